"""The engine with real processes: kill -9, Ctrl-C, resuming, and what it answers to wrong input.

Run by ctest; FATMC_TEST_BIN is the folder with fatmc and fatmc-worker that have the study of tests/support.
"""
import json
import os
import shutil
import signal
import socket
import sqlite3
import subprocess
import unittest

from engine_case import FATMC, LIMIT_S, SPEC, WORKER, EngineCase, children, is_alive, until


class Engine(EngineCase):
    def test_one_two_and_eight_workers_leave_the_same_digest(self):
        reference = self.reference_digest()
        for workers in ("2", "8"):
            result = self.call("run", "spec.toml", "--db", f"{workers}.db", "--workers", workers)
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertIn("180 of 180 trials: 168 ok, 12 diverged", result.stdout)
            self.assertIn("mean of a standard normal", result.stdout)
            self.assertEqual(self.digest(f"{workers}.db"), reference)

    def test_a_campaign_done_piece_by_piece_in_another_order_has_the_same_digest(self):
        reference = self.reference_digest()
        for trials, workers in (("7", "3"), ("31", "1"), ("60", "2")):
            result = self.call("run", "spec.toml", "--db", "p.db", "--trials", trials, "--workers", workers)
            self.assertEqual(result.returncode, 0, result.stderr)
        result = self.call("run", "spec.toml", "--db", "p.db", "--workers", "2")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(self.digest("p.db"), reference)

    def test_keys_of_a_run_stand_in_no_command_line_and_no_environment(self):
        process = self.start(FATMC, "run", "spec.toml", "--workers", "1")
        worker = until(lambda: children(process.pid), "the worker is there")[0]
        until(lambda: self.stored("results/engine.db") > 0, "it works")
        for what in ("cmdline", "environ"):
            with open(f"/proc/{worker}/{what}", "rb") as file:
                self.assertNotRegex(file.read(), rb"[0-9a-f]{64}")
        with open(f"/proc/{worker}/cmdline", "rb") as file:
            self.assertIn(b"--keys-descriptor\x003", file.read())
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=LIMIT_S)

    def test_a_worker_then_the_coordinator_killed_and_resumed_leave_the_same_digest(self):
        reference = self.reference_digest()
        arguments = ("run", "spec.toml", "--db", "hurt.db", "--workers", "2")
        coordinator = self.start(FATMC, *arguments)
        until(lambda: self.stored("hurt.db") > 10, "some trials are stored")
        victim = children(coordinator.pid)[0]
        os.kill(victim, signal.SIGKILL)
        before = self.stored("hurt.db")
        until(lambda: self.stored("hurt.db") > before + 20, "work goes on without the killed worker")
        self.assertIsNone(coordinator.poll())
        orphans = children(coordinator.pid)
        os.kill(coordinator.pid, signal.SIGKILL)
        coordinator.wait()
        self.assertLess(self.stored("hurt.db"), 180, "the coordinator was to be killed in mid-run")
        resumed = self.call(*arguments)
        self.assertEqual(resumed.returncode, 0, resumed.stderr)
        self.assertIn("180 of 180 trials", resumed.stdout)
        self.assertEqual(self.digest("hurt.db"), reference)
        until(lambda: not any(is_alive(pid) for pid in orphans), "orphaned workers end by themselves")

    def test_ctrl_c_ends_with_3_leaves_no_process_and_the_printed_command_resumes(self):
        process = self.start(FATMC, "run", "spec.toml", "--workers", "2")
        until(lambda: self.stored("results/engine.db") > 10, "some trials are stored")
        workers = children(process.pid)
        self.assertEqual(len(workers), 2)
        process.send_signal(signal.SIGINT)
        _, errors = process.communicate(timeout=LIMIT_S)
        self.assertEqual(process.returncode, 3, errors)
        self.assertFalse(any(is_alive(pid) for pid in workers))
        line = errors.strip().splitlines()[-1]
        self.assertIn("go on by: fatmc run spec.toml", line)
        stored = self.stored("results/engine.db")
        self.assertLess(stored, 180)
        resume = line.split("go on by: fatmc ")[1].split()
        resumed = self.call(*resume)
        self.assertEqual(resumed.returncode, 0, resumed.stderr)
        self.assertEqual(self.digest("results/engine.db"), self.reference_digest())

    def test_standalone_workers_outlive_their_coordinator_and_serve_its_successor(self):
        reference = self.reference_digest()
        endpoint = f"ipc://{self.path('socket')}"
        arguments = ("coordinator", "spec.toml", "--bind", endpoint, "--db", "own.db")
        worker = self.start(WORKER, "--connect", endpoint, "--jobs", "2")
        coordinator = self.start(FATMC, *arguments)
        until(lambda: self.stored("own.db") > 10, "some trials are stored")
        os.kill(coordinator.pid, signal.SIGKILL)
        coordinator.wait()
        self.assertLess(self.stored("own.db"), 180)
        successor = self.call(*arguments)
        self.assertEqual(successor.returncode, 0, successor.stderr)
        self.assertEqual(self.digest("own.db"), reference)
        self.assertEqual(worker.wait(timeout=LIMIT_S), 0, "told that the campaign is finished")

    def test_more_trials_extend_a_database_and_keep_what_it_has(self):
        self.assertEqual(self.call("run", "spec.toml", "--db", "more.db", "--trials", "10").returncode, 0)
        with sqlite3.connect(self.path("more.db")) as connection:
            before = connection.execute("SELECT id, content_hash, started_us FROM trial ORDER BY id").fetchall()
        result = self.call("run", "spec.toml", "--db", "more.db", "--trials", "15")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("30 of 30 trials", result.stdout)
        with sqlite3.connect(self.path("more.db")) as connection:
            after = connection.execute("SELECT id, content_hash, started_us FROM trial ORDER BY id").fetchall()
        self.assertTrue(set(before) < set(after))

    def refused(self, expected, *arguments):
        result = self.call(*arguments)
        self.assertEqual(result.returncode, 2, result.stderr)
        self.assertEqual(len(result.stderr.splitlines()), 1, result.stderr)
        self.assertIn(expected, result.stderr)

    def test_another_seed_spec_or_build_on_a_database_is_refused(self):
        self.assertEqual(self.call("run", "spec.toml", "--db", "a.db", "--trials", "2").returncode, 0)
        before = self.digest("a.db")
        self.refused("made with seed 11, this run has 12", "run", "spec.toml", "--db", "a.db", "--seed", "12")
        self.write("other.toml", SPEC.replace("array = 7", "array = 8"))
        self.refused("other.toml:12: cell.1.array: is 8, the database was made with 7",
                     "run", "other.toml", "--db", "a.db")
        with sqlite3.connect(self.path("a.db")) as connection:
            connection.execute("UPDATE campaign SET build = 'another'")
        self.refused("made by build another", "run", "spec.toml", "--db", "a.db")
        self.assertEqual(self.digest("a.db"), before)

    def test_wrong_input_gets_one_line_and_leaves_nothing_behind(self):
        self.write("key.toml", SPEC.replace("array = 7", "aray = 7"))
        self.refused("key.toml:12: cell.aray: is not a known key", "run", "key.toml")
        self.write("range.toml", SPEC.replace("work = 10000000", "work = -4"))
        self.refused("range.toml:17: cell.work: -4 is out of range", "run", "range.toml")
        self.write("study.toml", SPEC.replace("engine_test", "nothing"))
        self.refused("study.toml:3: campaign.study: \"nothing\" is not known", "run", "study.toml")
        self.write("text.toml", "a = = 1\n")
        self.refused("text.toml:1", "run", "text.toml")
        self.refused("nowhere.toml", "run", "nowhere.toml")
        self.refused("--workers", "run", "spec.toml", "--workers", "0")
        self.assertFalse(os.path.exists(self.path("results")))
        self.write("notes.db", "this is no database, but somebody's notes\n" * 40)
        self.refused("notes.db: is no database", "run", "spec.toml", "--db", "notes.db")
        with open(self.path("notes.db")) as file:
            self.assertTrue(file.read().startswith("this is no database"))
        self.refused("nowhere.db: no such database", "digest", "nowhere.db")

    def test_wrong_outputs_get_one_line_and_exit_code_2_before_any_trial(self):
        os.mkdir(self.path("folder"))
        self.write("file", "notes\n")
        for command in (("run", "spec.toml"), ("coordinator", "spec.toml", "--bind", "tcp://127.0.0.1:*")):
            self.refused("folder: is a folder", *command, "--db", "folder")
            self.refused("file/x.db: its folder cannot be made", *command, "--db", "file/x.db")
            self.refused("n.db", *command, "--db", "n" * 300 + ".db")
        for command in ("status", "digest", "query", "tables"):
            self.refused("folder: no such database", command, "folder")
            self.refused("n.db: cannot be read", command, "n" * 300 + ".db")
        for name, what in (("", "is empty"), ("n" * 300, "has 300 characters")):
            self.write("name.toml", SPEC.replace('name = "engine"', f'name = "{name}"'))
            self.refused(f"name.toml:4: campaign.name: {what}", "run", "name.toml")
        self.assertEqual(sorted(os.listdir(self.cwd)), ["file", "folder", "name.toml", "spec.toml"])

    def test_wrong_published_figures_are_refused_before_any_trial(self):
        self.write("published.toml", 'kind = "published"\n[[figure]]\ntable = 5\n')
        self.write("with.toml", 'published = "published.toml"\n' + SPEC)
        self.refused("published.toml:3: figure.table: is an integer, write a string", "run", "with.toml")
        self.assertFalse(os.path.exists(self.path("results")))

    def test_a_failed_start_leaves_no_trace(self):
        with socket.socket() as taken:
            taken.bind(("127.0.0.1", 0))
            taken.listen()
            endpoint = f"tcp://127.0.0.1:{taken.getsockname()[1]}"
            self.refused("cannot be used", "coordinator", "spec.toml", "--bind", endpoint, "--db", "new.db")
        self.assertEqual(os.listdir(self.cwd), ["spec.toml"])
        alone = self.path("bin")
        os.mkdir(alone)
        shutil.copy(FATMC, alone)
        result = subprocess.run([os.path.join(alone, "fatmc"), "run", "spec.toml"], cwd=self.cwd,
                                capture_output=True, text=True, timeout=LIMIT_S)
        self.assertEqual(result.returncode, 2, result.stderr)
        self.assertIn("fatmc-worker: cannot be run", result.stderr)
        self.assertEqual(sorted(os.listdir(self.cwd)), ["bin", "spec.toml"])

    def test_a_run_whose_last_cannot_be_written_is_done_with_a_warning(self):
        self.write("results", "a file where a folder should be\n")
        result = self.call("run", "spec.toml", "--db", "x.db", "--trials", "2")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("warning: results/last: cannot be written", result.stderr)
        self.assertIn("4 of 4 trials", result.stdout)

    def test_a_damaged_database_is_named_with_a_remedy_by_every_command(self):
        self.assertEqual(self.call("run", "spec.toml", "--db", "d.db").returncode, 0)
        with open(self.path("d.db"), "r+b") as file:
            size = file.seek(0, os.SEEK_END)
            file.seek(4096 * 2)  # behind the schema: the file still opens
            file.write(b"\xee" * (size - 4096 * 2))
        for command in (("run", "spec.toml", "--db", "d.db"), ("status", "d.db"), ("digest", "d.db"),
                        ("tables", "d.db"), ("query", "d.db", "--sql", "SELECT * FROM trials")):
            self.refused("d.db: is damaged", *command)

    def test_output_that_is_lost_is_a_failure(self):
        self.assertEqual(self.call("run", "spec.toml", "--db", "f.db", "--trials", "2").returncode, 0)
        for command in (("status", "f.db"), ("digest", "f.db"), ("tables", "f.db"), ("query", "f.db"), ("--help",)):
            with open("/dev/full", "w") as full:
                result = subprocess.run([FATMC, *command], cwd=self.cwd, stdout=full, stderr=subprocess.PIPE,
                                        text=True, timeout=LIMIT_S)
            self.assertEqual(result.returncode, 1, command)
            self.assertIn("standard output could not be written", result.stderr)

    def test_an_unknown_command_is_named(self):
        self.refused('"bogus" is no command, write one of: run', "bogus")

    def test_a_table_is_found_by_its_number_alone(self):
        self.assertEqual(self.call("run", "spec.toml", "--db", "t.db", "--trials", "2").returncode, 0)
        for only in ("Section 1.2", "1.2"):
            result = self.call("tables", "t.db", "--only", only)
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertIn("mean of a standard normal", result.stdout)
        self.refused('no table "2"', "tables", "t.db", "--only", "2")

    def test_a_run_without_an_estimate_says_so(self):
        self.write("fail.toml", SPEC.replace("array = 3", "diverge_every = 1").replace("= 10\n", "= 1\n"))
        result = self.call("run", "fail.toml", "--trials", "2")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("0 ok, 4 diverged", result.stdout)
        self.assertIn("no trial gave an estimate", result.stdout)

    def test_plain_tcp_is_for_the_loopback_alone(self):
        self.refused("not on the loopback", "coordinator", "spec.toml", "--bind", "tcp://0.0.0.0:5555", "--db", "x.db")
        self.refused("not on the loopback", "coordinator", "spec.toml", "--bind", "tcp://*:5555", "--db", "x.db")

    def test_a_database_has_one_writer_at_a_time(self):
        arguments = ("coordinator", "spec.toml", "--bind", "tcp://127.0.0.1:*", "--db", "one.db")
        first = self.start(FATMC, *arguments)
        until(lambda: first.stderr.readline(), "the first serves")
        self.refused("is being written by another coordinator", *arguments)
        first.send_signal(signal.SIGTERM)
        self.assertEqual(first.wait(timeout=LIMIT_S), 3)

    def test_a_trial_that_kills_its_workers_is_quarantined_with_the_reason_and_the_rest_is_done(self):
        self.write("crash.toml", SPEC.replace("array = 7", "array = 7\ncrash_at = 100"))
        result = self.call("run", "crash.toml", "--db", "crash.db", "--workers", "2")
        self.assertEqual(result.returncode, 3, result.stderr)
        self.assertIn("1 trials are quarantined", result.stderr)
        self.assertIn("180 of 180 trials: 167 ok, 12 diverged, 1 quarantined", result.stdout)
        failure, = self.rows("crash.db", "SELECT repetition, detail, attempts FROM trials WHERE outcome = 'quarantined'")
        self.assertEqual(failure, (100, "killed its worker 3 times, at last: signal Aborted", 3))
        again = self.call("run", "crash.toml", "--db", "crash.db", "--workers", "2")
        self.assertEqual(again.returncode, 3, "a campaign with a trial given up stays partial")

    def test_a_quarantined_trial_that_works_when_tried_again_completes_the_campaign(self):
        reference = self.reference_digest()
        self.write("crash.toml", SPEC.replace("array = 7", "array = 7\ncrash_if = \"bomb\"\ncrash_at = 100"))
        self.write("bomb", "")
        result = self.call("run", "crash.toml", "--db", "crash.db", "--workers", "1")
        self.assertEqual(result.returncode, 3, result.stderr)
        os.remove(self.path("bomb"))
        result = self.call("run", "crash.toml", "--db", "crash.db", "--workers", "1", "--retry-quarantined")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("180 of 180 trials: 168 ok, 12 diverged", result.stdout)
        self.assertEqual(self.rows("crash.db", "SELECT count(*) FROM trial"), [(180,)])
        self.assertEqual(self.payloads("crash.db"), self.payloads("reference.db"))
        self.assertEqual(self.digest("reference.db"), reference)

    def test_a_study_whose_every_trial_kills_its_worker_ends_with_1(self):
        self.write("crash.toml", SPEC.replace("array = 7", "crash_every = 1"))
        result = self.call("run", "crash.toml", "--db", "crash.db", "--workers", "2")
        self.assertEqual(result.returncode, 1, result.stderr)
        self.assertIn("without a trial done in between", result.stderr)

    def test_what_a_trial_throws_is_said_and_is_the_reason_of_its_quarantine(self):
        self.write("throw.toml", SPEC.replace("array = 7", "array = 7\nthrow_at = 3"))
        result = self.call("run", "throw.toml", "--db", "throw.db", "--workers", "1")
        self.assertEqual(result.returncode, 3, result.stderr)
        self.assertIn("trial 3 of cell 0 threw: as the spec told it", result.stderr)
        detail = self.rows("throw.db", "SELECT detail FROM trials WHERE outcome = 'quarantined'")
        self.assertEqual(detail, [("killed its worker 3 times, at last: trial 3 of cell 0 threw: as the spec told it",)])

    def test_sql_users_find_scalars_and_arrays_by_name(self):
        self.assertEqual(self.call("run", "spec.toml", "--db", "q.db", "--trials", "12").returncode, 0)
        rows = json.loads(self.call("query", "q.db", "--view", "outcomes", "--format", "json").stdout)
        self.assertEqual(rows, [{"cell": "short", "outcome": "diverged", "trials": 1},
                                {"cell": "short", "outcome": "ok", "trials": 11},
                                {"cell": "long", "outcome": "ok", "trials": 12}])
        values = self.call("query", "q.db", "--format", "csv", "--sql",
                           "SELECT count(*) AS n FROM metrics WHERE name = 'normal' AND value IS NOT NULL").stdout
        self.assertEqual(values, "n\n23\n")
        arrays = json.loads(self.call("query", "q.db", "--format", "json", "--sql",
                                      "SELECT data FROM arrays WHERE cell = 'short' AND repetition = 0 "
                                      "AND name = 'values'").stdout)
        self.assertEqual(len(arrays[0]["data"]), 7)
        self.refused("--sql", "query", "q.db", "--sql", "SELECT nonsense")
        self.refused("--sql", "query", "q.db", "--sql", "DELETE FROM trial")
        status = self.call("status", "q.db")
        self.assertIn("trials: 24 of 24 stored", status.stdout)


if __name__ == "__main__":
    unittest.main(verbosity=2)
