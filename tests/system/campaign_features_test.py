"""What a user asks of campaigns beyond running them: factors, dispersions, stopping, pausing, extending, replaying.

Run by ctest; FATMC_TEST_BIN is the folder with fatmc and fatmc-worker that have the study of tests/support.
"""
import json
import os
import signal
import sqlite3
import unittest

import engine_test
from engine_test import FATMC, LIMIT_S, until

HEAD = '[campaign]\nstudy = "engine_test"\nname = "features"\nseed = 11\n'
CELL = '[[cell]]\nname = "c"\nrepetitions = {n}\n{rest}\n'
INPUTS = '[inputs]\na = 0.0\nb = 0.0\nc = 0.0\n'
DRAWN = '[[dispersion]]\npath = "inputs.a"\nlaw = "normal"\nmean = 1.0\nsd = 2.0\n' \
        '[[dispersion]]\npath = "inputs.b"\nlaw = "uniform"\nlow = -1.0\nhigh = 1.0\n'


class Engine(engine_test.Engine):
    def spec(self, text, name="spec.toml"):
        self.write(name, HEAD + text)
        return name

    def done(self, *arguments):
        result = self.call(*arguments)
        self.assertEqual(result.returncode, 0, result.stderr)
        return result.stdout

    def sql(self, database, query):
        connection = sqlite3.connect(f"file:{self.path(database)}?mode=ro", uri=True)
        try:
            return connection.execute(query).fetchall()
        finally:
            connection.close()

    def test_factors_are_listed_by_a_dry_run_and_run_with_their_own_counts(self):
        self.spec(CELL.format(n=4, rest="") +
                  '[[factor]]\npath = "cell.array"\nvalues = [1, 2]\nrepetitions = [3, 5]\n'
                  '[[factor]]\npath = "cell.work"\nname = "effort"\nvalues = [0, 10]\nlabels = ["none", "some"]\n')
        listing = self.done("run", "spec.toml", "--dry-run")
        self.assertIn("4 cells, 16 trials", listing)
        self.assertIn("c, array=2, effort=some: 5 trials", listing)
        self.assertFalse(os.path.exists(self.path("results")))
        self.done("run", "spec.toml", "--db", "f.db")
        rows = self.sql("f.db", "SELECT cell, stored FROM cells")
        self.assertEqual(rows, [("c, array=1, effort=none", 3), ("c, array=1, effort=some", 3),
                                ("c, array=2, effort=none", 5), ("c, array=2, effort=some", 5)])
        counts = self.sql("f.db", "SELECT DISTINCT cell, count FROM arrays WHERE name = 'values'")
        self.assertEqual({count for cell, count in counts if "array=2" in cell}, {2})

    def test_sizes_are_chosen_on_the_command_line(self):
        self.spec(CELL.format(n=50, rest="") + '[size.small]\nrepetitions = 3\nset."cell.array" = 4\n')
        self.assertIn("1 cells, 3 trials", self.done("run", "spec.toml", "--dry-run", "--size", "small"))
        self.assertIn("1 cells, 50 trials", self.done("run", "spec.toml", "--dry-run", "--size", "full"))
        self.spec(CELL.format(n=50, rest=""), "plain.toml")
        self.refused("the spec has no [size.small]", "run", "plain.toml", "--size", "small")
        self.refused("the spec has no [size.tiny]", "run", "spec.toml", "--size", "tiny")

    def test_a_shard_without_a_trial_is_refused(self):
        self.spec(CELL.format(n=2, rest=""))
        self.refused("--shard 1/3 holds no trial", "run", "spec.toml", "--shard", "1/3", "--db", "s.db")
        self.assertFalse(os.path.exists(self.path("s.db")))

    def test_drawn_parameters_are_stored_and_the_same_for_any_number_of_workers(self):
        self.spec(CELL.format(n=40, rest="") + INPUTS + DRAWN)
        for workers in ("1", "2"):
            self.done("run", "spec.toml", "--db", workers + ".db", "--workers", workers)
        self.assertEqual(self.digest("1.db"), self.digest("2.db"))
        drawn = dict(self.sql("1.db", "SELECT repetition, value FROM metrics WHERE name = 'draw.a'"))
        self.assertEqual(len(set(drawn.values())), 40)
        linear = self.sql("1.db", "SELECT l.value - n.value - 2 * a.value - b.value FROM metrics l "
                                  "JOIN metrics n USING (cell, repetition) JOIN metrics a USING (cell, repetition) "
                                  "JOIN metrics b USING (cell, repetition) WHERE l.name = 'linear' AND n.name = 'noise' "
                                  "AND a.name = 'draw.a' AND b.name = 'draw.b'")
        self.assertEqual(len(linear), 40)
        self.assertLess(max(abs(rest) for rest, in linear), 1e-12)
        seed, build, parameters = self.sql("1.db", "SELECT seed, build, drawn FROM provenance WHERE repetition = 7")[0]
        self.assertEqual((seed, len(build), json.loads(parameters)["a"]), (11, 64, drawn[7]))

    def test_a_dispersion_that_meets_nothing_is_refused_at_its_line(self):
        self.spec(CELL.format(n=4, rest="") + INPUTS + DRAWN.replace("inputs.a", "inputs.z"))
        self.refused("spec.toml:14: inputs.z: is not a known key", "run", "spec.toml")

    def test_a_campaign_stops_at_one_n_whatever_the_number_of_workers_and_interruptions(self):
        self.spec(CELL.format(n=3000, rest="work = 20000\ndiverge_every = 7") +
                  '[stop]\nmetric = "normal"\nhalf_width = 0.25\nminimum = 20\ntuned_for = 100\n')
        outputs = [self.done("run", "spec.toml", "--db", workers + ".db", "--workers", workers) for workers in "12"]
        self.assertEqual(self.digest("1.db"), self.digest("2.db"))
        n, low, high = self.sql("1.db", "SELECT repetitions, low, high FROM stop")[0]
        self.assertTrue(20 < n < 3000)
        self.assertLessEqual(0.5 * (high - low), 0.25)
        self.assertEqual(self.sql("2.db", "SELECT count(*), max(repetition) FROM trial")[0], (n, n - 1))
        self.assertIn(f"c: precise enough after {n} trials", outputs[1])
        # Interrupted and resumed, and run again when it is done.
        process = self.start(FATMC, "run", "spec.toml", "--db", "3.db", "--workers", "2")
        until(lambda: self.stored("3.db") > 5 or process.poll() is not None, "some trials are stored")
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=LIMIT_S)
        for _ in range(2):
            self.done("run", "spec.toml", "--db", "3.db")
        self.assertEqual(self.digest("3.db"), self.digest("1.db"))
        # A wish for more precision goes on from there.
        with open(self.path("spec.toml")) as file:
            self.write("spec.toml", file.read().replace("half_width = 0.25", "half_width = 0.2"))
        self.done("run", "spec.toml", "--db", "3.db")
        self.assertGreater(self.sql("3.db", "SELECT repetitions FROM stop")[0][0], n)
        self.assertIn("precise enough: half-width at most 0.2", self.done("status", "3.db"))

    def test_precision_that_is_not_reached_is_said(self):
        self.spec(CELL.format(n=30, rest="") + '[stop]\nmetric = "normal"\nhalf_width = 0.001\n')
        self.assertIn("is not known to within 0.001 after all 30 trials", self.done("run", "spec.toml", "--db", "p.db"))

    def test_cells_of_higher_priority_are_run_first(self):
        self.spec('[[cell]]\nname = "late"\nrepetitions = 20\n[[cell]]\nname = "early"\nrepetitions = 20\npriority = 1\n')
        self.done("run", "spec.toml", "--db", "p.db", "--workers", "1")
        first, last = (self.sql("p.db", f"SELECT {f}(started) FROM trials WHERE cell = '{c}'")[0][0]
                       for f, c in (("min", "late"), ("max", "early")))
        self.assertLessEqual(last, first)

    def test_a_running_campaign_is_paused_extended_and_resumed_from_another_terminal(self):
        self.spec(CELL.format(n=60, rest="work = 5000000"))
        self.done("run", "spec.toml", "--db", "whole.db", "--trials", "70")
        process = self.start(FATMC, "run", "spec.toml", "--db", "p.db", "--workers", "2")
        until(lambda: self.stored("p.db") > 3, "some trials are stored")
        self.assertIn("get nothing new", self.done("pause", "p.db"))
        self.assertIn("running; paused", self.done("status", "p.db"))
        self.assertIn("takes them up", self.done("extend", "p.db", "--trials", "70"))
        self.assertEqual(self.call("status", "p.db", "--check").returncode, 3)
        self.assertIn("the campaign is paused", self.done("explain", "p.db"))
        self.assertIsNone(process.poll())
        self.done("resume", "p.db")
        _, errors = process.communicate(timeout=LIMIT_S)
        self.assertEqual(process.returncode, 0, errors)
        self.assertEqual(self.digest("p.db"), self.digest("whole.db"))
        self.assertEqual(self.call("status", "p.db", "--check").returncode, 0)

    def test_extend_needs_no_spec_and_moves_no_number(self):
        self.spec(CELL.format(n=12, rest="array = 3"))
        self.done("run", "spec.toml", "--db", "whole.db", "--trials", "30")
        self.done("run", "spec.toml", "--db", "e.db")
        os.remove(self.path("spec.toml"))
        self.assertIn("30 of 30 trials", self.done("extend", "e.db", "--add", "18"))
        self.assertEqual(self.digest("e.db"), self.digest("whole.db"))
        self.refused("no cell has fewer trials", "extend", "e.db", "--trials", "30")
        self.refused("no cell \"d\"", "extend", "e.db", "--trials", "40", "--cell", "d")

    def test_replay_gives_the_same_bits_and_says_when_it_cannot(self):
        self.spec(CELL.format(n=10, rest="array = 5\ndiverge_every = 5") + INPUTS + DRAWN)
        self.done("run", "spec.toml", "--db", "r.db")
        self.assertIn("c/3: ok; bit-identical to the stored row", self.done("replay", "r.db", "3"))
        self.assertIn("c/4: diverged (as the spec told it); bit-identical", self.done("replay", "r.db", "c/4"))
        self.assertIn("not stored yet", self.done("replay", "r.db", "c/99"))
        self.refused("names no trial", "replay", "r.db", "c/x")
        result = self.call("replay", "r.db", "3", "-o", "flight.csv")
        self.assertEqual(result.returncode, 1, "the study of the tests flies nothing")
        self.assertIn("has no record", result.stderr)
        with sqlite3.connect(self.path("r.db")) as connection:
            connection.execute("UPDATE trial SET content_hash = zeroblob(32) WHERE repetition = 3")
        result = self.call("replay", "r.db", "3")
        self.assertEqual(result.returncode, 1)
        self.assertIn("differs from the stored row", result.stderr)
        with sqlite3.connect(self.path("r.db")) as connection:
            connection.execute("UPDATE campaign SET build = 'another'")
        self.refused("cannot promise the same bits", "replay", "r.db", "5")
        self.assertIn("bit-identical", self.done("replay", "r.db", "5", "--any-build"))

    def test_explain_tells_why_trials_failed_or_are_missing_and_what_to_do(self):
        self.spec(CELL.format(n=10, rest="diverge_every = 5"))
        self.done("run", "spec.toml", "--db", "x.db")
        text = self.done("explain", "x.db")
        self.assertIn("2 trials diverged, the first is c/4 (as the spec told it)", text)
        self.assertIn("leased 1 time\n", self.done("explain", "x.db", "c/4"))
        self.assertIn("beyond the plan of 10", self.done("explain", "x.db", "c/10"))
        with sqlite3.connect(self.path("x.db")) as connection:
            connection.execute("DELETE FROM trial WHERE repetition IN (2, 3, 7)")
        text = self.done("explain", "x.db")
        self.assertIn("c: 3 trials missing: 2 to 3, 7", text)
        self.assertIn("go on by: fatmc extend x.db", text)
        self.assertIn("planned and not stored", self.done("explain", "x.db", "c/2"))

    def test_trials_that_a_run_did_not_ask_for_are_told_and_computed_by_extend(self):
        self.spec(CELL.format(n=10, rest=""))
        self.assertNotIn("the database plans", self.call("run", "spec.toml", "--db", "more.db", "--trials", "6").stderr)
        with sqlite3.connect(self.path("more.db")) as connection:
            connection.execute("UPDATE cell SET repetitions = 10")
        result = self.call("run", "spec.toml", "--db", "more.db", "--trials", "8")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("the database plans 2 more", result.stderr)
        self.done(*result.stderr.split("which this computes: fatmc ")[1].split("\n")[0].split())
        self.assertEqual(self.call("status", "more.db", "--check").returncode, 0)

    def test_a_stop_of_a_run_that_was_extended_names_the_command_for_all_of_it(self):
        self.spec(CELL.format(n=2, rest="work = 3000000"))
        self.done("run", "spec.toml", "--db", "e.db")
        self.done("pause", "e.db")
        process = self.start(FATMC, "run", "spec.toml", "--db", "e.db", "--workers", "1", "--trials", "3")
        until(lambda: "coordinator: running" in self.call("status", "e.db").stdout, "a coordinator waits")
        self.done("extend", "e.db", "--trials", "3000")
        self.done("resume", "e.db")
        until(lambda: self.stored("e.db") > 3, "it takes the trials up")
        process.send_signal(signal.SIGINT)
        _, errors = process.communicate(timeout=LIMIT_S)
        self.assertEqual(process.returncode, 3, errors)
        self.assertIn("go on by: fatmc extend e.db", errors)

    def test_a_trial_that_takes_long_is_found_where_it_is(self):
        self.spec(CELL.format(n=1, rest="work = 9000000000"))
        process = self.start(FATMC, "run", "spec.toml", "--db", "l.db", "--workers", "1")
        until(lambda: os.path.exists(self.path("l.db")) and "held by process" in self.call("explain", "l.db").stdout,
              "the trial is reported")
        self.assertIn("c/0: held by process", self.done("explain", "l.db", "0"))
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=LIMIT_S)
        self.assertEqual(process.returncode, 3)
        self.assertNotIn("held by process", self.done("explain", "l.db"))

    def test_several_campaigns_in_one_file_are_run_one_after_another(self):
        os.mkdir(self.path("sub"))
        for name in ("one", "two"):
            self.write(f"sub/{name}.toml", HEAD.replace("features", name) + CELL.format(n=3, rest=""))
        self.write("all.toml", '[[study]]\nspec = "sub/one.toml"\n[[study]]\nspec = "sub/two.toml"\n')
        self.assertEqual(self.done("run", "all.toml", "--trials", "5").count("5 of 5 trials"), 2)
        with open(self.path("results/last")) as file:
            self.assertEqual([os.path.basename(line.strip()) for line in file], ["one.db", "two.db"])
        self.refused("lists several", "run", "all.toml", "--db", "x.db")
        self.write("bad.toml", '[[study]]\nspec = "sub/three.toml"\n')
        self.refused('bad.toml:2: study.spec: no file "sub/three.toml"', "run", "bad.toml")
        self.write("sub/two.toml", HEAD.replace("features", "one") + CELL.format(n=3, rest=""))
        self.refused("names two campaigns", "run", "all.toml")

    def test_arrays_are_kept_or_not_as_the_spec_says(self):
        self.spec(CELL.format(n=3, rest="array = 5") + "[keep]\narrays = false\n")
        self.done("run", "spec.toml", "--db", "k.db")
        self.assertEqual(self.sql("k.db", "SELECT count(*) FROM arrays"), [(0,)])
        self.assertIn("bit-identical", self.done("replay", "k.db", "1"))


if __name__ == "__main__":
    unittest.main(verbosity=2)
