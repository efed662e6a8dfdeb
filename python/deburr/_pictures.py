# SPDX-License-Identifier: MIT
"""Files of runs as arrays: 8-bit PNG, as the command writes it, and portable float maps."""
import struct
import sys
import zlib

import numpy

from deburr import _golden

_SIGNATURE = b"\x89PNG\r\n\x1a\n"
_CHANNELS = {0: 1, 2: 3, 6: 4}  # by PNG's colour type
_NONE, _UP = 0, 2


def _level_of_caller():
    """Returns the stack level for a warning, relative to the caller: the first line outside of deburr."""
    level, frame = 1, sys._getframe(1)
    while frame.f_back and frame.f_globals.get("__name__", "").split(".")[0] == "deburr":
        level, frame = level + 1, frame.f_back
    return level


def png_of(array):
    """Encodes a picture of uint8, (height, width), (height, width, 3) or (height, width, 4), or depths of (height,
    width): float32, 0..1, or uint32, U24, as 24 bits in R, G, B, which the command reads as depths."""
    if array.ndim == 2 and array.dtype in (numpy.float32, numpy.uint32):
        _golden.check_depths(array, _level_of_caller())
    if array.ndim == 2 and array.dtype == numpy.float32:
        scaled = numpy.floor(numpy.clip(array.astype(numpy.float64), 0, 1) * 0xFFFFFF + 0.5)
        return png_of(scaled.astype(numpy.uint32))
    if array.ndim == 2 and array.dtype == numpy.uint32:
        array = numpy.stack([array >> 16 & 255, array >> 8 & 255, array & 255], axis=2).astype(numpy.uint8)
    channels = 1 if array.ndim == 2 else array.shape[2] if array.ndim == 3 else 0
    types = [kind for kind, count in _CHANNELS.items() if count == channels]
    if array.dtype != numpy.uint8 or not types or 0 in array.shape:
        raise ValueError("expected a picture: uint8 of (height, width), (height, width, 3) or (height, width, 4), or "
                         f"depths, float32 or uint32 of (height, width), got {array.dtype} of {array.shape}")
    height, width = array.shape[:2]
    rows = numpy.zeros((height, 1 + width * channels), dtype=numpy.uint8)
    rows[:, 1:] = array.reshape(height, -1)

    def chunk(name, data):
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))

    header = struct.pack(">IIBBBBB", width, height, 8, types[0], 0, 0, 0)
    return (_SIGNATURE + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows.tobytes(), 1))
            + chunk(b"IEND", b""))


def read_png(file):
    """Returns uint8 of (height, width, channels) from a file that the command wrote."""
    data = file.read_bytes()
    position, pixels, header = len(_SIGNATURE), b"", None
    while position + 8 <= len(data):
        length, name = struct.unpack(">I4s", data[position:position + 8])
        body = data[position + 8:position + 8 + length]
        if name == b"IHDR":
            header = struct.unpack(">IIBBBBB", body)
        elif name == b"IDAT":
            pixels += body
        position += 12 + length
    if not data.startswith(_SIGNATURE) or header is None or header[2] != 8 or header[3] not in _CHANNELS or header[6]:
        raise OSError(f"{file}: not a PNG with 8 bits per channel")
    width, height, channels = header[0], header[1], _CHANNELS[header[3]]
    rows = numpy.frombuffer(zlib.decompress(pixels), dtype=numpy.uint8).reshape(height, 1 + width * channels)
    if (rows[:, 0] == _UP).all():
        values = numpy.cumsum(rows[:, 1:], axis=0, dtype=numpy.uint8)
    elif (rows[:, 0] == _NONE).all():
        values = rows[:, 1:].copy()
    else:
        raise OSError(f"{file}: unsupported PNG row filters (only none or up in all rows)")
    return values.reshape(height, width, channels)


def read_pfm(file):
    """Returns float32 of (height, width), top row first; NaN for pixels without a value."""
    data = file.read_bytes()
    kind, size, scale, values = data.split(b"\n", 3)
    width, height = (int(word) for word in size.split())
    if kind != b"Pf" or float(scale) >= 0:
        raise OSError(f"{file}: not a little-endian portable float map with one channel")
    return numpy.frombuffer(values, dtype="<f4", count=width * height).reshape(height, width)[::-1].copy()
