#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""`deburr params --c-header` prints a header that C99 and C++20 compile without a warning, and its macros have the
values of the contract, given here by hand.

usage: c_header_test.py DEBURR CC CXX"""
import pathlib
import re
import subprocess
import sys
import tempfile

# Bits by hand, from docs: a change of the register map must be repeated here.
VALUES = {
    "DEBURR_GEOMETRIC_ID_RESET": 0xDEB00005, "DEBURR_GEOMETRIC_SIZE": 0x0C,
    "DEBURR_GEOMETRIC_SIZE_HEIGHT_MASK": 0x3FFF0000, "DEBURR_GEOMETRIC_SIZE_HEIGHT_SHIFT": 16,
    "DEBURR_GEOMETRIC_CONTROL_START_MASK": 4, "DEBURR_GEOMETRIC_CONFIG_CREASE_MASK": 0xC,
    "DEBURR_GEOMETRIC_CONFIG_CREASE_SHIFT": 2, "DEBURR_GEOMETRIC_CONFIG_CREASE_SHADING": 2,
    "DEBURR_GEOMETRIC_COPY_BASE_ADDRESS_MASK": 0xFFFFFFC0,
    "DEBURR_GEOMETRIC_REJECTION_REASON_FACE_COUNT": 7, "DEBURR_GEOMETRIC_REJECTION_REASON_BOUNDARY_COUNT": 8,
    "DEBURR_GEOMETRIC_BOUNDARY_COUNT": 0x98, "DEBURR_GEOMETRIC_PAIR_BASE": 0x9C,
    "DEBURR_GEOMETRIC_OTHER_PAIR_BASE": 0xA0, "DEBURR_GEOMETRIC_COARSE_BASE": 0xA4,
    "DEBURR_GEOMETRIC_PAIR_BASE_ADDRESS_MASK": 0xFFFFFFC0,
    "DEBURR_MORPHOLOGICAL_ID_RESET": 0xDEB00105, "DEBURR_MORPHOLOGICAL_CONFIG_BYPASS_SHIFT": 24,
    "DEBURR_MORPHOLOGICAL_CONFIG_BYPASS_MASK": 0x07000000,
    "DEBURR_MORPHOLOGICAL_CONFIG_BYPASS_MASKED": 4,
    "DEBURR_MORPHOLOGICAL_CONFIG_TEXT_GUARD_MASK": 0x10000000,
    "DEBURR_MORPHOLOGICAL_CONFIG_EDGES_SOURCE_COLOUR": 3,
    "DEBURR_MORPHOLOGICAL_SMAA_CORNER_ROUNDING_MASK": 0x01FF0000,
    "DEBURR_MORPHOLOGICAL_WEIGHTS_DATA": 0x84, "DEBURR_MORPHOLOGICAL_BYPASSED_PIXELS": 0x7C,
    "DEBURR_TEXTURE_ID_RESET": 0xDEB00002, "DEBURR_TEXTURE_TEXTURE0_MODE": 0x104,
    "DEBURR_TEXTURE_TEXTURE0_MODE_LEVELS_MASK": 0x00F00000,
    "DEBURR_TEXTURE_TEXTURE0_MODE_MIN_FILTER_LINEAR_MIPMAP_LINEAR": 5,
    "DEBURR_TEXTURE_TEXTURE0_BASE_12": 0x140, "DEBURR_TEXTURE_STRIDE": 0x80,
    "DEBURR_TEXTURE_COUNT": 16,
    # Contents other than numbers.
    "DEBURR_FIELD(DEBURR_GEOMETRIC_SIZE_HEIGHT, 0xFFFF1234u)": 0x3FFF,
    "DEBURR_FIELD(DEBURR_MORPHOLOGICAL_CONFIG_BYPASS, 0xFCFFFFFFu)": 4,
    "DEBURR_IN(DEBURR_GEOMETRIC_SIZE_HEIGHT, 5)": 0x50000,
    "DEBURR_IN(DEBURR_GEOMETRIC_SIZE_HEIGHT, -1)": 0x3FFF0000,
    "DEBURR_IN(DEBURR_GEOMETRIC_CONFIG_CREASE, 1 | 2)": 0xC,
    "DEBURR_CHOICE(DEBURR_MORPHOLOGICAL_CONFIG_BYPASS, MASKED)": 0x04000000,
    "DEBURR_WITH(DEBURR_GEOMETRIC_SIZE_HEIGHT, 0xFFFF1234u, 5)": 0xC0051234,
}


def compiles(compiler, header, values):
    """Compiler output, empty on success, for a program that asserts the values of the macros."""
    checks = [f"typedef char check{i}[{name} == {value}u ? 1 : -1];"
              for i, (name, value) in enumerate(values.items())]
    with tempfile.TemporaryDirectory() as folder:
        source = pathlib.Path(folder, "program.c" if compiler[1] == "-std=c99" else "program.cpp")
        pathlib.Path(folder, "registers.h").write_text(header)
        # Included twice, to test the include guard.
        source.write_text('#include "registers.h"\n#include "registers.h"\n' + "\n".join(checks)
                          + "\nint main(void) { return 0; }\n")
        done = subprocess.run([*compiler, "-Wall", "-Wextra", "-pedantic", "-Werror",
                               "-fsyntax-only", str(source)],
                              capture_output=True, text=True, check=False)
        return done.stderr if done.returncode else ""


def main():
    if len(sys.argv) != 4:
        print(__doc__)
        return 2
    header = subprocess.run([sys.argv[1], "params", "--c-header"], check=True,
                            capture_output=True, text=True).stdout
    names = re.findall(r"^#define (\w+)", header, re.M)
    wrong = 0
    if len(names) != len(set(names)) or len(names) < 300:
        print(f"{len(names)} macros, {len(set(names))} of them different")
        wrong += 1
    for compiler in ([sys.argv[2], "-std=c99"], [sys.argv[3], "-std=c++20"]):
        if said := compiles(compiler, header, VALUES):
            print(said)
            wrong += 1
        # A wrong value is detected.
        for name, value in (next(iter(VALUES.items())), list(VALUES.items())[-1]):
            if not compiles(compiler, header, {name: value ^ 1}):
                print(f"{compiler}: {name} == {value ^ 1:#x} was not noticed")
                wrong += 1
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
