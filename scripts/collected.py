# SPDX-License-Identifier: MIT
"""Reads the collected.json of a sweep or of a search."""
import json
import math

SCHEMA = 2


def read(path):
    """As the file says, with infinity where a picture is identical: there the file has null, and the
    point's list `identical` names the metric. ValueError for a file of another layout."""
    sweep = json.loads(path.read_text(encoding="utf-8"))
    if not isinstance(sweep, dict) or sweep.get("schema") != SCHEMA:
        raise ValueError(f"not of schema {SCHEMA}: collect the sweep again")
    names = [metric["name"] for metric in sweep["metrics"]]
    for point in sweep["points"]:
        for name in point.get("identical", []):
            point["values"][names.index(name)] = math.inf
    return sweep
