// SPDX-License-Identifier: MIT
// Measures how long each item (a beat, a fragment) is inside an engine that keeps their order, and
// knows how many are inside. A measuring instrument: no hardware.
//
// Items come in consecutive clocks most of the time, so it keeps (clock - number of the item) and
// only notes where that changes.
#pragma once

#include <cstdint>
#include <deque>

#include "rtl_model/fabric/clocked.h"
#include "spec/error.h"

namespace deburr::rtl {

class LatencyProbe {
 public:
  // The next item enters in this cycle.
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
  // The oldest item inside leaves in this cycle: clocks since it entered.
  Cycle leaves(Cycle cycle) {
    DEBURR_CHECK(left_ != entered_, "something leaves that never entered");
    if (left_ == next_) {
      marks_.pop_front();
      oldest_ = marks_.front().offset;
      next_ = marks_.size() > 1 ? marks_[1].first : kNever;
    }
    return cycle - (oldest_ + left_++);
  }
  std::uint64_t inside() const { return entered_ - left_; }
  void reset() {
    entered_ = left_ = 0;
    newest_ = next_ = kNever;
    marks_.clear();
  }

 private:
  struct Mark {
    Cycle first;   // number of the first item with
    Cycle offset;  // this difference of clock and number
  };
  Cycle entered_ = 0, left_ = 0;
  std::deque<Mark> marks_;  // of the items inside; the first one may be older
  Cycle newest_ = kNever;   // difference of the last mark
  Cycle oldest_ = 0;        // difference of the first mark
  Cycle next_ = kNever;     // first item of the second mark
};

}  // namespace deburr::rtl
