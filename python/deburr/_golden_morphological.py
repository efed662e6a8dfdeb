# SPDX-License-Identifier: MIT
"""The morphological engine's part of deburr.golden."""
from deburr import _golden
from deburr._declared import declare
from deburr._given import rgba
from deburr._golden import MorphologicalFrame

__all__ = ["MorphologicalFrame", "morphological"]

# What a type checker is told, beside arrays (tb/system/python_stubs_test.py).
TYPES = {"morphological": "MorphologicalFrame", ".depth": "_Array | None", ".edges": "_Array | None", ".detail": "bool",
         ".error_lines": "_Array | None",
         "MorphologicalFrame.work": "Figures",
         "MorphologicalFrame.memory_errors": "int",
         "MorphologicalFrame.detail": "bool",
         "MorphologicalFrame.coverage": "dict[str, int]"}


def morphological(pixels, depth=None, *, edges=None, detail=False, error_lines=None, **parameters):
    """Smooths a frame with the morphological engine's golden model: a MorphologicalFrame.

    pixels is the frame, depth its depths (for edges of depth, and the rule `leave`), edges those that someone else
    found (uint8, bit 0 left, bit 1 above). detail=True keeps taps, decisions, runs and coverage as well, and is slower.
    error_lines are addresses of lines that memory cannot read, with storage = memory."""
    return _golden.morphological(rgba(pixels), depth, edges, bool(detail), error_lines, parameters)


declare(morphological, _golden.morphological_parameters())
