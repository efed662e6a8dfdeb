# SPDX-License-Identifier: MIT
"""Reference filters and references in real arithmetic, and other methods for comparison with the engines.

Filters take uint8 frames of (height, width, 4). Colours of textures are float64, 0..255.
"""
from deburr._golden import ideal as _ideal

__all__ = ["FOOTPRINT", "SCREEN_LINE", "TextureImage", "box", "cmaa2", "disc", "ewa", "fxaa", "half_plane",
           "line_blend", "line_weights", "pixel_footprints", "psnr", "smaa_edges", "smaa_weights"]

globals().update({name: getattr(_ideal, name) for name in __all__})
