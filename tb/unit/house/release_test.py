#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""The version is said once, by project() of CMakeLists.txt: the change log begins with it, and what has to
repeat it for readers elsewhere (CITATION.cff, SECURITY.md, pages) says the same. CITATION.cff is of the Citation
File Format 1.2.0, as far as it goes here.

usage: release_test.py SOURCE"""
import pathlib
import re
import shutil
import sys
import tempfile

import yaml

VERSION = re.compile(r"^project\(deburr VERSION (\d+\.\d+\.\d+) ", re.M)
# What in a page is a version of ours, whole or its first two numbers.
SAID = re.compile(r"(?:find_package\(deburr|Deburr|\(today|takes no) (\d+\.\d+(?:\.\d+)?)")
NEXT = re.compile(r"takes no (\d+\.\d+)")
REQUIRED = {"cff-version": str, "message": str, "title": str, "authors": list}
OPTIONAL = {"abstract": str, "type": str, "version": str, "license": str, "keywords": list, "doi": str,
            "repository-code": str, "url": str, "date-released": object, "references": list}
AUTHOR = {"name", "family-names", "given-names", "orcid", "affiliation", "website"}


def citation_problems(text, version):
    try:
        cited = yaml.safe_load(text)
    except yaml.YAMLError as error:
        return [f"CITATION.cff is no YAML: {error}"]
    if not isinstance(cited, dict):
        return ["CITATION.cff is no mapping"]
    found = [f"CITATION.cff has no {key}" for key in REQUIRED if not cited.get(key)]
    known = REQUIRED | OPTIONAL
    found += [f"CITATION.cff: {key} is unknown to the format" for key in cited if key not in known]
    found += [f"CITATION.cff: {key} is of another type" for key, value in cited.items() if not isinstance(value, known.get(key, object))]
    found += [f"CITATION.cff: author {author}" for author in cited.get("authors") or []
              if not isinstance(author, dict) or not author or not AUTHOR.issuperset(author)]
    for key, wanted in (("cff-version", "1.2.0"), ("version", version), ("license", "MIT"), ("type", "software")):
        if cited.get(key) != wanted:
            found.append(f"CITATION.cff: {key} is {cited.get(key)}, expected {wanted}")
    return found


def problems(root):
    match = VERSION.search((root / "CMakeLists.txt").read_text(encoding="utf-8"))
    if not match:
        return ["CMakeLists.txt does not say the version"]
    version = match[1]
    major, minor, _ = version.split(".")
    found = citation_problems((root / "CITATION.cff").read_text(encoding="utf-8"), version)
    first = re.search(r"^## (.*)$", (root / "CHANGELOG.md").read_text(encoding="utf-8"), re.M)
    if not first or first[1] != version:
        found.append(f"CHANGELOG.md begins with {first and first[1]}, expected {version}")
    for page in (root / "SECURITY.md", *sorted((root / "docs").rglob("*.md"))):
        text = page.read_text(encoding="utf-8")
        if page.name == "stability.md" and NEXT.findall(text) != [f"{major}.{int(minor) + 1}"]:
            found.append("docs/reference/stability.md does not say the version that is not taken")
        found += [f"{page.relative_to(root)}: version {said}, expected {version}" for said in SAID.findall(NEXT.sub("", text))
                  if said not in (version, f"{major}.{minor}")]
    said = [page for page in ("SECURITY.md", "docs/howto/use_in_my_platform.md", "docs/howto/testbench.md",
                              "docs/reference/stability.md") if not SAID.search((root / page).read_text(encoding="utf-8"))]
    return found + [f"{page} says no version" for page in said]


# What each must be found of: file, a piece of it, and another in its place.
FAULTS = (("CMakeLists.txt", " VERSION 0.", " VERSION 10."), ("CITATION.cff", "version: 0.", "version: 10."),
          ("CITATION.cff", "cff-version: 1.2.0", "cff-version: 1.1.0"), ("CITATION.cff", "authors:", "writers:"),
          ("CITATION.cff", "  - name:", "  - called:"), ("CITATION.cff", "message: If", "message: [If"),
          ("CITATION.cff", "keywords:", "keywords: none\nwords:"), ("CITATION.cff", "type: software", "type: program"),
          ("CHANGELOG.md", "## 0.", "## next, 0."), ("SECURITY.md", "today 0.", "today 10."),
          ("docs/howto/use_in_my_platform.md", "find_package(deburr 0.", "find_package(deburr 10."),
          ("docs/howto/testbench.md", "Deburr 0.", "Deburr 10."), ("docs/reference/stability.md", "takes no 0.", "takes no 10."))


def faults_that_are_not_found(root):
    for file, piece, other in FAULTS:
        with tempfile.TemporaryDirectory() as folder:
            copy = pathlib.Path(folder)
            for name in ("CMakeLists.txt", "CITATION.cff", "CHANGELOG.md", "SECURITY.md", "docs/howto/use_in_my_platform.md",
                         "docs/howto/testbench.md", "docs/reference/stability.md"):
                (copy / name).parent.mkdir(parents=True, exist_ok=True)
                shutil.copy(root / name, copy / name)
            text = (copy / file).read_text(encoding="utf-8")
            (copy / file).write_text(text.replace(piece, other, 1), encoding="utf-8")
            if piece not in text or not problems(copy):
                yield f"planted fault not found: {file}: {other}"


def main():
    if len(sys.argv) != 2:
        print(__doc__)
        return 2
    root = pathlib.Path(sys.argv[1])
    found = problems(root)
    if not found:
        found = list(faults_that_are_not_found(root))
    print("\n".join(found))
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
