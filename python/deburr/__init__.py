# SPDX-License-Identifier: MIT
"""Models of anti-aliasing hardware on numpy arrays.

golden    bit-exact golden models of the engines as functions
ideal     reference filters and references in real arithmetic
run       one run of a cycle-accurate model, in its own process
cost      gates, flip-flops, memory and longest path of a build
sweep     many runs, as a table

See docs/reference/python.md.
"""
from deburr import golden, ideal
from deburr._golden import version as __version__
from deburr._program import RunError, engines, parameters
from deburr._run import Run, cost, run
from deburr._sweep import sweep

__all__ = ["Run", "RunError", "__version__", "cost", "engines", "golden", "ideal", "parameters", "run", "sweep"]
