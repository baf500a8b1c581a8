#!/usr/bin/env python3
"""Writes the flexible beam's experiments (FATMC_DATA/beam_ring_2x2) as records.

Usage: beam_records.py DATA OUT
DATA is the folder with sweeps.csv and validation.csv. OUT gets sym1, asym1, sym2, asym2 (the sweeps: u2 = u1 or -u1) and
rnd1, rnd2 (validation: u2 has other phases), each as CSV with a TOML beside it: inputs in V, outputs in V (one count of
the converter is 20/4096 V), 120,000 samples at 1 kHz.
"""
import csv
import pathlib
import sys

SAMPLES = 120000
VOLT_PER_COUNT = 20.0 / 4096.0
RECORD = """[record]
rate_hz = 1000.0
input = ["u1", "u2"]
output = ["y1", "y2"]
hold = "zoh"
"""


def columns(path):
    with open(path, encoding="utf-8", newline="") as file:
        reader = csv.reader(file)
        names = next(reader)
        rows = [row for _, row in zip(range(SAMPLES), reader)]
    return {name: [row[c] for row in rows] for c, name in enumerate(names)}


def write(folder, name, u1, u2, y1, y2):
    with open(folder / f"{name}.csv", "w", encoding="utf-8") as file:
        file.write("u1,u2,y1,y2\n")
        for row in zip(u1, u2, y1, y2):
            volts = (repr(int(count) * VOLT_PER_COUNT) for count in row[2:])
            file.write(",".join((*row[:2], *volts)) + "\n")
    (folder / f"{name}.toml").write_text(RECORD, encoding="utf-8")


def main(data, out):
    out.mkdir(parents=True, exist_ok=True)
    sweeps, validation = columns(data / "sweeps.csv"), columns(data / "validation.csv")
    u = sweeps["u_V"]
    opposite = [text[1:] if text.startswith("-") else "-" + text for text in u]
    for name in ("sym1", "sym2", "asym1", "asym2"):
        write(out, name, u, opposite if name.startswith("asym") else u, sweeps[f"{name}_y1"], sweeps[f"{name}_y2"])
    for name in ("rnd1", "rnd2"):
        write(out, name, u, validation[f"{name}_u2_V"], validation[f"{name}_y1"], validation[f"{name}_y2"])


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]))
