#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Compares the cycles of a dense frame quoted by docs/reference/geometric/hardware.md with those that the benchmark counts.

usage: geometric_cycles_test.py BENCH"""
import pathlib
import re
import subprocess
import sys
import unittest

BENCH = "geometric_rtl_bench"
BEGIN = 540  # cycles that read one word of touched bits each
PAGE = pathlib.Path(__file__).resolve().parent.parent.parent / "docs/reference/geometric/hardware.md"


def bench(*arguments):
    return subprocess.run([BENCH, *arguments], text=True, capture_output=True, check=True).stdout


def frame(*arguments):
    """Cycles of the edges and of the resolve, the counters, and lines of memory of both phases."""
    text = bench("--frames", "1", *arguments)
    edges, resolve = map(int, re.search(r"edges (\d+), resolve (\d+)", text).groups())
    lines = tuple(map(int, re.search(r"memory lines per frame: edges (\d+), resolve (\d+)", text).groups()))
    return edges, resolve, {name: int(value) for name, value in re.findall(r"([A-Z_]+) (\d+)", text)}, lines


def said(text):
    """A number with blanks as thousands separators."""
    return f"{int(text):,}".replace(",", " ")


class Cycles(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.page = re.sub(r"\s+", " ", PAGE.read_text(encoding="utf-8"))

    def assert_said(self, text):
        self.assertIn(text, self.page)

    def test_dense_frames(self):
        """Separate and stacked rings, fast and slow memory, compared with the minimum cycles of the memory port."""
        for passes, name in (("1", "apart"), ("3", "stacked")):
            for coverage in ("distance", "area"):
                for latency in ("20", "100"):
                    edges, resolve, work, lines = frame("deburr", "4", "2", "tiled", passes, latency,
                                                        f"coverage={coverage}")
                    self.assertEqual(work["EDGES"], 33000)
                    self.assertEqual(work["KEPT_EDGES"], 6600)
                    bound = BEGIN + sum(lines)
                    self.assert_said(f"| {name} | {coverage} | {latency} | {said(work['BLENDED_PIXELS'])} | "
                                     f"{said(work['COLUMNS'])} | {said(work['GROUPS'])} | {said(work['BLOCKS'])} | "
                                     f"{said(edges)} | {said(resolve)} | **{said(edges + resolve)}** | {said(bound)} |")
                    self.assertGreater(edges + resolve, bound)
                    if passes == "1":
                        self.assertGreaterEqual(work["BLENDED_PIXELS"], 22000)
                        self.assertLess(edges + resolve, 1.05 * bound)

    def test_less_traffic(self):
        """The same with build parameters that save memory lines. With the larger cache the frame is close to the
        minimum of the port, also with slow memory."""
        larger = "records=split colour_lines=128 weight_blocks=256"
        for passes, name in (("1", "apart"), ("3", "stacked")):
            for latency in ("20", "100"):
                for choices in ("colour_lines=128", "records=split", "write_buffer=128",
                                "records=split colour_lines=128 write_buffer=128", larger):
                    edges, resolve, work, lines = frame("deburr", "4", "2", "tiled", passes, latency,
                                                        f"coverage=area {choices}")
                    shown = ", ".join(choice.replace("=", " = ") for choice in choices.split())
                    self.assert_said(f"| {name} | {shown} | {latency} | {said(edges)} | {said(resolve)} | "
                                     f"**{said(edges + resolve)}** | {said(BEGIN + sum(lines))} |")
                    self.assertGreater(edges + resolve, BEGIN + sum(lines))
                    if passes == "1":
                        self.assertGreaterEqual(work["BLENDED_PIXELS"], 22000)
                        if choices == larger:
                            self.assertLess(edges + resolve, min(50000, 1.05 * (BEGIN + sum(lines))))

    def test_sizes(self):
        for parameter in ("fills", "resolve_lines"):
            cycles = sum(frame("deburr", "4", "2", "tiled", "1", "100", f"coverage=distance {parameter}=64")[:2])
            self.assert_said(f"{said(cycles)}{' cycles' if parameter == 'fills' else ''} with `{parameter}` = 64")

    def test_fewer_lanes_and_rows(self):
        one_lane = sum(frame("deburr", "4", "1", "tiled", "3", "20", "coverage=distance")[:2])
        rows = sum(frame("deburr", "4", "2", "raster", "3", "20", "coverage=distance")[:2])
        self.assert_said(f"{said(one_lane)} with edge_lanes = 1, {said(rows)} in `raster`")


if __name__ == "__main__":
    if len(sys.argv) < 2 or sys.argv[1] in ("-h", "--help"):
        print(__doc__)
        sys.exit(0 if len(sys.argv) == 2 else 2)
    BENCH = sys.argv.pop(1)
    unittest.main()
