#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""scripts/mutate on a tree of one file: what the test looks at is killed, what it does not look at
survives, and the tree itself stays as it was. usage: mutate_test.py SOURCE [unittest options]"""
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

SOURCE = pathlib.Path(sys.argv.pop(1) if len(sys.argv) > 1 else ".").resolve()

FILES = {
    "CMakeLists.txt": """cmake_minimum_required(VERSION 3.25)
project(tiny LANGUAGES CXX)
enable_testing()
add_executable(tiny_test tiny_test.cpp)
add_test(NAME tiny_test.all COMMAND tiny_test)
add_executable(tiny tb/results/tiny.cpp)
add_test(NAME figures COMMAND sh ${CMAKE_CURRENT_SOURCE_DIR}/tiny_script.sh)
set_tests_properties(figures PROPERTIES ENVIRONMENT "TINY=$<TARGET_FILE:tiny>")
""",
    "rtl_model/tiny/tiny.h": """// a < b and 1 + 1 are no code here
inline bool tested(int a) { return a < 7; }
inline const char* untested(int a, int b) { return a == b ? "a < b" : "a + 1"; }
inline int stalled(bool ready) { return ready ? 0 : -1; }
""",
    "tiny_test.cpp": """#include "rtl_model/tiny/tiny.h"
int main() { return tested(6) && !tested(7) ? 0 : 1; }
""",
    "tb/results/tiny.cpp": """int main(int argc, char**) { return argc < 2 ? 0 : 1; }
""",
    "tiny_script.sh": """#!/bin/sh
"$TINY" && ! "$TINY" word
""",
}


class Mutate(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory(prefix="deburr_tiny_")
        self.addCleanup(scratch.cleanup)
        self.root = pathlib.Path(scratch.name)
        for name, text in FILES.items():
            (self.root / name).parent.mkdir(parents=True, exist_ok=True)
            (self.root / name).write_text(text, encoding="utf-8")

    def mutate(self, *arguments):
        return subprocess.run([SOURCE / "scripts/mutate", "--root", self.root, *arguments],
                              capture_output=True, text=True, check=False)

    def test_verdicts(self):
        done = self.mutate("rtl_model/tiny/tiny.h", "--tests", "tiny_test", "--count", "0")
        self.assertEqual(done.returncode, 1, done.stdout + done.stderr)
        verdicts = [(line.split()[0], line.split(": ", 2)[2].split("    ")[0])
                    for line in done.stdout.splitlines()[:-1]]
        tested = "inline bool tested(int a) {{ return a {} }}"
        self.assertEqual([v for v in verdicts if "tested(int a)" in v[1]],
                         [("killed", tested.format("<= 7;")), ("killed", tested.format("< 6;")),
                          ("killed", tested.format("< 8;"))])
        rest = [v for v in verdicts if "tested(int a)" not in v[1]]
        self.assertEqual([verdict for verdict, _ in rest], ["survived"] * len(rest))
        self.assertIn('a != b ? "a < b"', rest[0][1])
        self.assertIn("3 killed", done.stdout.splitlines()[-1])
        for name, text in FILES.items():
            self.assertEqual((self.root / name).read_text(encoding="utf-8"), text)

    def test_a_script_judges_what_it_runs(self):
        done = self.mutate("tb/results/tiny.cpp", "--count", "0")
        self.assertEqual(done.returncode, 1, done.stdout + done.stderr)
        *killed, survivor, _ = done.stdout.splitlines()
        self.assertEqual([(line.split()[0], line.rpartition("    ")[2]) for line in killed],
                         [("killed", "by figures")] * 5, done.stdout)
        self.assertRegex(survivor, "survived .* return argc < 2 [?] 0 : 2; }")

    def test_tests_that_fail_by_themselves_judge_nothing(self):
        (self.root / "tiny_test.cpp").write_text("int main() { return 1; }\n", encoding="utf-8")
        done = self.mutate("rtl_model/tiny/tiny.h", "--tests", "tiny_test")
        self.assertEqual(done.returncode, 2)
        self.assertIn("without any fault", done.stderr)

    def test_wrong_command_lines(self):
        for arguments in (["tiny_test.cpp"], ["rtl_model/none.h"], ["tiny_script.sh"],
                          ["rtl_model/tiny/tiny.h", "--tests", "none_test"],
                          ["rtl_model/tiny/tiny.h", "--work", self.root / "copy"]):
            self.assertEqual(self.mutate(*arguments).returncode, 2, arguments)

    @staticmethod
    def module():
        import importlib.machinery
        import importlib.util
        loader = importlib.machinery.SourceFileLoader("mutate", str(SOURCE / "scripts/mutate"))
        module = importlib.util.module_from_spec(importlib.util.spec_from_loader("mutate", loader))
        sys.dont_write_bytecode = True
        loader.exec_module(module)
        return module

    def test_each_block_has_its_tests(self):
        module = self.module()
        programs = {"_".join(path.relative_to(SOURCE / "tb/unit").with_suffix("").parts)
                    for path in (SOURCE / "tb/unit").rglob("*_test.cpp")}

        def found(file):
            return {name for name in programs
                    if re.fullmatch(module.tests_of(pathlib.PurePath(file)), name)}

        self.assertIn("fabric_link_test", found("rtl_model/fabric/link.h"))
        for file, start in (("rtl_model/texture/log2_unit.cpp", ("rtl_texture_",)),
                            ("rtl_model/morphological/runs/line_unit.h", ("rtl_morphological_",)),
                            ("golden/texture/filter.h",
                             ("golden_texture_", "rtl_texture_equivalence_")),
                            ("golden/morphological/line.cpp", ("golden_morphological_",)),
                            ("golden/ideal/ewa.cpp", ("golden_texture_ideal_",))):
            self.assertEqual(found(file), {name for name in programs if name.startswith(start)},
                             file)
            self.assertTrue(found(file))
        for room in module.ROOMS:
            self.assertTrue(found(f"tb/{room}/file.cpp") or room == "oracle", room)
        self.assertIn("results_result_test", found("tb/results/statistics.cpp"))

    def test_the_operators(self):
        module = self.module()

        def texts(source):
            return [source[:m.begin] + m.text + source[m.end:] for m in module.mutants_of(source)]

        self.assertEqual(texts("if (!out.can_push(cycle)) return;"), ["if (false) return;"])
        self.assertEqual(texts("a && b"), ["a || b"])
        self.assertEqual(texts("a - 1"), ["a + 1", "a - 0", "a - 2"])
        no_code = '#if 1 < 2\n/* 1 + 2 */ f("1 == 2", \'1\', 0x10, 1\'000, T<3u>)'
        self.assertEqual(texts(no_code), [])


if __name__ == "__main__":
    unittest.main()
