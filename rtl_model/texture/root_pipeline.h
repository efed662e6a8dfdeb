// SPDX-License-Identifier: MIT
// Two integer square roots side by side, sqrt(s^2 + t^2) for the x and the y side of a footprint.
//
// Where: inside the FootprintUnit when `footprint = exact`; stages and cost in its datasheet. The
// whole pipeline holds still while its last stage cannot leave. Method: digit by digit. A stage
// brings down two bits of the radicand at a time, tries to subtract (root << 2 | 1), and appends
// the digit: no multiplier.
#pragma once

#include <cstdint>

#include "rtl_model/fabric/pipe.h"
#include "rtl_model/texture/tokens.h"

namespace deburr::rtl::texture {

class RootPipeline {
 public:
  static constexpr int kDigitStages = 16;
  static constexpr int kStages = 2 + kDigitStages + 1;

  bool empty() const { return pipe_.empty(); }
  // A token leaves with the next step.
  bool leaving() const { return pipe_.leaves(); }

  // One clock. `next`: what enters, or nullptr; true if *result was written. With leaving(), call
  // only if the result can be delivered.
  bool step(const DerivativeToken* next, FootprintToken* result);
  void reset() { pipe_.reset(); }

  // The digit stages at once: floor(sqrt(radicand)).
  static std::uint32_t root(std::uint64_t radicand);

 private:
  struct Root {
    std::uint64_t radicand;   // U63, what has not been brought down yet, at the top; first s^2
    std::uint64_t remainder;  // U34; first t^2
    std::uint32_t root;       // U32, digits found
  };
  struct Entry {
    DerivativeToken token;
    Root x, y;
    bool x_is_major;  // found beside the first digits, of the sums: roots may be equal
  };
  static Root squares(std::uint32_t s, std::uint32_t t);
  static void sum(Root& root);
  static void two_digits(Root& root);

  Pipe<Entry, kStages> pipe_;
};

}  // namespace deburr::rtl::texture
