#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Lints the top modules of hdl/ and all modules below them in every generated configuration: with Verilator (-Wall
and the waivers of hdl/lint.vlt), with Icarus Verilog, and by synthesis with yosys (no latch, no loop, no multiple
drivers). Each tool must reject an injected fault, and every file of hdl/ must be covered by a configuration
(Verilator, Icarus Verilog).

usage: lint_test.py SOURCE VERILATOR|ICARUS|YOSYS HEADERS..."""
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

FAULTS = {
    "verilator": ("wire [5:0] n = position - 6'd16;", "wire [5:0] n = position - 7'd16;"),  # a width mismatch
    "icarus": ("assign mitchell = $signed({n, y});", "assign michell = $signed({n, y}};"),  # a syntax error
    "yosys": ("position = 6'd0;\n", "\n"),  # a latch
}


def commands(tool, root, headers, module):
    folders = [word for folder in ("fabric", "pieces", "texture") for word in ("-y", root / folder)]
    files = sorted(root.rglob("*.sv"))
    if tool == "verilator":
        return ["verilator", "--lint-only", "-Wall", root / "lint.vlt", f"-I{headers}", *folders,
                "--top-module", module, next(path for path in files if path.stem == module)]
    if tool == "icarus":
        return ["iverilog", "-g2012", "-t", "null", f"-I{headers}", "-Y", ".sv", *folders,
                "-s", module, next(path for path in files if path.stem == module)]
    names = " ".join(map(str, files))
    return ["yosys", "-q", "-p", f"read_verilog -sv -I{headers} {names}; hierarchy -check -top {module}; proc; "
                                 "opt; check -assert; select -assert-none t:$dlatch"]


def seen(tool, root, headers, module, folder):
    """The modules that the tool reads below a top; None for yosys, which reads every file."""
    if tool == "yosys":
        return None
    command = list(map(str, commands(tool, root, headers, module)))
    if tool == "verilator":
        command = [command[0], "--xml-only", "--Mdir", folder, "-Wno-fatal", *command[2:]]
        subprocess.run(command, capture_output=True, check=True)
        text = (pathlib.Path(folder) / f"V{module}.xml").read_text(encoding="utf-8")
        return set(re.findall(r'<module [^>]*\borigName="(\w+)"', text))
    files = pathlib.Path(folder) / "files"
    subprocess.run([*command, "-M", files], capture_output=True, check=True)
    return {pathlib.Path(name).stem for name in files.read_text(encoding="utf-8").split() if name.endswith(".sv")}


def left_over(tool, root, printed):
    """Findings for files below hdl/ that no configuration covers."""
    texts = texts_of(root)
    with tempfile.TemporaryDirectory(prefix="deburr_lint_") as folder:
        found = [seen(tool, root, headers, top, folder) for headers in printed for top in tops_of(texts)]
    if None in found:
        return []
    return [f"{tool}: {name}.sv: no configuration builds it" for name in
            sorted(texts.keys() - set().union(*found))]


def texts_of(root):
    return {path.stem: path.read_text(encoding="utf-8") for path in root.rglob("*.sv")}


def tops_of(texts):
    """The modules that no other module instantiates."""
    built = {name for text in texts.values() for name in re.findall(r"^ *(\w+) (?:#\(.*\) )?\w+ \((?:$|\.)", text, re.M)}
    return sorted(texts.keys() - built)


def rejected(tool, root, headers, module):
    """The tool's message against a module, or None."""
    done = subprocess.run(list(map(str, commands(tool, root, headers, module))), capture_output=True, text=True,
                          check=False)
    said = re.sub(r".*sorry: constant selects in always_.*\n", "", done.stdout + done.stderr)
    return f"{tool}: {module} with {headers.name}: {said}" if done.returncode != 0 else None


def main():
    if len(sys.argv) < 4:
        sys.exit(__doc__.splitlines()[-1])
    root, tool = pathlib.Path(sys.argv[1]) / "hdl", sys.argv[2]
    program = {"icarus": "iverilog"}.get(tool, tool)
    if shutil.which(program) is None:
        print(f"skipped '{program} is not installed: scripts/install hdl'")
        return
    tops, printed = tops_of(texts_of(root)), [pathlib.Path(headers) for headers in sys.argv[3:]]
    problems = [rejected(tool, root, headers, top) for headers in printed for top in tops]
    count = len(problems)
    problems += left_over(tool, root, printed)
    with tempfile.TemporaryDirectory(prefix="deburr_lint_") as folder:
        copy = pathlib.Path(folder) / "hdl"
        shutil.copytree(root, copy)
        file = copy / "texture/log2_value.sv"
        text = file.read_text(encoding="utf-8")
        good, bad = FAULTS[tool]
        if text.count(good) != 1:
            sys.exit(f"log2_value.sv has {good!r} {text.count(good)} times, expected once: the fault cannot be injected")
        file.write_text(text.replace(good, bad), encoding="utf-8")
        if rejected(tool, copy, pathlib.Path(sys.argv[3]), "log2_value") is None:
            problems.append(f"{tool} accepts the injected fault {bad!r}")
        # A module that a unit instantiates but that no configuration builds.
        file.write_text(text, encoding="utf-8")
        (copy / "texture/nowhere.sv").write_text("module nowhere (input logic clk);\nendmodule\n", encoding="utf-8")
        with (copy / "texture/address_unit.sv").open("a", encoding="utf-8") as stream:
            stream.write("`ifdef NEVER\nmodule never (input logic clk);\n  nowhere cell (.clk);\nendmodule\n`endif\n")
        if tool != "yosys" and not any("nowhere.sv" in said for said in left_over(tool, copy, printed[:1])):
            problems.append(f"{tool}: the unused file nowhere.sv is not reported")
    problems = [problem for problem in problems if problem]
    print("\n".join(problems) or f"{tool}: {count} runs, top modules {', '.join(tops)}")
    sys.exit(1 if problems or not count else 0)


if __name__ == "__main__":
    main()
