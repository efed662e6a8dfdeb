// SPDX-License-Identifier: MIT
#include "golden/geometric/line.h"

#include <algorithm>
#include <bit>
#include <utility>

namespace deburr::golden::geometric {

using spec::geometric::Axis;
using spec::geometric::LineRecord;
using spec::geometric::Vertex;

bool is_usable(const Vertex& vertex) {
  constexpr std::int32_t kBand = spec::geometric::kGuardBand;
  return vertex.usable && vertex.x >= -kBand && vertex.x < kBand && vertex.y >= -kBand &&
         vertex.y < kBand;
}

std::uint32_t reciprocal(std::uint32_t normalised_length) {
  return static_cast<std::uint32_t>((std::uint64_t{1} << 48) / normalised_length);
}

LineFate set_up_line(const Vertex& p, const Vertex& q, int width, int height, LineRecord& line) {
  if (!is_usable(p) || !is_usable(q)) return LineFate::kOutside;
  if (p.x == q.x && p.y == q.y) return LineFate::kDegenerate;
  const bool horizontal = std::abs(q.x - p.x) > std::abs(q.y - p.y);
  struct End {
    std::int64_t major, minor, depth;
  };
  const auto end_of = [&](const Vertex& v) {
    const std::int64_t depth = v.depth & 0xFFFFFFu;
    return horizontal ? End{v.x, v.y, depth} : End{v.y, v.x, depth};
  };
  End start = end_of(p), end = end_of(q);
  if (end.major < start.major) std::swap(start, end);
  const std::int64_t columns = horizontal ? width : height, rows = horizontal ? height : width;

  const std::int64_t first = std::max<std::int64_t>(0, (start.major + 127) >> 8);
  const std::int64_t last = std::min(columns - 1, ((end.major + 127) >> 8) - 1);
  if (first > last) return LineFate::kEmptyColumns;
  if (start.minor < 0 && end.minor < 0) return LineFate::kEmptyBefore;
  if (start.minor >= 256 * rows && end.minor >= 256 * rows) return LineFate::kEmptyAfter;

  const auto length = static_cast<std::uint32_t>(end.major - start.major);
  const int e = std::bit_width(length) - 1;
  const auto normalise = [e](std::int64_t extent) { return extent << (22 - e); };
  const std::int64_t r = reciprocal(length << (22 - e));
  const std::int64_t dm = end.minor - start.minor, dd = end.depth - start.depth;
  const auto signed_as = [](std::int64_t sign, std::int64_t magnitude) {
    return sign < 0 ? -magnitude : magnitude;
  };

  const std::int64_t slope = (normalise(std::abs(dm)) * r + (1 << 23)) >> 24;
  const std::int64_t offset = 256 * first + 128 - start.major;
  const std::int64_t share = (normalise(offset) * (r >> 2)) >> 22;
  line.axis = horizontal ? Axis::kHorizontal : Axis::kVertical;
  line.tie_forward = horizontal && dm > 0;
  line.first = static_cast<std::uint16_t>(first);
  line.count = static_cast<std::uint16_t>(last - first + 1);
  line.slope = static_cast<std::int32_t>(signed_as(dm, slope));
  line.position = start.minor * 65536 + signed_as(dm, (slope * offset) >> 8) + 128;
  line.depth = start.depth * 4096 + signed_as(dd, (std::abs(dd) * share) >> 12);
  line.depth_step = e >= 8 ? signed_as(dd, (std::abs(dd) * (r >> 2)) >> (4 + e)) : 0;
  return LineFate::kLine;
}

}  // namespace deburr::golden::geometric
