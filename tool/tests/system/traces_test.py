#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Traces as input of other tools: a cache implemented here has the same misses for the lookups in a trace, and a run
of recorded fragments equals the run that recorded them.

usage: traces_test.py DEBURR PAGE [CLASS]        PAGE: docs/reference/traces.md"""
import collections
import fractions
import json
import math
import os
import re
import struct
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../../tb/engines"))
from engine_list import trials  # noqa: E402

EVENTS = ["read", "write", "hit", "merged", "miss"]
Record = collections.namedtuple("Record", "clock event address bytes port")


def read_text(file):
    """Header lines as lists of fields, and records."""
    header, records = [], []
    for line in file.read().decode().splitlines():
        fields = line.split()
        if fields[0] == "#":
            header.append(fields[1:])
        else:
            clock, event, address, size, port = fields
            records.append(Record(int(clock), event, int(address, 16), int(size), int(port)))
    return header, records


def read_binary(file):
    data = file.read()
    magic, version, begin, size, ports, count, mhz, engine = struct.unpack_from("<8sIIIIQd24s", data)
    header = [["deburr-lines", str(version)], ["engine", engine.rstrip(b"\0").decode()],
              ["clock_mhz", f"{mhz:g}"]]
    for port in range(ports):
        line, kind, name = struct.unpack_from("<II56s", data, 64 + 64 * port)
        header.append(["port", str(port), ["memory", "lookups"][kind], str(line),
                       name.rstrip(b"\0").decode()])
    assert magic == b"DEBURRLT" and size == 24 and begin == 64 + 64 * ports
    assert len(data) == begin + count * size
    records = [Record(clock, EVENTS[event], address, length, port)
               for clock, address, length, event, port, zero in struct.iter_unpack("<QQIBBH", data[begin:])
               if zero == 0]
    header += [["clock", "event", "address", "bytes", "port"], ["end", str(len(records))]]
    return header, records


class Cache:
    """Set-associative, written only from docs/reference/texture/formats.md."""

    def __init__(self, size, line, ways, replacement):
        self.line, self.ways, self.replacement = line, ways, replacement
        self.sets = [[None] * ways for _ in range(size // line // ways)]
        self.order = [[] for _ in self.sets]  # the next one to be replaced
        self.random = 0xACE1

    def victim(self, ways, order):
        for way in range(self.ways):
            if ways[way] is None:
                return way
        if self.replacement == "random":
            r = self.random
            bit = (r ^ r >> 2 ^ r >> 3 ^ r >> 5) & 1  # taps 16, 14, 13, 11
            self.random = r >> 1 | bit << 15
            return self.random % self.ways
        return order[0]

    def look_up(self, address):
        number = address // self.line
        ways, order = (part[number % len(self.sets)] for part in (self.sets, self.order))
        if number in ways:
            way, hit = ways.index(number), True
            if self.replacement != "lru":
                return True
        else:
            way, hit = self.victim(ways, order), False
            ways[way] = number
        if way in order:
            order.remove(way)
        order.append(way)
        return hit


class TracesTest(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory(prefix="deburr_traces_")
        self.addCleanup(scratch.cleanup)
        self.directory = scratch.name

    def path(self, name):
        return os.path.join(self.directory, name)

    def run_engine(self, engine, name, *arguments):
        done = subprocess.run([DEBURR, "run", engine, "--out", name, *arguments], cwd=self.directory,
                              text=True, capture_output=True, timeout=600)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        with open(self.path(f"{name}/result.json")) as file:
            return json.load(file)

    def lines(self, name, read=read_text):
        with open(self.path(f"{name}/lines.trace"), "rb") as file:
            return read(file)


class Lines(TracesTest):
    def check_sums(self, result, records):
        for event, key in (("read", "bytes_read"), ("write", "bytes_written")):
            self.assertEqual(sum(r.bytes for r in records if r.event == event), result["memory"][key])
        self.assertEqual(records, sorted(records, key=lambda r: (r.clock, r.port)))

    def test_lines_of_every_engine_in_both_formats(self):
        for engine, trial in trials("lines").items():
            arguments = trial["run"]
            without = [a for a in arguments if "lookups" not in a and a != "--set"]
            plain = self.run_engine(engine, "plain", "--no-images", *without)
            result = self.run_engine(engine, "text", "--no-images", "--line-trace", "text", *arguments)
            self.run_engine(engine, "binary", "--no-images", "--line-trace", "binary", *arguments)
            header, records = self.lines("text")
            self.assertEqual(self.lines("binary", read_binary), (header, records), engine)
            self.assertEqual(header[:2], [["deburr-lines", "1"], ["engine", engine]])
            self.assertEqual(sum(line[0] == "port" for line in header), trial["ports"])
            self.assertEqual(header[-1], ["end", str(len(records))])
            self.assertGreater(len(records), 100)
            self.check_sums(result, records)
            for one in (plain, result):
                del one["host"]
            self.assertEqual(plain, result)

    def test_evaluation_order_changes_nothing(self):
        arguments = ["--no-images", "--line-trace", "text", *trials("lines")["frame"]["run"]]
        self.run_engine("frame", "plain", *arguments)
        self.run_engine("frame", "shuffled", *arguments, "--shuffle")
        self.assertEqual(self.lines("plain"), self.lines("shuffled"))

    def test_independent_cache_has_the_same_misses(self):
        for size, line, ways, replacement in ((1024, 64, 2, "lru"), (2048, 32, 4, "lru"),
                                              (2048, 128, 8, "lru"), (1024, 64, 1, "lru"),
                                              (1024, 64, 4, "fifo"), (2048, 64, 8, "random")):
            what = f"{size} {line} {ways} {replacement}"
            result = self.run_engine(
                "texture", "cache", "--scene", "tunnel", "--size", "64x64", "--no-images",
                "--line-trace", "binary", "--set", "run.line_trace_lookups=true",
                "--set", f"texture.cache.bytes={size}", "--set", f"texture.cache.line_bytes={line}",
                "--set", f"texture.cache.ways={ways}",
                "--set", f"texture.cache.replacement={replacement}")
            _, records = self.lines("cache", read_binary)
            cache = Cache(size, line, ways, replacement)
            misses = []
            for r in records:
                if r.event in ("hit", "merged", "miss"):
                    self.assertEqual(r.bytes, line)
                    hit = cache.look_up(r.address)
                    self.assertEqual(hit, r.event != "miss", f"{what}: {r}")
                    if not hit:
                        misses.append(r.address)
            self.assertGreater(len(misses), 500, what)
            for event, key in (("hit", "hits"), ("merged", "merged"), ("miss", "misses")):
                mine = sum(r.event == event for r in records)
                self.assertEqual(mine, result["work"][f"tag_stage_{key}"], what)
            # Memory requests have the same order, each as a burst of its own lines.
            asked = [r.address for r in records if r.event == "read"]
            grain = min(line, 64)
            self.assertEqual(asked, [a + i for a in misses for i in range(0, line, grain)], what)


class Forms(TracesTest):
    """The commands of docs/reference/traces.md produce the formats that DRAM simulators read."""

    # The line grammars of their parsers: DRAMsim3 common.cc, operator>>; DRAMSys StlPlayer.cpp, parseTraceFile;
    # Ramulator 2 loadstore_trace.cpp, init_trace; Ramulator 1 Processor.cpp, get_dramtrace_request. Where a parser
    # takes any word for a read, this grammar accepts only the right one.
    GRAMMARS = {
        "dramsim3.trace": r"(?P<address>(0x)?[0-9a-f]+)\s+(?P<command>READ|WRITE)\s+(?P<clock>\d+)",
        "dramsys.stl": r"(?P<clock>\d+):\s+(\(\d+\)\s+)?(?P<command>read|write)\s+(?P<address>(0x)?[0-9a-f]+)",
        "ramulator2.trace": r"(?P<command>LD|ST) (?P<address>0x[0-9a-f]+)",
        "ramulator1.trace": r"(?P<address>(0x)?[0-9a-f]+) +(?P<command>[RW])",
    }
    COMMANDS = {"READ": "read", "WRITE": "write", "read": "read", "write": "write",
                "LD": "read", "ST": "write", "R": "read", "W": "write"}

    def commands_of_the_page(self):
        """The commands of the block by the file that each writes, and its cycle times in ns."""
        with open(PAGE) as file:
            block = next(b for b in re.findall(r"^```\n(.*?)^```", file.read(), re.M | re.S)
                         if "ramulator" in b)
        commands = {c.rsplit("> ", 1)[1].strip(): c for c in re.split(r"^(?=awk)", block, flags=re.M) if c}
        tck = {name: float(found[1]) for name, c in commands.items()
               if (found := re.search(r"-v tck=([\d.]+)", c))}
        return commands, tck

    def check_forms(self, name, mhz):
        commands, tck = self.commands_of_the_page()
        self.assertEqual(set(commands), set(self.GRAMMARS))
        self.assertEqual(set(tck), {"dramsim3.trace", "dramsys.stl"})
        header, records = self.lines(name)
        self.assertIn(["clock_mhz", mhz], header)
        records = [r for r in records if r.event in ("read", "write")]
        self.assertGreater(len(records), 100)
        for file, command in commands.items():
            done = subprocess.run(["bash", "-ec", command], cwd=self.path(name), text=True,
                                  capture_output=True)
            self.assertEqual((done.returncode, done.stderr), (0, ""), command)
            with open(self.path(f"{name}/{file}")) as converted:
                lines = converted.read().splitlines()
            self.assertEqual(len(lines), len(records), file)
            for line, record in zip(lines, records):
                found = re.fullmatch(self.GRAMMARS[file], line)
                self.assertTrue(found, f"{file}: {line}")
                self.assertEqual(int(found["address"], 16), record.address, file)
                self.assertEqual(self.COMMANDS[found["command"]], record.event, file)
                if file in tck:
                    exact = (fractions.Fraction(record.clock * 1000) /
                             (fractions.Fraction(str(tck[file])) * fractions.Fraction(mhz)))
                    # awk's floating point may round to the other side of an integer.
                    self.assertIn(int(found["clock"]),
                                  {math.floor(exact - fractions.Fraction(1, 10**6)),
                                   math.floor(exact + fractions.Fraction(1, 10**6))}, line)

    def test_converts_reads(self):
        self.run_engine("texture", "lines", "--size", "48x48", "--no-images", "--line-trace", "text",
                        "--set", "run.line_trace_lookups=true")
        self.check_forms("lines", "166.67")

    def test_converts_reads_and_writes_at_another_clock(self):
        cycles = set()
        for engine, trial in trials("lines").items():
            result = self.run_engine(engine, "lines", *trial["run"], "--no-images", "--line-trace", "text")
            clock = dict(line for line in self.lines("lines")[0] if len(line) == 2)["clock_mhz"]
            if result["memory"]["bytes_written"] > 0 and clock != "166.67":
                cycles.add(clock)
                self.check_forms("lines", clock)
        self.assertIn("250", cycles)

    def test_converts_the_example_of_the_page(self):
        with open(PAGE) as file:
            text = file.read()
        trace = re.search(r"^# deburr-lines 1\n.*?^# end \d+\n", text, re.M | re.S)[0]
        rows = re.findall(r"^\| (DRAM\S+|Ramulator \d).*?\| `([^`]*)`", text, re.M)
        os.mkdir(self.path("page"))
        with open(self.path("page/lines.trace"), "w") as file:
            file.write(trace)
        for command in self.commands_of_the_page()[0].values():
            subprocess.run(["bash", "-ec", command], cwd=self.path("page"), check=True)
        shown = {}
        for file in self.GRAMMARS:
            with open(self.path(f"page/{file}")) as converted:
                shown[file] = converted.read().strip()
        self.assertEqual([line for _, line in rows], list(shown.values()))

    def test_grammars_reject_earlier_page_version(self):
        self.assertFalse(re.fullmatch(self.GRAMMARS["ramulator2.trace"], "R 0x0003f340"))
        self.assertFalse(re.fullmatch(self.GRAMMARS["ramulator1.trace"], "R 0x0003f340"))
        self.assertFalse(re.fullmatch(self.GRAMMARS["dramsys.stl"], "0x0003f340 READ 28"))


class Fragments(TracesTest):
    def outcome(self, name):
        with open(self.path(f"{name}/result.json")) as file:
            result = json.load(file)
        del result["host"]
        pictures = []
        maps = [f"map_{name}.pfm" for name in sorted(result["maps"])]
        self.assertEqual(len(maps), 4)
        for picture in ("after.png", "golden.png", *maps):
            with open(self.path(f"{name}/{picture}"), "rb") as file:
                pictures.append(file.read())
        return result, pictures, self.lines(name)

    def check_round_trip(self, *arguments, drawn=()):
        common = ["--line-trace", "text", "--set", "run.line_trace_lookups=true", "--maps", *arguments]
        self.run_engine("texture", "first", "--fragment-trace", "text", *common, *drawn)
        wanted = self.outcome("first")
        self.assertEqual(wanted[0]["verdict"], "pass")
        with open(self.path("first/fragments.trace"), "rb") as file:
            text = file.read()
        # Text, a run of it that writes binary, and a run of that which writes text again.
        self.run_engine("texture", "second", "--fragments", "first/fragments.trace",
                        "--fragment-trace", "binary", *common)
        self.assertEqual(self.outcome("second"), wanted)
        self.run_engine("texture", "third", "--fragments", "second/fragments.trace",
                        "--fragment-trace", "text", *common)
        self.assertEqual(self.outcome("third"), wanted)
        with open(self.path("third/fragments.trace"), "rb") as file:
            self.assertEqual(file.read(), text)

    def test_run_of_recorded_fragments_is_identical(self):
        self.check_round_trip("--scene", "tunnel", drawn=["--size", "80x60"])

    def test_hidden_fragments_and_odd_sizes(self):
        self.check_round_trip("--scene", "object", "--format", "srgb8_a8",
                              drawn=["--size", "61x47", "--set", "scene.visibility=overdraw"])

    def test_fragments_with_stalls(self):
        self.check_round_trip("--stalls", "0.2", drawn=["--size", "40x40"])

    def test_single_fragments_equal_their_quads(self):
        """A plane, as quads and as fragments with derivatives."""
        width, height = 32, 24
        step = 1 / 64  # exact in S7.24

        def s(x):
            return 0.125 + step * x

        def t(x, y):
            return -0.5 + 2 * step * y + step / 4 * x

        quads, fragments = [], []
        for y in range(0, height, 2):
            for x in range(0, width, 2):
                lanes = [(x, y), (x + 1, y), (x, y + 1), (x + 1, y + 1)]
                quads.append(f"quad 0 f f 0 {x} {y} " +
                             " ".join(f"{s(i)} {t(i, j)}" for i, j in lanes))
                fragments += [f"fragment 0 {i} {j} {s(i)} {t(i, j)} {step} {step / 4} 0 {2 * step}"
                              for i, j in lanes]
        pictures = []
        for name, records in (("quads", quads), ("fragments", fragments)):
            with open(self.path(name), "w") as file:
                file.write("\n".join(["deburr-fragments 1", f"size {width} {height}", *records,
                                      f"end {len(records)}"]) + "\n")
            result = self.run_engine("texture", f"out_{name}", "--fragments", name)
            self.assertEqual(result["work"]["fragments"], width * height)
            with open(self.path(f"out_{name}/after.png"), "rb") as file:
                pictures.append(file.read())
        self.assertEqual(*pictures)

    def test_fragments_without_positions_give_only_figures(self):
        with open(self.path("bare"), "w") as file:
            file.write("deburr-fragments 1\nfragment 0 - - .5 .5 .01 0 0 .01 # a comment\r\n\n"
                       "quad 0 5 f 0 - - 0 0 .01 0 0 .01 .01 .01\nend 2\n")
        result = self.run_engine("texture", "out", "--fragments", "bare")
        self.assertEqual(result["work"]["fragments"], 3)
        self.assertEqual(sorted(os.listdir(self.path("out"))),
                         ["manifest.json", "report.html", "result.json"])

    def test_maps_show_fragments_with_positions(self):
        """Other fragments are in the counters of the unit, but in no pixel."""
        with open(self.path("mixed"), "w") as file:
            file.write("deburr-fragments 1\nsize 8 6\nquad 0 f f 0 2 4 0 0 .01 0 0 .01 .01 .01\n"
                       "quad 0 f f 0 - - .5 .5 .51 .5 .5 .51 .51 .51\nend 2\n")
        result = self.run_engine("texture", "out", "--fragments", "mixed", "--maps")
        self.assertEqual({figures["pixels"] for figures in result["maps"].values()}, {4})
        self.assertEqual(result["maps"]["samples"]["sum"], 4)
        self.assertEqual(result["work"]["sample_walker_samples"], 8)
        with open(self.path("bare"), "w") as file:
            file.write("deburr-fragments 1\nfragment 0 - - .5 .5 .01 0 0 .01\nend 1\n")
        done = subprocess.run([DEBURR, "run", "texture", "--fragments", self.path("bare"), "--maps", "--out",
                               self.path("rejected")], text=True, capture_output=True, check=False)
        self.assertEqual(done.returncode, 2)
        self.assertIn("have no position in a picture", done.stderr)

    def test_memory_does_not_grow_with_the_trace(self):
        """Peak memory of a binary trace and of one ten times as long, without a golden model."""
        peaks = []
        for count in (20_000, 200_000):
            with open(self.path("long"), "wb") as file:
                file.write(b"DEBURRFT" + struct.pack("<IIIIIIQ24x", 1, 64, 80, 0, 0, 0, count))
                record = struct.pack("<IIBBBB4x8d", 2**32 - 1, 2**32 - 1, 0, 0, 1, 15,
                                     0, 0, .001, 0, 0, .001, .001, .001)
                for _ in range(count):
                    file.write(record)
            code = ("import resource, subprocess, sys; "
                    "code = subprocess.run(sys.argv[1:], stdout=subprocess.DEVNULL).returncode; "
                    "print(code, resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss)")
            done = subprocess.run([sys.executable, "-c", code, DEBURR, "run", "texture", "--quiet",
                                   "--fragments", "long", "--mode", "nearest", "--fragment-trace",
                                   "text", "--line-trace", "text", "--out", "out"],
                                  cwd=self.directory, text=True, capture_output=True, timeout=600)
            code, peak = done.stdout.split()
            self.assertEqual(code, "0", done.stderr)
            peaks.append(int(peak))
        self.assertLess(peaks[1], peaks[0] + 3000, "kilobytes")


if __name__ == "__main__":
    if len(sys.argv) < 3 or sys.argv[1] in ("-h", "--help"):
        print(__doc__)
        sys.exit(0 if sys.argv[1:2] in (["-h"], ["--help"]) else 2)
    DEBURR, PAGE = (os.path.abspath(sys.argv.pop(1)) for _ in range(2))
    unittest.main()
