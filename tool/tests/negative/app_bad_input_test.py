#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Bad input to the command: each kind has its exit code and a message that names the error. See --help."""
import hashlib
import json
import os
import pty
import re
import resource
import shutil
import signal
import subprocess
import time
import unittest

from app_support import DEBURR, CommandTest, bc1_dds, engines, float_tiff, pages_tiff, png


class TextureFiles(CommandTest):
    """Image files as textures."""

    def texture(self, code, name, content, says=()):
        return self.run_texture(code, "--texture", self.write(name, content), says=says)

    def test_rejects_missing_image(self):
        self.run_texture(5, "--texture", self.path("missing.png"), says="missing.png")

    def test_rejects_folder_as_image(self):
        os.mkdir(self.path("folder.png"))
        self.run_texture(5, "--texture", self.path("folder.png"), says="folder.png")

    def test_rejects_empty_image(self):
        self.texture(5, "empty.png", b"", says="empty.png")

    def test_rejects_truncated_image(self):
        whole = png(64, 64)
        self.texture(5, "truncated.png", whole[:len(whole) // 2], says="truncated.png")

    def test_rejects_corrupt_image(self):
        broken = bytearray(png(64, 64))
        for i in range(45, len(broken) - 12):
            broken[i] ^= 0x5A
        self.texture(5, "corrupt.png", bytes(broken), says="corrupt.png")

    def test_rejects_text_as_image(self):
        self.texture(5, "text.png", b"this is no image at all\n" * 10, says="text.png")

    def test_rejects_huge_image_header(self):
        self.texture(5, "huge.png", png(4, 4, declared=(60000, 60000)), says="huge.png")

    def test_rejects_image_larger_than_the_unit_takes(self):
        self.texture(5, "wide.png", png(4097, 2), says="4097")

    def test_rejects_truncated_tiff(self):
        whole = pages_tiff(64, 64, 1)
        for part in (0.3, 0.6, 0.99):
            self.texture(5, "truncated.tif", whole[:int(part * len(whole))], says="truncated.tif")

    def test_reads_blocks_of_dds(self):
        whole = bc1_dds(13, 7)
        file = self.write("brick.dds", whole)
        self.write("brick.mtl", "newmtl a\nmap_Kd brick.dds\n")
        mesh = self.write("brick.obj", "mtllib brick.mtl\nusemtl a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\n"
                          "vt 0 1\nf 1/1 2/2 3/3\n")
        for engine, *arguments in (("texture", "--texture", file), ("frame", "--scene", "quad", "--texture", file),
                                   ("geometric", "--in", mesh), ("morphological", "--in", file)):
            size = [] if engine == "morphological" else ["--size", "16x16"]
            self.expect(0, "run", engine, *size, *arguments, "--out", self.path("out"), says="PASS")
        self.texture(5, "cut.dds", whole[:-1], says=["cut.dds", "level 2 of 3 x 1 texels needs 8 bytes", "copy it"])
        self.texture(5, "cube.dds", bc1_dds(8, 8, caps2=0xFE00), says=["cube.dds", "cube map; write one of its faces"])
        self.expect(5, "run", "morphological", "--in", self.write("cut.dds", whole[:-1]), "--out", self.path("out"),
                    says="cut.dds")

    def test_accepts_16_bit_image(self):
        self.texture(0, "deep.png", png(16, 16, bits=16), says="PASS")

    def test_accepts_grey_image(self):
        self.texture(0, "grey.png", png(16, 16, channels=1), says="PASS")

    def test_accepts_grey_alpha_image(self):
        self.texture(0, "grey_alpha.png", png(16, 16, channels=2), says="PASS")

    def test_accepts_float_image(self):
        self.texture(0, "float.tif", float_tiff(16, 16), says="PASS")

    def test_accepts_nan_texels(self):
        self.texture(0, "nan.tif", float_tiff(16, 16, float("nan")), says="PASS")

    def test_accepts_image_with_odd_size(self):
        self.texture(0, "odd.png", png(13, 7), says="PASS")

    def test_accepts_one_texel(self):
        self.texture(0, "one.png", png(1, 1), says="PASS")


class MeshFiles(CommandTest):
    """Mesh files as scenes."""

    def mesh(self, code, name, content, says=()):
        return self.run_texture(code, "--in", self.write(name, content), says=says)

    def test_rejects_missing_mesh(self):
        self.run_texture(5, "--in", self.path("missing.obj"), says="missing.obj")

    def test_rejects_empty_mesh(self):
        self.mesh(5, "empty.obj", b"", says="empty.obj")

    def test_rejects_mesh_without_triangles(self):
        self.mesh(5, "points.obj", b"v 0 0 0\nv 1 0 0\n", says="points.obj")

    def test_rejects_index_out_of_range(self):
        self.mesh(5, "range.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n", says="range.obj")

    def test_rejects_vertex_that_is_not_finite(self):
        self.mesh(5, "nan.obj", b"v 0 0 nan\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", says="nan.obj")

    def test_rejects_truncated_glb(self):
        self.mesh(5, "short.glb", b"glTF\x02\0\0\0\xff\xff\0\0", says="short.glb")

    def test_notes_are_printed(self):
        self.mesh(0, "cut.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3",
                  says="may be truncated")
        self.assertIn("may be truncated", self.notes())

    def test_accepts_one_triangle(self):
        self.mesh(0, "good.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", says="PASS")

    def test_rejects_scene_that_draws_nothing(self):
        small = self.write("degenerate.obj", b"v 0 0 0\nv 1e-9 0 0\nv 0 1e-9 0\nv 5 5 5\n"
                                             b"f 1 2 3\nf 4 4 4\n")
        for engine in engines():
            self.expect(2, "run", engine, "--in", small, "--size", "16x16", "--out",
                        self.path("out"), says=["degenerate", "draws nothing", "16 x 16"])
        for arguments in (("--set", "scene.eye=0,-1,0", "--set", "scene.target=0,-5,-0.1"),):
            self.run_texture(2, *arguments, says=["draws nothing", "scene.eye"])
        self.assertFalse(os.path.exists(self.path("out")))

    def test_unknown_scene_suggests_similar_name(self):
        self.run_texture(2, "--scene", "plain", says="plane")


class CompressedFormats(CommandTest):
    """Formats of blocks."""

    DECODE = ("--set", "texture.decode=after")

    def test_rejects_blocks_without_decoder(self):
        self.run_texture(2, "--format", "bc1", says=["sampler.format = bc1", "set texture.decode = after"])
        self.expect(2, "run", "frame", "--set", "sampler.format=etc2_rgb", "--out", self.path("out"),
                    says="set texture.decode = after")

    def test_rejects_parameters_of_absent_decoders(self):
        self.run_texture(2, "--set", "texture.cache.decoders=2", says="has no effect: it needs texture.decode = after")
        self.run_texture(2, *self.DECODE, "--set", "texture.cache.compressed_lines=8", says="it needs texture.decode = before")
        self.run_texture(2, "--set", "texture.bc=rounded", says="has no effect: it needs texture.decode = after or before")

    def test_rejects_srgb_of_other_formats(self):
        self.run_texture(2, "--set", "sampler.srgb=true", says=["sampler.srgb: rgba8", "srgb8_a8"])
        self.run_texture(2, *self.DECODE, "--format", "bc4", "--set", "sampler.srgb=true", says="sampler.srgb: bc4")

    def test_frame_keeps_codes(self):
        self.expect(2, "run", "frame", *self.DECODE, "--set", "sampler.format=bc1", "--set", "sampler.srgb=true",
                    "--out", self.path("out"), says=["sampler.srgb", "texture.srgb_output = encoded"])

    def test_notes_origin_of_blocks(self):
        file = self.write("brick.dds", bc1_dds(16, 16))
        for name, noted in ((file, "bc1 blocks and 3 levels of the file"), ("brick", "texture 'brick' as bc1: ")):
            self.run_texture(0, *self.DECODE, "--format", "bc1", "--texture", name, says=["PASS", noted])
            self.assertIn(noted, str(self.notes()))


class Notes(CommandTest):
    """Adjustments of an input are noted in the result and the report of every engine."""

    def of_texture(self, name, content, says):
        for engine in ("texture", "frame"):
            self.expect(0, "run", engine, "--scene", "quad", "--size", "16x16", "--texture",
                        self.write(name, content), "--out", self.path("out"), says=says)
            self.noted(name, says)

    def of_image(self, name, content, says):
        self.expect(0, "run", "morphological", "--in", self.write(name, content), "--out",
                    self.path("out"), says=says)
        self.noted(name, says)

    def noted(self, name, says):
        self.assertTrue(any(name in note and says in note for note in self.result()["notes"]),
                        self.result()["notes"])
        with open(self.path("out/report.html")) as file:
            self.assertIn(says, file.read())

    def test_notes_16_bit_image(self):
        self.of_texture("deep.png", png(16, 16, bits=16), "uint16 values scaled to 8 bits")
        self.of_image("deep.png", png(16, 16, bits=16), "uint16 values scaled to 8 bits")

    def test_notes_grey_image(self):
        self.of_texture("grey.png", png(16, 16, channels=1), "grey copied")
        self.of_image("grey.png", png(16, 16, channels=1), "grey copied")

    def test_notes_nan_values(self):
        says = "768 of 768 values NaN replaced by 0, the first at (0, 0)"
        self.of_texture("nan.tif", float_tiff(16, 16, float("nan")), says)
        self.of_image("nan.tif", float_tiff(16, 16, float("nan")), says)

    def test_notes_clamped_values(self):
        says = "768 of 768 values clamped to [0, 1], the first at (0, 0)"
        self.of_texture("bright.tif", float_tiff(16, 16, 1.5), says)
        self.of_image("bright.tif", float_tiff(16, 16, 1.5), says)
        self.of_image("inside.tif", float_tiff(16, 16), "float values scaled to 8 bits")
        self.assertNotIn("clamped", self.notes())
        self.assertNotIn("NaN", self.notes())

    def test_notes_first_of_several_pictures(self):
        self.of_texture("pages.tif", pages_tiff(16, 16, 3), "only the first of several images is read")
        self.of_image("pages.tif", pages_tiff(16, 16, 3), "only the first of several images is read")

    def test_notes_missing_texture(self):
        mesh = self.write("bare.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
        for engine in ("texture", "frame"):
            self.expect(0, "run", engine, "--in", mesh, "--size", "16x16", "--out",
                        self.path("out"), says="has no texture")
            self.noted("bare.obj", "has no texture")

    def test_quiet_run_keeps_notes_in_result(self):
        self.run_texture(0, "--texture", self.write("grey.png", png(16, 16, channels=1)), "--quiet")
        self.assertIn("grey copied", str(self.notes()))

    def test_result_without_notes_has_no_key(self):
        self.run_texture(0)
        self.assertNotIn("notes", self.result())


class Configuration(CommandTest):
    """Parameters by option and by file."""

    def config(self, code, text, says=()):
        return self.run_texture(code, "--config", self.write("run.yaml", text), says=says)

    def test_rejects_kernel_by_axis_without_diagonals(self):
        self.run_texture(2, "--preset", "paper", "--set", "texture.kernel=axis",
                         says="texture.axes = two has no diagonals")

    def test_accepts_configuration_file(self):
        self.config(0, "texture:\n  cache: {bytes: 8192}\nsampler.mode: linear\n", says="PASS")
        with open(self.path("out/manifest.json")) as file:
            configuration = json.load(file)["configuration"]
        self.assertEqual(configuration["texture.cache.bytes"], 8192)
        self.assertEqual(configuration["sampler.mode"], "linear")

    def test_unknown_key_names_line_and_suggestion(self):
        self.config(2, "texture:\n  cache.bites: 8192\n",
                    says=["run.yaml:2", "texture.cache.bytes"])

    def test_rejects_value_out_of_range(self):
        self.config(2, "texture.cache.ways: 64\n", says=["run.yaml:1", "1..8"])

    def test_rejects_value_of_wrong_type(self):
        self.config(2, "texture.cache.ways: many\n", says=["run.yaml:1", "integer"])

    def test_rejects_duplicate_key(self):
        self.config(2, "run.seed: 1\nrun.seed: 2\n", says=["run.yaml:2", "given twice"])

    def test_rejects_invalid_yaml(self):
        self.config(2, "[\n", says="not valid YAML")

    def test_rejects_binary_file(self):
        self.config(2, bytes(range(256)), says="run.yaml")

    def test_rejects_missing_configuration(self):
        self.run_texture(5, "--config", self.path("none.yaml"), says="none.yaml")

    def manifest(self):
        with open(self.path("out/manifest.json")) as file:
            return json.load(file)

    def test_manifest_repeats_the_run(self):
        """A manifest sets what its run was given; presets and options take effect as before."""
        self.write("t.png", png(8, 8))
        self.run_texture(0, "--texture", "t.png", "--preset", "paper", "--set", "texture.cache.ways=2", "--seed", "7")
        first = self.manifest()
        self.assertEqual(first["working_directory"], os.path.realpath(self.directory))
        self.assertEqual({p["name"]: p["from"] for p in first["parameters"] if p["name"] in
                          ("texture.cache.ways", "texture.footprint", "memory.latency")},
                         {"texture.cache.ways": "given", "texture.footprint": "preset paper", "memory.latency": "default"})
        os.rename(self.path("out"), self.path("first"))
        config = ("--config", self.path("first/manifest.json"))
        command = ("run", "texture", *config, "--out", self.path("out"))
        self.expect(0, *command)
        again = self.manifest()
        for key in ("configuration", "golden", "seed"):
            self.assertEqual(again[key], first[key])
        self.assertEqual([p["from"] for p in again["parameters"]], [p["from"] for p in first["parameters"]])
        # From another folder, file names still refer to the same files; another preset can be selected.
        os.mkdir(self.path("elsewhere"))
        self.expect(0, *command, "--preset", "deburr", cwd=self.path("elsewhere"))
        again = self.manifest()
        self.assertEqual(again["configuration"]["scene.texture"], os.path.realpath(self.path("t.png")))
        self.assertNotEqual(again["configuration"]["texture.footprint"], first["configuration"]["texture.footprint"])
        self.assertEqual(again["configuration"]["texture.cache.ways"], 2)
        self.expect(2, "run", "frame", *config, "--out", self.path("out"),
                    says="first/manifest.json:4: this manifest belongs to a run of 'texture', not of 'frame'")
        self.expect(2, "run", "texture", *config, "--out", self.path("first"),
                    says="the results would overwrite the input")

    def test_named_build_sets_what_is_not_given(self):
        self.run_texture(0, "--set", "texture.build=lean", "--set", "texture.cache.lookups=8", "--set", "texture.blend=level")
        configuration, title = self.manifest()["configuration"], self.manifest()["summary"]
        self.assertEqual([configuration[f"texture.{name}"] for name in
                          ("width", "fragments", "cache.lookups", "cache.allocations", "cache.line_banks",
                           "cache.bank_reads", "cache.fill_writes")], [4, 4, 8, 2, 4, 2, 2])
        self.assertIn("; preset deburr, build lean, changed: cache.lookups; ", title)
        self.assertIn(", blend level; width 4, cache ", title)

    def test_manifest_of_other_defaults_is_applied(self):
        self.run_texture(0)
        manifest = self.manifest()
        manifest["configuration"].update({"memory.latency": 77, "no.more": 1})
        file = self.write("old.json", json.dumps(manifest, indent=2))
        done = self.run_texture(2, "--config", file, says="old.json:")
        self.assertIn("unknown parameter 'no.more'", done.stderr)
        del manifest["configuration"]["no.more"]
        self.write("old.json", json.dumps(manifest, indent=2))
        self.run_texture(0, "--config", file)
        self.assertEqual(self.manifest()["configuration"]["memory.latency"], 77)

    def test_configuration_from_standard_input(self):
        text = "texture:\n  cache: {bytes: 8192}\t# it's 8 \\n\nsampler.mode: linear\n"
        done = self.run_texture(1, "--config", "/dev/stdin", "--fault", "flip-bit", input=text)
        repro = next(line for line in done.stdout.splitlines() if line.startswith("REPRO: "))
        manifest = self.manifest()
        self.assertEqual(manifest["configuration"]["texture.cache.bytes"], 8192)
        self.assertEqual(manifest["inputs"][-1], {
            "file": "/dev/stdin", "sha256": hashlib.sha256(text.encode()).hexdigest(), "role": "configuration",
            "bytes": len(text)})
        again = subprocess.run(["bash", "-c", repro.removeprefix("REPRO: ")], cwd=self.directory, text=True,
                               capture_output=True, stdin=subprocess.DEVNULL)
        self.assertEqual(again.returncode, 1, again.stderr)
        self.assertEqual(self.manifest()["configuration"], manifest["configuration"])
        self.run_texture(2, "--config", "/dev/stdin", input="a: 1\nb: 2\n", says="/dev/stdin:1: unknown parameter 'a'")
        self.run_texture(5, "--config", "/dev/stdin", input="#" * (2 << 20), says="'/dev/stdin': it is larger than")
        with open(self.write("run.yaml", text)) as file:
            self.run_texture(0, "--config", "/dev/stdin", stdin=file)

    def test_trilinear_is_rejected_with_advice(self):
        for engine in ("texture", "frame"):
            for given in (("--mode", "trilinear"), ("--set", "sampler.mode=trilinear")):
                done = self.run_command("run", engine, *given, "--size", "16x16", "--show-config")
                self.assertIn('sampler.mode: "linear_mipmap_linear"', done.stdout, done.stderr)
        self.run_texture(2, "--mode", "trilinaer", says=["linear_mipmap_linear", "trilinear is linear_mipmap_linear"])
        self.config(0, "sampler.mode: trilinear\n")
        self.assertEqual(self.manifest()["configuration"]["sampler.mode"], "linear_mipmap_linear")

    def test_unknown_parameter_is_suggested(self):
        self.run_texture(2, "--set", "texture.fotprint=half", says=["--set", "texture.footprint"])

    def test_parameter_out_of_range_is_rejected(self):
        self.run_texture(2, "--set", "memory.latency=0", says="1..100000")

    def test_parameter_without_value_is_rejected(self):
        self.run_texture(2, "--set", "memory.latency", says="name=value")

    def test_contradicting_options_are_rejected(self):
        self.run_texture(2, "--mode", "linear", "--set", "sampler.mode=nearest", says="contradicts")

    def test_cache_size_must_be_power_of_two(self):
        self.run_texture(2, "--set", "texture.cache.bytes=10000", says="power of two")

    def test_cache_must_hold_one_set(self):
        self.run_texture(2, "--set", "texture.cache.bytes=256",
                         "--set", "texture.cache.ways=8", says=["cache.bytes = 256", "one set"])

    def test_rejects_invalid_size(self):
        for size in ("0x4", "4", "4x", "9000x4", "-1x4"):
            self.expect(2, "run", "texture", "--size", size, "--out", self.path("out"))

    def test_rejects_invalid_camera(self):
        self.run_texture(2, "--set", "scene.eye=1,2", says="x,y,z")
        self.run_texture(2, "--set", "scene.eye=1,2,3", "--set", "scene.target=1,2,3",
                         says="same point")

    def test_rejects_unknown_option_and_command(self):
        self.expect(2, "run", "texture", "--aniso", "3", says="1, 2, 4, 8, 16")
        self.expect(2, "run", "texture", "--colour", "red",
                    says=["'--colour'", "deburr run texture --help"])
        self.expect(2, "run", "nothing", says=["deburr run nothing", ", ".join(engines())])
        self.expect(2, "frobnicate", says=["deburr frobnicate", "compare"])
        self.expect(2, says=["deburr: missing command", "compare"])
        self.expect(2, "run", says=["deburr run: missing command", "morphological"])

    def test_typing_errors_are_corrected(self):
        self.expect(2, "run", "morphlogical", "--size", "8x8", says="did you mean 'morphological'?")
        self.expect(2, "rum", "texture", says="did you mean 'run'?")
        self.expect(2, "run", "morphological", "--presett", "mlaa",
                    says=["'--presett': did you mean '--preset'?", "deburr run morphological --help"])
        self.expect(2, "run", "morphological", "--out", "./--size", "--presett=mlaa",
                    says="did you mean '--preset'?")
        self.expect(2, "compare", "a", "b", "--psnr", "1", says="'--psnr-db'")

    def test_option_is_not_taken_as_value(self):
        """An option is not the value of another option, unless it is written as NAME=VALUE."""
        self.write("one.yaml", "engine: texture\naxes: {memory.latency: [50]}\n")
        for command in (("run", "texture", "--size", "8x8"), ("sweep", "one.yaml", "plan"), ("papers",)):
            for word in ("--quiet", "--out=x"):
                self.expect(2, *command, "--out", word, says=["usage: --out needs a value", f"--out={word}"])
        self.expect(2, "run", "texture", "--set", "--size", "8x8", says="--set needs a value")
        self.assertEqual([name for name in os.listdir(self.directory) if name.startswith("--")], [])
        for name in ("--out=--quiet", "--out=./--wait"):
            self.expect(0, "run", "texture", "--size", "8x8", name)
            self.assertTrue(os.path.exists(self.path(f"{name.removeprefix('--out=')}/result.json")))
        self.expect(0, "run", "texture", "--size", "8x8", "--out", "--other")  # not an option's name

    def test_help_describes_faults(self):
        for engine in engines():
            self.assertIn("--fault", self.run_command("run", engine, "--help").stdout)

    def test_unknown_paper_lists_known_ones(self):
        for option in ((), ("--only",)):
            self.expect(2, "papers", *option, "999", says="unknown paper '999' (known: 000")

    def test_trace_pattern_without_match_is_rejected(self):
        self.run_texture(2, "--trace", "texture.nothing*",
                         says=["texture.nothing*", "texture.texels", "texture.texture_cache.tag_stage"])
        self.assertFalse(os.path.exists(self.path("out")))

    def test_trace_interval_after_the_run_is_rejected(self):
        self.run_texture(2, "--trace", "*", "--trace-from", "900000", "--trace-to", "900100",
                         says=["run.trace_from = 900000", "nothing was traced"])
        self.assertFalse(os.path.exists(self.path("out")))

    def test_rejects_empty_names(self):
        self.expect(2, "run", "texture", "--config", "", says="--config: expected a name")
        self.expect(2, "run", "texture", "--out", "", says="--out: expected a name")
        self.expect(2, "papers", "--out", "", says="--out")

    def test_rejects_empty_range_of_levels(self):
        for engine in ("texture", "frame"):
            self.expect(2, "run", engine, "--set", "sampler.min_lod=512", "--set",
                        "sampler.max_lod=511", "--out", self.path("out"),
                        says=["sampler.min_lod = 512", "sampler.max_lod = 511"])

    def test_accepts_hexadecimal_addresses(self):
        """In the notation of error messages."""
        self.run_texture(3, "--set", "memory.error_address=0x40", "--set", "memory.error_bytes=0x4000000")
        with open(self.path("out/manifest.json")) as file:
            configuration = json.load(file)["configuration"]
        self.assertEqual((configuration["memory.error_address"], configuration["memory.error_bytes"]), (64, 4 << 24))

    def test_memory_errors_never_accessed_are_rejected(self):
        self.run_texture(2, "--set", "memory.error_address=2147483584",
                         says=["memory.error_address", "from 0x7fffffc0 to 0x7fffffff, so no access failed"])
        self.expect(2, "run", "morphological", "--size", "32x32", "--storage", "memory", "--set",
                    "memory.error_address=4000000", "--out", self.path("out"),
                    says="no access failed")
        self.assertFalse(os.path.exists(self.path("out")))

    def test_rejects_memory_slower_than_watchdog(self):
        self.run_texture(2, "--set", "memory.latency=20000",
                         says=["memory.latency = 20000", "run.watchdog_cycles=40000"])
        self.run_texture(2, "--set", "memory.latency_max=30000", says="memory.latency_max = 30000")
        self.expect(2, "run", "frame", "--storage", "memory", "--set", "frame_memory.latency=20000",
                    "--out", self.path("out"), says="frame_memory.latency = 20000")
        self.expect(0, "run", "texture", "--size", "2x2", "--set", "memory.latency=20000", "--set",
                    "run.watchdog_cycles=40000", "--out", self.path("out"))

    def test_show_config_checks_like_a_run(self):
        """Configurations that a run rejects are rejected; nothing is run or written."""
        for engine, *arguments in (
                ("texture", "--fault", "gremlin"), ("texture", "--trace", "nothing*"),
                ("texture", "--set", "texture.cache.bytes=10000"),
                ("frame", "--set", "sampler.format=srgb8_a8"),
                ("texture", "--set", "scene.eye=0,-1,0", "--set", "scene.target=0,-5,-0.1")):
            self.expect_as_shown(engine, *arguments)
        self.expect(5, "run", "morphological", "--in", self.path("none.png"), "--show-config")
        for engine in engines():
            done = self.run_command("run", engine, "--size", "32x32", "--trace", "*",
                                    "--show-config", "--out", self.path("out"))
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertIn("run.trace", done.stdout.replace(": {", ".").replace("run:\n  ", "run."))
        self.assertFalse(os.path.exists(self.path("out")))

    def test_rejects_empty_trace_interval(self):
        self.run_texture(2, "--trace", "*", "--trace-from", "100", "--trace-to", "100",
                         says=["run.trace_from = 100", "--trace-to"])
        self.run_texture(2, "--trace", "*", "--trace-from", "5000", says="above 5000")
        self.assertFalse(os.path.exists(self.path("out")))

    def test_trace_holds_clock_cycle_and_link(self):
        self.run_texture(0, "--trace", "texture.texels", "--trace-to", "50", says="PASS")
        with open(self.path("out/trace.vcd")) as file:
            wave = file.read()
        # One scope holds everything: the clock, the cycle number, and the link in a nested scope.
        self.assertRegex(wave, r"(?s)^\$comment.*?\$scope module deburr \$end\n\$var wire 1 \S+ clk \$end")
        self.assertEqual(wave.count("$scope module"), 3, "deburr.texture.texels")
        for name in ("cycle", "occupancy", "push", "pop"):
            self.assertRegex(wave, rf"\$var wire \d+ \S+ {name} ")

    def test_writes_nothing_before_configuration_is_valid(self):
        self.run_texture(2, "--set", "texture.fotprint=half")
        self.assertFalse(os.path.exists(self.path("out")))


class Output(CommandTest):
    """Output locations that cannot be written."""

    def no_remains(self):
        names = os.listdir(self.path("out")) if os.path.isdir(self.path("out")) else []
        if "result.json" not in names:
            self.assertEqual(names, [])
        known = (".json", ".png", ".html", ".vcd")
        self.assertEqual([n for n in names if not n.endswith(known)], [],
                         "temporary files are left")
        for name in names:
            if name.endswith(".json"):
                with open(self.path("out/" + name)) as file:
                    json.load(file)

    def test_rejects_file_as_output_folder(self):
        self.write("out", "in the way")
        self.run_texture(5, says="out")

    def test_rejects_output_below_a_file(self):
        self.write("file", "in the way")
        self.expect(5, "run", "texture", "--size", "8x8", "--out", self.path("file/out"))

    @unittest.skipIf(os.geteuid() == 0, "root may write everywhere")
    def test_rejects_read_only_folder(self):
        os.mkdir(self.path("out"), 0o555)
        self.run_texture(5, says="out")

    def limited(self, size):
        return lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))

    def test_full_disk_is_found_before_the_simulation(self):
        done = self.run_texture(5, preexec_fn=self.limited(0))
        self.assertNotIn("cycles", done.stdout)
        self.no_remains()

    def test_reports_no_room_for_the_report(self):
        self.run_texture(5, says="report.html", preexec_fn=self.limited(100_000))
        self.no_remains()

    def test_full_disk_leaves_no_partial_results(self):
        """A real file system of 96 KB, if the kernel allows it."""
        mount = f"mount -t tmpfs -o size=96k none {self.path('disk')}"
        os.mkdir(self.path("disk"))
        probe = subprocess.run(["unshare", "-rm", "sh", "-c", mount], capture_output=True)
        if probe.returncode != 0:
            self.skipTest("no user namespaces here")
        script = (f"{mount} && "
                  f"{DEBURR} run texture --size 64x64 --out {self.path('disk')}/out; code=$?; "
                  f"ls -A {self.path('disk')}/out 2>/dev/null; exit $code")
        done = subprocess.run(["unshare", "-rm", "sh", "-c", script], capture_output=True,
                              text=True, timeout=300)
        self.assertEqual(done.returncode, 5, done.stdout + done.stderr)
        self.assertIn("No space left", done.stderr)
        names = done.stdout[done.stdout.index("RESULT: "):].splitlines()[1:]
        self.assertEqual(names, [], "all, or nothing")

    def test_reports_no_room_for_the_wave(self):
        """The limit is reached in the wave, at its end, and in the pictures after it."""
        for size in (1_000, 100_000, 300_000):
            done = self.run_texture(5, "--trace", "*", preexec_fn=self.limited(size),
                                    says="File too large")
            self.assertNotIn("free some space", done.stderr)
            self.assertFalse(os.path.exists(self.path("out")), size)


class EarlierResults(CommandTest):
    """A run replaces only an earlier run's results, and only once it can start."""

    def setUp(self):
        super().setUp()
        self.run_texture(0, "--trace", "texture.texels")
        self.before = self.contents()
        self.assertIn("trace.vcd", self.before)

    def contents(self):
        return {name: os.stat(self.path("out/" + name)).st_mtime_ns
                for name in os.listdir(self.path("out"))}

    def test_earlier_results_stay_if_the_run_cannot_start(self):
        self.run_texture(5, "--texture", self.path("none.png"))
        self.run_texture(5, "--in", self.path("none.obj"))
        self.run_texture(2, "--fault", "gremlin")
        self.run_texture(2, "--trace", "nothing*")
        self.expect(5, "run", "morphological", "--in", self.path("none.png"), "--out",
                    self.path("out"))
        self.expect(2, "run", "morphological", "--set", "morphological.quality=low", "--out",
                    self.path("out"))
        self.expect(2, "run", "frame", "--size", "8x8", "--set", "sampler.format=srgb8_a8", "--out",
                    self.path("out"))
        self.assertEqual(self.contents(), self.before)

    def test_run_does_not_replace_its_input(self):
        picture = self.path("out/before.png")
        self.run_texture(2, "--texture", picture, says=["before.png", "--out"])
        self.expect(2, "run", "morphological", "--in", "before.png", "--out", ".",
                    says="before.png", cwd=self.path("out"))
        self.expect(2, "run", "morphological", "--in", "out/../out/after.png", "--truth", picture,
                    "--out", "out", says="after.png")
        os.symlink(picture, self.path("link.png"))
        self.run_texture(2, "--texture", self.path("link.png"), says="link.png")
        self.assertEqual(self.contents(), self.before)
        self.expect(0, "run", "morphological", "--in", picture, "--out", self.path("other"))

    def test_foreign_files_stay(self):
        os.mkdir(self.path("mine"))
        self.write("mine/before.png", b"mine")
        self.write("mine/trace.vcd", b"mine")
        command = ("run", "texture", "--size", "8x8", "--out", self.path("mine"))
        self.expect(2, *command, says=["before.png", "--out"])
        os.remove(self.path("mine/before.png"))
        self.expect(2, *command, "--trace", "*", says="trace.vcd")
        self.expect(0, *command)
        with open(self.path("mine/trace.vcd")) as file:
            self.assertEqual(file.read(), "mine")

    def test_earlier_results_go_when_the_run_starts(self):
        self.run_texture(0, "--check", "none")
        self.assertNotIn("trace.vcd", self.contents())
        self.assertNotIn("golden.png", self.contents())


class StandardOutput(CommandTest):
    """A failed write to the standard output is an error."""

    def test_full_output_is_an_error(self):
        for arguments in (["--help"], ["params", "texture"], ["run", "texture", "--help"]):
            with open("/dev/full", "w") as full:
                done = subprocess.run([DEBURR, *arguments], stdout=full, stderr=subprocess.PIPE,
                                      text=True, check=False)
            self.assertEqual(done.returncode, 5, f"{arguments}: {done.stderr}")

    def test_closed_streams_are_handled(self):
        """No result file gets the file descriptor of a closed stream."""
        command = f"'{DEBURR}' run texture --size 16x16 --out '{self.path('out')}'"
        for closed, code in ((">&-", 5), ("2>&-", 0), ("<&-", 0), ("<&- >&- 2>&-", 5)):
            done = subprocess.run(["bash", "-c", f"{command} {closed}"], capture_output=True, text=True, check=False)
            self.assertEqual(done.returncode, code, f"{closed}: {done.stderr}")
            self.assertEqual(self.result()["verdict"], "pass")
            with open(self.path("out/manifest.json")) as file:
                json.load(file)
            for name in os.listdir(self.path("out")):
                with open(self.path("out/" + name), "rb") as file:
                    self.assertNotIn(b"RESULT: ", file.read(), f"{closed}: {name}")
            shutil.rmtree(self.path("out"))

    def test_names_that_are_not_utf8_are_rejected(self):
        for more in ([], ["--json"]):
            done = subprocess.run([DEBURR, "run", "texture", "--size", "16x16", "--out", b"q\xff", *more],
                                  cwd=self.directory, capture_output=True, check=False)
            self.assertEqual(done.returncode, 2)
            self.assertIn(b"argument 6 is not valid UTF-8", done.stderr)
            if more:
                self.assertEqual(json.loads(done.stdout)["exit_code"], 2)
        self.assertEqual(os.listdir(self.directory), [])


class Interruption(CommandTest):
    """Ctrl-C keeps finished results."""

    def test_ctrl_c_ends_a_run(self):
        process = subprocess.Popen([DEBURR, "run", "texture", "--size", "2048x2048", "--out",
                                    self.path("out")], text=True,
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        # The simulation has begun when the first progress line is printed.
        line = process.stderr.readline()
        self.assertIn("texture", line)
        process.send_signal(signal.SIGINT)
        out, err = process.communicate(timeout=120)
        self.assertEqual(process.returncode, 130, out + err)
        self.assertTrue(out.strip().splitlines()[-1].startswith("RESULT: INTERRUPTED"), out)
        self.assertIn("again", err)
        with open(self.path("out/result.json")) as file:
            result = json.load(file)
        self.assertTrue(result["interrupted"])
        self.assertEqual(result["verdict"], "unchecked")
        self.assertEqual(result["checks"]["mismatches"], 0)
        self.assertGreater(result["checks"]["comparisons"], 0)
        self.assertTrue(os.path.exists(self.path("out/report.html")))

    def test_closed_terminal_ends_a_run(self):
        """SIGHUP, from the kernel and from the shell, with no reader for the terminal output."""
        with open(self.path("said"), "w") as said:
            process, terminal = pty.fork()
            if process == 0:
                os.dup2(said.fileno(), 1)
                os.execl(DEBURR, "deburr", "run", "texture", "--size", "2048x2048", "--trace", "texture.texels",
                         "--out", self.path("out"))
        seen = b""
        while b"texture  " not in seen:
            seen += os.read(terminal, 4096)
        os.close(terminal)
        os.kill(process, signal.SIGHUP)
        _, status = os.waitpid(process, 0)
        self.assertEqual(os.waitstatus_to_exitcode(status), 130)
        with open(self.path("said")) as said:
            self.assertRegex(said.read(), r"\nRESULT: INTERRUPTED texture: [^\n]*\n\Z")
        result = self.result()
        self.assertEqual((result["verdict"], result["interrupted"], result["checks"]["mismatches"]),
                         ("unchecked", True, 0))
        self.assertGreater(result["checks"]["comparisons"], 0)
        self.assertTrue(os.path.exists(self.path("out/report.html")))

    def test_nohup_run_continues(self):
        """An ignored hangup stays ignored."""
        process = subprocess.Popen(["nohup", DEBURR, "run", "texture", "--size", "300x300", "--out", self.path("out")],
                                   text=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        while not self.claimed():
            self.assertIsNone(process.poll())
            time.sleep(0.01)
        process.send_signal(signal.SIGHUP)
        out, err = process.communicate(timeout=300)
        self.assertEqual(process.returncode, 0, out + err)

    def interrupt(self, when, *arguments):
        """Interrupts the command once when() is true; returns the time it took to end, and its output."""
        process = subprocess.Popen([DEBURR, "run", *arguments, "--out", self.path("out")],
                                   text=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        while not when():
            self.assertIsNone(process.poll(), "it ended before it could be interrupted")
            time.sleep(0.01)
        sent = time.monotonic()
        process.send_signal(signal.SIGINT)
        out, err = process.communicate(timeout=120)
        self.assertEqual(process.returncode, 130, out + err)
        return time.monotonic() - sent, out

    def claimed(self):
        """From this point the run handles Ctrl-C."""
        return os.path.exists(self.path("out/.deburr_run/claim.json"))

    def test_ctrl_c_before_the_simulation(self):
        """Rendering this reference takes minutes; the run ends without it and leaves nothing."""
        _, out = self.interrupt(self.claimed, "morphological", "--scene", "object", "--size",
                                "4096x4096", "--set", "frame.reference_samples=16")
        self.assertIn("before the simulation began", out)
        self.assertFalse(os.path.exists(self.path("out")))

    def test_ctrl_c_while_rendering_the_reference(self):
        """Few fragments in a large picture: rendering of the reference starts when the other pictures exist."""
        self.interrupt(lambda: os.path.exists(self.path("out/.deburr_run/difference.png")),
                       "texture", "--scene", "quad", "--size", "4096x4096", "--set",
                       "scene.fov=3.1", "--truth")
        with open(self.path("out/result.json")) as file:
            result = json.load(file)
        self.assertTrue(result["interrupted"])
        self.assertEqual(result["checks"]["mismatches"], 0)
        self.assertGreater(result["checks"]["comparisons"], 0)
        self.assertNotIn("reference.png", os.listdir(self.path("out")))


class Results(CommandTest):
    """`compare` and `report` with missing or invalid results."""

    def setUp(self):
        super().setUp()
        self.run_texture(0)
        os.rename(self.path("out"), self.path("a"))
        shutil.copytree(self.path("a"), self.path("b"))

    def change(self, **values):
        with open(self.path("b/result.json")) as file:
            result = json.load(file)
        result.update(values)
        self.write("b/result.json", json.dumps(result))

    def test_equal_results_pass(self):
        self.expect(0, "compare", self.path("a"), self.path("b"), says=["PASS", "no value differs"])

    def test_different_engines_are_rejected(self):
        self.expect(0, "run", "frame", "--size", "16x16", "--out", self.path("frame"))
        self.expect(2, "compare", self.path("a"), self.path("frame"), says=["texture", "frame"])

    def test_different_work_is_a_warning(self):
        done = self.expect(0, "compare", self.path("a"), self.path("b/result.json"))
        self.assertNotIn("warning", done.stderr)
        self.run_texture(0, "--texture", self.write("t.png", png(8, 8)), "--set",
                         "run.clock_mhz=100")
        done = self.run_command("compare", self.path("a"), self.path("out"))
        for word in ("inputs differ", "t.png", "run.clock_mhz differs"):
            self.assertIn(word, done.stderr)

    def test_slower_run_is_worse(self):
        self.change(cycles=10**9)
        self.expect(1, "compare", self.path("a"), self.path("b"), says=["cycles", "WORSE"])
        self.expect(0, "compare", self.path("b"), self.path("a"))
        self.expect(0, "compare", self.path("a"), self.path("b"), "--cycles-percent", "1e12")

    def test_important_rows_come_first(self):
        """About twenty rows; counters are shown only on request."""
        self.run_texture(0, "--set", "texture.cache.bytes=1024", "--set", "memory.latency=400")
        loose = ("--cycles-percent", "1000", "--throughput-percent", "99")
        command = ("compare", self.path("a"), self.path("out"), *loose)
        short = self.expect(0, *command).stdout
        more = re.search(r"(?m)^(\d+) more values differ: --all shows counters and the rest$", short)
        rows = short[short.index("\n\n") + 2:more.start()].splitlines()[1:]
        self.assertEqual([row.split()[0] for row in rows][:2], ["cycles", "throughput.value"])
        self.assertLess(len(rows), 26)
        whole = self.expect(0, *command, "--all").stdout
        all_rows = whole[whole.index("\n\n") + 2:whole.index("RESULT: ")].splitlines()[1:]
        self.assertEqual([row.split() for row in all_rows[:len(rows)]], [row.split() for row in rows])
        self.assertEqual(len(all_rows), len(rows) + int(more[1]))
        self.assertGreater(int(more[1]), 50)
        self.assertTrue(any(row.startswith("units.") for row in all_rows))
        self.assertFalse(any(row.startswith("units.") for row in rows))
        answer = json.loads(self.run_command(*command, "--json").stdout)
        self.assertEqual(len(answer["comparison"]["values"]), len(all_rows))

    def test_worse_values_are_always_shown(self):
        with open(self.path("b/result.json")) as file:
            checks = json.load(file)["checks"]
        self.change(checks={**checks, "mismatches": 3})
        done = self.expect(1, "compare", self.path("a"), self.path("b"))
        self.assertRegex(done.stdout, r"(?m)^checks.mismatches .* WORSE$")

    def test_rejects_invalid_tolerance(self):
        self.change(cycles=10**9)
        for given in ("nan", "inf", "-1", "two"):
            self.expect(2, "compare", self.path("a"), self.path("b"), "--cycles-percent", given,
                        says=["--cycles-percent", given, "tolerance"])

    def test_rejects_page_among_compared_results(self):
        before = {name: os.stat(self.path("a/" + name)).st_mtime_ns for name in os.listdir(self.path("a"))}
        for page in ("a/report.html", "b/result.json", "a/new.html"):
            for one in ("a", "a/result.json"):
                self.expect(2, "compare", self.path(one), self.path("b"), "--html", self.path(page),
                            says=["--html", "another folder"])
        self.assertEqual(before, {name: os.stat(self.path("a/" + name)).st_mtime_ns
                                  for name in os.listdir(self.path("a"))})
        self.expect(0, "compare", self.path("a"), self.path("b"), "--html", self.path("page.html"))

    def test_failed_run_is_worse(self):
        self.change(verdict="fail")
        self.expect(1, "compare", self.path("a"), self.path("b"), says="verdict")

    def test_rejects_missing_result(self):
        self.expect(5, "compare", self.path("a"), self.path("none"))
        self.expect(5, "report", self.path("none"))

    def test_rejects_file_that_is_no_result(self):
        self.write("b/result.json", "{}")
        self.expect(5, "compare", self.path("a"), self.path("b"), says="schema")
        self.expect(5, "report", self.path("b"))

    def test_rejects_result_changed_by_hand(self):
        """A value of another type, anywhere, gives an error that names the file."""
        with open(self.path("b/result.json")) as file:
            whole = json.load(file)
        places = [(key,) for key in whole if key != "schema"] + [("meaning", key) for key in list(whole["meaning"])[::20]]
        damaged = 0
        for place in places:
            for value in (None, 7, {"a": 1}):
                changed = json.loads(json.dumps(whole))
                (changed if len(place) == 1 else changed[place[0]])[place[-1]] = value
                self.write("b/result.json", json.dumps(changed))
                for command in (("compare", self.path("a"), self.path("b")), ("report", self.path("b"))):
                    done = self.run_command(*command)
                    self.assertIn(done.returncode, (0, 1, 2, 5), f"{place} = {value}: {done.stderr}")
                    damaged += done.returncode == 5
                    if done.returncode == 5:
                        self.assertIn("damaged", done.stderr)
                        self.assertIn(self.path("b"), done.stderr)
        self.assertGreater(damaged, 10)

    def test_rebuilt_report_is_the_same(self):
        os.remove(self.path("b/report.html"))
        self.expect(0, "report", self.path("a"), self.path("b"))
        with open(self.path("a/report.html")) as one, open(self.path("b/report.html")) as two:
            self.assertEqual(one.read(), two.read())

    def test_repro_command_repeats_the_run(self):
        with open(self.path("a/manifest.json")) as file:
            command = json.load(file)["command"]
        done = subprocess.run(command, shell=True, cwd=self.directory, capture_output=True,
                              text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        with open(self.path("out/result.json")) as one, open(self.path("a/result.json")) as two:
            first, second = json.load(one), json.load(two)
        for result in (first, second):
            del result["host"]
        self.assertEqual(first, second)


if __name__ == "__main__":
    unittest.main()
