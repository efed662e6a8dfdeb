#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Types of the Python module as mypy --strict reads them: it accepts the page's program and another one, and finds
each mistake in a third.

usage: python_stubs_test.py MODULES DOCS"""
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

MODULES, DOCS = pathlib.Path(sys.argv.pop(1)).resolve(), pathlib.Path(sys.argv.pop(1)).resolve()

GOOD = """import numpy
import deburr
from deburr import golden, ideal

frame = numpy.zeros((4, 4, 4), dtype=numpy.uint8)
smooth = golden.morphological(frame, preset="smaa", detail=True)
pixels = ideal.fxaa(smooth.pixels, threshold=0.1)
weights = ideal.smaa_weights(smooth.edges, corner_keeps=None)
run = deburr.run("texture", scene="plane", size=(64, 64), memory_latency=200, texture_cache_bytes=4096, maps=True)
print(run.cycles, run.maps["misses"].max(), run.pictures["after"].shape, smooth.work.edge_pixels, pixels.shape)
print(deburr.cost("texture", texture_cache_bytes=4096).gates.value)
table = deburr.sweep("texture", {"texture_cache_bytes": [4096]}, scene="plane", metrics=["cycles"], jobs=2)
unit = golden.TextureUnit(cache_bytes=4096)
unit.load(golden.mip_levels(frame), format="rgba8")
colours = unit.filter(golden.quads_of(numpy.zeros((4, 4)), numpy.zeros((4, 4))))
print(unit.work.by_level, golden.QUAD.names, golden.EDGE_CLASSES[0], smooth.probes["weights"], colours["rgba"])
"""
MISTAKES = ("golden.morphologic(frame)", "golden.morphological(frame, detail='yes')", "smooth.pixel", "smooth.probes()",
            "ideal.fxaa(frame, treshold=1)", "ideal.TextureImage(frame, srgb='yes')", "ideal.disc('0', 0, 1, 4, 4)",
            "golden.QUAD.nams", "smooth.work()", "run.explain(3)", "run.pictures[3]", "deburr.run(3)", "deburr.cost(3)",
            "deburr.sweep('texture', {}, jobs='2')", "unit.filter()", "golden.mip_levels(frame).shape")


class Types(unittest.TestCase):
    def lines_with_errors(self, text):
        """Line numbers of mypy errors; the package is treated as installed, so its own errors are not reported."""
        with tempfile.TemporaryDirectory() as folder:
            program = pathlib.Path(folder) / "program.py"
            program.write_text(text, encoding="utf-8")
            done = subprocess.run(["/usr/bin/python3", "-m", "mypy", "--strict", "--follow-imports=silent", "--python-executable",
                                   "/usr/bin/python3", "--cache-dir", folder, program.name],
                                  cwd=folder, text=True, capture_output=True, check=False,
                                  env={"PATH": "/usr/bin:/bin", "MYPYPATH": str(MODULES), "HOME": folder})
        self.assertIn(done.returncode, (0, 1), done.stdout + done.stderr)
        return done.stdout, [int(line) for line in re.findall(r"^program\.py:(\d+): error", done.stdout, re.M)]

    def test_program_of_the_page_is_accepted(self):
        page = (DOCS / "reference/python.md").read_text(encoding="utf-8")
        said, errors = self.lines_with_errors(re.search(r"```python\n(.*?)```", page, re.S)[1])
        self.assertEqual(errors, [], said)

    def test_each_mistake_is_found(self):
        said, errors = self.lines_with_errors(GOOD)
        self.assertEqual(errors, [], said)
        said, errors = self.lines_with_errors(GOOD + "\n".join(MISTAKES) + "\n")
        first = GOOD.count("\n") + 1
        self.assertEqual(sorted(set(errors)), list(range(first, first + len(MISTAKES))), said)


if __name__ == "__main__":
    unittest.main()
