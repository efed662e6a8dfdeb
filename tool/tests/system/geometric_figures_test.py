#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Figures, coverage and maps of `deburr run geometric`, compared with values found by hand or with other figures.

usage: geometric_figures_test.py DEBURR SOURCE"""
import math
import os
import sys
import tempfile
import unittest

import coverage_test
import figures_test
import observers_test
from coverage_test import SIZE, covered, declared, total


class Figures(figures_test.Figures):
    """A square facing the camera, 32 pixels per side: its lines are a quarter of a pixel inside columns 17 and 49 and
    rows 17 and 49, so each cuts 32 pixels, in blocks 4..12 of rows and columns 4 and 12, by 1/4."""
    MESH = """v -0.4609375 0.4609375 0\nv -0.4609375 -0.5390625 0\nv 0.5390625 -0.5390625 0\nv 0.5390625 0.4609375 0
f 1 2 3\nf 1 3 4\n"""
    # Two units high at the square; caches without conflicts.
    VIEW = ("--size", "64x64", "--set", "scene.eye=0,0,2", "--set", "scene.target=0,0,0", "--set",
            f"scene.fov={2 * math.atan(0.5)!r}", "--set", "memory.latency=1", "--set", "geometric.weight_blocks=256")
    DEPTHS = ("--set", "geometric.depth_lines=256")
    PIXELS, BLOCKS = 4 * 32 - 1, 4 * 9 - 4  # pixel (17, 17) is cut twice

    def square(self, *arguments, depths=DEPTHS, mesh=MESH):
        path = os.path.join(os.path.dirname(self.out), "square.obj")
        with open(path, "w") as file:
            file.write(mesh)
        return self.run_engine("geometric", "--in", path, *self.VIEW, *depths, *arguments)

    def test_figures_of_a_frame(self):
        r = self.square()
        work, cycles = r["work"], r["work"]["frame_cycles"]
        expected = {"edge_classifier_edges": 5, "edge_classifier_boundary_edges": 4, "edge_classifier_flat_edges": 1,
                    "edge_classifier_kept_edges": 4, "line_setup_lines": 4, "line_walker_columns": 128,
                    "coverage_unit_candidates": 128, "depth_test_passed": 128, "resolver_blocks": self.BLOCKS,
                    "resolver_blended_pixels": self.PIXELS, "line_setup_divider_cycles": 4 * 13}
        self.assertEqual({name: work[name] for name in expected}, expected)
        # From column 17 on in fours: 3, seven times 4, and 1; one lookup each, and one line of depth each.
        self.assertEqual(work["line_walker_groups"], 4 * 9)
        self.assertAlmostEqual(work["columns_per_cycle"], 32 / 9)
        self.assertEqual(work["vertex_hits_percent"], 75, "four vertices are one line")
        for name in ("depth_hits_percent", "weight_hits_percent"):
            self.assertAlmostEqual(work[name], 100 * (1 - self.BLOCKS / (4 * 9)))
        read = {"faces": 1, "edges": 2, "vertices": 1, "depth": self.BLOCKS, "weights": 0, "colour": self.BLOCKS,
                "copy": 0}
        written = {"weights": 0, "colour": self.BLOCKS, "copy": 0}
        self.assertEqual({name: work[f"lines_read_{name}"] for name in read}, read)
        self.assertEqual({name: work[f"lines_written_{name}"] for name in written}, written)
        lines, enabled = sum(read.values()), 4 * self.PIXELS
        self.assertEqual((r["memory"]["bytes_read"], r["memory"]["bytes_written"]), (64 * lines, enabled))
        self.assertAlmostEqual(work["bytes_per_blended_pixel"], (64 * lines + enabled) / self.PIXELS)
        self.assertAlmostEqual(work["frame_bytes_per_blended_pixel"], (64 * 2 * self.BLOCKS + enabled) / self.PIXELS)
        self.assertEqual(cycles, work["edge_cycles"] + work["resolve_cycles"])
        self.assertEqual(r["cycles"], cycles)
        self.assertAlmostEqual(work["divider_occupancy_percent"], 100 * 4 / work["edge_cycles"])
        self.assertAlmostEqual(work["port_occupancy_percent"], 100 * (lines + self.BLOCKS) / cycles)
        self.assertAlmostEqual(work["frame_rate"], 250e6 / cycles)
        self.assertAlmostEqual(work["clock_for_60_frames"], 60 * cycles / 1e6)
        # 256 tags are cleared; 36 groups; two lines of colours per block.
        bound = 256 + 36 + 2 * self.BLOCKS
        self.assertEqual(work["frame_cycles_bound"], bound)
        self.assertAlmostEqual(r["throughput"]["bound"], 5 / bound)
        self.assertAlmostEqual(r["throughput"]["value"], 5 / cycles)
        self.assertEqual(sum(b["count"] for b in r["latency"]["histogram"]), 4, "the lines")
        slower = 100 * (cycles - bound) / bound
        self.assert_tile("Frame", f"{cycles:,}", "clk", f"bound {bound}, {slower:+.1f} %; {cycles / 250e3:.2f} ms at 250 MHz")
        self.assert_tile("Clock for 60 frame/s", f"{60 * cycles / 1e6:.4g}", "MHz")
        self.assert_tile("Traffic per blended pixel", f"{work['bytes_per_blended_pixel']:.4g}", "byte/pixel")

    def test_walker_figures(self):
        for walkers, groups in ((1, 32), (2, 17), (4, 9)):
            work = self.square("--walkers", str(walkers))["work"]
            self.assertEqual(work["line_walker_groups"], 4 * groups)
            self.assertAlmostEqual(work["columns_per_cycle"], 32 / groups)

    def test_columns_without_a_candidate(self):
        """A quarter of a pixel further left, both vertical lines lie between two columns of pixels and cover none."""
        mesh = self.MESH.replace("v -0.4609375", "v -0.46875").replace("v 0.5390625", "v 0.53125")
        work = self.square(mesh=mesh)["work"]
        self.assertEqual((work["line_walker_columns"], work["coverage_unit_candidates"]), (128, 64))
        self.assertEqual(work["line_walker_groups"], 4 * 9)
        self.assertAlmostEqual(work["columns_per_cycle"], 32 / 9)

    def test_latency_of_the_first_line(self):
        """Two edges per cycle wait only for vertices and depth, one after the other: the sum of the units' latencies,
        one cycle per link, and twice a memory of one cycle."""
        r = self.square("--set", "geometric.select=all", "--walkers", "1", depths=("--set", "geometric.depth_test=off"))
        # 3 classifier, 5 vertices, 22 setup, 1 walker, 3 coverage, 7 depth test, 5 combiner; 31 groups after the
        # first one; M + 6 of the vertices.
        self.assertEqual(r["latency"]["min"], 3 + 5 + 22 + 1 + 3 + 7 + 5 + 31 + 7)

    def test_traffic_of_rows(self):
        """A row of 64 pixels is four lines; a vertical line needs one line of depth per row."""
        work = self.square("--layout", "raster")["work"]
        # Rows 16, 17, 48, 49, columns 16..49: lines 1..3; the other rows 18..47: lines 1 and 3.
        self.assertEqual(work["lines_read_depth"], 4 * 3 + 30 * 2)

    def test_frames_add_up(self):
        one = self.square()["work"]
        two = self.square("--set", "scene.count=2")["work"]
        for name in ("edge_classifier_edges", "resolver_blended_pixels", "lines_read_depth"):
            self.assertEqual(two[name], 2 * one[name])
        for name in ("frame_cycles", "frame_cycles_bound", "columns_per_cycle", "bytes_per_blended_pixel",
                     "divider_occupancy_percent", "port_occupancy_percent"):
            self.assertAlmostEqual(two[name], one[name])


class Coverage(unittest.TestCase):
    def test_every_bin_is_declared_and_reached(self):
        bins, work = covered("geometric", *SIZE)
        self.assertEqual(set(bins), declared("geometric"))
        self.assertEqual(total(bins, "geometric/line"), work["line_setup_lines"])
        self.assertEqual(bins["geometric/lookup/depth/miss"], work["lines_read_depth"])
        self.assertGreater(work["line_setup_lines"], 0)

    # A run that ends with an error keeps the coverage up to that point.
    def test_error_is_covered(self):
        bins, _ = covered("geometric", *SIZE, "--set", "memory.error_address=0", code=3)
        self.assertGreater(bins["geometric/error/faces"], 0)
        self.assertEqual(total(bins, "geometric/error"), bins["geometric/error/faces"])


class Maps(observers_test.MapSums):
    def test_maps_match_counters(self):
        for more in ((), ("--layout", "raster")):
            with self.subTest(more), tempfile.TemporaryDirectory() as out:
                observers_test.run(out, *observers_test.ENGINES["geometric"], *more, "--maps")
                maps, work = self.sums(out)
                self.assertEqual(maps["lines"][0], work["coverage_unit_candidates"])
                self.assertEqual(maps["passed"][0], work["depth_test_passed"])
                self.assertEqual(maps["weight"][1], work["resolver_blended_pixels"])
                self.assertEqual(maps["depth_reads"][0], 16 * work["depth_test_misses"])


if __name__ == "__main__":
    if len(sys.argv) < 3 or sys.argv[1] in ("-h", "--help"):
        print(__doc__)
        sys.exit(0 if len(sys.argv) >= 2 else 2)
    program = os.path.abspath(sys.argv.pop(1))
    coverage_test.DEBURR = figures_test.DEBURR = observers_test.DEBURR = program
    coverage_test.SOURCE = sys.argv.pop(1)
    unittest.main()
