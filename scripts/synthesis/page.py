# SPDX-License-Identifier: MIT
"""docs/measurements/cost.md, which says what cost.json does."""
import textwrap

from .flows import NOT_MAPPED, NOT_RUN

# Settings of configurations that a preset builds, as they stand there. Their rows are there.
PRESETS = {"deburr": [], "paper": ["axes=two", "footprint=half", "log2=mitchell", "count=floor"]}


def number(value, digits=0):
    """With spaces between thousands."""
    return "-" if value is None else f"{value:,.{digits}f}".replace(",", " ")


def table(head, rows, texts=2):
    """`texts` columns of text, then figures."""
    yield "| " + " | ".join(head) + " |"
    yield "|" + "|".join("---" if i < texts else "--:" for i in range(len(head))) + "|"
    for row in rows:
        yield "| " + " | ".join(row) + " |"


def shown(unit):
    return " ".join(f"`{name}={value}`" for name, value in unit["parameters"].items()) or "-"


def units_of_presets(cost):
    names = {one["name"] for one in cost["configurations"] if one["settings"] in PRESETS.values()}
    return [unit for unit in cost["units"] if names.intersection(unit["configurations"])]


def gates(units):
    for unit in units:
        row = unit["osu018"]
        start = [f"`{unit['unit']}`", shown(unit)]
        if isinstance(row, str):
            yield start + [row] + ["-"] * 5
            continue
        to = row["to"] or "-"
        yield start + [number(row["gates"]), number(row["flip_flops"]), number(row["memory_bits"] or None),
                       number(row["ns"], 2), number(row["ratio"], 2), to if to == "-" or to == "a memory" else f"`{to}`"]


def fpga(units):
    for unit in units:
        cells = []
        for technology in ("xc7", "ecp5"):
            row = unit[technology]
            if isinstance(row, str):
                cells += [row] + ["-"] * 3
            else:
                blocks = row["block_rams"]
                cells += [number(row["luts"]), number(row["flip_flops"]), number(row["multipliers"] or None),
                          number(blocks or None, 0 if blocks == int(blocks) else 1)]
        yield [f"`{unit['unit']}`", shown(unit)] + cells


def paragraphs(cost):
    tools, yard, units = cost["tools"], cost["yardstick"], units_of_presets(cost)
    yield ("Made by `scripts/synthesise`; do not edit. What the units of `hdl/` cost, mapped by yosys to three "
           "technologies. Rows are those of the presets `paper` and `deburr`; those of all configurations that are compared "
           "with the model (`tb/hdl/configurations.txt`) are in `docs/measurements/cost.json`.")
    yield "[How to read it](#how-to-read-it), [standard cells](#standard-cells), [FPGAs](#fpgas)."
    yield "## How to read it"
    yield (f"{cost['date']}, yosys {tools['yosys']}, berkeley-abc {tools['abc']}, qflow-tech-osu018 {tools['osu018']}. "
           "Nothing is placed or routed.")
    yield [
        "**osu018**: standard cells of 180 nm, typical corner, 1.8 V, 25 degrees (`abc -liberty`, `stime`, without "
        f"wires). A gate is a NAND2X1, {number(cost['gate']['area'])} of the library's units of area. *ns* is the longest "
        "path through logic, from a register or an input to a register or an output. Clock-to-output, setup and the "
        "access of a memory are not in it. *Ends in* is the register or port at the end of that path.",
        f"**ratio**: ns by those of a {yard['what']} that is mapped in the same way, {number(yard['ns'], 2)} ns (osu018). "
        "It says more of another process than ns do.",
        "**xc7** (`synth_xilinx`): look-up tables of six inputs, flip-flops, DSP48E1, block RAMs of 36 kbit. **ECP5** "
        "(`synth_ecp5 -abc9 -nowidelut`): look-up tables of four inputs, flip-flops, MULT18X18D, block RAMs of 18 kbit. "
        "Small memories are look-up tables. There are no ns of an FPGA: yosys has none that hold.",
        "**Memories** (`sram_1r1w`, `fifo`, `rom`) are not mapped to flip-flops. For osu018 they are left out of gates "
        "and flip-flops, and *memory* is their bits, with those of FIFOs that the hardware builds of flip-flops. The "
        "tags, the queue of lines and the descriptors are flip-flops.",
        f"**{NOT_MAPPED}**: yosys and abc did not end in {number(cost['seconds'])} s of processor time. There is no guess."
        + (f" **{NOT_RUN}**: `scripts/synthesise` maps it." if any(
            unit[technology] == NOT_RUN for unit in units for technology in ("osu018", "xc7", "ecp5")) else ""),
        "**`address_unit`, `texture_cache`** are the sum of their units and links: no path goes through a link, so their "
        "ns are those of the longest part. A few gates between the parts are not in it.",
    ]
    yield ("A row is a module with a clock and the parameters on which it depends, as some configuration builds it. "
           "Modules without one are in the unit that has them. `in_data` stands where other settings make a token wider.")
    yield "Not covered: units that are not in `hdl/`, the memory port, wires, clock trees, energy."
    yield "## Standard cells"
    yield "Technology: osu018, 180 nm."
    yield table(["unit", "parameters", "gates", "flip-flops", "memory, bits", "ns (osu018)", "ratio", "ends in"],
                gates(units))
    yield "## FPGAs"
    yield "Technologies: xc7 (Xilinx 7), ECP5 (Lattice)."
    yield table(["unit", "parameters", "xc7 LUT", "FF", "DSP", "BRAM", "ECP5 LUT", "FF", "DSP", "BRAM"], fpga(units))


def page(cost):
    lines = ["# Cost of the units"]
    for part in paragraphs(cost):
        lines.append("")
        if isinstance(part, str):
            lines += [part] if part.startswith("#") else textwrap.wrap(part, 120, break_long_words=False,
                                                                       break_on_hyphens=False)
        elif isinstance(part, list):
            for item in part:
                lines += textwrap.wrap("* " + item, 120, subsequent_indent="  ", break_long_words=False,
                                       break_on_hyphens=False)
        else:
            lines += part
    return "\n".join(lines) + "\n"
