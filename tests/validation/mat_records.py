#!/usr/bin/python3
"""Records that scipy wrote as MAT files give what the CSV gives, byte for byte. Usage: mat_records.py FATMC"""
import pathlib
import subprocess
import sys
import tempfile

import numpy as np
import scipy.io

fatmc = sys.argv[1]
model, experiment = "campaigns/models/fat.toml", "campaigns/experiments/chapter5.toml"
folder = tempfile.TemporaryDirectory()
work = pathlib.Path(folder.name)
flight = work / "flight.csv"
subprocess.run([fatmc, "simulate", model, experiment, "--seed", "3", "-o", str(flight)], check=True, stdout=subprocess.DEVNULL)
roles = (work / "flight.toml").read_text(encoding="utf-8")
names = flight.read_text(encoding="utf-8").split("\n", 1)[0].split(",")
values = np.loadtxt(flight, delimiter=",", skiprows=1)
columns = dict(zip(names, values.T))


def run(command, record, *arguments):
    out = record.with_suffix("")
    done = subprocess.run([fatmc, command, str(record), *arguments, "-o", str(out)], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return out


def same(record, wanted, roles_of_record, **options):
    scipy.io.savemat(record, wanted, **options)
    record.with_suffix(".toml").write_text(roles_of_record, encoding="utf-8")
    frm = (run("estimate", record) / "frm.csv").read_bytes()
    assert frm == expected, f"{record.name}: another estimate"
    lines = (run("stability", record, "--nominal", model) / "lines.csv").read_bytes()
    assert lines == judged, f"{record.name}: another judgement"


expected = (run("estimate", flight) / "frm.csv").read_bytes()
judged = (run("stability", flight, "--nominal", model) / "lines.csv").read_bytes()
# Vectors, as rows and compressed, then as columns; other variables of any kind do not matter.
same(work / "rows.mat", {**columns, "note": "text", "cell": np.array([1, "a"], dtype=object)}, roles, do_compression=True)
same(work / "level4.mat", columns, roles, format="4", oned_as="column")

# Outputs as a matrix: other names, the same numbers.
indexed = roles
for k, name in enumerate(("p", "q", "r")):
    indexed = indexed.replace(f'"{name}"', f'"y({k + 1})"')
rest = {name: column for name, column in columns.items() if name not in ("p", "q", "r")}
matrix = work / "matrix.mat"
scipy.io.savemat(matrix, {**rest, "y": np.column_stack([columns[name] for name in ("p", "q", "r")])})
matrix.with_suffix(".toml").write_text(indexed, encoding="utf-8")
text = (run("estimate", matrix) / "frm.csv").read_text(encoding="utf-8")
for k, name in enumerate(("p", "q", "r")):
    text = text.replace(f",y({k + 1}),", f",{name},")
assert text.encode() == expected, "columns of a matrix: another estimate"
print("three MAT files: estimates and judgements equal the CSV's byte for byte")
