// SPDX-License-Identifier: MIT
// An edge on the screen as a line: reciprocal, slope, start, and what it is at each column.
//
// Second and third step; docs/reference/geometric/algorithm.md, "Line" and "Walk". Paper 002,
// equations (6) and (7). Integers only; bounds of the errors stand with the formats.
#pragma once

#include <cstdint>
#include <cstdlib>

#include "spec/geometric/packets.h"
#include "spec/geometric/parameters.h"
#include "spec/geometric/records.h"
#include "spec/geometric/tables.h"

namespace deburr::golden::geometric {

// Why a kept edge is no line, or that it is one.
enum class LineFate : std::uint8_t {
  kLine,
  kOutside,       // a vertex is not usable
  kDegenerate,    // both ends in one place
  kEmptyColumns,  // no column of the frame
  kEmptyBefore,   // both ends above or to the left of the frame
  kEmptyAfter     // both ends below or to the right of it
};

bool is_usable(const spec::geometric::Vertex& vertex);

// floor(2^48 / l) of a length l = L << (22 - e) that is normalised to 23 bits; U1.26.
std::uint32_t reciprocal(std::uint32_t normalised_length);

// `line` is written only if the edge is one; never `line.crease`, which is its class.
LineFate set_up_line(const spec::geometric::Vertex& p, const spec::geometric::Vertex& q, int width,
                     int height, spec::geometric::LineRecord& line);

// The line at one column.
struct ColumnPoint {
  std::int32_t row = 0;       // pixel along the minor axis; may lie outside the frame
  std::int32_t distance = 0;  // dis, S0.16: of the line from the pixel's centre
  std::uint32_t depth = 0;    // U24
};
inline ColumnPoint point_at(std::int64_t position, std::int64_t depth) {
  const std::int64_t rounded =
      position >> (spec::geometric::kSlopeBits - spec::geometric::kDistanceBits);
  return {static_cast<std::int32_t>(rounded >> spec::geometric::kDistanceBits),
          static_cast<std::int32_t>(rounded & 0xFFFF) - 0x8000,
          static_cast<std::uint32_t>(depth >> spec::geometric::kDepthStepBits)};
}

// U0.8 of S0.16.
constexpr int coverage(std::int32_t distance) {
  return (32768 - (distance < 0 ? -distance : distance) + 128) >> 8;
}
// What a line gives away, U0.8, of the pixel in which it meets the middle of a column, and of the
// neighbour if it cuts that, too.
struct Shares {
  int first = 0, second = 0;
};
constexpr Shares shares(spec::geometric::CoverageRule rule, std::int32_t distance,
                        std::int32_t slope) {
  if (rule == spec::geometric::CoverageRule::kDistance) return {coverage(distance), 0};
  const std::int32_t away = distance < 0 ? -distance : distance;
  const std::int32_t steep = slope < 0 ? -slope : slope;
  if (2 * away + (steep >> 8) <= 65536) return {coverage(distance), 0};  // stays in the pixel
  const int k = (steep + (1 << 18)) >> 19;
  const auto& areas = spec::geometric::kCutArea[static_cast<std::size_t>(k < 1 ? 0 : k - 1)];
  return {areas[static_cast<std::size_t>(away >> 10)],
          areas[static_cast<std::size_t>((65536 - away) >> 10)]};
}
// Whether the neighbour is the pixel below or to the right.
constexpr bool is_forward(std::int32_t distance, bool tie_forward) {
  return distance > 0 || (distance == 0 && tie_forward);
}
constexpr spec::geometric::Direction direction(spec::geometric::Axis axis, bool forward) {
  using spec::geometric::Direction;
  if (axis == spec::geometric::Axis::kHorizontal)
    return forward ? Direction::kDown : Direction::kUp;
  return forward ? Direction::kRight : Direction::kLeft;
}

// The opposite one: towards the pixel that a second candidate came from.
constexpr spec::geometric::Direction opposite(spec::geometric::Direction direction) {
  return static_cast<spec::geometric::Direction>(static_cast<unsigned>(direction) ^ 1u);
}

// The depth that a line is compared with, of pixel and neighbour; U24.
constexpr std::uint32_t compared_depth(const spec::geometric::Configuration& configuration,
                                       std::uint32_t own, std::uint32_t other) {
  const bool own_alone = configuration.depth_test == spec::geometric::DepthTest::kOwn;
  return own_alone || own < other ? own : other;
}
// Whether a line at depth d is seen where pixel and neighbour have these depths; all U24.
constexpr bool is_seen(const spec::geometric::Configuration& configuration, std::uint32_t d,
                       std::uint32_t own, std::uint32_t other) {
  if (configuration.depth_test == spec::geometric::DepthTest::kOff) return true;
  const std::uint32_t f = compared_depth(configuration, own, other);
  return d >= f - (f >> configuration.depth_bias);
}
// Whether both pixels show what meets in a crease at depth d.
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
// Whether the pixel is nearer to the eye than its neighbour, as far as the rules know.
constexpr bool is_nearer(const spec::geometric::Configuration& configuration, std::uint32_t own,
                         std::uint32_t other) {
  return configuration.depth_test == spec::geometric::DepthTest::kFarther && own > other;
}

}  // namespace deburr::golden::geometric
