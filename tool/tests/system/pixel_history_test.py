#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""The history of a pixel (deburr run ENGINE --pixel X,Y), for every engine whose trials.yaml has `followed`.

usage: pixel_history_test.py DEBURR"""
import json
import os
import re
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../../tb/engines"))
from engine_list import engines, trials  # noqa: E402


CUT_SHORT = 3  # exit code of --max-cycles


class PixelHistory(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory(prefix="deburr_pixel_")
        self.addCleanup(scratch.cleanup)
        self.directory = scratch.name

    def run_engine(self, engine, *arguments, code=0):
        self.out = os.path.join(self.directory, "out")
        done = subprocess.run([DEBURR, "run", engine, *arguments, "--out", self.out], text=True,
                              capture_output=True, timeout=300)
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        self.said = done.stdout + done.stderr
        if code == 2:
            return None
        with open(os.path.join(self.out, "report.html"), encoding="utf-8") as file:
            self.page = file.read()
        with open(os.path.join(self.out, "result.json"), encoding="utf-8") as file:
            return json.load(file)

    def followed(self):
        for engine, entry in trials("followed").items():
            with self.subTest(engine=engine):
                yield engine, entry["run"], "{},{}".format(*entry["pixel"]), entry

    def test_every_step_has_both_sides(self):
        for engine, run, pixel, entry in self.followed():
            result = self.run_engine(engine, *run, "--no-images", "--pixel", pixel)
            history = result["pixel"]
            self.assertEqual([history["x"], history["y"]], entry["pixel"])
            self.assertEqual((history["differences"], history["note"]), (0, ""))
            both = {step["step"] for step in history["steps"] if step["golden"] and step["hardware"]}
            self.assertLessEqual(set(entry["steps"]), both)
            for step in history["steps"]:
                self.assertFalse(step["differs"], step)
            cycles = [step["clock"] for step in history["steps"] if step["clock"] is not None]
            self.assertGreater(len(cycles), 2)
            self.assertEqual(history["steps"][-1]["step"], "colour")
            self.assertEqual(history["steps"][-1]["clock"], max(cycles))
            self.assertIn(f"pixel       ({pixel.replace(',', ', ')}): {len(history['steps'])} steps, 0 of them differ",
                          self.said)
            self.assertIn(f'<h2 id="pixel">History of pixel {pixel}</h2>', self.page)
            for step in history["steps"]:
                self.assertIn(f">{step['item']}</td>", self.page.replace("<wbr>", ""))
            waves = re.search(r'id="pixel-waves">(.*?)</pre>', self.page).group(1)
            self.assertIn(f"--trace-from {min(cycles)} --trace-to {max(cycles) + 2}", waves)

    def test_history_changes_nothing(self):
        for engine, run, pixel, _ in self.followed():
            plain = self.run_engine(engine, *run, "--no-images")
            self.assertNotIn("pixel", plain)
            self.assertNotIn('id="pixel"', self.page)
            watched = self.run_engine(engine, *run, "--no-images", "--pixel", pixel)
            for key in ("cycles", "work", "units", "memory", "checks"):
                self.assertEqual(plain[key], watched[key], key)

    def test_without_golden_only_hardware_steps(self):
        for engine, run, pixel, entry in self.followed():
            steps = self.run_engine(engine, *run, "--no-images", "--check", "none", "--pixel", pixel)["pixel"]["steps"]
            seen = {step["step"] for step in steps if step["hardware"]}
            self.assertLessEqual(set(entry["steps"]), seen)
            self.assertFalse(any(step["differs"] for step in steps))

    # The row of a mismatch leads to its pixel, where the wrong step is marked.
    def test_mismatch_leads_to_its_pixel(self):
        for engine, run, _, entry in self.followed():
            fault = ["--fault", entry["fault"]]
            result = self.run_engine(engine, *run, *fault, code=1)
            pixels = re.findall(r'href="#follow-(\d+,\d+)"', self.page)
            self.assertTrue(pixels, result["first_mismatches"])
            self.assertIn(pixels[0].replace(",", ", "), str(result["first_mismatches"]))
            history = self.run_engine(engine, *run, *fault, "--pixel", pixels[0], code=1)["pixel"]
            self.assertGreater(history["differences"], 0)
            wrong = next(step for step in history["steps"] if step["differs"])
            self.assertNotEqual(wrong["golden"], wrong["hardware"])
            self.assertIn('<tr class="differs">', self.page)
            self.assertIn('<a href="#pixel">below</a>', self.page)

    # Steps missing on one side are marked as well. After an added record, records are compared with their neighbours,
    # so the first mismatch names both pixels: the expected one and the actual one.
    def test_lost_and_added_records_differ(self):
        for engine, run, _, entry in self.followed():
            for fault in entry["lost_or_added"]:
                with self.subTest(fault=fault):
                    broken = [*run, "--fault", fault, "--set", "run.check_links=false"]
                    result = self.run_engine(engine, *broken, code=1)
                    came = re.search(r"\bx=(\d+) y=(\d+)", result["first_mismatches"][0]["got"])
                    pixels = list(dict.fromkeys(re.findall(r'href="#follow-(\d+,\d+)"', self.page)))[:2]
                    pixels += [",".join(came.groups())] if came else []
                    steps = [step for pixel in pixels
                             for step in self.run_engine(engine, *broken, "--pixel", pixel, code=1)["pixel"]["steps"]]
                    self.assertTrue([step for step in steps
                                     if step["differs"] and not (step["golden"] and step["hardware"])], steps)

    def test_pixel_outside_the_frame(self):
        for engine, run, _, _ in self.followed():
            for given, says in (("100000,3", ["run.pixel = 100000,3 is outside of the picture of", "a column of 0.."]),
                                ("12", ["run.pixel: expected X,Y", "got '12'"])):
                for more in ((), ("--show-config",)):
                    self.run_engine(engine, *run, "--pixel", given, *more, code=2)
                    for word in says:
                        self.assertIn(word, self.said)

    # The program accepts --pixel for exactly the engines that these tests follow.
    def test_engines_with_history_are_tested(self):
        kept = set()
        for engine in engines():
            done = subprocess.run([DEBURR, "run", engine, "--size", "32x32", "--pixel", "3,4", "--show-config"], text=True,
                                  capture_output=True, timeout=300)
            if done.returncode == 0:
                kept.add(engine)
            else:
                self.assertIn(f"the engine {engine} does not record the history of a pixel", done.stdout + done.stderr)
        self.assertTrue(kept)
        self.assertEqual(kept, {*trials("followed"), *trials("followed_in_parts")})

    def test_engines_without_history_say_so(self):
        for engine in set(engines()) - set(trials("followed")):
            with self.subTest(engine=engine):
                of_parts = trials("followed_in_parts").get(engine, False)
                result = self.run_engine(engine, "--no-images", "--size", "32x32", "--pixel", "3,4", code=0 if of_parts else 2)
                if of_parts:
                    self.assertIn("pixel", result)
                else:
                    self.assertIn(f"the engine {engine} does not record the history of a pixel", self.said)

    # Steps of each part; a fault in one part leaves the others unchanged.
    def test_parts_are_independent(self):
        for engine, entry in trials("followed_in_parts").items():
            run, pixel = [engine, *entry["run"]], "{},{}".format(*entry["pixel"])
            history = self.run_engine(*run, "--no-images", "--pixel", pixel)["pixel"]
            self.assertEqual((history["differences"], history["note"]), (0, ""))
            both = {(step["part"].split()[0], step["step"]) for step in history["steps"]
                    if step["golden"] and step["hardware"]}
            self.assertLessEqual(set(entry["steps"].items()), both)
            fault = ["--fault", entry["fault"], "--no-images"]
            self.run_engine(*run, *fault, code=1)
            wrong = re.search(r'href="#follow-(\d+,\d+)"', self.page).group(1)
            history = self.run_engine(*run, *fault, "--pixel", wrong, code=1)["pixel"]
            self.assertEqual({step["part"] for step in history["steps"] if step["differs"]}, {entry["fault"].split(".")[0]})

    # The lookups come from another instrument.
    def test_lookups_match_the_trace(self):
        steps = self.run_engine("texture", "--size", "32x32", "--no-images", "--pixel", "9,20", "--line-trace", "text",
                                "--set", "run.line_trace_lookups=true")["pixel"]["steps"]
        with open(os.path.join(self.out, "lines.trace"), encoding="utf-8") as file:
            trace = {tuple(line.split()[:3]) for line in file if not line.startswith("#")}
        lines = [step for step in steps if step["item"] == "line"]
        self.assertGreater(len(lines), 0)
        for step in lines:
            address, outcome = step["hardware"].split()
            self.assertIn((str(step["clock"]), outcome, f"{int(address, 16):#010x}"), trace)

    # Reasons for an incomplete history, or one without weights.
    def test_notes_give_reasons(self):
        for engine, run, _, entry in self.followed():
            for note in entry["notes"]:
                with self.subTest(engine=engine, note=note["says"]):
                    cut = ["--max-cycles", str(note["cycles"])] if "cycles" in note else []
                    history = self.run_engine(engine, *run, "--pixel", ",".join(map(str, note["pixel"])), *cut,
                                              code=CUT_SHORT if cut else 0)["pixel"]
                    self.assertTrue(history["note"].startswith(note["says"]), history["note"])
                    self.assertEqual(history["differences"], 0)

    # All fragments of a pixel, including hidden ones; none if absent.
    def test_lists_all_fragments(self):
        run = ["--scene", "object", "--size", "64x64", "--no-images", "--set", "scene.visibility=overdraw"]
        parts = set()
        for pixel in ("32,32", "30,20", "36,40"):
            history = self.run_engine("texture", *run, "--pixel", pixel)["pixel"]
            parts |= {step["part"] for step in history["steps"]}
        self.assertIn("fragment 0", parts)
        sky = self.run_engine("texture", *run, "--pixel", "0,0")["pixel"]
        self.assertEqual((sky["steps"], sky["note"]), ([], "no fragment of a texture covers it"))


if __name__ == "__main__":
    DEBURR = os.path.abspath(sys.argv[1])
    unittest.main(argv=[sys.argv[0], *sys.argv[2:]])
