#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Checks the spelling of the pages (codespell, without the words of scripts/site/words.txt, one a line), and that
their terms are those of the field, written in one way.

usage: spelling_test.py SOURCE"""
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

# What is written in another way -> how the pages write it.
TERMS = {r"anti aliasing|antialiased": "anti-aliasing", r"test bench(?:es)?": "testbench", r"backpressure": "back-pressure",
         r"mip-map|mip map": "mipmap", r"System Verilog|Systemverilog": "SystemVerilog", r"bit exact": "bit-exact",
         r"cycle accurate": "cycle-accurate"}


def pages(root):
    return [*sorted(root.glob("*.md")), *sorted((root / "docs").rglob("*.md"))]


def spelled(root):
    done = subprocess.run(["codespell", "--ignore-words", root / "scripts/site/words.txt", *pages(root)],
                          capture_output=True, text=True, check=False)
    return [line.replace(f"{root}/", "") for line in (done.stdout + done.stderr).splitlines() if line.strip()]


def terms(root):
    for page in pages(root):
        fenced = False
        for number, line in enumerate(page.read_text(encoding="utf-8").splitlines(), 1):
            fenced ^= line.startswith("```")
            words = "" if fenced else re.sub(r"`[^`]*`|\]\([^)]*\)|\*[^*]*\*", "", line)
            for other, ours in TERMS.items():
                if found := re.search(rf"\b(?:{other})\b", words):
                    yield f"{page.relative_to(root)}:{number}: {found[0]}: the pages write {ours}"


def faults_that_are_not_found(root):
    with tempfile.TemporaryDirectory() as folder:
        copy = pathlib.Path(folder)
        (copy / "docs").mkdir()
        (copy / "scripts/site").mkdir(parents=True)
        shutil.copy(root / "scripts/site/words.txt", copy / "scripts/site")
        page = copy / "docs/a.md"
        for text, count in (("A reciever of pixels.", 1), ("No backpressure here.", 1), ("Bits are bit exact.", 1),
                            ("An unstalled receiver with back-pressure, `test bench`.", 0)):
            page.write_text(f"# A\n\n{text}\n", encoding="utf-8")
            if len([*spelled(copy), *terms(copy)]) != count:
                yield f"planted fault: {text} gives {[*spelled(copy), *terms(copy)]}"


def main():
    if len(sys.argv) != 2:
        print(__doc__)
        return 2
    if not shutil.which("codespell"):
        print("skipped: no codespell (scripts/install docs)")
        return 0
    root = pathlib.Path(sys.argv[1]).resolve()
    found = [*spelled(root), *terms(root), *faults_that_are_not_found(root)]
    print("\n".join(found))
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
