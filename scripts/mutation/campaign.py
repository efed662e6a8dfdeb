# SPDX-License-Identifier: MIT
"""Campaigns over many files: sampling of mutants, their verdicts, and the table of both."""
import collections
import hashlib
import json
import math
import threading

from mutation.check import threads
from mutation.mutants import shown
from mutation.tree import digest

Z = 1.959964  # for a confidence of 95 %


def drawn(mutants, count, each, seed, left=frozenset()):
    """(file, place) of `count` mutants (0: all), without those in `left`, drawn at random over all files, in the
    order of the draw, followed by the extra mutants that bring every file to `each`. The random number of a mutant
    depends only on the mutant and the seed, so a larger sample begins with the smaller one."""
    def number(file, mutant):
        text = f"{seed} {file} {mutant.begin} {mutant.kind} {mutant.text}"
        return hashlib.sha256(text.encode()).digest()

    order = sorted((number(file, mutant), file, place) for file, all_of in mutants.items()
                   for place, mutant in enumerate(all_of) if (file, place) not in left)
    order = [(file, place) for _, file, place in order]
    chosen, rest = (order[:count], order[count:]) if count else (order, [])
    of_file = collections.Counter(file for file, _ in chosen)
    for file, place in rest:
        if of_file[file] < each:
            of_file[file] += 1
            chosen.append((file, place))
    return chosen


def entry_of(tree, file, place):
    """The record of a mutant without its verdict."""
    mutant = tree.mutants[file][place]
    line, before, after = shown(tree.sources[file], mutant)
    return {"file": str(file), "hash": digest(tree.sources[file]), "begin": mutant.begin, "kind": mutant.kind,
            "text": mutant.text, "line": line, "was": before, "is": after}


def key_of(entry):
    return tuple(entry[name] for name in ("file", "hash", "begin", "kind", "text"))


def read_results(work):
    """The entries of work/results.jsonl; the last line may be truncated if a process was killed."""
    path, found = work / "results.jsonl", {}
    for line in path.read_text(encoding="utf-8").splitlines() if path.exists() else ():
        try:
            entry = json.loads(line)
        except ValueError:
            continue
        found[key_of(entry)] = entry
    return found


def check(checker, chosen, jobs, say):
    """The entries of the chosen mutants, all of which have a switch. Mutants with a verdict in work/results.jsonl for
    the same contents of their file are not run again."""
    tree, lock = checker.tree, threading.Lock()
    known = read_results(tree.work)
    entries = [entry_of(tree, *item) for item in chosen]
    wanted = [pair for pair in zip(chosen, entries) if key_of(pair[1]) not in known]
    with (tree.work / "results.jsonl").open("a", encoding="utf-8") as out:
        out.write("\n" if out.tell() else "")

        def checked(number, item, entry):
            entry.update(checker.by_switch(*item)._asdict())
            with lock:
                out.write(json.dumps(entry) + "\n")
                out.flush()
            if number % 200 == 0:
                say(f"{number} of {len(wanted)} mutants")

        with threads(jobs) as pool:
            for future in [pool.submit(checked, number, *pair) for number, pair in enumerate(wanted)]:
                future.result()
    return [known.get(key_of(entry), entry) for entry in entries]


def still_standing(tree, entries):
    """(file, place) of the mutants of another tree whose changed line and change are the same; if several match, the
    one on the nearest line, each once."""
    places = collections.defaultdict(list)
    for file, all_of in tree.mutants.items():
        for place in range(len(all_of)):
            entry = entry_of(tree, file, place)
            places[tuple(entry[name] for name in ("file", "kind", "text", "was", "is"))].append(
                (entry["line"], place, file))
    found = []
    for entry in entries:
        alike = places[tuple(entry[name] for name in ("file", "kind", "text", "was", "is"))]
        if alike:
            nearest = min(alike, key=lambda one: (abs(one[0] - entry["line"]), one))
            alike.remove(nearest)
            found.append((nearest[2], nearest[1]))
    return found


def estimate(strata):
    """From (mutants, killed, checked) of each file: the kill rate of all mutants of these files in tenths of a
    percent, and its interval, rounded outwards. Files are weighted by their mutants, not by the number checked.
    None if none was checked."""
    strata = [(of, killed, judged) for of, killed, judged in strata if judged]
    if not strata:
        return None
    whole = sum(of for of, _, _ in strata)
    rate = sum(of * killed / judged for of, killed, judged in strata) / whole

    def variance(of, killed, judged):
        # One more of each kind, so that a file with all mutants killed also has an interval; not if all were checked.
        likely = (killed + 1) / (judged + 2)
        return likely * (1 - likely) / judged * max(0, 1 - judged / of)

    reach = Z * math.sqrt(sum((of / whole) ** 2 * variance(of, killed, judged) for of, killed, judged in strata))
    # Exact results stay exact despite rounding errors.
    return (math.floor(rate * 1000 + 1e-9), max(0, math.floor((rate - reach) * 1000 + 1e-9)),
            min(1000, math.ceil((rate + reach) * 1000 - 1e-9)))


def table(tree, entries, left):
    """One row per folder; the rate is for all mutants that have a switch and a test."""
    counts = {file: collections.Counter() for file in tree.mutants}
    by_name = {str(file): file for file in counts}
    for entry in entries:
        counts[by_name[entry["file"]]][entry["verdict"]] += 1
    without = collections.Counter(file for file, _ in left)
    folders = collections.defaultdict(list)
    for file in counts:
        folders[str(file.parent)].append(file)
    yield "| folder | mutants | killed | survived | invalid | killed % (95 %) |"
    yield "|---|--:|--:|--:|--:|--:|"
    for name, files in [*sorted(folders.items()), ("all", list(counts))]:
        total = sum((counts[file] for file in files), collections.Counter())
        rate = estimate([(len(tree.mutants[file]) - without[file], counts[file]["killed"],
                          counts[file]["killed"] + counts[file]["survived"]) for file in files])
        text = "{:.1f} ({:.1f} to {:.1f})".format(*(value / 10 for value in rate)) if rate else "-"
        yield (f"| `{name}` | {sum(len(tree.mutants[file]) for file in files)} | {total['killed']} "
               f"| {total['survived']} | {total['invalid']} | {text} |")
