"""The database of a campaign, read with sqlite3 and numpy alone (docs/schema.md), and its views against numpy.

Usage: schema_reference.py FATMC
"""
import csv
import io
import json
import pathlib
import sqlite3
import subprocess
import sys
import tempfile

import numpy
from scipy import stats

TRIALS = 24
LARGEST_TRIAL_BYTES = 40_000


def arrays(db, name):
    rows = db.execute("SELECT data FROM arrays WHERE cell = 'nonlinear' AND name = ? ORDER BY repetition", (name,))
    return numpy.array([numpy.frombuffer(data, "<f8") for (data,) in rows])


def metric(db, name):
    values = {value for (value,) in db.execute("SELECT value FROM metrics WHERE name = ?", (name,))}
    assert len(values) == 1, (name, values)
    return values.pop()


def check_elements(db, re):
    seen = numpy.full(re.shape, numpy.nan)
    for repetition, position, value in db.execute(
            "SELECT repetition, position, value FROM elements WHERE name = 'error_re'"):
        seen[repetition, position] = value
    assert numpy.array_equal(seen, re), "elements are the doubles of the arrays, bit for bit"


def check_bias(db, error, variance, bias):
    n = len(error)
    mean = error.mean(axis=0)
    scatter = numpy.sqrt((abs(error - mean)**2).sum(axis=0) / (n - 1) / n)
    rows = db.execute("SELECT line, output, input, error_re, error_im, standard_error, mean_estimated_bias, "
                      "estimated_standard_deviation FROM bias").fetchall()
    assert len(rows) == error.shape[1]
    inputs, elements = int(metric(db, "inputs")), int(metric(db, "elements_per_line"))
    for position, row in enumerate(rows):
        assert row[:3] == (position // elements, position % elements // inputs, position % inputs), (position, row)
        expected = [mean[position].real, mean[position].imag, scatter[position], bias[:, position].mean(),
                    numpy.sqrt(variance[:, position].mean())]
        numpy.testing.assert_allclose(row[3:], expected, rtol=1e-9, atol=1e-12)


def check_coverage(db, error, variance, bias, q):
    plain = abs(error)**2 / variance
    extended = numpy.maximum(0.0, abs(error) - bias)**2 / variance
    printed = (abs(error) - bias)**2 / variance
    rows = db.execute("SELECT * FROM coverage").fetchall()
    assert [row[1] for row in rows] == [0.75, 0.9, 0.95, 0.99]
    for row in rows:
        limit = stats.f.ppf(row[1], 2, 2 * q)
        for square, value, standard_error in zip((plain, extended, printed), row[3::2], row[4::2]):
            shares = (square <= limit).mean(axis=1)
            numpy.testing.assert_allclose(value, shares.mean(), rtol=1e-12)
            numpy.testing.assert_allclose(standard_error, stats.sem(shares), rtol=1e-6, atol=1e-9)


def check_command(fatmc, path, re):
    out = subprocess.run([fatmc, "query", path, "--array", "error_re"], check=True, capture_output=True, text=True)
    rows = list(csv.reader(io.StringIO(out.stdout)))
    assert rows[0][:3] == ["cell", "repetition", "0"]
    assert numpy.array_equal(numpy.array([[float(x) for x in row[2:]] for row in rows[1:]]), re)
    out = subprocess.run([fatmc, "query", path, "--view", "coverage", "--format", "json"], check=True,
                         capture_output=True, text=True)
    assert len(json.loads(out.stdout)) == 4


def main():
    fatmc = sys.argv[1]
    with tempfile.TemporaryDirectory() as folder:
        path = f"{folder}/coverage.db"
        subprocess.run([fatmc, "run", "campaigns/coverage/spec.toml", "--trials", str(TRIALS), "--db", path],
                       check=True, capture_output=True)
        size = pathlib.Path(path).stat().st_size / TRIALS
        db = sqlite3.connect(f"file:{path}?mode=ro", uri=True)
        re, im, variance, bias = (arrays(db, name) for name in ("error_re", "error_im", "variance", "bias"))
        assert re.shape[0] == TRIALS
        check_elements(db, re)
        check_bias(db, re + 1j * im, variance, bias)
        check_coverage(db, re + 1j * im, variance, bias, metric(db, "degrees_of_freedom"))
        check_command(fatmc, path, re)
        db.close()
        (page,) = sqlite3.connect(path).execute("PRAGMA page_size").fetchone()
        print(f"{TRIALS} trials: {size / 1000:.1f} kB a trial with pages of {page} bytes")
        # The empty schema, some 40 pages, is spread over few trials here: an upper bound.
        assert size <= LARGEST_TRIAL_BYTES, size


if __name__ == "__main__":
    main()
