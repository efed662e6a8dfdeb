#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""What runs say of the memories that the hardware is built from: no default and no preset of any engine has one
that no technology offers, and the totals are the sums.

usage: memories_test.py DEBURR"""
import itertools
import json
import os
import subprocess
import sys
import tempfile
import unittest

DEBURR = "deburr"


def runs():
    yield ("texture",)
    presets = ("mlaa", "mlaa-slope", "deburr-line", "deburr")
    for preset, lanes, storage in itertools.product(presets, "124", ("line_buffers", "memory")):
        yield ("morphological", "--preset", preset, "--lanes", lanes, "--storage", storage)
    for preset in presets:
        yield ("frame", "--preset", preset)
    for preset, layout in itertools.product(("gpaa", "gpaa-optimised", "deburr"), ("tiled", "raster")):
        yield ("geometric", "--preset", preset, "--layout", layout)


class Memories(unittest.TestCase):
    def result(self, *arguments):
        with tempfile.TemporaryDirectory() as out:
            done = subprocess.run([DEBURR, "run", *arguments, "--size", "24x16", "--check", "none", "--out", out],
                                  text=True, capture_output=True, check=False)
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
            with open(os.path.join(out, "result.json")) as file:
                return done.stdout + done.stderr, json.load(file)

    def test_no_default_and_no_preset_is_idealised(self):
        for arguments in runs():
            with self.subTest(arguments):
                said, result = self.result(*arguments)
                self.assertNotIn("idealised", result)
                self.assertNotIn("IDEALISED", said)
                self.assertNotIn("cannot be built", said)

    def test_totals_are_sums(self):
        for arguments in (("texture",), ("morphological",), ("geometric",), ("frame",)):
            _, result = self.result(*arguments)
            memories = result["memories"].values()
            self.assertTrue(memories)
            for m in memories:
                self.assertEqual(m["logical_bits"], m["words"] * m["word_bits"])
                self.assertGreaterEqual(m["physical_bits"], m["logical_bits"])
                self.assertIn(m["kind"], ("flops", "sram", "rom"))
            for kind, bits in result["memory_bits"].items():
                of_kind = [m for m in memories if kind in ("total", m["kind"])]
                self.assertEqual(bits["memories"], len(of_kind))
                self.assertEqual(bits["logical"], sum(m["logical_bits"] for m in of_kind))
                self.assertEqual(bits["physical"], sum(m["physical_bits"] for m in of_kind))


if __name__ == "__main__":
    if len(sys.argv) < 2 or sys.argv[1] in ("-h", "--help"):
        sys.exit(__doc__)
    DEBURR = sys.argv.pop(1)
    unittest.main()
