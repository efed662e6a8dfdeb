#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Compares the counts of runs with recorded ones: cycles; busy, stalled (by cause) and idle cycles of every unit;
latencies, memory traffic, work, and high-water marks of FIFOs. A model gives the same counts on every machine, so
any difference fails; an improvement must be recorded.

  tb/baselines/check.py build/release/deburr            checks all baselines of all engines
  tb/baselines/check.py build/release/deburr --record   records the runs that pass

Each engine has its baselines in tb/engines/NAME: baselines.txt has one `deburr run NAME` command per line,
baselines.json the recorded counts. @PATTERN-NUMBER-WIDTHxHEIGHT in a command is an image made by write_frame, which
is built with this script's test."""
import argparse
import json
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]  # files in commands are relative to it
ENGINES = ROOT / "tb/engines"
FRAME = re.compile(r"@(\w+)-(\d+)-(\d+)x(\d+)")
SHOWN = 12  # differences shown per run


def runs_of(folder):
    """The runs listed in an engine's folder, which is named after the engine."""
    lines = (folder / "baselines.txt").read_text(encoding="utf-8").splitlines()
    return [f"{folder.name} {line}" for line in lines if line and not line.startswith("#")]


def flat(value, prefix=""):
    """Every number and word of a tree, by path."""
    if isinstance(value, dict):
        return {path: leaf for key, inner in value.items()
                for path, leaf in flat(inner, f"{prefix}{key}.").items()}
    return {prefix[:-1]: value}


def counts(result):
    """The counts of a result that are equal on every machine."""
    latency = {key: value for key, value in result.get("latency", {}).items() if key != "histogram"}
    parts = {key: result[key] for key in ("cycles", "throughput", "memory", "units", "work")
             if key in result}
    full = {name: memory["high_water"] for name, memory in result.get("memories", {}).items()
            if "high_water" in memory}
    texts = {"unit", "bound_meaning", "bound_key"}
    return {path: value for path, value in flat({**parts, "latency": latency, "fifos": full}).items()
            if path.split(".")[-1] not in texts}


def command_line(run, folder, program):
    """The arguments of a run; its pictures are written to `folder`."""
    def picture(match):
        file = pathlib.Path(folder) / (match[0][1:] + ".png")
        writer = program.parent / "tb/baselines/write_frame"
        subprocess.run([writer, *match.groups(), file], check=True)
        return shlex.quote(str(file))
    return shlex.split(FRAME.sub(picture, run))


def measure(program, run):
    """The counts of one run; exits with the program's output if the run does not pass."""
    with tempfile.TemporaryDirectory(prefix="deburr_baseline_") as folder:
        out = pathlib.Path(folder) / "out"
        command = [program, "run", *command_line(run, folder, program), "--out", out]
        done = subprocess.run([str(word) for word in command], capture_output=True, text=True,
                              check=False, cwd=ROOT)
        if done.returncode != 0:
            sys.exit(f"{run}\nended with {done.returncode}:\n{done.stdout}{done.stderr}")
        return counts(json.loads((out / "result.json").read_text(encoding="utf-8")))


def differences(recorded, measured):
    """Yields the differences between the counts of two runs."""
    for path in sorted(recorded.keys() | measured.keys()):
        before, now = recorded.get(path, "absent"), measured.get(path, "absent")
        if before != now:
            yield f"{path}: {now}, recorded {before}"


def comparison_works():
    one = {"cycles": 100, "units": {"a": {"busy": 7, "stalls": {"b": 1}}}}
    other = {"cycles": 100, "units": {"a": {"busy": 7, "stalls": {"b": 2}}}}
    return (not list(differences(counts(one), counts(one)))
            and len(list(differences(counts(one), counts(other)))) == 1
            and len(list(differences(counts(one), counts({"cycles": 101})))) == 3)


def engine_folders():
    lines = (ENGINES / "engines.txt").read_text(encoding="utf-8").split("\n")
    return [ENGINES / line for line in lines if line and not line.startswith("#")]


def check(program, folder, record):
    """Runs a folder's baselines; returns their number and how many differ."""
    file = folder / "baselines.json"
    recorded = json.loads(file.read_text(encoding="utf-8")) if file.exists() else {}
    runs = runs_of(folder)
    measured, failures = {}, 0
    for run in runs:
        measured[run] = measure(program, run)
        found = list(differences(recorded.get(run, {}), measured[run]))
        print(f"{measured[run]['cycles']:>9} cycles, {len(found)} differences: {run}", flush=True)
        if found and not record:
            failures += 1
            for line in found[:SHOWN]:
                print(f"            {line}")
            if len(found) > SHOWN:
                print(f"            and {len(found) - SHOWN} more")
    for run in recorded.keys() - set(runs):
        failures += not record
        print(f"recorded, but not a baseline any more: {run}")
    if record:
        lines = [f"{json.dumps(run)}: {json.dumps(counted, separators=(',', ':'))}"
                 for run, counted in measured.items()]
        file.write_text("{\n" + ",\n".join(lines) + "\n}\n", encoding="utf-8")
    return len(runs), failures


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=pathlib.Path, help="the deburr command")
    parser.add_argument("folders", type=pathlib.Path, nargs="*", metavar="FOLDER",
                        help="only these folders of engines (all of tb/engines/engines.txt)")
    parser.add_argument("--record", action="store_true", help="record the measured counts")
    options = parser.parse_args()
    if not comparison_works():
        sys.exit("the comparison missed an injected difference")
    counted = [check(options.program.resolve(), folder.resolve(), options.record)
               for folder in options.folders or engine_folders()]
    runs, failures = (sum(column) for column in zip(*counted))
    if failures:
        print(f"{failures} of {runs} runs differ. Record intended changes and improvements: "
              f"tb/baselines/check.py {options.program} --record")
    sys.exit(0 if runs and not failures else 1)


if __name__ == "__main__":
    main()
