#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""scripts/mutate on a tree of one file: what the test looks at is killed, what it does not look at
survives, and the tree itself stays as it was. usage: mutate_test.py SOURCE [unittest options]"""
import json
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
from tiny_tree import tiny_tree  # noqa: E402

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
        self.root = tiny_tree(self, FILES)

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
                         [("killed", tested.format("<= 7;")), ("killed", tested.format("< 8;")),
                          ("killed", tested.format("< 6;"))])
        rest = [v for v in verdicts if "tested(int a)" not in v[1]]
        self.assertEqual([verdict for verdict, _ in rest], ["survived"] * len(rest))
        self.assertIn('a != b ? "a < b"', rest[0][1])
        self.assertIn("3 killed", done.stdout.splitlines()[-1])
        for name, text in FILES.items():
            self.assertEqual((self.root / name).read_text(encoding="utf-8"), text)

    def test_a_script_judges_what_it_runs(self):
        done = self.mutate("tb/results/tiny.cpp", "--count", "0")
        self.assertEqual(done.returncode, 1, done.stdout + done.stderr)
        *verdicts, _ = done.stdout.splitlines()
        killed = [line for line in verdicts if line.startswith("killed ")]
        self.assertEqual([line.rpartition("    ")[2] for line in killed], ["by figures"] * 5,
                         done.stdout)
        survivors = [line for line in verdicts if line not in killed]
        self.assertEqual(len(survivors), 1, done.stdout)
        self.assertRegex(survivors[0], "survived .* return argc < 2 [?] 0 : 2; }")

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

    def campaign(self, *arguments):
        return self.mutate("--all", "--tests", "tiny_test", "--count", "0", "--work", self.work,
                           *arguments)

    def test_a_campaign_resumes_and_its_survivors_are_explained(self):
        scratch = tempfile.TemporaryDirectory(prefix="deburr_tiny_work_")
        self.addCleanup(scratch.cleanup)
        self.work = pathlib.Path(scratch.name)
        (self.root / "docs").mkdir()
        done = self.campaign()
        self.assertEqual(done.returncode, 1, done.stdout + done.stderr)
        found = self.work / "results/local.jsonl"

        def whole(text):
            return [line for line in text.splitlines() if line.endswith("}")]

        lines = whole(found.read_text(encoding="utf-8"))
        self.assertEqual(len(set(lines)), 7, lines)

        # Of a campaign that was killed while it wrote, all but the last line counts.
        found.write_text("\n".join(lines[:3]) + "\n" + lines[3][:20], encoding="utf-8")
        self.assertEqual(self.campaign().returncode, 1)
        again = whole(found.read_text(encoding="utf-8"))
        self.assertEqual(again[:3], lines[:3])
        self.assertEqual(set(again), set(lines))

        self.assertEqual(self.campaign("--again").returncode, 1)
        again = whole(found.read_text(encoding="utf-8"))
        self.assertEqual((len(again), set(again)), (7 + 4, set(lines)))

        page = (self.root / "docs/mutation.md").read_text(encoding="utf-8")
        self.assertIn("| `rtl_model/tiny` | 1 | 7 | 7 | 0 | 3 | 0 | 4 | 42.8 | 42.8 |", page)
        self.assertEqual(self.mutate("--check").returncode, 0)

        survivors = [entry for entry in map(json.loads, lines) if entry["verdict"] == "survived"]
        explained = [{"file": e["file"], "was": e["was"], "is": e["is"], "reason": "tiny"}
                     for e in survivors]
        file = self.root / "tb/mutation/survivors.json"
        file.write_text(json.dumps(explained), encoding="utf-8")
        self.assertEqual(self.mutate("--check").returncode, 1)
        self.assertEqual(self.mutate("--report", "--work", self.work).returncode, 0)
        self.assertEqual(self.mutate("--check").returncode, 0)

        killed = next(e for e in map(json.loads, lines) if e["verdict"] == "killed")
        for wrong, what in (({**explained[0], "is": killed["is"], "was": killed["was"]}, "is killed"),
                            ({**explained[0], "reason": " "}, "by nothing")):
            file.write_text(json.dumps(explained[1:] + [wrong]), encoding="utf-8")
            done = self.mutate("--report", "--work", self.work)
            self.assertEqual(done.returncode, 1)
            self.assertIn(what, done.stderr)
        file.write_text(json.dumps(explained), encoding="utf-8")
        header = self.root / "rtl_model/tiny/tiny.h"
        header.write_text(header.read_text(encoding="utf-8").replace("ready ?", "!ready ?"),
                          encoding="utf-8")
        done = self.mutate("--check")
        self.assertIn("its line is gone", done.stderr)
        self.assertIn("1 files have changed", done.stdout)

    def test_a_switch_does_what_the_text_would(self):
        """Every mutant of functions over small numbers, behind its switch and as it stands."""
        module = self.module()
        source = """#include <string>
inline int pure(int a, int b, int c) { return a < b && b <= c || !(a > c) && (b >= c || a == b); }
inline bool seen(int& n, bool is) { n += 5; return is; }
inline int asked(int a, int b) { int n = 3; const bool is = seen(n, a > 1) && seen(n, a != b) || seen(n, b == 2); return is ? n : b - 1 - n + 2; }
inline int sums(int a, int b) { int s = 4; s += a - 2; s -= b + 1 - a * 2; return s << 1; }
inline std::string texts(int a) { std::string t = "x"; t += "y"; return a + 1 > 1 ? t + "z" : t; }
struct Three { unsigned a : 3; };
inline int odd(int a) { Three t{static_cast<unsigned>(a & 3)}; const int n = a + 2; constexpr int k = 1 + 2; return (t.a == 2) + n + k; }
template <bool is> int chosen(char c) { return is && c != 'b' || c == '"' && c ? 1 : 0; }
inline int both(char c) { return chosen<true>(c) + chosen<false>(c); }
inline bool row(int a, int b, int c) { return a > 1 && b > 1 && c > 1 && a != b || a == 0 || b == 0 && c > 2 || c == 1; }
inline bool lambda(int a) { return [&] { return a > 1 && a < 3; }() || (a ? a == 1 && true : false); }
"""
        call = """for (int a = 0; a < 4; ++a) for (int b = 0; b < 4; ++b) {
  out << asked(a, b) << sums(a, b) << texts(a) << odd(a) << lambda(a)
      << both("ab\\""[a]) << 1e-9;
  for (int c = 0; c < 4; ++c) out << pure(a, b, c) << row(a, b, c); }
"""
        all_of = module.mutants.mutants_of(source)
        plain = ["#include <iostream>\n#include <sstream>\n#include <string>\n"]
        places = frozenset(range(len(all_of)))
        texts = [module.mutants.schema_of(source, 0, places, place) for place in sorted(places)]
        # A mutant that is no program is left out on both sides: - between texts, -= to one.
        possible = [n for n, text in enumerate(texts) if '- "z"' not in text
                    and '-= "y"' not in text]
        for n in possible:
            plain.append(f"namespace m{n} {{\n{texts[n].partition(chr(10))[2]}}}\n"
                         f"void f{n}(std::ostream& out) {{ using namespace m{n}; {call} }}\n")
        plain.append("int main() {" + "".join(f"f{n}(std::cout); std::cout << '\\n';"
                                               for n in possible) + "}\n")
        schema = (module.mutants.schema_of(source, 0)
                  + "#include <iostream>\nint main() { std::ostream& out = std::cout; "
                  + call + "}\n")
        for name, text, flags in (("plain", "".join(plain), []), ("schema", schema, [
                "-include", str(SOURCE / "scripts/mutation/switch.h")])):
            (self.root / f"{name}.cpp").write_text(text, encoding="utf-8")
            subprocess.run(["g++", "-std=c++20", "-w", "-Wno-narrowing", *flags, "-o",
                            self.root / name, self.root / f"{name}.cpp"], check=True)
        wanted = subprocess.run([self.root / "plain"], capture_output=True, text=True,
                                check=True).stdout.splitlines()
        without = subprocess.run([self.root / "schema"], capture_output=True, text=True,
                                 check=True).stdout
        self.assertTrue(any("((a > 1) || (b > 1)) && c > 1" in text for text in texts))
        seen = {}
        for n, line in zip(possible, wanted, strict=True):
            seen[n] = subprocess.run([self.root / "schema"], capture_output=True, text=True,
                                     check=True, env={"DEBURR_MUTANT": str(n)}).stdout
            if "constexpr int k" in source[source.rfind(";", 0, all_of[n].begin):all_of[n].begin]:
                self.assertEqual(seen[n], without, texts[n])
            else:
                self.assertEqual(seen[n], line, texts[n])
        self.assertGreater(len(possible), 60)
        self.assertGreater(sum(text != without for text in seen.values()), 50)

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
                            ("rtl_model/platform/memory_model.cpp", ("platform_",)),
                            ("golden/texture/filter.h",
                             ("golden_texture_", "rtl_texture_equivalence_")),
                            ("golden/morphological/line.cpp", ("golden_morphological_",)),
                            ("golden/ideal/ewa.cpp", ("golden_texture_ideal_", "golden_ideal_"))):
            self.assertEqual(found(file), {name for name in programs if name.startswith(start)},
                             file)
            self.assertTrue(found(file))
        for room in module.ROOMS:
            self.assertTrue(found(f"tb/{room}/file.cpp") or room == "oracle", room)
        self.assertIn("results_result_test", found("tb/results/statistics.cpp"))

    def test_the_operators(self):
        module = self.module()

        def texts(source):
            return [source[:m.begin] + m.text + source[m.end:] for m in module.mutants.mutants_of(source)]

        self.assertEqual(texts("if (!out.can_push(cycle)) return;"), ["if (false) return;"])
        self.assertEqual(texts("a && b"), ["a || b"])
        self.assertEqual(texts("a - 1"), ["a + 1", "a - 2", "a - 0"])
        header = "#ifndef A_H\nstruct A {\n  int a = 0, b = 1;\n  static constexpr int kC = 2;\n};\n"
        self.assertEqual(len(texts(header)), 2, "what members are before they are set is no fault")
        no_code = '#if 1 < 2\n/* 1 + 2 */ f("1 == 2", \'1\', 0x10, 1\'000, 1e-9, T<3u>)'
        self.assertEqual(texts(no_code), [])


if __name__ == "__main__":
    unittest.main()
