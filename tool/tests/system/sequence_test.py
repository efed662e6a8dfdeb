#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Sequences of frames, as a list or a pattern of images, meshes or cameras, through every engine: the reported
flicker equals the one computed here from the pictures of one run per frame.

usage: sequence_test.py DEBURR [CLASS]"""
import csv
import json
import os
import pathlib
import struct
import subprocess
import sys
import tempfile
import unittest
import zlib

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[3] / "tb/engines"))
from engine_list import trials  # noqa: E402

DEBURR = "deburr"


def write_png(path, rows):
    """Rows of grey values."""
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    data = b"".join(b"\0" + bytes(v for g in row for v in (g, g, g)) for row in rows)
    head = struct.pack(">IIBBBBB", len(rows[0]), len(rows), 8, 2, 0, 0, 0)
    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(data)) +
                   chunk(b"IEND", b""))


def read_png(path):
    """Pixels of R, G, B, without alpha; 8 bits per channel."""
    with open(path, "rb") as file:
        data = file.read()
    at, packed = 8, b""
    while at < len(data):
        size, kind = struct.unpack_from(">I4s", data, at)
        if kind == b"IHDR":
            width, height, bits, colours = struct.unpack_from(">IIBB", data, at + 8)
        elif kind == b"IDAT":
            packed += data[at + 8:at + 8 + size]
        at += size + 12
    assert bits == 8 and colours in (2, 6)
    channels = 3 if colours == 2 else 4
    raw, row_bytes, before, pixels = zlib.decompress(packed), width * channels, bytes(width * channels), []
    for y in range(height):
        row = bytearray(raw[y * (row_bytes + 1) + 1:(y + 1) * (row_bytes + 1)])
        kind = raw[y * (row_bytes + 1)]
        for i in range(row_bytes):
            left = row[i - channels] if i >= channels else 0
            up, corner = before[i], before[i - channels] if i >= channels else 0
            if kind == 1:
                guess = left
            elif kind == 2:
                guess = up
            elif kind == 3:
                guess = (left + up) // 2
            elif kind == 4:
                guess = min((left, up, corner), key=lambda v: abs(left + up - corner - v))
            else:
                guess = 0
            row[i] = (row[i] + guess) & 255
        before = bytes(row)
        pixels += [tuple(row[i:i + 3]) for i in range(0, row_bytes, channels)]
    return pixels


def flicker(pictures, references, drawn=None):
    """(mean, worst, second frame of the worst pair), as docs/reference/texture/index.md says."""
    squares = []
    for i in range(1, len(pictures)):
        total = count = 0
        for p, (a, b, s, t) in enumerate(zip(pictures[i - 1], pictures[i], references[i - 1], references[i])):
            if drawn and not (drawn[i - 1][p] and drawn[i][p]):
                continue
            count += 3
            total += sum((b[c] - a[c] - (t[c] - s[c])) ** 2 for c in range(3))
        squares.append(total / count)
    worst = max(squares)
    return (sum(squares) / len(squares)) ** 0.5, worst ** 0.5, squares.index(worst) + 1


class SequenceTest(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory(prefix="deburr_sequence_")
        self.addCleanup(scratch.cleanup)
        self.directory = scratch.name

    def path(self, name):
        return os.path.join(self.directory, name)

    def deburr(self, engine, *arguments, code=0):
        done = subprocess.run([DEBURR, "run", engine, "--quiet", *arguments], cwd=self.directory, text=True,
                              capture_output=True, check=False, timeout=300)
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return done.stdout + done.stderr

    def result(self, engine, name, *arguments):
        self.deburr(engine, "--out", name, *arguments)
        with open(self.path(f"{name}/result.json"), encoding="utf-8") as file:
            return json.load(file)

    def check(self, result, pictures, befores, references, drawn=None):
        work = result["work"]
        mean, worst, frame = flicker(pictures, references, drawn)
        self.assertGreater(mean, 0)
        self.assertAlmostEqual(work["flicker"], mean, places=6)
        self.assertAlmostEqual(work["flicker_worst"], worst, places=6)
        self.assertEqual(work["flicker_worst_frame"], frame)
        self.assertAlmostEqual(work["flicker_before"], flicker(befores, references, drawn)[0], places=6)

    def pictures(self, name, count):
        return [read_png(self.path(f"{name}{i}/after.png")) for i in range(count)]

    def write_box(self, name, shift):
        """A slanted box with edges in all directions; the camera follows its position, so its slant varies."""
        corners = [(x, y + (0.23 + shift) * x, z) for z in (-.5, .5) for y in (-.5, .5) for x in (-.5, .5)]
        faces = [(1, 3, 4, 2), (5, 6, 8, 7), (1, 2, 6, 5), (3, 7, 8, 4), (1, 5, 7, 3), (2, 4, 8, 6)]
        with open(self.path(name), "w", encoding="utf-8") as file:
            file.writelines(f"v {x} {y} {z}\n" for x, y, z in corners)
            file.writelines(f"vt {u} {v}\n" for u, v in ((0, 0), (1, 0), (1, 1), (0, 1)))
            file.writelines("f " + " ".join(f"{v}/{i + 1}" for i, v in enumerate(face)) + "\n" for face in faces)


class Images(SequenceTest):
    """The engine that takes picture files."""
    (ENGINE,) = trials("sequence_of_images")
    NAMES = ("f1.png", "f2.png", "f10.png")  # order as numbers, not as text

    def setUp(self):
        super().setUp()
        size = 32
        for k, name in enumerate(self.NAMES):
            edge = [[x + .5 + .23 * (y + .5) > 12 + k / 3 for x in range(size)] for y in range(size)]
            write_png(self.path(name), [[255 if v else 0 for v in row] for row in edge])
            write_png(self.path("t_" + name), [[max(0, min(255, round(255 * (x + 1 + .23 * y - 12 - k / 3))))
                                                for x in range(size)] for y in range(size)])

    def test_flicker_without_reference_uses_the_input(self):
        result = self.result(self.ENGINE, "all", "--in", "f*.png")
        for i, name in enumerate(self.NAMES):
            self.result(self.ENGINE, f"one{i}", "--in", name)
        befores = [read_png(self.path(name)) for name in self.NAMES]
        self.check(result, self.pictures("one", 3), befores, befores)
        self.assertEqual(result["work"]["flicker_before"], 0)
        with open(self.path("all/report.html"), encoding="utf-8") as file:
            self.assertIn("Flicker over 3 frames beyond that of the input", file.read())
        said = subprocess.run([DEBURR, "run", self.ENGINE, "--in", "f*.png", "--out", "all"], cwd=self.directory,
                              text=True, capture_output=True, check=True).stdout
        self.assertRegex(said,
                         f"flicker +{result['work']['flicker']:.2f}/255 over 3 frames .*, beyond that of the input\n")
        # All of them are inputs: a run with other files is another run.
        with open(self.path("all/manifest.json"), encoding="utf-8") as file:
            self.assertEqual([i["file"] for i in json.load(file)["inputs"]], list(self.NAMES))

    def test_still_sequence_has_no_flicker(self):
        work = self.result(self.ENGINE, "still", "--in", "f1.png;f1.png;f1.png")["work"]
        self.assertEqual((work["flicker"], work["flicker_worst"], work["flicker_worst_frame"]), (0, 0, None))
        said = subprocess.run([DEBURR, "run", self.ENGINE, "--in", "f1.png;f1.png", "--out", "still"],
                              cwd=self.directory, text=True, capture_output=True, check=True).stdout
        self.assertRegex(said, r"flicker +0\.00/255 over 2 frames, beyond that of the input\n")

    def test_flicker_with_references(self):
        result = self.result(self.ENGINE, "all", "--in", "f*.png", "--truth", "t_f*.png")
        for i, name in enumerate(self.NAMES):
            self.result(self.ENGINE, f"one{i}", "--in", name)
        self.check(result, self.pictures("one", 3), [read_png(self.path(name)) for name in self.NAMES],
                   [read_png(self.path("t_" + name)) for name in self.NAMES])
        with open(self.path("all/report.html"), encoding="utf-8") as file:
            self.assertIn("Flicker over 3 frames", file.read())
        # Every frame is left, with its quality: that of frame 0 is the result's.
        with open(self.path("all/frames.csv"), encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual([read_png(self.path(f"all/{row['file']}")) for row in rows], self.pictures("one", 3))
        for key in ("psnr_db", "psnr_before_db", "psnr_edge_db", "psnr_edge_before_db", "flip", "ssim", "ssim_before"):
            self.assertEqual(float(rows[0][key]), result["quality"][key])
        self.result(self.ENGINE, "all", "--in", "f1.png;f2.png", "--no-images")
        self.assertFalse(list(pathlib.Path(self.path("all")).glob("*.png")), "of the run before")
        with open(self.path("all/frames.csv"), encoding="utf-8") as file:
            self.assertEqual(file.read().splitlines()[1:], ["0,,,,,,,,,", "1,,,,,,,,,"])

    def test_list_in_configuration_equals_command_line(self):
        with open(self.path("run.yaml"), "w", encoding="utf-8") as file:
            file.write("frame: {source: [f10.png, f1.png], reference: [t_f10.png, t_f1.png]}\n")
        given = self.result(self.ENGINE, "given", "--in", "f10.png; f1.png", "--truth", "t_f10.png;t_f1.png")
        read = self.result(self.ENGINE, "read", "--config", "run.yaml")
        self.assertEqual(given["work"], read["work"])
        again = self.result(self.ENGINE, "again", "--config", "given/manifest.json")
        self.assertEqual(given["work"], again["work"])

    def test_rejects_invalid_sequences(self):
        write_png(self.path("small.png"), [[0] * 16] * 16)
        for says, *arguments in (
                ("no file matches 'g*.png'", "--in", "g*.png"),
                ("all lists of a run must have the same length", "--in", "f*.png", "--truth", "t_f1.png;t_f2.png"),
                ("has an empty entry", "--in", "f1.png;;f2.png"),
                ("frame.source lists 3 frames", "--in", "f*.png", "--frames", "3"),
                ("a single image file has no motion", "--in", "f1.png", "--frames", "3"),
                ("has no motion", "--in", "f1.png", "--motion", "pan"),
                ("frame 1 has 16 x 16 pixels", "--in", "f1.png;small.png")):
            with self.subTest(says):
                self.assertIn(says, self.deburr(self.ENGINE, *arguments, "--out", "rejected", code=2))
        self.assertIn("nothere.png", self.deburr(self.ENGINE, "--in", "f1.png;nothere.png", "--out", "rejected",
                                                 code=5))
        with open(self.path("run.yaml"), "w", encoding="utf-8") as file:
            file.write("frame: {width: [16, 17]}\n")
        self.assertIn("must be a single value", self.deburr(self.ENGINE, "--config", "run.yaml", code=2))


class Meshes(SequenceTest):
    SIZE = ("--size", "40x30")
    EYES = ("0.4,0.5,2.5", "0.5,0.5,2.5")

    def check_engine(self, engine, *arguments, drawn=""):
        """Two meshes, and two cameras on one mesh; the messages are the same for every engine that draws. `drawn`:
        the map whose value is above zero in drawn pixels, if the others do not count."""
        for i in range(2):
            self.write_box(f"m{i}.obj", 0.03 * i)
        settings = [f"scene.eye={eye}" for eye in self.EYES]
        for kind, listed, singles in (
                ("mesh", ["--in", "m?.obj"], [["--in", f"m{i}.obj"] for i in range(2)]),
                ("eye", ["--in", "m0.obj", "--set", "scene.eye=" + ";".join(self.EYES)],
                 [["--in", "m0.obj", "--set", s] for s in settings])):
            with self.subTest(kind):
                result = self.result(engine, f"{kind}_all", *self.SIZE, *listed, *arguments)
                masks = []
                for i, single in enumerate(singles):
                    self.result(engine, f"{kind}{i}", *self.SIZE, *single, *arguments, "--truth",
                                *(["--maps"] if drawn else []))
                    if drawn:
                        with open(self.path(f"{kind}{i}/map_{drawn}.pfm"), "rb") as file:
                            data = file.read()[len(b"Pf\n40 30\n-1.0\n"):]
                        values = struct.unpack("<1200f", data)
                        masks.append([values[(29 - y) * 40 + x] == values[(29 - y) * 40 + x]
                                      for y in range(30) for x in range(40)])
                self.check(result, self.pictures(kind, 2),
                           *([read_png(self.path(f"{kind}{i}/{name}.png")) for i in range(2)]
                             for name in ("before", "reference")), masks or None)

    def test_mesh_sequences_of_every_engine(self):
        for engine, given in trials("sequence_of_meshes").items():
            for arguments in given["runs"]:
                with self.subTest(engine=engine, arguments=arguments):
                    self.check_engine(engine, *arguments, drawn=given.get("drawn", ""))

    def test_mesh_extension_may_be_in_capitals(self):
        self.write_box("BOX.OBJ", 0)
        for engine in trials("moving_camera"):
            with self.subTest(engine):
                self.deburr(engine, "--in", "BOX.OBJ", *self.SIZE, "--out", engine)

    def test_camera_moves_in_every_engine(self):
        scenes = trials("moving_camera")
        self.assertEqual(set(scenes), set(trials("sequence_of_meshes")) | set(trials("sequence_of_images")))
        for engine, source in scenes.items():
            with self.subTest(engine):
                result = self.result(engine, engine, "--scene", source, *self.SIZE, "--frames", "3", "--motion", "pan")
                self.assertGreater(result["work"]["flicker"], 0)
                self.assertGreaterEqual(result["work"]["flicker_worst"], result["work"]["flicker"])
                still = self.result(engine, engine, "--scene", source, *self.SIZE)
                self.assertNotIn("flicker", still["work"])

    def test_fragment_trace_is_one_frame(self):
        self.write_box("m0.obj", 0)
        self.write_box("m1.obj", 1)
        self.result("texture", "first", "--in", "m0.obj", *self.SIZE, "--fragment-trace", "text")
        self.assertIn("the fragments of one frame", self.deburr("texture", "--in", "m?.obj", "--fragments",
                                                        "first/fragments.trace", "--out", "rejected", code=2))


if __name__ == "__main__":
    if len(sys.argv) > 1 and not sys.argv[1].startswith("-"):
        DEBURR = os.path.abspath(sys.argv.pop(1))
    unittest.main()
