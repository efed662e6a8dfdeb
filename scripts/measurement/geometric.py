# SPDX-License-Identifier: MIT
"""Tables of docs/reference/geometric/."""
import json

from measurement.sources import recipe, spaced

BENCHES = "tb/bench"


@recipe("geometric-dividers", long=True)
def dividers(f):
    """The frame of 33 000 edges, far from a memory and near one."""
    for setup, *figures in json.loads(f.program(f"{BENCHES}/geometric_rtl_bench", "--dividers")):
        yield [setup, *map(spaced, figures)]
