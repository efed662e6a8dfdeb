// SPDX-License-Identifier: MIT
// Measures how long each item (a beat, a fragment) stays inside an engine that preserves order, and
// counts the items inside. A measuring instrument without hardware.
//
// Items mostly come in consecutive cycles, so the probe stores (cycle - item number) and adds a
// mark only where that changes.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

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
      if (pushed_ == popped_) {
        oldest_ = offset;
        next_ = kNever;
      } else if (pushed_ == popped_ + 1) {
        next_ = entered_;
      }
      if (pushed_ - popped_ == marks_.size()) grow();
      mark(pushed_++) = {entered_, offset};
    }
    ++entered_;
  }
  // The oldest item leaves in this cycle. Returns the cycles since it entered.
  Cycle leaves(Cycle cycle) {
    DEBURR_CHECK(left_ != entered_, "an item left that never entered");
    if (left_ == next_) {
      oldest_ = mark(++popped_).offset;
      next_ = popped_ + 1 != pushed_ ? mark(popped_ + 1).first : kNever;
    }
    return cycle - (oldest_ + left_++);
  }
  std::uint64_t inside() const { return entered_ - left_; }
  void reset() {
    entered_ = left_ = 0;
    newest_ = next_ = kNever;
    pushed_ = popped_ = 0;
  }

 private:
  struct Mark {
    Cycle first;   // number of the first item with
    Cycle offset;  // this difference of cycle and item number
  };
  Mark& mark(std::uint64_t number) { return marks_[number & (marks_.size() - 1)]; }
  void grow() {
    std::vector<Mark> larger(2 * marks_.size());
    for (std::uint64_t i = popped_; i != pushed_; ++i) larger[i & (larger.size() - 1)] = mark(i);
    marks_ = std::move(larger);
  }

  Cycle entered_ = 0, left_ = 0;
  // A ring with a power-of-two size: marks of the items inside; the first mark may be older.
  std::vector<Mark> marks_ = std::vector<Mark>(64);
  std::uint64_t pushed_ = 0, popped_ = 0;
  Cycle newest_ = kNever;  // difference of the last mark
  Cycle oldest_ = 0;       // difference of the first mark
  Cycle next_ = kNever;    // first item of the second mark
};

}  // namespace deburr::rtl
