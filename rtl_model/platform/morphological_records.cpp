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

std::uint32_t rules_register(const spec::morphological::Parameters& p) {
  using spec::morphological::AreaSource;
  const bool learned = p.area == AreaSource::kLearned,
             table = p.area != AreaSource::kAnalytic && !learned;
  std::uint32_t value = 0;
  // The low `bits` bits of a code, at bit `low`.
  const auto field = [&value](auto code, int bits, int low) {
    value |= (static_cast<std::uint32_t>(code) & ((1u << bits) - 1)) << low;
  };
  const auto leave = static_cast<std::uint32_t>(p.leave),
             dynamic_luma = static_cast<std::uint32_t>(p.dynamic_luma);
  field(p.edge_source, 2, 0);
  field(p.threshold_mode, 1, 2);
  field(dynamic_luma, 1, 3);
  field(p.local_contrast, 2, 4);
  field(p.predictor, 2, 6);
  field(p.steps, 5, 8);
  field(p.contiguous, 1, 13);
  field(p.safe, 1, 14);
  field(p.linear_light, 1, 15);
  field(p.trim, 1, 16);
  field(dynamic_luma >> 1, 1, 17);
  field(p.ends, 1, 18);
  field(table, 1, 19);
  field(p.diagonals, 1, 20);
  field(p.round_corners, 1, 21);
  field(p.blend, 1, 22);
  field(leave, 2, 23);
  field(learned, 1, 25);
  field(leave >> 2, 1, 26);
  return value;
}

std::uint32_t smaa_register(const spec::morphological::Parameters& p) {
  return static_cast<std::uint32_t>(p.search_steps) |
         static_cast<std::uint32_t>(p.diagonal_steps) << 8 |
         static_cast<std::uint32_t>(p.corner_rounding) << 16;
}

std::uint32_t shares_sum(std::span<const std::int8_t> entries) {
  std::uint32_t sum = 0, place = 0;
  for (const std::int8_t entry : entries) sum += ++place * static_cast<std::uint8_t>(entry);
  return sum;
}

}  // namespace deburr::platform
