# SPDX-License-Identifier: MIT
"""Tables of the how-tos, from small runs."""
import re

from reports.sources import Problem, recipe, spaced


def roof(f):
    """The mesh that the tutorial prints, as a file for runs."""
    text = (f.root / "docs/tutorial/first_run.md").read_text(encoding="utf-8")
    mesh = re.search(r"`(\w+\.obj)`:\n\n```\n(.*?)```", text, re.S)
    if not mesh:
        raise Problem("docs/tutorial/first_run.md prints no mesh")
    (f.scratch / mesh[1]).write_text(mesh[2], encoding="utf-8")
    return mesh[1]


@recipe("cache-hits")
def cache_hits(f):
    mesh = roof(f)
    runs = [f.run(f"texture --in {mesh} --texture brick --size 320x320 --set memory.latency=200 --set"
                  f" texture.cache.bytes={kib * 1024} --set texture.cache.ways=2") for kib in (1, 2, 32)]
    for key in ("texel_hits_percent", "lookup_hits_percent"):
        yield [f"`work.{key}`"] + [f"{run['work'][key]:.2f}" for run in runs]


@recipe("lanes-of-2160p")
def lanes(f):
    for count in (1, 2, 4):
        run = f.run("morphological --scene cylinders --size 3840x2160 --check none --set frame.reference_samples=0"
                    f" --lanes {count}")
        cycles = run["work"]["frame_cycles"]
        yield [str(count), spaced(cycles), f"{60 * cycles / 1e6:.1f}",
               spaced(run["memory_bits"]["total"]["physical"])]


@recipe("samples-at-most")
def samples_at_most(f):
    for most in (1, 2, 4, 8, 16):
        run = f.run(f"texture --scene tunnel --size 128x128 --aniso {most} --truth")
        yield [str(most), f"{run['quality']['psnr_db']:.2f}", f"{run['work']['bilinears_per_fragment']:.2f}",
               spaced(run["cycles"]), spaced(run["memory"]["bytes_read"])]


@recipe("preset-of-frames")
def preset_of_frames(f):
    for preset in ("mlaa", "mlaa-slope", "smaa", "smaa-dynamic", "deburr-line", "deburr"):
        runs = [f.run(f"morphological --scene {scene} --size 320x180 --preset {preset}")
                for scene in ("cylinders", "road")]
        yield [f"`{preset}`", spaced(runs[0]["memory_bits"]["total"]["physical"]), spaced(runs[0]["cycles"])] + [
            f"{run['quality']['psnr_edge_db']:.2f}; {run['change']['right_over_2_percent']:.2f}" for run in runs]


def front(f, engine, axes, quality, only=None):
    """A row per point of the front: values of the axes, quality, cycles, thousands of gates."""
    for point in f.front(f"{engine}_gates"):
        if all(point[axis] in values for axis, values in (only or {}).items()):
            yield [point[axis] for axis in axes] + [f"{point[quality]:.2f}", spaced(point["cycles"]),
                                                    spaced(round(point["gates"] / 1000))]


@recipe("gates-texture")
def gates_texture(f):
    return front(f, "texture", ("texture.axes", "texture.footprint", "texture.build"), "psnr",
                 {"texture.footprint": ["two_segment", "exact"], "texture.count": ["any"],
                  "texture.cache.bytes": ["4096"], "texture.cache.ways": ["2"]})


@recipe("gates-morphological")
def gates_morphological(f):
    return front(f, "morphological", [f"morphological.{name}" for name in ("preset", "lanes", "predictor_units")],
                 "psnr_edge", {"morphological.storage": ["line_buffers"]})


@recipe("gates-geometric")
def gates_geometric(f):
    return front(f, "geometric", [f"geometric.{name}" for name in ("edge_lanes", "resolve_lanes", "pipelined",
                                                                   "dividers")] + ["caches"], "psnr_edge")
