// SPDX-License-Identifier: MIT
#include "tb/engines/morphological/morphological_history.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <string_view>

#include "spec/morphological/shapes.h"

namespace deburr::tb {

using golden::morphological::MorphologicalGolden;
using golden::morphological::PredictedRun;
using spec::morphological::Axis;
using spec::morphological::BlendProbe;
using spec::morphological::LineDescriptor;
using spec::morphological::Rgba8;
using spec::morphological::RunDescriptor;

struct MorphologicalHistory::Side {
  std::string_view name;
  Axis axis;   // of its runs
  int beyond;  // offset of the line of runs from the pixel's own row or column
};

namespace {

std::string text_of(const Rgba8& p) {
  return fmt::format("{}, {}, {}, {}", p[0], p[1], p[2], p[3]);
}

std::string edges_of(const BlendProbe& probe) {
  constexpr std::array<std::string_view, 4> kNames = {"none", "left", "top", "left and top"};
  return std::string(kNames[probe.edges & 3]);
}
std::string weights_of(const BlendProbe& probe) {
  if (probe.first == 0 && probe.second == 0) return "none";
  return fmt::format("{} {}, {}", probe.horizontal ? "left, right" : "up, down", probe.first,
                     probe.second);
}
std::string signals_of(bool first, bool last) {
  return fmt::format("{}, {}", first ? "yes" : "no", last ? "yes" : "no");
}
std::string text_of(const RunDescriptor& r) {
  constexpr std::array<std::string_view, 3> kParts = {"", " (head)", " (tail)"};
  return fmt::format("{}..{} {}{}", r.start, r.start + r.length - 1,
                     spec::morphological::kRunShapes[r.shape & 15].name,
                     kParts[static_cast<std::size_t>(r.part)]);
}
std::string text_of(const LineDescriptor& l) {
  if (l.learned)
    return fmt::format("{}..{} learned, crossings {} and {}", l.run.start,
                       l.run.start + l.run.length - 1, l.start_class, l.end_class);
  return fmt::format("{}..{} steps {} and {}, slope {}, span {}", l.run.start,
                     l.run.start + l.run.length - 1, l.left_steps, l.right_steps,
                     static_cast<double>(l.slope) / (1 << 24), l.span);
}

// Whether the run has a line: it has a side, or its weights are learned.
bool has_line(const LineDescriptor& line) {
  const spec::morphological::RunShape& shape = spec::morphological::kRunShapes[line.run.shape & 15];
  return line.learned || shape.before != spec::morphological::Side::kNone ||
         shape.after != spec::morphological::Side::kNone;
}

const RunDescriptor& run_of(const RunDescriptor& run) { return run; }
const RunDescriptor& run_of(const LineDescriptor& line) { return line.run; }

// Compares the records of those runs that `wanted` selects, in the order of runs.
template <class Descriptor, class Wanted>
void add_descriptors(const std::string& step, const std::string& item,
                     const std::vector<std::pair<Descriptor, rtl::Cycle>>& seen,
                     std::vector<Descriptor> expected, const Wanted& wanted, const PixelSides& came,
                     PixelHistory& all) {
  std::vector<std::pair<Descriptor, rtl::Cycle>> here;
  for (const auto& one : seen)
    if (wanted(run_of(one.first))) here.push_back(one);
  std::erase_if(expected, [&](const Descriptor& one) { return !wanted(run_of(one)); });
  const auto before = [](const Descriptor& a, const Descriptor& b) {
    return std::pair(run_of(a).start, run_of(a).part) < std::pair(run_of(b).start, run_of(b).part);
  };
  std::stable_sort(here.begin(), here.end(),
                   [&](const auto& a, const auto& b) { return before(a.first, b.first); });
  std::stable_sort(expected.begin(), expected.end(), before);
  all.compare_records(
      expected.size(), here.size(),
      [&](std::size_t g, std::size_t h) { return expected[g] == here[h].first; },
      [&](PixelHistory::Record g, PixelHistory::Record h) {
        PixelStep row{.part = {},
                      .step = step,
                      .item = item,
                      .golden = g ? text_of(expected[*g]) : "",
                      .hardware = h ? text_of(here[*h].first) : ""};
        if (h) row.clock = here[*h].second;
        return row;
      },
      came);
}

}  // namespace

void MorphologicalHistory::begin(int width) {
  width_ = width;
  runs_.clear();
  lines_.clear();
  delivered_.clear();
}

namespace {

int line_of(Axis axis, const PixelAddress& pixel) {
  return axis == Axis::kHorizontal ? pixel.y : pixel.x;
}
int position_of(Axis axis, const PixelAddress& pixel) {
  return axis == Axis::kHorizontal ? pixel.x : pixel.y;
}

}  // namespace

// Whether the pixel is next to the run, on either side.
bool MorphologicalHistory::is_near(const RunDescriptor& run) const {
  const int position = position_of(run.axis, pixel_), line = line_of(run.axis, pixel_);
  return (run.line == line || run.line == line + 1) && position >= run.start &&
         position < run.start + run.length;
}
bool MorphologicalHistory::is_at(const Side& side, const RunDescriptor& run) const {
  return run.axis == side.axis && run.line == line_of(run.axis, pixel_) + side.beyond &&
         is_near(run);
}

void MorphologicalHistory::see(const RunDescriptor& run, rtl::Cycle cycle) {
  if (is_near(run)) runs_.emplace_back(run, cycle);
}
void MorphologicalHistory::see(const LineDescriptor& line, rtl::Cycle cycle) {
  if (is_near(line.run)) lines_.emplace_back(line, cycle);
}
void MorphologicalHistory::see(std::size_t position, const Delivered& pixel) {
  if (position == static_cast<std::size_t>(pixel_.y) * static_cast<std::size_t>(width_) +
                      static_cast<std::size_t>(pixel_.x))
    delivered_.push_back(pixel);
}

void MorphologicalHistory::add_side(const Side& side, const MorphologicalGolden* golden,
                                    const PixelSides& came, PixelHistory& all) const {
  std::vector<RunDescriptor> runs;
  std::vector<LineDescriptor> lines;
  if (golden)
    for (const PredictedRun& run : golden->runs()) {
      runs.push_back(run.line.run);
      if (has_line(run.line)) lines.push_back(run.line);
    }
  const auto here = [&](const RunDescriptor& run) { return is_at(side, run); };
  const std::string step = fmt::format("{} edge", side.name);
  add_descriptors(step, "run", runs_, runs, here, came, all);
  add_descriptors(step, "line", lines_, lines, here, came, all);
}

PixelHistory MorphologicalHistory::history(const MorphologicalInput& frame, bool ended,
                                           const MorphologicalGolden* golden) const {
  PixelHistory all{pixel_};
  if (golden && golden->pixels().size() != frame.image.pixels.size()) golden = nullptr;
  const std::size_t at = frame.image.index(pixel_.x, pixel_.y);
  const auto add = [&](std::string step, std::string item, std::string expected, std::string got) {
    all.compare({.part = {},
                 .step = std::move(step),
                 .item = std::move(item),
                 .golden = std::move(expected),
                 .hardware = std::move(got)});
  };
  // Adds a part of the delivered pixel once.
  const auto add_delivered = [&](const std::string& step, const std::string& item, bool known,
                                 const auto& expected, const auto& got) {
    all.compare_records(
        known ? 1 : 0, delivered_.size(),
        [&](std::size_t, std::size_t h) { return expected() == got(delivered_[h]); },
        [&](PixelHistory::Record g, PixelHistory::Record h) {
          PixelStep row{.part = {},
                        .step = step,
                        .item = item,
                        .golden = g ? expected() : "",
                        .hardware = h ? got(delivered_[*h]) : ""};
          if (h) row.clock = delivered_[*h].cycle;
          return row;
        },
        {known, ended});
  };
  // Inputs of a pixel are observed before the pixel itself.
  const PixelSides came{golden != nullptr, ended || !delivered_.empty()};
  if (delivered_.empty())
    all.note = ended ? "the pixel was not delivered"
                     : "the run was cut short before the pixel was delivered";
  const std::string before = text_of(frame.image.pixels[at]);
  add("input", "RGBA", before, before);
  if (at < frame.depth.size()) {
    const std::string depth = fmt::format("{:#x}", frame.depth[at] & 0xFFFFFF);
    add("input", "depth", depth, depth);
  }
  const bool probes = golden && at < golden->probes().size();
  add_delivered(
      "edges", "left, top", probes, [&] { return edges_of(golden->probes()[at]); },
      [](const Delivered& one) { return edges_of(one.probe); });
  constexpr std::array<Side, 4> kSides = {{{"top", Axis::kHorizontal, 0},
                                           {"bottom", Axis::kHorizontal, 1},
                                           {"left", Axis::kVertical, 0},
                                           {"right", Axis::kVertical, 1}}};
  for (const Side& side : kSides) add_side(side, golden, came, all);
  if (probes && golden->probes()[at].edges != 0) {
    const auto top = golden->top_weights(pixel_.x, pixel_.y);
    const auto left = golden->left_weights(pixel_.x, pixel_.y);
    add("weights", "of its top edge: upper, lower", fmt::format("{}, {}", top.first, top.second),
        "");
    add("weights", "of its left edge: left, right", fmt::format("{}, {}", left.first, left.second),
        "");
  }
  add_delivered(
      "blend", "weights of neighbours", probes, [&] { return weights_of(golden->probes()[at]); },
      [](const Delivered& one) { return weights_of(one.probe); });
  add_delivered(
      "signals", "start of frame, end of row", golden != nullptr,
      [&] { return signals_of(at == 0, pixel_.x == width_ - 1); },
      [](const Delivered& one) { return signals_of(one.first, one.last); });
  add_delivered(
      "colour", "RGBA", golden != nullptr, [&] { return text_of(golden->pixels()[at]); },
      [](const Delivered& one) { return text_of(one.pixel); });
  return all;
}

}  // namespace deburr::tb
