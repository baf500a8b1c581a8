#!/usr/bin/python3
"""fatmc estimate, noise and design as a user runs them: fields, and bad input as one line with a remedy.

Usage: estimate_command.py FATMC
"""
import csv
import json
import math
import os
import random
import subprocess
import sys
import tempfile

fatmc = sys.argv[1]
folder = tempfile.TemporaryDirectory()
count = 0
PERIOD, PERIODS, RATE = 400, 3, 50.0
LINES = list(range(5, 65))


def write(name, columns, roles, extra=""):
    path = os.path.join(folder.name, name + ".csv")
    with open(path, "w", encoding="utf-8") as file:
        file.write(",".join(columns) + "\n")
        for row in zip(*columns.values()):
            file.write(",".join(repr(v) for v in row) + "\n")
    with open(path[:-3] + "toml", "w", encoding="utf-8") as file:
        file.write(f"[record]\nrate_hz = {RATE}\n")
        for role, names in roles.items():
            file.write(f"{role} = {json.dumps(names)}\n")
        file.write(extra)
    return path


def multisine(rng, lines=LINES, phases=None):
    phases = phases or [2 * math.pi * rng.random() for _ in lines]
    one = [sum(math.cos(2 * math.pi * k * n / PERIOD + p) for k, p in zip(lines, phases)) for n in range(PERIOD)]
    return one * PERIODS, phases


def noisy(rng, x, deviation):
    return [v + rng.gauss(0.0, deviation) for v in x]


PERIODIC = f"period_samples = {PERIOD}\nexcited_lines = {LINES}\n"


def record(name, seed=1, same=False, noise=0.05, input_noise=0.02, second=1.0, extra=PERIODIC):
    """Two inputs, two outputs, static gains, references r1 and r2."""
    rng = random.Random(seed)
    r1, phases = multisine(rng)
    r2, _ = multisine(rng, phases=phases if same else None)
    u1, u2 = noisy(rng, r1, input_noise), noisy(rng, [second * v for v in r2], input_noise)
    y1 = noisy(rng, [2 * a - b for a, b in zip(u1, u2)], noise)
    y2 = noisy(rng, [a + 0.5 * b for a, b in zip(u1, u2)], noise)
    return write(name, {"r1": r1, "r2": r2, "u1": u1, "u2": u2, "y1": y1, "y2": y2},
                 {"reference": ["r1", "r2"], "input": ["u1", "u2"], "output": ["y1", "y2"]}, extra)


def run(*arguments, command="estimate"):
    return subprocess.run([fatmc, command, *arguments], capture_output=True, text=True)


def finite(value):
    if isinstance(value, float):
        assert math.isfinite(value)
    for item in value.values() if isinstance(value, dict) else value if isinstance(value, list) else []:
        finite(item)


def estimated(*arguments):
    global count
    count += 1
    out = os.path.join(folder.name, f"out{count}")
    done = run(*arguments, "-o", out)
    assert done.returncode == 0, done
    with open(os.path.join(out, "frm.csv"), encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    for row in rows:
        for key in ("re", "im", "variance"):
            assert math.isfinite(float(row[key])), row
    with open(os.path.join(out, "estimate.json"), encoding="utf-8") as file:
        info = json.load(file)
    finite(info)
    return info, rows, done.stdout


def refused(words, *arguments, command="estimate"):
    out = os.path.join(folder.name, "refused")
    done = run(*arguments, "-o", out, command=command)
    assert done.returncode == 2, done
    assert done.stderr.count("\n") == 1 and done.stdout == "", done
    for word in words:
        assert word in done.stderr, (word, done.stderr)
    assert not os.path.exists(out), "half written"


good = record("good")

# Every method says q, n_E (null where meaningless), conditions and border lines.
single = random.Random(7)
r, _ = multisine(single)
siso = write("siso", {"u": noisy(single, r, 0.02), "y": noisy(single, [3 * v for v in r], 0.1)}, {"input": ["u"], "output": ["y"]},
             PERIODIC)
several = [record(f"several{i}", seed=20 + i) for i in range(3)]
for method, records, windowed in (("lpm", [good], True), ("lrm", [good], True), ("arbitrary", [good], True), ("welch", [good], False),
                                  ("robust", several, False), ("tlpm", [siso], False), ("etfe", [siso], False)):
    info, rows, text = estimated(*records, "--method", method)
    assert info["q"] >= 1 and (info["n_e"] is not None) == windowed, info
    assert len(info["regressor_condition"]) == len(info["lines"]) + len(info["lines_without_estimate"])
    assert all(value is None or value >= 1 - 1e-9 for value in info["regressor_condition"]), (method, info["regressor_condition"])
    assert bool(info["border_lines"]) == windowed, method
    assert "condition" in text and "border lines" in text, text
    kinds = {(row["level"], row["kind"]): row["radius"] for row in info["confidence"] or []}
    assert (method == "lrm") == (not kinds)
    if kinds and kinds[0.95, "joint"]:
        assert kinds[0.95, "univariate"] <= kinds[0.95, "bonferroni"]
        assert kinds[0.95, "joint"] == kinds[0.95, "simultaneous"] > kinds[0.95, "univariate"] - 1e-9

info, rows, text = estimated(good, "--bias-variants")
radius = {(row["level"], row["kind"]): row["radius"] for row in info["confidence"]}
assert abs(radius[0.95, "univariate"] ** 2 - info["q"] * (0.05 ** (-1 / info["q"]) - 1)) < 1e-12
assert len(info["input_snr_db"]) == 60 and info["low_snr_lines"] == [] and "input SNR of u1" in text
assert info["noise"]["channels"] == ["y1", "y2", "u1", "u2"] and len(info["noise"]["deviation"][0]) == 4
assert abs(sorted(d[2] for d in info["noise"]["deviation"])[30] / 0.02 - 1) < 0.3
assert len(info["nonlinear_distortion"]["output_ratio"]) == 60
assert set(info["three_db_hz"]) == {"linear_dropped", "linear_kept"}
assert set(info["bias_variants"]) == {"exact_offsets", "limit", "printed"}
assert abs(info["bias_variants"]["limit"]["constant"][0] - 3 / 35) < 1e-12
for k, row in enumerate(info["bias_variants"]["exact_offsets"]["bias"]):
    for i in range(2):
        for j in range(2):
            assert abs(row[i][j] - float(rows[4 * k + 2 * i + j]["bias"])) < 1e-15
assert "uneven" in info["conventions"]["bias"]

# A noisy input is an outcome with a reason, not a refusal.
info, rows, text = estimated(record("faint", input_noise=8.0))
assert info["low_snr_lines"] and "below 20 dB" in text and "more periods" in text, text

# What cannot be estimated is refused in one line that says what would mend it.
refused(["n-e", "no degree of freedom", "n_E >= 3"], good, "--n-e", "2")
refused(["n-e", "60 excited lines"], good, "--n-e", "40")
refused(["r1 and r2", "phases of its own"], record("same", same=True))
for method in ("tlpm", "etfe"):
    refused(["one experiment"], good, "--method", method)
silent = random.Random(8)
for method in ("tlpm", "etfe"):
    r, _ = multisine(silent, [k for k in LINES if k != 20])
    refused(["line 20", "not excited", "excited_lines"],
            write("silent", {"u": r, "y": [3 * v for v in r]}, {"input": ["u"], "output": ["y"]}, PERIODIC), "--method", method)
quiet = record("quiet", second=0.0, input_noise=0.0)
refused(["u2"], quiet)  # a channel that does not move
refused(["follow the references"], record("still", second=1e-18, input_noise=0.0, noise=0.0))
refused(["segment"], good, "--segment", "5000", command="noise")

# Stability: the controller's size and the nominal model's stability.
plant = os.path.join(folder.name, "plant.toml")
with open(plant, "w", encoding="utf-8") as file:
    file.write('kind = "state_space"\nrate_hz = 50.0\ninputs = ["u1", "u2"]\noutputs = ["y1", "y2"]\nA = [[1.2]]\nB = [[1.0, 0.0]]\n'
               "C = [[1.0], [0.0]]\nD = [[0.0, 0.0], [0.0, 0.0]]\n")
wrong = record("wrong", extra=PERIODIC + "controller_gain = [[0.1, 0.0, 0.0], [0.0, 0.1, 0.0], [0.0, 0.0, 0.1]]\n")
refused(["controller_gain", "2"], wrong, "--nominal", plant, command="stability")
right = record("right", extra=PERIODIC + "controller_gain = [[0.1, 0.0], [0.0, 0.1]]\n")
refused(["stable"], right, "--nominal", plant, command="stability")

# Noise of a record with fixed controls.
calm = random.Random(3)
still = write("calm", {"u": noisy(calm, [0.0] * 4000, 0.1), "y": noisy(calm, [0.0] * 4000, 0.3)}, {"input": ["u"], "output": ["y"]})
out = os.path.join(folder.name, "noise")
done = run(still, "--segment", "100", "-o", out, command="noise")
assert done.returncode == 0 and "40 segments" in done.stdout, done
with open(os.path.join(out, "noise.csv"), encoding="utf-8") as file:
    rows = list(csv.DictReader(file))
y = [float(row["deviation"]) ** 2 for row in rows if row["channel"] == "y"]
assert len(y) == 49 and abs(sum(y) / len(y) / 0.09 - 1) < 0.1, sum(y) / len(y)

# Design: Table 3-1's short period, the shipped experiments.
done = run("--mode", "0.484,0.665", "--format", "json", command="design")
assert done.returncode == 0, done
mode = json.loads(done.stdout)["modes"][0]
assert abs(mode["duration_table_3_1_s"] - 14.64) < 0.01 and mode["uniform"]["exact"] < 0.0857
crest = {}
for name in ("chapter5", "zippered"):
    done = run("--experiment", f"campaigns/experiments/{name}.toml", "--model", "campaigns/models/fat.toml", "--format", "json",
               command="design")
    assert done.returncode == 0, done
    experiment = json.loads(done.stdout)["experiment"]
    crest[name] = [axis["crest_factor"] for axis in experiment["axes"]]
    assert (experiment["phase_correlation"] is None) == (name == "zippered")
assert max(crest["zippered"]) < 2.5 < 3.0 < min(crest["chapter5"]), crest  # random phases: 3.3 to 3.5
for arguments, word in ((["--mode", "0.3"], "F0,DAMPING"), ([], "nothing to work on"),
                        (["--experiment", "campaigns/experiments/chapter5.toml"], "--model")):
    done = run(*arguments, command="design")
    assert done.returncode == 2 and done.stderr.count("\n") == 1 and word in done.stderr, done

print("estimate, noise and design: as described")
