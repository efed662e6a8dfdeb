// SPDX-License-Identifier: MIT
// The straight line through a run and its extensions, as the two reciprocals that the areas need.
//
// Between EndpointPredictor and AreaUnit; docs/reference/morphological/algorithm.md, "Line through
// a run". One rounded division per descriptor. Source: paper 000 (chord), this project (fit).
#pragma once

#include <cstdint>

#include "golden/morphological/predictor.h"
#include "spec/morphological/packets.h"
#include "spec/morphological/parameters.h"

namespace deburr::golden::morphological {

spec::morphological::LineDescriptor line_through(const spec::morphological::Parameters& parameters,
                                                 const spec::morphological::RunDescriptor& run,
                                                 const Prediction& prediction);

// t(X), S.24: height of the line above the edge at position X, in steps.
constexpr std::int64_t height(const spec::morphological::LineDescriptor& line, int position) {
  const std::int64_t numerator = std::int64_t{line.scale} * position - line.offset;
  return numerator * line.slope +
         std::int64_t{line.shift} * (1 << (spec::morphological::kRecipFractionBits - 1));
}

}  // namespace deburr::golden::morphological
