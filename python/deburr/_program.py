# SPDX-License-Identifier: MIT
"""The command `deburr`: where it is, what it can, and how it is called."""
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
    """A run that failed: `code` is the command's exit code (1 mismatch, 3 simulation error, 4 deadlock), `result` what
    was measured until then, or None."""

    def __init__(self, text: str, code: int, result: Run | None = None) -> None:
        super().__init__(text)
        self.code, self.result = code, result


def program():
    """Where the command is: beside this package, as it was installed, or on the PATH."""
    beside = pathlib.Path(_golden.__file__).absolute().parent / _build.PROGRAM
    if os.access(beside, os.X_OK):
        return str(beside.resolve())
    found = shutil.which("deburr")
    if found is None:
        raise FileNotFoundError(f"the command deburr is neither {os.path.normpath(beside)} nor on the PATH: install "
                                "it (Debian's package deburr, or cmake --install)")
    return found


def call(*words, progress=False):
    """What the command says, as JSON. ValueError and OSError have its words; other failures are in exit_code."""
    # What a user's terminal sends goes to both; where Ctrl-C comes to Python alone, it is passed on.
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
        raise RunError(f"the command ended with {process.returncode} and said: {complaints or text}",
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
    """Ctrl-C twice: the first ends a run at its next chance, the second at once."""
    for wait in (0.2, 5):
        try:
            process.wait(wait)
            return
        except subprocess.TimeoutExpired:
            process.send_signal(signal.SIGINT)
    process.kill()
    process.wait()  # Popen waits for a quarter of a second after Ctrl-C, and no longer


def _words(answer):
    """The command's complaint, whole; its last line is cut."""
    kind, _, short = answer["outcome"].partition(": ")
    del kind
    whole = "\n".join(answer["messages"])
    return whole or short


@functools.lru_cache(maxsize=None)
def _declared():
    answer = call("params")
    return answer["parameters"], answer["options"]


def engines() -> list[str]:
    """Names of the engines that run() takes."""
    return list(dict.fromkeys(row["engine"] for row in _declared()[0]))


def parameters(engine: str) -> list[dict[str, typing.Any]]:
    """Every parameter of an engine's runs: dictionaries of name, kind, default, range, unit and meaning."""
    if engine not in engines():
        call("run", str(engine))  # whose words say what is known
    return [dict(row) for row in _declared()[0] if row["engine"] == engine]


def options(engine):
    """Short names of parameters, as of `deburr run ENGINE --help`."""
    return [dict(row) for row in _declared()[1] if row["engine"] == engine]


def known(engine):
    """The names that Python has for an engine's parameters: the parameters' own that each stands for, and what a
    switch gives them."""
    names = {}
    for row in parameters(engine):
        names[argument(row["name"])] = ([row["name"]], None)
    for row in options(engine):
        names[argument(row["option"])] = (row["parameters"], row["given"])
    return names


def text_of(value, folder):
    """A value as it is written on the command line. Arrays become pictures in the folder."""
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
    """[(parameter, value as text)] of what was given by Python's names; what is no parameter stays as it is, for the
    command to reject."""
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
