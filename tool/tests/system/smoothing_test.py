#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""A whole frame with each choice of smoothing engines: checked by golden models, quality and consistent figures; its
coverage and maps are those of its engines.

usage: smoothing_test.py DEBURR SOURCE"""
import json
import os
import subprocess
import sys
import tempfile
import unittest

import coverage_test
import observers_test
from coverage_test import SIZE, covered, declared, total

SMALL = ("--scene", "object", "--size", "160x120")


class Smoothing(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory(prefix="deburr_smoothing_")
        self.addCleanup(scratch.cleanup)
        self.out = os.path.join(scratch.name, "out")

    def command(self, code, *arguments, says=""):
        done = subprocess.run([DEBURR, "run", "frame", *SMALL, *arguments, "--out", self.out], text=True,
                              capture_output=True, timeout=300)
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        self.assertIn(says, done.stdout + done.stderr)

    def run_frame(self, *arguments):
        self.command(0, *arguments)
        with open(os.path.join(self.out, "result.json")) as file:
            return json.load(file)

    def pictures(self):
        return {name[:-4] for name in os.listdir(self.out) if name.endswith(".png")}

    def test_both_engines_smooth_best(self):
        quality = {}
        for choice in ("morphological", "geometric", "geometric-morphological"):
            result = self.run_frame("--smoothing", choice, "--truth")
            self.assertEqual(result["checks"]["mismatches"] + result["checks"]["traffic_mismatches"], 0)
            quality[choice] = result["quality"]
            self.assertEqual("classes" in self.pictures(), choice != "morphological")
            self.assertEqual("edges" in self.pictures(), choice != "geometric")
        for measure in ("psnr_edge_db", "psnr_silhouette_db"):
            self.assertGreater(quality["geometric"][measure], quality["morphological"][measure] + 1)
            self.assertGreaterEqual(quality["geometric-morphological"][measure], quality["geometric"][measure])
        # With its own edges, the second engine takes texture detail for edges.
        own = self.run_frame("--smoothing", "geometric-morphological", "--truth", "--preset", "deburr", "--set",
                             "morphological.edges.source=colour")["quality"]
        self.assertLess(own["psnr_edge_db"], quality["geometric"]["psnr_edge_db"] - 1)

    def test_cycles_of_sequential_engines_add_up(self):
        geometric = self.run_frame("--smoothing", "geometric")["work"]
        result = self.run_frame("--smoothing", "geometric-morphological")
        work = result["work"]
        self.assertEqual(work["drawing_cycles"], geometric["drawing_cycles"])
        self.assertAlmostEqual(
            result["cycles"], work["texturing_cycles"] + work["drawing_cycles"] + work["smoothing_cycles"], delta=20)
        self.assertLessEqual(work["engine_cycles_bound"], result["cycles"])
        # By default a marked pixel makes no edge, so no pixel is bypassed; with bypass = marked some are.
        self.assertEqual(work["morphological_blender_bypassed_pixels"], 0)
        marked = self.run_frame("--smoothing", "geometric-morphological", "--set", "morphological.bypass=marked")["work"]
        self.assertGreater(marked["morphological_blender_bypassed_pixels"], 0)
        # Every marked pixel was blended by the first engine.
        self.assertLessEqual(marked["morphological_blender_bypassed_pixels"], work["geometric_resolver_blended_pixels"])

    def test_wide_texture_unit_lowers_the_bound(self):
        narrow, wide = (self.run_frame("--smoothing", "geometric", "--set", f"texture.build={build}")
                        for build in ("narrow", "wide"))
        bilinears = narrow["work"]["texture_bilinears"]
        self.assertEqual(narrow["work"]["engine_cycles_bound"] - wide["work"]["engine_cycles_bound"],
                         bilinears - (bilinears + 3) // 4)
        self.assertLessEqual(wide["work"]["engine_cycles_bound"], wide["cycles"])

    def test_given_settings_are_kept(self):
        def configuration(*given):
            self.run_frame("--smoothing", "geometric-morphological", *given)
            with open(os.path.join(self.out, "manifest.json")) as file:
                return json.load(file)["configuration"]
        implied = configuration()
        self.assertEqual(implied["geometric.mark"], True)
        self.assertEqual(implied["morphological.preset"], "deburr-line")
        self.assertEqual(implied["morphological.bypass"], "masked")
        self.assertEqual(implied["morphological.edges.source"], "predicated")
        self.assertEqual(implied["morphological.edges.threshold_off_depth_edge"], 16777215)
        given = configuration("--set", "morphological.bypass=beside", "--set", "morphological.edges.source=luma")
        self.assertEqual(given["morphological.bypass"], "beside")
        self.assertEqual(given["morphological.edges.source"], "luma")
        # A dynamic threshold cannot be combined with depth.
        self.assertEqual(configuration("--preset", "smaa-dynamic")["morphological.edges.source"], "luma")

    def test_every_preset_of_either_engine_passes(self):
        for edges in ("gpaa", "gpaa-optimised"):
            for smoothing in ("mlaa", "smaa", "smaa-dynamic"):
                self.run_frame("--smoothing", "geometric-morphological", "--preset", smoothing, "--set",
                               f"geometric.preset={edges}")

    def test_unused_engine_takes_no_parameters(self):
        self.command(2, "--set", "geometric.layout=raster", says="has no geometric engine")
        self.command(2, "--set", "geometric_memory.latency=9", says="has no geometric engine")
        self.command(2, "--smoothing", "geometric", "--preset", "mlaa", says="has no morphological engine")
        self.command(2, "--smoothing", "geometric", "--set", "frame_memory.latency=9",
                     says="has no morphological engine")
        self.command(2, "--smoothing", "both", says="geometric-morphological")
        self.command(2, "--smoothing", "geometric", "--set", "geometric_memory.latency=20000",
                     says="geometric_memory.latency = 20000")

    def test_faults_of_either_engine_are_caught(self):
        unmarked = ("wrong-rule", "misdecode-config-linear-light")
        for fault, code in (("geometric.drop-line", 1), ("geometric.flip-weight", 1), ("wrong-rule", 1),
                            ("geometric.memory-error", 3), ("geometric.misdecode-config-layout", 1),
                            ("morphological.misdecode-config-linear-light", 1), ("misdecode-texture0-mode-layout", 1)):
            # No run of the remaining edges is extended or blended here, so a wrong setting would change nothing.
            marks = ("--set", "morphological.bypass=none") if fault.split(".")[-1] in unmarked else ()
            self.command(code, "--smoothing", "geometric-morphological", "--fault", fault, *marks)


class Coverage(unittest.TestCase):
    def test_bins_are_those_of_its_engines(self):
        bins, work = covered("frame", *SIZE, "--smoothing", "geometric-morphological")
        self.assertEqual(set(bins), {name for engine in ("texture", "morphological", "geometric")
                                     for name in declared(engine)})
        self.assertEqual(total(bins, "texture/samples"), work["texture_fragments"])
        self.assertEqual(total(bins, "morphological/decision"), 72 * 56)
        self.assertEqual(total(bins, "geometric/line"), work["geometric_line_setup_lines"])


class Maps(observers_test.MapSums):
    def test_maps_are_those_of_its_engines(self):
        with tempfile.TemporaryDirectory() as out:
            # With these settings, blended pixels have no edge left.
            observers_test.run(out, *observers_test.ENGINES["frame"], "--set", "morphological.bypass=none", "--maps")
            maps, work = self.sums(out)
            self.assertEqual(maps["texture_samples"][0], work["texture_sample_walker_samples"])
            self.assertEqual(maps["geometric_lines"][0], work["geometric_coverage_unit_candidates"])
            self.assertEqual(maps["morphological_edges"][1], work["morphological_edge_detector_edge_pixels"])


if __name__ == "__main__":
    if len(sys.argv) < 3 or sys.argv[1] in ("-h", "--help"):
        print(__doc__)
        sys.exit(0 if len(sys.argv) >= 2 else 2)
    DEBURR = os.path.abspath(sys.argv.pop(1))
    coverage_test.DEBURR = observers_test.DEBURR = DEBURR
    coverage_test.SOURCE = sys.argv.pop(1)
    unittest.main(verbosity=2)
