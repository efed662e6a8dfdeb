# SPDX-License-Identifier: MIT
"""A copy of the tree in which files hold all their mutants, its build and its tests."""
import collections
import hashlib
import json
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time

from mutation import mutants

LEFT_OUT = {".git", "build", "out", "__pycache__"}
MOST_SWITCHES = 1 << 16  # as in switch.h
# The numbers of a file begin at a multiple of this, with room for growth, so that a changed file does not renumber,
# and so rebuild, all files after it.
STEP, ROOM = 64, 16
HEADER = pathlib.Path("scripts/mutation/switch.h")
# Enough optimisation to make the switches cheap; the tests are built once and run often.
FLAGS = "-std=c++20 -w -Wno-narrowing -O1 -finline-small-functions -findirect-inlining -DNDEBUG"

# `source` is the prefix of the test's name: the test source, in `program`, or the script.
Test = collections.namedtuple("Test", "name source program command folder environment limit")


class Problem(Exception):
    """An error that ends the work; the text is the reason."""


def digest(text):
    return hashlib.sha256(text.encode()).hexdigest()[:16]


def files_of(root):
    return {path.relative_to(root) for path in root.rglob("*")
            if path.is_file() and not LEFT_OUT & set(path.relative_to(root).parts)}


def write(path, data):
    """Copies; equal files keep their time stamp, so that they are not rebuilt."""
    if not path.exists() or path.read_bytes() != data:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(data)


class Tree:
    """`files` are those whose mutants are of interest. Only the programs of the tests that match the regular
    expression `tests` are built."""

    def __init__(self, root, work, files, tests, jobs):
        self.root, self.copy, self.work, self.jobs = root, work / "tree", work, jobs
        self.build = self.copy / "build"
        self.sources = {file: (root / file).read_text(encoding="utf-8") for file in files}
        self.mutants = {file: mutants.mutants_of(text) for file, text in self.sources.items()}
        self.first, number = {}, 0
        for file in files:
            self.first[file] = number
            number = -(-(number + len(self.mutants[file]) + ROOM) // STEP) * STEP
        if number > MOST_SWITCHES:
            raise Problem(f"{number} mutants are more than switch.h supports")
        self.dropped = {file: set() for file in files}
        self.remembered = work / "dropped.json"
        if self.remembered.exists():
            for file, (content, places) in json.loads(self.remembered.read_text()).items():
                path = pathlib.Path(file)
                if path in self.sources and self.numbered(path) == content:
                    self.dropped[path] = set(places)
        self.tests = tests

    def run(self, *command, needed=False):
        done = subprocess.run([str(word) for word in command], capture_output=True, text=True,
                              errors="replace", check=False)
        if needed and done.returncode != 0:
            raise Problem(f"{command[0]} failed\n{done.stdout[-4000:]}\n{done.stderr[-4000:]}")
        return done

    def numbered(self, file):
        """Hash of everything that the indices of a file's mutants depend on: its text, and the list of kinds."""
        return digest(mutants.schema_of(self.sources[file], 0))

    def put(self, file, plain=None):
        """Writes a file with its switches, and the mutant `plain` without a switch."""
        text = mutants.schema_of(self.sources[file], self.first[file], self.dropped[file], plain)
        write(self.copy / file, text.encode())

    def prepare(self):
        """Copies the tree, and builds it without the mutants that do not compile behind a switch."""
        wanted = files_of(self.root)
        for name in wanted - set(self.sources):
            write(self.copy / name, (self.root / name).read_bytes())
            shutil.copymode(self.root / name, self.copy / name)
        for name in files_of(self.copy) - wanted:
            (self.copy / name).unlink()
        here = pathlib.Path(__file__).resolve().parent / HEADER.name
        header = self.work / HEADER.name
        write(header, here.read_bytes())
        for file in self.sources:
            self.put(file)
        self.run("cmake", "-S", self.copy, "-B", self.build, "-G", "Ninja",
                 "-DCMAKE_BUILD_TYPE=None",
                 f"-DCMAKE_CXX_FLAGS={FLAGS} -include {header}",
                 needed=True)
        self.choose()
        while True:
            done = self.run("ninja", "-C", self.build, "-j", self.jobs, "-k", "0", *self.targets)
            if done.returncode == 0:
                break
            if not self.drop(done.stdout):
                failed = done.stdout.partition("FAILED: ")
                raise Problem(f"the tests do not build\n{''.join(failed[1:])[:4000] or done.stdout[-4000:]}")
        self.remembered.write_text(json.dumps({
            str(file): [self.numbered(file), sorted(places)]
            for file, places in self.dropped.items() if places}))

    def drop(self, errors):
        """Removes the switches from lines with compiler errors."""
        # A compiler may name a file by any path that ends in the name.
        ends = {}
        for file in self.sources:
            for place in range(len(file.parts)):
                ends["/".join(file.parts[place:])] = file

        def source_of(path):
            parts = path.split("/")
            return next((ends[end] for end in ("/".join(parts[place:]) for place in
                                               range(len(parts))) if end in ends), None)

        lines = collections.defaultdict(set)
        for text in re.split(r"^FAILED: ", errors, flags=re.M)[1:]:
            for pattern in (r":(\d+):\d+: (?:fatal )?error:", r":(\d+):\d+: +required from",
                            r":(\d+)[:,]"):
                found = {(source_of(path), int(number)) for path, number in
                         re.findall(r"([\w/.+-]+)" + pattern, text) if source_of(path)}
                for file, number in found:
                    lines[file].add(number)
                if found:
                    break
        dropped = 0
        for file, numbers in lines.items():
            new = {place for place, own in enumerate(mutants.lines_of(self.sources[file]))
                   if own & numbers} - self.dropped[file]
            for line in sorted(numbers):
                print(f"no schema: {file}:{line}", file=sys.stderr)
            dropped += len(new)
            self.dropped[file] |= new
            self.put(file)
        return dropped

    def choose(self):
        """The programs to build, and the tests they hold."""
        listed = self.run("ninja", "-C", self.build, "-t", "targets", "all", needed=True).stdout
        programs = set(re.findall(r"^(?:\S*/)?(\w+): CXX_EXECUTABLE_LINKER", listed, re.M))
        # A program is one test with its own name, or holds several (cmake/Tests.cmake).
        self.program_of = {name: name for name in programs}
        held = self.build / "test_programs.txt"
        if held.exists():
            for line in held.read_text(encoding="utf-8").splitlines():
                name, _, program = line.split()
                self.program_of[name] = pathlib.PurePath(program).name
        chosen = {name for name in self.program_of if re.fullmatch(self.tests, name)}
        scripts = [test for test in self.listed()
                   if re.fullmatch(self.tests, test["name"])
                   and test["name"].partition(".")[0] not in self.program_of]
        if not chosen and not scripts:
            raise Problem(f"no test matches {self.tests}: choose with --tests")
        # A script gets the path of the program it runs as an argument or in its environment.
        runs = {path.rpartition("/")[2] for path in
                re.findall(rf"{re.escape(str(self.build))}/[\w/.-]+", json.dumps(scripts))}
        self.targets = sorted({self.program_of[name] for name in chosen} | runs & programs)
        # PROGRAM_complete is the program with the files that it starts and loads.
        self.targets += [name for name in (f"{target}_complete" for target in self.targets)
                         if re.search(rf"^{name}: phony", listed, re.M)]
        self.scripts = {test["name"] for test in scripts}
        self.chosen = chosen

    def listed(self):
        done = self.run("ctest", "--test-dir", self.build, "--show-only=json-v1", needed=True)
        return json.loads(done.stdout)["tests"]

    def tests_here(self):
        """The chosen tests that are built, by name."""
        found = {}
        for test in self.listed():
            source = test["name"].partition(".")[0]
            if "command" not in test or not (test["name"] in self.scripts or source in self.chosen):
                continue
            properties = {p["name"]: p["value"] for p in test.get("properties", [])}
            found[test["name"]] = Test(
                test["name"], source, self.program_of.get(source, source), test["command"],
                properties.get("WORKING_DIRECTORY", str(self.build)),
                dict(word.split("=", 1) for word in properties.get("ENVIRONMENT", [])),
                float(properties.get("TIMEOUT", 1500)))
        return found


def limits(seconds):
    """The beginning of a command that limits its resources, whatever a mutant does. Not a preexec function: that
    would copy this whole process, a fifth of a campaign's time."""
    return ["prlimit", f"--cpu={int(seconds) + 1}:{int(seconds) + 2}", f"--as={6 << 30}", f"--fsize={1 << 28}",
            "--core=0"]


def ended(group):
    try:
        os.killpg(group, signal.SIGKILL)
    except ProcessLookupError:
        pass


def passes(test, cpu, **environment):
    """(passes within `cpu` seconds of processor time, seconds taken)."""
    with tempfile.TemporaryDirectory(prefix="deburr_mutant_") as scratch:
        began = time.monotonic()
        process = subprocess.Popen(
            limits(cpu) + test.command, cwd=test.folder, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL, start_new_session=True,
            env=dict(os.environ, TMPDIR=scratch, **test.environment, **environment))
        # On a busy machine a second of processor time may take many seconds; a sleeping process takes none.
        late = threading.Timer(20 + 10 * cpu, ended, [process.pid])
        late.start()
        try:
            _, status, used = os.wait4(process.pid, 0)
            process.returncode = os.waitstatus_to_exitcode(status)
        finally:
            late.cancel()
            ended(process.pid)
    return process.returncode == 0, used.ru_utime + used.ru_stime, time.monotonic() - began
