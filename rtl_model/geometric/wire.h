// SPDX-License-Identifier: MIT
// A register of one unit that others look at: what is set in clock t is seen from t + 1 on,
// whichever unit is ticked first. Latency 1, never stalls. Cost: the bits of T.
#pragma once

#include "rtl_model/fabric/clocked.h"

namespace deburr::rtl::geometric {

template <class T>
class Wire {
 public:
  explicit Wire(T value) : reset_(value), before_(value), value_(value) {}
  T get(Cycle cycle) const { return cycle > changed_ ? value_ : before_; }
  void set(Cycle cycle, T value) {
    if (cycle > changed_) before_ = value_;
    value_ = value;
    changed_ = cycle;
  }
  void reset() {
    before_ = value_ = reset_;
    changed_ = 0;
  }

 private:
  T reset_, before_, value_;
  Cycle changed_ = 0;
};

// What the frame under way is doing.
enum class Phase : unsigned char { kIdle, kBegin, kEdges, kResolve };

}  // namespace deburr::rtl::geometric
