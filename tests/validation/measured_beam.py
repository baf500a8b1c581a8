#!/usr/bin/python3
"""The flexible beam with two inputs: four sweeps predict two other experiments. Usage: measured_beam.py FATMC

Data: FATMC_DATA/beam_ring_2x2; exits 77 (skipped) without. `fatmc estimate` of the sweeps and `fatmc predict` of the
validation records, beside numpy: the raw inverse Y U^-1 a bin, and the response of frm.csv applied by numpy.
"""
import csv
import json
import os
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

SAMPLES, RATE = 120000, 1000.0
BARS = {"rnd1": (99.24, 99.27), "rnd2": (99.71, 99.58)}  # what the raw inverse reaches, by the data set's README

fatmc = sys.argv[1]
source = pathlib.Path(os.environ.get("FATMC_DATA", "")) / "beam_ring_2x2"
if "FATMC_DATA" not in os.environ or not source.exists():
    print("skipped: the beam data set is not there, set FATMC_DATA to the folder that holds beam_ring_2x2")
    sys.exit(77)
folder = tempfile.TemporaryDirectory()
work = pathlib.Path(folder.name)
subprocess.run([sys.executable, "tests/support/beam_records.py", str(source), str(work)], check=True)
sweeps = ("sym1", "asym1", "sym2", "asym2")
done = subprocess.run([fatmc, "estimate", *(str(work / f"{name}.csv") for name in sweeps), "--method", "arbitrary", "--band", "0.3", "80",
                       "-o", str(work / "sweeps")], capture_output=True, text=True)
assert done.returncode == 0, done.stderr
print(done.stdout.splitlines()[1])
print(next(line for line in done.stdout.splitlines() if "by themselves" in line))


def spectra(name):
    samples = np.loadtxt(work / f"{name}.csv", delimiter=",", skiprows=1)
    bins = np.fft.rfft(samples, axis=0)[36:9601]  # 0.3 to 80 Hz
    return bins[:, :2], bins[:, 2:]


def vaf(response, name):
    u, y = spectra(name)
    error = y - np.einsum("kij,kj->ki", response, u)
    return 100.0 * (1.0 - (np.abs(error) ** 2).sum(0) / (np.abs(y) ** 2).sum(0))


U, Y = (np.stack(part) for part in zip(*(spectra(name) for name in sweeps)))
raw = np.zeros((U.shape[1], 2, 2), complex)
for pair in ((0, 1), (2, 3)):
    raw += np.moveaxis(Y[list(pair)], 0, -1) @ np.linalg.inv(np.moveaxis(U[list(pair)], 0, -1)) / 2


def smoothed(n):
    """One polynomial of degree 2 over 2 n + 1 bins of all sweeps, whether it fits or not."""
    lines = U.shape[1]
    window = np.clip(np.arange(lines), n, lines - 1 - n)[:, None] + np.arange(-n, n + 1)
    powers = ((window - np.arange(lines)[:, None]) / n)[:, :, None] ** np.arange(3)
    regressor = np.einsum("kws,ekwj->kewsj", powers, U[:, window]).reshape(lines, -1, 6)
    outputs = np.moveaxis(Y[:, window], 0, 1).reshape(lines, -1, 2)
    adjoint = np.conj(np.swapaxes(regressor, 1, 2))
    return np.swapaxes(np.linalg.solve(adjoint @ regressor, adjoint @ outputs)[:, :2], 1, 2)


for first in (0, 1):
    scatter = (np.abs(Y[first] - Y[first + 2]) ** 2).sum(0) / (2.0 * (np.abs(Y[first]) ** 2).sum(0))
    print(f"scatter between two {sweeps[first][:-1]} sweeps: {100 * scatter[0]:.2f} % of the energy in y1, {100 * scatter[1]:.2f} % in y2")
for n in (2, 4, 9):
    print(f"order 2 over {2 * n + 1} bins without a guard: " + ", ".join(f"{name} {vaf(smoothed(n), name).round(2)} %" for name in BARS))
estimated = np.zeros_like(raw)
with open(work / "sweeps" / "frm.csv", encoding="utf-8") as file:
    for row in csv.DictReader(file):
        at = int(row["line"]) - 36
        estimated[at, int(row["output"][1]) - 1, int(row["input"][1]) - 1] = complex(float(row["re"]), float(row["im"]))

for name, bars in BARS.items():
    out = work / f"predicted_{name}"
    done = subprocess.run([fatmc, "predict", str(work / f"{name}.csv"), "--response", str(work / "sweeps" / "frm.csv"), "-o", str(out)],
                          capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    outputs = json.loads((out / "prediction.json").read_text())["outputs"]
    ours = np.array([entry["vaf_percent"] for entry in outputs])
    inverse = vaf(raw, name)
    print(f"{name}: raw inverse {inverse[0]:.3f}/{inverse[1]:.3f} %, fatmc {ours[0]:.3f}/{ours[1]:.3f} % (bar {bars[0]}/{bars[1]} %)")
    assert np.all(np.abs(ours - vaf(estimated, name)) < 1e-8), "numpy predicts otherwise from the same response"
    assert np.all(ours >= bars), ours
    assert np.all(ours > inverse), "smoothing does not beat the raw inverse"
    # In time: the band-passed signals of predicted.csv tell the same share.
    series = np.loadtxt(out / "predicted.csv", delimiter=",", skiprows=1)
    for i in range(2):
        measured, predicted = series[:, 1 + 2 * i], series[:, 2 + 2 * i]
        in_time = 100.0 * (1.0 - ((measured - predicted) ** 2).sum() / (measured**2).sum())
        assert abs(in_time - ours[i]) < 1e-6, (in_time, ours[i])
