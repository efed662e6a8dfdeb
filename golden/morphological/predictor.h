// SPDX-License-Identifier: MIT
// Extends a run as a digital line: repeats its step on the neighbouring rows.
//
// Between RunExtractor and LineUnit; docs/reference/morphological/algorithm.md, "Extension".
// Source: paper 000, section 2.2, corrected (docs/measurements/morphological_quality.md, "What the
// paper prints, and what is built"); lockstep and trim are from this project. Positions count from
// the start of the run; integers only.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "golden/morphological/planes.h"
#include "spec/morphological/packets.h"
#include "spec/morphological/parameters.h"

namespace deburr::golden::morphological {

// Result of a side before the trim: the first step that differs from L.
enum class Outcome : std::uint8_t {
  kUntried,  // not a clean Z within the search range, or no predictor
  kNone,     // tried; no step taken
  kExact,    // every step is L
  kEarly,    // L' = L - 1
  kLate      // L' = L + 1
};
// Why the extension of a side ended.
enum class SideEnd : std::uint8_t {
  kUntried,
  kSteps,         // all N steps taken or tried
  kNoHit,         // no candidate hits: the line is lost
  kReach,         // no candidate hits, and the largest exceeds the search range
  kInconsistent,  // safe: no line fits all corners with this hit, or with both hits
  kCurve          // safe: both sides hit, with different steps other than L
};

struct Extension {
  int steps = 0;  // kept
  int end = 0;    // position of the outermost corner: L or 0 without steps
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
  int iterations = 0;  // number of values of k with a trial
};

// Corners (i, X) that one digital line can have produced: its pixels per step lie strictly between
// max (X_j - X_i - 1) / (j - i) and min (X_j - X_i + 1) / (j - i) over the pairs i < j.
class ConsistentSet {
 public:
  struct Corner {
    std::int32_t index, position;
  };
  explicit ConsistentSet(int length);  // {(0, 0), (1, length)}
  void add(Corner corner);
  bool consistent() const { return bounds_.low < bounds_.high; }
  // Whether the set stays consistent with one or two more corners.
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

// Extends `run` along edges.axis. Without an extension (Outcome::kUntried) both ends are those of
// the run.
Prediction predict(const spec::morphological::Parameters& parameters, const AxisEdges& edges,
                   const spec::morphological::RunDescriptor& run);

}  // namespace deburr::golden::morphological
