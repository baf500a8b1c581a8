#!/usr/bin/python3
"""fatmc estimate, predict: plots, several records, output directories, one-line errors. Usage: estimate_command.py FATMC"""
import math
import os
import random
import re
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as xml

fatmc = sys.argv[1]
folder = tempfile.TemporaryDirectory()
SAMPLES, RATE = 2000, 100.0
ROLES = f'[record]\nrate_hz = {RATE}\ninput = ["a", "b"]\noutput = ["y", "z"]\n'


def path(*parts):
    return os.path.join(folder.name, *parts)


def run(*arguments):
    return subprocess.run([fatmc, *arguments], capture_output=True, text=True)


def done(*arguments):
    result = run(*arguments)
    assert result.returncode == 0, result
    return result.stdout


def refused(arguments, *words):
    result = run(*arguments)
    assert result.returncode == 2, result
    assert result.stdout == "" and result.stderr.count("\n") == 1, result
    for word in words:
        assert word in result.stderr, (word, result.stderr)


def record(name, seed):
    """Sweeps over all frequencies, of other phases from record to record, through two short filters, at rest at the ends."""
    draw = random.Random(seed)
    turn = draw.uniform(0.0, 2.0 * math.pi)
    quiet = 50
    u = [[0.0, 0.0] for _ in range(SAMPLES)]
    for n in range(quiet, SAMPLES - quiet):
        phase = math.pi * 0.9 * (n - quiet) ** 2 / (2.0 * (SAMPLES - 2 * quiet))
        u[n] = [math.cos(phase), math.cos(phase + turn) * (1.0 if seed % 2 else -0.5)]
    rows = []
    for n in range(SAMPLES):
        past = u[n - 1] if n else [0.0, 0.0]
        y = u[n][0] + 0.5 * past[0] - 0.3 * u[n][1] + 1e-3 * draw.gauss(0.0, 1.0)
        z = 0.2 * u[n][0] + 2.0 * u[n][1] - 0.4 * past[1] + 1e-3 * draw.gauss(0.0, 1.0)
        rows.append(f"{u[n][0]!r},{u[n][1]!r},{y!r},{z!r}")
    with open(path(f"{name}.csv"), "w", encoding="utf-8") as file:
        file.write("a,b,y,z\n" + "\n".join(rows) + "\n")
    with open(path(f"{name}.toml"), "w", encoding="utf-8") as file:
        file.write(ROLES)
    return path(f"{name}.csv")


sweeps = [record(f"sweep{seed}", seed) for seed in range(4)]
held_out = record("held_out", 9)

# Several records together, a band, and the prediction of another one.
out = path("joint")
text = done("estimate", *sweeps, "--method", "arbitrary", "--band", "2", "40", "--plots", "-o", out)
assert "4 records together" in text and "2 to 40 Hz" in text, text
assert sorted(os.listdir(out)) == ["estimate.json", "frm.csv", "response.svg"], os.listdir(out)
text = done("predict", held_out, "--response", os.path.join(out, "frm.csv"), "-o", path("prediction"))
assert sorted(os.listdir(path("prediction"))) == ["predicted.csv", "prediction.json"]
vaf = [float(line.split()[1]) for line in text.splitlines() if line.startswith(("  y ", "  z "))]
assert len(vaf) == 2 and min(vaf) > 99.9, text
assert "written" not in done("predict", held_out, "--response", os.path.join(out, "frm.csv"))

# Plots are well-formed, the same every time, and show every element; a reference adds a figure.
again = path("again")
done("estimate", *sweeps, "--method", "arbitrary", "--band", "2", "40", "--reference", os.path.join(out, "frm.csv"), "-o", again)
assert sorted(os.listdir(again)) == ["error.svg", "estimate.json", "frm.csv", "response.svg"]
for name in ("response.svg", "error.svg"):
    tree = xml.parse(os.path.join(again, name))
    texts = [element.text for element in tree.iter("{http://www.w3.org/2000/svg}text")]
    for element in ("y / a", "y / b", "z / a", "z / b"):
        assert any((t or "").startswith(element) for t in texts), (name, element, texts)
    content = open(os.path.join(again, name), encoding="utf-8").read()
    assert "nan" not in content and "inf" not in content
costs = [float(cost) for cost in re.findall(r": cost ([^,]*), 0 of 761 outside", content)]
assert len(costs) == 4 and max(costs) < 1e-20, "an estimate has no error against itself"
first = open(os.path.join(out, "response.svg"), "rb").read()
done("estimate", *sweeps, "--method", "arbitrary", "--band", "2", "40", "--plots", "-o", out)
assert open(os.path.join(out, "response.svg"), "rb").read() == first

# What cannot be written to is said before the work, and nothing is left behind.
refused(["estimate", *sweeps, "--method", "arbitrary", "-o", "/proc/fatmc"], "/proc/fatmc", "-o", "cannot be written to")
refused(["estimate", *sweeps, "--method", "arbitrary", "-o", sweeps[0]], "is a file")
refused(["predict", held_out, "--response", os.path.join(out, "frm.csv"), "-o", os.path.join(sweeps[0], "x")], "cannot be written to")
refused(["ssv", sweeps[0], "-o", "/proc/fatmc.csv"], "-o")
refused(["estimate", path("nowhere.csv"), "-o", path("p", "q", "r")], "nowhere.csv", "does not exist")
assert not os.path.exists(path("p"))

refused(["estimate", *sweeps[:2], "--method", "arbitrary", "-o", path("x")], "3 or more; there are 2")
refused(["estimate", *sweeps, "--method", "arbitrary", "--band", "40", "2", "-o", path("x")], "--band")
refused(["estimate", sweeps[0], "--method", "etfe", "--band", "2", "40", "-o", path("x")], "--band", "excited lines")
refused(["estimate", *sweeps, "--method", "arbitrary", "--reference", path("no.csv"), "-o", path("x")], "no.csv")
refused(["predict", held_out, "--response", sweeps[0]], "frequency_hz", "is missing")
with open(path("other.toml"), "w", encoding="utf-8") as file:
    file.write(ROLES.replace('["y", "z"]', '["z", "w"]'))
refused(["predict", held_out, "--meta", path("other.toml"), "--response", os.path.join(out, "frm.csv")], "no column", '"w"')
assert not os.path.exists(path("x"))
for command in ("estimate", "predict"):
    assert "Example" in run(command, "--help").stdout
