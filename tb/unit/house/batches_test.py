#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Checks the sources that this build compiles, and their batches (cmake/Layers.cmake): every source of the
tree is compiled, by one target and once, and a batch has at most forty sources. With DEBURR_UNITY off, as in
the preset `dev`, every file is compiled separately.
usage: batches_test.py SOURCE BUILD [unittest options]"""
import collections
import json
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

SOURCE, BUILD = (pathlib.Path(sys.argv.pop(1)).resolve() for _ in range(2))
LAYERS = ("spec", "golden", "rtl_model", "tb", "tool", "studies")
BATCH = re.compile(r"_batch_\d+\.cpp$")
INCLUDE = re.compile(r'^#include "(.+)"$', re.M)
MOST = 40
# Compiled conditionally: with the presets asan, fuzz and hdl, or if the EGL headers are installed.
SOMETIMES = {"tb/unit/scene/leaks.cpp", "tb/fuzz/fuzzer.cpp", "tb/fuzz/write_seeds.cpp",
             "tb/oracle/mesa_context.cpp", "tb/oracle/mesa_device.cpp", "tb/oracle/mesa_test.cpp",
             "tb/oracle/smaa_shader.cpp", "tb/oracle/smaa_shader_test.cpp",
             *(path.relative_to(SOURCE).as_posix() for path in (SOURCE / "tb/hdl").glob("*.cpp"))}
# The generated source and s5.cpp have their own compile settings, so each is a batch of one file.
TINY = """cmake_minimum_required(VERSION 3.25)
project(tiny LANGUAGES CXX)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
include({source}/cmake/Options.cmake)
include({source}/cmake/Layers.cmake)
file(WRITE "${{PROJECT_BINARY_DIR}}/made.cpp" "")
foreach(number RANGE 1 56)
  file(WRITE "${{PROJECT_BINARY_DIR}}/../golden/s${{number}}.cpp" "")
  list(APPEND sources "${{PROJECT_SOURCE_DIR}}/golden/s${{number}}.cpp")
endforeach()
set_source_files_properties("${{PROJECT_SOURCE_DIR}}/golden/s5.cpp" PROPERTIES COMPILE_OPTIONS -O2)
deburr_library(many LAYER golden SOURCES ${{sources}} "${{PROJECT_BINARY_DIR}}/made.cpp")
deburr_library(one LAYER golden SOURCES "${{PROJECT_SOURCE_DIR}}/golden/s1.cpp")
foreach(name a b c d e)
  file(WRITE "${{PROJECT_BINARY_DIR}}/../golden/${{name}}.cpp" "")
  set(${{name}} "${{PROJECT_SOURCE_DIR}}/golden/${{name}}.cpp")
endforeach()
deburr_library(mixed LAYER golden SOURCES ${{a}} ${{b}} NOT_SIMULATED ${{c}} ${{d}})
deburr_library(light LAYER golden NOT_SIMULATED ${{e}})
"""


def units_of(build, source):
    """{object file: its sources} for each translation unit of the tree `source`."""
    units = {}
    for entry in json.loads((build / "compile_commands.json").read_text(encoding="utf-8")):
        path = pathlib.Path(entry["directory"], entry["file"])
        # Targets have separate object folders, so the object file identifies the unit.
        unit = re.search(r" -o (\S+)", entry["command"])[1]
        units[unit] = [path.resolve()]
        if BATCH.search(path.name):
            units[unit] = [source / name for name in INCLUDE.findall(path.read_text(encoding="utf-8"))]
    return units


def problems(units, source, built):
    """Yields the errors in the units of a build of the tree `source`, whose files are `built`."""
    times = collections.Counter(path.relative_to(source).as_posix() for unit in units.values()
                                for path in unit if path.is_relative_to(source))
    for name in sorted(set(built) - set(times)):
        yield f"nothing compiles {name}"
    for name, count in sorted(times.items()):
        if count > 1 and name in built:
            yield f"{name} is compiled {count} times"
    for unit, sources in sorted(units.items()):
        if len(sources) > MOST:
            yield f"{unit}: {len(sources)} sources in a batch"


class Batches(unittest.TestCase):
    def tiny(self, *options):
        scratch = tempfile.TemporaryDirectory(prefix="deburr_batches_")
        self.addCleanup(scratch.cleanup)
        root = pathlib.Path(scratch.name).resolve()
        (root / "golden").mkdir()
        (root / "CMakeLists.txt").write_text(TINY.format(source=SOURCE), encoding="utf-8")
        subprocess.run(["cmake", "-G", "Ninja", "-S", root, "-B", root / "build",
                        "-DCMAKE_BUILD_TYPE=Release", *options], check=True, capture_output=True)
        commands = json.loads((root / "build/compile_commands.json").read_text(encoding="utf-8"))
        self.light = {re.search(r" -o (\S+)", entry["command"])[1] for entry in commands
                      if re.search(" -O3 .* -Og ", entry["command"])}
        units = units_of(root / "build", root)
        self.light = sorted(path.name for unit in self.light for path in units[unit])
        return sorted([path.name for path in unit] for unit in units.values())

    def test_batches_have_equal_size_and_exclude_separate_sources(self):
        units = self.tiny()
        alone = [unit for unit in units if len(unit) == 1]
        self.assertEqual(alone, [["e.cpp"], ["made.cpp"], ["s1.cpp"], ["s5.cpp"]])
        batches = [unit for unit in units if len(unit) > 1]
        self.assertEqual(sorted(len(unit) for unit in batches), [2, 2, 27, 28])
        self.assertEqual(sum(batches[2:], []), [f"s{n}.cpp" for n in range(1, 57) if n != 5])

    def test_unsimulated_sources_form_faster_compiled_batches(self):
        units = self.tiny()
        self.assertIn(["a.cpp", "b.cpp"], units)
        self.assertIn(["c.cpp", "d.cpp"], units)
        self.assertEqual(self.light, ["c.cpp", "d.cpp", "e.cpp"])

    def test_unity_off_compiles_every_file_separately(self):
        self.assertEqual([len(unit) for unit in self.tiny("-DDEBURR_UNITY=OFF")], [1] * 63)
        self.assertEqual(self.light, ["c.cpp", "d.cpp", "e.cpp"])

    def test_only_preset_dev_disables_unity(self):
        presets = json.loads((SOURCE / "CMakePresets.json").read_text(encoding="utf-8"))
        set_to = {p["name"]: p["cacheVariables"].get("DEBURR_UNITY", "ON")
                  for p in presets["configurePresets"]}
        self.assertEqual({name for name, value in set_to.items() if value == "OFF"}, {"dev"})

    def test_this_build_compiles_every_source_once(self):
        built = {path.relative_to(SOURCE).as_posix() for layer in LAYERS
                 for path in (SOURCE / layer).rglob("*.cpp")} - SOMETIMES
        units = units_of(BUILD, SOURCE)
        self.assertEqual(list(problems(units, SOURCE, built)), [])
        unity = "DEBURR_UNITY:BOOL=ON" in (BUILD / "CMakeCache.txt").read_text(encoding="utf-8")
        self.assertEqual(any(len(unit) > 1 for unit in units.values()), unity)

    def test_injected_faults_are_detected(self):
        root, built = pathlib.Path("/tree"), {"tb/a.cpp", "tb/b.cpp"}
        good = {"x.o": [root / "tb/a.cpp", root / "tb/b.cpp"], "y.o": [pathlib.Path("/made.cpp")]}
        self.assertEqual(list(problems(good, root, built)), [])
        for fault in ({"x.o": [root / "tb/a.cpp"]},
                      {**good, "z.o": [root / "tb/a.cpp"]},
                      {**good, "z.o": [pathlib.Path(f"/{n}.cpp") for n in range(MOST + 1)]}):
            self.assertEqual(len(list(problems(fault, root, built))), 1, fault)


if __name__ == "__main__":
    unittest.main()
