#!/usr/bin/python3
"""Coverage of T (5.14) as printed, b = 2 sigma, no bias in truth, nominal 75 %, q = 10: by numerical integration.

The value stands in tests/unit/coverage/regions_test.cc; this script fails if it is not the integral.
"""
import sys

import numpy as np
from scipy import integrate, stats

q, level, b = 10, 0.75, 2.0
limit = stats.f.ppf(level, 2, 2 * q)


def given_variance(v):
    """P((|e| - b)^2 <= limit v) for |e|^2 exponential of mean one."""
    radius = np.sqrt(limit * v)
    return np.exp(-max(0.0, b - radius) ** 2) - np.exp(-((b + radius) ** 2))


value, _ = integrate.quad(lambda v: given_variance(v) * stats.gamma.pdf(v, q, scale=1 / q), 0, 10,
                          points=[b * b / limit], limit=500)
print(f"{value:.6f}")
sys.exit(0 if abs(value - 0.534526) < 1e-6 else 1)
