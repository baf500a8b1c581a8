"""`fatmc run --launcher ssh` with a stand-in for ssh on PATH that runs the command here, as sshd would: through the
user's shell, with nothing of the caller's environment but what a login gives.

FATMC_TEST_BIN is the folder with fatmc and fatmc-worker that have the study of tests/support.
"""
import os
import pathlib
import signal
import sqlite3
import subprocess
import tempfile
import unittest

from slurm_cluster import LIMIT_S, free_port, until

BIN = os.environ["FATMC_TEST_BIN"]
FATMC = os.path.join(BIN, "fatmc")
SPEC = """
[campaign]
study = "engine_test"
name = "hosts"
seed = 13

[[cell]]
name = "long"
repetitions = 200
work = 4000000
diverge_every = 20
array = 3
"""
SSH = """#!/bin/sh
echo "$@" >> "{folder}/ssh.txt"
[ "$1" = -o ] && [ "$2" = BatchMode=yes ] || exit 9
shift 2
case $1 in unknown) echo "ssh: Could not resolve hostname unknown" >&2; exit 255 ;; esac
shift
exec env -i HOME=/ PATH=/usr/bin:/bin sh -c "$*"
"""


class Hosts(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory(prefix="fatmc_hosts_")
        self.addCleanup(self.temporary.cleanup)
        self.folder = pathlib.Path(self.temporary.name) / "a folder"  # whose name wants quotes
        self.folder.mkdir()
        (self.folder / "spec.toml").write_text(SPEC)
        ssh = self.folder / "ssh"
        ssh.write_text(SSH.format(folder=self.folder))
        ssh.chmod(0o755)
        self.environment = {**os.environ, "PATH": f"{self.folder}:{os.environ['PATH']}"}

    def fatmc(self, *arguments):
        return subprocess.run([FATMC, *arguments], cwd=self.folder, env=self.environment, capture_output=True,
                              text=True, timeout=LIMIT_S)

    def words(self, database, hosts, *more):
        return ("run", "spec.toml", "--db", database, "--launcher", "ssh", "--hosts", hosts, "--bind",
                f"tcp://127.0.0.1:{free_port()}", *more)

    def reference(self):
        self.assertEqual(self.fatmc("run", "spec.toml", "--db", "local.db", "--workers", "2").returncode, 0)
        return self.fatmc("digest", "local.db").stdout

    def test_hosts_leave_the_digest_of_a_local_run(self):
        done = self.fatmc(*self.words("ssh.db", "node1:2,ada@node2"))
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(self.fatmc("digest", "ssh.db").stdout, self.reference())
        calls = (self.folder / "ssh.txt").read_text().splitlines()
        self.assertEqual(len(calls), 2, calls)
        second, first = sorted(calls, key=lambda call: "ada@node2" not in call)  # both at once: logged in any order
        self.assertIn("ada@node2", second)
        self.assertIn("--jobs 2", first)

    def test_any_line_that_starts_a_command_there_will_do(self):
        done = self.fatmc(*self.words("line.db", "here:2", "--launch-line", "env HOST={host} sh -c {command}"))
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(self.fatmc("digest", "line.db").stdout, self.reference())

    def test_a_host_that_is_lost_is_started_again_and_an_unknown_one_given_up(self):
        process = subprocess.Popen([FATMC, *self.words("lost.db", "node1,unknown")], cwd=self.folder,
                                   env=self.environment, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        self.addCleanup(process.stderr.close)
        pid = until(lambda: self.worker_of("lost.db"), "a worker has stored a trial")
        os.kill(pid, signal.SIGKILL)
        _, errors = process.communicate(timeout=LIMIT_S)
        self.assertEqual(process.returncode, 0, errors)
        self.assertEqual(self.fatmc("digest", "lost.db").stdout, self.reference())

    def worker_of(self, database):
        try:
            with sqlite3.connect(f"file:{self.folder / database}?mode=ro", uri=True) as connection:
                return connection.execute("SELECT max(pid) FROM trial").fetchone()[0]
        except sqlite3.OperationalError:
            return None

    def refused(self, expected, *arguments):
        result = self.fatmc(*arguments)
        self.assertEqual(result.returncode, 2, result.stderr)
        self.assertEqual(len(result.stderr.splitlines()), 1, result.stderr)
        self.assertIn(expected, result.stderr)

    def test_options_that_do_not_fit_are_refused_before_anything_is_written(self):
        run = ("run", "spec.toml")
        self.refused("--hosts: is missing", *run, "--launcher", "ssh")
        self.refused("--hosts: is for --launcher ssh", *run, "--hosts", "a")
        self.refused("--hosts: \"a:0\"", *run, "--launcher", "ssh", "--hosts", "a:0")
        self.refused("--launch-line", *run, "--launcher", "ssh", "--hosts", "a", "--launch-line", "ssh {host}")
        self.refused("--sbatch: is for --launcher slurm", *run, "--sbatch=--partition=x")
        self.refused("--launcher: is local", *run, "--bind", "tcp://127.0.0.1:*")
        self.assertEqual(sorted(os.listdir(self.folder)), ["spec.toml", "ssh"])

    def test_shards_that_ran_apart_have_the_digest_of_one_run(self):
        for shard in ("1/3", "2/3", "3/3"):
            done = self.fatmc("run", "spec.toml", "--shard", shard, "--workers", "1")
            self.assertEqual(done.returncode, 0, done.stderr)
        shards = [f"results/hosts.{i}of3.db" for i in (1, 2, 3)]
        merged = self.fatmc("merge", "all.db", *shards)
        self.assertEqual(merged.returncode, 0, merged.stderr)
        self.assertIn("200 trials added, 0 were there already", merged.stdout)
        self.assertEqual(self.fatmc("digest", "all.db").stdout, self.reference())
        again = self.fatmc("merge", "all.db", shards[1])
        self.assertIn("0 trials added", again.stdout)
        self.refused("--shard", "run", "spec.toml", "--shard", "4/3")
        (self.folder / "stop.toml").write_text(SPEC + "[stop]\nmetric = 'x'\nhalf_width = 0.1\nbounds = [0.0, 1.0]\n")
        self.refused("stop: needs all trials of a cell", "run", "stop.toml", "--shard", "1/2")
        self.refused("made with seed", "merge", "all.db", self.other_seed())

    def other_seed(self):
        self.assertEqual(self.fatmc("run", "spec.toml", "--db", "other.db", "--seed", "5", "--trials", "2").returncode, 0)
        return "other.db"


if __name__ == "__main__":
    unittest.main(verbosity=2)
