#!/usr/bin/env python3
"""The estimators beside the fast LPM in numpy and scipy, compared with `fatmc estimate --method`.

Usage: estimators_reference.py FATMC
Written from the equations: explicit pseudoinverses and Kronecker products, scipy.signal for the spectra. Records are made
here: two inputs through a coupled second-order system from rest, with noise on inputs and outputs.
"""
import csv
import json
import os
import subprocess
import sys
import tempfile

import numpy as np
from scipy import signal

TOLERANCE = 1e-8  # relative to the largest of its kind at a line; round-off is about 1e-12
PERIOD, RATE = 500, 50.0
LINES = list(range(8, 48, 2))


def write(directory, name, columns, roles, periodic=True):
    path = os.path.join(directory, name + ".csv")
    with open(path, "w", encoding="utf-8") as file:
        file.write(",".join(columns) + "\n")
        for row in zip(*columns.values()):
            file.write(",".join(repr(float(value)) for value in row) + "\n")
    with open(os.path.join(directory, name + ".toml"), "w", encoding="utf-8") as file:
        file.write(f"[record]\nrate_hz = {RATE}\n")
        for role, names in roles.items():
            file.write(f"{role} = {json.dumps(names)}\n")
        if periodic:
            file.write(f"period_samples = {PERIOD}\nexcited_lines = {LINES}\n")
    return path



def plant(u, rng):
    a = np.array([[0.86, 0.25], [-0.25, 0.90]])
    b = np.array([[1.0, 0.3], [-0.2, 0.7]])
    x, y = np.zeros(2), np.zeros((len(u), 2))
    for n, row in enumerate(u):
        y[n] = x
        x = a @ x + b @ row
    return y + 0.05 * rng.standard_normal(y.shape)


def record(rng, inputs, periods=None, samples=2000, input_noise=0.02):
    """Columns r, u, y; the input is the reference and noise."""
    if periods:
        n = np.arange(PERIOD * periods)
        r = np.array([sum(np.cos(2 * np.pi * k * n / PERIOD + 2 * np.pi * rng.random()) for k in LINES)
                      for _ in range(inputs)]).T
    else:
        r = rng.standard_normal((samples, inputs))
    u = r + input_noise * rng.standard_normal(r.shape)
    y = plant(u if inputs == 2 else np.hstack([u, 0 * u]), rng)
    columns = {f"r{j}": r[:, j] for j in range(inputs)}
    columns.update({f"u{j}": u[:, j] for j in range(inputs)})
    columns.update({"y0": y[:, 0], "y1": y[:, 1]})
    return columns


def pick(columns, letter):
    return np.stack([columns[name] for name in columns if name[0] == letter], axis=1)


def run(fatmc, records, method, options=()):
    out = records[0] + "." + method
    subprocess.run([fatmc, "estimate", *records, "--method", method, "-o", out, *options], check=True,
                   stdout=subprocess.DEVNULL)
    with open(os.path.join(out, "estimate.json"), encoding="utf-8") as file:
        info = json.load(file)
    with open(os.path.join(out, "frm.csv"), encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    return info, rows


def compare(what, info, rows, g, variance, bias=None):
    """g, variance, bias: lines x outputs x inputs."""
    assert len(rows) == g.size, f"{what}: {len(rows)} rows, expected {g.size}"
    read = lambda key: np.array([float(row[key]) for row in rows]).reshape(g.shape)
    scale = np.abs(g).max(axis=(1, 2), keepdims=True)
    worst = {"G": np.max(np.abs(read("re") + 1j * read("im") - g) / scale),
             "variance": np.max(np.abs(read("variance") / variance - 1.0))}
    if bias is None:
        assert all(row["bias"] == "" for row in rows), f"{what}: a bias where there is none"
    else:
        worst["bias"] = np.max(np.abs(read("bias") - bias) / scale)
    print(f"{what}: q {info['q']}, largest relative differences " + ", ".join(f"{k} {v:.1e}" for k, v in worst.items()))
    assert max(worst.values()) < TOLERANCE, f"{what}: {worst}"


def solve(l, z, n_in, n_out, indirect, c_z):
    """z: channels x rows, l: parameters x rows with the constant terms first -> G, element variances."""
    pinv = np.linalg.pinv(l)
    theta = z @ pinv
    s = pinv[:, :n_in]
    q = l.shape[1] - l.shape[0]
    if c_z is None:
        c_z = (z - theta @ l) @ (z - theta @ l).conj().T / q
    a = (s.conj().T @ s).conj()
    g = theta[:n_out, :n_in]
    b, c_v = a, c_z
    if indirect:
        inverse = np.linalg.inv(theta[n_out:, :n_in])
        g = g @ inverse
        v = np.hstack([np.eye(n_out), -g])
        c_v, b = v @ c_z @ v.conj().T, inverse.T @ a @ inverse.conj()
    return g, np.diag(np.kron(b, c_v)).real.reshape(n_in, n_out).T


def periodic_means(columns, periods):
    z = np.hstack([pick(columns, "y"), pick(columns, "u")])
    spectra = np.fft.fft(z.reshape(periods, PERIOD, -1), axis=1)[:, LINES] / np.sqrt(PERIOD)
    mean = spectra.mean(axis=0)
    noise = np.array([np.cov(spectra[:, k].T) for k in range(len(LINES))]) / periods
    return mean, noise


def check_etfe(fatmc, directory, rng):
    for input_noise in (0.02, 15.0):  # with the second, |U|/s_U is about 2 and the bias counts
        check_etfe_at(fatmc, directory, rng, input_noise)


def check_etfe_at(fatmc, directory, rng, input_noise):
    columns = record(rng, 1, periods=6, input_noise=input_noise)
    path = write(directory, f"etfe{input_noise}", columns, {"input": ["u0"], "output": ["y0", "y1"]})
    mean, noise = periodic_means(columns, 6)
    g, variance, bias = [], [], []
    for k in range(len(LINES)):
        y, u = mean[k, :2], mean[k, 2]
        s_u = noise[k, 2, 2].real
        s_y, s_yu = np.diag(noise[k])[:2].real, noise[k, :2, 2]
        g.append(y / u)
        variance.append(abs(y / u) ** 2 * (s_u / abs(u) ** 2 + s_y / abs(y) ** 2 - 2 * (s_yu / (y * np.conj(u))).real))
        bias.append(abs(y / u) * abs(1 - s_yu / s_u * u / y) * np.exp(-abs(u) ** 2 / s_u))
    info, rows = run(fatmc, [path], "etfe")
    assert info["q"] == 5 and info["n_e"] is None and info["order"] is None, info
    assert (np.max(bias) > 0.01) == (input_noise > 1.0)
    compare(f"etfe, input noise {input_noise}", info, rows, *(np.array(x)[:, :, None] for x in (g, variance, bias)))


def transient_means(columns, periods, count, order=2):
    z = np.hstack([pick(columns, "y"), pick(columns, "u")])
    z = np.fft.fft(z, axis=0) / np.sqrt(len(z))
    excited = [periods * k for k in LINES]
    candidates = np.array([m for m in range(excited[0] - periods + 1, excited[-1] + periods) if m not in set(excited)])
    mean, noise = [], []
    for m in excited:
        start = min(max(np.sum(candidates < m) - count // 2, 0), len(candidates) - count)
        bins = candidates[start:start + count]
        basis = np.vander((bins - m) / max(abs(bins - m)), order + 1, increasing=True)
        pinv = np.linalg.pinv(basis)
        residual = z[bins] - basis @ (pinv @ z[bins])
        mean.append(z[m] - pinv[0] @ z[bins])
        noise.append((1 + pinv[0] @ pinv[0]) * residual.T @ residual.conj() / (count - order - 1))
    return np.array(mean), np.array(noise)


def check_tlpm(fatmc, directory, rng):
    columns = record(rng, 1, periods=7)
    path = write(directory, "tlpm", columns, {"reference": ["r0"], "input": ["u0"], "output": ["y0", "y1"]})
    for options, count in (((), 9), (("--n-transient", "5"), 10), (("--n-transient", "4", "--order", "3"), 8)):
        order = 3 if "--order" in options else 2
        mean, noise = transient_means(columns, 7, count, order)
        g, variance = [], []
        for z, c in zip(mean, noise):
            v = np.hstack([np.eye(2), -(z[:2] / z[2])[:, None]])
            g.append(z[:2] / z[2])
            variance.append(np.diag(v @ c @ v.conj().T).real / abs(z[2]) ** 2)
        info, rows = run(fatmc, [path], "tlpm", options)
        assert info["q"] == count - order - 1, info
        for row in rows:
            assert float(row["bias"]) < 1e-12  # SNR of the inputs is some 40 dB
            row["bias"] = ""
        compare("tlpm " + " ".join(options), info, rows, *(np.array(x)[:, :, None] for x in (g, variance)))


def check_robust(fatmc, directory, rng):
    roles = {"reference": ["r0", "r1"], "input": ["u0", "u1"], "output": ["y0", "y1"]}
    experiments = [record(rng, 2, periods=2) for _ in range(5)]
    paths = [write(directory, f"robust{i}", columns, roles) for i, columns in enumerate(experiments)]
    means = np.array([transient_means(columns, 2, 10)[0] for columns in experiments])
    known = np.array([(np.fft.fft(pick(c, "r"), axis=0) / np.sqrt(2 * PERIOD))[[2 * k for k in LINES]]
                      for c in experiments])
    solved = [solve(known[:, k].T, means[:, k].T, 2, 2, True, None) for k in range(len(LINES))]
    info, rows = run(fatmc, paths, "robust")
    assert info["q"] == 3 and info["records"] == 5, info
    compare("robust", info, rows, np.array([s[0] for s in solved]), np.array([s[1] for s in solved]))


def bins_of(columns):
    z = np.hstack([pick(columns, "y"), pick(columns, "u")])
    return np.fft.fft(z, axis=0) / np.sqrt(len(z)), np.fft.fft(pick(columns, "r"), axis=0) / np.sqrt(len(z))


def window(bin_, width, last):
    start = min(max(bin_ - width // 2, 1), last - width + 1)
    return start + np.arange(width)


def check_arbitrary(fatmc, directory, rng):
    columns = record(rng, 2, samples=801)
    z, r = bins_of(columns)
    last = 400
    for what, roles in (("direct", {}), ("indirect", {"reference": ["r0", "r1"]})):
        path = write(directory, "arbitrary-" + what, columns, {**roles, "input": ["u0", "u1"], "output": ["y0", "y1"]}, False)
        indirect = bool(roles)
        solved = []
        for m in range(1, last + 1):
            bins = window(m, 19, last)
            d = (bins - m) / max(abs(bins - m))
            known = r[bins].T if indirect else z[bins, 2:].T
            l = np.vstack([d ** s * known for s in range(3)] + [d ** s for s in range(3)])
            solved.append(solve(l, z[bins].T if indirect else z[bins, :2].T, 2, 2, indirect, None))
        info, rows = run(fatmc, [path], "arbitrary")
        assert info["q"] == 10 and info["lines"] == list(range(1, last + 1)), info["q"]
        compare("arbitrary, " + what, info, rows, np.array([s[0] for s in solved]), np.array([s[1] for s in solved]))


def rational(l_known, x, y, order, transient):
    """One channel: b_0, rows that map the channel's noise to b_0 and to the residuals, residuals, poles."""
    columns = [x ** s * k for s in range(order + 1) for k in l_known]
    columns += [x ** s for s in range(order + 1)] if transient else []
    columns += [-y * x ** s for s in range(1, order + 1)]
    l = np.array(columns).T
    pinv = np.linalg.pinv(l)
    theta = pinv @ y
    a = np.concatenate([theta[-order:][::-1], [1.0]])
    weight = np.polyval(a, x)
    n = len(l_known)
    return theta[:n], pinv[:n] * weight, (np.eye(len(x)) - l @ pinv) * weight, y - l @ theta, np.roots(a)


def check_lrm(fatmc, directory, rng):
    columns = record(rng, 2, samples=601)
    z, r = bins_of(columns)
    last, n_e = 300, 8
    path = write(directory, "lrm", columns, {"reference": ["r0", "r1"], "input": ["u0", "u1"], "output": ["y0", "y1"]}, False)
    g, variance, keep = [], [], []
    for m in range(1, last + 1):
        bins = window(m, 2 * n_e + 1, last)
        x = (bins - m) / max(abs(bins - m))
        fits = [rational(r[bins].T, x, z[bins, c], 2, True) for c in range(4)]
        spacing = x[1] - x[0]
        keep.append(all(np.min(abs(np.subtract.outer(f[4], x))) > 0.25 * spacing for f in fits))
        theta = np.array([f[0] for f in fits])
        c_z = np.array([[np.vdot(d[3], c[3]) / np.sum(c[2] * d[2].conj()) for d in fits] for c in fits])
        inverse = np.linalg.inv(theta[2:])
        gm = theta[:2] @ inverse
        v = np.hstack([np.eye(2), -gm])
        var = np.zeros((2, 2))
        for i in range(2):
            for j in range(2):
                rows = np.array([v[i, c] * inverse[:, j] @ fits[c][1] for c in range(4)])
                var[i, j] = np.sum(c_z * (rows @ rows.conj().T)).real
        g.append(gm)
        variance.append(var)
    info, rows = run(fatmc, [path], "lrm", ("--n-e", str(n_e)))
    fallback = [m for m, kept in zip(range(1, last + 1), keep) if not kept]
    assert info["fallback_lines"] == fallback, (info["fallback_lines"], fallback)
    rows = [row for row in rows if int(row["line"]) not in set(fallback)]
    print(f"lrm: {len(fallback)} of {last} lines fall back")
    compare("lrm", info, rows, np.array(g)[keep], np.array(variance)[keep])


def check_welch(fatmc, directory, rng):
    columns = record(rng, 2, samples=4000)
    path = write(directory, "welch", columns, {"input": ["u0", "u1"], "output": ["y0", "y1"]}, False)
    y, u = pick(columns, "y"), pick(columns, "u")
    spec = lambda a, b: signal.csd(b, a, fs=RATE, window="hann", nperseg=200, noverlap=100, detrend="constant")[1][1:100]
    s_uu = np.array([[spec(u[:, i], u[:, j]) for j in range(2)] for i in range(2)]).transpose(2, 0, 1)
    s_yu = np.array([[spec(y[:, i], u[:, j]) for j in range(2)] for i in range(2)]).transpose(2, 0, 1)
    s_yy = np.array([spec(y[:, i], y[:, i]).real for i in range(2)]).T
    segments = 39
    hann = signal.get_window("hann", 200)
    rho = hann[:100] @ hann[100:] / (hann @ hann)
    effective = segments / (1 + 2 * (1 - 1 / segments) * rho ** 2)
    inverse = np.linalg.inv(s_uu)
    g = s_yu @ inverse
    explained = np.einsum("kij,kij->ki", g, s_yu.conj()).real
    variance = ((s_yy - explained) / (effective - 2))[:, :, None] * np.einsum("kjj->kj", inverse).real[:, None, :]
    info, rows = run(fatmc, [path], "welch", ("--segment", "200"))
    assert info["q"] == int(effective) - 2 and len(info["coherence"]) == 99, info["q"]
    compare("welch", info, rows, g, variance)
    assert np.max(abs(np.array(info["coherence"]) - explained / s_yy)) < 1e-9


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    rng = np.random.default_rng(331)
    with tempfile.TemporaryDirectory() as directory:
        for check in (check_etfe, check_tlpm, check_robust, check_arbitrary, check_lrm, check_welch):
            check(sys.argv[1], directory, rng)


if __name__ == "__main__":
    main()
