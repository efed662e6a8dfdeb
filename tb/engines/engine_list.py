# SPDX-License-Identifier: MIT
"""The engines of engines.txt for scripts and tests, and what their trials.yaml says: with what tests of every engine
run this one."""
import pathlib

FOLDER = pathlib.Path(__file__).resolve().parent


def engines():
    """Their names, in order."""
    lines = (FOLDER / "engines.txt").read_text(encoding="utf-8").splitlines()
    return [line for line in lines if line and not line.startswith("#")]


def trials(name):
    """{engine: its entry `name`}, of those that have one."""
    import yaml  # not of those that want the names alone
    found = {}
    for engine in engines():
        entries = yaml.safe_load((FOLDER / engine / "trials.yaml").read_text(encoding="utf-8"))
        if name in entries:
            found[engine] = entries[name]
    return found
