# SPDX-License-Identifier: MIT
"""A small tree in a folder of its own, for tests of scripts."""
import pathlib
import tempfile


def tiny_tree(test, files):
    """Writes the texts of `files` by their names, and removes all with the test; the tree's root."""
    scratch = tempfile.TemporaryDirectory(prefix="deburr_tiny_")
    test.addCleanup(scratch.cleanup)
    root = pathlib.Path(scratch.name).resolve()
    for name, text in files.items():
        (root / name).parent.mkdir(parents=True, exist_ok=True)
        (root / name).write_text(text, encoding="utf-8")
    return root
