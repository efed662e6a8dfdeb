// SPDX-License-Identifier: MIT
// The tables of docs/reference/morphological/vectors.md, and of runs in algorithm.md, are generated
// from spec/morphological/vectors.h.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "spec/morphological/vectors.h"
#include "tb/unit/spec/generated_table.h"
#include "tb/unit/spec/morphological/vector_images.h"

namespace deburr::tb::morphological::vectors_page_test {
namespace {

using namespace spec::morphological;  // NOLINT: the tested names

std::string hash_text(std::uint64_t hash) { return fmt::format("{:016x}", hash); }

// "mlaa", "smaa high".
std::string configuration_of(const FrameVector& v) {
  const auto preset = static_cast<std::size_t>(v.preset);
  return kPresets[preset].has_qualities
             ? fmt::format("{} {}", kPresetNames[preset],
                           kQualityNames[static_cast<std::size_t>(v.quality)])
             : std::string(kPresetNames[preset]);
}

std::string frames(std::span<const FrameVector> vectors) {
  std::vector<std::string> titles = {"vector", "image", "preset", "settings"};
  FrameResult::fields(vectors[0].result,
                      [&](std::string_view title, std::uint64_t) { titles.emplace_back(title); });
  MarkdownTable table(titles);
  for (const FrameVector& v : vectors) {
    std::vector<std::string> row = {
        std::string(v.name), std::string(kVectorImageNames[static_cast<std::size_t>(v.image)]),
        configuration_of(v), v.settings.empty() ? "" : fmt::format("`{}`", v.settings)};
    FrameResult::fields(v.result, [&](std::string_view title, std::uint64_t value) {
      row.push_back(title == "hash" ? hash_text(value) : std::to_string(value));
    });
    table.row(row);
  }
  return table.text();
}

std::string runs(std::span<const RunVector> vectors) {
  MarkdownTable table({"corners", "scale", "offset", "slope", "inverse", "shift", "span",
                       "weights (b before, a after)"});
  for (const RunVector& v : vectors) {
    std::string corners;
    for (int i = 0; i < v.count; ++i)
      corners += fmt::format("{}{}{}{}", i == 0 ? "" : ", ", v.count > 2 && i == v.start ? "[" : "",
                             v.corners[static_cast<std::size_t>(i)],
                             v.count > 2 && i == v.start + 1 ? "]" : "");
    std::vector<std::string> row = {corners};
    RunResult::fields(v.result, [&](std::string_view, std::int64_t value) {
      row.push_back(std::to_string(value));
    });
    row.emplace_back(v.weights);
    table.row(row);
  }
  return table.text();
}

// The rows of a drawing, one per line.
std::string in_rows(std::string_view drawing) {
  std::string rows;
  for (const char c : drawing) rows += c == ' ' ? std::string("` `") : std::string(1, c);
  return fmt::format("`{}`", rows);
}

std::string patterns(std::span<const PatternVector> vectors) {
  MarkdownTable table({"frame", "quality", "rows", "weights", "taken", "hash"});
  for (const PatternVector& v : vectors) {
    table.row({std::string(v.name), std::string(kQualityNames[static_cast<std::size_t>(v.quality)]),
               in_rows(v.rows), std::string(v.weights), std::to_string(v.result.diagonal_pixels),
               hash_text(v.result.hash)});
  }
  return table.text();
}

std::string limits(std::span<const LimitVector> vectors) {
  MarkdownTable table({"L", "first/second of each pixel", "hash"});
  for (const LimitVector& v : vectors)
    table.row({std::to_string(v.length), std::string(v.weights), hash_text(v.result.hash)});
  return table.text();
}

std::string drawings(std::span<const GuardVector> vectors) {
  MarkdownTable table({"frame", "rows", "guarded (g)"});
  for (const GuardVector& v : vectors)
    table.row({std::string(v.name), in_rows(v.rows), in_rows(v.guarded)});
  return table.text();
}

std::string hashes(const TableHashes& all) {
  MarkdownTable table({"table", "order", "hash"});
  auto order = kTableOrders.begin();
  TableHashes::fields(all, [&](std::string_view name, std::uint64_t hash) {
    table.row({std::string(name), std::string(*order++), hash_text(hash)});
  });
  return table.text();
}

std::string weights(std::span<const TableVector> vectors) {
  MarkdownTable table({"l, r", "T(l, r)", "U(l, r)"});
  for (const TableVector& v : vectors)
    table.row({fmt::format("{}, {}", v.l, v.r), std::to_string(v.result.half),
               std::to_string(v.result.dip)});
  return table.text();
}

constexpr const char* kPage = "reference/morphological/vectors.md";

TEST(MorphologicalVectorsPage, FrameTableMatchesSpec) {
  expect_generated(kPage, "MorphologicalVectorsPage.FrameTableMatchesSpec", frames(kFrameVectors));
  expect_table_has_each_value(kFrameVectors, frames);
}

TEST(MorphologicalVectorsPage, SmaaFrameTableMatchesSpec) {
  expect_generated(kPage, "MorphologicalVectorsPage.SmaaFrameTableMatchesSpec",
                   frames(kSmaaFrameVectors));
}

TEST(MorphologicalVectorsPage, GuardFrameTableMatchesSpec) {
  expect_generated(kPage, "MorphologicalVectorsPage.GuardFrameTableMatchesSpec",
                   frames(kGuardFrameVectors));
}

TEST(MorphologicalVectorsPage, GuardDrawingTableMatchesSpec) {
  expect_generated(kPage, "MorphologicalVectorsPage.GuardDrawingTableMatchesSpec",
                   drawings(kGuardVectors));
  auto changed = kGuardVectors;
  changed.back().guarded = "--- --g ---";  // the injected fault
  EXPECT_NE(drawings(changed), drawings(kGuardVectors));
}

TEST(MorphologicalVectorsPage, RunTableMatchesSpec) {
  expect_generated("reference/morphological/algorithm.md",
                   "MorphologicalVectorsPage.RunTableMatchesSpec", runs(kRunVectors));
  expect_table_has_each_value(kRunVectors, runs);
}

TEST(MorphologicalVectorsPage, PatternTableMatchesSpec) {
  expect_generated(kPage, "MorphologicalVectorsPage.PatternTableMatchesSpec",
                   patterns(kPatternVectors));
  expect_table_has_each_value(kPatternVectors, patterns);
}

TEST(MorphologicalVectorsPage, LimitTableMatchesSpec) {
  expect_generated(kPage, "MorphologicalVectorsPage.LimitTableMatchesSpec", limits(kLimitVectors));
  expect_table_has_each_value(kLimitVectors, limits);
}

TEST(MorphologicalVectorsPage, RomHashesMatchSpec) {
  expect_generated(kPage, "MorphologicalVectorsPage.RomHashesMatchSpec", hashes(kTableHashes));
  TableHashes changed = kTableHashes;
  changed.mix ^= 1;  // the injected fault
  EXPECT_NE(hashes(changed), hashes(kTableHashes));
}

TEST(MorphologicalVectorsPage, AreaWeightTableMatchesSpec) {
  expect_generated(kPage, "MorphologicalVectorsPage.AreaWeightTableMatchesSpec",
                   weights(kTableVectors));
  expect_table_has_each_value(kTableVectors, weights);
}

TEST(MorphologicalVectors, NamesAreUnique) {
  std::set<std::string_view> names;
  for (const FrameVector& v : frame_vectors()) EXPECT_TRUE(names.insert(v.name).second) << v.name;
  EXPECT_EQ(names.size(), 70u);
}

}  // namespace
}  // namespace deburr::tb::morphological::vectors_page_test
