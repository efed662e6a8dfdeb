// SPDX-License-Identifier: MIT
// Training samples for learned weights: for each pixel next to an edge its colours, its reference,
// and the sources of its four weights.
//
// The samples are taken from the golden model's records, so that the features are the engine's
// (docs/reference/morphological/learned_weights.md, "Indices").
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "golden/morphological/learned_weights.h"
#include "tb/scene/image.h"

namespace deburr::studies::training {

// A frame without anti-aliasing, and its reference.
struct ReferenceFrame {
  std::string name;   // unique
  std::string group;  // all frames of one mesh or scene are either trained on or held out
  tb::Image frame, reference;
  tb::DepthImage depth;  // empty: no silhouettes
};

enum class Source : std::uint8_t {
  kNone,     // no edge
  kLine,     // an extended run descriptor: the weight is fixed
  kLearned,  // from the tables
};

// Neighbours in the order up, down, left, right.
struct WeightSample {
  std::array<golden::morphological::WeightIndices, 4> indices{};
  std::array<Source, 4> source{};
  std::array<std::uint8_t, 4> weight{};  // U0.8, for kLine
  std::int8_t longer = 0;  // 1: the vertical pair has the longer line; -1: the horizontal pair
  std::array<std::uint8_t, 3> own{}, reference{};
  std::array<std::array<std::uint8_t, 3>, 4> neighbour{};
};

std::vector<WeightSample> samples_of(const ReferenceFrame& frame);

}  // namespace deburr::studies::training
