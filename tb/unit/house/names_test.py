#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Checks that the names of all tests are the same on every build: no address, no bytes of a value that
GoogleTest could not print, no path of the machine, and none twice; that every program of tb/unit is
named as the path of its source: tb/unit/fabric/link_test.cpp is fabric_link_test; and that every test has
labels, of those that cmake/Labels.cmake lists."""
import argparse
import collections
import json
import pathlib
import re
import subprocess
import sys
import tempfile

UNSTABLE = re.compile(r"(?<![0-9])0x[0-9A-Fa-f]+|-byte object|GetParam\(\)|(?<![\w.])/[a-z]+/")


def problems(listed):
    """Yields what is wrong with each of these names."""
    names = collections.Counter(listed)
    for name, times in names.items():
        if UNSTABLE.search(name):
            yield f"differs from build to build: {name}"
        if times > 1:
            yield f"there are {times} of: {name}"
    if not names:
        yield "no tests at all"


def misnamed(programs, built, source):
    """Yields what is wrong with each program below `built`, whose sources are below `source`."""
    for program in sorted(set(programs)):
        if built in program.parents:
            folder = program.parent.relative_to(built)
            stem = program.name.removeprefix("_".join(folder.parts) + "_")
            if stem == program.name or not (source / folder / f"{stem}.cpp").exists():
                yield f"not named as the path of its source: {folder / program.name}"


def mislabelled(tests, known):
    """Yields what is wrong with the labels of each of these tests of ctest's listing."""
    for test in tests:
        labels = [label for entry in test.get("properties", []) if entry["name"] == "LABELS"
                  for label in entry["value"]]
        if not labels or not known.issuperset(labels):
            yield f"labels of {test['name']}: {', '.join(labels) or 'none'}"


def planted_faults_are_caught():
    labelled = [{"name": name, "properties": [{"name": "LABELS", "value": value}]}
                for name, value in (("a", ["unit"]), ("b", ["long", "unit"]), ("c", ["units"]), ("d", []))]
    if len(list(mislabelled([*labelled, {"name": "e"}], {"unit", "long"}))) != 3:
        return False
    good = ["a_test.Suite.Name/rgba8", "a_test.Each/Suite.Name/3"]
    bad = ["a_test.Suite.Name/0x55d0", "a_test.Suite/8-byte object <01-00>",
           "Suite/0  # GetParam() = 4", "smoke /tmp/x", "a_test.Suite.Name/rgba8"]
    if list(problems(good)) or not list(problems([])) or any(
            len(list(problems([*good, name]))) != 1 for name in bad):
        return False
    with tempfile.TemporaryDirectory() as folder:
        source, built = pathlib.Path(folder), pathlib.Path("/build/tb/unit")
        (source / "rtl/texture").mkdir(parents=True)
        (source / "rtl/texture/log2_test.cpp").touch()
        named = [built / "rtl/texture/rtl_texture_log2_test", pathlib.Path("/build/deburr")]
        return not list(misnamed(named, built, source)) and all(
            len(list(misnamed([built / name], built, source))) == 1
            for name in ("rtl/texture/log2_test", "rtl/texture/rtl_texture_log2",
                         "rtl/texture/rtl_texture_none_test", "rtl/rtl_log2_test"))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("ctest", help="the ctest command")
    parser.add_argument("build", type=pathlib.Path, help="the build folder")
    parser.add_argument("source", type=pathlib.Path, help="the checkout")
    options = parser.parse_args()
    listing = subprocess.run([options.ctest, "--test-dir", options.build, "--show-only=json-v1"],
                             capture_output=True, text=True, check=False)
    if listing.returncode != 0:
        sys.exit(f"ctest does not list its tests:\n{listing.stderr}")
    tests = json.loads(listing.stdout)["tests"]
    programs = [pathlib.Path(test["command"][0]) for test in tests if "command" in test]
    labels = re.search(r"set\(DEBURR_LABELS ([^)]*)\)",
                       (options.source / "cmake/Labels.cmake").read_text(encoding="utf-8"))
    found = [*problems(test["name"] for test in tests),
             *mislabelled(tests, set(labels[1].split())),
             *misnamed(programs, options.build / "tb/unit", options.source / "tb/unit")]
    for problem in found:
        print(problem)
    caught = planted_faults_are_caught()
    if not caught:
        print("planted faults were not caught")
    sys.exit(0 if caught and not found else 1)


if __name__ == "__main__":
    main()
