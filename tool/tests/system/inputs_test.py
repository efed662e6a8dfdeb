#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""The files that a run reads are in its keys and its manifest: a file named by another file counts like one named by
a parameter. After a texture, a material file or a buffer is replaced, sweeps, searches and regressions repeat
their points, and use the reference of the new file. A tracer compares the files that the command opens with those
it lists.

usage: inputs_test.py DEBURR [CLASS]"""
import base64
import glob
import json
import os
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../../tb/engines"))
from engine_list import trials  # noqa: E402
import zlib


def png(shade, width=16, height=16):
    """Stripes of 4 pixels; the light ones have this shade."""
    rows = b"".join(b"\0" + b"".join(bytes(3 * [shade if (x // 4 + y // 4) % 2 else 20])
                                     for x in range(width)) for y in range(height))

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0))
            + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


SQUARE = ("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
          "usemtl wood\nf 1/1 2/2 3/3 4/4\n")


def buffer_of(side):
    """Positions, texture coordinates and indices of a square."""
    return (struct.pack("<12f", 0, 0, 0, side, 0, 0, side, 1, 0, 0, 1, 0)
            + struct.pack("<8f", 0, 1, 1, 1, 1, 0, 0, 0) + struct.pack("<6H", 0, 1, 2, 0, 2, 3))


def gltf(buffer, image):
    """A textured square, whose buffer and image have these URIs."""
    views = [(0, 48), (48, 32), (80, 12)]
    return json.dumps({
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "indices": 2,
                                    "material": 0}]}],
        "materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}],
        "textures": [{"source": 0}], "images": [{"uri": image}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"},
                      {"bufferView": 1, "componentType": 5126, "count": 4, "type": "VEC2"},
                      {"bufferView": 2, "componentType": 5123, "count": 6, "type": "SCALAR"}],
        "bufferViews": [{"buffer": 0, "byteOffset": at, "byteLength": size} for at, size in views],
        "buffers": [{"byteLength": 92, "uri": buffer}]})


class InputsTest(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory(prefix="deburr_inputs_")
        self.addCleanup(scratch.cleanup)
        self.directory = os.path.realpath(scratch.name)

    def path(self, name):
        return os.path.join(self.directory, name)

    def write(self, name, content):
        os.makedirs(os.path.dirname(self.path(name)), exist_ok=True)
        with open(self.path(name), "wb") as file:
            file.write(content if isinstance(content, bytes) else content.encode())

    def write_obj(self):
        """A mesh in its own folder, with materials and a texture in another one."""
        self.write("meshes/m.obj", "mtllib none.mtl m.mtl\n" + SQUARE)
        self.write("meshes/m.mtl", "newmtl wood\nKd 1 1 1\nmap_Kd ../pictures/wood grain.png\n")
        self.write("pictures/wood grain.png", png(90))

    def write_gltf(self):
        self.write("meshes/m.gltf", gltf("b.bin", "../pictures/wood%20grain.png"))
        self.write("meshes/b.bin", buffer_of(1))
        self.write("pictures/wood grain.png", png(90))

    def deburr(self, *arguments, code=0, tracer=()):
        done = subprocess.run([*tracer, DEBURR, *arguments], cwd=self.directory, text=True,
                              capture_output=True, timeout=600)
        self.assertEqual(done.returncode, code, f"{arguments}\n{done.stdout}\n{done.stderr}")
        return done.stdout + done.stderr

    def load(self, name):
        with open(self.path(name)) as file:
            return json.load(file)


# Options for runs of each engine, and an axis that changes no picture.
ENGINES = trials("inputs")


class Replaced(InputsTest):
    def base(self, engine, mesh):
        source, more = (ENGINES[engine][key] for key in ("source", "base"))
        return (f"engine: {engine}\nbase: {{{source}: {{source: {mesh}, width: 24, height: 16}}, "
                f"{more}, run.images: false}}\n")

    def write_sweep(self, engine, mesh, points):
        axis, values = (ENGINES[engine][key] for key in ("axis", "values"))
        self.write("s.yaml", self.base(engine, mesh) + f"axes: {{{axis}: {list(values[:points])}}}\n"
                   "metrics: {psnr: quality.psnr_db, cycles: cycles}\n"
                   "objectives: {maximise: [psnr], minimise: [cycles]}\n")

    def run_sweep(self, ran):
        self.assertIn(f"({ran} in this run)", self.deburr("sweep", "s.yaml", "run", "-j2"))

    def figures(self):
        """Results of all points of the sweep by name, without figures of the host."""
        self.deburr("sweep", "s.yaml", "collect")
        results = {}
        for point in self.load("out/sweeps/s/collected.json")["points"]:
            folder = f"out/points/{point['name'][:2]}/{point['name']}"
            results[point["name"]] = (self.load(f"{folder}/result.json"),
                                      self.load(f"{folder}/manifest.json"))
            del results[point["name"]][0]["host"]
        return results

    def check_against_fresh_runs(self):
        """Each point equals a separate run of its command, which shares nothing; returns their quality."""
        quality = []
        for result, manifest in self.figures().values():
            command = manifest["command"].replace("deburr", f"'{DEBURR}'", 1) + " --out alone"
            done = subprocess.run(["bash", "-c", command], cwd=self.directory, text=True,
                                  capture_output=True, timeout=300)
            self.assertEqual(done.returncode, 0, done.stderr)
            alone = self.load("alone/result.json")
            del alone["host"]
            self.assertEqual(result, alone)
            self.assertEqual(manifest["inputs"], self.load("alone/manifest.json")["inputs"])
            self.assertEqual(manifest["golden"], self.load("alone/manifest.json")["golden"])
            quality.append(result["quality"]["psnr_db"])
        return quality

    def check_replaced(self, engine, mesh, file, content):
        """A file that the mesh names is replaced, and then restored."""
        self.write_sweep(engine, mesh, 2)
        self.run_sweep(2)
        self.run_sweep(0)
        before, inputs = self.figures(), self.load("out/sweeps/s/collected.json")["inputs"]
        with open(self.path(file), "rb") as now:
            old = now.read()
        self.write(file, content)
        self.assertRegex(self.deburr("sweep", "s.yaml", "plan"),
                         f"changed     '[^']*{os.path.basename(file)}' since")
        self.run_sweep(2)
        replaced = self.check_against_fresh_runs()
        self.assertNotEqual(replaced, [r["quality"]["psnr_db"] for r, _ in before.values()])
        # A new point has the new reference.
        self.write_sweep(engine, mesh, 3)
        self.run_sweep(1)
        self.check_against_fresh_runs()
        self.write(file, old)
        self.write_sweep(engine, mesh, 2)
        self.run_sweep(0)
        self.assertEqual(self.figures(), before)
        self.assertEqual(self.load("out/sweeps/s/collected.json")["inputs"], inputs)

    # One engine per kind of file: class Traced checks that all engines list these.
    def test_replaced_texture_of_obj_repeats_points(self):
        self.write_obj()
        self.check_replaced(list(ENGINES)[len(ENGINES) // 2], "meshes/m.obj", "pictures/wood grain.png", png(220))

    def test_replaced_texture_of_gltf_repeats_points(self):
        self.write_gltf()
        self.check_replaced(list(ENGINES)[0], "meshes/m.gltf", "pictures/wood grain.png", png(220))

    def test_replaced_buffer_of_gltf_repeats_points(self):
        self.write_gltf()
        self.check_replaced(list(ENGINES)[-1], "meshes/m.gltf", "meshes/b.bin", buffer_of(2))

    def test_materials_that_appear_later_repeat_points(self):
        """The first of two named files is missing, and then appears."""
        self.write_obj()
        self.write_sweep("texture", "meshes/m.obj", 2)
        self.run_sweep(2)
        self.write("pictures/other.png", png(220))
        self.write("meshes/none.mtl", "newmtl wood\nKd 1 1 1\nmap_Kd ../pictures/other.png\n")
        self.assertIn("changed     'meshes/none.mtl'", self.deburr("sweep", "s.yaml", "plan"))
        self.run_sweep(2)
        self.check_against_fresh_runs()
        manifest = next(iter(self.figures().values()))[1]
        self.assertEqual([entry["file"] for entry in manifest["inputs"]],
                         ["meshes/m.obj", "meshes/none.mtl", "meshes/../pictures/other.png"])
        os.remove(self.path("meshes/none.mtl"))
        self.run_sweep(0)

    def test_missing_texture_fails_points_until_it_exists(self):
        self.write_obj()
        os.remove(self.path("pictures/wood grain.png"))
        self.write_sweep("texture", "meshes/m.obj", 2)
        self.assertIn("2 failed", self.deburr("sweep", "s.yaml", "run", code=1))
        self.write("pictures/wood grain.png", png(90))
        self.run_sweep(2)
        self.check_against_fresh_runs()

    def test_redirected_link_repeats_points(self):
        self.write_obj()
        self.write("pictures/other.png", png(220))
        os.rename(self.path("pictures/wood grain.png"), self.path("pictures/old.png"))
        os.symlink("old.png", self.path("pictures/wood grain.png"))
        self.write_sweep("texture", "meshes/m.obj", 2)
        self.run_sweep(2)
        os.remove(self.path("pictures/wood grain.png"))
        os.symlink("other.png", self.path("pictures/wood grain.png"))
        self.run_sweep(2)
        self.check_against_fresh_runs()

    def test_file_named_like_a_scene_is_no_input(self):
        self.write("tunnel", "not the scene")
        self.write("brick", "not the texture")
        self.deburr("run", "texture", "--scene", "tunnel", "--texture", "brick", "--size", "16x16")
        self.assertEqual(self.load("out/texture/manifest.json")["inputs"], [])

    def test_search_repeats_points(self):
        self.write_obj()
        axis, values = (ENGINES["texture"][key] for key in ("axis", "values"))
        self.write("s.yaml", self.base("texture", "meshes/m.obj")
                   + f"axes: {{{axis}: {list(values)}, texture.cache.ways: [1, 2]}}\n"
                   "metrics: {psnr: quality.psnr_db, cycles: cycles}\n"
                   "objectives: {maximise: [psnr], minimise: [cycles]}\n")

        def search(*arguments, code=0):
            return self.deburr("search", "s.yaml", *arguments, "--runs", "8", code=code)

        self.assertIn("6 done (6 in this run)", search())
        self.assertIn("6 done (0 in this run)", search())
        before = self.load("out/searches/s/collected.json")
        self.write("pictures/wood grain.png", png(220))
        self.assertIn("search again", search("collect", code=2))
        self.assertIn("6 done (6 in this run)", search())
        after = self.load("out/searches/s/collected.json")
        self.assertNotEqual([p["values"] for p in before["points"]],
                            [p["values"] for p in after["points"]])
        self.write_sweep("texture", "meshes/m.obj", 3)
        self.run_sweep(0)
        self.check_against_fresh_runs()

    def test_regression_repeats_runs(self):
        self.write_obj()
        self.write("docs/p.md", "# Stalls\n")
        base = self.base("frame", "meshes/m.obj").split("\n")[1]
        self.write("t.yaml", "features:\n  - id: a\n    title: A\n"
                   "    traces: [docs/p.md#stalls]\n"
                   f"    stimuli: [{{name: s, engine: frame, seeds: 2, {base}}}]\n"
                   "    checks: {colours: 1}\n")

        def results():
            return {path: os.stat(path).st_ino
                    for path in glob.glob(self.path("out/points/*/*/result.json"))}

        def regress():
            self.deburr("regress", "t.yaml", "run", "--seed", "7")
            return self.load("out/regressions/t-7/collected.json")

        first = regress()
        old = results()
        regress()
        self.assertEqual((len(old), results()), (2, old))
        self.write("pictures/wood grain.png", png(220))
        self.assertIn("2 points over 2 inputs, 0 already done",
                      self.deburr("regress", "t.yaml", "plan", "--seed", "7"))
        second = regress()
        self.assertEqual(len(results()), 4, "two runs more")
        self.assertNotEqual(first["inputs"], second["inputs"])
        self.assertEqual({entry["file"]: entry.get("role") for entry in second["inputs"]},
                         {"t.yaml": "testplan", "docs/p.md": "page", "meshes/m.obj": None,
                          "meshes/none.mtl": None, "meshes/m.mtl": None,
                          "meshes/../pictures/wood grain.png": None})

    def test_comparison_names_different_inputs(self):
        """Only inputs that differ are named, for runs and for sweeps."""
        self.write_obj()
        self.write_sweep("texture", "meshes/m.obj", 2)

        def everything(out):
            for engine in ENGINES:
                self.deburr("run", engine, "--in", "meshes/m.obj", "--size", "24x16", "--no-images",
                            "--out", f"{out}/{engine}")
            self.deburr("sweep", "s.yaml", "run", "--out", f"{out}/all")
            self.deburr("sweep", "s.yaml", "collect", "--out", f"{out}/all")

        everything("a")
        everything("b")
        self.write("pictures/wood grain.png", png(220))
        everything("c")
        for what in (*ENGINES, "all/sweeps/s"):
            with self.subTest(what):
                self.assertNotIn("warning", self.deburr("compare", f"a/{what}", f"b/{what}"))
                done = subprocess.run([DEBURR, "compare", f"a/{what}", f"b/{what}", f"c/{what}"],
                                      cwd=self.directory, text=True, capture_output=True, timeout=60)
                warning = [line for line in done.stderr.splitlines() if "inputs differ" in line]
                self.assertEqual(len(warning), 1, done.stderr)
                self.assertEqual(warning[0].count("wood grain.png"), 2)
                self.assertIn("(B is C here)", warning[0])
                self.assertNotIn("m.obj", warning[0])

    def test_configuration_is_listed_and_changes_no_key(self):
        self.write("one.yaml", "scene: {width: 16, height: 16}\n")
        self.write("two.yaml", "# as the other\nscene: {width: 16, height: 16}\n")
        for name in ("one", "two"):
            self.deburr("run", "texture", "--config", f"{name}.yaml", "--out", name)
        one, two = self.load("one/manifest.json"), self.load("two/manifest.json")
        self.assertEqual([(e["file"], e["role"]) for e in one["inputs"]], [("one.yaml", "configuration")])
        self.assertNotEqual(one["inputs"][0]["sha256"], two["inputs"][0]["sha256"])
        self.assertEqual(one["golden"], two["golden"])
        self.assertNotIn("warning", self.deburr("compare", "one", "two"))

    def test_rejects_mesh_that_names_a_result_file(self):
        """It would be another mesh in the next run."""
        self.write_obj()
        self.write("meshes/m.mtl", "newmtl wood\nmap_Kd ../out/texture/after.png\n")
        self.write("out/texture/after.png", png(90))
        self.deburr("run", "texture", "--in", "meshes/m.obj", "--size", "16x16", code=2)

    def test_rejects_pipes_and_folders_at_once(self):
        """A pipe would block, and can be read only once."""
        self.write_obj()
        os.remove(self.path("meshes/m.mtl"))
        for make in (os.mkfifo, os.mkdir):
            make(self.path("meshes/m.mtl"))
            self.assertIn("'meshes/m.mtl'", self.deburr("run", "texture", "--in", "meshes/m.obj", code=5))
            self.write_sweep("texture", "meshes/m.obj", 2)
            self.assertIn("2 failed", self.deburr("sweep", "s.yaml", "run", code=1))
            (os.rmdir if make is os.mkdir else os.remove)(self.path("meshes/m.mtl"))
        self.write_gltf()
        os.remove(self.path("meshes/b.bin"))
        os.mkfifo(self.path("meshes/b.bin"))
        self.assertIn("'meshes/b.bin'", self.deburr("run", "texture", "--in", "meshes/m.gltf", code=5))

    def test_standard_input_may_be_a_file(self):
        """Redirected input is a file; a pipe is not."""
        self.write("f.png", png(90))
        command = [DEBURR, "run", "morphological", "--in", "/dev/stdin", "--no-images"]
        with open(self.path("f.png")) as file:
            done = subprocess.run(command, cwd=self.directory, stdin=file, text=True,
                                  capture_output=True, timeout=60)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.deburr("run", "morphological", "--in", "f.png", "--no-images", "--out", "named")
        streamed, named = self.load("out/morphological/manifest.json"), self.load("named/manifest.json")
        self.assertEqual(streamed["inputs"][0]["sha256"], named["inputs"][0]["sha256"])
        done = subprocess.run(command, cwd=self.directory, input=png(90), capture_output=True, timeout=60)
        self.assertEqual(done.returncode, 5)
        self.assertIn(b"not a regular file", done.stderr)


OPENED = re.compile(r'open(?:at2?)?\(.*O_(?:RDONLY|RDWR).*\) += \d+<(?P<path>[^>]*)>$')

UNFINISHED = re.compile(r"^(?P<process>\d+) (?P<begin>.*) <unfinished \.\.\.>$")
RESUMED = re.compile(r"^(?P<process>\d+) <\.\.\. \w+ resumed>(?P<rest>.*)$")


def whole_calls(log):
    """The calls of a trace, one per line: strace splits a call if another process interrupts it."""
    begun = {}
    for line in log:
        line = line.strip()
        if cut := UNFINISHED.match(line):
            begun[cut["process"]] = cut["begin"]
        elif rest := RESUMED.match(line):
            yield f"{rest['process']} {begun.pop(rest['process'])}{rest['rest']}"
        else:
            yield line


def differences(listed, opened, once=()):
    """Differences between listed and opened files. A file is opened once to read it and once to list it; files in
    `once` are listed from what was read."""
    wrong = [f"opened and not listed: {path}" for path in sorted(set(opened) - set(listed))]
    return wrong + [f"listed and not read: {path}" for path in sorted(set(listed))
                    if opened.count(path) < (1 if path in once else 2)]


class Traced(InputsTest):
    def setUp(self):
        super().setUp()
        strace = shutil.which("strace")
        if strace is None:
            self.skipTest("no strace: install it")
        self.log = self.path("out/strace.log")
        self.tracer = [strace, "-f", "-y", "-qq", "-s", "4096", "-e", "trace=open,openat,openat2",
                       "-e", "signal=none", "-o", self.log]
        os.mkdir(self.path("out"))
        tried = subprocess.run([*self.tracer, "true"], text=True, capture_output=True)
        if tried.returncode != 0:
            self.skipTest(f"no tracing here: {tried.stderr.strip()}")

    def opened(self, *arguments):
        """The files of this folder, without those of out/, that the command opens, once per open call."""
        self.deburr(*arguments, tracer=self.tracer)
        paths = []
        with open(self.log) as log:
            for line in whole_calls(log):
                found = OPENED.search(line)
                if found and os.path.isfile(found["path"]):
                    paths.append(found["path"])
        own = [path for path in paths if path.startswith(self.directory + "/")]
        return [path for path in own if not path.startswith(self.path("out/"))]

    def listed(self, inputs):
        """Existing files, by their real paths."""
        for entry in inputs:
            self.assertEqual("sha256" in entry, os.path.isfile(self.path(entry["file"])), entry)
        return [os.path.realpath(self.path(entry["file"])) for entry in inputs if "sha256" in entry]

    def check(self, inputs, opened, least):
        listed = self.listed(inputs)
        once = self.listed([entry for entry in inputs if entry.get("role") == "configuration"])
        self.assertEqual(differences(listed, opened, once), [])
        self.assertGreaterEqual(len(listed), least)
        # Faults that it finds: a file that is read but not listed, and one that is listed but not read.
        for missing in range(len(listed)):
            cut = listed[:missing] + listed[missing + 1:]
            self.assertEqual(differences(cut, opened, once), [f"opened and not listed: {listed[missing]}"])
        self.assertEqual(differences([*listed, "/more"], opened, once), ["listed and not read: /more"])

    def check_run(self, engine, *arguments, least):
        opened = self.opened("run", engine, *arguments, "--out", "out/run")
        self.check(self.load("out/run/manifest.json")["inputs"], opened, least)

    def test_split_calls_are_joined(self):
        cut = ['7 openat(AT_FDCWD</w>, "a", O_RDONLY <unfinished ...>', '8 open("b", O_RDONLY) = 3</w/b>',
               "7 <... openat resumed>) = 4</w/a>", '9 open("c", O_RDONLY <unfinished ...>',
               "9 <... open resumed>)             = 5</w/c>"]  # strace aligns the text after short calls
        self.assertEqual([OPENED.search(call)["path"] for call in whole_calls(cut)],
                         ["/w/b", "/w/a", "/w/c"])

    def test_lists_meshes_of_every_engine(self):
        self.write_obj()
        self.write_gltf()
        os.symlink("m.mtl", self.path("meshes/link.mtl"))
        self.write("meshes/linked.obj", "mtllib link.mtl\nmtllib link.mtl\n" + SQUARE)
        inside = "data:application/octet-stream;base64," + base64.b64encode(buffer_of(1)).decode()
        self.write("meshes/inside.gltf", gltf(inside, "../pictures/wood grain.png"))
        for engine in ENGINES:
            for mesh, least in (("m.obj", 3), ("m.gltf", 3), ("linked.obj", 3), ("inside.gltf", 2)):
                with self.subTest(f"{engine} {mesh}"):
                    self.check_run(engine, "--in", f"meshes/{mesh}", "--size", "16x16", least=least)

    def test_lists_textures_and_configurations(self):
        self.write_obj()
        self.write("t.png", png(220))
        self.write("c.yaml", "run.seed: 3\n")
        for engine in ("texture", "frame"):
            for scene in ("--scene=road", "--scene=cube", "--scene=cylinders", "--in=meshes/m.obj"):
                with self.subTest(f"{engine} {scene}"):
                    self.check_run(engine, scene, "--size", "16x16", "--texture", "t.png", "--truth",
                                   "--config", "c.yaml", least=1)

    def test_lists_fragments(self):
        self.write_obj()
        self.deburr("run", "texture", "--in", "meshes/m.obj", "--size", "16x16", "--fragment-trace",
                    "text", "--out", "out/traced")
        shutil.copy(self.path("out/traced/fragments.trace"), self.path("f.trace"))
        self.check_run("texture", "--in", "meshes/m.obj", "--fragments", "f.trace", least=4)

    def test_lists_latencies(self):
        self.write("l.txt", "40\n90\n")
        for engine, memory in (("texture", "memory"), ("geometric", "memory"), ("morphological", "memory"),
                               ("frame", "memory"), ("frame", "frame_memory")):
            with self.subTest(f"{engine} {memory}"):
                storage = ["--storage", "memory"] if engine in ("morphological", "frame") else []
                self.check_run(engine, "--size", "32x32", *storage, "--set", f"{memory}.latency_file=l.txt", least=1)

    def test_lists_frames(self):
        for name, shade in (("f", 90), ("t", 100), ("d", 30), ("m", 200)):
            self.write(f"frames/{name}.png", png(shade))
        files = [word for name, option in (("f", "--in"), ("t", "--truth"), ("d", "--depth"), ("m", "--mask"))
                 for word in (option, f"frames/{name}.png")]
        self.check_run("morphological", *files, "--set", "morphological.edges.source=depth", least=4)

    def test_lists_sequences(self):
        self.write_obj()
        self.check_run("texture", "--in", "meshes/m.obj", "--size", "16x16", "--frames", "2", least=3)

    def test_file_is_read_once_for_all_points(self):
        self.write_obj()
        self.write_gltf()
        times = []
        for latencies in (2, 12):
            self.write("s.yaml", "engine: texture\nchunk: 100\n"
                       "base: {scene: {width: 16, height: 16}, run.reference: true, run.images: false}\n"
                       "axes: {scene.source: [meshes/m.obj, meshes/m.gltf], "
                       f"memory.latency: {{from: 50, to: {49 + latencies}}}}}\n")
            opened = self.opened("sweep", "s.yaml", "run")
            times.append({path: opened.count(path) for path in opened if "s.yaml" not in path})
            shutil.rmtree(self.path("out/points"))
            shutil.rmtree(self.path("out/sweeps"))
        self.assertEqual(times[0], times[1])
        self.assertEqual(len(times[0]), 5)

    def check_points(self, command, name, collected, *, least):
        opened = self.opened(command, name, "run", *(("--seed", "7") if command == "regress" else ()),
                             *(("--runs", "8") if command == "search" else ()))
        if command == "sweep":
            opened += self.opened(command, name, "collect")
        inputs = self.load(collected)["inputs"]
        self.check(inputs, opened, least)
        of_points = [entry["file"] for path in glob.glob(self.path("out/points/*/*/manifest.json"))
                     for entry in self.load(path)["inputs"]]
        self.assertEqual(set(of_points), {entry["file"] for entry in inputs if "role" not in entry})

    def test_points_list_their_files(self):
        self.write_obj()
        self.write_gltf()
        base = "{scene: {width: 16, height: 16}, run.reference: true, run.images: false}"
        axes = "axes: {scene.source: [meshes/m.obj, meshes/m.gltf], memory.latency: [50, 60]}\n"
        goals = "objectives: {minimise: [cycles, memory_bits]}\n"
        self.write("s.yaml", f"engine: texture\nbase: {base}\n{axes}{goals}")
        self.check_points("sweep", "s.yaml", "out/sweeps/s/collected.json", least=6)
        shutil.rmtree(self.path("out/points"))
        self.check_points("search", "s.yaml", "out/searches/s/collected.json", least=6)
        shutil.rmtree(self.path("out/points"))
        self.write("docs/p.md", "# Stalls\n")
        self.write("plans/t.yaml", "features:\n  - id: a\n    title: A\n"
                   "    traces: [docs/p.md#stalls]\n"
                   f"    stimuli: [{{name: s, engine: texture, base: {base}, {axes.strip()}}}]\n"
                   "    checks: {colours: 1}\n")
        self.check_points("regress", "plans/t.yaml", "out/regressions/t-7/collected.json", least=7)


if __name__ == "__main__":
    DEBURR = os.path.abspath(sys.argv.pop(1))
    unittest.main()
