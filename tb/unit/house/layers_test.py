#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Checks the dependency rules of the layers in the sources.

The include paths of the build already separate golden and rtl_model; this test also finds relative paths, forbidden
words and missing licence lines, and reports the line and the rule.
"""
import pathlib
import re
import tempfile

from house_main import house_main

# layer -> layers whose headers it may include
ALLOWED = {
    "spec": {"spec"},
    "golden": {"spec", "golden"},
    "rtl_model": {"spec", "rtl_model"},
    "python": {"spec", "golden", "python"},
    "tb": {"spec", "golden", "rtl_model", "tb"},
    "tool": {"spec", "golden", "rtl_model", "tb", "tool"},
    "studies": {"spec", "golden", "rtl_model", "tb", "tool", "studies"},
}
# Layers around the models, from inside to outside; each has its tests.
RINGS = ("tb", "tool", "studies")
# Folders that only tests and studies may include, not the sources of the command.
TESTS_ALONE = {"unit", "system", "oracle", "bench", "baselines", "hdl", "fuzz", "tests"}
# Fuzzing covers file readers of the tool as well as of the testbench.
SEES_THE_TOOL = {"tb/fuzz"}
# rtl_model/platform is the software side: it uses engines through their registers in spec, and no engine includes it.
PLATFORM_MAY_INCLUDE = {"platform", "fabric"}
# Folders of a layer from bottom to top: a folder may include itself and those before it. Tests and benchmarks may
# include all.
ROOMS = {"tb": ["base", "scene", "stimuli", "harness", "run", "traces", "env", "engines"],
         "tool": ["cost", "pages", "run", "engines", "sweep", "regress", "command", "soak"],
         "studies": ["training", "papers", "quality"]}
# Folders outside the simulation: they must not include SystemC, directly or indirectly, since it takes longer to
# compile than all of them. Their headers include json_fwd.hpp, not json.hpp.
WITHOUT_SYSTEMC = {"tb/base", "tb/scene", "tb/stimuli", "tb/run", "tool/cost", "tool/pages", "tool/sweep", "tool/regress",
                   "tool/command", "tool/soak", "studies/training"}
SYSTEMC = {"systemc", "tlm", "tlm_utils"}
JSON = "nlohmann/json.hpp"
SOURCE = {".h", ".cpp", ".cmake", ".py", ".txt"}
# The only headers of hdl/: the build generates them (tb/hdl/print_headers.cpp).
PRINTED = {"tokens.svh", "tables.svh", "descriptor.svh"}
INCLUDE_OF_HDL = re.compile(r'^\s*`include\s+"([^"]+)"')
INCLUDE = re.compile(r'^\s*#\s*include\s*[<"]([^>"]+)[>"]')
# SMAA's published areas of diagonals depend on the rounding of doubles for points on a line (formats.md,
# "Published values").
DOUBLES = {"golden/morphological/diagonals.cpp", "rtl_model/morphological/blend/diagonal_table.cpp"}
FLOATING = re.compile(r"\b(float|double)\b")
THREADS = re.compile(r"\bSC_C?THREAD\b")
ASSERT = re.compile(r"(?<![\w_])assert\s*\(")
NAMESPACE = re.compile(r"^\s*using\s+namespace\b")
# Namespaces follow folders: tool and studies define names in their own namespaces and may declare names of others.
OPENED = re.compile(r"^namespace deburr::(tb|tool|studies)\b")
DECLARED = re.compile(r"^((class|struct) \w+;|)$")
ADDED_ENGINE = "tool/tests/system/added_engine/"
RANDOM = re.compile(r"\bstd::(?:mt19937|minstd_rand|ranlux|default_random|random_device|s?rand\b|\w+_distribution)")
# Frames and trained weights must be the same on every machine; quality measures need not be.
EXACT, MEASURES = {"tb/scene", "tb/stimuli", "studies/training"}, {"flip.cpp", "quality.cpp", "ssim.cpp"}
OF_THE_C_LIBRARY = re.compile(
    r"\bstd::(?:a?(?:sin|cos|tan)h?|atan2|pow|exp2?|expm1|log(?:2|10|1p)?|cbrt|hypot)f?\(")
CONDITIONAL = re.compile(r"^\s*#\s*if(n?def)?\b")
# A C header tests for C++.
IN_C = re.compile(r"^#ifdef __cplusplus$")


def in_order(where, wanted):
    """Whether a file may include another file of its layer, by their folders."""
    room, below, rooms = where[1], wanted[1], ROOMS[where[0]]
    if room not in rooms or below not in rooms:
        return True
    # Engines do not include each other, and a composition does not include engines.
    if room == below == "engines" and len(where) > 3 and len(wanted) > 3:
        return where[2] == wanted[2]
    return rooms.index(below) <= rooms.index(room)


def way_to_systemc(root, name, seen):
    """The chain of includes from a file to a SystemC header, or None."""
    headers = [include.group(1) for include in
               map(INCLUDE.match, (root / name).read_text(encoding="utf-8").splitlines()) if include]
    for header in headers:
        if header.split("/")[0] in SYSTEMC:
            return [name, header]
    for header in headers:
        if header not in seen and (root / header).is_file():
            seen.add(header)
            way = way_to_systemc(root, header, seen)
            if way:
                return [name, *way]
    return None


def includes_between_folders(root):
    """{folder: {included folder: first line with such an include}}."""
    includes = {}
    for layer in ALLOWED:
        for path in sorted((root / layer).rglob("*")):
            if path.suffix not in {".h", ".cpp"}:
                continue
            where = path.relative_to(root)
            for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
                include = INCLUDE.match(line)
                wanted = pathlib.PurePosixPath(include.group(1)).parent if include else None
                if wanted and wanted.parts and wanted.parts[0] in ALLOWED and wanted != where.parent:
                    includes.setdefault(where.parent, {}).setdefault(wanted, f"{where}:{number}")
    return includes


def circles(root):
    """Yields each include between folders that is part of a cycle."""
    includes = includes_between_folders(root)
    for folder in includes:
        for wanted, line in includes[folder].items():
            seen, ways = {wanted}, [wanted]
            while ways and folder not in seen:
                for next_one in includes.get(ways.pop(), {}):
                    if next_one not in seen:
                        seen.add(next_one)
                        ways.append(next_one)
            if folder in seen:
                yield f"{line}: {folder} includes {wanted}, from where a way leads back"


def violations_of_hdl(root):
    """Yields violations in hdl/: SystemVerilog may include generated headers only."""
    for path in sorted((root / "hdl").rglob("*")):
        if not path.is_file():
            continue
        lines = path.read_text(encoding="utf-8").splitlines()
        where = path.relative_to(root)
        if path.suffix == ".svh":
            yield f"{where}:1: only the build may generate headers here"
        if "SPDX-License-Identifier: MIT" not in "\n".join(lines[:3]):
            yield f"{where}:1: no SPDX licence line"
        for number, line in enumerate(lines, 1):
            include = INCLUDE_OF_HDL.match(line)
            if include and include.group(1) not in PRINTED:
                yield f"{where}:{number}: hdl includes {include.group(1)}"


def violations(root):
    """Yields 'file:line: rule' for every broken rule below root."""
    yield from circles(root)
    yield from violations_of_hdl(root)
    for layer, allowed in ALLOWED.items():
        for path in sorted((root / layer).rglob("*")):
            if not path.is_file() or path.suffix not in SOURCE:
                continue
            where = path.relative_to(root)
            lines = path.read_text(encoding="utf-8").splitlines()
            if "SPDX-License-Identifier: MIT" not in "\n".join(lines[:3]):
                yield f"{where}:1: no SPDX licence line"
            if path.suffix not in {".h", ".cpp"}:
                continue
            way = (way_to_systemc(root, str(where), set())
                   if "/".join(where.parts[:2]) in WITHOUT_SYSTEMC else None)
            if way:
                yield f"{where}:1: SystemC in a folder outside the simulation: " + " -> ".join(way)
            ideal = where.parts[:2] == ("golden", "ideal")
            foreign = False
            of_tests = layer in RINGS and where.parts[1] in TESTS_ALONE
            sees_the_tool = "/".join(where.parts[:2]) in SEES_THE_TOOL
            for number, line in enumerate(lines, 1):
                include = INCLUDE.match(line)
                if include:
                    name = include.group(1)
                    if ".." in name:
                        yield f"{where}:{number}: relative include {name}"
                    if name == "systemc.h":
                        yield f"{where}:{number}: <systemc.h> instead of <systemc>"
                    if layer in RINGS and name == JSON and path.suffix == ".h" and not of_tests:
                        yield f"{where}:{number}: {JSON} in a header"
                    if name == "random":
                        yield f"{where}:{number}: <random> instead of tb/base/random.h"
                    if layer in {"spec", "golden"} and name.split("/")[0] in {"systemc", "tlm"}:
                        yield f"{where}:{number}: SystemC in {layer}"
                    first = name.split("/")[0]
                    if first in ALLOWED and first not in allowed and not (sees_the_tool and first == "tool"):
                        yield f"{where}:{number}: {layer} includes {first}"
                    if first == layer == "rtl_model":
                        room, wanted = where.parts[1], name.split("/")[1]
                        if room == "platform" and wanted not in PLATFORM_MAY_INCLUDE:
                            yield f"{where}:{number}: rtl_model/platform includes an engine"
                        if room != "platform" and wanted == "platform":
                            yield f"{where}:{number}: hardware includes rtl_model/platform"
                    if layer == first and layer in RINGS and not in_order(where.parts, name.split("/")):
                        yield f"{where}:{number}: {layer}/{where.parts[1]} includes {name}, which is not a lower folder"
                    if layer in {"tb", "tool"} and not of_tests and first in RINGS and name.split("/")[1] in TESTS_ALONE:
                        yield f"{where}:{number}: test support in the command"
                if (layer in {"golden", "rtl_model"} and not ideal and where.as_posix() not in DOUBLES
                        and FLOATING.search(line)):
                    yield f"{where}:{number}: floating point in {layer}"
                if ASSERT.search(line) and "static_assert" not in line:
                    yield f"{where}:{number}: assert instead of DEBURR_CHECK"
                if RANDOM.search(line):
                    yield f"{where}:{number}: a random generator other than tb/base/random.h"
                if ("/".join(where.parts[:2]) in EXACT and path.name not in MEASURES
                        and OF_THE_C_LIBRARY.search(line)):
                    yield f"{where}:{number}: a function of the C library where tb/scene/exact_math.h has one"
                opened = OPENED.match(line) if layer in {"tool", "studies"} else None
                if opened and not where.as_posix().startswith(ADDED_ENGINE):
                    foreign = opened[1] != layer
                elif foreign and line.startswith("}"):
                    foreign = False
                elif foreign and not DECLARED.match(line):
                    yield f"{where}:{number}: {layer} defines in another's namespace"
                    foreign = False
                if path.suffix == ".h" and NAMESPACE.match(line):
                    yield f"{where}:{number}: using namespace in a header"
                if layer == "rtl_model" and THREADS.search(line):
                    yield f"{where}:{number}: a thread process in rtl_model"
                asks_the_language = where.parts[:2] == ("golden", "c") and path.suffix == ".h" and IN_C.match(line)
                if layer in {"golden", "rtl_model"} and CONDITIONAL.match(line) and not asks_the_language:
                    yield f"{where}:{number}: compile-time configuration in {layer}"


def injected_faults_are_caught():
    """Injects one fault of each kind and returns the missed kinds."""
    faults = {
        "golden/a.cpp": '#include "rtl_model/fabric/link.h"',
        "rtl_model/a.cpp": '#include "golden/texture/x.h"',
        "rtl_model/b.cpp": "SC_THREAD(run);",
        "rtl_model/c.cpp": "SC_CTHREAD(run, clk.pos());",
        "rtl_model/d.h": "using namespace sc_core;",
        "rtl_model/platform/a.cpp": '#include "rtl_model/foo/tokens.h"',
        "rtl_model/platform/b.cpp": '#include "golden/foo/traffic.h"',
        "rtl_model/platform/c.cpp": '#include "tb/harness/bench.h"',
        "rtl_model/fabric/a.cpp": '#include "rtl_model/platform/memory_model.h"',
        "golden/e.cpp": '#include "rtl_model/platform/foo_records.h"',
        "golden/d.cpp": "#include <systemc>",
        "python/a.cpp": '#include "rtl_model/fabric/link.h"',
        "tb/b.cpp": "#include <systemc.h>",
        "tb/c.cpp": "assert(x > 0);",
        "tb/d.cpp": "#include <random>",
        "tb/unit/a.cpp": "std::mt19937_64 random(1);",
        "tb/unit/b.cpp": "std::uniform_int_distribution<int> pick(0, 3);",
        "tb/scene/a.cpp": "double y = std::pow(x, 2.2);",
        "studies/training/a.h": "inline double f(double x) { return std::log2(x); }",
        "tool/run/a.cpp": '#include "tb/unit/scene/fixtures.h"',
        "tool/run/b.cpp": '#include "tool/sweep/point.h"',
        "tool/run/c.h": "#include <nlohmann/json.hpp>",
        "tool/run/d.cpp": '#include "studies/papers/papers.h"',
        "tool/run/e.cpp": 'namespace deburr::tb {\nclass Image;\nint a;\n}',
        "tb/env/a.cpp": '#include "tool/run/engine.h"',
        "tb/unit/env/a.cpp": '#include "tool/run/engine.h"',
        "tool/tests/run/a.cpp": '#include "studies/papers/papers.h"',
        "tool/sweep/a.cpp": '#include "tool/tests/run/support.h"',
        "tb/run/a.h": "#include <systemc>",
        "tb/base/a.cpp": '#include "tb/run/result.h"',
        "tb/engines/foo/a.cpp": '#include "tb/engines/bar/bar_environment.h"',
        "golden/b.cpp": "double x;",
        "golden/ideal/c.cpp": '#include "../../rtl_model/x.h"',
        "spec/a.h": '#include "tb/scene/image.h"',
        "golden/c.h": "#ifdef FAST",
        "golden/c/a.h": "#ifdef FAST",
        "golden/c/a.cpp": "#ifdef __cplusplus",
        "golden/d.h": "#ifdef __cplusplus",
        "hdl/foo/a.sv": '`include "rtl_model/foo/tokens.svh"',
        "hdl/foo/tokens.svh": "`define A 1",
    }
    missed = []
    for name, line in faults.items():
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / name
            path.parent.mkdir(parents=True)
            path.write_text("// SPDX-License-Identifier: MIT\n" + line + "\n", encoding="utf-8")
            if len(list(violations(pathlib.Path(folder)))) != 1:
                missed.append(f"{name}: {line}")
    with tempfile.TemporaryDirectory() as folder:
        for name, include in (("tool/sweep/a.cpp", "rtl_model/fabric/a.h"), ("rtl_model/fabric/a.h", "systemc")):
            path = pathlib.Path(folder) / name
            path.parent.mkdir(parents=True)
            path.write_text(f'// SPDX-License-Identifier: MIT\n#include "{include}"\n', encoding="utf-8")
        if len(list(violations(pathlib.Path(folder)))) != 1:
            missed.append("tool/sweep/a.cpp: SystemC through a header")
    ring = ("rtl_model/foo", "rtl_model/foo/below", "rtl_model/foo/common")
    for length in (2, 3):
        with tempfile.TemporaryDirectory() as folder:
            for place, wanted in zip(ring[:length], (*ring[1:length], ring[0])):
                path = pathlib.Path(folder) / place / "a.h"
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_text(f'// SPDX-License-Identifier: MIT\n#include "{wanted}/a.h"\n', encoding="utf-8")
            if len(list(violations(pathlib.Path(folder)))) != length:
                missed.append(f"{length} folders that include each other")
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "spec/b.h"
        path.parent.mkdir(parents=True)
        path.write_text("#pragma once\n", encoding="utf-8")
        if len(list(violations(pathlib.Path(folder)))) != 1:
            missed.append("spec/b.h: no licence line")
    return missed


if __name__ == "__main__":
    house_main(__doc__, injected_faults_are_caught(), violations)
