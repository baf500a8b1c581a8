"""Median overall d1, and that of the roll rate, by past and future window: python3 agreement_by_window.py DATABASE [CELL]"""
import sqlite3
import sys

import numpy as np

FUTURES = [(20, 50), (60, 100), (110, 200), (210, 400), (410, 700), (710, 994)]
PASTS = [(20, 100), (110, 200), (210, 400), (410, 600), (610, 800), (810, 994)]
ROLL_RATE, OUTPUTS = 3, 8

database, cell = sys.argv[1], sys.argv[2] if len(sys.argv) > 2 else "open loop"
columns = {}
for name, data in sqlite3.connect(database).execute("SELECT name, data FROM arrays WHERE cell = ? ORDER BY repetition", (cell,)):
    columns.setdefault(name, []).append(np.frombuffer(data, "<f8"))
past, future, order, overall, outputs = (np.concatenate(columns[name]) for name in ("past", "future", "order", "d1", "d1_outputs"))
roll = outputs.reshape(-1, OUTPUTS)[:, ROLL_RATE]
for n in (12, 18):
    print(f"n = {n}, {cell}: d1 overall, of p, (models)")
    print("past".ljust(10) + "".join(f"f {low}..{high}".ljust(20) for low, high in FUTURES))
    for low, high in PASTS:
        line = f"{low}..{high}".ljust(10)
        for first, last in FUTURES:
            m = (order == n) & (past >= low) & (past <= high) & (future >= first) & (future <= last)
            line += (f"{np.median(overall[m]):.2f} {np.median(roll[m]):.2f} ({m.sum()})" if m.any() else "-").ljust(20)
        print(line)
