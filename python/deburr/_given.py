# SPDX-License-Identifier: MIT
"""Converts arguments of the golden models."""
from __future__ import annotations

import operator
import typing

import numpy
import numpy.typing

Array = numpy.typing.NDArray[typing.Any]


def rgba(pixels):
    """Adds an alpha channel; the model rejects invalid pictures."""
    if isinstance(pixels, numpy.ndarray) and pixels.ndim == 3 and pixels.shape[2] == 3 and pixels.dtype == numpy.uint8:
        opaque = numpy.full((*pixels.shape[:2], 1), 255, dtype=numpy.uint8)
        return numpy.concatenate([pixels, opaque], axis=2)
    return pixels


def whole(name, value, least=0, most=(1 << 64) - 1):
    """Returns an integer in least..most."""
    try:
        number = operator.index(value)
    except TypeError:
        raise ValueError(f"{name}: expected an integer, got {described(value)}") from None
    if not least <= number <= most:
        raise ValueError(f"{name} {number} is outside {least}..{most}")
    return number


def byte_array(values):
    """Returns a bytes-like object as an array of bytes; the model rejects invalid arrays."""
    if isinstance(values, numpy.ndarray):
        return values
    try:
        view = memoryview(values)
    except TypeError:
        view = None
    if view is None or view.itemsize != 1:
        raise ValueError(f"bytes: expected a bytes-like object or uint8 of (n,), got {described(values)}")
    return numpy.frombuffer(view.tobytes(), dtype=numpy.uint8)


def described(value):
    if isinstance(value, numpy.ndarray):
        return f"{value.dtype} of {value.shape}"
    return "None" if value is None else f"an object of type {type(value).__name__}"
