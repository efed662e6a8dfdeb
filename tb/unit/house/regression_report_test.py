#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""What scripts/ make of a regression and of testplans, by files made by hand: the page of collected.json, a plan that
includes others, points of a sweep. usage: regression_report_test.py SOURCE"""
import json
import math
import pathlib
import subprocess
import sys
import tempfile
import unittest

import yaml

SOURCE = pathlib.Path(sys.argv.pop(1) if len(sys.argv) > 1 else ".").resolve()
sys.dont_write_bytecode = True
sys.path[:0] = [str(SOURCE / "scripts"), str(SOURCE / "tb/engines")]
import collected  # noqa: E402
from engine_list import engines, testplan  # noqa: E402

MET = {"scoreboard": "colours", "comparisons": 1200, "minimum": 1000, "met": True}
FEW = {"scoreboard": "pixels", "comparisons": 34, "minimum": 100, "met": False}
COLLECTED = {
    "title": "Night", "testplan": "night-of-10", "divisor": 10, "base_seed": 7, "version": "1.2",
    "commit": "0123456789abcdef", "holds": False,
    "counts": {"runs": 1250, "passed": 1000, "failed": 200, "missing": 50, "simulated_seconds": 1499.6},
    "features": [
        {"title": "A", "runs": 1200, "passed": 960, "checks": [MET, FEW],
         "coverage": [{"bins": 1000, "hit": 900}, {"bins": 100, "hit": 100}]},
        {"title": "B", "runs": 50, "passed": 50, "checks": [], "coverage": []},
        {"title": "C", "runs": 0, "passed": 0, "checks": [MET], "coverage": [{"bins": 2, "hit": 0}]}],
    "buckets": [{"runs": 1999, "engine": "texture", "kind": "mismatch", "message": "a | b",
                 "example": {"name": "A/x/1"}}],
    "coverage": {"texture": {"bins": 16, "hit": 2, "holes": [f"texture/h{i}" for i in range(14)]},
                 "frame": {"bins": 12, "hit": 12, "holes": []}},
}
PAGE = """# Regression: Night

Made by `scripts/regression_report` from the `collected.json` of `deburr regress tb/testplan/night.yaml
--seed 7 --divide 10`; do not edit. How it is made: [regression.md](../reference/regression.md).

Version 1.2, commit `0123456789ab`. 1 250 runs: 1 000 passed, 200 failed,
50 missing; 80.0 % pass; 1 500 s of simulation. The testplan does not hold.

## Features

| feature | runs | passed | rate | compared | bins met |
|---|---|---|---|---|---|
| A | 1 200 | 960 | 80.0 % | 1 234 (too few: pixels) | 1 000 of 1 100 |
| B | 50 | 50 | 100.0 % | 0 | - |
| C | 0 | 0 | - | 1 200 | 0 of 2 |

## Failures

| runs | engine | kind | message | first |
|---|---|---|---|---|
| 1 999 | texture | mismatch | a \\| b | `A/x/1` |

## Coverage of all runs

| engine | bins | met | rate | not met |
|---|---|---|---|---|
| `texture` | 16 | 2 | 12.5 % | HOLES and 2 more |
| `frame` | 12 | 12 | 100.0 % |  |
""".replace("HOLES", ", ".join(f"`texture/h{i}`" for i in range(12)))


class Folder(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory(prefix="deburr_report_")
        self.addCleanup(scratch.cleanup)
        self.folder = pathlib.Path(scratch.name)

    def write(self, name, text):
        (self.folder / name).write_text(text, encoding="utf-8")
        return self.folder / name

    def page_of(self, what):
        out = self.folder / "page.md"
        done = subprocess.run([SOURCE / "scripts/regression_report", self.write("collected.json", json.dumps(what)),
                               "--out", out], capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)
        return out.read_text(encoding="utf-8")


class Report(Folder):
    def test_a_page_has_every_figure(self):
        self.assertEqual(self.page_of(COLLECTED), PAGE)

    def test_a_whole_plan_without_failures_and_coverage(self):
        page = self.page_of({**COLLECTED, "testplan": "night", "divisor": 1, "holds": True, "buckets": [],
                             "coverage": {}})
        self.assertIn("tb/testplan/night.yaml\n--seed 7`; do not", page)
        self.assertIn("The testplan holds.", page)
        self.assertIn("## Failures\n\nNone.\n", page)
        self.assertTrue(page.endswith("No run has left any: `run.coverage` was off.\n"))


class Testplan(Folder):
    def test_what_is_included_stands_in_front_or_adds_to_what_is_there(self):
        """docs/reference/regression.md: a file of each engine, in their order, then a file by its name."""
        for name in engines():
            self.write(f"{name}.yaml", yaml.safe_dump({
                "features": [{"id": name, "stimuli": [1]},
                             {"id": "own", "stimuli": [name], "checks": {name: 1}}],
                "coverage": [f"{name}/*"]}))
        self.write("more.yaml", "features: [{id: late, traces: [t]}, {id: late, traces: [u], coverage: [c]}]\n"
                   "unmet: [a]\ncoverage: [last]\n")
        plan = testplan(self.write("plan.yml", "title: T\ninclude: ['*.yaml', more.yaml]\nunmet: [b]\n"
                                   "coverage: [first]\n"
                                   "features: [{id: own, traces: [x], checks: {mine: 3}}]\n"))
        self.assertEqual(plan, {
            "title": "T", "unmet": ["b", "a"], "coverage": ["first", *[f"{name}/*" for name in engines()], "last"],
            "features": [*[{"id": name, "stimuli": [1]} for name in engines()],
                         {"id": "late", "traces": ["t", "u"], "coverage": ["c"]},
                         {"id": "own", "traces": ["x"], "stimuli": engines(),
                          "checks": {"mine": 3, **{name: 1 for name in engines()}}}]})


class Points(Folder):
    def test_identical_pictures_are_infinite(self):
        sweep = {"schema": 2, "metrics": [{"name": "psnr"}, {"name": "bits"}],
                 "points": [{"values": [None, 1], "identical": ["psnr"]}, {"values": [30, None]}]}
        read = collected.read(self.write("collected.json", json.dumps(sweep)))
        self.assertEqual([point["values"] for point in read["points"]], [[math.inf, 1], [30, None]])
        for wrong in ({**sweep, "schema": 1}, []):
            with self.assertRaisesRegex(ValueError, "not of schema 2"):
                collected.read(self.write("collected.json", json.dumps(wrong)))


if __name__ == "__main__":
    unittest.main()
