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

import yaml

sys.dont_write_bytecode = True
from tiny_tree import tiny_tree  # noqa: E402

SOURCE = pathlib.Path(sys.argv.pop(1) if len(sys.argv) > 1 else ".").resolve()
sys.path.insert(0, str(SOURCE / "tb/engines"))
from engine_list import testplan  # noqa: E402

COMPILER = '#!/bin/sh\necho "${COMPILER_VERSION:-12}"\n'
SAYS = '#!/bin/sh\necho "$(basename "$0") $*" >>"$CALLS"\n'
# A few of its options; what it does not know it passes over.
CTEST = SAYS.replace("\n", """
case "$*" in --help)
  echo '  -N,--show-only[=format]      = Disable actual execution of tests.
  -V,--verbose                 = Enable verbose output from tests.
  -j <jobs>, --parallel <jobs> = Run the tests in parallel.
  --timeout <seconds>          = Set the default test timeout.
  --rerun-failed               = Run only the tests that failed --before.
  --repeat until-fail:<n>      = Allow each test to run several times.'; exit ;;
esac
""", 1)
DEBURR = "build/release/deburr"
# What ninja says of a target: the programs that it builds.
PROGRAMS = """case "$*" in *"-t query"*)
  echo 'deburr_unit_tests:
  input: phony
    deburr
    tb/unit/golden/golden_tests
    tb/unit/rtl/rtl_tests
  outputs:' ;;
esac
"""
HELD = """golden_test tb/unit/golden/golden_test.cpp tb/unit/golden/golden_tests
rtl_a_test tb/unit/rtl/a_test.cpp tb/unit/rtl/rtl_tests
rtl_b_test tb/unit/rtl/b_test.cpp tb/unit/rtl/rtl_tests
embosser_test tb/system/embosser_test.cpp tb/system/system_tests
"""
# Every package but two is there.
INSTALLED = '''#!/bin/sh
case "$*" in *clang*|*slurm*) exit 1 ;; esac
echo "install ok installed"
'''


class CommandLines(unittest.TestCase):
    def setUp(self):
        tools = ("cmake", "apt-get", "clang++")
        self.root = tiny_tree(self, {f"bin/{tool}": SAYS for tool in tools} |
                              {"bin/ctest": CTEST, DEBURR: SAYS, "build/release/test_programs.txt": HELD, "bin/ninja": SAYS + PROGRAMS, "bin/dpkg-query": INSTALLED,
                               "bin/c++": COMPILER})
        for folder in ("scripts", ".ci", "cmake", "tb/engines", "tb/testplan"):
            shutil.copytree(SOURCE / folder, self.root / "tree" / folder)
        shutil.copy(SOURCE / "CMakePresets.json", self.root / "tree")
        (self.root / "build").rename(self.root / "tree/build")
        self.calls = self.root / "calls"
        for file in (*(self.root / "bin").iterdir(), self.root / "tree" / DEBURR):
            file.chmod(0o755)

    def environment(self, **more):
        return {**os.environ, "PATH": f"{self.root}/bin:{os.environ['PATH']}",
                "DEBURR_NO_INSTALL": "1", "CALLS": str(self.calls), **more}

    def call(self, script, *arguments, **more):
        """Exit code, what was said, and the tools that were called; from another folder."""
        self.calls.write_text("", encoding="utf-8")
        done = subprocess.run([self.root / "tree" / script, *arguments], capture_output=True,
                              text=True, check=False, cwd=self.root, env=self.environment(**more))
        return done.returncode, done.stdout + done.stderr, self.calls.read_text().splitlines()

    def test_what_is_wrong_is_said_before_anything_is_done(self):
        for script, arguments, code, text in (
                ("scripts/test", ["--preset"], 2, "--preset needs a name"),
                ("scripts/test", ["-L"], 2, "-L needs a regular expression"),
                ("scripts/test", ["unit"], 2, 'what is "unit"'),
                ("scripts/test", ["-L", "unit", "more"], 2, 'what is "more"'),
                ("scripts/test", ["--before"], 2, "ctest has no option --before"),
                ("scripts/test", ["-L", "unit", "--repeats", "until-fail:2"], 2, "ctest has no option --repeats"),
                ("scripts/test", ["-L", "unit", "-k4"], 2, "ctest has no option -k4"),
                ("scripts/test", ["-L", "units"], 2, "no label matches units: smoke unit"),
                ("scripts/test", ["-L", "unit", "-LE", "("], 2, "no label matches (: smoke unit"),
                ("scripts/test", ["--preset", "base"], 2, "CMakePresets.json has no preset base"),
                ("scripts/demo", ["--out", "x"], 2, "unknown option --out"),
                ("scripts/demo", ["x", "y"], 2, "one folder, and no y"),
                ("scripts/install", ["--odd"], 2, "no section --odd: libraries build modules test"),
                ("scripts/install", ["build", "odd"], 2, "no section odd: libraries build modules test"),
                ("scripts/stand_alone", ["5/4"], 2, "5/4 is no part as 2/4"),
                ("scripts/stand_alone", ["1/4", "2/4"], 2, "one part, and no 2/4"),
                ("scripts/nightly", ["odd"], 2, "no feature odd: texture-rules, "),
                ("scripts/nightly", ["--divide", "0"], 2, "--divide 0: expected a number from 1"),
                ("scripts/everything", ["odd"], 2, "no part odd: tests sanitizers"),
                ("scripts/everything", ["--list", "tests"], 2, "parts go with no option"),
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
        for arguments in (["-L", "unit"], ["-L", "unit", "--timeout", "9", "-V"], ["-L", "unit", "-j4", "--show-only=json-v1"]):
            done, said, calls = self.call("scripts/test", *arguments)
            self.assertEqual((done, said), (0, ""))
            self.assertEqual([c.split()[0] for c in calls], ["cmake", "cmake", "ctest"])
            self.assertTrue(calls[2].endswith(" " + " ".join(arguments)), calls[2])
            self.assertFalse(old.exists())

    def test_a_choice_of_labels_builds_what_they_need(self):
        for arguments, targets in (
                (["-L", "unit"], "deburr_unit_tests"),
                (["-L", "^(smoke|slurm)$"], "deburr_smoke_tests deburr_slurm_tests"),
                (["-LE", "^(unit|stress|oracle|negative|perf|tools|long|slurm|fuzz)$"],
                 "deburr_smoke_tests deburr_system_tests deburr_examples_tests"),
                (["-R", "^rtl_"], "all"),
                (["-L", "^unit$", "-R", "^rtl_"], "deburr rtl_tests"),
                (["-L", "^unit$", "-R", "^(golden_|rtl_b)"], "deburr golden_tests rtl_tests"),
                (["-L", "^unit$", "-E", "^rtl_"], "deburr golden_tests"),
                (["-L", "^unit$", "-E", "^rtl_a"], "deburr golden_tests rtl_tests"),
                # These may be parts of names behind that of the program.
                (["-L", "^unit$", "-R", "rtl_"], "deburr_unit_tests"),
                (["-L", "^unit$", "-R", "^rtl_a_test[.]Suite"], "deburr_unit_tests"),
                (["-L", "^unit$", "-R", "^rtl_a_test_of"], "deburr_unit_tests"),
                (["-L", "^unit$", "-R", "^rtl_", "-E", "^rtl_a"], "deburr_unit_tests")):
            with self.subTest(arguments=arguments):
                calls = [call for call in self.call("scripts/test", *arguments)[2] if "--build" in call]
                self.assertEqual(calls, [f"cmake --build build/release --target {targets}"])

    def test_labels_of_the_preset_hdl_choose_it_and_others_leave_them_out(self):
        for arguments, preset, targets in (
                (["-L", "^hdl$"], "hdl", "deburr_hdl_tests"),
                (["-L", "^(hdl|formal)$"], "hdl", "deburr_hdl_tests deburr_formal_tests"),
                (["-L", "^(smoke|hdl)$"], "release", "deburr_smoke_tests"),
                (["--preset", "hdl", "-L", "^(smoke|formal)$"], "hdl", "deburr_smoke_tests deburr_formal_tests")):
            with self.subTest(arguments=arguments):
                calls = self.call("scripts/test", *arguments)[2]
                self.assertIn(f"cmake --preset {preset} -DDEBURR_WERROR=ON", calls)
                self.assertIn(f"cmake --build build/{preset} --target {targets}", calls)

    def test_a_choice_of_labels_installs_what_they_need(self):
        clang, slurm = ["clang", "libclang-rt-14-dev"], ["slurm-wlm"]
        for arguments, packages in (
                (["-L", "smoke"], []),
                (["-L", "^unit$"], ["clang-format"]),
                (["-L", "^unit$", "--preset", "asan"], ["clang-format", *clang]),
                (["-L", "fuzz"], clang),
                (["-L", "slurm"], slurm),
                (["-L", "smoke", "--tidy"], ["clang-tidy"]),
                (["-R", "slurm"], ["clang-format", "clang-tidy", *clang]),
                ([], ["clang-format", "clang-tidy"])):
            with self.subTest(arguments=arguments):
                calls = self.call("scripts/test", *arguments, DEBURR_NO_INSTALL="0")[2]
                installed = [call.split("--no-install-recommends ")[1].split() for call in calls
                             if "apt-get install" in call]
                self.assertEqual(installed, [packages] if packages else [])

    def test_clang_tidy_is_asked_of_what_changed_unless_it_is_asked_for(self):
        (self.root / "tree/scripts/tidy").write_text(SAYS, encoding="utf-8")
        for arguments, asked in (([], ["tidy --changed --build build/release"]), (["-L", "smoke"], []),
                                 (["--tidy"], ["tidy --build build/release"]),
                                 (["--tidy", "-L", "smoke"], ["tidy --build build/release"])):
            with self.subTest(arguments=arguments):
                calls = self.call("scripts/test", *arguments)[2]
                self.assertEqual([call for call in calls if call.startswith("tidy")], asked)

    def test_a_part_of_the_nightly_plan_has_the_features_that_are_asked_for(self):
        plan = testplan(SOURCE / "tb/testplan/nightly.yaml")
        names = [feature["id"] for feature in plan["features"]]
        self.assertTrue(plan["coverage"])
        # What all runs must meet together, some of them need not.
        of_all = {key: value for key, value in plan.items() if key not in ("coverage", "unmet")}
        for arguments, whole, left, name in (
                (["large-frames"], of_all, ["large-frames"], "nightly-large-frames"), ([], plan, names, "nightly"),
                (["--but", names[0], names[2]], of_all, [names[1], *names[3:]], f"nightly-but-{names[0]}-{names[2]}")):
            done, said, calls = self.call("scripts/nightly", *arguments, "--seed", "7")
            self.assertEqual(done, 0, said)
            part = self.root / f"tree/build/nightly/{name}.yaml"
            self.assertEqual(calls, ["cmake --build build/release --target deburr",
                                     f"deburr regress {part} --divide 100 --out {part.parent} --seed 7"])
            self.assertEqual(yaml.safe_load(part.read_text(encoding="utf-8")),
                             {**whole, "features": [f for f in plan["features"] if f["id"] in left]})

    def test_of_the_nightly_call_before_its_trend_stays(self):
        regressions = self.root / "tree/build/nightly/regressions"
        (regressions / "nightly-of-100-1").mkdir(parents=True)
        (regressions / "nightly-of-100.jsonl").write_text("{}\n", encoding="utf-8")
        (regressions.parent / "points").mkdir()
        (regressions.parent / "trend.jsonl").touch()
        node = (regressions / "nightly-of-100.jsonl").stat().st_ino
        self.assertEqual(self.call("scripts/nightly")[0], 0)
        self.assertEqual(sorted(path.name for path in regressions.rglob("*")), ["nightly-of-100.jsonl"])
        self.assertEqual((regressions / "nightly-of-100.jsonl").read_text(encoding="utf-8"), "{}\n")
        # It was never away, so that an interrupted call loses none.
        self.assertEqual((regressions / "nightly-of-100.jsonl").stat().st_ino, node)
        self.assertEqual(sorted(path.name for path in regressions.parent.iterdir()), ["nightly.yaml", "regressions"])

    def test_few_configurations_of_the_nightly_plan_are_drawn_by_the_seed(self):
        drawn = set()
        for seed in ("1", "2", "3", "1"):
            self.assertEqual(self.call("scripts/nightly", "--few", "--seed", seed)[0], 0)
            text = (self.root / "tree/build/nightly/nightly-few.yaml").read_text(encoding="utf-8")
            self.assertNotIn("unmet", yaml.safe_load(text))
            for feature in yaml.safe_load(text)["features"]:
                # What one value of an axis compares may be less than the plan demands of all of them.
                self.assertEqual(set(feature["checks"].values()), {100})
                self.assertNotIn("coverage", feature)
                for stimulus in feature["stimuli"]:
                    values = list(stimulus.get("axes", {}).values())
                    self.assertEqual([len(v) for v in values[:2]], [1] * len(values[:2]))
            drawn.add(text)
        self.assertEqual(len(drawn), 3)

    def test_the_demo_writes_to_its_callers_folder(self):
        for arguments, out in (([], f"{self.root}/tree/out/demo"), (["mine"], f"{self.root}/mine")):
            done, said, calls = self.call("scripts/demo", *arguments)
            self.assertEqual(done, 0, said)
            self.assertEqual(calls[-1], f"deburr run texture --scene plane --out {out}")
            self.assertEqual(said.splitlines()[-1], f"Open {out}/report.html")

    def test_the_demo_configures_and_installs_no_tests(self):
        """It says how long each step takes, and leaves tests that are configured as they are."""
        (self.root / "tree" / DEBURR).rename(self.root / "deburr")
        calls = self.call("scripts/demo", DEBURR_NO_INSTALL="0")
        self.assertEqual(calls[2], ["cmake --preset release -DDEBURR_WERROR=ON -DBUILD_TESTING=OFF",
                                    "cmake --build build/release --target deburr"])
        for step in ("Configuring: 5 to 15 s", "Building: about ", "Running the texture unit"):
            self.assertIn(step, calls[1])
        build = self.root / "tree/build/release"
        (build / "build.ninja").touch()
        (build / "CMakeCache.txt").write_text("BUILD_TESTING:BOOL=ON\n", encoding="utf-8")
        self.assertIn("cmake --preset release -DDEBURR_WERROR=ON -DBUILD_TESTING=ON", self.call("scripts/demo")[2])

    def test_the_tests_compile_nothing_of_the_demo_again(self):
        """Both give the same options, so that what they have in common is compiled alike."""
        def options(script, **more):
            configure, = (call for call in self.call(script, **more)[2] if call.startswith("cmake --preset"))
            return {word for word in configure.split() if "BUILD_TESTING" not in word}
        self.assertEqual(options("scripts/demo"), options("scripts/test"))
        # Warnings of a compiler that nobody has tried end no first build.
        self.assertEqual(options("scripts/test") - options("scripts/demo", COMPILER_VERSION="14"),
                         {"-DDEBURR_WERROR=ON"})

    def test_the_complete_demo_builds_all_that_the_command_starts_and_loads(self):
        done, said, calls = self.call("scripts/demo", "--complete", "mine")
        self.assertEqual((done, calls[1:]), (0, ["cmake --build build/release --target deburr_complete",
                                                 f"deburr run texture --scene plane --out {self.root}/mine"]), said)

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

    def test_ctrl_c_ends_the_tests_and_the_demo(self):
        """cmake and ctest may end as they like when they are interrupted; nothing comes after them."""
        waits = '#!/bin/sh\ntrap "exit 3" INT\necho "waits" >>"$CALLS"\nwhile :; do sleep 0.1; done\n'
        self.program("bin/cmake", waits)
        for script in ("scripts/test", "scripts/demo", ".ci/run", "scripts/stand_alone"):
            self.assertEqual(self.interrupted(script), "waits\n", script)
        self.program("bin/cmake", "#!/bin/sh\n")
        self.program("bin/ctest", waits)
        self.assertIn("waits\n", self.interrupted("scripts/test", "-L", "smoke"))

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
