#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Checks that the names of all tests are the same on every build: no address, no bytes of a value that
GoogleTest could not print, no path of the machine, and none twice."""
import argparse
import collections
import re
import subprocess
import sys

LISTED = re.compile(r"^\s*Test\s+#\d+: (.*)$", re.M)
UNSTABLE = re.compile(r"(?<![0-9])0x[0-9A-Fa-f]+|-byte object|GetParam\(\)|(?<![\w.])/[a-z]+/")


def problems(listing):
    """Yields what is wrong with each name of a list as `ctest -N` prints it."""
    names = collections.Counter(LISTED.findall(listing))
    for name, times in names.items():
        if UNSTABLE.search(name):
            yield f"differs from build to build: {name}"
        if times > 1:
            yield f"there are {times} of: {name}"
    if not names:
        yield "no tests at all"


def planted_faults_are_caught():
    good = "  Test   #1: a_test.Suite.Name/rgba8\n  Test #22: a_test.Each/Suite.Name/3\n"
    bad = ["a_test.Suite.Name/0x55d0", "a_test.Suite/8-byte object <01-00>",
           "Suite/0  # GetParam() = 4", "smoke /tmp/x", "a_test.Suite.Name/rgba8"]
    return not list(problems(good)) and list(problems("")) and all(
        len(list(problems(f"{good}  Test #3: {name}\n"))) == 1 for name in bad)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("ctest", help="the ctest command")
    parser.add_argument("build", help="the build folder")
    options = parser.parse_args()
    listing = subprocess.run([options.ctest, "--test-dir", options.build, "-N"], capture_output=True,
                             text=True, check=False)
    if listing.returncode != 0:
        sys.exit(f"ctest does not list its tests:\n{listing.stderr}")
    found = list(problems(listing.stdout))
    for problem in found:
        print(problem)
    caught = planted_faults_are_caught()
    if not caught:
        print("planted faults were not caught")
    sys.exit(0 if caught and not found else 1)


if __name__ == "__main__":
    main()
