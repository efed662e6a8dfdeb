#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""What the scripts make of their command lines, with tools that only say how they were called.
usage: command_lines_test.py SOURCE [unittest options]"""
import json
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
DEBURR = "build/release/deburr"


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
            done, said, calls = self.call("scripts/test", *arguments)
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

    def interrupted(self, script, *arguments):
        """The tools that were called before and after Ctrl-C, which comes while the first one runs."""
        self.calls.write_text("", encoding="utf-8")
        with subprocess.Popen([self.root / "tree" / script, *arguments], env=self.environment(),
                              stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                              start_new_session=True) as process:
            deadline = time.monotonic() + 60
            while "waits" not in self.calls.read_text() and time.monotonic() < deadline:
                time.sleep(0.05)
            os.killpg(process.pid, signal.SIGINT)
            try:
                self.assertEqual(process.wait(timeout=20), 130)
            finally:
                if process.poll() is None:
                    os.killpg(process.pid, signal.SIGKILL)
        return self.calls.read_text()

    def program(self, name, text):
        path = self.root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
        path.chmod(0o755)

    def test_ctrl_c_ends_all_fuzzers(self):
        """A fuzzer that is interrupted ends as one that has found something."""
        folder = "tree/build/fuzz/tb/fuzz/"
        self.program(folder + "write_seeds", SAYS)
        for name in ("obj", "gltf"):
            self.program(f"{folder}fuzz_{name}", "#!/bin/sh\ntrap 'exit 72' INT\n"
                         f"echo 'waits {name}' >>\"$CALLS\"\nwhile :; do sleep 0.1; done\n")
        calls = self.interrupted("scripts/fuzz", "obj", "gltf")
        self.assertIn("waits obj", calls)
        self.assertNotIn("waits gltf", calls)

    def test_ctrl_c_ends_clang_tidy(self):
        """With flags of its own each file is looked at alone."""
        (self.root / "tree/.clang-tidy").write_text("", encoding="utf-8")
        (self.root / "tree/golden").mkdir()
        commands = []
        for n in range(8):
            (self.root / f"tree/golden/{n}.cpp").write_text("\n", encoding="utf-8")
            commands.append({"directory": str(self.root / "tree"), "file": f"golden/{n}.cpp",
                             "command": f"c++ -DN={n} -c golden/{n}.cpp"})
        (self.root / "tree/build/release/compile_commands.json").write_text(json.dumps(commands),
                                                                            encoding="utf-8")
        self.program("bin/clang-tidy", '#!/bin/sh\n[ "$1" = --version ] && exit 0\n'
                     'echo "waits" >>"$CALLS"\nexec sleep 5\n')
        self.assertEqual(self.interrupted("scripts/tidy", "--jobs", "1"), "waits\n")


if __name__ == "__main__":
    unittest.main()
