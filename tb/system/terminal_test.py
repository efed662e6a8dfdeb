#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""What `deburr` says on a terminal and to programs, and what completes its command line.

usage: terminal_test.py DEBURR
"""
import json
import os
import re
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "../engines"))
from engine_list import engines  # noqa: E402


class Terminal(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory(prefix="deburr_terminal_")
        self.addCleanup(scratch.cleanup)
        self.out = os.path.join(scratch.name, "out")

    def run_texture(self, *arguments, code=0):
        done = subprocess.run([DEBURR, "run", "texture", "--size", "32x32", "--out", self.out,
                               *arguments], text=True, capture_output=True, timeout=300)
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return done

    def result(self):
        with open(os.path.join(self.out, "result.json")) as file:
            return json.load(file)

    def test_it_ends_with_rate_bound_bottleneck_and_quality(self):
        lines = self.run_texture("--truth").stdout.splitlines()
        result = self.result()
        rate = result["throughput"]
        self.assertTrue(lines[0].startswith(
            f"rate        {rate['value']:.3f} bilinear/clk, {100 * rate['value']:.1f} % of 1: One"))
        limit = result["bottleneck"]
        self.assertTrue(lines[1].startswith(
            f"limited by  {limit['unit']}, {limit['cause']} in "
            f"{100 * limit['cycles'] / result['cycles']:.1f} % of the cycles"), lines[1])
        quality = result["quality"]
        gain = quality["psnr_db"] - quality["psnr_before_db"]
        self.assertTrue(lines[2].startswith(
            f"quality     {quality['psnr_db']:.2f} dB ({gain:+.2f}), edges "), lines[2])
        self.assertTrue(lines[2].endswith("against supersampled-256"), lines[2])
        self.assertTrue(lines[3].startswith("RESULT: PASS texture: "), lines[3])
        self.assertEqual(len(lines), 4)
        self.assertEqual(len(self.run_texture().stdout.splitlines()), 3, "no truth, no quality")

    def test_quiet(self):
        done = self.run_texture("--quiet", "--truth")
        self.assertRegex(done.stdout, r"\ARESULT: PASS [^\n]*\n\Z")
        self.assertEqual(done.stderr, "")
        failed = self.run_texture("--quiet", "--fault", "flip-bit", code=1)
        self.assertIn("mismatch", failed.stderr)

    def test_json(self):
        done = self.run_texture("--json")
        answer = json.loads(done.stdout)
        self.assertEqual(answer["exit_code"], 0)
        self.assertTrue(answer["outcome"].startswith("PASS texture"))
        self.assertEqual(answer["directory"], self.out)
        self.assertEqual(answer["result"], self.result())
        failed = json.loads(self.run_texture("--json", "--fault", "flip-bit", code=1).stdout)
        self.assertEqual(failed["result"]["verdict"], "fail")
        refused = json.loads(self.run_texture("--json", "--set", "memory.latency=0",
                                              code=2).stdout)
        self.assertEqual(refused["exit_code"], 2)
        self.assertIn("--set memory.latency=0", refused["command"])
        self.assertNotIn("result", refused, "that of the run before is not its own")
        typed_wrong = json.loads(self.run_texture("--json", "--colour", "red", code=2).stdout)
        self.assertIn("--colour", typed_wrong["outcome"])

    def test_no_images(self):
        self.run_texture()
        self.run_texture("--no-images")
        self.assertEqual(sorted(os.listdir(self.out)),
                         ["manifest.json", "report.html", "result.json"])
        with open(os.path.join(self.out, "report.html")) as file:
            self.assertNotIn("data:image/png;base64", file.read())

    def test_two_seeds(self):
        """The stall seed moves clocks and no pixel; the seed changes what goes in."""
        def run(*arguments):
            self.run_texture("--stalls", "0.2", "--set", "scene.texture=noise", *arguments)
            with open(os.path.join(self.out, "after.png"), "rb") as file:
                picture = file.read()
            with open(os.path.join(self.out, "manifest.json")) as file:
                return self.result()["cycles"], picture, json.load(file)["golden"]

        first, again = run(), run()
        self.assertEqual(first, again)
        stalled = run("--stall-seed", "2")
        self.assertNotEqual(stalled[0], first[0])
        self.assertEqual(stalled[1:], first[1:])
        seeded = run("--seed", "2")
        self.assertNotEqual(seeded[1], first[1])
        self.assertNotEqual(seeded[2], first[2])


class Completion(unittest.TestCase):
    """As bash does it: `deburr completion bash` is sourced, and asked."""

    def complete(self, *words):
        script = (f'source <("{DEBURR}" completion bash) || exit 9\n'
                  'COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _deburr\n'
                  'printf "%s\\n" "${COMPREPLY[@]}"')
        done = subprocess.run(["bash", "-c", script, "bash", "deburr", *words], text=True,
                              capture_output=True)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        return done.stdout.split()

    def test_commands(self):
        self.assertEqual(self.complete("pa"), ["papers", "params"])
        self.assertEqual(set(self.complete("run", "")) - {"--help"},
                         set(engines()))

    def test_options(self):
        self.assertEqual(self.complete("run", "texture", "--trace-f"), ["--trace-from"])
        self.assertEqual(self.complete("run", "morphological", "--size", "8x8", "--pre"),
                         ["--preset"])
        self.assertEqual(self.complete("run", "texture", "--smoo"), [])

    def test_values(self):
        self.assertIn("linear_mipmap_linear", self.complete("run", "texture", "--mode", "linear"))
        self.assertEqual(self.complete("run", "frame", "--preset", "mlaa-"), ["mlaa-slope"])
        self.assertEqual(self.complete("completion", "b"), ["bash"])
        self.assertEqual(self.complete("run", "texture", "--in", ""), [], "bash knows the files")

    def test_parameters(self):
        self.assertEqual(self.complete("run", "texture", "--set", "texture.cache.by"),
                         ["texture.cache.bytes="])
        self.assertEqual(self.complete("run", "texture", "--set", "sampler.layout", "=", "li"),
                         ["linear"])
        self.assertEqual(self.complete("run", "texture", "--set", "sampler.layout", "="),
                         ["linear", "tiled"])

    def test_every_parameter_and_option_is_there(self):
        known = set(self.complete("run", "texture", "--set", ""))
        page = subprocess.run([DEBURR, "run", "texture", "--show-config"], text=True,
                              capture_output=True).stdout
        self.assertIn("memory.latency=", known)
        self.assertGreater(len(known), 40)
        self.assertIn("latency", page)
        options = set(self.complete("run", "texture", "--"))
        text = subprocess.run([DEBURR, "run", "texture", "--help"], text=True,
                              capture_output=True).stdout
        self.assertEqual(set(re.findall(r"--[a-z][a-z-]*", text.split("OPTIONS")[-1]))
                         - {"--truth-samples"} - options, set())


if __name__ == "__main__":
    if len(sys.argv) < 2 or sys.argv[1] in ("-h", "--help"):
        print(__doc__)
        sys.exit(0 if len(sys.argv) >= 2 else 2)
    DEBURR = sys.argv.pop(1)
    unittest.main()
