#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Tests scripts/mutate on a tree of one file: mutants that the test covers are killed, the others survive; a replay
with a weaker test lists the newly surviving mutants. usage: mutate_test.py SOURCE"""
import pathlib
import subprocess
import sys
import unittest

sys.dont_write_bytecode = True
from tiny_tree import tiny_tree  # noqa: E402

SOURCE = pathlib.Path(sys.argv.pop(1) if len(sys.argv) > 1 else ".").resolve()
TEST = '#include "rtl_model/tiny/tiny.h"\nint main() {{ return {} ? 0 : 1; }}\n'
FILES = {
    "CMakeLists.txt": """cmake_minimum_required(VERSION 3.25)
project(tiny LANGUAGES CXX)
enable_testing()
add_executable(tiny_test tiny_test.cpp)
add_test(NAME tiny_test.all COMMAND tiny_test)
""",
    "rtl_model/tiny/tiny.h": """// a < b and 1 + 1 are not code here
inline bool tested(int a) { return a < 7; }
inline bool far_from_its_limit(int a) { return a < 9; }
inline bool unmet(int a) { return a < 9; }
""",
    "tiny_test.cpp": TEST.format("tested(6) && !tested(7) && far_from_its_limit(0)"),
}


class Mutate(unittest.TestCase):
    def test_campaign_and_replay_list_survivors(self):
        root, work = tiny_tree(self, FILES), tiny_tree(self, {})

        def mutate(*arguments):
            done = subprocess.run([SOURCE / "scripts/mutate", "--root", root, "--tests", "tiny_test", *arguments],
                                  capture_output=True, text=True, check=False)
            self.assertEqual(done.returncode, 1, done.stdout + done.stderr)
            return [line.partition(": ")[2] for line in done.stdout.splitlines() if line.startswith("survived")], \
                done.stdout

        survivors, text = mutate("--all", "--work", work / "first")
        self.assertIn("| `all` | 9 | 3 | 3 | 0 | 50.0 (50.0 to 50.0) |", text)
        self.assertIn("3 mutants without a switch or without a test that reaches them", text)
        results = (work / "first/results.jsonl").read_text(encoding="utf-8")
        self.assertEqual(mutate("--all", "--work", work / "first"), (survivors, text))
        self.assertEqual((work / "first/results.jsonl").read_text(encoding="utf-8").strip(), results.strip(), "resumed")
        (root / "tiny_test.cpp").write_text(TEST.format("tested(6) && far_from_its_limit(0)"), encoding="utf-8")
        lost, text = mutate("--replay", work / "first", "--work", work / "second")
        self.assertEqual([line.split("    ")[0].rpartition("return ")[2] for line in lost], ["a <= 7; }", "a < 8; }"])


if __name__ == "__main__":
    unittest.main()
