// SPDX-License-Identifier: MIT
// Parameters, presets and limits of the geometric engine: the configuration, which changes pixels,
// and build parameters, which change cycles, traffic and cost. Meaning:
// docs/reference/geometric/index.md; formats and rounding, to the bit:
// docs/reference/geometric/algorithm.md; cycles: docs/reference/geometric/hardware.md.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "spec/parameters.h"
#include "spec/presets.h"

namespace deburr::spec::geometric {

enum class Preset : std::uint8_t { kGpaa, kGpaaOptimised, kDeburr };
inline constexpr std::array<std::string_view, 3> kPresetNames = {"gpaa", "gpaa-optimised",
                                                                 "deburr"};

enum class Select : std::uint8_t { kAll, kEdges, kMesh };
inline constexpr std::array<std::string_view, 3> kSelectNames = {"all", "edges", "mesh"};

enum class Crease : std::uint8_t { kOff, kPaper, kShading };
inline constexpr std::array<std::string_view, 3> kCreaseNames = {"off", "paper", "shading"};

enum class DepthTest : std::uint8_t { kOff, kOwn, kFarther };
inline constexpr std::array<std::string_view, 3> kDepthTestNames = {"off", "own", "farther"};

enum class Cull : std::uint8_t { kNone, kBack };
inline constexpr std::array<std::string_view, 2> kCullNames = {"none", "back"};

enum class CoverageRule : std::uint8_t { kDistance, kArea };
inline constexpr std::array<std::string_view, 2> kCoverageNames = {"distance", "area"};

enum class Combine : std::uint8_t { kMax, kLast, kOutermost };
inline constexpr std::array<std::string_view, 3> kCombineNames = {"max", "last", "outermost"};

enum class Layout : std::uint8_t { kRaster, kTiled };
inline constexpr std::array<std::string_view, 2> kLayoutNames = {"raster", "tiled"};

enum class RecordsLayout : std::uint8_t { kJoined, kSplit };
inline constexpr std::array<std::string_view, 2> kRecordsNames = {"joined", "split"};

// Edges, walkers or pixels per cycle.
enum class Lanes : std::uint8_t { kOne, kTwo, kFour };
inline constexpr std::array<std::string_view, 3> kLanesNames = {"1", "2", "4"};
inline constexpr std::array<std::uint8_t, 3> kLaneCount = {1, 2, 4};
inline constexpr int kMaxLanes = 4;

// Words of a memory, codes 0..6.
enum class CacheLines : std::uint8_t { k16, k32, k64, k128, k256, k512, k1024 };
inline constexpr std::array<std::string_view, 7> kCacheLinesNames = {"16",  "32",  "64",  "128",
                                                                     "256", "512", "1024"};
inline constexpr std::array<std::uint16_t, 7> kCacheLineCount = {16, 32, 64, 128, 256, 512, 1024};
inline constexpr std::array<std::uint8_t, 7> kCacheLineBits = {4, 5, 6, 7, 8, 9, 10};

// On-chip lines of coarse depth; none: no coarse depth test.
enum class CoarseLines : std::uint8_t { kNone, k4, k8, k16, k32, k64 };
inline constexpr std::array<std::string_view, 6> kCoarseLinesNames = {"none", "4",  "8",
                                                                      "16",   "32", "64"};
inline constexpr std::array<std::uint8_t, 6> kCoarseLineCount = {0, 4, 8, 16, 32, 64};

// ---- limits
inline constexpr int kMaxFrameSize = 8192;  // pixels per axis
inline constexpr std::uint32_t kMaxEdges = 1u << 24;
inline constexpr std::uint32_t kMaxVertices = 1u << 24;
inline constexpr std::uint32_t kMaxFaces = 1u << 20;
// Usable vertices have x and y in [-kGuardBand, kGuardBand), S14.8.
inline constexpr int kGuardBandPixels = 1 << 14;
inline constexpr std::int32_t kGuardBand = kGuardBandPixels << 8;

// ---- formats
inline constexpr int kSubpixelBits = 8;        // of positions
inline constexpr int kDepthBits = 24;          // near / w, grows towards the eye
inline constexpr int kLengthBits = 23;         // extent of a line, U15.8
inline constexpr int kReciprocalBits = 26;     // fraction bits of a reciprocal, U1.26
inline constexpr int kSlopeBits = 24;          // fraction bits of slope and position
inline constexpr int kDistanceBits = 16;       // fraction bits of the distance to a line
inline constexpr int kDepthStepBits = 12;      // fraction bits of a depth along a line
inline constexpr int kMaxWeight = 128;         // U0.8: 1/2, the largest weight of a neighbour
inline constexpr int kAreaSlopes = 32;         // slopes of the area table, 1/32 each
inline constexpr int kAreaDistances = 64;      // distances of the area table, 1/64 pixel each
inline constexpr int kBlockSize = 4;           // pixels per side of a block
inline constexpr int kBlockPixels = 16;        // pixels of a block, and of a line of memory
inline constexpr int kTileSize = 8;            // pixels per side of a tile
inline constexpr int kBlocksInWord = 128;      // blocks of a row whose touched bits are in one word
inline constexpr int kMaxReciprocalBits = 11;  // length bits of the reciprocal table
inline constexpr int kMinFills = 8, kMaxFills = 256;  // a group may request eight lines of depth
// Limits of entries that are not derived from the memory latency.
inline constexpr std::int32_t kMinResolveLines = 16, kMaxResolveLines = 512;
inline constexpr std::int32_t kMinCopyLines = 2, kMaxCopyLines = 256;
// Limits of lines kept on the chip: docs/reference/geometric/memory.md.
inline constexpr std::int32_t kMaxColourLines = 256, kMaxWriteBuffer = 128;

// Configuration: it changes pixels. Golden model and RTL model both implement it. The defaults are
// those of preset `deburr`.
struct Configuration {
  Preset preset = Preset::kDeburr;
  Select select = Select::kEdges;
  Crease crease = Crease::kShading;
  Cull cull = Cull::kNone;
  CoverageRule coverage = CoverageRule::kArea;
  DepthTest depth_test = DepthTest::kFarther;
  std::int32_t depth_bias = 9;
  std::int32_t crease_depth = 3;
  Combine combine = Combine::kOutermost;
  bool linear_light = true;
  bool mark = false;
};

// Build parameters: they change cycles, traffic and cost, but no pixels. Runs that differ only in
// these have the same golden picture. `layout` and `frame_copy` are fields of registers
// nevertheless.
struct Build {
  Layout layout = Layout::kTiled;
  bool frame_copy = false;
  std::int32_t line_pixels = 2048;
  std::int32_t touched_words = 1088;
  std::int32_t face_limit = 32768;
  Lanes edge_lanes = Lanes::kTwo;
  std::int32_t edge_lines = 64;
  CacheLines vertex_lines = CacheLines::k64;
  std::int32_t dividers = 1;
  bool pipelined = true;
  std::int32_t reciprocal_table = 0;
  std::int32_t line_fifo = 16;
  Lanes walkers = Lanes::kFour;
  CacheLines depth_lines = CacheLines::k128;
  CacheLines weight_blocks = CacheLines::k128;
  std::int32_t fills = 0;  // 0: derived from the memory latency
  std::int32_t latency_fifo = 128;
  Lanes resolve_lanes = Lanes::kTwo;
  std::int32_t resolve_lines = 0;  // 0: like fills
  std::int32_t copy_lines = 0;     // 0: like fills
  RecordsLayout records = RecordsLayout::kJoined;
  std::int32_t colour_lines = 0;
  std::int32_t write_buffer = 0;
  CoarseLines coarse_lines = CoarseLines::kNone;
  std::int32_t memory_outstanding = 128;
};

struct Parameters : Configuration, Build {};

template <class Visitor>
void describe(Configuration& p, Visitor& v) {
  v.choice(
      "preset", p.preset, kPresetNames,
      "Named configuration: sets the parameters below. A parameter that is given overrides it.");
  v.choice("select", p.select, kSelectNames,
           "Drawn edges: all; boundaries, silhouettes and creases; or boundaries and creases only, "
           "independent of the view (mesh).");
  v.choice("crease", p.crease, kCreaseNames,
           "Creases: none, by angle (eq 4 of paper 002), or by a change of shading.");
  v.choice("cull", p.cull, kCullNames,
           "Edges between two back faces: handled as between front faces, or dropped.");
  v.choice("coverage", p.coverage, kCoverageNames,
           "Coverage of a pixel by a line: the distance along the column, or the area cut off, "
           "including the second pixel of the column.");
  v.choice("depth_test", p.depth_test, kDepthTestNames,
           "Depth test of a line: off, against its own pixel, or against the farther of its pixel "
           "and the neighbour.");
  v.integer("depth_bias", p.depth_bias, 1, 24, "bit",
            "Tolerance of the depth test: a line passes if it is farther by at most 2^-n of the "
            "compared depth.");
  v.integer("crease_depth", p.crease_depth, 0, 24, "bit",
            "Tolerance for creases: the compared depth may be farther than the crease by 2^-n of "
            "the crease's depth; 0: no limit.");
  v.choice("combine", p.combine, kCombineNames,
           "Weights where lines overlap: the largest per direction, the last one only, or the "
           "smallest in a direction whose neighbour is farther and otherwise the largest.");
  v.boolean("linear_light", p.linear_light, "Blend in linear light instead of sRGB codes.");
  v.boolean("mark", p.mark, "Clear bit 0 of alpha of blended pixels, for the engine that follows.");
}

template <class Visitor>
void describe(Build& p, Visitor& v) {
  v.choice("layout", p.layout, kLayoutNames,
           "Pixel order of the colour and depth buffers: rows, or 8 x 8 tiles.");
  v.boolean("frame_copy", p.frame_copy,
            "Copy the whole frame first and blend from the copy, as the original method does.");
  v.integer("line_pixels", p.line_pixels, 64, kMaxFrameSize, "pixel",
            "Maximum frame width of the row buffers of original pixels.");
  v.integer("touched_words", p.touched_words, 16, 65536, "word",
            "Words of 128 touched bits, one bit per block; a frame needs a word for every 512 x 4 "
            "pixels.");
  v.integer("face_limit", p.face_limit, 8192, static_cast<std::int32_t>(kMaxFaces), "face",
            "On-chip facing bits; a mesh with more faces is rejected.");
  v.choice("edge_lanes", p.edge_lanes, kLanesNames, "Edges classified per cycle.");
  v.integer("edge_lines", p.edge_lines, 4, 256, "line",
            "Prefetched lines of the edge table, four edges each; ten with records = split.");
  v.choice("vertex_lines", p.vertex_lines, kCacheLinesNames,
           "Lines of the vertex cache, four vertices each.");
  v.integer("dividers", p.dividers, 1, 8, "unit", "Dividers of the line setup.");
  v.boolean("pipelined", p.pipelined,
            "A divider accepts a line in every cycle instead of every thirteenth.");
  v.integer("reciprocal_table", p.reciprocal_table, 0, kMaxReciprocalBits, "bit",
            "Lines shorter than 2^n / 256 pixels get their reciprocal from a table; 0: no table. "
            "For dividers without pipelining.");
  v.integer("line_fifo", p.line_fifo, 2, 256, "line", "Lines waiting for the walkers.");
  v.choice("walkers", p.walkers, kLanesNames, "Pixels of a line walked per cycle.");
  v.choice("depth_lines", p.depth_lines, kCacheLinesNames,
           "Lines of the depth cache, sixteen pixels each.");
  v.choice("weight_blocks", p.weight_blocks, kCacheLinesNames,
           "Blocks of the weight cache, 4 x 4 pixels each.");
  v.integer("fills", p.fills, 0, kMaxFills, "line",
            "Fills in flight of each cache (vertices, depth, weights, and pairs and coarse depth "
            "if built), at least 8; 0: derived from the memory latency.");
  v.integer("latency_fifo", p.latency_fifo, 4, 1024, "token",
            "Lookups that wait for their lines, for each cache of `fills`.");
  v.choice("resolve_lanes", p.resolve_lanes, kLanesNames, "Pixels blended per cycle.");
  v.integer("resolve_lines", p.resolve_lines, 0, kMaxResolveLines, "line",
            "Lines of colours and weights in flight to the resolve, at least 16; 0: derived from "
            "the memory latency.");
  v.integer("copy_lines", p.copy_lines, 0, kMaxCopyLines, "line",
            "Lines between read and write of the frame copy, at least 2; 0: derived from the "
            "memory latency.");
  v.choice("records", p.records, kRecordsNames,
           "Edge table: vertices and faces of an edge in one record, or in two arrays, so that "
           "vertices are only read for kept edges.");
  v.integer("colour_lines", p.colour_lines, 0, kMaxColourLines, "line",
            "Colour lines that the resolve keeps and does not read again; 0: none.");
  v.integer("write_buffer", p.write_buffer, 0, kMaxWriteBuffer, "block",
            "Write buffer: evicted blocks of weights that stay on the chip before they are "
            "written; 0: none.");
  v.choice("coarse_lines", p.coarse_lines, kCoarseLinesNames,
           "On-chip lines of coarse depth, 32 tiles of 8 x 8 pixels each; they drop hidden "
           "candidates before depth is read.");
  v.integer("memory.outstanding", p.memory_outstanding, kMinFills, 1024, "transaction",
            "Transactions in flight.");
}

template <class Visitor>
void describe(Parameters& p, Visitor& v) {
  describe(static_cast<Configuration&>(p), v);
  describe(static_cast<Build&>(p), v);
}

// The parameters that a preset sets; all others keep their defaults.
struct PresetRow {
  Preset preset;
  Select select;
  Crease crease;
  Cull cull;
  CoverageRule coverage;
  std::int32_t crease_depth;
  Combine combine;
  bool frame_copy;
};
inline constexpr std::array<PresetRow, 3> kPresets = {{
    {Preset::kGpaa, Select::kAll, Crease::kPaper, Cull::kBack, CoverageRule::kDistance, 0,
     Combine::kLast, true},
    {Preset::kGpaaOptimised, Select::kEdges, Crease::kPaper, Cull::kBack, CoverageRule::kDistance,
     0, Combine::kLast, true},
    {Preset::kDeburr, Select::kEdges, Crease::kShading, Cull::kNone, CoverageRule::kArea, 3,
     Combine::kOutermost, false},
}};

// Calls set(name, member, value) for each of them (spec/presets.h).
template <class Set>
constexpr void for_each_of(Preset preset, Set&& set) {
  const PresetRow& row = row_of(kPresets, &PresetRow::preset, preset);
  set("select", &Configuration::select, row.select);
  set("crease", &Configuration::crease, row.crease);
  set("cull", &Configuration::cull, row.cull);
  set("coverage", &Configuration::coverage, row.coverage);
  set("crease_depth", &Configuration::crease_depth, row.crease_depth);
  set("combine", &Configuration::combine, row.combine);
  set("frame_copy", &Build::frame_copy, row.frame_copy);
}

// The defaults with the values of a preset. Throws ConfigError for an unknown preset.
constexpr Parameters preset_parameters(Preset preset) {
  Parameters p;
  p.preset = preset;
  for_each_of(preset, [&](std::string_view, auto member, auto value) { p.*member = value; });
  return p;
}

}  // namespace deburr::spec::geometric
