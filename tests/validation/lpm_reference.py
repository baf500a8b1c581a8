#!/usr/bin/env python3
"""An independent fast LPM in numpy, compared with `fatmc estimate`.

Usage: lpm_reference.py FATMC [closed-loop|f16|all]
Written from the conventions of estimate.json alone: plain loops, lstsq and explicit inverses, one matrix a line. The
closed-loop record is made here (three inputs, Table 5-1's 73 lines, process and measurement noise, a start outside the
periodic state). The F-16 record needs FATMC_DATA; without it that part is skipped with exit code 77.
"""
import csv
import json
import os
import subprocess
import sys
import tempfile

import numpy as np

TOLERANCE = 1e-9  # relative to the largest of its kind at a line; round-off is about 1e-12


def dft(x, bins):
    return np.fft.fft(x, axis=0)[bins] / np.sqrt(len(x))


def transient(z, excited, periods, n, order):
    """Z^ at the excited bins and the covariance of its noise; z: all bins x channels."""
    half = (len(z) - 1) // 2
    candidates = np.array([m for m in range(excited[0] - (periods - 1), min(excited[-1] + periods - 1, half) + 1)
                           if m not in set(excited)])
    out, noise = [], []
    for m in excited:
        left = np.sum(candidates < m)
        start = min(max(left - n, 0), len(candidates) - 2 * n)
        bins = candidates[start:start + 2 * n]
        r = (bins - m) / max(abs(bins - m))
        k = np.vander(r, order + 1, increasing=True)
        fit = np.linalg.lstsq(k, z[bins], rcond=None)[0]
        out.append(z[m] - fit[0])
        residual = (z[bins] - k @ fit).T
        mu_poly = 1.0 + np.linalg.inv(k.T @ k)[0, 0]
        noise.append(mu_poly * residual @ residual.conj().T / (2 * n - order - 1))
    return np.array(out), np.array(noise)


def fast_lpm(y, u, r, lines, periods, period, rate, n_e, order, n_transient):
    """G, variance, bias as lines x outputs x inputs, and fields of estimate.json. r is None for a direct estimate."""
    excited = [periods * k for k in lines]
    everything = np.arange(periods * period)
    z, noise = transient(dft(np.hstack([y, u]), everything), excited, periods, n_transient, order)
    n_out, n_in = y.shape[1], u.shape[1]
    known = z[:, n_out:] if r is None else dft(r, excited)
    regressed = z[:, :n_out] if r is None else z
    frequency = np.array(lines) * rate / period
    width = 2 * n_e + 1
    q = width - (order + 1) * n_in
    g_all, variance, ratio = [], [], []
    windows = [min(max(k - n_e, 0), len(lines) - width) + np.arange(width) for k in range(len(lines))]
    for k, window in enumerate(windows):
        d = frequency[window] - frequency[k]
        d = d / max(abs(d))
        l = np.array([np.kron(di ** np.arange(order + 1), known[w]) for di, w in zip(d, window)]).T
        zn = regressed[window].T
        pinv = np.linalg.pinv(l)
        theta = zn @ pinv
        residual = zn - theta @ l
        c_z = residual @ residual.conj().T / q
        s = pinv[:, :n_in]
        a = (s.conj().T @ s).conj()
        if r is None:
            g, c_v, b = theta[:, :n_in], c_z, a
        else:
            g_ur = theta[n_out:, :n_in]
            inv = np.linalg.inv(g_ur)
            g = theta[:n_out, :n_in] @ inv
            v = np.hstack([np.eye(n_out), -g])
            c_v = v @ c_z @ v.conj().T
            b = inv.T @ a @ inv.conj()
        covariance = np.kron(b, c_v)  # of vec G, columns stacked
        g_all.append(g)
        v = np.hstack([np.eye(n_out), -g])
        ratio.append(np.diag(c_v).real / np.diag(v @ noise[k] @ v.conj().T).real)
        variance.append(np.diag(covariance).real.reshape(n_in, n_out).T)
    g_all = np.array(g_all)
    bias, dropped, kept = np.zeros(g_all.shape), np.zeros(g_all.shape), np.zeros(g_all.shape)
    exponent = order + 2 if order % 2 == 0 else order + 1
    for k, window in enumerate(windows):
        d = frequency[window] - frequency[k]
        scale = max(abs(d))
        fit = np.linalg.pinv(np.vander(d / scale, max(order, 2) + 1, increasing=True))
        own = np.linalg.pinv(np.vander(d / scale, order + 1, increasing=True))
        for i in range(n_out):
            for j in range(n_in):
                g0, g2 = fit[0] @ g_all[window, i, j], fit[2] @ g_all[window, i, j] / scale ** 2
                b3db = 2.0 * np.sqrt((1.0 - 1.0 / np.sqrt(2.0)) * abs(g0 / g2))
                dropped[k, i, j] = b3db
                root = np.roots([g2, fit[1] @ g_all[window, i, j] / scale, (1.0 - 1.0 / np.sqrt(2.0)) * g0])
                kept[k, i, j] = abs(root[0] - root[1])
                bias[k, i, j] = abs(own[0] @ (2.0 * d / b3db) ** exponent) * abs(g_all[k, i, j])
    deviation = np.sqrt(np.diagonal(noise, axis1=1, axis2=2).real)
    snr = 20.0 * np.log10((abs(z[:, n_out:]) - deviation[:, n_out:]) / deviation[:, n_out:])
    fields = {"input_snr_db": snr, "deviation": deviation, "output_ratio": np.array(ratio), "linear_dropped": dropped,
              "linear_kept": kept}
    return g_all, np.array(variance), bias, fields


def estimate(fatmc, record, meta, directory, options):
    subprocess.run([fatmc, "estimate", record, "--meta", meta, "-o", directory] + options, check=True,
                   stdout=subprocess.DEVNULL)
    with open(os.path.join(directory, "estimate.json"), encoding="utf-8") as file:
        info = json.load(file)
    with open(os.path.join(directory, "frm.csv"), encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    return info, rows


def compare(what, info, rows, columns, roles, rate):
    pick = lambda names: np.stack([columns[name] for name in names], axis=1)
    reference = pick(roles["reference"]) if info["indirect"] else None
    skip = info["skipped_periods"] * info["period_samples"]
    g, variance, bias, fields = fast_lpm(pick(roles["output"])[skip:], pick(roles["input"])[skip:],
                                 None if reference is None else reference[skip:], info["lines"], info["periods"],
                                 info["period_samples"], rate, info["n_e"], info["order"], info["n_transient"])
    expected_rows = len(info["lines"]) * len(roles["output"]) * len(roles["input"])
    assert len(rows) == expected_rows, f"{what}: {len(rows)} rows, expected {expected_rows}"
    worst = {"G": 0.0, "variance": 0.0, "bias": 0.0}
    for row in rows:
        k = info["lines"].index(int(row["line"]))
        i, j = roles["output"].index(row["output"]), roles["input"].index(row["input"])
        assert abs(float(row["frequency_hz"]) - int(row["line"]) * rate / info["period_samples"]) < 1e-9
        value = float(row["re"]) + 1j * float(row["im"])
        worst["G"] = max(worst["G"], abs(value - g[k, i, j]) / np.max(abs(g[k])))
        worst["variance"] = max(worst["variance"], abs(float(row["variance"]) / variance[k, i, j] - 1.0))
        worst["bias"] = max(worst["bias"], abs(float(row["bias"]) / bias[k, i, j] - 1.0))
    found = {"input_snr_db": info["input_snr_db"], "deviation": info["noise"]["deviation"],
             "output_ratio": info["nonlinear_distortion"]["output_ratio"], **info["three_db_hz"]}
    for name, value in found.items():
        value = np.array([[np.nan if v is None else v for v in np.ravel(row)] for row in value], dtype=float).reshape(
            fields[name].shape)
        known = np.isfinite(value)
        assert known.mean() > 0.9 or name == "input_snr_db", name
        worst[name] = np.max(abs(value[known] / fields[name][known] - 1.0), initial=0.0)
    print(f"{what}: largest relative differences " + ", ".join(f"{k} {v:.1e}" for k, v in worst.items()))
    assert max(worst.values()) < TOLERANCE, f"{what}: {worst}"


def table_5_1_lines():
    lines = set()
    for start, stop, step in ((57, 76, 1), (76, 116, 2), (116, 578, 14)):
        lines.update(range(start, stop + 1, step))
    assert len(lines) == 73
    return sorted(lines)


def closed_loop_record():
    """x+ = A x + B u + w, y = C x + v, u = K (r - y), held for 0.02 s."""
    rng = np.random.default_rng(20181)
    period, periods, rate = 10000, 2, 50.0
    n = np.arange(period)
    r = np.zeros((period, 3))
    for k in table_5_1_lines():
        r += 0.03 * np.cos(2 * np.pi * k * n[:, None] / period + 2 * np.pi * rng.random(3))
    r = np.tile(r, (periods, 1))
    a = np.array([[0.80, 0.02, 0.05], [0.01, 0.93, -0.03], [-0.06, 0.02, 0.97]])
    b = np.array([[1.2, 0.1, 0.3], [0.05, 0.9, -0.1], [-0.2, 0.1, 0.8]])
    x = np.array([0.5, -0.3, 0.2])
    y, u = np.zeros(r.shape), np.zeros(r.shape)
    for i in range(len(r)):
        y[i] = x + 1e-4 * rng.standard_normal(3)
        u[i] = 0.1 * (r[i] - y[i])
        x = a @ x + b @ u[i] + 2e-4 * rng.standard_normal(3)
    columns = {f"r_{c}": r[:, i] for i, c in enumerate("pqr")}
    columns.update({f"u_{c}": u[:, i] for i, c in enumerate("pqr")})
    columns.update({c: y[:, i] for i, c in enumerate("pqr")})
    return columns, rate


def check_closed_loop(fatmc, directory):
    columns, rate = closed_loop_record()
    record, meta = os.path.join(directory, "loop.csv"), os.path.join(directory, "loop.toml")
    with open(record, "w", encoding="utf-8") as file:
        file.write(",".join(columns) + "\n")
        for row in zip(*columns.values()):
            file.write(",".join(repr(float(value)) for value in row) + "\n")
    roles = {"reference": ["r_p", "r_q", "r_r"], "input": ["u_p", "u_q", "u_r"], "output": ["p", "q", "r"]}
    for name, used, options in (("indirect", roles, []),
                                ("indirect, order 4", roles, ["--order", "4", "--n-e", "12"]),
                                ("indirect, order 1", roles, ["--order", "1", "--n-e", "7", "--n-transient", "4"]),
                                ("direct", {k: v for k, v in roles.items() if k != "reference"}, [])):
        with open(meta, "w", encoding="utf-8") as file:
            file.write(f"[record]\nrate_hz = {rate}\n")
            for role, names in used.items():
                file.write(f"{role} = {json.dumps(names)}\n")
            if "reference" not in used:  # noise hides lines and period in measured inputs
                file.write(f"period_samples = 10000\nexcited_lines = {table_5_1_lines()}\n")
        info, rows = estimate(fatmc, record, meta, directory, options)
        assert info["lines"] == table_5_1_lines() and info["periods"] == 2, info
        assert info["indirect"] == ("reference" in used)
        compare("closed loop, " + name, info, rows, columns, roles, rate)


def check_f16(fatmc, directory):
    data = os.environ.get("FATMC_DATA", "")
    record = os.path.join(data, "f16_gvt", "full_msine_level1.csv")
    if not os.path.exists(record):
        print("skipped: FATMC_DATA does not hold f16_gvt")
        return False
    support = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "support", "f16_record.py")
    meta = os.path.join(directory, "f16.toml")
    subprocess.run([sys.executable, support, meta], check=True)
    table = np.genfromtxt(record, delimiter=",", names=True)
    columns = {name: table[name] for name in table.dtype.names}
    roles = {"reference": ["voltage_V"], "input": ["force_N"], "output": ["acc1", "acc2", "acc3"]}
    for options in ([], ["--n-e", "3"], ["--n-e", "3", "--skip-periods", "1"]):
        info, rows = estimate(fatmc, record, meta, directory, options)
        assert info["period_samples"] == 8192 and len(info["lines"]) == 267, info
        assert info["periods"] == (8 if "--skip-periods" in options else 9)
        compare("F-16 " + " ".join(options), info, rows, columns, roles, 400.0)
    # The three modes that the data's description names, on the narrow window.
    for output, peaks in (("acc2", (5.2, 7.3, 9.2)),):
        f = np.array([float(row["frequency_hz"]) for row in rows if row["output"] == output])
        g = np.array([abs(float(row["re"]) + 1j * float(row["im"])) for row in rows if row["output"] == output])
        inner = np.flatnonzero((g[1:-1] > g[:-2]) & (g[1:-1] > g[2:])) + 1
        highest = inner[np.argsort(g[inner])[::-1][:5]]
        for peak in peaks:
            assert np.min(abs(f[highest] - peak)) < 0.1, f"no peak of {output} near {peak} Hz: {sorted(f[highest])}"
    return True


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    part = sys.argv[2] if len(sys.argv) > 2 else "all"
    with tempfile.TemporaryDirectory() as directory:
        if part in ("closed-loop", "all"):
            check_closed_loop(sys.argv[1], directory)
        if part in ("f16", "all") and not check_f16(sys.argv[1], directory) and part == "f16":
            sys.exit(77)


if __name__ == "__main__":
    main()
