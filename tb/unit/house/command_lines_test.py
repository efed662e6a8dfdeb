#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""What the scripts make of their command lines, with tools that only say how they were called.
usage: command_lines_test.py SOURCE [unittest options]"""
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import time
import unittest

sys.dont_write_bytecode = True
from tiny_tree import tiny_tree  # noqa: E402

SOURCE = pathlib.Path(sys.argv.pop(1) if len(sys.argv) > 1 else ".").resolve()
SAYS = '#!/bin/sh\necho "$(basename "$0") $*" >>"$CALLS"\n'
DEBURR = "build/release/tb/app/deburr"


class CommandLines(unittest.TestCase):
    def setUp(self):
        tools = ("cmake", "ctest", "apt-get", "clang++")
        self.root = tiny_tree(self, {f"bin/{tool}": SAYS for tool in tools} | {DEBURR: SAYS})
        shutil.copytree(SOURCE / "scripts", self.root / "tree/scripts")
        shutil.copytree(SOURCE / ".ci", self.root / "tree/.ci")
        (self.root / "build").rename(self.root / "tree/build")
        self.calls = self.root / "calls"
        for file in (*(self.root / "bin").iterdir(), self.root / "tree" / DEBURR):
            file.chmod(0o755)

    def environment(self):
        return {**os.environ, "PATH": f"{self.root}/bin:{os.environ['PATH']}",
                "DEBURR_NO_INSTALL": "1", "CALLS": str(self.calls)}

    def call(self, script, *arguments):
        """Exit code, what was said, and the tools that were called; from another folder."""
        self.calls.write_text("", encoding="utf-8")
        done = subprocess.run([self.root / "tree" / script, *arguments], capture_output=True,
                              text=True, check=False, cwd=self.root, env=self.environment())
        return done.returncode, done.stdout + done.stderr, self.calls.read_text().splitlines()

    def test_what_is_wrong_is_said_before_anything_is_done(self):
        for script, arguments, code, text in (
                ("scripts/test", ["--preset"], 2, "--preset needs a name"),
                ("scripts/test", ["-L"], 2, "-L needs a regular expression"),
                ("scripts/test", ["unit"], 2, 'what is "unit"'),
                ("scripts/test", ["-L", "unit", "more"], 2, 'what is "more"'),
                (".ci/run", ["unit"], 2, 'what is "unit"'),
                ("scripts/demo", ["--out", "x"], 2, "unknown option --out"),
                ("scripts/demo", ["x", "y"], 2, "one folder, and no y"),
                ("scripts/install", ["--odd"], 2, "takes no arguments"),
                ("scripts/fuzz", ["--seconds"], 2, "--seconds needs a number from 1"),
                ("scripts/fuzz", ["--seconds", "gltf"], 2, "--seconds needs a number from 1"),
                ("scripts/fuzz", ["gltf", "odd"], 2, "no target odd: pictures depths obj"),
                ("scripts/mutate", ["a.cpp", "--tests", "("], 2, "--tests (: missing )"),
                ("scripts/mutate", ["a.cpp", "--jobs", "0"], 2, "--jobs from 1"),
                ("scripts/mutate", ["a.cpp", "--count", "-1"], 2, "--count from 0"),
                ("scripts/findings", ["none"], 1, "findings: none: No such file"),
                ("scripts/findings", [SOURCE / "CMakePresets.json"], 1, "is no collected.json of a sweep"),
                ("scripts/findings", [SOURCE / "LICENSE"], 1, "is no collected.json of a sweep"),
                ("scripts/regression_report", ["none"], 1, "regression_report: none: No such file"),
                ("scripts/regression_report", [SOURCE / "CMakePresets.json"], 1,
                 "is no collected.json of a regression"),
                ("scripts/skipped", ["none"], 1, "No such file")):
            with self.subTest(script=script, arguments=arguments):
                done, said, calls = self.call(script, *arguments)
                self.assertEqual((done, calls), (code, []), said)
                self.assertIn(text, said.splitlines()[-1])

    def test_every_script_helps(self):
        for script in sorted((SOURCE / "scripts").iterdir()):
            if not script.is_file() or script.suffix:
                continue
            for option in ("-h", "--help"):
                with self.subTest(script=script.name):
                    done, said, calls = self.call(f"scripts/{script.name}", option)
                    self.assertEqual((done, calls), (0, []), said)
                    self.assertRegex(said, rf"(scripts/|usage: ){script.name}\b")

    def test_options_of_ctest_pass_and_the_record_of_another_run_does_not(self):
        old = self.root / "tree/build/release/tests.xml"
        old.write_text("<testsuite/>", encoding="utf-8")
        for arguments, targets in ((["-L", "unit"], " --target deburr_unit_tests deburr"),
                                   (["-L", "unit", "--timeout", "9", "-V"], "")):
            done, said, calls = self.call(".ci/run", *arguments)
            self.assertEqual((done, said), (0, ""))
            self.assertEqual([c.split()[0] for c in calls], ["cmake", "cmake", "ctest"])
            self.assertEqual(calls[1], f"cmake --build build/release{targets}")
            self.assertTrue(calls[2].endswith(" " + " ".join(arguments)), calls[2])
            self.assertFalse(old.exists())

    def test_the_demo_writes_to_its_callers_folder(self):
        for arguments, out in (([], f"{self.root}/tree/out/demo"), (["mine"], f"{self.root}/mine")):
            done, said, calls = self.call("scripts/demo", *arguments)
            self.assertEqual(done, 0, said)
            self.assertEqual(calls[-1], f"deburr run texture --scene plane --out {out}")
            self.assertEqual(said, f"Open {out}/report.html\n")

    def test_ctrl_c_ends_all_fuzzers(self):
        """A fuzzer that is interrupted ends as one that has found something."""
        for name in ("write_seeds", "fuzz_obj", "fuzz_gltf"):
            path = self.root / "tree/build/fuzz/tb/fuzz" / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(SAYS + ("" if name == "write_seeds" else
                                    "trap 'exit 72' INT\nwhile :; do sleep 0.1; done\n"), encoding="utf-8")
            path.chmod(0o755)
        self.calls.write_text("", encoding="utf-8")
        with subprocess.Popen([self.root / "tree/scripts/fuzz", "obj", "gltf"], env=self.environment(),
                              stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                              start_new_session=True) as fuzz:
            deadline = time.monotonic() + 60
            while "fuzz_obj" not in self.calls.read_text() and time.monotonic() < deadline:
                time.sleep(0.05)
            time.sleep(0.2)
            os.killpg(fuzz.pid, signal.SIGINT)
            try:
                self.assertEqual(fuzz.wait(timeout=20), 130)
            finally:
                if fuzz.poll() is None:
                    os.killpg(fuzz.pid, signal.SIGKILL)
        self.assertIn("fuzz_obj", self.calls.read_text())
        self.assertNotIn("fuzz_gltf", self.calls.read_text())


if __name__ == "__main__":
    unittest.main()
