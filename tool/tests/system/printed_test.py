#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""The output that README, tutorial and how-tos show below a command is the command's current output. A line that ends
with ... may continue, a line with only ... stands for several lines. Sweeps run where the page prints their file.

usage: printed_test.py DEBURR ROOT [unittest options]"""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

DEBURR, ROOT = (pathlib.Path(sys.argv.pop(1)).resolve() for _ in range(2))
sys.dont_write_bytecode = True
sys.path.insert(0, str(ROOT / "scripts"))
from reports.sources import write_png  # noqa: E402

PAGES = {"../README": 1, "tutorial/first_run": 3, "howto/which_engine": 2, "howto/smooth_my_frames": 2,
         "howto/explore_a_design": 4, "howto/read_a_report": 2}
BLOCK = re.compile(r"^```(\w*)\n(.*?)^```", re.S | re.M)
FILE = re.compile(r"`(\w+\.(?:yaml|obj))`")


def parts_of(text):
    """("file", name, text) and ("run", commands, printed lines), in order."""
    commands, end = [], 0
    for block in BLOCK.finditer(text):
        before, (language, inside), end = text[end:block.start()], block.groups(), block.end()
        lines = inside.replace("\\\n", " ").splitlines()
        called = [line for line in lines if re.match("deburr [a-z]", line)]
        printed = [line for line in lines if line not in called]
        name = FILE.search(before.strip().split("\n\n")[-1] if before.strip() else "")
        if name and not called:
            yield "file", name[1], inside
            commands = []
        elif language == "" and called:
            if printed:
                yield "run", called, printed
            commands = [] if printed else called
        elif language == "" and commands:
            yield "run", commands, printed
            commands = []
        else:
            commands = []


def not_printed(lines, said):
    """Lines of a page that match no line of the output, or its beginning."""
    squeezed = [" ".join(line.split()) for line in said.splitlines()]
    for line in lines:
        wanted = " ".join(line.split())
        start = wanted.removesuffix("...").strip()
        if wanted.endswith("...") and any(line.startswith(start) for line in squeezed) or wanted in squeezed:
            continue
        yield line


class Printed(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="deburr_printed_")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.call("deburr run morphological --scene cylinders --size 256x256 --out out/one")
        shutil.copy(self.folder / "out/one/before.png", self.folder / "frame.png")
        shutil.copy(self.folder / "out/one/reference.png", self.folder / "reference.png")
        write_png(self.folder / "mask.png", 256, 256, lambda x, y: 255 if x < 128 else 0)
        mesh = [part for part in parts_of((ROOT / "docs/tutorial/first_run.md").read_text(encoding="utf-8"))
                if part[1] == "roof.obj"]
        (self.folder / "roof.obj").write_text(mesh[0][2], encoding="utf-8")

    def call(self, command):
        path = f"{DEBURR.parent}:{os.environ['PATH']}"
        done = subprocess.run(["bash", "-c", command], cwd=self.folder, env={**os.environ, "PATH": path}, text=True,
                              capture_output=True, timeout=600, check=False)
        return done.stdout + done.stderr

    def test_pages_show_current_output(self):
        for page, least in PAGES.items():
            held = 0
            for kind, what, lines in parts_of((ROOT / f"docs/{page}.md").read_text(encoding="utf-8")):
                if kind == "file":
                    (self.folder / what).write_text(lines, encoding="utf-8")
                    continue
                files = re.findall(r"deburr sweep (\S+)", " ".join(what))
                if not all((self.folder / file).exists() for file in files):
                    continue  # the first sweep, which has its own test
                said = "".join(self.call(command) for command in what)
                with self.subTest(page=page, commands=what):
                    self.assertEqual(list(not_printed(lines, said)), [], said)
                held += 1
            with self.subTest(page=page):
                self.assertGreaterEqual(held, least)

    def test_wrong_lines_are_found(self):
        said = "rate   7 of 8\nRESULT: PASS\n"
        self.assertEqual(list(not_printed(["rate 7 ...", "...", "RESULT: PASS"], said)), [])
        self.assertEqual(list(not_printed(["rate 6 ...", "RESULT: PAS", "7 ..."], said)),
                         ["rate 6 ...", "RESULT: PAS", "7 ..."])
        self.assertEqual(list(parts_of("As `a.obj`:\n\n```\nv 1\n```\n\n```\ndeburr a\n```\n\n```\nb\n```\n\n```\ndeburr c\nd\n```\n")),
                         [("file", "a.obj", "v 1\n"), ("run", ["deburr a"], ["b"]), ("run", ["deburr c"], ["d"])])


if __name__ == "__main__":
    unittest.main()
