#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""scripts/mutate on a tree of one file: what the test looks at is killed, what it does not look at
survives, and the tree itself stays as it was. usage: mutate_test.py SOURCE [unittest options]"""
import collections
import json
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest
import unittest.mock

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

    def test_a_script_checks_what_it_runs(self):
        done = self.mutate("tb/results/tiny.cpp", "--count", "0")
        self.assertEqual(done.returncode, 1, done.stdout + done.stderr)
        *verdicts, _ = done.stdout.splitlines()
        killed = [line for line in verdicts if line.startswith("killed ")]
        self.assertEqual([line.rpartition("    ")[2] for line in killed], ["by figures"] * 5,
                         done.stdout)
        survivors = [line for line in verdicts if line not in killed]
        self.assertEqual(len(survivors), 1, done.stdout)
        self.assertRegex(survivors[0], "survived .* return argc < 2 [?] 0 : 2; }")

    def test_tests_that_fail_by_themselves_check_nothing(self):
        (self.root / "tiny_test.cpp").write_text("int main() { return 1; }\n", encoding="utf-8")
        done = self.mutate("rtl_model/tiny/tiny.h", "--tests", "tiny_test")
        self.assertEqual(done.returncode, 2)
        self.assertIn("without any fault", done.stderr)

    def test_wrong_command_lines(self):
        for arguments in (["tiny_test.cpp"], ["rtl_model/none.h"], ["tiny_script.sh"], ["--all"],
                          ["--all", "--each", "-1", "--work", self.root / "../copy"],
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
        (self.root / "docs/measurements").mkdir(parents=True)
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

        page = (self.root / "docs/measurements/mutation.md").read_text(encoding="utf-8")
        self.assertIn("| `rtl_model/tiny` | 1 | 7 | 7 | 0 | 3 | 0 | 4 | 42.8 (42.8 to 42.9) | 42.8 (42.8 to 42.9) |",
                      page)
        self.assertIn("It is missed by `rtl_model/tiny`.", page)
        self.assertRegex(page.replace("\n", " "), r"Of 7 mutants 7 have a verdict [^.]*: 42\.8 \(42\.8 to 42\.9\) % killed")
        self.assertIn("| comparison | 2 | 2 | 0 | 1 | 50.0 (50.0 to 50.0) |", page)
        self.assertEqual(self.mutate("--check").returncode, 0)
        (self.root / "docs/measurements/mutation.md").write_text("", encoding="utf-8")
        self.assertIn("is not made from the record", self.mutate("--check").stderr)
        self.assertEqual(self.mutate("--report").returncode, 1, "from the record alone")
        self.assertEqual((self.root / "docs/measurements/mutation.md").read_text(encoding="utf-8"), page)
        new = self.root / "golden/new.cpp"
        new.parent.mkdir()
        new.write_text("int f() { return 1; }\n", encoding="utf-8")
        done = self.mutate("--check")
        self.assertEqual(done.returncode, 1)
        self.assertIn("golden/new.cpp: 0 of 2 mutants have a verdict, a file needs 2: scripts/mutate", done.stderr)
        new.unlink()
        record = self.root / "tb/mutation/record.json"
        whole_record = json.loads(record.read_text(encoding="utf-8"))
        few = json.loads(record.read_text(encoding="utf-8"))
        few["rtl_model/tiny/tiny.h"]["killed"] -= 1
        record.write_text(json.dumps(few), encoding="utf-8")
        self.assertIn("tiny.h: 6 of 7 mutants have a verdict, a file needs 7", self.mutate("--check").stderr)
        few["rtl_model/tiny/tiny.h"].update(mutants=100, killed=36)
        record.write_text(json.dumps(few), encoding="utf-8")
        self.assertNotIn("a file needs", self.mutate("--check").stderr)
        record.write_text(json.dumps(whole_record), encoding="utf-8")

        survivors = [entry for entry in map(json.loads, lines) if entry["verdict"] == "survived"]
        explained = [{"file": e["file"], "was": e["was"], "is": e["is"], "reason": "tiny"}
                     for e in survivors]
        file = self.root / "tb/mutation/survivors.json"
        file.write_text(json.dumps(explained), encoding="utf-8")
        self.assertEqual(self.mutate("--check").returncode, 1)
        for words in (["init", "-q"], ["-c", "user.name=a", "-c", "user.email=a", "commit", "-q", "--allow-empty", "-m", "a"]):
            subprocess.run(["git", "-C", self.root, *words], check=True)
        self.assertEqual(self.mutate("--report", "--work", self.work).returncode, 0)
        self.assertEqual(self.mutate("--check").returncode, 0)
        commit = subprocess.run(["git", "-C", self.root, "rev-parse", "HEAD"], capture_output=True, text=True, check=True).stdout
        page = (self.root / "docs/measurements/mutation.md").read_text(encoding="utf-8")
        self.assertIn(f"campaigns at `{commit[:12]}` (1 files)", page.replace("\n", " "))

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

    def test_files_that_a_campaign_leaves_out_keep_their_verdicts(self):
        (self.root / "rtl_model/tiny/other.h").write_text("inline bool other() { return true; }\n", encoding="utf-8")
        (self.root / "docs/measurements").mkdir(parents=True)
        record = self.root / "tb/mutation/record.json"
        found = []
        for files in (".*/tiny.h", "rtl_model/tiny/other.*"):
            scratch = tempfile.TemporaryDirectory(prefix="deburr_tiny_work_")
            self.addCleanup(scratch.cleanup)
            self.work = pathlib.Path(scratch.name)
            self.assertEqual(self.campaign("--files", files).returncode, 1)
            found.append(json.loads(record.read_text(encoding="utf-8")))
        tiny, other = "rtl_model/tiny/tiny.h", "rtl_model/tiny/other.h"
        self.assertEqual([found[0][tiny]["killed"], len(found[0][tiny]["survived"])], [3, 4])
        self.assertEqual([found[0][other]["killed"], found[0][other]["survived"]], [0, []])
        self.assertEqual(found[1][tiny], found[0][tiny])
        self.assertEqual(len(found[1][other]["survived"]), 1)
        self.assertEqual(self.campaign("--files", "none.*").returncode, 2)
        self.assertEqual(self.campaign("--files", "(").returncode, 2)

    def test_what_needs_a_build_is_left_out_for_others(self):
        scratch = tempfile.TemporaryDirectory(prefix="deburr_tiny_work_")
        self.addCleanup(scratch.cleanup)
        self.work = pathlib.Path(scratch.name)
        for file, text in (("tested", "inline int two(int a) { return a + 2; }\n"),
                           ("fixed", "constexpr int kTwo = 1 + 1;\ninline int three(int a) { return a + 3; }\n")):
            (self.root / f"rtl_model/tiny/{file}.h").write_text(text, encoding="utf-8")
        (self.root / "tiny_test.cpp").write_text("""#include "rtl_model/tiny/fixed.h"
#include "rtl_model/tiny/tested.h"
int main() { return two(kTwo) == 4 && three(1) == 4 ? 0 : 1; }
""", encoding="utf-8")
        (self.root / "docs/measurements").mkdir(parents=True)
        words = ["--all", "--work", self.work, "--tests", "tiny_test", "--files"]
        self.mutate(*words, ".*/(tested|fixed).h", "--budget", "7", "--count", "1", "--each", "3", "--switched")
        record = json.loads((self.root / "tb/mutation/record.json").read_text(encoding="utf-8"))
        for file, (of, left) in {"tested": (3, 0), "fixed": (8, 5)}.items():
            entry = record[f"rtl_model/tiny/{file}.h"]
            self.assertEqual([entry[name] for name in ("mutants", "left", "killed")], [of, left, 3], file)
        page = (self.root / "docs/measurements/mutation.md").read_text(encoding="utf-8").replace("\n", " ")
        self.assertIn("5 of them would need a build each", page)
        self.assertIn("Tests of at most 7 seconds a mutant were run for 2 of the files", page)
        self.assertNotIn("fixed.h: ", self.mutate("--check").stderr, "it has all that it needs")

        self.mutate(*words, ".*/fixed.h")
        record = json.loads((self.root / "tb/mutation/record.json").read_text(encoding="utf-8"))
        self.assertEqual([record["rtl_model/tiny/fixed.h"][name] for name in ("left", "killed")], [0, 8], "none is left")

    def test_the_longest_tests_come_first_where_asked(self):
        module = self.module()

        class Test:
            source = "a_test"

        for longest, wanted in ((False, ["a", "b", "c"]), (True, ["c", "b", "a"])):
            checker = module.Checker(None, 3, longest)
            checker.tests, checker.seconds = dict.fromkeys("abc", Test), {"a": 1, "b": 2, "c": 4}
            self.assertEqual(checker.ordered(pathlib.PurePath("f.cpp"), "bca", "call"), wanted)

    def test_a_mutant_has_its_budget_and_one_test_at_least(self):
        module = self.module()
        check = sys.modules[module.Checker.__module__]
        test = collections.namedtuple("Test", "name source")
        file = pathlib.PurePath("f.cpp")
        tree = collections.namedtuple("Tree", "mutants")({file: module.mutants.mutants_of("a - 1")})
        for longest, budget, wanted in ((False, 3, "ab"), (False, 0.5, "a"), (True, 5, "ca"), (True, 3, "ba"), (True, 0.5, "a")):
            checker = module.Checker(tree, budget, longest)
            checker.tests = {name: test(name, "a_test") for name in "abc"}
            checker.seconds = {"a": 1, "b": 2, "c": 4}
            asked = []
            with unittest.mock.patch.object(check, "passes", lambda each, *_: asked.append(each.name) or (True, 0, "")):
                self.assertEqual(checker.checked_by(file, 0, "abc").verdict, "survived")
            self.assertEqual("".join(asked), wanted, (longest, budget))

    def test_a_switch_does_what_the_text_would(self):
        """Every mutant of functions over small numbers, behind its switch and as it stands."""
        module = self.module()
        source = """#include <algorithm>
#include <string>
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
inline unsigned bits(unsigned a, unsigned b) { unsigned r = a << b | a >> 1 & 0x5u ^ b; r <<= b; r >>= a & 1; r &= ~a; r |= b; r ^= 0x1; return r; }
inline int limits(int a, int b) { return std::min(a, b) * 64 + std::max<int>(a, 2) * 8 + std::max({a, b, 1}) + std::min({b, 2}); }
struct Held {
  int x = 1, y = 2, z = 3;
  bool set = true;
  void reset(int a) { x = y = z = a; if (a == 2) set = false; else set = true; }
  void go(int a) {
    if (a == 0) return;
    if (a == 1) { ++x; return; }
    for (int i = 0; i < 4; ++i) { if (i == a) break; if (i == 1) continue; y += i; }
    switch ("abcd"[a]) { case 'd': step(); break; case 'c': z += x; default: x -= 1; }
    auto twice = [&](int n) { step(); z += n; };
    twice(a);
  }
  void step() { z = y++; }
  int sum() const { return x + 10 * y + 100 * z + (set ? 1000 : 0); }
};
inline int held(int a, int b) { Held h; h.go(a); int s = h.sum(); h.reset(b); h.go(a); return s * 31 + h.sum(); }
inline int early(int a) { if (a < 1) return 5; try { if (a == 2) throw a; } catch (int n) { return n; } return 7; }
"""
        call = """for (int a = 0; a < 4; ++a) for (int b = 0; b < 4; ++b) {
  out << asked(a, b) << sums(a, b) << texts(a) << odd(a) << lambda(a) << bits(a, b)
      << limits(a, b) << held(a, b) << early(a)
      << both("ab\\""[a]) << 1e-9;
  for (int c = 0; c < 4; ++c) out << pure(a, b, c) << row(a, b, c); }
"""
        all_of = module.mutants.mutants_of(source)
        plain = ["#include <algorithm>\n#include <iostream>\n#include <sstream>\n#include <string>\n"]
        places = frozenset(range(len(all_of)))
        texts = [module.mutants.schema_of(source, 0, places, place) for place in sorted(places)]
        # A mutant that is no program is left out on both sides: - between texts, -= to one.
        possible = [n for n, text in enumerate(texts) if '- "z"' not in text
                    and '-= "y"' not in text]
        for n in possible:
            plain.append(f"namespace m{n} {{\n{texts[n].partition('<string>')[2]}}}\n"
                         f"void f{n}(std::ostream& out) {{ using namespace m{n}; {call} }}\n")
        plain.append("int main() {" + "".join(f"f{n}(std::cout); std::cout << '\\n';"
                                               for n in possible) + "}\n")
        schema = (module.mutants.schema_of(source, 0)
                  + "#include <iostream>\nint main() { std::ostream& out = std::cout; "
                  + call + "}\n")
        for name, text in (("plain", "".join(plain)), ("schema", schema)):
            (self.root / f"{name}.cpp").write_text(text, encoding="utf-8")
            subprocess.run(["g++", "-std=c++20", "-w", "-Wno-narrowing", "-include",
                            SOURCE / "scripts/mutation/switch.h", "-o", self.root / name,
                            self.root / f"{name}.cpp"], check=True)
        wanted = subprocess.run([self.root / "plain"], capture_output=True, text=True,
                                check=True).stdout.splitlines()
        without = subprocess.run([self.root / "schema"], capture_output=True, text=True,
                                 check=True).stdout
        self.assertTrue(any("((a > 1) || (b > 1)) && c > 1" in text for text in texts))
        seen = {}
        for n, line in zip(possible, wanted, strict=True):
            seen[n] = subprocess.run([self.root / "schema"], capture_output=True, text=True,
                                     check=True, env={"DEBURR_MUTANT": str(n)}).stdout
            before = source[source.rfind(";", 0, all_of[n].begin):all_of[n].begin]
            if "constexpr int k" in before or before.endswith("chosen<"):  # the compiler works it out
                self.assertEqual(seen[n], without, texts[n])
            else:
                self.assertEqual(seen[n], line, texts[n])
        self.assertGreater(len(possible), 200)
        self.assertGreater(sum(text != without for text in seen.values()), 180)
        effective = {all_of[n].kind for n, text in seen.items() if text != without}
        self.assertEqual(effective | {"stall"}, set(module.mutants.KINDS), "each kind has an effect")

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

    def texts(self, source, *kinds):
        module = self.module()
        return [source[:m.begin] + m.text + source[m.end:] for m in module.mutants.mutants_of(source)
                if not kinds or m.kind in kinds]

    def test_the_operators(self):
        texts = self.texts
        self.assertEqual(texts("if (!out.can_push(cycle)) return;"), ["if (false) return;"])
        self.assertEqual(texts("a && b"), ["a || b"])
        self.assertEqual(texts("a - 1"), ["a + 1", "a - 2", "a - 0"])
        header = "#ifndef A_H\nstruct A {\n  int a = 0, b = 1;\n  static constexpr int kC = 2;\n};\n"
        self.assertEqual(len(texts(header)), 2, "what members are before they are set is no fault")
        no_code = '#if 1 < 2\n/* 1 + 2 */ f("1 == 2", \'1\', 1\'000, 1e-9, T<3u>)'
        self.assertEqual(texts(no_code), [])

    def test_literals(self):
        self.assertEqual(self.texts("f(true, untrue, false)"), ["f(false, untrue, false)", "f(true, untrue, true)"])
        self.assertEqual(self.texts("struct A {\n  bool a = true;\n  static constexpr bool kB = false;\n};", "literal"),
                         ["struct A {\n  bool a = true;\n  static constexpr bool kB = true;\n};"])
        self.assertEqual(self.texts("std::true_type a; // true"), [])

    def test_hexadecimal_constants(self):
        self.assertEqual(self.texts("a(0x5)"), ["a(0x4)", "a(0x1)"])
        self.assertEqual(self.texts("a(0xFF'00u)"), ["a(0xFF01u)", "a(0x7F00u)"])
        self.assertEqual(self.texts("a(0x1, 0x0)"), ["a(0x0, 0x0)", "a(0x1, 0x1)"])
        self.assertEqual(self.texts("struct A {\n  int a = 0x10, b = 0x20;\n};"), [])
        self.assertEqual(self.texts("a(0x1p3)"), [])

    def test_shifts_and_bits(self):
        self.assertEqual(self.texts("a << b"), ["a >> b"])
        self.assertEqual(self.texts("a >>= b"), ["a <<= b"])
        self.assertEqual(self.texts('out << "a" << b << \'c\';'), [], "texts are written")
        self.assertEqual(self.texts("A<B<int>> f(const C& c, D&& d);"), [])
        self.assertEqual(self.texts("a & b"), ["a | b"])
        self.assertEqual(self.texts("a | b"), ["a & b"])
        self.assertEqual(self.texts("a ^ b"), ["a & b"])
        self.assertEqual(self.texts("a &= b"), ["a |= b"])
        self.assertEqual(self.texts("f(&a, [&] {})"), [])

    def test_min_and_max(self):
        self.assertEqual(self.texts("std::min(a, b)"), ["std::max(a, b)"])
        self.assertEqual(self.texts("std::max<int>(a, b)"), ["std::min<int>(a, b)"])
        self.assertEqual(self.texts("std::max_element(a, b) + std::minmax(a, b)", "min_max"), [])

    def test_what_is_left_out(self):
        def left(body):
            source = f"int f(A& a) {{ {body} }}"
            return [text[14:-2] for text in self.texts(source, "statement", "call", "exit", "reset")]

        self.assertEqual(left("x = 1;"), [";"])
        self.assertEqual(left("*a.b[i](2)->c |= g(x);"), [";"])
        self.assertEqual(left("++x; y--;"), ["; y--;", "++x; ;"])
        self.assertEqual(left("a.b(c); ns::f<int>(d);"), ["; ns::f<int>(d);", "a.b(c); ;"])
        self.assertEqual(left("x = y[i = 1] = z;"), ["y[i = 1] = z;", "x = z;"])
        self.assertEqual(left("if (a) b(); else [[unlikely]] c = 1;"),
                         ["if (a) ; else [[unlikely]] c = 1;", "if (a) b(); else [[unlikely]] ;"])
        self.assertEqual(left("for (i = 0; i < n; ++i) go(i);"), ["for (i = 0; i < n; ++i) ;"])
        self.assertEqual(left("run([&](int b) { go(b); });"), [";", "run([&](int b) { ; });"])
        self.assertEqual(left("const auto b = [] { c(); }(), d = e;"), ["const auto b = [] { ; }(), d = e;"])
        self.assertEqual(left("b = [&] { return c; };"), [";"])
        self.assertEqual(left("switch (a) { case A::kB: c(); break; default: d(); }"),
                         ["switch (a) { case A::kB: ; break; default: d(); }",
                          "switch (a) { case A::kB: c(); ; default: d(); }",
                          "switch (a) { case A::kB: c(); break; default: ; }"])
        self.assertEqual(left("if (a) return 1; if (b) { throw C(); }"),
                         ["if (a) ; if (b) { throw C(); }", "if (a) return 1; if (b) { ; }"])
        # Declarations, what gives a function its value, and initialisers.
        for body in ("int x = 3;", "A b(c);", "auto [b, c] = d();", "A b{c};", "return x = 3;", "throw A();",
                     "static_cast<void>(x);", "const auto g = A{1, {2}};", "using A = B;", "A* b = c();"):
            self.assertEqual(left(body), [], body)
        for source in ("struct A {\n  A();\n  A(const A&) = delete;\n  B b = B();\n};", "int x = f();",
                       "enum class A { kB = 1 };", "A::A() : b_{f()}, c_(g()) {}",
                       "template <class T>\nconcept C = requires(T t) { t.f(); };",
                       "#define A(x) \\\n  void f() { \\\n    x = 1; \\\n  }\n"):
            self.assertEqual(self.texts(source, "statement", "call", "exit", "reset"), [], source)

    def test_resets(self):
        module = self.module()
        source = "void A::reset() {\n  a_ = b_ = 0;\n  for (B& b : c_) b.clear();\n}\nvoid A::go() { a_ = 1; }\n"
        found = [(m.kind, source[m.begin:m.end]) for m in module.mutants.mutants_of(source) if not m.text]
        self.assertEqual(found, [("reset", "a_ = "), ("reset", "b_ = "), ("reset", "b.clear()"),
                                 ("statement", "a_ = 1")])

    def test_samples_are_of_all_mutants(self):
        """Of three files, one of which has most of the mutants."""
        module = self.module()
        drawn = module.campaign.drawn
        all_of = {pathlib.PurePath(name): module.mutants.mutants_of("f(1)\n" * lines)
                  for name, lines in (("a.h", 5), ("b.h", 100), ("c.h", 0))}
        a, b, _ = all_of
        whole = drawn(all_of, 0, 0, 1)
        self.assertEqual(sorted(whole), [(a, n) for n in range(10)] + [(b, n) for n in range(200)])
        some = drawn(all_of, 42, 0, 1)
        self.assertEqual(some, whole[:42], "a larger sample begins with a smaller one")
        self.assertEqual(some, drawn(dict(reversed(all_of.items())), 42, 0, 1))
        self.assertNotEqual(some, drawn(all_of, 42, 0, 2))
        counts = [sum(file == name for seed in range(50) for file, _ in drawn(all_of, 42, 0, seed)) for name in (a, b)]
        self.assertEqual(sum(counts), 42 * 50)
        self.assertTrue(60 <= counts[0] <= 140, f"2 of 42 a draw: {counts}")
        for each, wanted in ((1, 1), (8, 8), (40, 10)):
            more = drawn(all_of, 42, each, 1)
            self.assertEqual(more[:42], some)
            of_a = [place for file, place in more if file == a]
            self.assertEqual((len(of_a), len(set(of_a))), (max(wanted, sum(file == a for file, _ in some)),) * 2)
        self.assertEqual([file for file, _ in drawn(all_of, 42, 45, 1)].count(b), 45)

    def test_estimates(self):
        """In tenths of a percent, by files, with what 95 % of such samples would say, against values worked out apart."""
        estimate = self.module().report.estimate
        for files, wanted in (([(100, 50, 100)], (500, 500, 500)), ([(1000, 36, 40)], (900, 801, 999)),
                              ([(100, 10, 10), (300, 10, 20)], (625, 461, 789)), ([(10, 0, 10), (5, 0, 0)], (0, 0, 0)),
                              ([(7, 3, 7)], (428, 428, 429)), ([(5, 0, 0)], None)):
            self.assertEqual(estimate(files), wanted, files)

    def test_a_record_keeps_what_a_new_one_does_not_know_better(self):
        joined = self.module().report.joined

        def entry(killed, content="a", left=0):
            return {"hash": content, "mutants": 100, "left": left, "killed": killed, "invalid": 0, "survived": []}

        for old, new, kept in ((entry(40), entry(1), "old"), (entry(40), entry(1, "b"), "new"), (entry(40), entry(0, "b"), "old"),
                               (entry(60), entry(40), "new"), (entry(0), entry(0, left=3), "new"),
                               (entry(0, left=3), entry(0), "old"), (entry(5), entry(0, left=100), "old")):
            self.assertIs(joined({"f": old}, {"f": new})["f"], old if kept == "old" else new, (old, new))
        self.assertEqual(list(joined({"gone": entry(1)}, {"f": entry(0)})), ["f"])

    def test_a_page_names_files_without_a_verdict(self):
        entry = {"hash": "a", "mutants": 5, "left": 5, "killed": 0, "invalid": 0, "alone": 0, "survived": []}
        record = {"golden/a/all_left.h": entry, "golden/a/killed.h": {**entry, "left": 4, "killed": 1},
                  "golden/a/nothing.h": {**entry, "mutants": 0, "left": 0}, "golden/a/not_drawn.h": {**entry, "left": 4}}
        page = self.module().report.page_of(self.root, record).replace("\n", " ")
        self.assertIn("each of their mutants needs a build, or no test runs it: `golden/a/all_left.h`.", page)

    def test_a_statement_of_several_lines_stands_in_its_file(self):
        stands_in = self.module().report.stands_in
        source = "  f(1,\n    2);\n  g();\n"
        for statement, stands in (("f(1,\n    2);", True), ("f(1,\n  2);", False), ("g();", True), ("g()", False)):
            self.assertIs(stands_in(source, statement), stands, statement)

    def test_a_verdict_is_not_left_out_by_another_writer(self):
        campaign = self.module().campaign
        folder = self.root / "results"
        folder.mkdir()
        for name, begins in (("left", ("left", "left", "left")), ("local", ("killed", "survived", "left")),
                             ("part_0", ("survived", "invalid", "left")), ("zeta", ("left", "left", "left"))):
            (folder / f"{name}.jsonl").write_text("".join(
                json.dumps({"file": "f", "hash": "a", "begin": n, "kind": "call", "text": ";", "verdict": verdict}) + "\n"
                for n, verdict in enumerate(begins)) + '{"half', encoding="utf-8")
        self.assertEqual([entry["verdict"] for entry in campaign.read_results(self.root)], ["killed", "invalid", "left"])


if __name__ == "__main__":
    unittest.main()
