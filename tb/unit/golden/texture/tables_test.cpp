// SPDX-License-Identifier: MIT
// Every entry of the texture unit's tables is what its formula gives.
#include "spec/texture/tables.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "spec/texture/descriptor.h"

namespace deburr {
namespace {

// Index of the first entry that differs from formula(i), or -1.
template <class Table, class Formula>
int first_wrong(const Table& table, Formula&& formula) {
  for (std::size_t i = 0; i < table.size(); ++i) {
    if (static_cast<long>(table[i]) != std::lround(formula(static_cast<int>(i)))) {
      return static_cast<int>(i);
    }
  }
  return -1;
}

double log2_entry(int i) { return 4096 * std::log2(1 + i / 64.0); }

// Middle of the range of lb(1 + y) - y, concave with its top at 1 / ln 2 - 1, in eighth i.
double correction_entry(int i) {
  const auto gap = [](double y) { return std::log2(1 + y) - y; };
  const double from = i / 8.0, to = (i + 1) / 8.0, top = 1 / std::log(2.0) - 1;
  const double low = std::min(gap(from), gap(to));
  const double high = top > from && top < to ? gap(top) : std::max(gap(from), gap(to));
  return 4096 * (low + high) / 2;
}

double srgb_entry(int i) {
  const double c = i / 255.0;
  return 4080 * (c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4));
}

TEST(TextureTables, AreWhatTheirFormulasGive) {
  EXPECT_EQ(first_wrong(spec::texture::kLog2Table, log2_entry), -1);
  EXPECT_EQ(first_wrong(spec::texture::kLog2Correction, correction_entry), -1);
  EXPECT_EQ(first_wrong(spec::texture::kSrgbToLinear, srgb_entry), -1);
}

TEST(TextureTables, TilesAre64Bytes) {
  for (const std::size_t bytes : spec::texture::kFormatBytes) {
    EXPECT_EQ(spec::texture::kTileWidth[bytes] * spec::texture::kTileHeight[bytes] *
                  static_cast<int>(bytes),
              spec::texture::kTileBytes);
  }
}

TEST(TextureTables, CheckFindsOneWrongBitAnywhere) {
  for (std::size_t i = 0; i < spec::texture::kLog2Table.size(); ++i) {
    auto table = spec::texture::kLog2Table;
    table[i] ^= 1;
    EXPECT_EQ(first_wrong(table, log2_entry), static_cast<int>(i));
  }
  for (std::size_t i = 0; i < spec::texture::kLog2Correction.size(); ++i) {
    auto table = spec::texture::kLog2Correction;
    table[i] ^= 1;
    EXPECT_EQ(first_wrong(table, correction_entry), static_cast<int>(i));
  }
  for (std::size_t i = 0; i < spec::texture::kSrgbToLinear.size(); ++i) {
    auto table = spec::texture::kSrgbToLinear;
    table[i] ^= 1;
    EXPECT_EQ(first_wrong(table, srgb_entry), static_cast<int>(i));
  }
}

}  // namespace
}  // namespace deburr
