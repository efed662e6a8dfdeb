#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Compares runs with recorded ones, count by count: clocks, every unit's busy, stalled (by cause) and
idle clocks, latencies, traffic, work, and how full FIFOs were. A model gives the same counts on every
machine, so any difference fails, a better one too until it is recorded.

  tb/baselines/check.py build/release/deburr            every baseline
  tb/baselines/check.py build/release/deburr --record   writes those that pass as the record

A baseline is a `deburr run` command line; @PATTERN-NUMBER-WIDTHxHEIGHT in it is a picture of
write_frame, which is built beside this script's test."""
import argparse
import json
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile

FILE = pathlib.Path(__file__).with_name("baselines.json")
FRAME = re.compile(r"@(\w+)-(\d+)-(\d+)x(\d+)")
SHOWN = 12  # differences of a run


RUNS = [
    # Anisotropic; a cache that stays warm; one that never is, far from memory; trilinear in between.
    # By the paper's rules and by the project's own, and with directions measured in turn.
    *(f"texture --scene {scene} --preset {preset}"
      for preset in ("paper", "deburr")
      for scene in ("plane --size 256x256", "quad --size 256x256",
                    "tunnel --size 256x256 --set texture.cache.bytes=4096 --set memory.latency=200",
                    "tunnel --size 256x256")),
    "texture --scene quad --size 256x256 --set texture.axes=eight --set texture.axis_clocks=4"
    " --set texture.kernel=tent --set texture.srgb_output=encoded --format srgb8_a8",
    # A fifth and half of all pixels on edges, and the worst pattern.
    *(f"morphological --in @{frame}-256x144 --preset {preset} --lanes {lanes}"
      for frame in ("random_edges-200", "random_edges-500", "diagonals-2")
      for preset in ("deburr", "deburr-line", "mlaa") for lanes in (1, 4)),
    "morphological --in @random_edges-200-256x144 --preset smaa",
    "morphological --in @random_edges-500-256x144 --preset smaa-dynamic",
    "morphological --in @diagonals-2-256x144 --preset smaa --set morphological.quality=ultra --lanes 4",
    # Records in every column, all of them extended.
    "morphological --in @diagonals-2-256x144 --preset deburr-line --set morphological.ends=crossings"
    " --set morphological.area=table_minimal --set morphological.round_corners=true",
    # Learned shares of records in every column; long runs; a mask that is nowhere.
    "morphological --in @diagonals-2-256x144 --set morphological.ends=crossings",
    "morphological --in @random_edges-200-256x144 --set morphological.reach_columns=6"
    " --set morphological.window_rows=22",
    "morphological --in @random_edges-500-256x144 --set morphological.leave=masked",
    *(f"morphological {given}{preset}"
      for given in ("--in @random_edges-10-256x144", "--in @random_edges-500-256x144 --storage memory",
                    "--size 256x256")
      for preset in (" --preset deburr-line", "")),
    # Presets; rows instead of tiles with a walker; more lines than caches hold, far from memory.
    *(f"geometric --scene wheelcover --size 256x192 --preset {preset}"
      for preset in ("gpaa", "gpaa-optimised", "deburr")),
    "geometric --scene wing --size 256x192 --layout raster --walkers 1",
    "geometric --scene terrain --size 256x192 --set geometric.pipelined=false --set memory.latency=200"
    " --set geometric.depth_lines=16 --set geometric.weight_blocks=16 --set geometric.vertex_lines=16",
    "frame --scene object --size 128x128 --preset deburr-line",
    "frame --scene object --size 128x128",
]


def flat(value, prefix=""):
    """Every number and word of a tree, by its path."""
    if isinstance(value, dict):
        return {path: leaf for key, inner in value.items()
                for path, leaf in flat(inner, f"{prefix}{key}.").items()}
    return {prefix[:-1]: value}


def counts(result):
    """What of a result is the same on every machine and says how a run went."""
    latency = {key: value for key, value in result.get("latency", {}).items() if key != "histogram"}
    parts = {key: result[key] for key in ("cycles", "throughput", "memory", "units", "work")
             if key in result}
    full = {name: memory["high_water"] for name, memory in result.get("memories", {}).items()
            if "high_water" in memory}
    texts = {"unit", "bound_meaning", "bound_key"}
    return {path: value for path, value in flat({**parts, "latency": latency, "fifos": full}).items()
            if path.split(".")[-1] not in texts}


def command_line(run, folder, program):
    """The words of a run; its pictures are written to `folder`."""
    def picture(match):
        file = pathlib.Path(folder) / (match[0][1:] + ".png")
        writer = program.parent / "tb/baselines/write_frame"
        subprocess.run([writer, *match.groups(), file], check=True)
        return shlex.quote(str(file))
    return shlex.split(FRAME.sub(picture, run))


def measure(program, run):
    """The counts of one run; exits with the program's words if it does not pass."""
    with tempfile.TemporaryDirectory(prefix="deburr_baseline_") as folder:
        out = pathlib.Path(folder) / "out"
        command = [program, "run", *command_line(run, folder, program), "--out", out]
        done = subprocess.run([str(word) for word in command], capture_output=True, text=True,
                              check=False)
        if done.returncode != 0:
            sys.exit(f"{run}\nended with {done.returncode}:\n{done.stdout}{done.stderr}")
        return counts(json.loads((out / "result.json").read_text(encoding="utf-8")))


def differences(recorded, measured):
    """Yields what differs between the counts of two runs."""
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


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=pathlib.Path, help="the deburr command")
    parser.add_argument("--record", action="store_true", help="write what is measured")
    options = parser.parse_args()
    if not comparison_works():
        sys.exit("the comparison itself is broken")
    program = options.program.resolve()
    recorded = json.loads(FILE.read_text(encoding="utf-8")) if FILE.exists() else {}
    measured, failures = {}, 0
    for run in RUNS:
        measured[run] = measure(program, run)
        found = list(differences(recorded.get(run, {}), measured[run]))
        print(f"{measured[run]['cycles']:>9} cycles, {len(found)} differences: {run}", flush=True)
        if found and not options.record:
            failures += 1
            for line in found[:SHOWN]:
                print(f"            {line}")
            if len(found) > SHOWN:
                print(f"            and {len(found) - SHOWN} more")
    for run in recorded.keys() - set(RUNS):
        failures += not options.record
        print(f"recorded, but not a baseline any more: {run}")
    if options.record:
        FILE.write_text(json.dumps(measured, indent=1) + "\n", encoding="utf-8")
    elif failures:
        print(f"{failures} of {len(RUNS)} runs differ. If that is meant, an improvement too, record it: "
              f"tb/baselines/check.py {options.program} --record")
    sys.exit(1 if failures else 0)


if __name__ == "__main__":
    main()
