#!/usr/bin/python3
"""The studies of bias and variance again, by numpy from the arrays of their databases.

    chapter4_reference.py FATMC     flies 12 trials of each and compares all tables
    chapter4_reference.py --border  experiment: border factor of white noise for one and three inputs of random phases

The experiment is the reason in campaigns/variance/README.md.
"""
import json
import pathlib
import sqlite3
import subprocess
import sys
import tempfile

import numpy as np

import coverage_reference

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
    a = coverage_reference.arrays(path, "clean")
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
    a = coverage_reference.arrays(path, "light turbulence")
    f = a["frequency_hz"][0]
    shape = (-1, len(f), 9)
    g = (a["g_re"] + 1j * a["g_im"]).reshape(shape)
    between = (abs(g - g.mean(axis=0)) ** 2).sum(axis=0) / (len(g) - 1)
    estimated = np.median(a["variance"].reshape(shape), axis=0)
    at = lambda hz: abs(f - hz).argmin()
    ends = {"low border": (at(0.05), at(0.15)), "high border": (at(5.0), at(4.9))}
    parts = {"all lines": f > 0, "0.15-4.9 Hz": (f > 0.1499) & (f < 4.9001), "below 0.15 Hz": f < 0.1499,
             "above 4.9 Hz": f > 4.9001}
    s = lambda place: (np.linalg.pinv(np.vander((np.arange(21) - place) / 10.0, 3, increasing=True))[0] ** 2).sum()
    worst, checked = 0.0, 0
    for row in table:
        if row["table"] == "Section 4.3.2":
            value = (10 * np.log10(estimated / between))[parts[row["row"]]].mean()
        else:
            edge, inner = ends[row["row"]]
            value = {"border factor, between runs": (between[edge] / between[inner]).mean(),
                     "border factor, medians of the estimates": (estimated[edge] / estimated[inner]).mean(),
                     "border factor, white noise, one input": s(0) / s(10)}[row["quantity"]]
        worst, checked = max(worst, abs(value - row["value"]) / max(1, abs(value))), checked + 1
    print(f"variance: {checked} rows, largest difference {worst:.2e}")
    return checked == 10 and worst < 1e-9


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


if __name__ == "__main__":
    if sys.argv[1:] == ["--border"]:
        sys.exit(border())
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    with tempfile.TemporaryDirectory() as work:
        sys.exit(0 if check_bias(sys.argv[1], work) and check_variance(sys.argv[1], work) else 1)
