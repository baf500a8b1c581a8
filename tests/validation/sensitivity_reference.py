"""Rank correlations and variance shares of `fatmc query sensitivity` against scipy, numpy and exact values.

Usage: sensitivity_reference.py FATMC, the one of the tests, whose study has a linear model and Ishigami's function. The
draws are those of the program's own dispersions, read from its database.
"""
import json
import os
import sqlite3
import subprocess
import sys
import tempfile

try:
    import numpy as np
    from scipy import stats
except ImportError:
    print("numpy and scipy are not there")
    sys.exit(77)

N = 2000
SPEC = """
[campaign]
study = "engine_test"
name = "sensitivity"
seed = 5
[inputs]
a = 0.0
b = 0.0
c = 0.0
[[cell]]
name = "s"
repetitions = %d
""" % N + "".join(f'[[dispersion]]\npath = "inputs.{name}"\nlaw = "uniform"\nlow = {-np.pi!r}\nhigh = {np.pi!r}\n'
                  for name in "abc")


def share(x, y):
    """Adjusted R² of a degree-8 polynomial of the rank, by numpy's least squares."""
    u = 2.0 * (stats.rankdata(x) - 0.5) / len(x) - 1.0
    basis = np.polynomial.legendre.legvander(u, 8)
    rest = y - basis @ np.linalg.lstsq(basis, y, rcond=None)[0]
    return 1.0 - (rest @ rest / (len(x) - 9)) / np.var(y, ddof=1)


def main(fatmc):
    fails = 0
    with tempfile.TemporaryDirectory() as folder:
        with open(os.path.join(folder, "s.toml"), "w") as file:
            file.write(SPEC)
        subprocess.run([fatmc, "run", "s.toml", "--db", "s.db"], cwd=folder, check=True, capture_output=True)
        out = subprocess.run([fatmc, "query", "sensitivity", "s.db", "--format", "json", "--resamples", "200"], cwd=folder,
                             check=True, capture_output=True, text=True).stdout
        rows = {(row["metric"], row["parameter"]): row for row in json.loads(out)}
        database = sqlite3.connect(os.path.join(folder, "s.db"))
        column = lambda name: np.array([value for value, in database.execute(
            "SELECT value FROM metrics WHERE name = ? ORDER BY repetition", (name,))])
        draws = {name: column("draw." + name) for name in "abc"}

        pi4 = np.pi**4
        total = 49 / 8 + 0.1 * pi4 / 5 + 0.01 * pi4**2 / 18 + 0.5
        variance = np.pi**2 / 3
        exact = {"ishigami": {"a": 0.5 * (1 + 0.1 * pi4 / 5)**2 / total, "b": 49 / 8 / total, "c": 0.0},
                 "linear": {"a": 4 * variance / (5 * variance + 1), "b": variance / (5 * variance + 1), "c": 0.0}}
        for metric in ("linear", "ishigami"):
            y = column(metric)
            for name, x in draws.items():
                row = rows[metric, name]
                rho = stats.spearmanr(x, y)[0]
                half = stats.norm.ppf(0.975) * np.sqrt((1 + rho**2 / 2) / (N - 3))
                checks = [("rank correlation", row["rank_correlation"], rho, 1e-12),
                          ("its lower end", row["rank_correlation_low"], np.tanh(np.arctanh(rho) - half), 1e-12),
                          ("its upper end", row["rank_correlation_high"], np.tanh(np.arctanh(rho) + half), 1e-12),
                          ("share", row["share"], share(x, y), 1e-10)]
                # Four times the width of a 95 % interval's quarter: 4 standard errors about the exact share.
                error = max((row["share_high"] - row["share_low"]) / 3.92, 1.5 / N)
                checks.append(("share against the exact one", row["share"], exact[metric][name], 4 * error))
                for what, ours, reference, tolerance in checks:
                    good = abs(ours - reference) <= tolerance
                    fails += not good
                    print(f"{'ok  ' if good else 'FAIL'} {metric} {name}: {what} {ours:.6f}, reference {reference:.6f}, "
                          f"tolerance {tolerance:.1e}")
    return fails


if __name__ == "__main__":
    sys.exit(main(os.path.abspath(sys.argv[1])) > 0)
