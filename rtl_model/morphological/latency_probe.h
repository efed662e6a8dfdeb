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
    if (offset != newest_) {
      newest_ = offset;
      if (marks_.empty()) oldest_ = offset, next_ = kNever;
      marks_.push_back({entered_, offset});
      if (marks_.size() == 2) next_ = entered_;
    }
    ++entered_;
  }
  // The oldest beat inside is pushed in this cycle: clocks since it was popped.
  Cycle leaves(Cycle cycle) {
    if (left_ == next_) {
      marks_.pop_front();
      oldest_ = marks_.front().offset;
      next_ = marks_.size() > 1 ? marks_[1].first : kNever;
    }
    return cycle - (oldest_ + left_++);
  }
  Cycle inside() const { return entered_ - left_; }
  void reset() {
    entered_ = left_ = 0;
    newest_ = next_ = kNever;
    marks_.clear();
  }

 private:
  struct Mark {
    Cycle first;   // number of the first beat with
    Cycle offset;  // this difference of clock and number
  };
  Cycle entered_ = 0, left_ = 0;
  std::deque<Mark> marks_;  // of the beats inside; the first one may be older
  Cycle newest_ = kNever;   // difference of the last mark
  Cycle oldest_ = 0;        // difference of the first mark
  Cycle next_ = kNever;     // first beat of the second mark
};

}  // namespace deburr::rtl::morphological
