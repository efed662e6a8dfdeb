#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Memories that runs report for the hardware: every default and preset of every engine uses implementable memories,
totals are sums, and the texture unit's page names the memories.

usage: memories_test.py DEBURR DOCS"""
import itertools
import json
import os
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../../tb/engines"))
from engine_list import engines, trials  # noqa: E402

DEBURR = DOCS = ""


def runs():
    for engine, options in trials("not_implementable").items():
        for values in itertools.product(*options.values()):
            yield (engine, *itertools.chain(*zip(options, values)))


class Memories(unittest.TestCase):
    def result(self, *arguments):
        with tempfile.TemporaryDirectory() as out:
            done = subprocess.run([DEBURR, "run", *arguments, "--size", "24x16", "--check", "none", "--out", out],
                                  text=True, capture_output=True, check=False)
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
            with open(os.path.join(out, "result.json")) as file:
                return done.stdout + done.stderr, json.load(file)

    def test_defaults_and_presets_are_implementable(self):
        for arguments in runs():
            with self.subTest(arguments):
                said, result = self.result(*arguments)
                self.assertNotIn("not_implementable", result)
                self.assertNotIn("NOT IMPLEMENTABLE", said)
                self.assertNotIn("cannot be built", said)

    def test_totals_are_sums(self):
        with_memories = with_registers = with_links = 0
        for arguments in ((engine,) for engine in engines()):
            _, result = self.result(*arguments)
            memories = result["memories"].values()
            with_memories += 1 if memories else 0
            for m in memories:
                self.assertEqual(m["logical_bits"], m["words"] * m["word_bits"])
                self.assertGreaterEqual(m["physical_bits"], m["logical_bits"])
                self.assertIn(m["kind"], ("flops", "sram", "rom"))
            sums = result["memory_bits"]
            beside = [m["register_bits"] for m in memories if "register_bits" in m]
            registers = sums.get("registers", {"memories": 0, "physical": 0})
            self.assertEqual((registers["memories"], registers["physical"]), (len(beside), sum(beside)))
            if "links" in sums:
                self.assertGreater(sums["links"]["physical"], sums["links"]["memories"])
            with_registers += "registers" in sums
            with_links += "links" in sums
            for kind in sums.keys() - {"registers", "links"}:
                bits = sums[kind]
                of_kind = [m for m in memories if kind in ("total", m["kind"])]
                self.assertEqual(bits["memories"], len(of_kind))
                self.assertEqual(bits["logical"], sum(m["logical_bits"] for m in of_kind))
                self.assertEqual(bits["physical"], sum(m["physical_bits"] for m in of_kind))
        self.assertGreater(min(with_memories, with_registers, with_links), 0)

    def test_accesses_are_counted(self):
        """Words read and written by each engine: of memories with ports, of FIFOs and of the port's buffer."""
        for engine in engines():
            _, result = self.result(engine)
            memories = result["memories"].values()
            rams = [m for m in memories if m["kind"] == "sram"]
            used = [m for m in rams if m["reads"] > 0 and m["writes"] > 0]
            self.assertGreater(len(used), 0.4 * len(rams), engine)
            for m in memories:
                if "reads" in m and m.get("high_water", 0) > 0:
                    self.assertGreaterEqual(m["writes"], m["high_water"])
                    self.assertEqual(m["reads"], m["writes"], "a FIFO is empty at the end")
        _, result = self.result("texture")
        memories, fills = result["memories"], result["memory"]["lines_filled"]
        self.assertGreater(fills, 0)
        for name in ("memory_port_response_buffer", "miss_queue_fill_buffer"):
            self.assertEqual((memories[name]["reads"], memories[name]["writes"]), (fills, fills), name)
        self.assertEqual(memories["latency_fifo_entries"]["reads"], result["work"]["texel_addresser_bilinears"])

    def test_composition_names_units_of_cost_by_their_part(self):
        """`params --cost` tells the same without a run."""
        for engine in engines():
            _, result = self.result(engine)
            cost = {name: value for name, value in result["cost"].items() if "frames_per_s" not in name}
            said = subprocess.run([DEBURR, "params", engine, "--cost", "--json"], check=True, capture_output=True,
                                  text=True).stdout
            self.assertEqual(json.loads(said)["cost"], cost, engine)
            for name in cost["units"]:
                if engine == "frame" and name != "links":
                    self.assertRegex(name, "^(texture|geometric|morphological)_")
                    self.assertNotRegex(name, "_(texture|geometric|morphological)$")

    def test_texture_page_names_its_memories(self):
        with open(os.path.join(DOCS, "reference/texture/hardware.md"), encoding="utf-8") as file:
            table = file.read().split("\n## Memories\n")[1].split("\n## ")[0]
        page = {}
        for line in table.splitlines():
            cells = [cell.strip() for cell in line.strip("|").split("|")]
            if not line.startswith("| `"):
                continue
            name = cells[0].split("`")[1].removeprefix("texture_cache.").removeprefix("address_unit.").replace(".", "_")
            page[name] = (cells[2], cells[3].split(",")[0], cells[5], int(cells[6].replace(" ", "")))

        def found(*rules):
            _, result = self.result("texture", *rules)
            return {name: (f"{m['words']} x {m['word_bits']}", m["ports"], m["built_as"], m["physical_bits"])
                    for name, m in result["memories"].items() if name != "memory_port_response_buffer"}

        every_rule = found("--set", "texture.srgb_output=encoded", "--set", "texture.log2=exact")
        self.assertEqual(page, every_rule)
        self.assertEqual(set(page) - set(found()), {"filter_pipeline_codes", "log2_unit_table"})


if __name__ == "__main__":
    if len(sys.argv) < 3 or sys.argv[1] in ("-h", "--help"):
        sys.exit(__doc__)
    DEBURR, DOCS = sys.argv.pop(1), sys.argv.pop(1)
    unittest.main()
