#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Checks the names, sources and labels of all tests:

- names are unique and the same in every build: without addresses, raw bytes of values that GoogleTest cannot print,
  and paths of the machine;
- every test source belongs to exactly one program, in its folder, has its own namespace, and names its tests after its
  path: tb/unit/fabric/link_test.cpp is fabric_link_test, tool/tests/run/reset_test.cpp is tool_run_reset_test;
- some test runs every test class of a *_test.py, and every method of a class whose methods are named;
- every test has labels, all of them listed in cmake/Labels.cmake;
- scripts/everything, and so CI, runs every test in exactly one part."""
import argparse
import ast
import collections
import importlib.machinery
import json
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile

sys.dont_write_bytecode = True
SOMETIMES = {"tb/oracle/mesa_test.cpp", "tb/oracle/smaa_shader_test.cpp"}  # if the EGL headers are installed
SOME_BUILDS = ("tb/hdl/", "tool/tests/system/python_")  # with the option DEBURR_HDL; with the Python module
# Labels that scripts/test excludes by default; hdl and formal have their own preset.
LEFT_OUT = "^(long|examples|slurm|fuzz|hdl|formal)$"
UNSTABLE = re.compile(r"(?<![0-9])0x[0-9A-Fa-f]+|-byte object|GetParam\(\)|(?<![\w.])/[a-z]+/")


def labels_of(test):
    return [label for entry in test.get("properties", []) if entry["name"] == "LABELS" for label in entry["value"]]


def takes(command, name, labels):
    """Whether this call of scripts/test runs a test, by ctest's selection rules."""
    words = shlex.split(command)
    rules = {"-L": lambda regex: any(re.search(regex, label) for label in labels),
             "-LE": lambda regex: not any(re.search(regex, label) for label in labels),
             "-R": lambda regex: re.search(regex, name), "-E": lambda regex: not re.search(regex, name)}
    if words == ["scripts/test"]:
        words += ["-LE", LEFT_OUT]
    return words[0] == "scripts/test" and all(
        rules[word](following) for word, following in zip(words, words[1:]) if word in rules)


def not_in_one_part(tests, parts):
    """Yields each test of ctest's list that is not in exactly one of the parts {name: command}. Parts with sanitizers
    or another SystemC repeat unit tests and do not count."""
    for test in tests:
        name, labels = test["name"], labels_of(test)
        found = [part for part, command in parts.items()
                 if not part.startswith(("sanitizers", "systemc3")) and takes(command, name, labels)]
        if len(found) != 1:
            yield f"{name} is in the parts {found} of scripts/everything"


def another_ci(source, parts):
    """Yields the difference if CI does not run the tests and the sanitizers whose turn it is."""
    text = (source / ".ci/run").read_text(encoding="utf-8")
    commands = [line for line in text.splitlines() if line.startswith("scripts/")]
    wanted = [parts["tests"], "scripts/everything sanitizers --turn"]
    if commands != wanted:
        yield f".ci/run runs {commands}, expected {wanted}"


def problems(listed):
    """Yields the errors in these names."""
    names = collections.Counter(listed)
    for name, times in names.items():
        if UNSTABLE.search(name):
            yield f"differs from build to build: {name}"
        if times > 1:
            yield f"there are {times} of: {name}"
    if not names:
        yield "no tests at all"


def test_sources(source, pattern):
    return [path for ring in ("tb", "tool", "studies") for path in sorted((source / ring).rglob(pattern))]


def prefix(folders):
    """The prefix of a test's name, from the folders of its source; for system tests only the layer."""
    if folders[0] == "tb":
        return {"unit": folders[2:], "fuzz": folders[1:]}.get(folders[1], ())
    return folders[:1] if folders[2] == "system" else (folders[0], *folders[2:])


def misnamed(listed, source):
    """Yields the errors in the sources of the test programs, given as (name, file, program)."""
    files = [file for _, file, _ in listed]
    for path in test_sources(source, "*_test.cpp"):
        file = path.relative_to(source).as_posix()
        if files.count(file) != 1 and file not in SOMETIMES and not (
                file.startswith(SOME_BUILDS) and file not in files):
            yield f"{file} is in {files.count(file)} test programs"
    for name, file, program in listed:
        path = pathlib.PurePosixPath(file)
        if name != "_".join([*prefix(path.parent.parts), path.stem]):
            yield f"{file}: the test is named {name}"
        if pathlib.PurePosixPath(program).parent != path.parent:
            yield f"{file} is in {program}"
        if not re.search(rf"^namespace deburr[\w:]*::{path.stem} {{$",
                         (source / file).read_text(encoding="utf-8"), re.M):
            yield f"{file} must use the namespace ...::{path.stem}"


def mislabelled(tests, known):
    """Yields the tests of ctest's list whose labels are missing or unknown."""
    for test in tests:
        labels = labels_of(test)
        if not labels or not known.issuperset(labels):
            yield f"labels of {test['name']}: {', '.join(labels) or 'none'}"


def test_methods(text):
    """{class: names of its tests, including inherited ones} of a Python file."""
    classes = {node.name: node for node in ast.parse(text).body if isinstance(node, ast.ClassDef)}

    def of(name):
        if name not in classes:
            return set()
        inherited = [of(base.id) for base in classes[name].bases if isinstance(base, ast.Name)]
        return {part.name for part in classes[name].body
                if isinstance(part, ast.FunctionDef) and part.name.startswith("test")}.union(*inherited)
    return {name: methods for name in classes if (methods := of(name))}


def unregistered(tests, source):
    """Yields the Python tests that no test of ctest's list runs. A command that names neither class nor method runs
    the whole file."""
    commands = [test.get("command", []) for test in tests]
    for path in test_sources(source, "*_test.py"):
        file = path.relative_to(source).as_posix()
        calls = [command for command in commands if any(word.endswith("/" + file) for word in command)]
        if not calls:
            if not file.startswith(SOME_BUILDS):
                yield f"no test runs {file}"
            continue
        methods = test_methods(path.read_text(encoding="utf-8"))
        named = [[word.partition(".")[::2] for word in command if word.partition(".")[0] in methods]
                 for command in calls]
        if not all(named):
            continue
        named = {pair for call in named for pair in call}
        for name, wanted in methods.items():
            run = {method for of, method in named if of == name}
            if not run:
                yield f"no test runs {name} of {file}"
            elif "" not in run:
                yield from (f"no test runs {name}.{method} of {file}" for method in sorted(wanted - run))


def classes_without_a_test_are_caught():
    text = ("class Support:\n    def helper(self):\n        pass\n"
            "class Faults(Support):\n    def test_one(self):\n        pass\n    def test_two(self):\n        pass\n"
            "class WeightsFaults(Faults):\n    pass\n")
    runs = {"": 0, "Faults WeightsFaults": 0, "Faults": 1, "WeightsFaults": 1, "Faults.test_two WeightsFaults": 1,
            "Faults.test_one Faults.test_two WeightsFaults": 0, None: 1}
    with tempfile.TemporaryDirectory() as folder:
        source = pathlib.Path(folder)
        for file in ("tool/tests/negative/a_test.py", "tb/hdl/b_test.py", "tool/tests/system/python_c_test.py"):
            (source / file).parent.mkdir(parents=True)
            (source / file).write_text(text, encoding="utf-8")
        for words, faults in runs.items():
            script = str(source / "tool/tests/negative/a_test.py")
            one = [{"command": [script, "-v", *words.split()]}] if words is not None else []
            each = [{"command": ["python3", script, word]} for word in (words or "").split()]
            if any(len(list(unregistered(tests, source))) != faults for tests in (one, each or one)):
                return False
    return True


def injected_faults_are_caught():
    labelled = [{"name": name, "properties": [{"name": "LABELS", "value": value}]}
                for name, value in (("a", ["unit"]), ("b", ["long", "unit"]), ("c", ["units"]), ("d", []))]
    if len(list(mislabelled([*labelled, {"name": "e"}], {"unit", "long"}))) != 3:
        return False
    parts = {"tests": "scripts/test -LE '^(unit|long)$'", "a": "scripts/test -L '^unit$' -R '^[ab]'",
             "b": "scripts/test -L '^long$'", "sanitizers": "scripts/test -L '^unit$'", "tidy": "scripts/tidy"}
    if [text.split()[0] for text in not_in_one_part(labelled, parts)] != ["b"]:
        return False
    good = ["a_test.Suite.Name/rgba8", "a_test.Each/Suite.Name/3"]
    bad = ["a_test.Suite.Name/0x55d0", "a_test.Suite/8-byte object <01-00>",
           "Suite/0  # GetParam() = 4", "smoke /tmp/x", "a_test.Suite.Name/rgba8"]
    if list(problems(good)) or not list(problems([])) or any(
            len(list(problems([*good, name]))) != 1 for name in bad):
        return False
    with tempfile.TemporaryDirectory() as folder:
        source = pathlib.Path(folder)
        for file in ("unit/rtl/texture/log2_test.cpp", "oracle/mesa_test.cpp", "system/frame_test.cpp"):
            (source / "tb" / file).parent.mkdir(parents=True)
            stem = pathlib.Path(file).stem
            (source / "tb" / file).write_text(f"namespace deburr::tb::{stem} {{\n", encoding="utf-8")
        log2 = ("rtl_texture_log2_test", "tb/unit/rtl/texture/log2_test.cpp", "tb/unit/rtl/texture/rtl_tests")
        frame = ("frame_test", "tb/system/frame_test.cpp", "tb/system/system_tests")
        faults = ([log2], [log2, log2, frame], [log2, ("system_frame_test", *frame[1:])],
                  [log2, (*frame[:2], "tb/unit/system_tests")])
        if list(misnamed([log2, frame], source)) or any(
                len(list(misnamed(fault, source))) != 1 for fault in faults):
            return False
        (source / log2[1]).write_text("namespace deburr::tb {\n", encoding="utf-8")
        return len(list(misnamed([log2, frame], source))) == 1


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
    programs = [line.split() for line in
                (options.build / "test_programs.txt").read_text(encoding="utf-8").splitlines()]
    labels = re.search(r"set\(DEBURR_LABELS ([^)]*)\)",
                       (options.source / "cmake/Labels.cmake").read_text(encoding="utf-8"))
    everything = importlib.machinery.SourceFileLoader("everything", str(options.source / "scripts/everything"))
    parts = everything.load_module().PARTS
    found = [*problems(test["name"] for test in tests),
             *not_in_one_part(tests, parts), *another_ci(options.source, parts),
             *mislabelled(tests, set(labels[1].split())),
             *unregistered(tests, options.source),
             *misnamed(programs, options.source)]
    for problem in found:
        print(problem)
    caught = injected_faults_are_caught() and classes_without_a_test_are_caught()
    if not caught:
        print("injected faults were not caught")
    sys.exit(0 if caught and not found else 1)


if __name__ == "__main__":
    main()
