// SPDX-License-Identifier: MIT
// Everything that happens to one pixel in the geometric engine: lines that pass it, candidates with
// depth and test, weights, colour; golden beside the hardware (docs/reference/run.md, "One pixel").
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

  // The next frame; what was seen of the one before is forgotten.
  void begin();
  void see(const spec::geometric::LineRecord& line, rtl::Cycle cycle);
  void see(const spec::geometric::Candidate& candidate, rtl::Cycle cycle);
  void see(const spec::geometric::BlockRecord& block, rtl::Cycle cycle);
  // `golden`: null without one. `after`: the frame as it is in memory. `ended`: all of the frame
  // was done, so what was not seen does not come.
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
  Seen<spec::geometric::BlockRecord> blocks_;  // one, of an engine that is right
};

}  // namespace deburr::tb
