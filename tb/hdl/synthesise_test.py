#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Tests scripts/synthesise on small modules: figures that can be counted by hand, preserved memories, the cache,
--check and the differences that it must find, a row over the time limit, Ctrl-C, and errors.

usage: synthesise_test.py SOURCE [unittest options]"""
import json
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

SOURCE = pathlib.Path(sys.argv.pop(1)).resolve() if len(sys.argv) > 1 else pathlib.Path(".").resolve()
LIBERTY = pathlib.Path("/usr/share/qflow/tech/osu018/osu018_stdcells.lib")
# Ctrl-C must reach the processes started here, even if this runs in the background of a shell.
signal.signal(signal.SIGINT, signal.default_int_handler)

HEADERS = """#!/bin/sh
mkdir -p "$1"
ways=3
for word in "$@"; do case "$word" in ways=*) ways=${word#ways=} ;; esac; done
printf '`define CHOSEN_WAYS %s\\n' "$ways" >"$1/tokens.svh"
"""
# 8 counting flip-flops, a memory of 16 x 4 bits.
SMALL = """`include "tokens.svh"
module small #(parameter integer WAYS = `CHOSEN_WAYS) (
  input logic clk, input logic write, input logic [3:0] at, output logic [3:0] word, output logic [7:0] sum
);
  always_ff @(posedge clk) sum <= sum + WAYS[7:0];
  sram_1r1w #(.BITS(4), .WORDS(16), .ADDRESS_BITS(4)) store (
    .clk, .read(1'b1), .read_address(at), .word, .write, .write_address(at), .write_data(sum[3:0]));
endmodule
"""
BOTH = """module both (
  input logic clk, input logic write, input logic [3:0] at, output logic [3:0] word, output logic [15:0] sum
);
  logic [3:0] other;
  small first (.clk, .write, .at, .word, .sum(sum[7:0]));
  small second (.clk, .write, .at(word), .word(other), .sum(sum[15:8]));
endmodule
"""
SLOW = """module slow (input logic clk, input logic [255:0] a, output logic [511:0] p);
  always_ff @(posedge clk) p <= a * {a[127:0], a[255:128]};
endmodule
"""
CONFIGURATIONS = """VBoth both ways=3  # two instances of the cell
VSmall small
VPaper small axes=two footprint=half log2=mitchell count=floor
"""


class Synthesise(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory(prefix="deburr_synthesise_")
        cls.root = pathlib.Path(cls.folder.name)
        for name, text in {"hdl/texture/small.sv": SMALL, "hdl/texture/both.sv": BOTH, "hdl/texture/slow.sv": SLOW,
                           "headers": HEADERS, "configurations": CONFIGURATIONS}.items():
            cls.write(name, text)
        (cls.root / "headers").chmod(0o755)
        cls.write("hdl/fabric/sram_1r1w.sv", (SOURCE / "hdl/fabric/sram_1r1w.sv").read_text(encoding="utf-8"))
        (cls.root / "out").mkdir()
        cls.first = cls.call()

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    @classmethod
    def write(cls, name, text):
        file = cls.root / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text, encoding="utf-8")

    @classmethod
    def command(cls, *words):
        return [sys.executable, str(SOURCE / "scripts/synthesise"), "--hdl", str(cls.root / "hdl"), "--configurations",
                str(cls.root / "configurations"), "--headers", str(cls.root / "headers"), "--work", str(cls.root / "work"),
                "--out", str(cls.root / "out"), "--jobs", "2", *words]

    @classmethod
    def call(cls, *words, **options):
        return subprocess.run(cls.command(*words), capture_output=True, text=True, check=False, **options)

    @classmethod
    def cost(cls):
        return json.loads((cls.root / "out/cost.json").read_text(encoding="utf-8"))

    @classmethod
    def row(cls, unit):
        return next(one for one in cls.cost()["units"] if one["unit"] == unit)

    def changed(self, name, good, bad):
        """Injects a fault until the test ends."""
        text = (self.root / name).read_text(encoding="utf-8")
        self.assertEqual(text.count(good), 1, name)
        self.write(name, text.replace(good, bad))
        self.addCleanup(self.write, name, text)

    def test_figures_match_manual_counts(self):
        self.assertEqual(self.first.returncode, 0, self.first.stderr)
        small = self.row("small")
        self.assertEqual(small["parameters"], {"ways": 3})
        gates = small["osu018"]
        self.assertEqual((gates["flip_flops"], gates["memory_bits"]), (8, 64))
        self.assertEqual((gates["from"], gates["to"]), ("sum", "sum"))
        # Eight flip-flops of four gates each and at least one gate per bit of the sum.
        self.assertGreater(gates["gates"], 8 * 4 + 8)
        self.assertLess(gates["gates"], 100)
        self.assertTrue(0.1 < gates["ns"] < self.cost()["yardstick"]["ns"], gates)
        self.assertAlmostEqual(gates["ratio"], gates["ns"] / self.cost()["yardstick"]["ns"], 3)
        for technology, most in (("xc7", 24), ("ecp5", 24)):
            row = small[technology]
            self.assertGreaterEqual(row["flip_flops"], 8)
            self.assertLess(row["flip_flops"], 8 + 2 * 4 + 1, "the memory is flip-flops")
            self.assertTrue(4 < row["luts"] < most or row["block_rams"], row)
            self.assertEqual(row["multipliers"], 0)

    def test_sum_of_parts_matches(self):
        both, small = self.row("both"), self.row("small")
        self.assertEqual(both["parts"], [["small", {"ways": 3}, 2]])
        self.assertEqual(both["osu018"]["flip_flops"], 16)
        self.assertEqual(both["osu018"]["memory_bits"], 128)
        self.assertEqual(both["xc7"]["luts"], 2 * small["xc7"]["luts"])
        self.assertEqual((both["osu018"]["ns"], both["osu018"]["to"]), (small["osu018"]["ns"], "small.sum"))

    def test_page_is_written(self):
        page = (self.root / "out/cost.md").read_text(encoding="utf-8")
        row = self.row("small")["osu018"]
        self.assertIn(f"| `small` | `ways=3` | {row['gates']} | 8 | 64 | {row['ns']:.2f} | {row['ratio']:.2f} | `sum` |", page)
        self.assertIn("ns (osu018)", page)
        self.assertLessEqual(max(len(line) for line in page.splitlines() if not line.startswith("|")), 120)

    def test_cache_is_used(self):
        page = (self.root / "out/cost.md").read_bytes()
        again = self.call()
        self.assertEqual(again.returncode, 0, again.stderr)
        self.assertRegex(again.stderr, r"\b(\d+) rows, \1 from the cache")
        self.assertEqual((self.root / "out/cost.md").read_bytes(), page)
        self.changed("hdl/texture/small.sv", "sum + ", "sum - ")
        one = self.call("--unit", "small")
        self.assertIn("3 rows, 0 from the cache", one.stderr)
        self.assertEqual((self.root / "out/cost.md").read_bytes(), page, "a printed unit writes nothing")

    def test_check_passes_recorded_figures(self):
        done = self.call("--check")
        self.assertEqual((done.returncode, done.stdout), (0, "cost.md, cost.json and osu018.json are current\n"), done.stderr)

    def test_check_needs_no_tool(self):
        self.assertEqual(self.call("--check", env={"PATH": self.shell_alone()}).returncode, 0)

    def test_check_finds_differences(self):
        for name, good, bad, said in (
                ("hdl/texture/small.sv", "sum + ", "sum - ", "VBoth: its sources have changed"),
                ("hdl/fabric/sram_1r1w.sv", "if (write) memory", "if (!write) memory", "VBoth: its sources have changed"),
                ("headers", "CHOSEN_WAYS %s", "CHOSEN_WAYS 1%s", "VBoth: its sources have changed"),
                ("configurations", "ways=3", "ways=4", "VBoth: its settings have changed"),
                ("configurations", "VBoth", "VOther", "VOther is not in it\nconfiguration VBoth no longer exists"),
                ("configurations", "axes=two footprint=half", "footprint=half axes=two",
                 "no configuration of paper: axes=two footprint=half log2=mitchell count=floor"),
                ("configurations", "VSmall small", "VSmall small ways=3",
                 "no configuration of deburr: default settings"),
                ("out/cost.md", "| `small` | `ways=3` | ", "| `small` | `ways=3` | 1", "cost.md is not what cost.json says"),
                ("out/cost.json", '"flow": "', '"flow": "0', "the mapping flow has changed")):
            with self.subTest(said=said, name=name):
                text = (self.root / name).read_text(encoding="utf-8")
                self.assertGreaterEqual(text.count(good), 1)
                self.write(name, text.replace(good, bad, 1))
                done = self.call("--check")
                self.write(name, text)
                self.assertEqual(done.returncode, 1, done.stdout + done.stderr)
                self.assertIn(said, done.stdout)

    def test_check_finds_missing_preset_row(self):
        for name, said in (("small", "VSmall: small ways=3 has not been mapped for xc7\n"),
                           ("sram_1r1w", "VSmall: sram_1r1w ")):
            cost = self.cost()
            for unit in cost["units"]:
                if unit["unit"] == name:
                    unit["xc7"] = "not run"
            self.addCleanup(self.write, "out/cost.json", (self.root / "out/cost.json").read_text(encoding="utf-8"))
            self.write("out/cost.json", json.dumps(cost))
            done = self.call("--check")
            self.assertEqual(done.returncode, 1, done.stdout + done.stderr)
            self.assertIn(said, done.stdout)
            self.doCleanups()

    def test_check_ignores_comments(self):
        self.changed("hdl/texture/small.sv", "endmodule", "  // Said in other words.\nendmodule")
        self.assertEqual(self.call("--check").returncode, 0)

    def test_reports_row_over_time_limit(self):
        kept = {name: (self.root / "out" / name).read_bytes() for name in ("cost.md", "cost.json")}
        self.addCleanup(lambda: [(self.root / "out" / name).write_bytes(old) for name, old in kept.items()])
        self.changed("configurations", "VBoth both ways=3", "VBoth both ways=3\nVSlow slow\n")
        done = self.call("--seconds", "2")
        self.assertEqual(done.returncode, 0, done.stderr)
        slow = self.row("slow")
        self.assertEqual(slow["osu018"], "not mapped")
        self.assertIn("| `slow` | - | not mapped | - |", (self.root / "out/cost.md").read_text(encoding="utf-8"))
        self.assertEqual(self.row("small")["osu018"]["flip_flops"], 8)
        self.assertEqual(self.call("--cached", "--seconds", "3").returncode, 0)
        self.assertEqual((self.row("slow")["xc7"], self.row("both")["xc7"]["flip_flops"] > 8), ("not run", True))
        # The limit is stored; a higher one tries again.
        self.assertRegex(self.call("--seconds", "2").stderr, r"\b(\d+) rows, \1 from the cache")
        self.assertNotRegex(self.call("--seconds", "2.5").stderr, r"\b(\d+) rows, \1 from the cache")

    def test_interrupt_ends_all_processes(self):
        for end in (signal.SIGINT, signal.SIGTERM):
            with self.subTest(end=end):
                self.interrupted(end)

    def interrupted(self, end):
        self.write("slow", "VSlow slow ways=5\n")
        process = subprocess.Popen(self.command("--configurations", str(self.root / "slow"), "--seconds", "600"),
                                   stderr=subprocess.PIPE, text=True,
                                   cwd=self.root, env={**os.environ, "TMPDIR": str(self.root)})
        for line in process.stderr:
            if "rows, " in line:
                break
        time.sleep(1)
        process.send_signal(end)
        _, said = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 130, said)
        self.assertIn("interrupted", said)
        left = []
        for file in pathlib.Path("/proc").glob("[0-9]*"):
            try:
                if os.readlink(file / "cwd").startswith(str(self.root)):
                    left.append(file.name)
            except OSError:
                pass
        self.assertEqual(left, [], "yosys goes on")

    def shell_alone(self):
        """A PATH with only the tools that print the headers."""
        folder = self.root / "bin"
        folder.mkdir(exist_ok=True)
        for name in ("sh", "mkdir", "printf", "env"):
            if not (folder / name).exists():
                (folder / name).symlink_to(shutil.which(name))
        return str(folder)

    def test_errors_are_reported(self):
        def said(words, code, *arguments, **options):
            done = self.call(*arguments, **options)
            self.assertEqual(done.returncode, code, done.stdout + done.stderr)
            self.assertIn(words, done.stderr)

        said("yosys is not installed: scripts/install synthesis (package yosys)", 2, env={"PATH": self.shell_alone()})
        said("--target deburr_hdl_headers", 2, "--headers", str(self.root / "absent"))
        said("unknown unit absent (known: both, small, sram_1r1w)", 2, "--unit", "absent")
        said("No such file", 2, "--configurations", str(self.root / "absent"))
        said("no *.sv in", 2, "--hdl", str(self.root / "out"))
        said("above 0", 2, "--seconds", "0")
        for line, words in (("VBoth", "other:1: expected NAME TOP"), ("VBoth both ways", "expected NAME TOP"),
                            ("VBoth absent ways=1", "no module absent"), ("# none", "no configuration")):
            self.write("other", line + "\n")
            said(words, 2, "--configurations", str(self.root / "other"))
        self.changed("hdl/texture/both.sv", ".sum(sum[7:0]))", ".summ(sum[7:0]))")
        said("VBoth: module both was not read: ERROR", 2)


def main():
    for tool in ("yosys", "yosys-abc"):
        if shutil.which(tool) is None:
            print(f"skipped '{tool} is not installed: scripts/install synthesis'")
            return
    if not LIBERTY.exists():
        print("skipped 'qflow-tech-osu018 is not installed: scripts/install synthesis'")
        return
    unittest.main()


if __name__ == "__main__":
    main()
