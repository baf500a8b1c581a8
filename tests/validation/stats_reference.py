#!/usr/bin/python3
"""Quantiles of F(2, 2q) and Student's t as the program has them, against scipy. Usage: stats_reference.py PRINT_QUANTILES

The band of 1e-8 is scipy's: its iteration for t stops at about 3e-9 (for 2 degrees of freedom and p = 0.01 the exact
value, 0.98 sqrt(50/0.99), agrees with ours to 1e-15).
"""
import subprocess
import sys

from scipy import stats

worst, count = 0.0, 0
for line in subprocess.run([sys.argv[1]], check=True, capture_output=True, text=True).stdout.splitlines():
    kind, *numbers = line.split()
    dof, p, x, *cdf = map(float, numbers)
    expected = stats.f.ppf(p, 2, 2 * dof) if kind == "f" else stats.t.ppf(p, dof)
    worst = max(worst, abs(x - expected) / max(abs(expected), 1e-3 if kind == "t" else 1e-300))  # t at p = 0.5 is 0
    if cdf:
        worst = max(worst, abs(cdf[0] - stats.f.cdf(x, 2, 2 * dof)))
    count += 1
print(f"{count} quantiles, largest relative difference {worst:.1e}")
sys.exit(0 if count == 126 and worst < 1e-8 else 1)
