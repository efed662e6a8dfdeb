// SPDX-License-Identifier: MIT
// Line setup: reciprocal, slope and start of an edge on the screen, and the line at each column.
//
// Second and third step; docs/reference/geometric/algorithm.md, "Line" and "Walk". Paper 002,
// equations (6) and (7). Integers only; error bounds: same page.
#pragma once

#include <cstdint>
#include <cstdlib>

#include "spec/geometric/packets.h"
#include "spec/geometric/parameters.h"
#include "spec/geometric/records.h"
#include "spec/geometric/tables.h"

namespace deburr::golden::geometric {

// Whether a kept edge gives a line, or why it does not.
enum class LineFate : std::uint8_t {
  kLine,
  kOutside,       // a vertex is not usable
  kDegenerate,    // both vertices at the same position
  kEmptyColumns,  // no column in the frame
  kEmptyBefore,   // both ends above or left of the frame
  kEmptyAfter     // both ends below or right of it
};

bool is_usable(const spec::geometric::Vertex& vertex);

// floor(2^48 / l), U1.26, for a length l = L << (22 - e) normalised to 23 bits.
std::uint32_t reciprocal(std::uint32_t normalised_length);

// Writes `line` only if the edge gives one; never `line.crease`, which depends on the class.
LineFate set_up_line(const spec::geometric::Vertex& p, const spec::geometric::Vertex& q, int width,
                     int height, spec::geometric::LineRecord& line);

// The line at a column.
struct ColumnPoint {
  std::int32_t row = 0;       // pixel along the minor axis; may lie outside the frame
  std::int32_t distance = 0;  // dis, S0.16: from the centre of the pixel to the line
  std::uint32_t depth = 0;    // U24
};
inline ColumnPoint point_at(std::int64_t position, std::int64_t depth) {
  const std::int64_t rounded =
      position >> (spec::geometric::kSlopeBits - spec::geometric::kDistanceBits);
  return {static_cast<std::int32_t>(rounded >> spec::geometric::kDistanceBits),
          static_cast<std::int32_t>(rounded & 0xFFFF) - 0x8000,
          static_cast<std::uint32_t>(depth >> spec::geometric::kDepthStepBits)};
}

// S0.16 to U0.8.
constexpr int coverage(std::int32_t distance) {
  return (32768 - (distance < 0 ? -distance : distance) + 128) >> 8;
}
// Blend weights of a column, U0.8: of the pixel that the line crosses in the middle of the column,
// and of its neighbour if the line cuts that pixel as well.
struct Shares {
  int first = 0, second = 0;
};
constexpr Shares shares(spec::geometric::CoverageRule rule, std::int32_t distance,
                        std::int32_t slope) {
  if (rule == spec::geometric::CoverageRule::kDistance) return {coverage(distance), 0};
  const std::int32_t away = distance < 0 ? -distance : distance;
  const std::int32_t steep = slope < 0 ? -slope : slope;
  if (2 * away + (steep >> 8) <= 65536) return {coverage(distance), 0};  // does not leave the pixel
  const int k = (steep + (1 << 18)) >> 19;
  const auto& areas = spec::geometric::kCutArea[static_cast<std::size_t>(k < 1 ? 0 : k - 1)];
  return {areas[static_cast<std::size_t>(away >> 10)],
          areas[static_cast<std::size_t>((65536 - away) >> 10)]};
}
// Whether the neighbour is the pixel below, or the pixel to the right.
constexpr bool is_forward(std::int32_t distance, bool tie_forward) {
  return distance > 0 || (distance == 0 && tie_forward);
}
constexpr spec::geometric::Direction direction(spec::geometric::Axis axis, bool forward) {
  using spec::geometric::Direction;
  if (axis == spec::geometric::Axis::kHorizontal)
    return forward ? Direction::kDown : Direction::kUp;
  return forward ? Direction::kRight : Direction::kLeft;
}

// The direction of a second candidate: towards the pixel of the first.
constexpr spec::geometric::Direction opposite(spec::geometric::Direction direction) {
  return static_cast<spec::geometric::Direction>(static_cast<unsigned>(direction) ^ 1u);
}

// f: the depth that a line is compared with, U24.
constexpr std::uint32_t compared_depth(const spec::geometric::Configuration& configuration,
                                       std::uint32_t own, std::uint32_t other) {
  const bool own_alone = configuration.depth_test == spec::geometric::DepthTest::kOwn;
  return own_alone || own < other ? own : other;
}
// Whether a line at depth d is visible, given the depths of pixel and neighbour; all U24.
constexpr bool is_seen(const spec::geometric::Configuration& configuration, std::uint32_t d,
                       std::uint32_t own, std::uint32_t other) {
  if (configuration.depth_test == spec::geometric::DepthTest::kOff) return true;
  const std::uint32_t f = compared_depth(configuration, own, other);
  return d >= f - (f >> configuration.depth_bias);
}
// Whether the surfaces of both pixels can meet in a crease at depth d.
constexpr bool is_near_crease(const spec::geometric::Configuration& configuration, std::uint32_t d,
                              std::uint32_t own, std::uint32_t other) {
  if (configuration.depth_test == spec::geometric::DepthTest::kOff ||
      configuration.crease_depth == 0)
    return true;
  return compared_depth(configuration, own, other) >= d - (d >> configuration.crease_depth);
}
constexpr bool passes(const spec::geometric::Configuration& configuration, bool crease,
                      std::uint32_t d, std::uint32_t own, std::uint32_t other) {
  return is_seen(configuration, d, own, other) &&
         (!crease || is_near_crease(configuration, d, own, other));
}
// Whether the pixel counts as nearer than its neighbour; only known with depth_test = farther.
constexpr bool is_nearer(const spec::geometric::Configuration& configuration, std::uint32_t own,
                         std::uint32_t other) {
  return configuration.depth_test == spec::geometric::DepthTest::kFarther && own > other;
}

}  // namespace deburr::golden::geometric
