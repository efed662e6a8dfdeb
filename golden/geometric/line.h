// SPDX-License-Identifier: MIT
// An edge on the screen as a line: reciprocal, slope, start, and what it is at each column.
//
// Second and third step; docs/geometric.md, "Line" and "Walk"; docs/number_formats_geometric.md.
// Paper 002, equations (6) and (7). Integers only; bounds of the errors stand with the formats.
#pragma once

#include <cstdint>
#include <cstdlib>

#include "spec/geometric/packets.h"
#include "spec/geometric/parameters.h"
#include "spec/geometric/records.h"

namespace deburr::golden::geometric {

// Why a kept edge is no line, or that it is one.
enum class LineFate : std::uint8_t {
  kLine,
  kOutside,       // a vertex is not usable
  kDegenerate,    // both ends in one place
  kEmptyColumns,  // no column of the frame
  kEmptyBefore,   // both ends above or to the left of the frame
  kEmptyBehind    // both ends below or to the right of it
};

bool is_usable(const spec::geometric::Vertex& vertex);

// floor(2^48 / l) of a length l = L << (22 - e) that is normalised to 23 bits; U1.26.
std::uint32_t reciprocal(std::uint32_t normalised_length);

// `line` is written only if the edge is one.
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

// Whether a line at depth d is seen where pixel and neighbour have these depths; all U24.
constexpr bool passes(const spec::geometric::Rules& rules, std::uint32_t d, std::uint32_t own,
                      std::uint32_t other) {
  if (rules.depth_test == spec::geometric::DepthTest::kOff) return true;
  const bool own_alone = rules.depth_test == spec::geometric::DepthTest::kOwn;
  const std::uint32_t f = own_alone || own < other ? own : other;
  return d >= f - (f >> rules.depth_bias);
}

}  // namespace deburr::golden::geometric
