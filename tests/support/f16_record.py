#!/usr/bin/env python3
"""Writes the record TOML of the F-16 ground vibration test (FATMC_DATA/f16_gvt).

Usage: f16_record.py OUT.toml
Voltage is the generator's reference, force the measured input, three accelerations the outputs. Period and lines are
left out on purpose: `fatmc estimate` finds them.
"""
import sys

RECORD = """[record]
rate_hz = 400.0
reference = ["voltage_V"]
input = ["force_N"]
output = ["acc1", "acc2", "acc3"]
hold = "continuous"
"""

if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    with open(sys.argv[1], "w", encoding="utf-8") as file:
        file.write(RECORD)
