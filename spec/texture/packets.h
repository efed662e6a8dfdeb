// SPDX-License-Identifier: MIT
// Packets at the ports of the texture unit: quads of fragments in, colours out. Each lists its
// fields with their widths.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

namespace deburr::spec::texture {

// Texture coordinates are S7.24: 24 fraction bits, saturated to [-128, 128).
inline constexpr int kCoordinateFractionBits = 24;
inline constexpr std::int32_t kCoordinateOne = 1 << kCoordinateFractionBits;

// Four adjacent pixels: lane 0 = (x, y), 1 = (x+1, y), 2 = (x, y+1), 3 = (x+1, y+1), x and y even.
// All four lanes have coordinates, since the derivatives are differences between lanes. The
// coordinates of lanes that are not covered are those of the extrapolated primitive. Only lanes in
// `coverage` give a colour.
struct Quad {
  std::uint32_t tag = 0;            // returned with each colour; not used by the unit
  std::uint16_t x = 0, y = 0;       // pixel of lane 0, only for traces and error texts
  std::uint8_t texture = 0;         // descriptor handle, 0..15
  std::uint8_t coverage = 0xF;      // bit i: lane i gives a colour
  std::uint8_t clamped = 0;         // bit i: lane i had a NaN, infinite or out-of-range coordinate
  std::array<std::int32_t, 4> s{};  // S7.24
  std::array<std::int32_t, 4> t{};  // S7.24
  friend bool operator==(const Quad&, const Quad&) = default;

  template <class Self, class Visit>
  static constexpr void fields(Self& self, Visit&& visit) {
    visit("tag", self.tag, 32);
    visit("x", self.x, 16);
    visit("y", self.y, 16);
    visit("texture", self.texture, 8);
    visit("coverage", self.coverage, 4);
    visit("clamped", self.clamped, 4);
    visit("s", self.s, 32, "S7.24");
    visit("t", self.t, 32, "S7.24");
  }
};

// A filtered colour. `last` marks the last covered lane of its quad.
struct Colour {
  std::uint32_t tag = 0;
  std::uint8_t lane = 0;
  bool last = false;
  std::array<std::uint8_t, 4> rgba{};  // U0.8 unorm each
  friend bool operator==(const Colour&, const Colour&) = default;

  template <class Self, class Visit>
  static constexpr void fields(Self& self, Visit&& visit) {
    visit("tag", self.tag, 32);
    visit("lane", self.lane, 2);
    visit("last", self.last);
    visit("rgba", self.rgba, 8, "U0.8", "rgba");
  }
};

// The colours that the unit delivers in one cycle, in the order of their fragments. There is at
// least one, and at most as many as the requests per cycle (docs/reference/texture/width.md).
struct ColourGroup {
  std::uint8_t count = 1;
  std::array<Colour, 4> colour{};
  const Colour* begin() const { return colour.data(); }
  const Colour* end() const { return colour.data() + count; }
  friend bool operator==(const ColourGroup& a, const ColourGroup& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end());
  }

  template <class Self, class Visit>
  static constexpr void fields(Self& self, Visit&& visit) {
    visit("count", self.count, 3);
    visit("colour", self.colour);
  }
};

}  // namespace deburr::spec::texture
