#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Checks that whatever a page below docs/reference calls ignored has a test that puts something else there: each line
with that word is in a list `ignored.txt` below tb/unit, with a test that exists.

usage: ignored_test.py SOURCE"""
import pathlib
import re
import sys
import tempfile

WORD = re.compile(r"\bignor(e[sd]?|ing)\b", re.IGNORECASE)


def entries(source):
    """Page, a part of its line, file and name of the test, of all lists."""
    for path in sorted((source / "tb/unit").rglob("ignored.txt")):
        for line in path.read_text(encoding="utf-8").splitlines():
            if not line.startswith("#"):
                page, text, test = line.split(" :: ")
                yield page, text, *test.split()


def has_test(source, file, test):
    suite, case = test.split(".")
    path = source / "tb/unit" / file
    return path.exists() and re.search(rf"\bTEST(_P|_F)?\({suite},\s+{case}\)", path.read_text(encoding="utf-8"))


def complaints(source):
    """What is in no list, what of a list is no longer there, or there more than once: the second may be of something
    that no test looks at."""
    pages, listed, found, met = source / "docs/reference", list(entries(source)), [], {}
    for page in sorted(pages.rglob("*.md")):
        name = str(page.relative_to(pages))
        for number, line in enumerate(page.read_text(encoding="utf-8").splitlines(), 1):
            if not WORD.search(line):
                continue
            here = {row[:2] for row in listed if row[0] == name and row[1] in line}
            for row in here:
                met.setdefault(row, []).append(number)
            if not here:
                found.append(f"docs/reference/{name}:{number}: no ignored.txt names a test for this: {line.strip()}")
    for name, text in sorted({row[:2] for row in listed}):
        lines = met.get((name, text), [])
        if not lines:
            found.append(f"docs/reference/{name} ignores nothing as '{text}' any more")
        elif len(lines) > 1:
            found.append(f"docs/reference/{name} has '{text}' in lines {', '.join(map(str, lines))}: list more of the "
                         "line that the test is of, and each other one")
    return found + [f"there is no test {test} in tb/unit/{file}" for _, _, file, test in listed
                    if not has_test(source, file, test)]


def planted_mistakes_are_found():
    three, four = "a.md :: bit 3 :: a_test.cpp Bits.Three", "a.md :: bit 4 :: a_test.cpp Bits.Three"
    lists = {f"{three}\n{four}": 0, f"{three}\n{four}\n{three}": 0, three: 1,
             "a.md :: bit :: a_test.cpp Bits.Three": 1, f"{three}\na.md :: bit 5 :: a_test.cpp Bits.Three": 2,
             f"{three}\na.md :: bit 4 :: a_test.cpp Bits.Four\na.md :: bit 4 :: b_test.cpp Bits.Three": 2}
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder)
        for name, text in (("docs/reference/a.md", "bit 3 is ignored\nIgnoring bit 4\nbit 5\n"),
                           ("tb/unit/a_test.cpp", "TEST(Bits, Three) {}\n")):
            (root / name).parent.mkdir(parents=True)
            (root / name).write_text(text, encoding="utf-8")
        for text, count in lists.items():
            (root / "tb/unit/ignored.txt").write_text(f"# a list\n{text}\n", encoding="utf-8")
            if len(complaints(root)) != count:
                return False
    return True


def main():
    if not planted_mistakes_are_found():
        sys.exit("the planted mistakes were not found")
    sys.exit("\n".join(complaints(pathlib.Path(sys.argv[1]))) or None)


if __name__ == "__main__":
    main()
