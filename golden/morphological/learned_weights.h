// SPDX-License-Identifier: MIT
// Learned weights: for edges whose run does not show where the line is. Each end of the run is
// classified, and three small tables give the weight.
//
// Replaces line.h and area.h after the predictor; docs/reference/morphological/learned_weights.md,
// "Descriptors" and "Indices". Source: this project. reachable_entries() lists every entry that a
// descriptor can name.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "golden/morphological/area.h"
#include "golden/morphological/planes.h"
#include "golden/morphological/run_coverage.h"
#include "spec/morphological/learned_weights.h"
#include "spec/morphological/packets.h"
#include "spec/morphological/parameters.h"
#include "spec/morphological/tables.h"

namespace deburr::golden::morphological {

// Contents of the ROMs, S3.4.
struct WeightTables {
  std::array<std::int8_t, 1024> of_codes = spec::morphological::kWeightsOfCodes;  // A
  std::array<std::int8_t, 640> of_near = spec::morphological::kWeightsOfNear;     // B
  std::array<std::int8_t, 640> of_far = spec::morphological::kWeightsOfFar;       // C
};

// a, b and c of a weight.
struct WeightIndices {
  std::uint16_t codes = 0, near = 0, far = 0;
  friend bool operator==(const WeightIndices&, const WeightIndices&) = default;
};

// Class 0..8 of the crossing at an end. `room`: range - L, the pixels up to the search range.
int crossing_class(const AxisEdges& edges, const spec::morphological::RunDescriptor& run,
                   bool at_end, int room);

// For both pixels of an edge in the gap between head and tail.
inline constexpr WeightIndices kGapIndices = {63, 31, 31};

// The ends of a learned descriptor, seen from one side.
class LearnedEnds {
 public:
  LearnedEnds(const spec::morphological::LineDescriptor& descriptor, spec::morphological::Side own);
  WeightIndices of_pixel(int k) const;

 private:
  struct End {
    int code = 0, appearance = 0;  // `appearance` is E
    bool seen = false;
  };
  End start_, end_;
  int length_ = 0, length_class_ = 0;
};

inline int learned_weight(const WeightTables& tables, const WeightIndices& i) {
  const int z = tables.of_codes[i.codes] + tables.of_near[i.near] + tables.of_far[i.far];
  const auto entry = static_cast<std::uint8_t>(std::clamp(z, -128, 127) + 128);
  return spec::morphological::kWeightOfSum[entry];
}

// Coverage of the table entries, bins `A/<index>`, `B/<index>`, `C/<index>` of the reachable ones,
// and of the classes, `class/<axis>/<start or end>/<class>`.
class LearnedCoverage {
 public:
  void count_descriptor(const spec::morphological::LineDescriptor& descriptor);
  void count_weight(const WeightIndices& i) {
    ++of_codes_[i.codes];
    ++of_near_[i.near];
    ++of_far_[i.far];
  }
  // Always in the same order.
  std::vector<CoverageBin> bins() const;

 private:
  std::array<std::uint64_t, 1024> of_codes_{};
  std::array<std::uint64_t, 640> of_near_{}, of_far_{};
  std::array<std::array<std::array<std::uint64_t, 9>, 2>, 2> classes_{};
};

// Flags of the entries that a descriptor can name.
struct ReachableEntries {
  std::array<bool, 1024> of_codes{};
  std::array<bool, 640> of_near{}, of_far{};
};
const ReachableEntries& reachable_entries();

}  // namespace deburr::golden::morphological
