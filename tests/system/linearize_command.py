#!/usr/bin/python3
"""fatmc linearize: formats, exit codes, one-line errors. Usage: linearize_command.py FATMC"""
import json
import os
import re
import subprocess
import sys
import tempfile

fatmc = sys.argv[1]
model = "campaigns/models/fat.toml"


def run(*arguments):
    return subprocess.run([fatmc, "linearize", *arguments], capture_output=True, text=True)


def refused(text, *words):
    with tempfile.NamedTemporaryFile("w", suffix=".toml") as file:
        file.write(text)
        file.flush()
        done = run(file.name)
        assert done.returncode == 2, done
        assert done.stdout == "", done.stdout
        assert done.stderr.count("\n") == 1, done.stderr
        assert os.path.basename(file.name) in done.stderr, done.stderr
        for word in words:
            assert word in done.stderr, done.stderr


out = json.loads(run(model, "--format", "json").stdout)
assert list(out) == ["states", "inputs", "outputs", "A", "B", "C", "D", "poles", "zeros", "sampled"], list(out)
assert out["inputs"] == ["xi_c", "eta_c", "zeta_c"] and out["outputs"] == ["p", "q", "r"]
n = len(out["states"])
assert [len(out["A"]), len(out["A"][0]), len(out["B"][0]), len(out["C"]), len(out["poles"])] == [n, n, 3, 3, n]
assert set(out["zeros"]) == {f"{y}/{u}" for y in "pqr" for u in ("xi_c", "eta_c", "zeta_c")}
assert list(out["sampled"]) == ["rate_hz", "A", "B", "C", "D"] and out["sampled"]["rate_hz"] == 50

text = run(model)
assert text.returncode == 0
assert all(f"Table A-{i}" in text.stdout for i in (1, 2, 5)), text.stdout
source = open(model).read()
with tempfile.NamedTemporaryFile("w", suffix=".toml") as other:
    other.write(source.replace('name = "FAT"', 'name = "another"'))
    other.flush()
    assert "Table A-" not in run(other.name).stdout  # nothing is published of it

assert "Example" in run("--help").stdout
refused(source.replace("mass_kg = 23.0", "mass_kg = -1"), "mass.mass_kg", "out of range")
refused(source.replace("speed_m_s = 24.0", "speed_m_s = 13.0"), "speed_m_s")
line = 1 + source[: source.index("span_m")].count("\n")
refused(source.replace("span_m = 5.0", "span = 5.0"), "geometry")
refused(source.replace("span_m = 5.0", 'span_m = "5"'), f":{line}:", "geometry.span_m", "write a number")
refused("kind = \n", ":1:")
missing = run("nowhere.toml")
assert missing.returncode == 2 and missing.stderr.count("\n") == 1
assert run(model, "--format", "xml").returncode == 2
assert re.search(r"MODEL", run().stderr) and run().returncode == 2
