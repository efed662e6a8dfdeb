#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Tests scripts/skipped on a record of six tests: counts, skipped tests and reasons. usage: skipped_test.py SOURCE"""
import pathlib
import subprocess
import sys
import tempfile
import unittest

SOURCE = pathlib.Path(sys.argv.pop(1) if len(sys.argv) > 1 else ".").resolve()

RECORD = """<?xml version="1.0" encoding="UTF-8"?>
<testsuite name="all" tests="6" failures="1" skipped="3">
  <testcase name="a.Passes" status="run"><system-out>fine</system-out></testcase>
  <testcase name="b.Fails" status="fail"><failure message=""/><system-out>wrong</system-out></testcase>
  <testcase name="c.Parts" status="run"><system-out>test_one (T.test_one) ... skipped 'no user namespaces here'
</system-out></testcase>
  <testcase name="d.Data" status="notrun"><skipped message="x"/><system-out>t.cpp:7: Skipped
no "/some/where/frames/a.png": set DEBURR_DATA to the folder that holds frames/
</system-out></testcase>
  <testcase name="e.Data" status="notrun"><skipped message="x"/><system-out>t.cpp:9: Skipped
no data folder: set DEBURR_DATA to one
</system-out></testcase>
  <testcase name="f.Mesa" status="notrun"><skipped message="x"/><system-out>t.cpp:77: Skipped
Mesa is absent: no libEGL
</system-out></testcase>
</testsuite>
"""


def said(text):
    with tempfile.TemporaryDirectory(prefix="deburr_skipped_") as folder:
        file = pathlib.Path(folder) / "tests.xml"
        file.write_text(text, encoding="utf-8")
        return subprocess.run([SOURCE / "scripts/skipped", file], capture_output=True, text=True, check=False)


class Skipped(unittest.TestCase):
    def test_lists_counts_and_reasons(self):
        self.assertEqual(said(RECORD).stdout.splitlines(), [
            "3 tests ran, 3 of 6 were skipped",
            "  2: no data folder: DEBURR_DATA, or ../shared/data next to the repository (d.Data, e.Data)",
            "  1: Mesa is absent: no libEGL (f.Mesa)",
            "  1 parts of tests: no user namespaces here"])

    def test_missing_record_is_an_error(self):
        self.assertEqual(said("no XML").returncode, 1)


if __name__ == "__main__":
    unittest.main()
