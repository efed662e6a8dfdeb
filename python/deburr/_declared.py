# SPDX-License-Identifier: MIT
"""Generates signatures and docstrings of functions from parameter declarations."""
import inspect
import keyword
import textwrap


def argument(name):
    """Returns a parameter's name in Python: `cache_bytes` for `cache.bytes`, `in_` for `in`."""
    flat = name.lstrip("-").replace(".", "_").replace("-", "_")
    return flat + "_" if keyword.iskeyword(flat) else flat


def kind_of(row):
    """Returns the annotation of a parameter, from its default and its range."""
    if isinstance(row["default"], bool):
        return bool
    return type(row["default"])


def declare(function, rows):
    """Gives `function(..., **parameters)` the signature and the docstring of these parameters."""
    signature = inspect.signature(function)
    own = [parameter for parameter in signature.parameters.values()
           if parameter.kind is not inspect.Parameter.VAR_KEYWORD]
    given = [inspect.Parameter(argument(row["name"]), inspect.Parameter.KEYWORD_ONLY, default=row["default"],
                               annotation=kind_of(row)) for row in rows]
    function.__signature__ = signature.replace(parameters=[*own, *given])
    lines = [inspect.cleandoc(function.__doc__), "", "Parameters, each with its default:", ""]
    for row in rows:
        unit = f" {row['unit']}" if row["unit"] else ""
        lines.append(f"{argument(row['name'])} = {row['default']!r} ({row['range']}{unit})")
        lines.extend(textwrap.wrap(row["meaning"], 96, initial_indent="    ", subsequent_indent="    ",
                                   break_on_hyphens=False))
    function.__doc__ = "\n".join(lines)
    function.__declared__ = rows
    return function
