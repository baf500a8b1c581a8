"""Faults, with real processes: killed, stopped, cut off, slow, lying; a full disk, a clock that jumps.

Run by ctest; FATMC_TEST_BIN is the folder with the programs of tests/support. No test sleeps a fixed time: trials
that wait for a file (hold_at, hold_while) put every process where a test wants it.
"""
import glob
import os
import resource
import select
import signal
import socket
import subprocess
import threading
import unittest

from engine_case import FATMC, LIMIT_S, SPEC, WORKER, EngineCase, until

OTHER_WORKER = WORKER + "-other"

# Trial 5 waits while the file "hold" exists, the last one while "last" does.
HELD = """
[campaign]
study = "engine_test"
name = "held"
seed = 11

[[cell]]
name = "only"
repetitions = 40
work = 100000
array = 3
hold_at = 5
hold_while = "hold"
last_while = "last"
"""


class Proxy:
    """A TCP proxy on the loopback that can cut its connections off, and damage what passes."""

    def __init__(self, port, damage_at=()):
        self.target = ("127.0.0.1", port)
        self.damage_at = list(damage_at)  # offsets of bytes to change, counted over all connections
        self.passed = 0
        self.is_cut = False
        self.pairs = []
        self.listener = socket.create_server(("127.0.0.1", 0))
        self.port = self.listener.getsockname()[1]
        self.closing, self.wake = socket.socketpair()
        self.thread = threading.Thread(target=self.serve, daemon=True)
        self.thread.start()

    def serve(self):
        while True:
            sockets = [] if self.is_cut else [s for pair in self.pairs for s in pair]
            ready, _, _ = select.select([self.listener, self.closing] + sockets, [], [], 0.05)
            if self.closing in ready:
                return
            if self.listener in ready:
                near, _ = self.listener.accept()
                try:
                    self.pairs.append((near, socket.create_connection(self.target)))
                except OSError:
                    near.close()
            for pair in list(self.pairs):
                if any(s in ready for s in pair) and not all(self.forward(*way, ready) for way in (pair, pair[::-1])):
                    self.drop(pair)

    def forward(self, source, sink, ready):
        if source not in ready:
            return True
        try:
            data = bytearray(source.recv(65536))
            if not data:
                return False
            while self.damage_at and self.damage_at[0] < self.passed + len(data):
                data[max(self.damage_at.pop(0) - self.passed, 0)] ^= 0x55
            self.passed += len(data)
            sink.sendall(data)
            return True
        except OSError:
            return False

    def drop(self, pair):
        self.pairs.remove(pair)
        for one in pair:
            one.close()

    def cut(self):
        """Nothing passes any more, and nobody is told."""
        self.is_cut = True

    def heal(self):
        """What was cut is dead by now; new connections pass."""
        for pair in list(self.pairs):
            self.drop(pair)
        self.is_cut = False

    def close(self):
        self.wake.send(b"x")
        self.thread.join()
        for pair in list(self.pairs):
            self.drop(pair)
        for one in (self.listener, self.closing, self.wake):
            one.close()


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


class Engine(EngineCase):
    def setUp(self):
        super().setUp()
        self.write("held.toml", HELD)
        self.port = free_port()
        self.assertEqual(self.call("keygen", "keys").returncode, 0)

    def coordinator(self, spec="held.toml", database="x.db", verbose=False, **options):
        arguments = ["coordinator", spec, "--bind", f"tcp://127.0.0.1:{self.port}", "--db", database, "--keys", "keys"]
        # To a file: nobody reads a pipe while a test waits for something else.
        log = open(self.path("coordinator.log"), "a")
        process = subprocess.Popen([FATMC, *arguments, *(["--verbose"] if verbose else [])], cwd=self.cwd,
                                   stdout=log, stderr=log, **options)
        log.close()
        self.started.append(process)
        return process

    def log(self):
        with open(self.path("coordinator.log")) as file:
            return file.read()

    def worker(self, port=None, program=WORKER, keys="keys", jobs=1, **environment):
        process = subprocess.Popen([program, "--connect", f"tcp://127.0.0.1:{port or self.port}", "--keys", keys,
                                    "--jobs", str(jobs)],
                                   cwd=self.cwd, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True,
                                   env={**os.environ, **environment})
        self.started.append(process)
        return process

    def is_in(self, worker, hold):
        """Whether that worker is in the trial that waits for this file."""
        return os.path.exists(self.path(f"{hold}.{worker.pid}"))

    def held_reference(self):
        result = self.call("run", "held.toml", "--db", "held_reference.db", "--workers", "1")
        self.assertEqual(result.returncode, 0, result.stderr)
        return self.digest("held_reference.db")

    def done(self, coordinator, reference, database="x.db"):
        self.assertEqual(coordinator.wait(timeout=LIMIT_S), 0, self.log())
        self.assertEqual(self.digest(database), reference)

    def worker_in_held_trial(self, **options):
        """A coordinator, and its first worker in the middle of trial 5."""
        self.write("hold", "")
        self.write("last", "")
        coordinator = self.coordinator(**options)
        first = self.worker()
        until(lambda: self.is_in(first, "hold"), "the first worker is in the trial that waits")
        return coordinator, first

    def test_the_trial_of_a_worker_killed_in_its_middle_is_done_by_another(self):
        reference = self.held_reference()
        coordinator, first = self.worker_in_held_trial()
        second = self.worker()
        first.kill()
        os.remove(self.path("hold"))
        os.remove(self.path("last"))
        self.done(coordinator, reference)
        self.assertEqual(self.rows("x.db", "SELECT pid FROM trials WHERE repetition = 5"), [(second.pid,)])
        self.assertEqual(second.wait(timeout=LIMIT_S), 0)

    def late_result(self, reference, expected, **environment):
        """The first worker is silent in mid-trial, another does its trial, then the first comes back with a row."""
        self.write("hold", "")
        self.write("last", "")
        coordinator = self.coordinator(verbose=True)
        first = self.worker(**environment)
        until(lambda: self.is_in(first, "hold"), "the first worker is in the trial that waits")
        first.send_signal(signal.SIGSTOP)
        second = self.worker(jobs=2)  # one waits in the last trial while the other does what the first had
        os.remove(self.path("hold"))
        until(lambda: self.is_in(second, "last"), "the second has done all but the last trial")
        until(lambda: self.stored("x.db") == 39, "and they are stored")
        first.send_signal(signal.SIGCONT)
        until(lambda: self.is_in(first, "last"), "the first is back, and idle enough for a copy of the last trial")
        os.remove(self.path("last"))
        self.done(coordinator, reference)
        self.assertIn(expected, self.log())

    def test_a_stopped_worker_hangs_nothing_and_its_late_result_is_a_duplicate(self):
        self.late_result(self.held_reference(), "no word for 900 ms")
        self.assertRegex(self.log(), r"duplicates [1-9][0-9]*, conflicts 0")

    def test_a_late_result_that_differs_is_an_alarm_and_the_stored_one_stays(self):
        self.late_result(self.held_reference(), "ALARM", FATMC_TEST_WRONG_AT="5")
        self.assertRegex(self.log(), r"conflicts 1")

    def test_a_worker_cut_off_from_the_network_hangs_nothing_and_comes_back(self):
        reference = self.held_reference()
        self.write("hold", "")
        self.write("last", "")
        coordinator = self.coordinator()
        proxy = Proxy(self.port)
        self.addCleanup(proxy.close)
        first = self.worker(port=proxy.port)
        until(lambda: self.is_in(first, "hold"), "the first worker is in the trial that waits")
        proxy.cut()
        second = self.worker(jobs=2)
        os.remove(self.path("hold"))
        until(lambda: self.is_in(second, "last"), "the second has done all but the last trial")
        proxy.heal()
        until(lambda: self.is_in(first, "last"), "the first is back, and idle enough for a copy of the last trial")
        os.remove(self.path("last"))
        self.done(coordinator, reference)
        self.assertEqual(first.wait(timeout=LIMIT_S), 0)

    def test_a_coordinator_that_was_stopped_at_the_end_still_sees_its_workers_off(self):
        # The worker takes the connection for dead and makes another while the coordinator has its last row unread:
        # BYE must come through the new one. So it is when the last commit takes seconds on a slow disk.
        reference = self.held_reference()
        self.write("last", "")
        coordinator = self.coordinator(verbose=True)
        worker = self.worker()
        until(lambda: self.is_in(worker, "last"), "the worker is in the last trial")
        until(lambda: self.stored("x.db") == 39, "all others are stored")
        coordinator.send_signal(signal.SIGSTOP)
        os.remove(self.path("last"))
        self.assertIn("no word from", worker.stderr.readline())
        coordinator.send_signal(signal.SIGCONT)
        self.done(coordinator, reference)
        self.assertEqual(worker.wait(timeout=LIMIT_S), 0)
        self.assertNotIn("is dead", self.log(), "the coordinator was away, not the worker")

    def test_damaged_bytes_cost_a_connection_and_no_result(self):
        reference = self.reference_digest()
        coordinator = self.coordinator(spec="spec.toml", verbose=True)
        proxy = Proxy(self.port, damage_at=(3000, 12000, 25000))
        self.addCleanup(proxy.close)
        self.worker(port=proxy.port)  # may miss the BYE, and would wait for another coordinator
        self.done(coordinator, reference)
        self.assertEqual(proxy.damage_at, [], "all three were to be damaged")
        self.assertIn("conflicts 0", self.log())

    def test_a_worker_that_is_slow_beyond_measure_delays_nothing(self):
        reference = self.held_reference()
        coordinator = self.coordinator()
        slow = self.worker(FATMC_TEST_SLOWNESS="1e9")
        until(lambda: glob.glob(self.path("slow.*")), "the slow one is in its first trial")
        self.worker()
        self.done(coordinator, reference)
        self.assertEqual(self.rows("x.db", f"SELECT count(*) FROM trials WHERE pid = {slow.pid}"), [(0,)])

    def test_a_coordinator_killed_between_commits_again_and_again_loses_and_repeats_nothing(self):
        self.write("many.toml", SPEC.replace("repetitions = 120", "repetitions = 6000").replace("= 1000000\n", "= 100\n"))
        result = self.call("run", "many.toml", "--db", "many_reference.db", "--workers", "1")
        self.assertEqual(result.returncode, 0, result.stderr)
        workers = [self.worker(), self.worker()]
        for _ in range(5):
            before = self.stored("x.db")
            coordinator = self.coordinator(spec="many.toml")
            until(lambda: self.stored("x.db") > before + 300 or coordinator.poll() is not None, "rows are committed")
            coordinator.kill()
            coordinator.wait()
        self.done(self.coordinator(spec="many.toml"), self.digest("many_reference.db"))
        for worker in workers:
            self.assertEqual(worker.wait(timeout=LIMIT_S), 0, "standalone workers live through it all")

    def test_a_full_disk_pauses_the_run_and_room_lets_it_go_on(self):
        reference = self.reference_digest()
        # SIGXFSZ stays ignored, as Python has it: a write beyond the limit is then an error like a full disk.
        coordinator = self.coordinator(spec="spec.toml", restore_signals=False)
        worker = self.worker()
        until(lambda: self.stored("x.db") > 10, "some trials are stored")
        limits = resource.prlimit(coordinator.pid, resource.RLIMIT_FSIZE)
        resource.prlimit(coordinator.pid, resource.RLIMIT_FSIZE, (8192, limits[1]))
        until(lambda: "the database cannot be written" in self.log(), "the coordinator notices")
        full = self.stored("x.db")
        self.assertLess(full, 180)
        self.assertIsNone(coordinator.poll())
        resource.prlimit(coordinator.pid, resource.RLIMIT_FSIZE, limits)
        self.done(coordinator, reference)
        self.assertIn("takes rows again", self.log())
        self.assertEqual(worker.wait(timeout=LIMIT_S), 0)

    def test_a_clock_that_jumps_by_days_changes_nothing(self):
        library = next(iter(glob.glob("/usr/lib/*/faketime/libfaketime.so.1")), None)
        if not library:
            self.skipTest("libfaketime is not installed")
        reference = self.reference_digest()
        self.write("clock", "+0")
        environment = {"LD_PRELOAD": library, "FAKETIME_TIMESTAMP_FILE": self.path("clock"), "FAKETIME_NO_CACHE": "1",
                       "FAKETIME_DONT_FAKE_MONOTONIC": "1"}
        coordinator = self.coordinator(spec="spec.toml", env={**os.environ, **environment})
        worker = self.worker(**environment)
        for jump in ("+1d", "-1d", "+2d"):
            before = self.stored("x.db")
            until(lambda: self.stored("x.db") > before + 20, "trials are stored")
            with open(self.path("clock.new"), "w") as file:
                file.write(jump)
            os.rename(self.path("clock.new"), self.path("clock"))
        self.done(coordinator, reference)
        self.assertEqual(worker.wait(timeout=LIMIT_S), 0)
        days = self.rows("x.db", "SELECT count(DISTINCT started_us / 86400000000) FROM trial")[0][0]
        self.assertGreaterEqual(days, 3, "the clock was to jump")

    def test_a_worker_of_another_build_is_refused_and_the_others_work_on(self):
        reference = self.reference_digest()
        coordinator = self.coordinator(spec="spec.toml")
        other = self.worker(program=OTHER_WORKER)
        _, errors = other.communicate(timeout=LIMIT_S)
        self.assertEqual(other.returncode, 2)
        self.assertRegex(errors, "refused: the worker's build [0-9a-z]* is not the coordinator's")
        self.assertEqual(self.stored("x.db"), 0)
        self.worker()
        self.done(coordinator, reference)

    def test_keys_decide_who_gets_in(self):
        reference = self.reference_digest()
        self.assertEqual(self.call("keygen", "others").returncode, 0)
        os.mkdir(self.path("mixed"), 0o700)
        for folder, name in (("others", "worker.key"), ("keys", "coordinator.pub")):
            with open(self.path(f"{folder}/{name}")) as source:
                text = source.read()
            with open(os.open(self.path(f"mixed/{name}"), os.O_WRONLY | os.O_CREAT, 0o600), "w") as file:
                file.write(text)
        coordinator = self.coordinator(spec="spec.toml")
        stranger = self.worker(keys="mixed")
        _, errors = stranger.communicate(timeout=LIMIT_S)
        self.assertEqual(stranger.returncode, 2)
        self.assertIn("does not admit this worker's key", errors)
        plain = subprocess.run([WORKER, "--connect", f"tcp://127.0.0.1:{self.port}"], cwd=self.cwd,
                               capture_output=True, text=True, timeout=LIMIT_S)
        self.assertEqual(plain.returncode, 2)
        self.assertIn("wants keys", plain.stderr)
        misled = self.worker(keys="others")
        self.assertIn("no word from", misled.stderr.readline())
        self.assertIsNone(misled.poll(), "the right coordinator may still come")
        self.assertEqual(self.stored("x.db"), 0)
        self.worker()
        self.done(coordinator, reference)

    def test_keys_that_others_may_read_are_refused(self):
        os.chmod(self.path("keys/worker.key"), 0o644)
        worker = self.worker()
        _, errors = worker.communicate(timeout=LIMIT_S)
        self.assertEqual(worker.returncode, 2)
        self.assertIn("worker.key: may be read or written by others, write chmod 600", errors)
        os.chmod(self.path("keys/coordinator.key"), 0o640)
        result = self.call("coordinator", "spec.toml", "--bind", "tcp://127.0.0.1:*", "--db", "y.db", "--keys", "keys")
        self.assertEqual(result.returncode, 2)
        self.assertIn("coordinator.key: may be read", result.stderr)
        self.assertFalse(os.path.exists(self.path("y.db")))
        again = self.call("keygen", "keys")
        self.assertEqual(again.returncode, 2)
        self.assertIn("is not overwritten", again.stderr)


if __name__ == "__main__":
    unittest.main(verbosity=2)
