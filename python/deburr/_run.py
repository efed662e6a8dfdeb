# SPDX-License-Identifier: MIT
"""One run of a cycle-accurate model, in its own process: SystemC elaborates once per process."""
from __future__ import annotations

import collections.abc
import json
import os
import pathlib
import shutil
import tempfile
import typing
import weakref

import numpy

from deburr import _pictures
from deburr._figures import Figures
from deburr._given import Array
from deburr._program import RunError, call, settings


class _Scratch:
    """A folder that is deleted with its last user."""

    def __init__(self):
        self.path = pathlib.Path(tempfile.mkdtemp(prefix="deburr_run_"))
        weakref.finalize(self, shutil.rmtree, self.path, ignore_errors=True)


class _Files(collections.abc.Mapping[str, Array]):
    """Arrays from the files of a run's directory, read on first access: a mapping by name."""

    def __init__(self, directory, pattern, prefix, read):
        self._files = {file.stem.removeprefix(prefix): file for file in sorted(directory.glob(pattern))
                       if file.stem.startswith(prefix)}
        self._read = read

    def __iter__(self) -> collections.abc.Iterator[str]:
        return iter(self._files)

    def __len__(self) -> int:
        return len(self._files)

    def __contains__(self, name: object) -> bool:
        return name in self._files

    def __getitem__(self, name: str) -> Array:
        if name not in self._files:
            raise KeyError(f"the run wrote no '{name}' (available: {', '.join(self._files) or 'none'})")
        return self._read(self._files[name])

    def __repr__(self):
        return "{" + ", ".join(self._files) + "}"


def _arrays(node):
    """Converts sampling intervals to arrays: nested lists of numbers."""
    if isinstance(node, dict):
        return {name: _arrays(value) for name, value in node.items()}
    if isinstance(node, list) and node and all(isinstance(value, (int, float)) for value in node):
        return numpy.array(node)
    return node


class Run(Figures):
    """The measurements of a run. Its figures are those of result.json, as attributes: `run.cycles`,
    `run.throughput.value`, `run.units`, `run.work`; `run["units.filter_pipeline.busy"]` selects one by its key.

    pictures and maps are arrays by name, intervals has one array per series by key, directory holds the files. It is
    deleted with this object unless run() was given `out`. A pickled Run has its pictures and maps with it."""

    directory: pathlib.Path
    meaning: dict[str, dict[str, str]]
    intervals: Figures
    maps: collections.abc.Mapping[str, Array]
    pictures: collections.abc.Mapping[str, Array]

    def __init__(self, result, directory, kept):
        histogram = result.get("latency", {}).get("histogram")
        if histogram:
            result["latency"]["histogram"] = numpy.array(
                [tuple(entry.values()) if isinstance(entry, dict) else tuple(entry) for entry in histogram])
        for link in result.get("links", {}).values():
            link["histogram"] = numpy.array(link["histogram"])
        meaning = result.pop("meaning", {})
        super().__init__(result)
        files = [file.name for file in directory.iterdir()]
        intervals = {}
        if "intervals.json" in files:
            intervals = _arrays(json.loads((directory / "intervals.json").read_text(encoding="utf-8")))
        self.__dict__.update(
            _kept=kept, directory=directory, meaning=meaning, intervals=Figures(intervals),
            maps=_Files(directory, "map_*.pfm", "map_", _pictures.read_pfm),
            pictures=_Files(directory, "*.png", "", _pictures.read_png))

    def __getstate__(self) -> dict[str, typing.Any]:
        # The directory of the copy may be gone: it takes the contents of the files along.
        return {**self.__dict__, "_kept": None, "maps": dict(self.maps), "pictures": dict(self.pictures)}

    def __setstate__(self, state: dict[str, typing.Any]) -> None:
        self.__dict__.update(state)

    def __repr__(self):
        rate = self.throughput
        return f"<Run {self.unit}: {self.verdict}, {self.cycles} cycles, {rate.value:.3f} {rate.unit}>"

    def explain(self, key: str) -> str:
        """Returns unit and meaning of a figure, by its key."""
        entry = self.meaning.get(key)
        if entry is None:
            raise KeyError(f"'{key}' has no description")
        return f"{entry['meaning']} [{entry['unit']}]" if entry.get("unit") else entry["meaning"]


def cost(engine: str, **parameters: typing.Any) -> Figures:
    """Returns the cost of the hardware that run() would build, without a run: `cost.gates.value`, `cost.ns`,
    `cost.units.tag_stage.flip_flops`. Parameters as for run(); those of the run and its inputs have no effect."""
    with tempfile.TemporaryDirectory(prefix="deburr_cost_") as folder:
        words = [f"--set={name}={text}" for name, text in settings(str(engine), parameters, folder)]
        answer = call("params", str(engine), "--cost", *words)
    if answer["exit_code"] != 0:
        raise RunError("\n".join([answer["outcome"], *answer["messages"]]), answer["exit_code"])
    return Figures(answer["cost"])


def run(engine: str, *, out: str | os.PathLike[str] | None = None, config: str | os.PathLike[str] | None = None,
        progress: bool = False, **parameters: typing.Any) -> Run:
    """Runs a cycle-accurate model against its golden model; returns a Run.

    engine is one of engines(). Parameters have the names of `deburr params ENGINE` with '_' for '.'
    (memory_latency=200), or the short ones of `deburr run ENGINE --help` (scene="tunnel", size=(640, 360), in_=file,
    windows=2000); names with dots can be given as **{"memory.latency": 200}. Arrays are accepted for pictures and
    depths. config is a file of parameters, out a directory for the files, progress=True shows the command's messages
    during the run.

    Raises ValueError with the command's message for invalid arguments, OSError for a file that cannot be read or
    written, RunError for a run that fails. Ctrl-C ends the run."""
    kept = _Scratch()
    folder = kept.path
    (folder / "given").mkdir()
    words = ["run", str(engine)]
    words += [f"--set={name}={text}" for name, text in settings(str(engine), parameters, folder / "given")]
    if config is not None:
        words.append(f"--config={config}")
    directory = folder / "out" if out is None else pathlib.Path(out)
    words.append(f"--out={directory}")
    answer = call(*words, progress=progress)
    result = answer.get("result")
    found = None if result is None else Run(result, pathlib.Path(answer["directory"]).absolute(), kept)
    if answer["exit_code"] != 0 or found is None:
        raise RunError("\n".join([answer["outcome"], *answer["messages"]]), answer["exit_code"], found)
    return found
