#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Bad input and injected faults of `deburr run morphological` and `deburr run frame`: each has its exit code and a
message that names the error; unusual but legal frames pass. See --help of unittest."""
import json
import os
import random
import struct
import unittest
import zlib

from app_support import CommandTest, float_tiff, png


def noisy_png(width, height, seed=1):
    """Black and white at random: edges everywhere."""
    bits = random.Random(seed)
    rows = b"".join(b"\0" + b"".join(bytes([bits.choice((0, 255))]) * 3 for _ in range(width)) for _ in range(height))

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0))
            + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


def rgb_png(width, pixels):
    """A PNG of these pixels, three bytes each."""
    rows = b"".join(b"\0" + b"".join(pixels[i:i + width]) for i in range(0, len(pixels), width))

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    return (b"\x89PNG\r\n\x1a\n"
            + chunk(b"IHDR", struct.pack(">IIBBBBB", width, len(pixels) // width, 8, 2, 0, 0, 0))
            + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


class Base(CommandTest):
    def run_engine(self, code, *arguments, says=(), engine="morphological", **options):
        return self.expect(code, "run", engine, "--out", self.path("out"), *arguments, says=says, **options)

    def result(self):
        with open(self.path("out/result.json")) as file:
            return json.load(file)


DEPTH_EDGES = ("--set", "morphological.edges.source=depth")


class Frames(Base):
    """Image files as frames."""

    def frame(self, code, name, content, *arguments, says=()):
        return self.run_engine(code, "--in", self.write(name, content), *arguments, says=says)

    def test_rejects_missing_image(self):
        self.run_engine(5, "--in", self.path("missing.png"), says="missing.png")

    def test_unknown_scene_suggests_similar_name(self):
        self.run_engine(2, "--scene", "cylinder", says=["cylinder", "road"])

    def test_rejects_folder_as_image(self):
        os.mkdir(self.path("folder.png"))
        self.run_engine(5, "--in", self.path("folder.png"), says="folder.png")

    def test_rejects_empty_image(self):
        self.frame(5, "empty.png", b"", says="empty.png")

    def test_rejects_truncated_image(self):
        whole = noisy_png(64, 64)
        done = self.frame(5, "truncated.png", whole[:len(whole) // 2], says="truncated.png")
        self.assertEqual(len(done.stderr.splitlines()), 1, "a library's own message, or one of several lines")

    def test_rejects_corrupt_image(self):
        broken = bytearray(noisy_png(64, 64))
        for i in range(45, len(broken) - 12):
            broken[i] ^= 0x5A
        self.frame(5, "corrupt.png", bytes(broken), says="corrupt.png")

    def test_rejects_text_as_image(self):
        self.frame(5, "text.png", b"this is no image at all\n" * 10, says="text.png")

    def test_rejects_image_that_is_too_large(self):
        self.frame(5, "huge.png", png(4, 4, declared=(60000, 60000)), says="huge.png")
        self.frame(5, "wide.png", png(8193, 1), says=["wide.png", "8192"])

    def test_rejects_frame_wider_than_line_buffers(self):
        self.frame(2, "wide.png", png(65, 2), "--set", "morphological.line_pixels=64", says="line_pixels")

    def test_accepts_largest_width(self):
        self.frame(0, "widest.png", png(8192, 1), says="PASS")

    def test_accepts_one_pixel_row_and_column(self):
        self.frame(0, "one.png", png(1, 1), says="PASS")
        self.frame(0, "row.png", noisy_png(200, 1), says="PASS")
        self.frame(0, "column.png", noisy_png(1, 200), says="PASS")

    def test_accepts_frame_full_of_edges(self):
        self.frame(0, "noise.png", noisy_png(90, 60), says="PASS")
        self.assertGreater(self.result()["work"]["edge_pixels_percent"], 50)

    def test_flat_frame_blends_nothing(self):
        self.frame(0, "flat.png", png(40, 30), says="PASS")
        self.assertEqual(self.result()["work"]["blended_pixels_percent"], 0)

    def test_accepts_16_bit_image(self):
        self.frame(0, "deep.png", png(16, 16, bits=16), says="PASS")

    def test_accepts_grey_and_alpha(self):
        self.frame(0, "grey.png", png(16, 16, channels=1), says="PASS")
        self.frame(0, "grey_alpha.png", png(16, 16, channels=2), says="PASS")
        self.frame(0, "alpha.png", png(16, 16, channels=4), says="PASS")

    def test_accepts_float_image(self):
        self.frame(0, "float.tif", float_tiff(16, 16), says="PASS")
        self.frame(0, "nan.tif", float_tiff(16, 16, float("nan")), says="PASS")

    def test_rejects_reference_and_depth_of_other_size(self):
        self.frame(2, "a.png", png(16, 16), "--truth", self.write("b.png", png(15, 16)), says=["b.png", "15 x 16"])
        self.frame(2, "a.png", png(16, 16), *DEPTH_EDGES, "--depth", self.write("d.png", png(16, 17)),
                   says=["d.png", "16 x 17"])
        self.frame(5, "a.png", png(16, 16), "--truth", self.path("none.png"), says="none.png")
        self.frame(5, "a.png", png(16, 16), *DEPTH_EDGES, "--depth", self.write("g.png", png(16, 16, channels=1)),
                   says="g.png")
        self.frame(0, "a.png", noisy_png(16, 16), "--truth", self.write("t.png", png(16, 16)), says="PASS")
        self.assertIn("psnr_edge_db", self.result()["quality"])

    def test_rejects_depth_edges_without_depth(self):
        for source in ("depth", "predicated"):
            edges = ("--set", "morphological.edges.source=" + source)
            self.frame(2, "a.png", png(16, 16), *edges, says=[source, "--depth FILE"])
            self.frame(0, "a.png", noisy_png(16, 16), *edges, "--depth", self.write("d.png", noisy_png(16, 16)))
            self.run_engine(0, "--size", "16x16", *edges)
            self.run_engine(0, "--size", "16x16", *edges, engine="frame")

    def test_accepts_depth_of_16_bit_grey(self):
        done = self.frame(0, "a.png", noisy_png(16, 16), *DEPTH_EDGES, "--depth",
                          self.write("d.png", png(16, 16, bits=16, channels=1)), says="PASS")
        self.assertIn("'%s': 16-bit grey read as near / w" % self.path("d.png"), done.stderr)
        self.assertNotIn("looks like a picture", done.stderr)
        self.frame(5, "a.png", png(16, 16), *DEPTH_EDGES, "--depth", self.write("c.png", png(16, 16, bits=16)),
                   says=["c.png", "this one has 3 channels of uint16"])

    def test_notes_depth_that_looks_like_a_picture(self):
        picture = [bytes((x * 5 % 256, x * 5 % 256 // 2 + y, x * 5 % 256)) for y in range(32) for x in range(48)]
        depth = [(9_000_000 + 70_001 * x + 30_011 * y).to_bytes(3, "big") for y in range(32) for x in range(48)]
        frame = self.write("a.png", noisy_png(48, 32))
        for pixels, noted in ((picture, True), (depth, False)):
            done = self.run_engine(0, "--in", frame, *DEPTH_EDGES, "--depth", self.write("d.png", rgb_png(48, pixels)))
            self.assertEqual("looks like a picture" in done.stderr, noted)

    def test_rejects_depth_that_is_not_finite(self):
        """Such a depth is without distance: silhouettes and edges would be found around it."""
        depths = [0.25] * 256
        depths[16 * 3 + 5] = depths[16 * 3 + 6] = float("nan")
        depth = ("--depth", self.write("nan.tif", float_tiff(16, 16, depths, channels=1)))
        says = ["nan.tif", "2 of 256 values are NaN", "the first at (5, 3)", "write 0 (infinitely far)"]
        self.frame(5, "a.png", noisy_png(16, 16), *DEPTH_EDGES, *depth, says=says)
        self.frame(5, "a.png", noisy_png(16, 16), "--truth", self.write("t.png", png(16, 16)), *depth, says=says)

    def test_notes_clamped_depth(self):
        for beyond, noted in ((1.0, False), (0.0, False), (1.5, True), (-0.1, True)):
            depth = self.write("d.tif", float_tiff(16, 16, [0.25] * 100 + [beyond] * 2 + [0.5] * 154, channels=1))
            done = self.frame(0, "a.png", noisy_png(16, 16), *DEPTH_EDGES, "--depth", depth)
            self.assertEqual("2 of 256 values lie outside [0, 1], the first at (4, 6)" in done.stderr, noted,
                             done.stderr)

    def test_rejects_reference_for_a_scene(self):
        self.run_engine(2, "--scene", "road", "--truth", self.write("t.png", png(4, 4)), says="scene has its own")


class Configuration(Base):
    """Presets, settings that override them, and invalid combinations."""
    SMALL = ("--size", "48x40")

    def test_rejects_unknown_preset(self):
        self.run_engine(2, *self.SMALL, "--preset", "smoothest", says="mlaa")
        self.assertFalse(os.path.exists(self.path("out/result.json")))

    def test_quality_selects_a_preset_of_smaa(self):
        for preset in ("smaa", "smaa-dynamic"):
            for quality, rows, steps in (("low", 38, 4), ("medium", 70, 8), ("high", 134, 16), ("ultra", 258, 32)):
                shown = self.run_engine(0, "--preset", preset, "--set", f"morphological.quality={quality}",
                                        "--show-config").stdout
                self.assertIn(f"morphological.window_rows: {rows}", shown)
                self.assertIn(f"morphological.search_steps: {steps}", shown)
                self.assertIn(f"By preset {preset}, quality {quality}.", shown)
        given = self.run_engine(0, "--preset", "smaa", "--set", "morphological.window_rows=40", "--show-config").stdout
        self.assertIn("morphological.window_rows: 40", given)
        self.assertNotIn("# morphological.window_rows", given)

    def test_rejects_impossible_combinations(self):
        self.run_engine(2, *self.SMALL, "--set", "morphological.diagonals=true", says="learned with diagonals")
        self.run_engine(2, *self.SMALL, "--preset", "mlaa", "--set", "morphological.diagonals=true", "--set",
                        "morphological.diagonal_steps=10", "--set", "morphological.window_rows=20",
                        says=["diagonal_steps", "window_rows of at least 22"])
        self.run_engine(2, *self.SMALL, "--preset", "smaa", "--set", "morphological.search_steps=113", says="1..112")
        self.run_engine(2, *self.SMALL, "--set", "morphological.window_rows=33", says="window_rows")
        self.run_engine(2, *self.SMALL, "--set", "morphological.steps=16", "--set", "morphological.window_rows=20",
                        says="steps")
        self.run_engine(2, *self.SMALL, "--set", "morphological.edges.source=predicated", "--set",
                        "morphological.edges.threshold_mode=dynamic", says="predicated")
        self.run_engine(2, *self.SMALL, "--lanes", "3", says="1, 2, 4")

    RANGES = {"edges.threshold": (1, 16777215), "edges.alpha": (0, 16777215), "edges.floor": (1, 16777215),
              "search_steps": (1, 112), "diagonal_steps": (1, 16), "corner_rounding": (0, 256)}

    def test_rejects_smaa_numbers_out_of_range(self):
        """Distances up to 2N pixels lie within the 225 of the tables for every N, so every table fits; a larger N is
        out of range."""
        for name, (least, most) in self.RANGES.items():
            for value in (least - 1, most + 1, "few", 0.5):
                self.run_engine(2, *self.SMALL, "--preset", "smaa", "--set", f"morphological.{name}={value}",
                                says=[f"morphological.{name}", f"{least}..{most}"])
        self.assertFalse(os.path.exists(self.path("out")))

    def test_accepts_smaa_numbers_at_ends_of_range(self):
        """Also alpha and T far outside the values in the paper."""
        for name, ends in self.RANGES.items():
            preset = "smaa-dynamic" if name in ("edges.alpha", "edges.floor") else "smaa"
            for value in ends:
                self.run_engine(0, *self.SMALL, "--preset", preset, "--set", f"morphological.{name}={value}",
                                says="PASS")

    def test_notes_thresholds_below_one_code(self):
        """Legal, but probably written when thresholds were fractions of full scale."""
        predicated = ("--set", "morphological.edges.source=predicated")
        dynamic = ("--preset", "smaa-dynamic")
        for name, least, rules in (("edges.threshold", 65536, ()), ("edges.threshold_on_depth_edge", 65536, predicated),
                                   ("edges.threshold_off_depth_edge", 65536, predicated),
                                   ("edges.floor", 65536, dynamic), ("edges.alpha", 65794, dynamic)):
            for value in (least - 1, least):
                done = self.run_engine(0, *self.SMALL, *rules, "--set", f"morphological.{name}={value}")
                self.assertEqual(f"note: morphological.{name} = {value} is " in done.stderr, value < least, done.stderr)
        for rules in ((), predicated, dynamic, (*dynamic, "--set", "morphological.edges.alpha=0")):
            self.assertNotIn("morphological.edges.", self.run_engine(0, *self.SMALL, *rules).stderr)
        done = self.run_engine(0, *self.SMALL, "--set", "morphological.edges.threshold=5140", engine="frame")
        self.assertIn("= 5140 is 0.07843 of a code, so noise makes edges: its unit is code / 65536; multiply values "
                      "for versions before 0.3.0 by 255", done.stderr)
        done = self.run_engine(0, *self.SMALL, "--set", "morphological.edges.threshold=65535")
        self.assertIn("= 65535 is 0.99998 of a code", done.stderr)
        # Below a code, alpha decides nothing if the floor is a code; a lower floor may be below alpha times luma.
        for floor, decides in ((65536, ", so edges.floor alone decides"), (65535, "")):
            done = self.run_engine(0, *self.SMALL, *dynamic, "--set", "morphological.edges.alpha=65793", "--set",
                                   f"morphological.edges.floor={floor}")
            self.assertIn(f"edges.alpha = 65793 is 0.00392, below one code even for white{decides}: its unit is "
                          "1 / 16777216; multiply values for versions before 0.3.0 by 256", done.stderr)

    def test_rejects_unknown_smaa_choices(self):
        for name, known in (("quality", "low, medium, high, ultra"), ("ends", "gaps, crossings"),
                            ("border", "end, clamp"), ("area_values", "exact, published"),
                            ("area", "analytic, table_full, table_merged, table_minimal"),
                            ("blend", "longest, strongest"), ("edges.dynamic_luma", "current, max, min, mean"),
                            ("edges.local_contrast", "off, paper, symmetric, smaa"), ("diagonals", "true or false"),
                            ("round_corners", "true or false")):
            self.run_engine(2, *self.SMALL, "--preset", "smaa", "--set", f"morphological.{name}=none-such",
                            says=[f"morphological.{name}", "none-such", known])
        self.run_engine(2, *self.SMALL, "--preset", "smaa2", says=["smaa2", "did you mean 'smaa'?", "smaa-dynamic"])
        self.assertFalse(os.path.exists(self.path("out")))

    def test_rejects_illegal_smaa_combinations(self):
        """Combinations that the contract rejects, and similar legal ones."""
        smaa = ("--preset", "smaa")

        def rows(steps, window):
            return self.SMALL + smaa + ("--set", f"morphological.diagonal_steps={steps}", "--set",
                                        f"morphological.window_rows={window}")

        for steps in (5, 6, 15, 16):
            least = 2 * steps + 2
            self.run_engine(2, *rows(steps, least - 2), says=["diagonal_steps", f"window_rows of at least {least}"])
            self.run_engine(0, *rows(steps, least), says="PASS")
        # Without diagonals the same search range is legal.
        self.run_engine(0, *self.SMALL, *smaa, "--set", "morphological.diagonals=false", "--set",
                        "morphological.window_rows=10", says="PASS")
        self.run_engine(2, *self.SMALL, "--preset", "smaa-dynamic", "--set", "morphological.edges.source=predicated",
                        says=["predicated", "threshold_mode = fixed"])
        self.run_engine(0, *self.SMALL, *smaa, "--set", "morphological.edges.source=predicated", says="PASS")
        # Runs continue past this border: without a search nothing can continue.
        for name, value in (("ends", "gaps"), ("area", "analytic")):
            one = ("--set", f"morphological.{name}={value}")
            self.run_engine(2, *self.SMALL, *smaa, *one, says=["morphological.border", name, "must be end"])
            self.run_engine(0, *self.SMALL, *smaa, *one, "--set", "morphological.border=end", says="PASS")
        self.run_engine(2, *self.SMALL, "--preset", "mlaa", "--set", "morphological.border=clamp", says="must be end")

    def test_setting_overrides_preset(self):
        done = self.run_engine(0, "--preset", "mlaa-slope", "--set", "morphological.steps=8", "--show-config")
        self.assertIn("morphological.steps: 8", done.stdout)
        self.assertIn('morphological.predictor: "chord"', done.stdout)

    def test_rejects_parameters_without_effect(self):
        image = ("--in", self.write("a.png", noisy_png(16, 16)))
        morphological = [
            (image, "--size", "10x10", "determines the size"),
            (image, "--set", "frame.reference_samples=8", "--truth"),
            (image, "--depth", self.write("d.png", noisy_png(16, 16)), "--truth FILE"),
            ((), "--set", "memory.latency=100", "line_buffers"),
            ((), "--set", "morphological.memory.outstanding=8", "line_buffers"),
            ((), "--set", "morphological.edges.alpha=9", "threshold_mode = dynamic"),
            ((), "--set", "morphological.edges.floor=9", "threshold_mode = dynamic"),
            ((), "--set", "morphological.edges.dynamic_luma=current", "threshold_mode = dynamic"),
            ((), "--set", "morphological.edges.depth_threshold=9", "depth or predicated"),
            ((), "--set", "morphological.edges.threshold_on_depth_edge=9", "predicated"),
            ((), "--set", "morphological.edges.threshold_off_depth_edge=9", "predicated"),
            (DEPTH_EDGES, "--set", "morphological.edges.threshold=9", "thresholds of its own"),
            (DEPTH_EDGES, "--set", "morphological.edges.local_contrast=off", "compares depths"),
            (("--set", "morphological.edges.threshold_mode=dynamic"), "--set", "morphological.edges.threshold=9",
             "computes the threshold"),
            (("--preset", "mlaa"), "--set", "morphological.steps=3", "extends no run"),
            ((), "--set", "morphological.quality=low", "morphological.preset = smaa or smaa-dynamic"),
            ((), "--set", "morphological.search_steps=8", "area = analytic"),
            ((), "--set", "morphological.area_values=published", "morphological.area or morphological.diagonals"),
            ((), "--set", "morphological.diagonal_steps=4", "diagonals = true"),
            (("--preset", "smaa", "--set", "morphological.quality=low"), "--set", "morphological.diagonal_steps=4",
             "diagonals = true"),
            ((), "--set", "morphological.corner_rounding=0", "round_corners = true"),
            (("--preset", "smaa-dynamic"), "--set", "morphological.edges.threshold=9", "computes the threshold"),
            ((), "--trace-to", "100", "run.trace")]
        for others, option, value, why in morphological:
            self.run_engine(2, *others, option, value, says=["has no effect", why])
        memory = ("--set", "morphological.storage=memory")
        for name, value in (("interleave_bytes", 128), ("error_bytes", 128), ("latency_max", 50)):
            self.run_engine(2, *memory, "--set", f"memory.{name}={value}", says="has no effect")
        self.run_engine(2, "--set", "frame_memory.latency=9", engine="frame", says="line_buffers")
        self.run_engine(2, "--set", "memory.error_bytes=9", engine="texture", says="error_address")
        self.assertFalse(os.path.exists(self.path("out")))

    def configuration(self, *arguments):
        return self.write("rules.yaml", self.run_engine(0, *arguments, "--show-config").stdout)

    def test_resolved_configuration_repeats_itself(self):
        for rules in ((), ("--preset", "mlaa"), ("--preset", "mlaa-slope", "--set", "morphological.steps=8"),
                      ("--in", self.write("a.png", noisy_png(16, 16)))):
            text = self.run_engine(0, *rules, "--show-config").stdout
            again = self.run_engine(0, "--config", self.write("rules.yaml", text), "--show-config").stdout
            self.assertEqual(text, again, rules)

    def title(self):
        with open(self.path("out/manifest.json")) as file:
            return json.load(file)["summary"]

    def test_preset_overrides_resolved_configuration(self):
        """The preset takes effect; settings that had been changed stay changed and are reported."""
        config = ("--config", self.configuration("--preset", "mlaa-slope", *self.SMALL))
        self.run_engine(0, *config, "--preset", "mlaa")
        self.assertIn("preset mlaa: ", self.title())
        self.assertIn("predictor none with N = 0", self.title())
        config = ("--config", self.configuration("--preset", "mlaa-slope", "--set", "morphological.steps=8", *self.SMALL))
        self.run_engine(0, *config)
        self.assertIn("preset mlaa-slope, changed: steps: ", self.title())
        self.run_engine(0, *config, "--preset", "deburr", "--set", "morphological.predictor=chord", "--set",
                        "morphological.steps=4")
        self.assertIn("preset deburr, changed: predictor, steps: ", self.title())
        self.run_engine(0, *self.SMALL, "--preset", "mlaa", "--set", "morphological.predictor=fit", engine="frame")
        self.assertIn("preset mlaa, changed: predictor", self.title())

    def expect(self, code, *arguments, says=(), **options):
        if "--show-config" in arguments:  # prints a configuration and no RESULT line
            done = self.run_command(*arguments, **options)
            self.assertEqual(done.returncode, code, done.stdout + done.stderr)
            return done
        return super().expect(code, *arguments, says=says, **options)

    def test_frame_keeps_codes(self):
        srgb = ("--set", "sampler.format=srgb8_a8", "--set")
        self.run_engine(2, *self.SMALL, *srgb, "texture.srgb_output=linear", engine="frame",
                        says="texture.srgb_output = encoded")
        self.run_engine(0, *self.SMALL, *srgb, "texture.srgb_output=encoded", "--truth", engine="frame", says="PASS")
        self.assertEqual(self.result()["memories"]["texture_filter_pipeline_codes"]["words"], 4096)
        encoded = self.result()["quality"]["psnr_db"]
        self.run_engine(0, *self.SMALL, "--truth", engine="frame", says="PASS")
        self.assertGreater(encoded, self.result()["quality"]["psnr_db"] + 0.5)  # filtered in linear light

    def test_frame_passes(self):
        self.run_engine(0, *self.SMALL, engine="frame", says="PASS")
        work = self.result()["work"]
        self.assertGreater(work["texturing_cycles"], 0)
        self.assertGreater(work["smoothing_cycles"], 0)


class Faults(Base):
    """Every injected fault must be found by the right check; without link checkers by the scoreboards."""
    SMALL = ("--size", "64x48", "--set", "run.watchdog_cycles=2000")
    CHECKED = SMALL + ("--set", "run.check_links=true")
    UNCHECKED = SMALL + ("--set", "run.check_links=false")
    MEMORY = ("--storage", "memory")

    def fault(self, name, code, says, *arguments, engine="morphological"):
        done = self.run_engine(code, "--fault", name, *arguments, says=says, engine=engine)
        self.assertEqual(self.result()["verdict"], "fail")
        self.assertTrue(os.path.exists(self.path("out/report.html")), "a failed run has a report too")
        return done

    def test_passes_without_a_fault(self):
        self.run_engine(0, *self.CHECKED)
        self.run_engine(0, *self.UNCHECKED, *self.MEMORY)
        self.assertGreater(self.result()["checks"]["traffic_comparisons"], 0)

    def test_catches_flipped_bit(self):
        done = self.fault("flip-bit", 1, "mismatch", *self.UNCHECKED)
        self.assertEqual(self.result()["checks"]["mismatches"], 1)
        self.assertRegex(done.stderr, r"cycle \d+: pixel \(36, 1\): expected RGBA .*, got RGBA")
        self.fault("flip-bit", 3, "changed while it waited", *self.CHECKED)

    def test_catches_dropped_pixel(self):
        self.fault("drop-pixel", 1, "end of row", *self.UNCHECKED)
        self.assertLess(self.result()["checks"]["mismatches"], 2 * 64, "only its own row is spoiled")
        self.fault("drop-pixel", 3, "vanished", *self.CHECKED)

    def test_catches_duplicated_pixel(self):
        self.fault("duplicate-pixel", 1, "mismatch", *self.UNCHECKED)
        self.assertLess(self.result()["checks"]["mismatches"], 2 * 64, "only its own row is spoiled")
        self.fault("duplicate-pixel", 3, "appeared", *self.CHECKED)

    def test_catches_dropped_input(self):
        self.fault("drop-input", 4, "deadlock", *self.UNCHECKED)

    def test_catches_wrong_edge(self):
        self.fault("wrong-edge", 1, "edges", *self.UNCHECKED)

    def test_catches_wrong_configuration(self):
        self.fault("wrong-rule", 1, "mismatch", "--scene", "cylinders", "--size", "200x150")

    def test_catches_stuck_ready(self):
        self.fault("stuck-ready", 4, "morphological.slots", *self.CHECKED)

    def test_catches_duplicated_request(self):
        self.fault("duplicate-fetch", 1, "memory lines", *self.UNCHECKED, *self.MEMORY)
        result = self.result()
        self.assertRegex(result["first_mismatches"][0]["where"], r"^cycle \d+$")
        self.assertLess(int(result["first_mismatches"][0]["where"].split()[1]), result["cycles"] // 2, "request 20")
        self.fault("duplicate-fetch", 3, "appeared", *self.CHECKED, *self.MEMORY)

    def test_catches_lost_response(self):
        self.fault("lost-response", 4, "memory", *self.CHECKED, *self.MEMORY)

    def test_catches_memory_error(self):
        self.fault("memory-error", 3, "1 lines with an error", *self.CHECKED, *self.MEMORY)

    def test_errors_by_address_are_predicted(self):
        self.run_engine(3, *self.CHECKED, *self.MEMORY, "--set", "memory.error_address=256", says="with an error")
        self.assertEqual(self.result()["checks"]["mismatches"], 0)

    def test_rejects_memory_faults_without_memory(self):
        self.run_engine(2, *self.CHECKED, "--fault", "lost-response", says="storage = memory")

    def test_max_cycles_ends_the_run(self):
        self.run_engine(3, *self.CHECKED, "--max-cycles", "1000", says=["not done after 1,000", "of 3,072 pixels"])
        self.assertEqual(self.result()["cycles"], 1000)
        self.run_engine(3, *self.CHECKED, "--max-cycles", "1000", engine="frame", says="of 3,072 pixels")
        # The second of two frames has no cycles left.
        self.run_engine(0, *self.CHECKED)
        cycles = str(self.result()["cycles"])
        self.run_engine(3, *self.CHECKED, "--max-cycles", cycles, "--set", "frame.count=2", says="3,072 of 6,144")

    def test_unknown_fault_is_rejected(self):
        self.run_engine(2, *self.CHECKED, "--fault", "gremlin", says=["gremlin", "flip-bit"])

    def test_catches_flipped_bits_in_a_frame(self):
        self.fault("flip:colours:50:56", 1, "mismatch", *self.UNCHECKED, engine="frame")
        self.fault("flip:blended:50:4", 1, "mismatch", *self.UNCHECKED, engine="frame")

    def test_link_checkers_are_off_by_default(self):
        self.fault("morphological.flip-bit", 1, "mismatch", *self.SMALL, engine="frame")
        self.fault("flip-bit", 1, "mismatch", *self.SMALL)

    def test_every_output_bit_of_a_frame_is_checked_or_rejected(self):
        """Including flags; a bit that the beat does not have is rejected."""
        # Per lane: 32 bits of the pixel, 19 of the blend decision, 3 of the count, 2 flags.
        for bit in (0, 31, 32, 33, 48, 50, 51, 53, 54, 55):
            self.fault(f"flip:blended:100:{bit}", 1, "mismatch", *self.UNCHECKED, engine="frame")
        for bit in (56, 264, 100000):
            self.run_engine(2, *self.UNCHECKED, "--fault", f"flip:blended:100:{bit}", engine="frame",
                            says=f"no bit {bit}: the payload has 56 bits")

    def test_frame_reports_texture_memory_errors(self):
        self.run_engine(3, *self.SMALL, "--set", "memory.error_address=0", "--set", "memory.error_bytes=100000000",
                        engine="frame", says="line fills with an error")
        self.assertEqual(self.result()["checks"]["mismatches"], 0, "golden reads zero too")
        self.assertEqual(self.result()["checks"]["traffic_mismatches"], 0)

    def test_frame_reports_frame_memory_errors(self):
        self.run_engine(3, *self.SMALL, *self.MEMORY, "--set", "frame_memory.error_address=256", engine="frame",
                        says=["lines with an error", "frame_memory.error_address"])
        self.assertEqual(self.result()["checks"]["mismatches"], 0)

    def test_catches_named_faults_in_a_frame(self):
        for name, checked, unchecked in (
                ("morphological.flip-bit", 3, 1), ("drop-pixel", 3, 1), ("duplicate-pixel", 3, 1),
                ("texture.flip-bit", 3, 1), ("drop-colour", 3, 4), ("morphological.stuck-ready", 4, 4),
                ("texture.lost-response", 4, 4), ("texture.memory-error", 3, 3), ("wrong-texel", 1, 1)):
            with self.subTest(name):
                self.fault(name, checked, "", *self.CHECKED, engine="frame")
                self.fault(name, unchecked, "", *self.UNCHECKED, engine="frame")
        self.run_engine(2, *self.CHECKED, "--fault", "gremlin", engine="frame", says=["gremlin", "texture.flip-bit"])
        self.run_engine(2, *self.CHECKED, "--fault", "flip-bit", engine="frame",
                        says="texture.flip-bit or morphological.flip-bit")
        self.run_engine(2, *self.CHECKED, "--fault", "morphological.lost-response", engine="frame",
                        says="storage = memory")
        self.fault("stuck_ready:pixels:300", 4, "pixels", *self.CHECKED, engine="frame")


def stair_png(size):
    """White beneath a rising staircase with steps of one pixel: one diagonal over the whole frame."""
    return rgb_png(size, [bytes([255 if x + y >= size else 0]) * 3 for y in range(size) for x in range(size)])


def columns_png(height, colours):
    """One column per colour."""
    return rgb_png(len(colours), [bytes(colour) for _ in range(height) for colour in colours])


class BlockFaults(Base):
    """Scoreboards find faults in blocks. The link checkers find faults of links first, with their own exit code."""
    SMALL = ("--size", "64x48", "--set", "run.watchdog_cycles=2000")
    passed = set()  # runs without a fault, keyed by file content

    def passes(self, *arguments, engine="morphological"):
        run = [engine]
        for word in arguments:
            if os.path.isfile(word):
                with open(word, "rb") as file:
                    word = file.read()
            run.append(word)
        if tuple(run) not in self.passed:
            self.run_engine(0, *arguments, engine=engine)
            self.passed.add(tuple(run))

    def fault(self, name, *arguments, code=1, says="mismatch", unchecked=None, **options):
        self.passes(*arguments, **options)  # without the fault the run passes
        for checked, expected in ((False, unchecked or code), (True, code))[:2 if unchecked else 1]:
            links = ("--set", f"run.check_links={str(checked).lower()}")
            self.run_engine(expected, "--fault", name, *links, *arguments, says=says if expected == code else (),
                            **options)
            self.assertEqual(self.result()["verdict"], "fail")
            if expected == 1:
                self.assertGreater(self.result()["checks"]["mismatches"], 0)

    def rules(self, **given):
        return [word for name, value in given.items()
                for word in ("--set", f"morphological.{name.replace('__', '.')}={value}")]

    def picture(self, name, content):
        return ("--in", self.write(name, content), "--set", "run.watchdog_cycles=2000")


class WeightsFaults(BlockFaults):
    """Faults in edges from colour and in learned weights, and the effect of a mask."""

    def noise(self):
        return self.picture("noise.png", noisy_png(48, 40))

    def test_catches_a_bit_of_each_weight_table(self):
        for name in ("wrong-weight", "wrong-near", "wrong-far", "wrong-sum"):
            with self.subTest(name):
                self.fault(name, *self.noise())

    def test_catches_wrong_edges_from_luma(self):
        # Hues of equal luma, as nearly as codes allow.
        hues = self.picture("hues.png", columns_png(8, [(128, 40, 70)] * 6 + [(10, 76, 64)] * 6))
        self.fault("wrong-colour", *hues)

    def test_catches_faults_of_links(self):
        for name in ("wrong-class", "wrong-code", "wrong-axis"):
            with self.subTest(name):
                self.fault(name, *self.noise(), code=3, unchecked=1, says="changed while it waited")
        self.fault("drop-line", *self.noise(), code=3, unchecked=4, says="vanished")

    def test_faults_in_absent_hardware_are_rejected(self):
        for name in ("wrong-weight", "wrong-near", "wrong-far", "wrong-sum", "wrong-class", "wrong-code",
                     "wrong-axis", "drop-line"):
            self.run_engine(2, *self.SMALL, "--preset", "deburr-line", "--fault", name,
                            says=[name, "needs", "area = learned"])
        self.run_engine(2, *self.SMALL, "--preset", "deburr-line", "--fault", "wrong-colour",
                        says=["wrong-colour", "needs", "edges.source = colour"])

    def test_rejects_incompatible_settings(self):
        for rules, says in (({"edges__threshold_mode": "dynamic"}, "dynamic"),
                            ({"diagonals": "true"}, "learned"), ({"round_corners": "true"}, "learned")):
            self.run_engine(2, *self.SMALL, *self.rules(**rules), says=says)
        self.run_engine(2, *self.SMALL, *self.rules(search_steps=4), says="learned search nothing")
        self.run_engine(2, *self.SMALL, *self.rules(edges__depth_threshold=4), says="source = depth")

    def mask(self, marks):
        """Red where a pixel is marked; the other channels are inverted."""
        return self.write("mask.png", rgb_png(48, [bytes((red, 255 - red, 255)) for red in marks]))

    def test_marked_pixels_are_not_blended(self):
        noise = self.noise()
        for preset in ("deburr", "deburr-line", "mlaa", "smaa"):
            for marks, blends in (([255] * 1920, False), ([128] * 1920, False), ([127] * 1920, True),
                                  ([255 * (i % 48 < 24) for i in range(1920)], True)):
                self.run_engine(0, *noise, "--preset", preset, "--mask", self.mask(marks))
                work = self.result()["work"]
                self.assertEqual(work["blender_blended_pixels"] > 0, blends, preset)
                self.assertEqual(work["blender_bypassed_pixels"], 0)
                self.assertEqual(work["edge_pixels_percent"] > 0, blends, preset)

    def test_rejects_mask_that_does_not_fit(self):
        noise = self.noise()
        self.run_engine(2, *noise, "--mask", self.write("small.png", noisy_png(20, 20)),
                        says=["mask", "20 x 20", "48 x 40"])
        self.run_engine(5, *noise, "--mask", self.path("missing.png"), says="missing.png")
        self.run_engine(2, *noise, "--mask", self.mask([0] * 1920), *self.rules(bypass="none"),
                        says=["frame.mask", "bypass = none"])


class GuardFaults(BlockFaults):
    """A text guard that is missing or wrong, and its effect."""
    GUARD = ("--set", "morphological.text_guard=true")

    def test_catches_disabled_guard(self):
        noise = self.picture("noise.png", noisy_png(48, 40))
        for preset in ("deburr", "deburr-line", "mlaa", "smaa"):
            with self.subTest(preset):
                self.fault("wrong-guard", *noise, "--preset", preset, *self.GUARD)
        # A frame without a guarded pixel does not reveal the fault.
        flat = self.picture("flat.png", rgb_png(24, [bytes([255 * (x < 12)] * 3) for _ in range(20) for x in range(24)]))
        self.run_engine(0, *flat, *self.GUARD, "--fault", "wrong-guard", says="PASS")

    def test_catches_a_bit_of_a_guarded_pixel(self):
        noise = self.picture("noise.png", noisy_png(48, 40))
        for arguments in (("--preset", "deburr"), ("--preset", "mlaa", "--lanes", "4"), ("--preset", "smaa")):
            with self.subTest(arguments):
                self.fault("flip-guard", *noise, *arguments, *self.GUARD, code=3, unchecked=1,
                           says="changed while it waited")

    def test_faults_in_absent_guard_are_rejected(self):
        for name in ("wrong-guard", "flip-guard"):
            self.run_engine(2, *self.SMALL, "--fault", name, says=[name, "needs", "text_guard = true"])

    def test_guard_bypasses_most_of_random_two_colour_frame(self):
        noise = self.picture("noise.png", noisy_png(48, 40))
        self.run_engine(0, *noise)
        before = self.result()["work"]
        self.run_engine(0, *noise, *self.GUARD)
        work = self.result()["work"]
        self.assertEqual(before["blender_bypassed_pixels"], 0)
        self.assertLess(work["blender_blended_pixels"], before["blender_blended_pixels"] / 5)
        self.assertEqual(work["blender_blended_pixels"] + work["blender_bypassed_pixels"], before["blender_blended_pixels"])
        self.assertEqual(work["edge_pixels_percent"], before["edge_pixels_percent"])


class Fields(BlockFaults):
    """Hardware decodes a configuration field as a different value than software wrote."""

    def test_each_field_is_decoded(self):
        bits = random.Random(1)
        grain, grey, dark = (self.picture(name, rgb_png(48, [bytes(code() for _ in range(3)) if colours else
                                                            bytes([code()] * 3) for _ in range(48 * 32)]))
                             for name, colours, code in (("grain.png", True, lambda: 7 * bits.randrange(36)),
                                                         ("grey.png", False, lambda: bits.randrange(90, 140)),
                                                         ("dark.png", False, lambda: bits.randrange(8))))
        noise = self.picture("noise.png", noisy_png(48, 40))
        mask = self.write("mask.png", rgb_png(48, [bytes([255 * (x // 8 % 2)] * 3) for _ in range(32) for x in range(48)]))
        depth = ("--depth", grain[1])
        scene, line, smaa = (("--size", "48x32", "--preset", preset)
                                      for preset in ("mlaa-slope", "deburr-line", "smaa"))
        predicated = (*grey, *depth, *self.rules(edges__source="predicated", edges__threshold_on_depth_edge=1310720,
                                                 edges__threshold_off_depth_edge=1310720))
        self.misdecode("morphological", {
            "config-edges-source": scene, "config-threshold-mode": scene,
            "config-dynamic-luma": (*grey, "--preset", "smaa-dynamic"), "config-local-contrast": smaa,
            "config-predictor": scene, "config-steps": scene, "config-contiguous": (*grain, "--preset", "deburr-line"),
            "config-safe": line, "config-linear-light": scene, "config-trim": line, "config-ends": smaa,
            "config-area-table": smaa, "config-diagonals": smaa, "config-round-corners": smaa, "config-blend": smaa,
            "config-area-learned": ("--size", "48x32"), "config-bypass": (*grain, "--mask", mask),
            "config-border": (*grain, "--preset", "smaa"), "config-text-guard": (*noise, *self.rules(text_guard="true")),
            "threshold-value": (*grey, "--preset", "mlaa"), "threshold-on-value": predicated,
            "threshold-off-value": predicated, "alpha-value": (*grey, "--preset", "smaa-dynamic"),
            "floor-value": (*dark, "--preset", "smaa-dynamic"),
            "depth-threshold-value": (*grain, *depth, *self.rules(edges__source="depth")),
            "smaa-search-steps": (*smaa, *self.rules(search_steps=2)), "smaa-diagonal-steps": smaa,
            "smaa-corner-rounding": smaa})
        self.decode_as_built("morphological")


class SmaaFaults(BlockFaults):
    """Faults in SMAA's blocks."""

    def test_catches_a_bit_of_the_table_in_each_layout(self):
        for area in ("table_full", "table_merged", "table_minimal"):
            with self.subTest(area):
                rules = self.rules(quality="medium", area=area)
                self.fault("wrong-area", "--preset", "smaa", *rules, *self.SMALL)
                self.run_engine(1, "--fault", "wrong-root", "--preset", "smaa", *rules, *self.SMALL, says="mismatch")

    def test_catches_wrong_decode_of_merged_table(self):
        self.fault("wrong-decode", "--preset", "smaa-dynamic", *self.SMALL)
        self.fault("wrong-decode", "--preset", "smaa", *self.rules(area="table_merged"), *self.SMALL)

    def test_catches_faults_in_other_roms(self):
        self.fault("wrong-diagonal-area", "--preset", "smaa", *self.SMALL)
        self.fault("wrong-mix", "--preset", "smaa", *self.SMALL)

    def test_catches_wrong_threshold_at_equality(self):
        # Steps of blue are T exactly; steps from 1 to 2 are alpha times luma exactly.
        blue = self.picture("blue.png", columns_png(8, [(0, 0, 0)] * 6 + [(0, 0, 255)] * 6))
        dark = self.picture("dark.png", columns_png(8, [(1, 1, 1)] * 6 + [(2, 2, 2)] * 6))
        off = self.rules(edges__local_contrast="off")
        self.fault("wrong-threshold", *blue, "--preset", "smaa", *off, *self.rules(edges__threshold=255 * 4732))
        self.fault("wrong-floor", *blue, "--preset", "smaa-dynamic", *off,
                   *self.rules(edges__alpha=1, edges__floor=255 * 4732))
        for luma in ("current", "max"):  # of the right column, which owns the edge and is brighter
            self.fault("wrong-threshold", *dark, "--preset", "smaa-dynamic", *off,
                       *self.rules(edges__alpha=1 << 23, edges__floor=1, edges__dynamic_luma=luma))
        for luma, code in (("min", 16777215), ("mean", 11184810)):  # 1 and 1.5: just below, no equality
            self.run_engine(0, "--fault", "wrong-threshold", *dark, "--preset", "smaa-dynamic", *off,
                            *self.rules(edges__alpha=code, edges__floor=1, edges__dynamic_luma=luma), says="PASS")

    def test_catches_wrong_local_contrast_at_equality(self):
        grey = self.picture("grey.png", columns_png(8, [(c, c, c) for c in [0] * 5 + [60] + [180] * 5]))
        for contrast in ("smaa", "paper"):
            self.fault("wrong-contrast", *grey, "--preset", "smaa", *self.rules(edges__local_contrast=contrast))

    def test_catches_search_one_step_short(self):
        self.fault("wrong-search", "--preset", "smaa", *self.rules(quality="low"), *self.SMALL)
        self.fault("wrong-diagonal", *self.picture("stair.png", stair_png(40)), "--preset", "smaa")

    def test_catches_wrong_border(self):
        noise = self.picture("noise.png", noisy_png(48, 40))
        for preset in ("smaa", "smaa-dynamic"):
            for rules in (self.rules(diagonals="false"), self.rules(quality="ultra")):
                self.fault("wrong-border", *noise, "--preset", preset, *rules)
        self.fault("wrong-endless", *noise, "--preset", "smaa", code=3, unchecked=1, says="changed while it waited")
        self.run_engine(2, *self.SMALL, "--preset", "smaa", *self.rules(border="end"), "--fault", "wrong-border",
                        says="border = clamp")
        # If no run meets the border, the fault has no effect.
        inner = [bytes([255 * (20 <= x < 40 and 15 <= y < 31)] * 3) for y in range(48) for x in range(60)]
        self.run_engine(0, *self.picture("inner.png", rgb_png(60, inner)), "--preset", "smaa", "--fault",
                        "wrong-border", says="PASS")

    def test_catches_wrong_table_values(self):
        for values in ("exact", "published"):
            for area in ("table_full", "table_merged", "table_minimal"):
                self.fault("wrong-values", "--preset", "smaa", *self.SMALL,
                           *self.rules(area=area, area_values=values, diagonals="false"))
            self.fault("wrong-values", *self.picture("stair.png", stair_png(40)), "--preset", "mlaa",
                       *self.rules(diagonals="true", diagonal_steps=8, area_values=values))

    def test_catches_wrong_corners(self):
        self.fault("wrong-corner", "--preset", "smaa", *self.SMALL)

    def test_catches_smaa_link_faults(self):
        # A column with a vertical run in each row.
        rows = rgb_png(64, [bytes([0 if x < 20 else 255 - 100 * (y % 2)] * 3) for y in range(48) for x in range(64)])
        rules = self.rules(edges__local_contrast="off", diagonals="false")
        self.fault("wrong-entry", *self.picture("rows.png", rows), "--preset", "smaa", *rules, code=3, unchecked=1,
                   says="changed while it waited")
        self.fault("drop-diagonals", "--preset", "smaa", *self.SMALL, code=3, unchecked=4, says="vanished")

    def test_catches_smaa_faults_in_a_frame(self):
        for name in ("wrong-area", "morphological.wrong-diagonal-area", "wrong-corner"):
            self.fault(name, "--preset", "smaa", *self.SMALL, engine="frame")

    def test_smaa_faults_in_absent_hardware_are_rejected(self):
        for name, needs in (("wrong-area", "area = table"), ("wrong-root", "area = table"),
                            ("wrong-decode", "area = table_merged"), ("wrong-search", "search_steps of at least 2"),
                            ("wrong-floor", "threshold_mode = dynamic"), ("wrong-contrast", "smaa or paper"),
                            ("wrong-entry", "ends = crossings"), ("wrong-border", "border = clamp"),
                            ("wrong-endless", "border = clamp"), ("wrong-values", "diagonals = true"), ("wrong-diagonal", "diagonals = true"),
                            ("wrong-diagonal-area", "diagonals = true"), ("drop-diagonals", "diagonals = true"),
                            ("wrong-corner", "round_corners = true"), ("wrong-mix", "blend = strongest")):
            self.run_engine(2, *self.SMALL, "--fault", name, says=[name, "needs", needs])
        smaa = ("--preset", "smaa")
        for name, rules, needs in (("wrong-threshold", {"edges__threshold": 16777215}, "T of at most 16777214"),
                                   ("wrong-search", {"search_steps": 1}, "search_steps of at least 2"),
                                   ("wrong-diagonal", {"diagonal_steps": 1}, "diagonal_steps of at least 2"),
                                   ("wrong-corner", {"corner_rounding": 0}, "corner_rounding of at least 1"),
                                   ("wrong-decode", {"area": "table_full"}, "area = table_merged")):
            self.run_engine(2, *self.SMALL, *smaa, *self.rules(**rules), "--fault", name, says=[name, "needs", needs])
        self.run_engine(2, *self.SMALL, "--preset", "smaa-dynamic", *self.rules(edges__alpha=0), "--fault",
                        "wrong-threshold", says="alpha of at least 1")
        self.run_engine(2, *self.SMALL, "--preset", "mlaa", "--fault", "wrong-rule", says="steps of at least 1")


if __name__ == "__main__":
    unittest.main()
