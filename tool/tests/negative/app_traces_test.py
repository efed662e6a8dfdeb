#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Invalid traces, and traces that cannot be written: an error names the position, the reason and a remedy."""
import json
import os
import resource
import struct
import unittest

from app_support import CommandTest, engines

TITLE = "deburr-fragments 1\n"
QUAD = "quad 0 f f 0 0 0 0 0 .1 0 0 .1 .1 .1\n"
FRAGMENT = "fragment 0 - - .5 .5 .01 0 0 .01\n"
NONE = 2**32 - 1


def header(version=1, begin=64, size=80, width=0, height=0, count=1, magic=b"DEBURRFT"):
    return magic + struct.pack("<IIIIIIQ24x", version, begin, size, width, height, 0, count)


def record(x=NONE, y=NONE, kind=0, texture=0, coverage=15, visible=15, clamped=0, tail=b"\0\0\0",
           values=(0, 0, .1, 0, 0, .1, .1, .1)):
    return struct.pack("<IIBBBBB3s8d", x, y, kind, texture, coverage, visible, clamped, tail, *values)


class Fragments(CommandTest):
    def rejected(self, content, *says, code=5):
        self.write("trace", content)
        for more in ((), ("--show-config",)):  # checked before anything is simulated
            done = self.run_command("run", "texture", "--fragments", "trace", "--out", "out", *more)
            context = f"{content[:200]}\n{done.stdout}\n{done.stderr}"
            self.assertEqual(done.returncode, code, context)
            for word in says:
                self.assertIn(word, done.stdout + done.stderr, context)
        self.assertFalse(os.path.exists(self.path("out")))

    def test_error_in_text_names_its_line(self):
        sized = TITLE + "size 8 8\n"
        for content, *says in (
                ("", "trace:1", "the file is empty", "begins with 'deburr-fragments 1'"),
                ("hello\n", "trace:1", "not a fragment trace", "docs/reference/traces.md"),
                ("deburr-fragments\n", "trace:1", "1 fields, expected 2"),
                ("deburr-fragments 2\n", "trace:1", "version 2", "reads version 1"),
                (TITLE, "trace:2", "truncated"),
                (TITLE + "size 8\n", "trace:2", "2 fields, expected 3", "size WIDTH HEIGHT"),
                (TITLE + "size 0 8\n", "trace:2", "0 x 8", "1 to 8192"),
                (TITLE + "size 8 8193\n", "trace:2", "8 x 8193"),
                (TITLE + "triangle 1\n", "trace:2", "'triangle'", "'quad', 'fragment' or 'end'"),
                (TITLE + "quad 0 f\n", "trace:2", "3 fields, expected 15", "s0 t0 s1 t1"),
                (TITLE + "\n# a\n" + FRAGMENT.replace("0 -", "x -", 1), "trace:4", "texture = 'x'", "whole number"),
                (TITLE + FRAGMENT.replace("0 -", "1 -", 1), "trace:2", "texture 1", "the scene has 1", "--in FILE.gltf"),
                (TITLE + FRAGMENT.replace(".5", "nan", 1), "trace:2", "s = nan", "-128 to below 128"),
                (TITLE + FRAGMENT.replace(".5", "inf", 1), "trace:2", "s = inf"),
                (TITLE + FRAGMENT.replace(".5", "1e999", 1), "trace:2", "s = inf"),
                (TITLE + FRAGMENT.replace(".5", "128", 1), "trace:2", "s = 128", "subtract whole repeats"),
                (TITLE + FRAGMENT.replace(".5", "-128.1", 1), "trace:2", "s = -128.1"),
                (TITLE + FRAGMENT.replace(".01", "nan", 1), "trace:2", "ds/dx = nan"),
                (TITLE + FRAGMENT.replace(".5 .5", "127.999 .5"), "trace:2", "neighbour by the derivatives"),
                (TITLE + FRAGMENT.replace(".5", "0.5f", 1), "trace:2", "s = '0.5f'", "expected a number"),
                (TITLE + FRAGMENT + FRAGMENT.replace("- -", "- 3"), "trace:3", "x = '-'"),
                (TITLE + FRAGMENT.replace("- -", "3 3"), "trace:2", "has no image size", "size WIDTH HEIGHT"),
                (sized + FRAGMENT.replace("- -", "8 3"), "trace:3", "(8, 3) is outside", "8 x 8"),
                (sized + QUAD.replace("0 0 0 0", "0 1 0 0", 1), "trace:3", "(1, 0)", "must be even"),
                (TITLE + "size 7 7\n" + QUAD.replace("0 0 0 0", "0 6 6 0", 1), "trace:3", "lane 1", "outside"),
                (TITLE + QUAD.replace("f f", "1f f").replace("0 0 0 0", "0 - - 0", 1), "trace:2", "coverage = '1f'", "0 to f"),
                (TITLE + FRAGMENT, "trace:3", "no line 'end 1'", "truncated"),
                (TITLE + FRAGMENT + "end 2\n", "trace:3", "'end 2' after 1 records"),
                (TITLE + FRAGMENT + "end 1", "trace:3", "in the middle of a line", "truncated"),
                (TITLE + FRAGMENT + "end 1\n" + FRAGMENT, "trace:4", "text after the line 'end'"),
                (TITLE + "x" * 2000 + "\n", "trace:2", "more than 1000 characters")):
            with self.subTest(content=content[:120]):
                self.rejected(content, *says)

    def test_error_in_binary_names_its_record(self):
        good = record()
        for content, *says in (
                (header()[:40], "truncated header, expected 64 bytes"),
                (header(version=7) + good, "version 7", "reads version 1"),
                (header(size=72) + good, "records of 72, expected 64 and 80"),
                (header() + good[:-1], "143 bytes", "1 records need 144", "truncated"),
                (header(count=2) + good, "truncated"),
                (header() + good + b"x", "too long"),
                (header(count=2**63) + good, f"{2**63} records", "split the trace into several runs"),
                (header(width=9000, height=1) + good, "9000 x 1"),
                (header(count=2) + good + record(kind=2), "record 1", "kind 2"),
                (header() + record(texture=3), "record 0", "texture 3"),
                (header() + record(coverage=16), "record 0", "coverage = 0x10"),
                (header() + record(clamped=255), "clamped = 0xff"),
                (header() + record(tail=b"\0\1\0"), "bytes 13 to 15"),
                (header() + record(values=[float("nan")] * 8), "record 0", "s0 = nan"),
                (header() + record(values=[0] * 7 + [float("-inf")]), "t3 = -inf"),
                (header() + record(values=[200] * 8), "s0 = 200", "subtract whole repeats"),
                (header() + record(x=0, y=0), "has no image size"),
                (header(width=8, height=8) + record(x=0, y=NONE), "outside the image"),
                (header(magic=b"DEBURRFX") + good, "not a fragment trace")):
            with self.subTest(says=says):
                self.rejected(content, *says)

    def test_rejects_trace_without_samples(self):
        self.rejected(TITLE + "end 0\n", "has no covered fragment", code=2)
        self.rejected(TITLE + QUAD.replace("f f", "0 f").replace("0 0 0 0", "0 - - 0", 1) + "end 1\n",
                     "has no covered fragment in 1 quads", code=2)

    def test_rejects_missing_file_and_folder(self):
        for name, says in (("missing", "no such file"), (".", "not a regular file")):
            self.expect(5, "run", "texture", "--fragments", name, "--out", "out", says=says)

    def test_rejects_options_without_effect_on_fragments(self):
        self.write("trace", TITLE + FRAGMENT + "end 1\n")
        for arguments in (["--size", "8x8"], ["--set", "scene.fov=1"], ["--truth"],
                          ["--set", "scene.visibility=overdraw"]):
            self.expect(2, "run", "texture", "--fragments", "trace", "--out", "out", *arguments)
        for engine in set(engines()) - {"texture"}:
            done = self.run_command("run", engine, "--set", "scene.fragments=trace", "--out", "out")
            self.assertEqual(done.returncode, 2, done.stderr)

    def test_results_do_not_replace_their_input(self):
        os.mkdir(self.path("out"))
        self.run_texture(0, "--fragment-trace", "text")
        before = open(self.path("out/fragments.trace"), "rb").read()
        self.expect(2, "run", "texture", "--fragments", "out/fragments.trace", "--fragment-trace", "text",
                    "--out", "out", says="would overwrite the input")
        # Nor is it removed with the results of the run that made it.
        self.expect(2, "run", "texture", "--fragments", "out/fragments.trace", "--out", "out",
                    says="would overwrite the input")
        self.assertEqual(open(self.path("out/fragments.trace"), "rb").read(), before)


class Lines(CommandTest):
    def test_rejects_options_without_effect_on_lines(self):
        self.run_texture(2, "--set", "run.line_trace_lookups=true", says="it needs run.line_trace")
        for more in ((), ("--show-config",)):
            self.expect(2, "run", "morphological", "--size", "32x32", "--line-trace", "text", "--out", "out",
                        *more, says="morphological.storage = memory")
        self.run_texture(2, "--line-trace", "yaml", says="none, text, binary")

    def test_keeps_foreign_file(self):
        os.mkdir(self.path("out"))
        self.write("out/lines.trace", "mine")
        self.run_texture(2, "--line-trace", "text", says="lines.trace")
        with open(self.path("out/lines.trace")) as file:
            self.assertEqual(file.read(), "mine")
        self.run_texture(0)

    def test_earlier_trace_goes_with_its_run(self):
        self.run_texture(0, "--line-trace", "text", "--fragment-trace", "binary")
        self.assertTrue(os.path.exists(self.path("out/lines.trace")))
        with open(self.path("out/manifest.json")) as file:
            self.assertIn("fragments.trace", json.load(file)["files"])
        self.run_texture(0)
        self.assertFalse(os.path.exists(self.path("out/lines.trace")))
        self.assertFalse(os.path.exists(self.path("out/fragments.trace")))

    def test_full_disk_keeps_earlier_results(self):
        self.run_texture(0, "--no-images")
        before = sorted(os.listdir(self.path("out")))
        with open(self.path("out/result.json")) as file:
            result = file.read()
        for what in ("--line-trace", "--fragment-trace"):
            for form in ("text", "binary"):
                lookups = ["--set", "run.line_trace_lookups=true"] if "line" in what else []
                done = self.expect(
                    5, "run", "texture", "--size", "128x128", "--no-images", what, form, *lookups,
                    "--out", self.path("out"),
                    preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (260_000, 260_000)),
                    says=["File too large", ".trace", "make room there"])
                self.assertNotIn("Traceback", done.stderr)
                self.assertEqual(sorted(os.listdir(self.path("out"))), before)
                with open(self.path("out/result.json")) as file:
                    self.assertEqual(file.read(), result)

    def test_aborted_run_leaves_complete_traces(self):
        self.run_texture(3, "--max-cycles", "1000", "--line-trace", "text", "--fragment-trace", "text",
                         says="1,000 cycles")
        for name, end in (("lines", "# end "), ("fragments", "end ")):
            with open(self.path(f"out/{name}.trace")) as file:
                last = file.read().splitlines()[-1]
            self.assertTrue(last.startswith(end), last)


if __name__ == "__main__":
    unittest.main()
