// SPDX-License-Identifier: MIT
// What a frame teaches about learned weights: for each pixel beside an edge its colours, its
// reference, and where its four weights come from.
//
// From the golden model's own records, so that the features are the engine's
// (docs/reference/morphological/learned_weights.md, "Indices").
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "golden/morphological/learned_weights.h"
#include "tb/scene/image.h"

namespace deburr::studies::training {

// A frame without anti-aliasing, and what it should have been.
struct ReferenceFrame {
  std::string name;   // unique
  std::string group;  // frames of one mesh or scene are trained on or checked, never both
  tb::Image frame, reference;
  tb::DepthImage depth;  // empty: no silhouettes
};

enum class Source : std::uint8_t {
  kNone,     // no edge
  kLine,     // an extended record: the weight is what it is
  kLearned,  // the tables
};

// Neighbours in the order up, down, left, right.
struct WeightSample {
  std::array<golden::morphological::WeightIndices, 4> indices{};
  std::array<Source, 4> source{};
  std::array<std::uint8_t, 4> weight{};  // U0.8, of kLine
  std::int8_t longer = 0;  // 1: the pair up and down has the longer line, -1 the other
  std::array<std::uint8_t, 3> own{}, reference{};
  std::array<std::array<std::uint8_t, 3>, 4> neighbour{};
};

std::vector<WeightSample> samples_of(const ReferenceFrame& frame);

}  // namespace deburr::studies::training
