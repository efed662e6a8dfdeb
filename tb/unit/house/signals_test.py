#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Checks on the headers of the engines that the module tree is the block diagram: units are joined by
links and wires alone.

No unit holds or is given another unit by reference or pointer, none has a pointer that is set from
outside, and none asks by a function what a wire would tell (observers, which return nothing, are
for checks). Registers, memories' ports and instruments are no units and may be shared. A part that
keeps a memory (a store of lines on their way, say) has one owner; another unit holds a side of it that the
part declares, `Store::Reader`, as of a memory a port.
"""
import argparse
import pathlib
import re
import sys
import tempfile

# Rooms of rtl_model that are no engine.
NO_ENGINES = {"fabric", "platform"}
COMMENT = re.compile(r"//[^\n]*|/\*.*?\*/", re.S)
CLASS = re.compile(r"\b(?:class|struct)\s+(\w+)\s*(?:final\s*)?:\s*([^{;]*)\{")
BASES = re.compile(r"\bpublic\s+(?:[\w:]+::)?(Unit|Engine|sc_module)\b")
POINTER = re.compile(r"^\s*(?:const\s+)?[\w:]+(?:<[^;]*>)?(?:\s+const)?\s*\*\s*(?:const\s+)?\w+\s*(?:=\s*nullptr|\{\s*\})?\s*;")
PART = re.compile(r"^(?:class|struct)\s+(\w+)\s*(?:final\s*)?\{", re.M)
MEMORY = re.compile(r"^\s*(?:std::(?:array|vector|deque)\s*<\s*)?Memory<[^;()]*\b\w+\s*(?:\{[^;]*)?;", re.M)
# (unit, part): who is given a part whole, and why.
WHOLE = {
    ("RunExtractor", "EdgeWindow"): "writes it",
    ("RunExtractor", "EdgeRows"): "writes them",
    ("EndpointPredictor", "EdgeWindow"): "makes EdgePorts of it, as many as its schedule has",
    ("EndpointPredictor", "EdgeRows"): "makes EdgePorts of them, as many as its schedule has",
    ("AreaUnit", "SharesRom"): "shows its own to the registers",
    ("Resolver", "FillStore"): "uses the lines that BlockFetch reserves and fills",
}
FUNCTION = re.compile(r"\bstd::function<\s*(?!void\b)([^()]*?)\(")


def body_of(text, begin):
    """From behind an opening brace to the one that closes it."""
    depth = 1
    for at in range(begin, len(text)):
        depth += {"{": 1, "}": -1}.get(text[at], 0)
        if depth == 0:
            return text[begin:at]
    return text[begin:]


def classes(text):
    """(name, base, first line, body) of every module in a header without comments."""
    for match in CLASS.finditer(text):
        base = BASES.search(match.group(2))
        if base:
            yield match.group(1), base.group(1), text.count("\n", 0, match.end()) + 1, body_of(text, match.end())


def own_lines(body):
    """(offset, line, public) of the lines that are the class's own: not those in braces."""
    depth, public = 0, False
    for offset, line in enumerate(body.split("\n")):
        if depth == 0:
            label = re.match(r"\s*(public|protected|private)\s*:", line)
            if label:
                public = label.group(1) == "public"
            yield offset, line, public
        depth += line.count("{") - line.count("}")


def parts(text):
    """Names of classes without a base that keep memories."""
    return {match.group(1) for match in PART.finditer(text)
            if any(MEMORY.search(line) for _, line, _ in own_lines(body_of(text, match.end())))}


def violations(root, whole):
    """Yields 'file:line: rule' for every broken rule below root; `whole`: who is given a part whole."""
    headers = {}
    for path in sorted((root / "rtl_model").rglob("*.h")):
        if path.relative_to(root).parts[1] in NO_ENGINES:
            continue
        # Comments go, their lines stay.
        text = path.read_text(encoding="utf-8")
        headers[path.relative_to(root)] = COMMENT.sub(lambda c: "\n" * c.group().count("\n"), text)
    found = {name: list(classes(text)) for name, text in headers.items()}
    units = {c[0] for list_ in found.values() for c in list_ if c[1] == "Unit"}
    stores = {name for text in headers.values() for name in parts(text)}
    shared = re.compile(rf"\b({'|'.join(sorted(stores)) or '(?!)'})\b(?:<[^;<>]*>)?\s*(?:const\s*)?[&*]")
    met = set()
    for where, list_ in found.items():
        for name, base, first, body in list_:
            others = "|".join(sorted(units - {name})) or "(?!)"
            held = re.compile(rf"\b({others})\b\s*(?:const\s*)?[&*]")
            owned = re.compile(rf"\b(?:unique_ptr|shared_ptr|reference_wrapper)\s*<\s*(?:const\s+)?({others})\b")
            for offset, line in enumerate(body.split("\n")):
                if held.search(line):
                    yield f"{where}:{first + offset}: {name} holds or is given {held.search(line)[1]}: join them by a link or a wire"
                part = shared.search(line) if base == "Unit" else None
                if part:
                    met.add((name, part[1]))
                if part and (name, part[1]) not in whole:
                    yield f"{where}:{first + offset}: {name} holds or is given the whole {part[1]}: declare its side, {part[1]}::Reader"
                if base == "Unit" and owned.search(line):
                    yield f"{where}:{first + offset}: {name} holds {owned.search(line)[1]}: join them by a link or a wire"
            if base != "Unit":
                continue
            for offset, line, public in own_lines(body):
                if public and POINTER.match(line):
                    yield f"{where}:{first + offset}: {name} has a pointer that is set from outside"
                if public and FUNCTION.search(line):
                    yield f"{where}:{first + offset}: {name} asks by a function: use a wire"
    for name, part in sorted(set(whole) - met):
        yield f"{name} is not given {part} any more: take it off the list"


def planted_faults_are_caught():
    """Plants one fault of each kind and returns those that were missed."""
    unit = ("class Other final : public Unit {\n public:\n  void reset();\n};\n"
            "template <class Word>\nclass Store {\n public:\n  class Reader {\n    Store* store_;\n  };\n\n private:\n"
            "  Memory<Word> memory_;\n};\nclass Rules {\n  int lanes_;\n};\n")
    faults = {
        "a reference": "class A final : public Unit {\n  const Other& other_;\n};",
        "a constructor's reference": "class A final : public Unit {\n public:\n  A(int lanes,\n    Other& other);\n};",
        "a pointer": "class A final : public Unit {\n  Other* other_ = nullptr;\n};",
        "a smart pointer": "class A final : public Unit {\n  std::unique_ptr<Other> other_;\n};",
        "in a struct inside": "class A final : public Unit {\n  struct Side {\n    Other const& other;\n  };\n};",
        "a module's reference": "class A final : public sc_core::sc_module {\n  Other& other_;\n};",
        "a pointer from outside": "class A final : public Unit {\n public:\n  Latency* latency = nullptr;  // or none\n};",
        "a pointer without a value": "class A final : public Unit {\n public:\n  const Probe<int>* probe;\n};",
        "a question": "class A final : public Unit {\n public:\n  std::function<bool(Cycle)> done;\n};",
    }
    faults |= {
        "a part that keeps a memory": "class A final : public Unit {\n  Store<Line>& lines_;\n};",
        "a constructor's part": "class A final : public Unit {\n public:\n  A(int lanes,\n    const Store<Line>& lines);\n};",
    }
    fine = {
        "its own part": "class A final : public Unit {\n public:\n  Store<Line> lines;\n};",
        "a part's side": "class A final : public Unit {\n public:\n  A(const Store<Line>::Reader& lines);\n\n private:\n"
                         "  Store<Line>::Reader lines_;\n};",
        "a part without a memory": "class A final : public Unit {\n  const Rules& rules_;\n};",
        "who is on the list": "class Writer final : public Unit {\n  Store<Line>& lines_;\n};",
        "an owner": "class A final : public Engine {\n public:\n  Other other;\n  std::unique_ptr<Other> second;\n};",
        "an observer": "class A final : public Unit {\n public:\n  std::function<void(const Beat&)> observer;\n};",
        "itself": "class A final : public Unit {\n  struct Side {\n    const A& unit;\n  };\n};",
        "registers": "class A final : public Unit {\n  const ParameterStore& store_;\n};",
        "a comment": "class A final : public Unit {\n  // Other& is joined by a link.\n  int x_;\n};",
        "its own pointer": "class A final : public Unit {\n public:\n  A();\n\n private:\n  Beat* newest_ = nullptr;\n};",
    }
    missed = []
    for cases, wanted in ((faults, 1), (fine, 0)):
        for what, text in cases.items():
            with tempfile.TemporaryDirectory() as folder:
                path = pathlib.Path(folder) / "rtl_model/engine/a.h"
                path.parent.mkdir(parents=True)
                path.write_text(unit + text + "\n", encoding="utf-8")
                named = {("Writer", "Store"): "writes it"} if "Writer" in text else {}
                if len(list(violations(pathlib.Path(folder), named))) != wanted:
                    missed.append(what)
    with tempfile.TemporaryDirectory() as folder:
        if len(list(violations(pathlib.Path(folder), {("Writer", "Store"): "wrote it"}))) != 1:
            missed.append("a name that is on the list for nothing")
    return missed


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("root", type=pathlib.Path, help="the checkout")
    root = parser.parse_args().root
    missed = planted_faults_are_caught()
    for fault in missed:
        print(f"planted fault not caught, or said of what is fine: {fault}")
    found = list(violations(root, WHOLE))
    for violation in found:
        print(violation)
    sys.exit(1 if found or missed else 0)


if __name__ == "__main__":
    main()
