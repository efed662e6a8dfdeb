#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Checks that the SystemVerilog package and its C glue file match the header of the C interface, and that the page of
the interface names every function.

usage: systemverilog_test.py HEADER SOURCE [--write]     HEADER: layers/golden_c/golden/c/deburr_golden.h of a build
                                                         --write: regenerates package and glue"""
import pathlib
import re
import sys

HEADER = "deburr_golden.h"
PACKAGE = "golden/c/systemverilog/deburr_golden_pkg.sv"
GLUE = "golden/c/systemverilog/deburr_golden_dpi.c"
PAGE = "docs/reference/c_interface.md"

CONSTANT = re.compile(r"^\s*(DEBURR_\w+) = (\d+)", re.M)
# A comment, or a declaration.
PIECE = re.compile(r"/\*(?P<comment>.*?)\*/|^(?P<result>const char\*|deburr_golden\*|int) (?P<name>deburr_\w+)"
                   r"\((?P<parameters>[^)]*)\);", re.M | re.S)
PARAMETER = re.compile(r"(?P<constant>const )?(?P<type>\w+)(?P<pointer>\*)? (?P<name>\w+)(?:\[(?P<length>\d+)\])?$")

SCALARS = {"int": "int", "int32_t": "int", "int64_t": "longint", "uint8_t": "byte unsigned",
           "uint32_t": "int unsigned", "uint64_t": "longint unsigned"}
RESULTS = {"int": "int", "const char*": "string", "deburr_golden*": "chandle"}


class Parameter:
    """A parameter: its SystemVerilog declaration, its declaration in the C glue, and the argument passed on."""

    def __init__(self, text, with_size):
        match = PARAMETER.match(text)
        if not match:
            raise ValueError(f"no parameter is known as '{text}'")
        constant, kind, pointer, self.name, length = match.groups()
        self.declaration = f"{constant or ''}{kind}{pointer or ''} {self.name}" + (f"[{length}]" if length else "")
        self.passed = self.name
        self.open_array = self.text = False
        if kind == "deburr_golden" and pointer:
            self.sv = f"input chandle {self.name}"
            self.declaration = f"void* {self.name}"
            self.passed = f"(deburr_golden*){self.name}"
        elif kind == "char" and pointer and constant and not with_size:
            self.sv = f"input string {self.name}"
        elif kind == "char" and pointer and not constant and with_size:
            self.sv = f"output string {self.name}"
            self.declaration = f"const char** {self.name}"
            self.passed = "text_of_thread, sizeof text_of_thread"
            self.text = True
        elif pointer and with_size:
            # Not `output`: padding between rows keeps its values.
            self.sv = f"{'input' if constant else 'inout'} {SCALARS[kind]} {self.name}[]"
            self.declaration = f"const svOpenArrayHandle {self.name}"
            self.passed = (f"({constant or ''}{kind}*)svGetArrayPtr({self.name}), "
                           f"(size_t)svSize({self.name}, 1)")
            self.open_array = True
        elif length:
            self.sv = f"{'input' if constant else 'output'} {SCALARS[kind]} {self.name}[{length}]"
        elif pointer and not constant:
            self.sv = f"output {SCALARS[kind]} {self.name}"
        elif not pointer:
            self.sv = f"input {SCALARS[kind]} {self.name}"
        else:
            raise ValueError(f"no parameter is known as '{text}'")


class Function:
    def __init__(self, result, name, parameters):
        self.result, self.name, self.parameters = result, name, []
        texts = [" ".join(text.split()) for text in parameters.split(",") if text.strip() not in ("", "void")]
        skip = False
        for text, following in zip(texts, [*texts[1:], ""]):
            if skip:
                skip = False
                continue
            skip = following == f"size_t {re.split(r'[ *]', text)[-1]}_size"
            self.parameters.append(Parameter(text, skip))
        self.glued = any(p.open_array or p.text for p in self.parameters)

    def glue_name(self):
        return self.name.replace("deburr_", "deburr_dpi_", 1) if self.glued else self.name


def pieces(header):
    """Yields comments (lists of lines) and Functions of the header in order."""
    begin = header.index("typedef struct")
    for match in PIECE.finditer(header, begin):
        if match["comment"] is None:
            yield Function(match["result"], match["name"], match["parameters"])
        else:
            yield [line.strip().removeprefix("*").strip() for line in match["comment"].strip().splitlines()]


def functions(header):
    found = [piece for piece in pieces(header) if isinstance(piece, Function)]
    # Functions that the pattern missed.
    names = re.findall(r"\b(deburr_\w+)\(", re.sub(r"/\*.*?\*/", "", header, flags=re.S))
    if [function.name for function in found] != names:
        raise ValueError(f"functions that were not read: {set(names) - {function.name for function in found}}")
    return found


def wrapped(before, items, after, columns=100):
    """`before`, comma-separated items and `after`, wrapped at `columns`."""
    lines, indent = [before], " " * 6
    for index, item in enumerate(items):
        text = item + (after if index == len(items) - 1 else ",")
        space = "" if lines[-1].endswith("(") or index == 0 else " "
        if len(lines[-1]) + len(space) + len(text) > columns:
            lines.append(indent + text)
        else:
            lines[-1] += space + text
    if not items:
        lines[-1] += after
    return "\n".join(lines) + "\n"


def package(header):
    out = ["// SPDX-License-Identifier: MIT\n",
           "// Deburr's bit-exact golden models through DPI-C, generated from deburr_golden.h with the same\n"
           "// function names. A pointer with its size becomes an open array, declared as [N] and of the\n"
           "// type below; a returned text becomes a string. Also compile deburr_golden_dpi.c, and link\n"
           "// libdeburr-golden.\n",
           "package deburr_golden_pkg;\n"]
    out += [f"  localparam int {name} = {value};\n" for name, value in CONSTANT.findall(header)]
    for piece in pieces(header):
        if isinstance(piece, Function):
            name = piece.glue_name()
            alias = f"{name} = " if piece.glued else ""
            out.append(wrapped(f'  import "DPI-C" {alias}function {RESULTS[piece.result]} {piece.name}(',
                               [parameter.sv for parameter in piece.parameters], ");"))
        elif piece[0].startswith("----"):
            out.append("\n  // " + piece[0] + "\n")
        else:
            out.append("\n" + "".join(f"  // {line}\n" for line in piece))
    return "".join(out) + "\nendpackage\n"


def glue(header):
    out = ["/* SPDX-License-Identifier: MIT */\n",
           "/* Converts the open arrays and strings of deburr_golden_pkg.sv for libdeburr-golden. Generated from\n"
           " * deburr_golden.h. Compile it with the simulator's svdpi.h. */\n",
           "#include <svdpi.h>\n\n#include \"deburr_golden.h\"\n\n",
           "/* Returned text; the simulator copies it when the function returns. */\n",
           "#ifdef __cplusplus\nextern \"C\" {\n#define OF_THREAD thread_local\n#else\n"
           "#define OF_THREAD _Thread_local\n#endif\n",
           "static OF_THREAD char text_of_thread[4096];\n"]
    for function in functions(header):
        if not function.glued:
            continue
        out.append("\n" + wrapped(f"int {function.glue_name()}(", [p.declaration for p in function.parameters], ") {"))
        texts = [p.name for p in function.parameters if p.text]
        if texts:
            out.append(f"  text_of_thread[0] = '\\0';\n  *{texts[0]} = text_of_thread;\n")
        out.append(wrapped(f"  return {function.name}(", [p.passed for p in function.parameters], ");") + "}\n")
    return "".join(out) + "\n#ifdef __cplusplus\n}\n#endif\n"


def problems(header, texts, page):
    """Yields a message per mismatch with the header."""
    for name, made in ((PACKAGE, package(header)), (GLUE, glue(header))):
        if texts[name] != made:
            yield f"{name} is not what {HEADER} makes: tb/unit/golden/c/systemverilog_test.py HEADER . --write"
    for function in functions(header):
        if not re.search(rf"\b{function.name}\b", page):
            yield f"{PAGE} does not name {function.name}"


def missed_faults(header, texts, page):
    """Injected faults that remain undetected: changes of the header, of a generated file, of the page."""
    changes = [("uint32_t* count);", "uint64_t* count);"), ("size_t lines_size,", "uint32_t lines_size,"),
               ("const int32_t s[4]", "const int32_t s[8]"), ("DEBURR_BUSY = 3", "DEBURR_BUSY = 4"),
               ("uint32_t lane,", "uint32_t corner,"), ("int deburr_reset(", "int deburr_restart("),
               ("const uint8_t* pixels", "uint8_t* pixels"), ("uint32_t x, uint32_t y,", "uint32_t y, uint32_t x,")]
    missed = []
    for old, new in changes:
        changed = header.replace(old, new, 1)
        if changed == header or not list(problems(changed, texts, page)):
            missed.append(f"{old} -> {new}")
    for name, text in texts.items():
        if len(list(problems(header, {**texts, name: text.replace("deburr_reset", "deburr_rset", 1) + " "}, page))) != 1:
            missed.append(name)
    if len(list(problems(header, texts, page.replace("deburr_check", "deburr_cheque")))) != 1:
        missed.append(PAGE)
    for unknown in ("int deburr_a(float x);", "void deburr_b(int x);", "int deburr_c(const uint8_t* bytes);"):
        try:
            list(problems(header.replace("int deburr_reset(", unknown + "\nint deburr_reset("), texts, page))
            missed.append(unknown)
        except (KeyError, ValueError):
            pass
    return missed


def main():
    root = pathlib.Path(sys.argv[2])
    header = pathlib.Path(sys.argv[1]).read_text(encoding="utf-8")
    if "--write" in sys.argv:
        (root / PACKAGE).write_text(package(header), encoding="utf-8")
        (root / GLUE).write_text(glue(header), encoding="utf-8")
    texts = {name: (root / name).read_text(encoding="utf-8") for name in (PACKAGE, GLUE)}
    page = (root / PAGE).read_text(encoding="utf-8")
    found = list(problems(header, texts, page))
    for problem in found:
        print(problem)
    missed = [] if found else missed_faults(header, texts, page)
    for fault in missed:
        print(f"injected fault not caught: {fault}")
    sys.exit(1 if found or missed else 0)


if __name__ == "__main__":
    main()
