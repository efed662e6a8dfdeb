// SPDX-License-Identifier: MIT
#include "tool/engines/morphological/morphological_draws.h"

#include <string>

#include "tb/run/parameter_set.h"

namespace deburr::tool {
namespace {

// A standalone engine only accesses memory for the frame that it delays.
bool traces_something(const tb::ParameterSet& set) {
  return !set.find("frame.count") || set.find("morphological.storage")->text() == "memory" ||
         set.find("run.line_trace")->text() == "none";
}

}  // namespace

RandomDraws morphological_draws() {
  RandomDraws all;
  all.draws = {{"frame.source", name_of_scene},
               {"frame.width", side_of_picture},
               {"frame.height", side_of_picture},
               {"frame.count", evenly<2, 3>},
               {"morphological.window_rows",
                [](tb::Random& r) { return std::to_string(2 * by_magnitude(r, 5, 129)); }},
               {"morphological.search_columns", magnitude<4, 2048>},
               {"morphological.line_pixels", evenly<96, 1100>},
               {"morphological.memory.outstanding", magnitude<4, 256>}};
  // Files; and references and sequences, which do not exercise the hardware.
  all.fixed = {"frame.depth",    "frame.reference",         "frame.mask",
               "frame.weights",  "frame.reference_samples", "sequence.frames",
               "sequence.motion"};
  all.given = {{"frame.reference_samples", "0"}};
  all.wanted = {traces_something};
  return all;
}

}  // namespace deburr::tool
