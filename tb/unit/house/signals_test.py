#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Checks in the headers of the engines that the module tree is the block diagram: only links and wires connect units.

A module neither holds nor receives another module of its engine by reference or pointer. A unit has no pointer that is
set from outside, and no callback that returns a value: that needs a wire (observers return nothing and serve checks).
SHARED lists everything that a module, or a class that is part of one, may hold by reference. Handles of memory ports,
and of the two sides of a line buffer, are values.
"""
import pathlib
import re
import tempfile

from house_main import house_main

# Folders of rtl_model that are not engines.
NO_ENGINES = {"fabric", "platform"}
# Classes shared by units, or not hardware, with the reason.
SHARED = {
    "ClockDomain": "the clock",
    "ControlRegisters": "the registers on the bus",
    "EdgeWindow": "a memory with a port a user",
    "EdgeRows": "a memory with a port a user",
    "PortSchedule": "which clock of a port is whose",
    "EdgeMemory": "a memory and a handle of its port",
    "EdgeLatency": "an instrument",
    "LatencyProbe": "an instrument",
}
# Parts of one unit: the first addresses the memories of the second.
PARTS = {"DescriptorWalk": "DescriptorStore"}
# Modules that hold one of two units, that of the width which is built, by the base that both have.
BUILT = {
    "TextureCache": {"TagUnit", "DataUnit", "BlockDecoderBase"},
    "TextureUnit": {"DerivativeUnitBase", "LevelUnitBase", "SampleWalkerBase", "TexelAddresserBase", "FilterPipelineBase"},
}
COMMENT = re.compile(r"//[^\n]*|/\*.*?\*/", re.S)
CLASS = re.compile(r"\b(?:class|struct)\s+(\w+)\s*(?:final\s*)?:\s*([^{;]*)\{")
ANY_CLASS = re.compile(r"\b(?:class|struct)\s+(\w+)\s*(?:final\s*)?(?::\s*([^{;]*))?\{")
BASES = re.compile(r"\bpublic\s+(?:[\w:]+::)?(Unit|Engine|sc_module)\b")
POINTER = re.compile(r"^\s*(?:const\s+)?[\w:]+(?:<[^;]*>)?(?:\s+const)?\s*\*\s*(?:const\s+)?\w+\s*(?:=\s*nullptr|\{\s*\})?\s*;")
# No initialiser: a member, not a local variable.
REFERENCE = re.compile(r"^\s*(?:const\s+)?(?:\w+::)*(\w+)(?:<[^;]*>)?(?:\s+const)?\s*&\s*\w+\s*;")
FUNCTION = re.compile(r"\bstd::function<\s*(?!void\b)([^()]*?)\(")


def body_of(text, begin):
    """The text after an opening brace up to the matching closing brace."""
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
    """Yields (offset, line, public) for the lines of the class body outside nested braces."""
    depth, public = 0, False
    for offset, line in enumerate(body.split("\n")):
        if depth == 0:
            label = re.match(r"\s*(public|protected|private)\s*:", line)
            if label:
                public = label.group(1) == "public"
            yield offset, line, public
        depth += line.count("{") - line.count("}")


def violations(root):
    """Yields 'file:line: rule' for every broken rule below root."""
    headers = {}
    for path in sorted((root / "rtl_model").rglob("*.h")):
        if path.relative_to(root).parts[1] in NO_ENGINES:
            continue
        # Removes comments and keeps line numbers.
        text = path.read_text(encoding="utf-8")
        headers[path.relative_to(root)] = COMMENT.sub(lambda c: "\n" * c.group().count("\n"), text)
    found = {name: list(classes(text)) for name, text in headers.items()}
    modules, units = {}, {}
    for where, list_ in found.items():
        modules.setdefault(where.parts[1], set()).update(c[0] for c in list_)
        units.setdefault(where.parts[1], set()).update(c[0] for c in list_ if c[1] != "sc_module")
    for where, list_ in found.items():
        engine = where.parts[1]
        for name, base, first, body in list_:
            others = "|".join(sorted(modules[engine] - {name, PARTS.get(name)} - BUILT.get(name, set()))) or "(?!)"
            held = re.compile(rf"\b({others})\b\s*(?:const\s*)?[&*]")
            # An optional part is owned by a pointer, a permanent one is a member.
            parts = "|".join(sorted(units[engine] - {name})) or "(?!)"
            owned = re.compile(rf"\b(?:unique_ptr\s*<\s*(?:const\s+)?({parts})|(?:shared_ptr|reference_wrapper)\s*<\s*(?:const\s+)?({others}))\b")
            for offset, line in enumerate(body.split("\n")):
                if held.search(line):
                    yield f"{where}:{first + offset}: {name} holds or is given {held.search(line)[1]}: join them by a link or a wire"
                if base == "Unit" and owned.search(line):
                    yield f"{where}:{first + offset}: {name} holds {owned.search(line)[1] or owned.search(line)[2]}: join them by a link or a wire"
                reference = REFERENCE.search(line)
                if reference and reference[1] not in modules[engine] | SHARED.keys():
                    yield f"{where}:{first + offset}: {name} holds {reference[1]}, which SHARED does not name: use a link or a wire"
            if base != "Unit":
                continue
            for offset, line, public in own_lines(body):
                if public and POINTER.match(line):
                    yield f"{where}:{first + offset}: {name} has a pointer that is set from outside"
                if public and FUNCTION.search(line):
                    yield f"{where}:{first + offset}: {name} asks by a function: use a wire"
        text = headers[where]
        for body in (module[3] for module in list_):
            text = text.replace(body, "\n" * body.count("\n"))
        yield from of_parts(where, text, modules[engine])


def of_parts(where, text, modules):
    """Yields unlisted references held by classes that are not modules."""
    for match in ANY_CLASS.finditer(text):
        first = text.count("\n", 0, match.end()) + 1
        for offset, line, _ in own_lines(body_of(text, match.end())):
            reference = REFERENCE.search(line)
            if reference and reference[1] not in SHARED.keys() | modules:
                yield f"{where}:{first + offset}: {match[1]} holds {reference[1]}, which SHARED does not name: give it a handle of its side"


def not_shared(root):
    """Yields entries of SHARED and PARTS that no engine uses."""
    held = set()
    for path in (root / "rtl_model").rglob("*.h"):
        if path.relative_to(root).parts[1] not in NO_ENGINES:
            lines = COMMENT.sub("", path.read_text(encoding="utf-8")).split("\n")
            held.update(match[1] for match in map(REFERENCE.search, lines) if match)
    for name in sorted(SHARED.keys() - held):
        yield f"SHARED names {name}, which no module holds: remove it"
    for name in sorted(set(PARTS.values()) - held):
        yield f"PARTS names {name}, which no module holds: remove it"


def injected_faults_are_caught():
    """Injects one fault of each kind and returns the missed ones."""
    unit = ("class Other final : public Unit {\n public:\n  void reset();\n};\n"
            "class Store final : public sc_core::sc_module {\n  int x_;\n};\n")
    faults = {
        "a reference": "class A final : public Unit {\n  const Other& other_;\n};",
        "a constructor's reference": "class A final : public Unit {\n public:\n  A(int lanes,\n    Other& other);\n};",
        "a pointer": "class A final : public Unit {\n  Other* other_ = nullptr;\n};",
        "a smart pointer": "class A final : public Unit {\n  std::unique_ptr<Other> other_;\n};",
        "a shared part": "class A final : public Unit {\n  std::shared_ptr<Store> store_;\n};",
        "in a struct inside": "class A final : public Unit {\n  struct Side {\n    Other const& other;\n  };\n};",
        "a module's reference": "class A final : public sc_core::sc_module {\n  Other& other_;\n};",
        "a module that is not a unit": "class A final : public Unit {\n  const Store& store_;\n};",
        "a reference that is not listed": "class A final : public Unit {\n  struct Side {\n    const Table<Word>& table;\n  };\n};",
        "a pointer from outside": "class A final : public Unit {\n public:\n  Latency* latency = nullptr;  // or none\n};",
        "a pointer without a value": "class A final : public Unit {\n public:\n  const Probe<int>* probe;\n};",
        "a part's reference": "class Loader {\n  Rom& rom_;\n};",
        "a part of a part": "class Loader {\n  struct Side {\n    const Rom<int>& rom;\n  };\n};",
        "a question": "class A final : public Unit {\n public:\n  std::function<bool(Cycle)> done;\n};",
    }
    fine = {
        "an owner": "class A final : public Engine {\n public:\n  Other other;\n  std::unique_ptr<Other> second;\n};",
        "a part that may be left out": "class A final : public Unit {\n  std::unique_ptr<Store> store_;\n};",
        "an observer": "class A final : public Unit {\n public:\n  std::function<void(const Beat&)> observer;\n};",
        "itself": "class A final : public Unit {\n  struct Side {\n    const A& unit;\n  };\n};",
        "an instrument": "class A final : public Unit {\n  EdgeLatency& latency_;\n};",
        "a local name": "class A final : public Unit {\n  void work() {\n    const Table& table = tables_[0];\n  }\n};",
        "a part's registers": "class Loader {\n  ControlRegisters& registers_;\n};",
        "a handle": "class Loader {\n  Rom::LoadPort tables_;\n};",
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
                if len(list(violations(pathlib.Path(folder)))) != wanted:
                    missed.append(what)
    return missed


if __name__ == "__main__":
    house_main(__doc__, injected_faults_are_caught(), lambda root: [*violations(root), *not_shared(root)])
