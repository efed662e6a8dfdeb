// SPDX-License-Identifier: MIT
#include "rtl_model/platform/morphological_records.h"

namespace deburr::platform {

int lanes_of(const spec::morphological::Parameters& p) {
  return spec::morphological::kLaneCount[static_cast<std::size_t>(p.lanes)];
}

std::vector<spec::morphological::PixelBeat> beats_of(const PixelFrame& frame, int lanes) {
  std::vector<spec::morphological::PixelBeat> beats;
  for (int y = 0; y < frame.height; ++y)
    for (int x = 0; x < frame.width; x += lanes) beats.push_back(pixel_beat(frame, x, y, lanes));
  return beats;
}

std::uint64_t frame_bytes(int width, int height) {
  constexpr std::uint64_t kLine = spec::morphological::kFrameLineBytes;
  const std::uint64_t row =
      static_cast<std::uint64_t>(width) * spec::morphological::kFramePixelBytes;
  return (row + kLine - 1) / kLine * kLine * static_cast<std::uint64_t>(height);
}

std::uint32_t weights_sum(std::span<const std::int8_t> entries) {
  std::uint32_t sum = 0, place = 0;
  for (const std::int8_t entry : entries)
    sum += ++place * std::uint32_t{static_cast<std::uint8_t>(entry)};
  return sum;
}

}  // namespace deburr::platform
