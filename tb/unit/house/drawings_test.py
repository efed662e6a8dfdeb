#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Checks that each figure of docs/images/ has a title, a description and colours for light and dark, that each picture is
shown in a page, and that each that is shown has words for those who cannot see it.

usage: drawings_test.py SOURCE"""
import pathlib
import re
import shutil
import sys
import tempfile
import xml.etree.ElementTree

SHOWN = re.compile(r"!\[([^\]]*)\]\(([^)\s]+)\)")
SVG = "{http://www.w3.org/2000/svg}"
WORDS = 6  # fewer do not say what a picture shows


def pictures(root):
    files = sorted((root / "docs/images").glob("*.svg"))
    if not files:
        yield "docs/images: no figure"
    for file in files:
        name, text = file.relative_to(root), file.read_text(encoding="utf-8")
        tree = xml.etree.ElementTree.fromstring(text)
        for part in ("title", "desc"):
            found = tree.find(SVG + part)
            if found is None or len((found.text or "").split()) < WORDS:
                yield f"{name}: no {part} of {WORDS} words or more"
        if "prefers-color-scheme: dark" not in text:
            yield f"{name}: has no colours for dark"
        if re.search(r"(?:href|src)=|url\((?!#)|@import", text):
            yield f"{name}: loads something else"


def pages(root):
    shown = set()
    for page in [*sorted(root.glob("*.md")), *sorted((root / "docs").rglob("*.md"))]:
        for words, target in SHOWN.findall(page.read_text(encoding="utf-8")):
            file = (page.parent / target).resolve()
            shown.add(file)
            if not file.is_file():
                yield f"{page.relative_to(root)}: shows {target}, which does not exist"
            elif file.suffix == ".svg" and len(words.split()) < WORDS or not words.strip():
                yield f"{page.relative_to(root)}: {target} has no words for those who cannot see it"
    for file in sorted((root / "docs/images").iterdir()):
        if file.resolve() not in shown:
            yield f"{file.relative_to(root)}: no page shows it"


def problems(root):
    return [*pictures(root), *pages(root)]


def faults_that_are_not_found(root):
    """Each changes one thing in a copy: (file, what stands there, what it becomes)."""
    faults = (("docs/images/line_walk.svg", '<title id="title">', '<title id="title">A</title><title>'),
              ("docs/images/line_walk.svg", "prefers-color-scheme: dark", "prefers-color-scheme: light"),
              ("docs/images/line_walk.svg", "url(#head)", "url(head.svg)"),
              ("docs/howto/nightly_regression.md", "![A testplan", "![shapes](../images/run_shapes.svg) ![A testplan"),
              ("docs/howto/nightly_regression.md", "images/regression.svg)", "images/none.svg)"))
    with tempfile.TemporaryDirectory() as folder:
        copy = pathlib.Path(folder)
        shutil.copytree(root / "docs", copy / "docs")
        for page in root.glob("*.md"):
            shutil.copy(page, copy)
        for file, old, new in faults:
            text = (copy / file).read_text(encoding="utf-8")
            if old not in text:
                yield f"planted fault has no place: {file} has no {old}"
                continue
            (copy / file).write_text(text.replace(old, new, 1), encoding="utf-8")
            if not problems(copy):
                yield f"planted fault not found: {file}: {new}"
            (copy / file).write_text(text, encoding="utf-8")
        bare = copy / "docs/images/bare.svg"
        bare.write_text('<svg xmlns="http://www.w3.org/2000/svg"><title>A picture</title></svg>', encoding="utf-8")
        if len(problems(copy)) != 4:
            yield f"planted fault not found: a bare picture gives {problems(copy)}"


def main():
    if len(sys.argv) != 2:
        print(__doc__)
        return 2
    root = pathlib.Path(sys.argv[1]).resolve()
    found = problems(root) or list(faults_that_are_not_found(root))
    print("\n".join(found))
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
