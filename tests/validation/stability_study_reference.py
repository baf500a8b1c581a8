#!/usr/bin/python3
"""The stability study again, in numpy.

    stability_study_reference.py FATMC            flies 12 trials; all tables from the arrays of the database, and one trial
                                                  from its record: LPM, readings of the bias, H-infinity, p
    stability_study_reference.py FATMC --bounds   experiment: share of the elements whose true interpolation bias each
                                                  reading bounds (linear plant, calm air, 20 flights)
    stability_study_reference.py FATMC --lag DB   experiment: nominal H-infinity against models that lag behind the
                                                  estimates of a database of the coverage study

The experiments are the reasons in campaigns/stability/README.md.
"""
import json
import pathlib
import subprocess
import sys
import tempfile

import numpy as np
from scipy import stats

import campaign_arrays
import lpm_reference

ROOT = pathlib.Path(__file__).resolve().parents[2]
Q = 10  # degrees of freedom
N_E = 9
LINES = lpm_reference.table_5_1_lines()
F = 0.005 * np.array(LINES)
READINGS = {"b of (2.145)": "limit", "b by line numbers (C.6)": "numbers", "b of the actual offsets": "offsets",
            "b of the magnitude": "magnitude", "without b": "off"}


def run(*words):
    return subprocess.run([str(w) for w in words], check=True, cwd=ROOT, capture_output=True, text=True).stdout


def bias(estimate, reading):
    """runs x lines x elements; (2.145) with C.14 under a reading of core/ident/bias_reading.h."""
    out = np.zeros(estimate.shape)
    if reading == "off":
        return out
    values = abs(estimate) if reading == "magnitude" else estimate
    for k in range(len(F)):
        first = min(max(k - N_E, 0), len(F) - 2 * N_E - 1)
        window = np.arange(first, first + 2 * N_E + 1)
        d = (window - k).astype(float) if reading == "numbers" else F[window] - F[k]
        fit = np.linalg.pinv(np.vander(d, 3, increasing=True))
        g = (fit @ values[:, window].transpose(1, 0, 2).reshape(len(window), -1)).reshape(3, *out[:, k].shape)
        width = 2 * np.sqrt((1 - np.sqrt(0.5)) * abs(g[0] / g[2]))
        span = (d[-1] - d[0]) * (2 * N_E + 1) / (2 * N_E)
        moment = abs(fit[0] @ (2 * d) ** 4) if reading == "offsets" else 3 / 35 * span ** 4
        out[:, k] = moment / width ** 4 * abs(estimate[:, k])
    return out


def h_infinity(x, radii):
    """sqrt(n_in) sigma_max(diag(|w_j|) X); radii ... x out x in."""
    column = np.sqrt((radii ** 2).sum(axis=-2))
    return np.sqrt(3) * np.linalg.svd(column[..., :, None] * x, compute_uv=False)[..., 0]


def confidence(kappa, sigma, systematic):
    """min and Bonferroni over the elements (last axis)."""
    radius = kappa[..., None] * (systematic + sigma) - systematic
    p = np.where(radius > 0, stats.f.cdf((np.maximum(radius, 0) / sigma) ** 2, 2, 2 * Q), 0)
    return p.min(-1), np.maximum(0, 1 - (1 - p).sum(-1))


def true_response(fatmc):
    model = json.loads(run(fatmc, "linearize", "campaigns/models/fat.toml", "--format", "json"))["sampled"]
    a, b, c, d = (np.array(model[k]) for k in "ABCD")
    return np.array([c @ np.linalg.solve(np.exp(2j * np.pi * f * 0.02) * np.eye(len(a)) - a, b) + d for f in F])


def decibel(x):
    return 20 * np.log10(x)


def check_tables(fatmc, database, a):
    """Every row that follows from the arrays alone."""
    table = json.loads(run(fatmc, "tables", database, "--format", "json"))
    n = len(a["limit.hinf"])
    between = lambda low, high: (F > low - 1e-4) & (F < high + 1e-4)
    around = between(0.29, 0.35) & ~between(0.33, 0.34)
    worst, checked = 0.0, 0
    for row in table:
        parts = row["quantity"].split(", ")
        if parts[-1] in ("min", "Bonferroni"):
            rule, name = ("" if parts[-1] == "min" else "_bonferroni"), parts[-2]
        else:
            rule, name = None, parts[-1]
        what = parts[0]
        if row["table"] == "Section 5.4" or row["table"] == "Section 5.6" and rule is None:
            h, s = a["hinf_nominal"], a["ssv_nominal"]
            value = {"share of all runs with nominal H-infinity below 0 dB": 100 * (h < 1).all(1).mean(),
                     "share of all runs with nominal ssv below 0 dB": 100 * (s < 1).all(1).mean(),
                     "median of nominal H-infinity": decibel(np.median(h[:, -1])),
                     "lines with a median of nominal H-infinity below -10 dB":
                         100 * (decibel(np.median(h, 0)) < -10).mean(),
                     "nominal H-infinity above ssv": decibel(np.median(h, 0) / np.median(s, 0)).mean(),
                     "share of all runs with an input SNR below the limit at a line":
                         100 * (a["snr_min_db"] < 20).any(1).mean()}[what]
        elif row["table"] in ("Fig. 5-6", "Fig. 5-7"):
            key = READINGS[name]
            h, s = a[key + ".hinf"], a[key + ".ssv"]
            if what.startswith("H-infinity above"):
                value = decibel(np.median(h, 0) / np.median(s, 0)).mean()
            else:
                part = {"0.29-0.40 Hz": between(0.29, 0.40), "2.1-2.5 Hz": between(2.1, 2.5)}.get(row["row"], F > 0)
                value = 100 * ((h if row["table"] == "Fig. 5-6" else s)[:, part] > 1).mean(0).max()
        else:
            ssv = row["table"] in ("Fig. 5-9", "Fig. 5-10") or row["row"].endswith("ssv")
            p = a[READINGS[name] + (".p_ssv" if ssv else ".p_hinf") + rule].copy()
            if row["table"] == "Section 5.6":
                p[(a["ssv_nominal" if ssv else "hinf_nominal"] >= 1) | (a["snr_min_db"] < 20)] = 0
            part = {"0.29-0.35 Hz": around, "0.35-2.89 Hz": between(0.35, 2.89)}.get(row["row"], F > 0)
            if row["row"].endswith(" Hz") and "-" not in row["row"]:
                part = between(float(row["row"][:-3]), float(row["row"][:-3]))
            product = p.prod(1)
            value = {"smallest median of p": np.median(p[:, part], 0).min(),
                     "smallest 25 % quantile of p": np.quantile(p[:, part], 0.25, axis=0).min(),
                     "largest 25 % quantile of p": np.quantile(p[:, part], 0.25, axis=0).max(),
                     "share of all runs with p = 0": 100 * (p[:, part] == 0).mean(),
                     "share of all runs with p = 0 at a line": 100 * (p == 0).any(1).mean(),
                     "lines with p = 0 in 50 runs": 50 * (p == 0).sum(1).mean(),
                     "share of all runs above 99 %": 100 * (product > 0.99).mean(),
                     "share of all runs above 90 %": 100 * (product > 0.9).mean(),
                     "share of all runs at zero": 100 * (product == 0).mean()}[what]
        worst = max(worst, abs(value - row["value"]))
        assert row["n"] == n and (row["low"] is None or row["low"] <= row["high"])
        checked += 1
    print(f"{checked} rows of {n} trials, largest difference {worst:.2e}")
    return checked > 150 and worst < 1e-9


def check_trial(fatmc, folder, database, a, repetition):
    """The arrays of one trial from its record."""
    record = f"{folder}/flight.csv"
    # Its exit code says whether the bits of the row came out again, which is not the question here.
    subprocess.run([fatmc, "replay", database, f"nonlinear/{repetition}", "-o", record], cwd=ROOT, capture_output=True)
    with open(record, encoding="utf-8") as file:
        names = file.readline().strip().split(",")
    samples = np.loadtxt(record, delimiter=",", skiprows=1)
    pick = lambda *wanted: samples[:, [names.index(name) for name in wanted]]
    g, variance, _, _ = lpm_reference.fast_lpm(pick("p", "q", "r"), pick("xi_c", "eta_c", "zeta_c"),
                                               pick("r_p", "r_q", "r_r"), LINES, 2, 10000, 50.0, N_E, 2, 5)
    speed = 24.0 / pick("V").mean()  # (3.4)
    g, variance = g * speed, variance * speed ** 2
    k = 0.1 * np.eye(3)
    loop = lambda plant: np.linalg.solve(np.eye(3) + k @ plant, np.broadcast_to(k, plant.shape))
    nominal = true_response(fatmc)
    worst = {"hinf_nominal": np.abs(h_infinity(loop(nominal), abs(g - nominal)) / a["hinf_nominal"][repetition] - 1).max()}
    estimate, sigma = g.reshape(1, len(F), 9), np.sqrt(variance.reshape(len(F), 9))
    for key in READINGS.values():
        systematic = bias(estimate, key)[0] + 0.03 * abs(estimate[0])
        h = h_infinity(loop(g), (systematic + sigma).reshape(-1, 3, 3))
        worst[key + ".hinf"] = np.abs(h / a[key + ".hinf"][repetition] - 1).max()
        for name, value in (("hinf", h), ("ssv", a[key + ".ssv"][repetition])):
            for rule, p in zip(("", "_bonferroni"), confidence(1 / value, sigma, systematic)):
                worst[f"{key}.p_{name}{rule}"] = np.abs(p - a[f"{key}.p_{name}{rule}"][repetition]).max()
    name, value = max(worst.items(), key=lambda item: item[1])
    print(f"trial {repetition} from its record: {len(worst)} arrays, largest difference {value:.2e} ({name})")
    return value < 1e-6


def compare(fatmc):
    with tempfile.TemporaryDirectory() as folder:
        database = f"{folder}/stability.db"
        run(fatmc, "run", "campaigns/stability/spec.toml", "--trials", "12", "--db", database)
        a = campaign_arrays.arrays(database, "nonlinear")
        good = check_tables(fatmc, database, a)
        return 0 if check_trial(fatmc, folder, database, a, 5) and good else 1


def bounds(fatmc):
    spec = (ROOT / "campaigns/coverage/spec.toml").read_text(encoding="utf-8")
    spec = spec[:spec.index("[watch]")] + '[[cell]]\nname = "nonlinear"\nrepetitions = 20\nplant = "linear"\n' \
        'turbulence_sigma_m_s = 0.0\nset."experiment.imu.grade" = "none"\ncompare = false\n'
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "calm.toml"
        path.write_text(spec.replace('"../', f'"{ROOT}/campaigns/').replace('"published', f'"{ROOT}/campaigns/coverage/published'),
                        encoding="utf-8")
        run(fatmc, "run", path, "--db", f"{folder}/calm.db")
        a = campaign_arrays.arrays(f"{folder}/calm.db", "nonlinear")
    error = (a["error_re"] + 1j * a["error_im"]).reshape(-1, len(F), 9)
    estimate = error + true_response(fatmc).reshape(len(F), 9)
    inner = slice(N_E, len(F) - N_E)
    for name, key in READINGS.items():
        if key == "off":
            continue
        ratio = bias(estimate, key) / abs(error)
        print(f"{name:26s} bounds {100 * (ratio >= 1).mean():5.1f} % of the elements, {100 * (ratio[:, inner] >= 1).mean():5.1f} % "
              f"away from the borders; b over the true bias, median of the diagonal: {np.median(ratio[:, inner][..., [0, 4, 8]]):.2f}")
    return 0


def ssv(fatmc, x, radii):
    """Upper bound by the program itself; x ... x in x out, radii ... x out x in."""
    loops, w = x.reshape(-1, 9), radii.swapaxes(-1, -2).reshape(-1, 9)
    head = ["id"] + [f"X{part}{i}{j}" for i in (1, 2, 3) for j in (1, 2, 3) for part in ("re", "im")]
    head += [f"w_out{i}_in{j}" for j in (1, 2, 3) for i in (1, 2, 3)]
    columns = np.column_stack([np.arange(len(loops)), loops.view(float), w])
    with tempfile.TemporaryDirectory() as folder:
        np.savetxt(f"{folder}/f.csv", columns, delimiter=",", header=",".join(head), comments="", fmt=["%d"] + ["%.17g"] * 27)
        subprocess.run([fatmc, "ssv", f"{folder}/f.csv", "-o", f"{folder}/o.csv"], cwd=ROOT, capture_output=True)
        rows = pathlib.Path(f"{folder}/o.csv").read_text(encoding="utf-8").split()[1:]
    return np.array([float(row.split(",")[1]) for row in rows]).reshape(radii.shape[:-2])


def lag(fatmc, database):
    a = campaign_arrays.arrays(database, "nonlinear")
    truth = true_response(fatmc)
    estimate = (a["error_re"] + 1j * a["error_im"]).reshape(-1, len(F), 3, 3) + truth
    k = 0.1 * np.eye(3)
    for ticks in (0.0, 1.0, 1.5, 2.0):
        nominal = truth * np.exp(2j * np.pi * F * 0.02 * ticks)[:, None, None]
        x = np.linalg.solve(np.eye(3) + k @ nominal, np.broadcast_to(k, nominal.shape))
        x = np.ascontiguousarray(np.broadcast_to(x, estimate.shape))
        median = decibel(np.median(h_infinity(x, abs(estimate - nominal)), 0))
        below = median - decibel(np.median(ssv(fatmc, x, abs(estimate - nominal)), 0))
        print(f"G_n {ticks} ticks ahead: median of nominal H-infinity, dB: " +
              ", ".join(f"{median[abs(F - f).argmin()]:.1f} at {f} Hz" for f in (0.285, 0.34, 0.5, 1.0, 2.0, 2.89)) +
              f"; ssv {below.mean():.1f} dB below")
    return 0


if __name__ == "__main__":
    if len(sys.argv) == 2:
        sys.exit(compare(sys.argv[1]))
    if sys.argv[2:] == ["--bounds"]:
        sys.exit(bounds(sys.argv[1]))
    if len(sys.argv) == 4 and sys.argv[2] == "--lag":
        sys.exit(lag(sys.argv[1], sys.argv[3]))
    sys.exit(__doc__)
