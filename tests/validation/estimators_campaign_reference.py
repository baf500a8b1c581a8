#!/usr/bin/python3
"""Section 3.4 again, by numpy.

    estimators_campaign_reference.py FATMC                  the comparison
    estimators_campaign_reference.py FATMC --experiments    errors in steady state for other windows and another pitch zero:
                                                            the reasons in campaigns/estimators/README.md

Flies the small size of campaigns/estimators/spec.toml. Flights of three repetitions of two cells are replayed and all four
estimates made anew: numpy's FFT, transients and local polynomials by lstsq, G0 from the matrices that `fatmc linearize` prints.
Then Tables 3-2 and 3-3 and the figures of 3.4.1 and 3.4.2 follow from the stored errors of all runs.
"""
import json
import pathlib
import subprocess
import sys
import tempfile

import numpy as np
from scipy import stats

from campaign_arrays import arrays

ROOT = pathlib.Path(__file__).resolve().parents[2]
LABELS = {"etfe": "ETFE", "tlpm": "tLPM", "fast_lpm": "fastLPM", "fast_lpm_indirect": "fastLPM, indirect"}
N, P = 1000, 2  # samples of a period, periods


def call(fatmc, *arguments):
    return subprocess.run([fatmc, *arguments], check=True, cwd=ROOT, capture_output=True, text=True).stdout


def pitch_response(fatmc, frequencies):
    s = json.loads(call(fatmc, "linearize", "campaigns/models/fat.toml", "--format", "json"))["sampled"]
    a, b, c, d = (np.array(s[name]) for name in "ABCD")
    z = np.exp(2j * np.pi * frequencies / s["rate_hz"])
    return np.array([(c @ np.linalg.solve(x * np.eye(len(a)) - a, b) + d)[1, 1] for x in z])


def without_transient(spectrum, lines, side=5, degree=2):
    """Spectrum at the lines, less a polynomial through the nearest bins that are not excited (T 2.101-2.111)."""
    excited = {P * k for k in lines}
    bins = np.array([m for m in range(P * lines[0] - (P - 1), P * lines[-1] + P) if m not in excited])
    out = []
    for k in lines:
        start = min(max(np.searchsorted(bins, P * k) - side, 0), len(bins) - 2 * side)
        near = bins[start:start + 2 * side]
        fit = np.polynomial.polynomial.polyfit(near - P * k, np.column_stack([spectrum[near].real, spectrum[near].imag]), degree)
        out.append(spectrum[P * k] - fit[0] @ [1, 1j])
    return np.array(out)


def local_polynomial(output, regressor, n_e=2, degree=2):
    """Constant term of output = (g0 + g1 d + g2 d^2) regressor over the 2 n_E + 1 nearest lines (T 2.123-2.131)."""
    out = []
    for k in range(len(output)):
        start = min(max(k - n_e, 0), len(output) - 2 * n_e - 1)
        window = np.arange(start, start + 2 * n_e + 1)
        columns = np.column_stack([(window - k) ** g * regressor[window] for g in range(degree + 1)])
        out.append(np.linalg.lstsq(columns, output[window], rcond=None)[0][0])
    return np.array(out)


def estimates(record, lines, correction):
    y, u, r = (np.fft.fft(record[name]) for name in ("q", "eta_c", "r_q"))
    at = P * np.array(lines)
    ys, us = without_transient(y, lines), without_transient(u, lines)
    factor = 24.0 / record["V"].mean() if correction else 1.0
    return {"etfe": factor * y[at] / u[at],
            "tlpm": factor * ys / us,
            "fast_lpm": factor * local_polynomial(ys, us),
            "fast_lpm_indirect": factor * local_polynomial(ys, r[at]) / local_polynomial(us, r[at])}


def worst_of_estimates(fatmc, path, folder):
    worst = 0.0
    for cell, correction in (("linear", False), ("nonlinear, light turbulence", True)):
        stored = arrays(path, cell)
        for repetition in range(3):
            file = f"{folder}/flight.csv"
            call(fatmc, "replay", path, f"{cell}/{repetition}", "-o", file)
            record = np.genfromtxt(file, delimiter=",", names=True)
            assert len(record) == P * N
            frequencies = stored["frequency_hz"][repetition]
            lines = [round(20 * f) for f in frequencies]
            g0 = pitch_response(fatmc, frequencies)
            for name, g in estimates(record, lines, correction).items():
                error = stored[f"{name}.error_re"][repetition] + 1j * stored[f"{name}.error_im"][repetition]
                worst = max(worst, np.max(abs(g / g0 - 1 - error)))
    return worst


def mean_and_range(errors):
    """|mean| and half width of the 90 % interval of a mean of 20."""
    half = stats.t.ppf(0.95, 19) * errors.std(axis=0, ddof=1) / np.sqrt(20)
    return abs(errors.mean(axis=0)), half


def worst_of_tables(fatmc, path):
    rows = json.loads(call(fatmc, "tables", path, "--format", "json"))
    worst, checked = 0.0, 0
    for cell, suffix in (("linear", ""), ("linear, open loop", ", linear, open loop"),
                         ("nonlinear, light turbulence", ", nonlinear, light turbulence")):
        a = arrays(path, cell)
        frequencies = a["frequency_hz"][0]
        for name, label in LABELS.items():
            magnitude = abs(1 + a[f"{name}.error_re"] + 1j * a[f"{name}.error_im"])
            mean, half = mean_and_range(20 * np.log10(magnitude))
            relative = magnitude - 1
            own_mean, own_half = mean_and_range(relative)
            for row in rows:
                if row["row"] != label + suffix:
                    continue
                if row["table"] in ("3-2", "3-3"):
                    k = np.argmin(abs(frequencies - float(row["quantity"].split()[0])))
                    wanted = (mean if row["table"] == "3-2" else half)[k]
                elif row["quantity"].startswith("lines whose 90 %"):
                    assert len(relative) == 20  # one campaign of 20
                    wanted = 100 * np.mean(own_mean <= own_half)
                elif row["table"] == "Section 3.4.2":
                    wanted = 100 * np.max(own_mean[frequencies <= 0.15 + 1e-9])
                else:
                    continue
                worst = max(worst, abs(row["value"] - wanted))
                checked += 1
    return worst, checked


def steady_errors(fatmc, lowest, n_e=2, zero=None):
    """Mean over 50 draws of phases of the relative error of |G|, direct and indirect, gain 0.5, without transient or noise.

    `zero`: T_theta1 in rad/s, put in the place of the model's 0.2701."""
    frequencies = np.arange(lowest, 21) / 20
    g = pitch_response(fatmc, frequencies)
    if zero is not None:
        s = 2j * np.pi * frequencies
        g = g * (s + zero) / (s + 0.27013)
    random = np.random.default_rng(5)
    direct, indirect = [], []
    for _ in range(50):
        r = np.exp(2j * np.pi * random.random(len(g)))
        u = 0.5 * r / (1 + 0.5 * g)
        y = g * u
        direct.append(abs(local_polynomial(y, u, n_e) / g) - 1)
        indirect.append(abs(local_polynomial(y, r, n_e) / local_polynomial(u, r, n_e) / g) - 1)
    return np.mean(direct, axis=0), np.mean(indirect, axis=0)


def experiments(fatmc):
    def decibel(error):
        return " ".join(f"{abs(20 * np.log10(1 + error[k])):.4f}" for k in (1, 5, 9, 13, 17))
    for n_e in (2, 3, 4, 5):
        direct, indirect = steady_errors(fatmc, 3, n_e)
        print(f"n_E = {n_e}: error at 0.2 0.4 0.6 0.8 1.0 Hz, dB: direct {decibel(direct)}, indirect {decibel(indirect)}")
    for zero in (0.078, 0.10, 0.165, 0.20, 0.27013, 0.34, 0.49):
        at_02 = steady_errors(fatmc, 3, zero=zero)[0][1]
        direct, indirect = (100 * e[1] for e in steady_errors(fatmc, 1, zero=zero))
        print(f"T_theta1 {zero:.3f} rad/s: direct at 0.2 Hz {20 * np.log10(1 + at_02):.3f} dB; "
              f"20 lines, at 0.10 Hz: direct {direct:.0f} %, indirect {indirect:.0f} %")
    return 0


def main():
    fatmc = sys.argv[1]
    if "--experiments" in sys.argv[2:]:
        return experiments(fatmc)
    with tempfile.TemporaryDirectory() as folder:
        path = f"{folder}/estimators.db"
        call(fatmc, "run", "campaigns/estimators/spec.toml", "--size", "small", "--db", path)
        estimate = worst_of_estimates(fatmc, path, folder)
        table, checked = worst_of_tables(fatmc, path)
    print(f"estimates of 6 flights: largest relative difference {estimate:.1e}; {checked} rows, largest difference {table:.1e}")
    return 0 if estimate < 1e-8 and table < 1e-8 and checked == 92 else 1


if __name__ == "__main__":
    sys.exit(main())
