# SPDX-License-Identifier: MIT
"""Sources of figures: runs of the command, the tables of `deburr papers`, other programs."""
import json
import os
import pathlib
import shlex
import struct
import subprocess
import sys
import tempfile
import zlib

RECIPES = {}


class Problem(Exception):
    """A figure that cannot be obtained; the text is the reason."""


def recipe(name):
    """The decorated function yields the rows of a table, each as a list of cells."""
    def add(function):
        RECIPES[name] = function
        return function
    return add


# ---- format of figures --------------------------------------------------------------------------


def spaced(number):
    return f"{number:,}".replace(",", " ")


# ---- pictures -----------------------------------------------------------------------------------


def write_png(path, width, height, grey):
    """A picture whose pixel (x, y) is grey(x, y)."""
    def chunk(kind, data):
        return (struct.pack(">I", len(data)) + kind + data
                + struct.pack(">I", zlib.crc32(kind + data)))
    rows = b"".join(b"\0" + bytes(grey(x, y) for x in range(width)) for y in range(height))
    path.write_bytes(b"\x89PNG\r\n\x1a\n"
                     + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 0, 0, 0, 0))
                     + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


# ---- programs -----------------------------------------------------------------------------------


class Sources:
    """Runs each command once, however many tables need it."""

    def __init__(self, root, build):
        self.root, self.build = root, build
        self.data = pathlib.Path(os.environ.get("DEBURR_DATA", root / "../shared/data"))
        if not self.data.is_dir():
            self.data = None
        self._scratch = tempfile.TemporaryDirectory(prefix="deburr_report_")
        self.scratch = pathlib.Path(self._scratch.name)
        self._known = {}

    def _once(self, key, make):
        if key not in self._known:
            print(f"  {key}", file=sys.stderr, flush=True)
            self._known[key] = make()
        return self._known[key]

    def _call(self, shown, words, environment=None):
        program = pathlib.Path(words[0])
        if not program.exists():
            raise Problem(f"{program} is missing: build it")
        done = subprocess.run([str(word) for word in words], capture_output=True, text=True,
                              check=False, cwd=self.scratch,
                              env={**os.environ, **(environment or {})})
        if done.returncode != 0:
            raise Problem(f"{shown}\nended with {done.returncode}:\n{done.stdout}{done.stderr}")
        return done.stdout

    def run(self, line):
        """result.json of `deburr run LINE`; FILE in the line is a file of self.scratch."""
        def make():
            out = self.scratch / "run"
            self._call(f"deburr run {line}",
                       [self.build / "deburr", "run", *shlex.split(line), "--set",
                        "run.images=false", "--quiet", "--out", out])
            return json.loads((out / "result.json").read_text(encoding="utf-8"))
        return self._once(f"deburr run {line}", make)

    def front(self, name):
        """Points on the front of a ready sweep: dictionaries of axes and metrics, by gates."""
        def make():
            for action in ("run", "collect"):
                self._call(f"deburr sweep {name} {action}",
                           [self.build / "deburr", "sweep", self.root / f"sweeps/{name}.yaml", action, "--quiet"])
            file = self.scratch / f"out/sweeps/{name}/collected.json"
            return json.loads(file.read_text(encoding="utf-8"))
        found = self._once(f"deburr sweep {name}", make)
        names = [column["name"] for column in found["axes"] + found["metrics"]]
        points = [dict(zip(names, point["at"] + point["values"])) for point in found["points"] if point.get("front")]
        return sorted(points, key=lambda point: point["gates"])

    def papers(self, number):
        """The tables of a paper, by their titles."""
        def make():
            out = self.scratch / f"papers_{number}"
            self._call(f"deburr papers {number}",
                       [self.build / "deburr", "papers", number, "--quiet", "--out", out],
                       {"DEBURR_DATA": str(self.data)} if self.data else {})
            papers = json.loads((out / "papers.json").read_text(encoding="utf-8"))["papers"]
            return {table["title"]: table["rows"] for table in papers[0]["tables"]}
        return self._once(f"deburr papers {number}", make)

    def paper_table(self, number, title):
        """The table of a paper whose title begins with this text."""
        found = [rows for name, rows in self.papers(number).items() if name.startswith(title)]
        if len(found) != 1:
            raise Problem(f"{len(found)} tables of paper {number} begin with {title!r}")
        return found[0]

    def program(self, program, *words):
        """Output of a program below tb/ of the build."""
        def make():
            return self._call(" ".join([program, *words]), [self.build / "tb" / program, *words])
        return self._once(" ".join([program, *words]), make)

