// SPDX-License-Identifier: MIT
// Parameters of the texture unit: the configuration, which changes pixels, and build parameters,
// which change cycles and cost. Meaning: docs/reference/texture/index.md; formats and rounding:
// docs/reference/texture/formats.md.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "spec/parameters.h"
#include "spec/presets.h"

namespace deburr::spec::texture {

enum class Preset : std::uint8_t { kPaper, kDeburr };
inline constexpr std::array<std::string_view, 2> kPresetNames = {"paper", "deburr"};
enum class FootprintRule : std::uint8_t { kHalf, kQuarter, kTwoSegment, kExact, kMax };
inline constexpr std::array<std::string_view, 5> kFootprintNames = {"half", "quarter",
                                                                    "two_segment", "exact", "max"};
enum class Log2Rule : std::uint8_t { kMitchell, kCorrected, kSegments, kExact };
inline constexpr std::array<std::string_view, 4> kLog2Names = {"mitchell", "corrected", "segments",
                                                               "exact"};
enum class CountRule : std::uint8_t { kFloor, kCeil, kAny };
inline constexpr std::array<std::string_view, 3> kCountNames = {"floor", "ceil", "any"};
enum class Axes : std::uint8_t { kTwo, kFour, kEight };
inline constexpr std::array<std::string_view, 3> kAxesNames = {"two", "four", "eight"};
enum class SrgbOutput : std::uint8_t { kLinear, kEncoded };
inline constexpr std::array<std::string_view, 2> kSrgbOutputNames = {"linear", "encoded"};
enum class CountCap : std::uint8_t { kNone, kTexel };
inline constexpr std::array<std::string_view, 2> kCountCapNames = {"none", "texel"};
enum class Kernel : std::uint8_t { kBox, kTent, kAxis };
inline constexpr std::array<std::string_view, 3> kKernelNames = {"box", "tent", "axis"};
enum class Replacement : std::uint8_t { kLru, kFifo, kRandom };
inline constexpr std::array<std::string_view, 3> kReplacementNames = {"lru", "fifo", "random"};

enum class Blend : std::uint8_t { kSample, kLevel };
inline constexpr std::array<std::string_view, 2> kBlendNames = {"sample", "level"};
enum class Derivatives : std::uint8_t { kFine, kCoarse };
inline constexpr std::array<std::string_view, 2> kDerivativesNames = {"fine", "coarse"};
enum class BlockRule : std::uint8_t { kTruncated, kRounded };
inline constexpr std::array<std::string_view, 2> kBlockRuleNames = {"truncated", "rounded"};
enum class Decode : std::uint8_t { kNone, kAfter, kBefore };
inline constexpr std::array<std::string_view, 3> kDecodeNames = {"none", "after", "before"};
enum class NamedBuild : std::uint8_t { kNarrow, kLean, kWide };
inline constexpr std::array<std::string_view, 3> kNamedBuildNames = {"narrow", "lean", "wide"};

// ---- Limits of the build
// Four lines are looked up one after the other within a cycle. This leaves time for no more than
// this many ways.
inline constexpr std::int32_t kMostCacheWays = 8;
// Tags are flip-flops, and these are limited to 16 kbit.
inline constexpr std::int32_t kMostCacheLines = 512;
inline constexpr std::int32_t kMostFifoDepth = 4096;
inline constexpr std::int32_t kLeastCacheBytes = 256;
inline constexpr std::int32_t kLeastCacheLineBytes = 32, kMostCacheLineBytes = 128;
inline constexpr std::int32_t kMostOutstanding = 256;
// Requests and fragments per cycle, and ports of the cache (docs/reference/texture/width.md).
inline constexpr std::int32_t kMostWidth = 4;
inline constexpr std::int32_t kLeastLookups = 4, kMostLookups = 8;
inline constexpr std::int32_t kMostAllocations = 4;
inline constexpr std::int32_t kMostLineBanks = 8;
inline constexpr std::int32_t kMostBankReads = 2;
inline constexpr std::int32_t kMostFillWrites = 4;
// A request asks for at most four blocks; a group for more (docs/reference/texture/compressed.md).
inline constexpr std::int32_t kBlocksPerRequest = 4;
inline constexpr std::int32_t kMostDecoders = 6;
inline constexpr std::int32_t kLeastCompressedLines = 4, kMostCompressedLines = 64;

// Configuration: it changes pixels. Golden model and RTL model both implement it. The defaults are
// those of preset `deburr`.
struct Configuration {
  Preset preset = Preset::kDeburr;
  Axes axes = Axes::kFour;
  FootprintRule footprint = FootprintRule::kExact;
  Log2Rule log2 = Log2Rule::kSegments;
  CountRule count = CountRule::kAny;
  CountCap count_cap = CountCap::kNone;
  Kernel kernel = Kernel::kBox;
  std::int32_t spread = 64;
  SrgbOutput srgb_output = SrgbOutput::kLinear;
  Blend blend = Blend::kSample;
  Derivatives derivatives = Derivatives::kFine;
  BlockRule bc = BlockRule::kTruncated;
};

// Build parameters: they change cycles and cost, but no pixels. Runs that differ only in these have
// the same golden picture.
struct Build {
  std::int32_t cache_bytes = 16384;
  std::int32_t cache_line_bytes = 64;
  std::int32_t cache_ways = 2;
  Replacement cache_replacement = Replacement::kLru;
  std::int32_t cache_outstanding = 64;  // 0: derived from the memory latency
  std::int32_t cache_fifo_depth = 0;    // 0: derived from the memory latency
  std::int32_t axis_cycles = 1;
  NamedBuild build = NamedBuild::kNarrow;
  std::int32_t width = 1;      // bilinear requests per cycle
  std::int32_t fragments = 1;  // fragments of one quad per cycle
  std::int32_t cache_lookups = 4;
  std::int32_t cache_allocations = 4;
  std::int32_t cache_line_banks = 1;
  std::int32_t cache_bank_reads = 1;
  std::int32_t cache_fill_writes = 1;
  Decode decode = Decode::kNone;
  std::int32_t cache_decoders = 0;          // 0: 4 with width = 1, else 6
  std::int32_t cache_compressed_lines = 0;  // 0: 16
};

struct Parameters : Configuration, Build {};

template <class Visitor>
void describe(Configuration& p, Visitor& v) {
  v.choice(
      "preset", p.preset, kPresetNames,
      "Named configuration: sets the parameters below. A parameter that is given overrides it.");
  v.choice("axes", p.axes, kAxesNames,
           "Candidate directions of the major axis: the pixel's row and column (the paper), or "
           "four or eight directions, every 45 or 22.5 degrees.");
  v.choice("footprint", p.footprint, kFootprintNames,
           "Formula for the length of a footprint side from its two components.");
  v.choice("log2", p.log2, kLog2Names, "Formula for the binary logarithm of a footprint side.");
  v.choice("count", p.count, kCountNames,
           "Sample count: N = 2^L with L rounded (floor: the paper), or any: every N from 1 to 16, "
           "without visible steps.");
  v.choice("count_cap", p.count_cap, kCountCapNames,
           "texel: samples are at least a texel of level 0 apart.");
  v.choice("kernel", p.kernel, kKernelNames,
           "Weights of the N samples: equal (box, the paper), an integer tent, or axis: a tent for "
           "fragments whose major axis is a diagonal of the pixel, a box for all others.");
  v.integer(
      "spread", p.spread, 0, 128, "1/64 axis",
      "Length over which the samples are spread, U2.6 of the major axis; a tent of kernel = axis "
      "is 1.41 times as long.");
  v.choice("srgb_output", p.srgb_output, kSrgbOutputNames,
           "Output format of sRGB textures: 8-bit linear light, or sRGB codes.");
  v.choice(
      "blend", p.blend, kBlendNames,
      "Order of the sums over samples and levels: sample blends the levels of each sample (the "
      "paper); level sums the samples of each level, then blends the levels.");
  v.choice("derivatives", p.derivatives, kDerivativesNames,
           "Differences of a fragment: along its own row and column (fine), or along row 0 and "
           "column 0 of its quad (coarse).");
  v.choice("bc", p.bc, kBlockRuleNames,
           "Rounding of the colours between two end points of a BC block: truncated as libsquish, "
           "or rounded as OpenImageIO.");
}

template <class Visitor>
void describe(Build& p, Visitor& v) {
  v.integer("cache.bytes", p.cache_bytes, kLeastCacheBytes, kMostCacheLines * kMostCacheLineBytes,
            "byte", "Capacity of the texture cache; a power of two, at most 512 lines.");
  v.integer("cache.line_bytes", p.cache_line_bytes, kLeastCacheLineBytes, kMostCacheLineBytes,
            "byte", "Size of a cache line; a power of two.");
  v.integer("cache.ways", p.cache_ways, 1, kMostCacheWays, "way", "Associativity; a power of two.");
  v.choice("cache.replacement", p.cache_replacement, kReplacementNames, "Replacement policy.");
  v.integer(
      "cache.outstanding", p.cache_outstanding, 0, kMostOutstanding, "line",
      "Line fills in flight: entries of the miss queue and of the fill buffer, at least 4; 0: "
      "derived from the memory latency.");
  v.integer("cache.fifo_depth", p.cache_fifo_depth, 0, kMostFifoDepth, "request",
            "Depth of the latency FIFO between tag check and data read, at least 2; 0: derived "
            "from the memory latency.");
  v.integer("axis_cycles", p.axis_cycles, 1, 4, "clk",
            "Cycles for measuring the candidate directions of axes = four or eight; more cycles "
            "need fewer operators. A power of two, at most half the candidates.");
  v.choice("build", p.build, kNamedBuildNames,
           "Named build: sets width and ports below. A parameter that is given overrides it.");
  v.integer("width", p.width, 1, kMostWidth, "request/clk",
            "Bilinear requests per cycle; a power of two.");
  v.integer("fragments", p.fragments, 1, kMostWidth, "fragment/clk",
            "Fragments of one quad that the address unit accepts per cycle; a power of two.");
  v.integer("cache.lookups", p.cache_lookups, kLeastLookups, kMostLookups, "line/clk",
            "Distinct lines looked up per cycle.");
  v.integer("cache.allocations", p.cache_allocations, 1, kMostAllocations, "line/clk",
            "Lines allocated per cycle.");
  v.integer("cache.line_banks", p.cache_line_banks, 1, kMostLineBanks, "bank",
            "Banks of whole lines, selected by the low bits of the line number; a power of two.");
  v.integer("cache.bank_reads", p.cache_bank_reads, 1, kMostBankReads, "word/clk",
            "Words read per cycle from each bank of words.");
  v.integer("cache.fill_writes", p.cache_fill_writes, 1, kMostFillWrites, "line/clk",
            "Fills written per cycle, each into another line bank; a power of two.");
  v.choice("decode", p.decode, kDecodeNames,
           "Where compressed textures are decoded: after or before the cache; none: their "
           "descriptors are invalid.");
  v.integer("cache.decoders", p.cache_decoders, 0, kMostDecoders, "block/clk",
            "Blocks decoded per cycle with decode = after; 0: 4 with width = 1, else 6.");
  v.integer("cache.compressed_lines", p.cache_compressed_lines, 0, kMostCompressedLines, "line",
            "Lines of 64 bytes of memory in front of the decoder of decode = before, a power of "
            "two, at least 4; 0: 16.");
}

template <class Visitor>
void describe(Parameters& p, Visitor& v) {
  describe(static_cast<Configuration&>(p), v);
  describe(static_cast<Build&>(p), v);
}

// The parameters that a preset sets; all others keep their defaults.
struct PresetRow {
  Preset preset;
  Axes axes;
  FootprintRule footprint;
  Log2Rule log2;
  CountRule count;
};
inline constexpr std::array<PresetRow, 2> kPresets = {{
    {Preset::kPaper, Axes::kTwo, FootprintRule::kHalf, Log2Rule::kMitchell, CountRule::kFloor},
    {Preset::kDeburr, Axes::kFour, FootprintRule::kExact, Log2Rule::kSegments, CountRule::kAny},
}};

// Calls set(name, member, value) for each of them (spec/presets.h).
template <class Set>
constexpr void for_each_of(Preset preset, Set&& set) {
  const PresetRow& row = row_of(kPresets, &PresetRow::preset, preset);
  set("axes", &Configuration::axes, row.axes);
  set("footprint", &Configuration::footprint, row.footprint);
  set("log2", &Configuration::log2, row.log2);
  set("count", &Configuration::count, row.count);
}

// The parameters that a named build sets.
struct BuildRow {
  NamedBuild build;
  std::int32_t outstanding;
  std::int32_t width, fragments;
  std::int32_t lookups, allocations, line_banks, bank_reads, fill_writes;
};
inline constexpr std::array<BuildRow, 3> kBuilds = {{
    {NamedBuild::kNarrow, 64, 1, 1, 4, 4, 1, 1, 1},
    {NamedBuild::kLean, 0, 4, 4, 6, 2, 4, 2, 2},
    {NamedBuild::kWide, 0, 4, 4, 8, 4, 4, 2, 4},
}};

// Calls set(name, member, value) for each of them.
template <class Set>
constexpr void for_each_of(NamedBuild build, Set&& set) {
  const BuildRow& row = row_of(kBuilds, &BuildRow::build, build);
  set("cache.outstanding", &Build::cache_outstanding, row.outstanding);
  set("width", &Build::width, row.width);
  set("fragments", &Build::fragments, row.fragments);
  set("cache.lookups", &Build::cache_lookups, row.lookups);
  set("cache.allocations", &Build::cache_allocations, row.allocations);
  set("cache.line_banks", &Build::cache_line_banks, row.line_banks);
  set("cache.bank_reads", &Build::cache_bank_reads, row.bank_reads);
  set("cache.fill_writes", &Build::cache_fill_writes, row.fill_writes);
}

// The defaults with the values of a preset and of a named build. Throws ConfigError if either is
// unknown.
constexpr Parameters preset_parameters(Preset preset, NamedBuild build = NamedBuild::kNarrow) {
  Parameters p;
  p.preset = preset;
  p.build = build;
  const auto set = [&](std::string_view, auto member, auto value) { p.*member = value; };
  for_each_of(preset, set);
  for_each_of(build, set);
  return p;
}

}  // namespace deburr::spec::texture
