#!/usr/bin/python3
"""The studies of bias and variance again, by numpy from the arrays of their databases.

    chapter4_reference.py FATMC     flies 12 trials of each and compares all tables
    chapter4_reference.py --border  experiment: border factor of white noise for one and three inputs of random phases
    chapter4_reference.py FATMC --unknowns
                                    experiment: errors and bias estimates of 4.2 where poles, zeros and the band are others: the
                                    interpolation error alone of the linear response, in steady state

The experiments are the reasons in campaigns/variance/README.md and campaigns/bias/README.md.
"""
import json
import pathlib
import sqlite3
import subprocess
import sys
import tempfile

import numpy as np

import campaign_arrays

ROOT = pathlib.Path(__file__).resolve().parents[2]


def fly(fatmc, study, folder):
    path = f"{folder}/{study}.db"
    subprocess.run([fatmc, "run", f"campaigns/{study}/spec.toml", "--trials", "12", "--db", path], check=True, cwd=ROOT,
                   capture_output=True)
    table = subprocess.run([fatmc, "tables", path, "--format", "json"], check=True, cwd=ROOT, capture_output=True, text=True)
    return path, json.loads(table.stdout)


def metric(path, name):
    rows = sqlite3.connect(path).execute("SELECT value FROM metrics WHERE name = ? ORDER BY repetition", (name,))
    return np.array([value for value, in rows])


def check_bias(fatmc, folder):
    path, table = fly(fatmc, "bias", folder)
    a = campaign_arrays.arrays(path, "clean")
    f = a["frequency_hz"][0]
    mean = {key: (a[f"{key}.ratio_re"] + 1j * a[f"{key}.ratio_im"]).mean(axis=0) for key in ("pitch", "yaw")}
    db = {key: 20 * np.log10(abs(value)) for key, value in mean.items()}
    deg = {key: np.degrees(np.angle(value)) for key, value in mean.items()}
    places = {"phugoid": ("pitch", 0.082), "short period": ("pitch", 0.48), "zero of r/zeta": ("yaw", 0.05),
              "Dutch roll": ("yaw", 0.33)}
    worst, checked = 0.0, 0
    for row in table:
        what = row["quantity"].split(", ")[0]
        if row["table"] == "4-2" or what == "observed amplification":
            key, hz = places[row["row"]]
            k = abs(f - hz).argmin()
            value = {"magnitude error": db[key][k], "phase error": deg[key][k],
                     "observed amplification": 20 * np.log10(abs(db[key][k] / db[key].mean()))}[what]
        elif row["table"] in ("4-3", "4-4"):
            key = row["row"].split()[0]
            value = {"mean magnitude error": db[key].mean(), "upper magnitude error": db[key].max(),
                     "lower magnitude error": db[key].min(), "upper phase error": deg[key].max(),
                     "lower phase error": deg[key].min()}[what]
        elif row["table"] == "4-5":
            f0, damping = (0.082, 0.077) if row["row"] == "phugoid" else (0.05, 0.199)
            constant = 0.857 if row["quantity"].endswith("0.857") else 0.0857 * 8
            value = 20 * np.log10(constant * (0.1 / (2 * damping * f0)) ** 4)
        else:
            key = "pitch" if row["row"] == "phugoid" else "yaw"
            reading = {"b of (2.145)": "limit", "b of the actual offsets": "offsets", "b of the magnitude": "magnitude"}
            b = metric(path, f"{key}.bias.{reading[row['quantity'].split(', ')[1]]}")
            value = (20 * np.log10(1 + b)).mean()
        worst, checked = max(worst, abs(value - row["value"])), checked + 1
    print(f"bias: {checked} rows, largest difference {worst:.2e}")
    return checked == 30 and worst < 1e-9


def check_variance(fatmc, folder):
    path, table = fly(fatmc, "variance", folder)
    a = campaign_arrays.arrays(path, "light turbulence")
    f = a["frequency_hz"][0]
    shape = (-1, len(f), 9)
    g = (a["g_re"] + 1j * a["g_im"]).reshape(shape)
    between = (abs(g - g.mean(axis=0)) ** 2).sum(axis=0) / (len(g) - 1)
    estimated = np.median(a["variance"].reshape(shape), axis=0)
    at = lambda hz: abs(f - hz).argmin()
    ends = {"low border": (at(0.05), at(0.15)), "high border": (at(5.0), at(4.9))}
    parts = {"lines of Fig. 4-3, all alike": f > 0, "0.15-4.9 Hz": (f > 0.1499) & (f < 4.9001), "below 0.15 Hz": f < 0.1499,
             "above 4.9 Hz": f > 4.9001}
    s = lambda place: (np.linalg.pinv(np.vander((np.arange(21) - place) / 10.0, 3, increasing=True))[0] ** 2).sum()
    worst, checked = 0.0, 0
    for row in table:
        if row["table"] == "Section 4.3.2":
            ratio = (10 * np.log10(estimated / between)).mean(axis=1)
            value = (np.trapz(ratio, f) / (f[-1] - f[0]) if row["row"].endswith("they stand for") else
                     ratio[parts[row["row"]]].mean())
        else:
            edge, inner = ends[row["row"]]
            value = {"border factor, between runs": (between[edge] / between[inner]).mean(),
                     "border factor, medians of the estimates": (estimated[edge] / estimated[inner]).mean(),
                     "border factor, white noise, one input": s(0) / s(10)}[row["quantity"]]
        worst, checked = max(worst, abs(value - row["value"]) / max(1, abs(value))), checked + 1
    print(f"variance: {checked} rows, largest difference {worst:.2e}")
    return checked == 11 and worst < 1e-9


def border(draws=2000):
    random = np.random.default_rng(1)

    def gain(offsets, inputs):
        d = offsets / abs(offsets).max()
        phases = np.exp(2j * np.pi * random.random((inputs, len(d))))
        regressor = np.vstack([d ** g * phases for g in range(3)])
        return np.diag(np.linalg.inv(regressor @ regressor.conj().T)).real[:inputs].mean()

    for n_e in (9, 10):
        for inputs in (1, 3):
            window = np.arange(2 * n_e + 1)
            edge, middle = ([gain(window - place, inputs) for _ in range(draws)] for place in (0, n_e))
            print(f"n_E {n_e}, {inputs} input(s): edge over middle {np.mean(edge) / np.mean(middle):.2f} (means), "
                  f"{np.median(edge) / np.median(middle):.2f} (medians)")
    return 0


def second_order(s, hertz, damping):
    w = 2 * np.pi * hertz
    return s * s + 2 * damping * w * s + w * w


def interpolation_errors(base, change, first_hz=0.05, n_e=10, draws=50, gain=0.5):
    """Errors of the mean of the indirect estimate of q/eta_c and r/zeta_c, and b/|G| at 0.08 and 0.33 Hz, by reading.

    `base`: response by frequency, `change(s, G)` alters it in place. No turn coordinator, no transient."""
    f = np.round(np.arange(round(100 * first_hz), 501)) / 100
    g = base(f)
    change(2j * np.pi * f, g)
    amplitude = np.array([0.007, 0.0031, 0.006])
    random = np.random.default_rng(4)
    lines, windows = len(f), []
    for k in range(lines):
        first = min(max(k - n_e, 0), lines - 2 * n_e - 1)
        windows.append(np.arange(first, first + 2 * n_e + 1))
    windows = np.array(windows)
    d = (windows - np.arange(lines)[:, None]) * 0.01
    powers = np.stack([np.ones_like(d), d / 0.1, (d / 0.1) ** 2], axis=2)  # line x window x 3
    loop = np.linalg.inv(np.eye(3) + gain * g) * gain
    total = np.zeros((lines, 3, 3), complex)
    b = {name: [[], []] for name in ("(2.145)", "offsets", "magnitude")}
    row = np.linalg.pinv(powers)  # line x 3 x window
    for _ in range(draws):
        r = amplitude * np.exp(2j * np.pi * random.random((lines, 3)))
        u = np.einsum("kij,kj->ki", loop, r)
        z = np.concatenate([np.einsum("kij,kj->ki", g, u), u], axis=1)
        regressor = (powers[:, :, :, None] * r[windows][:, :, None, :]).reshape(lines, 2 * n_e + 1, 9)
        theta = np.linalg.pinv(regressor) @ z[windows]  # line x 9 x 6
        constant = theta[:, :3].transpose(0, 2, 1)      # line x 6 x 3
        estimate = constant[:, :3] @ np.linalg.inv(constant[:, 3:])
        with np.errstate(divide="ignore", invalid="ignore"):  # elements that are zero; nobody reads them
            total += estimate / g / draws
        for place, (element, hz) in enumerate((((1, 1), 0.08), ((2, 2), 0.33))):
            k = abs(f - hz).argmin()
            e = estimate[windows[k], element[0], element[1]]
            for name, values in (("(2.145)", e), ("offsets", e), ("magnitude", abs(e))):
                psi = row[k] @ values
                width = 2 * np.sqrt((1 - np.sqrt(0.5)) * abs(psi[0] / psi[2])) * 0.1
                span = (d[k, -1] - d[k, 0]) * (2 * n_e + 1) / (2 * n_e)
                moment = abs(row[k][0] @ (2 * d[k]) ** 4) if name == "offsets" else 3 / 35 * span ** 4
                b[name][place].append(20 * np.log10(1 + moment / width ** 4))
    return f, total, {name: [np.mean(x) for x in value] for name, value in b.items()}


def unknowns(fatmc):
    model = json.loads(subprocess.run([fatmc, "linearize", "campaigns/models/fat.toml", "--format", "json"], check=True,
                                      cwd=ROOT, capture_output=True, text=True).stdout)["sampled"]
    a, b, c, d = (np.array(model[key]) for key in "ABCD")
    base = lambda f: np.array([c @ np.linalg.solve(np.exp(2j * np.pi * x * 0.02) * np.eye(len(a)) - a, b) + d for x in f])

    def theta_1(zero):
        def change(s, g):
            g[:, 1, 1] *= (s + zero) / (s + 0.27013)
        return change

    def damping(rows, hertz, before, after):
        def change(s, g):
            g[:, rows] *= (second_order(s, hertz, before) / second_order(s, hertz, after))[:, None, None]
        return change

    def zero_damping(after):
        def change(s, g):
            g[:, 2, 2] *= second_order(s, 0.05, after) / second_order(s, 0.05, 0.199)
        return change

    same = lambda s, g: None
    print("q/eta_c at 0.082 Hz: dB, deg | range dB, deg || r/zeta_c at 0.33 Hz: dB, deg | range dB, deg || b at 0.08, 0.33 Hz, dB: "
          "(2.145); actual offsets; magnitude")
    for name, change, more in (
            ("as flown, linear", same, {}), ("n_E 9", same, {"n_e": 9}),
            ("band from 0.04 Hz", same, {"first_hz": 0.04}), ("band from 0.03 Hz", same, {"first_hz": 0.03}),
            ("band from 0.02 Hz", same, {"first_hz": 0.02}), ("gain 0.1", same, {"gain": 0.1}),
            ("T_theta1 0.078 rad/s", theta_1(0.078), {}),
            ("the same, band from 0.04 Hz", theta_1(0.078), {"first_hz": 0.04}),
            ("T_theta1 0.13 rad/s", theta_1(0.13), {}), ("T_theta1 0.165 rad/s", theta_1(0.165), {}),
            ("T_theta1 0.49 rad/s", theta_1(0.49), {}),
            ("phugoid damping 0.065", damping([1], 0.0818, 0.0775, 0.065), {}),
            ("phugoid damping 0.055", damping([1], 0.0818, 0.0775, 0.055), {}),
            ("Dutch roll damping 0.15", damping([0, 2], 0.329, 0.184, 0.15), {}),
            ("Dutch roll damping 0.12", damping([0, 2], 0.329, 0.184, 0.12), {}),
            ("zero of r/zeta damping 0.10", zero_damping(0.10), {}),
            ("zero of r/zeta damping 0.05", zero_damping(0.05), {})):
        f, ratio, bias = interpolation_errors(base, change, **more)
        texts = []
        for element, hz in (((1, 1), 0.082), ((2, 2), 0.33)):
            values = ratio[f > 0.0499, element[0], element[1]]
            at = ratio[abs(f - hz).argmin(), element[0], element[1]]
            db, deg = 20 * np.log10(abs(values)), np.degrees(np.angle(values))
            texts.append(f"{20 * np.log10(abs(at)):6.2f} {np.degrees(np.angle(at)):6.1f} | {db.min():5.1f} to {db.max():4.1f}, "
                         f"{deg.min():6.1f} to {deg.max():5.1f}")
        print(f"{name:28s} " + " || ".join(texts) + " || " + "; ".join(f"{x:.1f}, {y:.1f}" for x, y in bias.values()))
    return 0


if __name__ == "__main__":
    if len(sys.argv) == 3 and sys.argv[2] == "--unknowns":
        sys.exit(unknowns(sys.argv[1]))
    if sys.argv[1:] == ["--border"]:
        sys.exit(border())
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    with tempfile.TemporaryDirectory() as work:
        sys.exit(0 if check_bias(sys.argv[1], work) and check_variance(sys.argv[1], work) else 1)
