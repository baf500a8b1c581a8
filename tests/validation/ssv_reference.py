#!/usr/bin/env python3
"""`fatmc ssv` against scipy on the whole loop matrix M = -W S X T.

Usage: ssv_reference.py FATMC
Upper bound: a general diagonal D, one entry an element of the plant, descended with BFGS on log of the Schatten norm of
growing order and then on log sigma_max itself. Lower bound: one phase an element, climbed with BFGS from random starts.
Neither knows of the collapse to the size of X. Any D bounds ssv from above and any phases from below, so that part of
the comparison is rigorous whatever the optimiser found.
"""
import csv
import subprocess
import sys
import tempfile

import numpy as np
import scipy.linalg
import scipy.optimize

SIZES = [(3, 3)] * 150 + [(2, 2)] * 6 + [(2, 3)] * 4 + [(3, 2)] * 4 + [(1, 4)] * 2 + [(4, 1)] * 2 + [(4, 4)] * 4 + [(1, 1)]
STARTS = 12


def loop_matrix(x, w):
    """M for X (n_in x n_out) and radii w (n_out x n_in), from its factors."""
    n_in, n_out = x.shape
    s = np.kron(np.eye(n_in), np.ones((n_out, 1)))
    t = np.kron(np.ones((1, n_in)), np.eye(n_out))
    return -np.diag(w.flatten(order="F")) @ s @ x @ t


def upper_bound(m):
    n = len(m)

    def schatten(log_d, p):
        scaled = np.exp(log_d[:, None] - log_d[None, :]) * m
        u, sigma, vh = np.linalg.svd(scaled)
        weight = np.where(sigma > 0, (sigma / sigma[0]) ** p, 0.0)
        value = np.log(sigma[0]) + np.log(weight.sum()) / p
        weight /= weight.sum()
        return value, (np.abs(u) ** 2) @ weight - (np.abs(vh.T) ** 2) @ weight

    log_d, best = np.zeros(n), np.inf
    for p in (4, 16, 64, 256, 1024, 4096, 2.0 ** 14, 2.0 ** 16):
        found = scipy.optimize.minimize(schatten, log_d, args=(p,), jac=True, method="BFGS", options={"gtol": 1e-10})
        log_d = found.x
        best = min(best, np.linalg.norm(np.exp(log_d[:, None] - log_d[None, :]) * m, 2))
    return best


def lower_bound(m, rng):
    def minus_log_radius(phase):
        values, left, right = scipy.linalg.eig(m * np.exp(1j * phase)[None, :], left=True)
        k = np.argmax(np.abs(values))
        share = np.conj(left[:, k]) * right[:, k]
        share /= share.sum()
        return -np.log(np.abs(values[k])), share.imag

    best = 0.0
    for _ in range(STARTS):
        start = rng.uniform(0, 2 * np.pi, len(m))
        found = scipy.optimize.minimize(minus_log_radius, start, jac=True, method="BFGS", options={"gtol": 1e-9})
        best = max(best, np.exp(-found.fun))
    return best


def main():
    fatmc = sys.argv[1]
    rng = np.random.default_rng(20181)
    failures = []
    worst = {"upper": 0.0, "lower": 0.0, "met": 0}
    for size in sorted(set(SIZES)):
        n_in, n_out = size
        plants = []
        for _ in range(SIZES.count(size)):
            x = rng.normal(size=size) + 1j * rng.normal(size=size)
            plants.append((x, np.exp(rng.normal(size=(n_out, n_in)))))
        with tempfile.TemporaryDirectory() as folder:
            header = ["id"] + [f"X{part}{j + 1}{i + 1}" for j in range(n_in) for i in range(n_out) for part in ("re", "im")]
            header += [f"w_out{i + 1}_in{j + 1}" for j in range(n_in) for i in range(n_out)]
            with open(f"{folder}/factors.csv", "w", newline="") as file:
                writer = csv.writer(file)
                writer.writerow(header)
                for k, (x, w) in enumerate(plants):
                    elements = [repr(float(v)) for z in x.flatten() for v in (z.real, z.imag)]
                    writer.writerow([k] + elements + [repr(float(v)) for v in w.flatten(order="F")])
            subprocess.run([fatmc, "ssv", f"{folder}/factors.csv", "-o", f"{folder}/ssv.csv"], check=True)
            with open(f"{folder}/ssv.csv", newline="") as file:
                rows = list(csv.DictReader(file))
        assert [row["id"] for row in rows] == [str(k) for k in range(len(plants))]
        for row, (x, w) in zip(rows, plants):
            upper, lower, met = float(row["upper"]), float(row["lower"]), row["certified"] == "true"
            m = loop_matrix(x, w)
            peer_upper, peer_lower = upper_bound(m), lower_bound(m, rng)
            name = f"{n_in} x {n_out} plant {row['id']}"
            worst["upper"] = max(worst["upper"], abs(peer_upper / upper - 1))
            worst["lower"] = max(worst["lower"], abs(peer_lower / lower - 1))
            worst["met"] += met
            if upper > peer_upper * (1 + 1e-8):
                failures.append(f"{name}: upper bound {upper} above scipy's {peer_upper}")
            if peer_upper > upper * (1 + 1e-4):
                failures.append(f"{name}: scipy's D gives {peer_upper}, upper bound says {upper}")
            if lower < peer_lower * (1 - 1e-7):
                failures.append(f"{name}: lower bound {lower} below scipy's {peer_lower}")
            if peer_lower > upper * (1 + 1e-9) or lower > peer_upper * (1 + 1e-9):
                failures.append(f"{name}: bounds cross: {lower} {upper} against {peer_lower} {peer_upper}")
            if met and upper - lower > 1e-8 * upper:
                failures.append(f"{name}: certified with bounds {lower} {upper}")
    print(f"{len(SIZES)} plants, {worst['met']} certified; largest relative difference of the upper bounds "
          f"{worst['upper']:.2e}, of the lower bounds {worst['lower']:.2e}")
    for failure in failures:
        print("FAILED", failure)
    sys.exit(1 if failures else 0)


if __name__ == "__main__":
    main()
