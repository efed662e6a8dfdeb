#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""A fifth engine (tool/tests/system/added_engine), which the program is built with and the rest of the repository
does not name: it is run, swept, regressed, completed, soaked and compared with its baselines like the others. The
edits that it needs are counted.

usage: added_engine_test.py DEBURR SOAK SOURCE"""
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../../tb/engines"))
from engine_list import engines  # noqa: E402

HERE = pathlib.Path(__file__).resolve().parent / "added_engine"
NAME = [line for line in (HERE / "engines.txt").read_text(encoding="utf-8").splitlines() if line[:1] != "#"][0]
FOLDER = HERE / "tb/engines" / NAME
DEBURR = SOAK = SOURCE = ""
# Of the tests of every engine, those that name no other engine.
TESTS = {"observers": ["Intervals.test_intervals_of_every_engine_add_up",
                      "Timeline.test_timeline_obeys_rules_and_matches_intervals"],
         "memories": ["Memories.test_defaults_and_presets_are_implementable", "Memories.test_totals_are_sums"],
         "pixel_history": ["PixelHistory.test_engines_without_history_say_so"]}


class Added(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory(prefix="deburr_added_")
        self.addCleanup(scratch.cleanup)
        self.folder = pathlib.Path(scratch.name)

    def call(self, code, *command, says=()):
        done = subprocess.run([str(word) for word in command], cwd=self.folder, text=True, capture_output=True,
                              timeout=300, check=False)
        self.assertEqual(done.returncode, code, f"{command}\n{done.stdout}{done.stderr}")
        for text in [says] if isinstance(says, str) else says:
            self.assertIn(text, done.stdout + done.stderr)
        return done.stdout

    def deburr(self, code, *arguments, says=()):
        return self.call(code, DEBURR, *arguments, says=says)

    def test_run_passes(self):
        self.deburr(0, "run", NAME, "--size", "31x17", "--bits", "2", "--windows", "50", "--maps", "--timeline", "--set",
                    "run.coverage=true", "--out", "out", says="PASS posteriser: 529 outputs")
        result = json.loads((self.folder / "out/result.json").read_text())
        self.assertEqual(result["work"]["levels_pixels"], 31 * 17)
        self.assertEqual(sum(result["coverage"]["bins"].values()), 31 * 17)
        self.assertEqual(set(result["maps"]), {"level"})
        for file in ("after.png", "change.png", "map_level.pfm", "intervals.json", "timeline.json", "report.html"):
            self.assertTrue((self.folder / "out" / file).exists(), file)

    def test_detects_faults(self):
        for fault in ("flip-bit", "wrong-rule", "miscount-pixels", "blind-pixels", "blind-status-registers"):
            self.deburr(1, "run", NAME, "--fault", fault, "--out", "out", says="FAIL mismatch")
        self.deburr(2, "run", NAME, "--fault", "gremlin", says="wrong-rule")
        self.deburr(2, "run", NAME, "--set", "posteriser.bits=9", says="1..8")
        for how in ((), ("--show-config",)):
            self.deburr(2, "run", NAME, "--set", "posteriser.link_depth=3", *how, says="link_depth = 3: must be 1 or an even")
        self.deburr(2, "run", "posterise", says="did you mean 'posteriser'")

    def test_disturbances_change_no_pixel(self):
        for more in ((), ("--stalls", "0.4", "--shuffle"), ("--set", "run.reset_after=200"), ("--set", "run.poison=true")):
            self.deburr(0, "run", NAME, *more, "--out", "out", says="PASS")
            after = (self.folder / "out/after.png").read_bytes()
            self.assertEqual(after, getattr(self, "before", after))
            self.before = after

    def test_sweep_passes(self):
        (self.folder / "levels.yaml").write_text(
            f"engine: {NAME}\nbase: {{picture.width: 16}}\naxes:\n  posteriser.bits: [1, 4, 8]\n"
            "  posteriser.rounding: [truncate, nearest]\n", encoding="utf-8")
        self.deburr(0, "sweep", "levels.yaml", "run", says="6 points, 6 done")

    def test_regression_passes(self):
        (self.folder / "added.yaml").write_text(
            f"include: [{FOLDER / 'smoke.yaml'}]\nfeatures:\n  - id: random-configurations\n    title: Any\n"
            "    checks: {pixels: 100}\n", encoding="utf-8")
        self.deburr(0, "regress", "added.yaml", "run", "--seed", "1", says="24 points, 24 passed")

    # Files of its folder mirror the paths of the repository; CMakeLists.txt mirrors the one in the root.
    def test_adding_it_changes_one_line(self):
        edits = {}
        for file in HERE.rglob("*"):
            path = file.relative_to(HERE).as_posix()
            if file.is_dir() or path in ("CMakeLists.txt", "rtl_model/platform/CMakeLists.txt"):
                continue
            if NAME in path:
                self.assertFalse(os.path.exists(os.path.join(SOURCE, path)), path)
            else:
                lines = file.read_text(encoding="utf-8").splitlines()
                edits[path] = [line for line in lines if line[:1] != "#"]
        self.assertEqual(edits, {"engines.txt": [NAME]})

    def repository(self, *engines_there):
        """A tree whose list has these engines and the added one, with the tests of every engine."""
        root = self.folder / "repository"
        for file in ("tb/engines/engine_list.py", *(f"tool/tests/system/{name}_test.py" for name in TESTS)):
            os.makedirs(root / os.path.dirname(file), exist_ok=True)
            shutil.copy(os.path.join(SOURCE, file), root / file)
        for engine in engines_there:
            os.symlink(os.path.join(SOURCE, "tb/engines", engine), root / "tb/engines" / engine)
        shutil.copytree(FOLDER, root / "tb/engines" / NAME)
        (root / "tb/engines/engines.txt").write_text("".join(f"{engine}\n" for engine in (*engines_there, NAME)))
        return root

    # Selected by its trials.yaml, which may have any part or none.
    def test_tests_of_every_engine_include_it(self):
        root = self.repository(engines()[0])

        def run_tests(name, code=0):
            more = [os.path.join(SOURCE, "docs")] if name == "memories" else []
            self.call(code, root / f"tool/tests/system/{name}_test.py", DEBURR, *more, *TESTS[name])

        for name in TESTS:
            run_tests(name)
        entries = root / "tb/engines" / NAME / "trials.yaml"
        # They do run it: an engine that cannot run fails.
        entries.write_text(f"watched: {{{NAME}: [--size, 0x0]}}\n")
        run_tests("observers", code=1)
        entries.unlink()
        for name in TESTS:
            run_tests(name)

    # Parts that the declaration omits, with working defaults.
    def test_optional_declarations_may_be_omitted(self):
        declared = own = ""
        for header, base, file in (("tb/env/engine_testbench.h", "EngineTestbench", f"tb/engines/{NAME}/{NAME}_testbench.h"),
                                   ("tool/run/engine.h", "Engine", f"tool/engines/{NAME}/{NAME}_engine.cpp")):
            text = pathlib.Path(SOURCE, header).read_text(encoding="utf-8")
            declared += text.split(f"class {base} ")[1].split("\n};")[0]
            own += (HERE / file).read_text(encoding="utf-8")
        functions = dict(re.findall(r"virtual [^;{]*?\b(\w+)\([^;{]*?(= 0;|\{)", declared.replace("const {", "{")))
        functions |= {name: "{" for name in re.findall(r"virtual [^;{=]*?\b(\w+)\([^;{=]*?;", declared)}
        overridden = {name for name in functions if re.search(rf"\b{name}\([^;{{]*override", own)}
        self.assertEqual({name for name, body in functions.items() if body == "= 0;"} - overridden, set())
        self.assertEqual(set(functions) - overridden, {"parts", "clock_mhz", "resolve", "prepare", "built_for_golden",
                                                       "pixel_history", "describe_build"})

    # Its parameters define the work; a comparison knows no engine.
    def test_comparison_finds_different_work(self):
        for folder, size in (("a", "31x17"), ("b", "31x18")):
            self.deburr(0, "run", NAME, "--size", size, "--bits", "2" if folder == "a" else "3", "--out", folder)
        done = subprocess.run([DEBURR, "compare", "a", "b"], cwd=self.folder, text=True, capture_output=True, check=False)
        self.assertIn("picture.height differs: A 17, B 18", done.stderr)
        for name in ("picture.width differs", "posteriser.bits differs"):
            self.assertNotIn(name, done.stderr)

    # With one line in the list, and none in the plan, the repository's own plan includes it.
    def test_plan_for_every_engine_includes_it(self):
        os.makedirs(self.folder / "tb/engines")
        os.symlink(os.path.join(SOURCE, "docs"), self.folder / "docs")
        shutil.copytree(os.path.join(SOURCE, "tb/testplan"), self.folder / "tb/testplan")
        for engine in engines():
            os.symlink(os.path.join(SOURCE, "tb/engines", engine), self.folder / "tb/engines" / engine)
        self.deburr(2, "regress", "tb/testplan/smoke.yaml", "plan", says=f"file 'tb/engines/{NAME}/smoke.yaml' not found")
        os.symlink(FOLDER, self.folder / "tb/engines" / NAME)
        self.deburr(0, "regress", "tb/testplan/smoke.yaml", "plan", "--seed", "1")
        points = next(self.folder.rglob("points.jsonl"), None) or next(self.folder.rglob("points*"))
        self.assertIn("posteriser-levels", points.read_text(encoding="utf-8"))

    # By its role only: after a drawing engine, after an edge smoother, and in every list.
    def test_joins_compositions(self):
        small = ("--size", "32x24", "--out", "out")
        told = self.deburr(0, "params", "frame")
        values = re.search(r"(\S+(?: \| \S+)+)", told[told.index("frame.smoothing"):])[1].split(" | ")
        pair = next(value for value in values if value.endswith(f"-{NAME}"))
        first = pair.removesuffix(f"-{NAME}")
        self.assertEqual([NAME in values, first in values, values[-1]], [True, True, pair])
        for smoothing in (NAME, pair):
            self.deburr(0, "run", "frame", *small, "--smoothing", smoothing, "--set", "posteriser.bits=3", "--stalls", "0.1",
                        says="PASS frame")
            result = json.loads((self.folder / "out/result.json").read_text())
            self.assertEqual(result["work"]["posteriser_levels_pixels"], 32 * 24)
            self.assertGreaterEqual(result["work"]["smoothing_cycles"], 32 * 24)
            self.assertIn("frame_buffer", result["units"])
            self.assertEqual("drawing_cycles" in result["work"], smoothing == pair)
        self.deburr(1, "run", "frame", *small, "--smoothing", NAME, "--fault", "posteriser.flip-bit", says="FAIL mismatch")
        for smoothing in (NAME, pair):
            self.deburr(0, "run", "frame", *small, "--smoothing", smoothing, "--set", "run.reset_after=900", says="PASS frame")
        # If an engine reads no marks, no engine writes them.
        self.assertIn(f"{first}.mark: false", self.deburr(0, "run", "frame", "--smoothing", pair, "--show-config"))
        self.deburr(2, "run", "frame", "--set", "posteriser.bits=3", says=f"frame.smoothing = {values[0]} has no posteriser")
        self.deburr(0, "run", "frame", "--help", says=f" or {pair}")

    def test_parameters_and_pages_include_it(self):
        self.deburr(0, "params", NAME, says=["posteriser.bits", "posteriser.link_depth", "must be 1 or an even"])
        for page, says in (("parameters", f"## `deburr run {NAME}`"), ("registers", "## Posteriser\n"),
                           ("coverage", "## Posteriser: 3 bins"), ("statistics", "`work.levels_changed`"),
                           ("datasheets", "| LevelUnit | 1 | 1 |")):
            self.deburr(0, "params", "--markdown", page, says=says)
        self.deburr(0, "params", "--c-header", says="DEBURR_POSTERISER_CONFIG_BITS_MASK")

    def test_completion_includes_it(self):
        script = self.deburr(0, "completion", "bash")
        self.assertIn(f"'deburr run {NAME}:posteriser.rounding') found='truncate nearest'", script)
        self.assertRegex(script, rf"'deburr run {NAME}:--fault'\) found='[^']*wrong-rule")

    def test_soak_runs_it(self):
        self.call(0, SOAK, "--engines", NAME, "--runs", "6", "--long-every", "6", says=["long run", "RESULT: PASS"])
        self.call(1, SOAK, "--engines", NAME, "--runs", "2", "--set", "run.fault=flip-bit", "--set",
                  "picture.width=32", "--set", "picture.height=24", says="RESULT: FAIL")

    def test_baselines_include_it(self):
        check = os.path.join(SOURCE, "tb/baselines/check.py")
        self.call(0, check, DEBURR, FOLDER, says="0 differences")
        moved = self.folder / NAME
        shutil.copytree(FOLDER, moved)
        record = moved / "baselines.json"
        record.write_text(record.read_text().replace('"cycles":', '"cycles":1', 1))
        self.call(1, check, DEBURR, moved, says="1 of 2 runs differ")


if __name__ == "__main__":
    if len(sys.argv) < 4 or sys.argv[1] in ("-h", "--help"):
        print(__doc__)
        sys.exit(0 if len(sys.argv) >= 2 else 2)
    DEBURR, SOAK, SOURCE = (os.path.abspath(sys.argv.pop(1)) for _ in range(3))
    unittest.main(verbosity=2)
