#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Injected faults (deburr run texture --fault NAME): each must be caught by the right check with the right exit code.
By default the link checkers are off, so that the scoreboards must find the fault; both settings are tested."""
import html
import json
import os
import random
import re
import struct
import unittest

from app_support import CommandTest


class Faults(CommandTest):
    UNCHECKED = ("--set", "run.watchdog_cycles=2000")
    CHECKED = UNCHECKED + ("--set", "run.check_links=true")

    def fault(self, name, code, says, *arguments):
        done = self.run_texture(code, "--fault", name, *arguments, says=says)
        with open(self.path("out/result.json")) as file:
            result = json.load(file)
        self.assertEqual(result["verdict"], "fail")
        self.assertTrue(result["reason"])
        self.assertTrue(os.path.exists(self.path("out/report.html")), "failed runs have a report")
        return done, result

    def test_passes_without_a_fault(self):
        self.run_texture(0, *self.CHECKED)
        self.run_texture(0, *self.UNCHECKED)

    def test_catches_flipped_bit(self):
        done, result = self.fault("flip-bit", 1, "mismatch", *self.UNCHECKED)
        self.assertEqual(result["checks"]["mismatches"], 1)
        # Pixel, tag, expected, got and cycle.
        self.assertRegex(done.stderr, r"cycle \d+: pixel \(\d+, \d+\): expected "
                                      r"tag \d+ lane \d .*RGBA .*, got .*RGBA")
        expected, got = map(int, re.search(r"\(expected/got: rgba\.r=(\d+)/(\d+)\)",
                                           done.stderr).groups())
        self.assertEqual(expected ^ got, 1 << 4, "the bit that `deburr params` promises")
        line, = result["first_mismatches"]
        self.assertEqual(line["check"], "colours")
        self.assertRegex(line["where"], r"^cycle \d+$")
        self.assertRegex(line["item"], r"^pixel \(\d+, \d+\)$")
        self.assertRegex(line["field"], "rgba|RGBA|r")
        with open(self.path("out/report.html")) as file:
            page = html.unescape(file.read().replace("<wbr>", ""))  # where a name may break
        for text in ("First mismatches", *line.values()):
            self.assertIn(f">{text}<", page)
        done, _ = self.fault("flip-bit", 3, "changed while it waited", *self.CHECKED)
        self.assertIn(f"(was/is): rgba.r={expected}/{got} ", done.stderr)

    def test_catches_dropped_colour(self):
        done, result = self.fault("drop-colour", 1, "mismatch", *self.UNCHECKED)
        self.assertEqual(result["checks"]["mismatches"], 1, "the rest is compared with its own")
        self.assertIn("next came", done.stderr)
        with open(self.path("out/manifest.json")) as file:
            captions = {i["role"]: i["caption"] for i in json.load(file)["images"]}
        self.assertIn("any difference is bright", captions["difference"])
        self.assertIn("1 pixels were not delivered", captions["after"])
        self.fault("drop-colour", 3, "vanished", *self.CHECKED)

    def test_catches_missing_last_colour(self):
        """No later colour would reveal the gap."""
        done, result = self.fault("drop:colours:1023", 1, "1 expected but never came", *self.UNCHECKED)
        self.assertEqual(result["checks"]["mismatches"], 1)
        self.assertEqual(result["scoreboards"]["colours"], {"comparisons": 1023, "mismatches": 1})

    def test_catches_duplicated_colour(self):
        done, result = self.fault("duplicate-colour", 1, "mismatch", *self.UNCHECKED)
        self.assertEqual(result["checks"]["mismatches"], 1)
        self.assertIn("expected it once, got again", done.stderr)
        self.fault("duplicate-colour", 3, "appeared", *self.CHECKED)

    def test_catches_dropped_quad(self):
        self.fault("drop-quad", 1, "mismatch", *self.UNCHECKED)
        self.fault("drop-quad", 3, "vanished", *self.CHECKED)

    def test_catches_duplicated_fetch(self):
        _, result = self.fault("duplicate-fetch", 1, "line fills", *self.UNCHECKED)
        self.assertEqual(result["scoreboards"]["colours"]["mismatches"], 0, "the picture is perfect")
        self.assertGreater(result["checks"]["traffic_mismatches"], 0)
        cycles = [int(re.fullmatch(r"cycle (\d+)", line["where"])[1]) for line in result["first_mismatches"]
                  if line["check"] == "line fills"]
        self.assertEqual(cycles, sorted(cycles))
        self.assertLess(cycles[0], result["cycles"] // 2, "when it was seen, not when it was over")

    def test_catches_duplicated_request(self):
        self.fault("duplicate-request", 3, "fill_buffer", *self.UNCHECKED)
        self.fault("duplicate-request", 3, "memory_requests", *self.CHECKED)

    def test_catches_stuck_ready(self):
        done, _ = self.fault("stuck-ready", 4, "no link has moved", *self.CHECKED)
        self.assertIn("texture.texels", done.stderr, "the dump names every link")
        self.assertIn("texture.texture_cache.tag_stage", done.stderr, "the dump names every unit")

    def test_catches_lost_response(self):
        done, _ = self.fault("lost-response", 4, "no link has moved", *self.CHECKED)
        self.assertIn("texture.texture_cache.memory_responses", done.stderr)

    def test_catches_memory_error(self):
        self.fault("memory-error", 3, "memory answered 1 line fills with an error", *self.CHECKED)

    def test_memory_error_by_address_is_predicted(self):
        done = self.run_texture(3, "--set", "memory.error_address=0",
                                "--set", "memory.error_bytes=100000000", says="with an error")
        with open(self.path("out/result.json")) as file:
            result = json.load(file)
        self.assertEqual(result["checks"]["mismatches"], 0, done.stderr)
        self.assertEqual(result["checks"]["traffic_mismatches"], 0)

    def test_golden_result_depends_on_memory_errors(self):
        def golden(*arguments):
            self.run_command("run", "texture", "--size", "32x32", "--out", self.path("out"), *arguments)
            with open(self.path("out/manifest.json")) as file:
                return json.load(file)["golden"]
        long_lines = ("--set", "texture.cache.line_bytes=128")
        error = ("--set", "memory.error_address=0", "--set", "memory.error_bytes=100000000")
        self.assertEqual(golden(), golden(*long_lines))
        self.assertNotEqual(golden(*error), golden(*error, *long_lines))
        self.assertEqual(golden(*error), golden(*error, "--set", "memory.latency=3"))

    def test_catches_wrong_texel(self):
        _, result = self.fault("wrong-texel", 1, "mismatch", *self.CHECKED)
        self.assertEqual(result["checks"]["traffic_mismatches"], 0,
                         "addresses do not depend on texels")

    def test_catches_wrong_directions_and_samples(self):
        for name in ("wrong-axis", "wrong-ratio", "wrong-count", "wrong-sample"):
            with self.subTest(name):
                self.fault(name, 1, "mismatch", *self.UNCHECKED)

    def test_catches_wrong_kernel(self):
        tilted = ("--scene", "tunnel", "--set", "texture.kernel=axis")
        self.fault("wrong-kernel", 1, "mismatch", *self.UNCHECKED, *tilted)
        self.run_texture(2, "--fault", "wrong-kernel", says="texture.kernel = axis")

    def test_catches_wrong_replacement(self):
        _, result = self.fault("wrong-replacement", 1, "line fills", *self.CHECKED, "--set",
                               "texture.cache.bytes=1024")
        self.assertGreater(result["checks"]["traffic_mismatches"], 0)

    def test_catches_faults_of_blocks(self):
        # KTX 1 of ETC2 RGB with random blocks, which have every mode: the encoder uses neither T nor H.
        blocks = random.Random(1).randbytes(16 * 16 * 8)
        modes = self.path("modes.ktx")
        with open(modes, "wb") as file:
            file.write(b"\xabKTX 11\xbb\r\n\x1a\n" + struct.pack(
                "<14I", 0x04030201, 0, 1, 0, 0x9274, 0x1907, 64, 64, 0, 0, 1, 1, 0, len(blocks)) + blocks)
        after, before = ("--set", "texture.decode=after"), ("--set", "texture.decode=before", "--set",
                                                            "texture.cache.compressed_lines=4")
        for name, form, *more in (
                ("swapped-modes", "etc2_rgb", *after, "--texture", modes), ("swapped-selectors", "bc1", *after),
                ("wrong-alpha-mode", "bc4", *after, "--texture", "stones"), ("wrong-edge-block", "bc1", *after),
                ("late-half", "bc3", *after), ("replaced-line", "bc1", *before)):
            with self.subTest(name):
                self.fault(name, 1, "mismatch", *self.UNCHECKED, "--format", form, *more)
        self.fault("late-half", 2, "needs texture.decode = after", *self.UNCHECKED)
        self.fault("replaced-line", 2, "needs texture.decode = before", *self.UNCHECKED)
        self.fault("late-half", 2, "needs a texture of bc3, bc5 or etc2_rgba8", *self.UNCHECKED, *after,
                   "--format", "bc1")

    def test_catches_fault_on_any_link(self):
        # The highest bit of the first texel's red.
        self.fault("flip:texture.texel_quads:12:texel.0.7", 1, "mismatch", *self.UNCHECKED)

    def test_max_cycles_ends_the_run(self):
        done = self.run_texture(3, "--max-cycles", "300",
                                says=["not done after 300 cycles", "--max-cycles"])
        last = done.stdout.strip().splitlines()[-1]
        self.assertRegex(last, r"FAIL simulation: .* [\d,]+ of 1,024 fragments are done; raise the limit")
        self.assertIn("texture.texels", done.stderr, "the dump names every link")
        with open(self.path("out/result.json")) as file:
            result = json.load(file)
        self.assertEqual((result["verdict"], result["cycles"]), ("fail", 300))

    def test_unknown_fault_is_rejected(self):
        self.run_texture(2, "--fault", "gremlin", says=["gremlin", "flip-bit"])
        done = self.run_texture(2, "--fault", "drop:no.such.link:1", says="no.such.link")
        last = done.stdout.strip().splitlines()[-1]
        self.assertIn("known: ", last)
        self.assertIn(", texture.texels", last, "the last line holds the whole message")

    def test_unreached_fault_fails_the_run(self):
        self.run_texture(3, "--fault", "drop:colours:100000000", *self.UNCHECKED,
                         says="never reached")


class Registers(CommandTest):
    """Each checked status register can fail the run by itself."""

    TEXTURE = ["fragments", "bilinears", "line-fills", "clamped", "saturated", "memory-errors", "invalid-fragments"]
    MORPHOLOGICAL = ["pixels", "edge-pixels", "horizontal-runs", "vertical-runs", "long-runs", "z-runs",
                     "extended-runs", "steps", "probes", "divides", "blended-pixels", "diagonals", "bypassed-pixels",
                     "frame-cycles", "memory-errors"]

    def test_texture_registers_are_checked(self):
        self.miscount("texture", self.TEXTURE)

    def test_morphological_registers_are_checked(self):
        self.miscount("morphological", self.MORPHOLOGICAL)


class Figures(CommandTest):
    """Each counter with a second source can fail the run."""

    def test_texture_figures_are_checked(self):
        self.wrong_figures("texture", 11, ["memory_port_reads", "miss_queue_fill_bytes"])

    def test_morphological_figures_are_checked(self):
        self.wrong_figures("morphological", 4, ["slot_sequencer_beats", "endpoint_predictor_v_iterations"])
        self.wrong_figures("morphological", 10, ["memory_port_bytes_written", "pixel_store_lines_read"],
                           "--storage", "memory")


class Fields(CommandTest):
    """Hardware decodes a field of a texture descriptor as a different value than software wrote."""

    def test_texture_fields_are_decoded(self):
        small, large = ("--size", "48x32"), ("--size", "48x32", "--scene", "quad", "--set", "scene.texture_size=8")
        runs = {f"texture0-{field}": small for field in (
            "size-width", "size-height", "mode-format", "mode-layout", "mode-srgb", "mode-wrap-s", "mode-wrap-t",
            "mode-min-filter", "mode-mag-filter", "mode-levels", "mode-max-count-log2", "lod-bias-bias", "lod-clamp-min-lod",
            "lod-clamp-max-lod")}
        self.misdecode("texture", {**runs, "texture0-mode-mag-filter": large})


class Blind(CommandTest):
    """A scoreboard that compares nothing fails the run, even if everything else is right."""
    TEXTURE = ("colours", "line-fills", "status-registers", "figures")
    MORPHOLOGICAL = ("pixels", "probes", "memory-lines", "status-registers", "figures")

    def test_texture_scoreboards_must_compare(self):
        boards = {f"blind-{board}" for board in self.TEXTURE}
        self.assertEqual(self.known("texture"), boards)
        needed = {board: self.blind("texture", board) for board in boards}
        self.assertEqual(needed["blind-colours"], 32 * 32)
        self.assertEqual(needed["blind-status-registers"], 7)
        self.run_texture(0)
        self.assertEqual(needed["blind-line-fills"], self.result()["memory"]["lines_filled"])

    def test_morphological_scoreboards_must_compare(self):
        memory = ("--storage", "memory")
        boards = {f"blind-{board}" for board in self.MORPHOLOGICAL}
        self.assertEqual(self.known("morphological", *memory), boards)
        self.assertEqual(self.known("morphological"), boards - {"blind-memory-lines"})
        needed = {board: self.blind("morphological", board, *memory) for board in boards}
        self.assertEqual(needed, {"blind-pixels": 32 * 32, "blind-probes": 32 * 32,
                                  "blind-memory-lines": 2 * 2 * 32, "blind-status-registers": 15,
                                  "blind-figures": 10})


if __name__ == "__main__":
    unittest.main()
