// SPDX-License-Identifier: MIT
// Input and output of the posteriser: one pixel per beat.
#pragma once

#include <array>
#include <cstdint>

namespace deburr::spec::posteriser {

struct Tone {
  std::array<std::uint8_t, 3> colour{};  // R, G, B codes, U0.8 unorm
  bool last = false;                     // of the picture
  friend bool operator==(const Tone&, const Tone&) = default;
  template <class Self, class Visit>
  static constexpr void fields(Self& self, Visit&& visit) {
    visit("colour", self.colour, 8, "U0.8", "rgb");
    visit("last", self.last);
  }
};

}  // namespace deburr::spec::posteriser
