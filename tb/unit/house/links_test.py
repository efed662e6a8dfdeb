#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Checks that every link of the README and of docs/ leads to a file, that every page of docs/ is
linked from somewhere, and that no template placeholder was left standing."""
import argparse
import pathlib
import re
import sys
import tempfile

LINK = re.compile(r"\]\(([^)#\s]+)(#[^)]*)?\)")
PLACEHOLDER = re.compile(r"@[A-Z_]{3,}@")


def problems(root):
    """Yields 'file:line: what' for every problem below root."""
    pages = [root / "README.md", *sorted((root / "docs").glob("*.md"))]
    linked = set()
    for page in pages:
        for number, line in enumerate(page.read_text(encoding="utf-8").splitlines(), 1):
            where = f"{page.relative_to(root)}:{number}"
            for target in LINK.findall(line):
                if "://" in target[0]:
                    continue
                path = (page.parent / target[0]).resolve()
                linked.add(path)
                if not path.exists():
                    yield f"{where}: link to {target[0]}, which does not exist"
            if PLACEHOLDER.search(line):
                yield f"{where}: a placeholder was left standing"
    for page in pages[1:]:
        if page.resolve() not in linked:
            yield f"{page.relative_to(root)}:1: no page links to it"


def planted_faults_are_caught():
    """True if a dead link, an orphan and a placeholder are each found."""
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder)
        (root / "docs").mkdir()
        (root / "README.md").write_text("[a](docs/a.md) [b](docs/none.md)\n", encoding="utf-8")
        (root / "docs/a.md").write_text("@TABLE@\n", encoding="utf-8")
        (root / "docs/orphan.md").write_text("alone\n", encoding="utf-8")
        return len(list(problems(root))) == 3


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("root", type=pathlib.Path, help="the checkout")
    root = parser.parse_args().root
    found = list(problems(root))
    for problem in found:
        print(problem)
    caught = planted_faults_are_caught()
    if not caught:
        print("planted faults were not caught")
    sys.exit(0 if caught and not found else 1)


if __name__ == "__main__":
    main()
