"""Where `[stop]` ends a cell and with which interval, against the formulas written anew in numpy and scipy.

Usage: stopping_reference.py FATMC, the one of the tests. The normal sequence's ends are found here as roots of the Bayes
factor of the t statistic itself, not by the program's closed form.
"""
import os
import sqlite3
import subprocess
import sys
import tempfile

try:
    import numpy as np
    from scipy.optimize import brentq
except ImportError:
    print("numpy and scipy are not there")
    sys.exit(77)

ALPHA = 0.05
SPEC = """
[campaign]
study = "engine_test"
name = "stopping"
seed = 3
[[cell]]
name = "s"
repetitions = 20000
diverge_every = 9
"""
RULES = {
    "normal": 'metric = "normal"\nhalf_width = 0.15\ntuned_for = 300\n',
    "bernstein": 'metric = "x"\nhalf_width = 0.04\nbounds = [0.0, 1.0]\nmissing = 0.5\n',
}


def normal_interval(x, tuned_for=300.0):
    n, g = len(x), (-2 * np.log(ALPHA) + np.log(1 - 2 * np.log(ALPHA))) / tuned_for
    mean, deviation, nu = np.mean(x), np.std(x, ddof=1), n - 1.0

    def log_factor(mu):
        t2 = n * (mean - mu)**2 / deviation**2
        return (-0.5 * np.log1p(n * g) - 0.5 * n * np.log1p(t2 / (nu * (1 + n * g))) + 0.5 * n * np.log1p(t2 / nu)
                + np.log(ALPHA))

    return brentq(log_factor, mean - 10 * deviation, mean), brentq(log_factor, mean, mean + 10 * deviation)


def bernstein_interval(x):
    low, high = 0.0, 1.0
    log_term = np.log(2 / ALPHA)
    means = [0.5]  # half a trial of prior: m_0, m_1 ...
    squares = [0.25]
    lambdas, penalty = [], 0.0
    for i, value in enumerate(x, start=1):
        variance = squares[-1] / i
        weight = min(0.5, np.sqrt(2 * log_term / (variance * i * np.log(1 + i))))
        lambdas.append(weight)
        penalty += (value - means[-1])**2 * (-np.log(1 - weight) - weight)
        means.append((0.5 + np.sum(x[:i])) / (i + 1))
        squares.append(squares[-1] + (value - means[-1])**2)
        centre = np.dot(lambdas, x[:i]) / np.sum(lambdas)
        half = (log_term + penalty) / np.sum(lambdas)
        low, high = max(low, centre - half), min(high, centre + half)
    return low, high


def main(fatmc):
    fails = 0
    for method, rule in RULES.items():
        with tempfile.TemporaryDirectory() as folder:
            with open(os.path.join(folder, "s.toml"), "w") as file:
                file.write(SPEC + "[stop]\n" + rule)
            subprocess.run([fatmc, "run", "s.toml", "--db", "s.db"], cwd=folder, check=True, capture_output=True)
            database = sqlite3.connect(os.path.join(folder, "s.db"))
            n, metric, low, high = database.execute("SELECT repetitions, metric, low, high FROM stop").fetchone()
            stored = dict(database.execute("SELECT repetition, value FROM metrics WHERE name = ?", (metric,)))
            wanted = float(rule.split("half_width = ")[1].split("\n")[0])
            values = [stored.get(i, 0.5 if method == "bernstein" else None) for i in range(n)]
            interval = {"normal": normal_interval, "bernstein": bernstein_interval}[method]
            at = interval(np.array([v for v in values if v is not None]))
            before = interval(np.array([v for v in values[:-1] if v is not None]))
            checks = [("lower end", abs(low - at[0]) < 1e-9), ("upper end", abs(high - at[1]) < 1e-9),
                      ("narrow enough at N", 0.5 * (at[1] - at[0]) <= wanted),
                      ("too wide at N - 1", 0.5 * (before[1] - before[0]) > wanted),
                      ("rows are those below N", database.execute("SELECT count(*), max(repetition) FROM trial").fetchone()
                       == (n, n - 1))]
            for what, good in checks:
                fails += not good
                print(f"{'ok  ' if good else 'FAIL'} {method}, N = {n}: {what}; [{low:.6f}, {high:.6f}], reference "
                      f"[{at[0]:.6f}, {at[1]:.6f}]")
    return fails


if __name__ == "__main__":
    sys.exit(main(os.path.abspath(sys.argv[1])) > 0)
