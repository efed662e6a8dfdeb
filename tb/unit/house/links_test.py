#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Checks the pages in the root and in docs/:

- every link leads to an existing file and heading; every page below docs/ is reachable from docs/index.md, and that
  from README.md;
- no template placeholder is left;
- paths and C++ names set as code, and paths in scripts/, exist in the tree (NAME in a path matches any name);
- pages and quoted headings that source comments name exist;
- pages, CHANGELOG.md and CITATION.cff have the version of CMakeLists.txt."""
import argparse
import functools
import pathlib
import re
import sys
import tempfile

LINK = re.compile(r"\]\(([^)#\s]*)(?:#([^)\s]*))?\)")
HEADING = re.compile(r"#+\s+(.*)")
VERSION = re.compile(r"^project\(deburr VERSION (\d+\.\d+\.\d+) ", re.M)
SAID = re.compile(r"(?:(takes no)|find_package\(deburr|Deburr|\(today) (\d+\.\d+(?:\.\d+)?)")
PLACEHOLDER = re.compile(r"@[A-Z_]{3,}@")
CODE = re.compile(r"`([^`]+)`")
FOLDERS = ("cmake", "docs", "examples", "golden", "hdl", "python", "rtl_model", "scripts", "spec", "studies", "tb", "tool")
PATH = re.compile(rf"(?<![\w./-])((?:{'|'.join(FOLDERS)})/[\w./-]*\w/?|(?:\w+/)+\w+\.(?:h|cpp|py|md))(?![\w/{{])")
# Qualified names, and single names that cannot be ordinary words: CamelCase, kCamelCase.
NAME = re.compile(r"(?<![\w:])(?:[A-Za-z_]\w*::)+\w+|\b[A-Z][a-z]+[A-Z]\w*|\bk[A-Z]\w+")
SOURCES = (".h", ".cpp", ".py", ".cmake", ".txt", ".in")
COMMENT = re.compile(r"(?:^[ \t]*(?://|#)[^\n]*\n)+", re.M)
# A page, optionally followed by a heading in quotes.
NAMED = re.compile(r"(docs/[\w/]+\.md)(?:,? \(?\"([^\"]+)\")?")


def anchor_of(heading):
    return re.sub(r"[^\w\- ]", "", heading.strip().lower()).replace(" ", "-")


def anchors(page):
    """The anchors that GitHub gives the headings of a page."""
    found, in_code = set(), False
    for line in page.read_text(encoding="utf-8").splitlines():
        in_code ^= line.startswith("```")
        heading = HEADING.match(line)
        if heading and not in_code:
            # GitHub numbers repeated headings; links must not use them.
            found.add(anchor_of(heading[1]))
    return found


class Tree:
    """The files and the names of a checkout."""

    def __init__(self, root):
        files = [path for folder in FOLDERS for path in (root / folder).rglob("*")]
        self.ends = {""}  # of every path: "line_bounds.h", "runs/line_bounds.h", ..
        for parts in (path.relative_to(root).parts for path in files):
            self.ends.update("/".join(parts[i:]) for i in range(len(parts)))
        self.ends.update(FOLDERS)
        self.texts = [path.read_text(encoding="utf-8") for path in files if path.suffix in SOURCES]

    def has_path(self, path):
        return "NAME" in path or path.rstrip("/") in self.ends

    @functools.lru_cache(maxsize=None)
    def has_name(self, name):
        """Whether a source contains the name, or declares its scope and contains its last part."""
        if any(name in text and re.search(rf"\b{name}\b", text) for text in self.texts):
            return True
        scope, _, last = name.rpartition("::")
        declared = re.compile(rf"\b(?:class|struct|enum)\s+{scope.rpartition('::')[2]}\b"
                              rf"|\bnamespace\s+(?:\w+::)*{scope}\s*{{")
        return bool(scope) and any(last in text and declared.search(text) and re.search(rf"\b{last}\b", text)
                                   for text in self.texts)


def code_problems(tree, text, where):
    """Paths and names in a piece of code of a page."""
    for path in PATH.findall(text):
        if not tree.has_path(path):
            yield f"{where}: {path} does not exist"
    for name in NAME.findall(PATH.sub("", text)):
        if not tree.has_name(name):
            yield f"{where}: no source has the name {name}"


def script_problems(tree, root):
    scripts = (path for path in (root / "scripts").rglob("*")
               if path.is_file() and path.suffix not in (".pyc", ".h"))
    for script in sorted(scripts):
        for number, line in enumerate(script.read_text(encoding="utf-8").splitlines(), 1):
            for path in PATH.findall(line):
                if not tree.has_path(path):
                    yield f"{script.relative_to(root)}:{number}: {path} does not exist"


def comment_problems(root):
    """Pages and headings named in comments of sources."""
    known = {page.relative_to(root).as_posix(): anchors(page) for page in (root / "docs").rglob("*.md")}
    sources = sorted(path for folder in FOLDERS for path in (root / folder).rglob("*")
                     if path.suffix in (*SOURCES, ".sv") and path.is_file())
    for source in sources:
        text = source.read_text(encoding="utf-8")
        for comment in COMMENT.finditer(text):
            words = re.sub(r"\s*\n[ \t]*(?://|#)?[ \t]*", " ", comment[0])
            where = f"{source.relative_to(root)}:{text.count(chr(10), 0, comment.start()) + 1}"
            for page, heading in NAMED.findall(words):
                if page not in known:
                    yield f"{where}: {page} does not exist"
                elif heading and anchor_of(heading) not in known[page]:
                    yield f"{where}: {page} has no heading '{heading}'"


def version_problems(root, pages):
    """Project versions, complete or their first two numbers; stability.md may name the next one."""
    version = VERSION.search((root / "CMakeLists.txt").read_text(encoding="utf-8"))[1]
    major, minor, _ = version.split(".")
    for page in pages:
        for says_next, said in SAID.findall(page.read_text(encoding="utf-8")):
            if said not in ([f"{major}.{int(minor) + 1}"] if says_next else [version, f"{major}.{minor}"]):
                yield f"{page.relative_to(root)}:1: version {said} where CMakeLists.txt has {version}"
    for file, line in (("CHANGELOG.md", f"## {version}"), ("CITATION.cff", f"version: {version}")):
        first = re.search(rf"^{line.split()[0]} .*", (root / file).read_text(encoding="utf-8"), re.M)
        if not first or first[0] != line:
            yield f"{file}:1: begins with {first and first[0]}, expected {line}"


def unreachable(root, pages, links):
    """`links` holds the targets of each page."""
    index = (root / "docs/index.md").resolve()
    reached, to_see = {index}, [index]
    while to_see:
        found = links.get(to_see.pop(), set()) - reached
        reached |= found
        to_see += found
    for page in pages:
        if page.is_relative_to(root / "docs") and page.resolve() not in reached:
            yield f"{page.relative_to(root)}:1: no links lead to it from docs/index.md"
    if index not in links.get((root / "README.md").resolve(), ()):
        yield "README.md:1: no link to docs/index.md"


def problems(root):
    """Yields 'file:line: what' for every problem below root."""
    tree = Tree(root)
    yield from script_problems(tree, root)
    yield from comment_problems(root)
    # The change log may name removed files.
    pages = [page for page in [*sorted(root.glob("*.md")), *sorted((root / "docs").rglob("*.md"))]
             if page.name != "CHANGELOG.md"]
    yield from version_problems(root, pages)
    links = {}
    for page in pages:
        fenced, linked = False, links.setdefault(page.resolve(), set())
        for number, line in enumerate(page.read_text(encoding="utf-8").splitlines(), 1):
            where = f"{page.relative_to(root)}:{number}"
            fenced ^= line.startswith("```")
            for code in [line] if fenced else CODE.findall(line):
                yield from code_problems(tree, code, where)
            # A lambda in code looks like a link.
            for target, anchor in LINK.findall(CODE.sub("", line)):
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
    yield from unreachable(root, pages, links)


def injected_faults_are_caught():
    """True if exactly the injected faults are found: a dead link, a dead anchor, orphans, a placeholder, missing paths
    and names, wrong versions, and missing pages and headings in comments."""
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder)
        for name in ("docs", "scripts", "spec/engine"):
            (root / name).mkdir(parents=True)
        (root / "README.md").write_text(
            "[a](docs/a.md#a-heading) [b](docs/none.md) [c](docs/a.md#none) [d](#none)\n",
            encoding="utf-8")
        (root / "docs/a.md").write_text(
            "## A `heading`\n@TABLE@\n"
            "`spec/engine/packets.h` `engine/packets.h` `spec/` `spec/NAME/` `a / b` `out/x.json`\n"
            "`spec::engine::PixelBeat` `PixelBeat::count` `kLanes` `std::array` `Plain` `[](int)`\n"
            "`spec/packets.h` `spec::PixelBeat` `engine/none.h` `hdl/none.sv` `PixelBeat::none` `EdgeBeat` `kNone`\n"
            "```\nscripts/none --count 3\n```\n", encoding="utf-8")
        (root / "docs/index.md").write_text("[a](a.md)\n", encoding="utf-8")
        (root / "docs/orphan.md").write_text("Deburr 1.3, Deburr 1.2, takes no 1.3, takes no 1.4: [c](circle.md)\n",
                                             encoding="utf-8")
        (root / "docs/circle.md").write_text("[orphan](orphan.md)\n", encoding="utf-8")
        (root / "CMakeLists.txt").write_text("project(deburr VERSION 1.2.0 LANGUAGES CXX)\n", encoding="utf-8")
        (root / "CHANGELOG.md").write_text("## 1.1.0\n\n## 1.2.0\n", encoding="utf-8")
        (root / "CITATION.cff").write_text("cff-version: 1.2.0\nversion: 1.1.0\n", encoding="utf-8")
        (root / "scripts/test").write_text("# spec/engine/packets.h spec/none.h\n", encoding="utf-8")
        (root / "spec/engine/packets.h").write_text(
            "// docs/a.md, \"A\n// heading\"; docs/a.md. (docs/gone.md)\n"
            "namespace deburr::spec::engine {\nstruct PixelBeat {\n  std::array<int, kLanes> count;\n};\n}\n"
            "// docs/a.md, \"None\"; docs/a.md (\"No\")\nconst auto page = \"docs/away.md\";\n", encoding="utf-8")
        return len(list(problems(root))) == 23


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("root", type=pathlib.Path, help="the checkout")
    root = parser.parse_args().root
    found = list(problems(root))
    for problem in found:
        print(problem)
    caught = injected_faults_are_caught()
    if not caught:
        print("injected faults were not caught")
    sys.exit(0 if caught and not found else 1)


if __name__ == "__main__":
    main()
