#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Copies a source with an injected fault: replaces a text that occurs exactly once.

usage: inject_fault.py SOURCE COPY NAME FROM TO"""
import pathlib
import sys


def main():
    source, copy, _, wrong, right = sys.argv[1:6] if len(sys.argv) == 6 else [None] * 5
    if source is None:
        sys.exit(__doc__.splitlines()[-1])
    text = pathlib.Path(source).read_text(encoding="utf-8")
    if text.count(wrong) != 1:
        sys.exit(f"inject_fault: {source} has {wrong!r} {text.count(wrong)} times; name a text that it has once")
    path = pathlib.Path(copy)
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text.replace(wrong, right), encoding="utf-8")


if __name__ == "__main__":
    main()
