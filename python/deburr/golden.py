# SPDX-License-Identifier: MIT
"""Bit-exact golden models of the engines, on numpy arrays.

Frames are uint8 of (height, width, 4), R, G, B, A; (height, width, 3) is opaque. Depths are near / w in float32, 0..1,
or the hardware's codes, U24 in uint32. An invalid argument raises a ValueError with what was expected. Results are
read-only views of memory of the model that made them, which they keep alive.
"""
import importlib
import pathlib

# Each engine's part is a module _golden_NAME.py; its public names are re-exported here.
_PARTS = [importlib.import_module(f"deburr.{file.stem}") for file in sorted(pathlib.Path(__file__).parent.glob("_golden_*.py"))]
for _part in _PARTS:
    for _name in _part.__all__:
        globals()[_name] = getattr(_part, _name)
        if getattr(globals()[_name], "__module__", None) == _part.__name__:
            globals()[_name].__module__ = __name__

__all__ = sorted(_name for _part in _PARTS for _name in _part.__all__)
