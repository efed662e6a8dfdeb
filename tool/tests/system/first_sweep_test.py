#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""The first sweep of docs/reference/sweeps.md, exactly as printed there: its file, its commands, their output, and
the page that they make.

usage: first_sweep_test.py DEBURR ROOT [--write]

--write updates the picture of that page, docs/images/first_sweep.png."""
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

BROWSER = next((b for b in ("chromium", "chromium-browser", "google-chrome") if shutil.which(b)), None)
PICTURE = "docs/images/first_sweep.png"


def section():
    with open(os.path.join(ROOT, "docs/reference/sweeps.md")) as file:
        return file.read().split("## A first sweep in five minutes")[1].split("\n## ")[0]


def browse(page, *arguments):
    return subprocess.run([BROWSER, "--headless", "--no-sandbox", "--disable-gpu", "--hide-scrollbars",
                           "--window-size=1000,1000", "--virtual-time-budget=5000", *arguments, page],
                          text=True, capture_output=True, timeout=120).stdout


class FirstSweep(unittest.TestCase):
    def test_page_commands_print_what_it_shows(self):
        text = section()
        name, definition = re.search(r"`(\w+\.yaml)`:\n\n```yaml\n(.*?)```", text, re.S).groups()
        commands = [line for language, block in re.findall(r"```(\w*)\n(.*?)```", text, re.S)
                    for line in block.splitlines() if not language and line.startswith("deburr ")]
        self.assertGreaterEqual(len(commands), 3)
        with tempfile.TemporaryDirectory(prefix="deburr_first_") as directory:
            with open(os.path.join(directory, name), "w") as file:
                file.write(definition)
            path = dict(os.environ, PATH=os.path.dirname(DEBURR) + ":" + os.environ["PATH"])
            for command in commands:
                done = subprocess.run(["bash", "-c", command], cwd=directory, env=path, text=True,
                                      capture_output=True, timeout=300)
                self.assertEqual(done.returncode, 0, command + done.stdout + done.stderr)
                said = command.split("#")[1].strip()
                for part in said.split("; "):
                    self.assertIn(part, done.stdout, command)
            pages = re.findall(r"Open `([^`]*index.html)`", text)
            self.assertEqual(len(pages), 1)
            page = os.path.join(directory, pages[0])
            self.assertTrue(os.path.exists(page))
            self.assertTrue(WRITE or os.path.exists(os.path.join(ROOT, PICTURE)))
            self.assertIn("(../images/" + os.path.basename(PICTURE) + ")", text)
            if not BROWSER:
                return
            dom = re.sub("(?s)<noscript>.*?</noscript>", "", browse(page, "--dump-dom"))
            across = re.search(r'<select id="across">(.*?)</select>', dom, re.S).group(1)
            for metric in ("cycles", "rate", "memory_bits"):
                self.assertIn(metric, across)
            fronts = re.search(r'<span id="fronts">Fronts: (.*?) points\.</span>', dom)[1]
            sizes = dict(re.findall(r"memory\.latency = (\d+): (\d+)", fronts))
            self.assertEqual((sorted(sizes), sum(map(int, sizes.values()))), (["200", "50"], 13))
            self.assertEqual(len(re.findall(r"<tr[^>]*>\s*<td", dom)), 32)
            shot = os.path.join(ROOT if WRITE else directory, PICTURE if WRITE else "page.png")
            browse(page, f"--screenshot={shot}")
            self.assertGreater(os.path.getsize(shot), 20_000)


if __name__ == "__main__":
    WRITE = "--write" in sys.argv
    sys.argv = [argument for argument in sys.argv if argument != "--write"]
    if len(sys.argv) < 3 or sys.argv[1] in ("-h", "--help"):
        print(__doc__)
        sys.exit(0 if len(sys.argv) > 1 and sys.argv[1] in ("-h", "--help") else 2)
    DEBURR, ROOT = os.path.abspath(sys.argv.pop(1)), os.path.abspath(sys.argv.pop(1))
    unittest.main()
