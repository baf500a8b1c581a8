#!/usr/bin/python3
"""Joint law of a frequency response matrix against two independent computations. Usage: joint_region_reference.py PRINT_QUANTILES

1. Simulation: T^2 = q tr(W^-1 X X^H) from complex normal matrices; the share below each quantile within 4 standard errors.
2. Without contours or Laplace transforms: given the smaller eigenvalues, the largest of r = min(n_out, n_in) integrates in
   closed form (incomplete beta functions); the others by Gauss-Legendre. For r = 1 it is scipy's F.
"""
import subprocess
import sys

import numpy as np
from scipy import special

SEED, DRAWS, BATCH = 20, 200_000, 20_000


def simulate(n_out, n_in, q, rng):
    def normal(*shape):
        return (rng.standard_normal(shape) + 1j * rng.standard_normal(shape)) * np.sqrt(0.5)

    values = []
    for _ in range(DRAWS // BATCH):
        x, e = normal(BATCH, n_out, n_in), normal(BATCH, n_out, q)
        w = e @ e.conj().swapaxes(1, 2)
        values.append(q * np.einsum("bij,bij->b", x.conj(), np.linalg.solve(w, x)).real)
    return np.concatenate(values)


def incomplete(power, b, limit):
    """int_0^limit f^power (1 + f)^-b df"""
    a, c = power + 1.0, b - power - 1.0
    return special.beta(a, c) * special.betainc(a, c, limit / (1.0 + limit))


def distribution(n_out, n_in, q, t, nodes=300):
    """P(sum f <= t/q), density prod f^(s-r) (1+f)^-(nu+s) prod (f_i - f_j)^2."""
    r, s = min(n_out, n_in), max(n_out, n_in)
    nu = q if n_out <= n_in else q + n_in - n_out
    a, b, limit = s - r, nu + s, t / q

    def mass(total):
        """Integral over sum f <= total (None: everywhere) of the unnormalised density."""
        x, w = np.polynomial.legendre.leggauss(nodes)
        grids = []
        shape = (nodes,) * (r - 1)
        rest = np.full(shape, 1e15 if total is None else total)
        weight = np.ones(shape)
        for d in range(r - 1):
            axis = [1] * (r - 1)
            axis[d] = nodes
            y, wy = (0.5 * (x + 1)).reshape(axis), (0.5 * w).reshape(axis)
            scale = np.log1p(rest)  # f = (1 + rest)^y - 1 spreads the nodes over a heavy tail
            f = np.expm1(scale * y)
            jacobian = scale * (1 + f) * wy
            f = np.broadcast_to(f, shape)
            weight = weight * np.broadcast_to(jacobian, shape) * f ** a * (1 + f) ** -b
            for g in grids:
                weight = weight * (f - g) ** 2
            grids.append(f)
            if total is not None:
                rest = rest - f
        # prod over g of (f - g)^2 as a polynomial in the last eigenvalue f
        coefficients = [np.ones(shape)]
        for g in grids:
            for _ in range(2):
                grown = [np.zeros(shape) for _ in range(len(coefficients) + 1)]
                for power, value in enumerate(coefficients):
                    grown[power + 1] = grown[power + 1] + value
                    grown[power] = grown[power] - g * value
                coefficients = grown
        upper = np.full(shape, 1e300) if total is None else rest
        last = sum(value * incomplete(a + power, b, upper) for power, value in enumerate(coefficients))
        return np.sum(weight * last)

    return mass(limit) / mass(None)


lines = [line.split()[1:] for line in subprocess.run([sys.argv[1]], check=True, capture_output=True, text=True).stdout.splitlines()
         if line.startswith("j ")]
rng = np.random.default_rng(SEED)
drawn, worst, worst_sigma, checked = {}, 0.0, 0.0, 0
for entry in lines:
    n_out, n_in, q = map(int, entry[:3])
    p, t, error, back = map(float, entry[3:])
    assert abs(back - p) < 1e-10 and error < 1e-6 * t, entry
    if (n_out, n_in, q) not in drawn:
        drawn[n_out, n_in, q] = simulate(n_out, n_in, q, rng)
    share = np.mean(drawn[n_out, n_in, q] <= t)
    sigma = (share - p) / np.sqrt(p * (1 - p) / DRAWS)
    worst_sigma = max(worst_sigma, abs(sigma))
    text = f"{n_out} x {n_in}, q {q}, p {p}: T^2 {t:.6f}, simulated {100 * share:.3f} % ({sigma:+.1f} standard errors)"
    if min(n_out, n_in) <= 3:
        exact = distribution(n_out, n_in, q, t)
        worst, checked = max(worst, abs(exact - p)), checked + 1
        text += f", by quadrature {exact:.12f}"
    print(text)
print(f"{len(lines)} quantiles: largest difference by quadrature {worst:.1e} ({checked} of them), by simulation "
      f"{worst_sigma:.1f} standard errors")
sys.exit(0 if len(lines) == 36 and checked == 32 and worst < 1e-8 and worst_sigma < 4.0 else 1)
