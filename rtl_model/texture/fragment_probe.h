// SPDX-License-Identifier: MIT
// Measures the latency of each fragment, from the clock in which its quad is taken to the clock in
// which its colour can be taken, and knows how many fragments are inside.
//
// An instrument, not hardware: it costs nothing and changes nothing. Fragments leave in the order
// in which they enter, so a queue of times is enough.
#pragma once

#include <bit>
#include <cstdint>
#include <vector>

#include "rtl_model/fabric/clocked.h"
#include "spec/error.h"

namespace deburr::rtl::texture {

class FragmentProbe {
 public:
  // `capacity`: at least as many fragments as the unit can hold.
  explicit FragmentProbe(std::uint32_t capacity)
      : taken_(std::bit_ceil(capacity)), mask_(taken_.size() - 1) {}

  void entered(Cycle cycle) {
    DEBURR_CHECK(in_flight() <= mask_, "more fragments inside than the unit can hold");
    taken_[entered_++ & mask_] = cycle;
  }
  // The colour of the oldest fragment can be taken in `cycle`; gives its latency.
  Cycle left(Cycle cycle) {
    DEBURR_CHECK(left_ != entered_, "a colour that no fragment asked for");
    return cycle - taken_[left_++ & mask_];
  }
  std::uint64_t in_flight() const { return entered_ - left_; }
  void reset() { entered_ = left_ = 0; }

 private:
  std::vector<Cycle> taken_;
  std::uint64_t mask_;
  std::uint64_t entered_ = 0, left_ = 0;
};

}  // namespace deburr::rtl::texture
