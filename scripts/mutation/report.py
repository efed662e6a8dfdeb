# SPDX-License-Identifier: MIT
"""The record of a campaign, the explanations of its survivors, and the page of both."""
import collections
import json
import pathlib

from mutation import mutants
from mutation.tree import digest

RECORD = pathlib.Path("tb/mutation/record.json")
SURVIVORS = pathlib.Path("tb/mutation/survivors.json")
PAGE = pathlib.Path("docs/mutation.md")
GOAL = 95
HEAD = """# Mutants of both models

What the tests do not see: `scripts/mutate --all` plants every small fault that it knows (a flipped comparison, `+` for
`-`, `&&` for `||`, an off-by-one constant, a stall that never holds) in `golden/` and `rtl_model/`, one at a time, and
runs the tests that reach it until one fails ([verification](verification.md#mutants)). `scripts/mutate --report` makes
this page from `tb/mutation/record.json`, the result of the last campaign, and `tb/mutation/survivors.json`, which says
of a survivor why no test could see it.

"""


def record_of(results, sources):
    """What a campaign found, a file at a time; results on other contents of a file do not count."""
    record = {}
    for file, source in sources.items():
        content = digest(source)
        known = {(m.begin, m.kind, m.text) for m in mutants.mutants_of(source)}
        own = [r for r in results if r["file"] == str(file) and r["hash"] == content
               and (r["begin"], r["kind"], r["text"]) in known]
        counts = collections.Counter(r["verdict"] for r in own)
        record[str(file)] = {
            "hash": content, "mutants": len(known),
            "alone": sum(r["way"] == "alone" for r in own),
            "killed": counts["killed"], "invalid": counts["invalid"],
            "survived": sorted([r["was"], r["is"]] for r in own if r["verdict"] == "survived")}
    return record


def read(path):
    return json.loads(path.read_text(encoding="utf-8")) if path.exists() else {}


def write_record(root, record):
    (root / RECORD).parent.mkdir(parents=True, exist_ok=True)
    rows = [f"{json.dumps(file)}: {json.dumps(entry)}" for file, entry in sorted(record.items())]
    (root / RECORD).write_text("{\n" + ",\n".join(rows) + "\n}\n", encoding="utf-8")


def folder_of(file):
    return str(pathlib.PurePath(file).parent)


def judged(record, explained):
    """A row a folder: counts, and of the survivors those that are explained."""
    rows = collections.defaultdict(collections.Counter)
    for file, entry in record.items():
        row = rows[folder_of(file)]
        row["files"] += 1
        row["mutants"] += entry["mutants"]
        for name in ("killed", "invalid", "alone"):
            row[name] += entry[name]
        for was, becomes in entry["survived"]:
            row["explained" if (file, was, becomes) in explained else "survived"] += 1
    return dict(sorted(rows.items()))


def explanations(root):
    entries = read(root / SURVIVORS) or []
    return {(e["file"], e["was"], e["is"]): e["reason"] for e in entries}


def percent(part, whole):
    # Rounded down, so that nothing looks whole that is not.
    return f"{part * 1000 // whole / 10:.1f}" if whole else "-"


def page_of(root, record):
    explained = explanations(root)
    rows = judged(record, explained)
    total = sum(rows.values(), collections.Counter())
    lines = ["| folder | files | mutants | judged | not compiled | killed | survived: explained "
             "| survived: open | killed % | of those not explained % |",
             "|---|---|---|---|---|---|---|---|---|---|"]
    for name, row in [*rows.items(), ("all", total)]:
        run = row["killed"] + row["explained"] + row["survived"]
        lines.append(
            f"| `{name}` | {row['files']} | {row['mutants']} | {run} | {row['invalid']} "
            f"| {row['killed']} | {row['explained']} | {row['survived']} "
            f"| {percent(row['killed'], run)} "
            f"| {percent(row['killed'], row['killed'] + row['survived'])} |")
    run = total["killed"] + total["explained"] + total["survived"] + total["invalid"]
    below = [name for name, row in rows.items() if row["killed"] * 100 < GOAL * (
        row["killed"] + row["survived"])]
    text = HEAD + "\n".join(lines) + "\n\n"
    text += wrapped(
        f"Of {total['mutants']} mutants {run} were tried, {total['alone']} of them compiled alone; "
        f"{total['mutants'] - run} were not, since the campaign was ended before them, or since they "
        "wait to be compiled alone: what the compiler works out costs a build each. `not compiled` "
        "are no programs, and count nowhere. The goal "
        f"is {GOAL} % of those that are not explained; "
        + ("every folder reaches it." if not below else
           "below it: " + ", ".join(f"`{name}`" for name in below) + ".")) + "\n"
    text += "\n## Survivors that are explained\n\n"
    text += wrapped("Nobody can see these: the program does the same, or what it does otherwise is "
                    "not part of any contract.") + "\n\n"
    for (file, was, becomes), reason in sorted(explained.items()):
        text += f"* `{file}`: `{becomes}` (was `{was}`): {reason}\n"
    text += "\n## Open survivors\n\n"
    text += wrapped("Each is a gap in the tests, or waits for its explanation.") + "\n\n"
    for file, entry in sorted(record.items()):
        open_ones = [(was, becomes) for was, becomes in entry["survived"]
                     if (file, was, becomes) not in explained]
        for (was, becomes), times in sorted(collections.Counter(open_ones).items()):
            text += (f"* `{file}`: `{becomes}` (was `{was}`)"
                     + (f", {times} times" if times > 1 else "") + "\n")
    return text


def wrapped(text):
    import textwrap
    return textwrap.fill(text, 120, break_long_words=False, break_on_hyphens=False)


def complaints(root, record):
    """What is wrong with the explanations: each must be of a survivor that still is one."""
    survived = {(file, was, becomes) for file, entry in record.items()
                for was, becomes in entry["survived"]}
    found = []
    for (file, was, becomes), reason in explanations(root).items():
        path = root / file
        if not reason.strip():
            found.append(f"{file}: `{becomes}` is explained by nothing")
        if (file, was, becomes) not in survived:
            found.append(f"{file}: `{becomes}` is explained, but is killed or was not tried")
        elif not path.exists() or was not in {
                line.strip() for line in path.read_text(encoding="utf-8").splitlines()}:
            found.append(f"{file}: `{becomes}` is explained, but its line is gone: `{was}`")
    return found


def changed_since(root, record):
    """Files that are not those that the record is of."""
    return sorted(file for file, entry in record.items()
                  if not (root / file).exists()
                  or digest((root / file).read_text(encoding="utf-8")) != entry["hash"])
