#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Runs and sweeps of the hardware models through the Python module: figures, arrays and tables from the result files,
the golden model's picture equal to the hardware's, errors in the command's words, Ctrl-C.

usage: python_run_test.py MODULES [CLASS]"""
import builtins
import csv
import gc
import json
import os
import pathlib
import pickle
import re
import signal
import subprocess
import sys
import tempfile
import textwrap
import threading
import time
import unittest
import warnings

MODULES = pathlib.Path(sys.argv.pop(1)).resolve()
sys.dont_write_bytecode = True
sys.path.insert(0, str(MODULES))
SOURCE = pathlib.Path(__file__).resolve().parents[3]
sys.path.insert(1, str(SOURCE / "tb/engines"))

import numpy  # noqa: E402

import deburr  # noqa: E402
from deburr import _pictures, _program, golden  # noqa: E402
from engine_list import engines  # noqa: E402

TINY = {"scene": "tunnel", "size": (48, 48), "scene_texture_size": 64}


class Scratch(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="deburr_python_")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        before = os.getcwd()
        self.addCleanup(os.chdir, before)
        os.chdir(folder.name)


class Runs(Scratch):
    def test_figures_equal_the_file(self):
        run = deburr.run("texture", **TINY, memory_latency=50, windows=500, maps=True, out="out")
        file = json.loads((self.folder / "out/result.json").read_text(encoding="utf-8"))
        self.assertEqual(run.cycles, file["cycles"])
        self.assertEqual(run.verdict, "pass")
        self.assertEqual(run.throughput.value, file["throughput"]["value"])
        self.assertEqual(run["units.filter_pipeline.busy"], file["units"]["filter_pipeline"]["busy"])
        self.assertEqual(run.work.as_dict(), file["work"])
        self.assertIn("misses_per_texel", run.work)
        self.assertIn("[line/texel]", run.explain("work.misses_per_texel"))
        self.assertEqual(run.directory, (self.folder / "out").absolute())
        # Intervals add up to the run.
        intervals = run.intervals
        self.assertEqual(int(intervals.cycles.sum()), run.cycles)
        self.assertEqual(int(intervals["series.work.derivative_unit_fragments"].sum()), run.work.fragments)
        self.assertEqual(intervals["series.units.filter_pipeline.busy"].shape, (intervals.intervals,))
        for page in ("docs/reference/python.md", "examples/python/notebook.ipynb"):
            named = set(re.findall(r"series\.[a-z_.]+", (SOURCE / page).read_text(encoding="utf-8")))
            self.assertNotEqual(named, set(), page)
            self.assertEqual([series for series in named if series not in intervals], [], page)
        histogram = run.latency.histogram
        self.assertEqual(int(histogram[:, 1].sum()), run.work.fragments)
        for link in run.links.values():
            self.assertEqual(int(link.histogram.sum()), run.cycles)
        # Maps add up to the counters.
        self.assertEqual(set(run.maps), set(file["maps"]))
        misses = run.maps["misses"]
        self.assertEqual(misses.shape, (48, 48))
        self.assertEqual(float(numpy.nansum(misses)), file["maps"]["misses"]["sum"])
        for name, value in file["maps"].items():
            self.assertAlmostEqual(float(numpy.nanmax(run.maps[name])), value["max"], places=3)
        self.assertTrue((run.pictures["after"] == run.pictures["golden"]).all())
        self.assertEqual(run.pictures["after"].shape[:2], (48, 48))
        with self.assertRaises(KeyError):
            run.maps["mises"]
        with self.assertRaises(AttributeError) as caught:
            run.cicles
        self.assertIn("cycles", str(caught.exception))

    def test_arrays_are_input_and_output(self):
        """The hardware model's output for a frame from an array equals the golden model's output."""
        y, x = numpy.mgrid[0:60, 0:80]
        disc = (x - 40.3) ** 2 + (y - 30.2) ** 2 < 400
        image = numpy.zeros((60, 80, 4), dtype=numpy.uint8)
        image[..., 0], image[..., 1], image[..., 2], image[..., 3] = 200 * disc, 30 + 90 * disc, 3 * x, 255
        depth = numpy.where(disc, 0.75, 0.125).astype(numpy.float32)
        for given, depths in (({"preset": "smaa"}, {}), ({"preset": "deburr", "lanes": 4}, {}),
                              ({"morphological_edges_source": "depth"}, {"depth": depth})):
            run = deburr.run("morphological", in_=image, **depths, **given)
            frame = golden.morphological(image, depths.get("depth"),
                                         **{name.removeprefix("morphological_"): value for name, value in given.items()})
            self.assertTrue((run.pictures["after"][..., :3] == frame.pixels[..., :3]).all())
            self.assertGreater(frame.work.blended_pixels, 20)
            for name, value in frame.work.items():
                if name in run.work:
                    self.assertEqual(run.work[name], value, name)

    def test_parameter_names(self):
        """A parameter by each of its names."""
        cycles = {deburr.run("texture", **TINY, no_images=True, **one).cycles for one in (
            {"memory_latency": 300}, {"memory.latency": 300}, {"memory_latency": numpy.int64(300)},
            {"memory_latency": "300"})}
        self.assertEqual(len(cycles), 1)
        self.assertNotIn(deburr.run("texture", **TINY, run_images=False).cycles, cycles)
        config = self.folder / "run.yaml"
        config.write_text("memory.latency: 300\n", encoding="utf-8")
        self.assertIn(deburr.run("texture", config=config, **TINY).cycles, cycles)
        self.assertEqual(deburr.engines(), engines())
        self.assertIn("texture.cache.bytes", [row["name"] for row in deburr.parameters("texture")])

    def test_cost_of_a_build_equals_cost_of_its_run(self):
        """Frames per second need a run."""
        for given in ({}, {"texture_cache_bytes": 2048, "memory_latency": 300}):
            found = deburr.run("texture", **TINY, no_images=True, **given).cost.as_dict()
            self.assertGreater(found.pop("frames_per_s")["value"], 0)
            self.assertGreater(found.pop("run_frames_per_s"), 0)
            cost = deburr.cost("texture", **given)
            self.assertEqual(cost.as_dict(), found)
            self.assertGreater(cost.units.tag_stage.flip_flops, 0)
        with self.assertRaisesRegex(ValueError, "texture_cache_byte"):
            deburr.cost("texture", texture_cache_byte=2048)

    def test_files_are_removed_with_the_run(self):
        run = deburr.run("texture", **TINY)
        directory = run.directory
        self.assertTrue((directory / "report.html").exists())
        del run
        self.assertFalse(directory.exists())

    def test_runs_and_errors_can_be_pickled(self):
        run = deburr.run("texture", **TINY, windows=500, maps=True)
        copy = pickle.loads(pickle.dumps(run))
        self.assertIsInstance(copy, deburr.Run)
        directory, maps, pictures = run.directory, dict(run.maps), dict(run.pictures)
        figures, intervals = repr(run.as_dict()), repr(run.intervals.as_dict())
        del run
        gc.collect()
        self.assertFalse(directory.exists())
        self.assertEqual((repr(copy.as_dict()), repr(copy.intervals.as_dict())), (figures, intervals))
        self.assertEqual((list(copy.maps), list(copy.pictures)), (list(maps), list(pictures)))
        self.assertTrue((copy.pictures["after"] == pictures["after"]).all())
        self.assertIn("[line/texel]", copy.explain("work.misses_per_texel"))
        with self.assertRaises(deburr.RunError) as caught:
            deburr.run("texture", **TINY, fault="flip-bit")
        error = pickle.loads(pickle.dumps(caught.exception))
        self.assertEqual((str(error), error.code, error.result.cycles),
                         (str(caught.exception), caught.exception.code, caught.exception.result.cycles))

    def test_parallel_runs(self):
        found = {}

        def work(latency):
            found[latency] = deburr.run("texture", **TINY, memory_latency=latency, no_images=True).cycles
        threads = [threading.Thread(target=work, args=(latency,)) for latency in (20, 100, 400)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertLess(found[20], found[100])
        self.assertLess(found[100], found[400])


class Errors(Scratch):
    def rejected(self, words, error, *arguments, **named):
        with self.assertRaises(error) as caught:
            deburr.run(*arguments, **named)
        self.assertIn(words, str(caught.exception))
        return caught.exception

    def test_errors_have_the_commands_words(self):
        for given, words in (
                ({"texture_cache_bites": 5}, "unknown parameter 'texture_cache_bites'"),
                ({"texture.cache.bites": 5}, "did you mean 'texture.cache.bytes'"),
                ({"memory_latency": "soon"}, "'memory.latency' = 'soon'"), ({"memory_latency": -1}, "memory.latency"),
                ({"memory_latency": None}, "'memory.latency' = 'None'"), ({"preset": "smaa"}, "'texture.preset' = 'smaa'"),
                ({"texture_cache_bytes": 3000}, "must be a power of two"),
                ({"scene": "tunel"}, "tunel"), ({"size": 5}, "expected WIDTHxHEIGHT, got '5'"),
                ({"size": (5, 5, 5)}, "expected WIDTHxHEIGHT"), ({"scene": numpy.zeros((4, 4))}, "expected a picture")):
            with self.subTest(given):
                self.rejected(words, ValueError, "texture", **given)
        depth = numpy.full((16, 16), 0.5, numpy.float32)
        depth[3, 5] = numpy.nan
        frame = {"in_": numpy.zeros((16, 16, 3), numpy.uint8), "morphological_edges_source": "depth"}
        self.rejected("depth: 1 of 256 values are NaN, the first at (5, 3)", ValueError,
                      "morphological", depth=depth, **frame)
        self.rejected("depth: 1 of 256 values lie outside 0..16777215, the first at (5, 3)", ValueError, "morphological",
                      depth=numpy.where(numpy.isnan(depth), 1 << 24, 1).astype(numpy.uint32), **frame)
        depth[3, 5] = 2
        with self.assertWarnsRegex(UserWarning, r"depth: 1 of 256 values lie outside \[0, 1\]") as caught:
            deburr.run("morphological", depth=depth, **frame)
        self.assertEqual(caught.filename, __file__)
        self.rejected("no 'deburr run textur': did you mean", ValueError, "textur")
        self.rejected("None", ValueError, None)
        self.rejected("nothing.obj", OSError, "texture", in_="nothing.obj")
        (self.folder / "file").write_text("", encoding="utf-8")
        self.rejected("file", OSError, "texture", out="file", **TINY)
        # The same words as the command's own.
        said = subprocess.run([_program.program(), "run", "texture", "--set=texture.cache.bites=5"], text=True,
                              capture_output=True, check=False).stderr
        error = self.rejected("", ValueError, "texture", **{"texture.cache.bites": 5})
        self.assertIn(str(error), said)

    def test_failures_keep_their_results(self):
        error = self.rejected("FAIL mismatch", deburr.RunError, "texture", **TINY, fault="flip-bit")
        self.assertEqual(error.code, 1)
        self.assertGreater(error.result.checks.mismatches, 0)
        self.assertEqual(error.result.verdict, "fail")
        error = self.rejected("FAIL simulation", deburr.RunError, "texture", **TINY, max_cycles=100)
        self.assertEqual((error.code, error.result.cycles > 0), (3, True))

    def test_missing_command_is_an_error(self):
        program = _program._build.PROGRAM
        self.addCleanup(setattr, _program._build, "PROGRAM", program)
        _program._build.PROGRAM = "nowhere/deburr"
        path = os.environ["PATH"]
        self.addCleanup(os.environ.__setitem__, "PATH", path)
        os.environ["PATH"] = str(self.folder)
        self.rejected("install it", FileNotFoundError, "texture")

    def test_pictures_are_arrays(self):
        for shape in ((5, 7), (5, 7, 3), (5, 7, 4)):
            array = numpy.random.default_rng(3).integers(0, 256, shape, dtype=numpy.uint8)
            (self.folder / "a.png").write_bytes(_pictures.png_of(array))
            self.assertTrue((_pictures.read_png(self.folder / "a.png").reshape(shape) == array).all())
        (self.folder / "b.png").write_bytes(b"\x89PNG\r\n\x1a\nrest")
        for wrong in (numpy.zeros((5, 7, 2), numpy.uint8), numpy.zeros((0, 7), numpy.uint8), numpy.zeros((5, 7))):
            self.assertRaises(ValueError, _pictures.png_of, wrong)
        self.assertRaises(OSError, _pictures.read_png, self.folder / "b.png")


class Interrupted(Scratch):
    def test_ctrl_c_ends_a_run_and_its_process(self):
        """Sent only to Python, and to both as a terminal does."""
        program = textwrap.dedent(f"""
            import signal
            import sys
            sys.path.insert(0, {str(MODULES)!r})
            signal.signal(signal.SIGINT, signal.default_int_handler)
            import deburr
            print("go", flush=True)
            try:
                deburr.run("texture", scene="tunnel", size=(2048, 2048), out="out")
            except KeyboardInterrupt:
                print("interrupted", flush=True)
            """)
        claim = self.folder / "out/.deburr_run/claim.json"
        for whole_group in (False, True):
            claim.unlink(missing_ok=True)  # an interrupted run leaves it
            with subprocess.Popen(["/usr/bin/python3", "-B", "-c", program], text=True, stdout=subprocess.PIPE,
                                  start_new_session=True) as process:
                self.assertEqual(process.stdout.readline(), "go\n")
                for _ in range(600):
                    if claim.exists():
                        break
                    time.sleep(0.1)
                children = pathlib.Path(f"/proc/{process.pid}/task/{process.pid}/children").read_text(encoding="utf-8")
                (os.killpg if whole_group else os.kill)(process.pid, signal.SIGINT)
                self.assertEqual(process.stdout.read(), "interrupted\n")
                self.assertEqual(process.wait(), 0)
            self.assertNotEqual(children, "")
            for child in children.split():
                self.assertFalse(pathlib.Path(f"/proc/{child}").exists())


class Sweeps(Scratch):
    AXES = {"texture_cache_bytes": [1024, 2048, 4096], "memory_latency": [50, 100]}

    def rows(self, table):
        return table if isinstance(table, list) else table.to_dict("records")

    def test_latency_file(self):
        """A file of one latency acts as that latency, exactly; the name is relative to the working directory."""
        fifo = {"texture_cache_fifo_depth": 64, "no_images": True}  # not sized by memory.latency
        fixed = [deburr.run("texture", **TINY, **fifo, memory_latency=latency).cycles for latency in (99, 100, 101)]
        self.assertEqual(len(set(fixed)), 3)
        for latency, cycles in zip((99, 100, 101), fixed):
            (self.folder / "latencies.txt").write_text(f"# clk\n{latency}\n", encoding="utf-8")
            self.assertEqual(deburr.run("texture", **TINY, **fifo, memory_latency_file="latencies.txt").cycles, cycles)
            table = deburr.sweep("texture", {"memory_latency_file": [pathlib.Path("latencies.txt")]}, **TINY, **fifo,
                                 out="out", metrics=["cycles"])
            self.assertEqual([row["cycles"] for row in self.rows(table)], [cycles])

    def test_sweep_is_a_table_of_points(self):
        table = deburr.sweep("texture", self.AXES, **TINY, run_images=False, out="out", jobs=2,
                             metrics={"cycles": "cycles", "bits": "memory_bits.total.physical"},
                             minimise=["cycles", "bits"], for_each="memory_latency")
        rows = self.rows(table)
        self.assertEqual(len(rows), 6)
        with open("out/sweeps/sweep/collected.csv", encoding="utf-8") as file:
            collected = list(csv.DictReader(file))
        for row, line in zip(rows, collected):
            self.assertEqual(row["state"], "done")
            self.assertEqual((row["texture.cache.bytes"], row["memory.latency"], row["cycles"], row["bits"]),
                             tuple(int(line[name]) for name in ("texture.cache.bytes", "memory.latency", "cycles", "bits")))
            self.assertEqual(row["front"], line["front"] == "1")
        self.assertEqual(sorted((row["texture.cache.bytes"], row["memory.latency"]) for row in rows),
                         [(size, latency) for size in (1024, 2048, 4096) for latency in (50, 100)])
        # A point equals a separate run; existing results are not run again.
        alone = deburr.run("texture", **TINY, run_images=False, texture_cache_bytes=2048, memory_latency=100)
        self.assertIn(alone.cycles, [row["cycles"] for row in rows if row["texture.cache.bytes"] == 2048])
        results = {file: file.stat().st_mtime_ns for file in pathlib.Path("out/points").rglob("result.json")}
        again = deburr.sweep("texture", self.AXES, **TINY, run_images=False, out="out", metrics=["memory.bytes_read"])
        self.assertEqual({file: file.stat().st_mtime_ns for file in pathlib.Path("out/points").rglob("result.json")}, results)
        self.assertTrue(all(row["memory_bytes_read"] > 0 for row in self.rows(again)))

    def test_dictionaries_without_pandas(self):
        table = deburr.sweep("texture", {"memory_latency": [50]}, **TINY)
        imported = builtins.__import__

        def without(name, *arguments, **named):
            if name == "pandas":
                raise ImportError(name)
            return imported(name, *arguments, **named)
        builtins.__import__ = without
        try:
            plain = deburr.sweep("texture", {"memory_latency": [50]}, **TINY)
        finally:
            builtins.__import__ = imported
        self.assertIsInstance(plain, list)
        self.assertEqual(plain[0]["cycles"], self.rows(table)[0]["cycles"])
        try:
            import pandas
        except ImportError:
            self.skipTest("pandas is not installed: scripts/install python")
        self.assertIsInstance(table, pandas.DataFrame)

    def test_sweep_file_and_its_errors(self):
        file = self.folder / "cache.yaml"
        file.write_text("engine: texture\nbase: {scene: {source: tunnel, width: 48, height: 48, texture_size: 64}}\n"
                        "axes: {memory.latency: [50, 100]}\nmetrics: {cycles: cycles}\n", encoding="utf-8")
        rows = self.rows(deburr.sweep(file))
        self.assertEqual([row["memory.latency"] for row in rows], [50, 100])
        for words, arguments, named in (
                ("defines its own axes", (file, {"memory_latency": [50]}), {}),
                ("no 'deburr run textur'", ("textur", self.AXES), {}),
                ("axes: expected a dictionary", ("texture",), {}),
                ("unknown", ("texture", {"memory_latncy": [50]}), {}),
                ("memory.latency", ("texture", {"memory_latency": ["soon"]}), {}),
                ("no result of 'texture' has the key 'cycle'", ("texture", {"memory_latency": [50]}), {**TINY, "metrics": ["cycle"]}),
                ("unknown parameter", ("texture", {"memory_latency": [50]}), {"nobody": 1})):
            with self.subTest(words), self.assertRaises(ValueError) as caught:
                deburr.sweep(*arguments, **named)
            self.assertIn(words, str(caught.exception))

    def test_failed_points_are_rows(self):
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            table = deburr.sweep("texture", {"max_cycles": [100, 10_000_000]}, **TINY)
        rows = self.rows(table)
        self.assertEqual([row["state"] for row in rows], ["failed", "done"])
        self.assertIn("simulation", rows[0]["failure"])
        self.assertIn("1 of 2 points failed", str(caught[0].message))


if __name__ == "__main__":
    unittest.main()
