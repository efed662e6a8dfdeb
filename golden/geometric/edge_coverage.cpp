// SPDX-License-Identifier: MIT
#include "golden/geometric/edge_coverage.h"

#include <algorithm>
#include <cstdlib>
#include <initializer_list>
#include <string_view>
#include <utility>

namespace deburr::golden::geometric {
namespace {

using spec::geometric::Axis;
using spec::geometric::Crease;
using spec::geometric::EdgeClass;
using spec::geometric::Layout;
using spec::geometric::Select;
using spec::geometric::Vertex;

constexpr std::array<std::string_view, 3> kTurnedAway = {"back/back", "none/crease", "none/flat"};
constexpr std::array<std::string_view, 8> kOctants = {"right-down", "right-up",   "left-down",
                                                      "left-up",    "down-right", "down-left",
                                                      "up-right",   "up-left"};
constexpr std::array<std::string_view, 3> kLengths = {"below-pixel", "below-four", "longer"};
constexpr std::array<std::string_view, 6> kFates = {"line",          "outside",      "degenerate",
                                                    "empty-columns", "empty-before", "empty-after"};
constexpr std::array<std::string_view, 4> kCuts = {"none", "start", "end", "both"};
constexpr std::array<std::string_view, 5> kRows = {"inside", "enters-before", "enters-after",
                                                   "leaves-before", "leaves-after"};
constexpr std::array<std::string_view, 4> kTies = {"horizontal-rising", "horizontal-level",
                                                   "horizontal-falling", "vertical"};
constexpr std::array<std::string_view, 4> kBorders = {"top", "bottom", "left", "right"};
constexpr std::array<std::string_view, 4> kFarther = {"own", "other", "equal", "background"};
constexpr std::array<std::string_view, 2> kTests = {"behind", "passed"};
constexpr std::array<std::string_view, 2> kLimits = {"near", "far"};
constexpr std::array<std::string_view, 2> kBlocks = {"same", "other"};
constexpr std::array<std::string_view, 6> kWeights = {"raised",      "kept",    "equal",
                                                      "overwritten", "lowered", "held"};
constexpr std::array<std::string_view, 4> kGroups = {"length", "across", "along", "line"};
constexpr std::array<std::string_view, 4> kCaches = {"vertex", "depth", "block", "colour"};
constexpr std::array<std::string_view, 4> kFetches = {"hit", "miss", "replaced", "read-back"};
constexpr std::array<std::string_view, 6> kPairs = {"boundary-pair/hit",   "boundary-pair/miss",
                                                    "other-pair/hit",      "other-pair/miss",
                                                    "pair-number/invalid", "pair-vertex/invalid"};
constexpr std::array<std::string_view, 5> kBuffered = {"hit", "empty", "leaves", "full-at-end",
                                                       "not-full-at-end"};
constexpr std::array<std::string_view, 2> kTwoTiles = {"own", "other"};
constexpr std::array<std::string_view, 3> kProbes = {"up-down", "left-right", "tie"};
constexpr std::array<std::string_view, 3> kOriginals = {"none", "above", "left"};

std::string slash(std::initializer_list<std::string_view> parts) {
  std::string name;
  for (const std::string_view part : parts) {
    if (!name.empty()) name += '/';
    name += part;
  }
  return name;
}

// Whether this configuration can produce the class.
bool reachable(Select select, Crease crease, EdgeClass c) {
  if (c == EdgeClass::kInvalid || c == EdgeClass::kBoundary) return true;
  if (select == Select::kAll) return c == EdgeClass::kUnclassified;
  if (c == EdgeClass::kCrease) return crease != Crease::kOff;
  if (c == EdgeClass::kFlat) return true;
  return select == Select::kEdges && c != EdgeClass::kUnclassified;
}

}  // namespace

void EdgeCoverage::count_line(const Vertex& p, const Vertex& q, int width, int height) {
  const int dx = q.x - p.x, dy = q.y - p.y;
  const bool horizontal = std::abs(dx) > std::abs(dy);
  const std::size_t octant = horizontal ? (dx < 0 ? 2u : 0u) + (dy < 0 ? 1u : 0u)
                                        : 4u + (dy < 0 ? 2u : 0u) + (dx < 0 ? 1u : 0u);
  const int length = std::max(std::abs(dx), std::abs(dy));
  ++lines_[octant][length < 256 ? 0u : length < 1024 ? 1u : 2u];
  int major0 = horizontal ? p.x : p.y, major1 = horizontal ? q.x : q.y;
  int minor0 = horizontal ? p.y : p.x, minor1 = horizontal ? q.y : q.x;
  if (major1 < major0) {
    std::swap(major0, major1);
    std::swap(minor0, minor1);
  }
  const int columns = horizontal ? width : height, rows = horizontal ? height : width;
  ++columns_[(major0 + 127 < 0 ? 1u : 0u) + (major1 + 127 >= 256 * (columns + 1) ? 2u : 0u)];
  const auto outside = [&](int minor) { return minor < 0 ? 1u : minor >= 256 * rows ? 2u : 0u; };
  if (outside(minor0) == 0 && outside(minor1) == 0) ++rows_[0];
  if (outside(minor0) != 0) ++rows_[outside(minor0)];
  if (outside(minor1) != 0) ++rows_[2 + outside(minor1)];
}

void EdgeCoverage::count_tie(const spec::geometric::LineRecord& line) {
  if (line.axis == Axis::kVertical) {
    ++ties_[3];
  } else {
    ++ties_[line.slope < 0 ? 0u : line.slope == 0 ? 1u : 2u];
  }
}

void EdgeCoverage::count_depth(std::uint32_t own, std::uint32_t other, bool passed) {
  const std::size_t farther = std::min(own, other) == 0 ? 3u
                              : own < other             ? 0u
                              : other < own             ? 1u
                                                        : 2u;
  ++depths_[farther][passed ? 1u : 0u];
}

void EdgeCoverage::count_turned_away(spec::geometric::Cull cull, EdgeClass c) {
  if (cull == spec::geometric::Cull::kBack) {
    ++turned_away_[0];
  } else {
    ++turned_away_[c == EdgeClass::kCrease ? 1 : 2];
  }
}

void EdgeCoverage::count_weight(spec::geometric::Combine rule, bool nearer,
                                const spec::geometric::Weights& before,
                                spec::geometric::Direction direction, int coverage) {
  std::array<std::uint64_t, 6>& outcomes = weights_[index(direction)];
  const int weight = before[index(direction)];
  if (rule == spec::geometric::Combine::kLast) {
    if (is_blended(before)) ++outcomes[3];
  } else if (rule == spec::geometric::Combine::kOutermost && nearer && weight != 0) {
    ++outcomes[coverage < weight ? 4u : coverage > weight ? 5u : 2u];
  } else {
    ++outcomes[coverage > weight ? 0u : coverage < weight ? 1u : 2u];
  }
}

void EdgeCoverage::count_probe(const spec::geometric::Weights& w) {
  const int vertical = w[0] + w[1], horizontal = w[2] + w[3];
  ++probes_[vertical > horizontal ? 0u : vertical < horizontal ? 1u : 2u];
}

void EdgeCoverage::for_each_bin(const BinSink& sink) const {
  for (std::size_t s = 0; s < classes_.size(); ++s)
    for (std::size_t c = 0; c < classes_[s].size(); ++c)
      for (std::size_t k = 0; k < classes_[s][c].size(); ++k)
        if (reachable(static_cast<Select>(s), static_cast<Crease>(c), static_cast<EdgeClass>(k)))
          sink(slash({"class", spec::geometric::kSelectNames[s], spec::geometric::kCreaseNames[c],
                      spec::geometric::kEdgeClassNames[k]}),
               classes_[s][c][k]);
  const auto list = [&](std::string_view group, const auto& names, const auto& hits,
                        std::size_t from = 0) {
    for (std::size_t i = from; i < names.size(); ++i) sink(slash({group, names[i]}), hits[i]);
  };
  const auto table = [&](std::string_view group, const auto& rows, const auto& columns,
                         const auto& hits) {
    for (std::size_t i = 0; i < rows.size(); ++i) list(slash({group, rows[i]}), columns, hits[i]);
  };
  list("turned-away", kTurnedAway, turned_away_);
  table("line", kOctants, kLengths, lines_);
  list("fate", kFates, fates_, 1);
  list("columns", kCuts, columns_);
  list("rows", kRows, rows_);
  list("tie", kTies, ties_);
  list("border", kBorders, borders_);
  for (std::size_t i = 0; i < kFarther.size(); ++i)
    for (std::size_t k = 0; k < kTests.size(); ++k)
      if (kFarther[i] != "background" || kTests[k] == "passed")
        sink(slash({"depth", kFarther[i], kTests[k]}), depths_[i][k]);
  table("crease", kBorders, kLimits, creases_);
  table("second", kBorders, kBlocks, seconds_);
  table("weight", kBorders, kWeights, weights_);
  list("group", kGroups, groups_);
  for (std::size_t i = 0; i < kCaches.size(); ++i)
    for (std::size_t k = 0; k < kFetches.size(); ++k)
      if (kFetches[k] != "read-back" || kCaches[i] == "block")
        sink(slash({"fetch", kCaches[i], kFetches[k]}), fetches_[i][k]);
  list("fetch", kPairs, pairs_);
  list("fetch/write-buffer", kBuffered, buffered_);
  for (std::size_t i = 0; i < kBorders.size(); ++i)
    sink(slash({"coarse", kBorders[i], "dropped"}), dropped_[i]);
  sink("coarse/equal", coarse_equal_);
  list("coarse/lesser", kTwoTiles, two_tiles_);
  list("resolve", kProbes, probes_);
  list("original", kOriginals, originals_);
  for (std::size_t layout = 0; layout < block_lines_.size(); ++layout) {
    const bool tiled = static_cast<Layout>(layout) == Layout::kTiled;
    for (std::size_t i = 1; i <= (tiled ? kMaxTiledLines : kMaxBlockLines); ++i)
      sink(slash({"lines", spec::geometric::kLayoutNames[layout], std::to_string(i)}),
           block_lines_[layout][i]);
  }
}

std::vector<CoverageBin> EdgeCoverage::bins() const {
  std::vector<CoverageBin> result;
  for_each_bin([&](std::string name, std::uint64_t hits) {
    result.push_back({std::move(name), hits});
  });
  return result;
}

template <class Visit>
void EdgeCoverage::for_each_table(EdgeCoverage& a, const EdgeCoverage& b, Visit&& visit) {
  visit(a.classes_, b.classes_);
  visit(a.turned_away_, b.turned_away_);
  visit(a.lines_, b.lines_);
  visit(a.fates_, b.fates_);
  visit(a.columns_, b.columns_);
  visit(a.rows_, b.rows_);
  visit(a.ties_, b.ties_);
  visit(a.borders_, b.borders_);
  visit(a.depths_, b.depths_);
  visit(a.creases_, b.creases_);
  visit(a.seconds_, b.seconds_);
  visit(a.weights_, b.weights_);
  visit(a.groups_, b.groups_);
  visit(a.fetches_, b.fetches_);
  visit(a.pairs_, b.pairs_);
  visit(a.buffered_, b.buffered_);
  visit(a.dropped_, b.dropped_);
  visit(a.coarse_equal_, b.coarse_equal_);
  visit(a.two_tiles_, b.two_tiles_);
  visit(a.probes_, b.probes_);
  visit(a.originals_, b.originals_);
  visit(a.block_lines_, b.block_lines_);
}

namespace {

void add(std::uint64_t& sum, std::uint64_t more) { sum += more; }
template <class T, std::size_t N>
void add(std::array<T, N>& sum, const std::array<T, N>& more) {
  for (std::size_t i = 0; i < N; ++i) add(sum[i], more[i]);
}

}  // namespace

void EdgeCoverage::merge(const EdgeCoverage& other) {
  for_each_table(*this, other, [](auto& sum, const auto& more) { add(sum, more); });
}

}  // namespace deburr::golden::geometric
