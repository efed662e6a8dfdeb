#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Writes the ctest entries of a test program, one per TEST or, with --suites, one per suite, named after the source
that contains it (deburr_test in Tests.cmake). With --suites, tests labelled `timing` or `long` get their own
entry. Errors: a source without tests, a test without a source, two tests with one name, a disabled test, and a
regular expression of TIMING or LONG that matches no test.
usage: discover_tests.py LIST PROGRAM OUTPUT [--suites]"""
import collections
import json
import pathlib
import re
import subprocess
import sys
import tempfile


LONGEST = 600  # seconds of a suite, unless one of its tests may take longer


def listed(program):
    """(name, source file) of each test that the program has."""
    with tempfile.NamedTemporaryFile(suffix=".json") as out:
        subprocess.run([program, "--gtest_list_tests", f"--gtest_output=json:{out.name}"], check=True,
                       stdout=subprocess.DEVNULL, timeout=60)
        suites = json.loads(pathlib.Path(out.name).read_text(encoding="utf-8"))["testsuites"]
    return [(f"{suite['name']}.{test['name']}", test["file"]) for suite in suites
            for test in suite["testsuite"]]


def entries(sources, tests):
    """(entry of ctest, name in the program, what the list says of its source, labels) of each test,
    and what is wrong."""
    found, wrong = [], []
    for name, times in collections.Counter(name for name, _ in tests).items():
        if times > 1:
            files = ", ".join(sorted(file for other, file in tests if other == name))
            wrong.append(f"{times} tests are called {name}: {files}")
        if "DISABLED_" in name:
            wrong.append(f"{name} would not run")
    # A compiler may name a source by any path that ends so.
    known = {name: next((s for s in sources if f"/{file}".endswith("/" + s["source"])), None)
             for name, file in tests}
    wrong += [f"{name} is in no source of the list" for name, source in known.items() if not source]
    for source in sources:
        own = [name for name in known if known[name] is source]
        if not own:
            wrong.append(f"{source['source']} has no tests")
        labels = {name: list(source["labels"]) for name in own}
        for label in ("timing", "long"):
            for regex in source[label]:
                matching = [name for name in own if re.match(f"(.*/)?{regex}", name)]
                if not matching:
                    wrong.append(f"{source['source']} has no test '{regex}' for the label {label}")
                for name in matching:
                    labels[name] += [label] if label not in labels[name] else []
        found += [(f"{source['name']}.{name}", name, source, labels[name]) for name in own]
    return found, wrong


def entries_of_tests(found):
    return [(entry, [name], source, labels) for entry, name, source, labels in found]


def entries_of_suites(found):
    """Tests with labels in addition to those of their source get their own entry."""
    together = {}
    for entry, name, source, labels in found:
        more = [label for label in labels if label not in source["labels"]]
        suite = ".".join([entry.rpartition(".")[0], *more])
        together.setdefault(suite, (suite, [], source, labels))[1].append(name)
    return together.values()


def main():
    listing, program, output = map(pathlib.Path, sys.argv[1:4])
    one_each = sys.argv[4:] != ["--suites"]
    found, wrong = entries(json.loads(listing.read_text(encoding="utf-8")), listed(program))
    output.unlink(missing_ok=True)
    if wrong:
        sys.exit("\n".join(f"{program.name}: {text}" for text in wrong))
    text = ""
    for entry, names, source, labels in entries_of_tests(found) if one_each else entries_of_suites(found):
        seconds = min(source["timeout"] * len(names), max(source["timeout"], LONGEST))
        text += (f"add_test([=[{entry}]=] [=[{program}]=] [=[--gtest_filter={':'.join(names)}]=])\n"
                 f"set_tests_properties([=[{entry}]=] PROPERTIES TIMEOUT {seconds} "
                 f"WORKING_DIRECTORY [=[{program.parent}]=] LABELS \"{';'.join(labels)}\")\n")
    output.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
