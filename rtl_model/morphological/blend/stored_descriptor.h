// SPDX-License-Identifier: MIT
// A descriptor as stored in the DescriptorStore, for the weight units.
#pragma once

#include <cstdint>

#include "spec/morphological/packets.h"

namespace deburr::rtl::morphological {

struct StoredDescriptor {
  std::int64_t t = 0;         // S4.24, at the first edge
  std::uint32_t growth = 0;   // U2.24, per pixel
  std::uint32_t inverse = 0;  // U12.12
  std::uint16_t span = 0;     // U12
  spec::morphological::Side before{}, after{};
  // With a table: positions of the line's ends, S13, in the bits of growth and inverse.
  void set_ends(std::int32_t first, std::int32_t last) {
    growth = static_cast<std::uint32_t>(first);
    inverse = static_cast<std::uint32_t>(last);
  }
  std::int32_t first_end() const { return static_cast<std::int32_t>(growth); }
  std::int32_t last_end() const { return static_cast<std::int32_t>(inverse); }
  // With a table or corners.
  std::uint8_t shape = 0, far = 0;
  spec::morphological::RunPart part{};
  // Learned weights: no line; the classes share the bits of t.
  bool learned = false;
  std::uint8_t start_class = 0, end_class = 0;
};

}  // namespace deburr::rtl::morphological
