# SPDX-License-Identifier: MIT
"""Many runs over axes of parameters, as a table."""
from __future__ import annotations

import json
import math
import os
import pathlib
import tempfile
import typing
import warnings

from deburr._declared import argument
from deburr._program import call, engines, known, parameters, settings

_METRICS = {"cycles": "cycles", "rate": "throughput.value"}


def _definition(engine, axes, metrics, rest, given, folder):
    """Builds the contents of a sweep file from Python names."""
    names = known(engine)
    if not axes:
        raise ValueError("axes: expected a dictionary of parameters and their values, such as "
                         "{\"memory_latency\": [50, 200]}")

    def own(name):
        parameters = names.get(name, ([name], None))[0]
        return parameters[0] if len(parameters) == 1 else name

    def plain(values):
        return values if isinstance(values, dict) else [
            value if isinstance(value, (bool, int, float, str)) else value.item() if hasattr(value, "item")
            else str(value) for value in values]

    if metrics is not None and not isinstance(metrics, dict):
        metrics = {argument(key): key for key in metrics}
    return {"engine": engine, "base": dict(settings(engine, given, folder)),
            "axes": {own(name): plain(values) for name, values in axes.items()},
            "metrics": _METRICS if metrics is None else metrics, "reports": False, **rest}


def _typed(axis, declared):
    """Returns a function that converts an axis's text in the sweep's results to a value."""
    default = declared.get(axis["name"], "")
    if isinstance(default, bool):
        return lambda text: text == "true"
    if isinstance(default, (int, float)):
        kind = float if isinstance(default, float) else lambda text: int(text, 0)
        # "-" marks a point where this axis does not apply.
        return lambda text: text if text == "-" else kind(text)
    return str


def _rows(collected):
    """Returns one dictionary per point: its axis values, metrics, state, front and failure."""
    declared = {row["name"]: row["default"] for row in parameters(collected["engine"])}
    axes = [axis["name"] for axis in collected["axes"]]
    types = [_typed(axis, declared) for axis in collected["axes"]]
    metrics = [metric["name"] for metric in collected["metrics"]]
    rows = []
    for point in collected["points"]:
        row = {name: kind(value) if isinstance(value, str) else value
               for name, kind, value in zip(axes, types, point["at"])}
        values = [math.nan if value is None else value for value in point["values"]]
        row.update(zip(metrics, values))
        row.update({name: math.inf for name in point.get("identical", [])})
        row["state"] = point["state"]
        if collected["objectives"]:
            row["front"] = point.get("front", False)
        row["failure"] = point.get("failure", "")
        row["point"] = point["name"]
        rows.append(row)
    return rows


def _table(rows):
    """Returns a DataFrame if pandas is installed, else the dictionaries."""
    try:
        import pandas
    except ImportError:
        return rows
    return pandas.DataFrame(rows)


def sweep(what: str | os.PathLike[str], axes: dict[str, typing.Any] | None = None, *,
          metrics: list[str] | dict[str, str] | None = None, minimise: str | list[str] | None = None,
          maximise: str | list[str] | None = None, for_each: str | list[str] | None = None,
          constraints: list[str] | None = None, sample: str | dict[str, int] | None = None, refused: str | None = None,
          out: str | os.PathLike[str] | None = None, jobs: int | None = None, progress: bool = False,
          **parameters: typing.Any) -> typing.Any:
    """Runs an engine at many points, each checked against its golden model; returns a table with one row per point.

    what is the name of an engine, or a sweep file, which defines everything except out and jobs. axes are parameters
    and their values: {"cache_bytes": [4096, 8192]} by the names that run() accepts, as lists or in the forms of a sweep
    file ({"from": 32, "to": 256, "times": 2}). Other parameters apply to every point. metrics are keys of result.json,
    as a list or as names and keys; default: cycles and rate. minimise and maximise name metrics, and the table shows
    which points are on their Pareto front; only points that agree in the axes of for_each are compared. constraints,
    sample and `refused` are those of a file. out keeps the points, and existing ones are not run again; jobs is the
    number of concurrent runs.

    The table is a pandas DataFrame if pandas is installed, else a list of dictionaries. Points that failed are rows
    with their failure, and a warning is raised."""
    with tempfile.TemporaryDirectory(prefix="deburr_sweep_") as scratch:
        folder = pathlib.Path(scratch)
        place = folder / "out" if out is None else pathlib.Path(out)
        if what in engines():
            objectives = {"minimise": minimise, "maximise": maximise, "for_each": for_each}
            objectives = {name: [value] if isinstance(value, str) else list(value)
                          for name, value in objectives.items() if value is not None}
            names = known(what)
            if "for_each" in objectives:
                objectives["for_each"] = [names.get(name, ([name],))[0][0] for name in objectives["for_each"]]
            rest = {"objectives": objectives or None, "constraints": constraints, "sample": sample, "refused": refused}
            given = folder / "given"
            given.mkdir()
            definition = _definition(what, axes, metrics, {name: value for name, value in rest.items()
                                                           if value is not None}, parameters, given)
            file = folder / "sweep.yaml"  # JSON is YAML
            file.write_text(json.dumps(definition), encoding="utf-8")
        else:
            if axes is not None or parameters or any(
                    value is not None for value in (metrics, minimise, maximise, for_each, constraints, sample, refused)):
                if not os.path.exists(what):
                    call("run", str(what))  # not an engine: raises the command's message
                raise ValueError(f"{what}: a sweep file defines its own axes; only out, jobs and progress can be given "
                                 "with it")
            file = pathlib.Path(what)
        words = ["sweep", str(file)]
        run = call(*words, "run", f"--out={place}", *([] if jobs is None else [f"--jobs={jobs}"]), progress=progress)
        collected = call(*words, "collect", f"--out={place}")["result"]
        failed = run["counts"]["failed"]
        if failed:
            warnings.warn(f"{failed} of {run['counts']['points']} points failed: see the column failure", stacklevel=2)
        return _table(_rows(collected))
