// SPDX-License-Identifier: MIT
// Two integer square roots side by side, sqrt(s^2 + t^2) for the x and the y side of a footprint,
// in 16 stages of two root bits each.
//
// Where: inside the FootprintUnit when `footprint = exact`. 16 stages: the last one writes the
// output link, so 15 sets of registers. Initiation interval 1; the whole pipeline holds still while
// its last stage cannot leave. Formats: U15.16 in; squares and sum exact (U31.32); root U16.16,
// truncated. Method: digit by digit. A stage brings down two bits of the radicand at a time, tries
// to subtract (root << 2 | 1), and appends the digit: no multiplier. Cost a stage and root: two
// 34-bit subtractors in a row.
#pragma once

#include <array>
#include <cstdint>

#include "rtl_model/texture/tokens.h"

namespace deburr::rtl::texture {

class RootPipeline {
 public:
  static constexpr int kStages = 16;
  static constexpr int kRegisters = kStages - 1;

  bool empty() const { return occupied_ == 0; }
  // A token is in the last set of registers and so leaves with the next step.
  bool leaving() const { return (occupied_ >> (kRegisters - 1)) & 1; }

  // One clock. `next`: what enters, or nullptr; true if *result was written. With leaving(), call
  // only if the result can be delivered.
  bool step(const DerivativeToken* next, FootprintToken* result);
  void reset() { occupied_ = 0; }

 private:
  struct Root {
    std::uint64_t radicand;   // U63, what has not been brought down yet, at the top
    std::uint64_t remainder;  // U34
    std::uint32_t root;       // U32, digits found
  };
  struct Entry {
    DerivativeToken token;
    Root x, y;
  };
  static Root start(std::uint32_t s, std::uint32_t t);
  static void two_digits(Root& root);
  Entry& entry(int stage) { return entries_[(head_ + static_cast<unsigned>(stage)) & 15]; }

  // The registers of stage k are entries_[(head_ + k) mod 16]: a step renames them by moving head_,
  // instead of copying every token.
  std::array<Entry, 16> entries_{};
  unsigned head_ = 0;
  std::uint32_t occupied_ = 0;  // bit k: the registers after stage k + 1 hold a token
};

}  // namespace deburr::rtl::texture
