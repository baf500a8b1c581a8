#!/usr/bin/python3
"""fatmc diagnose: hide an effect, name it, patch the model, close the gap; nothing where nothing is hidden; bad input in one line.

Usage: diagnose_command.py FATMC
"""
import csv
import json
import os
import subprocess
import sys
import tempfile

fatmc = sys.argv[1]
aircraft = "campaigns/models/fat.toml"
folder = tempfile.TemporaryDirectory()
experiment = "tests/support/short_experiment.toml"


def place(name):
    return os.path.join(folder.name, name)


def write(name, text):
    with open(place(name), "w", encoding="utf-8") as file:
        file.write(text)
    return place(name)


def run(*arguments):
    return subprocess.run([fatmc, *arguments], capture_output=True, text=True)


def halved(text):
    """The experiment with half of its amplitudes."""
    line = next(line for line in text.split("\n") if line.startswith("amplitude_rad_s"))
    values = [float(word) for word in line[line.index("[") + 1:line.index("]")].split(",")]
    return text.replace(line, "amplitude_rad_s = " + str([0.5 * v for v in values]))


def flight(name, seed, *effects, experiment=experiment):
    out = place(name + ".csv")
    options = [word for effect in effects for word in ("--effect", effect)]
    done = run("simulate", aircraft, experiment, "--seed", str(seed), "-o", out, *options)
    assert done.returncode == 0, done
    return out


def diagnosed(name, *arguments):
    out = place(name)
    done = run("diagnose", "--flights", "300", "--cache", place("cache"), "-o", out, *arguments)
    assert done.returncode == 0, done
    assert sorted(os.listdir(out)) == ["diagnosis.json", "model.toml", "patch.toml", "report.html"]
    with open(os.path.join(out, "diagnosis.json"), encoding="utf-8") as file:
        return json.load(file), done


def read(path):
    with open(path, "rb") as file:
        return file.read()


# An effect is hidden; the plain model and the record are all that diagnose gets.
hidden = flight("hidden", 1, "control_effectiveness:axis=roll,factor=0.75")
other = flight("other", 2, "control_effectiveness:axis=roll,factor=0.75")
answer, done = diagnosed("first", "--model", aircraft, "--record", hidden, "--holdout", other)
assert answer["verdict"] == "named", answer
assert [e["name"] for e in answer["effects"]] == ["control_effectiveness:axis=roll"], answer["effects"]
factor = answer["effects"][0]["parameters"][0]
assert factor["name"] == "factor" and abs(factor["value"] - 0.75) < factor["high"] - factor["low"], factor
assert "flights" in done.stderr, "progress"
assert any(w["input"] == "xi_c" and w["output"] == "p" for w in answer["where"]), answer["where"]
for data in ("training", "holdout"):
    gap = answer["gap"][data]
    assert gap["after"] - gap["floor"] < 0.1 * (gap["before"] - gap["floor"]), (data, gap)
assert {m["holdout"] for m in answer["measures"]} == {False, True}
for measure in answer["measures"]:
    assert measure["after"]["cost"] < measure["before"]["cost"], measure

# The patched model agrees with the other record; the basis of the first answer is not made again.
patched = os.path.join(place("first"), "model.toml")
again, _ = diagnosed("patched", "--model", patched, "--record", other)
assert again["verdict"] == "none", again["evidence"]
cached, done = diagnosed("cached", "--model", aircraft, "--record", hidden, "--holdout", other)
assert cached == answer and "flights" not in done.stderr, done.stderr

# A patch is listed, and undone it gives the parent bit for bit.
done = run("diagnose", "--list", patched)
assert done.returncode == 0 and "control_effectiveness" in done.stdout, done
done = run("diagnose", "--undo", patched, "-o", place("parent.toml"))
assert done.returncode == 0, done
assert read(place("parent.toml")) == read(aircraft)
assert read(patched) != read(aircraft)
for bad in (aircraft, place("nowhere.toml")):
    done = run("diagnose", "--undo", bad, "-o", place("no.toml"))
    assert done.returncode == 2 and done.stderr.count("\n") == 1 and not os.path.exists(place("no.toml")), done

# Two records at two levels are explained by one value; two effects at once need no second round, and it finds nothing more.
quiet = write("quiet_experiment.toml", halved(read(experiment).decode()))
low = flight("low", 4, "backlash:surface=aileron,width_deg=0.8", experiment=quiet)
high = flight("high", 5, "backlash:surface=aileron,width_deg=0.8")
answer, done = diagnosed("levels", "--model", aircraft, "--record", low, "--record", high, "--until-consistent")
assert [e["name"] for e in answer["effects"]] == ["backlash:surface=aileron"], (answer["verdict"], answer["effects"])
width = answer["effects"][0]["parameters"][0]
assert abs(width["value"] - 0.8) < width["high"] - width["low"], width
assert "cannot" not in " ".join(n for n in answer.get("notes", []) if "level or speed" in n), answer["notes"]

# Nothing hidden, nothing named.
answer, _ = diagnosed("null", "--model", aircraft, "--record", flight("null", 3))
assert answer["verdict"] == "none" and answer["effects"] == [] and read(os.path.join(place("null"), "model.toml")) == read(aircraft)


# Records that do not fit.
def variant(name, change, toml=lambda text: text):
    with open(hidden, encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    for row in rows:
        change(row)
    with open(place(name + ".csv"), "w", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, list(rows[0]))
        writer.writeheader()
        writer.writerows(rows)
    with open(place("hidden.toml"), encoding="utf-8") as file:
        write(name + ".toml", toml(file.read()))
    return place(name + ".csv")


def scaled(factor, *names):
    def change(row):
        for column in names:
            row[column] = repr(float(row[column]) * factor)
    return change


def clipped(row):
    row["xi_c"] = repr(max(-0.02, min(0.02, float(row["xi_c"]))))


def refused(record, *words, model=aircraft):
    out = place("refused")
    done = run("diagnose", "--model", model, "--record", record, "-o", out, "--cache", place("cache"))
    assert done.returncode == 2 and done.stdout == "" and done.stderr.count("\n") == 1, done
    for word in words:
        assert word in done.stderr, (word, done.stderr)
    assert not os.path.exists(out), "half written"


refused(variant("degrees", scaled(57.29578, "p", "q", "r", "r_p", "r_q", "r_r")), "57.3")
refused(variant("bank", scaled(57.29578, "phi", "theta")), "phi", "57.3")
refused(variant("clipped", clipped), "xi_c", "saturated")
def gainless(text):
    return "\n".join(line for line in text.split("\n") if "gain" not in line)


refused(variant("gainless", lambda row: None, gainless), "controller_gain")
refused(variant("two", lambda row: None, lambda text: gainless(text).replace('output = ["p", "q", "r"]', 'output = ["p", "q"]')), "output", "three")
refused(place("absent.csv"), "does not exist")
refused(hidden, "kind", "state_space", model=write("other_model.toml", 'kind = "spectrum"\n'))
