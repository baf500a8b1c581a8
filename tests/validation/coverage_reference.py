#!/usr/bin/python3
"""Table 5-5 again, by numpy from the arrays of a coverage database.

    coverage_reference.py FATMC             flies 12 trials and compares all shares with `fatmc tables --format json`
    coverage_reference.py FATMC --bias DB   experiment: coverage by rule (5.14) for other readings of the bias b
    coverage_reference.py FATMC --insensitivity
                                            experiment: Fig. 5-2, Dutch roll and zeros with other derivatives
    coverage_reference.py FATMC --extremes DB
                                            experiment: how often intervals for the smallest SNR of 50 runs hold, by law

The experiments are the reasons behind the verdicts of Table 5-5, Fig. 5-2 and 5.2.3 (campaigns/coverage/README.md).
"""
import json
import pathlib
import re
import sqlite3
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


def changed_model(factors):
    """campaigns/models/fat.toml with values of (table, key) multiplied."""
    out, table = [], ""
    for line in (ROOT / "campaigns/models/fat.toml").read_text(encoding="utf-8").splitlines():
        if match := re.match(r"\[(.*)\]", line):
            table = match.group(1)
        match = re.match(r"(\w+) = (-?[\d.e-]+)(.*)", line)
        if match and (table, match.group(1)) in factors:
            line = f"{match.group(1)} = {float(match.group(2)) * factors[table, match.group(1)]:.9g}{match.group(3)}"
        out.append(line)
    return "\n".join(out) + "\n"


def insensitivity_experiment(fatmc):
    """Largest 1/|H| from 0.05 to 5 Hz; Dutch roll and the slow pair of zeros of r/zeta_c beside it."""
    spec = (ROOT / "campaigns/experiments/chapter5.toml").read_text(encoding="utf-8")
    with tempfile.TemporaryDirectory() as folder:
        experiment, model = pathlib.Path(folder) / "wide.toml", pathlib.Path(folder) / "model.toml"
        experiment.write_text(re.sub(r"ranges_hz = \[.*?\n\]", "ranges_hz = [[0.05, 5.0, 0.01]]", spec, flags=re.S),
                              encoding="utf-8")

        def read(*words):
            return json.loads(subprocess.run([fatmc, *words, "--format", "json"], check=True, capture_output=True,
                                             text=True).stdout)

        for name, factors in (("as flown", {}), ("0.5 C_n_r", {("yaw", "r"): 0.5}), ("0.73 C_n_r", {("yaw", "r"): 0.73}),
                              ("0.73 C_n_r, 1.7 C_Y_beta", {("yaw", "r"): 0.73, ("side", "beta"): 1.7}),
                              ("0.73 C_m_q", {("pitch", "q"): 0.73}), ("0.5 C_m_q", {("pitch", "q"): 0.5}),
                              ("twice C_Y_r", {("side", "r"): 2.0}), ("twice C_l_r", {("roll", "r"): 2.0}),
                              ("twice C_n_p", {("yaw", "p"): 2.0})):
            model.write_text(changed_model(factors), encoding="utf-8")
            axes = read("design", "--experiment", experiment, "--model", model)["experiment"]["axes"]
            linear = read("linearize", model)
            pair = lambda roots, low, high: [complex(*z) for z in roots if z[1] > 0 and low < abs(complex(*z)) < high]
            dutch, zero = pair(linear["poles"], 1.9, 2.5)[0], pair(linear["zeros"]["r/zeta_c"], 0.0, 1.0)[0]
            print(f"{name:26s} " + "  ".join(f"{a['axis']} {min(a['turbulence_insensitivity_db']):5.1f} to "
                                              f"{max(a['turbulence_insensitivity_db']):4.1f} dB" for a in axes) +
                  f"  Dutch roll {abs(dutch) / 2 / np.pi:.3f} Hz, damping {-dutch.real / abs(dutch):.3f}"
                  f"  zero {abs(zero) / 2 / np.pi:.3f} Hz, damping {-zero.real / abs(zero):.3f}")
    return 0


def extremes_experiment(path, size=50, pairs=4000, resamples=400):
    """Pairs of campaigns drawn from the runs of a large one: how often the second's smallest SNR lies outside."""
    rng = np.random.default_rng(1)
    k = stats.norm.ppf(1 - (1 - np.array([0.025, 0.975])) ** (1 / size))
    wide = np.array([-3.51968, -1.37157])  # normal_smallest_factor(50, 50, ...)
    print("share below / above a 95 % interval, %: normal law | its parameters taken as known | ranks (above) | bootstrap")
    with sqlite3.connect(f"file:{path}?mode=ro", uri=True) as db:
        for axis in ("xi_c", "eta_c", "zeta_c"):
            runs = np.array(db.execute("SELECT value FROM metrics WHERE name = ?", (f"smallest_input_snr_db_{axis}",)).fetchall())
            runs = runs[:, 0]
            out, drawn = np.zeros((4, 2)), 0
            for pair in range(pairs):
                order = rng.permutation(len(runs))
                ours, theirs = runs[order[:size]], runs[order[size:2 * size]].min()
                mean, deviation = ours.mean(), ours.std(ddof=1)
                for row, factors in ((0, wide), (1, k)):
                    out[row] += theirs < mean + factors[0] * deviation, theirs > mean + factors[1] * deviation
                out[2, 1] += theirs > np.sort(ours)[5]
                if pair < resamples:
                    draws = ours.min() + np.array([rng.choice(ours, size).min() - rng.choice(ours, size).min()
                                                   for _ in range(resamples)])
                    low, high = np.quantile(draws, (0.025, 0.975))
                    out[3] += theirs < low, theirs > high
                    drawn += 1
            out[:3] /= pairs
            out[3] /= drawn
            print(f"{axis:7s} {len(runs)} runs, deviation {runs.std():.2f} dB, skewness {stats.skew(runs):.2f}: " +
                  " | ".join(f"{100 * a:4.1f} / {100 * b:4.1f}" for a, b in out))
    return 0


if __name__ == "__main__":
    if len(sys.argv) == 2:
        sys.exit(compare(sys.argv[1]))
    if len(sys.argv) == 4 and sys.argv[2] == "--bias":
        sys.exit(bias_experiment(sys.argv[1], sys.argv[3]))
    if len(sys.argv) == 4 and sys.argv[2] == "--extremes":
        sys.exit(extremes_experiment(sys.argv[3]))
    if len(sys.argv) == 3 and sys.argv[2] == "--insensitivity":
        sys.exit(insensitivity_experiment(sys.argv[1]))
    sys.exit(__doc__)
