#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Figures in result.json and report.html of runs, compared with values found by hand or with other figures.

usage: figures_test.py DEBURR"""
import html
import json
import math
import os
import re
import struct
import subprocess
import sys
import tempfile
import unittest
import zlib


def png(width, height, grey):
    """A PNG whose pixel (x, y) is grey(x, y)."""
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    rows = b"".join(b"\0" + b"".join(bytes([grey(x, y)]) * 3 for x in range(width)) for y in range(height))
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0))
            + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


class Figures(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory(prefix="deburr_figures_")
        self.addCleanup(scratch.cleanup)
        self.out = os.path.join(scratch.name, "out")
        self.frame = os.path.join(scratch.name, "frame.png")

    def run_engine(self, *arguments):
        done = subprocess.run([DEBURR, "run", *arguments, "--out", self.out], text=True, capture_output=True,
                              timeout=300)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.terminal = done.stdout
        with open(os.path.join(self.out, "report.html")) as file:
            self.page = re.sub(r"\s+", " ", html.unescape(file.read()))
        with open(os.path.join(self.out, "result.json")) as file:
            return json.load(file)

    def assert_tile(self, name, value, unit="", note=""):
        """Value, unit and note as the report shows them."""
        tiles = {tile[0]: tile[1:] for tile in re.findall(
            r'<div class="name">([^<]*)</div><div class="value">([^<]*) <small>([^<]*)</small></div>'
            r'<div class="note">([^<]*)</div>', self.page)}
        self.assertIn(name, tiles)
        self.assertEqual(tiles[name][:2], (value, unit), name)
        self.assertEqual(tiles[name][2], note, name)

    def assert_row(self, name, value, unit):
        """A row of the report's tables of figures."""
        self.assertIn((name, f"{value:.4g}", unit), re.findall(
            r"<tr[^>]*><td>([^<]*)</td><td class=\"n\">([^<]*)</td><td>([^<]*)</td>", self.page))

    def assert_percentiles(self, latency):
        """Each percentile lies in the bin of its rank; no two share a bin."""
        bins = latency["histogram"]
        width = bins[1]["from"] - bins[0]["from"]
        count = sum(b["count"] for b in bins)
        begins = []
        for name, share in (("p50", 0.50), ("p95", 0.95), ("p99", 0.99)):
            rank, seen = math.ceil(share * count), 0
            for b in bins:
                seen += b["count"]
                if seen >= rank:
                    self.assertTrue(b["from"] <= latency[name] < b["from"] + width, (name, b, latency[name]))
                    begins.append(b["from"])
                    break
        self.assertEqual(len(set(begins)), 3, "a run in which they are told apart")
        self.assertTrue(bins[0]["from"] <= latency["min"] < bins[0]["from"] + width)
        self.assertTrue(bins[-1]["from"] <= latency["max"] < bins[-1]["from"] + width)


class Texture(Figures):
    SMALL = ("texture", "--scene", "plane", "--size", "32x32", "--set", "memory.latency=1")

    def test_figures_of_a_run(self):
        r = self.run_engine(*self.SMALL, "--mode", "nearest")
        work, lines = r["work"], r["memory"]["lines_filled"]
        # Without levels a sample is one request, and the plane fills the picture.
        self.assertEqual(work["fragments"], 32 * 32)
        self.assertEqual(work["bilinears"], work["sample_walker_samples"])
        self.assertEqual(work["bilinears_per_fragment"], work["sample_walker_samples"] / 1024)
        self.assertEqual(r["throughput"]["value"], work["bilinears"] / r["cycles"])
        self.assertEqual(r["throughput"]["bound"], 1)
        self.assertEqual(work["misses_per_texel"], lines / (4 * work["bilinears"]))
        self.assertEqual(work["texel_hits_percent"], 100 - 100 * work["misses_per_texel"])
        looked_up = [work[f"tag_stage_{what}"] for what in ("hits", "merged", "misses")]
        for what, count in zip(("hits", "merged", "misses"), looked_up):
            self.assertGreater(count, 0)
            self.assertEqual(work[f"lookup_{what}_percent"], 100 * (count / sum(looked_up)), what)
        self.assertEqual(r["memory"]["read_gb_per_s"], 64 * lines * 166.67 / (1000 * r["cycles"]))
        self.assertEqual(r["memory"]["written_gb_per_s"], 0)
        self.assert_row("Texels without a line fill", work["texel_hits_percent"], "%")
        self.assert_row("Lookups that hit", work["lookup_hits_percent"], "%")
        self.assert_row("Lookups merged with a fill", work["lookup_merged_percent"], "%")
        self.assert_row("Mean read rate at clock_mhz, over the whole run; 10^9 bytes per second",
                        r["memory"]["read_gb_per_s"], "GB/s")
        self.assert_row("Mean write rate at clock_mhz, over the whole run; 10^9 bytes per second", 0, "GB/s")
        self.assertIn(f'<td class="muted">byte/clk, {64 * 166.67 / 1000:.4g} GB/s</td>', self.page)
        self.assertEqual(work["texels_fetched_per_fragment"], lines * 16 / 1024)
        self.assertEqual(r["memory"]["bytes_read"], 64 * lines)
        self.assertEqual(lines, work["tag_stage_misses"])
        self.assertEqual(work["bilinears"],
                         work["tag_stage_hits"] + work["tag_stage_merged"] + work["tag_stage_misses"])
        self.assertEqual(sum(b["count"] for b in r["latency"]["histogram"]), 1024)
        self.assert_percentiles(r["latency"])
        rate = work["bilinears"] / r["cycles"]
        ms = r["cycles"] / 166.67e6 * 1e3
        self.assert_tile("Cycles", f"{r['cycles']:,}", "clk", f"{ms:.2f} ms at 166.67 MHz")
        self.assert_tile("Throughput", f"{rate:.3f}", note=f"bilinear/clk, {100 * rate:.1f} % of the bound 1")
        self.assert_tile("Latency p50", str(r["latency"]["p50"]), "clk",
                         f"p99 {r['latency']['p99']}, max {r['latency']['max']}")
        self.assert_tile("Read from memory", f"{64 * lines / 2**20:.2f}", "MiB", f"{lines:,} reads")
        self.assertTrue(f"At 166.67 MHz this is {rate * 166.67:.1f} Mbilinear/s." in self.page)

    def test_cycles_match_the_run(self):
        cycles = self.run_engine(*self.SMALL)["cycles"]
        self.assertEqual(self.run_engine(*self.SMALL, "--max-cycles", str(cycles))["cycles"], cycles)
        short = subprocess.run([DEBURR, "run", *self.SMALL, "--max-cycles", str(cycles - 1), "--out", self.out],
                               capture_output=True, timeout=300)
        self.assertEqual(short.returncode, 3)

    def test_samples_and_requests_of_each_mode(self):
        """Without anisotropy one sample per fragment; a second request where two levels are blended."""
        for mode, levels in (("nearest", 1), ("linear", 1), ("linear_mipmap_nearest", 1), ("linear_mipmap_linear", 2)):
            work = self.run_engine(*self.SMALL, "--mode", mode, "--aniso", "1")["work"]
            self.assertEqual(work["sample_walker_samples"], 1024, mode)
            self.assertEqual(work["bilinears"], 1024 + (work["level_unit_two_levels"] if levels == 2 else 0), mode)
            self.assertEqual(work["filter_pipeline_stage_7"], 1024, "a sample passes here once")
            self.assertEqual(work["filter_pipeline_stage_8"], 1024, "a fragment passes here once")

    def test_texel_bytes_follow_the_format(self):
        for texel_format, size in (("rgba8", 4), ("rgb565", 2), ("l8", 1)):
            for line in (64, 128):
                r = self.run_engine(*self.SMALL, "--format", texel_format, "--set", f"texture.cache.line_bytes={line}")
                lines = r["work"]["miss_queue_line_fills"]
                self.assertEqual(r["memory"]["lines_filled"], lines)
                self.assertEqual(r["memory"]["bytes_read"], line * lines)
                self.assertEqual(r["work"]["texels_fetched_per_fragment"], lines * line / size / 1024)

    def test_memory_port_figures(self):
        memories = self.run_engine(*self.SMALL)["memories"]
        ports = {name: memory["ports"] for name, memory in memories.items()}
        self.assertEqual(ports["descriptors"], "3R1W")
        self.assertEqual(ports["miss_queue_fill_buffer"], "1R1W")
        self.assertTrue(">3R1W<" in self.page)


class Morphological(Figures):
    WIDTH, HEIGHT, ROWS = 40, 24, 32 + 5  # a search range of 66 rows, and those of the pipeline

    def step(self, *arguments, lanes=1, width=WIDTH):
        """White to the left of a border that moves right by a pixel every fourth row."""
        with open(self.frame, "wb") as file:
            file.write(png(width, self.HEIGHT, lambda x, y: 255 if x < 10 + y // 4 else 0))
        return self.run_engine("morphological", "--in", self.frame, "--preset", "mlaa-slope", "--lanes", str(lanes),
                               *arguments)

    def cycles(self, width, height, lanes):
        beats = -(-width // lanes)
        return (height + self.ROWS) * beats + 23

    def test_figures_of_a_frame(self):
        for lanes in (1, 2, 4):
            width = 40 * lanes  # shorter rows wait for their descriptors
            r = self.step(lanes=lanes, width=width)
            work, cycles = r["work"], self.cycles(width, self.HEIGHT, lanes)
            latency = self.ROWS * 40 + 23
            self.assertEqual((work["frame_cycles"], work["frame_cycles_by_formula"]), (cycles, cycles))
            self.assertEqual((r["latency"]["min"], r["latency"]["max"]), (latency, latency))
            self.assertEqual(work["latency_by_formula"], latency)
            self.assertEqual(r["throughput"]["value"], 24 * width / r["cycles"])
            self.assertEqual(r["throughput"]["bound"], lanes)
            self.assertEqual(work["input_pixels_per_cycle"], lanes)
            self.assertEqual(work["memory_bytes_per_pixel"], 0)
            self.assertAlmostEqual(work["frame_rate"], 148.5e6 / cycles)
            # 60 of 1920 x 1080.
            self.assertAlmostEqual(work["clock_for_1080p60"], 60 * self.cycles(1920, 1080, lanes) / 1e6)
            self.assertIs(work["fits_1080p60"], True)
            self.assert_tile("Frame", f"{cycles:,}", "clk", f"= formula; {cycles / 148.5e3:.2f} ms at 148.5 MHz")
            self.assert_tile("Latency of a pixel", f"{latency:,}", "clk", "= formula")

    def test_counts_of_a_frame(self):
        """Six runs of four left edges, five of one top edge; runs at the frame's border are not clean Z shapes."""
        for lanes in (1, 4):
            work = self.step("--set", "morphological.divider.interval=4", lanes=lanes)["work"]
            expected = {"area_unit_vertical_edges": 24, "area_unit_horizontal_edges": 5, "edge_detector_edge_pixels": 29,
                        "run_extractor_vertical_runs": 6, "run_extractor_horizontal_runs": 5, "run_extractor_z_runs": 9,
                        "run_extractor_long_runs": 0, "line_unit_h_divides": 5, "line_unit_v_divides": 6,
                        "line_unit_h_occupancy": 20, "line_unit_v_occupancy": 24, "area_unit_descriptors": 11,
                        "blender_pixels": 960, "slot_sequencer_beats": 960 // lanes, "slot_sequencer_frames": 1}
            self.assertEqual({name: work[name] for name in expected}, expected)
            self.assertAlmostEqual(work["edge_pixels_percent"], 100 * 29 / 960)
            self.assertAlmostEqual(work["blended_pixels_percent"], 100 * work["blender_blended_pixels"] / 960)

    def test_occupancy_of_the_dividers(self):
        """Divisions x interval over cycles x lanes; a divider is idle in a cycle without a division in progress."""
        for lanes, interval in ((1, 1), (1, 4), (4, 4)):
            r = self.step("--set", f"morphological.divider.interval={interval}", lanes=lanes)
            for name, divisions in (("line_unit_h", 5), ("line_unit_v", 6)):
                unit = r["units"][name]
                self.assertEqual(unit["busy"] + unit["idle"] + sum(unit["stalls"].values()), r["cycles"])
                self.assertAlmostEqual(r["work"][name + "_occupancy_percent"],
                                       100 * divisions * interval / (lanes * r["cycles"]))
                if lanes == 1 and interval == 1:
                    # Divisions never overlap: each takes the divider's latency plus one cycle.
                    self.assertEqual(unit["busy"], divisions * 25)

    def test_memory_traffic_and_stalls(self):
        r = self.step("--storage", "memory")
        work, cycles = r["work"], self.cycles(self.WIDTH, self.HEIGHT, 1)
        # 160 bytes per row are three lines; each is written and read.
        self.assertEqual((r["memory"]["bytes_written"], r["memory"]["bytes_read"]), (24 * 192, 24 * 192))
        self.assertEqual(r["memory"]["lines_filled"], 24 * 3)
        self.assertEqual(work["memory_bytes_per_pixel"], 2 * 192 / 40)
        # Rows of 40 pixels are too short for memory: 1080p is slower in the same proportion.
        self.assertGreater(work["frame_cycles"], cycles)
        hd = work["frame_cycles"] / cycles * 60 * self.cycles(1920, 1080, 1) / 1e6
        self.assertAlmostEqual(work["clock_for_1080p60"], hd)
        self.assertIs(work["fits_1080p60"], hd <= 148.5)
        self.assertGreater(hd, 148.5, "a frame that does not fit")
        slower = 100 * (work["frame_cycles"] - cycles) / cycles
        self.assert_tile("Frame", f"{work['frame_cycles']:,}", "clk",
                         f"formula {cycles:,}, {slower:+.1f} %; {work['frame_cycles'] / 148.5e3:.2f} ms at 148.5 MHz")
        self.assert_tile("Clock for 1080p60", f"{hd:.4g}", "MHz",
                         f"pixel clock 148.5, {100 * (hd / 148.5 - 1):+.1f} %")
        self.assert_tile("Memory traffic", "9.6", "byte/pixel")


if __name__ == "__main__":
    if len(sys.argv) < 2 or sys.argv[1] in ("-h", "--help"):
        print(__doc__)
        sys.exit(0 if len(sys.argv) >= 2 else 2)
    DEBURR = sys.argv.pop(1)
    unittest.main()
