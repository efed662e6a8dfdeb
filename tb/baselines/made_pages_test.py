#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Are pages of measurements what their commands make today? Compared without commit, version and seconds. Pages of one
call share their runs.

usage: made_pages_test.py SOURCE DEBURR PAGE... [--write]   (of docs/measurements/, without .md)"""
import argparse
import difflib
import pathlib
import re
import subprocess
import sys
import tempfile

# What a page says of its making, and is another each time.
OF_ITS_MAKING = ((re.compile(r"commit `[\w+-]+`"), "commit `-`"), (re.compile(r"^Version [^,]+,"), "Version -,"),
                 (re.compile(r"[\d ]+ s of simulation"), " - s of simulation"))


class Maker:
    """Makes pages anew, in a folder."""

    def __init__(self, root, deburr, folder):
        self.root, self.deburr, self.folder = root, deburr, pathlib.Path(folder)

    def _said(self, *command):
        done = subprocess.run([str(word) for word in command], cwd=self.root, capture_output=True, text=True, check=False)
        if done.returncode:
            sys.exit(f"{' '.join(map(str, command))}\nended with {done.returncode}:\n{done.stdout}{done.stderr}")
        return done.stdout

    def _run(self, *words):
        self._said(self.deburr, *words, "--quiet", "--out", self.folder)

    def _findings(self, name):
        for action in ("run", "collect"):
            self._run("sweep", f"sweeps/{name}.yaml", action)
        self._said("scripts/findings", self.folder / "sweeps" / name / "collected.json", "--out", self.folder)
        return (self.folder / f"{name}.md").read_text(encoding="utf-8")

    def _regression(self):
        self._run("regress", "tb/testplan/smoke.yaml", "run", "--seed", "1")
        page = self.folder / "regression.md"
        self._said("scripts/regression_report", self.folder / "regressions/smoke-1/collected.json", "--out", page)
        return page.read_text(encoding="utf-8")

    def page(self, name):
        if name == "search":
            return self._said("scripts/search_study", self.deburr, "sweeps/texture_design.yaml", "--out", self.folder)
        return self._regression() if name == "regression_report" else self._findings(name)


def compared(text):
    """The lines of a page that must be the same; a paragraph is one, since a commit moves its breaks."""
    for block in text.strip("\n").split("\n\n"):
        lines = block.split("\n")
        for line in lines if lines[0].startswith("|") else [" ".join(lines)]:
            for pattern, placeholder in OF_ITS_MAKING:
                line = pattern.sub(placeholder, line)
            yield line


def differences(page, made):
    return list(difflib.unified_diff(list(compared(page)), list(compared(made)), "page", "now", n=0, lineterm=""))


def missed_faults(made):
    """A changed figure of any row must be found, another commit and other breaks must not."""
    lines = made.split("\n")
    rows = [i for i, line in enumerate(lines) if line.startswith("|") and re.search(r"\| \d", line)]
    for i in rows:
        row = re.sub(r"\| (\d)", lambda found: f"| {(int(found[1]) + 1) % 10}", lines[i], count=1)
        if not differences("\n".join([*lines[:i], row, *lines[i + 1:]]), made):
            yield f"a changed figure is not found: {row}"
    if not rows or not differences("\n".join(lines[:rows[-1]]), made):
        yield "a missing row is not found"
    other = re.sub(r"(?<=commit `)\w{7}", "0123456", made).replace("; do not", ";\ndo not", 1)
    if other == made or differences(other, made):
        yield "another commit is taken for a difference"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("root", type=pathlib.Path)
    parser.add_argument("deburr", type=pathlib.Path)
    parser.add_argument("pages", nargs="+")
    parser.add_argument("--write", action="store_true", help="put the pages into the tree")
    options = parser.parse_args()
    root, wrong = options.root.resolve(), 0
    with tempfile.TemporaryDirectory() as folder:
        maker = Maker(root, options.deburr.resolve(), folder)
        for name in options.pages:
            file, made = root / "docs/measurements" / f"{name}.md", maker.page(name)
            if options.write:
                file.write_text(made, encoding="utf-8")
                continue
            found = differences(file.read_text(encoding="utf-8"), made)
            if found:
                found.append(f"{file.relative_to(root)} is not current; if that is meant: "
                             f"{' '.join(sys.argv)} --write")
            found += missed_faults(made)
            wrong += len(found)
            print("\n".join(found) or f"{name}: current")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
