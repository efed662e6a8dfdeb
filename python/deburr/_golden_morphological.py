# SPDX-License-Identifier: MIT
"""The morphological engine's part of deburr.golden."""
from __future__ import annotations

import typing

from deburr import _golden
from deburr._declared import declare
from deburr._given import Array, rgba
from deburr._golden import MorphologicalFrame

__all__ = ["MorphologicalFrame", "morphological"]


def morphological(pixels: Array, depth: Array | None = None, *, edges: Array | None = None, detail: bool = False,
                  error_lines: Array | None = None, **parameters: typing.Any) -> MorphologicalFrame:
    """Smooths a frame with the morphological engine's golden model; returns a MorphologicalFrame.

    pixels is the frame, depth its depths (for depth edges, and `bypass`), edges are externally detected edges (uint8,
    bit 0 left, bit 1 above). detail=True adds probes, decisions, runs and coverage, and is slower. error_lines are
    addresses of lines that memory cannot read, with storage = memory."""
    return _golden.morphological(rgba(pixels), depth, edges, bool(detail), error_lines, parameters)


declare(morphological, _golden.morphological_parameters())
