"""PBSIDopt of its own in numpy and scipy against `fatmc identify`: same records in, same model out.

Compared: singular values (1e-10 of the largest), eigenvalues of A and of A - K C (1e-9), impulse response (1e-9), the Riccati gain against
scipy.linalg.solve_discrete_are, the continuous model against scipy.linalg.logm. With `measured`: DaISy's CD-player arm and the
TREX 550 flight (FATMC_DATA), variance accounted for on the part that was held back.
Usage: subspace_reference.py FATMC [measured]
"""
import json
import os
import subprocess
import sys
import tempfile

import numpy as np
import scipy.linalg as sl

FATMC = sys.argv[1]


def regressor(u, y, p):
    z = np.hstack([u, y])
    return np.hstack([z[p - lag : len(z) - lag] for lag in range(1, p + 1)])


def ridge_by_gcv(phi, y):
    """GCV over lambda / s_1 = 10^-12 ... 1, 20 a decade."""
    left, s, right = np.linalg.svd(phi, full_matrices=False)
    beta = left.T @ y
    rest, m = (y**2).sum() - (beta**2).sum(), len(phi)
    best = None
    for lam in s[0] * 10.0 ** (np.arange(-240, 1) / 20):
        f = s**2 / (s**2 + lam**2)
        value = (rest + (((1 - f)[:, None] * beta) ** 2).sum()) / m / (1 - f.sum() / m) ** 2
        if best is None or value < best[0]:
            best = (value, lam)
    lam = best[1]
    return lam, ((right.T * (s / (s**2 + lam**2))) @ beta).T


def identify(maneuvers, p, f, n, final, lam=None):
    n_y = maneuvers[0][1].shape[1]
    n_z = maneuvers[0][0].shape[1] + n_y
    n_u = n_z - n_y
    phis = [regressor(u, y, p) for u, y in maneuvers]
    phi, y = np.vstack(phis), np.vstack([y[p:] for _, y in maneuvers])
    if lam is None:
        lam, xi = ridge_by_gcv(phi, y)
    else:
        xi = np.linalg.lstsq(np.vstack([phi, lam * np.eye(phi.shape[1])]),
                             np.vstack([y, np.zeros((phi.shape[1], n_y))]), rcond=None)[0].T
    ok = np.zeros((f * n_y, p * n_z))
    for i in range(f):
        ok[i * n_y : (i + 1) * n_y, : (p - i) * n_z] = xi[:, i * n_z :]
    _, s, vt = np.linalg.svd(ok @ phi.T, full_matrices=False)  # the whole product: no QR, no Gram matrix
    states = np.sqrt(s[:n])[:, None] * vt[:n]
    x0, x1, u0, y0, start = [], [], [], [], 0
    for (u, y_j), phi_j in zip(maneuvers, phis):
        x = states[:, start : start + len(phi_j)].T
        start += len(phi_j)
        x0.append(x[:-1])
        x1.append(x[1:])
        u0.append(u[p:-1])
        y0.append(y_j[p:-1])
    x0, x1, u0, y0 = map(np.vstack, (x0, x1, u0, y0))
    c = np.linalg.lstsq(x0, y0, rcond=None)[0].T
    e = y0 - x0 @ c.T
    if final == "residual":
        abk = np.linalg.lstsq(np.hstack([x0, u0, e]), x1, rcond=None)[0].T
        a, b, k = abk[:, :n], abk[:, n : n + n_u], abk[:, n + n_u :]
    else:
        ab = np.linalg.lstsq(np.hstack([x0, u0]), x1, rcond=None)[0].T
        a, b = ab[:, :n], ab[:, n:]
        w = np.hstack([x1 - np.hstack([x0, u0]) @ ab.T, e])
        w = w.T @ w / len(w)
        cov = sl.solve_discrete_are(a.T, c.T, w[:n, :n], w[n:, n:], s=w[:n, n:])
        k = (a @ cov @ c.T + w[:n, n:]) @ np.linalg.inv(c @ cov @ c.T + w[n:, n:])
    return a, b, c, k, s, lam


def moduli(matrix):
    return np.sort_complex(np.linalg.eigvals(matrix))


def impulse(a, b, c, count=25):
    out, power = [], b
    for _ in range(count):
        out.append(c @ power)
        power = a @ power
    return np.array(out)


def simulated_maneuver(rng, samples):
    """Closed loop, two inputs, two outputs, four states."""
    a = np.array([[0.9, 0.3, 0, 0.1], [-0.3, 0.9, 0.1, 0], [0, 0, 0.7, 0.2], [0, 0, -0.2, 0.7]])
    b = np.array([[0.1, 0], [0, 0.3], [0.5, 0.1], [0.2, -0.4]])
    c = np.array([[1.0, 0, 0.5, 0], [0, 0.4, 0, 1.0]])
    k = 0.2 * np.array([[1.0, 0], [0, 1.0], [0.3, 0], [0, 0.3]])
    x, u, y = np.zeros(4), np.zeros((samples, 2)), np.zeros((samples, 2))
    for t in range(samples):
        e = 0.3 * rng.standard_normal(2)
        y[t] = c @ x + e + 5.0
        u[t] = rng.standard_normal(2) - 0.2 * (y[t] - 5.0) + 1.0
        x = a @ x + b @ (u[t] - 1.0) + k @ e
    return u, y


def write_record(path, u, y, rate_hz):
    header = ",".join([f"u{i + 1}" for i in range(u.shape[1])] + [f"y{i + 1}" for i in range(y.shape[1])])
    np.savetxt(path + ".csv", np.hstack([u, y]), delimiter=",", header=header, comments="", fmt="%.17g")
    names = lambda kind, count: str([f"{kind}{i + 1}" for i in range(count)]).replace("'", '"')
    with open(path + ".toml", "w") as f:
        f.write(f"[record]\nrate_hz = {rate_hz}\ninput = {names('u', u.shape[1])}\noutput = {names('y', y.shape[1])}\n")


def run(*arguments):
    done = subprocess.run([FATMC, "identify", *map(str, arguments)], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return done.stdout


def against_numpy(folder):
    rng = np.random.default_rng(4)
    maneuvers, rate_hz = [simulated_maneuver(rng, n) for n in (500, 400)], 25.0
    files = []
    for j, (u, y) in enumerate(maneuvers):
        write_record(f"{folder}/m{j}", u, y, rate_hz)
        files.append(f"{folder}/m{j}.csv")
    centred = [(u - u.mean(0), y - y.mean(0)) for u, y in maneuvers]
    worst = {}
    cases = [(12, 8, 4, "paper", "gcv", None), (12, 8, 4, "residual", "gcv", None), (15, 15, 5, "paper", "0.5", 0.5),
             (9, 4, 4, "residual", "0", 0.0)]
    for p, f, n, final, rule, lam in cases:
        run(*files, "--past", p, "--future", f, "--order", n, "--final", final, "--regularization", rule, "-o", folder + "/out")
        ours = json.load(open(folder + "/out/model.json"))
        a, b, c, k, s, lam = identify(centred, p, f, n, final, lam)
        oa, ob, oc, ok = (np.array(ours[x]) for x in "ABCK")
        assert abs(ours["lambda"] - lam) <= 1e-9 * max(lam, 1e-300), (ours["lambda"], lam)
        differences = {
            "singular values": abs(np.array(ours["singular_values"])[: len(s)] - s).max() / s[0] / 1e-10,
            "eigenvalues of A": abs(moduli(oa) - moduli(a)).max() / 1e-9,
            "eigenvalues of A - K C": abs(moduli(oa - ok @ oc) - moduli(a - k @ c)).max() / 1e-9,
            "impulse response": abs(impulse(oa, ob, oc) - impulse(a, b, c)).max() / 1e-9,
            "predictor norm": abs(ours["predictor_norm"] / np.linalg.norm(np.linalg.matrix_power(oa - ok @ oc, p), 2) - 1) / 1e-9,
        }
        if ours["A_ct"] is not None:
            step = np.block([[oa, ob], [np.zeros((2, n)), np.eye(2)]])
            rate = sl.logm(step).real * rate_hz
            differences["continuous A"] = abs(np.array(ours["A_ct"]) - rate[:n, :n]).max() / abs(rate).max() / 1e-9
            differences["continuous B"] = abs(np.array(ours["B_ct"]) - rate[:n, n:]).max() / abs(rate).max() / 1e-9
        for name, value in differences.items():
            worst[name] = max(worst.get(name, 0.0), value)
    for name, value in worst.items():
        print(f"{name}: {value:.2g} of the tolerance")
    assert max(worst.values()) < 1.0


def measured(folder):
    data = os.environ.get("FATMC_DATA", "")
    if not os.path.isdir(data + "/daisy_cd_player_arm"):
        print("FATMC_DATA names no folder with daisy_cd_player_arm: skipped")
        sys.exit(77)
    with open(folder + "/daisy.toml", "w") as f:
        f.write('[record]\nrate_hz = 1.0\ninput = ["u1", "u2"]\noutput = ["y1", "y2"]\n')
    with open(folder + "/trex.toml", "w") as f:
        f.write('[record]\nrate_hz = 100.0\ninput = ["lat", "lon", "ped", "col"]\noutput = ["p", "q", "r", "phi", "theta"]\n')

    def held_back(record, meta, *arguments):
        run(f"{data}/{record}", "--meta", f"{folder}/{meta}", *arguments, "-o", folder + "/measured")
        ours = json.load(open(folder + "/measured/model.json"))
        return ours, {o["output"]: o["variance_accounted_for"] for o in ours["validation"][0]["outputs"]}

    ours, vaf = held_back("daisy_cd_player_arm/cd_player_arm.csv", "daisy.toml", "--past", 40, "--future", 20, "--order", 8,
                          "--hold-back", 0.5)
    print("CD-player arm, n = 8:", vaf, "SLICOT: 88.6, 95.4; largest |eigenvalue| of A - K C", ours["predictor_radius"])
    assert vaf["y1"] >= 86.6 and vaf["y2"] >= 93.4 and ours["predictor_radius"] < 1.0
    ours, vaf = held_back("trex550_helicopter/flight.csv", "trex.toml", "--decimate", 5, "--past", 40, "--future", 40, "--order",
                          10, "--hold-back", 0.4)
    print("TREX 550, n = 10:", vaf)
    assert vaf["p"] >= 30 and vaf["q"] >= 70


with tempfile.TemporaryDirectory() as temporary:
    (measured if sys.argv[2:] == ["measured"] else against_numpy)(temporary)
