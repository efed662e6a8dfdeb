#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""scripts/coverage on a tree of three files: it lists the lines that no test runs, leaves out the
texts of checks, and fails where too few lines are run. usage: line_coverage_test.py SOURCE [unittest options]"""
import pathlib
import shutil
import subprocess
import sys
import unittest

sys.dont_write_bytecode = True
from tiny_tree import tiny_tree  # noqa: E402

SOURCE = pathlib.Path(sys.argv.pop(1) if len(sys.argv) > 1 else ".").resolve()

FILES = {
    "CMakePresets.json": """{"version": 6, "configurePresets": [{"name": "coverage", "generator": "Ninja",
  "binaryDir": "${sourceDir}/build/coverage"}]}
""",
    "CMakeLists.txt": """cmake_minimum_required(VERSION 3.25)
project(tiny LANGUAGES CXX)
enable_testing()
set(layer ${CMAKE_BINARY_DIR}/layers/rtl_model)
file(MAKE_DIRECTORY ${layer})
file(CREATE_LINK ${CMAKE_SOURCE_DIR}/rtl_model ${layer}/rtl_model SYMBOLIC)
add_compile_options(--coverage)
add_link_options(--coverage)
foreach(name fabric_tiny_test fabric_oracle_test other_test)
  add_executable(${name} ${name}.cpp)
  target_include_directories(${name} PRIVATE ${layer} ${CMAKE_SOURCE_DIR})
  add_test(NAME ${name}.all COMMAND ${name})
  file(APPEND ${CMAKE_BINARY_DIR}/test_programs.txt "${name} ${name}.cpp ${name}\n")
endforeach()
set_tests_properties(fabric_oracle_test.all PROPERTIES LABELS oracle)
""",
    "golden/tiny/tiny.h": """inline int twice(int a) {
  return 2 * a;
}
""",
    "golden/ideal/ideal.h": """inline int never() {
  return 1;
}
""",
    "rtl_model/tiny/tiny.h": """#define DEBURR_CHECK(is, text) (void)((is) || (text))
inline int half(int a) {
  DEBURR_CHECK(a % 2 == 0,
               [] {
                 return true;
               }());
  if (a < 0)
    return -half(-a);
  return a / 2;
}
inline int third(int a) {
  return a / 3;
}
inline int fourth(int a) {
  return a / 4;
}
""",
    "fabric_tiny_test.cpp": """#include "golden/tiny/tiny.h"
#include "golden/ideal/ideal.h"
#include "rtl_model/tiny/tiny.h"
int (*const unused[])(int) = {third, fourth};
int (*const ideal)() = never;
int main() { return half(twice(3)) == 3 && unused[0] && ideal ? 0 : 1; }
""",
    "fabric_oracle_test.cpp": """#include "rtl_model/tiny/tiny.h"
int main() { return third(3) == 1 ? 0 : 1; }
""",
    "other_test.cpp": """#error is no program to build
""",
}


class Coverage(unittest.TestCase):
    def setUp(self):
        self.root = tiny_tree(self, FILES)

    def coverage(self, *arguments):
        return subprocess.run([SOURCE / "scripts/coverage", "--root", self.root, "-j1", *arguments],
                              capture_output=True, text=True, check=False)

    def test_lines_table_and_verdict(self):
        done = self.coverage("--limit", "44")
        self.assertEqual((done.returncode, done.stderr), (0, ""), done.stdout)
        report = done.stdout[done.stdout.index("not run:"):].split("\n", 1)[1].splitlines()
        # The line for negative numbers, and two functions, one of which runs in tests of a label
        # that does not count; of the check its first line alone is one of nine.
        self.assertEqual(report[0], "  rtl_model/tiny/tiny.h: 8, 11-12, 14-15")
        self.assertEqual([line.split() for line in report[2:]], [
            ["folder", "lines", "run", "%"],
            ["golden", "2", "2", "100.0"], ["golden/tiny", "2", "2", "100.0"],
            ["rtl_model", "9", "4", "44.4"], ["rtl_model/tiny", "9", "4", "44.4"]])

        again = self.coverage("--no-build", "--no-run", "--limit", "45")
        self.assertEqual((again.returncode, again.stderr), (1, "rtl_model: below 45 %\n"))
        self.assertEqual(again.stdout.splitlines()[1:], report)

        self.assertEqual(self.coverage("--no-build", "--only", "none").stderr,
                         "no test source matches none\n")

    def test_a_layer_without_lines_and_a_test_that_fails(self):
        shutil.rmtree(self.root / "golden")
        (self.root / "fabric_tiny_test.cpp").write_text(
            '#include "rtl_model/tiny/tiny.h"\nint main() { return half(-4) == -2 ? 3 : 4; }\n',
            encoding="utf-8")
        done = self.coverage("--limit", "0")
        self.assertEqual((done.returncode, done.stderr.splitlines()[-2:]),
                         (1, ["tests failed", "golden: no lines were counted"]), done.stdout)

    def test_what_cannot_be_measured_is_said_in_a_line(self):
        for code, arguments, text in ((2, ["--only", "("], "--only (: missing )"),
                                      (2, ["-j", "0"], "-j 0: expected a number from 1"),
                                      (2, ["--odd"], "unrecognized arguments: --odd"),
                                      (1, ["--root", self.root / "none"], "none: No such file")):
            done = self.coverage(*arguments)
            self.assertEqual(done.returncode, code, done.stderr)
            self.assertIn(text, done.stderr.splitlines()[-1])
        (self.root / "fabric_tiny_test.cpp").write_text("no C++\n", encoding="utf-8")
        done = self.coverage()
        self.assertEqual((done.returncode, done.stderr.splitlines()[-1]),
                         (1, "cmake --build build/coverage failed"))


if __name__ == "__main__":
    unittest.main()
