#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""The promises of docs/reference/stability.md hold as listed in stable.txt: functions and constants of the C
interface, keys of result.json, commands with their options, exit codes. Additions are allowed; nothing may be
removed or changed.

usage: stable_test.py DEBURR HEADER SOURCE [--update]     HEADER: deburr_golden.h as a build makes it
                                                          --update: adds new entries; removes only the keys of an
                                                          older schema of result.json"""
import pathlib
import re
import subprocess
import sys

LIST = "tool/tests/command/stable.txt"
TITLE = """# SPDX-License-Identifier: MIT
# What docs/reference/stability.md promises; made longer by tool/tests/command/stable_test.py --update, and no line of it changed.
"""
COMMENT = re.compile(r"/\*.*?\*/", re.S)
CONSTANT = re.compile(r"\bDEBURR_\w+ = \d+")
FUNCTION = re.compile(r"^[a-z][\w ]*\*? ?deburr_\w+\([^)]*\)(?=;)", re.M)
KEY = re.compile(r"^\| `([^`]+)` \| ([^|]*) \|", re.M)
OPTION = re.compile(r"^  (?:-\w,)?(--[\w-]+)( (?!Excludes:|Needs:)[A-Z]\S*)?", re.M)
EXIT = re.compile(r"\b(\d+) ([^,.]+)[,.]")


def functions(header):
    bare = COMMENT.sub("", header)
    return ["C " + " ".join(found.split()) for found in CONSTANT.findall(bare) + FUNCTION.findall(bare)]


def keys(page):
    """Keys from the page of statistics, of every engine. Files other than result.json are not promised."""
    schema = re.search(r"`result\.json`, schema (\d+)", page)[1]
    table = page.split("\n## Every engine\n")[1].split("\n## ")[0]
    return [f"result.json {schema} {name} [{unit.strip()}]" for name, unit in KEY.findall(table)]


def commands(manual):
    """Commands and options from the manual page."""
    plain = manual.replace("\\-", "-")
    found = []
    parts = re.split(r"^\.SS ", plain, flags=re.M)
    for part in ["deburr\n" + parts[0], *parts[1:]]:
        command, text = part.split("\n", 1)
        found.append(f"command {command}")
        options = text.split("\nOptions:\n", 1)[-1].split("\n\n", 1)[0]
        found += [f"command {command} {name}{' VALUE' if value else ''}" for name, value in OPTION.findall(options)]
    codes = re.search(r"Exit codes: (.*?)\. The last line is RESULT:", plain, re.S)[1]
    return found + [f"exit code {code} {' '.join(meaning.split())}" for code, meaning in EXIT.findall(codes + ".")]


def what_there_is(header, page, manual):
    return functions(header) + keys(page) + commands(manual)


def promised(text):
    return [line for line in text.splitlines() if line and not line.startswith("#")]


def updated(text, there):
    schemas = {line.split()[1] for line in there if line.startswith("result.json")}
    kept = [line for line in promised(text) if not line.startswith("result.json") or line.split()[1] in schemas]
    return TITLE + "\n".join(sorted({*kept, *there})) + "\n"


def injected(header, page, manual):
    """Forbidden changes, each with a word that must then be reported missing."""
    return (("a function is gone", header.replace("int deburr_reset(deburr_golden* golden);", ""), page, manual),
            ("a parameter has another type", header.replace("uint32_t index, char* text", "uint64_t index, char* text"), page, manual),
            ("a constant has another value", header.replace("DEBURR_BUSY = 3", "DEBURR_BUSY = 6"), page, manual),
            ("a key has another unit", header, page.replace("| `cycles` | clk |", "| `cycles` | ns |"), manual),
            ("a key is gone", header, page.replace("| `verdict` |", "| `outcome` |"), manual),
            ("a schema has another number", header, page.replace("`result.json`, schema ", "`result.json`, schema 1"), manual),
            ("an option is gone", header, page, manual.replace("\\-\\-stall\\-seed", "\\-\\-noise\\-seed")),
            ("an option takes a value", header, page, manual.replace("\\-\\-shuffle   ", "\\-\\-shuffle NUMBER   ")),
            ("a command is gone", header, page, manual.replace(".SS deburr regress", ".SS deburr retest")),
            ("an exit code means something else", header, page, manual.replace("4 deadlock", "4 file")))


def main():
    if len(sys.argv) not in (4, 5) or sys.argv[4:] not in ([], ["--update"]):
        print(__doc__)
        return 2
    root = pathlib.Path(sys.argv[3])
    page, manual = (subprocess.run([sys.argv[1], *words], check=True, capture_output=True, text=True).stdout
                    for words in (["params", "--markdown", "statistics"], ["help", "--man"]))
    texts = (pathlib.Path(sys.argv[2]).read_text(encoding="utf-8"), page, manual)
    there = what_there_is(*texts)
    listed = (root / LIST).read_text(encoding="utf-8") if (root / LIST).exists() else ""
    if sys.argv[4:]:
        (root / LIST).write_text(updated(listed, there), encoding="utf-8")
        return 0
    wrong = [f"promised, and not there: {line}" for line in promised(listed) if line not in there]
    if updated(listed, promised(listed)) != listed:
        wrong.append(f"{LIST} is not as --update writes it")
    for kind, least in (("C ", 40), ("result.json ", 60), ("command ", 150), ("exit code ", 7)):
        if sum(line.startswith(kind) for line in promised(listed)) < least:
            wrong.append(f"{LIST} has fewer than {least} lines that begin with '{kind.strip()}'")
    for what, *changed in injected(*texts):
        if tuple(changed) == texts:
            wrong.append(f"nothing to plant a fault in: {what}")
        elif set(promised(listed)) <= set(what_there_is(*changed)):
            wrong.append(f"not noticed: {what}")
    print("\n".join(wrong))
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
