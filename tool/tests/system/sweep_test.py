#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Sweeps and searches: the name of a point depends on everything that its result depends on; points run once, survive
kill -9, and are collected.

usage: sweep_test.py DEBURR [CLASS]"""
import csv
import glob
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

POINTS = 12
SWEEP = """
engine: texture
base:
  scene: {source: tunnel, width: 48, height: 48, texture_size: 64}
  run.images: false
axes:
  texture.cache.bytes: [1024, 2048, 4096]
  texture.cache.ways: [1, 2]
  memory.latency: {from: 50, to: 100, times: 2}
metrics: {cycles: cycles, bits: memory_bits.total.physical, lines: /memory/lines_filled}
objectives: {minimise: [cycles, bits]}
"""


def results_in(directory):
    """Inode and content of every result: a result that was simulated again has another inode."""
    found = {}
    for path in glob.glob(os.path.join(directory, "out/points/*/*/result.json")):
        with open(path) as file:
            content = json.load(file)
        del content["host"]
        found[os.path.basename(os.path.dirname(path))] = (os.stat(path).st_ino, content)
    return found


class SweepTest(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory(prefix="deburr_sweep_")
        self.addCleanup(scratch.cleanup)
        self.directory = scratch.name

    def write(self, name, text):
        with open(os.path.join(self.directory, name), "w") as file:
            file.write(text)

    def said(self, name, *arguments, code=0, command="sweep"):
        done = subprocess.run([DEBURR, command, name, *arguments], cwd=self.directory, text=True,
                              capture_output=True, timeout=300)
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return done.stdout.strip().splitlines()

    def run_sweep(self, name, *arguments, **how):
        return self.said(name, *arguments, **how)[-1]

    def search(self, name, *arguments, code=0):
        return self.run_sweep(name, *arguments, code=code, command="search")

    def start_sweep(self, name, *arguments, command="sweep"):
        process = subprocess.Popen([DEBURR, command, name, "run", *arguments], cwd=self.directory,
                                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        return process

    def rows(self, name, command="sweep", code=0):
        self.run_sweep(f"{name}.yaml", "collect", command=command, code=code)
        kind = {"sweep": "sweeps", "search": "searches"}[command]
        with open(os.path.join(self.directory, f"out/{kind}/{name}/collected.csv")) as file:
            return list(csv.DictReader(file))

    def page(self, name):
        with open(os.path.join(self.directory, f"out/sweeps/{name}/index.html")) as file:
            return file.read()

    def results(self):
        return results_in(self.directory)


class Points(SweepTest):
    def test_plan_run_status_and_collect(self):
        self.write("cache.yaml", SWEEP)
        self.assertIn("12 points over 1 input, 0 already done", self.run_sweep("cache.yaml", "plan"))
        self.assertIn("12 done (12 in this run), 0 failed", self.run_sweep("cache.yaml", "run", "-j2"))
        self.assertIn("12 of 12 points done", self.run_sweep("cache.yaml", "status"))
        rows = self.rows("cache")
        self.assertEqual(len(rows), POINTS)
        for row in rows:
            with open(os.path.join(self.directory, row["directory"], "result.json")) as file:
                result = json.load(file)
            self.assertEqual(result["verdict"], "pass")
            self.assertEqual(int(row["cycles"]), result["cycles"])
            self.assertEqual(int(row["bits"]), result["memory_bits"]["total"]["physical"])
            self.assertEqual(int(row["lines"]), result["memory"]["lines_filled"])
        # The front by its definition.
        cost = [(int(r["cycles"]), int(r["bits"])) for r in rows]
        for row, mine in zip(rows, cost):
            dominated = any(o[0] <= mine[0] and o[1] <= mine[1] and o != mine for o in cost)
            self.assertEqual(row["front"], "0" if dominated else "1")

    def test_metrics_of_several_keys_and_limits(self):
        """Expressions computed by hand from the results; no point beyond a limit is on the front, including in a
        search."""
        text = SWEEP.split("metrics:")[0] + """
metrics:
  hits: work.lookup_hits_percent
  kib: memory_bits.total.physical / 0x2000
  cycles_a_fragment: cycles / work.fragments - 0
  read: memory.read_gb_per_s
limits: [hits >= LEAST, cycles_a_fragment < 1e6]
objectives: {minimise: [kib, cycles_a_fragment]}
"""
        self.write("limits.yaml", text.replace("LEAST", "-1"))
        self.run_sweep("limits.yaml", "run")
        least = sorted(float(row["hits"]) for row in self.rows("limits"))[POINTS // 2]
        self.assertIn(", 0 beyond the limits", self.run_sweep("limits.yaml", "collect"))
        self.assertIn("No point is beyond a limit.", self.page("limits"))
        self.write("limits.yaml", text.replace("LEAST", repr(least)))
        rows = self.rows("limits")
        for row in rows:
            with open(os.path.join(self.directory, row["directory"], "result.json")) as file:
                result = json.load(file)
            work = result["work"]
            self.assertEqual(float(row["kib"]), result["memory_bits"]["total"]["physical"] / 8192)
            self.assertEqual(float(row["cycles_a_fragment"]), result["cycles"] / work["fragments"])
            self.assertEqual(float(row["read"]), result["memory"]["read_gb_per_s"])
            self.assertEqual(row["beyond"], "" if float(row["hits"]) >= least else f"hits >= {least!r}")
        within = [row for row in rows if row["beyond"] == ""]
        self.assertTrue(0 < len(within) < POINTS, within)
        cost = [(float(row["kib"]), float(row["cycles_a_fragment"])) for row in within]
        self.assertEqual([row["front"] for row in within],
                         ["0" if any(o[0] <= c[0] and o[1] <= c[1] and o != c for o in cost) else "1" for c in cost])
        self.assertNotIn("1", [row["front"] for row in rows if row["beyond"]])
        self.assertIn(f", {POINTS - len(within)} beyond the limits", self.run_sweep("limits.yaml", "collect"))
        page = self.page("limits")
        self.assertIn(f"{POINTS - len(within)} points, the crosses, are beyond a limit.", page)
        self.assertEqual(len(re.findall(r'<tr class="beyond">', page)), POINTS - len(within))
        front = {row["point"] for row in rows if row["front"] == "1"}
        self.search("limits.yaml", "--runs", str(POINTS), "--population", "8")
        self.assertEqual({row["point"] for row in self.rows("limits", command="search") if row["front"] == "1"}, front)

    def test_front_of_cycles_and_gates(self):
        """A second fragment per cycle costs gates and, with many samples per fragment, saves no cycle."""
        self.write("gates.yaml", "engine: texture\nbase: {scene: {source: plane, width: 24, height: 24}, run.images: false}\n"
                   "points:\n- {texture.width: 1, texture.fragments: 1}\n- {texture.width: 2, texture.fragments: 2}\n"
                   "- {texture.width: 2, texture.fragments: 1}\n"
                   "metrics: {cycles: cycles, gates: cost.gates, ns: cost.ns.value, sum: /cost/estimate/gates}\n"
                   "limits: [ns > 0]\nobjectives: {minimise: [cycles, gates]}\n")
        self.run_sweep("gates.yaml", "run")
        said, rows, results = self.said("gates.yaml", "collect"), self.rows("gates"), self.results()
        self.assertEqual([row["front"] for row in rows], ["1", "0", "1"])
        self.assertRegex(said[0], r"^front .*, gates = [\d,]+ gate, ns = [\d.]+ ns, ")
        for row in rows:
            cost = results[row["point"]][1]["cost"]
            self.assertEqual([float(row[name]) for name in ("gates", "ns", "sum")],
                             [cost["gates"]["value"], cost["ns"]["value"], cost["estimate"]["gates"]])

    def test_small_front_is_printed(self):
        """Each point with its axes and metrics; larger fronts are only on the page. The same for a search."""
        text = SWEEP.replace("metrics: {", "metrics: {none: cycles / (work.fragments - work.fragments), ")
        self.write("front.yaml", text)
        self.run_sweep("front.yaml", "run")
        sizes = set()
        for objectives in ("minimise: [bits]", "minimise: [cycles]", "minimise: [cycles, bits], maximise: [lines]",
                           "minimise: [bits], maximise: [cycles]"):
            self.write("front.yaml", text.replace("minimise: [cycles, bits]", objectives))
            front = [row for row in self.rows("front") if row["front"] == "1"]
            sizes.add(len(front))
            axes = ("texture.cache.bytes", "texture.cache.ways", "memory.latency")
            metrics = (("cycles", " clk"), ("bits", " bit"), ("lines", " line"))
            lines = ["front       " + ", ".join(f"{axis} = {row[axis]}" for axis in axes) + ": none = none, " +
                     ", ".join(f"{name} = {int(row[name]):,}{unit}" for name, unit in metrics) for row in front]
            said = [line for line in self.said("front.yaml", "collect") if line.startswith("front ")]
            self.assertEqual(said, lines if len(front) <= 3 else [], objectives)
            self.assertEqual(len(self.said("front.yaml", "collect", "--quiet")), 1)
        self.assertTrue(sizes & {1, 2, 3} and max(sizes) > 3, sizes)
        said = self.said("front.yaml", "--runs", str(POINTS), "--population", "8", command="search")
        self.assertCountEqual([line for line in said if line.startswith("front ")], lines)

    def test_table_without_script_has_every_point(self):
        """Every point with its values, the front first, and links to existing files."""
        self.write("cache.yaml", SWEEP + "reports: false\n")
        self.run_sweep("cache.yaml", "run")
        rows = self.rows("cache")
        place = os.path.join(self.directory, "out/sweeps/cache")
        with open(os.path.join(place, "index.html")) as file:
            page = file.read()
        self.assertNotRegex(page, r'<canvas id="[^"]*">', "each chart says in words what it shows")
        table = re.search(r"(?s)<noscript>.*?</noscript>", page)[0]
        self.assertIn('<th class="n">cycles (clk)</th>', table)
        lines = re.findall(r'<tr(?: class="(front)")?>(<td.*?)</tr>', table)
        cells = [[re.sub("<[^>]*>", "", cell) for cell in re.findall("<td.*?</td>", line)] for _, line in lines]
        fronts = sum(row["front"] == "1" for row in rows)
        self.assertEqual([front for front, _ in lines], ["front"] * fronts + [""] * (POINTS - fronts))
        axes = ("texture.cache.bytes", "texture.cache.ways", "memory.latency", "cycles", "bits", "lines")
        self.assertEqual(sorted(cells), sorted([row[axis] for axis in axes] + [row["point"][:8]] for row in rows))
        for link in re.findall(r'href="([^"]*)"', table):
            self.assertTrue(os.path.exists(os.path.join(place, link)), link)
        data = json.loads(re.search(r'<script type="application/json" id="data">(.*?)</script>', page)[1])
        self.assertFalse(data["reports"], "so the script links no report")

    def test_point_equals_a_run_of_its_command(self):
        self.write("cache.yaml", SWEEP)
        self.run_sweep("cache.yaml", "run")
        row = self.rows("cache")[5]
        with open(os.path.join(self.directory, row["directory"], "manifest.json")) as file:
            command = json.load(file)["command"]
        again = subprocess.run(["bash", "-c", command.replace("deburr", f"'{DEBURR}'", 1)],
                               cwd=self.directory, text=True, capture_output=True)
        self.assertEqual(again.returncode, 0, again.stderr)
        with open(os.path.join(self.directory, "out/texture/result.json")) as file:
            alone = json.load(file)
        with open(os.path.join(self.directory, row["directory"], "result.json")) as file:
            point = json.load(file)
        del alone["host"], point["host"]
        self.assertEqual(alone, point)

    def test_nothing_runs_twice_across_sweeps(self):
        self.write("cache.yaml", SWEEP)
        self.run_sweep("cache.yaml", "run")
        before = self.results()
        self.assertIn("(0 in this run)", self.run_sweep("cache.yaml", "run"))
        self.write("wider.yaml", SWEEP.replace("ways: [1, 2]", "ways: [1, 2, 4]"))
        self.assertIn("18 points, 18 done (6 in this run)", self.run_sweep("wider.yaml", "run"))
        after = self.results()
        self.assertEqual({name: after[name] for name in before}, before)
        self.assertEqual(len(after), 18)

    def test_other_engines_named_choices_and_seeds(self):
        for engine, base in (("morphological", "frame.reference_samples: 2"), ("frame", "run.check: none")):
            source = "frame" if engine == "morphological" else "scene"
            self.write(f"{engine}.yaml", f"""
engine: {engine}
base: {{{base}, run.images: false}}
axes:
  picture:
    small: {{{source}.width: 24, {source}.height: 16}}
    wide: {{{source}.width: 32, {source}.height: 8}}
  morphological.lanes: [1, 2]
  run.seed: {{from: 1, to: 2}}
constraints: [morphological.lanes == 1 or {source}.width > 24]
""")
            self.assertIn("6 points, 6 done", self.run_sweep(f"{engine}.yaml", "run"))
            rows = self.rows(engine)
            self.assertEqual({row["picture"] for row in rows}, {"small", "wide"})
            self.assertEqual(rows[0]["state"], "done")

    def test_samples_are_repeatable(self):
        """A Latin hypercube hits each stratum once; samples are the same every time."""
        text = SWEEP.split("axes:")[0] + """
axes:
  memory.latency: {from: 1, to: 80}
  texture.cache.fifo_depth: {from: 2, to: 401, step: 1}
sample: {SAMPLE: 8, seed: 3}
"""
        self.write("latin.yaml", text.replace("SAMPLE", "latin"))
        self.run_sweep("latin.yaml", "plan")
        rows = self.rows("latin")
        self.assertEqual(sorted((int(r["memory.latency"]) - 1) // 10 for r in rows), list(range(8)))
        self.assertEqual(sorted((int(r["texture.cache.fifo_depth"]) - 2) // 50 for r in rows),
                         list(range(8)))
        os.remove(os.path.join(self.directory, "out/sweeps/latin/plan.json"))
        self.run_sweep("latin.yaml", "plan")
        self.assertEqual(self.rows("latin"), rows)
        self.write("random.yaml", text.replace("SAMPLE", "random") +
                   "constraints: [memory.latency <= 40 and not memory.latency % 2 == 1]\n")
        self.run_sweep("random.yaml", "plan")
        latencies = [int(r["memory.latency"]) for r in self.rows("random")]
        self.assertEqual(len(latencies), 8)
        self.assertTrue(all(x <= 40 and x % 2 == 0 for x in latencies), latencies)

    def test_axis_applies_only_where_it_has_an_effect(self):
        self.write("when.yaml", """
engine: morphological
base: {frame: {width: 24, height: 16, reference_samples: 1}, run.images: false}
axes:
  morphological.steps: {from: 4, to: 8, times: 2, when: morphological.predictor != none}
  morphological.predictor: [none, fit]
  morphological.lanes: [1, 2]
""")
        self.assertIn("6 points, 6 done", self.run_sweep("when.yaml", "run"))
        rows = self.rows("when")
        self.assertEqual({(r["morphological.predictor"], r["morphological.steps"]) for r in rows},
                         {("none", "-"), ("fit", "4"), ("fit", "8")})
        with open(os.path.join(self.directory, "out/sweeps/when/collected.json")) as file:
            collected = json.load(file)
        self.assertEqual(collected["left_out"], [])
        self.assertEqual(collected["axes"][0]["labels"], ["4", "8", "-"])
        for row in rows:
            with open(os.path.join(self.directory, row["directory"], "manifest.json")) as file:
                manifest = json.load(file)
            given = row["morphological.steps"]
            self.assertEqual("steps" in manifest["command"], given != "-")
            if given != "-":
                self.assertEqual(str(manifest["configuration"]["morphological.steps"]), given)

    def test_changed_input_makes_other_points(self):
        triangle = "v 0 0 0\nv {} 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n"
        self.write("mesh.obj", triangle.format(1))
        self.write("mesh.yaml", "engine: texture\n"
                   "base: {scene: {source: mesh.obj, width: 16, height: 16}, run.images: false}\n"
                   "axes: {memory.latency: [50, 60]}\n")
        self.run_sweep("mesh.yaml", "run")
        first = self.results()
        self.write("mesh.obj", triangle.format(2))
        self.assertIn("(2 in this run)", self.run_sweep("mesh.yaml", "run"))
        self.assertEqual(len(self.results()), 4)
        self.write("mesh.obj", triangle.format(1))
        self.assertIn("(0 in this run)", self.run_sweep("mesh.yaml", "run"))
        self.assertEqual({n: e for n, e in self.results().items() if n in first}, first)

    def identical_pictures(self):
        """A uniform frame is its own reference; a chessboard is not."""
        for name, pixels in (("flat.pgm", [200] * 64),
                             ("chess.pgm", [255 * ((i + i // 8) % 2) for i in range(64)])):
            with open(os.path.join(self.directory, name), "wb") as file:
                file.write(b"P5 8 8 255\n" + bytes(pixels))
        self.write("picture.yaml", """
engine: texture
base:
  scene: {source: plane, width: 32, height: 32}
  run: {images: false, reference: true}
axes:
  scene.texture: [chess.pgm, flat.pgm]
  texture.cache.bytes: [1024, 4096]
  texture.cache.ways: [1, 2]
metrics: {psnr: quality.psnr_db, edges: quality.psnr_edge_db, bits: memory_bits.total.physical}
objectives: {maximise: [psnr], minimise: [bits]}
""")

    def test_identical_picture_is_best_and_not_missing(self):
        self.identical_pictures()
        self.run_sweep("picture.yaml", "run")
        rows = self.rows("picture")
        with open(os.path.join(self.directory, "out/sweeps/picture/collected.json")) as file:
            collected = json.load(file, parse_constant=self.fail)  # no NaN, no Infinity
        for row, point in zip(rows, collected["points"]):
            flat = row["scene.texture"] == "flat.pgm"
            with open(os.path.join(self.directory, row["directory"], "result.json")) as file:
                quality = json.load(file, parse_constant=self.fail)["quality"]
            self.assertEqual(quality["identical"]["psnr_db"], flat)
            self.assertEqual(quality["psnr_db"] is None, flat)
            self.assertEqual((row["psnr"] == "inf", point["values"][0] is None), (flat, flat))
            # It has no edges, so no value, and it does not count as identical.
            self.assertEqual(point.get("identical", []), ["psnr"] if flat else [])
            self.assertEqual(row["edges"] == "", flat)
        # The smallest memory with the best picture beats all others.
        least = min(int(row["bits"]) for row in rows)
        for row in rows:
            best = row["psnr"] == "inf" and int(row["bits"]) == least
            self.assertEqual(row["front"], "1" if best else "0", row)
        # A search also treats it as the best, and a comparison as equal to itself.
        self.search("picture.yaml", "--runs", "8")
        self.assertEqual({(row["psnr"], int(row["bits"])) for row in
                          self.rows("picture", command="search") if row["front"] == "1"},
                         {("inf", least)})
        self.run_compare("out/sweeps/picture", "out/sweeps/picture")
        flat, chess = (next(r["directory"] for r in rows if r["scene.texture"] == name)
                       for name in ("flat.pgm", "chess.pgm"))
        loose = ("--cycles-percent", "1000", "--throughput-percent", "99")
        self.assertIn("worse: quality.psnr_db, quality.flip, quality.ssim;",
                      self.run_compare(flat, chess, *loose, code=1) + ";")
        # Its edge quality, which no longer exists, is missing; the picture quality is not.
        self.assertIn("worse: quality.psnr_edge_db,", self.run_compare(chess, flat, *loose, code=1))

    def test_missing_metric_values_are_explained(self):
        self.identical_pictures()
        self.write("none.yaml", """
engine: texture
base:
  scene: {source: plane, width: 32, height: 32}
  run.images: false
axes:
  scene.texture: [chess.pgm, flat.pgm]
  run.reference: [true, false]
metrics:
  inverse: 1 / quality.flip
  edges: quality.psnr_edge_db
  gain: quality.psnr_db - quality.psnr_before_db
  less: -quality.psnr_db
  huge: 1e308 * cycles
  name: throughput.unit
  cycles: cycles
limits: [cycles / inverse >= 0]
objectives: {minimise: [inverse, cycles]}
""")
        flat = {"inverse": "division by zero", "edges": "quality.psnr_edge_db is null",
                "gain": "not defined for the infinite PSNR of identical pictures", "less": "minus infinity"}
        always = {"huge": "too large for a number", "name": "throughput.unit is not a number"}
        no_reference = {name: f"no key '{key}' in the result" for name, key in
                    (("inverse", "quality.flip"), ("edges", "quality.psnr_edge_db"), ("gain", "quality.psnr_db"),
                     ("less", "quality.psnr_db"))}
        counts = {(name, reason): points for reasons, points in ((flat, 1), (always, 4), (no_reference, 2))
                  for name, reason in reasons.items()}
        self.run_sweep("none.yaml", "run")
        for command in ("sweep", "search"):
            arguments = ("none.yaml", "collect") if command == "sweep" else ("none.yaml", "--runs", "8")
            done = subprocess.run([DEBURR, command, *arguments], cwd=self.directory, text=True, capture_output=True)
            self.assertEqual(done.returncode, 0, done.stderr)
            said = dict(re.findall(r"(?m)^no value    (.* points: .*)()$", done.stdout))
            self.assertEqual(set(said), {f"{name} in {points} of 4 points: {reason}"
                                         for (name, reason), points in counts.items()})
            answer = json.loads(subprocess.run([DEBURR, command, *arguments, "--json"], cwd=self.directory, text=True,
                                               capture_output=True).stdout)["result"]
            self.assertEqual({(e["metric"], e["reason"]): e["points"] for e in answer["no_value"]}, counts)
            names = [metric["name"] for metric in answer["metrics"]]
            for point in answer["points"]:
                texture, reference = point["at"]
                self.assertEqual(point["no_value"], always | (no_reference if reference == "false" else
                                                              flat if texture == "flat.pgm" else {}))
                self.assertEqual({name for name, value in zip(names, point["values"]) if value is None},
                                 set(point["no_value"]))
                # A limit that cannot be computed is not met.
                self.assertEqual("beyond" in point, "inverse" in point["no_value"])
                self.assertEqual(point.get("front", False), "inverse" not in point["no_value"])
            place = {"sweep": "sweeps", "search": "searches"}[command]
            with open(os.path.join(self.directory, f"out/{place}/none/index.html")) as file:
                page = file.read()
            self.assertIn("<li>inverse in 1 of 4 points: division by zero</li>", page)
            self.assertEqual(page.count('<td class="n" title="division by zero">none</td>'), 1)
        self.write("cache.yaml", SWEEP.replace("metrics: {", "limits: [cycles / wrong >= 0]\nmetrics: {wrong: checks.mismatches, "))
        self.run_sweep("cache.yaml", "run")
        self.assertIn(f", {POINTS} beyond the limits", self.run_sweep("cache.yaml", "collect"), "it divides by zero")
        with open(os.path.join(self.directory, "out/sweeps/cache/index.html")) as file:
            self.assertNotIn("Metrics without a value", file.read(), "every point has every one")

    def run_compare(self, *arguments, code=0):
        return self.run_sweep(*arguments, code=code, command="compare")

    def test_damaged_cache_is_rebuilt(self):
        text = SWEEP.replace("run.images: false", "run.images: false\n  run.reference: true")
        self.write("reference.yaml", text.replace("metrics: {", "metrics: {psnr: quality.psnr_db, "))
        self.run_sweep("reference.yaml", "run")
        before = self.results()
        kept = [f for f in glob.glob(os.path.join(self.directory, "out/cache/*/*"))
                if not f.endswith(".lock")]
        self.assertEqual(len(kept), 1)
        with open(kept[0], "r+b") as file:
            file.seek(200)
            file.write(b"damage")
        shutil.rmtree(os.path.join(self.directory, "out/points"))
        self.run_sweep("reference.yaml", "run")
        after = self.results()
        self.assertEqual({n: e[1] for n, e in after.items()}, {n: e[1] for n, e in before.items()})

    def test_failed_points_are_listed_and_stop_no_other(self):
        self.write("fault.yaml", SWEEP.replace("axes:", "  run.fault: flip-bit\naxes:")
                   .replace("width: 48", "width: 24"))
        self.assertIn("0 done (0 in this run), 12 failed",
                      self.run_sweep("fault.yaml", "run", code=1))
        self.assertIn("FAIL sweep fault: 0 of 12 points collected, 12 failed",
                      self.run_sweep("fault.yaml", "collect", code=1))
        rows = self.rows("fault", code=1)
        self.assertEqual({row["state"] for row in rows}, {"failed"})
        self.assertIn("mismatch: colours: 1 mismatches", rows[0]["failure"])
        before = {n: e[0] for n, e in self.results().items()}
        self.run_sweep("fault.yaml", "run", code=1)
        self.assertEqual({n: e[0] for n, e in self.results().items()}, before, "not run again")
        self.run_sweep("fault.yaml", "run", "--retry", code=1)
        self.assertNotEqual({n: e[0] for n, e in self.results().items()}, before)


SEARCH = SWEEP.replace("bytes: [1024, 2048, 4096]", "bytes: [1024, 2048, 4096, 8192]").replace(
    "width: 48, height: 48", "width: 24, height: 24").replace(
        "  memory.latency:", "  texture.cache.fifo_depth: [4, 16, 64]\n  memory.latency:")


class Searched(SweepTest):
    """48 points, of which a search requests some."""

    def test_search_results_equal_the_sweep(self):
        self.write("wide.yaml", SEARCH)
        self.assertIn("20 points, 20 done (20 in this run)",
                      self.search("wide.yaml", "--runs", "20", "-j2"))
        before = self.results()
        self.assertEqual(len(before), 20)
        self.assertIn("PASS search wide: 20 of 20 points done", self.search("wide.yaml", "status"))
        self.assertTrue(os.path.exists(os.path.join(self.directory,
                                                    "out/searches/wide/index.html")))
        found = self.rows("wide", "search")
        self.assertEqual({row["point"] for row in found}, set(before))
        self.assertIn("20 points, 20 done (0 in this run)",
                      self.search("wide.yaml", "--runs", "20", "-j1"))
        self.assertEqual(self.rows("wide", "search"), found, "the same points in the same order")
        self.assertIn("48 done (28 in this run)", self.run_sweep("wide.yaml", "run", "-j2"))
        self.assertEqual({n: e for n, e in self.results().items() if n in before}, before)
        # A search of all points finds the whole front; a smaller one stays on its own points.
        everything = self.rows("wide")
        self.assertIn("48 points, 48 done (0 in this run)",
                      self.search("wide.yaml", "--runs", "90", "--population", "8"))

        def front(rows):
            return {row["point"] for row in rows if row["front"] == "1"}
        self.assertEqual(front(self.rows("wide", "search")), front(everything))
        values = {row["point"]: (row["cycles"], row["bits"]) for row in everything}
        self.assertEqual({r["point"]: (r["cycles"], r["bits"]) for r in found},
                         {r["point"]: values[r["point"]] for r in found})

    def test_search_depends_only_on_the_seed(self):
        self.write("wide.yaml", SEARCH)
        asked = {}
        for seed, out in (("1", "a"), ("1", "b"), ("2", "a")):
            self.search("wide.yaml", "--runs", "16", "--seed", seed, "--out", out,
                        "-j1" if out == "a" else "-j2")
            with open(os.path.join(self.directory, out, "searches/wide/points.jsonl")) as file:
                asked[seed + out] = file.read()
        self.assertEqual(asked["1a"], asked["1b"])
        self.assertNotEqual(asked["1a"], asked["2a"])

    def test_constraints_and_separate_fronts(self):
        self.write("wide.yaml", SEARCH.replace(
            "minimise: [cycles, bits]", "minimise: [cycles, bits], for_each: [memory.latency]")
            + "constraints: [texture.cache.ways == 1 or texture.cache.bytes > 1024]\n")
        self.assertIn("17 points, 17 done", self.search("wide.yaml", "--runs", "17"))
        rows = self.rows("wide", "search")
        latencies = [row["memory.latency"] for row in rows]
        self.assertEqual((latencies.count("50"), latencies.count("100")), (9, 8))
        for row in rows:
            self.assertTrue(row["texture.cache.ways"] == "1"
                            or int(row["texture.cache.bytes"]) > 1024)

    def test_failed_points_count_as_the_worst(self):
        self.write("wide.yaml", SEARCH.replace("axes:", "  run.max_cycles: 700\naxes:"))
        text = self.search("wide.yaml", "--runs", "16", code=1)
        self.assertIn("0 missing", text)
        states = [row["state"] for row in self.rows("wide", "search", code=1)]
        self.assertEqual(len(states), 16)
        self.assertIn("failed", states)

    def test_stopped_search_resumes(self):
        self.write("wide.yaml", SEARCH.replace("width: 24, height: 24", "width: 160, height: 160"))
        for victim in (signal.SIGTERM, signal.SIGKILL):
            before = len(self.results())
            process = self.start_sweep("wide.yaml", "--runs", "20", "-j2", command="search")
            deadline = time.monotonic() + 120
            while len(self.results()) < before + 3 and time.monotonic() < deadline:
                time.sleep(0.02)
            process.send_signal(victim)
            self.assertEqual(process.wait(), 130 if victim == signal.SIGTERM else -victim)
            time.sleep(1)  # the workers end with it
        kept = self.results()
        self.assertGreaterEqual(len(kept), 6)
        self.assertIn("points done", self.search("wide.yaml", "status"))
        self.assertIn("20 points, 20 done", self.search("wide.yaml", "--runs", "20", "-j2"))
        after = self.results()
        self.assertEqual(len(after), 20)
        self.assertEqual({name: after[name] for name in kept}, kept)
        self.search("wide.yaml", "--runs", "20", "-j2", "--out", "whole")
        with open(os.path.join(self.directory, "whole/searches/wide/points.jsonl")) as file:
            whole = file.read()
        with open(os.path.join(self.directory, "out/searches/wide/points.jsonl")) as file:
            self.assertEqual(file.read(), whole)


class Failing(SweepTest):
    """A failed point stays failed, whichever other process ran the point or was killed while running it."""

    def setUp(self):
        super().setUp()
        self.faulty = SWEEP.replace("  run.images: false", "  run: {images: false, fault: flip-bit}")
        self.write("faulty.yaml", self.faulty)

    def test_failure_without_reason_is_run_again(self):
        self.assertIn("0 done (0 in this run), 12 failed", self.run_sweep("faulty.yaml", "run", "-j2", code=1))
        reasons = glob.glob(os.path.join(self.directory, "out/points/*/*/failure.json"))
        self.assertEqual(len(reasons), POINTS)
        for reason in reasons:
            os.remove(reason)
        self.assertIn("0 of 12 points done", self.run_sweep("faulty.yaml", "status"))
        self.assertIn("0 done (0 in this run), 12 failed", self.run_sweep("faulty.yaml", "run", "-j2", code=1))
        for reason in reasons:
            self.assertTrue(os.path.exists(reason))

    def test_repro_command_runs_the_failed_point(self):
        for command in ("sweep", "search"):
            done = subprocess.run([DEBURR, command, "faulty.yaml", "run", "-j2"], cwd=self.directory, text=True,
                                  capture_output=True)
            self.assertEqual(done.returncode, 1, done.stderr)
            failed = re.search(r"(?m)^failed      (\S+): mismatch: ", done.stdout)[1]
            repro = re.search(r"(?m)^REPRO: (.*)$", done.stdout)[1]
            self.assertTrue(repro.startswith(f"{DEBURR} run texture --set "), repro)
            again = subprocess.run(["bash", "-c", repro], cwd=self.directory, text=True, capture_output=True)
            self.assertEqual(again.returncode, 1, again.stderr)
            with open(os.path.join(self.directory, "out/texture/manifest.json")) as file:
                alone = json.load(file)
            with open(os.path.join(self.directory, failed, "manifest.json")) as file:
                point = json.load(file)
            for key in ("configuration", "golden"):
                self.assertEqual(alone[key], point[key])

    def test_two_sweeps_share_points(self):
        self.write("other.yaml", self.faulty)
        for process in [self.start_sweep(name, "-j2") for name in ("faulty.yaml", "other.yaml")]:
            self.assertEqual(process.wait(), 1)
        self.assertEqual(len(glob.glob(os.path.join(self.directory, "out/points/*/*/failure.json"))), POINTS)


class Killed(SweepTest):
    """kill -9 of a point, a worker, Ninja and the command: nothing is lost, no partial point counts."""

    def setUp(self):
        super().setUp()
        # Points of half a second each, so that every process is still alive when it is killed.
        self.write("slow.yaml", SWEEP.replace("width: 48, height: 48", "width: 160, height: 160"))

    def victims(self, process, name):
        """Living processes below the command: 'ninja', 'worker' or 'point'."""
        deadline = time.monotonic() + 60
        while time.monotonic() < deadline and process.poll() is None:
            listing = subprocess.run(["ps", "-eo", "pid=,ppid=,args="], text=True,
                                     capture_output=True).stdout
            table = {int(l.split()[0]): (int(l.split()[1]), l.split(None, 2)[2])
                     for l in listing.splitlines() if len(l.split()) > 2}
            ninjas = [p for p, (parent, _) in table.items() if parent == process.pid]
            workers = [p for p, (parent, args) in table.items()
                       if parent in ninjas and "sweep-worker" in args]
            points = [p for p, (parent, _) in table.items() if parent in workers]
            found = {"ninja": ninjas, "worker": workers, "point": points}[name]
            if found and points:
                return found
            time.sleep(0.005)
        self.fail(f"no living {name}")

    def check_resumed(self, kept):
        """A further run executes only the missing points."""
        self.run_sweep("slow.yaml", "run", "-j2")
        after = self.results()
        self.assertEqual(len(after), POINTS)
        self.assertEqual({name: after[name] for name in kept}, kept)
        for path in glob.glob(os.path.join(self.directory, "out/points/*/*")):
            self.assertEqual(sorted(os.listdir(path)),
                             ["manifest.json", "report.html", "result.json"])
        reference = tempfile.mkdtemp(dir=self.directory)
        self.run_sweep("slow.yaml", "run", "-j2", "--out", reference)
        for path in glob.glob(os.path.join(reference, "points/*/*/result.json")):
            with open(path) as file:
                content = json.load(file)
            del content["host"]
            self.assertEqual(content, after[os.path.basename(os.path.dirname(path))][1])

    def kill(self, victim, *arguments):
        process = self.start_sweep("slow.yaml", *arguments)
        for pid in self.victims(process, victim):
            try:
                os.kill(pid, signal.SIGKILL)
            except ProcessLookupError:
                pass
        return process

    def test_killed_point_loses_nothing(self):
        process = self.kill("point", "-j1")
        self.assertEqual(process.wait(), 1)
        self.assertIn("11 of 12 points done", self.run_sweep("slow.yaml", "status"))
        self.check_resumed(self.results())

    def test_killed_worker_loses_nothing(self):
        process = self.kill("worker", "-j1")
        self.assertIn(process.wait(), (0, 3))
        self.check_resumed(self.results())

    def test_killed_ninja_loses_nothing(self):
        process = self.kill("ninja", "-j2")
        self.assertEqual(process.wait(), 3)
        time.sleep(1)  # the workers end with it
        self.check_resumed(self.results())

    def test_killed_command_loses_nothing(self):
        process = self.start_sweep("slow.yaml", "-j2")
        self.victims(process, "point")
        process.kill()
        process.wait()
        time.sleep(1)
        kept = self.results()
        self.assertLess(len(kept), POINTS)
        self.check_resumed(kept)

    def test_interrupted_run_loses_nothing(self):
        process = self.start_sweep("slow.yaml", "-j2")
        self.victims(process, "point")
        process.send_signal(signal.SIGTERM)
        self.assertEqual(process.wait(), 130)
        kept = self.results()
        self.assertLess(len(kept), POINTS)
        for _, content in kept.values():
            self.assertNotIn("interrupted", content)
        self.check_resumed(kept)

    def test_second_run_is_rejected(self):
        process = self.start_sweep("slow.yaml", "-j1")
        self.victims(process, "point")
        self.assertIn("is being run by another process", self.run_sweep("slow.yaml", "run", code=5))
        status = self.run_sweep("slow.yaml", "status")
        self.assertNotIn("12 of 12", status)
        process.wait()
        self.assertEqual(len(self.results()), POINTS)


if __name__ == "__main__":
    if len(sys.argv) < 2 or sys.argv[1] in ("-h", "--help"):
        print(__doc__)
        sys.exit(0 if len(sys.argv) >= 2 else 2)
    DEBURR = os.path.abspath(sys.argv.pop(1))
    unittest.main()
