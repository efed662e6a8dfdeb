// SPDX-License-Identifier: MIT
// Rules between the build parameters of the texture unit. Reasons: docs/reference/texture/cache.md,
// "Tags"; docs/reference/texture/hardware.md, "Directions".
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <string>

#include "spec/check_build.h"
#include "spec/texture/parameters.h"

namespace deburr::spec::texture {

constexpr bool is_power_of_two(std::int32_t value) {
  return value > 0 && std::has_single_bit(static_cast<std::uint32_t>(value));
}
// Leaves at least two directions per cycle: 1, 2, 4 for two, four, eight axes.
constexpr std::int32_t most_axis_cycles(Axes axes) { return 1 << static_cast<std::int32_t>(axes); }

inline constexpr std::array<BuildRule<Parameters>, 25> kBuildRules = {{
    {{"cache.bytes"},
     "must be a power of two",
     [](const Parameters& p) { return is_power_of_two(p.cache_bytes); }},
    {{"cache.line_bytes"},
     "must be a power of two",
     [](const Parameters& p) { return is_power_of_two(p.cache_line_bytes); }},
    {{"cache.ways"},
     "must be a power of two",
     [](const Parameters& p) { return is_power_of_two(p.cache_ways); }},
    {{"cache.bytes", "cache.line_bytes", "cache.ways"},
     "must hold at least one set, with a line for each way",
     [](const Parameters& p) { return p.cache_bytes >= p.cache_line_bytes * p.cache_ways; },
     [](const Parameters& p) {
       return "make it at least " + std::to_string(p.cache_line_bytes * p.cache_ways) +
              ", or lines or ways fewer";
     }},
    {{"cache.fifo_depth"},
     "must be at least 2 entries, since one is read and one is written per cycle; 0: derived from "
     "the memory latency",
     [](const Parameters& p) { return p.cache_fifo_depth != 1; }},
    {{"axis_cycles"},
     "must be a power of two",
     [](const Parameters& p) { return is_power_of_two(p.axis_cycles); }},
    {{"axis_cycles", "axes"},
     "must be at most half of the directions, since at least two are measured per cycle",
     [](const Parameters& p) { return p.axis_cycles <= most_axis_cycles(p.axes); },
     [](const Parameters& p) {
       return "make it at most " + std::to_string(most_axis_cycles(p.axes)) + " for " +
              std::to_string(2 * most_axis_cycles(p.axes)) + " directions";
     }},
    {{"cache.bytes", "cache.line_bytes"},
     "must be at most 512 lines: their tags are kept in flip-flops, because four sets are read and "
     "written per cycle, and flip-flops are limited to 16 kbit per memory",
     [](const Parameters& p) { return p.cache_bytes <= kMostCacheLines * p.cache_line_bytes; },
     [](const Parameters& p) {
       return "make it at most " + std::to_string(kMostCacheLines * p.cache_line_bytes) +
              ", or lines longer";
     }},
    {{"cache.outstanding"},
     "must be at least 4 lines, those of one request; 0: derived from the memory latency",
     [](const Parameters& p) { return p.cache_outstanding == 0 || p.cache_outstanding >= 4; }},
    {{"width"},
     "must be a power of two",
     [](const Parameters& p) { return is_power_of_two(p.width); }},
    {{"fragments"},
     "must be a power of two",
     [](const Parameters& p) { return is_power_of_two(p.fragments); }},
    {{"cache.line_banks"},
     "must be a power of two",
     [](const Parameters& p) { return is_power_of_two(p.cache_line_banks); }},
    {{"cache.fill_writes"},
     "must be a power of two",
     [](const Parameters& p) { return is_power_of_two(p.cache_fill_writes); }},
    {{"fragments", "width"},
     "must be at most the requests per cycle, since every fragment makes a request",
     [](const Parameters& p) { return p.fragments <= p.width; },
     [](const Parameters& p) { return "make it at most " + std::to_string(p.width); }},
    {{"cache.lookups", "cache.allocations", "cache.line_banks", "cache.bank_reads",
      "cache.fill_writes", "width"},
     "must be 4, 4, 1, 1 and 1 with width = 1: these ports belong to groups of requests",
     [](const Parameters& p) {
       return p.width > 1 ||
              (p.cache_lookups == 4 && p.cache_allocations == 4 && p.cache_line_banks == 1 &&
               p.cache_bank_reads == 1 && p.cache_fill_writes == 1);
     }},
    {{"cache.replacement", "width"},
     "must be lru with a width above 1: with other policies, a line could be evicted between two "
     "uses by one group",
     [](const Parameters& p) { return p.width == 1 || p.cache_replacement == Replacement::kLru; }},
    {{"cache.line_banks", "cache.bytes", "cache.line_bytes", "cache.ways"},
     "must be at most the number of sets, since the low bits of the set select the bank",
     [](const Parameters& p) {
       return p.cache_line_banks == 1 ||
              p.cache_line_banks * p.cache_line_bytes * p.cache_ways <= p.cache_bytes;
     }},
    {{"cache.line_banks", "cache.bytes", "cache.line_bytes"},
     "must leave 16 lines per bank, or at most 64 banks of words: more and smaller ones of SRAM "
     "are not built",
     [](const Parameters& p) {
       return p.cache_bytes / p.cache_line_bytes >= 16 * p.cache_line_banks ||
              p.cache_line_banks * p.cache_line_bytes / 4 <= 64;
     }},
    {{"cache.fill_writes", "cache.line_banks"},
     "must be at most the number of line banks, since each fill is written into another one",
     [](const Parameters& p) { return p.cache_fill_writes <= p.cache_line_banks; },
     [](const Parameters& p) { return "make it at most " + std::to_string(p.cache_line_banks); }},
    {{"cache.outstanding", "cache.fill_writes"},
     "must be a multiple of the fills written per cycle, over which the fill buffer is interleaved",
     [](const Parameters& p) { return p.cache_outstanding % p.cache_fill_writes == 0; }},
    {{"cache.outstanding", "cache.lookups"},
     "must hold the lines of one group",
     [](const Parameters& p) {
       return p.width == 1 || p.cache_outstanding == 0 || p.cache_outstanding >= p.cache_lookups;
     },
     [](const Parameters& p) { return "make it at least " + std::to_string(p.cache_lookups); }},
    {{"cache.decoders", "decode", "width"},
     "must be at most 4 with width = 1, since a request asks for at most four blocks",
     [](const Parameters& p) {
       return p.decode != Decode::kAfter || p.width > 1 || p.cache_decoders <= kBlocksPerRequest;
     }},
    {{"cache.decoders", "decode", "width"},
     "must be at least 4 with a width above 1, so that a group of one request is decoded in one "
     "cycle; 0: 6",
     [](const Parameters& p) {
       return p.decode != Decode::kAfter || p.width == 1 || p.cache_decoders == 0 ||
              p.cache_decoders >= kBlocksPerRequest;
     }},
    {{"cache.compressed_lines", "decode"},
     "must be a power of two, at least 4",
     [](const Parameters& p) {
       return p.decode != Decode::kBefore || p.cache_compressed_lines == 0 ||
              (is_power_of_two(p.cache_compressed_lines) &&
               p.cache_compressed_lines >= kLeastCompressedLines);
     }},
    {{"cache.line_bytes", "decode"},
     "must be 64 with decode = before, which fills lines of 4 x 4 decoded texels",
     [](const Parameters& p) { return p.decode != Decode::kBefore || p.cache_line_bytes == 64; }},
}};

inline std::span<const BuildRule<Parameters>> build_rules(const Parameters&) { return kBuildRules; }

inline const Parameters& check_build(const Parameters& parameters) {
  return spec::check_build("texture", parameters);
}

}  // namespace deburr::spec::texture
