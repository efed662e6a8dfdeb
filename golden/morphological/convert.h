// SPDX-License-Identifier: MIT
// Conversion of images of other sample formats to codes: docs/reference/morphological/algorithm.md,
// "Conversion of images". It is exact, so every reader gives the engine the same frame.
//
// Before the engine. Binary32 samples (IEEE 754) are passed as bit patterns and converted in
// integers.
#pragma once

#include <cstdint>
#include <span>

#include "golden/morphological/planes.h"
#include "spec/morphological/packets.h"

namespace deburr::golden::morphological {

// Converts an unsigned sample of 1..32 bits to a code.
std::uint8_t code_from_unsigned(std::uint32_t value, int bits);
// floor(full_scale v + 1/2) of v clamped to 0..1; NaN is 0. full_scale is at most 2^24.
std::uint32_t scaled_from_binary32(std::uint32_t pattern, std::uint32_t full_scale);
inline std::uint8_t code_from_binary32(std::uint32_t pattern) {
  return static_cast<std::uint8_t>(scaled_from_binary32(pattern, 255));
}
inline std::uint32_t depth_from_binary32(std::uint32_t pattern) {
  return scaled_from_binary32(pattern, (1u << 24) - 1);
}
inline std::uint32_t depth_from_codes(const spec::morphological::Rgba8& pixel) {
  return std::uint32_t{pixel[0]} << 16 | std::uint32_t{pixel[1]} << 8 | pixel[2];
}

// Interleaved samples of an image.
struct Samples {
  std::span<const std::uint32_t> values;  // width x height x channels
  int width = 0, height = 0;
  int channels = 0;       // 1: grey; 2: grey, alpha; 3: RGB; 4 and more: RGBA, the rest is ignored
  int bits = 8;           // of unsigned samples
  bool binary32 = false;  // values are bit patterns; `bits` is unused
};
PlaneOf<spec::morphological::Rgba8> codes_from(const Samples& samples);

}  // namespace deburr::golden::morphological
