#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""The reference pages of docs match the program's output, and docs/reference/command_line.md names every option of a
run.

usage: pages_test.py DEBURR SOURCE [--write]     --write updates the pages"""
import difflib
import pathlib
import re
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[3] / "tb/engines"))
from engine_list import engines  # noqa: E402


def options_left_out(deburr, source):
    """Options of `deburr run` that docs/reference/command_line.md does not name."""
    with open(f"{source}/docs/reference/command_line.md") as file:
        named = set(re.findall(r"--[a-z][a-z-]+", file.read()))
    options = set()
    for engine in engines():
        text = subprocess.run([deburr, "run", engine, "--help"], check=True, capture_output=True, text=True).stdout
        options |= set(re.findall(r"^  (--[a-z-]+)", text, re.MULTILINE))
    return sorted(options - named) if options else ["every option: the help lists none"]


def main():
    if "--help" in sys.argv or "-h" in sys.argv or len(sys.argv) < 3:
        print(__doc__)
        return 0 if len(sys.argv) >= 2 else 2
    deburr, source = sys.argv[1:3]
    stale = 0
    for page in ("parameters", "statistics", "registers", "coverage", "datasheets"):
        done = subprocess.run([deburr, "params", "--markdown", page], check=True,
                              capture_output=True, text=True)
        printed = done.stdout
        # Messages of a library on the same stream would become part of the page.
        if not printed.startswith(f"# {page.capitalize()}\n\n") or done.stderr:
            print(f"{page}: something else than the page was printed:\n{printed[:400]}{done.stderr}")
            return 1
        path = next(pathlib.Path(source, "docs").rglob(f"{page}.md"))
        if "--write" in sys.argv:
            with open(path, "w") as file:
                file.write(printed)
            continue
        with open(path) as file:
            kept = file.read()
        if kept != printed:
            stale += 1
            sys.stdout.writelines(difflib.unified_diff(
                kept.splitlines(True), printed.splitlines(True), str(path),
                "deburr params --markdown " + page))
    if stale:
        print(f"Bring the pages up to date: {sys.argv[0]} {deburr} {source} --write")
    left_out = options_left_out(deburr, source)
    if left_out:
        print(f"docs/reference/command_line.md does not name {', '.join(left_out)}")
    return 1 if stale or left_out else 0


if __name__ == "__main__":
    sys.exit(main())
