#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Disturbances that must not change a picture of any engine: stalls of every link, late memory, noise in unwritten
fields, the evaluation order of units, the fast path, a reset in mid-frame, and whether the configuration is
written to registers or given as reset values. Runs every engine of engines.txt, with the options under `watched`
or `programmed` in its trials.yaml, or none.

usage: disturbed_test.py DEBURR SOURCE [CLASS]"""
import itertools
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

# Cycle-identical runs: the whole result except figures of the host.
UNSEEN = {"another order of units": ["run.shuffle=true"], "noise": ["run.poison=true"],
          "no fast path": ["run.fast_path=false"], "no checks of links": ["run.check_links=false"],
          "all of them": ["run.shuffle=true", "run.poison=true", "run.fast_path=false"]}
# The same comparisons in other cycles.
SLOWER = {"stalls": ["run.stalls=0.3"], "dense stalls": ["run.stalls=0.8", "run.poison=true", "run.shuffle=true"]}
# Cycle-identical, whether the configuration is written to registers or given as reset values.
PROGRAMMED = {"nothing": [], "stalls": ["run.stalls=0.2", "run.poison=true", "run.shuffle=true"],
              "no fast path": ["run.fast_path=false"],
              "a reset": ["run.reset_after=333", "run.poison=true", "run.shuffle=true"]}
# The first beats of some engines come late, frames of others end early.
RESETS = (1, 40, 333, 2500, 5000)


class Disturbed(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory(prefix="deburr_disturbed_")
        self.addCleanup(scratch.cleanup)
        self.out = pathlib.Path(scratch.name)

    def run_of(self, *arguments, code=0):
        """Its result without figures of the host, and its pictures."""
        done = subprocess.run([DEBURR, "run", *arguments, "--quiet", "--out", self.out], text=True, capture_output=True,
                              check=False)
        self.assertEqual(done.returncode, code, f"{arguments}\n{done.stdout}{done.stderr}")
        result = json.loads((self.out / "result.json").read_text(encoding="utf-8"))
        del result["host"]
        pictures = {path.name: path.read_bytes() for path in self.out.glob("*.png")}
        self.assertGreater(len(pictures), 0)
        return result, pictures

    def compare_each(self, disturbances, compare):
        """Each engine undisturbed, and with each disturbance."""
        for engine in engines():
            for options in trials("watched").get(engine, {"": []}).values():
                quiet = self.run_of(engine, *options)
                for name, settings in disturbances.items():
                    with self.subTest(engine=engine, options=options, disturbed=name):
                        more = [word for setting in settings for word in ("--set", setting)]
                        disturbed = self.run_of(engine, *options, *more)
                        self.assertEqual(disturbed[1].keys(), quiet[1].keys())
                        self.assertEqual([name for name in quiet[1] if disturbed[1][name] != quiet[1][name]], [])
                        compare(quiet[0], disturbed[0])

    @staticmethod
    def compared(result):
        return {name: (board["comparisons"], board["mismatches"]) for name, board in result["scoreboards"].items()}


class Unseen(Disturbed):
    def test_nothing_changes(self):
        # Only the keys: a list of all differences would take minutes.
        self.compare_each(UNSEEN, lambda quiet, disturbed: self.assertEqual(
            [key for key in {**quiet, **disturbed} if quiet.get(key) != disturbed.get(key)], []))


class Slower(Disturbed):
    def test_stalls_change_only_cycles(self):
        def compare(quiet, disturbed):
            self.assertEqual(self.compared(disturbed), self.compared(quiet))
            self.assertGreater(disturbed["cycles"], quiet["cycles"])
        self.compare_each(SLOWER, compare)


class Reset(Disturbed):
    def test_restarted_frame_is_the_same(self):
        more = []

        def compare(quiet, disturbed):
            before, after = (sum(count for count, _ in self.compared(result).values()) for result in (quiet, disturbed))
            more.append(after - before)
            for name, (comparisons, mismatches) in self.compared(quiet).items():
                self.assertGreaterEqual(disturbed["scoreboards"][name]["comparisons"], comparisons, name)
                self.assertEqual(disturbed["scoreboards"][name]["mismatches"], mismatches, name)
        self.compare_each({f"reset after {cycles} cycles": [f"run.reset_after={cycles}", "run.poison=true"]
                           for cycles in RESETS}, compare)
        # Comparisons before the reset are the only evidence of it.
        while more:
            self.assertGreater(sum(more[:len(RESETS)]), 0, "no reset took place")
            del more[:len(RESETS)]


class Programmed(Disturbed):
    def test_written_configuration_equals_reset_values(self):
        runs = [(engine, list(itertools.chain(*zip(options, values))))
                for engine, options in trials("programmed").items() for values in itertools.product(*options.values())]
        self.assertGreater(len(runs), 0)
        for (engine, options), (name, settings) in itertools.product(runs, PROGRAMMED.items()):
            with self.subTest(engine=engine, options=options, disturbed=name):
                more = [word for setting in settings for word in ("--set", setting)]
                written, built = ((*self.run_of(engine, *options, "--size", "48x32", *more, "--set", f"run.program={how}"),
                                   self.configuration()) for how in ("registers", "reset"))
                self.assertEqual([key for key in {**written[0], **built[0]} if written[0].get(key) != built[0].get(key)], [])
                self.assertEqual(written[1], built[1])
                self.assertEqual([key for key, value in written[2].items() if built[2][key] != value], ["run.program"])

    def configuration(self):
        return json.loads((self.out / "manifest.json").read_text(encoding="utf-8"))["configuration"]


class Faulty(Disturbed):
    def test_different_picture_is_detected(self):
        """The comparisons above detect a wrong pixel."""
        for engine, entry in trials("followed").items():
            quiet, pictures = self.run_of(engine, *entry["run"])
            result, faulty = self.run_of(engine, *entry["run"], "--fault", entry["fault"], code=1)
            self.assertNotEqual(faulty, pictures)
            self.assertNotEqual(self.compared(result), self.compared(quiet))


if __name__ == "__main__":
    if len(sys.argv) < 3 or sys.argv[1] in ("-h", "--help"):
        print(__doc__)
        sys.exit(0 if len(sys.argv) >= 2 else 2)
    DEBURR, SOURCE = pathlib.Path(sys.argv.pop(1)).resolve(), pathlib.Path(sys.argv.pop(1)).resolve()
    sys.dont_write_bytecode = True
    sys.path.insert(0, str(SOURCE / "tb/engines"))
    from engine_list import engines, trials
    unittest.main()
