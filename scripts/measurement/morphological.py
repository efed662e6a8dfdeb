# SPDX-License-Identifier: MIT
"""Tables of docs/morphological_quality.md, and those of docs/results.md on the same figures."""
import re
import statistics

from measurement.sources import absent, best, pair, recipe, spaced

FRAMES = "tb/oracle/morphological_frames_test"
QUALITY = "tb/oracle/morphological_quality_test"
METHODS = ("MSAA 4x", "none", "mlaa-slope", "mlaa", "deburr-line", "deburr", "smaa low",
           "smaa medium", "smaa high", "smaa ultra", "smaa-dynamic 0.05", "smaa-dynamic 0.10",
           "smaa-dynamic 0.20", "fxaa", "cmaa2", "+ diagonals", "+ corners", "+ crossings",
           "+ strongest", "+ diag + strong", "+ all four")
LINE = re.compile(r"(\S.*?) +(" + "|".join(re.escape(m) for m in METHODS) +
                  r") +edges (\S+) dB, silhouettes (\S+) dB")
RUN = re.compile(r"\[ RUN +\] (\S+?)(?:/OnEdgesAndSilhouettes|[.]\w+)?(?:/(\S+?))?(?:,.*)?$")


def frames(f):
    """PSNR by frame, then by method: (edges, silhouettes). Frames are named by the test that judges
    them, "Scenes/cylinders_512", and those of `track` from four other sides by a number."""
    figures, test, seen = {}, None, {}
    for line in f.test(FRAMES).splitlines():
        run = re.match(r"\[ RUN +\] (\S+)", line)
        if run:
            test = run[1]
            continue
        found = LINE.fullmatch(line)
        if not found or "AWorseFilter" in test or "OutOfSample" in test:
            continue
        name, method = found[1], found[2]
        suite, _, case = test.rpartition("/")
        if case.startswith("MorphologicalFrames.") or not suite:
            key = name
            if "OtherSides" in test:
                # The first figure of a view is deburr's.
                seen[name] = seen.get(name, 0) + (method == "deburr")
                key = f"{name} from side {seen[name]}"
        else:
            key = f"{suite.split('/')[0]}/{case}"
        figures.setdefault(key, {})[method] = (float(found[3]), float(found[4]))
    return figures


def group(figures, *prefixes):
    return [figures[key] for key in figures if key.startswith(prefixes)]


def mean(frames_of, method):
    """Of edges and of silhouettes, as a pair; frames without silhouettes count for edges alone."""
    edges = [frame[method][0] for frame in frames_of]
    outlines = [frame[method][1] for frame in frames_of if frame[method][1] == frame[method][1]]
    return f"{statistics.fmean(edges):.2f} / {statistics.fmean(outlines):.2f}"


def shown(figure):
    return pair(f"{figure[0]:.2f}", "-" if figure[1] != figure[1] else f"{figure[1]:.2f}")


def all_29(figures):
    return group(figures, "Scenes/", "Meshes/", "track from side")


# ---- docs/results.md ----------------------------------------------------------------------------

FIVE = ("none", "mlaa", "mlaa-slope", "deburr-line", "deburr")


@recipe("frames-by-preset", long=True)
def frames_by_preset(f):
    figures = frames(f)
    for name, key in (("track 720p", "track 720p"), ("track 1080p", "track 1080p")):
        yield ([name] + best([shown(figures[key][m]) for m in FIVE]) if key in figures
               else absent(name))
    views = all_29(figures)
    yield (["29 frames, mean"] + best([mean(views, m) for m in FIVE]) if len(views) == 29
           else absent("29 frames, mean"))
    for scene in ("cylinders", "object", "road", "quad"):
        yield ([("of them " if scene == "cylinders" else "") + scene] +
               best([shown(figures[f"Scenes/{scene}_512"][m]) for m in FIVE]))
    for scene, name in (("tunnel", "tunnel (not among the 29)"), ("plane", "plane (not among the 29)")):
        yield [name] + best([shown(figures[f"Texture/{scene}_512"][m]) for m in FIVE])
    held = group(figures, "HeldOut/")
    yield (["17 held-out frames, mean"] + best([mean(held, m) for m in FIVE]) if len(held) == 17
           else absent("17 held-out frames, mean"))


# ---- lines and discs ----------------------------------------------------------------------------


def fan(f, interval):
    """Rows of paper 000's table of lines by their names, u in an interval."""
    rows = f.paper_table("000", "RMSE × 1000 to analytic coverage, slopes 1/(n + u), u in " + interval)
    return {row["line"]: row for row in rows}


FANS = (("none", "none"), ("mlaa", "mlaa"), ("chord N = 1", "chord N = 1"),
        ("chord N = 2", "chord N = 2"), ("chord N = 4 = `mlaa-slope`", "chord N = 4"),
        ("chord N = 8", "chord N = 8"), ("fit N = 2", "fit N = 2"), ("fit N = 4", "fit N = 4"),
        ("fit N = 8 = `deburr-line`", "deburr-line"), ("the same lines by `deburr`", "deburr"),
        ("fit N = 16", "fit N = 16"))


@recipe("lines", long=True)
def lines(f):
    rows = fan(f, "[0.05, 0.95]")
    for name, key in FANS:
        yield [name] + list(rows[key].values())[1:9]
    asked = next(row for name, row in rows.items() if name.startswith("(") and "fit" in name)
    yield ["asked of the fit"] + list(asked.values())[1:9]
    rows = fan(f, "[0, 1]")
    for name, key in (("u in [0, 1]: mlaa", "mlaa"), ("chord N = 4", "chord N = 4"),
                      ("fit N = 4", "fit N = 4"), ("`deburr-line`", "deburr-line"),
                      ("`deburr`", "deburr"), ("fit N = 16", "fit N = 16")):
        yield [name] + list(rows[key].values())[1:9]


@recipe("discs")
def discs(f):
    printed = {}
    for line in f.test(QUALITY, "*.CurvesLoseNothingByTheFit").splitlines():
        found = re.fullmatch(r"(\S.*?)((?: +[\d.]+){7})", line)
        if found:
            printed[found[1].strip()] = [f"{float(n):.0f}" for n in found[2].split()]
    for name, key in (("mlaa", "mlaa"), ("`mlaa-slope`", "mlaa-slope"),
                      ("fit N = 8, safe, not trimmed", "+ N = 8"),
                      ("`deburr-line`", "+ T = 0.03 = deburr-line"),
                      ("`deburr`", "+ learned shares = deburr")):
        yield [name] + printed[key]


# ---- frames made by formula ---------------------------------------------------------------------


@recipe("frames-by-formula", long=True)
def frames_by_formula(f):
    figures = frames(f)
    for scene in ("cylinders", "object", "road", "quad", "tunnel", "plane"):
        key = ("Texture/" if scene in ("tunnel", "plane") else "Scenes/") + f"{scene}_512"
        yield [scene] + best([shown(figures[key][m]) for m in
                              ("none", "mlaa", "deburr-line", "MSAA 4x", "deburr")]) + ["in sample"]


# ---- SMAA and peers -----------------------------------------------------------------------------

MATRIX = ("none", "mlaa", "mlaa-slope", "smaa low", "smaa medium", "smaa high",
          "smaa-dynamic 0.05", "smaa-dynamic 0.1", "smaa-dynamic 0.2", "smaa ultra", "fxaa",
          "cmaa2", "deburr-line", "deburr", "deburr-line + diagonals", "deburr-line + corners",
          "deburr-line + strongest")


@recipe("smaa-lines", long=True)
def smaa_lines(f):
    rows = {row["rules"]: row for row in f.paper_table("003", "Quality matrix: lines and discs")}
    for name in MATRIX:
        yield [name] + list(rows[name].values())[1:-1]


@recipe("smaa-frames", long=True)
def smaa_frames(f):
    figures = frames(f)
    names = {"smaa-dynamic 0.1": "smaa-dynamic 0.10", "smaa-dynamic 0.2": "smaa-dynamic 0.20"}
    rows = ("none", "MSAA 4x", "mlaa", "mlaa-slope", "smaa low", "smaa medium", "smaa high",
            "smaa ultra", "smaa-dynamic 0.05", "smaa-dynamic 0.1", "smaa-dynamic 0.2", "fxaa",
            "cmaa2", "deburr-line", "deburr", "deburr-line + diagonals", "deburr-line + corners",
            "deburr-line + crossings", "deburr-line + strongest", "deburr-line + all four")
    if f.data is None:
        yield from (absent(name) for name in rows)
        return
    held, views = group(figures, "HeldOut/"), all_29(figures)
    rendered = group(figures, "Scenes/", "Meshes/")  # MSAA of `track` would need its mesh
    for name in rows:
        method = names.get(name, name).replace("deburr-line +", "+")
        if method == "MSAA 4x":
            yield [name, "", "", mean(rendered, method), mean(held, method)]
            continue
        yield [name, shown(figures["track 720p"][method]), shown(figures["track 1080p"][method]),
               mean(views, method), mean(held, method)]


@recipe("smaa-costs", long=True)
def smaa_costs(f):
    for row in f.paper_table("003", "Quality matrix: cost"):
        yield [row["rules"]] + [spaced(int(row[c])) for c in
                                ("clocks", "ROM, bits", "flip-flops and SRAM, bits")] + [
                                    row["20 %"], row["37 %"]]


@recipe("peers", long=True)
def peers(f):
    """Frames on which FXAA or CMAA2 is ahead of deburr-line by more than 0.2 dB."""
    figures = frames(f)
    for key, frame in figures.items():
        if "fxaa" not in frame:
            continue
        line = frame["deburr-line"]
        gains = {peer: [frame[peer][i] - line[i] for i in (0, 1)] for peer in ("fxaa", "cmaa2")}
        if max(g for both in gains.values() for g in both if g == g) <= 0.2:
            continue
        yield [f"`{key.split('/')[-1]}`"] + [
            " / ".join("-" if g != g else f"{g:+.2f}" for g in gains[peer])
            for peer in ("fxaa", "cmaa2")]
