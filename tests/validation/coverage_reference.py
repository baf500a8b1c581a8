#!/usr/bin/python3
"""Table 5-5 again, by numpy from the arrays of a coverage database.

    coverage_reference.py FATMC             flies 12 trials and compares all shares with `fatmc tables --format json`
    coverage_reference.py FATMC --bias DB   experiment: coverage by rule (5.14) for other readings of the bias b

The second is the reason behind the verdicts of Table 5-5 (campaigns/coverage/README.md).
"""
import json
import pathlib
import subprocess
import sys
import tempfile

import numpy as np
from scipy import stats

from campaign_arrays import arrays

ROOT = pathlib.Path(__file__).resolve().parents[2]
LEVELS = (0.75, 0.90, 0.95, 0.99)


def shares(squares, limits):
    return [100 * np.mean(squares <= x) for x in limits]


def compare(fatmc):
    with tempfile.TemporaryDirectory() as folder:
        path = f"{folder}/coverage.db"
        subprocess.run([fatmc, "run", "campaigns/coverage/spec.toml", "--trials", "12", "--db", path], check=True,
                       cwd=ROOT, capture_output=True)
        table = json.loads(subprocess.run([fatmc, "tables", path, "--only", "5-5", "--format", "json"], check=True,
                                          cwd=ROOT, capture_output=True, text=True).stdout)
        a = arrays(path, "nonlinear")
    error = a["error_re"] + 1j * a["error_im"]
    n = len(error)
    sample = (error - error.mean(axis=0)) * np.sqrt(n / (n - 1))
    q, elements = 10, 9
    squares = {
        "without bias (5.13)": abs(error) ** 2,
        "extended, max(0, |e| - b)": np.maximum(0, abs(error) - a["bias"]) ** 2,
        "extended, |e| - b as printed (5.14)": (abs(error) - a["bias"]) ** 2,
        "extended, max(0, |e| - b), printed constant": np.maximum(0, abs(error) - a["bias_printed_constant"]) ** 2,
        "extended, |e| - b as printed, printed constant": (abs(error) - a["bias_printed_constant"]) ** 2,
        "error against the sample mean": abs(sample) ** 2,
    }
    worst, checked = 0.0, 0
    for row in table:
        level = float(row["row"].split()[0]) / 100
        quantity = row["quantity"]
        name = quantity.replace(", all elements of a line, Bonferroni", "").replace(", all elements of a line", "")
        ratio = squares[name] / a["variance"]
        if quantity.endswith("Bonferroni"):
            level = 1 - (1 - level) / elements
        if ", all elements" in quantity:
            ratio = ratio.reshape(n, -1, elements).max(axis=2)
        inside = ratio <= stats.f.ppf(level, 2, 2 * q)
        worst = max(worst, abs(100 * inside.mean() - row["value"]))
        runs = 100 * inside.reshape(n, -1).mean(axis=1)
        half = stats.t.ppf(0.975, n - 1) * runs.std(ddof=1) * np.sqrt(1 / 50 + 1 / n)
        worst = max(worst, abs(max(0, runs.mean() - half) - row["low"]), abs(min(100, runs.mean() + half) - row["high"]))
        checked += 1
    print(f"{checked} rows, largest difference {worst:.2e} points")
    return 0 if checked == 40 and worst < 1e-6 else 1


def bias_experiment(fatmc, path):
    a = arrays(path, "nonlinear")
    model = json.loads(subprocess.run([fatmc, "linearize", "campaigns/models/fat.toml", "--format", "json"], check=True,
                                      cwd=ROOT, capture_output=True, text=True).stdout)["sampled"]
    A, B, C, D = (np.array(model[k]) for k in "ABCD")
    lines = np.array(sorted({57 + i for i in range(20)} | {76 + 2 * i for i in range(21)} | {116 + 14 * i for i in range(34)}))
    f = 0.005 * lines
    truth = np.array([C @ np.linalg.solve(np.exp(2j * np.pi * x * 0.02) * np.eye(len(A)) - A, B) + D for x in f])
    error = a["error_re"] + 1j * a["error_im"]
    estimate = (error + truth.reshape(-1)).reshape(len(error), len(f), 9)
    error, variance = error.reshape(estimate.shape), a["variance"].reshape(estimate.shape)
    limits = [stats.f.ppf(p, 2, 20) for p in LEVELS]

    def b_of(values, scale, index_distance, constant=3 / 35):
        """(2.145) with C.14: values = the estimate or its magnitude; distances in Hz or in line numbers."""
        out = np.zeros(estimate.shape)
        for k in range(len(f)):
            first = min(max(k - 9, 0), len(f) - 19)
            window = np.arange(first, first + 19)
            d = (window - k).astype(float) if index_distance else f[window] - f[k]
            g = np.linalg.pinv(np.vander(d, 3, increasing=True)) @ values[:, window].transpose(1, 0, 2).reshape(19, -1)
            ratio = np.abs(g[0] / g[2]).reshape(len(values), 9)
            width = 2 * np.sqrt((1 - np.sqrt(0.5)) * ratio)
            span = 19.0 if index_distance else (f[window[-1]] - f[window[0]]) * 19 / 18
            out[:, k] = constant * scale * (span / width) ** 4 * abs(estimate[:, k])
        return out

    print("rule (|e| - b)^2 as printed | max(0, |e| - b)^2, at 75, 90, 95, 99 %;  print: 78.6 97.0 99.6 100")

    def show(name, b):
        printed = shares((abs(error) - b) ** 2 / variance, limits)
        disc = shares(np.maximum(0, abs(error) - b) ** 2 / variance, limits)
        print(f"{name:52s} " + " ".join(f"{x:6.1f}" for x in printed) + "  |" + " ".join(f"{x:6.1f}" for x in disc) +
              "   b/sigma at 5, 50, 95 %: " + " ".join(f"{x:.2f}" for x in np.quantile(b / np.sqrt(variance), (0.05, 0.5, 0.95))))

    show("b = 0", np.zeros(error.shape))
    show("stored: actual offsets", a["bias"].reshape(error.shape))
    for name, values in (("complex estimate", estimate), ("magnitude of the estimate", abs(estimate))):
        for index_distance in (False, True):
            for text, constant in (("3/35", 3 / 35), ("0.0318", 0.0318)):
                show(f"{name}, {'line numbers' if index_distance else 'Hz'}, {text}", b_of(values, 1.0, index_distance, constant))
    for factor in (1.0, 1.25, 1.5, 1.75, 2.0):
        show(f"b = {factor} sigma for every element", factor * np.sqrt(variance))
    return 0


if __name__ == "__main__":
    if len(sys.argv) == 2:
        sys.exit(compare(sys.argv[1]))
    if len(sys.argv) == 4 and sys.argv[2] == "--bias":
        sys.exit(bias_experiment(sys.argv[1], sys.argv[3]))
    sys.exit(__doc__)
