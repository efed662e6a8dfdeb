# SPDX-License-Identifier: MIT
"""The units of hdl/ in the configurations of tb/hdl/configurations.txt: the list, their parameters, and the sources
of each."""
import dataclasses
import hashlib
import json
import pathlib
import re
import subprocess

FOLDERS = ("fabric", "pieces", "texture")
# Modules without headers, mapped only to check estimates of units that have no RTL (docs/explanation/cost.md).
PIECES = ("line_divider", "line_walker", "predictor_trial")
# The header has another name for this parameter of the texture unit.
RENAMED = {"cap": "count_cap"}


class Problem(Exception):
    """An error that the user can fix; its text says how."""


@dataclasses.dataclass
class Configuration:
    name: str
    top: str
    settings: list
    headers: pathlib.Path = None
    inputs: str = ""  # a hash of everything that the tools read


@dataclasses.dataclass
class Unit:
    """A module with its parameters."""
    module: str
    parameters: dict          # as the page shows them
    key: str                  # a hash of its sources
    design: pathlib.Path      # the elaborated design that contains it, and its name there
    name: str
    parts: list               # for a unit without registers of its own: (key, count)
    configurations: list
    ports: dict               # bits of each
    rank: int = 0             # the first configurations of a module come first

    def shown(self):
        return " ".join(f"{name}={value}" for name, value in self.parameters.items())


def sha(*texts):
    return hashlib.sha256("\0".join(texts).encode()).hexdigest()


def bare(text):
    """Verilog without comments, layout and proof code."""
    text = re.sub(r"^\s*`ifdef FORMAL\b.*?^\s*`endif\b", "", text, flags=re.S | re.M)
    return re.sub(r"\s+", " ", re.sub(r"//[^\n]*|/\*.*?\*/", " ", text, flags=re.S)).strip()


class Sources:
    """The modules of hdl/, each in a file of its name."""

    def __init__(self, root):
        self.files = {file.stem: file for folder in FOLDERS for file in sorted((root / folder).glob("*.sv"))}
        if not self.files:
            raise Problem(f"{root}: no *.sv in {' and '.join(FOLDERS)}")
        self.text = {name: bare(file.read_text(encoding="utf-8")) for name, file in self.files.items()}

    def below(self, top):
        """The names of a module and of all modules that it instantiates."""
        if top not in self.text:
            raise Problem(f"no module {top} in hdl/")
        names, found = [top], []
        while names:
            name = names.pop()
            if name not in found:
                found.append(name)
                names += sorted(set(re.findall(r"\w+", self.text[name])) & self.text.keys())
        return sorted(found)

    def closure(self, top):
        return " ".join(self.text[name] for name in self.below(top))

    def has_registers(self, name):
        return "always_ff" in self.text[name]

    def has_clock(self, name):
        return re.search(r"\binput (logic )?clk\b", self.text[name]) is not None

    def defaults(self, name):
        """The parameters in the head of a module and the texts of their defaults."""
        head = self.text[name].partition(") (")[0] if "#(" in self.text[name] else ""
        return dict(re.findall(r"parameter (?:integer|logic \[[^]]*\]) (\w+) = ([^,]*?)(?=,| *$| \))", head))


def configurations(file):
    """One line NAME TOP SETTING... each; tb/hdl/CMakeLists.txt builds the same configurations."""
    found = []
    try:
        lines = file.read_text(encoding="utf-8").splitlines()
    except OSError as error:
        raise Problem(f"{file}: {error.strerror}") from error
    for number, line in enumerate(lines, 1):
        words = line.partition("#")[0].split()
        if words:
            if len(words) < 2 or any("=" not in word for word in words[2:]):
                raise Problem(f"{file}:{number}: expected NAME TOP SETTING=VALUE..., got {line}")
            found.append(Configuration(words[0], words[1], words[2:]))
    if not found:
        raise Problem(f"{file}: no configuration")
    return found


def print_headers(found, program, folder, sources):
    """The headers of each configuration (tb/hdl/print_headers.cpp), and the hash of all inputs of the tools."""
    if not program.exists():
        raise Problem(f"{program} does not exist: cmake --preset hdl && cmake --build --preset hdl --target "
                      "deburr_hdl_headers")
    for one in found:
        one.headers = folder / sha(*one.settings)[:16]
        done = subprocess.run([program, one.headers, *one.settings], capture_output=True, text=True, check=False)
        if done.returncode:
            raise Problem(f"{one.name}: {done.stderr.strip()}")
        texts = [bare(file.read_text(encoding="utf-8")) for file in sorted(one.headers.glob("*.svh"))]
        one.inputs = sha(sources.closure(one.top), *texts)


def macros(folder):
    """NAME: value of each macro, in the order of the headers."""
    text = "".join(file.read_text(encoding="utf-8") for file in sorted(folder.glob("*.svh")))
    return dict(re.findall(r"^`define (\w+) (.+)$", text, re.M))


def value_of(bits):
    """A parameter as yosys writes it."""
    if isinstance(bits, str) and re.fullmatch("[01xz]+", bits) and len(bits) <= 64:
        return int(re.sub("[xz]", "0", bits), 2)
    return bits


def code_name(defined, prefix, value):
    """The macro name of a code of the configuration (`FOOTPRINT_HALF 0), or the number itself."""
    for name, code in defined.items():
        if name == f"{prefix}_LAST":
            return value
        if name.startswith(prefix + "_") and code == str(value) and f"{prefix}_LAST" in defined:
            return name[len(prefix) + 1:].lower()
    return value


def shown_parameters(sources, module, parameters, defined):
    """The parameters of a unit as the page shows them: those of the texture unit by their names, others by their own."""
    shown = {}
    for name, default in sources.defaults(module).items():
        value = value_of(parameters.get(name))
        chosen = re.fullmatch(r"`CHOSEN_(\w+)", default.strip())
        if chosen:
            known = chosen[1].lower()
            known = re.sub("^cache_", "cache.", RENAMED.get(known, known))
            shown[known] = code_name(defined, chosen[1].removeprefix("CACHE_"), value)
        elif re.fullmatch(r"\d+", default.strip()) and isinstance(value, int) and name != "CONTENTS":
            shown[name] = value
    return shown


def plain(name):
    """The module that yosys derived `$paramod...` from."""
    if name.startswith("$paramod$"):
        return name.split("\\")[1]
    return name.split("\\")[1] if name.startswith("$paramod\\") else name


def elaborate(configuration, sources, folder, run, note):
    """Writes the design of a configuration for the flows, once, and returns its modules with their yosys names."""
    design = folder / f"{sha(configuration.top, configuration.inputs)[:16]}.il"
    listed = design.with_suffix(".json")
    if not (design.exists() and listed.exists()):
        note(f"reads {configuration.name}")
        files = " ".join(str(sources.files[name]) for name in sources.below(configuration.top))
        # Memories built from these cells stay memories, and are not mapped to flip-flops.
        script = (f"read_verilog -sv -I{configuration.headers} {files}\nhierarchy -check -top {configuration.top}\n"
                  f"proc\nsetattr -set deburr_memory 1 *fifo*/m:* *sram_1r1w*/m:* *rom*/m:*\n"
                  f"write_ilang {design}.part\nwrite_json {listed}.part\n")
        run(script, f"{configuration.name}: module {configuration.top} was not read")
        modules = {}
        for name, module in json.loads(pathlib.Path(f"{listed}.part").read_text(encoding="utf-8"))["modules"].items():
            modules[name] = {
                "parameters": module.get("parameter_default_values", {}),
                "ports": {name: len(port["bits"]) for name, port in module["ports"].items()},
                "cells": [cell["type"] for cell in module["cells"].values() if not re.match(r"\$[a-z_]+$", cell["type"])]}
        listed.write_text(json.dumps(modules), encoding="utf-8")
        pathlib.Path(f"{listed}.part").unlink()
        pathlib.Path(f"{design}.part").rename(design)
    return design, json.loads(listed.read_text(encoding="utf-8"))


def units_of(configuration, sources, design, modules):
    """Every module with a clock, as this configuration builds it: {key: Unit}."""
    defined = macros(configuration.headers)
    keys, found = {}, {}
    for name, module in modules.items():
        of = plain(name)
        text = sources.closure(of)
        used = {word: defined[word] for word in re.findall(r"`(\w+)", text)
                if word in defined and not word.startswith("CHOSEN_")}
        keys[name] = sha(of, json.dumps(module["parameters"], sort_keys=True), text, json.dumps(used, sort_keys=True))
    for name, module in modules.items():
        of = plain(name)
        if not sources.has_clock(of):
            continue
        parts = []
        if not sources.has_registers(of):
            clocked = [cell for cell in module["cells"] if sources.has_clock(plain(cell))]
            if len(clocked) > 1:
                parts = [(keys[cell], clocked.count(cell)) for cell in dict.fromkeys(clocked)]
        found[keys[name]] = Unit(of, shown_parameters(sources, of, module["parameters"], defined), keys[name], design,
                                 name, parts, [configuration.name], module["ports"])
    return found


def all_units(found, sources, folder, run, note):
    """The units of all configurations, each once, sorted by name and parameters."""
    units, ranks = {}, {}
    for one in found:
        ranks[one.top] = rank = ranks.get(one.top, 0) + 1
        for key, unit in units_of(one, sources, *elaborate(one, sources, folder, run, note)).items():
            if key in units:
                units[key].configurations.append(one.name)
            else:
                units[key] = unit
                unit.rank = rank
    # Units with the same shown parameters can still differ: other settings make a port wider.
    alike = {}
    for unit in units.values():
        alike.setdefault((unit.module, unit.shown()), []).append(unit)
    for like in alike.values():
        wider = [port for port in like[0].ports if len({unit.ports[port] for unit in like}) > 1]
        for count, unit in enumerate(like, 1):
            unit.parameters = {**unit.parameters, **{port: unit.ports[port] for port in wider[:1]}}
            if len(like) > 1 and not wider:
                unit.parameters["contents"] = count
    return sorted(units.values(), key=lambda unit: (unit.module, [
        (str(name), not isinstance(value, int), value if isinstance(value, int) else str(value))
        for name, value in unit.parameters.items()]))
