# SPDX-License-Identifier: MIT
"""Tables of docs/measurements/morphological_peers.md that `deburr papers 003` prints as well."""
from measurement.sources import recipe, spaced


@recipe("smaa-lines", long=True)
def smaa_lines(f):
    for row in f.paper_table("003", "Quality matrix: lines and discs"):
        yield list(row.values())[:-1]


@recipe("smaa-costs", long=True)
def smaa_costs(f):
    for row in f.paper_table("003", "Quality matrix: cost"):
        bits = [spaced(int(row[c])) for c in ("clocks", "ROM, bits", "flip-flops and SRAM, bits")]
        yield [row["rules"], *bits, row["20 %"], row["37 %"]]
