#!/usr/bin/python3
"""fatmc diagnose against numpy: features from the record's CSV, covariance as a dense matrix, likelihood ratios by solving it.

Read from the program's basis (core/discrepancy/basis_file.h) are only mean, Cholesky factors, low-rank columns and signatures;
what is made of them, and the features themselves, is computed here in another way. Outputs of the filters for higher moments are
taken from the program where energies are compared, and compared with a filter of this script's own flights on a record that hides
such a moment. Usage: diagnosis_reference.py FATMC
"""
import csv
import glob
import json
import os
import struct
import subprocess
import sys
import tempfile

import numpy as np

fatmc = sys.argv[1]
folder = tempfile.TemporaryDirectory()
EXPERIMENT = "tests/support/short_experiment.toml"
PERIOD, PERIODS, RATE = 2000, 2, 50.0
LINES = list(range(12, 91, 2))
NOISE_EDGES = [0.01, 0.05, 0.15, 0.3, 0.6, 1.2, 2.5, 5.0, 10.0, 25.0]


def place(name):
    return os.path.join(folder.name, name)


def run(*arguments):
    done = subprocess.run([fatmc, *arguments], capture_output=True, text=True)
    assert done.returncode == 0, done
    return done


class Basis:
    """The matrices of the file in their order."""

    def __init__(self, path, blocks):
        with open(path, "rb") as file:
            data = file.read()
        at = data.index(b"\n", data.index(b"\n") + 1) + 1

        def matrix():
            nonlocal at
            rows, cols = struct.unpack_from("<qq", data, at)
            values = np.frombuffer(data, "<f8", rows * cols, at + 16)
            at += 16 + 8 * rows * cols
            return values.reshape(cols, rows).T  # column by column

        self.mean = matrix()[:, 0]
        self.inverse_factor = [matrix() for _ in range(blocks)]
        self.low_rank = matrix()
        self.baseline = matrix()
        self.differences = matrix()


def features(record):
    """The vector of core/discrepancy/feature_layout.h, and the sizes of its blocks."""
    n = PERIOD * PERIODS
    names = ["p", "q", "r", "phi", "theta", "V"]
    ramp = np.arange(n) / (n - 1) - 0.5
    spectra = {c: np.fft.fft(record[c] - (record[c][-1] - record[c][0]) * ramp) / np.sqrt(n) for c in names}
    bin_hz = RATE / n
    low, high = PERIODS * LINES[0] - (PERIODS - 1), PERIODS * LINES[-1] + (PERIODS - 1)
    excited = {PERIODS * k for k in LINES}
    free = [m for m in range(low, high + 1) if m not in excited]
    out, sizes = [], []

    def add(values):
        out.extend(values)
        sizes.append(len(values))

    for k in LINES:
        b = PERIODS * k
        above = int(np.searchsorted(free, b))
        start = min(max(above - 5, 0), len(free) - 10)
        around = np.array(free[start:start + 10])
        corrected = []
        for c in names[:5]:
            x = (around - b) / np.abs(around - b).max()
            transient = np.polynomial.polynomial.polyfit(x, np.stack([spectra[c][around].real, spectra[c][around].imag]).T, 2)[0]
            corrected.append(spectra[c][b] - complex(*transient))
        add([z.real for z in corrected] + [z.imag for z in corrected])
    add([np.mean(record[c]) for c in names] + [np.mean(np.sin(record["phi"]) * np.tan(record["phi"]))])

    first, last = PERIODS * LINES[0] * bin_hz, PERIODS * LINES[-1] * bin_hz
    begin = max(NOISE_EDGES[0], 2 * bin_hz)
    for edge in NOISE_EDGES:
        end = min(edge, RATE / 2)
        if (end - begin) / bin_hz * (PERIODS - 1) / PERIODS < 20:
            continue
        bins = np.arange(int(np.floor(begin / bin_hz)) + 1, min(int(np.floor(end / bin_hz)), (n - 1) // 2) + 1)
        noise = bins[bins % PERIODS != 0]
        power = {c: np.abs(spectra[c][noise]) ** 2 for c in names}
        add([np.log(power[c].mean()) for c in names])
        add([np.log(power[c].max() / power[c].mean()) for c in names[:3]])
        if end > first and begin < 3 * last and (end - begin) / (bin_hz * PERIODS) > 40:
            other = np.array([m for m in bins if m % PERIODS == 0 and m not in excited])
            add([np.log((np.abs(spectra[c][other]) ** 2).mean()) for c in names[:3]])
        begin = end
    add([np.log(n / len(np.unique(record[c]))) for c in names[:3]])
    gains, offsets = [], []
    for axis, (u, r, y) in enumerate(zip(["xi_c", "eta_c", "zeta_c"], ["r_p", "r_q", "r_r"], "pqr")):
        columns = [record[r] - record[y], np.ones(n)]
        if axis == 2:
            columns.append(9.80665 * np.sin(record["phi"]) * np.cos(record["theta"]) / record["V"])
        found = np.linalg.lstsq(np.stack(columns).T, record[u], rcond=None)[0]
        gains.append(found[0] / 0.1 - 1)
        offsets.append(found[1])
    add(gains + offsets + [found[2] / 0.1 - 1])
    return np.array(out), sizes


def flown(name, seed, *effects, experiment=EXPERIMENT):
    """A record of the simulator, column by column; its path is place(name + ".csv")."""
    path = place(name + ".csv")
    options = [word for effect in effects for word in ("--effect", effect)]
    run("simulate", "campaigns/models/fat.toml", experiment, "--seed", str(seed), "-o", path, *options)
    with open(path, encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    return {column: np.array([float(row[column]) for row in rows]) for column in rows[0]}


def diagnosed(name):
    """Evidence of the diagnosis of a record, and the path of its basis."""
    with open(place(name + ".toml"), "a", encoding="utf-8") as file:
        file.write('[environment]\nturbulence_sigma_m_s = 0.5\nimu_grade = "tactical"\n')
    out = place(name + "-out")
    run("diagnose", "--model", "campaigns/models/fat.toml", "--record", place(name + ".csv"), "--flights", "300", "-o", out, "--cache",
        out + "-cache", "--exclude", "flexible_mode,slosh,rate_limit,position_limit")
    with open(os.path.join(out, "diagnosis.json"), encoding="utf-8") as file:
        return json.load(file)["evidence"], glob.glob(out + "-cache/*.basis")[0]


def rate_spectra(record):
    """DFT of p, q, r without the line from first to last sample, a row a bin."""
    n = PERIOD * PERIODS
    ramp = np.arange(n) / (n - 1) - 0.5
    return np.stack([np.fft.fft(record[c] - (record[c][-1] - record[c][0]) * ramp) / np.sqrt(n) for c in "pqr"]).T


def check(seed):
    record = flown(f"flight{seed}", seed)
    evidence, path = diagnosed(f"flight{seed}")
    x, sizes = features(record)
    x = np.concatenate([x, [m["value"] for m in evidence["moments"]]])
    sizes.append(len(evidence["moments"]))
    basis = Basis(path, len(sizes))
    assert [len(m) for m in basis.inverse_factor] == sizes, "blocks"
    assert len(basis.mean) == len(x), (len(basis.mean), len(x))

    # Sigma = L (I + F F^T) L^T, dense.
    factor = np.zeros((len(x), len(x)))
    at = 0
    for inverse in basis.inverse_factor:
        factor[at:at + len(inverse), at:at + len(inverse)] = np.linalg.inv(inverse)
        at += len(inverse)
    sigma = factor @ (np.eye(len(x)) + basis.low_rank @ basis.low_rank.T) @ factor.T
    d = x - basis.mean
    solved = np.linalg.solve(sigma, np.column_stack([d, basis.differences]))
    energy = d @ solved[:, 0]
    products = basis.differences.T @ solved[:, 0]
    lengths = np.einsum("ij,ij->j", basis.differences, solved[:, 1:])
    ratios = np.where(lengths > 0, np.maximum(products, 0) ** 2 / np.where(lengths > 0, lengths, 1), 0)
    print(f"seed {seed}: {len(x)} features, energy {energy:.6f} ({evidence['energy']['value']:.6f}), "
          f"largest ratio {ratios.max():.6f} ({evidence['scan']['value']:.6f})")
    assert abs(energy / evidence["energy"]["value"] - 1) < 1e-6
    assert abs(ratios.max() - evidence["scan"]["value"]) < 1e-5 * max(1.0, ratios.max())


def check_moments(seed, moment):
    """The filter of a moment by this script's own flights: the same output on a record with ten times that moment."""
    name, size = moment
    record = flown("hidden", seed, f"{name},ratio={10 * size}")
    evidence, _ = diagnosed("hidden")
    value = next(m["value"] for m in evidence["moments"] if m["moment"] == name)
    with open(EXPERIMENT, encoding="utf-8") as file:
        calm = file.read().replace("turbulence_sigma_m_s = 0.5", "turbulence_sigma_m_s = 0.0").replace('"tactical"', '"none"')
    with open(place("calm.toml"), "w", encoding="utf-8") as file:
        file.write(calm)
    plain = flown("plain", seed, experiment=place("calm.toml"))
    assert np.array_equal(plain["r_p"], record["r_p"]), "one reference"
    moved = flown("moved", seed, f"{name},ratio={size}", experiment=place("calm.toml"))
    difference = rate_spectra(moved) - rate_spectra(plain)
    noise = [rate_spectra(flown(f"noise{k}", 100 + k)) for k in range(20)]
    y = rate_spectra(record)
    output = energy = 0.0
    for harmonic in range(1, min((PERIOD - 1) // 2, 4 * LINES[-1]) + 1):
        if harmonic in LINES:
            continue
        at = PERIODS * harmonic
        around = [m for m in range(max(1, at - 15), at + 16) if m % PERIODS]
        samples = np.concatenate([flight[around] for flight in noise])
        cov = samples.T @ samples.conj() / len(samples)  # E y y^H
        solved = np.linalg.solve(cov, difference[at])
        output += 2 * (np.conj(solved) @ y[at]).real
        energy += 2 * (np.conj(difference[at]) @ solved).real
    output /= np.sqrt(energy)
    print(f"{name}: filter of this script {output:.3f}, of the program {value:.3f}; of ratio {size} {np.sqrt(energy):.3f} is expected")
    # Filters of two estimates of the noise, each uncertain by a tenth: outputs differ by a part of a deviation.
    assert abs(value) > 4.0, "the moment shows"
    assert abs(output - value) < 0.5 + 0.1 * abs(value)


check(1)
check_moments(2, ("quadratic_damping:axis=roll", 0.2))
