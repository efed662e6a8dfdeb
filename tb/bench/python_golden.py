#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Compares the instructions for a frame of 1920 x 1080 in Python and in C++. The Python call constructs a model and
returns an array; the C++ program reuses one model. Fails if Python needs 5 % more.

usage: python_golden.py PYTHON_FRAMES MODULES [PRESET...]      PYTHON_FRAMES: path of that program"""
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

LIMIT = 1.05
WIDTH, HEIGHT = 1920, 1080
FRAMES = (1, 3)  # their difference cancels start-up
PROGRAM = """
import sys
sys.path.insert(0, sys.argv[1])
import numpy
import deburr
pixels = numpy.fromfile(sys.argv[2], dtype=numpy.uint8).reshape({height}, {width}, 4)
for _ in range(int(sys.argv[4])):
    frame = deburr.golden.morphological(pixels, preset=sys.argv[3])
    result = frame.pixels
print(frame.work.blended_pixels)
"""


def drawn():
    """Discs and slanted bars of many colours: about a tenth of the pixels are edges."""
    import numpy
    random = numpy.random.default_rng(5)
    y, x = numpy.mgrid[0:HEIGHT, 0:WIDTH]
    frame = numpy.full((HEIGHT, WIDTH, 4), 255, dtype=numpy.uint8)
    for _ in range(160):
        cx, cy, r = random.integers(0, WIDTH), random.integers(0, HEIGHT), random.integers(8, 60)
        frame[(x - cx) ** 2 + (y - cy) ** 2 < r * r, :3] = random.integers(0, 256, 3)
    for _ in range(40):
        a, b = random.uniform(-1, 1, 2)
        bar = abs(a * (x - random.integers(0, WIDTH)) + b * (y - random.integers(0, HEIGHT))) < 3
        frame[bar, :3] = random.integers(0, 256, 3)
    return frame


def instructions(folder, *command):
    """Instructions and output of a command."""
    out = folder / "callgrind.out"
    done = subprocess.run(["valgrind", "--tool=callgrind", f"--callgrind-out-file={out}", *command], text=True,
                          capture_output=True, check=False, env={"PATH": "/usr/bin:/bin", "PYTHONHASHSEED": "0",
                                                                 "PYTHONDONTWRITEBYTECODE": "1"})
    if done.returncode != 0:
        sys.exit(done.stdout + done.stderr)
    return int(re.search(r"^(?:summary|totals): (\d+)", out.read_text(encoding="utf-8"), re.M)[1]), done.stdout


def a_frame(folder, command):
    few, _ = instructions(folder, *command, str(FRAMES[0]))
    many, said = instructions(folder, *command, str(FRAMES[1]))
    return (many - few) / (FRAMES[1] - FRAMES[0]), said


def main():
    program, modules, presets = sys.argv[1], sys.argv[2], sys.argv[3:] or ["mlaa", "smaa", "deburr"]
    if not shutil.which("valgrind"):
        print("skipped: valgrind is not installed (scripts/install perf)")
        sys.exit(77)
    slow = []
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        drawn().tofile(folder / "frame.rgba")
        script = folder / "frames.py"
        script.write_text(PROGRAM.format(width=WIDTH, height=HEIGHT), encoding="utf-8")
        print("preset         C++    Python    ratio   (million instructions per frame)")
        for preset in presets:
            there, said = a_frame(folder, [program, folder / "frame.rgba", str(WIDTH), str(HEIGHT), preset])
            here, also = a_frame(folder, ["/usr/bin/python3", script, modules, folder / "frame.rgba", preset])
            if said != also:
                sys.exit(f"{preset}: not the same work: {said.strip()}, {also.strip()}")
            print(f"{preset:10} {there / 1e6:7.1f}   {here / 1e6:7.1f}   {here / there:6.3f}", flush=True)
            if here > LIMIT * there:
                slow.append(preset)
    sys.exit(f"more than {LIMIT} of C++: {', '.join(slow)}" if slow else 0)


if __name__ == "__main__":
    main()
