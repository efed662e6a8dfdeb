# SPDX-License-Identifier: MIT
"""docs/measurements/cost.md, made from cost.json."""
import textwrap

from .flows import NOT_MAPPED, NOT_RUN

# Settings of configurations that a preset already builds; see the rows of that preset.
PRESETS = {"deburr": [], "paper": ["axes=two", "footprint=half", "log2=mitchell", "count=floor"]}

# The ratio above which the page names a unit.
LONG = 1.05

# Cells of the units: only in cost.json.
CELLS = ("link", "pipe", "rom", "sram_1r1w")


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
    return [unit for unit in cost["units"] if names.intersection(unit["configurations"]) and unit["unit"] not in CELLS]


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
    yield ("Made by `scripts/synthesise`; do not edit. This page shows the cost of the units of `hdl/`, mapped by yosys to "
           "three technologies, for the presets `paper` and `deburr`. `docs/measurements/cost.json` has all configurations "
           "of `tb/hdl/configurations.txt`, and the cells of which units are made.")
    yield "[How to read it](#how-to-read-it), [standard cells](#standard-cells), [FPGAs](#fpgas)."
    yield "## How to read it"
    yield (f"{cost['date']}, yosys {tools['yosys']}, berkeley-abc {tools['abc']}, qflow-tech-osu018 {tools['osu018']}. "
           "Nothing is placed or routed.")
    yield [
        "**osu018**: standard cells of 180 nm, typical corner, 1.8 V, 25 degrees (`abc -liberty`, `stime`, without "
        "wires). Adders are parallel prefix adders: the script of abc omits `dc2`, which makes ripple adders of them. "
        f"A gate is a NAND2X1, {number(cost['gate']['area'])} of the library's units of area. *ns* is the longest "
        "path through logic, from a register or an input to a register or an output, without clock-to-output, setup and "
        "memory access. *Ends in* is the register or port at the end of that path.",
        f"**ratio**: ns divided by those of a {yard['what']} mapped in the same way, {number(yard['ns'], 2)} ns (osu018). "
        "For another process the ratio says more than the ns.",
        "**xc7** (`synth_xilinx`): LUTs of six inputs, flip-flops, DSP48E1, block RAMs of 36 kbit. **ECP5** "
        "(`synth_ecp5 -abc9 -nowidelut`): LUTs of four inputs, flip-flops, MULT18X18D, block RAMs of 18 kbit. Small "
        "memories are LUTs. No FPGA timing is given: yosys does not report reliable delays.",
        "**Memories** (`sram_1r1w`, `fifo`, `rom`) are not mapped to flip-flops. For osu018 the column *memory* has their "
        "bits, including FIFOs that the hardware builds of flip-flops; gates and flip-flops exclude them. The tags, the "
        "queue of lines and the descriptors are flip-flops.",
        f"**{NOT_MAPPED}**: yosys and abc did not finish in {number(cost['seconds'])} s of processor time."
        + (f" **{NOT_RUN}**: `scripts/synthesise` maps it." if any(
            unit[technology] == NOT_RUN for unit in units for technology in ("osu018", "xc7", "ecp5")) else ""),
        "**`address_unit`, `texture_cache`** are the sum of their units and links, without a few gates between them. Paths "
        "end at links, so their ns are those of the longest part.",
    ]
    yield ("A row is a clocked module with the parameters on which it depends. Unclocked modules count in the unit that "
           "contains them. `in_data` is listed if other settings make a token wider.")
    yield "Not covered: units outside `hdl/`, the memory port, wires, clock trees, energy."
    yield "## Standard cells"
    yield "Technology: osu018, 180 nm."
    yield table(["unit", "parameters", "gates", "flip-flops", "memory, bits", "ns (osu018)", "ratio", "ends in"],
                gates(units))
    longest = {}
    for unit in cost["units"]:
        row = unit["osu018"]
        if isinstance(row, dict) and not unit["parts"] and (row["ratio"] or 0) > LONG:
            longest[unit["unit"]] = max(longest.get(unit["unit"], (0, "")), (row["ratio"], row["to"] or "-"))
    if longest:
        yield f"Paths above {LONG} of the multiply, in any configuration: " + ", ".join(
            f"`{name}` {number(ratio, 2)} (to `{to}`)" for name, (ratio, to) in longest.items()) + "."
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
