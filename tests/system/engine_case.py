"""What system tests of the engine share: a folder of their own, processes that end with the test, waiting."""
import os
import sqlite3
import subprocess
import tempfile
import time
import unittest

BIN = os.environ["FATMC_TEST_BIN"]
FATMC = os.path.join(BIN, "fatmc")
WORKER = os.path.join(BIN, "fatmc-worker")
LIMIT_S = 60

# Trials of about 2.5 and 25 ms, with failures among them: long enough to strike in mid-run.
SPEC = """
[campaign]
study = "engine_test"
name = "engine"
seed = 11

[[cell]]
name = "short"
repetitions = 120
work = 1000000
diverge_every = 10
array = 7

[[cell]]
name = "long"
repetitions = 60
work = 10000000
array = 3
"""


def until(condition, what):
    """Polls; the limit is there to end a broken run, not to measure one."""
    end = time.monotonic() + LIMIT_S
    while time.monotonic() < end:
        value = condition()
        if value:
            return value
        time.sleep(0.005)
    raise AssertionError(f"waited in vain until {what}")


def children(pid):
    try:
        with open(f"/proc/{pid}/task/{pid}/children") as file:
            return [int(word) for word in file.read().split()]
    except FileNotFoundError:
        return []


def is_alive(pid):
    try:
        with open(f"/proc/{pid}/stat") as file:
            return file.read().rsplit(")", 1)[1].split()[0] not in "ZX"
    except FileNotFoundError:
        return False


class EngineCase(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory(prefix="fatmc_engine_")
        self.cwd = self.folder.name
        self.started = []
        self.write("spec.toml", SPEC)

    def tearDown(self):
        for process in self.started:
            if process.poll() is None:
                process.kill()
            process.wait()
            for stream in (process.stdout, process.stderr):
                if stream:
                    stream.close()
        self.folder.cleanup()

    def write(self, name, text):
        with open(os.path.join(self.cwd, name), "w") as file:
            file.write(text)

    def path(self, name):
        return os.path.join(self.cwd, name)

    def call(self, *arguments):
        return subprocess.run([FATMC, *arguments], cwd=self.cwd, capture_output=True, text=True, timeout=LIMIT_S)

    def start(self, program, *arguments):
        process = subprocess.Popen([program, *arguments], cwd=self.cwd, stdout=subprocess.PIPE,
                                   stderr=subprocess.PIPE, text=True)
        self.started.append(process)
        return process

    def stored(self, database):
        try:
            connection = sqlite3.connect(f"file:{self.path(database)}?mode=ro", uri=True)
            try:
                return connection.execute("SELECT count(*) FROM trial").fetchone()[0]
            finally:
                connection.close()
        except sqlite3.OperationalError:
            return 0  # not yet made

    def rows(self, database, query):
        connection = sqlite3.connect(f"file:{self.path(database)}?mode=ro", uri=True)
        try:
            return connection.execute(query).fetchall()
        finally:
            connection.close()

    def payloads(self, database):
        """Every result by its key; what the digest covers, cell by cell."""
        return self.rows(database, "SELECT cell, repetition, outcome, content_hash FROM trial ORDER BY id")

    def digest(self, database):
        result = self.call("digest", database)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertRegex(result.stdout, r"\A[0-9a-f]{64}\n\Z")
        return result.stdout

    def reference_digest(self):
        result = self.call("run", "spec.toml", "--db", "reference.db", "--workers", "1")
        self.assertEqual(result.returncode, 0, result.stderr)
        return self.digest("reference.db")
