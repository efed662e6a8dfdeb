// SPDX-License-Identifier: MIT
// History of one pixel in the geometric engine: lines that cross it, candidates with depth and
// test, weights, colour, with golden model and hardware side by side (docs/reference/run.md, "One
// pixel").
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "golden/geometric/geometric_golden.h"
#include "rtl_model/fabric/clocked.h"
#include "spec/geometric/packets.h"
#include "tb/engines/geometric/geometric_stimuli.h"
#include "tb/run/pixel_history.h"

namespace deburr::tb {

class GeometricHistory {
 public:
  explicit GeometricHistory(const PixelAddress& pixel) : pixel_(pixel) {}

  // Starts the next frame and discards observations of the previous one.
  void begin();
  void see(const spec::geometric::LineRecord& line, rtl::Cycle cycle);
  void see(const spec::geometric::Candidate& candidate, rtl::Cycle cycle);
  void see(const spec::geometric::BlockRecord& block, rtl::Cycle cycle);
  // `golden`: null if disabled. `after`: the frame in memory. `ended`: the frame is complete, so
  // nothing more will be observed.
  PixelHistory history(const geometric::Frame& frame, const Image& after, bool ended,
                       const golden::geometric::GeometricGolden* golden) const;

 private:
  template <class T>
  using Seen = std::vector<std::pair<T, rtl::Cycle>>;

  bool passes(const spec::geometric::LineRecord& line) const;
  bool is_here(const spec::geometric::Candidate& c) const {
    return c.x == pixel_.x && c.y == pixel_.y;
  }
  bool is_here(const spec::geometric::BlockRecord& b) const {
    return b.x == pixel_.x / 4 && b.y == pixel_.y / 4;
  }

  PixelAddress pixel_;
  Seen<spec::geometric::LineRecord> lines_;
  Seen<spec::geometric::Candidate> candidates_;
  Seen<spec::geometric::BlockRecord> blocks_;  // one, if the engine is correct
};

}  // namespace deburr::tb
