#!/usr/bin/python3
"""How often do the 95 % intervals of `fatmc tables` hold what they promise? Usage: prediction_intervals.py FATMC DB [RUNS [CAMPAIGNS]]

An experiment: cuts the trials of a large campaign into campaigns of the published size (RUNS, 50; CAMPAIGNS of them, 20), prints the tables of each,
and counts for every row how often the interval of one holds the value of another, over all ordered pairs. Pairs share campaigns:
the deviation stated is the scatter between the campaigns whose intervals are asked, divided by the root of their number.

    fatmc run campaigns/stability/spec.toml --scale 20 --db results/large.db
    prediction_intervals.py build/release/bin/fatmc results/large.db
"""
import json
import pathlib
import sqlite3
import subprocess
import sys
import tempfile

import numpy as np

fatmc, source = sys.argv[1], pathlib.Path(sys.argv[2]).resolve()
size = int(sys.argv[3]) if len(sys.argv) > 3 else 50
most = int(sys.argv[4]) if len(sys.argv) > 4 else 20


def tables(path):
    rows = json.loads(subprocess.run([fatmc, "tables", str(path), "--format", "json"], check=True, capture_output=True,
                                     text=True).stdout)
    return {(r["table"], r["row"], r["quantity"]): r for r in rows}


with tempfile.TemporaryDirectory() as folder:
    block = pathlib.Path(folder) / "block.db"
    with sqlite3.connect(f"file:{source}?mode=ro", uri=True) as whole:
        trials = min(n for (n,) in whole.execute("SELECT count(*) FROM trial GROUP BY cell"))
    campaigns = []
    for first in range(0, min(trials, most * size) - size + 1, size):
        block.unlink(missing_ok=True)
        with sqlite3.connect(f"file:{block}", uri=True) as part:
            part.execute("ATTACH ? AS whole", (f"file:{source}?mode=ro",))
            (version,) = part.execute("PRAGMA whole.user_version").fetchone()
            (application,) = part.execute("PRAGMA whole.application_id").fetchone()
            for kind in ("table", "view"):
                for name, sql in part.execute("SELECT name, sql FROM whole.sqlite_master WHERE type = ? AND sql IS NOT NULL",
                                              (kind,)).fetchall():
                    part.execute(sql)
            part.execute(f"PRAGMA user_version = {version}")
            part.execute(f"PRAGMA application_id = {application}")
            for name in ("campaign", "cell", "name", "event", "control"):
                part.execute(f"INSERT INTO main.{name} SELECT * FROM whole.{name}")
            inside = f"& 1099511627775 BETWEEN {first} AND {first + size - 1}"
            part.execute(f"INSERT INTO main.trial SELECT * FROM whole.trial WHERE id {inside}")
            for name in ("metric", "array"):
                part.execute(f"INSERT INTO main.{name} SELECT * FROM whole.{name} WHERE trial {inside}")
            part.execute("UPDATE main.cell SET repetitions = ?", (first + size,))
        campaigns.append(tables(block))

print(f"{len(campaigns)} campaigns of {size} runs")
for key, row in campaigns[0].items():
    numbers = [[c[key][what] for what in ("value", "low", "high")] for c in campaigns]
    value, low, high = (np.array([np.nan if n[i] is None else n[i] for n in numbers], dtype=float) for i in range(3))
    if np.isnan(low).all() and np.isnan(high).all():
        continue
    low, high = np.where(np.isnan(low), -np.inf, low), np.where(np.isnan(high), np.inf, high)
    slack = 1e-9 * np.abs(value)  # shares stand on the interval's ends
    held = (value[None, :] >= low[:, None] - slack) & (value[None, :] <= high[:, None] + slack)
    np.fill_diagonal(held, False)
    each = held.sum(1) / (len(campaigns) - 1)
    print(f"{100 * each.mean():5.1f} % +- {100 * each.std(ddof=1) / len(campaigns) ** 0.5:4.1f}  {', '.join(key)}"
          + (f"  (published {row['published']:g})" if row["published"] is not None else ""))
