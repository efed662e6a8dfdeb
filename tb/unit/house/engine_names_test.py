#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Checks that adding an engine needs no edit of other files: only its own files and one line of
tb/engines/engines.txt name it.

An engine's own files have its name in their path. Other files that name it, also within an identifier, are listed in
NAMED with the reason; files that a command generates from the declarations (MADE) are exempt. Texture and frame are
common words, so for every engine the test also searches the general folders (GENERAL), which must not name any
engine: they run, sweep, report, trace and build all engines, and provide the C and Python interfaces. Documentation
is not searched.

usage: engine_names_test.py SOURCE"""
import pathlib
import re
import tempfile

from house_main import house_main

LIST = "tb/engines/engines.txt"
# Tests of the tool and of studies use engines as examples.
LEFT_OUT = re.compile(r"docs/|README\.md|CHANGELOG\.md|LICENSES?|tb/unit/house/engine_names_test\.py|"
                      r"(tool|studies)/tests/|build/|out/|\.git/|\.ci/")
PAGE = re.compile(r"(?<!\")docs/reference/\w+/\w+\.md")  # an engine's contract, named in a comment
ADDED = "posteriser"  # the engine that tests add to the list
# Testplans and records run compositions by name. The composition itself names none of its parts.
COMPOSITION = re.compile(r"tb/engines/frame/[^/]*\.(yaml|json)$")

# Files generated from the declarations or the behaviour of engines: the command with its option.
MADE = {
    "golden/c/systemverilog/deburr_golden_dpi.c": "tb/unit/golden/c/systemverilog_test.py --write",
    "golden/c/systemverilog/deburr_golden_pkg.sv": "tb/unit/golden/c/systemverilog_test.py --write",
    "tb/baselines/speed.json": "tb/speed --record",
    "tool/tests/command/stable.txt": "tool/tests/command/stable_test.py --update",
}

# engine -> reason -> files that name it. A CMake list may name an engine if the sources in its folder do.
NAMED = {
    "geometric": {
        "each pair of engines is tested in separate clock domains": ["tb/unit/platform/engine_domains_test.cpp"],
        "the parameter `bypass` uses its marks": [
            "golden/morphological/configuration.cpp", "golden/morphological/configuration.h",
            "golden/morphological/bypass.h", "rtl_model/morphological/blend/blender.cpp",
            "spec/morphological/parameters.h", "tool/engines/morphological/morphological_role.cpp",
            "tb/unit/golden/morphological/frames_test.cpp"],
        "methods are compared by name": ["studies/quality/comparison.cpp"],
        "the paper that describes its method": ["studies/papers/papers_002.cpp"],
        "tests, and examples built from installed files, call its C functions": [
            "examples/installed_test.py", "examples/systemverilog/testbench.sv", "tb/fuzz/c_calls.cpp",
            "tb/unit/golden/c/calls_test.cpp", "tb/unit/golden/c/frames_test.cpp",
            "tb/unit/golden/c/threads_test.cpp"],
        "Python provides its equations in real numbers, and tests call its Python functions": [
            "python/bindings/ideal_python.cpp"],
        "generates the tables of its pages": ["scripts/reports/guides.py", "scripts/reports/results.py"],
        "an example in the help of a script": ["scripts/mutate"],
    },
    "morphological": {
        "each pair of engines is tested in separate clock domains": ["tb/unit/platform/engine_domains_test.cpp"],
        "shares its tables for linear light": [
            "golden/geometric/geometric_golden.cpp", "golden/geometric/geometric_golden.h",
            "golden/geometric/resolve.cpp", "golden/geometric/resolve.h", "spec/geometric/tables.h",
            "tb/unit/golden/geometric/line_test.cpp"],
        "the field's word for such methods, or a comparison with them": [
            "golden/ideal/cmaa2.h", "golden/ideal/coverage.h", "golden/ideal/smaa.h", "studies/quality/comparison.cpp",
            "studies/quality/harm.cpp", "tb/oracle/smaa_frames.h",
            "tb/oracle/smaa_published_test.cpp", "tb/oracle/smaa_shader_test.cpp", "tb/oracle/smaa_test.cpp",
            "tb/scene/reference.h"],
        "papers that describe its methods": ["studies/papers/papers_000.cpp", "studies/papers/papers_003.cpp"],
        "images that measure and train its blend weights": [
            "scripts/train-weights", "tb/stimuli/line_fans.cpp",
            "tb/stimuli/line_fans.h", "studies/training/recipe.cpp", "studies/training/recipe.h", "tb/stimuli/weight_file.cpp",
            "tb/stimuli/weight_file.h", "studies/training/weight_samples.cpp", "studies/training/weight_samples.h",
            "studies/training/weight_trainer.cpp", "studies/training/weight_trainer.h", "studies/training/title_weights.cpp",
            "studies/training/title_weights.h", "studies/training/train_weights.cpp", "tb/unit/stimuli/weight_file_test.cpp"],
        "its contract defines some table values by doubles": ["tb/unit/house/layers_test.py"],
        "an example engine in a test of common functions": [
            "tb/unit/env/injected_faults_test.cpp"],
        "an example engine, built from installed files": [
            "examples/c/draw.c", "examples/installed_test.py", "examples/platform/expected.cpp",
            "examples/platform/expected.h", "examples/platform/main.cpp", "examples/platform/painter.cpp",
            "examples/platform/painter.h", "examples/platform/software.cpp", "examples/systemverilog/edge_detector.sv",
            "examples/systemverilog/testbench.sv"],
        "frames from Python use its views and depths, and tests call its Python functions": [
            "python/bindings/frames.cpp", "python/bindings/frames.h", "python/bindings/ideal_python.cpp",
            "tb/bench/python_frames.cpp", "tb/bench/python_golden.py"],
        "tests call its C functions": [
            "tb/fuzz/c_calls.cpp", "tb/unit/golden/c/calls_test.cpp", "tb/unit/golden/c/frames_test.cpp",
            "tb/unit/golden/c/threads_test.cpp"],
        "generates the tables of its pages": [
            "scripts/report", "scripts/reports/guides.py", "scripts/reports/results.py"],
    },
}

# Folders that must not name an engine: they get the list of engines. The composition does too: its parts register
# themselves.
GENERAL = re.compile(r"CMakeLists\.txt|cmake/|golden/CMakeLists\.txt|golden/c/|rtl_model/CMakeLists\.txt|spec/[^/]*$|"
                     r"rtl_model/(fabric|platform)/|tb/(env|harness)/|tb/traces/(CMakeLists|line_trace|trace_file)|"
                     r"python/(CMakeLists|bindings/(arrays|module)\.|deburr/)|"
                     r"tool/(?!engines/(?!frame/))|"
                     r"tb/(CMakeLists\.txt|base/|baselines/check\.py|fuzz/(?!c_calls\.cpp)|run/|speed$|testplan/|"
                     r"engines/[^/]*$|engines/frame/[^/]*\.txt$|unit/CMakeLists\.txt)|scripts/coverage")


def files(root):
    """Yields (path, text) of every text file of the tree."""
    for path in sorted(root.rglob("*")):
        name = path.relative_to(root).as_posix()
        if not path.is_file() or path.is_symlink() or LEFT_OUT.match(name):
            continue
        try:
            yield name, PAGE.sub("", path.read_text(encoding="utf-8"))
        except UnicodeDecodeError:
            continue


def engines(root):
    lines = (root / LIST).read_text(encoding="utf-8").splitlines()
    return [line for line in lines if line and not line.startswith("#")]


def naming(engine, texts):
    """Files other than the engine's own that contain its name as a word or in an identifier; names of pages do not count."""
    word = re.compile(rf"(?<![A-Za-z])(?:{engine}|{engine.upper()})(?![A-Za-z])(?!\w*\.md)|"
                      rf"(?<![A-Z]){engine.capitalize()}(?![a-z])")
    return {name for name, text in texts if engine not in name and name not in (LIST, *MADE) and word.search(text)}


def build_list(name):
    return name.endswith((".cmake", "CMakeLists.txt"))


def general_naming(engine, texts):
    """Files of general folders that name it in code: in quotes, or as a namespace, a folder or a type."""
    camel = engine.capitalize()
    # `frame.` also begins image parameters of every engine, and "frame" is the unit of some parameter ranges.
    code = re.compile(rf"(?<!\d, )\"{engine}[\"{'' if engine == 'frame' else '.'}]|\b(spec|golden|rtl|tb)(::|/|_){engine}\b|engines/{engine}\b|"
                      rf"{'' if engine == 'frame' else f'deburr_{engine}_|'}\bdeburr::{engine}_|\b{camel}(Engine|Environment|Golden|Setup|Unit|Composition)\b|"
                      rf"\b_golden\.{engine}\b|\bdef {engine}\b|"
                      rf"engine: {engine}\b")
    # Comments in lists and scripts may give an example.
    plain = [(name, text if name.endswith((".h", ".cpp")) else re.sub(r"(?m)^ *#.*", "", text))
             for name, text in texts if GENERAL.match(name) and name not in MADE and f"engines/{engine}/" not in name
             and not re.search(rf"(^|/)(_golden_)?{engine}(_[^/]*|\.[^/]*)$", name)]
    return {f"{name}: {code.search(text)[0]}" for name, text in plain if code.search(text)}


def not_made(root, made):
    """Yields the files of MADE that their command does not generate."""
    for name, command in made.items():
        script = root / command.split()[0]
        if not script.exists() or name.rpartition("/")[2] not in script.read_text(encoding="utf-8"):
            yield f"{name} is not generated by {command}"
        elif command.split()[1] not in script.read_text(encoding="utf-8"):
            yield f"{command.split()[0]} lacks {command.split()[1]}"
        if not (root / name).exists():
            yield f"MADE names {name}, which does not exist"


def complaints(root, named):
    """Yields the differences between the tree and NAMED."""
    texts = list(files(root))
    for name, text in texts:
        if ADDED in (name + text).lower():
            yield f"{name} names {ADDED}, which tests add to the list"
    for engine in engines(root):
        for found in sorted(general_naming(engine, texts)):
            yield f"a general folder names {engine}: {found}"
        if engine not in named:
            continue
        reasons = {name for names in named[engine].values() for name in names}
        folders = {name.rpartition("/")[0] for name in reasons}
        found = {name for name in naming(engine, texts) if (engine == "frame" or not COMPOSITION.search(name)) and
                 not (build_list(name) and name.rpartition("/")[0] in folders and not GENERAL.match(name))}
        for name in sorted(found - reasons):
            yield f"{name} names {engine}: move this into a declaration of {engine} (docs/howto/add_an_engine.md)"
        for name in sorted(reasons & MADE.keys()):
            yield f"{name} is generated: remove it from the list"
        for name in sorted(reasons - found):
            yield f"{name} does not name {engine} any more: remove it from the list"


def injected_faults_are_caught():
    """True if, in a small tree, exactly the injected faults are found."""
    def tree(folder, **changed):
        texts = {LIST: "# engines\nfoo\nfrobber\n", "spec/frobber/parameters.h": "namespace spec::frobber",
                 "tool/run/engine.cpp": "for (engine : engines())",
                 "studies/papers/one.cpp": "the frobber of 2016", "docs/a.md": "frobber",
                 "tb/engines/frame/smoke.yaml": "frobber", **changed}
        root = pathlib.Path(folder)
        for name, text in texts.items():
            (root / name).parent.mkdir(parents=True, exist_ok=True)
            (root / name).write_text(text, encoding="utf-8")
        return root
    named = {"frobber": {"a paper": ["studies/papers/one.cpp"]}}
    expected = [({}, 0), ({"tool/soak/soak.cpp": 'if (engine == "foo")'}, 1), ({"tb/scene/a.cpp": "of the frobber"}, 1),
                ({"tool/pages/a.cpp": '"frobber."'}, 2), ({"tb/oracle/a.cpp": "deburr_frobber_new()"}, 1),
                ({"tb/oracle/a.cpp": "class FrobberFrame"}, 1), ({"tb/oracle/a.cpp": "frobbers, frobber_of_mine.md"}, 0),
                ({"golden/c/deburr_golden.h.in": "int deburr_foo_new(void);"}, 1), ({"golden/c/foo_c.cpp": "deburr_foo_new"}, 0),
                ({"python/deburr/golden.py": "def foo(pixels):"}, 1), ({"python/deburr/_golden_foo.py": "def foo(pixels):"}, 0),
                ({"tb/traces/line_trace.cpp": "rtl::foo::Cache"}, 1), ({"studies/papers/one.cmake": "deburr::frobber_engine"}, 0),
                ({"tb/oracle/one.cmake": "deburr::frobber_engine"}, 1), ({"studies/papers/one.cpp": "of 2016"}, 1),
                ({"tb/env/a.h": 'v.integer("count", p.count, 1, 100, "foo", "So many.");'}, 0),
                ({"tool/sweep/a.h": "a foo is no engine here"}, 0), ({"tb/scene/b.h": "// docs/reference/frobber/index.md"}, 0),
                ({"tool/engines/frame/frame_mix.cpp": "spec::foo::Rules p"}, 1),
                ({"tool/pages/b.cpp": "as Posteriser does"}, 1),
                ({"tool/tests/system/added_engine/posteriser.h": "class Posteriser"}, 0)]
    missed = []
    for changed, count in expected:
        with tempfile.TemporaryDirectory() as folder:
            found = list(complaints(tree(folder, **changed), named))
        if len(found) != count:
            missed.append(f"{changed}: {found}")
    made = {"a.txt": "make.py --write"}
    for texts, count in (({"make.py": "a.txt --write"}, 1), ({"a.txt": ""}, 1), ({"make.py": "a.txt", "a.txt": ""}, 1),
                         ({"make.py": "a.txt --write", "a.txt": ""}, 0)):
        with tempfile.TemporaryDirectory() as folder:
            found = list(not_made(tree(folder, **texts), made))
        if len(found) != count:
            missed.append(f"{texts}: {found}")
    return missed


if __name__ == "__main__":
    house_main(__doc__, injected_faults_are_caught(), lambda root: [*complaints(root, NAMED), *not_made(root, MADE)])
