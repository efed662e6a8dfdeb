#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Proves one property of the units in hdl/, and that the proof can fail: with a fault injected in the
source it must be refuted. Sequential properties are proved by induction over one to three cycles with
hand-written invariants (yosys-smtbmc, z3), combinational ones for all inputs by yosys' SAT solver. Invariants
are in the unit, or in a proof module that names the unit's registers by wires with the attribute
`hierconn`.

usage: formal_test.py SOURCE HEADERS PROOF | --list"""
import dataclasses
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import time

TOOLS = ("yosys", "yosys-smtbmc", "z3")
SECONDS = 120  # per proof


@dataclasses.dataclass
class Proof:
    top: str
    method: str      # "sat": for all inputs; "induction": all cycles; "bmc": the first STEPS cycles, from any state
    fault: tuple     # (file, from, to)
    steps: int = 3
    parameters: dict = dataclasses.field(default_factory=dict)
    base: int = 0    # cycles of the base case of an induction; the default is the number of steps
    free: str = ""   # modules whose outputs the solver chooses freely in every cycle
    registers: bool = False  # memories as registers, so that invariants can name a word


LINK = ("fabric/link.sv", "behind == HERE) place[i] <= push_data;\n          else if (pop)",
        "count == HERE) place[i] <= push_data;\n          else if (pop)")
# Modules whose own properties assume a protocol; as parts of another top these must not be assumed.
FABRIC = ("link", "fifo", "pipe")
PROOFS = {
    # Count, order and data of a followed beat; the faults: a push together with a pop is stored one entry too far.
    "link_1": Proof("link", "induction", ("fabric/link.sv", "can_push <= next_count != FULL", "can_push <= !push"),
                    parameters={"ENTRIES": 1, "BITS": 32}),
    "link_2": Proof("link", "induction", LINK, parameters={"ENTRIES": 2, "BITS": 336}),
    "link_5": Proof("link", "induction", LINK, parameters={"ENTRIES": 5, "BITS": 32}),
    "fifo_2": Proof("fifo", "induction",
                    ("fabric/fifo.sv", "ready == 2'd2) first <= second", "ready == 2'd2) first <= word"),
                    parameters={"ENTRIES": 2, "BITS": 32}),
    "fifo_107": Proof("fifo", "induction", ("fabric/fifo.sv", "read_place == LAST ?", "read_place + 1'b1 == LAST ?"),
                      parameters={"ENTRIES": 107, "BITS": 8}),
    "pipe": Proof("pipe_proof", "induction",
                  ("fabric/pipe.sv", "move = out_ready || !valid[STAGES-1]", "move = out_ready || !valid[0]")),
    "log2_value_32": Proof("log2_value_proof", "sat", ("texture/log2_value.sv", "shifted[11:0]", "shifted[12:1]")),
    "log2_value_47": Proof("log2_value_proof", "sat", ("texture/log2_value.sv", "i < BITS", "i < BITS - 1"),
                           parameters={"BITS": 47}),
    "log2_segments": Proof("log2_segments_proof", "sat",
                           ("texture/log2_correction.sv", "10'd20 + (r >> 2)", "10'd20 + (r >> 3)")),
    "log2_corrected": Proof("log2_corrected_proof", "sat",
                            ("texture/log2_correction.sv", "TABLE[y[11:9]*", "TABLE[y[10:9]*")),
    "log2_exact": Proof("log2_exact_proof", "bmc", ("texture/log2_exact.sv", "+ 13'd32", "+ 13'd31"), steps=4,
                        registers=True),
    # The smallest decrease that holds: a fault that increases it is refuted.
    "log2_falls_segments": Proof("log2_monotone_proof", "sat", ("texture/log2_correction.sv", "10'd356", "10'd355")),
    "log2_falls_corrected": Proof("log2_monotone_proof", "sat",
                                  ("texture/log2_correction.sv", "TABLE[y[11:9]*", "TABLE[y[11:10]*"),
                                  parameters={"RULE": 1, "FALL": 118}),
    "tile_index": Proof("tile_index_proof", "sat",
                        ("texture/tile_index.sv", "longer >> i}", "longer >> 1 >> i}")),
    "texel_axis": Proof("texel_axis_proof", "sat",
                        ("texture/texel_axis.sv", "low > last ? last : low", "low > end_of ? last : low")),
    "bank_passes": Proof("bank_passes_proof", "sat",
                         ("texture/bank_passes.sv", "{1'b0, bank_32 && first_2}", "{1'b0, bank_32}")),
    "root_stage": Proof("root_stage_proof", "sat",
                        ("texture/root_stage.sv", "bit_2 = with_2 >= try_2", "bit_2 = with_2 > try_2")),
    "root_pipe": Proof("root_pipe", "induction",
                       ("texture/root_stage.sv", "{digits[59:0], 4'd0}", "{digits[60:0], 3'd0}"),
                       steps=1, base=3, registers=True),
    # Four lines, the fewest entries; five lines of two beats.
    "miss_path_4": Proof("miss_path_proof", "induction",
                         ("texture/fill_buffer.sv", "(!line_valid || use_line)", "(!line_valid || held != FULL)"),
                         steps=1, base=3, registers=True, parameters={"ENTRIES": 4}),
    "miss_path_5": Proof("miss_path_proof", "induction",
                         ("texture/miss_queue.sv", "if (count > 3'd2)", "if (count > 3'd3)"),
                         steps=1, base=3, registers=True, parameters={"ENTRIES": 5, "LINE_BYTES": 128}),
    # The fault: a request for ENTRIES lines is never accepted.
    "cache_moves": Proof("cache_moves_proof", "induction",
                         ("texture/miss_queue.sv", "FULL = ENTRIES[COUNT_BITS:0]", "FULL = ENTRIES[COUNT_BITS:0] - 1'b1"),
                         steps=1, base=3, registers=True, free="tag_look_up"),
}
# The level for each count, with and without cap, of a minor side and of an area.


def level_fault(axes, count, cap):
    """A fault (from, to) in code that only this configuration uses."""
    if count == "any":
        return "if (e_1 > {1'b0,", "if (e_1 >= {1'b0,"
    if cap == "texel":
        return "limited < cap ? limited : cap", "limited > cap ? limited : cap"
    if axes == "four":
        return "(lb_max <<< 1) - lb_minor", "lb_max - lb_minor"
    if count == "ceil":
        return "further == 13'd0", "further == 13'd1"
    return "mixed_end = level_mixed >= ", "mixed_end = level_mixed > "


PROOFS |= {f"level_{axes}_{count}_{cap}": Proof("level_bounds_proof", "bmc",
                                                ("texture/level_unit.sv", *level_fault(axes, count, cap)), steps=3,
                                                registers=True, parameters={"AXES": a, "COUNT": n, "CAP": c})
           for a, axes in enumerate(("two", "four")) for n, count in enumerate(("floor", "ceil", "any"))
           for c, cap in enumerate(("none", "texel"))}
# The length of a side by each rule without a square root.
SIDE = "texture/side_length.sv"
PROOFS |= {f"footprint_{name}": Proof("side_length_proof", "sat", (SIDE, *fault), parameters={"RULE": rule})
           for name, rule, fault in (("half", 0, ("low = {1'b0, a} + {2'b0, b[30:1]}", "low = {1'b0, a} + {1'b0, b}")),
                                     ("quarter", 1, ("{3'b0, b[30:2]}", "{2'b0, b[30:1]}")),
                                     ("two_segment", 2, ("{4'b0, b[30:3]}", "{3'b0, b[30:2]}")),
                                     ("max", 4, ("a = s > t ? s : t", "a = s")))}


def script(proof, sources, headers, out):
    """Commands for yosys."""
    files = " ".join(str(path) for path in sources)
    lines = [f"read_verilog -sv -formal -DFORMAL{' -mem2reg' * proof.registers} -I{headers} {files}"]
    lines += [f"chparam -set {name} {value} {proof.top}" for name, value in proof.parameters.items()]
    lines.append(f"hierarchy -check -top {proof.top}")
    if proof.method == "sat":
        lines += ["proc", "flatten", "opt -full", "sat -verify -prove-asserts -set-assumes -show-ports"]
    else:
        lines += [f"cutpoint t:*{proof.free}*"] if proof.free else []
        lines += ["proc", "chformal -remove a:src=*/hdl/fabric/*"] if proof.top not in FABRIC else []
        # A name that is not a register would be an undriven wire.
        lines += [f"prep -flatten -nordff -top {proof.top}", "select -assert-none a:hierconn w:*g_beat[1]* %d",
                  f"write_smt2 -wires {out}"]
    return "; ".join(lines)


def run(command, log):
    """Exit code and output; None on timeout."""
    # In its own process group, so that processes started by yosys-smtbmc end with it.
    with subprocess.Popen(list(map(str, command)), stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                          start_new_session=True) as process:
        try:
            out, error = process.communicate(timeout=SECONDS)
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            return None, f"no answer in {SECONDS} s: {' '.join(map(str, command))[:200]}"
    log.write_text(out + error, encoding="utf-8")
    return process.returncode, out + error


def proved(proof, source, headers, fault):
    """(True, False or None if undecided; output)."""
    with tempfile.TemporaryDirectory(prefix="deburr_formal_") as folder:
        root = pathlib.Path(folder)
        shutil.copytree(source / "hdl", root / "hdl")
        shutil.copytree(source / "tb/hdl/formal", root / "formal")
        if fault:
            file, wrong, right = proof.fault
            text = (root / "hdl" / file).read_text(encoding="utf-8")
            if text.count(wrong) != 1:
                return None, f"{file} has {wrong!r} {text.count(wrong)} times, expected once: the fault cannot be injected"
            (root / "hdl" / file).write_text(text.replace(wrong, right), encoding="utf-8")
        sources = needed(root, proof.top)
        smt, log = root / "model.smt2", root / "log"
        code, said = run(["yosys", "-p", script(proof, sources, headers, smt)], log)
        if code is None:
            return None, said
        if proof.method == "sat":
            if "SAT proof finished - no model found: SUCCESS!" in said and code == 0:
                return True, said
            return (False if "Called with -verify and proof did fail!" in said else None), said
        if code != 0:
            return None, said
        # The base case of the induction: nothing fails in the first cycles after a reset. Without arrays each step is a
        # separate query to z3's bit-vector solver, which is much faster.
        solver = ["yosys-smtbmc", "-s", "z3", "--unroll"] + ["--noincr", "--logic", "QF_BV"] * proof.registers
        commands = [[*solver, "-t", str(proof.base or proof.steps), smt]]
        if proof.method == "induction":
            commands.append([*solver, "-i", "-t", str(proof.steps), smt])
        for command in commands:
            code, said = run(command, log)
            if code is None:
                return None, said
            if "Status: FAILED" in said or "Status: failed" in said:
                return False, said
            if "Status: PASSED" not in said and "Status: passed" not in said:
                return None, said
        return True, said


def needed(root, top):
    """The files of the modules below a top: a module is in the file of its name."""
    by_name = {path.stem: path for folder in ("hdl/fabric", "hdl/texture", "formal")
               for path in (root / folder).glob("*.sv")}
    names, found = [top], []
    while names:
        name = names.pop()
        if by_name[name] in found:
            continue
        found.append(by_name[name])
        words = set(by_name[name].read_text(encoding="utf-8").replace("(", " ").replace("#", " ").split())
        names += sorted(words & by_name.keys())
    return found


def main():
    if sys.argv[1:] == ["--list"]:
        print(" ".join(PROOFS))
        return
    if len(sys.argv) != 4:
        sys.exit(__doc__.splitlines()[-1])
    source, headers, proof = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]), PROOFS[sys.argv[3]]
    missing = [tool for tool in TOOLS if shutil.which(tool) is None]
    if missing:
        print(f"skipped '{missing[0]} is not installed: scripts/install hdl'")
        return
    for fault, wanted in ((False, True), (True, False)):
        start = time.monotonic()
        verdict, said = proved(proof, source, headers, fault)
        what = "with an injected fault" if fault else "as it is"
        print(f"{sys.argv[3]} {what}: {dict([(True, 'proved'), (False, 'refuted'), (None, 'undecided')])[verdict]}, "
              f"{time.monotonic() - start:.1f} s")
        if verdict is not wanted:
            sys.exit(said[-4000:])


if __name__ == "__main__":
    main()
