#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""The clocks that docs/geometric_hardware.md quotes of a dense frame, against those that the bench counts.

usage: geometric_clocks_test.py BENCH"""
import pathlib
import re
import subprocess
import sys
import unittest

BENCH = "geometric_rtl_bench"
PAGE = pathlib.Path(__file__).resolve().parent.parent.parent / "docs/geometric_hardware.md"


def bench(*arguments):
    return subprocess.run([BENCH, *arguments], text=True, capture_output=True, check=True).stdout


def frame(*arguments):
    """Clocks of the edges and of the resolve, and the counters."""
    text = bench("--frames", "1", *arguments)
    edges, resolve = map(int, re.search(r"edges (\d+), resolve (\d+)", text).groups())
    return edges, resolve, {name: int(value) for name, value in re.findall(r"([A-Z_]+) (\d+)", text)}


def said(text):
    """A number with blanks between its thousands."""
    return f"{int(text):,}".replace(",", " ")


class Clocks(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.page = re.sub(r"\s+", " ", PAGE.read_text(encoding="utf-8"))

    def assert_said(self, text):
        self.assertIn(text, self.page)

    def test_a_dense_frame(self):
        edges, resolve, work = frame("deburr", "4", "2", "tiled", "3")
        self.assertEqual(work["EDGES"], 33000)
        self.assertEqual(work["KEPT_EDGES"], 6600)
        self.assert_said(f"{said(work['COLUMNS'])} columns, {said(work['GROUPS'])} groups, {said(work['BLOCKS'])} blocks")
        self.assert_said(f"takes {said(edges)} clocks for the edges and {said(resolve)} for the resolve, "
                         f"**{said(edges + resolve)}** in all")
        self.assertLess(edges + resolve, 36000)
        one_lane = sum(frame("deburr", "4", "1", "tiled", "3")[:2])
        rows = sum(frame("deburr", "4", "2", "raster", "3")[:2])
        self.assert_said(f"{said(one_lane)} with edge_lanes = 1, {said(rows)} in `raster`")

    def test_rings_beside_each_other(self):
        edges, resolve, work = frame("deburr", "4", "2", "tiled", "1")
        self.assert_said(f"touch {said(work['BLOCKS'])} blocks with {said(work['COLUMNS'])} columns")
        self.assert_said(f"{said(edges)} and {said(resolve)} clocks, the port busy in 99 % of them")

    def test_dividers(self):
        rows = [line.split() for line in bench("--dividers").splitlines()[1:]]
        alone = [row[1] for row in rows[:5]]
        self.assert_said(f"edge_lanes = 4: {', '.join(map(said, alone))} clocks of the edges with 1..5 dividers, "
                         f"{said(rows[-1][1])} pipelined, and {said(rows[0][2])} with one divider and the table")


if __name__ == "__main__":
    if len(sys.argv) < 2 or sys.argv[1] in ("-h", "--help"):
        print(__doc__)
        sys.exit(0 if len(sys.argv) == 2 else 2)
    BENCH = sys.argv.pop(1)
    unittest.main()
