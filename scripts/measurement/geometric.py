# SPDX-License-Identifier: MIT
"""Tables of docs/geometric_quality.md: RMSE in codes, on edge pixels / on silhouettes."""
import math
import re

from measurement.sources import absent, best, recipe, spaced

QUALITY = "tb/oracle/geometric_quality_test"
JOINED = "tb/oracle/geometric_morphological_test"
SCENES = ("cube", "sphere", "wheelcover", "wing", "canopy", "cylinders", "object", "track", "road",
          "terrain")
TEXTURED = {"object", "track", "road", "terrain"}
METHODS = ("none", "msaa4", "morphological", "gpaa", "gpaa-optimised", "deburr")
# What was asked for: RMSE of the aliased frame and what is left, and edges that are kept.
GOALS = {"cube": (19.7, 1.45), "sphere": (20.0, 2.44), "wheelcover": (15.1, 2.9),
         "track": (18.0, 7.1), "object": (18.7, 6.5)}
KEPT = {"cube": 9, "sphere": 224, "wing": 315, "wheelcover": 213}


def cells(line):
    return [cell.strip() for cell in line.strip().strip("|").split("|")]


def tables(f, tests):
    """What geometric_quality_test prints of scenes: figures by (scene, method), and their line of
    edges and columns."""
    figures, edges = {}, {}
    for line in f.test(QUALITY, tests).splitlines():
        row = cells(line) if line.startswith("| ") else []
        if len(row) == 6:
            figures[scene_of(row[0]), row[1]] = row[2:]
        elif len(row) == 4 and row[1].startswith("edges"):
            edges[scene_of(row[0])] = [int(n) for n in re.findall(r"\d+", " ".join(row[1:3]))]
    return figures, edges


def scene_of(name):
    return "track" if "track" in name else name


@recipe("geometric-scenes", long=True)
def scenes(f):
    figures, _ = tables(f, "*Goals*:*Others*")
    for scene in SCENES:
        name = scene + (" (textured)" if scene in TEXTURED else "")
        if (scene, "none") not in figures:
            yield absent(name)
            continue
        yield [name] + best(["{} / {}".format(*figures[scene, method]) for method in METHODS], min)


@recipe("geometric-silhouettes", long=True)
def silhouettes(f):
    figures, _ = tables(f, "*Goals*:*Others*")
    for scene in SCENES:
        if (scene, "none") not in figures:
            yield absent(scene)
            continue
        ours, msaa = (float(figures[scene, method][3]) for method in ("deburr", "msaa4"))
        yield [scene, f"{msaa:.2f}", f"{ours:.2f}", f"{ours - msaa:+.2f}"]


@recipe("geometric-goals", long=True)
def goals(f):
    figures, _ = tables(f, "*Goals*:*Others*")
    for scene, (aliased, left) in GOALS.items():
        if (scene, "none") not in figures:
            yield absent(scene)
            continue
        none, ours = (float(figures[scene, method][0]) for method in ("none", "deburr"))
        yield [scene, f"{aliased}, {left}", f"{left / aliased:.3f}", f"{none:.2f}, {ours:.2f}",
               f"{ours / none:.3f}"]


@recipe("geometric-edges", long=True)
def edges_processed(f):
    _, edges = tables(f, "*Goals*:*Others*")
    for scene in ("cube", "sphere", "wing", "wheelcover", "canopy", "object", "track"):
        if scene not in edges:
            yield absent(scene)
            continue
        every, optimised, ours, *columns = edges[scene]
        yield [scene, spaced(every), str(KEPT.get(scene, "-")), spaced(optimised), spaced(ours),
               ", ".join(spaced(n) for n in columns)]


@recipe("geometric-rules")
def rules(f):
    for line in f.test(QUALITY, "Rules.*").splitlines():
        if line.startswith("| "):
            scene, change, before, after = cells(line)
            yield [scene, f"`{change.split()[0]}` {change.split()[1]}", before, after]


@recipe("geometric-slopes", long=True)
def slopes(f):
    table = f.paper_table("002", "Equations 7 and 8")
    for column, name in (
            ("none", "none"),
            ("equation", "the equation: distance along the axis, one pixel a column"),
            ("across, one a column", "distance across the line, one pixel a column"),
            ("across the line", "distance across the line, every pixel nearer than a half")):
        yield [name] + [row[column] for row in table]


@recipe("geometric-bars")
def bars(f):
    for line in f.test(QUALITY, "WeakSpot.*").splitlines():
        if line.startswith("| "):
            yield cells(line)


def two(figure):
    """edges / silhouettes with two digits."""
    return " / ".join(f"{float(n):.2f}" for n in figure)


@recipe("geometric-outermost", long=True)
def outermost(f):
    for line in f.test(JOINED, "Outermost.*").splitlines():
        if line.startswith("| "):
            name, *figures = cells(line)
            scene, degrees = name.split()
            if degrees == "0" or scene == "terrain":
                turned = "" if degrees == "0" else f", turned by {degrees}"
                yield [scene + turned] + [two(figure.split(" / ")) for figure in figures]


WAYS = {"msaa4": "MSAA 4x", "geometric": "geometric alone", "twice": "nothing left",
        "marked": "`marked`", "beside": "`beside`", "half": "`half`",
        "depth, half": "`half`, depth", "morphological": "morphological alone",
        "depth, marked": "`marked`, depth", "depth, beside": "`beside`, depth",
        "two channels": "blended by the channels alone, one neighbour a pixel",
        "channels as edges": "channels as the morphological engine's edges",
        "luma edges at channels": "luma's edges where there is a channel"}


def joined(f):
    """RMSE by (view, way): the views are "cube 0", "cube 25", .., "track 0", ..."""
    figures = {}
    for line in f.test(JOINED, "*Joined*").splitlines():
        row = cells(line) if line.startswith("| ") else []
        if len(row) == 3:
            figures[row[0], row[1]] = [float(n) for n in row[2].split(" / ")]
    return figures


@recipe("geometric-joined", long=True)
def joined_scenes(f):
    figures = joined(f)
    for scene in SCENES:
        if (f"{scene} 0", "none") not in figures:
            yield absent(scene)
            continue
        yield [scene] + best([two(figures[f"{scene} 0", way]) for way in
                              ("msaa4", "geometric", "twice", "marked", "beside", "half",
                               "depth, half")], min)


def gains(f, ways):
    """Over the geometric engine alone, in dB: mean and worst, on edges and on silhouettes, of the
    scenes from their own cameras and from the others."""
    figures = joined(f)
    views = {view for view, _ in figures}
    if not any(view.startswith("track") for view in views):
        yield from (absent(WAYS[way]) for way in ways)
        return
    own = sorted(view for view in views if view.endswith(" 0"))
    others = sorted(views - set(own))
    for way in ways:
        row = [WAYS[way]]
        for which in (0, 1):
            for part in (own, others):
                each = [20 * math.log10(figures[view, "geometric"][which] / figures[view, way][which])
                        for view in part]
                row.append(f"{sum(each) / len(each):+.2f}, {min(each):+.2f}")
        yield row


@recipe("geometric-joined-gains", long=True)
def joined_gains(f):
    yield from gains(f, ("msaa4", "morphological", "twice", "marked", "beside", "half",
                         "depth, marked", "depth, beside", "depth, half"))


@recipe("geometric-channels-gains", long=True)
def channels_gains(f):
    yield from gains(f, ("two channels", "channels as edges", "luma edges at channels"))
