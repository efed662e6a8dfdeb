# SPDX-License-Identifier: MIT
"""Reference filters and references in real arithmetic, and other methods for comparison with the engines.

Filters take uint8 frames of (height, width, 4). Colours of textures are float64, 0..255.
"""
import functools
import inspect
import re

from deburr._golden import ideal as _ideal

__all__ = ["FOOTPRINT", "SCREEN_LINE", "TextureImage", "box", "cmaa2", "disc", "ewa", "fxaa", "half_plane",
           "line_blend", "line_weights", "pixel_footprints", "psnr", "smaa_edges", "smaa_weights"]


def _reject_unknown(function, known, named):
    for name in named:
        if name not in known:
            raise ValueError(f"{function}: unknown parameter '{name}'; known: {', '.join(known)}")


def _named(function):
    """The function, which rejects unknown arguments as deburr.golden does."""
    known = re.findall(r"[(,] ?(\w+):", function.__doc__.split("\n")[0])

    @functools.wraps(function)
    def call(*arguments, **named):
        _reject_unknown(function.__name__, known, named)
        return function(*arguments, **named)
    call.__module__, call.__qualname__ = __name__, function.__name__  # what pickle looks up
    return call


for _name in __all__:
    _part = getattr(_ideal, _name)
    globals()[_name] = _named(_part) if inspect.isbuiltin(_part) else _part


class TextureImage(_ideal.TextureImage):
    __doc__ = _ideal.TextureImage.__doc__

    def __init__(self, *arguments, **named):
        _reject_unknown("TextureImage", ("texels", "wrap_s", "wrap_t", "srgb"), named)
        super().__init__(*arguments, **named)
