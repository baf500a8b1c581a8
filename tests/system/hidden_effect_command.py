#!/usr/bin/python3
"""A blind set as a campaign: two workers share a basis through a folder, one without it gives the same results, and the answers are
what they should be.

Usage: hidden_effect_command.py FATMC
"""
import json
import os
import subprocess
import sys
import tempfile

fatmc = sys.argv[1]
SPEC = "tests/support/blind_set.toml"
folder = tempfile.TemporaryDirectory()


def place(name):
    return os.path.join(folder.name, name)


def run(*arguments, cache):
    environment = dict(os.environ, FATMC_CACHE=cache)
    done = subprocess.run([fatmc, *arguments], capture_output=True, text=True, env=environment)
    assert done.returncode == 0, done
    return done.stdout


def table(database):
    rows = json.loads(run("tables", database, "--format", "json", cache=""))
    return {(row["row"], row["quantity"]): row for row in rows if row["table"] == "Hidden effects"}


run("run", SPEC, "--db", place("shared.db"), "--workers", "2", cache=place("cache"))
(host,) = os.listdir(place("cache"))
kept = [name for name in os.listdir(os.path.join(place("cache"), host)) if name.endswith(".basis")]
assert len(kept) == 1, f"one model, one experiment, one basis: {kept}"

# Without a folder the worker makes its own, and not a bit differs.
few = ["--trials", "2", "--workers", "1"]
run("run", SPEC, "--db", place("own.db"), *few, cache="")
run("run", SPEC, "--db", place("read.db"), *few, cache=place("cache"))
assert run("digest", place("own.db"), cache="") == run("digest", place("read.db"), cache="")
assert os.listdir(os.path.join(place("cache"), host)).count(kept[0]) == 1

rows = table(place("shared.db"))


def share(cell, quantity):
    row = rows[cell, quantity]
    return row["value"] / 100, row["n"]


# At a rate of 1 % five alarms of 60 come once in 3,000 sets. Single: 16 of a rate of 0.9 give fewer than 11 once in 60 sets, of a
# rate of 0.3 (a search that names at random among what it suspects) more than 10 once in 2,000; likewise unknown, 8 of 0.9.
alarms, n = share("null", "false alarm")
assert n == 60 and alarms * n < 5, rows["null", "false alarm"]
right, n = share("single", "right name")
assert n == 16 and right * n >= 11, rows["single", "right name"]
detected, n = share("single", "detected")
assert detected * n >= 15, rows["single", "detected"]
wrong, n = share("taken_out", "confident wrong name")
unknown, n = share("taken_out", "unknown flagged")
assert n == 8 and unknown * n >= 5 and wrong * n <= 2, (rows["taken_out", "unknown flagged"], rows["taken_out", "confident wrong name"])
for key in ("null", "single", "taken_out"):
    failed, n = share(key, "no answer")
    assert failed == 0.0, rows[key, "no answer"]

# The rows say in words what was hidden and what was answered.
details = run("query", place("shared.db"), "--sql", "SELECT detail FROM trials WHERE cell = 'single'", "--format", "csv", cache="")
lines = [line for line in details.splitlines()[1:] if line]
assert len(lines) == 16 and all("hidden " in line and "; answer " in line for line in lines), details

# What a trial was given is a record as a stranger's file holds it.
record = place("replayed.csv")
run("replay", place("shared.db"), "single/0", "-o", record, cache="")
with open(record) as file:
    assert file.readline().strip() == "t,r_p,r_q,r_r,xi_c,eta_c,zeta_c,p,q,r,phi,theta,V"
print(f"{n} trials a cell and more: false alarms {alarms:.2f}, right {right:.2f}, unknown flagged {unknown:.2f}")
