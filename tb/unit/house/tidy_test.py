#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Tests scripts/tidy on a tree of two files: it finds injected faults, and rechecks changed files only.
usage: tidy_test.py SOURCE [unittest options]"""
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

SOURCE = pathlib.Path(sys.argv.pop(1) if len(sys.argv) > 1 else ".").resolve()
CLEAN = "// a header\ninline int* nothing() { return nullptr; }\n"
INJECTED = "// a header\ninline int* nothing() { return 0; }\n"


class Tidy(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory(prefix="deburr_tidy_")
        self.addCleanup(scratch.cleanup)
        self.root = pathlib.Path(scratch.name).resolve()
        (self.root / "build/release").mkdir(parents=True)
        (self.root / "golden").mkdir()
        (self.root / "scripts").mkdir()
        for name in ("scripts/tidy", "scripts/changed.py"):
            shutil.copy(SOURCE / name, self.root / name)
        shutil.copy(SOURCE / ".clang-tidy", self.root / ".clang-tidy")
        (self.root / "golden/a.cpp").write_text('#include "golden/a.h"\nint* a() { return nothing(); }\n',
                                                encoding="utf-8")
        (self.root / "golden/b.cpp").write_text("int b() { return 1; }\n", encoding="utf-8")
        self.header(CLEAN)
        (self.root / "build/release/compile_commands.json").write_text(json.dumps(
            [{"directory": str(self.root), "file": f"golden/{name}.cpp",
              "command": f"c++ -std=c++20 -I. -c golden/{name}.cpp"} for name in "ab"]),
            encoding="utf-8")

    def header(self, text):
        (self.root / "golden/a.h").write_text(text, encoding="utf-8")

    def tidy(self, *arguments):
        done = subprocess.run([self.root / "scripts/tidy", *arguments], capture_output=True, text=True, check=False,
                              env={**os.environ, "DEBURR_CHANGED_HOURS": ""})
        clean = len(list((self.root / "build/tidy").glob("*")))
        return done.returncode, clean, done.stdout + done.stderr

    def test_finds_injected_faults_and_remembers_clean_files(self):
        self.assertEqual(self.tidy()[:2], (0, 2))
        code, _, text = self.tidy()
        self.assertEqual(code, 0)
        self.assertIn("0 of 2 files checked", text)
        self.header(INJECTED)
        code, clean, text = self.tidy()
        self.assertEqual((code, clean), (1, 2))
        self.assertEqual(text.count("[modernize-use-nullptr"), 1)
        self.header(CLEAN + "// longer\n")
        self.assertEqual(self.tidy()[:2], (0, 3), "the file that includes it, and not the other")

    def test_checks_files_of_batch_separately(self):
        batch = self.root / "build/release/golden/x_batch_1.cpp"
        batch.parent.mkdir(parents=True)
        batch.write_text("".join(f'#include "golden/{name}.cpp"\n' for name in "ab"),
                         encoding="utf-8")
        (self.root / "build/release/compile_commands.json").write_text(json.dumps(
            [{"directory": str(self.root), "file": str(batch),
              "command": f"c++ -std=c++20 -Werror --param=large-unit-insns=9 -I. -o x.o -c {batch}"}]), encoding="utf-8")
        self.assertEqual(self.tidy()[:2], (0, 2))
        self.header(INJECTED)
        code, clean, text = self.tidy(self.root / "golden/a.cpp")
        self.assertEqual((code, clean, text.count("[modernize-use-nullptr")), (1, 2, 1))
        self.assertIn("1 of 1 files checked", text)

    def test_file_that_does_not_compile_is_not_clean(self):
        (self.root / "golden/a.cpp").write_text('#include "golden/nowhere.h"\n', encoding="utf-8")
        code, clean, text = self.tidy()
        self.assertEqual((code, clean), (1, 1))
        self.assertIn("[clang-diagnostic-error]", text)

    def git(self, *words):
        subprocess.run(["git", "-c", "user.name=A", "-c", "user.email=a@b", "-C", self.root, *words],
                       check=True, capture_output=True)

    def test_changed_selects_differences_from_upstream(self):
        (self.root / ".gitignore").write_text("/build/\n", encoding="utf-8")
        self.git("init", "-q", "-b", "main")
        self.git("add", ".")
        self.git("commit", "-q", "-m", "first")
        self.git("branch", "upstream")
        self.git("branch", "-q", "--set-upstream-to=upstream")
        self.assertIn("0 of 0 files checked", self.tidy("--changed")[2])
        self.header(INJECTED)
        self.git("commit", "-q", "-a", "-m", "second")
        code, _, text = self.tidy("--changed")
        self.assertEqual((code, text.count("[modernize-use-nullptr")), (1, 1))
        self.assertIn("1 of 1 files checked", text, "the file that includes it")


if __name__ == "__main__":
    if not shutil.which("clang-tidy"):
        print("skipped: clang-tidy is absent")
        sys.exit(0)
    unittest.main()
