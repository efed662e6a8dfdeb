// SPDX-License-Identifier: MIT
// Rules between the build parameters of the geometric engine.
#pragma once

#include <array>
#include <span>
#include <string>

#include "spec/check_build.h"
#include "spec/geometric/parameters.h"
#include "spec/geometric/records.h"

namespace deburr::spec::geometric {

inline constexpr std::array<BuildRule<Parameters>, 7> kBuildRules = {{
    {{"reciprocal_table", "pipelined"},
     "must be 0 with pipelined dividers: they accept a line in every cycle, so a table has no "
     "effect",
     [](const Parameters& p) { return !p.pipelined || p.reciprocal_table == 0; },
     [](const Parameters&) -> std::string { return "use 0, or pipelined = false"; }},
    {{"face_limit"},
     "must be a multiple of 512, the facing bits in a line of memory",
     [](const Parameters& p) { return p.face_limit % kFacesInLine == 0; }},
    {{"fills"},
     "must be at least 8 lines, which one group of pixels may request; 0: derived from the memory "
     "latency",
     [](const Parameters& p) { return p.fills == 0 || p.fills >= kMinFills; }},
    {{"fills", "memory.outstanding"},
     "must be at most memory.outstanding, since every line in flight needs a transaction",
     [](const Parameters& p) { return p.fills <= p.memory_outstanding; },
     [](const Parameters&) -> std::string { return "raise that, or lower fills"; }},
    {{"resolve_lines"},
     "must be at least 16 lines: half for colours and half for weights, and the FIFOs between have "
     "a quarter; 0: derived from the memory latency",
     [](const Parameters& p) {
       return p.resolve_lines == 0 || p.resolve_lines >= kMinResolveLines;
     }},
    {{"copy_lines"},
     "must be at least 2 lines, since one is read while one is written; 0: derived from the memory "
     "latency",
     [](const Parameters& p) { return p.copy_lines == 0 || p.copy_lines >= kMinCopyLines; }},
    {{"coarse_lines", "depth_test"},
     "must be none with depth_test = off, which reads no depth",
     [](const Parameters& p) {
       return p.coarse_lines == CoarseLines::kNone || p.depth_test != DepthTest::kOff;
     },
     [](const Parameters&) -> std::string { return "use none, or another depth_test"; }},
}};

inline std::span<const BuildRule<Parameters>> build_rules(const Parameters&) { return kBuildRules; }

inline const Parameters& check_build(const Parameters& parameters) {
  return spec::check_build("geometric", parameters);
}

}  // namespace deburr::spec::geometric
