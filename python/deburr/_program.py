# SPDX-License-Identifier: MIT
"""The command `deburr`: its location, its capabilities, and calls to it."""
from __future__ import annotations

import functools
import json
import os
import pathlib
import shutil
import signal
import subprocess
import tempfile
import typing

import numpy

from deburr import _build, _golden, _pictures
from deburr._declared import argument

if typing.TYPE_CHECKING:
    from deburr._run import Run

_INTERRUPTED = 130
_USAGE, _FILE = 2, 5


class RunError(RuntimeError):
    """A failed run: `code` is the command's exit code (1 mismatch, 3 simulation error, 4 deadlock), `result` the
    measurements until then, or None."""

    def __init__(self, text: str, code: int, result: Run | None = None) -> None:
        super().__init__(text)
        self.code, self.result = code, result

    def __reduce__(self) -> tuple[typing.Any, ...]:
        return type(self), (str(self), self.code, self.result)


def program():
    """Returns the command's path: next to this package as installed, or on the PATH."""
    beside = pathlib.Path(_golden.__file__).absolute().parent / _build.PROGRAM
    if os.access(beside, os.X_OK):
        return str(beside.resolve())
    found = shutil.which("deburr")
    if found is None:
        raise FileNotFoundError(f"the command deburr is neither {os.path.normpath(beside)} nor on the PATH: install "
                                "it (Debian's package deburr, or cmake --install)")
    return found


def call(*words, progress=False):
    """Returns the command's answer as JSON. Raises ValueError and OSError with its message; other failures are in
    exit_code."""
    # Ctrl-C in a terminal reaches both processes; if only Python receives it, it is passed on.
    with tempfile.TemporaryFile("w+", encoding="utf-8") as said, tempfile.TemporaryFile("w+", encoding="utf-8") as errors:
        with subprocess.Popen([program(), *words, "--json"], stdin=subprocess.DEVNULL, stdout=said,
                              stderr=None if progress else errors) as process:
            try:
                process.wait()
            except BaseException:
                _end(process)
                raise
        said.seek(0)
        errors.seek(0)
        text, complaints = said.read(), errors.read()
    try:
        answer = json.loads(text)
    except json.JSONDecodeError:
        raise RunError(f"the command ended with exit code {process.returncode}: {complaints or text}",
                       process.returncode) from None
    answer["messages"] = [line.removeprefix("deburr: ") for line in complaints.splitlines()]
    code = answer["exit_code"]
    if code == _INTERRUPTED:
        raise KeyboardInterrupt
    if code == _USAGE:
        raise ValueError(_words(answer))
    if code == _FILE:
        raise OSError(_words(answer))
    return answer


def _end(process):
    """Sends Ctrl-C twice: the first ends a run at its next poll, the second immediately."""
    for wait in (0.2, 5):
        try:
            process.wait(wait)
            return
        except subprocess.TimeoutExpired:
            process.send_signal(signal.SIGINT)
    process.kill()
    process.wait()  # Popen waits only a quarter of a second after Ctrl-C


def _words(answer):
    """Returns the command's complete error message; `outcome` has only a shortened line."""
    kind, _, short = answer["outcome"].partition(": ")
    del kind
    whole = "\n".join(answer["messages"])
    return whole or short


@functools.lru_cache(maxsize=None)
def _declared():
    answer = call("params")
    return answer["parameters"], answer["options"]


def engines() -> list[str]:
    """Returns the names of the engines that run() accepts."""
    return list(dict.fromkeys(row["engine"] for row in _declared()[0]))


def parameters(engine: str) -> list[dict[str, typing.Any]]:
    """Returns every parameter of an engine's runs: dictionaries of name, kind, default, range, unit and meaning."""
    if engine not in engines():
        call("run", str(engine))  # raises the command's message with the known names
    return [dict(row) for row in _declared()[0] if row["engine"] == engine]


def options(engine):
    """Returns the short parameter names of `deburr run ENGINE --help`."""
    return [dict(row) for row in _declared()[1] if row["engine"] == engine]


def known(engine):
    """Returns the Python names of an engine's parameters: for each name the parameters that it sets, and the value that
    it gives a switch."""
    names = {}
    for row in parameters(engine):
        names[argument(row["name"])] = ([row["name"]], None)
    for row in options(engine):
        names[argument(row["option"])] = (row["parameters"], row["given"])
    return names


def text_of(value, folder):
    """Returns a value as on the command line. Arrays are written as pictures to the folder."""
    if isinstance(value, (bool, numpy.bool_)):
        return "true" if value else "false"
    if isinstance(value, numpy.ndarray):
        file = pathlib.Path(folder) / f"array_{len(list(pathlib.Path(folder).iterdir()))}.png"
        file.write_bytes(_pictures.png_of(value))
        return str(file)
    if isinstance(value, (tuple, list)):
        return ",".join(text_of(one, folder) for one in value)
    if isinstance(value, (float, numpy.floating)):
        return repr(float(value))
    return str(value)


def settings(engine, given, folder):
    """Converts settings by Python names to [(parameter, value as text)]; unknown names are unchanged, and the command
    rejects them."""
    names = known(engine)
    found = []
    for name, value in given.items():
        wanted, switch = names.get(name, ([name], None))
        if len(wanted) == 2:
            parts = str(value).split("x") if not isinstance(value, (tuple, list)) else list(value)
            if len(parts) != 2:
                raise ValueError(f"{name}: expected WIDTHxHEIGHT, got '{value}'")
            found += [(one, text_of(part, folder)) for one, part in zip(wanted, parts)]
        elif switch == "false" and isinstance(value, (bool, numpy.bool_)):
            found.append((wanted[0], text_of(not value, folder)))  # no_images=True is run.images = false
        else:
            found.append((wanted[0], text_of(value, folder)))
    return found
