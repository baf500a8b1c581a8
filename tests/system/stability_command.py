#!/usr/bin/python3
"""fatmc stability: files, exit codes, one-line errors. Usage: stability_command.py FATMC"""
import csv
import json
import os
import subprocess
import sys
import tempfile

fatmc = sys.argv[1]
aircraft = "campaigns/models/fat.toml"
folder = tempfile.TemporaryDirectory()
record = os.path.join(folder.name, "flight.csv")
meta = os.path.join(folder.name, "flight.toml")
written = 0


def path(name, text):
    full = os.path.join(folder.name, name)
    with open(full, "w", encoding="utf-8") as file:
        file.write(text)
    return full


def run(*arguments):
    return subprocess.run([fatmc, "stability", *arguments], capture_output=True, text=True)


def judged(*arguments, nominal=aircraft):
    global written
    written += 1
    out = os.path.join(folder.name, f"out{written}")
    done = run(record, "--nominal", nominal, "-o", out, *arguments)
    assert done.returncode == 0, done
    assert sorted(os.listdir(out)) == ["lines.csv", "summary.json"]
    with open(os.path.join(out, "lines.csv"), encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    with open(os.path.join(out, "summary.json"), encoding="utf-8") as file:
        return rows, json.load(file), done.stdout


def refused(arguments, *words):
    out = os.path.join(folder.name, "refused")
    done = run(*arguments, "-o", out)
    assert done.returncode == 2, done
    assert done.stdout == "", done.stdout
    assert done.stderr.count("\n") == 1, done.stderr
    for word in words:
        assert word in done.stderr, (word, done.stderr)
    assert not os.path.exists(out), "half written"


subprocess.run([fatmc, "simulate", aircraft, "campaigns/experiments/chapter5.toml", "--seed", "2", "-o", record], check=True,
               stdout=subprocess.DEVNULL)

rows, summary, text = judged()
assert list(rows[0]) == ["line", "frequency_hz", "hinf_nominal", "ssv_nominal", "hinf", "ssv_upper", "ssv_lower",
                         "kappa_hinf", "kappa_ssv", "p_hinf", "p_ssv", "snr_min_db"], list(rows[0])
assert len(rows) == 73 and rows[0]["line"] == "57" and float(rows[0]["frequency_hz"]) == 0.285
assert list(summary)[:8] == ["nominal_stable", "p_band_hinf", "p_band_ssv", "p_total_hinf", "p_total_ssv", "combine",
                             "bias", "intergrid"], list(summary)
assert (summary["combine"], summary["bias"], summary["intergrid"]) == ("min", "on", 0.03)
for word in ("H-infinity", "ssv", "nominally stable", "p over the band", "gates", "lines.csv"):
    assert word in text, text
again, _, _ = judged()
assert again == rows, "two runs differ"
by_gain, _, _ = judged("--gain", "0.1")
assert by_gain == rows, "controller_gain of the record is 0.1 times the identity"
_, joint, _ = judged("--combine", "bonferroni")
assert joint["p_band_ssv"] <= summary["p_band_ssv"]
offsets, same, _ = judged("--bias", "offsets")
assert offsets == rows and same["bias"] == "offsets"
constant, limit, text = judged("--bias", "constant")
assert limit["bias"] == "constant" and "bias constant" in text
# The window of the first line lies on one side: its actual offsets have a larger constant than many lines (2.145).
assert float(constant[0]["hinf"]) < float(rows[0]["hinf"]) and limit["p_band_ssv"] >= summary["p_band_ssv"]
without, unbiased, _ = judged("--bias", "off", "--intergrid", "0")
assert all(float(a["hinf"]) < float(b["hinf"]) for a, b in zip(without, rows))
assert unbiased["p_band_ssv"] > summary["p_band_ssv"]

# A response of the model at the record's lines, from the record's own estimate: the nominal values are then zero.
estimate = os.path.join(folder.name, "estimate")
subprocess.run([fatmc, "estimate", record, "-o", estimate], check=True, stdout=subprocess.DEVNULL)
same, trusted, text = judged(nominal=os.path.join(estimate, "frm.csv"))
assert max(float(row["hinf_nominal"]) for row in same) < 1e-12 and trusted["nominal"]["largest_pole"] is None
assert "cannot be checked" in text
# An integrator, to rounding, is moved onto the circle.
one = 'kind = "state_space"\nrate_hz = 50\nA = [[{a}]]\nB = [[{b}, 0, 0]]\nC = [[1], [0], [0]]\n'
_, moved, text = judged(nominal=path("integrator.toml", one.format(a="1.0", b="0.1")))
assert moved["nominal"]["moved_poles"] == 1 and "1 pole moved" in text, text

assert "Example" in run("--help").stdout
refused([record, "--nominal", "nowhere.toml"], "nowhere.toml")
refused([record, "--nominal", path("kind.toml", 'kind = "wheel"\n')], "kind", "state_space")
refused([record, "--nominal", path("unstable.toml", one.format(a="1.01", b="0.1"))], "not stable", "1.01")
refused([record, "--nominal", path("loop.toml", one.format(a="0.99", b="-0.2"))], "controller gain", "not stable", "1.01")
refused([record, "--nominal", path("rate.toml", one.format(a="0.9", b="1").replace("50", "100"))], "rate_hz", "100")
refused([record, "--nominal", path("shape.toml", one.format(a="0.9", b="1").replace("[0], [0]]", "[0]]"))], "outputs")
refused([record, "--nominal", path("text.toml", one.format(a='"x"', b="1"))], ":3:", "A")
refused([record, "--nominal", path("names.toml", one.format(a="0.9", b="1") + 'inputs = ["a", "b", "c"]\n')], "xi_c", "a, b, c")
with open(os.path.join(estimate, "frm.csv"), encoding="utf-8") as file:
    response = file.read().splitlines()
refused([record, "--nominal", path("gap.csv", "\n".join(response[:-9]) + "\n")], "2.89", "line of the record")
refused([record, "--nominal", path("hole.csv", "\n".join(response[:5] + response[6:]) + "\n")], "is missing at")
refused([record, "--nominal", path("nan.csv", "\n".join([response[0], response[1].rsplit(",", 4)[0] + ",nan,0,0,0"]))],
        "nan.csv:2", "re")
refused([record, "--nominal", aircraft, "--intergrid", "-1"], "--intergrid")
refused([record, "--nominal", aircraft, "--combine", "max"], "--combine")
refused([record, "--nominal", aircraft, "--bias", "some"], "--bias", "constant")
refused([record, "--nominal", aircraft, "--n-e", "3"])
# Effects of a model file that the linearised airframe does not show are named, in text and JSON; without any there is no word.
with open(aircraft) as file:
    plain_model = file.read()
delayed = path("delayed.toml", plain_model + '[[effect]]\nid = "transport_delay"\ndelay_s = 0.03\n[[effect]]\nid = "mass"\nfactor = 1.1\n')
for model, words in ((delayed, ["transport_delay:delay_s=0.03"]), (aircraft, [])):
    _, summary, text = judged(nominal=model)
    assert summary["nominal"].get("effects_not_shown", []) == words, summary["nominal"]
    said = [line for line in text.splitlines() if "not in the nominal plant" in line]
    assert len(said) == len(words) and all(word in said[0] and "mass" not in said[0] for word in words), text
refused([record], "--nominal")
with open(meta, encoding="utf-8") as file:
    roles = file.read()
bare = path("bare.toml", "\n".join(line for line in roles.splitlines() if not line.startswith("controller_gain")))
refused([record, "--nominal", aircraft, "--meta", bare], "controller_gain", "--gain")
assert run(record, "--nominal", aircraft, "--meta", bare, "--gain", "0.1", "-o", os.path.join(folder.name, "bare")).returncode == 0
two = path("two.toml", open(bare, encoding="utf-8").read().replace('output = ["p", "q", "r"]', 'output = ["p", "q"]'))
refused([record, "--nominal", aircraft, "--meta", two, "--gain", "0.1"], "--gain", "identity")
