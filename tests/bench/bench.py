#!/usr/bin/env python3
"""Runs the benchmarks and prints a line a figure; --json prints JSON lines.

`reference` is the figure of a peer or of the thesis, `ratio` says how many times better ours is. Figures of Google
Benchmark are medians of repetitions; whole commands are timed several times and the median is given.
"""
import argparse
import json
import pathlib
import resource
import statistics
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
BIN = ROOT / "build" / "release" / "bin"

# name: (program, filter of its benchmarks, unit, reference, higher is better, where the reference is from); the figure is
# the counter of that name. A reference that is a name is a peer that the same program measures beside it; it is left out
# where the peer is not installed.
GOOGLE = {
    "sim_steps_per_s": ("bench_flight", "closed_loop/nonlinear_record_400_s", "1/s", 0.125e6, True,
                        "JSBSim on such a core: 0.10 to 0.15 million simpler frames a second"),
    "lpm_73_lines_ms": ("bench_lpm", "lpm_", "ms", 40.0, False, "thesis, section 5.8.1: 0.04 s"),
    "lpm_line_us_prepared": ("bench_lpm", "lpm_", "us", None, False, ""),
    "lpm_line_us_cold": ("bench_lpm", "lpm_", "us", None, False, ""),
    "ssv_us_cold": ("bench_robust", "ssv_us_(cold|warm|slicot)$", "us", "ssv_us_slicot", False,
                    "SLICOT's AB13MD, upper bound alone, in the same run; ours both bounds"),
    "ssv_us_warm": ("bench_robust", "ssv_us_(cold|warm|slicot)$", "us", "ssv_us_slicot", False, "the same"),
    "epoch_ms": ("bench_stability", "epoch_ms", "ms", 1040.0, False,
                 "thesis, section 5.8.1: LPM 0.04 s, mu-analysis about 1 s; bar 2.5 ms"),
    **{f"{name}_line_us": ("bench_estimators", ".*_line_us", "us", None, False, "")
       for name in ("etfe", "tlpm", "robust", "lrm", "arbitrary", "joint", "welch")},
    "monitor_epochs_per_s": ("bench_stability", "monitor_epochs_per_s", "1/s", 1.0, True,
                             "thesis: about 1; bar 500, ten times the sample rate"),
    "pbsid_shared_over_direct": ("bench_subspace", "pbsid_models/.*", "1/s", "pbsid_direct_per_s", True,
                                 "a direct computation for each model in the same run: 105 models of 15 windows"),
    "acked_per_s": ("bench_engine", "AckedTrials/100000/2", "1/s", "dask_noop_per_s", True,
                    "Dask distributed in the same run, without storage or keys; bar 20,000 with CURVE, synchronous=FULL"),
    "coordinator_us_per_trial": ("bench_engine", "AckedTrials/100000/2", "us", 50.0, False, "bar"),
    "efficiency_10ms": ("bench_engine", "TenMillisecondTrials", "", "dask_efficiency_10ms", True,
                        "Dask distributed in the same run; bar 0.98"),
    "resume_million_s": ("bench_engine", "ResumeMillion", "s", 2.0, False, "bar: reopen, plan, ready to lease"),
    "aggregate_million_s": ("bench_engine", "AggregateMillion", "s", 10.0, False,
                            "bar: views outcomes and scalars over a million trials of three scalars"),
    "coordinator_growth_b_per_trial": ("bench_engine", "MemoryOfAMillion", "B", None, False,
                                       "resident memory of the coordinator's process, from 100,000 trials to 1,000,000"),
}


def google_benchmark(program, chosen):
    """Medians of all counters of the chosen benchmarks; a benchmark that takes a minute runs once."""
    repetitions = 1 if chosen == "MemoryOfAMillion" else 5
    path = BIN / program
    if not path.exists():
        sys.exit(f"bench: {path} is missing, run scripts/build")
    figures = {}
    with tempfile.TemporaryDirectory() as folder:  # a file, since what is measured logs on standard output
        subprocess.run([str(path), f"--benchmark_filter=^{chosen}", f"--benchmark_out={folder}/figures.json",
                        f"--benchmark_repetitions={repetitions}",
                        f"--benchmark_report_aggregates_only={str(repetitions > 1).lower()}"],
                       check=True, capture_output=True, text=True, cwd=ROOT)
        entries = json.loads(pathlib.Path(folder, "figures.json").read_text(encoding="utf-8"))["benchmarks"]
    for entry in entries:
        if repetitions == 1 or entry.get("aggregate_name") == "median":
            figures.update({name: value for name, value in entry.items() if isinstance(value, float)})
    return figures


def dask_peer():
    """Figures of Dask distributed, with dask_ before their names; none where it is not installed."""
    script = ROOT / "tests/bench/dask_peer.py"
    out = subprocess.run(["/usr/bin/python3", str(script)], capture_output=True, text=True)
    if out.returncode != 0:
        print(f"bench: no figures of Dask: {out.stderr.strip().splitlines()[-1:]}; apt-get install python3-distributed "
              "brings it", file=sys.stderr)
        return {}
    return {f"dask_{name}": value for name, value in json.loads(out.stdout).items()}


def coverage_campaign_seconds(runs=5):
    """Wall time of the default campaign, 50 trials, from start to table."""
    times = []
    for _ in range(runs):
        with tempfile.TemporaryDirectory() as folder:
            start = time.monotonic()
            subprocess.run([str(BIN / "fatmc"), "run", str(ROOT / "campaigns/coverage/spec.toml"),
                            "--workers", "2", "--db", f"{folder}/coverage.db"], check=True, capture_output=True)
            times.append(time.monotonic() - start)
    return statistics.median(times)


def largest_process_mb(pid):
    """Largest resident set so far of a process and its children, in MB."""
    largest = 0
    for process in [str(pid), *pathlib.Path(f"/proc/{pid}/task/{pid}/children").read_text().split()]:
        for line in pathlib.Path(f"/proc/{process}/status").read_text().splitlines():
            if line.startswith("VmHWM:"):
                largest = max(largest, int(line.split()[1]))
    return largest / 1024.0


def coverage_campaign_memory():
    """Largest process, coordinator or worker, of the default campaign with 500 trials, looked at every 10 ms."""
    largest = 0.0
    with tempfile.TemporaryDirectory() as folder:
        process = subprocess.Popen([str(BIN / "fatmc"), "run", str(ROOT / "campaigns/coverage/spec.toml"), "--trials", "500",
                                    "--workers", "2", "--db", f"{folder}/coverage.db"],
                                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        while process.poll() is None:
            try:
                largest = max(largest, largest_process_mb(process.pid))
            except (FileNotFoundError, ProcessLookupError):  # it ended between two looks
                pass
            time.sleep(0.01)
    if process.returncode != 0:
        sys.exit("bench: the coverage campaign failed")
    return largest


def diagnosis_seconds():
    """Wall time of the first diagnosis of a record, 400 s flown with a delay, and processor time of the second."""
    model, experiment = ROOT / "campaigns/models/fat.toml", ROOT / "campaigns/experiments/chapter5.toml"
    with tempfile.TemporaryDirectory() as folder:
        record = f"{folder}/flight.csv"
        subprocess.run([str(BIN / "fatmc"), "simulate", str(model), str(experiment), "--seed", "1", "--effect",
                        "transport_delay:delay_s=0.03", "-o", record], check=True, capture_output=True)

        def diagnose():
            start, before = time.monotonic(), resource.getrusage(resource.RUSAGE_CHILDREN)
            subprocess.run([str(BIN / "fatmc"), "diagnose", "--model", str(model), "--record", record, "-o",
                            f"{folder}/diagnosis", "--cache", folder], check=True, capture_output=True)
            after = resource.getrusage(resource.RUSAGE_CHILDREN)
            return time.monotonic() - start, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime

        cold = diagnose()[0]
        return {"diagnose_s": cold, "diagnose_cached_cpu_s": diagnose()[1]}


def thesis_seconds():
    """Wall time of all studies at the thesis's size."""
    with tempfile.TemporaryDirectory() as folder:
        start = time.monotonic()
        subprocess.run([str(BIN / "fatmc"), "run", str(ROOT / "campaigns/thesis.toml"), "--workers", "2"], check=True,
                       capture_output=True, cwd=folder)
        return time.monotonic() - start


# name: (what measures it, unit, bar, where the bar is from)
COMMANDS = {
    "coverage_campaign_s": (coverage_campaign_seconds, "s", 3.0, "bar: 50 trials on 2 cores, start to table"),
    "campaign_memory_mb": (coverage_campaign_memory, "MB", 200.0, "bar: largest process of a campaign"),
    "thesis_campaign_s": (thesis_seconds, "s", 60.0, "bar: all studies of the thesis on 2 cores"),
    "diagnose_s": (diagnosis_seconds, "s", 20.0, "bar: a 400 s record, nothing cached, 2 cores"),
    "diagnose_cached_cpu_s": (diagnosis_seconds, "s", 1.0, "bar: processor time once model and experiment are cached"),
}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--json", action="store_true", help="print JSON lines")
    parser.add_argument("--only", help="rows whose name holds this text")
    arguments = parser.parse_args()

    chosen_names = [name for name in [*GOOGLE, *COMMANDS] if (arguments.only or "") in name]
    measured = dask_peer() if {"acked_per_s", "efficiency_10ms"} & set(chosen_names) else {}

    def emit(name, unit, reference, higher, source):
        value = measured[name]
        ratio = None if reference is None else (value / reference if higher else reference / value)
        if arguments.json:
            print(json.dumps({"name": name, "value": value, "unit": unit, "reference": reference, "ratio": ratio}),
                  flush=True)
        else:
            text = f"{name:26s} {value:14.6g} {unit:4s}"
            if reference is not None:
                text += f"   reference {reference:<10.6g} ratio {ratio:8.2f}   {source}"
            print(text, flush=True)

    for name, (program, chosen, unit, reference, higher, source) in GOOGLE.items():
        if name not in chosen_names:
            continue
        if name not in measured:
            measured.update(google_benchmark(program, chosen))
        emit(name, unit, measured.get(reference) if isinstance(reference, str) else reference, higher, source)
    for name, (measure, unit, bar, source) in COMMANDS.items():
        if name not in chosen_names:
            continue
        if name not in measured:
            value = measure()
            measured.update(value if isinstance(value, dict) else {name: value})
        emit(name, unit, bar, False, source)


if __name__ == "__main__":
    main()
