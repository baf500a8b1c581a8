#!/usr/bin/python3
"""fatmc diagnose with a linear model: nothing missing, a missing coupling, noise, an unstable plant. Usage: ... FATMC

The plants are simulated here, sampled by scipy's matrix exponential; what the repaired response says is held against theirs.
"""
import csv
import json
import os
import subprocess
import sys
import tempfile

import numpy as np
from scipy.linalg import expm

fatmc = os.path.abspath(sys.argv[1])
folder = tempfile.TemporaryDirectory()
rate, samples = 20.0, 4000
random = np.random.default_rng(1)

# Continuous: y1 of u1 through an oscillation, y2 of u2 through a lag, and, in the truth, of u1 through another.
A = np.array([[-0.5, 4.0, 0.0, 0.0], [-4.0, -0.5, 0.0, 0.0], [0.0, 0.0, -2.0, 0.0], [0.0, 0.0, 0.0, -6.0]])
B = np.array([[1.0, 0.0], [0.5, 0.0], [0.0, 2.0], [3.0, 0.0]])
C = np.array([[1.0, 0.0, 0.0, 0.0], [0.0, 0.0, 1.0, 1.0]])
without = C.copy()
without[1, 3] = 0.0


def path(name):
    return os.path.join(folder.name, name)


def sampled(a, b):
    block = np.zeros((len(a) + b.shape[1],) * 2)
    block[:len(a), :len(a)], block[:len(a), len(a):] = a, b
    block = expm(block / rate)
    return block[:len(a), :len(a)], block[:len(a), len(a):]


def fly(name, a, b, c, noise, start=0.0):
    phi, gamma = sampled(a, b)
    x, u = np.full(len(a), start), random.standard_normal((samples, 2))
    rows = []
    for t in range(samples):
        rows.append([*u[t], *(c @ x + 3.0 + noise * random.standard_normal(2))])
        x = phi @ x + gamma @ u[t]
    np.savetxt(path(name + ".csv"), rows, delimiter=",", header="u1,u2,y1,y2", comments="")
    with open(path(name + ".toml"), "w", encoding="utf-8") as f:
        f.write(f'[record]\nrate_hz = {rate}\ninput = ["u1", "u2"]\noutput = ["y1", "y2"]\n')
    return path(name + ".csv")


def model(name, a, b, c, head):
    text = 'kind = "state_space"\n' + head + 'inputs = ["u1", "u2"]\noutputs = ["y1", "y2"]\n'
    for key, values in (("A", a), ("B", b), ("C", c)):
        text += f"{key} = {np.asarray(values).tolist()}\n"
    with open(path(name), "w", encoding="utf-8") as f:
        f.write(text)
    return path(name)


def diagnose(name, model_file, *arguments):
    done = subprocess.run([fatmc, "diagnose", "--model", model_file, *arguments, "-o", path(name)],
                          capture_output=True, text=True)
    assert done.returncode == 0, done
    with open(path(name + "/diagnosis.json"), encoding="utf-8") as f:
        return json.load(f), done.stdout


def refused(words, model_file, record):
    done = subprocess.run([fatmc, "diagnose", "--model", model_file, "--record", record, "-o", path("none")],
                          capture_output=True, text=True)
    assert done.returncode == 2 and done.stderr.count("\n") == 1, done
    for word in words:
        assert word in done.stderr, (word, done.stderr)
    assert not os.path.exists(path("none"))


record, other = fly("record", A, B, C, 0.005, 1.0), fly("other", A, B, C, 0.005)
continuous = 'time = "continuous"\n'
discrete = f"rate_hz = {rate}\n"

# The truth, given as it is and sampled: nothing is missing, although the record begins away from rest.
for name, matrices, head in (("continuous", (A, B), continuous), ("discrete", sampled(A, B), discrete)):
    found, _ = diagnose(name, model(name + ".toml", *matrices, C, head), "--record", record, "--holdout", other)
    assert found["verdict"] == "none" and not found["effects"] and not found["where"], found
    assert 0.7 < found["gap"]["training"]["before"] < 1.3 and 0.7 < found["gap"]["holdout"]["before"] < 1.3, found["gap"]

# Without the coupling of u1 into y2: it is named, and its response given.
found, told = diagnose("coupling", model("coupling.toml", A, B, without, continuous), "--record", record, "--holdout", other)
assert found["verdict"] == "named", told
assert [effect["name"] for effect in found["effects"]] == ["cross_coupling:output=y2,input=u1"], told
assert all((place["output"], place["input"]) == ("y2", "u1") for place in found["where"]) and found["where"]
gap = found["gap"]
# What stays is mostly the start and end of the state that the model does not show.
assert all(gap[part]["before"] > 100.0 and gap[part]["after"] < 0.01 * gap[part]["before"] for part in gap), gap
phi, gamma = sampled(A, B)
errors = []
with open(path("coupling/frm.csv"), encoding="utf-8") as f:
    for row in csv.DictReader(f):
        if (row["output"], row["input"]) != ("y2", "u1"):
            continue
        z = np.exp(2j * np.pi * float(row["frequency_hz"]) / rate)
        wanted = (C @ np.linalg.solve(z * np.eye(4) - phi, gamma))[1, 0]
        errors.append(abs(complex(float(row["re"]), float(row["im"])) / wanted - 1.0))
assert len(errors) > 1000 and np.median(errors) < 0.1, (len(errors), np.median(errors))

# An element that is there but wrong.
wrong = B.copy()
wrong[2, 1] *= 0.7
found, told = diagnose("wrong", model("wrong.toml", A, wrong, C, continuous), "--record", record)
assert [effect["name"] for effect in found["effects"]] == ["element_error:output=y2,input=u2"], told

# A plant that grows 30-fold over the record is compared like any other.
unstable = A.copy()
unstable[2, 2] = np.log(30.0) / (samples / rate)
found, told = diagnose("unstable", model("unstable.toml", unstable, B, C, continuous), "--record",
                       fly("grown", unstable, B, C, 0.02, 0.5))
assert found["verdict"] == "none", told

# Noise as large as the answer is no response to the inputs.
found, told = diagnose("noise", path("continuous.toml"), "--record", fly("noisy", A, B, C, 1.0))
assert found["verdict"] == "unknown" and any(entry["unknown"] for entry in found["incoherent"]), told

refused(["rate_hz", "40 Hz"], model("fast.toml", *sampled(A, B), C, "rate_hz = 40.0\n"), record)
refused(["rate_hz", "continuous"], model("both.toml", A, B, C, continuous + discrete), record)
with open(path("coupling.toml"), encoding="utf-8") as f:
    text = f.read()
with open(path("names.toml"), "w", encoding="utf-8") as f:
    f.write(text.replace('"y2"', '"q"'))
refused(["y2", "outputs"], path("names.toml"), record)
print(f"response of the missing coupling within {100 * np.median(errors):.1f} % in the median of {len(errors)} bins")
