# SPDX-License-Identifier: MIT
"""For scripts and tests: the engines of engines.txt, the entries of their trials.yaml (arguments with which tests of
all engines run each engine), and testplans with the parts of the engines included."""
import pathlib

FOLDER = pathlib.Path(__file__).resolve().parent


def loaded(path):
    import yaml  # imported here, as callers that need only the names do not need it
    with open(path, encoding="utf-8") as file:  # the C loader, if available: ten times as fast
        return yaml.load(file, Loader=getattr(yaml, "CSafeLoader", yaml.SafeLoader))


def engines():
    """The names of the engines, in order."""
    lines = (FOLDER / "engines.txt").read_text(encoding="utf-8").splitlines()
    return [line for line in lines if line and not line.startswith("#")]


def trials(name):
    """{engine: its entry `name` of trials.yaml}. The file and each entry are optional."""
    found = {}
    for engine in engines():
        file = FOLDER / engine / "trials.yaml"
        entries = loaded(file) if file.exists() else {}
        if name in entries:
            found[engine] = entries[name]
    return found


def testplan(path):
    """A testplan with its `include` entries resolved: included features first, then its own
    (docs/reference/regression.md)."""
    plan = loaded(path)
    own, included = plan.get("features", []), []
    for pattern in plan.pop("include", []):
        files = [path.parent / pattern.replace("*", name) for name in engines()] if "*" in pattern else [path.parent / pattern]
        parts = [loaded(file) for file in files]
        for key in ("coverage", "unmet"):  # merged over the whole plan
            if more := [entry for part in parts for entry in part.get(key, [])]:
                plan[key] = plan.get(key, []) + more
        for feature in (f for part in parts for f in part["features"]):
            known = next((f for f in own + included if f["id"] == feature["id"]), None)
            if known is None:
                included.append(feature)
                continue
            for key in ("traces", "stimuli", "coverage"):
                if key in feature:
                    known[key] = known.get(key, []) + feature[key]
            if "checks" in feature:
                known["checks"] = {**known.get("checks", {}), **feature["checks"]}
    plan["features"] = included + own
    return plan
