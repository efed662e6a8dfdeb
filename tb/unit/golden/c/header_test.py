#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Checks that the header of the C interface compiles without warnings as C and C++, included by itself and twice, and
that its functions have C linkage.

usage: header_test.py HEADER CC CXX"""
import pathlib
import subprocess
import sys
import tempfile

PROGRAM = """#include "deburr_golden.h"
#include "deburr_golden.h"
int main(void) {
  deburr_golden* golden = deburr_texture_new();
  uint8_t rgba[16];
  const int32_t s[4] = {0, 0, 0, 0};
  return golden && deburr_texture_quad(golden, 0, 15, 0, s, s, rgba) == DEBURR_OK ? deburr_close(golden) : 1;
}
"""
FLAGS = ("-Wall", "-Wextra", "-Wpedantic", "-Wstrict-prototypes", "-Werror", "-c")


def compiled(command, header, suffix):
    """Messages of the compiler, and undefined symbols of the object file."""
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        (folder / "deburr_golden.h").write_text(header, encoding="utf-8")
        (folder / f"program{suffix}").write_text(PROGRAM, encoding="utf-8")
        flags = [flag for flag in FLAGS if suffix == ".c" or flag != "-Wstrict-prototypes"]
        done = subprocess.run([*command, *flags, f"program{suffix}", "-o", "program.o"], cwd=folder, text=True,
                              capture_output=True, check=False)
        if done.returncode != 0:
            return done.stderr, set()
        listed = subprocess.run(["nm", "-u", "program.o"], cwd=folder, text=True, capture_output=True, check=True)
    return "", {line.split()[-1] for line in listed.stdout.splitlines()}


def problems(header, compiler, cxx):
    for command, suffix in (([compiler, "-std=c99"], ".c"), ([compiler, "-std=c17"], ".c"),
                            ([cxx, "-std=c++11"], ".cpp"), ([cxx, "-std=c++20"], ".cpp")):
        messages, names = compiled(command, header, suffix)
        if messages:
            yield f"{' '.join(command)}: {messages}"
        elif not {"deburr_texture_new", "deburr_texture_quad", "deburr_close"} <= names:
            yield f"{' '.join(command)} wants {names}"


def main():
    compiler, cxx = sys.argv[2:4]
    header = pathlib.Path(sys.argv[1]).read_text(encoding="utf-8")
    found = list(problems(header, compiler, cxx))
    for problem in found:
        print(problem)
    injected = {"C++ alone": (header.replace("typedef struct deburr_golden deburr_golden;", "struct deburr_golden;"), 2),
               "no language": (header.replace('extern "C"', 'extern "C++"'), 2),
               "no guard": (header.replace("#pragma once\n", ""), 4),
               "a type that is not there": (header.replace("#include <stdint.h>\n", ""), 4)}
    missed = [what for what, (text, count) in injected.items() if len(list(problems(text, compiler, cxx))) != count]
    for what in missed:
        print(f"injected fault not caught: {what}")
    sys.exit(1 if found or missed else 0)


if __name__ == "__main__":
    main()
