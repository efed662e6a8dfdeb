// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <string_view>

#include "spec/morphological/parameters.h"
#include "tb/harness/other_configuration.h"

namespace deburr::tb {

// The same hardware with a different configuration as reset values, which software must overwrite
// completely. Parameters that select blocks and memories are unchanged.
inline spec::morphological::Parameters unprogrammed(spec::morphological::Parameters p) {
  using spec::morphological::EdgeSource, spec::morphological::ThresholdMode;
  constexpr std::array<std::string_view, 13> kBuilt = {
      "edges.source", "edges.threshold_mode", "ends",          "border",         "contiguous",
      "area",         "area_values",          "diagonals",     "diagonal_steps", "round_corners",
      "text_guard",   "window_rows",          "search_columns"};
  OtherConfiguration other(kBuilt);
  describe(static_cast<spec::morphological::Configuration&>(p), other);
  // Luma and colour share their hardware, as do depth and predicated. Only the first of each pair
  // has a dynamic threshold.
  const bool fixed = p.threshold_mode == ThresholdMode::kFixed;
  switch (p.edge_source) {
    case EdgeSource::kLuma:
      p.edge_source = EdgeSource::kColour;
      break;
    case EdgeSource::kColour:
      p.edge_source = EdgeSource::kLuma;
      break;
    case EdgeSource::kDepth:
      p.edge_source = EdgeSource::kPredicated;
      break;
    case EdgeSource::kPredicated:
      p.edge_source = EdgeSource::kDepth;
      break;
  }
  const bool dynamic_goes =
      p.edge_source == EdgeSource::kLuma || p.edge_source == EdgeSource::kDepth;
  p.threshold_mode = fixed && dynamic_goes ? ThresholdMode::kDynamic : ThresholdMode::kFixed;
  return p;
}

}  // namespace deburr::tb
