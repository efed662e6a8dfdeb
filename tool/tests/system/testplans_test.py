#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Every testplan of the repository can be planned, and is rejected if a heading that it names is renamed.

usage: testplans_test.py DEBURR SOURCE"""
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[3] / "tb/engines"))
from engine_list import testplan  # noqa: E402

PLANS = ("coverage", "nightly", "smoke")


class Testplans(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory(prefix="deburr_testplans_")
        self.addCleanup(scratch.cleanup)
        self.root = pathlib.Path(scratch.name)
        for folder in ("docs", "tb/testplan", "tb/engines"):
            shutil.copytree(SOURCE / folder, self.root / folder)

    def plan(self, name):
        """One seed in a hundred: the planned features do not depend on the number of seeds."""
        done = subprocess.run([DEBURR, "regress", f"tb/testplan/{name}.yaml", "plan", "--divide", "100",
                               "--seed", "1"], cwd=self.root, capture_output=True, text=True, check=False)
        return done.returncode, done.stdout + done.stderr

    def test_every_plan_is_accepted(self):
        self.assertEqual(sorted(PLANS), sorted(path.stem for path in (SOURCE / "tb/testplan").iterdir()))
        for name in PLANS:
            code, said = self.plan(name)
            self.assertEqual(code, 0, said)
            self.assertRegex(said, r"RESULT: PASS regression \S+ --seed 1: [1-9][\d,]* points")

    def test_renamed_heading_rejects_every_plan(self):
        renamed = 0
        for name in PLANS:
            for page in {trace.partition("#")[0] for feature in testplan(SOURCE / f"tb/testplan/{name}.yaml")["features"]
                         for trace in feature["traces"]}:
                renamed += 1
                text = (SOURCE / page).read_text(encoding="utf-8")
                (self.root / page).write_text(re.sub(r"(?m)^#+ .*$", "# Renamed", text), encoding="utf-8")
                code, said = self.plan(name)
                self.assertEqual(code, 2, said)
                self.assertIn(f"'{page}' lacks the heading", said)
                (self.root / page).write_text(text, encoding="utf-8")
        self.assertGreater(renamed, 10)


if __name__ == "__main__":
    if len(sys.argv) < 3 or sys.argv[1] in ("-h", "--help"):
        print(__doc__)
        sys.exit(0 if len(sys.argv) >= 2 else 2)
    DEBURR, SOURCE = pathlib.Path(sys.argv.pop(1)).resolve(), pathlib.Path(sys.argv.pop(1)).resolve()
    unittest.main()
