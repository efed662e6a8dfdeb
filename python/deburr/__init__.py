# SPDX-License-Identifier: MIT
"""Deburr from Python: models of anti-aliasing hardware on numpy arrays.

golden    bit-exact golden models of the engines as functions
ideal     reference filters and reference in real numbers
run       one run of a cycle-accurate model, in a process of its own
sweep     many runs, as a table

docs/reference/python.md has the whole of it.
"""
from deburr import golden, ideal
from deburr._golden import version as __version__
from deburr._program import RunError, engines, parameters
from deburr._run import Run, run
from deburr._sweep import sweep

__all__ = ["Run", "RunError", "__version__", "engines", "golden", "ideal", "parameters", "run", "sweep"]
