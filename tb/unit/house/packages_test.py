#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Checks that a missing package is an error that names the section of scripts/install which installs it: CMake lists
require packages only through cmake/Packages.cmake, every package named there is in scripts/packages.txt, and the
errors have the expected text.

usage: packages_test.py CMAKE SOURCE"""
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

# Files for the builds of users.
NOT_OURS = ("examples/", "cmake/package/", "cmake/FindSystemC.cmake", "cmake/Packages.cmake", "build/")
BARE = re.compile(r"^\s*(find_\w+|pkg_check_modules|pkg_search_module)\s*\(([^)]*)\)", re.M)
# Optional packages: a compiler cache, Mesa, libsquish, SystemVerilog tools, packages of the Python module, and packages that
# pkg-config may find instead of CMake.
OPTIONAL = {"DEBURR_VERILATOR", "DEBURR_MAKE", "DEBURR_SQUISH", "DEBURR_SQUISH_HEADER", "Python", "pybind11",
            "CCACHE_PROGRAM", "PC_OracleEgl", "PC_OpenImageIO", "PC_OracleOpenImageIO", "OpenImageIO", "pagmo", "GTest"}
NAMED = re.compile(r"\bdeburr_(?:find_package|find|missing|missing_module)\(([^)]*)\)")


def lists(root):
    for file in sorted([*root.rglob("CMakeLists.txt"), *root.rglob("*.cmake")]):
        name = file.relative_to(root).as_posix()
        if not name.startswith(NOT_OURS):
            yield name, re.sub(r"#[^\n]*", "", file.read_text(encoding="utf-8"))


def problems(root):
    listed = {line for line in (root / "scripts/packages.txt").read_text(encoding="utf-8").splitlines()
              if re.fullmatch(r"[a-z0-9][a-z0-9+.-]*", line)}
    named = 0
    for name, text in lists(root):
        for command, arguments in BARE.findall(text):
            words = arguments.split()
            if words[0] not in OPTIONAL or "REQUIRED" in words:
                yield f"{name}: {command}({words[0]}) does not say what installs it"
        for arguments in NAMED.findall(text):
            named += 1
            if not listed.intersection(arguments.split()):
                yield f"{name}: no package of scripts/packages.txt in ({arguments})"
    if named < 20:
        yield f"only {named} packages are looked for"


CASES = (
    ("deburr_find_package(NoSuchThing libfmt-dev)", 1,
     "NoSuchThing was not found: `scripts/install libraries` installs Debian's package libfmt-dev."),
    ("deburr_find_package(NoSuchThing libyaml-cpp-dev COMPONENTS A)", 1, "`scripts/install build` installs Debian's package libyaml-cpp-dev"),
    ("deburr_find(program NO_SUCH_PROGRAM g++ NAMES no-such-program)", 1, "NO_SUCH_PROGRAM was not found: `scripts/install libraries`"),
    ("deburr_find(file NO_SUCH_FILE libjs-chart.js NAMES a.min.js PATHS /nonexistent)", 1, "`scripts/install build` installs Debian's package libjs-chart.js"),
    ("deburr_find(program CMAKE_ITSELF cmake NAMES cmake)", 0, ""),
    ("set(CMAKE_CXX_COMPILER no-such-clang++)\ndeburr_find_compiler()", 1,
     "The compiler no-such-clang++ was not found: `scripts/install asan` installs Debian's package clang."),
    ("set(CMAKE_CXX_COMPILER no-such-c++)\ndeburr_find_compiler()", 1, "`scripts/install libraries` installs Debian's package g++."),
    ("deburr_find_compiler()", 0, ""),
    ("deburr_missing(GoogleTest libgtest-dev \"Or without.\")", 1, "`scripts/install test` installs Debian's package libgtest-dev. Or without."),
    ("deburr_missing_module(pagmo libpagmo-dev \"nothing is searched\")", 0, "No pagmo (scripts/install modules): nothing is searched"),
    ("set(BUILD_TESTING ON)\ndeburr_missing_module(OpenImageIO libopenimageio-dev \"no picture is read\")", 1,
     "OpenImageIO was not found: `scripts/install modules` installs Debian's package libopenimageio-dev. "
     "Or configure with -DBUILD_TESTING=OFF: then no picture is read."),
)


def what_is_said(cmake, root):
    for lines, code, words in CASES:
        with tempfile.TemporaryDirectory() as folder:
            project = pathlib.Path(folder)
            (project / "CMakeLists.txt").write_text(
                f"cmake_minimum_required(VERSION 3.25)\ninclude({root}/cmake/Packages.cmake)\nproject(tried LANGUAGES NONE)\n{lines}\n",
                encoding="utf-8")
            done = subprocess.run([cmake, "-S", project, "-B", project / "build"], capture_output=True, text=True, check=False)
            said = " ".join((done.stdout + done.stderr).split())
            if done.returncode != code or words not in said:
                yield f"{lines}\n  exit code {done.returncode}, expected {code}: {said}"


def faults_that_are_not_found(root):
    faults = ("find_package(Boost REQUIRED)", "find_library(THING thing)", "pkg_check_modules(PC_Thing REQUIRED thing)",
              "find_package(GTest REQUIRED)", "deburr_find_package(Boost libboost-dev)")
    for fault in faults:
        with tempfile.TemporaryDirectory() as folder:
            copy = pathlib.Path(folder)
            (copy / "scripts").mkdir()
            shutil.copy(root / "scripts/packages.txt", copy / "scripts")
            (copy / "CMakeLists.txt").write_text("deburr_find_package(fmt libfmt-dev)\n" * 20 + fault + "\n", encoding="utf-8")
            if len(list(problems(copy))) != 1:
                yield f"injected fault not found: {fault}"


def main():
    if len(sys.argv) != 3:
        print(__doc__)
        return 2
    root = pathlib.Path(sys.argv[2]).resolve()
    found = [*problems(root), *what_is_said(sys.argv[1], root), *faults_that_are_not_found(root)]
    print("\n".join(found))
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
