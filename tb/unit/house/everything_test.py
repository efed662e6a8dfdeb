#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""scripts/everything with parts that only say that they ran: it goes on when one fails, resumes, takes
turns, ends with Ctrl-C, and writes the page that it demands; and of the real parts, that every test of
ctest is in one. usage: everything_test.py CTEST BUILD SOURCE [unittest options]"""
import importlib.machinery
import json
import os
import pathlib
import re
import shlex
import shutil
import signal
import subprocess
import sys
import time
import unittest

sys.dont_write_bytecode = True
from tiny_tree import tiny_tree  # noqa: E402

CTEST, BUILD, SOURCE = sys.argv.pop(1), pathlib.Path(sys.argv.pop(1)), pathlib.Path(sys.argv.pop(1)).resolve()
SCRIPT = SOURCE / "scripts/everything"
sys.path.insert(0, str(SOURCE / "tb/engines"))
from engine_list import engines  # noqa: E402
PARTS = importlib.machinery.SourceFileLoader("everything", str(SCRIPT)).load_module().PARTS

# Ctrl-C must reach what is started here, also where this is run in the background of a shell.
signal.signal(signal.SIGINT, signal.default_int_handler)

# Writes down how it was called, and a record of ctest with a test that passes, one that is skipped and,
# where `fail` has this command, one that fails.
STUB = """#!/bin/sh
cd "$(dirname "$0")/.."
called="$(basename "$0") $*"
echo "$called" >>calls
preset=release
case "$*" in *asan*) preset=asan ;; *wait*) sleep 60 ;; esac
mkdir -p build/$preset
failed=
grep -qsxF "$called" fail && failed='<testcase name="c" status="fail"/>'
echo '<testsuite><testcase name="a" status="run"/><testcase name="b" status="notrun"/>'"$failed"'</testsuite>' \
  >build/$preset/tests.xml
case "$called" in
  stand_alone*) echo 'stand_alone: 12 of 48 files checked' ;;
  tidy*) echo 'tidy: 3 of 345 files looked at, 0 findings, 1 s' ;;
esac
[ -z "$failed" ]
"""
COMMANDS = [" ".join(shlex.split(command)).removeprefix("scripts/") for command in PARTS.values()]


class Everything(unittest.TestCase):
    def setUp(self):
        names = {shlex.split(command)[0] for command in PARTS.values()}
        self.root = tiny_tree(self, {name: STUB for name in names} |
                              {f"rtl_model/{engine}/CMakeLists.txt": "" for engine in engines()
                               if (SOURCE / "rtl_model" / engine).exists()} |
                              {".gitignore": "calls\nfail\n/build/\n", "docs/index.md": ""})
        for name in names:
            (self.root / name).chmod(0o755)
        shutil.copy(SCRIPT, self.root / "scripts")
        shutil.copytree(SOURCE / "tb/engines", self.root / "tb/engines",
                        ignore=lambda folder, names: [n for n in names if not n.startswith("engine")])
        self.git("init", "-q")
        self.commit()

    def git(self, *arguments):
        subprocess.run(["git", "-c", "user.name=a", "-c", "user.email=a", *arguments], cwd=self.root,
                       check=True, capture_output=True)

    def commit(self):
        self.git("add", "-A")
        self.git("commit", "-q", "--allow-empty", "-m", "a")

    def call(self, *arguments):
        """Exit code, what was said, and the parts that ran."""
        calls = self.root / "calls"
        calls.write_text("", encoding="utf-8")
        done = subprocess.run([self.root / "scripts/everything", *arguments], capture_output=True, text=True,
                              check=False)
        return done.returncode, done.stdout + done.stderr, calls.read_text(encoding="utf-8").splitlines()

    def page(self):
        return (self.root / "docs/measurements/full_run.md").read_text(encoding="utf-8")

    def fail(self, name):
        (self.root / "fail").write_text(COMMANDS[list(PARTS).index(name)] + "\n", encoding="utf-8")

    def test_a_record_of_another_part_is_not_counted(self):
        self.call("slurm")
        (self.root / "scripts/test").write_text("#!/bin/sh\n", encoding="utf-8")
        self.commit()
        self.assertRegex(self.call("slurm")[1], r"(?m)^slurm +passed +- +- +- ")

    def test_goes_on_after_a_failure_and_repeats_only_what_has_not_passed(self):
        self.fail("slurm")
        code, said, calls = self.call()
        self.assertEqual((code, calls), (1, COMMANDS), said)
        self.assertRegex(said, r"(?m)^slurm +FAILED +3 +1 +1 +\d+ +\d+ +20\S+ `\w{12}` +never$")
        self.assertRegex(said, r"(?m)^sanitizers +passed +2 +0 +1 +\d+ +\d+ +20\d\d-")
        self.assertRegex(said, r"(?m)^alone-1 +passed +12 +- ")
        self.assertRegex(said, r"(?m)^tidy +passed +345 +0 ")
        self.assertRegex(self.page(), r"(?m)^\| `slurm` \| `.*` \| FAILED \| 3 \| 1 \| 1 \| "
                                      r"\d+ \| \d+ \| 20\S+ `\w{12}` \| never \|$")
        self.assertIn(f"{len(PARTS)} of {len(PARTS)} parts ran, 1 did not pass; commits: 1;", self.page())
        (self.root / "fail").unlink()
        self.assertEqual(self.call()[::2], (0, [COMMANDS[list(PARTS).index("slurm")]]))
        self.assertEqual(self.call()[::2], (0, []))
        self.assertIn("0 did not pass", self.page())
        self.assertEqual(self.call("tidy", "slurm")[::2],
                         (0, [COMMANDS[list(PARTS).index(name)] for name in ("tidy", "slurm")]))

    def test_another_commit_is_another_run_and_a_page_keeps_when_a_part_passed(self):
        self.call("slurm")
        first = subprocess.run(["git", "rev-parse", "HEAD"], cwd=self.root, capture_output=True, text=True,
                               check=True).stdout.strip()
        self.assertFalse((self.root / "docs/measurements/full_run.md").exists(), "not every part has run")
        self.assertEqual(self.call("--page")[0], 0)
        self.commit()
        self.assertEqual(self.call("tidy")[::2], (0, [COMMANDS[list(PARTS).index("tidy")]]))
        self.assertEqual(self.call("--page")[0], 0)
        self.assertIn(f"2 of {len(PARTS)} parts ran, 0 did not pass; commits: 2;", self.page())
        self.assertRegex(self.page(), rf"(?m)^\| `slurm` .* passed .*`{first[:12]}` \| .*`{first[:12]}` \|$")
        self.assertRegex(self.page(), r"(?m)^\| `tidy` .* passed ")
        self.assertEqual(self.call("--check")[0], 0)
        self.commit()
        self.fail("slurm")
        self.assertEqual(self.call()[::2], (1, COMMANDS), "what passed at another commit runs again")
        self.assertRegex(self.page(), rf"(?m)^\| `slurm` .* FAILED .*`{first[:12]}` \|$")
        self.assertEqual(self.page().count(first[:12]), 1)
        self.assertIn(f"`{first[:12]}`", self.call("--list")[1])

    def test_a_part_of_another_command_has_not_run(self):
        self.call("slurm", "tidy")
        self.assertEqual(self.call("--page")[0], 0)
        page = self.root / "docs/measurements/full_run.md"
        page.write_text(self.page().replace("-L '^slurm$'", "-L slurm"), encoding="utf-8")
        self.commit()
        self.assertEqual(self.call("--page")[0], 0)
        self.assertRegex(self.page(), r"(?m)^\| `slurm` \| `scripts/test -L '\^slurm\$'` \| - .*\| never \|$")
        self.assertRegex(self.page(), r"(?m)^\| `tidy` .* passed ")

    def test_a_tree_with_changes_leaves_no_record(self):
        (self.root / "docs/index.md").write_text("changed", encoding="utf-8")
        self.assertEqual(self.call("slurm")[0], 0)
        self.assertEqual(self.call("--page")[0], 2)
        self.assertEqual(self.call()[::2], (0, COMMANDS))
        self.assertFalse((self.root / "docs/measurements/full_run.md").exists())

    def test_what_is_skipped_as_a_whole_has_not_passed(self):
        stub = self.root / "scripts/test"
        stub.write_text(STUB.replace('status="run"', 'status="notrun"'), encoding="utf-8")
        self.commit()
        code, said, _ = self.call("slurm")
        self.assertEqual(code, 1)
        self.assertRegex(said, r"(?m)^slurm +skipped +2 +0 +2 .* never$")

    def test_the_page_is_checked(self):
        self.assertEqual(self.call("--check")[0], 1, "there is none")
        self.call("--page")
        self.assertEqual(self.call("--check")[0], 0)
        page = self.page()
        row = next(line for line in page.splitlines() if line.startswith("| `slurm`"))
        for planted in (page.replace(row + "\n", ""), page.replace("slurm", "slumr"), page + "more\n",
                        page.replace(row, row.replace("| - ", "", 1)), page.replace("0 of", "1 of")):
            self.assertNotEqual(planted, page)
            (self.root / "docs/measurements/full_run.md").write_text(planted, encoding="utf-8")
            self.assertEqual(self.call("--check")[0], 1)

    def test_each_part_has_its_turn(self):
        turns = []
        for _ in COMMANDS[2:]:
            self.commit()
            code, said, calls = self.call("--turn")
            self.assertEqual(code, 0)
            self.assertIn("last passed: never", said)
            turns += calls
        self.assertEqual(sorted(turns), sorted(COMMANDS[2:]))
        self.assertEqual(self.call("--turn")[2], turns[-1:], "the same at the same commit")
        self.fail("slurm")
        slurm = COMMANDS[list(PARTS).index("slurm")]
        for _ in range(turns.index(slurm) + 1):  # they come round in the same order
            self.commit()
        self.assertEqual(self.call("--turn")[::2], (1, [slurm]))

    def test_ctrl_c_ends_a_part_with_all_that_it_started(self):
        (self.root / "scripts/test").write_text(STUB.replace("*asan*", "*odd*").replace("*wait*", "*asan*"),
                                                encoding="utf-8")
        self.commit()
        for number in (signal.SIGINT, signal.SIGTERM):
            (self.root / "calls").write_text("", encoding="utf-8")
            with subprocess.Popen([self.root / "scripts/everything"], stdout=subprocess.PIPE, text=True) as process:
                deadline = time.monotonic() + 60
                while "asan" not in (self.root / "calls").read_text() and time.monotonic() < deadline:
                    time.sleep(0.05)
                os.kill(process.pid, number)
                said = process.communicate(timeout=20)[0]
            self.assertEqual(process.returncode, 130)
            self.assertRegex(said, r"(?m)^tests +passed")
            self.assertRegex(said, r"(?m)^sanitizers +- ")
            self.assertEqual(len((self.root / "calls").read_text().splitlines()), 2 if number == signal.SIGINT else 1)


class Parts(unittest.TestCase):
    @staticmethod
    def listed():
        """Name and labels of every test."""
        listing = subprocess.run([CTEST, "--test-dir", BUILD, "--show-only=json-v1"], capture_output=True,
                                 text=True, check=True).stdout
        for test in json.loads(listing)["tests"]:
            yield test["name"], [label for entry in test["properties"] if entry["name"] == "LABELS"
                                 for label in entry["value"]]

    @staticmethod
    def takes(command, name, labels):
        """As ctest chooses."""
        words = shlex.split(command)
        rules = {"-L": lambda regex: any(re.search(regex, label) for label in labels),
                 "-LE": lambda regex: not any(re.search(regex, label) for label in labels),
                 "-R": lambda regex: re.search(regex, name), "-E": lambda regex: not re.search(regex, name)}
        return words[0] == "scripts/test" and all(
            rules[word](following) for word, following in zip(words, words[1:]) if word in rules)

    def test_every_test_is_in_a_part_and_what_takes_turns_in_one(self):
        count = 0
        for name, labels in self.listed():
            count += 1
            parts = [part for part, command in PARTS.items()
                     if part != "sanitizers" and self.takes(command, name, labels)]
            # What is long has a label beside it.
            self.assertEqual(len(parts), 2 if {"unit", "long"} <= set(labels) else 1, f"{name} is in {parts}")
        self.assertGreater(count, 100)

    def test_ci_runs_the_first_two_and_a_turn(self):
        text = (SOURCE / ".ci/run").read_text(encoding="utf-8")
        commands = [line for line in text.splitlines() if line.startswith("scripts/")]
        self.assertEqual(commands, [PARTS["tests"], "scripts/everything --turn", PARTS["sanitizers"]])

    def test_the_page_is_as_it_is_written(self):
        done = subprocess.run([SCRIPT, "--check"], capture_output=True, text=True, check=False)
        self.assertEqual((done.returncode, done.stderr), (0, ""))


if __name__ == "__main__":
    unittest.main()
