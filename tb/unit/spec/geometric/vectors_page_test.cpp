// SPDX-License-Identifier: MIT
// The tables of docs/reference/geometric/vectors.md and algorithm.md are generated from
// spec/geometric/vectors.h.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "spec/geometric/vectors.h"
#include "tb/unit/spec/generated_table.h"

namespace deburr::tb::geometric::vectors_page_test {
namespace {

using spec::geometric::FrameResult;
using spec::geometric::FrameVector;
using spec::geometric::kFrameVectors;
using spec::geometric::kLineVectors;
using spec::geometric::kSpecialFrameVectors;
using spec::geometric::kTrafficFrameVectors;
using spec::geometric::LineVector;

constexpr std::size_t kHashes = 3;  // values of a result before its counters

std::string frames(std::span<const FrameVector> vectors) {
  std::vector<std::string> hash_titles = {"", "preset", "beside it"}, count_titles = {""};
  std::size_t at = 0;
  FrameResult::fields(vectors[0].result, [&](std::string_view title, std::uint64_t) {
    (at++ < kHashes ? hash_titles : count_titles).emplace_back(title);
  });
  MarkdownTable hashes(hash_titles), counts(count_titles);
  for (const FrameVector& v : vectors) {
    const std::string name(1, v.name);
    std::vector<std::string> hash_row = {
        name,
        fmt::format("`{}`", spec::geometric::kPresetNames[static_cast<std::size_t>(v.preset)]),
        v.settings.empty() ? "" : fmt::format("`{}`", v.settings)};
    std::vector<std::string> count_row = {name};
    at = 0;
    FrameResult::fields(v.result, [&](std::string_view, std::uint64_t value) {
      if (at++ < kHashes)
        hash_row.push_back(fmt::format("{:016x}", value));
      else
        count_row.push_back(std::to_string(value));
    });
    hashes.row(hash_row);
    counts.row(count_row);
  }
  return hashes.text() + "\n" + counts.text();
}

std::string lines(std::span<const LineVector> vectors) {
  MarkdownTable table({"M0, m0, d0", "M1, m1, d1", "horizontal", "first, count", "position",
                       "slope", "depth", "step"});
  for (const LineVector& v : vectors) {
    const auto end = [](const spec::geometric::LineEnd& e) {
      return fmt::format("{}, {}, {}", e.major, e.minor, e.depth);
    };
    const auto& r = v.result;
    table.row({end(v.a), end(v.b), v.axis == spec::geometric::Axis::kHorizontal ? "yes" : "no",
               fmt::format("{}, {}", r.first, r.count), std::to_string(r.position),
               std::to_string(r.slope), std::to_string(r.depth), std::to_string(r.step)});
  }
  return table.text();
}

TEST(GeometricVectorsPage, FrameTablesMatchSpec) {
  expect_generated("reference/geometric/vectors.md", "GeometricVectorsPage.FrameTablesMatchSpec",
                   frames(kFrameVectors));
  expect_table_has_each_value(kFrameVectors, frames);
}

TEST(GeometricVectorsPage, SpecialCaseTablesMatchSpec) {
  expect_generated("reference/geometric/vectors.md",
                   "GeometricVectorsPage.SpecialCaseTablesMatchSpec", frames(kSpecialFrameVectors));
  expect_table_has_each_value(kSpecialFrameVectors, frames);
}

TEST(GeometricVectorsPage, LessTrafficTablesMatchSpec) {
  expect_generated("reference/geometric/vectors.md",
                   "GeometricVectorsPage.LessTrafficTablesMatchSpec", frames(kTrafficFrameVectors));
  expect_table_has_each_value(kTrafficFrameVectors, frames);
}

TEST(GeometricVectorsPage, LineTableMatchesSpec) {
  expect_generated("reference/geometric/algorithm.md", "GeometricVectorsPage.LineTableMatchesSpec",
                   lines(kLineVectors));
  expect_table_has_each_value(kLineVectors, lines);
}

}  // namespace
}  // namespace deburr::tb::geometric::vectors_page_test
