#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Output of `deburr` on a terminal and to programs, and completion of its command line.

usage: terminal_test.py DEBURR [CLASS]"""
import fcntl
import json
import os
import pty
import re
import select
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import termios
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../../tb/engines"))
from engine_list import engines  # noqa: E402
SWEEP = """
engine: texture
base:
  scene: {source: tunnel, width: 48, height: 48, texture_size: 64}
  run.images: false
axes:
  texture.cache.bytes: [1024, 2048, 4096]
  texture.cache.ways: [1, 2]
  memory.latency: [50, 100]
metrics: {cycles: cycles, bits: memory_bits.total.physical}
objectives: {minimise: [cycles, bits]}
"""
PAGE = "# The unit\n\nIt gives every pixel once.\n"
TESTPLAN = """
title: Small
features:
  - id: filtering
    title: Filtering
    traces: [docs/unit.md#the-unit]
    stimuli:
      - name: scenes
        engine: texture
        base: {scene: {width: 48, height: 48, texture_size: 64}}
        axes: {scene.source: [plane, tunnel]}
        seeds: 6
    checks: {colours: 1}
"""


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

    def test_run_ends_with_rate_bound_bottleneck_and_quality(self):
        lines = self.run_texture("--truth").stdout.splitlines()
        result = self.result()
        rate = result["throughput"]
        self.assertTrue(lines[0].startswith(
            f"rate        {rate['value']:.3f} bilinear/clk, {100 * rate['value']:.1f} % of 1: One"))
        limit = result["bottleneck"]
        self.assertTrue(lines[1].startswith(
            f"limited by  {limit['unit']}, {limit['cause']} in "
            f"{100 * limit['cycles'] / result['cycles']:.1f} % of the cycles"), lines[1])
        work, memory = result["work"], result["memory"]
        self.assertEqual(lines[2], f"hits        {work['lookup_hits_percent']:.2f} % of lookups, "
                         f"{work['lookup_merged_percent']:.2f} % more merged with a fill in flight; "
                         f"{work['texel_hits_percent']:.2f} % of texels")
        self.assertEqual(lines[3], f"memory      {memory['read_gb_per_s']:.3g} GB/s read, 0 written at 166.67 MHz")
        self.assertTrue(lines[4].startswith("cost        "), lines[4])
        self.assertIn(f" ns in {result['cost']['limited_by']}, ", lines[4])
        quality = result["quality"]
        gain = quality["psnr_db"] - quality["psnr_before_db"]
        self.assertTrue(lines[5].startswith(
            f"quality     {quality['psnr_db']:.2f} dB ({gain:+.2f}), edges "), lines[5])
        self.assertTrue(lines[5].endswith("against supersampled-256"), lines[5])
        self.assertTrue(lines[6].startswith("RESULT: PASS texture: "), lines[6])
        self.assertEqual(len(lines), 7)
        self.assertEqual(len(self.run_texture().stdout.splitlines()), 6, "no reference, no quality")

    def test_run_lists_changed_parameters(self):
        frame = os.path.join(os.path.dirname(self.out), "frame.png")
        self.run_texture()
        os.rename(os.path.join(self.out, "after.png"), frame)
        for reference in ((), ("--truth", frame)):
            done = subprocess.run([DEBURR, "run", "morphological", "--in", frame, "--out", self.out,
                                   *reference], text=True, capture_output=True, timeout=300)
            self.assertEqual(done.returncode, 0, done.stderr)
            lines = done.stdout.splitlines()
            change = self.result()["change"]
            self.assertGreater(change["over_2_percent"], 0)
            right = (f" (of correct input pixels {change['right_over_2_percent']:.2f} % and "
                     f"{change['right_over_16_percent']:.2f} %)" if reference else "")
            self.assertEqual(lines[-2], f"changed     {change['over_2_percent']:.2f} % of the pixels by "
                             f"more than 2 codes, {change['over_16_percent']:.2f} % by more than 16"
                             f"{right}; {change['psnr_db']:.2f} dB to the input")
            if reference:  # the frame is its own reference: every pixel was right
                self.assertEqual(change["right_over_2_percent"], change["over_2_percent"])
                quality = self.result()["quality"]
                self.assertEqual(quality["flip_before"], 0)
                self.assertIn(f", FLIP {quality['flip']:.4f} (+{quality['flip']:.4f}), SSIM "
                              f"{quality['ssim']:.4f} (", lines[-3])

    def test_unit_that_completes_descriptors_is_the_bottleneck(self):
        done = subprocess.run([DEBURR, "run", "morphological", "--size", "64x64", "--no-images", "--out", self.out],
                              text=True, capture_output=True, timeout=300)
        self.assertEqual(done.returncode, 0, done.stderr)
        stalls = self.result()["units"]["run_extractor"]["stalls"]
        self.assertGreater(stalls["descriptors"], 0)
        self.assertEqual(self.result()["bottleneck"]["cause"], "busy")

    def test_quiet_prints_only_the_result(self):
        done = self.run_texture("--quiet", "--truth")
        self.assertRegex(done.stdout, r"\ARESULT: PASS [^\n]*\n\Z")
        self.assertEqual(done.stderr, "")
        failed = self.run_texture("--quiet", "--fault", "flip-bit", code=1)
        self.assertIn("mismatch", failed.stderr)

    def test_json_prints_one_object(self):
        done = self.run_texture("--json")
        answer = json.loads(done.stdout)
        self.assertEqual(answer["exit_code"], 0)
        self.assertTrue(answer["outcome"].startswith("PASS texture"))
        self.assertEqual(answer["directory"], self.out)
        self.assertEqual(answer["result"], self.result())
        failed = json.loads(self.run_texture("--json", "--fault", "flip-bit", code=1).stdout)
        self.assertEqual(failed["result"]["verdict"], "fail")
        rejected = json.loads(self.run_texture("--json", "--set", "memory.latency=0",
                                              code=2).stdout)
        self.assertEqual(rejected["exit_code"], 2)
        self.assertIn("--set memory.latency=0", rejected["command"])
        self.assertNotIn("result", rejected, "that of the run before is not its own")
        typed_wrong = json.loads(self.run_texture("--json", "--colour", "red", code=2).stdout)
        self.assertIn("--colour", typed_wrong["outcome"])

    def test_no_images_writes_none(self):
        self.run_texture()
        self.run_texture("--no-images")
        self.assertEqual(sorted(os.listdir(self.out)),
                         ["manifest.json", "report.html", "result.json"])
        with open(os.path.join(self.out, "report.html")) as file:
            self.assertNotIn("data:image/png;base64", file.read())

    def test_seeds_of_stalls_and_input_are_separate(self):
        """The stall seed changes cycles and no pixel; the seed changes the input."""
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


class Many(unittest.TestCase):
    """A folder with a sweep and a testplan of twelve points each."""

    def setUp(self):
        scratch = tempfile.TemporaryDirectory(prefix="deburr_terminal_")
        self.addCleanup(scratch.cleanup)
        self.directory = scratch.name
        os.mkdir(os.path.join(self.directory, "docs"))
        for name, text in (("cache.yaml", SWEEP), ("docs/unit.md", PAGE), ("small.yaml", TESTPLAN)):
            with open(os.path.join(self.directory, name), "w") as file:
                file.write(text)


class LastLine(Many):
    """It names the given command and its input."""

    def last_line(self, *arguments, code=0):
        done = subprocess.run([DEBURR, *arguments], cwd=self.directory, text=True,
                              capture_output=True, timeout=300)
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return done.stdout.splitlines()[-1]

    def test_last_line_of_every_command(self):
        small = ("--size", "32x32", "--no-images")
        commands = [(("run", engine, *small), f"PASS {engine}: ")
                    for engine in engines()]
        commands += [(("sweep", "cache.yaml", action), "PASS sweep cache: ")
                     for action in ("plan", "run", "run", "status", "collect")]
        commands += [(("search", "cache.yaml", action, "--runs", "8"), "PASS search cache: ")
                     for action in ("run", "run", "status", "collect")]
        commands += [(("regress", "small.yaml", action, "--seed", "3"),
                      "PASS regression small --seed 3: ")
                     for action in ("plan", "run", "run", "status", "collect")]
        commands += [(("compare", "out/texture", "out/texture"), "PASS compare: "),
                     (("compare", "out/sweeps/cache", "out/sweeps/cache"), "PASS compare: "),
                     (("report", "out/texture"), "PASS report: ")]  # papers: papers_test.py
        for arguments, begin in commands:
            line = self.last_line(*arguments)
            self.assertTrue(line.startswith("RESULT: " + begin), f"{arguments}: {line}")

    def test_last_line_of_failures(self):
        with open(os.path.join(self.directory, "cache.yaml"), "a") as file:
            file.write("retry: no such key\n")
        for command in ("sweep", "search", "regress"):
            self.assertRegex(self.last_line(command, "cache.yaml", "run", code=2),
                             "^RESULT: FAIL configuration: cache.yaml")
        self.assertRegex(self.last_line("run", "texture", "--size", "32x32", "--fault", "flip-bit",
                                        code=1), "^RESULT: FAIL mismatch: .*\\(texture: ")
        self.assertRegex(self.last_line("compare", "none", "none", code=5), "^RESULT: FAIL file: ")

    def test_last_line_of_interrupted_sweep(self):
        for command, name in (("sweep", "sweep cache"), ("search", "search cache")):
            process = subprocess.Popen([DEBURR, command, "cache.yaml", "run", "--quiet", "-j1"],
                                       cwd=self.directory, text=True, stdout=subprocess.PIPE,
                                       stderr=subprocess.PIPE)
            progress = os.path.join(self.directory, "out",
                                    {"sweep": "sweeps", "search": "searches"}[command], "cache")
            while process.poll() is None and not os.path.exists(os.path.join(progress, "run.lock")):
                pass
            process.send_signal(signal.SIGINT)
            out, _ = process.communicate(timeout=300)
            self.assertRegex(out.splitlines()[-1], f"^RESULT: (INTERRUPTED|PASS) {name}: ")

    def test_printing_commands_have_no_last_line(self):
        for arguments in (["params", "texture"], ["completion", "bash"], ["completion", "zsh"], ["completion", "fish"], ["help"],
                          ["--version"]):
            self.assertNotIn("RESULT:", self.last_line(*arguments))


class Help(unittest.TestCase):
    """Every page of help has examples, and `help` shows all pages."""

    def setUp(self):
        scratch = tempfile.TemporaryDirectory(prefix="deburr_help_")
        self.addCleanup(scratch.cleanup)
        self.directory = scratch.name

    def said(self, *arguments, code=0):
        done = subprocess.run([DEBURR, *arguments], cwd=self.directory, text=True, capture_output=True, timeout=300)
        self.assertEqual(done.returncode, code, f"{arguments}\n{done.stdout}{done.stderr}")
        return done.stdout

    def pages(self):
        commands = re.findall(r"(?m)^  ([a-z-]+) ", self.said("--help").split("Subcommands:\n")[1].split("\n\n")[0])
        self.assertTrue({"run", "sweep", "compare", "completion", "help"} <= set(commands), commands)
        return [(), *((command,) for command in commands), *(("run", engine) for engine in engines())]

    def examples(self, page):
        lines = self.said(*page, "--help").split("\nExamples:\n")[1].split("\n\n")[0].splitlines()
        self.assertGreater(len(lines), 0)
        return [line.strip() for line in lines]

    def test_help_command_equals_the_option(self):
        for page in self.pages():
            self.assertEqual(self.said("help", *page), self.said(*page, "--help"))
        self.assertIn("no 'deburr rum': did you mean 'run'?, known are run, ", self.said("help", "rum", code=2))
        self.assertIn(f"no 'deburr run {engines()[0]} x'", self.said("help", "run", engines()[0], "x", code=2))

    def test_every_command_has_examples(self):
        for page in self.pages():
            for line in self.examples(page):
                self.assertTrue(line.startswith(" ".join(("deburr", *page))), f"{page}: {line}")
                command = [word for word in line.split()[1:] if word.isalpha()][:2 if "run" in line.split() else 1]
                known = self.said(*command, "--help")
                for option in re.findall(r" (--[a-z-]+)", line):
                    self.assertIn(option, known, line)

    def test_examples_of_runs_are_valid(self):
        """The files they read exist, and each is accepted as printed."""
        with open(os.path.join(self.directory, "mesh.obj"), "w") as file:
            file.write("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
        self.said("run", engines()[0], "--size", "32x32", "--out", "picture")
        os.rename(os.path.join(self.directory, "picture/after.png"), os.path.join(self.directory, "frame.png"))
        for engine in engines():
            for line in self.examples(("run", engine)):
                self.assertIn("run.seed: 1", self.said(*line.split()[1:], "--show-config"), line)


class Documents(Many):
    """With --json the standard output is one document, and everything else goes to the error stream."""

    def answer(self, *arguments, code=0):
        done = subprocess.run([DEBURR, *arguments, "--json"], cwd=self.directory, text=True, capture_output=True,
                              timeout=300)
        self.assertEqual(done.returncode, code, f"{arguments}\n{done.stdout}{done.stderr}")
        answer = json.loads(done.stdout)
        self.assertEqual(answer["exit_code"], code)
        self.assertIn(arguments[0], answer["command"])
        return answer, done.stderr

    def collected(self, place):
        with open(os.path.join(self.directory, place, "collected.json")) as file:
            return json.load(file)

    def test_sweep_prints_one_document(self):
        with open(os.path.join(self.directory, "cache.yaml"), "a") as file:
            file.write("constraints: ['texture.cache.bytes < 4096']\n")
        planned, said = self.answer("sweep", "cache.yaml", "plan")
        self.assertEqual(planned["counts"], {"points": 8, "inputs": 1, "done": 0})
        self.assertEqual(planned["left_out"], ["4 by the constraint 'texture.cache.bytes < 4096'"])
        self.assertIn("left out    4 by the constraint", said)
        ran, _ = self.answer("sweep", "cache.yaml", "run", "-j2")
        self.assertEqual(ran["counts"], {"points": 8, "done": 8, "done_in_this_run": 8, "failed": 0, "missing": 0})
        self.assertEqual((ran["directory"], ran["failures"]), ("out/sweeps/cache", []))
        self.assertTrue(ran["outcome"].startswith("PASS sweep cache: "))
        status, _ = self.answer("sweep", "cache.yaml", "status")
        self.assertEqual(status["counts"], {"points": 8, "done": 8, "running": 0, "failed": 0, "queued": 0})
        collected, _ = self.answer("sweep", "cache.yaml", "collect")
        self.assertEqual(collected["result"], self.collected("out/sweeps/cache"))

    def test_failed_sweep_prints_one_document(self):
        with open(os.path.join(self.directory, "faulty.yaml"), "w") as file:
            file.write(SWEEP.replace("run.images: false", "run: {images: false, fault: flip-bit}"))
        for action, code in (("run", 1), ("status", 0)):
            answer, _ = self.answer("sweep", "faulty.yaml", action, code=code)
            self.assertEqual(answer["counts"]["failed"], 12)
            self.assertEqual(len(answer["failures"]), 10, "the first ones")
            failure = answer["failures"][0]
            self.assertEqual(failure["kind"], "mismatch")
            self.assertTrue(failure["command"].startswith("deburr run texture --set "))
            self.assertTrue(os.path.exists(os.path.join(self.directory, failure["directory"], "failure.json")))
            if code:
                self.assertEqual(answer["repro"].split(" ", 1)[1], failure["command"].split(" ", 1)[1])
        self.assertEqual(self.answer("sweep", "none.yaml", "run", code=5)[0]["outcome"][:10], "FAIL file:")

    def test_search_prints_one_document(self):
        answer, _ = self.answer("search", "cache.yaml", "--runs", "8")
        self.assertEqual(answer["counts"]["done"], 8)
        self.assertEqual(answer["result"], self.collected("out/searches/cache"))

    def test_regression_prints_one_document(self):
        self.assertEqual(self.answer("regress", "small.yaml", "plan", "--seed", "3")[0]["counts"]["points"], 12)
        for arguments in (("run", "--seed", "3"), ("collect", "--seed", "3"), ("rerun", "--failed")):
            answer, said = self.answer("regress", "small.yaml", *arguments)
            self.assertEqual(answer["result"], self.collected("out/regressions/small-3"))
            self.assertIn("--seed 3", answer["command"])
        self.assertIn("rerun       0 of 0", said)
        self.assertEqual(self.answer("regress", "small.yaml", "status", "--seed", "3")[0]["counts"]["done"], 12)

    def test_params_prints_one_document(self):
        answer, _ = self.answer("params")
        engine = engines()[0]
        modes = [p for p in answer["parameters"] if p["name"] == "sampler.mode"]
        self.assertEqual({p["engine"] for p in modes} & {engine}, {engine})
        self.assertEqual((modes[0]["default"], modes[0]["aliases"]), ("linear_mipmap_linear", ["trilinear"]))
        self.assertTrue(any("texture.cache.bytes" in rule["parameters"] for rule in answer["limits"]))
        cycles = {p["engine"]: p["default"] for p in answer["parameters"] if p["name"] == "run.clock_mhz"}
        self.assertEqual(set(cycles), set(engines()))
        some, _ = self.answer("params", "memory")
        self.assertTrue(all(p["name"].startswith("memory.") for p in some["parameters"]))
        self.answer("params", "memry", code=2)
        self.answer("params", "--markdown", code=2)


class Screen:
    """Emulates a terminal of this width: its rows, and how often the terminal itself wrapped a line."""

    def __init__(self, columns):
        self.columns, self.rows, self.column = columns, [""], 0
        self.wraps, self.redraws = 0, []

    def show(self, text):
        for part in re.findall(r"\033\[K|\r|\n|[^\r\n\033]", text):
            if part == "\r":
                self.redraws.append(self.rows[-1])
                self.column = 0
            elif part == "\n":
                self.rows.append("")
                self.column = 0
            elif part == "\033[K":
                self.rows[-1] = self.rows[-1][:self.column]
            else:
                if self.column == self.columns:
                    self.wraps += 1
                    self.rows.append("")
                    self.column = 0
                self.rows[-1] = self.rows[-1][:self.column] + part + self.rows[-1][self.column + 1:]
                self.column += 1


def pieces(terminal):
    """Everything written to a terminal until its other end is closed."""
    try:
        while data := os.read(terminal, 65536):
            yield data
    except OSError:
        pass


class Bar(Many):
    """Progress stays in one row of a terminal, however narrow."""

    def resize(self, descriptor, columns):
        fcntl.ioctl(descriptor, termios.TIOCSWINSZ, struct.pack("HHHH", 24 if columns else 0, columns, 0, 0))

    def run_on(self, columns, *arguments, variables=None, resized=None):
        """Everything written to a terminal of this width; `resized` to another width after the first bytes."""
        mine, its = pty.openpty()
        self.resize(its, columns)
        environment = {k: v for k, v in os.environ.items() if k != "COLUMNS"} | {"TERM": "xterm"} | (variables or {})
        process = subprocess.Popen([DEBURR, *arguments], cwd=self.directory, env=environment,
                                   stdin=its, stdout=subprocess.DEVNULL, stderr=its)
        os.close(its)
        parts = []
        for data in pieces(mine):
            parts.append(data.decode())
            if resized and len(parts) == 1:
                self.resize(mine, resized)
                process.send_signal(signal.SIGWINCH)
        os.close(mine)
        self.assertEqual(process.wait(timeout=300), 0, "".join(parts))
        return parts

    COMMANDS = [("sweep", ("sweep", "cache.yaml", "run", "-j1"), 12),
                ("search", ("search", "cache.yaml", "run", "-j1", "--runs", "8"), 8),
                ("regression", ("regress", "small.yaml", "run", "-j1", "--seed", "3"), 12)]

    def check(self, columns, label, arguments, points):
        # As wide as the terminal reports: a tty turns a line break into \r\n.
        text = "".join(self.run_on(columns, *arguments, "--out", f"out_{label}_{columns}")).replace("\r\n", "\n")
        screen = Screen(columns)
        screen.show(text)
        self.assertEqual(screen.wraps, 0, screen.rows)
        self.assertGreater(len(screen.redraws), 2, text)
        # The bar, and the row after it; on a slow machine planning also has a bar.
        rows = [row for row in screen.rows if "planning" not in row]
        self.assertEqual((len(rows), rows[1]), (2, ""), screen.rows)
        last = rows[0]
        self.assertIn(f"{label}  100 %", last)
        if columns == 120:
            self.assertRegex(last, rf"^\[#{{8,24}}\] {label}  100 %  \S+ k?point/s")
        if columns >= 80 and label != "search":
            self.assertTrue(last.endswith(f"0 queued, 0 running, {points} passed, 0 failed"), last)

    def test_bar_fits_40_columns(self):
        for command in self.COMMANDS:
            self.check(40, *command)

    def test_bar_fits_80_columns(self):
        for command in self.COMMANDS:
            self.check(80, *command)

    def test_bar_fits_120_columns(self):
        for command in self.COMMANDS:
            self.check(120, *command)

    def test_waiting_run_uses_one_row(self):
        screen = Screen(20)
        screen.show("".join(self.run_on(20, "run", "texture", "--scene", "object", "--size",
                                        "200x150", "--truth")).replace("\r\n", "\n"))
        self.assertEqual(screen.wraps, 0, screen.rows)
        self.assertIn("rendering reference", screen.rows)

    def test_no_control_sequences_on_a_dumb_terminal(self):
        for terminal in ("dumb", ""):
            text = "".join(self.run_on(80, *self.COMMANDS[0][1], "--out", f"out_{terminal}",
                                       variables={"TERM": terminal}))
            self.assertNotIn("\033", text)
            self.assertNotIn("\r", text.replace("\r\n", ""))
        self.assertIn("\033", "".join(self.run_on(80, *self.COMMANDS[0][1])))

    def test_message_after_search_starts_a_row(self):
        mine, its = pty.openpty()
        self.resize(its, 120)
        process = subprocess.Popen([DEBURR, "search", "cache.yaml", "run", "-j1", "--runs", "8"], cwd=self.directory,
                                   env=os.environ | {"TERM": "xterm"}, stdin=its, stdout=its, stderr=its)
        os.close(its)
        text = ""
        while True:
            try:
                data = os.read(mine, 65536)
            except OSError:
                break
            if not data:
                break
            text += data.decode()
        os.close(mine)
        self.assertEqual(process.wait(timeout=300), 0, text)
        screen = Screen(120)
        screen.show(text.replace("\r\n", "\n"))
        rows = [row for row in screen.rows if row]
        self.assertRegex(rows[0], r"^\[#{8,24}\] search  100 %  \S+ k?point/s$")
        self.assertTrue(rows[1].startswith("left out    all but 8 of 12 combinations"), rows)
        self.assertTrue(rows[-1].startswith("RESULT: PASS search cache: "), rows)
        self.assertEqual([row for row in rows[1:] if "point/s" in row], [], "the bar came again")

    def widths(self, parts):
        return [len(line.rstrip("\r\n")) for line in re.split(r"\r(?!\n)", "".join(parts).replace("\033[K", ""))]

    def test_bar_follows_narrower_terminal(self):
        widths = self.widths(self.run_on(120, *self.COMMANDS[0][1], resized=40))
        self.assertGreater(widths[1], 80)
        self.assertLess(max(widths[-3:]), 40)

    def test_bar_without_reported_width(self):
        for number, (variables, most) in enumerate((({}, 79), ({"COLUMNS": "50"}, 49),
                                                    ({"COLUMNS": "wide"}, 79), ({"COLUMNS": "0"}, 79))):
            widths = self.widths(self.run_on(0, *self.COMMANDS[0][1], "--out", f"out_{number}",
                                             variables=variables))
            self.assertLessEqual(max(widths), most, variables)
            self.assertGreater(max(widths), 25, variables)


class Lines(Many):
    """Tables fit the width of a terminal; through a pipe the same words are unbroken."""

    def on(self, columns, *arguments, codes=(0,)):
        """Standard output on a terminal of this width; 0: through a pipe."""
        command = [DEBURR, *arguments]
        if not columns:
            done = subprocess.run(command, cwd=self.directory, text=True, stdout=subprocess.PIPE,
                                  stderr=subprocess.DEVNULL, timeout=300)
            self.assertIn(done.returncode, codes, arguments)
            return done.stdout
        mine, its = pty.openpty()
        fcntl.ioctl(its, termios.TIOCSWINSZ, struct.pack("HHHH", 24, columns, 0, 0))
        process = subprocess.Popen(command, cwd=self.directory, stdin=subprocess.DEVNULL, stdout=its,
                                   stderr=subprocess.DEVNULL)
        os.close(its)
        text = b"".join(pieces(mine)).decode()
        os.close(mine)
        self.assertIn(process.wait(timeout=300), codes, arguments)
        return text.replace("\r\n", "\n")

    def check(self, *arguments, codes=(0,), table=False):
        """`table`: a row may be split into several, each repeating the column names."""
        plain = self.on(0, *arguments, codes=codes)
        for columns in (40, 80, 120):
            text = self.on(columns, *arguments, codes=codes)
            for line in text.splitlines():
                # Scripts read the last two lines, and an example must be copyable; words are never split.
                if len(line) < columns or line.startswith(("RESULT: ", "REPRO: ", "  deburr ")):
                    continue
                self.assertEqual(len(line.split()), 1, f"{arguments} at {columns}: {line}")
            if table:
                self.assertLessEqual(set(plain.replace(":", " ").split()) - set(text.replace(":", " ").split()), {"step"},
                                     arguments)
            else:
                self.assertEqual(text.split(), plain.split(), arguments)

    def test_help_and_parameters_fit(self):
        for arguments in (("--help",), ("help", "run", engines()[0]), ("run", engines()[0], "--help"), ("regress", "--help"),
                          ("params",), ("params", "memory")):
            self.check(*arguments)

    def test_run_output_fits(self):
        small = ("--size", "32x32", "--truth", "--no-images")
        for engine in engines():
            self.check("run", engine, *(small if engine == "texture" else small[:2] + small[3:]), "--out", engine)
        self.check("run", "texture", *small, "--out", "a", "--pixel", "9,9", table=True)
        self.check("run", "texture", "--size", "32x32", "--fault", "flip-bit", "--out", "c", codes=(1,))
        self.on(0, "run", "texture", *small, "--out", "b", "--set", "texture.cache.bytes=1024")
        for more in ((), ("--all",)):
            self.check("compare", "a", "b", *more, codes=(0, 1), table=True)

    def test_sweep_output_fits(self):
        text = SWEEP.replace("metrics: {", "metrics: {one: cycles / checks.mismatches, ")
        for name, fault in (("cache", "false"), ("faulty", "false, fault: flip-bit")):
            with open(os.path.join(self.directory, f"{name}.yaml"), "w") as file:
                file.write(text.replace("run.images: false", f"run: {{images: {fault}}}") +
                           "constraints: ['texture.cache.bytes < 4096']\n")
            for action in ("plan", "run", "status", "collect"):
                if action == "run":  # the number of points run differs the second time
                    self.on(0, "sweep", f"{name}.yaml", "run", codes=(0, 1))
                self.check("sweep", f"{name}.yaml", action, codes=(0, 1))
        self.check("compare", "out/sweeps/cache", "out/sweeps/cache", table=True)
        self.on(0, "regress", "small.yaml", "run", "--seed", "3")
        for action in ("plan", "status", "collect"):
            self.check("regress", "small.yaml", action, "--seed", "3")


class Completion(unittest.TestCase):
    """Completion in bash: `deburr completion bash` is sourced and queried. The classes below test the other shells."""

    def complete(self, *words):
        script = (f'source <("{DEBURR}" completion bash) || exit 9\n'
                  'COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _deburr\n'
                  'printf "%s\\n" "${COMPREPLY[@]}"')
        return self.asked("bash", "-c", script, "bash", "deburr", *words)

    def asked(self, *command):
        done = subprocess.run(command, text=True, capture_output=True, cwd=FOLDER)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        return done.stdout.split()

    # The words of `--set NAME=VALUE` as the shell splits them.
    def setting(self, name, value):
        return (name, "=", value) if value else (name, "=")

    # The completion of a setting's value.
    def value(self, name, value):
        return value

    FILES = []  # where the shell itself completes file names

    def test_completes_commands(self):
        self.assertEqual(self.complete("pa"), ["papers", "params"])
        self.assertEqual(set(self.complete("run", "")) - {"--help"},
                         set(engines()))
        self.assertEqual(self.complete("help", "swe"), ["sweep"])
        self.assertEqual(self.complete("help", "run", engines()[0][:3]), [engines()[0]])

    def test_completes_actions(self):
        for command, actions in (("sweep", ["collect", "plan", "run", "status"]), ("search", ["collect", "run", "status"]),
                                 ("regress", ["collect", "plan", "rerun", "run", "status"])):
            self.assertEqual(sorted(self.complete(command, "a.yaml", "")), actions)
            self.assertEqual(self.complete(command, "--jobs", "4", "a.yaml", "--quiet", "st"), ["status"])
        self.assertEqual(self.complete("regress", "st"), ["status"])
        self.assertEqual(self.complete("sweep", ""), self.FILES)
        self.assertEqual(self.complete("sweep", "a.yaml", "run", "--re"), ["--retry"])

    def test_completes_units(self):
        self.assertEqual(self.complete("params", "mem"), ["memory"])
        self.assertEqual(self.complete("params", "--markdown", "reg"), ["registers"])

    def test_completes_faults(self):
        self.assertEqual(self.complete("run", "texture", "--fault", "flip-b"), ["flip-bit"])
        self.assertIn("texture.flip-bit", self.complete("run", "frame", "--fault", "texture.flip"))
        self.assertEqual(self.complete("run", "texture", "--set", *self.setting("run.fault", "flip-b")),
                         [self.value("run.fault", "flip-bit")])

    def test_completes_options(self):
        self.assertEqual(self.complete("run", "texture", "--trace-f"), ["--trace-from"])
        self.assertEqual(self.complete("run", "morphological", "--size", "8x8", "--pre"),
                         ["--preset"])
        self.assertEqual(self.complete("run", "texture", "--smoo"), [])

    def test_completes_values(self):
        self.assertIn("linear_mipmap_linear", self.complete("run", "texture", "--mode", "linear"))
        self.assertEqual(self.complete("run", "texture", "--mode", "tri"), ["trilinear"])
        self.assertEqual(self.complete("run", "frame", "--preset", "mlaa-"), ["mlaa-slope"])
        self.assertEqual(self.complete("completion", "b"), ["bash"])
        self.assertEqual(self.complete("run", "texture", "--in", ""), self.FILES)

    def test_completes_parameters(self):
        self.assertEqual(self.complete("run", "texture", "--set", "texture.cache.by"),
                         ["texture.cache.bytes="])
        self.assertEqual(self.complete("run", "texture", "--set", *self.setting("sampler.layout", "li")),
                         [self.value("sampler.layout", "linear")])
        self.assertEqual(self.complete("run", "texture", "--set", *self.setting("sampler.layout", "")),
                         [self.value("sampler.layout", value) for value in ("linear", "tiled")])

    def test_completes_every_parameter_and_option(self):
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


class OneWord:
    """Shells for which NAME=VALUE is one word."""

    def setting(self, name, value):
        return (f"{name}={value}",)


@unittest.skipUnless(shutil.which("zsh"), "no zsh")
class CompletionZsh(OneWord, Completion):
    """Completion in zsh, with stubs that record the arguments of its own functions."""

    FILES = ["files"]

    def complete(self, *words):
        script = (f'source <("{DEBURR}" completion zsh) || exit 9\n'
                  'compset() { prefix=${words[CURRENT]%%=*}=; }\n'
                  '_files() { print files; }\n'
                  'compadd() {\n'
                  '  local word found=1; while [[ $1 != -- ]]; do shift; done; shift\n'
                  '  for word; do [[ $prefix$word != ${words[CURRENT]}* ]] || { print -- $word; found=0; }; done\n'
                  '  return $found\n'
                  '}\n'
                  'words=("$@"); CURRENT=$#; prefix=; _deburr; true')
        return self.asked("zsh", "-fc", script, "zsh", "deburr", *words)


@unittest.skipUnless(shutil.which("zsh"), "no zsh (Debian package zsh)")
class TypedZsh(unittest.TestCase):
    """Typed into a real zsh with its own completion: Tab completes the current word."""

    SET_UP = ("PS1='READY''> '; unsetopt beep; bindkey -e; autoload -Uz compinit; compinit -u -D; "
              'source <("$DEBURR" completion zsh)\n')

    def until(self, terminal, mark):
        said = b""
        while mark not in said:
            ready = select.select([terminal], [], [], 60)[0]
            self.assertTrue(ready, said)
            said += os.read(terminal, 1 << 16)
        return said.decode()

    def setUp(self):
        child, self.terminal = pty.fork()
        if child == 0:
            os.environ.update(TERM="dumb", COLUMNS="300", DEBURR=DEBURR)
            os.execvp("zsh", ["zsh", "-f", "-i"])
        self.addCleanup(os.waitpid, child, 0)
        self.addCleanup(os.kill, child, signal.SIGKILL)
        self.addCleanup(os.close, self.terminal)
        os.write(self.terminal, self.SET_UP.encode())
        self.until(self.terminal, b"READY> ")

    def typed(self, text):
        """The command line after Tab: the test types a command around it that prints it."""
        os.write(self.terminal, text.encode() + b"\t\x01print -r -- 'THERE:''[\x05]'\n")
        return re.search(r"THERE:\[(.*?)\]\r?\n", self.until(self.terminal, b"]\r\n")).group(1)

    def test_tab_completes(self):
        for typed, there in (("deburr ru", "deburr run"), ("deburr run tex", "deburr run texture"),
                             ("deburr run texture --check gol", "deburr run texture --check golden"),
                             ("deburr run texture --set memory.lat", "deburr run texture --set memory.latency"),
                             ("deburr run texture --check silv", "deburr run texture --check silv")):
            with self.subTest(typed=typed):
                self.assertEqual(self.typed(typed).rstrip(" ="), there)


@unittest.skipUnless(shutil.which("fish"), "no fish")
class CompletionFish(OneWord, Completion):
    """Completion in fish."""

    FILES = ["here.yaml"]

    def value(self, name, value):
        return f"{name}={value}"

    def complete(self, *words):
        line = " ".join(("deburr", *words)) if words[-1] else " ".join(("deburr", *words[:-1], ""))
        return self.asked("fish", "--no-config", "-c", f"'{DEBURR}' completion fish | source; complete -C '{line}'")


if __name__ == "__main__":
    if len(sys.argv) < 2 or sys.argv[1] in ("-h", "--help"):
        print(__doc__)
        sys.exit(0 if len(sys.argv) >= 2 else 2)
    DEBURR = os.path.abspath(sys.argv.pop(1))
    with tempfile.TemporaryDirectory(prefix="deburr_terminal_") as FOLDER:
        with open(os.path.join(FOLDER, "here.yaml"), "w"):
            pass
        unittest.main()
