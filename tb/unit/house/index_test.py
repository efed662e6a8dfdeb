#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Checks the way into the pages: docs/index.md names every page once and is found from the README; each of its
questions leads to a section that has an answer with a command that the program takes; the glossary's terms are
explained where it says; new pages keep to its words and to their size.

usage: index_test.py SOURCE [DEBURR]"""
import os
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile

LINK = re.compile(r"(?<!!)\[([^\]]+)\]\(([^)#\s]*)(?:#([^)\s]*))?\)")
NEW = ("index.md", "tutorial", "howto", "explanation")
QUESTIONS = 10
LINES, CELL = 300, 200
# What a command of a page names and its reader has; scenes stand for them here.
OF_THE_READER = re.compile(r"--(in|texture|truth|mask|depth) \S+\.\w+")


def anchor(heading):
    return re.sub(r"[^\w\- ]", "", heading.strip().lower()).replace(" ", "-")


def sections(page):
    """The lines below each heading of a page, by its anchor."""
    found, lines, fenced = {}, [], False
    for line in page.read_text(encoding="utf-8").splitlines():
        fenced ^= line.startswith("```")
        if line.startswith("#") and not fenced:
            lines = found.setdefault(anchor(line.lstrip("#")), [])
        else:
            lines.append(line)
    return found


def commands(lines):
    """Those of `deburr` in code blocks, joined where a line goes on."""
    fenced, text = False, []
    for line in lines:
        if line.startswith("```"):
            fenced = not fenced
        elif fenced:
            text.append(line)
    for line in "\n".join(text).replace("\\\n", " ").splitlines():
        for part in line.split("#")[0].split("&&"):
            if part.strip().startswith("deburr run "):
                yield part.strip()


def sweeps(lines):
    """The files of sweeps that are printed in code blocks."""
    return [block for block in re.findall(r"```yaml\n(.*?)```", "\n".join(lines), re.DOTALL) if "axes:" in block]


def pages_of(docs):
    return {path.relative_to(docs).as_posix() for path in docs.rglob("*.md")} - {"index.md"}


def links_of(text):
    return [(title, target, name) for title, target, name in LINK.findall(re.sub(r"\s*\n\s*", " ", text))
            if "://" not in target]


def index_problems(root):
    docs = root / "docs"
    index = docs / "index.md"
    if "docs/index.md" not in {target for _, target, _ in links_of((root / "README.md").read_text(encoding="utf-8"))}:
        yield "README.md: no link to docs/index.md"
    targets = {os.path.normpath(target) for _, target, _ in links_of(index.read_text(encoding="utf-8")) if target}
    for page in sorted(pages_of(docs) - targets):
        yield f"docs/index.md: no link to {page}"
    for target in sorted(targets):
        if not (docs / target).exists():
            yield f"docs/index.md: {target} does not exist"


def question_problems(root, run):
    """`run` gets the words of a command, and the text of sweep.yaml, and gives its exit code and what it said."""
    docs = root / "docs"
    asked = [links_of(item) for item in
             re.split(r"\n(?=\d+\. )", "\n".join(sections(docs / "index.md").get("questions", [])))]
    asked = [links[0] for links in asked if links]
    if len(asked) != QUESTIONS:
        yield f"docs/index.md: {len(asked)} questions, not {QUESTIONS}"
    for title, target, name in asked:
        where = f"docs/index.md: '{title}'"
        lines = sections(docs / target).get(name) if (docs / target).is_file() else None
        if lines is None:
            yield f"{where}: no section {target}#{name}"
            continue
        found = list(commands(lines))
        if not found:
            yield f"{where}: {target}#{name} has no `deburr run`"
        for command in found:
            words = shlex.split(OF_THE_READER.sub("", command))
            code, said = run([*words[1:], *([] if "--show-config" in words else ["--show-config"])])
            if code:
                yield f"{where}: {command}: {said.strip().splitlines()[-1] if said.strip() else code}"
        for sweep in sweeps(lines):
            code, said = run(["sweep", "sweep.yaml", "plan"], sweep)
            if code:
                yield f"{where}: its sweep: {said.strip().splitlines()[-1] if said.strip() else code}"


def not_used(docs):
    table = sections(docs / "explanation/glossary.md").get("words-that-are-not-used", [])
    rows = [[cell.strip() for cell in line.strip("|").split("|")] for line in table if line.startswith("|")]
    return {word.strip(): row[1] for row in rows[2:] for word in row[0].split(",")}


def glossary_problems(docs):
    glossary = docs / "explanation/glossary.md"
    terms = 0
    for name, lines in sections(glossary).items():
        if name == "words-that-are-not-used":
            continue
        for line in lines:
            cells = [cell.strip() for cell in line.strip("|").split("|")]
            if not line.startswith("|") or cells[0] in ("term", "---"):
                continue
            terms += 1
            links = links_of(cells[-1])
            if len(cells) != 3 or len(links) != 1 or not cells[1].endswith("."):
                yield f"glossary: {cells[0]}: not a term, a sentence and a link"
                continue
            _, target, heading = links[0]
            page = (glossary.parent / target).resolve()
            if not page.is_file() or heading and heading not in sections(page):
                yield f"glossary: {cells[0]}: {target}#{heading} does not exist"
    if terms < 50:
        yield f"glossary: {terms} terms"
    if len(not_used(docs)) < 10:
        yield "glossary: the table of words that are not used is not there"


def page_problems(docs):
    words = {word: (re.compile(rf"(?<![\w-]){re.escape(word)}(?![\w-])", re.IGNORECASE), but)
             for word, but in not_used(docs).items()}
    for path in sorted(path for name in NEW for path in [docs / name, *(docs / name).rglob("*.md")] if path.is_file()):
        where = path.relative_to(docs)
        text = path.read_text(encoding="utf-8")
        if path.name == "glossary.md":
            text = text.partition("## Words that are not used")[0]
        fenced = False
        for number, line in enumerate(text.splitlines(), 1):
            fenced ^= line.startswith("```")
            if not fenced and line.startswith("|") and max(map(len, line.strip("|").split("|"))) > CELL:
                yield f"{where}:{number}: a cell of more than {CELL} characters"
            # What programs print, and names that are set as code, are as they are.
            plain = "" if fenced else re.sub(r"`[^`]*`|\]\([^)]*\)", "", line)
            for word, (pattern, but) in words.items():
                if pattern.search(plain):
                    yield f"{where}:{number}: '{word}' is not used: {but}"
        if text.count("\n") > LINES:
            yield f"{where}: more than {LINES} lines"
        if path.parent.name in ("howto", "tutorial") and not re.match(r"# .*\n\n```\n(deburr|scripts/|cmake|ctest|build/)", text):
            yield f"{where}: does not begin with a command"


def problems(root, run):
    docs = root / "docs"
    yield from index_problems(root)
    yield from question_problems(root, run)
    yield from glossary_problems(docs)
    yield from page_problems(docs)


def planted():
    """What is wrong on purpose, in a tree of its own, and a part of what must be said of it."""
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder)
        for name in ("howto", "tutorial", "explanation"):
            (root / "docs" / name).mkdir(parents=True)
        (root / "README.md").write_text("nothing\n", encoding="utf-8")
        (root / "docs/alone.md").write_text("# Alone\n", encoding="utf-8")
        (root / "docs/index.md").write_text(
            "# Pages\n\n## Questions\n\n1. [a](howto/a.md#none)\n2. [b](howto/a.md#no-command)\n3. [c](howto/a.md#odd)\n\n"
            "## Rest\n\n[gone](gone.md) [words](explanation/glossary.md)\n", encoding="utf-8")
        (root / "docs/howto/a.md").write_text(
            "# A\n\nWe judge it.\n\n## No command\n\n```\nscripts/demo\n```\n\n## Odd\n\n```\ndeburr run \\\n  odd\n```\n```yaml\naxes: odd\n```\n"
            f"\n| {'x' * 201} |\n" + "\n" * LINES, encoding="utf-8")
        (root / "docs/explanation/glossary.md").write_text(
            "# Words\n\n| term | means | defined in |\n|---|---|---|\n| lost | Gone. | [a](../howto/a.md#none) |\n| short | Gone |\n\n"
            "## Words that are not used\n\n| not | but |\n|---|---|\n| judge, refuse | check |\n", encoding="utf-8")
        found = list(problems(root, lambda words, sweep="": (2, "RESULT: odd") if "odd" in [*words, sweep.strip()[6:9]] else (0, "")))
    expected = ("README.md: no link", "no link to alone.md", "gone.md does not exist", "3 questions", "'a': no section",
                "'b': howto/a.md#no-command has no", "'c': deburr run    odd: RESULT: odd", "'c': its sweep: RESULT: odd", "glossary: lost", "glossary: short",
                "glossary: 2 terms", "not used is not there", "howto/a.md:3: 'judge'", "a cell of more", "more than 300 lines",
                "does not begin with a command")
    return [text for text in expected if sum(text in problem for problem in found) != 1] + \
           [f"unexpected: {problem}" for problem in found if not any(text in problem for text in expected)]


def main():
    root = pathlib.Path(sys.argv[1]).resolve()
    missed = planted()
    if missed:
        sys.exit("planted faults: " + "; ".join(missed))

    def run(words, sweep=""):
        if len(sys.argv) < 3:
            return 0, ""
        with tempfile.TemporaryDirectory() as folder:
            (pathlib.Path(folder) / "sweep.yaml").write_text(sweep, encoding="utf-8")
            done = subprocess.run([sys.argv[2], *words], cwd=folder, capture_output=True, text=True, check=False)
        return done.returncode, done.stdout + done.stderr

    found = list(problems(root, run))
    for problem in found:
        print(problem)
    sys.exit(1 if found else 0)


if __name__ == "__main__":
    main()
