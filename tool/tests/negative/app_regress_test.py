#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Invalid testplans: each gives a clear error that names its file and line. See --help."""
import html
import json
import os
import re
import resource
import unittest

from app_support import CommandTest

HEAD = """title: Small
features:
  - id: filtering
    title: Filtering
    traces: [docs/unit.md#the-unit]
    stimuli:
      - {name: base, engine: texture, base: {scene: {width: 8, height: 8}}}
    checks: {colours: 1}
"""
UNIT = """# The unit

## Stalls, and why

```
# Code
```
"""


class Testplans(CommandTest):
    def setUp(self):
        super().setUp()
        os.makedirs(self.path("docs"))
        self.write("docs/unit.md", UNIT)

    def reject(self, text, *says, action="plan", code=2):
        self.write("t.yaml", text)
        done = self.expect(code, "regress", "t.yaml", action, "--seed", "1", says=says)
        if action == "plan":
            self.assertFalse(os.path.exists(self.path("out/regressions/t-1/plan.json")), done.stdout)

    def test_valid_plan_is_accepted(self):
        self.write("t.yaml", HEAD)
        self.expect(0, "regress", "t.yaml", "plan", "--seed", "1",
                    says="PASS regression t --seed 1: 1 point over 1 input, 0 already done")

    def test_rejects_unknown_names(self):
        self.reject(HEAD.replace("checks:", "check:"),
                    "t.yaml:8: unknown key 'check': did you mean 'checks'?")
        self.reject(HEAD.replace("engine: texture", "engine: textur"),
                    "t.yaml:7: no engine 'textur': did you mean 'texture'?")
        self.reject(HEAD.replace("{width: 8", "{widht: 8"),
                    "t.yaml:7: unknown parameter 'scene.widht'", "did you mean 'scene.width'")
        self.reject(HEAD.replace("{name: base,", "{name: base, sedes: 3,"),
                    "t.yaml:7: unknown key 'sedes': did you mean 'seeds'?")

    def test_rejects_missing_and_duplicate_keys(self):
        self.reject("title: Small\n", "t.yaml:1: 'features' is missing")
        self.reject(HEAD + "    coverage: []\n", "t.yaml:9: 'coverage' must be a list, got an empty list")
        self.reject("features: []\n", "t.yaml:1: 'features' must be a list, got an empty list")
        self.reject(HEAD.replace("    checks: {colours: 1}\n", ""),
                    "t.yaml:3: 'checks' and 'coverage' are both missing")
        self.reject(HEAD.replace("{colours: 1}", "{}"),
                    "t.yaml:8: 'checks' must be a map of scoreboards to numbers, got an empty map")
        self.reject(HEAD + HEAD[HEAD.index("  - id"):], "t.yaml:9: duplicate feature 'filtering'")
        self.reject(HEAD.replace("    checks", "      - {name: base, engine: texture}\n    checks"),
                    "t.yaml:8: duplicate stimulus 'base'")
        self.reject(HEAD.replace("colours: 1", "colours: 0"), "t.yaml:8: 'colours' = '0' is outside 1..")
        self.reject(HEAD.replace("id: filtering", "id: Filter it"), "t.yaml:3: 'id' = 'Filter it' must consist")

    def test_rejects_heading_of_changed_page(self):
        self.reject(HEAD.replace("docs/unit.md", "docs/units.md"), "t.yaml:5: page 'docs/units.md' not found")
        self.write("docs/unit.md", "# The units\n")
        self.reject(HEAD, "t.yaml:5: 'docs/unit.md' lacks the heading '#the-unit': did you mean 'the-units'?")
        self.write("docs/unit.md", "Nothing.\n")
        self.reject(HEAD, "t.yaml:5: 'docs/unit.md' lacks the heading '#the-unit': check that the feature is still tested")

    def test_rejects_invalid_headings(self):
        for anchor in ("code", "Stalls", "stalls", "It filters."):
            self.reject(HEAD.replace("#the-unit", "#" + anchor), f"t.yaml:5: 'docs/unit.md' lacks the heading '#{anchor}'")
        for anchor in ("", "#"):
            self.reject(HEAD.replace("#the-unit", anchor), f"t.yaml:5: 'traces' = 'docs/unit.md{anchor}' names no heading")
        self.reject(HEAD.replace("docs/unit.md#the-unit", "{page: docs/unit.md, says: It filters.}"),
                    "t.yaml:5: 'traces' no longer takes 'page' and 'says'", "docs/PAGE.md#HEADING")
        self.write("t.yaml", HEAD.replace("#the-unit", "#stalls-and-why"))
        self.expect(0, "regress", "t.yaml", "plan", "--seed", "1")

    def test_rejects_pages_outside_the_documentation(self):
        self.write("other.md", UNIT)
        for page in ("/etc/passwd", "etc/passwd", "other.md", "docs/../other.md", "docs/unit.txt", "docs",
                     self.path("docs/unit.md")):
            self.reject(HEAD.replace("docs/unit.md", page),
                        f"t.yaml:5: 'traces' = '{page}#the-unit' must be a heading of a page")

    def test_rejects_invalid_globs(self):
        self.reject(HEAD + "    coverage: ['texture/[ab]']\n", "t.yaml:9: 'texture/[ab]' is not a glob")
        self.reject(HEAD + "    coverage: ['texture/cash/hit']\n",
                    "t.yaml:9: no bin of the feature's engines matches 'texture/cash/hit'",
                    "did you mean 'texture/cache/hit'")
        self.reject((HEAD + "    coverage: ['geometric/look-up/*']\n").replace("engine: texture", "engine: geometric"),
                    "t.yaml:9: no bin of the feature's engines matches 'geometric/look-up/*'",
                    "did you mean 'geometric/lookup/*'?")
        self.reject(HEAD + "    coverage: ['morphological/*']\n",
                    "t.yaml:9: no bin of the feature's engines matches 'morphological/*'")

    def test_rejects_invalid_globs_of_all_runs(self):
        self.reject(HEAD + "coverage: ['texture/[ab]']\n", "t.yaml:9: 'texture/[ab]' is not a glob")
        self.reject(HEAD + "coverage: [texture/cash/hit]\n",
                    "t.yaml:9: no bin of the plan's engines matches 'texture/cash/hit'",
                    "did you mean 'texture/cache/hit'")
        self.reject(HEAD + "coverage: ['morphological/*']\n",
                    "t.yaml:9: no bin of the plan's engines matches 'morphological/*'")
        self.reject(HEAD + "coverage: [{bins: texture/cache/hit, reason: None.}]\n",
                    "t.yaml:9: 'coverage' must be a list of globs, got a map")
        self.reject(HEAD + "coverage: []\n", "t.yaml:9: 'coverage' must be a list, got an empty list")
        self.reject(HEAD + "unmet: [texture/cache/hit]\n",
                    "t.yaml:9: 'unmet' must be a list of maps of bins and reason, got a single value")
        self.reject(HEAD + "unmet: [{bins: texture/cache/hit}]\n", "t.yaml:9: 'reason' is missing")
        self.reject(HEAD + "unmet: [{bins: texture/cache/hit, reason: ''}]\n", "t.yaml:9: 'reason' must be a text")
        self.reject(HEAD + "unmet: [{reason: None.}]\n", "t.yaml:9: 'bins' is missing")
        self.reject(HEAD + "unmet: [{bins: texture/cash/hit, reason: None.}]\n",
                    "t.yaml:9: no bin of the plan's engines matches 'texture/cash/hit'")
        self.reject(HEAD + "unmet: [{bin: texture/cache/hit, reason: None.}]\n",
                    "t.yaml:9: unknown key 'bin': did you mean 'bins'?")
        self.reject(HEAD + "    unmet: [{bins: texture/cache/hit, reason: None.}]\n", "t.yaml:9: unknown key 'unmet'")
        self.reject(HEAD + "unmet: [{bins: texture/cache/hit, reason: None.}]\n",
                    "t.yaml:9: 'unmet' lists bins of the plan's own 'coverage' (next to 'features'), which is missing")
        self.reject(HEAD + "    coverage: [texture/cache/hit]\nunmet: [{bins: texture/cache/hit, reason: None.}]\n",
                    "t.yaml:10: 'unmet' lists bins of the plan's own 'coverage'")

    def test_unknown_scoreboard_is_a_failed_check(self):
        self.write("t.yaml", HEAD.replace("colours: 1", "colors: 1"))
        why = ("t.yaml:8: no run of this feature has a scoreboard 'colors' (known: colours, figures, line fills, "
               "status registers): did you mean 'colours'?")
        self.expect(1, "regress", "t.yaml", "--seed", "1", says=("1 passed, 0 failed", why))
        with open(self.path("out/regressions/t-1/collected.json")) as file:
            collected = json.load(file)
        self.assertIn(why, collected["features"][0]["checks"][0]["unknown"])
        for name in ("junit.xml", "index.html"):
            with open(self.path("out/regressions/t-1/" + name)) as file:
                self.assertIn(why, html.unescape(file.read()))

    def test_rejects_run_that_the_engine_rejects(self):
        text = HEAD.replace("engine: texture, base: {scene: {width: 8, height: 8}}",
                            "engine: morphological, base: {morphological.preset: mlaa, morphological.quality: low}")
        self.reject(text, "the engine rejects the point")

    def test_rejects_runs_without_checks(self):
        for run in ("run: {check: none, coverage: false}", "run.check: none"):
            self.reject(HEAD.replace("height: 8}}", "height: 8}, " + run + "}"),
                        "has run.check = none: unchecked runs would always pass")

    def test_action_without_plan_uses_default_plan(self):
        self.expect(5, "regress", "plan", says="cannot open 'tb/testplan/smoke.yaml'")
        os.makedirs(self.path("tb/testplan"))
        self.write("tb/testplan/smoke.yaml", HEAD)
        self.expect(0, "regress", "plan", "--seed", "1", says="PASS regression smoke --seed 1: 1 point")
        self.write("plan", HEAD)  # a file of this name wins
        self.expect(0, "regress", "plan", "plan", "--seed", "1", says="PASS regression plan --seed 1: 1 point")

    def test_repro_command_holds_on_another_day(self):
        self.write("t.yaml", HEAD.replace("colours: 1", "colours: 1000000"))
        done = self.expect(1, "regress", "t.yaml", "--quiet")
        seed = re.search(r"RESULT: FAIL regression t --seed (\d+):", done.stdout)[1]
        self.assertRegex(done.stdout, rf"(?m)^REPRO: \S+ regress t.yaml --quiet --seed {seed}$")
        done = self.expect(1, "regress", "t.yaml", "--seed", "5")
        self.assertRegex(done.stdout, r"(?m)^REPRO: \S+ regress t.yaml --seed 5$")

    def test_full_disk_keeps_the_previous_report(self):
        self.write("t.yaml", HEAD)
        self.expect(0, "regress", "t.yaml", "--seed", "1")
        place = self.path("out/regressions/t-1")

        def report():
            files = {}
            for name in os.listdir(place):
                if name in ("junit.xml", "collected.json", "index.html") or name.endswith(".tmp"):
                    with open(os.path.join(place, name)) as file:
                        files[name] = file.read()
            return files
        before = report()
        self.assertEqual(len(before), 3)
        self.write("t.yaml", HEAD.replace("Filtering", "Filtered"))
        self.expect(5, "regress", "t.yaml", "collect", "--seed", "1", says=("cannot write", "index.html"),
                    preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (100_000, 100_000)))
        self.assertEqual(report(), before)
        self.expect(0, "regress", "t.yaml", "collect", "--seed", "1")
        self.assertTrue(all(report()[name] != before[name] for name in ("collected.json", "index.html")))

    def test_rejects_rerun_without_target(self):
        self.write("t.yaml", HEAD)
        self.expect(2, "regress", "t.yaml", "rerun",
                    says="rerun needs --failed: 'rerun --failed' repeats the runs that failed")
        self.expect(2, "regress", "t.yaml", "--failed", says="--failed is only valid with 'rerun'")
        self.expect(5, "regress", "t.yaml", "rerun", "--failed", says="no report of 't' in 'out/regressions'")
        self.expect(5, "regress", "t.yaml", "rerun", "--failed", "--seed", "3",
                    says="no report in 'out/regressions/t-3'")
        self.expect(0, "regress", "t.yaml", "--seed", "4")
        done = self.expect(0, "regress", "t.yaml", "rerun", "--failed")
        self.assertIn("rerun       0 of 0 previously failed runs pass now", done.stdout)
        self.assertIn("RESULT: PASS regression t --seed 4: ", done.stdout)
        self.write("out/regressions/t-4/collected.json", "{}")
        self.expect(5, "regress", "t.yaml", "rerun", "--failed", says="is not a report of this version")

    def test_rejects_invalid_seeds(self):
        self.write("t.yaml", HEAD)
        for seed in ("-1", "18446744073709551616", "1.5", "0x10", "today", " 1", ""):
            for command in (("regress", "t.yaml", "plan"), ("search", "t.yaml")):
                self.expect(2, *command, "--seed", seed,
                            says=f"--seed: '{seed}' is not an integer in 0..18446744073709551615")
        for seed in ("0", "18446744073709551615"):
            self.expect(0, "regress", "t.yaml", "plan", "--seed", seed, says=f"PASS regression t --seed {seed}: 1 point")

    def test_reports_missing_files(self):
        self.expect(5, "regress", "nothing.yaml", "plan", says="cannot open 'nothing.yaml'")
        self.write("t.yaml", HEAD)
        self.expect(5, "regress", "t.yaml", "status", "--seed", "1",
                    says="no plan in 'out/regressions/t-1'")
        self.expect(2, "regress", "t.yaml", "polish", says="polish")
        self.write("t.yaml", "features: [")
        self.expect(2, "regress", "t.yaml", "plan", says="not valid YAML")

    def test_does_not_wait_for_a_pipe(self):
        os.mkfifo(self.path("pipe.yaml"))
        self.expect(5, "regress", "pipe.yaml", "plan", says="cannot read 'pipe.yaml': it is not a regular file")
        self.expect(5, "sweep", "pipe.yaml", "plan", says="cannot read 'pipe.yaml': it is not a regular file")
        self.expect(5, "run", "texture", "--config", "pipe.yaml", says="it is not a regular file")


if __name__ == "__main__":
    unittest.main()
