// SPDX-License-Identifier: MIT
#include "golden/morphological/area_table.h"

#include <algorithm>
#include <cstdlib>

#include "golden/morphological/arithmetic.h"
#include "golden/morphological/line.h"
#include "spec/morphological/shapes.h"

namespace deburr::golden::morphological {
namespace {

using spec::morphological::AreaValues;

constexpr int kRoots = spec::morphological::kTableRoots;

// Runs of 32 pixels and more are not smoothed.
constexpr int kSmoothed = 32;

std::uint64_t length_of(int l, int r) {
  const int length = l + r + 1;
  return static_cast<std::uint64_t>(length);
}

std::uint64_t half_entry(int l, int r) {
  const std::uint64_t length = length_of(l, r);
  if (l > r) return 0;
  if (l == r) return rdiv(64, length);
  return rdiv(256 * static_cast<std::uint64_t>(r - l), length);
}

std::uint64_t dip_entry(int l, int r) {
  const std::uint64_t length = length_of(l, r);
  const auto off_centre = static_cast<std::uint64_t>(std::abs(l - r));
  if (length >= kSmoothed) {
    return off_centre > 0 ? rdiv(256 * off_centre, length) : rdiv(128, length);
  }
  const std::uint64_t straight = off_centre > 0 ? 8 * off_centre : 4;
  const std::uint64_t missing = kSmoothed - length;
  const std::uint64_t round =
      isqrt(256 * missing * missing * std::max<std::uint64_t>(off_centre, 1) / length);
  return straight + (round + 1) / 2;
}

// The bytes of the published table.
std::uint64_t half_byte(int l, int r) {
  const std::uint64_t length = length_of(l, r);
  if (l > r) return 0;
  if (l == r) return 255 / (8 * length);
  return 255 * static_cast<std::uint64_t>(r - l) / (2 * length);
}

std::uint64_t dip_byte(int l, int r) {
  const std::uint64_t length = length_of(l, r);
  const auto off_centre = static_cast<std::uint64_t>(std::abs(l - r));
  if (length >= kSmoothed)
    return off_centre > 0 ? 255 * off_centre / (2 * length) : 255 / (4 * length);
  const std::uint64_t straight = off_centre > 0 ? 8 * off_centre : 4;
  const std::uint64_t missing = kSmoothed - length;
  const std::uint64_t round = isqrt(std::uint64_t{255} * 255 * 64 * missing * missing *
                                    std::max<std::uint64_t>(off_centre, 1) / length);
  return (255 * straight + round) / 512;
}

template <class Entry>
AreaTile tile_of(Entry&& entry) {
  AreaTile tile{};
  for (int i = 0; i < kRoots; ++i) {
    for (int j = 0; j < kRoots; ++j) {
      tile[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] =
          static_cast<std::uint8_t>(entry(i * i, j * j));
    }
  }
  return tile;
}

std::uint8_t at(const AreaTile& tile, int i, int j) {
  return tile[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
}

std::size_t flat(int i, int j) {
  const int place = i * kRoots + j;
  return static_cast<std::size_t>(place);
}

// Patterns stored in the merged table, in order.
constexpr std::array<int, 8> kStored = {1, 2, 3, 4, 6, 8, 9, 12};
// Index of each pattern in kStored; -1: not stored, zero.
constexpr std::array<int, 16> kReadAt = {-1, 0, 1, 2, 3, -1, 4, 4, 5, 6, -1, 6, 7, 6, 4, -1};

}  // namespace

AreaTile half_tile(AreaValues values) {
  if (values == AreaValues::kExact) return tile_of(half_entry);
  return tile_of([](int l, int r) { return rdiv(512 * half_byte(l, r), 255); });
}
AreaTile dip_tile(AreaValues values) {
  if (values == AreaValues::kExact) return tile_of(dip_entry);
  return tile_of([](int l, int r) { return rdiv(512 * dip_byte(l, r), 255); });
}

FullAreaTable::FullAreaTable(AreaValues values) {
  const AreaTile half = half_tile(values), dip = dip_tile(values);
  for (int pattern = 0; pattern < 16; ++pattern) {
    for (int i = 0; i < kRoots; ++i) {
      for (int j = 0; j < kRoots; ++j) {
        const std::uint8_t start = at(half, i, j), end = at(half, j, i), both = at(dip, i, j);
        AreaEntry& e = tiles_[static_cast<std::size_t>(pattern)][static_cast<std::size_t>(i)]
                             [static_cast<std::size_t>(j)];
        switch (pattern) {
          case 1:
            e = {start, 0};
            break;
          case 2:
            e = {end, 0};
            break;
          case 3:
            e = {both, 0};
            break;
          case 4:
            e = {0, start};
            break;
          case 8:
            e = {0, end};
            break;
          case 12:
            e = {0, both};
            break;
          case 6:
          case 7:
          case 14:
            e = {end, start};
            break;
          case 9:
          case 11:
          case 13:
            e = {start, end};
            break;
          default:  // 0, 5, 10, 15
            e = {};
        }
      }
    }
  }
}

MergedAreaTable::MergedAreaTable(const FullAreaTable& full) {
  for (std::size_t tile = 0; tile < kStored.size(); ++tile) {
    for (int i = 0; i < kRoots; ++i) {
      for (int j = 0; j < kRoots; ++j) tiles_[tile][flat(i, j)] = full.entry(kStored[tile], i, j);
    }
  }
}

AreaEntry MergedAreaTable::entry(int pattern, int i, int j) const {
  const int tile = kReadAt[static_cast<std::size_t>(pattern)];
  return tile < 0 ? AreaEntry{} : tiles_[static_cast<std::size_t>(tile)][flat(i, j)];
}

AreaEntry MinimalAreaTable::entry(int pattern, int i, int j) const {
  for (std::size_t shape = 0; shape < 16; ++shape) {
    if (pattern_of_shape(static_cast<int>(shape)) != pattern) continue;
    const spec::morphological::RunShape& s = spec::morphological::kRunShapes[shape];
    const auto of = [&](spec::morphological::Side side) -> std::uint8_t {
      if (s.before == s.after) return s.before == side ? at(dip_, i, j) : std::uint8_t{0};
      if (s.before == side) return at(half_, i, j);
      return s.after == side ? at(half_, j, i) : std::uint8_t{0};
    };
    return {of(spec::morphological::Side::kSecond), of(spec::morphological::Side::kFirst)};
  }
  return {};
}

int table_root(int distance) {
  return static_cast<int>(isqrt(65536 * static_cast<std::uint64_t>(distance)));
}

EdgeWeights table_weights(int shape, int before, int after, AreaValues values) {
  static const FullAreaTable exact(AreaValues::kExact), published(AreaValues::kPublished);
  const FullAreaTable& table = values == AreaValues::kExact ? exact : published;
  static const auto roots = [] {
    std::array<int, spec::morphological::kTableDistances> result{};
    for (std::size_t d = 0; d < result.size(); ++d) result[d] = table_root(static_cast<int>(d));
    return result;
  }();
  const int pattern = pattern_of_shape(shape);
  const int s = roots[static_cast<std::size_t>(before)], t = roots[static_cast<std::size_t>(after)];
  const int i = s >> 8, f = s & 255, j = t >> 8, g = t & 255;
  // The last root has no successor; its fraction is 0.
  const int next_i = std::min(i + 1, kRoots - 1), next_j = std::min(j + 1, kRoots - 1);
  const AreaEntry e00 = table.entry(pattern, i, j), e10 = table.entry(pattern, next_i, j),
                  e01 = table.entry(pattern, i, next_j), e11 = table.entry(pattern, next_i, next_j);
  const auto interpolated = [&](int v00, int v10, int v01, int v11) {
    const int v = (256 - g) * ((256 - f) * v00 + f * v10) + g * ((256 - f) * v01 + f * v11);
    return static_cast<std::uint8_t>((v + (1 << 16)) >> 17);
  };
  return {interpolated(e00.first, e10.first, e01.first, e11.first),
          interpolated(e00.second, e10.second, e01.second, e11.second)};
}

LineEnds line_ends(const spec::morphological::LineDescriptor& line) {
  constexpr std::int64_t kHalf = std::int64_t{1} << 23;
  // Height of the descriptor's start above the lower end of the line, in steps, S5.12.
  const std::int64_t begin = (height(line, 0) + kHalf + 2048) >> 12;
  const auto pixels = [&](std::int64_t steps) { return (steps * line.inverse + kHalf) >> 24; };
  const auto limited = [](std::int64_t position) {
    return static_cast<int>(std::clamp<std::int64_t>(position, -4096, 4095));
  };
  const LineEnds ends = {limited(-pixels(begin)), limited(pixels(4096 - begin))};
  return {(line.run.endless & 1) != 0 ? -4096 : ends.first,
          (line.run.endless & 2) != 0 ? 4095 : ends.last};
}

TableAddress table_address(const spec::morphological::LineDescriptor& line, const LineEnds& ends,
                           int search_steps, int k) {
  const int left = 2 * search_steps - 1, right = 2 * search_steps;
  const int before = std::max(0, k - ends.first), after = std::max(0, ends.last - 1 - k);
  const auto end_of = [](int distance, int limit) {
    return distance > limit    ? SearchEnd::kBeyond
           : distance == limit ? SearchEnd::kAtLimit
                               : SearchEnd::kWithin;
  };
  int shape = line.run.shape;
  if (before > left) shape &= 12;
  if (after > right) shape &= 3;
  return {shape, std::min(before, left), std::min(after, right), end_of(before, left),
          end_of(after, right)};
}

}  // namespace deburr::golden::morphological
