# SPDX-License-Identifier: MIT
"""The record of a campaign, the explanations of its survivors, and the page of both."""
import collections
import json
import math
import pathlib
import subprocess
import textwrap

from mutation import mutants
from mutation.tree import digest

RECORD = pathlib.Path("tb/mutation/record.json")
SURVIVORS = pathlib.Path("tb/mutation/survivors.json")
PAGE = pathlib.Path("docs/measurements/mutation.md")
VERDICTS = ("killed", "survived", "invalid")
GOAL = 95
EACH = 40  # verdicts that a file must have, or all of its mutants
Z = 1.959964  # of a confidence of 95 %
HEAD = ("Made by `scripts/mutate --report` from `tb/mutation/record.json`, campaigns{at}, and "
        "`tb/mutation/survivors.json`; do not edit. What a mutant is: [how](../reference/tests.md#mutants), "
        "[why](../explanation/verification.md#mutants).")


def record_of(results, sources, commit=""):
    """What a campaign found at a commit, a file at a time; results on other contents of a file do not count."""
    record = {}
    for file, source in sources.items():
        content = digest(source)
        all_of = mutants.mutants_of(source)
        known = {(m.begin, m.kind, m.text) for m in all_of}
        own = [r for r in results if r["file"] == str(file) and r["hash"] == content
               and (r["begin"], r["kind"], r["text"]) in known]
        counts = collections.Counter(r["verdict"] for r in own)
        judged = [r for r in own if r["verdict"] in VERDICTS]
        budgets = [r["budget"] for r in judged if "budget" in r]
        of_kind = collections.Counter(m.kind for m in all_of)
        verdicts = collections.Counter((r["kind"], r["verdict"]) for r in own)
        record[str(file)] = {
            **({"commit": commit} if commit and judged else {}),
            **({"budget": max(budgets)} if budgets else {}), "hash": content, "mutants": len(known),
            "alone": sum(r["way"] == "alone" for r in own),
            "left": counts["left"], "killed": counts["killed"], "invalid": counts["invalid"],
            "kinds": {kind: [of_kind[kind]] + [verdicts[kind, verdict] for verdict in VERDICTS]
                      for kind in mutants.KINDS if of_kind[kind]},
            "survived": sorted([r["was"], r["is"]] for r in own if r["verdict"] == "survived")}
    return record


def joined(old, new):
    """The new record, with what the old one knows of the files that the new one has no verdict on, or fewer
    than that, and than a file must have, on the same contents."""
    def better(entry, before):
        least = min(tried(before), needed(before)) if before["hash"] == entry["hash"] else 1
        return tried(entry) >= least if tried(before) else entry["left"] >= before.get("left", 0)

    return {file: entry if better(entry, old.get(file, entry)) else old[file] for file, entry in new.items()}


def read(path):
    return json.loads(path.read_text(encoding="utf-8")) if path.exists() else {}


def read_record(root):
    return read(root / RECORD)


def commit_of(root):
    done = subprocess.run(["git", "-C", root, "rev-parse", "HEAD"], capture_output=True, text=True, check=False)
    return done.stdout.strip()[:12]


def write_record(root, record):
    (root / RECORD).parent.mkdir(parents=True, exist_ok=True)
    rows = [f"{json.dumps(file)}: {json.dumps(entry)}" for file, entry in sorted(record.items())]
    (root / RECORD).write_text("{\n" + ",\n".join(rows) + "\n}\n", encoding="utf-8")


def commits_of(record):
    """What the page says of when the files of a record were checked."""
    counts = collections.Counter(entry["commit"] for entry in record.values() if "commit" in entry)
    texts = [f"`{commit}` ({files} files)" for commit, files in counts.most_common()]
    return " at " + ", ".join(texts) if texts else ""


def folder_of(file):
    return str(pathlib.PurePath(file).parent)


def checked(record, explained):
    """A row a folder: counts, and of the survivors those that are explained."""
    rows = collections.defaultdict(collections.Counter)
    for file, entry in record.items():
        row = rows[folder_of(file)]
        row["files"] += 1
        row["mutants"] += entry["mutants"]
        for name in ("killed", "invalid", "alone", "left"):
            row[name] += entry.get(name, 0)
        for was, becomes in entry["survived"]:
            row["explained" if (file, was, becomes) in explained else "survived"] += 1
    return dict(sorted(rows.items()))


def strata_of(record, explained=()):
    """By folder, (mutants that could be checked, killed, checked but those that are explained) of each file."""
    strata = collections.defaultdict(list)
    for file, entry in record.items():
        survived = sum((file, was, becomes) not in explained for was, becomes in entry["survived"])
        strata[folder_of(file)].append(
            (entry["mutants"] - entry.get("left", 0), entry["killed"], entry["killed"] + survived))
    return {**strata, "all": sum(strata.values(), [])}


def explanations(root):
    entries = read(root / SURVIVORS) or []
    return {(e["file"], e["was"], e["is"]): e["reason"] for e in entries}


def estimate(strata):
    """Of (mutants, killed, checked) of each file: the rate of all mutants of these files in tenths of a
    percent, and its interval, rounded away from it. Files count by their mutants, not by how many of
    them were checked. None if nothing was."""
    strata = [(of, killed, judged) for of, killed, judged in strata if judged]
    if not strata:
        return None
    whole = sum(of for of, _, _ in strata)
    rate = sum(of * killed / judged for of, killed, judged in strata) / whole

    def variance(of, killed, judged):
        # One more of each kind, so that a file of which all were killed has one too; none where all were checked.
        likely = (killed + 1) / (judged + 2)
        return likely * (1 - likely) / judged * max(0, 1 - judged / of)

    reach = Z * math.sqrt(sum((of / whole) ** 2 * variance(of, killed, judged) for of, killed, judged in strata))
    # What is whole stays so, whatever the arithmetic leaves behind the point.
    return (math.floor(rate * 1000 + 1e-9), max(0, math.floor((rate - reach) * 1000 + 1e-9)),
            min(1000, math.ceil((rate + reach) * 1000 - 1e-9)))


def percent(strata):
    """A rate and its interval; the rate is rounded down, so that nothing looks whole that is not."""
    found = estimate(strata)
    return "{:.1f} ({:.1f} to {:.1f})".format(*(value / 10 for value in found)) if found else "-"


def run_of(row):
    return row["killed"] + row["explained"] + row["survived"]


def goal_of(strata):
    """The folders by whether those of their mutants that have a verdict reach the goal."""
    lists = {"reached": [], "missed": []}
    found = {name: estimate(files) for name, files in sorted(strata.items()) if name != "all"}
    for name, (rate, _, _) in ((name, each) for name, each in found.items() if each):
        lists["missed" if rate < GOAL * 10 else "reached"].append(f"`{name}`")
    return " ".join(f"It is {how} by {'every folder' if len(names) == len(found) > 1 else ', '.join(names)}."
                    for how, names in lists.items() if names)


def kinds_of(record):
    """The table by kinds, of the files whose record knows them."""
    files = {kind: [] for kind in mutants.KINDS}
    for entry in record.values():
        for kind, counts in entry.get("kinds", {}).items():
            files[kind].append(counts)
    lines = ["| kind | mutants | with verdict | not compiled | killed | killed % |",
             "|---|---|---|---|---|---|"]
    for kind, counts in files.items():
        if counts:
            all_of, killed, survived, invalid = map(sum, zip(*counts))
            strata = [(of, killed, killed + survived) for of, killed, survived, _ in counts]
            lines.append(f"| {kind} | {all_of} | {killed + survived} | {invalid} | {killed} | {percent(strata)} |")
    return "\n".join(lines) + "\n\n" if len(lines) > 2 else ""


def page_of(root, record):
    explained = explanations(root)
    rows = checked(record, explained)
    total = sum(rows.values(), collections.Counter())
    strata, unexplained = strata_of(record), strata_of(record, explained)
    lines = ["| folder | files | mutants | with verdict | not compiled | killed | survived: explained "
             "| survived: open | killed % | of those not explained % |",
             "|---|---|---|---|---|---|---|---|---|---|"]
    for name, row in [*rows.items(), ("all", total)]:
        lines.append(
            f"| `{name}` | {row['files']} | {row['mutants']} | {run_of(row)} | {row['invalid']} "
            f"| {row['killed']} | {row['explained']} | {row['survived']} "
            f"| {percent(strata[name])} | {percent(unexplained[name])} |")
    old = [file for file, entry in record.items() if "kinds" not in entry]
    done = run_of(total) + total["invalid"]
    text = "# Mutants of both models\n\n" + wrapped(HEAD.format(at=commits_of(record))) + "\n\n" + wrapped(
        f"Of {total['mutants']} mutants {run_of(total)} have a verdict ({total['killed']} killed, {total['explained']} "
        f"survived and explained, {total['survived']} survived and open): {percent(strata['all'])} % killed, and "
        f"{percent(unexplained['all'])} % of those that are not explained, where {GOAL} % are the goal. "
        + goal_of(unexplained) + " Tests were written for what had survived, so this says less of other mutants than "
        "[a draw for which none were](tests.md#held-out-mutants).") + "\n\n"
    budgets = sorted({entry["budget"] for entry in record.values() if "budget" in entry})
    if budgets:
        text += wrapped(f"Tests of at most {' or '.join(f'{budget:g}' for budget in budgets)} seconds a mutant were run "
                        f"for {sum('budget' in entry for entry in record.values())} of the files"
                        + (": some of the open survivors would be killed by longer ones." if total["survived"] else ".")
                        ) + "\n\n"
    text += wrapped("Rates are of all mutants of the folder that a switch can plant and a test of the campaign runs: each "
                    "file counts by how many it has, not by how many of them were checked. In brackets: with a confidence "
                    f"of 95 %, if those with a verdict were drawn at random, which they were a file at a time ({EACH} of "
                    "each, or all), but for what is explained, which is asked drawn or not.") + "\n\n"
    text += "\n".join(lines) + "\n\n"
    text += wrapped(
        f"{total['invalid']} mutants did not compile and count nowhere; {total['alone']} were compiled alone. "
        f"{total['mutants'] - done} were not tried: {total['left']} of them would need a build each, and no rate has "
        "them in it: most are worked out by the compiler, such as sizes of arrays, and the rest no test of the campaign runs "
        "(few [lines](tests.md#lines)). "
        "The others were not drawn.") + "\n\n"
    if old:
        text += wrapped(
            f"The record of {len(old)} of {len(record)} files is older than the kinds "
            + ", ".join(mutants.KINDS[mutants.KINDS.index("shift"):]) + ", and its mutants were not drawn at random: "
            "the table has none of these kinds, and intervals say too much where whole files were left out.") + "\n\n"
    text += kinds_of(record)
    none = [f"`{file}`" for file, entry in record.items() if entry["mutants"] and not needed(entry)]
    if none:
        text += wrapped(f"Files without a verdict, since each of their mutants needs a build, or no test runs it: "
                        f"{', '.join(none)}.") + "\n\n"
    few = with_few(record)
    if few:
        text += wrapped(f"{len(few)} files have fewer than {EACH} verdicts, and mutants that a switch can plant "
                        "(`scripts/mutate --check` names them).") + "\n\n"
    text += wrapped(f"`tb/mutation/survivors.json` has {len(explained)} explanations, by file, line and reason: the program "
                    "does the same, or the difference is in no contract.") + "\n\n"
    text += "## Open survivors\n\n"
    text += wrapped("Gaps in the tests, or not explained yet." if total["survived"] else "None.") + "\n\n"
    for file, entry in sorted(record.items()):
        open_ones = [(was, becomes) for was, becomes in entry["survived"]
                     if (file, was, becomes) not in explained]
        for (was, becomes), times in sorted(collections.Counter(open_ones).items()):
            text += (f"* `{file}`: `{becomes}` (was `{was}`)"
                     + (f", {times} times" if times > 1 else "") + "\n")
    return text


def tried(entry):
    return entry["killed"] + entry["invalid"] + len(entry["survived"])


def needed(entry):
    return min(EACH, entry["mutants"] - entry.get("left", 0))


def with_few(record):
    """Files of the record with fewer verdicts than a file must have."""
    return sorted(file for file, entry in record.items() if tried(entry) < needed(entry))


def untried(root, record, files):
    """What is wrong with the files of today, which may be newer than the record: too few verdicts."""
    found = {file: (tried(record[file]), record[file]["mutants"], needed(record[file]))
             for file in with_few(record) if (root / file).exists()}
    for file in map(str, files):
        if file not in record:
            number = len(mutants.mutants_of((root / file).read_text(encoding="utf-8")))
            found.update({file: (0, number, min(EACH, number))} if number else {})
    return [f"{file}: {of} of {number} mutants have a verdict, a file needs {least}: scripts/mutate --all --count 1 "
            f"--each {EACH} --switched --files '{file}' --work ../mutants"
            for file, (of, number, least) in sorted(found.items())]


def wrapped(text):
    return textwrap.fill(text, 120, break_long_words=False, break_on_hyphens=False)


def stands_in(source, statement):
    """Whether it is a line of it, or several."""
    return statement in (source if "\n" in statement else {line.strip() for line in source.splitlines()})


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
        elif not path.exists() or not stands_in(path.read_text(encoding="utf-8"), was):
            found.append(f"{file}: `{becomes}` is explained, but its line is gone: `{was}`")
    return found


def changed_since(root, record):
    """Files that are not those that the record is of."""
    return sorted(file for file, entry in record.items()
                  if not (root / file).exists()
                  or digest((root / file).read_text(encoding="utf-8")) != entry["hash"])
