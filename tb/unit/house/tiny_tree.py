# SPDX-License-Identifier: MIT
"""A small temporary tree for tests of scripts."""
import pathlib
import tempfile


def tiny_tree(test, files):
    """Writes `files` {name: text} and returns the root; the tree is removed after the test."""
    scratch = tempfile.TemporaryDirectory(prefix="deburr_tiny_")
    test.addCleanup(scratch.cleanup)
    root = pathlib.Path(scratch.name).resolve()
    for name, text in files.items():
        (root / name).parent.mkdir(parents=True, exist_ok=True)
        (root / name).write_text(text, encoding="utf-8")
    return root
