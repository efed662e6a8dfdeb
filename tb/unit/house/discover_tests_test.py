#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Tests cmake/discover_tests.py with a program that prints a given list: names and labels of the entries, and
rejected inputs. usage: discover_tests_test.py SOURCE [unittest options]"""
import json
import pathlib
import subprocess
import sys
import unittest

sys.dont_write_bytecode = True
from tiny_tree import tiny_tree  # noqa: E402

SOURCE = pathlib.Path(sys.argv.pop(1) if len(sys.argv) > 1 else ".").resolve()
# Writes its list as a GoogleTest program does.
PROGRAM = """#!/bin/sh
cp "$(dirname "$0")/tests.json" "${2#--gtest_output=json:}"
"""


def source(name, **more):
    return {"name": f"rtl_{name}_test", "source": f"tb/unit/rtl/{name}_test.cpp", "labels": ["unit"],
            "timing": [], "long": [], "timeout": 120, **more}


class DiscoverTests(unittest.TestCase):
    def setUp(self):
        self.root = tiny_tree(self, {"program": PROGRAM})
        (self.root / "program").chmod(0o755)

    def discover(self, sources, tests, *more):
        """Returns exit code, output, and entries; `tests` are (suite, case, file)."""
        suites = {}
        for suite, case, file in tests:
            suites.setdefault(suite, []).append({"name": case, "file": file})
        (self.root / "tests.json").write_text(json.dumps({"testsuites": [
            {"name": suite, "testsuite": cases} for suite, cases in suites.items()]}), encoding="utf-8")
        (self.root / "list.json").write_text(json.dumps(sources), encoding="utf-8")
        output = self.root / "out.cmake"
        output.write_text("of the last build", encoding="utf-8")
        done = subprocess.run([SOURCE / "cmake/discover_tests.py", self.root / "list.json",
                               self.root / "program", output, *more], capture_output=True, text=True, check=False)
        return done.returncode, done.stderr, output.read_text(encoding="utf-8") if output.exists() else ""

    def test_entries_have_names_of_sources_and_labels_of_expressions(self):
        # Compilers give a file's absolute or relative path.
        code, said, text = self.discover(
            [source("a", timing=["Suite.Fast", "Each/Suite"]), source("b", labels=["unit", "oracle"], timeout=7)],
            [("Suite", "FastEnough", "../../tb/unit/rtl/a_test.cpp"),
             ("Suite", "NotFast", "tb/unit/rtl/a_test.cpp"),
             ("Way/Each/Suite", "Any/0", "/home/x/tb/unit/rtl/a_test.cpp"),
             ("Other", "SuiteFast", "layers/tb/tb/unit/rtl/b_test.cpp"),
             ("Suite", "OfB", "layers/tb/tb/unit/rtl/b_test.cpp")])
        self.assertEqual((code, said), (0, ""))
        program = self.root / "program"
        for name, of, labels, timeout in (
                ("Suite.FastEnough", "a", "unit;timing", 120), ("Suite.NotFast", "a", "unit", 120),
                ("Way/Each/Suite.Any/0", "a", "unit;timing", 120),
                ("Other.SuiteFast", "b", "unit;oracle", 7), ("Suite.OfB", "b", "unit;oracle", 7)):
            entry = f"rtl_{of}_test.{name}"
            self.assertIn(f"add_test([=[{entry}]=] [=[{program}]=] [=[--gtest_filter={name}]=])\n", text)
            self.assertIn(f'set_tests_properties([=[{entry}]=] PROPERTIES TIMEOUT {timeout} WORKING_DIRECTORY '
                          f'[=[{self.root}]=] LABELS "{labels}")\n', text)
        self.assertEqual(text.count("add_test"), 5)

    def test_suites_become_one_entry_on_request(self):
        tests = [(suite, case, "tb/unit/rtl/a_test.cpp") for suite, case in (
            ("Suite", "Fast"), ("Suite", "One"), ("Suite", "Two"), ("Way/Each/Suite", "Any/0"))]
        sources = [source("a", timing=["Suite.Fast"], timeout=7)]
        code, said, text = self.discover(sources, tests, "--suites")
        self.assertEqual((code, said), (0, ""))
        for entry, names, labels, timeout in (
                ("Suite.timing", "Suite.Fast", "unit;timing", 7), ("Suite", "Suite.One:Suite.Two", "unit", 14),
                ("Way/Each/Suite", "Way/Each/Suite.Any/0", "unit", 7)):
            self.assertIn(f"add_test([=[rtl_a_test.{entry}]=] [=[{self.root / 'program'}]=] [=[--gtest_filter={names}]=])\n"
                          f"set_tests_properties([=[rtl_a_test.{entry}]=] PROPERTIES TIMEOUT {timeout} WORKING_DIRECTORY "
                          f'[=[{self.root}]=] LABELS "{labels}")\n', text)
        self.assertEqual(text.count("add_test"), 3)
        for timeout, seconds in ((200, 400), (400, 600), (700, 700)):  # for a suite of two tests
            self.assertIn(f"TIMEOUT {seconds} ", self.discover([source("a", timeout=timeout)], tests[1:3], "--suites")[2])

    def test_rejects_lost_or_ambiguous_tests_without_entries(self):
        one, two = ("Suite", "One", "tb/unit/rtl/a_test.cpp"), ("Suite", "Two", "tb/unit/rtl/b_test.cpp")
        for sources, tests, complaint in (
                ([source("a"), source("b")], [one, ("Suite", "One", two[2])], "2 tests are called Suite.One"),
                ([source("a"), source("b")], [one], "tb/unit/rtl/b_test.cpp has no tests"),
                ([source("a")], [one, two], "Suite.Two is in no source of the list"),
                ([source("a")], [("Suite", "DISABLED_One", one[2])], "Suite.DISABLED_One would not run"),
                ([source("a", timing=["Suite.Tow"])], [one], "no test 'Suite.Tow' for the label timing"),
                ([source("a"), source("b", long=["Suite.One"])], [one, two],
                 "b_test.cpp has no test 'Suite.One' for the label long")):
            code, said, text = self.discover(sources, tests)
            self.assertEqual((code, text), (1, ""))
            self.assertIn(complaint, said)


if __name__ == "__main__":
    unittest.main()
