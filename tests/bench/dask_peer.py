#!/usr/bin/env python3
"""The peer of the engine's benchmarks: Dask distributed (Debian: python3-distributed), two worker processes here.

Prints JSON: {"noop_per_s": ..., "efficiency_10ms": ...}; exits 77 where Dask is not installed. Dask neither stores nor
authenticates, so that its figures are of less work than ours.
"""
import json
import logging
import os
import sys
import time
import warnings

NOOPS = 3000
TRIALS, TRIAL_S = 400, 0.010
WORKERS = 2


def noop(index):
    return index


def busy(index):
    """Ten milliseconds of processor time, as a trial takes them; the time that passed meanwhile, as the engine counts."""
    start = time.monotonic()
    end = time.process_time() + TRIAL_S
    while time.process_time() < end:
        pass
    return time.monotonic() - start


def main():
    warnings.simplefilter("ignore")
    logging.disable(logging.CRITICAL)
    try:
        from distributed import Client, LocalCluster
    except ImportError:
        print("python3-distributed is not installed", file=sys.stderr)
        sys.exit(77)
    os.environ["DASK_DISTRIBUTED__WORKER__MEMORY__TERMINATE"] = "False"
    with LocalCluster(n_workers=WORKERS, threads_per_worker=1, dashboard_address=None, processes=True,
                      silence_logs=logging.CRITICAL) as cluster, Client(cluster) as client:
        client.gather(client.map(noop, range(-100, 0)))  # workers are up, modules loaded
        start = time.monotonic()
        client.gather(client.map(noop, range(NOOPS), pure=False))
        noop_per_s = NOOPS / (time.monotonic() - start)
        start = time.monotonic()
        worked = sum(client.gather(client.map(busy, range(TRIALS), pure=False)))
        elapsed = time.monotonic() - start
    print(json.dumps({"noop_per_s": noop_per_s, "efficiency_10ms": worked / (WORKERS * elapsed)}))


if __name__ == "__main__":
    main()
