# SPDX-License-Identifier: MIT
"""The texture unit's part of deburr.golden."""
from __future__ import annotations

import typing

import numpy

from deburr import _golden
from deburr._declared import declare
from deburr._figures import Figures
from deburr._given import Array, byte_array, described, rgba, whole
from deburr._golden import COLOUR, QUAD

__all__ = ["COLOUR", "QUAD", "TextureUnit", "image_of", "mip_levels", "quads_of", "texture"]

_ONE = 1 << 24  # S7.24
_TEXTURES = 16


class TextureUnit:
    """A texture unit's golden model: a memory, up to 16 textures, a cache with predicted hits, and counters.

    memory is its size in bytes; load() enlarges it if needed. Only one thread may use a unit at a time: a concurrent
    call raises RuntimeError and changes nothing. A pickled unit has the same parameters, memory and textures, and an
    empty cache; it shows the original's work and fills until its first filter(), set() or reset(), and counts from 0
    then."""

    def __init__(self, memory: int = 0, **parameters: typing.Any) -> None:
        self._unit = _golden.TextureUnit(whole("memory", memory), parameters)
        self._end = 0
        self._error_lines: Array | None = None
        self._before: tuple[Array, Figures] | None = None  # fills and work of the unit that was pickled

    def __getstate__(self) -> dict[str, typing.Any]:
        return {"parameters": self.parameters, "memory": self.read(0, self._unit.size()), "end": self._end,
                "words": [self._unit.words(texture) for texture in range(_TEXTURES)],
                "error_lines": self._error_lines, "before": (self.fills, self.work)}

    def __setstate__(self, state: dict[str, typing.Any]) -> None:
        self._unit = _golden.TextureUnit(state["memory"].size, state["parameters"])
        self._unit.write(0, state["memory"])
        for texture, words in enumerate(state["words"]):
            self._put(texture, words)
        self._end = state["end"]
        self.set_error_lines(state["error_lines"])
        self._before = state["before"]

    def _put(self, texture, words):
        for number, word in enumerate(words):
            self._unit.set_register(texture, 4 * number, word)

    def set(self, **parameters: typing.Any) -> None:
        """Sets parameters from the next quad on: all of them or, if one is rejected, none. Empties the cache and resets
        the counters."""
        self._unit.set(parameters)
        self._before = None

    @property
    def parameters(self) -> dict[str, str]:
        """Returns every parameter as text."""
        return self._unit.parameters()

    def load(self, levels: Array | list[Array], texture: int = 0, **fields: typing.Any) -> None:
        """Stores a texture after the existing ones: its mip levels, the largest first, each uint8 of (height, width,
        4), or of (height, width, bytes of a texel) in the format given by `format`; in a compressed format of (rows,
        columns, bytes) of blocks of 4 x 4 texels. Fields are those of the descriptor's registers; width, height, levels
        and max_lod follow from the arrays unless given."""
        for level in levels if isinstance(levels, (list, tuple)) else [levels]:
            if not isinstance(level, numpy.ndarray) or level.dtype != numpy.uint8 or level.ndim != 3:
                raise ValueError("levels: expected uint8 of (height, width, bytes of a texel), got "
                                 + described(level))
        levels = [levels] if isinstance(levels, numpy.ndarray) else list(levels)
        if not levels:
            raise ValueError("levels: expected at least one")
        texture = _number(texture)
        before = self._unit.words(texture)
        try:
            end = self._describe(texture, levels, fields)
        except BaseException:
            self._put(texture, before)
            raise
        if end > self._unit.size():
            self._unit.resize(end)
        for number, level in enumerate(levels):
            self._unit.level(texture, number, numpy.ascontiguousarray(level).reshape(-1))
        self._end = -(-end // 64) * 64

    def _describe(self, texture, levels, fields):
        """Sets the descriptor of a texture stored after the others; returns the address after it."""
        self._unit.set_fields(texture, fields)
        block = self._unit.describe(texture)["block_bytes"]
        side = 4 if block else 1
        rows, columns = levels[0].shape[:2]
        self._unit.set_fields(texture, {"width": side * columns, "height": side * rows, "levels": len(levels),
                                        "max_lod": 256 * (len(levels) - 1), **fields})
        stored = self._unit.describe(texture)
        size = block or stored["texel_bytes"]
        for number, level in enumerate(levels):
            wanted = (-(-max(1, stored["height"] >> number) // side), -(-max(1, stored["width"] >> number) // side),
                      size)
            if level.shape != wanted:
                raise ValueError(f"level {number}: expected uint8 of {wanted}, got {described(level)}")
        return self._unit.place(texture, self._end)

    def set_fields(self, texture: int = 0, **fields: typing.Any) -> None:
        """Sets fields of a texture's registers by name: wrap_s="clamp_to_edge", bias=-128. All of them or none."""
        self._unit.set_fields(_number(texture), fields)

    def describe(self, texture: int = 0) -> dict[str, typing.Any]:
        """Returns size, levels, bases and fault (None: quads may use it) of a texture."""
        return self._unit.describe(_number(texture))

    def write(self, address: int, values: bytes | bytearray | memoryview | Array) -> None:
        """Writes bytes to memory, from a bytes-like object or uint8 of (n,). A cached line remains a predicted hit: call
        invalidate(), as software must."""
        self._unit.write(whole("address", address), byte_array(values))

    def read(self, address: int, size: int) -> Array:
        """Reads bytes of memory."""
        return self._unit.read(whole("address", address), whole("size", size))

    def filter(self, quads: Array) -> Array:
        """Filters an array of QUAD; returns an array of COLOUR, one for each covered lane, in order."""
        colours = self._unit.filter(quads)
        self._before = None
        return colours

    def analyse(self, quads: Array) -> Array:
        """Returns the decisions for each lane of quads before its first texel is read: records of (n, 4)."""
        return self._unit.analyse(quads)

    @property
    def fills(self) -> Array:
        """Returns the memory lines that the last filter() fetched, in order: address / cache_line_bytes."""
        return self._unit.fills() if self._before is None else self._before[0]

    @property
    def work(self) -> Figures:
        """Returns the counters since the unit was created or reset, with histograms by samples and by level."""
        return self._unit.work() if self._before is None else self._before[1]

    def set_error_lines(self, lines: Array | None) -> None:
        """Sets the numbers of lines that memory answers with an error, uint32; None: no errors."""
        self._unit.fail_lines(lines)
        self._error_lines = None if lines is None else lines.copy()

    def invalidate(self) -> None:
        """Empties the cache."""
        self._unit.invalidate()

    def reset(self) -> None:
        """Resets like the hardware: counters 0, cache empty. Textures and memory are kept."""
        self._unit.reset()
        self._before = None


def _number(texture):
    return whole("texture", texture, most=_TEXTURES - 1)


def texture(quads: Array, levels: Array | list[Array], *, fields: dict[str, typing.Any] | None = None,
            **parameters: typing.Any) -> tuple[Array, TextureUnit]:
    """Filters an array of QUAD with a new texture unit; returns (colours, unit), the unit for its work and fills.

    levels are the mip levels of texture 0 and fields those of its registers, as in TextureUnit.load()."""
    unit = TextureUnit(**parameters)
    unit.load(levels, **(fields or {}))
    return unit.filter(quads), unit


def mip_levels(texels: Array) -> list[Array]:
    """Returns the mip chain of a picture whose sides are powers of two: rounded means of 2 x 2 texels, or of two
    texels if one side is 1. Halves are rounded up; means of two are halves so often that they are rounded to even."""
    level = rgba(texels)
    if not isinstance(level, numpy.ndarray) or level.dtype != numpy.uint8 or level.ndim != 3:
        raise ValueError(f"texels: expected uint8 of (height, width, 4), got {described(texels)}")
    if any(side < 1 or side & (side - 1) for side in level.shape[:2]):
        raise ValueError(f"texels: expected sides that are powers of two, got {level.shape[1]} x {level.shape[0]}")
    levels = [level]
    to_even = min(level.shape[:2]) == 1
    while max(level.shape[:2]) > 1:
        wide = level.astype(numpy.uint16)
        # A side of one texel stays: it averages the texel with itself.
        rows = wide[0::2] + wide[1::2] if wide.shape[0] > 1 else 2 * wide
        both = rows[:, 0::2] + rows[:, 1::2] if rows.shape[1] > 1 else 2 * rows
        level = ((both + (1 + both // 4 % 2 if to_even else 2)) // 4).astype(numpy.uint8)
        levels.append(level)
    return levels


def quads_of(s: Array, t: Array, covered: Array | None = None, texture: int = 0) -> Array:
    """Returns the quads of a picture from the texture coordinates of its pixels, float64 or int32 (S7.24) of (height,
    width), both sides even, in row order. covered is one bool per pixel. Coordinates outside [-128, 128) are clamped.
    """
    s, t = numpy.asarray(s), numpy.asarray(t)
    if s.ndim != 2 or s.shape != t.shape or s.shape[0] % 2 or s.shape[1] % 2:
        raise ValueError(f"s and t: expected two arrays of (height, width), both even, got {s.shape} and {t.shape}")
    height, width = s.shape
    covered = numpy.ones(s.shape, bool) if covered is None else numpy.asarray(covered)
    if covered.shape != s.shape or covered.dtype != bool:
        raise ValueError(f"covered: expected bool of {s.shape}, got {described(covered)}")
    clamped = numpy.zeros(s.shape, bool)
    codes = []
    for values in (s, t):
        if values.dtype == numpy.int32:
            codes.append(values)
            continue
        if values.dtype.kind not in "fiu":
            raise ValueError(f"s and t: expected float64 or int32, got {described(values)}")
        with numpy.errstate(invalid="ignore"):
            scaled = numpy.floor(numpy.nan_to_num(values.astype(numpy.float64), nan=0.0) * _ONE + 0.5)
            outside = ~(numpy.isfinite(values) & (scaled >= -(1 << 31)) & (scaled < 1 << 31))
        clamped |= outside
        codes.append(numpy.clip(scaled, -(1 << 31), (1 << 31) - 1).astype(numpy.int64).astype(numpy.int32))

    def by_lane(plane):
        lanes = plane.reshape(height // 2, 2, width // 2, 2).transpose(0, 2, 1, 3)
        return lanes.reshape(-1, 4)

    bits = numpy.array([1, 2, 4, 8])
    quads = numpy.zeros(height * width // 4, dtype=QUAD)
    y, x = numpy.divmod(numpy.arange(quads.size), width // 2)
    quads["tag"] = numpy.arange(quads.size)
    quads["x"], quads["y"] = 2 * x, 2 * y
    quads["texture"] = texture
    quads["coverage"] = (by_lane(covered) * bits).sum(axis=1)
    quads["clamped"] = (by_lane(clamped) * bits).sum(axis=1)
    quads["s"], quads["t"] = by_lane(codes[0]), by_lane(codes[1])
    return quads


def image_of(quads: Array, colours: Array, shape: tuple[int, int]) -> Array:
    """Returns the picture of (height, width) with the colours of such quads: uint8 of (height, width, 4), 0 for pixels
    without a colour."""
    picture = numpy.zeros((*shape, 4), dtype=numpy.uint8)
    of = quads[numpy.searchsorted(quads["tag"], colours["tag"])]
    picture[of["y"] + colours["lane"] // 2, of["x"] + colours["lane"] % 2] = colours["rgba"]
    return picture


declare(texture, _golden.texture_parameters())
declare(TextureUnit.set, _golden.texture_parameters())
