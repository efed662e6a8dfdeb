#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Checks that every link of the README and of docs/ leads to a file and to a heading in it, that
every page of docs/ is linked from somewhere, and that no template placeholder was left standing."""
import argparse
import pathlib
import re
import sys
import tempfile

LINK = re.compile(r"\]\(([^)#\s]*)(?:#([^)\s]*))?\)")
HEADING = re.compile(r"#+\s+(.*)")
PLACEHOLDER = re.compile(r"@[A-Z_]{3,}@")


def anchors(page):
    """The anchors that GitHub gives the headings of a page."""
    found, in_code = set(), False
    for line in page.read_text(encoding="utf-8").splitlines():
        in_code ^= line.startswith("```")
        heading = HEADING.match(line)
        if heading and not in_code:
            # Repeated headings get a number there, and are no place to link to.
            found.add(re.sub(r"[^\w\- ]", "", heading[1].strip().lower()).replace(" ", "-"))
    return found


def problems(root):
    """Yields 'file:line: what' for every problem below root."""
    pages = [root / "README.md", *sorted((root / "docs").glob("*.md"))]
    linked = set()
    for page in pages:
        for number, line in enumerate(page.read_text(encoding="utf-8").splitlines(), 1):
            where = f"{page.relative_to(root)}:{number}"
            for target, anchor in LINK.findall(line):
                if "://" in target:
                    continue
                path = (page.parent / target).resolve() if target else page.resolve()
                if target:
                    linked.add(path)
                if not path.exists():
                    yield f"{where}: link to {target}, which does not exist"
                elif anchor and anchor not in anchors(path):
                    yield f"{where}: link to {target}#{anchor}, a heading that does not exist"
            if PLACEHOLDER.search(line):
                yield f"{where}: a placeholder was left standing"
    for page in pages[1:]:
        if page.resolve() not in linked:
            yield f"{page.relative_to(root)}:1: no page links to it"


def planted_faults_are_caught():
    """True if a dead link, a dead anchor, an orphan and a placeholder are each found."""
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder)
        (root / "docs").mkdir()
        (root / "README.md").write_text(
            "[a](docs/a.md#a-heading) [b](docs/none.md) [c](docs/a.md#none) [d](#none)\n",
            encoding="utf-8")
        (root / "docs/a.md").write_text("## A `heading`\n@TABLE@\n", encoding="utf-8")
        (root / "docs/orphan.md").write_text("alone\n", encoding="utf-8")
        return len(list(problems(root))) == 5


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
