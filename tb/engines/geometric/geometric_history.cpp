// SPDX-License-Identifier: MIT
#include "tb/engines/geometric/geometric_history.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>

namespace deburr::tb {
namespace {

using spec::geometric::BlockRecord;
using spec::geometric::Candidate;
using spec::geometric::LineRecord;

// A line can blend pixels on both sides of its crossing in a column.
constexpr double kLineDistance = 1.5;  // pixels, from the centre

double minor_at(const LineRecord& line, int column) {
  const auto steps = static_cast<double>(column - line.first);
  return (static_cast<double>(line.position) + steps * line.slope) / (1 << 24);
}

std::string text_of(const LineRecord& l) {
  return fmt::format("{} columns {}..{}, slope {}{}",
                     l.axis == spec::geometric::Axis::kHorizontal ? "horizontal" : "vertical",
                     l.first, l.first + l.count - 1, static_cast<double>(l.slope) / (1 << 24),
                     l.crease ? ", crease" : "");
}
std::string text_of(const Candidate& c) {
  return fmt::format("{} coverage {}, depth {:#x} {}",
                     spec::geometric::kDirectionNames[static_cast<std::size_t>(c.direction)],
                     c.coverage, c.depth, c.passed ? "passed" : "failed");
}
// Formats four weights or a colour.
std::string text_of(const std::array<std::uint8_t, 4>& v) {
  return fmt::format("{}, {}, {}, {}", v[0], v[1], v[2], v[3]);
}

}  // namespace

void GeometricHistory::begin() {
  lines_.clear();
  candidates_.clear();
  blocks_.clear();
}

bool GeometricHistory::passes(const LineRecord& line) const {
  const bool horizontal = line.axis == spec::geometric::Axis::kHorizontal;
  const int column = horizontal ? pixel_.x : pixel_.y, row = horizontal ? pixel_.y : pixel_.x;
  return column >= line.first && column < line.first + line.count &&
         std::abs(minor_at(line, column) - (row + 0.5)) <= kLineDistance;
}

void GeometricHistory::see(const LineRecord& line, rtl::Cycle cycle) {
  if (passes(line)) lines_.emplace_back(line, cycle);
}
void GeometricHistory::see(const Candidate& candidate, rtl::Cycle cycle) {
  if (is_here(candidate)) candidates_.emplace_back(candidate, cycle);
}
void GeometricHistory::see(const BlockRecord& block, rtl::Cycle cycle) {
  if (is_here(block)) blocks_.emplace_back(block, cycle);
}

PixelHistory GeometricHistory::history(const geometric::Frame& frame, const Image& after,
                                       bool ended,
                                       const golden::geometric::GeometricGolden* golden) const {
  PixelHistory all{pixel_};
  if (golden && golden->pixels().size() != frame.image.pixels.size()) golden = nullptr;
  const std::size_t at = frame.image.index(pixel_.x, pixel_.y);
  const auto input = [&](std::string step, std::string item, const std::string& value) {
    all.compare({.part = {},
                 .step = std::move(step),
                 .item = std::move(item),
                 .golden = value,
                 .hardware = value});
  };
  input("input", "RGBA", text_of(frame.image.pixels[at]));
  if (at < frame.depths.size())
    input("input", "depth", fmt::format("{:#x}", frame.depths[at] & 0xFFFFFF));

  const PixelSides came{golden != nullptr, ended};
  // Golden model and hardware produce records in the same order.
  const auto pair_up = [&](const auto& seen, const auto& expected, const char* step,
                           const auto& wanted) {
    auto here = expected;
    std::erase_if(here, [&](const auto& one) { return !wanted(one); });
    int number = 0;
    all.compare_records(
        here.size(), seen.size(),
        [&](std::size_t g, std::size_t h) { return here[g] == seen[h].first; },
        [&](PixelHistory::Record g, PixelHistory::Record h) {
          PixelStep row{.part = {},
                        .step = step,
                        .item = std::to_string(number++),
                        .golden = g ? text_of(here[*g]) : "",
                        .hardware = h ? text_of(seen[*h].first) : ""};
          if (h) row.clock = seen[*h].second;
          return row;
        },
        came);
  };
  static const std::vector<LineRecord> kNoLines;
  static const std::vector<Candidate> kNoCandidates;
  pair_up(lines_, golden ? golden->lines() : kNoLines, "line",
          [this](const LineRecord& line) { return passes(line); });
  pair_up(candidates_, golden ? golden->candidates() : kNoCandidates, "candidate",
          [this](const Candidate& candidate) { return is_here(candidate); });

  const auto in_block = static_cast<std::size_t>(pixel_.y % 4 * 4 + pixel_.x % 4);
  std::optional<std::uint64_t> resolved;
  if (!blocks_.empty()) resolved = blocks_.back().second;
  const bool touched = golden && std::any_of(golden->blocks().begin(), golden->blocks().end(),
                                             [this](const BlockRecord& b) { return is_here(b); });
  all.compare_records(
      touched ? 1 : 0, blocks_.size(),
      [&](std::size_t, std::size_t h) {
        return golden->weights()[at] == blocks_[h].first.weights[in_block];
      },
      [&](PixelHistory::Record g, PixelHistory::Record h) {
        PixelStep row{.part = {},
                      .step = "weights",
                      .item = "up, down, left, right",
                      .golden = g ? text_of(golden->weights()[at]) : "",
                      .hardware = h ? text_of(blocks_[*h].first.weights[in_block]) : ""};
        if (h) row.clock = blocks_[*h].second;
        return row;
      },
      came);
  if (!ended && !blocks_.empty())
    all.note = "the run was cut short after its block of 4 x 4 pixels was resolved";
  else if (!ended && (touched || !golden))
    all.note = "the run was cut short before its block of 4 x 4 pixels was resolved";
  else if (!ended)
    all.note = "the run was cut short";
  else if (!touched && blocks_.empty())
    all.note = "no candidate in its block of 4 x 4 pixels passes the depth test";
  // Memory may still hold the old pixel.
  const bool written = ended || after.pixels[at] != frame.image.pixels[at];
  all.compare({.part = {},
               .step = "colour",
               .item = "RGBA",
               .golden = golden ? text_of(golden->pixels()[at]) : "",
               .hardware = written ? text_of(after.pixels[at]) : "",
               .clock = resolved});
  return all;
}

}  // namespace deburr::tb
