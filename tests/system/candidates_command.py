#!/usr/bin/python3
"""fatmc candidates, export, identify, select, stability: from flights to a nominal model. Usage: candidates_command.py FATMC

A system of two inputs and two outputs whose matrices are known flies twice: with noise as input for identification, and in a loop
with periodic references for the judgement of its stability. The identified model is the nominal model of that judgement.
"""
import json
import os
import subprocess
import sys
import tempfile
import tomllib

import numpy as np

fatmc = os.path.abspath(sys.argv[1])
folder = tempfile.TemporaryDirectory()


def path(name):
    return os.path.join(folder.name, name)


def run(*arguments, code=0):
    done = subprocess.run([fatmc, *arguments], capture_output=True, text=True)
    assert done.returncode == code, done
    return done


def refused(words, *arguments):
    done = run(*arguments, code=2)
    assert done.stderr.count("\n") == 1, done.stderr
    for word in words:
        assert word in done.stderr, (word, done.stderr)


def model(name):
    with open(path(name), "rb") as f:
        return {key: np.array(value) if key in "ABC" else value for key, value in tomllib.load(f).items()}


# The study in its smallest size, its report, and a model of it as a file.
db = path("candidates.db")
run("candidates", "campaigns/candidates/spec.toml", "--size", "ci", "--db", db)
rows = json.loads(run("tables", db, "--format", "json").stdout)
medians = [row for row in rows if row["table"] == "Fig. 4" and row["quantity"] == "median"]
assert len(medians) == 2 * 13 and all(row["n"] == 15 and 0.5 < row["value"] < 1.0 for row in medians), medians
report = path("report.html")
run("report", db, "-o", report)
with open(report, encoding="utf-8") as f:
    page = f.read()
for figure in ("Fig. 2", "Fig. 3", "Fig. 4", "Fig. 5", "Figs. 6, 7", "Fig. 8", "Fig. 9", "Fig. 10", "Fig. 11", "Fig. 12"):
    assert figure + "," in page, figure
told = run("export", db, "--model", "60,40,18", "-o", path("candidate.toml")).stdout
assert "p 60, f 40, n 18" in told
candidate = model("candidate.toml")
assert candidate["A"].shape == (18, 18) and candidate["B"].shape == (18, 4) and candidate["C"].shape == (8, 18)
assert candidate["outputs"][3] == "p" and candidate["rate_hz"] == 25.0
s = np.log(np.linalg.eigvals(candidate["A"])) * 25.0
# The lead-lag mode of campaigns/models/actfhs_60kt.toml to a tenth: these windows are short.
assert min(abs(s - (-0.45 + 11.94j))) < 1.2, s
run("export", db, "--cell", "SCAS closed", "-o", path("best.toml"))
refused(["--model", "is not among the models"], "export", db, "--model", "61,40,18", "-o", path("no.toml"))
refused(["--model", "is not kept"], "export", db, "--model", "60,40,13", "-o", path("no.toml"))
refused(["--cell", "open loop"], "export", db, "--cell", "hover", "-o", path("no.toml"))
assert not os.path.exists(path("no.toml"))

# The flight test as records, and a model of the study beside one of them.
run("export", db, "--records", path("flights"))
assert sorted(os.listdir(path("flights")))[:2] == ["multistep-1.csv", "multistep-1.toml"] and len(os.listdir(path("flights"))) == 32
sweep = np.genfromtxt(path("flights/sweep-3.csv"), delimiter=",", names=True)
assert sweep.dtype.names == ("delta_x", "delta_y", "delta_p", "delta_0", "u", "v", "w", "p", "q", "r", "phi", "theta")
assert len(sweep) == 2485 and 5.0 < abs(sweep["delta_y"]).max() < 15.0  # 10 % at most, and the pulses that hold
run("diagnose", "--model", path("candidate.toml"), "--record", path("flights/sweep-3.csv"), "--holdout",
    path("flights/sweep-4.csv"), "-o", path("diagnosis"))
with open(path("diagnosis/diagnosis.json"), encoding="utf-8") as f:
    diagnosis = json.load(f)
assert diagnosis["verdict"] in ("named", "class", "unknown") and len(diagnosis["incoherent"]) == 8, diagnosis
run("diagnose", "--model", "campaigns/models/actfhs_60kt.toml", "--record", path("flights/sweep-3.csv"), "-o", path("truth"))
refused(["-o", "--records"], "export", db)

# Identification in open loop.
random = np.random.default_rng(1)
a = np.array([[0.9, 0.3, 0.0], [-0.3, 0.9, 0.0], [0.0, 0.1, 0.7]]) * 0.95
b = np.array([[0.2, 0.0], [0.1, 0.3], [0.0, 0.5]])
c = np.array([[1.0, 0.0, 0.3], [0.0, 1.0, 0.0]])
rate = 20.0


def fly(inputs_of, samples):
    x, rows = np.zeros(3), []
    for t in range(samples):
        y = c @ x + 0.01 * random.standard_normal(2)
        u = inputs_of(t, y)
        rows.append([*u, *y])
        x = a @ x + b @ u + 0.002 * random.standard_normal(3)
    return np.array(rows)


def write(name, header, values, meta):
    np.savetxt(path(name + ".csv"), values, delimiter=",", header=",".join(header), comments="")
    with open(path(name + ".toml"), "w", encoding="utf-8") as f:
        f.write("[record]\n" + f"rate_hz = {rate}\n" + meta)


roles = 'input = ["u1", "u2"]\noutput = ["y1", "y2"]\n'
open_loop = fly(lambda t, y: random.standard_normal(2), 2000)
write("open", ["u1", "u2", "y1", "y2"], open_loop, roles)
run("identify", path("open.csv"), "--past", "20", "--future", "20", "--order", "3", "--hold-back", "0.4", "-o", path("one"))
found = model("one/model.toml")
error = np.sort_complex(np.linalg.eigvals(found["A"])) - np.sort_complex(np.linalg.eigvals(a))
assert max(abs(error)) < 0.02, error

# Many windows and orders of the same record: their selection and spread.
told = run("select", path("open.csv"), "--pasts", "10,5,25", "--orders", "2,4", "--hold-back", "0.4", "--share", "0.5",
           "--smallest-norms", "0.8", "-o", path("many")).stdout
with open(path("many/candidates.json"), encoding="utf-8") as f:
    many = json.load(f)
assert many["models"] == 10 * 3 and [order["order"] for order in many["orders"]] == [2, 3, 4]  # f <= p: 1 + 2 + 3 + 4
three = many["orders"][1]
assert three["failed"] == 0 and len(three["candidates"]) == 5 and three["accepted"] == 8
assert all(c["norm"] <= three["limit"] for c in three["candidates"])
for output in three["outputs"]:
    assert output["median_variance_accounted_for"] > 99.0, output
    assert 0.0 <= output["covered_percent"] <= 100.0 and output["spread_rms"] < output["error_rms"], output
# Weights of the overall d1 (H 11): with the first output alone the best of an order need not be the best of both.
run("select", path("open.csv"), "--pasts", "10,5,25", "--orders", "3,3", "--hold-back", "0.4", "--weights", "2,0", "-o",
    path("first"))
with open(path("first/candidates.json"), encoding="utf-8") as f:
    weighted = json.load(f)["orders"][0]["candidates"][0]
run("identify", path("open.csv"), "--past", str(weighted["past"]), "--future", str(weighted["future"]), "--order", "3",
    "--hold-back", "0.4", "--weights", "2,0", "-o", path("again"))
with open(path("again/model.json"), encoding="utf-8") as f:
    validation = json.load(f)["validation"][0]
assert abs(validation["overall_agreement"] - validation["outputs"][0]["agreement"]) < 1e-12, validation
assert abs(validation["overall_agreement"] - weighted["agreement"]) < 1e-6, (validation, weighted)
refused(["--weights", "y1, y2"], "select", path("open.csv"), "--hold-back", "0.4", "--weights", "1", "-o", path("none"))
refused(["--weights", "at least one"], "identify", path("open.csv"), "--weights", "0,0", "-o", path("none"))
refused(["--hold-back"], "select", path("open.csv"), "-o", path("none"))
refused(["--pasts"], "select", path("open.csv"), "--hold-back", "0.4", "--pasts", "30,5,20", "-o", path("none"))
assert not os.path.exists(path("none"))

# The same system in a loop with known references, its stability about the identified models.
period, periods, gain = 400, 6, 0.2
lines = np.arange(3, 120, 3)
time = np.arange(period * periods)
reference = np.zeros((len(time), 2))
for column in range(2):
    for k in lines[column::2]:
        reference[:, column] += 0.3 * np.cos(2 * np.pi * k * time / period + 2 * np.pi * random.random())
closed = fly(lambda t, y: gain * (reference[t] - y), len(time))
write("closed", ["r1", "r2", "u1", "u2", "y1", "y2"], np.hstack([reference, closed]),
      roles + f'reference = ["r1", "r2"]\nperiod_samples = {period}\nperiods = {periods}\n'
      f"controller_gain = [[{gain}, 0.0], [0.0, {gain}]]\n")
for nominal in ("one/model.toml", "many/model.toml"):
    run("stability", path("closed.csv"), "--nominal", path(nominal), "-o", path("judged"))
    with open(path("judged/summary.json"), encoding="utf-8") as f:
        judged = json.load(f)
    assert judged["nominal_stable"], (nominal, judged)
print("ok")
