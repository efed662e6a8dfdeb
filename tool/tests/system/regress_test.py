#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Regressions: an injected fault is found, put into a signature, reproduced and recorded as a wave; seeds follow from
names; kill -9 loses nothing.

usage: regress_test.py DEBURR [CLASS]"""
import glob
import json
import os
import re
import signal
import subprocess
import sys
import tempfile
import time
import unittest
import xml.etree.ElementTree

PAGE = """# The unit

It gives every pixel once, in order.

## Stalls
"""
TESTPLAN = """
title: Small
features:
  - id: filtering
    title: Filtering
    traces: [docs/unit.md#the-unit]
    stimuli:
      - name: scenes
        engine: texture
        base: {scene: {width: 24, height: 16, texture_size: 32}}
        axes: {scene.source: [plane, tunnel]}
        seeds: 3
    checks: {colours: 1000, status registers: 10}
    coverage: [texture/cache/hit, texture/cache/miss]
  - id: anything
    title: Random configurations
    traces: [docs/unit.md#stalls]
    stimuli: [{name: texture, engine: texture, random: true, seeds: 3}]
    checks: {colours: 1}
"""
POINTS = 9
FAULT = """  - id: broken
    title: A injected fault
    traces: [docs/unit.md#stalls]
    stimuli:
      - name: fault
        engine: texture
        base: {scene: {width: 24, height: 16, texture_size: 32}, run.fault: flip-bit}
        seeds: 2
      - name: deadlock
        engine: texture
        base: {scene: {width: 24, height: 16, texture_size: 32}, run.fault: stuck-ready}
    checks: {colours: 1}
"""


class RegressTest(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory(prefix="deburr_regress_")
        self.addCleanup(scratch.cleanup)
        self.directory = scratch.name
        os.makedirs(self.path("docs"))
        os.makedirs(self.path("plans"))
        self.write("docs/unit.md", PAGE)
        self.write("plans/small.yaml", TESTPLAN)

    def path(self, name):
        return os.path.join(self.directory, name)

    def write(self, name, text):
        with open(self.path(name), "w") as file:
            file.write(text)

    def regress(self, *arguments, code=0, name="small", seed="7", says=""):
        done = subprocess.run([DEBURR, "regress", f"plans/{name}.yaml", *arguments, "--seed", seed],
                              cwd=self.directory, text=True, capture_output=True, timeout=600)
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        self.assertIn(says, done.stdout + done.stderr)
        return done.stdout

    def collected(self, name="small", seed="7", out="out"):
        with open(self.path(f"{out}/regressions/{name}-{seed}/collected.json")) as file:
            return json.load(file)

    def points(self, name="small", seed="7", out="out"):
        with open(self.path(f"{out}/regressions/{name}-{seed}/points.jsonl")) as file:
            return [json.loads(line) for line in file]

    def inodes(self):
        return {path: (os.stat(path).st_ino, os.stat(path).st_mtime_ns)
                for path in glob.glob(self.path("out/points/*/*/result.json"))}

    def check_fault(self, passed):
        """Signatures, the command that reproduces each, its waves, the page and JUnit of FAULT, whose three runs fail
        while `passed` others pass."""
        collected = self.collected()
        signatures = {b["kind"]: b for b in collected["signatures"]}
        self.assertEqual({kind: b["runs"] for kind, b in signatures.items()}, {"mismatch": 2, "deadlock": 1})
        self.assertEqual(signatures["mismatch"]["message"], "colours: N mismatches in N comparisons")
        for kind, signature in signatures.items():
            # One line, as the page's button copies it.
            command = signature["example"]["command"]
            self.assertNotIn("\n", command)
            again = subprocess.run(["bash", "-c", command.replace("deburr", f"'{DEBURR}'", 1)],
                                   cwd=self.directory, text=True, capture_output=True)
            self.assertEqual(again.returncode, {"mismatch": 1, "deadlock": 4}[kind], again.stdout)
            self.assertIn(signature["example"]["reason"], again.stdout)
            with open(self.path("out/texture/result.json")) as file:
                alone = json.load(file)
            place = self.path("out/regressions/small-7")
            with open(os.path.join(place, signature["example"]["directory"], "result.json")) as file:
                self.assertEqual(alone["first_mismatches" if kind == "mismatch" else "cycles"],
                                 json.load(file)["first_mismatches" if kind == "mismatch" else "cycles"])
            self.check_waves(os.path.join(place, signature["waves"]["file"]), kind, alone)
        with open(self.path("out/regressions/small-7/index.html")) as file:
            page = file.read()
        self.assertIn(signatures["mismatch"]["waves"]["file"], page)
        self.assertIn(">FAILED</span>", page)
        self.assertIn(f"{passed} of {passed + 3} runs passed, 3 failed; 1 of 6 checks failed;", page)
        root = xml.etree.ElementTree.parse(self.path("out/regressions/small-7/junit.xml")).getroot()
        self.assertEqual(root.get("failures"), "4", "three runs, and colours of the feature")

    def check_waves(self, file, kind, result):
        """Signals change in the interval, and the interval contains the failure."""
        period = round(1e6 / result["clock_mhz"])
        times, changes = [], 0
        with open(file) as vcd:
            for line in vcd:
                if line.startswith("#"):
                    times.append(int(line[1:]))
                elif times and line[0] in "01b":
                    changes += 1
        self.assertGreater(changes, 100)
        if kind == "mismatch":
            cycle = int(result["first_mismatches"][0]["where"].split()[1])
            self.assertLess(times[0], cycle * period)
            self.assertGreater(times[-1], cycle * period)


class Passing(RegressTest):
    def test_everything_is_run_checked_and_covered(self):
        self.assertIn(f"{POINTS} points", self.regress("plan"))
        self.assertIn(f"{POINTS} points, {POINTS} passed, 0 failed", self.regress("-j2"))
        self.assertIn(f"{POINTS} of {POINTS} points done", self.regress("status"))
        before = self.inodes()
        self.regress("run")
        self.assertEqual(self.inodes(), before, "nothing is run twice")
        collected = self.collected()
        self.assertTrue(collected["holds"])
        filtering = collected["features"][0]
        self.assertEqual([filtering[k] for k in ("runs", "passed")], [6, 6])
        self.assertEqual([c["hit"] for c in filtering["coverage"]], [1, 1])
        bins = collected["coverage"]["texture"]
        hits = compared = 0
        for run in collected["runs"]:
            with open(self.path(f"out/points/{run['point'][:2]}/{run['point']}/result.json")) as file:
                result = json.load(file)
            hits += result["coverage"]["bins"]["texture/cache/hit"]
            if run["name"].startswith("filtering/"):
                compared += result["scoreboards"]["colours"]["comparisons"]
        self.assertEqual(bins["hits"]["texture/cache/hit"], hits)
        self.assertEqual(filtering["checks"][0]["comparisons"], compared)
        self.assertEqual(bins["hit"], bins["bins"] - len(bins["holes"]))
        with open(self.path("out/regressions/small-7/index.html")) as file:
            page = file.read()
        self.assertIn("docs/unit.md#the-unit", page)
        self.assertIn(">PASSED</span>", page)
        self.assertIn("9 of 9 runs passed; 0 of 5 checks failed; 0 bins of their coverage were not met.", page)
        self.assertNotRegex(page, r"(src|href)=\"http")
        for hole in bins["holes"][:3]:
            self.assertIn(hole, page)
        suites = xml.etree.ElementTree.parse(self.path("out/regressions/small-7/junit.xml")).getroot()
        self.assertEqual(suites.get("failures"), "0")
        self.assertEqual(len(suites.findall(".//testcase")), POINTS + 5)

    def test_seeds_follow_from_base_seed_and_name(self):
        self.regress("plan")
        self.regress("plan", "--out", "again")
        self.regress("plan", seed="8")
        self.assertEqual(self.points(), self.points(out="again"))
        other = self.points(seed="8")
        self.assertEqual([p[3:7] for p in self.points()], [p[3:7] for p in other])
        self.assertFalse({p[0] for p in self.points()} & {p[0] for p in other})
        # A new first feature changes no seed.
        alone = TESTPLAN[:TESTPLAN.index("  - id: filtering")] + TESTPLAN[TESTPLAN.index("  - id: anything"):]
        self.write("plans/alone.yaml", alone)
        self.regress("plan", name="alone")
        self.assertEqual([p[0] for p in self.points(name="alone")],
                         [p[0] for p in self.points() if p[3] == "anything"])

    def test_partial_plan_has_runs_of_the_whole(self):
        """One seed in two: the runs are a subset of the whole plan's, and fewer comparisons are required."""
        self.write("plans/small.yaml", TESTPLAN.replace("colours: 1000", "colours: 2000"))
        said = self.regress("-j2", "--divide", "2")
        self.assertIn("regression small-of-2 --seed 7: 6 points, 6 passed", said)
        part = self.points(name="small-of-2")
        before = self.inodes()
        self.regress("-j2")
        self.assertLess({point[0] for point in part}, {point[0] for point in self.points()})
        after = self.inodes()
        self.assertEqual({path: after[path] for path in before}, before, "no run of the part again")
        for name, divisor, minimum in (("small-of-2", 2, 1000), ("small", 1, 2000)):
            collected = self.collected(name=name)
            self.assertEqual(collected["divisor"], divisor)
            self.assertEqual(collected["features"][0]["checks"][0]["minimum"], minimum)

    def test_changed_plan_keeps_unchanged_runs(self):
        self.regress("-j2")
        before = self.inodes()
        self.write("plans/small.yaml", TESTPLAN.replace("seeds: 3", "seeds: 4"))
        changed = "changed     'plans/small.yaml' since the plan was made: "
        status = self.regress("status")
        self.assertIn(changed + "these figures are from before the change", status)
        self.assertIn(f"{POINTS} of {POINTS} points done", status)
        collected = self.regress("collect", code=3)
        self.assertIn(changed + "unchanged points keep their results", collected)
        self.assertIn(f"{POINTS + 3} points, {POINTS} passed, 0 failed in 0 signatures, 3 missing", collected)
        # No run failed, and the results are checked and covered: only the missing runs count.
        report = self.collected()
        self.assertEqual([report["counts"][k] for k in ("failed", "failed_checks", "holes")], [0, 0, 0])
        self.assertEqual([(f["missing"], f["holds"]) for f in report["features"]], [(2, False), (1, False)])
        self.assertFalse(report["holds"])
        with open(self.path("out/regressions/small-7/index.html")) as file:
            page = file.read()
        self.assertIn(">FAILED</span>", page)
        self.assertEqual(page.count(">does not hold</span>"), 2)
        self.assertNotIn("changed  ", self.regress("status"))
        self.regress("run")
        after = self.inodes()
        self.assertEqual(len(after), POINTS + 3)
        self.assertEqual({path: after[path] for path in before}, before, "what was there stayed")

    def test_other_model_keeps_the_last_report(self):
        self.regress("-j2")
        report = self.collected()
        path = self.path("out/regressions/small-7/plan.json")
        with open(path) as file:
            plan = json.load(file)
        with open(path, "w") as file:
            json.dump({**plan, "model": "another"}, file)
        self.assertIn("changed     the model since", self.regress("status"))
        self.regress("collect", code=2, says="are from another version of the model")
        self.assertEqual(self.collected(), report)
        self.assertIn("earlier results are not used", self.regress("run"))
        self.regress("collect")

    def test_all_runs_together_meet_the_plan(self):
        alone = TESTPLAN[:TESTPLAN.index("  - id: anything")]
        formats = [f"texture/format/{name}" for name in (
            "bc1", "bc3", "bc4", "bc5", "etc2_rgb", "etc2_rgb_a1", "etc2_rgba8", "l8", "rgb565", "rgba4444", "srgb8_a8")]
        luminance = "texture/format/l8"
        others = [name for name in formats if name != luminance]
        demand = "coverage: ['texture/format/*', texture/cache/hit]\n"
        self.write("plans/small.yaml", alone + demand)
        said = self.regress("-j2", code=1)
        self.assertRegex(said, "(?m)^broken      all runs: texture/format/\\*: 11 of 12 bins were not met: " +
                         ", ".join(formats) + "$")
        self.assertNotIn("broken      filtering", said)
        report = self.collected()
        self.assertEqual([(c["glob"], c["hit"], c["holes"]) for c in report["whole"]["coverage"]],
                         [("texture/format/*", 1, formats), ("texture/cache/hit", 1, [])])
        self.assertEqual([report["holds"], report["counts"]["failed_checks"], report["counts"]["holes"]], [False, 1, 11])
        root = xml.etree.ElementTree.parse(self.path("out/regressions/small-7/junit.xml")).getroot()
        self.assertEqual([(suite.get("name"), suite.get("failures")) for suite in root], [("filtering", "0"), ("all runs", "1")])
        with open(self.path("out/regressions/small-7/index.html")) as file:
            self.assertIn("texture/format/*: 1 of 12 bins, not met:", file.read())
        # For part of the seeds one bin is enough.
        self.regress("-j2", "--divide", "3")
        # Only exceptions are named, with their reasons.
        unmet = "unmet:\n" + "".join(f"  - {{bins: {name}, reason: No scene has it.}}\n" for name in others)
        self.write("plans/small.yaml", alone + demand + unmet)
        self.assertIn(f"1 of 2 bins were not met: {luminance}\n", self.regress(code=1))
        self.write("plans/small.yaml", alone + demand + unmet + "  - {bins: 'texture/format/*8', reason: No scene has that.}\n")
        said = self.regress(code=1)
        self.assertIn("met         texture/format/rgba8, which the testplan lists as unmet: No scene has that.", said)
        self.assertIn("no run of the plan has a bin 'texture/format/*'", said)
        self.write("plans/small.yaml", alone + demand + unmet + "  - {bins: texture/format/l8, reason: No scene has that.}\n")
        self.assertNotIn("met         ", self.regress())
        report = self.collected()
        self.assertTrue(report["holds"])
        self.assertEqual(report["whole"]["coverage"][0]["bins"], 1)
        self.assertEqual([(u["bin"], u["reason"], u["hits"]) for u in report["whole"]["unmet"]],
                         [(name, "No scene has it.", 0) for name in others] + [(luminance, "No scene has that.", 0)])
        with open(self.path("out/regressions/small-7/index.html")) as file:
            self.assertIn("texture/format/l8: No scene has that.", file.read())

    def test_included_file_adds_requirements_on_all_runs(self):
        start = TESTPLAN.index("  - id: filtering")
        part = ("features:\n" + TESTPLAN[start:TESTPLAN.index("  - id: anything")] +
                "coverage: ['texture/format/*']\nunmet: [{bins: texture/format/l8, reason: None.}]\n")
        self.write("plans/small.yaml", "include: [part.yaml]\n")
        self.write("plans/part.yaml", part.replace("format/l8", "format/l9"))
        self.regress("plan", code=2, says="no bin of the plan's engines matches 'texture/format/l9'")
        self.write("plans/part.yaml", part)
        self.assertIn("broken      all runs: texture/format/*: 10 of 11 bins", self.regress("-j2", code=1))

    def test_night_is_a_line_of_the_trend(self):
        self.regress("-j2")
        night, = self.nights()
        report = self.collected()
        self.assertEqual([night[key] for key in ("seed", "commit", "holds", "runs", "passed")],
                         [7, report["commit"], True, POINTS, POINTS])
        self.assertRegex(night["date"], r"^20\d\d-[01]\d-[0-3]\d$")
        texture = report["coverage"]["texture"]
        self.assertEqual([night["bins"], night["met"]], [texture["bins"], texture["hit"]])
        cycles = 0
        for path in self.inodes():
            with open(path) as file:
                cycles += json.load(file)["cycles"]
        self.assertEqual(night["cycles"], cycles)
        self.assertEqual(night["seconds"], report["counts"]["simulated_seconds"])
        self.regress("collect")
        self.assertEqual(self.nights(), [night], "one of each seed and commit")
        with open(self.path("out/regressions/small-7/index.html")) as file:
            self.assertNotIn("Trend over", file.read())
        os.remove(min(self.inodes()))
        self.regress("collect", code=3)
        self.assertEqual(self.nights(), [night], "of which no run is missing")
        self.regress("run", seed="8")
        self.assertEqual([n["seed"] for n in self.nights()], [7, 8])
        self.regress("run")
        self.assertEqual([n["seed"] for n in self.nights()], [8, 7], "the last one is at the end")
        self.write("out/regressions/small.jsonl", '{"date": "2026-11-23"}\n')
        self.regress("collect", code=5, says="line 1 is not an entry of this version")

    def nights(self, name="small"):
        with open(self.path(f"out/regressions/{name}.jsonl")) as file:
            return [json.loads(line) for line in file]

    def test_too_few_checks_fail(self):
        self.write("plans/small.yaml", TESTPLAN.replace("colours: 1000", "colours: 1000000"))
        self.assertRegex(self.regress(code=1), r"colours: 2,\d\d\d comparisons of 1,000,000")
        self.write("plans/small.yaml", TESTPLAN.replace("texture/cache/hit,", "texture/tent/*,"))
        self.assertIn("bins were not met", self.regress(code=1))
        root = xml.etree.ElementTree.parse(self.path("out/regressions/small-7/junit.xml")).getroot()
        self.assertEqual([case.get("name") for case in root.iter("testcase")
                          if case.find("failure") is not None], ["coverage: texture/tent/*"])


class Failing(RegressTest):
    def test_fault_is_found_sorted_reproduced_and_recorded(self):
        self.write("plans/small.yaml", TESTPLAN + FAULT)
        out = self.regress("-j2", code=1)
        self.assertIn(f"{POINTS} passed, 3 failed in 2 signatures, 0 missing", out)
        self.check_fault(POINTS)
        # The command that reproduces it is the example of the largest signature, and of no other.
        repro = out[out.index("REPRO: "):].splitlines()[0].removeprefix("REPRO: ")
        self.assertEqual(repro.removeprefix(DEBURR), self.collected()["signatures"][0]["example"]["command"].removeprefix("deburr"))
        before = self.inodes()
        self.regress("run", code=1)
        self.assertEqual(self.inodes(), before, "neither failures nor waves are made again")

    def test_worse_night_is_reported(self):
        self.assertNotIn("fell", self.regress("-j2", seed="6"))
        self.write("plans/small.yaml", TESTPLAN + FAULT)
        said = self.regress("-j2", code=1)
        self.assertRegex(said, r"(?m)^fell        pass rate from 100\.0 % to 75\.0 %$")
        page = self.page()
        self.assertIn("Trend over 2 nights", page)
        rows = re.findall(r"<tr[^>]*><td>20\d\d-.*?</tr>", page)
        self.assertEqual([re.sub("<.*?>", " ", row).split()[1] for row in rows], ["7", "6"])
        self.assertIn('class="broken"', rows[0])
        self.assertIn("pass rate from 100.0 % to 75.0 %", rows[0])
        self.assertNotIn("broken", rows[1])
        drawn = json.loads(re.search(r'id="data">(.*?)</script>', page)[1])["trend"]
        self.assertEqual([night["passed"] for night in drawn], [100, 75])
        self.assertEqual([night["passed"] for night in self.collected()["trend"]], [POINTS, POINTS])

    def test_page_has_no_dead_links_and_no_empty_sections(self):
        """A run that cannot read its texture leaves no result and no coverage."""
        self.write("bad.png", "no picture")
        unread = """  - id: unread
    title: A texture that cannot be read
    traces: [docs/unit.md#stalls]
    stimuli: [{name: bad, engine: texture, base: {scene: {width: 24, height: 16, texture: bad.png}}}]
    checks: {colours: 1}
"""
        self.write("plans/small.yaml", TESTPLAN + FAULT + unread)
        self.assertIn("failed in 3 signatures", self.regress("-j2", code=1))
        page = self.page()
        self.assertIn("Coverage of all runs", page)
        self.assertEqual(page.count(">result.json</a>"), 2)
        self.write("plans/alone.yaml", "title: Alone\nfeatures:\n" + unread)
        self.regress("-j2", code=1, name="alone")
        page = self.page("alone")
        self.assertNotIn("Coverage of all runs", page)
        self.assertNotIn(">result.json</a>", page)
        self.assertRegex(page, "<h1>Alone <span")

    def page(self, name="small"):
        place = self.path(f"out/regressions/{name}-7")
        with open(os.path.join(place, "index.html")) as file:
            page = file.read()
        for link in re.findall(r'href="([^"#]*)"', page):
            self.assertTrue(os.path.exists(os.path.join(place, link)), link)
        self.assertEqual(page.count("<table"), page.count('class="scroll"><table'), "none is wider than a phone")
        self.assertNotRegex(page, r'<canvas id="[^"]*">', "each chart says in words what it shows")
        self.assertNotRegex(page, r"<(ul|tbody|section)[^>]*>\s*</")
        return page

    def test_failed_runs_are_repeated_by_one_command(self):
        self.write("plans/small.yaml", TESTPLAN + FAULT)
        self.regress("-j2", code=1)
        failed = {point[0] for point in self.points() if point[3] == "broken"}
        before = self.inodes()
        again = self.rerun(code=1)
        self.assertIn("rerun       0 of 3 previously failed runs pass now, 3 fail\n", again)
        self.assertIn(f"RESULT: FAIL regression small --seed 7: {POINTS + 3} points, {POINTS} passed, 3 failed", again)
        changed = {os.path.basename(os.path.dirname(path)) for path, inode in self.inodes().items()
                   if before.get(path) != inode}
        self.assertEqual(changed, failed)
        # If other runs lack a result, the report is the previous one, and the verdict covers only these runs.
        os.remove(next(path for path in before if os.path.basename(os.path.dirname(path)) not in failed
                       and os.path.basename(os.path.dirname(path)) in {point[0] for point in self.points()}))
        report = self.collected()
        again = self.rerun(code=1)
        self.assertRegex(again,
                         r"RESULT: FAIL regression small --seed 7: 0 of 3 previously failed runs pass now, 3 fail;")
        self.assertRegex(again, r"(?m)^failed      broken/fault/base/0: mismatch: ")
        self.assertEqual(self.collected(), report)
        # Without the fault they are other points with the same names.
        self.write("plans/small.yaml", TESTPLAN + FAULT.replace(", run.fault: flip-bit", "")
                   .replace(", run.fault: stuck-ready", ""))
        again = self.rerun()
        self.assertIn(
            "RESULT: PASS regression small --seed 7: 3 of 3 previously failed runs pass now, 0 fail; other", again)
        self.regress("run", "-j2")
        self.assertIn("rerun       0 of 0 previously failed runs pass now, 0 fail\n", self.rerun())
        self.assertEqual(self.collected()["counts"]["failed"], 0)

    def test_fixed_runs_make_the_report_pass(self):
        mended = FAULT.replace(", run.fault: flip-bit", "").replace(", run.fault: stuck-ready", "")
        self.write("plans/small.yaml", TESTPLAN + FAULT)
        self.regress("-j2", code=1)
        self.write("plans/small.yaml", TESTPLAN + mended)
        again = self.rerun("-j2")
        self.assertIn("rerun       3 of 3 previously failed runs pass now, 0 fail\n", again)
        self.assertIn(f"RESULT: PASS regression small --seed 7: {POINTS + 3} points, {POINTS + 3} passed, 0 failed", again)
        self.assertTrue(self.collected()["holds"])

    def test_rerun_uses_the_last_report(self):
        self.write("plans/small.yaml", TESTPLAN + FAULT)
        for seed in ("9", "7"):
            self.regress("-j2", code=1, seed=seed)
        os.utime(self.path("out/regressions/small-9/collected.json"), (1, 1))
        out = self.rerun(code=1)
        self.assertIn("regression small --seed 7: ", out)
        self.write("plans/small.yaml", TESTPLAN)
        out = self.rerun("--seed", "9")
        self.assertIn("gone        broken/fault/base/0: the testplan no longer has this run", out)

    def rerun(self, *arguments, code=0):
        done = subprocess.run([DEBURR, "regress", "plans/small.yaml", "rerun", "--failed", *arguments],
                              cwd=self.directory, text=True, capture_output=True, timeout=600)
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return done.stdout


class Killed(RegressTest):
    def test_kill_9_loses_nothing(self):
        text = TESTPLAN.replace("seeds: 3\n    checks: {colours: 1000", "seeds: 12\n    checks: {colours: 1000")
        self.write("plans/small.yaml", text)
        self.write("plans/whole.yaml", text)
        for moment in (0.3, 0.8):
            process = subprocess.Popen([DEBURR, "regress", "plans/small.yaml", "--seed", "7", "-j2"],
                                       cwd=self.directory, stdout=subprocess.DEVNULL,
                                       stderr=subprocess.DEVNULL)
            time.sleep(moment)
            process.send_signal(signal.SIGKILL)
            process.wait()
            time.sleep(0.5)  # its children end
        before = self.inodes()
        self.assertIn("27 passed", self.regress("-j2"))
        after = self.inodes()
        self.assertEqual({path: after[path] for path in before}, before, "what was there stayed")
        self.regress("--out", "other", name="whole", seed="7")
        names = {os.path.basename(os.path.dirname(p)) for p in after}
        self.assertEqual(names, {os.path.basename(os.path.dirname(p))
                                 for p in glob.glob(self.path("other/points/*/*/result.json"))})


if __name__ == "__main__":
    if len(sys.argv) < 2 or sys.argv[1] in ("-h", "--help"):
        print(__doc__)
        sys.exit(0 if len(sys.argv) >= 2 else 2)
    DEBURR = os.path.abspath(sys.argv.pop(1))
    unittest.main()
