#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Checks that every C++ file is formatted according to .clang-format, and that lines of README.md, CHANGELOG.md
and docs/ have at most 120 columns outside tables and code blocks."""
import argparse
import pathlib
import shutil
import subprocess
import sys
import tempfile

COLUMNS = 120
# Generated pages are not wrapped.
GENERATED = {"datasheets.md", "parameters.md", "registers.md", "statistics.md"}


def wide_lines(root):
    """Yields 'file:line: what' for every line of prose below root that is too wide."""
    pages = [page for page in [*sorted(root.glob("*.md")), *sorted((root / "docs").rglob("*.md"))]
             if page.name not in GENERATED]
    for page in pages:
        in_code = False
        for number, line in enumerate(page.read_text(encoding="utf-8").splitlines(), 1):
            text = line.lstrip()
            if text.startswith("```"):
                in_code = not in_code
            elif len(line) > COLUMNS and not in_code and not text.startswith("|"):
                yield f"{page.relative_to(root)}:{number}: {len(line)} columns, {COLUMNS} at most"


def injected_lines_are_caught():
    """True if exactly the wide prose is found, not tables, code or generated pages."""
    wide = "x" * (COLUMNS + 1)
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder)
        (root / "docs").mkdir()
        (root / "README.md").write_text(f"{wide}\n{wide[1:]}\n", encoding="utf-8")
        (root / "docs/a.md").write_text(f"```\n{wide}\n```\n| {wide} |\n* {wide}\n",
                                        encoding="utf-8")
        for name in GENERATED:
            (root / "docs" / name).write_text(f"{wide}\n", encoding="utf-8")
        return [found.rsplit(":", 1)[0] for found in wide_lines(root)] == ["README.md:1",
                                                                           "docs/a.md:5"]


def check_pages(root):
    if not injected_lines_are_caught():
        sys.exit("the injected wide lines were not caught")
    found = list(wide_lines(root))
    if found:
        sys.exit("\n".join(found))


def check_code(root):
    formatter = shutil.which("clang-format")
    if not formatter:
        print("skipped: clang-format is not installed")
        return
    check = [formatter, "--dry-run", "-Werror", f"--style=file:{root / '.clang-format'}"]
    injected = subprocess.run(check, input="int  x ;\n", capture_output=True, text=True, check=False)
    if injected.returncode == 0:
        sys.exit("the injected fault was not caught")
    files = [str(path) for layer in ("spec", "golden", "rtl_model", "tb", "tool", "studies", "examples")
             for path in sorted((root / layer).rglob("*")) if path.suffix in {".h", ".cpp"}]
    sys.exit(subprocess.run([*check, *files], check=False).returncode)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("root", type=pathlib.Path, help="the checkout")
    root = parser.parse_args().root
    check_pages(root)
    check_code(root)


if __name__ == "__main__":
    main()
