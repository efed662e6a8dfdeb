// SPDX-License-Identifier: MIT
#include "rtl_model/morphological/blend/area_table.h"

#include <algorithm>
#include <string>

#include "spec/morphological/shapes.h"
#include "spec/morphological/tables.h"

namespace deburr::rtl::morphological {
namespace {

using spec::morphological::AreaSource;
using spec::morphological::AreaValues;

constexpr int kRoots = spec::morphological::kTableRoots;
constexpr int kTileWords = kRoots * kRoots / 4;  // per parity
constexpr std::array<int, 8> kMergedTiles = {1, 2, 3, 4, 6, 8, 9, 12};
enum MinimalTile : int { kT, kU };

int nearest(int over, int under) { return (2 * over + under) / (2 * under); }

int root(std::int64_t square) {
  std::int64_t r = 0;
  for (std::int64_t bit = std::int64_t{1} << 20; bit != 0; bit >>= 1)
    if ((r + bit) * (r + bit) <= square) r += bit;
  return static_cast<int>(r);
}

// Entry for a published byte v, value v / 255.
int of_byte(int v) { return nearest(512 * v, 255); }

// Areas with l pixels before and r after, tabulated at the roots of both.
struct Entries {
  bool published;

  // Weight of the nearer half of a line that falls from half a pixel at the end to 0 in the middle.
  int half(int i, int j) const {
    const int l = i * i, r = j * j, d = l + r + 1;
    if (l > r) return 0;
    if (published) return of_byte(l < r ? 255 * (r - l) / (2 * d) : 255 / (8 * d));
    return l < r ? nearest(256 * (r - l), d) : nearest(64, d);
  }

  // Weight of both halves, smoothed for short runs.
  int arch(int i, int j) const {
    const int l = i * i, r = j * j, d = l + r + 1, n = std::max(l, r) - std::min(l, r);
    if (d >= 32) {
      if (published) return of_byte(n > 0 ? 255 * n / (2 * d) : 255 / (4 * d));
      return n > 0 ? nearest(256 * n, d) : nearest(128, d);
    }
    const int own = n > 0 ? 8 * n : 4, rest = (32 - d) * (32 - d) * std::max(n, 1);
    if (published) return of_byte((255 * own + root(std::int64_t{2040} * 2040 * rest / d)) / 512);
    return own + (root(256 * rest / d) + 1) / 2;
  }

  // Word of the published table: second value in the low byte, first value in the high byte.
  int pattern(int p, int i, int j) const {
    const auto both = [](int second, int first) { return second | first << 8; };
    switch (p) {
      case 1:
        return both(half(i, j), 0);
      case 2:
        return both(half(j, i), 0);
      case 3:
        return both(arch(i, j), 0);
      case 4:
        return both(0, half(i, j));
      case 8:
        return both(0, half(j, i));
      case 12:
        return both(0, arch(i, j));
      case 6:
      case 7:
      case 14:
        return both(half(j, i), half(i, j));
      case 9:
      case 11:
      case 13:
        return both(half(i, j), half(j, i));
      default:
        return 0;
    }
  }
};

int stored_entry(AreaSource layout, const Entries& entries, int tile, int i, int j) {
  switch (layout) {
    case AreaSource::kTableMerged:
      return entries.pattern(kMergedTiles[static_cast<std::size_t>(tile)], i, j);
    case AreaSource::kTableMinimal:
      return tile == kT ? entries.half(i, j) : entries.arch(i, j);
    default:
      return entries.pattern(tile, i, j);
  }
}

std::vector<std::uint16_t> area_words(AreaSource layout, AreaValues values, int parity) {
  const Entries entries{values == AreaValues::kPublished};
  std::vector<std::uint16_t> words;
  for (int tile = 0; tile < static_cast<int>(AreaTable::tiles_of(layout)); ++tile)
    for (int i = parity / 2; i < kRoots; i += 2)
      for (int j = parity % 2; j < kRoots; j += 2)
        words.push_back(static_cast<std::uint16_t>(stored_entry(layout, entries, tile, i, j)));
  return words;
}

std::vector<std::uint16_t> root_words() {
  std::vector<std::uint16_t> words;
  words.reserve(spec::morphological::kTableDistances);
  for (int d = 0; d < spec::morphological::kTableDistances; ++d)
    words.push_back(static_cast<std::uint16_t>(root(65536 * std::int64_t{d})));
  return words;
}

// Pattern of a shape; its bits are the first and second crossing edge of the start, then of the
// end.
int pattern_of(std::uint8_t shape) {
  return (shape >> 1 & 1) | (shape >> 3 & 1) << 1 | (shape & 1) << 2 | (shape >> 2 & 1) << 3;
}

}  // namespace

std::uint32_t AreaTable::tiles_of(AreaSource layout) {
  switch (layout) {
    case AreaSource::kTableMerged:
      return static_cast<std::uint32_t>(kMergedTiles.size());
    case AreaSource::kTableMinimal:
      return 2;
    default:
      return 16;
  }
}

AreaTable::AreaTable(AreaSource layout, AreaValues values, int lanes)
    : layout_(layout),
      reads_(layout == AreaSource::kTableMinimal ? 2 : 1),
      sqrt_rom_("sqrt_rom",
                {.words = spec::morphological::kTableDistances,
                 .word_bits = 12,
                 .kind = MemoryKind::kRom,
                 .read_ports = static_cast<std::uint32_t>(4 * lanes),
                 .write_ports = 0,
                 .content = "square root of a distance, U4.8"},
                root_words()) {
  const int readers = 2 * lanes;
  for (int port = 0; port < 2 * readers; ++port)
    roots_.emplace_back(sqrt_rom_, "distance " + std::to_string(port));
  for (int parity = 0; parity < static_cast<int>(kParities); ++parity) {
    area_rom_.emplace_back(("area_rom" + std::to_string(parity)).c_str(),
                           MemoryShape{.words = std::uint64_t{tiles_of(layout)} * kTileWords,
                                       .word_bits = layout == AreaSource::kTableMinimal ? 8u : 16u,
                                       .kind = MemoryKind::kRom,
                                       .read_ports = static_cast<std::uint32_t>(readers) *
                                                     static_cast<std::uint32_t>(reads_),
                                       .write_ports = 0,
                                       .content = "areas of tiles, by the parities of both roots"},
                           area_words(layout, values, parity));
    for (std::size_t port = 0; port < static_cast<std::size_t>(readers) * reads_; ++port)
      read_[static_cast<std::size_t>(parity)].emplace_back(area_rom_.back(),
                                                           "edge " + std::to_string(port));
  }
}

void AreaTable::address_roots(Cycle cycle, std::size_t reader, const Query& query) {
  roots_[2 * reader].read(cycle, query.left);
  roots_[2 * reader + 1].read(cycle, query.right);
}

int AreaTable::tile(std::uint8_t shape) const {
  const spec::morphological::RunShape& sides = spec::morphological::kRunShapes[shape];
  if (sides.before == spec::morphological::Side::kNone &&
      sides.after == spec::morphological::Side::kNone)
    return -1;
  int pattern = pattern_of(shape);
  switch (layout_) {
    case AreaSource::kTableMerged:
      if (pattern == 7 || pattern == 14) pattern = 6;
      if (pattern == 11 || pattern == 13) pattern = 9;
      return static_cast<int>(std::find(kMergedTiles.begin(), kMergedTiles.end(), pattern) -
                              kMergedTiles.begin());
    case AreaSource::kTableMinimal:
      return sides.before == sides.after ? kU : kT;
    default:
      return pattern;
  }
}

AreaTable::Corners AreaTable::corners(std::uint8_t i, std::uint8_t j) {
  Corners at{};
  for (unsigned k = 0; k < kParities; ++k) {
    const unsigned row = i + k / 2, column = j + k % 2;
    at.rom[k] = static_cast<std::uint8_t>((row & 1) * 2 + (column & 1));
    at.word[k] = static_cast<std::uint8_t>(row / 2 * (kRoots / 2) + column / 2);
  }
  return at;
}

void AreaTable::address_entries(Cycle cycle, std::size_t reader, Query& query) {
  const std::uint16_t left = roots_[2 * reader].at(cycle, query.left);
  const std::uint16_t right = roots_[2 * reader + 1].at(cycle, query.right);
  query.i = static_cast<std::uint8_t>(left >> 8);
  query.f = static_cast<std::uint8_t>(left);
  query.j = static_cast<std::uint8_t>(right >> 8);
  query.g = static_cast<std::uint8_t>(right);
  const int from = tile(query.shape);
  if (from < 0) return;
  for (std::size_t side = 0; side < reads_; ++side) {
    const Corners at = side == 0 ? corners(query.i, query.j) : corners(query.j, query.i);
    for (std::size_t k = 0; k < kParities; ++k)
      read_[at.rom[k]][reader * reads_ + side].read(
          cycle, static_cast<std::uint64_t>(from) * kTileWords + at.word[k]);
  }
}

std::array<std::uint16_t, AreaTable::kParities> AreaTable::entries(Cycle cycle, std::size_t port,
                                                                   int tile, const Corners& at) {
  std::array<std::uint16_t, kParities> words{};
  for (std::size_t k = 0; k < kParities; ++k)
    words[k] = read_[at.rom[k]][port].at(
        cycle, static_cast<std::uint64_t>(tile) * kTileWords + at.word[k]);
  return words;
}

AreaTable::Weights AreaTable::weights(Cycle cycle, std::size_t reader, const Query& query) {
  const int from = tile(query.shape);
  if (from < 0) return {};
  // Interpolates between entries with fractions f (first root) and g (second root).
  const auto between = [](const std::array<std::uint16_t, kParities>& words, int drop,
                          std::uint32_t f, std::uint32_t g) {
    const auto entry = [&](std::size_t k) -> std::uint32_t { return words[k] >> drop & 0xFF; };
    const std::uint32_t low = (256 - f) * entry(0) + f * entry(2);
    const std::uint32_t high = (256 - f) * entry(1) + f * entry(3);
    return static_cast<std::uint8_t>(((256 - g) * low + g * high + (1u << 16)) >> 17);
  };
  const auto there = entries(cycle, reader * reads_, from, corners(query.i, query.j));
  if (layout_ != AreaSource::kTableMinimal)
    return {between(there, 8, query.f, query.g), between(there, 0, query.f, query.g)};
  const auto back = entries(cycle, reader * reads_ + 1, from, corners(query.j, query.i));
  const std::uint8_t before = between(there, 0, query.f, query.g);
  const std::uint8_t after = between(back, 0, query.g, query.f);
  const spec::morphological::RunShape& sides = spec::morphological::kRunShapes[query.shape];
  Weights weights;
  const auto give = [&](spec::morphological::Side side, std::uint8_t weight) {
    if (side == spec::morphological::Side::kFirst) weights.first = weight;
    if (side == spec::morphological::Side::kSecond) weights.second = weight;
  };
  give(sides.after, after);
  give(sides.before, before);
  return weights;
}

}  // namespace deburr::rtl::morphological
