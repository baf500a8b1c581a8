"""fatmc report as a user opens it: a page in a real browser (Debian's chromium, headless), and wrong input.
Usage: report_command.py FATMC. Without chromium the browser part is skipped with a message."""
import html
import json
import os
import re
import shutil
import sqlite3
import subprocess
import sys
import tempfile

FATMC = os.path.abspath(sys.argv[1])
ROOT = os.getcwd()
# Measures the page from inside: what a reader would miss is counted.
PROBE = """<script>
addEventListener('load', () => {
  const svgs = [...document.querySelectorAll('figure svg')];
  const drawn = svgs.filter(s => { const b = s.getBoundingClientRect();
    return b.width > 100 && b.height > 100 && s.querySelectorAll('path,rect.bar,circle').length > 3; });
  const ids = [...document.querySelectorAll('[id]')].map(e => e.id);
  const links = [...document.querySelectorAll('a[href^="#"]')].map(a => a.getAttribute('href').slice(1));
  const probe = { figures: svgs.length, drawn: drawn.length, doubled: ids.length - new Set(ids).size,
    broken: links.filter(l => !document.getElementById(l)).length,
    overflow: document.documentElement.scrollWidth - innerWidth,
    ground: getComputedStyle(document.body).backgroundColor,
    requests: performance.getEntriesByType('resource').length };
  document.body.innerHTML = '<pre id="probe"></pre>';
  document.getElementById('probe').textContent = JSON.stringify(probe);
});
</script></body>"""


def run(*arguments, cwd=ROOT):
    return subprocess.run([FATMC, *map(str, arguments)], cwd=cwd, capture_output=True, text=True)


def refused(done, *words):
    lines = done.stderr.splitlines()
    assert done.returncode == 2 and len(lines) == 1, (done.returncode, done.stderr)
    for word in words:
        assert word in lines[0], lines[0]


def probe(browser, page, folder, *options):
    """What the page looks like from inside, and what the browser complains of."""
    with open(page) as file:
        text = file.read()
    copy = os.path.join(folder, "probed.html")
    with open(copy, "w") as file:
        file.write(text.replace("</body>", PROBE))
    done = subprocess.run([browser, "--headless", "--no-sandbox", "--disable-gpu", "--disable-background-networking",
                           "--disable-component-update", "--disable-sync", "--no-first-run", "--enable-logging=stderr",
                           f"--user-data-dir={folder}/profile", *options, "--dump-dom", f"file://{copy}"],
                          capture_output=True, text=True, timeout=120)
    assert "CONSOLE" not in done.stderr, done.stderr
    found = re.search(r'<pre id="probe">(.*?)</pre>', done.stdout, re.S)
    assert found, (done.returncode, done.stdout[-300:], done.stderr[-300:])
    return json.loads(html.unescape(found.group(1)))


with tempfile.TemporaryDirectory() as folder:
    database, page = f"{folder}/c.db", f"{folder}/c.html"
    assert run("run", "campaigns/coverage/spec.toml", "--trials", 4, "--db", database).returncode == 0

    done = run("report", database, "-o", page, "--figures", f"{folder}/figures")
    assert done.returncode == 0, done.stderr
    text = open(page).read()
    assert len(text) < 5e6
    figures = len(re.findall("<figure ", text))
    assert len(os.listdir(f"{folder}/figures")) == figures, (os.listdir(f"{folder}/figures"), figures)
    for word in ("Table 5-5", "Provenance", run("digest", database).stdout.strip()):
        assert word in text, word
    assert run("report", database, "-o", f"{folder}/again.html").returncode == 0
    assert open(f"{folder}/again.html").read() == text  # the same database, the same page

    # A campaign that is not finished says so, in the page and in its tables.
    with sqlite3.connect(database) as plan:  # as if it had been stopped after 4 of 6
        plan.execute("UPDATE cell SET repetitions = 6")
    assert run("report", database, "-o", page).returncode == 0
    assert "Partial: 4 of 6 trials" in open(page).read()
    assert "partial: 4 of 6 trials" in run("tables", database).stdout

    refused(run("report", f"{folder}/none.db", "-o", page), "none.db", "no such database")
    done = run("report", database, f"{folder}/../{os.path.basename(folder)}/c.db", "-o", f"{folder}/again.html")
    assert done.returncode == 0 and "given twice" in done.stderr and "1 campaigns" in done.stdout, done
    assert "given twice" in run("tables", database, database).stderr
    assert run("tables", database, database).stdout == run("tables", database).stdout
    refused(run("report", database, "-o", page, "--figures", database), "--figures", "is a file")
    refused(run("report", database, "-o", folder), folder)
    refused(run("report", database, "-o", f"{folder}/missing/c.html"), "missing")
    refused(run("report", database), "-o")
    refused(run("report", database, "-o", database), "is a database")
    assert run("tables", database).returncode == 0
    with open(f"{folder}/text.db", "w") as file:
        file.write("no database\n")
    refused(run("report", f"{folder}/text.db", "-o", f"{folder}/n.html"), "text.db")
    assert not os.path.exists(f"{folder}/n.html")

    browser = shutil.which("chromium")
    if browser is None:
        print("skipped: no chromium")
        sys.exit(77)
    for name, options in (("desk", ["--window-size=1400,1000"]), ("phone", ["--window-size=500,900"]),
                          ("dark", ["--force-dark-mode", "--blink-settings=preferredColorScheme=0"])):
        seen = probe(browser, page, folder, *options)
        assert seen["figures"] == seen["drawn"] == figures, (name, seen)
        assert seen["doubled"] == 0 and seen["broken"] == 0, (name, seen)
        assert seen["overflow"] <= 0, (name, seen)  # what is wide scrolls by itself
        assert seen["requests"] == 0, (name, seen)
        assert (seen["ground"] != "rgb(255, 255, 255)") == (name == "dark"), (name, seen)
