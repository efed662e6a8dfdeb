#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Compares cycle counts with recorded ones.

Each baseline is a `deburr run` command line and the cycles that it took. A run that is more than 2 %
slower fails; one that is more than 2 % faster fails too until it is recorded, so that the record stays
worth comparing with. Only --record writes.
"""
import argparse
import json
import pathlib
import subprocess
import sys
import tempfile

TOLERANCE = 0.02
FILE = pathlib.Path(__file__).with_name("cycles.json")


def cycles(program, arguments):
    """Cycles of one run; exits with the program's words if it does not pass."""
    with tempfile.TemporaryDirectory() as out:
        command = [program, "run", *arguments, "--out", out]
        run = subprocess.run(command, capture_output=True, text=True, check=False)
        if run.returncode != 0:
            sys.exit(f"{' '.join(command)}\nended with {run.returncode}:\n{run.stdout}{run.stderr}")
        result = json.loads((pathlib.Path(out) / "result.json").read_text(encoding="utf-8"))
        return result["cycles"]


def verdict(recorded, measured):
    """None if the two agree, else what is wrong."""
    change = measured / recorded - 1
    if abs(change) <= TOLERANCE:
        return None
    better = "faster: record it with --record" if change < 0 else "slower"
    return f"{measured} cycles against {recorded} recorded ({change:+.1%}): {better}"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program", help="the deburr command")
    parser.add_argument("--record", action="store_true", help="write the measured cycles")
    options = parser.parse_args()
    if verdict(100, 103) is None or verdict(100, 97) is None or verdict(100, 101):
        sys.exit("the comparison itself is broken")
    baselines = json.loads(FILE.read_text(encoding="utf-8"))
    failures = 0
    for baseline in baselines:
        measured = cycles(options.program, baseline["run"].split())
        problem = verdict(baseline["cycles"], measured) if baseline["cycles"] else "not recorded yet"
        if options.record:
            baseline["cycles"] = measured
        elif problem:
            failures += 1
        print(f"{baseline['run']}: {problem if problem and not options.record else measured}")
    if options.record:
        FILE.write_text(json.dumps(baselines, indent=2) + "\n", encoding="utf-8")
    sys.exit(1 if failures else 0)


if __name__ == "__main__":
    main()
