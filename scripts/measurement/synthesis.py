# SPDX-License-Identifier: MIT
"""The longest path of each unit by synthesis (docs/measurements/cost.json), in the stage that the datasheet has for it."""
import json
import re

from measurement.sources import Problem, recipe

# Unit and variant of the datasheets; module and parameters of the rows that are its; the stage of what a path ends in.
UNITS = (
    ("DerivativeUnit", "derivative_unit", {}, {r"[st]_[xy]|width|height": 1, r"p_.*": 2, "out_data": 3}),
    ("AxisUnit, `footprint = exact`", "axis_unit", {"footprint": "exact"},
     {r"[st]_[xy]\[\d\]|product_\d|with_it\[1\]": 1, r"area\[2\]|g_slot\[\d\]\.[st]": 2, r".*\.(ss|tt)": 3, r".*\.squares": 4,
      r"longest_5|which_5": 5, r"longest_6|direction_6": 6, r"m_.* to .*axis_[st]_at.*": 8, r"m_.*": 7,
      r".*(roots|rests)\[\d+\]|.*axis_[st]_at.*": "7-22",
      "out_data": "7-22"}),
    ("AxisUnit, other", "axis_unit", {"footprint": None},
     {r"[st]_[xy]\[\d\]|product_\d|with_it\[1\]": 1, r"area\[2\]|g_slot\[\d\]\.[st]": 2, r".*\.(low|high)_3": 3,
      r".*\.longer": 4, r"longest_5|which_5": 5, r"longest_6|direction_6": 6, r"m_.* to out_data": 8, r"m_.*": 7,
      "out_data": 8}),
    ("FootprintUnit, `footprint = exact`", "footprint_unit", {"footprint": "exact"},
     {r".*(ss|tt)_[xy]": 1, r".*sum_[xy]|.*radicand": 2, r".*(roots|rests)\[\d+\]": "3-18", "out_data": 19,
      r"d_[xy]|g_exact\.d_[xy]": 18}),
    ("FootprintUnit, other", "footprint_unit", {"footprint": None}, {r".*(low|high)_[xy]_1|d_[xy]": 1, "out_data": 2}),
    ("Log2Unit, `log2 = mitchell`", "log2_unit", {"log2": "mitchell"}, {"out_data": 1}),
    ("Log2Unit, other", "log2_unit", {"log2": None}, {r".*_1": 1, r".*_2|a memory": 2, "out_data": 3}),
    ("LevelUnit", "level_unit", {}, {r"e_1": 1, r"l_2|magnified_2|last_2": 2, "out_data": 3}),
    ("SampleWalker, other `count`", "sample_walker", {"count": None},
     {r"wide_[st]_1": 1, r"offset_[st]|stride_[st]": 2, "out_data": 3}),
    ("SampleWalker, `count = any`", "sample_walker", {"count": "any"},
     {r"wide_[st]_1|a memory": 1, r".*step_[st]_2": 2, r"offset_[st]|stride_[st]": 3, "out_data": 4}),
    ("TexelAddresser", "texel_addresser", {}, {r"bases_1": 1, r"width_2|height_2|[st]_2|base_2": 2, r"product_[st]": 3,
                                               r"[xy][01]_4|f_._4": 4, "out_data": 5}),
    ("TagStage", "tag_stage", {}, {r"(asked|at|set|same|drawn|valid)_\w+ to .*": 2, r"set_\d|same_\d+": 1,
                               r"miss_data|out_data|sets.*|valids|drawn|valid_2": 2}),
    ("MissQueue", "miss_queue", {}, {r".*": "-"}),
    ("FillBuffer", "fill_buffer", {}, {r"arrived|line_valid|can_reserve|a memory|held|read_place": 1, "line": 2}),
    ("LatencyFifo", "fifo", {}, {r".*": "-"}),
    ("DataStage", "data_stage", {}, {r"pass|fill|in_pop|use_line|a memory|valid_2": 1, r"out_data|.*\.kept": 2}),
    ("FilterPipeline", "filter_pipeline", {},
     {r".*\.low_\d\d": 3, r".*\.(upper|lower)_4": 4, r".*bilinear_5": 5, r".*levels_6": 6, r".*sum(\[\d\])?": 7,
      "out_data|rounded_8|a memory": 8}),
    ("Descriptors", "descriptors", {}, {r".*": "-"}),
)


def stage(unit, ends, start, to):
    """By the register in which a path ends, or by both ends: what is written may be read in the same clock."""
    for pattern, number in ends.items():
        if re.fullmatch(pattern, to or "") or re.fullmatch(pattern, f"{start} to {to}"):
            return str(number)
    raise Problem(f"{unit}: which stage ends in {to}? (scripts/measurement/synthesis.py)")


@recipe("longest-paths")
def longest_paths(f):
    cost = json.loads((f.root / "docs/measurements/cost.json").read_text(encoding="utf-8"))
    for title, module, wanted, ends in UNITS:
        rest = {other[name] for _, of, other, _ in UNITS if of == module for name in other if other[name]}
        rows = [unit for unit in cost["units"] if unit["unit"] == module and all(
            unit["parameters"][name] == value if value else unit["parameters"][name] not in rest
            for name, value in wanted.items())]
        if not rows:
            raise Problem(f"docs/measurements/cost.json has no row of {title}")
        mapped = [unit for unit in rows if isinstance(unit["osu018"], dict)]
        if not mapped:
            states = [unit["osu018"] for unit in rows]
            yield [title, "-", ", ".join(dict.fromkeys(sorted(states))), "-", "-", "-"]
            continue
        slowest = max(mapped, key=lambda unit: unit["osu018"]["ns"])
        row = slowest["osu018"]
        shown = " ".join(f"`{name}={value}`" for name, value in slowest["parameters"].items() if name not in wanted or
                         not wanted[name]) or "-"
        yield [title, shown + ("" if len(mapped) == len(rows) else f", of {len(mapped)} of {len(rows)} variants"),
               stage(title, ends, row["from"], row["to"]), f"`{row['from']}` to `{row['to']}`", f"{row['ns']:.2f}",
               f"{row['ratio']:.2f}"]
