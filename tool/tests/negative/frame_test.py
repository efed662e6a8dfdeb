#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Checks of `deburr run frame`, which are those of its engines: each can fail the run by itself. See --help of
unittest."""
import unittest

from app_faults_test import Blind as BlindAlone
from app_faults_test import Registers as RegistersAlone
from app_support import CommandTest
from geometric_test import Blind as BlindGeometric

TEXTURE, MORPHOLOGICAL, GEOMETRIC = BlindAlone.TEXTURE, BlindAlone.MORPHOLOGICAL, BlindGeometric.BOARDS


class Registers(CommandTest):
    def test_each_register_is_checked(self):
        self.miscount("frame", RegistersAlone.TEXTURE + RegistersAlone.MORPHOLOGICAL)


class Blind(CommandTest):
    def test_each_scoreboard_must_compare(self):
        memory = ("--storage", "memory")
        boards = ({f"texture.blind-{board}" for board in TEXTURE} |
                  {f"morphological.blind-{board}" for board in MORPHOLOGICAL})
        self.assertEqual(self.known("frame", *memory), boards)
        for board in boards:
            self.assertGreater(self.blind("frame", board, *memory), 0)
        smoothing = ("--smoothing", "geometric-morphological")
        boards |= {f"geometric.blind-{board}" for board in GEOMETRIC}
        self.assertEqual(self.known("frame", *memory, *smoothing), boards)
        for board in sorted(boards):
            if board.startswith("geometric."):
                self.assertGreater(self.blind("frame", board, *smoothing), 0)


if __name__ == "__main__":
    unittest.main()
