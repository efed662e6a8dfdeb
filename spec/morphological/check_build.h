// SPDX-License-Identifier: MIT
// Rules between the build parameters of the morphological engine. See
// docs/reference/morphological/index.md, "Configuration errors".
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>

#include "spec/check_build.h"
#include "spec/morphological/parameters.h"

namespace deburr::spec::morphological {

// Pixels per line of memory.
inline constexpr std::int32_t kLinePixels = kFrameLineBytes / kFramePixelBytes;

inline constexpr std::array<BuildRule<Parameters>, 10> kBuildRules = {{
    {{"window_rows"},
     "must be an even number of rows",
     [](const Parameters& p) { return p.window_rows % 2 == 0; }},
    {{"steps", "window_rows"},
     "must be at most window_rows / 2 - 2, the limit of the edge window",
     [](const Parameters& p) { return p.steps <= p.window_rows / 2 - 2; },
     [](const Parameters& p) {
       return "make it at most " + std::to_string(p.window_rows / 2 - 2) +
              ", or give window_rows of at least " + std::to_string(2 * p.steps + 4);
     }},
    {{"edges.threshold_mode", "edges.source"},
     "must be fixed with edges.source = predicated, which has its own thresholds",
     [](const Parameters& p) {
       return p.edge_source != EdgeSource::kPredicated || p.threshold_mode == ThresholdMode::kFixed;
     },
     [](const Parameters&) -> std::string { return "use edges.threshold_mode = fixed"; }},
    {{"edges.threshold_mode", "edges.source"},
     "must be fixed with edges.source = colour, which has no luma for a dynamic threshold",
     [](const Parameters& p) {
       return p.edge_source != EdgeSource::kColour || p.threshold_mode == ThresholdMode::kFixed;
     },
     [](const Parameters&) -> std::string {
       return "use edges.threshold_mode = fixed, or edges.source = luma";
     }},
    {{"area", "diagonals"},
     "must not be learned with diagonals, since the weights were learned without them",
     [](const Parameters& p) { return p.area != AreaSource::kLearned || !p.diagonals; }},
    {{"area", "round_corners"},
     "must not be learned with round_corners, since the weights were learned without it",
     [](const Parameters& p) { return p.area != AreaSource::kLearned || !p.round_corners; }},
    {{"diagonal_steps", "window_rows"},
     "must be at most window_rows / 2 - 1 with diagonals, the limit of the edge window",
     [](const Parameters& p) { return !p.diagonals || p.diagonal_steps <= p.window_rows / 2 - 1; },
     [](const Parameters& p) {
       return "make it at most " + std::to_string(p.window_rows / 2 - 1) +
              ", or give window_rows of at least " + std::to_string(2 * p.diagonal_steps + 2);
     }},
    {{"border", "ends"},
     "must be end with ends = gaps: only runs that end at crossings continue their search outside "
     "the frame",
     [](const Parameters& p) { return p.border != Border::kClamp || p.ends == Ends::kCrossings; },
     [](const Parameters&) -> std::string { return "use border = end, or ends = crossings"; }},
    {{"border", "area"},
     "must be end with area = analytic or learned, which do not limit a search outside the frame",
     [](const Parameters& p) {
       return p.border != Border::kClamp ||
              (p.area != AreaSource::kAnalytic && p.area != AreaSource::kLearned);
     },
     [](const Parameters&) -> std::string { return "use border = end, or area = table_full"; }},
    {{"line_pixels", "lanes", "storage"},
     "must be at least 17 with lanes = 4 and storage = memory: a line of memory fills eight banks "
     "of the pixel store, and 16 pixels are four words",
     [](const Parameters& p) {
       return p.line_pixels > kLinePixels || p.lanes != Lanes::kFour ||
              p.storage != Storage::kMemory;
     }},
}};

inline std::span<const BuildRule<Parameters>> build_rules(const Parameters&) { return kBuildRules; }

inline const Parameters& check_build(const Parameters& parameters) {
  return spec::check_build("morphological", parameters);
}

}  // namespace deburr::spec::morphological
