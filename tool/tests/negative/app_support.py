# SPDX-License-Identifier: MIT
"""Runs the command in a scratch directory, and makes unusual image files."""
import json
import os
import struct
import subprocess
import sys
import tempfile
import unittest
import zlib

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../../tb/engines"))
from engine_list import engines, trials  # noqa: E402,F401: for every test

DEBURR = os.environ.get("DEBURR", "deburr")


def png(width, height, bits=8, channels=3, declared=None):
    """A PNG whose header may declare another size than the data has."""
    colour_type = {1: 0, 2: 4, 3: 2, 4: 6}[channels]
    sample = b"\x80" if bits == 8 else b"\x80\x01"
    rows = b"".join(b"\0" + sample * channels * width for _ in range(height))

    def chunk(kind, data):
        return (struct.pack(">I", len(data)) + kind + data
                + struct.pack(">I", zlib.crc32(kind + data)))

    w, h = declared or (width, height)
    header = struct.pack(">IIBBBBB", w, h, bits, colour_type, 0, 0, 0)
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header)
            + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


def bc1_dds(width, height, levels=3, caps2=0):
    """A DDS of grey blocks."""
    head = (124, 0xA1007, height, width, 0, 0, levels, *([0] * 11), 32, 4)
    data = b"DDS " + struct.pack("<20I", *head) + b"DXT1" + struct.pack("<10I", *([0] * 5), 0x401008, caps2, 0, 0, 0)
    for level in range(levels):
        across, down = (max(1, side >> level) + 3 >> 2 for side in (width, height))
        data += struct.pack("<HHI", 0x8410, 0x4208, 0x12345678) * (across * down)
    return data


def float_tiff(width, height, value=0.5, channels=3):
    """A little-endian TIFF of 1 or 3 channels of 32-bit floats: one value everywhere, or these values."""
    values = value if isinstance(value, list) else [value] * (channels * width * height)
    data = struct.pack(f"<{len(values)}f", *values)
    colour = channels == 3  # then three numbers are stored in separate tables
    tables = 8 + len(data)
    ifd = tables + 12
    entries = [(256, 4, 1, width), (257, 4, 1, height), (258, 3, channels, tables if colour else 32),
               (259, 3, 1, 1), (262, 3, 1, 2 if colour else 1), (273, 4, 1, 8), (277, 3, 1, channels),
               (278, 4, 1, height), (279, 4, 1, len(data)), (339, 3, channels, tables + 6 if colour else 3)]
    body = struct.pack("<HHH", 32, 32, 32) + struct.pack("<HHH", 3, 3, 3)
    directory = struct.pack("<H", len(entries)) + b"".join(struct.pack("<HHII", *e) for e in entries)
    return b"II*\0" + struct.pack("<I", ifd) + data + body + directory + struct.pack("<I", 0)


def pages_tiff(width, height, pages):
    """A little-endian TIFF of several RGB pictures; each directory precedes its pixels."""
    pixels = bytes(range(1, 256)) * (3 * width * height // 255 + 1)
    pixels = pixels[:3 * width * height]
    out = b"II*\0" + struct.pack("<I", 8)
    for page in range(pages):
        size = 2 + 12 * 9 + 4 + 6
        data = len(out) + size
        entries = [(256, 4, 1, width), (257, 4, 1, height), (258, 3, 3, data - 6), (259, 3, 1, 1),
                   (262, 3, 1, 2), (273, 4, 1, data), (277, 3, 1, 3), (278, 4, 1, height),
                   (279, 4, 1, len(pixels))]
        following = data + len(pixels) if page + 1 < pages else 0
        out += struct.pack("<H", len(entries))
        for entry in entries:
            out += struct.pack("<HHII", *entry)
        out += struct.pack("<I", following) + struct.pack("<HHH", 8, 8, 8) + pixels
    return out


class CommandTest(unittest.TestCase):
    """Every test runs in its own temporary directory."""

    def setUp(self):
        self._scratch = tempfile.TemporaryDirectory(prefix="deburr_test_")
        self.directory = self._scratch.name
        self.addCleanup(self._scratch.cleanup)

    def path(self, name):
        return os.path.join(self.directory, name)

    def write(self, name, content):
        with open(self.path(name), "wb") as file:
            file.write(content if isinstance(content, bytes) else content.encode())
        return self.path(name)

    def result(self):
        with open(self.path("out/result.json")) as file:
            return json.load(file)

    def notes(self):
        return "\n".join(self.result().get("notes", []))

    def run_command(self, *arguments, program=DEBURR, **options):
        options.setdefault("cwd", self.directory)
        return subprocess.run([program, *arguments], text=True, capture_output=True, timeout=300,
                              **options)

    def expect(self, code, *arguments, says=(), **options):
        """Runs, and checks exit code, last line, REPRO line and parts of the output."""
        done = self.run_command(*arguments, **options)
        context = f"\n{arguments}\n{done.stdout}\n{done.stderr}"
        self.assertEqual(done.returncode, code, context)
        lines = done.stdout.strip().splitlines()
        self.assertTrue(lines and lines[-1].startswith("RESULT: "), "no RESULT line" + context)
        if code != 0:
            self.assertTrue(any(line.startswith("REPRO: ") for line in lines),
                            "no REPRO line" + context)
        for word in [says] if isinstance(says, str) else says:
            self.assertIn(word, done.stdout + done.stderr, context)
        return done

    def expect_as_shown(self, engine, *arguments):
        """Configurations that a run rejects, --show-config rejects with the same message."""
        command = ("run", engine, "--size", "32x32", "--out", self.path("out"), *arguments)
        told = [self.expect(2, *command, *more).stdout.splitlines()[-1] for more in ((), ("--show-config",))]
        self.assertEqual(told[0], told[1])

    def faults(self, engine, kind):
        done = self.expect(2, "run", engine, "--fault", "gremlin")
        line = next(line for line in done.stderr.splitlines() if "unknown fault 'gremlin'" in line)
        return [word.strip(",") for word in line.split() if f"{kind}-" in word]

    def misdecode(self, engine, runs):
        """Outputs or traffic reveal each wrongly decoded field, in the run that `runs` gives for it."""
        self.assertEqual([fault.split("misdecode-")[1] for fault in self.faults(engine, "misdecode")], list(runs))
        out = ("--out", self.path("out"))
        for run in {tuple(run) for run in runs.values()}:
            self.expect(0, "run", engine, *out, *run)  # without the fault the run passes
        for field, run in runs.items():
            with self.subTest(field):
                self.expect(1, "run", engine, *out, *run, "--fault", f"misdecode-{field}", says="FAIL mismatch: ")
                checks = self.result()["checks"]
                self.assertGreater(checks["mismatches"] + checks["traffic_mismatches"], 0)

    def decode_as_built(self, engine):
        """Faults in configuration fields have no effect if the configuration is a reset value."""
        self.expect(2, "run", engine, "--out", self.path("out"), "--set", "run.program=reset", "--fault",
                    "misdecode-config-linear-light", says="needs run.program = registers")

    def miscount(self, engine, expected):
        faults = self.faults(engine, "miscount")
        self.assertEqual([fault.split("miscount-")[1] for fault in faults], expected)
        for fault in faults:
            name = fault.split("miscount-")[1].upper().replace("-", "_")
            self.expect(1, "run", engine, "--size", "24x24", "--out", self.path("out"), "--fault", fault,
                        says=["status registers: 1 mismatches in", f"{name}: "])
            self.assertEqual(self.result()["checks"]["mismatches"], 1)

    def wrong_figures(self, engine, count, named, *arguments):
        """All of them are compared, and each differs; the given ones are among the first."""
        run = ("run", engine, "--size", "24x24", "--out", self.path("out"), *arguments)
        self.expect(0, *run)
        self.assertEqual(self.result()["scoreboards"]["figures"], {"comparisons": count, "mismatches": 0})
        self.expect(1, *run, "--fault", "wrong-figures", says=[f"figures: {count} mismatches in {count} comparisons"])
        self.assertEqual(self.result()["checks"]["mismatches"], count)
        for name in named:
            self.assertIn(f"{name} = ", str(self.result()["first_mismatches"]))

    def blind(self, engine, board, *arguments):
        name = board.split(".")[-1].removeprefix("blind-").replace("-", " ")
        done = self.expect(1, "run", engine, "--size", "32x32", "--out", self.path("out"), "--fault", board,
                           *arguments, says=f"{name}: 0 mismatches in 0 comparisons, only 0 comparisons, at least")
        self.assertIn("FAIL mismatch: ", done.stdout)
        result = self.result()
        self.assertEqual((result["verdict"], result["checks"]["mismatches"],
                          result["checks"]["traffic_mismatches"]), ("fail", 0, 0))
        return int(done.stderr.split("at least ")[1].split()[0])

    def known(self, engine, *arguments):
        """All scoreboards that a run of the engine has."""
        done = self.expect(2, "run", engine, "--fault", "gremlin", *arguments)
        line = next(line for line in done.stderr.splitlines() if "unknown fault 'gremlin'" in line)
        return {word.strip(",") for word in line.split() if "blind-" in word}

    def run_texture(self, code, *arguments, says=(), **options):
        """A tiny run of the texture unit into ./out."""
        return self.expect(code, "run", "texture", "--size", "32x32", "--out", self.path("out"),
                           *arguments, says=says, **options)
