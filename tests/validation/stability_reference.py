#!/usr/bin/env python3
"""Independent computation of what `fatmc stability` writes, in numpy.

Usage: stability_reference.py FATMC
Estimates by the LPM of lpm_reference.py, builds the whole M = -W S (I + K G)^-1 K T of nine blocks with explicit S, T and
diagonal W, and judges by F(2, 2q) of scipy. Records: a closed loop of three inputs made here, judged against its
own equations as state space and against its true response as frf, and a simulated flight against the sampled matrices of
`fatmc linearize`. The upper bound of ssv is checked against any D-scaling that numpy tries and against the lower bound.
"""
import csv
import json
import os
import subprocess
import sys
import tempfile

import numpy as np
from scipy import stats

import lpm_reference
import ssv_reference

TOLERANCE = 1e-8  # relative; the LPM agrees to 1e-9 of the largest element of a line


def noise_snr_db(u, lines, periods, period, order, n):
    """20 log10 min_j (|U^| - s)/s (5.10), s^2 = mu_poly |e|^2 / q_noise of the fit through non-excited bins."""
    excited = [periods * k for k in lines]
    spectrum = np.fft.fft(u, axis=0) / np.sqrt(len(u))
    candidates = np.array([m for m in range(excited[0] - (periods - 1), excited[-1] + periods) if m not in set(excited)])
    out = []
    for m in excited:
        start = min(max(np.sum(candidates < m) - n, 0), len(candidates) - 2 * n)
        bins = candidates[start:start + 2 * n]
        k = np.vander((bins - m) / max(abs(bins - m)), order + 1, increasing=True)
        weights = np.linalg.pinv(k)
        residual = spectrum[bins] - k @ (weights @ spectrum[bins])
        variance = (1.0 + np.sum(weights[0] ** 2)) * np.sum(abs(residual) ** 2, axis=0) / (2 * n - order - 1)
        s = np.sqrt(variance)
        out.append(20.0 * np.log10(np.min((abs(spectrum[m] - weights[0] @ spectrum[bins]) - s) / s)))
    return np.array(out)


def uncertainty_loop(g, k, radii):
    """The whole M; elements sorted by input, then output."""
    return ssv_reference.loop_matrix(np.linalg.solve(np.eye(len(k)) + k @ g, k), radii)


def h_infinity(g, k, radii):
    return np.linalg.svd(uncertainty_loop(g, k, radii), compute_uv=False)[0]


def confidence(kappa, sigma, b, q, rule):
    radius = kappa * (b + sigma) - b
    p = np.where(radius > 0.0, stats.f.cdf((radius / sigma) ** 2, 2, 2 * q), 0.0)
    return np.min(p) if rule == "min" else max(0.0, 1.0 - np.sum(1.0 - p))


class Reference:
    """Estimate of one record, and the judgement under given options."""

    def __init__(self, columns, roles, lines, periods, period, rate, k):
        pick = lambda role: np.stack([columns[name] for name in roles[role]], axis=1)
        self.n_e, order, n_transient = 9, 2, 5
        self.g, variance, self.bias, _ = lpm_reference.fast_lpm(pick("output"), pick("input"), pick("reference"), lines,
                                                                periods, period, rate, self.n_e, order, n_transient)
        self.sigma = np.sqrt(variance)
        self.q = 2 * self.n_e + 1 - (order + 1) * len(roles["input"])
        self.snr = noise_snr_db(pick("input"), lines, periods, period, order, n_transient)
        self.frequency = np.array(lines) * rate / period
        self.k = k
        # (2.145): alpha of many lines over (2 n_E + 1) mean spacings, instead of the sum over a line's actual offsets.
        self.constant = np.empty(len(lines))
        for n in range(len(lines)):
            first = min(max(n - self.n_e, 0), len(lines) - 2 * self.n_e - 1)
            d = self.frequency[first:first + 2 * self.n_e + 1] - self.frequency[n]
            moment = abs(np.linalg.pinv(np.vander(d, order + 1, increasing=True))[0] @ d ** (order + 2))
            self.constant[n] = 3 / 35 * ((d[-1] - d[0]) / (2 * self.n_e) * (2 * self.n_e + 1) / 2) ** (order + 2) / moment

    def compare(self, what, directory, nominal, rule, bias, intergrid):
        with open(os.path.join(directory, "lines.csv"), encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        with open(os.path.join(directory, "summary.json"), encoding="utf-8") as file:
            summary = json.load(file)
        assert len(rows) == len(self.frequency)
        worst = {}

        def agree(name, ours, theirs, scale=None):
            difference = abs(ours - theirs) / (abs(theirs) if scale is None else scale)
            worst[name] = max(worst.get(name, 0.0), difference)

        product, gated, snr_low = 1.0, 1.0, 0
        rng = np.random.default_rng(5)
        for n, row in enumerate(rows):
            value = {key: float(text) for key, text in row.items()}
            b = intergrid * abs(self.g[n]) + {"on": 1.0, "constant": self.constant[n], "off": 0.0}[bias] * self.bias[n]
            radii = b + self.sigma[n]
            hinf_nominal = h_infinity(nominal[n], self.k, abs(self.g[n] - nominal[n]))
            hinf = h_infinity(self.g[n], self.k, radii)
            p = confidence(1.0 / hinf, self.sigma[n], b, self.q, rule)
            agree("frequency", value["frequency_hz"], self.frequency[n])
            agree("hinf_nominal", value["hinf_nominal"], hinf_nominal)
            agree("hinf", value["hinf"], hinf)
            agree("kappa_hinf", value["kappa_hinf"], 1.0 / hinf)
            agree("p_hinf", value["p_hinf"], p, 1.0)
            agree("snr_db", value["snr_min_db"], self.snr[n])
            # ssv: p from its own kappa; no D-scaling is below the upper bound; the bounds enclose it.
            agree("p_ssv", value["p_ssv"], confidence(value["kappa_ssv"], self.sigma[n], b, self.q, rule), 1.0)
            agree("kappa_ssv", value["kappa_ssv"], 1.0 / value["ssv_upper"])
            assert value["ssv_lower"] <= value["ssv_upper"] <= value["hinf"] * (1.0 + 1e-12), value
            assert value["ssv_nominal"] <= value["hinf_nominal"] * (1.0 + 1e-12), value
            m = uncertainty_loop(self.g[n], self.k, radii)
            for _ in range(5):
                d = np.exp(rng.standard_normal(len(m)))
                bound = np.linalg.svd(d[:, None] * m / d[None, :], compute_uv=False)[0]
                assert value["ssv_upper"] <= bound * (1.0 + 1e-9), (value, bound)
            delta = np.exp(2j * np.pi * rng.random(len(m)))
            assert max(abs(np.linalg.eigvals(delta[:, None] * m))) <= value["ssv_upper"] * (1.0 + 1e-9)
            product *= p
            gated *= p if hinf_nominal < 1.0 and self.snr[n] >= 20.0 else 0.0
            snr_low += self.snr[n] < 20.0
        agree("p_band", summary["p_band_hinf"], product, 1.0)
        agree("p_total", summary["p_total_hinf"], gated, 1.0)
        agree("p_band_ssv", summary["p_band_ssv"], np.prod([float(row["p_ssv"]) for row in rows]), 1.0)
        assert summary["low_snr_lines"] == snr_low
        assert summary["nominal_stable"] == all(float(row["ssv_nominal"]) < 1.0 for row in rows)
        assert (summary["combine"], summary["bias"], summary["intergrid"]) == (rule, bias, intergrid)
        print(f"{what}, {rule}, bias {bias}, intergrid {intergrid}: p(B) {product:.6g}; largest differences "
              + ", ".join(f"{k} {v:.1e}" for k, v in worst.items()))
        assert max(worst.values()) < TOLERANCE, f"{what}: {worst}"
        return product


def stability(fatmc, record, meta, nominal, directory, *options):
    subprocess.run([fatmc, "stability", record, "--meta", meta, "--nominal", nominal, "-o", directory, *options],
                   check=True, stdout=subprocess.DEVNULL)


def sampled(a, b, c, d, frequency, rate):
    z = np.exp(2j * np.pi * frequency / rate)
    return np.array([c @ np.linalg.solve(zi * np.eye(len(a)) - a, b) + d for zi in z])


def check_closed_loop(fatmc, folder):
    columns, rate = lpm_reference.closed_loop_record()
    lines = lpm_reference.table_5_1_lines()
    roles = {"reference": ["r_p", "r_q", "r_r"], "input": ["u_p", "u_q", "u_r"], "output": ["p", "q", "r"]}
    record, meta = os.path.join(folder, "loop.csv"), os.path.join(folder, "loop.toml")
    with open(record, "w", encoding="utf-8") as file:
        file.write(",".join(columns) + "\n")
        for row in zip(*columns.values()):
            file.write(",".join(repr(float(value)) for value in row) + "\n")
    with open(meta, "w", encoding="utf-8") as file:
        file.write(f"[record]\nrate_hz = {rate}\ncontroller_gain = [[0.1,0,0],[0,0.1,0],[0,0,0.1]]\n")
        file.writelines(f"{role} = {json.dumps(names)}\n" for role, names in roles.items())
    # The equations behind the record, channels in another order than the record's.
    a = np.array([[0.80, 0.02, 0.05], [0.01, 0.93, -0.03], [-0.06, 0.02, 0.97]])
    b = np.array([[1.2, 0.1, 0.3], [0.05, 0.9, -0.1], [-0.2, 0.1, 0.8]])
    order = [2, 0, 1]
    model = os.path.join(folder, "model.toml")
    with open(model, "w", encoding="utf-8") as file:
        file.write(f"kind = \"state_space\"\nsample_time_s = {1.0 / rate}\n"
                   f"inputs = {json.dumps([roles['input'][i] for i in order])}\n"
                   f"outputs = {json.dumps([roles['output'][i] for i in order])}\n"
                   f"A = {a.tolist()}\nB = {b[:, order].tolist()}\nC = {np.eye(3)[order].tolist()}\n")
    reference = Reference(columns, roles, lines, 2, 10000, rate, 0.1 * np.eye(3))
    g0 = sampled(a, b, np.eye(3), np.zeros((3, 3)), reference.frequency, rate)
    table, listed = os.path.join(folder, "response.csv"), os.path.join(folder, "frf.toml")
    with open(table, "w", encoding="utf-8") as file:
        file.write("line,frequency_hz,output,input,re,im\n")
        for n, line in enumerate(lines):
            for i in order:
                for j in order:
                    file.write(f"{line},{float(reference.frequency[n])!r},{roles['output'][i]},{roles['input'][j]},"
                               f"{float(g0[n, i, j].real)!r},{float(g0[n, i, j].imag)!r}\n")
    with open(listed, "w", encoding="utf-8") as file:
        file.write('kind = "frf"\nresponse = "response.csv"\n')
    products = set()
    for rule, bias, intergrid in (("min", "on", 0.03), ("bonferroni", "on", 0.03), ("min", "off", 0.0), ("min", "on", 0.6),
                                  ("bonferroni", "off", 0.75), ("min", "constant", 0.03)):
        stability(fatmc, record, meta, model, folder, "--combine", rule, "--bias", bias, "--intergrid",
                  str(intergrid))
        products.add(reference.compare("closed loop, state space", folder, g0, rule, bias, intergrid))
    assert len(products) > 2 and any(0.0 < p < 0.999 for p in products), products  # the figures compared say something
    for nominal in (table, listed):
        stability(fatmc, record, meta, nominal, folder, "--gain", "0.1")
        reference.compare("closed loop, frf", folder, g0, "min", "on", 0.03)
    with open(listed, "a", encoding="utf-8") as file:  # as diagnose takes it
        file.write('elements = "diagonal"\nband_hz = [0.5, 2.0]\n')
    stability(fatmc, record, meta, listed, folder, "--gain", "0.1")
    reference.compare("closed loop, diagonal of an frf", folder, g0 * np.eye(3), "min", "on", 0.03)


def check_flight(fatmc, folder):
    record, aircraft = os.path.join(folder, "flight.csv"), "campaigns/models/fat.toml"
    subprocess.run([fatmc, "simulate", aircraft, "campaigns/experiments/chapter5.toml", "--seed", "3", "-o", record],
                   check=True, stdout=subprocess.DEVNULL)
    linear = json.loads(subprocess.run([fatmc, "linearize", aircraft, "--format", "json"], check=True,
                                       capture_output=True, text=True).stdout)
    a, b, c, d = (np.array(linear["sampled"][key]) for key in "ABCD")
    with open(record, encoding="utf-8") as file:
        names = file.readline().strip().split(",")
    samples = np.loadtxt(record, delimiter=",", skiprows=1)
    columns = {name: samples[:, i] for i, name in enumerate(names)}
    roles = {"reference": ["r_p", "r_q", "r_r"], "input": linear["inputs"], "output": linear["outputs"]}
    rate = linear["sampled"]["rate_hz"]
    reference = Reference(columns, roles, lpm_reference.table_5_1_lines(), 2, 10000, rate, 0.1 * np.eye(3))
    nominal = sampled(a, b, c, d, reference.frequency, rate)
    for bias in ("on", "constant", "off"):
        stability(fatmc, record, os.path.join(folder, "flight.toml"), aircraft, folder, "--bias", bias)
        reference.compare("simulated flight", folder, nominal, "min", bias, 0.03)


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    with tempfile.TemporaryDirectory() as folder:
        check_closed_loop(sys.argv[1], folder)
        check_flight(sys.argv[1], folder)


if __name__ == "__main__":
    main()
