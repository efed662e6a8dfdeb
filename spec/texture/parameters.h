// SPDX-License-Identifier: MIT
// Parameters of the texture unit: rules, which change pixels, and build choices, which change
// clocks and cost. Meaning: docs/texture_unit.md; formats and rounding: docs/number_formats.md.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "spec/parameters.h"

namespace deburr::spec::texture {

enum class FootprintRule : std::uint8_t { kHalf, kQuarter, kTwoSegment, kExact, kMax };
inline constexpr std::array<std::string_view, 5> kFootprintNames = {"half", "quarter",
                                                                    "two_segment", "exact", "max"};
enum class Log2Rule : std::uint8_t { kMitchell, kCorrected, kSegments, kExact };
inline constexpr std::array<std::string_view, 4> kLog2Names = {"mitchell", "corrected", "segments",
                                                               "exact"};
enum class CountRule : std::uint8_t { kFloor, kCeil };
inline constexpr std::array<std::string_view, 2> kCountNames = {"floor", "ceil"};
enum class CountCap : std::uint8_t { kNone, kTexel };
inline constexpr std::array<std::string_view, 2> kCountCapNames = {"none", "texel"};
enum class Kernel : std::uint8_t { kBox, kTent };
inline constexpr std::array<std::string_view, 2> kKernelNames = {"box", "tent"};
enum class Replacement : std::uint8_t { kLru, kFifo, kRandom };
inline constexpr std::array<std::string_view, 3> kReplacementNames = {"lru", "fifo", "random"};

// Rules: what changes pixels. Golden and hardware obey them.
struct Rules {
  FootprintRule footprint = FootprintRule::kHalf;
  Log2Rule log2 = Log2Rule::kMitchell;
  CountRule count = CountRule::kFloor;
  CountCap count_cap = CountCap::kNone;
  Kernel kernel = Kernel::kBox;
  std::int32_t spread = 64;
};

// Build choices: what changes clocks and cost, and no pixel. Runs that differ in these alone share
// one golden picture.
struct Build {
  std::int32_t cache_bytes = 16384;
  std::int32_t cache_line_bytes = 64;
  std::int32_t cache_ways = 2;
  Replacement cache_replacement = Replacement::kLru;
  std::int32_t cache_outstanding = 64;
  std::int32_t cache_fifo_depth = 160;
};

struct Parameters : Rules, Build {};

template <class Visitor>
void describe(Rules& p, Visitor& v) {
  v.choice("footprint", p.footprint, kFootprintNames,
           "Rule for the length of a footprint side from its two components.");
  v.choice("log2", p.log2, kLog2Names, "Rule for the binary logarithm of a footprint side.");
  v.choice("count", p.count, kCountNames,
           "Rounding of L when the sample count N = 2^L is formed: floor is the paper.");
  v.choice("count_cap", p.count_cap, kCountCapNames,
           "texel: never place samples closer together than a texel of level 0.");
  v.choice("kernel", p.kernel, kKernelNames,
           "Weights of the N samples: equal (the paper) or an integer tent.");
  v.integer("spread", p.spread, 0, 128, "1/64 axis",
            "Length over which the samples are spread, U1.6 of the major axis.");
}

template <class Visitor>
void describe(Build& p, Visitor& v) {
  v.integer("cache.bytes", p.cache_bytes, 256, 1 << 20, "byte",
            "Capacity of the texture cache; a power of two; more than 512 lines cannot be built.");
  v.integer("cache.line_bytes", p.cache_line_bytes, 32, 128, "byte",
            "Size of a cache line; a power of two.");
  v.integer("cache.ways", p.cache_ways, 1, 16, "way",
            "Associativity; a power of two; 16 cannot be built.");
  v.choice("cache.replacement", p.cache_replacement, kReplacementNames,
           "Which way of a full set is replaced.");
  v.integer("cache.outstanding", p.cache_outstanding, 4, 256, "line",
            "Line fills in flight: entries of the miss queue and of the fill buffer.");
  v.integer("cache.fifo_depth", p.cache_fifo_depth, 2, 4096, "request",
            "Depth of the latency FIFO between tag check and data read.");
}

template <class Visitor>
void describe(Parameters& p, Visitor& v) {
  describe(static_cast<Rules&>(p), v);
  describe(static_cast<Build&>(p), v);
}

}  // namespace deburr::spec::texture
