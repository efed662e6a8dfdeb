#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Invalid sweeps, and sweeps that cannot run: each gives a clear error that names its position. See --help."""
import os
import resource
import unittest

from app_support import CommandTest, png

AXES = "axes: {texture.cache.ways: [1, 2], memory.latency: [50, 60]}\n"
BASE = "engine: texture\nbase: {scene: {width: 16, height: 16}, run.images: false}\n"


class Sweeps(CommandTest):
    def reject(self, text, *says, action="plan", code=2, **options):
        self.write("s.yaml", text)
        done = self.expect(code, "sweep", "s.yaml", action, says=says, **options)
        self.assertFalse(os.path.exists(self.path("out/sweeps/s/plan.json")), done.stdout)


class Definitions(Sweeps):
    def test_rejects_unknown_names(self):
        self.reject(BASE + "axes: {texture.cache.weighs: [1]}\n",
                    "s.yaml:3: unknown parameter 'texture.cache.weighs'", "did you mean 'texture.cache.ways'")
        self.reject(BASE.replace("height", "hight") + AXES,
                    "s.yaml:2: unknown parameter 'scene.hight'", "did you mean 'scene.height'")
        self.reject(BASE.replace("texture\n", "textur\n", 1) + AXES,
                    "s.yaml:1: no engine 'textur': did you mean 'texture'?")
        self.reject(BASE + AXES + "constrains: []\n", "unknown key 'constrains'", "'constraints'?")
        self.reject(BASE + AXES + "objectives: {minimise: [cicles]}\n",
                    "s.yaml:4: no metric 'cicles': did you mean 'cycles'?")
        self.reject(BASE + AXES + "objectives: {for_each: [memory.latencies]}\n",
                    "no axis 'memory.latencies': did you mean 'memory.latency'?")

    def test_rejects_invalid_values(self):
        self.reject(BASE + "axes: {texture.cache.ways: [1, 17]}\n",
                    "'texture.cache.ways' = '17' is outside 1..8")
        self.reject(BASE + "axes: {texture.footprint: [half, hafl]}\n",
                    "s.yaml:3: 'texture.footprint' = 'hafl' must be one of", "'half'?")
        self.reject(BASE + "axes: {texture.cache.ways: [1, 2, 1]}\n", "has the value '1' twice")

    def test_rejects_unknown_faults(self):
        """`plan` rejects a fault name that every run would reject; names in one part and links are checked by the
        run."""
        for fault, says in (("none", "no run of 'texture' has a fault 'none'"), ("flip-bits", "did you mean 'flip-bit'?")):
            self.reject(BASE.replace("base: {", f"base: {{run.fault: {fault}, ") + AXES, says)
        self.write("s.yaml", BASE + "axes: {run.fault: ['', drop-colour, 'drop:quads:9'], memory.latency: [50, 60]}\n")
        self.expect(0, "sweep", "s.yaml", "plan", says="6 points")
        self.write("s.yaml", BASE + "axes: {run.fault: [drop-colour, none]}\nrefused: skip\n")
        self.expect(0, "sweep", "s.yaml", "plan", says=("1 point over", "1 that the engine rejects"))
        self.write("s.yaml", "engine: frame\naxes: {run.fault: [drop-colour, texture.drop-quad]}\n")
        self.expect(0, "sweep", "s.yaml", "plan", says="2 points")

    def test_rejects_empty_axes(self):
        self.reject(BASE + "axes: {texture.cache.ways: []}\n",
                    "s.yaml:3: axis 'texture.cache.ways' is empty")
        self.reject(BASE + "axes: {memory.latency: {from: 60, to: 50}}\n",
                    "axis 'memory.latency' is empty: from 60 to 50")
        self.reject(BASE + "axes: {memory.latency: {from: 1, to: 9, step: 0}}\n", "never gets from")
        self.reject(BASE + "axes: {}\n", "'axes' must be a map of parameters to values, got an empty map")
        self.reject(BASE + "points: []\n", "'points' must be a list of maps, got an empty list")
        self.reject(BASE, "nothing is varied")
        self.reject(BASE + "axes: {run.stalls: {from: 0, to: 0.5}}\n", "has infinitely many values")

    def test_rejects_duplicates(self):
        self.reject(BASE + "axes: {scene.width: [8, 16]}\n",
                    "'scene.width' is varied, and fixed at s.yaml:2")
        self.reject(BASE + AXES + "points: [{texture.cache.bytes: 4096}]\n", "exclude each other")
        self.reject(BASE + "points: [{memory.latency: 50}, {texture.cache.ways: 1}]\n",
                    "the first point does not set 'texture.cache.ways'")

    def test_rejects_invalid_constraints(self):
        def constraint(text, *says):
            self.reject(BASE + AXES + f"constraints: ['{text}']\n", f"constraint '{text}'", *says)

        constraint("texture.cache.bites > 1", "'texture.cache.bites' is neither a parameter nor",
                   "did you mean 'texture.cache.bytes'")
        constraint("texture.cache.ways", "it is a number, not true or false")
        constraint("texture.footprint == hafl", "is not a value of texture.footprint", "'half'?")
        constraint("texture.footprint > 1", "expected a number, got a word")
        constraint("texture.cache.ways > 1 memory.latency", "unexpected 'memory.latency'")
        constraint("(texture.cache.ways > 1", "a ')' is missing")
        constraint("texture.cache.ways >", "unexpected end")
        constraint("texture.cache.ways / 0 > 1", "division by zero")
        self.reject(BASE + AXES + "constraints: [texture.cache.ways > 2, memory.latency < 10]\n",
                    "all 4 points are excluded: 'texture.cache.ways > 2' excludes 4")

    def test_rejects_too_long_or_deep_expressions(self):
        """They would take minutes or exhaust the stack."""
        for text, says in (("(" * 20000 + "cycles" + ")" * 20000,
                            "a metric of 40006 characters, at most 4000 are allowed"),
                           ("+".join(["cycles"] * 20000), "a metric of 139999 characters"),
                           ("(" * 101 + "cycles" + ")" * 101, "brackets and signs are nested more than 100 deep"),
                           ("- " * 101 + "cycles", "brackets and signs are nested more than 100 deep")):
            self.reject(BASE + AXES + f"metrics: {{a: '{text}'}}\n", says)
        self.reject(BASE + AXES + f"constraints: ['{'not ' * 101}memory.latency > 60']\n", "brackets and signs are nested more than 100 deep")
        self.write("s.yaml", BASE + AXES + f"metrics: {{a: '{'(' * 100 + 'cycles' + ')' * 100}', "
                   f"b: '{'+'.join(['cycles'] * 570)}', c: '{'- ' * 100}cycles'}}\n")
        self.expect(0, "sweep", "s.yaml", "plan")

    def test_rejects_text_that_is_not_utf8(self):
        """It cannot be written into results."""
        self.reject((BASE + AXES + "title: Gr\xfc\xdfe\n").encode("latin-1"), "s.yaml:4: not valid UTF-8")

    def test_rejects_file_name_that_gives_no_folder(self):
        for name in ("..yaml", "...yaml"):
            self.write(name, BASE + AXES)
            self.expect(2, "sweep", name, "plan", says=(f"'{name}': a sweep is named after its file",))
            self.assertFalse(os.path.exists(self.path("out")))

    def test_constraints_are_evaluated(self):
        """Precedence, words and logic, checked by the number of the 4 points that remain."""
        for text, left in (("texture.cache.ways * 2 + 1 == 5", 2),
                           ("1 + texture.cache.ways * 2 == 5", 2),
                           ("(1 + texture.cache.ways) * 2 == 4", 2),
                           ("texture.cache.ways == 1 or texture.cache.ways == 2 and memory.latency > 50", 3),
                           ("not texture.cache.ways == 1 and memory.latency == 60", 1),
                           ("not (texture.cache.ways == 1 and memory.latency == 60)", 3),
                           ("-texture.cache.ways < -1", 2),
                           ("texture.cache.bytes / 64 / texture.cache.ways % 256 == 0", 2),
                           ("texture.footprint == exact and texture.kernel != tent", 4),
                           ("run.shuffle or memory.latency <= 50", 2),
                           ("sampler.anisotropy >= 16 and memory.latency - 10 - 40 != 0", 2)):
            self.write("s.yaml", BASE + AXES + f"constraints: ['{text}']\n")
            self.expect(0, "sweep", "s.yaml", "plan", says=f"{left} point" + "s" * (left > 1) + " over")

    def test_rejects_too_many_points(self):
        steps = "{from: 1, to: 1000}"
        self.reject("engine: texture\naxes:\n"
                    f"  memory.latency: {steps}\n  run.seed: {steps}\n  run.stall_seed: {steps}\n",
                    "1000 x 1000 x 1000 points = 1,000,000,000", "at most 1,000,000 can be planned",
                    "sample: {random: 1000}")
        self.reject("engine: texture\naxes: {run.seed: {from: 0, to: 4294967295}}\n",
                    "has 4294967296 values")

    def test_rejects_points_that_the_engine_rejects(self):
        text = ("engine: morphological\nbase: {frame: {width: 16, height: 16, reference_samples: 1}}\n"
                "axes: {morphological.predictor: [none, fit], morphological.steps: [4, 8]}\n")
        self.reject(text, "the engine rejects the point morphological.predictor = none",
                    "has no effect", "refused: skip")
        self.write("s.yaml", text + "refused: skip\n")
        self.expect(0, "sweep", "s.yaml", "plan", says=("2 that the engine rejects", "2 points"))

    def test_rejects_invalid_conditional_axes(self):
        def axis(text):
            return ("engine: morphological\nbase: {frame: {width: 16, height: 16, reference_samples: 1}}\n"
                    "axes:\n  morphological.predictor: [none, fit]\n"
                    f"  morphological.steps: {text}\n")

        self.reject(axis("{values: [4], when: morphological.predicter != none}"),
                    "s.yaml:5: constraint 'morphological.predicter != none'", "did you mean 'morphological.predictor'")
        self.reject(axis("{values: [4], when: morphological.steps}"), "not true or false")
        self.reject(axis("{values: [4], where: true}"), "unknown 'where' (known: values, when)")
        self.reject(axis("{values: [], when: true}"), "axis 'morphological.steps' is empty")
        self.reject(axis("{when: true}"), "a range needs 'from' and 'to'")
        self.reject(axis("{values: [4], when: true}"), "the engine rejects the point")

    def test_rejects_unreadable_files(self):
        self.expect(5, "sweep", "nothing.yaml", "plan", says="cannot open 'nothing.yaml'")
        self.reject("engine: [\n", "s.yaml:", "not valid YAML")
        self.reject("- engine\n", "expected a map, got a list")
        self.write("s.yaml", BASE + AXES)
        self.expect(5, "sweep", "s.yaml", "status", says="no plan in 'out/sweeps/s'")
        self.expect(2, "sweep", "s.yaml", "polish", says="polish")


class Searches(Sweeps):
    GOALS = "objectives: {minimise: [cycles, memory_bits]}\n"

    def reject_search(self, text, *says, options=()):
        self.write("s.yaml", text)
        self.expect(2, "search", "s.yaml", *options, says=says)
        self.assertFalse(os.path.exists(self.path("out/points")))

    def test_rejects_what_cannot_be_searched(self):
        self.reject_search(BASE + AXES, "a search needs at least two objectives (0 given)")
        self.reject_search(BASE + AXES + "objectives: {minimise: [cycles]}\n", "(1 given)")
        self.reject_search(BASE + AXES + self.GOALS + "sample: {random: 3}\n", "leave out 'sample'")
        self.reject_search(BASE + "points: [{memory.latency: 50}]\n" + self.GOALS,
                           "a search needs 'axes'")
        self.reject_search(BASE + AXES + self.GOALS + "constraints: [memory.latency > 60]\n",
                           "no point was found", "'memory.latency > 60' excludes")
        self.reject_search(BASE + AXES + self.GOALS.replace(
            "]}", "], for_each: [memory.latency, texture.cache.ways]}"), "no axis is left to search")

    def test_rejects_invalid_budgets(self):
        text = BASE + AXES + self.GOALS.replace("]}", "], for_each: [memory.latency]}")
        self.reject_search(text, "--runs 12 leaves 6 for each of 2 fronts", "population of 8",
                           options=("--runs", "12", "--population", "8"))
        self.write("s.yaml", text)
        for option, value in (("--runs", "7"), ("--runs", "many"), ("--population", "10"),
                              ("--population", "4")):
            self.expect(2, "search", "s.yaml", option, value, says=option)

    def test_rejects_unknown_metric(self):
        self.write("s.yaml", BASE + AXES + "metrics: {cycles: cicles, bits: memory_bits.total.physical}\n"
                   "objectives: {minimise: [cycles, bits]}\n")
        self.expect(2, "search", "s.yaml", "--runs", "8",
                    says="s.yaml:4: metric 'cycles': no result of 'texture' has the key 'cicles': did you mean 'cycles'")

    def test_rejects_missing_or_foreign_plan(self):
        self.write("s.yaml", BASE + AXES + self.GOALS)
        self.expect(5, "search", "s.yaml", "status", says="no plan in 'out/searches/s'")
        self.expect(0, "search", "s.yaml", "--runs", "8")
        self.write("s.yaml", BASE + AXES.replace("60", "70") + self.GOALS)
        self.expect(2, "search", "s.yaml", "collect", says="search again")

    def test_full_disk_is_reported(self):
        self.write("s.yaml", BASE + AXES + self.GOALS)
        limit = {"preexec_fn": lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (20_000, 20_000))}
        done = self.expect(3, "search", "s.yaml", "--runs", "8", "-j1", says=("0 done", "missing"),
                           **limit)
        self.assertIn("cannot write", done.stderr)
        self.expect(0, "search", "s.yaml", "--runs", "8", says="4 done (4 in this run)")


class Surroundings(Sweeps):
    def test_rejects_unknown_metric(self):
        """Found before any point runs if no run can have the metric; otherwise when results are collected."""
        self.write("s.yaml", BASE + AXES + "metrics: {cycles: cicles}\n")
        for action in ("plan", "run"):
            self.expect(2, "sweep", "s.yaml", action,
                        says="s.yaml:4: metric 'cycles': no result of 'texture' has the key 'cicles': did you mean 'cycles'")
        for key, near in (("units.filter_pipeline.buzy", "units.filter_pipeline.busy"), ("/units/filter_pipelne/busy", "units.filter_pipeline.busy"),
                          ("work.bilinear", "work.bilinears"), ("1 + work.bilinear", "work.bilinears"),
                          ("cost.x", "cost.ns"), ("/cost/gates/valu", "cost.gates.value")):
            self.write("s.yaml", BASE + AXES + f"metrics: {{it: '{key}'}}\n")
            self.expect(2, "sweep", "s.yaml", "plan", says=("has the key", f"'{near}'"))
        self.write("s.yaml", BASE + AXES + "metrics: {psnr: quality.psnr_db}\n")
        self.expect(0, "sweep", "s.yaml", "run")
        self.expect(2, "sweep", "s.yaml", "collect", says="metric 'psnr': no result has the key 'quality.psnr_db'")

    def test_rejects_invalid_metric_expressions(self):
        def metric(text, *says):
            self.reject(BASE + AXES + f"metrics: {{it: '{text}'}}\n", "s.yaml:4: ", *says)

        metric("1 + 2", "metric 'it': '1 + 2' uses no key of result.json")
        metric("cycles +", "metric 'cycles +': unexpected end")
        metric("cycles 2", "unexpected '2'")
        metric("cycles > 2", "expected a number, got true or false")
        metric("2x * cycles", "'2x' is neither a key of result.json nor a number")

    def test_rejects_invalid_limits(self):
        def limit(text, *says):
            self.reject(BASE + AXES + f"metrics: {{cycles: cycles}}\nlimits: ['{text}']\n", "s.yaml:5: ", *says)

        limit("cycle < 10", "limit 'cycle < 10': 'cycle' is neither a metric nor a number: did you mean 'cycles'")
        limit("cycles", "limit 'cycles' is not a comparison of a metric by < <= > >=")
        limit("cycles == 10", "is not a comparison of a metric")
        limit("cycles > 1 and cycles < 3", "list several limits separately")
        limit("1 < 2", "is not a comparison of a metric")
        self.reject(BASE + AXES + "limits: cycles\n",
                    "'limits' must be a list of comparisons of metrics, such as 'cycles <= 10'")

    def test_unreadable_input_fails_only_its_points(self):
        """It fails only its own points; once it can be read, they are run."""
        self.write("good.png", png(16, 8))
        self.write("bad.png", png(16, 8)[:60])
        self.write("s.yaml", "engine: morphological\nbase: {run.images: false}\n"
                   "axes: {frame.source: [bad.png, good.png], morphological.lanes: [1, 2]}\n")
        self.expect(1, "sweep", "s.yaml", "run", says=("2 done", "2 failed", "'bad.png'"))
        self.write("bad.png", png(16, 8))
        self.expect(0, "sweep", "s.yaml", "run", says="4 points, 4 done (2 in this run)")

    def test_missing_ninja_is_reported(self):
        self.write("s.yaml", BASE + AXES)
        self.expect(5, "sweep", "s.yaml", "run", says="ninja was not found",
                    env={"PATH": "/nonexistent"})

    def test_names_with_special_characters_work(self):
        for out in ("a|b", "-x", "--retry", " a $b: 'c'"):
            name = "s|t.yaml" if out == "a|b" else "s.yaml"
            self.write(name, BASE + AXES)
            self.expect(0, "sweep", name, "run", f"--out={out}", says="4 points, 4 done (4 in this run)")
            self.expect(0, "sweep", name, "collect", f"--out={out}")
            stem = name.removesuffix(".yaml")
            self.assertTrue(os.path.exists(self.path(f"{out}/sweeps/{stem}/index.html")))
            self.expect(0, "run", "texture", "--size", "8x8", f"--out={out}/run")
            self.assertTrue(os.path.exists(self.path(f"{out}/run/result.json")))
        self.expect(0, "sweep", "s.yaml", "run", "--out", "-x", says="4 done (0 in this run)")

    def limited(self, size):
        return {"preexec_fn": lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))}

    def test_full_disk_fails_points(self):
        self.write("s.yaml", BASE + AXES)
        done = self.expect(3, "sweep", "s.yaml", "run", "-j1", says=("0 done", "4 missing"),
                           **self.limited(20_000))
        self.assertIn("cannot write", done.stderr)
        self.assertIn("raise the limit of file sizes", done.stderr)
        self.expect(0, "sweep", "s.yaml", "run", says="4 done (4 in this run)")
        self.expect(5, "sweep", "s.yaml", "collect", says="cannot write", **self.limited(20_000))
        self.assertFalse(os.path.exists(self.path("out/sweeps/s/index.html")))

    def test_full_disk_while_planning_is_reported(self):
        self.reject(BASE + "axes: {memory.latency: {from: 1, to: 1000}}\n", "points.jsonl",
                    code=5, **self.limited(20_000))


if __name__ == "__main__":
    unittest.main()
