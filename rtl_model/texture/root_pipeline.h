// SPDX-License-Identifier: MIT
// Two integer square roots in parallel: sqrt(s^2 + t^2) for the x and the y side of a footprint.
//
// Position  Inside the FootprintUnit when `footprint = exact`; stages and cost in its datasheet.
// Stalls    The whole pipeline stalls while its last stage cannot leave.
// Method    Digit by digit: shifts in two bits of the radicand, tries to subtract (root << 2 | 1),
//           and appends the digit. No multiplier.
#pragma once

#include <cstdint>

#include "rtl_model/fabric/pipe.h"
#include "rtl_model/texture/tokens.h"

namespace deburr::rtl::texture {

class RootPipeline {
 public:
  static constexpr int kDigitStages = 16;
  static constexpr int kStages = 2 + kDigitStages + 1;
  // Bits of the rest, and of it, the root and what is left of the radicand: the rest grows by four
  // bits per stage, so the means over the stages are less.
  static constexpr std::uint32_t kRest = 34, kMeanRest = 26, kMeanRegisters = 71;

  bool empty() const { return pipe_.empty(); }
  // True if a token leaves with the next step().
  bool leaving() const { return pipe_.leaves(); }

  // Advances by one cycle. `next`: token that enters, or nullptr. Returns true if *result was
  // written. If leaving(), call only when the result can be delivered.
  bool step(const DerivativeToken* next, FootprintToken* result);
  void reset() { pipe_.reset(); }

  // All digit stages at once: floor(sqrt(radicand)).
  static std::uint32_t root(std::uint64_t radicand);

 private:
  struct Root {
    std::uint64_t radicand;   // U63, bits not shifted in yet, at the top; first s^2
    std::uint64_t remainder;  // U34; first t^2
    std::uint32_t root;       // U32, digits found so far
  };
  struct Entry {
    DerivativeToken token;
    Root x, y;
    bool
        x_is_major;  // compares the sums, in parallel with the first digits: the roots may be equal
  };
  static Root squares(std::uint32_t s, std::uint32_t t);
  static void sum(Root& root);
  static void two_digits(Root& root);

  Pipe<Entry, kStages> pipe_;
};

}  // namespace deburr::rtl::texture
