#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Functional coverage of a run: every declared bin of its engines and no other; hits that match hardware counters (a
lost hit is detected); the same sums when several engines run; no coverage unless requested.

usage: coverage_test.py DEBURR SOURCE"""
import json
import os
import re
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../../tb/engines"))
from engine_list import trials  # noqa: E402

DEBURR, SOURCE = "deburr", "."
SIZE = ("--size", "72x56")


def run(*arguments, code=0):
    """result.json, or the error message if the run is expected to fail."""
    with tempfile.TemporaryDirectory(prefix="deburr_coverage_") as out:
        done = subprocess.run([DEBURR, "run", *arguments, "--quiet", "--no-images", "--out", out], text=True,
                              capture_output=True, check=False)
        if done.returncode != code:
            raise AssertionError(f"{arguments}: {done.returncode}\n{done.stdout}{done.stderr}")
        if code == 2:
            return done.stdout + done.stderr
        with open(os.path.join(out, "result.json"), encoding="utf-8") as file:
            return json.load(file)


def covered(*arguments, code=0):
    result = run(*arguments, "--set", "run.coverage=true", code=code)
    return result["coverage"]["bins"], result["work"]


def declared(engine):
    """The names on the page of an engine, without those that only tests reach."""
    with open(os.path.join(SOURCE, "docs/reference/coverage.md"), encoding="utf-8") as file:
        rows = re.findall(r"^\| `(\w+/[^`]*)` \| ([^|]*) \|", file.read(), re.M)
    directed = trials("directed").get(engine, [])
    return {prefix + name for prefix, names in rows for name in re.findall("`([^`]+)`", names)
            if prefix.startswith(engine + "/") and name != "invalid" and
            prefix not in directed}


def total(bins, group):
    return sum(hits for name, hits in bins.items() if name.startswith(group + "/"))


class Coverage(unittest.TestCase):
    def test_off_by_default(self):
        self.assertNotIn("coverage", run("texture", *SIZE))

    def test_texture_bins_match_counters(self):
        bins, work = covered("texture", *SIZE, "--scene", "quad")
        self.assertEqual(set(bins), declared("texture"))
        fragments = work["fragments"]
        self.assertEqual(total(bins, "texture/samples"), fragments)
        self.assertEqual(total(bins, "texture/major/4"), fragments)
        self.assertEqual(bins["texture/format/rgba8"], fragments)
        self.assertEqual(total(bins, "texture/mode") + total(bins, "texture/magnified"), fragments)
        self.assertEqual(sum(int(name.split("/")[-1]) * hits for name, hits in bins.items()
                             if name.startswith("texture/samples/")), work["sample_walker_samples"])
        for outcome, counter in (("hit", "hits"), ("miss", "misses"), ("merged", "merged")):
            self.assertEqual(bins[f"texture/cache/{outcome}"], work[f"tag_stage_{counter}"])
        for axes in (2, 8):
            self.assertEqual(total(bins, f"texture/major/{axes}"), 0)
        self.assertEqual(total(bins, "texture/output"), 0)

    def test_texture_with_other_settings_matches(self):
        bins, work = covered("texture", *SIZE, "--scene", "plane", "--format", "srgb8_a8", "--set", "texture.axes=two",
                             "--set", "texture.kernel=tent", "--set", "texture.srgb_output=encoded")
        fragments = work["fragments"]
        self.assertEqual(bins["texture/output/encoded"], fragments)
        self.assertEqual(bins["texture/format/srgb8_a8"], fragments)
        self.assertEqual(total(bins, "texture/major/2"), fragments)
        self.assertEqual(total(bins, "texture/tent"), fragments)
        self.assertGreater(bins["texture/tent/wide"], 0)

    def test_morphological_bins_match_counters(self):
        bins, work = covered("morphological", *SIZE)
        self.assertEqual(set(bins), declared("morphological"))
        self.assertEqual(total(bins, "morphological/decision"), 72 * 56)
        runs = work["run_extractor_horizontal_runs"] + work["run_extractor_vertical_runs"]
        self.assertEqual(total(bins, "morphological/shape"), runs)
        self.assertGreater(runs, 0)
        self.assertEqual(total(bins, "morphological/table"), 0)

    def test_no_coverage_without_golden_model(self):
        self.assertIn("run.coverage", run("texture", *SIZE, "--check", "none", "--set", "run.coverage=true", code=2))


if __name__ == "__main__":
    if len(sys.argv) != 3:
        print(__doc__)
        sys.exit(0 if len(sys.argv) == 2 and sys.argv[1] in ("-h", "--help") else 2)
    DEBURR, SOURCE = sys.argv[1:]
    unittest.main(argv=sys.argv[:1])
