// SPDX-License-Identifier: MIT
// Measures how long each beat is inside. A measuring instrument: no hardware.
//
// Beats come in consecutive clocks most of the time, so it keeps (clock - number of the beat) and
// only notes where that changes.
#pragma once

#include <cstdint>
#include <deque>

#include "rtl_model/fabric/clocked.h"

namespace deburr::rtl::morphological {

class LatencyProbe {
 public:
  // The next beat is popped in this cycle.
  void enters(Cycle cycle) {
    const Cycle offset = cycle - entered_;
    if (marks_.empty() || marks_.back().offset != offset) marks_.push_back({entered_, offset});
    ++entered_;
  }
  // The oldest beat inside is pushed in this cycle: clocks since it was popped.
  Cycle leaves(Cycle cycle) {
    if (marks_.size() > 1 && marks_[1].first <= left_) marks_.pop_front();
    return cycle - (marks_.front().offset + left_++);
  }
  Cycle inside() const { return entered_ - left_; }
  void reset() {
    entered_ = left_ = 0;
    marks_.clear();
  }

 private:
  struct Mark {
    Cycle first;   // number of the first beat with
    Cycle offset;  // this difference of clock and number
  };
  Cycle entered_ = 0, left_ = 0;
  std::deque<Mark> marks_;
};

}  // namespace deburr::rtl::morphological
