// SPDX-License-Identifier: MIT
// Measures the distance from the published SMAA. From equal edges, the weights of
// golden/morphological are compared with golden/ideal/smaa as published: its sampler's border, its
// area texture's bytes. The oracle's bytes are checked against the published files if these are
// present (DEBURR_DATA).
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "golden/ideal/smaa.h"
#include "golden/morphological/area_table.h"
#include "golden/morphological/diagonals.h"
#include "golden/morphological/morphological_golden.h"
#include "tb/oracle/smaa_files.h"
#include "tb/oracle/smaa_frames.h"
#include "tb/unit/scene/fixtures.h"
#include "tb/unit/spec/generated_table.h"

namespace deburr::tb::smaa_published_test {
namespace {

using golden::ideal::SmaaBorder;
using golden::ideal::SmaaBytes;
using golden::ideal::SmaaEdges;
using golden::ideal::SmaaPixelWeights;
using golden::ideal::SmaaSettings;
using golden::ideal::SmaaWeights;
using golden::morphological::EdgeWeights;
using golden::morphological::MorphologicalGolden;
using spec::morphological::AreaValues;
using spec::morphological::Border;
using spec::morphological::Parameters;
using spec::morphological::Preset;
using spec::morphological::Quality;

// ---- the published tables -----------------------------------------------------------------------

// The error names the file, its size and what to do.
TEST(SmaaFiles, FilesWithOtherBytesAreRejected) {
  const test::TemporaryFolder folder;
  const std::filesystem::path path = folder / "SearchTex.h";
  const auto error = [&](std::size_t expected) {
    try {
      smaa_bytes(path, expected);
    } catch (const spec::FileError& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  EXPECT_EQ(error(3),
            fmt::format("'{}' cannot be read: take the files of SMAA's repository", path.string()));
  folder.write("SearchTex.h", "bytes[] = { 0x01, 0x02, 0xff };\n");
  EXPECT_EQ(error(3), "");
  EXPECT_EQ(error(4), fmt::format("'{}' has 3 bytes between its braces, expected 4: take the files "
                                  "of SMAA's repository",
                                  path.string()));
}

class PublishedTables : public testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(smaa_file("AreaTex.h"))) GTEST_SKIP() << no_smaa_file("AreaTex.h");
  }
};

// Row of subsample offset 0.
TEST_F(PublishedTables, AreasMatchTheOracle) {
  const std::vector<std::uint8_t> texture = smaa_bytes(smaa_file("AreaTex.h"), kSmaaAreaBytes);
  const auto expect = [&](int x, int y, const SmaaBytes& entry, const std::string& what) {
    const auto at = static_cast<std::size_t>(2 * (y * kSmaaAreaWidth + x));
    EXPECT_EQ(texture[at], entry.r) << what;
    EXPECT_EQ(texture[at + 1], entry.g) << what;
  };
  // 4e of an end by its crossings: N has weight 1, S weight 3.
  for (int pattern = 0; pattern < 16; ++pattern) {
    const int start = 3 * (pattern & 1) + (pattern >> 2 & 1),
              end = 3 * (pattern >> 1 & 1) + (pattern >> 3 & 1);
    for (int i = 0; i < 16; ++i)
      for (int j = 0; j < 16; ++j)
        expect(16 * start + i, 16 * end + j, golden::ideal::smaa_area_bytes(pattern, i * i, j * j),
               fmt::format("pattern {}, roots {} and {}", pattern, i, j));
  }
  for (int e1 = 0; e1 < 4; ++e1)
    for (int e2 = 0; e2 < 4; ++e2)
      for (int d1 = 0; d1 < 20; ++d1)
        for (int d2 = 0; d2 < 20; ++d2)
          expect(80 + 20 * e1 + d1, 20 * e2 + d2,
                 golden::ideal::smaa_diagonal_bytes(e1, e2, d1, d2),
                 fmt::format("diagonal {}, {}, distances {} and {}", e1, e2, d1, d2));
}

// Table values with area_values = published: a byte v becomes v / 255, rounded to nearest.
TEST_F(PublishedTables, AreaValuesMatchTheTables) {
  const std::vector<std::uint8_t> texture = smaa_bytes(smaa_file("AreaTex.h"), kSmaaAreaBytes);
  const auto byte = [&](int x, int y, int channel) {
    return texture[static_cast<std::size_t>(2 * (y * kSmaaAreaWidth + x) + channel)];
  };
  const auto nearest = [](int value, int one) { return (2 * one * value + 255) / 510; };
  const golden::morphological::FullAreaTable areas(AreaValues::kPublished);
  for (int pattern = 0; pattern < 16; ++pattern) {
    const int start = 3 * (pattern & 1) + (pattern >> 2 & 1),
              end = 3 * (pattern >> 1 & 1) + (pattern >> 3 & 1);
    for (int i = 0; i < 16; ++i)
      for (int j = 0; j < 16; ++j) {
        const auto entry = areas.entry(pattern, i, j);
        EXPECT_EQ(entry.second, nearest(byte(16 * start + i, 16 * end + j, 0), 512));
        EXPECT_EQ(entry.first, nearest(byte(16 * start + i, 16 * end + j, 1), 512));
      }
  }
  const golden::morphological::DiagonalTable diagonals(AreaValues::kPublished);
  for (int e1 = 0; e1 < 4; ++e1)
    for (int e2 = 0; e2 < 4; ++e2)
      for (int d1 = 0; d1 < 20; ++d1)
        for (int d2 = 0; d2 < 20; ++d2) {
          const auto entry = diagonals.at(e1, e2, d1, d2);
          const int x = 80 + 20 * e1 + d1, y = 20 * e2 + d2;
          EXPECT_EQ(entry.a, std::min(255, nearest(byte(x, y, 0), 256)));
          EXPECT_EQ(entry.b, std::min(255, nearest(byte(x, y, 1), 256)));
        }
}

// Differences between exact areas of diagonals and the published bytes, in 1/255. Two causes:
// sample points on the line count as A unless rounding puts them below it, and bytes are rounded
// down. Where two diagonals cross, one side of an edge gets A of one and B of the other.
TEST(ExactDiagonals, AreasDifferFromPublishedBytes) {
  const golden::morphological::DiagonalTable exact(AreaValues::kExact);
  double least = 0, most_a = 0, most_b = 0;
  for (int e1 = 0; e1 < 4; ++e1)
    for (int e2 = 0; e2 < 4; ++e2)
      for (int d1 = 0; d1 < 20; ++d1)
        for (int d2 = 0; d2 < 20; ++d2) {
          const SmaaBytes bytes = golden::ideal::smaa_diagonal_bytes(e1, e2, d1, d2);
          const auto entry = exact.at(e1, e2, d1, d2);
          const double a = 255 * entry.a / 256.0 - bytes.r, b = 255 * entry.b / 256.0 - bytes.g;
          least = std::min({least, a, b});
          most_a = std::max(most_a, a);
          most_b = std::max(most_b, b);
        }
  EXPECT_GT(least, -0.5);
  EXPECT_NEAR(most_a, 2.7, 0.05);
  EXPECT_NEAR(most_b, 1.0, 0.05);
  EXPECT_LT(most_a + most_b, 3.7);
}

// A fetch encodes its four edges with weights 1, 3, 7 and 21 of 32; the texture is cropped and
// upside down.
TEST_F(PublishedTables, SearchesMatchTheOracle) {
  const std::vector<std::uint8_t> texture = smaa_bytes(smaa_file("SearchTex.h"), kSmaaSearchBytes);
  constexpr std::array<int, 4> kWeights = {1, 3, 7, 21};
  for (int bits = 0; bits < 256; ++bits) {
    std::array<bool, 4> across{}, along{};
    int r = 0, g = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      across[i] = (bits >> i & 1) != 0;
      along[i] = (bits >> (4 + i) & 1) != 0;
      r += across[i] ? kWeights[i] : 0;
      g += along[i] ? kWeights[i] : 0;
    }
    for (const bool right : {false, true}) {
      const int x = std::min(kSmaaSearchWidth - 1, r + (right ? 33 : 0)),
                y = std::min(kSmaaSearchHeight - 1, 32 - g);
      EXPECT_EQ(texture[static_cast<std::size_t>(kSmaaSearchWidth * y + x)],
                127 * golden::ideal::smaa_search_length(across, along, right))
          << bits << (right ? " right" : " left");
    }
  }
}

// ---- edges --------------------------------------------------------------------------------------

// Luma edges differ only where the rounding of luma's three weights, up to 2^-17 each, decides.
TEST(PublishedSmaa, EdgesAreCloseToPublished) {
  constexpr double kRounding = 3.0 / 131072;
  std::vector<Image> all = smaa_frames();
  all.push_back(random_colours(700, 500));
  MarkdownTable table({"quality", "luma edges", "that differ", "not by luma's rounding"});
  for (const Quality quality : kSmaaQualities) {
    const double threshold = smaa_settings(quality).threshold;
    int edges = 0, differing = 0, unexplained = 0;
    for (const Image& image : all) {
      MorphologicalGolden golden(golden::morphological::preset_parameters(Preset::kSmaa, quality));
      golden.process({image.pixels, image.width, image.height});
      golden::ideal::SmaaLuma luma{{}, image.width, image.height};
      for (const auto& p : image.pixels)
        luma.values.push_back((0.2126 * p[0] + 0.7152 * p[1] + 0.0722 * p[2]) / 255);
      const auto compare = [&](bool edge, const golden::ideal::SmaaMargins& ideal) {
        edges += ideal.edge();
        if (edge == ideal.edge()) return;
        ++differing;
        unexplained +=
            std::abs(ideal.threshold) > kRounding && std::abs(ideal.contrast) > 2 * kRounding;
      };
      for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
          compare(golden.edges().left.at(x, y), left_margins(luma, threshold, x, y));
          compare(golden.edges().top.at(x, y), top_margins(luma, threshold, x, y));
        }
    }
    EXPECT_EQ(unexplained, 0);
    EXPECT_LT(differing, edges / 10000);
    table.row({name_of(quality), fmt::format("{}", edges), fmt::format("{}", differing),
               fmt::format("{}", unexplained)});
  }
  expect_generated("reference/morphological/smaa.md", "PublishedSmaa.EdgesAreCloseToPublished",
                   table.text());
}

// ---- weights ------------------------------------------------------------------------------------

// Differences of the weights of all edges, in 1/255.
struct Differences {
  int edges = 0, over_1 = 0, over_3 = 0;
  int sums_over_3 = 0;  // where the areas of two diagonals add up
  double largest = 0;
  void add(const SmaaWeights& published, EdgeWeights found, bool two_diagonals = false) {
    ++edges;
    const double off = 255 * std::max(std::abs(published.first - found.first / 256.0),
                                      std::abs(published.second - found.second / 256.0));
    over_1 += off > 1 ? 1 : 0;
    over_3 += off > 3.1 ? 1 : 0;
    sums_over_3 += two_diagonals && off > 3.1 ? 1 : 0;
    largest = std::max(largest, off);
  }
};

Differences differences(Quality quality, const std::vector<Image>& frames,
                        const SmaaSettings& ideal, void (*change)(Parameters&) = nullptr,
                        SmaaBorder border = SmaaBorder::kClamp) {
  Differences found;
  for (const Image& image : frames) {
    Parameters p = golden::morphological::preset_parameters(Preset::kSmaa, quality);
    if (change != nullptr) change(p);
    MorphologicalGolden golden(p);
    golden.process({image.pixels, image.width, image.height});
    const auto two_diagonals = [&](int x, int y) {
      return p.diagonals &&
             rising_diagonal(golden.edges(), p.diagonal_steps, x, y, p.border).counts() &&
             falling_diagonal(golden.edges(), p.diagonal_steps, x, y, p.border).counts();
    };
    SmaaEdges edges(image.width, image.height, border);
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x) {
        edges.set_left(x, y, golden.edges().left.at(x, y));
        edges.set_top(x, y, golden.edges().top.at(x, y));
      }
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x) {
        if (!edges.top(x, y) && !edges.left(x, y)) continue;
        const SmaaPixelWeights weights = smaa_weights(edges, ideal, x, y);
        if (edges.top(x, y)) found.add(weights.top, golden.top_weights(x, y), two_diagonals(x, y));
        if (edges.left(x, y)) found.add(weights.left, golden.left_weights(x, y));
      }
  }
  return found;
}

TEST(PublishedSmaa, WeightsAreCloseToPublished) {
  const std::vector<Image> all = smaa_frames();
  MarkdownTable table({"quality", "edges", "preset: over 1", "over 3.1", "largest",
                       "published values: over 1", "over 3.1", "largest ", "border ends: over 1",
                       "over 3.1", "largest  "});
  for (const Quality quality : kSmaaQualities) {
    const SmaaSettings ideal = smaa_settings(quality);
    const auto with_bytes = [](Parameters& p) { p.area_values = AreaValues::kPublished; };
    const auto ending = [](Parameters& p) { p.border = Border::kEnd; };
    const Differences preset = differences(quality, all, ideal);
    const Differences published = differences(quality, all, ideal, with_bytes);
    const Differences ends = differences(quality, all, ideal, ending);
    const Differences both_end = differences(quality, all, ideal, ending, SmaaBorder::kEnd);
    EXPECT_GT(preset.edges, 10000);
    // Only bytes and diagonals differ. Where two diagonals cross, A of one and B of the other add
    // up (ExactDiagonals.AreasDifferFromPublishedBytes).
    EXPECT_EQ(preset.over_3, preset.sums_over_3);
    EXPECT_LE(preset.largest, 3.7);
    EXPECT_LE(preset.over_3, 1);
    EXPECT_EQ(both_end.over_3, 0);
    EXPECT_EQ(published.over_1, 0) << "nothing differs but by rounding";
    EXPECT_GT(ends.over_3, 0) << "the border is seen";
    std::vector<std::string> row = {name_of(quality), fmt::format("{}", preset.edges)};
    for (const Differences* d : {&preset, &published, &ends})
      row.insert(row.end(), {fmt::format("{}", d->over_1), fmt::format("{}", d->over_3),
                             fmt::format("{:.1f}", d->largest)});
    table.row(row);
  }
  expect_generated("reference/morphological/smaa.md", "PublishedSmaa.WeightsAreCloseToPublished",
                   table.text());
}

// The comparison detects changed searches, diagonals and corners, and areas not rounded to bytes.
TEST(PublishedSmaa, OtherSettingsAreDetected) {
  const std::vector<Image> all = smaa_frames();
  const auto over_1 = [&](void (*change)(SmaaSettings&)) {
    SmaaSettings ideal = smaa_settings(Quality::kHigh);
    change(ideal);
    return differences(Quality::kHigh, all, ideal).over_1;
  };
  const int published = over_1([](SmaaSettings&) {});
  EXPECT_GT(over_1([](SmaaSettings& s) { s.search_steps = 4; }), published + 10);
  EXPECT_GT(over_1([](SmaaSettings& s) { s.diagonal_steps = 4; }), published + 10);
  EXPECT_GT(over_1([](SmaaSettings& s) { s.corner_keeps = 1; }), published + 10);
  EXPECT_LT(over_1([](SmaaSettings& s) { s.bytes = false; }), published);
}

}  // namespace
}  // namespace deburr::tb::smaa_published_test
