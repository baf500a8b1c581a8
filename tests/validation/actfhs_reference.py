"""The modes of campaigns/models/actfhs_60kt.toml with scipy: those that H (Wartmann & Greiser) prints.

The sampled model is taken back to continuous time by scipy's matrix logarithm. A mode s of a closed loop is found without
building that loop: u = F(s) (r - K y) has a pole where I + F(s) K G(s) is singular, G(s) = C (sI - A)^-1 B, with the gains of
H (14) and, for the optimized vehicle, the filter of H (15) as the rational function that it prints.
"""
import sys
import tomllib

import numpy as np
import scipy.linalg as sl

with open("campaigns/models/actfhs_60kt.toml", "rb") as f:
    model = tomllib.load(f)
a, b, c = (np.array(model[name]) for name in "ABC")
n, n_u = b.shape
held = np.block([[a, b], [np.zeros((n_u, n)), np.eye(n_u)]])
rate = sl.logm(held).real * model["rate_hz"]
a, b = rate[:n, :n], rate[:n, n:]

out = {name: i for i, name in enumerate(model["outputs"])}
gain = np.zeros((4, 8))
gain[0, out["q"]], gain[0, out["theta"]] = 50, 60
gain[1, out["p"]], gain[1, out["phi"]] = 60, 50
gain[2, out["r"]] = 50


def band_stop(s):
    return 1 + 0.9 * (0.4 * s**2 - 6 * s) / (s**2 + 2 * 0.6 * 12.6 * s + 12.6**2)


def pole(period, damping):
    w = 2 * np.pi / period
    return complex(-damping / np.sqrt(1 - damping**2) * w, w)


def return_difference(s, filtered):
    g = c @ np.linalg.solve(s * np.eye(n) - a, b)
    f = np.diag([1, band_stop(s) if filtered else 1, 1, 1])
    return np.linalg.det(np.eye(n_u) + f @ gain @ g)


worst = 0.0


def check(name, s, wanted):
    global worst
    period, damping = 2 * np.pi / s.imag, -s.real / abs(s)
    error = max(abs(period / wanted[0] - 1), abs(damping - wanted[1]))
    worst = max(worst, error)
    print(f"{name:28s} T {period:8.4f} s  D {damping:8.5f}  printed {wanted[0]} s, {wanted[1]}")


values = np.linalg.eigvals(a)
check("phugoid, bare", values[np.argmin(abs(values - pole(19.2, -0.16)))], (19.2, -0.16))
for name, filtered, wanted in [("phugoid, SCAS", False, (4.9, 0.4)), ("roll/flap, SCAS", False, (0.45, 0.32)),
                               ("lead-lag, SCAS", False, (0.55, 0.03)), ("roll/flap, SCAS and filter", True, (0.43, 0.58))]:
    one, two = pole(*wanted) * 1.01, pole(*wanted) * 0.995  # secant iteration from beside the printed pole
    for _ in range(40):
        f_one, f_two = return_difference(one, filtered), return_difference(two, filtered)
        if abs(two - one) < 1e-12 * abs(two) or f_two == f_one:
            break
        one, two = two, two - f_two * (two - one) / (f_two - f_one)
    assert abs(return_difference(two, filtered)) < 1e-8, "not a pole"
    check(name, two, wanted)
# The phugoid with the SCAS is a mode of pitch: near its pole the response of q to delta_x outweighs that of r, which the Dutch
# roll, of a similar period there, would rule.
s_near = pole(4.9, 0.4) * (1 + 1e-4)
g = c @ np.linalg.solve(s_near * np.eye(n) - a, b)
closed = g @ np.linalg.inv(np.eye(n_u) + gain @ g)
assert abs(closed[out["q"], 0]) > abs(closed[out["r"], 0]), "not the phugoid"
lead_lag = values[np.argmin(abs(values - 12j))]
print(f"bare lead-lag {abs(lead_lag):.3f} rad/s, D {-lead_lag.real / abs(lead_lag):.4f}")
assert abs(abs(lead_lag) - 12) < 0.3
# How fast the best predictor of the flight test forgets: gusts on u, v, w alone drive the aircraft (campaigns/candidates/spec.toml),
# so that no filter forgets the spiral and the inflow that they hardly move, whatever the noise. With the angular gusts of Dryden
# (MIL-F-8785: standard deviation by the integral of p_g's spectrum, rotor diameter 10.2 m) on top it forgets faster.
with open("campaigns/candidates/spec.toml", "rb") as f:
    flight = tomllib.load(f)["flight"]
speed, span = 30.87, 10.2
a_d, c_d = np.array(model["A"]), np.array(model["C"])
moved = a_d - np.eye(n)
rates = a[:, 3:6].copy()  # what turning does to the body but by the air
rates[out["phi"], 0] = rates[out["theta"], 1] = 0
rates[out["v"], 2] += speed
rates[out["w"], 1] -= speed
length = flight["gust_time_constant_s"] * speed
sigma = flight["gust_m_s"]
sigma_rate = sigma * np.pi / np.sqrt(10 * length * span) * (np.pi * length / (4 * span)) ** (1 / 6)
keep = np.exp(-1 / model["rate_hz"] / flight["gust_time_constant_s"])
keep_rate = np.exp(-np.pi * speed / (4 * span) / model["rate_hz"])
for angular in (False, True):
    columns = [-moved[:, :3]] + ([-np.linalg.solve(a, moved) @ rates] if angular else [])
    stay = np.repeat([keep, keep_rate], 3)[: 6 if angular else 3]
    power = np.repeat([sigma**2, sigma_rate**2], 3)[: len(stay)] * (1 - stay**2)
    a_g = np.block([[a_d, np.hstack(columns)], [np.zeros((len(stay), n)), np.diag(stay)]])
    c_g = np.hstack([c_d, np.zeros((8, len(stay)))])
    c_g[:3, n : n + 3] = -np.eye(3)  # u, v, w are airspeeds
    q = np.diag(np.concatenate([np.zeros(n), power]))
    for share in (1.0, 0.1):
        r = np.diag((share * np.array(flight["noise"])) ** 2)
        cov = sl.solve_discrete_are(a_g.T, c_g.T, q, r)
        k = a_g @ cov @ c_g.T @ np.linalg.inv(c_g @ cov @ c_g.T + r)
        slowest = np.sort(abs(np.linalg.eigvals(a_g - k @ c_g)))[::-1]
        print(f"predictor, {'angular gusts too' if angular else 'gusts of u, v, w'}, {share} of the noise: eigenvalues "
              f"{slowest[0]:.5f}, {slowest[2]:.4f} ... norm at p = 250 about {slowest[0]**250:.1e}, at 700 {slowest[0]**700:.1e}")
        assert 0.98 < slowest[0] < 1.0
print(f"largest error of T (relative) and D: {worst:.2g}")
sys.exit(0 if worst < 1e-3 else 1)
