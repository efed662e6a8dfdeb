// SPDX-License-Identifier: MIT
// How far a run continues as a digital line: tries its step again on the neighbouring rows.
//
// Between RunExtractor and LineUnit; docs/reference/morphological/algorithm.md, "Extension". Paper
// 000, section 2.2, corrected (docs/measurements/morphological_quality.md, "What the paper
// prints, and what is built"); the lockstep and the trim are ours. Positions count from the start
// of the run; integers only.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "golden/morphological/planes.h"
#include "spec/morphological/packets.h"
#include "spec/morphological/parameters.h"

namespace deburr::golden::morphological {

// What a side found, before it was trimmed: the first step that differs from L names it.
enum class Outcome : std::uint8_t {
  kUntried,  // not a clean Z within the reach, or no predictor
  kNone,     // tried, no step taken
  kExact,    // every step is L
  kEarly,    // L' = L - 1
  kLate      // L' = L + 1
};
// Why a side ended.
enum class SideEnd : std::uint8_t {
  kUntried,
  kSteps,         // all N steps taken, or tried
  kNoHit,         // no candidate hits: the line is lost
  kReach,         // no candidate hits, and the largest lies beyond the reach
  kInconsistent,  // safe: no line fits all corners with the one hit (or both)
  kCurve          // safe: both sides hit, with different steps that are not L
};

struct Extension {
  int steps = 0;  // kept
  int end = 0;    // position of the outermost corner: L or 0 if no step was taken
  std::array<std::int16_t, spec::morphological::kMaxSteps>
      corner{};  // positions of the corners taken
  Outcome outcome = Outcome::kUntried;
  SideEnd why = SideEnd::kUntried;
  std::span<const std::int16_t> corners() const {
    return {corner.data(), static_cast<std::size_t>(steps)};
  }
};

struct Prediction {
  Extension left, right;
  int probes = 0;      // corners tested
  int iterations = 0;  // values of k for which a trial was made
};

// Corners (i, X) that one digital line must have produced: the pixels a step that the pairs i < j
// allow lie strictly between max (X_j - X_i - 1) / (j - i) and min (X_j - X_i + 1) / (j - i).
class ConsistentSet {
 public:
  struct Corner {
    std::int32_t index, position;
  };
  explicit ConsistentSet(int length);  // {(0, 0), (1, length)}
  void add(Corner corner);
  bool consistent() const { return bounds_.low < bounds_.high; }
  // Whether the set would be, with one corner or two more.
  bool consistent_with(Corner corner) const;
  bool consistent_with(Corner a, Corner b) const;

 private:
  struct Ratio {
    std::int32_t numerator, denominator;  // at most 2^13 and 33
    bool operator<(const Ratio& o) const {
      return numerator * o.denominator < o.numerator * denominator;
    }
  };
  struct Bounds {
    Ratio low, high;
    void tighten(Corner a, Corner b);
  };
  Bounds bounds_with(Corner corner) const;

  std::array<Corner, spec::morphological::kMaxCorners> corners_;
  std::size_t count_ = 0;
  Bounds bounds_;
};

// Extends `run` (of edges.axis). Without extension (see Outcome::kUntried) both ends are the run's
// own.
Prediction predict(const spec::morphological::Parameters& parameters, const AxisEdges& edges,
                   const spec::morphological::RunDescriptor& run);

}  // namespace deburr::golden::morphological
