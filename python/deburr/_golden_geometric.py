# SPDX-License-Identifier: MIT
"""The geometric engine's part of deburr.golden."""
from __future__ import annotations

import typing

from deburr import _golden
from deburr._declared import declare
from deburr._given import Array, rgba
from deburr._golden import EDGE, EDGE_CLASSES, VERTEX, GeometricFrame

__all__ = ["EDGE", "EDGE_CLASSES", "VERTEX", "GeometricFrame", "geometric"]


def geometric(pixels: Array, depth: Array | None = None, *, vertices: Array, edges: Array, facing: Array,
              bases: dict[str, int] | None = None, detail: bool = False, error_lines: Array | None = None,
              **parameters: typing.Any) -> GeometricFrame:
    """Smooths a frame with the geometric engine's golden model; returns a GeometricFrame.

    vertices, edges and facing describe the mesh: arrays of VERTEX (x and y in 1/256 pixel, depth U24, usable) and EDGE
    (vertices v0, v1, faces f0, f1, flags: 1 boundary, 2 angle, 4 split normals, 8 seam), and one bool per face, true if
    it faces the eye. bases are base addresses of memory regions by name (edges, vertices, facing, depth, colour,
    weights, copy, pairs, coarse), for the traffic. detail=True adds classes, lines, candidates, blocks, traffic and
    coverage, and is slower. error_lines are addresses of lines that memory answers with an error."""
    return _golden.geometric(rgba(pixels), depth, vertices, edges, facing, bases, bool(detail), error_lines,
                             parameters)


declare(geometric, _golden.geometric_parameters())
