// SPDX-License-Identifier: MIT
// Compares every entry of the texture unit's tables with its formula.
#include "spec/texture/tables.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "spec/texture/descriptor.h"

namespace deburr::tables_test {
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

// Middle of the range of lb(1 + y) - y over eighth i of [0, 1]. The function is concave, with its
// maximum at 1 / ln 2 - 1.
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

double srgb_code(int i) {
  const double linear = std::min(i / 4080.0, 1.0);
  return 255 * (linear <= 0.0031308 ? linear * 12.92 : 1.055 * std::pow(linear, 1 / 2.4) - 0.055);
}

double count_entry(int n) { return n == 0 ? 0 : 4096 * std::log2(n) + 72; }
double reciprocal_entry(int n) { return n == 0 ? 0 : 65536.0 / n; }

// Whether the weights of one kernel and N follow docs/reference/texture/formats.md, "Sample
// walker".
bool right_weights(std::size_t kernel, int n, const std::array<std::uint16_t, 16>& weights) {
  const auto shape = [&](int i) {
    return kernel == 1 && n >= 4 ? std::min(2 * i + 1, 2 * (n - i) - 1) : 1;
  };
  int total = 0;
  for (int i = 0; i < n; ++i) total += shape(i);
  const auto running = [&](int j) {
    int first = 0;
    for (int i = 0; i < std::min(j, n - j); ++i) first += shape(i);
    const auto rounded = static_cast<int>(std::lround(256.0 * first / total));
    return 2 * j <= n ? rounded : 256 - rounded;
  };
  for (int i = 0; i < 16; ++i) {
    const int wanted = i < n ? running(i + 1) - running(i) : 0;
    if (weights[static_cast<std::size_t>(i)] != wanted) return false;
  }
  return true;
}

TEST(TextureTables, EntriesMatchTheirFormulas) {
  EXPECT_EQ(first_wrong(spec::texture::kLinearToSrgb, srgb_code), -1);
  EXPECT_EQ(first_wrong(spec::texture::kLog2Count, count_entry), -1);
  EXPECT_EQ(first_wrong(spec::texture::kReciprocal, reciprocal_entry), -1);
  for (std::size_t kernel = 0; kernel < 2; ++kernel)
    for (std::size_t n = 1; n <= 16; ++n)
      EXPECT_TRUE(
          right_weights(kernel, static_cast<int>(n), spec::texture::kKernelWeights[kernel][n]))
          << kernel << " " << n;
  EXPECT_EQ(first_wrong(spec::texture::kLog2Table, log2_entry), -1);
  EXPECT_EQ(first_wrong(spec::texture::kLog2Correction, correction_entry), -1);
  EXPECT_EQ(first_wrong(spec::texture::kSrgbToLinear, srgb_entry), -1);
}

// Error of each pair of cosine and sine against its exact angle and unit length
// (docs/reference/texture/formats.md, "Axes").
TEST(TextureTables, AxisConstantsAreWithinTheirErrors) {
  for (std::size_t i = 0; i < spec::texture::kAxes.size(); ++i) {
    const spec::texture::Axis& axis = spec::texture::kAxes[i];
    const double cosine = axis.cosine / 128.0, sine = axis.sine / 128.0;
    const double wanted = 22.5 * static_cast<double>(i);
    EXPECT_NEAR(std::atan2(sine, cosine) * 180 / std::numbers::pi, wanted, 0.06) << i;
    EXPECT_NEAR(std::hypot(cosine, sine), 1, 0.006) << i;
    EXPECT_LE(std::hypot(cosine, sine), 1) << i << ": would beat the right candidate beside it";
  }
}

TEST(TextureTables, TilesAre64Bytes) {
  for (const std::size_t bytes : spec::texture::kFormatBytes) {
    if (bytes == 0) continue;  // blocks
    EXPECT_EQ(spec::texture::kTileWidth[bytes] * spec::texture::kTileHeight[bytes] *
                  static_cast<int>(bytes),
              spec::texture::kTileBytes);
  }
}

template <class Table, class Formula>
void expect_wrong_entries_are_found(const Table& table, Formula&& formula) {
  for (std::size_t i = 0; i < table.size(); ++i) {
    auto changed = table;
    changed[i] ^= 1;
    EXPECT_EQ(first_wrong(changed, formula), static_cast<int>(i));
  }
}

TEST(TextureTables, CheckFindsAWrongBitInEveryEntry) {
  expect_wrong_entries_are_found(spec::texture::kLog2Table, log2_entry);
  expect_wrong_entries_are_found(spec::texture::kLog2Correction, correction_entry);
  expect_wrong_entries_are_found(spec::texture::kLog2Count, count_entry);
  expect_wrong_entries_are_found(spec::texture::kReciprocal, reciprocal_entry);
  expect_wrong_entries_are_found(spec::texture::kSrgbToLinear, srgb_entry);
  for (std::size_t kernel = 0; kernel < 2; ++kernel) {
    for (std::size_t n = 1; n <= 16; ++n) {
      for (std::size_t i = 0; i < 16; ++i) {
        auto weights = spec::texture::kKernelWeights[kernel][n];
        weights[i] ^= 1;
        EXPECT_FALSE(right_weights(kernel, static_cast<int>(n), weights));
      }
    }
  }
}

}  // namespace
}  // namespace deburr::tables_test
