# SPDX-License-Identifier: MIT
# Made by tb/system/python_stubs_test.py --write; do not edit.
import typing

import numpy
import numpy.typing

from deburr._figures import Figures

_Array = numpy.typing.NDArray[typing.Any]

EDGE: numpy.dtype[numpy.void]
EDGE_CLASSES: tuple[str, ...]
VERTEX: numpy.dtype[numpy.void]

class GeometricFrame:
    @property
    def blocks(self) -> _Array: ...
    @property
    def candidates(self) -> _Array: ...
    @property
    def classes(self) -> _Array: ...
    @property
    def coverage(self) -> dict[str, int]: ...
    @property
    def detail(self) -> bool: ...
    @property
    def lines(self) -> _Array: ...
    @property
    def memory_errors(self) -> int: ...
    @property
    def pixels(self) -> _Array: ...
    @property
    def traffic(self) -> dict[str, dict[str, _Array]]: ...
    @property
    def weights(self) -> _Array: ...
    @property
    def work(self) -> Figures: ...

def geometric(
    pixels: _Array,
    depth: _Array | None = ...,
    *,
    vertices: _Array,
    edges: _Array,
    facing: _Array,
    bases: dict[str, int] | None = ...,
    detail: bool = ...,
    error_lines: _Array | None = ...,
    preset: typing.Literal['gpaa', 'gpaa-optimised', 'deburr'] = ...,
    select: typing.Literal['all', 'edges', 'mesh'] = ...,
    crease: typing.Literal['off', 'paper', 'shading'] = ...,
    cull: typing.Literal['none', 'back'] = ...,
    coverage: typing.Literal['distance', 'area'] = ...,
    depth_test: typing.Literal['off', 'own', 'farther'] = ...,
    depth_bias: int = ...,
    crease_depth: int = ...,
    combine: typing.Literal['max', 'last', 'outermost'] = ...,
    linear_light: bool = ...,
    mark: bool = ...,
    layout: typing.Literal['raster', 'tiled'] = ...,
    frame_copy: bool = ...,
    line_pixels: int = ...,
    touched_words: int = ...,
    face_limit: int = ...,
    edge_lanes: int = ...,
    edge_lines: int = ...,
    vertex_lines: int = ...,
    dividers: int = ...,
    pipelined: bool = ...,
    reciprocal_table: int = ...,
    line_fifo: int = ...,
    walkers: int = ...,
    depth_lines: int = ...,
    weight_blocks: int = ...,
    fills: int = ...,
    latency_fifo: int = ...,
    resolve_lanes: int = ...,
    resolve_lines: int = ...,
    copy_lines: int = ...,
    records: typing.Literal['joined', 'split'] = ...,
    colour_lines: int = ...,
    write_buffer: int = ...,
    coarse_lines: typing.Literal['none', '4', '8', '16', '32', '64'] = ...,
    memory_outstanding: int = ...,
) -> GeometricFrame: ...

class MorphologicalFrame:
    @property
    def coverage(self) -> dict[str, int]: ...
    @property
    def decisions(self) -> _Array: ...
    @property
    def detail(self) -> bool: ...
    @property
    def edges(self) -> _Array: ...
    @property
    def memory_errors(self) -> int: ...
    @property
    def pixels(self) -> _Array: ...
    @property
    def runs(self) -> _Array: ...
    @property
    def shares(self) -> _Array: ...
    @property
    def taps(self) -> _Array: ...
    @property
    def traffic(self) -> _Array: ...
    @property
    def work(self) -> Figures: ...

def morphological(
    pixels: _Array,
    depth: _Array | None = ...,
    *,
    edges: _Array | None = ...,
    detail: bool = ...,
    error_lines: _Array | None = ...,
    preset: typing.Literal['mlaa', 'mlaa-slope', 'smaa', 'smaa-dynamic', 'deburr-line', 'deburr'] = ...,
    quality: typing.Literal['low', 'medium', 'high', 'ultra'] = ...,
    edges_source: typing.Literal['luma', 'depth', 'predicated', 'colour'] = ...,
    edges_threshold_mode: typing.Literal['fixed', 'dynamic'] = ...,
    edges_dynamic_luma: typing.Literal['current', 'max', 'min', 'mean'] = ...,
    edges_threshold: int = ...,
    edges_threshold_on_depth_edge: int = ...,
    edges_threshold_off_depth_edge: int = ...,
    edges_alpha: int = ...,
    edges_floor: int = ...,
    edges_depth_threshold: int = ...,
    edges_local_contrast: typing.Literal['off', 'paper', 'symmetric', 'smaa'] = ...,
    ends: typing.Literal['gaps', 'crossings'] = ...,
    border: typing.Literal['end', 'clamp'] = ...,
    predictor: typing.Literal['none', 'chord', 'fit'] = ...,
    steps: int = ...,
    contiguous: bool = ...,
    safe: bool = ...,
    trim: bool = ...,
    area: typing.Literal['analytic', 'table_full', 'table_merged', 'table_minimal', 'learned'] = ...,
    area_values: typing.Literal['exact', 'published'] = ...,
    search_steps: int = ...,
    diagonals: bool = ...,
    diagonal_steps: int = ...,
    round_corners: bool = ...,
    corner_rounding: int = ...,
    blend: typing.Literal['longest', 'strongest'] = ...,
    leave: typing.Literal['none', 'marked', 'beside', 'half', 'masked'] = ...,
    text_guard: bool = ...,
    linear_light: bool = ...,
    window_rows: int = ...,
    reach_columns: int = ...,
    lanes: int = ...,
    line_pixels: int = ...,
    record_fifo: int = ...,
    predictor_units: int = ...,
    trial_clocks: int = ...,
    divider_latency: int = ...,
    divider_interval: int = ...,
    storage: typing.Literal['line_buffers', 'memory'] = ...,
    memory_outstanding: int = ...,
) -> MorphologicalFrame: ...

COLOUR: numpy.dtype[numpy.void]
QUAD: numpy.dtype[numpy.void]

class TextureUnit:
    def __init__(
        self,
        memory: int = ...,
        *,
        preset: typing.Literal['paper', 'deburr'] = ...,
        axes: typing.Literal['two', 'four', 'eight'] = ...,
        footprint: typing.Literal['half', 'quarter', 'two_segment', 'exact', 'max'] = ...,
        log2: typing.Literal['mitchell', 'corrected', 'segments', 'exact'] = ...,
        count: typing.Literal['floor', 'ceil', 'any'] = ...,
        count_cap: typing.Literal['none', 'texel'] = ...,
        kernel: typing.Literal['box', 'tent'] = ...,
        spread: int = ...,
        srgb_output: typing.Literal['linear', 'encoded'] = ...,
        cache_bytes: int = ...,
        cache_line_bytes: int = ...,
        cache_ways: int = ...,
        cache_replacement: typing.Literal['lru', 'fifo', 'random'] = ...,
        cache_outstanding: int = ...,
        cache_fifo_depth: int = ...,
        axis_clocks: int = ...,
    ) -> None: ...
    def set(
        self,
        *,
        preset: typing.Literal['paper', 'deburr'] = ...,
        axes: typing.Literal['two', 'four', 'eight'] = ...,
        footprint: typing.Literal['half', 'quarter', 'two_segment', 'exact', 'max'] = ...,
        log2: typing.Literal['mitchell', 'corrected', 'segments', 'exact'] = ...,
        count: typing.Literal['floor', 'ceil', 'any'] = ...,
        count_cap: typing.Literal['none', 'texel'] = ...,
        kernel: typing.Literal['box', 'tent'] = ...,
        spread: int = ...,
        srgb_output: typing.Literal['linear', 'encoded'] = ...,
        cache_bytes: int = ...,
        cache_line_bytes: int = ...,
        cache_ways: int = ...,
        cache_replacement: typing.Literal['lru', 'fifo', 'random'] = ...,
        cache_outstanding: int = ...,
        cache_fifo_depth: int = ...,
        axis_clocks: int = ...,
    ) -> None: ...
    @property
    def parameters(self) -> dict[str, str]: ...
    def load(self, levels: _Array | list[_Array], texture: int = ..., **fields: typing.Any) -> None: ...
    def set_fields(self, texture: int = ..., **fields: typing.Any) -> None: ...
    def describe(self, texture: int = ...) -> dict[str, typing.Any]: ...
    def write(self, address: int, values: _Array) -> None: ...
    def read(self, address: int, size: int) -> _Array: ...
    def filter(self, quads: _Array) -> _Array: ...
    def analyse(self, quads: _Array) -> _Array: ...
    @property
    def fills(self) -> _Array: ...
    @property
    def work(self) -> Figures: ...
    def set_error_lines(self, lines: _Array | None) -> None: ...
    def invalidate(self) -> None: ...
    def reset(self) -> None: ...

def image_of(quads: _Array, colours: _Array, shape: tuple[int, int]) -> _Array: ...
def mip_levels(texels: _Array) -> list[_Array]: ...
def quads_of(s: _Array, t: _Array, covered: _Array | None = ..., texture: int = ...) -> _Array: ...
def texture(
    quads: _Array,
    levels: _Array | list[_Array],
    *,
    fields: dict[str, typing.Any] | None = ...,
    preset: typing.Literal['paper', 'deburr'] = ...,
    axes: typing.Literal['two', 'four', 'eight'] = ...,
    footprint: typing.Literal['half', 'quarter', 'two_segment', 'exact', 'max'] = ...,
    log2: typing.Literal['mitchell', 'corrected', 'segments', 'exact'] = ...,
    count: typing.Literal['floor', 'ceil', 'any'] = ...,
    count_cap: typing.Literal['none', 'texel'] = ...,
    kernel: typing.Literal['box', 'tent'] = ...,
    spread: int = ...,
    srgb_output: typing.Literal['linear', 'encoded'] = ...,
    cache_bytes: int = ...,
    cache_line_bytes: int = ...,
    cache_ways: int = ...,
    cache_replacement: typing.Literal['lru', 'fifo', 'random'] = ...,
    cache_outstanding: int = ...,
    cache_fifo_depth: int = ...,
    axis_clocks: int = ...,
) -> tuple[_Array, TextureUnit]: ...
