# SPDX-License-Identifier: MIT
"""Finds the test that kills each mutant."""
import collections
import concurrent.futures
import contextlib
import hashlib
import json
import uuid

from mutation.tree import MOST_SWITCHES, Problem, passes

REACHED, NO_SUCH_OPERATOR = 1, 2
Verdict = collections.namedtuple("Verdict", "verdict by")


@contextlib.contextmanager
def threads(jobs):
    """A pool that starts no more jobs after its user gives up (Ctrl-C, a Problem)."""
    pool = concurrent.futures.ThreadPoolExecutor(jobs)
    try:
        yield pool
    finally:
        pool.shutdown(cancel_futures=True)


class Checker:
    """Runs the tests of a tree once without any mutant, then for each mutant the tests that reach it."""

    def __init__(self, tree, budget):
        self.tree, self.budget = tree, budget
        self.kills = collections.defaultdict(collections.Counter)
        self.last = collections.defaultdict(list)

    def baseline(self, say=None):
        """Duration and reached mutants of each test; tests that were measured before are not run again."""
        known, kept = self.tree.work / "baseline.jsonl", {}
        tests = self.tree.tests_here()
        if known.exists():
            for line in known.read_text(encoding="utf-8").splitlines():
                entry = json.loads(line)
                kept[entry["test"]] = entry
        self.tests, self.seconds, self.reach = tests, {}, collections.defaultdict(list)
        self.impossible, failed = set(), []
        programs = {path.name: hashlib.sha256(path.read_bytes()).hexdigest()[:16]
                    for path in self.tree.build.rglob("*")
                    if path.name in self.tree.targets and path.is_file()}
        everything = hashlib.sha256(json.dumps(programs, sort_keys=True).encode()).hexdigest()[:16]

        def built_of(test):
            return programs.get(test.program, everything)

        def measured(test):
            asked = self.tree.work / f"reached_{uuid.uuid4().hex}"
            asked.write_bytes(bytes(MOST_SWITCHES))
            try:
                passed, took, _ = passes(test, test.limit * 4, DEBURR_MUTANTS_REACHED=str(asked))
                answers = asked.read_bytes()
            finally:
                asked.unlink()
            return {"test": test.name, "built": built_of(test), "passed": passed, "seconds": round(took, 4),
                    "reached": spans(n for n, a in enumerate(answers) if a & REACHED),
                    "impossible": spans(n for n, a in enumerate(answers) if a == NO_SUCH_OPERATOR)}

        wanted = [test for test in tests.values()
                  if kept.get(test.name, {}).get("built") != built_of(test)]
        with known.open("a", encoding="utf-8") as out, threads(self.tree.jobs) as pool:
            futures = [pool.submit(measured, test) for test in wanted]
            for number, future in enumerate(concurrent.futures.as_completed(futures)):
                entry = future.result()
                kept[entry["test"]] = entry
                out.write(json.dumps(entry) + "\n")
                out.flush()
                if say and number % 100 == 0:
                    say(f"baseline: {number} of {len(wanted)} tests")
        for name in tests:
            entry = kept[name]
            if not entry["passed"]:
                failed.append(name)
            self.seconds[name] = entry["seconds"]
            for begin, end in entry["reached"]:
                for n in range(begin, end):
                    self.reach[n].append(name)
            self.impossible |= {n for begin, end in entry["impossible"] for n in range(begin, end)}
        self.impossible -= set(self.reach)
        if failed:
            raise Problem("the tests fail without any fault; fix them first: "
                          + ", ".join(failed[:8]))

    def ordered(self, file, names, kind):
        """Order of tests: for a reset first the tests of resets, then the tests that killed the last mutants of the
        file, then the file's own tests, then by duration per kill."""
        stem = file.stem
        kills, last = self.kills[file], self.last[file]

        def order(name):
            source = self.tests[name].source
            return (kind == "reset" and "reset" not in name.lower(),
                    last.index(name) if name in last else 9, not source.endswith(f"_{stem}_test"),
                    self.seconds[name] / (1 + kills[name]), name)

        return sorted(names, key=order)

    def checked_by(self, file, place, names, **environment):
        spent = 0
        for name in self.ordered(file, names, self.tree.mutants[file][place].kind):
            seconds = self.seconds[name]
            if spent and spent + seconds > self.budget:  # the first test runs whatever it takes
                continue
            spent += seconds
            passed, took, _ = passes(self.tests[name], 1 + 10 * seconds, **environment)
            if not passed:
                self.kills[file][name] += 1
                self.last[file] = ([name] + [n for n in self.last[file] if n != name])[:3]
                return Verdict("killed", name)
        return Verdict("survived", "")

    def needs_a_build(self, file, place):
        """Must the mutant be compiled by itself? True if it cannot have a switch, or no test reaches it."""
        number = self.tree.first[file] + place
        return place in self.tree.dropped[file] or number not in self.impossible and number not in self.reach

    def by_switch(self, file, place):
        """The verdict on a mutant behind a switch."""
        number = self.tree.first[file] + place
        if number in self.impossible:
            return Verdict("invalid", "")
        return self.checked_by(file, place, self.reach[number], DEBURR_MUTANT=str(number))

    def alone(self, file, place):
        """The verdict on a mutant compiled without a switch."""
        tree = self.tree
        numbers = range(tree.first[file], tree.first[file] + len(tree.mutants[file]))
        names = {name for number in numbers for name in self.reach.get(number, ())} or set(self.tests)
        tree.put(file, plain=place)
        try:
            # The programs of the file's own tests first: most mutants need no others.
            own = {self.tests[n].program for n in names
                   if self.tests[n].source.endswith(f"_{file.stem}_test")} & set(tree.targets)
            groups = [own] if own else []
            for programs in groups + [set(tree.targets) - own]:
                if not programs:
                    continue
                if tree.run("ninja", "-C", tree.build, "-j", tree.jobs,
                            *sorted(programs)).returncode != 0:
                    return Verdict("invalid", "")
                verdict = self.checked_by(file, place, {n for n in names if (self.tests[n].program in own)
                                                == (programs is own)})
                if verdict.verdict == "killed":
                    return verdict
            return verdict
        finally:
            tree.put(file)


def spans(numbers):
    """Ascending numbers as [begin, end) ranges of consecutive numbers."""
    found = []
    for number in numbers:
        if found and found[-1][1] == number:
            found[-1][1] += 1
        else:
            found.append([number, number + 1])
    return found
