"""`fatmc run --launcher slurm` against a real Slurm that this test installs (Debian, root) and starts in a temporary
folder; without root or without the packages it skips with a message (exit code 77).

FATMC_TEST_BIN is the folder with fatmc and fatmc-worker that have the study of tests/support.
"""
import os
import re
import signal
import sqlite3
import subprocess
import sys
import unittest

import slurm_cluster
from slurm_cluster import LIMIT_S, Cluster, until

BIN = os.environ["FATMC_TEST_BIN"]
FATMC = os.path.join(BIN, "fatmc")

# Trials of about 20 ms, five to ten seconds in all on two pilots: long enough to strike in mid-run.
SPEC = """
[campaign]
study = "engine_test"
name = "slurm"
seed = 12

[[cell]]
name = "long"
repetitions = 300
work = 8000000
diverge_every = 50
array = 3
"""


class Slurm(unittest.TestCase):
    reference_digest = None

    def setUp(self):
        # A Slurm for each test: it starts in less than a second, and one test's wreck is not the next one's.
        self.cluster = Cluster()
        self.addCleanup(self.cluster.stop)
        self.cluster.start()
        self.folder = self.cluster.folder
        (self.folder / "spec.toml").write_text(SPEC)

    def fatmc(self, *arguments):
        return subprocess.run([FATMC, *arguments], cwd=self.folder, env=self.cluster.environment, capture_output=True,
                              text=True, timeout=LIMIT_S)

    def reference(self):
        """The digest of a local run."""
        if Slurm.reference_digest is None:
            local = self.fatmc("run", "spec.toml", "--db", "local.db", "--workers", "2")
            self.assertEqual(local.returncode, 0, local.stderr)
            Slurm.reference_digest = self.fatmc("digest", "local.db").stdout
        return Slurm.reference_digest

    def words(self, database):
        return ("run", "spec.toml", "--db", database, "--launcher", "slurm", "--workers", "2", "--bind",
                f"tcp://127.0.0.1:{slurm_cluster.free_port()}")

    def start(self, words):
        self.errors = open(self.folder / "errors.txt", "w+")
        process = subprocess.Popen([FATMC, *words], cwd=self.folder, env=self.cluster.environment,
                                   stdout=subprocess.DEVNULL, stderr=self.errors)
        self.addCleanup(self.errors.close)
        self.addCleanup(lambda: process.poll() is None and process.kill())
        return process

    def said(self):
        return (self.folder / "errors.txt").read_text()

    def select(self, database, sql):
        try:
            connection = sqlite3.connect(f"file:{self.folder / database}?mode=ro", uri=True)
            try:
                return connection.execute(sql).fetchone()[0]
            finally:
                connection.close()
        except sqlite3.OperationalError:
            return 0  # not yet made

    def stored(self, database):
        return self.select(database, "SELECT count(*) FROM trial")

    def wait_for(self, database, count):
        until(lambda: self.stored(database) >= count, f"{count} trials are stored\n{self.said()}\n{self.cluster.logs()}")

    def finish(self, process, database):
        self.assertEqual(process.wait(timeout=LIMIT_S), 0, self.said())
        self.assertEqual(self.fatmc("digest", database).stdout, self.reference())
        until(lambda: not self.cluster.jobs(), "the pilots have ended")

    def test_pilots_are_few_and_leave_the_digest_of_a_local_run(self):
        process = self.start(self.words("few.db"))
        self.finish(process, "few.db")
        self.assertIn("submitted 2 pilots", self.said())
        self.assertLessEqual(self.select("few.db", "SELECT count(DISTINCT pid) FROM trial"), 2)

    def test_a_coordinator_that_comes_back_adopts_the_pilots(self):
        words = self.words("adopt.db")
        first = self.start(words)
        self.wait_for("adopt.db", 20)
        first.kill()
        first.wait()
        self.assertLess(self.stored("adopt.db"), 300, "the coordinator was to be killed in mid-run")
        self.assertEqual(len(self.cluster.jobs("RUNNING")), 2)
        self.finish(self.start(words), "adopt.db")
        self.assertIn("adopted 2 pilots", self.said())
        self.assertNotIn("submitted", self.said())
        self.assertLessEqual(self.select("adopt.db", "SELECT count(DISTINCT pid) FROM trial"), 2)

    def lose_controller(self, database, forgets):
        """Kills slurmctld in mid-run, sees trials flow on, and starts it again with or without its memory."""
        process = self.start(self.words(database))
        self.wait_for(database, 20)
        if not forgets:
            until(lambda: len(self.cluster.jobs("RUNNING")) == 2, "both pilots run")
            self.cluster.remember_jobs()
        self.cluster.kill_controller()
        if forgets:
            self.cluster.forget_jobs()
        before = self.stored(database)
        self.assertLess(before, 300, "the controller was to be killed in mid-run")
        self.wait_for(database, min(before + 40, 300))
        self.cluster.start_controller()
        self.finish(process, database)
        until(lambda: not self.cluster.processes("fatmc-worker"), "all workers have ended")

    def test_a_killed_controller_stops_no_pilot_and_doubles_none(self):
        self.lose_controller("dead.db", forgets=False)
        self.assertEqual(self.said().count("submitted"), 1, self.said())
        self.assertLessEqual(self.select("dead.db", "SELECT count(DISTINCT pid) FROM trial"), 2)

    def test_a_controller_without_memory_makes_ghosts_of_pilots_that_cost_no_trial_and_no_duplicate(self):
        # Its pilots compute on while no queue knows them, until Slurm finds and ends them as orphans.
        self.lose_controller("ghosts.db", forgets=True)

    def test_pilots_that_are_requeued_or_cancelled_are_replaced(self):
        process = self.start(self.words("hurt.db"))
        self.wait_for("hurt.db", 20)
        until(lambda: len(self.cluster.jobs("RUNNING")) == 2, "both pilots run")
        one, other = self.cluster.jobs("RUNNING")
        self.cluster.ask("scontrol", "requeue", one)
        self.cluster.ask("scancel", other)
        self.finish(process, "hurt.db")

    def test_ctrl_c_ends_the_pilots_and_the_printed_command_goes_on(self):
        process = self.start(self.words("stop.db"))
        self.wait_for("stop.db", 20)
        process.send_signal(signal.SIGINT)
        self.assertEqual(process.wait(timeout=LIMIT_S), 3, self.said())
        until(lambda: not self.cluster.jobs(), "the pilots have ended")
        again = re.search(r"go on by: fatmc (.*)", self.said()).group(1).split()
        self.finish(self.start(again), "stop.db")

    def test_pilots_that_slurm_refuses_end_the_run_with_its_reason(self):
        refused = self.fatmc(*self.words("none.db"), "--sbatch=--partition=nowhere")
        self.assertEqual(refused.returncode, 1, refused.stderr)
        self.assertIn("Slurm takes no pilots", refused.stderr)
        self.assertIn("invalid partition", refused.stderr.lower())


if __name__ == "__main__":
    reason = slurm_cluster.install()
    if reason:
        print(f"skipped: {reason}")
        sys.exit(77)
    unittest.main(verbosity=2)
