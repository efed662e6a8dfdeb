# SPDX-License-Identifier: MIT
"""Converts arguments of the golden models."""
from __future__ import annotations

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


def described(value):
    if isinstance(value, numpy.ndarray):
        return f"{value.dtype} of {value.shape}"
    return "None" if value is None else f"an object of type {type(value).__name__}"
