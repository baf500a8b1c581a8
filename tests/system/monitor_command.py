"""fatmc monitor as a user runs it: a record, a stream, and wrong input. Usage: monitor_command.py FATMC"""
import json
import os
import subprocess
import sys
import tempfile

FATMC = os.path.abspath(sys.argv[1])
MODEL = "campaigns/models/fat.toml"


def run(*arguments, text=None):
    return subprocess.run([FATMC, *map(str, arguments)], input=text, capture_output=True, text=True)


def epochs(done):
    assert done.returncode == 0, done.stderr
    return [json.loads(line) for line in done.stdout.splitlines()]


def refused(done, *words):
    lines = done.stderr.splitlines()
    assert done.returncode == 2 and len(lines) == 1, (done.returncode, done.stderr)
    for word in words:
        assert word in lines[0], lines[0]


with tempfile.TemporaryDirectory() as folder:
    flight = f"{folder}/flight.csv"
    assert run("simulate", MODEL, "campaigns/experiments/chapter5.toml", "--seed", 3, "-o", flight).returncode == 0
    meta = f"{folder}/flight.toml"
    rows = open(flight).read()

    # The last epoch of a record that is one window long is the judgement of `fatmc stability`.
    for bias in ("on", "constant"):
        last = epochs(run("monitor", flight, "--nominal", MODEL, "--every", 400, "--combine", "min", "--bias", bias))[-1]
        done = run("stability", flight, "--nominal", MODEL, "--bias", bias, "-o", f"{folder}/{bias}")
        summary = json.load(open(f"{folder}/{bias}/summary.json"))
        for key in ("p_band_ssv", "p_band_hinf"):
            assert abs(last[key] - summary[key]) < 1e-8, (bias, key, last, summary[key])
    whole = epochs(run("monitor", flight, "--nominal", MODEL, "--every", 100, "--combine", "min", "--bias", "off"))
    assert [round(e["t"]) for e in whole] == [100, 200, 300, 400]
    assert [e["window_full"] for e in whole] == [False, False, False, True]
    done = run("stability", flight, "--nominal", MODEL, "--bias", "off", "-o", f"{folder}/stability")
    assert done.returncode == 0, done.stderr
    summary = json.load(open(f"{folder}/stability/summary.json"))
    for key in ("p_band_ssv", "p_band_hinf", "p_total_ssv", "p_total_hinf"):
        assert abs(whole[-1][key] - summary[key]) < 1e-8, (key, whole[-1], summary[key])
    assert whole[-1]["nominal_stable"] == summary["nominal_stable"]
    assert set(whole[-1]) >= {"t", "p_total_ssv", "p_total_hinf", "nominal_stable", "window_full"}

    # An effect of the nominal model's file that its linear plant lacks is named once, away from the epochs.
    delayed = f"{folder}/delayed.toml"
    with open(delayed, "w") as file:
        file.write(open(MODEL).read() + '[[effect]]\nid = "transport_delay"\ndelay_s = 0.03\n')
    done = run("monitor", flight, "--nominal", delayed, "--every", 100)
    assert len(epochs(done)) == 4 and done.stderr.count("transport_delay:delay_s=0.03") == 1, done.stderr

    # The same samples on standard input give the same lines.
    options = ["--nominal", MODEL, "--every", 100, "--combine", "min", "--bias", "off"]
    streamed = run("monitor", "-", "--meta", meta, *options, text=rows)
    assert epochs(streamed) == whole

    # An epoch is printed when it is due, not when the stream ends.
    with subprocess.Popen([FATMC, "monitor", "-", "--meta", meta, *map(str, options)], stdin=subprocess.PIPE,
                          stdout=subprocess.PIPE, text=True) as live:
        lines = rows.splitlines(keepends=True)
        live.stdin.writelines(lines[: 1 + 5000])
        live.stdin.flush()
        assert json.loads(live.stdout.readline())["window_full"] is False  # while the pipe is still open
        live.stdin.close()
        live.wait()

    refused(run("monitor", "-", "--nominal", MODEL, text=rows), "--meta")
    refused(run("monitor", flight, "--nominal", MODEL, "--meta", "absent.toml"), "absent.toml")
    refused(run("monitor", flight, "--nominal", "absent.toml"), "absent.toml")
    broken = "".join(lines[:10]) + "1,2,x\n"
    refused(run("monitor", "-", "--meta", meta, *options, text=broken), "standard input:11", "x")
    no_lines = open(meta).read()
    short = f"{folder}/short.toml"
    with open(short, "w") as f:
        f.writelines(line for line in no_lines.splitlines(keepends=True) if not line.startswith("period_samples"))
    done = run("monitor", "-", "--meta", short, *options, text=rows)
    assert done.returncode == 2 and "period" in done.stderr, done.stderr
print("ok")
