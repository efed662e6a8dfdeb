#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""`deburr run texture --hdl`: a run with SystemVerilog units is checked and lists them; units that were not built are
rejected; the same command with a fault in a unit fails.

usage: run_test.py DEBURR FAULTY_DEBURR"""
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

DEBURR = FAULTY = None
SIZE = ["--size", "48x48", "--no-images"]
UNITS = ["address", "cache", "filter"]


def run(program, *options):
    """Exit code, both outputs and result.json of a run."""
    with tempfile.TemporaryDirectory() as folder:
        done = subprocess.run([program, "run", "texture", *SIZE, "--out", f"{folder}/out", *options],
                              capture_output=True, text=True, check=False)
        file = pathlib.Path(folder) / "out" / "result.json"
        result = json.loads(file.read_text(encoding="utf-8")) if file.exists() else None
        return done.returncode, done.stdout + done.stderr, result


class Run(unittest.TestCase):
    def test_units_are_replaced_and_results_equal(self):
        for preset in ("paper", "deburr"):
            _, _, plain = run(DEBURR, "--preset", preset)
            for units in (["all"], ["filter,address"], ["cache"]):
                with self.subTest(preset=preset, units=units):
                    code, text, result = run(DEBURR, "--preset", preset, "--hdl", *units)
                    self.assertEqual(code, 0, text)
                    named = UNITS if units == ["all"] else units[0].split(",")
                    self.assertEqual({name for name in result["units"] if name.endswith("_hdl")},
                                     {f"{name}_hdl" for name in named})
                    self.assertEqual("tag_stage" in result["units"], "cache" not in named)
                    self.assertEqual("lookup_hits_percent" in result["work"], "cache" not in named)
                    self.assertEqual(result["cycles"], plain["cycles"])
                    self.assertEqual(result["latency"], plain["latency"])
                    for key in ("fragments", "bilinears", "misses_per_texel"):
                        self.assertEqual(result["work"][key], plain["work"][key])

    def test_stalls_change_no_result(self):
        code, text, _ = run(DEBURR, "--hdl", "all", "--stalls", "0.2", "--shuffle", "--set", "run.poison=true",
                            "--set", "run.reset_after=3000", "--set", "memory.latency_max=300",
                            "--set", "texture.cache.fifo_depth=107")
        self.assertEqual(code, 0, text)

    def test_rejects_invalid_combinations(self):
        for options, words in (
                (["--hdl", "rasteriser"], ["run.hdl", "rasteriser", "address, cache or filter"]),
                (["--hdl", "all", "--set", "texture.footprint=half"],
                 ["unit address", "footprint=half", "footprint=exact", "configurations.txt"]),
                (["--hdl", "cache", "--set", "memory.latency=200"], ["cache.fifo_depth=207", "cache.fifo_depth=107"]),
                (["--hdl", "all", "--maps"], ["run.maps"]),
                (["--hdl", "all", "--pixel", "3,3"], ["run.pixel"]),
                (["--hdl", "all", "--set", "run.coverage=true"], ["run.coverage"])):
            with self.subTest(options=options):
                code, text, _ = run(DEBURR, *options)
                self.assertEqual(code, 2, text)
                for word in words:
                    self.assertIn(word, text)

    def test_detects_injected_fault(self):
        code, text, _ = run(FAULTY, "--preset", "paper")
        self.assertEqual(code, 0, text)
        for unit, options in (("address", ["--preset", "paper"]), ("filter", ["--preset", "paper"]),
                              ("cache", ["--layout", "linear"])):
            with self.subTest(unit=unit):
                code, text, _ = run(FAULTY, "--hdl", unit, *options)
                self.assertEqual(code, 1, text)


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__.splitlines()[-1])
    DEBURR, FAULTY = sys.argv[1:]
    unittest.main(argv=sys.argv[:1])
