#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Golden models and ideal filters through the Python module: the contract's test vectors from its pages, the picture
of examples/c, bad calls, threads, and documentation.

usage: python_golden_test.py MODULES DOCS [CLASS]"""
import collections.abc
import ctypes
import inspect
import math
import multiprocessing
import pathlib
import pickle
import re
import signal
import sys
import threading
import time
import unittest

MODULES, DOCS = pathlib.Path(sys.argv.pop(1)).resolve(), pathlib.Path(sys.argv.pop(1)).resolve()
sys.dont_write_bytecode = True
sys.path.insert(0, str(MODULES))

import numpy  # noqa: E402

import deburr  # noqa: E402
from deburr import golden, ideal  # noqa: E402

FNV_START, FNV_PRIME = 1469598103934665603, 1099511628211


def fnv(data, start=FNV_START):
    value = start
    for byte in bytes(data):
        value = (value ^ byte) * FNV_PRIME & 0xFFFFFFFFFFFFFFFF
    return value


def random_numbers(count, state=1):
    numbers = numpy.empty(count, dtype=numpy.uint32)
    for i in range(count):
        state = (1664525 * state + 1013904223) & 0xFFFFFFFF
        numbers[i] = state
    return numbers


def opaque(red, green, blue):
    return numpy.stack([red, green, blue, numpy.full_like(red, 255)], axis=2).astype(numpy.uint8)


def vector_image(name):
    """docs/reference/morphological/vectors.md, "Test vectors", "Frames" and "Text guard"."""
    width, height = {"noise": (97, 61), "line": (200, 150), "blocks": (90, 80), "shades": (90, 80),
                     "text": (120, 110)}[name]
    y, x = numpy.mgrid[0:height, 0:width]
    s = random_numbers(width * height).reshape(height, width).astype(numpy.int64)
    stripe = (x + 3 * y) % 41 < 9
    if name == "noise":
        v = 255 * (s >> 31)
    elif name == "line":
        disc = (2 * x - 300) ** 2 + (2 * y - 120) ** 2 < 6400
        v = numpy.where(disc, 90, numpy.where(7 * (2 * x + 1) > 31 * (2 * y - 99), 255, 0))
    elif name == "blocks":
        e = x // 23 + 2 * (y // 17) + stripe + numpy.where(s >> 20 & 31, 0, s >> 30)
        v = numpy.array([0, 60, 130, 255])[e % 4]
        return opaque(v, 255 - v, 3 * v % 256)
    elif name == "text":
        k = numpy.where(y < 70, 1, 4)
        u, w = x // k, y // k
        i, j, a, b = u % 6, w % 9, u // 6, w // 9
        glyph = (x < 96) & (i < 5) & (j < 7) & ((i == (a + 2 * b) % 5) | (j == (2 * a + b) % 7))
        ink = glyph | (x >= 96) & (y % 4 == 0)
        speckle = numpy.where((y >= 35) & (y < 70) & (s >> 20 & 31 == 0), s >> 30, 0)
        return opaque(numpy.where(ink, 30, 250) + speckle, numpy.where(ink, 50, 240), numpy.where(ink, 70, 230))
    else:
        e = x // 11 + 2 * (y // 9) + stripe
        v = numpy.array([0, 1, 3, 7, 20, 24, 90, 110])[e % 8] + (s >> 31)
    return opaque(v, v, v)


def table(page, header):
    """The rows of a page's tables that begin with these cells, as dictionaries."""
    rows, columns = [], None
    for line in (DOCS / page).read_text(encoding="utf-8").splitlines():
        cells = [cell.strip() for cell in line.strip("|").split("|")] if line.startswith("|") else None
        if cells is None:
            columns = None
        elif cells[:len(header)] == header:
            columns = cells
        elif columns and not set(line) <= set("|-"):
            rows.append(dict(zip(columns, cells)))
    return rows


def settings(cell):
    return dict(word.split("=") for word in cell.strip("`").split())


class Vectors(unittest.TestCase):
    """The contract's tables: results through Python equal those of C++."""

    def test_morphological_vectors(self):
        rows = table("reference/morphological/vectors.md", ["vector", "image", "preset"])
        self.assertGreater(len(rows), 35)
        columns = {"edges": "edge_pixels", "long": "long_runs", "z": "z_runs", "extended": "extended_runs",
                   "steps": "steps", "probes": "probes", "taken": "diagonals", "blended": "blended_pixels"}
        for row in rows:
            preset = dict(zip(("preset", "quality"), row["preset"].split()))
            for detail in (False, True):
                with self.subTest(row["vector"], detail=detail):
                    frame = golden.morphological(vector_image(row["image"]), detail=detail, **preset,
                                                 **settings(row["settings"]))
                    self.assertEqual(f"{fnv(frame.pixels[:, :, :3].tobytes()):016x}", row["hash"])
                    for column, name in columns.items():
                        self.assertEqual(frame.work[name], int(row[column]), name)
                    self.assertEqual(frame.work.horizontal_runs + frame.work.vertical_runs, int(row["runs"]))
                    self.assertEqual(numpy.count_nonzero(frame.edges), frame.work.edge_pixels)

    def test_intermediate_planes_agree(self):
        """Planes agree with each other, and with the counters."""
        frame = golden.morphological(vector_image("blocks"), preset="deburr-line", detail=True)
        self.assertEqual(frame.pixels.shape, (80, 90, 4))
        self.assertEqual(frame.probes.shape, (80, 90))
        self.assertTrue((frame.probes["edges"] == frame.edges).all())
        mixed = (frame.probes["first"] | frame.probes["second"]) != 0
        self.assertEqual(numpy.count_nonzero(mixed), frame.work.blended_pixels)
        self.assertTrue((frame.pixels[~mixed] == vector_image("blocks")[~mixed]).all())
        self.assertTrue((frame.weights[:, :, :2][(frame.edges & 2) == 0] == 0).all())
        runs = frame.runs
        whole = runs["line"]["run"]["part"] == 0
        self.assertEqual(numpy.count_nonzero(whole) + numpy.count_nonzero(runs["line"]["run"]["part"] == 1),
                         frame.work.horizontal_runs + frame.work.vertical_runs)
        self.assertEqual(int(runs["probes"].sum()), frame.work.probes)
        self.assertEqual(int(runs["line"]["left_steps"].sum() + runs["line"]["right_steps"].sum()), frame.work.steps)
        self.assertEqual(sum(hits for name, hits in frame.coverage.items() if name.startswith("decision/")), 80 * 90)
        self.assertTrue((numpy.unique(frame.decisions) < 8).all())
        # The engine's own edges, given as input, lead to the same frame.
        again = golden.morphological(vector_image("blocks"), edges=frame.edges, preset="deburr-line")
        self.assertTrue((again.pixels == frame.pixels).all())

    def test_frame_with_gaps_and_without_alpha(self):
        whole = vector_image("line")
        wide = numpy.full((150, 210, 4), 77, dtype=numpy.uint8)
        wide[:, 5:205] = whole
        expected = golden.morphological(whole, preset="mlaa").pixels
        for other in (wide[:, 5:205], whole[:, :, :3], numpy.asfortranarray(whole), whole[::-1][::-1]):
            self.assertTrue((golden.morphological(other, preset="mlaa").pixels == expected).all())

    def test_memory_lines(self):
        image = vector_image("line")
        plain = golden.morphological(image, storage="memory")
        self.assertGreater(plain.traffic.size, 0)
        self.assertEqual(numpy.count_nonzero(plain.traffic["write"]) * 2, plain.traffic.size)
        reads = plain.traffic[~plain.traffic["write"]]
        failing = golden.morphological(image, storage="memory", error_lines=reads["address"][20:40].copy())
        self.assertGreater(failing.memory_errors, 0)
        self.assertFalse((failing.pixels == plain.pixels).all())
        self.assertEqual(golden.morphological(image).traffic.size, 0)

    def test_depth_formats_agree(self):
        """float32 and codes are the same depth, which gives edges."""
        y, x = numpy.mgrid[0:40, 0:60]
        depth = numpy.where(2 * x + y > 60, numpy.float32(0.75), numpy.float32(0.125))
        codes = numpy.floor(depth.astype(numpy.float64) * 0xFFFFFF + 0.5).astype(numpy.uint32)
        image = numpy.full((40, 60, 4), 90, dtype=numpy.uint8)
        frames = [golden.morphological(image, one, edges_source="depth") for one in (depth, codes)]
        self.assertGreater(frames[0].work.edge_pixels, 30)
        self.assertTrue((frames[0].edges == frames[1].edges).all())
        self.assertEqual(golden.morphological(image).work.edge_pixels, 0)
        depth[2, 1] = 1.5
        with self.assertWarnsRegex(UserWarning, r"depth: 1 of 2400 values lie outside \[0, 1\], the first at \(1, 2\)"):
            clamped = golden.morphological(image, depth, edges_source="depth")
        depth[2, 1] = 1
        self.assertTrue((clamped.edges == golden.morphological(image, depth, edges_source="depth").edges).all())

    @staticmethod
    def random_edges():
        """docs/reference/geometric/vectors.md, "Random edges"."""
        random = iter(random_numbers(2 * 61 * 45 + 600 + 49 + 1500).astype(numpy.int64))
        r = numpy.array([next(random) for _ in range(61 * 45)]).reshape(45, 61)
        pixels = opaque(r >> 24, r >> 16 & 255, r >> 8 & 255)
        depth = numpy.array([0, 3000000, 3005000, 6000000, 6011000, 9000000, 9017000, 16777215], dtype=numpy.uint32)[
            numpy.array([next(random) >> 29 for _ in range(61 * 45)]).reshape(45, 61)]
        vertices = numpy.zeros(200, dtype=golden.VERTEX)
        for i in range(200):
            x, y, z = (int(next(random)) for _ in range(3))
            vertices[i] = ((x >> 16) % 20480 - 2304, (y >> 16) % 16384 - 2304, z >> 8, True)
        for name in ("x", "y"):
            vertices[name][:10] &= ~127
        vertices["usable"][7] = False
        vertices["x"][11] = 1 << 22
        facing = numpy.array([next(random) >> 31 for _ in range(49)], dtype=bool)
        edges = numpy.zeros(300, dtype=golden.EDGE)
        for i in range(300):
            edges[i] = tuple((int(next(random)) >> 16) % most for most in (201, 200, 50, 50, 16))
        return pixels, depth, {"vertices": vertices, "edges": edges, "facing": facing}

    @staticmethod
    def special_cases():
        """The same page, "Special cases", without bits that memory ignores and an array does not have."""
        random = (int(r) for r in random_numbers(2 * 61 * 45 + 600 + 50 + 2000))
        r = numpy.array([next(random) for _ in range(61 * 45)]).reshape(45, 61)
        pixels = numpy.stack([r >> 24, r >> 16 & 255, r >> 8 & 255, r & 255], axis=2).astype(numpy.uint8)
        depths = (0, 4000000, 8000000, 8015655, 12000000, 12800000, 16000000, 16777215)
        depth = numpy.array([depths[next(random) >> 29] for _ in range(61 * 45)],
                            dtype=numpy.uint32).reshape(45, 61)
        vertices = numpy.zeros(200, dtype=golden.VERTEX)
        for i in range(100):
            a, b = ([64 * ((next(random) >> 16) % 264) - 512, 64 * ((next(random) >> 16) % 200) - 512,
                     depths[next(random) >> 29]] for _ in range(2))
            if i % 2 == 0:
                b[2] = a[2]
            beside, height = None, b[1] - a[1]
            if 30 <= i < 40:
                a[1] = b[1] = 256 * 45 * (i % 2)
            elif 40 <= i < 50:
                a[0] = b[0] = 256 * 61 * (i % 2)
            elif 50 <= i < 65:
                a[1] = b[1] = 256 * (a[1] >> 8) + 128
            elif 65 <= i < 80:
                beside = (height, height)
            elif 80 <= i < 90:
                beside = (2 * height, height)
            elif 90 <= i < 95:
                a[i % 2], b[i % 2] = -1 << 22, (1 << 22) - 1
            elif i >= 95:
                a[0], a[1] = a[0] & ~127, a[1] & ~127
                beside = (1 << 21, (1 << 20) + 1)
            if beside:
                along, across = beside if i % 4 < 2 else reversed(beside)
                b[0], b[1] = a[0] + along, a[1] + across
            for k, (x, y, z) in enumerate((a, b)):
                vertices[2 * i + k] = (x, y, z | 0xFF000000, True)
        facing = numpy.array([next(random) >> 31 for _ in range(50)], dtype=bool)
        edges = numpy.zeros(400, dtype=golden.EDGE)
        for i in range(400):
            v0, v1, f0, f1, flags = ((next(random) >> 16) % most for most in (200, 200, 50, 50, 16))
            if i < 100:
                v0, v1 = 2 * i + v0 % 2, 2 * i + 1 - v0 % 2
            edges[i] = (v0, v1, f0, 0xFFFFFF if flags & 1 else f1, flags | 0xF0)
        return pixels, depth, {"vertices": vertices, "edges": edges, "facing": facing}

    def test_geometric_vectors(self):
        bases = {"edges": 0x10000, "vertices": 0x20000, "facing": 0x30000, "depth": 0x40000, "colour": 0x50000,
                 "weights": 0x60000, "copy": 0x70000}
        hashes = table("reference/geometric/vectors.md", ["", "preset", "beside it"])
        counts = {row[""]: row for row in table("reference/geometric/vectors.md", ["", "edges", "boundary"])}
        self.assertEqual(len(hashes), 14 + 5 + 7)  # the last seven: options for less traffic, with an order of their own
        frames = [self.random_edges()] * 14 + [self.special_cases()] * 5
        for row, (pixels, depth, drawn) in zip(hashes, frames):
            preset = row["preset"].strip("`")
            frame = golden.geometric(pixels, depth, **drawn, bases=bases, detail=True, preset=preset,
                                     **settings(row["beside it"]))
            with self.subTest(row[""]):
                self.assertEqual(f"{fnv(frame.pixels.tobytes()):016x}", row["pixels"])
                self.assertEqual(f"{fnv(frame.weights.tobytes()):016x}", row["weights"])
                copied = preset == "gpaa" or preset == "gpaa-optimised"
                t = frame.traffic
                order = [t[name]["reads"] for name in ("faces", "edges", "vertices", "depth", "weights")]
                order += [t["weights"]["writes"], t["copy" if copied else "colour"]["reads"], t["colour"]["writes"]]
                if copied:
                    order += [t["colour"]["reads"], t["copy"]["writes"]]
                value = FNV_START
                for addresses in order:
                    value = fnv(addresses.tobytes(), value)
                self.assertEqual(f"{value:016x}", row["traffic"])
                wanted = counts[row[""]]
                for column, name in (("edges", "edges"), ("boundary", "boundary_edges"), ("kept", "kept_edges"),
                                     ("lines", "lines"), ("columns", "columns"), ("candidates", "candidates"),
                                     ("passed", "passed"), ("blocks", "blocks"), ("blended", "blended_pixels")):
                    self.assertEqual(frame.work[name], int(wanted[column]), name)
                self.assertEqual(frame.lines.size, frame.work.lines)
                self.assertEqual(frame.candidates.size, frame.work.candidates)
                self.assertEqual(numpy.count_nonzero(frame.candidates["passed"]), frame.work.passed)
                self.assertEqual(frame.blocks.size, frame.work.blocks)
                boundary = golden.EDGE_CLASSES.index("boundary")
                self.assertEqual(numpy.count_nonzero(frame.classes == boundary), frame.work.boundary_edges)
                quick = golden.geometric(pixels, depth, **drawn, preset=preset, **settings(row["beside it"]))
                self.assertTrue((quick.pixels == frame.pixels).all())

    def test_results_outlive_their_frame_and_are_read_only(self):
        pixels = golden.morphological(vector_image("noise"), preset="mlaa").pixels
        others = [golden.morphological(vector_image("noise"), preset="smaa") for _ in range(4)]
        self.assertEqual(f"{fnv(pixels[:, :, :3].tobytes()):016x}", "00b097db028f25fd")
        with self.assertRaises(ValueError):
            pixels[0, 0] = 0
        del others


SIDE, WIDTH, HEIGHT = 64, 192, 128


def checkerboard():
    y, x = numpy.mgrid[0:SIDE, 0:SIDE]
    light = ((x // 8) ^ (y // 8)) & 1
    return opaque(*(numpy.where(light, a, b) for a, b in ((240, 40), (220, 40), (180, 60))))


def floor():
    y, x = numpy.mgrid[0:HEIGHT, 0:WIDTH].astype(numpy.int64)
    s = ((x - WIDTH // 2) << 24) * 3
    s = numpy.sign(s) * (abs(s) // (2 * (y + 24)))  # as C divides
    t = (300 << 24) // (2 * (y + 24))
    return s.astype(numpy.int32), t.astype(numpy.int32), 8 * y >= 160 + x


FIELDS = {"format": "rgba8", "layout": "tiled", "min_filter": "linear_mipmap_linear", "mag_filter": "linear",
          "max_count_log2": 4, "max_lod": 3072, "wrap_s": "repeat", "wrap_t": "mirrored_repeat"}
PICTURE = 0xc807d6205d1665b6  # of examples/c/draw.c


class Texture(unittest.TestCase):
    def setUp(self):
        self.unit = golden.TextureUnit(axes="eight")
        self.unit.load(golden.mip_levels(checkerboard()), **FIELDS)
        s, t, covered = floor()
        self.quads = golden.quads_of(s, t, covered)

    def test_picture_of_the_c_example(self):
        colours = self.unit.filter(self.quads)
        picture = golden.image_of(self.quads, colours, (HEIGHT, WIDTH))
        picture[~floor()[2]] = (120, 170, 230, 255)
        smooth = golden.morphological(picture, preset="deburr")
        self.assertEqual(fnv(smooth.pixels.tobytes(), 14695981039346656037), PICTURE)
        # The function has its own unit.
        again, unit = golden.texture(self.quads, golden.mip_levels(checkerboard()), fields=FIELDS, axes="eight")
        self.assertTrue((again == colours).all())
        self.assertEqual(unit.work.as_dict().keys(), self.unit.work.as_dict().keys())
        self.assertEqual(unit.work.fragments, numpy.count_nonzero(floor()[2]))

    def test_work_fills_and_decisions(self):
        colours = self.unit.filter(self.quads)
        work, fills = self.unit.work, self.unit.fills
        self.assertEqual(work.fragments, colours.size)
        self.assertEqual(work.line_fills, fills.size)
        self.assertGreater(fills.size, 50)
        self.assertEqual(int((work.by_samples * numpy.arange(17)).sum()), work.samples)
        self.assertEqual(int(work.by_level.sum()), work.bilinears)
        decided = self.unit.analyse(self.quads)
        covered = (self.quads["coverage"][:, None] >> numpy.arange(4) & 1).astype(bool)
        self.assertEqual(int(decided["lod"]["samples"][covered].sum()), work.samples)
        self.assertEqual(self.unit.work.fragments, work.fragments, "analyse() changes nothing")
        # The cache keeps its contents between calls, until it is emptied.
        self.unit.filter(self.quads)
        warm = self.unit.fills.size
        self.unit.invalidate()
        self.unit.filter(self.quads)
        self.assertLess(warm, self.unit.fills.size)
        self.unit.reset()
        self.assertEqual(self.unit.work.fragments, 0)

    def test_memory_and_parameters(self):
        before = self.unit.filter(self.quads)
        first = self.unit.read(0, 256)
        self.unit.write(0, numpy.zeros(256, dtype=numpy.uint8))
        self.unit.invalidate()
        self.assertFalse((self.unit.filter(self.quads) == before).all())
        for values in (first, bytes(first), bytearray(first), memoryview(first), memoryview(first.reshape(4, 64)),
                       numpy.repeat(first, 2)[::2]):
            self.unit.write(0, numpy.zeros(256, dtype=numpy.uint8))
            self.unit.write(0, values)
            self.assertTrue((self.unit.read(0, 256) == first).all())
        self.assertTrue((self.unit.filter(self.quads) == before).all())
        self.unit.set(cache_bytes=1024)
        self.assertEqual(self.unit.parameters["cache.bytes"], "1024")
        self.assertTrue((self.unit.filter(self.quads) == before).all())
        lines = numpy.unique(self.unit.fills)
        self.unit.set_error_lines(lines[:4].astype(numpy.uint32))
        self.unit.invalidate()
        self.unit.filter(self.quads)
        self.assertGreater(self.unit.work.memory_errors, 0)

    def test_error_lines_survive_new_parameters(self):
        self.unit.set_error_lines(numpy.arange(1 << 12, dtype=numpy.uint32))
        self.unit.set(cache_bytes=1024)
        self.unit.filter(self.quads)
        self.assertGreater(self.unit.work.memory_errors, 0)

    def test_two_textures(self):
        self.unit.load([numpy.full((4, 4, 1), 200, dtype=numpy.uint8)], texture=3, format="l8", min_filter="nearest")
        self.assertIsNone(self.unit.describe(3)["fault"])
        quads = golden.quads_of(numpy.zeros((2, 2)), numpy.zeros((2, 2)), texture=3)
        self.assertTrue((self.unit.filter(quads)["rgba"] == (200, 200, 200, 255)).all())
        quads["texture"] = 5
        self.assertTrue((self.unit.filter(quads)["rgba"] == 0).all())
        self.assertIsNotNone(self.unit.describe(5)["fault"])

    def test_textures_of_blocks(self):
        white = numpy.array([[[255, 255, 0, 0, 0, 0, 0, 0]]], dtype=numpy.uint8)
        levels = [numpy.tile(white, (2, 3, 1)), numpy.tile(white, (1, 2, 1))]
        unit = golden.TextureUnit(decode="after")
        unit.load(levels, format="bc1", width=11, height=5, min_filter="nearest")
        described = unit.describe()
        self.assertEqual([described[key] for key in ("width", "height", "levels", "block_bytes", "fault")],
                         [11, 5, 2, 8, None])
        quads = golden.quads_of(numpy.zeros((2, 2)), numpy.zeros((2, 2)))
        self.assertTrue((unit.filter(quads)["rgba"] == 255).all())
        unit.load(levels[:1], texture=1, format="bc1")
        self.assertEqual((unit.describe(1)["width"], unit.describe(1)["height"]), (12, 8))

    def test_quads_match(self):
        s = numpy.array([[0.5, 200], [-1, math.nan]])
        quads = golden.quads_of(s, numpy.zeros((2, 2)))
        self.assertEqual(quads["s"][0].tolist(), [1 << 23, (1 << 31) - 1, -(1 << 24), 0])
        self.assertEqual((int(quads["clamped"][0]), int(quads["coverage"][0])), (0b1010, 15))
        quads = golden.quads_of(numpy.zeros((4, 6)), numpy.zeros((4, 6)))
        self.assertEqual([(int(q["x"]), int(q["y"])) for q in quads], [(0, 0), (2, 0), (4, 0), (0, 2), (2, 2), (4, 2)])


class Pickle(unittest.TestCase):
    """Results go to another process and back."""

    def same(self, one, other):
        if isinstance(one, collections.abc.Mapping):
            self.assertEqual(list(one), list(other))
            for name in one:
                self.same(one[name], other[name])
        elif isinstance(one, numpy.ndarray):
            self.assertEqual((one.dtype, one.shape), (other.dtype, other.shape))
            if one.dtype.names:  # without the padding of records
                for name in one.dtype.names:
                    self.same(one[name], other[name])
            else:
                self.assertTrue((one == other).all())
        else:
            self.assertEqual(one, other)

    def test_frames(self):
        image, (pixels, depth, drawn) = vector_image("blocks"), Vectors.special_cases()
        for detail in (False, True):
            for frame in (golden.morphological(image, preset="smaa", storage="memory", detail=detail),
                          golden.geometric(pixels, depth, detail=detail, **drawn)):
                copy = pickle.loads(pickle.dumps(frame))
                self.assertIs(type(copy), type(frame))
                for name in dir(frame):
                    if name.startswith("_"):
                        continue
                    try:
                        value = getattr(frame, name)
                    except ValueError as error:
                        self.assertFalse(detail)
                        with self.assertRaisesRegex(ValueError, re.escape(str(error))):
                            getattr(copy, name)
                    else:
                        self.same(value, getattr(copy, name))
                with self.assertRaises(ValueError):
                    copy.pixels[0, 0] = 0
                self.same(frame.pixels, pickle.loads(pickle.dumps(copy)).pixels)

    def test_texture_unit(self):
        unit = golden.TextureUnit(axes="eight")
        unit.load(golden.mip_levels(checkerboard()), **FIELDS)
        unit.load(checkerboard(), 3)
        quads = golden.quads_of(*floor())
        unit.set_error_lines(numpy.arange(40, dtype=numpy.uint32))
        colours = unit.filter(quads)
        copy = pickle.loads(pickle.dumps(unit))
        self.same(unit.work, copy.work)
        self.same(unit.fills, copy.fills)
        self.assertGreater(copy.work.memory_errors, 0)
        self.assertEqual((copy.parameters, copy.describe(3)), (unit.parameters, unit.describe(3)))
        unit.reset()
        self.same(unit.filter(quads), colours)
        self.same(copy.filter(quads), colours)
        self.same(copy.work, unit.work)
        self.assertEqual(copy.load(checkerboard(), 4), unit.load(checkerboard(), 4))
        self.assertEqual(copy.describe(4), unit.describe(4))

    def test_functions_map_over_processes(self):
        frames = [vector_image("noise"), vector_image("line")]
        with multiprocessing.get_context("fork").Pool(1) as pool:
            for function in (golden.morphological, ideal.fxaa):
                for frame, made in zip(frames, pool.map(function, frames)):
                    self.same(getattr(made, "pixels", made), getattr(function(frame), "pixels", function(frame)))


class Ideal(unittest.TestCase):
    def test_filters_approach_the_reference(self):
        """A slanted edge with a known reference: each filter comes closer to it; a frame without edges is unchanged."""
        reference = ideal.half_plane(0.25, -1, 10.3, 96, 64)
        jagged = numpy.where(reference > 0.5, 255, 0)
        frame = opaque(jagged, jagged, jagged)

        def error(pixels):
            return float(numpy.mean((pixels[4:-4, 4:-4, 0] / 255.0 - reference[4:-4, 4:-4]) ** 2))
        worst = error(frame)
        smaa = golden.morphological(frame, preset="smaa", linear_light=False).pixels
        for pixels in (ideal.fxaa(frame, linear_light=False), ideal.cmaa2(frame, linear_light=False), smaa):
            self.assertLess(error(pixels), 0.5 * worst)
        flat = numpy.full((20, 30, 4), 99, dtype=numpy.uint8)
        for one in (ideal.fxaa, ideal.cmaa2):
            self.assertTrue((one(flat) == flat).all())
        self.assertFalse((ideal.fxaa(frame, steps=12) == ideal.fxaa(frame, steps=39)).all())

    def test_coverage_is_exact(self):
        self.assertAlmostEqual(float(ideal.disc(20, 20, 7.5, 40, 40).sum()), math.pi * 7.5 ** 2, places=6)
        self.assertAlmostEqual(float(ideal.half_plane(1, 0, -3.25, 8, 4).sum()), 4 * (8 - 3.25), places=9)

    def test_smaa_weights(self):
        reference = ideal.half_plane(0.25, -1, 10.3, 96, 64)
        luma = numpy.where(reference > 0.5, 1.0, 0.0)
        edges = ideal.smaa_edges(luma)
        self.assertTrue((edges == golden.morphological(opaque(*3 * [255 * luma]), preset="smaa").edges).all())
        weights = ideal.smaa_weights(edges)
        self.assertEqual(weights.shape, (64, 96, 4))
        self.assertTrue((weights[(edges & 2) == 0][:, :2] == 0).all())
        self.assertGreater(numpy.count_nonzero(weights), 100)

    def test_textures_approach_the_ideal(self):
        """The golden model is close to its ideal, and the average of one colour is that colour."""
        s, t, covered = floor()
        covered &= numpy.arange(HEIGHT)[:, None] >= 96
        quads = golden.quads_of(s, t, covered)
        texels = checkerboard()
        colours, _ = golden.texture(quads, golden.mip_levels(texels), fields=FIELDS, preset="deburr")
        image = ideal.TextureImage(texels, wrap_t="mirrored_repeat")
        footprints = ideal.pixel_footprints(quads, SIDE, SIDE)
        self.assertEqual(footprints.size, colours.size)
        self.assertGreater(ideal.psnr(ideal.box(image, footprints, n=16), colours["rgba"].copy()), 25)
        self.assertGreater(ideal.psnr(ideal.ewa(image, footprints), colours["rgba"].copy()), 20)
        flat = ideal.TextureImage(numpy.full((8, 8, 4), 50, dtype=numpy.uint8))
        for one in (ideal.box, ideal.ewa):
            self.assertTrue(numpy.allclose(one(flat, footprints[:50].copy()), 50))
        self.assertEqual(ideal.psnr(numpy.full((3, 4), 7.0), numpy.full((3, 4), 7, dtype=numpy.uint8)), math.inf)

    def test_line_coverage(self):
        """A horizontal edge a quarter into its row of pixels: a quarter of the neighbour."""
        lines = numpy.zeros(1, dtype=ideal.SCREEN_LINE)
        lines[0] = ((0.0, 4.25, 0.5), (16.0, 4.25, 0.5), False)
        weights = ideal.line_weights(lines, numpy.full((8, 16), 0.5))
        self.assertTrue(numpy.allclose(weights[4, 1:-1].max(axis=1), 0.25))
        light = numpy.zeros((8, 16, 3))
        light[4:] = 1
        self.assertTrue(numpy.allclose(ideal.line_blend(light, weights)[4, 1:-1], 0.75))


def laid_out(array, random):
    """The same values with other strides: axes in any order and direction, gaps of any number of bytes."""
    strides, reach, start = [0] * array.ndim, array.itemsize, 0
    order = random.permutation(array.ndim) if random.integers(2) else range(array.ndim - 1, -1, -1)
    for axis in order:
        stride = reach + int(random.choice([0, 0, random.integers(1, 9)]))
        reach = stride * max(array.shape[axis], 1)
        backwards = random.integers(4) == 0
        start += stride * (array.shape[axis] - 1) if backwards and array.shape[axis] else 0
        strides[axis] = -stride if backwards else stride
    memory = random.integers(256, size=reach + array.itemsize, dtype=numpy.uint8)
    other = numpy.ndarray(array.shape, array.dtype, memory, start, strides)
    other[...] = array
    return other


class Layouts(unittest.TestCase):
    """For every array argument, only the values matter."""

    def calls(self):
        """Function, arrays by name, other arguments, and the compared part of the result."""
        pixels, depth, drawn = Vectors.random_edges()
        codes, line = depth, numpy.arange(0, 4096, 64, dtype=numpy.uint32)
        own = golden.morphological(pixels).edges
        levels, (s, t, covered) = golden.mip_levels(checkerboard()), floor()
        quads = golden.quads_of(s, t, covered)[::7].copy()
        colours, _ = golden.texture(quads, levels, fields=FIELDS)

        def frame(result):
            return [result.pixels]

        def texture(result):
            return [result[0], result[1].fills]

        def unit(name, argument, *before):
            def call(**arrays):
                made = golden.TextureUnit()
                made.load(levels, **FIELDS)
                return made, getattr(made, name)(*before, arrays[argument])
            call.__name__ = name
            return call

        def filtered(result):
            return [result[0].filter(quads), result[0].work.memory_errors]
        smooth = golden.morphological
        yield smooth, {"pixels": pixels, "depth": (codes / 0xFFFFFF).astype(numpy.float32)}, {"edges_source": "depth"}, frame
        yield smooth, {"pixels": pixels[:, :, :3], "depth": codes}, {"edges_source": "depth"}, frame
        yield smooth, {"pixels": pixels, "edges": own, "error_lines": line}, {"storage": "memory"}, frame
        yield golden.geometric, {"pixels": pixels, "depth": depth, **drawn, "error_lines": line}, {}, frame
        yield golden.texture, {"quads": quads, "levels": levels[0]}, {"fields": FIELDS}, texture
        yield golden.mip_levels, {"texels": checkerboard()}, {}, list
        yield golden.quads_of, {"s": s, "t": t, "covered": covered}, {}, lambda result: [result]
        yield (golden.image_of, {"quads": quads, "colours": colours}, {"shape": (HEIGHT, WIDTH)},
               lambda result: [result])
        yield unit("load", "levels"), {"levels": levels[1]}, {}, lambda result: [result[0].read(0, 20000)]
        yield unit("write", "values", 64), {"values": levels[2].reshape(-1)}, {}, filtered
        for name in ("filter", "analyse"):
            yield unit(name, "quads"), {"quads": quads}, {}, lambda result: [result[1]]
        yield unit("set_error_lines", "lines"), {"lines": line // 64}, {}, filtered

    def test_only_values_matter(self):
        random, tried = numpy.random.default_rng(1), set()
        for function, arrays, others, compared in self.calls():
            tried |= {(function.__name__, name) for name in arrays}
            wanted = compared(function(**arrays, **others))
            for trial in range(20):
                moved = {name: laid_out(array, random) for name, array in arrays.items()}
                strides = {name: array.strides for name, array in moved.items()}
                with self.subTest(function.__name__, strides=strides):
                    got = compared(function(**moved, **others))
                    self.assertEqual([numpy.asarray(one).tobytes() for one in got],
                                     [numpy.asarray(one).tobytes() for one in wanted])
        offered = [(name, getattr(golden, name)) for name in golden.__all__ if inspect.isfunction(getattr(golden, name))]
        offered += inspect.getmembers(golden.TextureUnit, inspect.isfunction)
        given = {(name, argument.name) for name, function in offered
                 for argument in inspect.signature(function).parameters.values() if "Array" in str(argument.annotation)}
        self.assertEqual(tried, given)


class BadCalls(unittest.TestCase):
    """Each is an error with a clear message, and does not affect the next call."""

    def rejected(self, words, function, *arguments, error=ValueError, **named):
        with self.assertRaises(error) as caught:
            function(*arguments, **named)
        for word in [words] if isinstance(words, str) else words:
            self.assertIn(word, str(caught.exception))

    def test_rejects_bad_frames(self):
        image = vector_image("noise")
        good = golden.morphological(image, preset="mlaa").pixels.copy()
        rejected = self.rejected
        for pixels, given in ((None, "None"), ([[1]], "type list"), (image.astype(float), "float64 of (61, 97, 4)"),
                              (image[:, :, 0], "uint8 of (61, 97)"), (image[:, :, :2], "uint8 of (61, 97, 2)"),
                              (image.astype(numpy.int8), "int8"), ("picture.png", "type str")):
            for function in (golden.morphological, ideal.fxaa, ideal.cmaa2):
                rejected(("pixels: expected uint8 of (height, width, 4)", given), function, pixels)
        for shape in ((0, 4, 4), (4, 0, 4), (8193, 1, 4), (1, 8193, 4)):
            rejected("width and height must be 1..8192", golden.morphological, numpy.zeros(shape, dtype=numpy.uint8))
        for depth in (numpy.zeros((61, 97)), numpy.zeros((61, 97, 1), numpy.float32), numpy.zeros((97, 61), numpy.float32),
                      numpy.zeros(61 * 97, numpy.uint32), [0.0]):
            rejected("depth: ", golden.morphological, image, depth)
        depth = numpy.full((61, 97), 0.5, numpy.float32)
        depth[3, 5:7] = numpy.nan
        rejected("depth: 2 of 5917 values are NaN, the first at (5, 3): write 0 (infinitely far)",
                 golden.morphological, image, depth)
        depth = numpy.ones((61, 97), numpy.uint32)
        depth[4, 6] = 1 << 24
        rejected("depth: 1 of 5917 values lie outside 0..16777215, the first at (6, 4): a depth has 24 bits",
                 golden.morphological, image, depth)
        rejected("nobody", golden.morphological, image, nobody=1)
        for name, value, words in (("preset", "mlab", "'preset' = 'mlab' must be one of mlaa, mlaa-slope, smaa"),
                                   ("steps", 99, "'steps' = '99' is outside 0..16"), ("steps", None, "'steps' = 'None'"),
                                   ("steps", 1.5, "'steps' = '1.5' must be an integer 0..16"),
                                   ("trim", "maybe", "'trim' = 'maybe' must be true or false"),
                                   ("steps", image, "'steps' = '[")):
            rejected(words, golden.morphological, image, **{name: value})
        rejected("unknown parameter 'stepps'; known:", golden.morphological, image, stepps=4)
        rejected("window_rows", golden.morphological, image, window_rows=11)  # what cannot be built
        edges = numpy.zeros((61, 97), dtype=numpy.uint8)
        edges[0, 5] = 2
        rejected("edges of (5, 0) are 2", golden.morphological, image, edges=edges)
        rejected("edges: expected the size of the pixels, (61, 97)", golden.morphological, image, edges=edges[:60])
        rejected("give one", golden.morphological, image, numpy.zeros((61, 97), numpy.float32), edges=0 * edges)
        frame = golden.morphological(image, preset="mlaa")
        for plane in ("probes", "decisions", "runs", "coverage"):
            rejected("give detail=True", getattr, frame, plane)
        rejected("error_lines", golden.morphological, image, error_lines=[1, 2])
        rejected("", golden.morphological, error=TypeError)
        self.assertTrue((golden.morphological(image, preset="mlaa").pixels == good).all())

    def test_rejects_bad_meshes(self):
        image, depth = vector_image("noise"), numpy.zeros((61, 97), numpy.float32)
        mesh = {"vertices": numpy.zeros(4, golden.VERTEX), "edges": numpy.zeros(3, golden.EDGE),
                "facing": numpy.zeros(2, bool)}
        frame = golden.geometric(image, depth, **mesh)
        self.assertTrue((frame.pixels == image).all())
        self.rejected("the frame has no depth", golden.geometric, image, **mesh)
        for name, value in (("vertices", numpy.zeros((4, 4), numpy.uint32)), ("edges", None), ("edges", mesh["vertices"]),
                            ("facing", numpy.zeros(2, numpy.uint8)), ("facing", [True]), ("vertices", numpy.zeros(4))):
            self.rejected(f"{name}: ", golden.geometric, image, depth, **{**mesh, name: value})
        self.rejected("unknown region of memory 'face'", golden.geometric, image, depth, bases={"face": 0}, **mesh)
        self.rejected("is not a multiple of 64", golden.geometric, image, depth, bases={"edges": 8}, **mesh)
        self.rejected("bases", golden.geometric, image, depth, bases=7, **mesh)
        # Indices out of range are dropped, as the contract says.
        mesh["edges"]["v0"] = 0xFFFFFFFF
        self.assertEqual(golden.geometric(image, depth, **mesh).work.invalid_edges, 3)

    def test_rejects_bad_textures(self):
        unit = golden.TextureUnit(cache_bytes=2048)
        unit.load(golden.mip_levels(checkerboard()), **FIELDS)
        s, t, covered = floor()
        quads = golden.quads_of(s, t, covered)
        good = unit.filter(quads)
        rejected = self.rejected
        for given in (None, numpy.zeros(4), quads.reshape(2, -1), [1], quads["s"]):
            rejected("quads: expected an array of QUAD of (n,)", unit.filter, given)
        rejected("unknown parameter 'cash_bytes'; known:", unit.set, cash_bytes=4096)
        rejected("'cache.bytes' = '7' is outside 256..65536", unit.set, cache_bytes=7)
        rejected("must be a power of two", unit.set, axes="two", cache_bytes=3000)
        self.assertEqual(unit.parameters["axes"], "four", "all of them or none")
        rejected("must be a power of two", golden.TextureUnit, cache_bytes=3000)
        rejected("unknown field of a texture 'colour'; known:", unit.set_fields, 0, layout="linear", colour=1)
        rejected("'format' = 'rgb' must be one of rgba8", unit.set_fields, format="rgb")
        rejected("texture 16 is outside 0..15", unit.set_fields, 16, format="rgba8")
        rejected("outside the memory of", unit.read, 1 << 30, 4)
        for call in ((unit.write, 1 << 30, numpy.zeros(4, numpy.uint8)), (unit.read, 1 << 30, 4)):
            rejected("load() and TextureUnit(memory=...) make it larger", *call)
        for values in ("1234", 7, [1, 2], None, memoryview(numpy.zeros(4, numpy.uint16))):
            rejected("bytes: expected a bytes-like object or uint8 of (n,), got ", unit.write, 0, values)
        rejected("bytes: expected uint8 of (n,)", unit.write, 0, numpy.zeros(4, numpy.int8))
        rejected("levels: ", unit.load, None)
        rejected("levels: ", unit.load, [])
        for texture in (0, 1):  # an existing texture is unchanged
            rejected("level 1: expected uint8 of (32, 32, 4)", unit.load, [checkerboard(), checkerboard()], texture)
        rejected("'format' = 'rgb'", unit.load, checkerboard(), wrap_s="clamp_to_edge", format="rgb")
        blocks = [numpy.zeros((2, 3, 8), dtype=numpy.uint8), numpy.zeros((1, 1, 8), dtype=numpy.uint8)]
        rejected("texture 2: ", unit.load, blocks[:1], 2, format="bc1")
        decoder = golden.TextureUnit(decode="after")
        rejected("level 1: expected uint8 of (1, 2, 8)", decoder.load, blocks, format="bc1")
        rejected("level 0: expected uint8 of (2, 3, 16)", decoder.load, blocks, format="bc3")
        rejected("expected sides that are powers of two", golden.mip_levels, vector_image("noise"))
        rejected("both even", golden.quads_of, numpy.zeros((3, 4)), numpy.zeros((3, 4)))
        rejected("covered", golden.quads_of, numpy.zeros((2, 4)), numpy.zeros((2, 4)), numpy.zeros((2, 4)))
        rejected("address -1 is outside 0..", unit.read, -1, 4)
        rejected("address -64 is outside 0..", unit.write, -64, b"1234")
        rejected("size -4 is outside 0..", unit.read, 0, -4)
        rejected("memory -1 is outside 0..", golden.TextureUnit, -1)
        rejected("address: expected an integer, got an object of type float", unit.read, 1.5, 4)
        for function in (unit.describe, unit.set_fields):
            rejected("texture -1 is outside 0..15", function, -1)
        rejected("texture -1 is outside 0..15", unit.load, checkerboard(), -1)
        unit.invalidate()
        unit.reset()
        self.assertTrue((unit.filter(quads) == good).all())

    def test_rejects_bad_ideal_calls(self):
        image = vector_image("noise")
        self.rejected("steps = 13 must be 12, 29 or 39", ideal.fxaa, image, steps=13)
        self.rejected("threshold = 2.000000 is outside 0..1", ideal.fxaa, image, threshold=2)
        self.rejected("fxaa: unknown parameter 'treshold'; known: pixels, threshold, least_threshold", ideal.fxaa,
                      image, treshold=1)
        self.rejected("TextureImage: unknown parameter 'wrap'; known: texels, wrap_s", ideal.TextureImage, image, wrap=1)
        self.rejected("disc: unknown parameter 'r'; known: x, y, radius, width, height", ideal.disc, 1, 1, r=1)
        self.rejected("'wrap_s' = 'mirror' must be one of repeat", ideal.TextureImage, image, wrap_s="mirror")
        self.rejected("footprints: expected an array of FOOTPRINT", ideal.box, ideal.TextureImage(image), numpy.zeros(3))
        self.rejected("edges: ", ideal.smaa_weights, image)
        self.rejected("luma: ", ideal.smaa_edges, image)
        self.rejected("pixels: ", ideal.psnr, numpy.zeros((3, 4)), numpy.zeros((2, 4), numpy.uint8))
        self.rejected("width and height must be 1..8192", ideal.disc, 1, 1, 1, 0, 5)


def thread_that_raises(function, results):
    def work():
        try:
            results.append(function())
        except Exception as error:  # the pattern that the test looks for
            results.append(error)
    return threading.Thread(target=work)


class Threads(unittest.TestCase):
    def test_interpreter_continues_while_a_model_runs(self):
        """While one thread smooths large frames, another one counts; if the GIL were held, it could not."""
        noise = numpy.random.default_rng(1).integers(0, 256, (1080, 1920, 4), dtype=numpy.uint8)
        inside, counted, results = threading.Event(), [], []

        def smooth():
            inside.set()
            return golden.morphological(noise, preset="deburr", detail=True).work.edge_pixels
        thread = thread_that_raises(smooth, results)
        thread.start()
        inside.wait()
        while thread.is_alive():
            counted.append(time.perf_counter())
            time.sleep(0.001)
        thread.join()
        self.assertGreater(results[0], 0)
        self.assertGreater(len(counted), 20)

    def test_threads_give_the_same_frames(self):
        images = [vector_image(name) for name in ("noise", "line", "blocks", "shades")]
        presets = ["mlaa", "smaa", "deburr-line", "deburr"]
        expected = [[golden.morphological(image, preset=preset).pixels.tobytes() for preset in presets] for image in images]
        results = []
        threads = [thread_that_raises(lambda: [[golden.morphological(image, preset=preset).pixels.tobytes()
                                                for preset in presets] for image in images], results) for _ in range(6)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(results, 6 * [expected])

    def test_two_threads_cannot_share_a_unit(self):
        """One of them gets an error; the other's results are complete."""
        unit = golden.TextureUnit()
        unit.load(golden.mip_levels(checkerboard()), **FIELDS)
        s, t, _ = floor()
        quads = numpy.tile(golden.quads_of(s, t), 40)
        expected = unit.filter(quads)
        results, told = [], 0
        thread = thread_that_raises(lambda: unit.filter(quads), results)
        thread.start()
        while thread.is_alive():
            for call in (lambda: unit.work, lambda: unit.set(preset="paper"), lambda: unit.filter(quads[:1]),
                         unit.reset, lambda: unit.write(0, numpy.zeros(64, numpy.uint8))):
                if not thread.is_alive() or results:
                    break
                try:
                    # Between this check and the call, the other thread may finish: then the calls change the unit.
                    if call() is not None and not results:
                        continue
                except RuntimeError as error:
                    self.assertIn("in use by another thread", str(error))
                    told += 1
            else:
                continue
            break
        thread.join()
        self.assertGreater(told, 0)
        self.assertTrue((results[0] == expected).all())

    def test_ctrl_c_ends_a_long_frame(self):
        """Within half a second (of the processor: others may use it), though the frame takes longer."""
        random = numpy.random.default_rng(1)
        noise = random.integers(0, 256, (4096, 4096, 4), dtype=numpy.uint8)
        vertices, edges = numpy.zeros(100000, golden.VERTEX), numpy.zeros(100000, golden.EDGE)
        for name, side in (("x", 1920), ("y", 1080)):
            vertices[name] = random.integers(0, 256 * side, vertices.size)
        vertices["usable"] = True
        edges["v0"], edges["v1"], edges["flags"] = *random.integers(0, vertices.size, (2, edges.size)), 1
        small, depth = noise[:1080, :1920], numpy.zeros((1080, 1920), numpy.float32)
        main = threading.main_thread().ident
        self.addCleanup(signal.signal, signal.SIGINT, signal.signal(signal.SIGINT, signal.default_int_handler))
        for name, call in (("morphological", lambda: golden.morphological(noise, preset="smaa", detail=True)),
                           ("geometric", lambda: golden.geometric(small, depth, vertices=vertices, edges=edges,
                                                                  facing=numpy.zeros(2, bool))),
                           ("fxaa", lambda: ideal.fxaa(noise)), ("cmaa2", lambda: ideal.cmaa2(noise)),
                           ("smaa_weights", lambda: ideal.smaa_weights(noise[:, :, 0] & 3))):
            with self.subTest(name):
                sent = []

                def interrupt():
                    time.sleep(0.4)
                    sent.append(time.process_time())
                    ctypes.CDLL(None).pthread_kill(ctypes.c_ulong(main), signal.SIGINT)
                thread = threading.Thread(target=interrupt)
                thread.start()
                with self.assertRaises(KeyboardInterrupt):
                    call()
                self.assertLess(time.process_time() - sent[0], 0.5)
                thread.join()

    def test_ctrl_c_ends_a_long_call(self):
        unit = golden.TextureUnit()
        unit.load(golden.mip_levels(checkerboard()), **FIELDS)
        s, t, _ = floor()
        once = golden.quads_of(s, t)
        quads = numpy.tile(once, 400)
        expected = unit.filter(once)
        main = threading.main_thread().ident
        # A background job starts with Ctrl-C ignored.
        self.addCleanup(signal.signal, signal.SIGINT, signal.signal(signal.SIGINT, signal.default_int_handler))

        def interrupt():
            time.sleep(0.2)
            ctypes.CDLL(None).pthread_kill(ctypes.c_ulong(main), signal.SIGINT)
        thread = threading.Thread(target=interrupt)
        thread.start()
        with self.assertRaises(KeyboardInterrupt):
            for _ in range(200):
                unit.filter(quads)
        thread.join()
        unit.reset()
        self.assertTrue((unit.filter(once) == expected).all())


class Declarations(unittest.TestCase):
    """Signatures and docstrings follow the parameters' declarations."""

    def test_every_parameter_is_in_its_signature(self):
        page = (DOCS / "reference/parameters.md").read_text(encoding="utf-8")
        for engine, function in (("texture", golden.texture), ("morphological", golden.morphological),
                                 ("geometric", golden.geometric), ("texture", golden.TextureUnit.set)):
            section = page.split("## `deburr run frame`")[0]
            cells = [re.split(r"(?<!\\) *\| *", line.strip("|").strip()) for line in section.splitlines()
                     if line.startswith(f"| `{engine}.")]
            rows = [(row[0].strip("`").removeprefix(engine + "."), row[2].strip("`"), row[5].replace("\\|", "|"))
                    for row in cells if len(row) == 6 and row[1] in ("rule", "build")]
            self.assertGreater(len(rows), 10)
            signature = inspect.signature(function)
            for name, default, meaning in rows:
                argument = signature.parameters[name.replace(".", "_")]
                self.assertEqual(str(argument.default).replace("True", "true").replace("False", "false"), default)
                self.assertIn(" ".join(meaning.split()), " ".join(function.__doc__.split()))
            self.assertEqual(len(function.__declared__), len({name for name, *_ in rows}))

    def test_everything_is_documented(self):
        for module in (deburr, golden, ideal):
            for name in module.__all__:
                if callable(getattr(module, name)):
                    self.assertTrue(getattr(module, name).__doc__, f"{module.__name__}.{name}")
        for kind in (golden.MorphologicalFrame, golden.GeometricFrame, golden.TextureUnit):
            for name in dir(kind):
                if not name.startswith("_") and name != "detail":
                    self.assertTrue(getattr(kind, name).__doc__, f"{kind.__name__}.{name}")

    def test_version_matches(self):
        changes = (DOCS.parent / "CHANGELOG.md").read_text(encoding="utf-8")
        self.assertIn(f"## {deburr.__version__}\n", changes)


if __name__ == "__main__":
    unittest.main()
