# SPDX-License-Identifier: MIT
"""Tables of docs/measurements/ and docs/reference/ that come from runs, paper figures and a benchmark."""
import json

from reports.sources import recipe, spaced

SCENES = ("plane", "quad", "tunnel")
# Estimates in real arithmetic: bilinears, texels, misses.
ESTIMATES = {"plane": ("7.8", "9.0", "1.81"), "quad": ("2.1", "3.7", "2.76"),
             "tunnel": ("5.0", "10.5", "3.28")}


@recipe("texture-rates")
def texture_rates(f):
    for scene in SCENES:
        near, far = (f.run(f"texture --scene {scene} --preset paper --set memory.latency={latency}")
                     for latency in (1, 100))
        work, estimate = far["work"], ESTIMATES[scene]
        yield [scene, f"{work['bilinears_per_fragment']:.2f} ({estimate[0]})",
               f"{work['texels_fetched_per_fragment']:.2f} ({estimate[1]})",
               f"{100 * work['misses_per_texel']:.2f} % ({estimate[2]})",
               spaced(near["cycles"]), spaced(far["cycles"])]


@recipe("texture-presets")
def texture_presets(f):
    for scene, name in (("plane", "plane"),
                        ("plane --roll 45", "plane, camera rolled by 45 degrees (`--roll 45`)"),
                        ("quad", "quad"), ("tunnel", "tunnel")):
        paper, ours = (f.run(f"texture --scene {scene} --preset {preset} --truth")
                       for preset in ("paper", "deburr"))
        yield [name] + [" / ".join(shown(run) for run in (paper, ours)) for shown in (
            lambda r: f"{r['work']['bilinears_per_fragment']:.2f}",
            lambda r: spaced(r["cycles"]), lambda r: f"{r['quality']['psnr_db']:.1f}")]


@recipe("texture-fifo")
def texture_fifo(f):
    for scene in SCENES:
        yield [scene] + [
            "{:.3f}".format(f.run(f"texture --scene {scene} --preset paper --set "
                                  f"texture.cache.fifo_depth={depth}")["throughput"]["value"])
            for depth in (2, 8, 16, 32, 64, 96, 128, 160, 256, 512)]


@recipe("frames-1080p")
def frames_1080p(f):
    for line in ("texture --scene plane --preset paper", "texture --scene plane --preset deburr",
                 "morphological --scene tunnel --preset deburr-line",
                 "morphological --scene tunnel --preset deburr",
                 "morphological --scene tunnel --preset smaa",
                 "geometric --scene object --preset gpaa-optimised",
                 "geometric --scene object --preset deburr"):
        result = f.run(line + " --size 1920x1080")
        bits = result["memory_bits"]["total"]
        blended = next((spaced(value) for name, value in result["work"].items()
                        if name.endswith("_blended_pixels")), "-")
        yield [f"`{line}`", blended, spaced(result["cycles"]), spaced(result["latency"]["p50"]),
               spaced(bits["logical"]), spaced(bits["physical"])]


@recipe("geometric-dividers")
def dividers(f):
    """The frame of 33 000 edges, with a fast and a slow memory."""
    for setup, *figures in json.loads(f.program("bench/geometric_rtl_bench", "--dividers")):
        yield [setup, *map(spaced, figures)]


@recipe("smaa-lines")
def smaa_lines(f):
    for row in f.paper_table("003", "Quality matrix: lines and discs"):
        cells = list(row.values())[:-1]
        if not cells[0].startswith(("deburr-line +", "smaa-dynamic", "smaa low", "smaa medium")):
            yield cells
