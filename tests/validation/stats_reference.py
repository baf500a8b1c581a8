#!/usr/bin/python3
"""Quantiles of F(2, 2q) and Student's t, and discs of the ratio distribution, against scipy. Usage: stats_reference.py PRINT_QUANTILES

The band of 1e-8 is scipy's: its iteration for t stops at about 3e-9 (for 2 degrees of freedom and p = 0.01 the exact
value, 0.98 sqrt(50/0.99), agrees with ours to 1e-15). A disc of g = (1 + y)/(1 + u) is computed another way here: given u,
|y - u| <= r |1 + u| is a noncentral chi-square in y, then a sum over a grid of u.
"""
import subprocess
import sys

import numpy as np
from scipy import stats


def disc(s_u, s_y, rho, radius):
    axis = np.linspace(-6.5, 6.5, 261)
    u = axis[:, None] + 1j * axis[None, :]
    weight = np.exp(-abs(u) ** 2) / np.pi * (axis[1] - axis[0]) ** 2
    rest = s_y ** 2 * (1.0 - abs(rho) ** 2)
    inside = stats.ncx2.cdf(2 * radius ** 2 * abs(1 + s_u * u) ** 2 / rest, 2, 2 * abs((rho * s_y - s_u) * u) ** 2 / rest)
    return np.sum(weight * inside)


worst, count, worst_disc, discs = 0.0, 0, 0.0, 0
for line in subprocess.run([sys.argv[1]], check=True, capture_output=True, text=True).stdout.splitlines():
    kind, *numbers = line.split()
    if kind == "j":  # joint_region_reference.py
        continue
    if kind == "r":
        s_u, s_y, re, im, radius, p = map(float, numbers)
        difference = abs(p - disc(s_u, s_y, complex(re, im), radius))
        if "-v" in sys.argv:
            print(numbers, difference)
        worst_disc, discs = max(worst_disc, difference), discs + 1
        continue
    dof, p, x, *cdf = map(float, numbers)
    expected = stats.f.ppf(p, 2, 2 * dof) if kind == "f" else stats.t.ppf(p, dof)
    worst = max(worst, abs(x - expected) / max(abs(expected), 1e-3 if kind == "t" else 1e-300))  # t at p = 0.5 is 0
    if cdf:
        worst = max(worst, abs(cdf[0] - stats.f.cdf(x, 2, 2 * dof)))
    count += 1
print(f"{count} quantiles, largest relative difference {worst:.1e}")
print(f"{discs} discs, largest difference {worst_disc:.1e}")
sys.exit(0 if count == 126 and worst < 1e-8 and discs == 54 and worst_disc < 1e-8 else 1)
