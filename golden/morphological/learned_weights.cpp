// SPDX-License-Identifier: MIT
#include "golden/morphological/learned_weights.h"

#include <algorithm>
#include <string>
#include <string_view>

#include "spec/morphological/shapes.h"

namespace deburr::golden::morphological {
namespace {

using spec::morphological::LineDescriptor;
using spec::morphological::RunDescriptor;
using spec::morphological::RunPart;
using spec::morphological::Side;

constexpr int kLongestLook = 10;  // edges away from the run
constexpr int kClasses = 9;
constexpr int kUnseenDistance = 7;

// D of a distance: 0, 1, 2, 3, 4-5, 6-8, 9-15, 16 and more.
constexpr std::array<std::uint8_t, 17> kDistanceClass = {0, 1, 2, 3, 4, 4, 5, 5, 5,
                                                         6, 6, 6, 6, 6, 6, 6, 7};
int distance_class(int d) { return kDistanceClass[static_cast<std::size_t>(std::min(d, 16))]; }

int length_class(int length) { return length == 1 ? 0 : length <= 3 ? 1 : length <= 7 ? 2 : 3; }

// K of a number of edges, 1..10.
constexpr std::array<std::uint8_t, kLongestLook + 1> kAwayClass = {0, 1, 2, 3, 4, 4, 5, 5, 5, 5, 6};

constexpr int swapped(int code) { return (code & 1) << 1 | code >> 1; }

int appearance(int code, int crossing_class) {
  if (code == 0 || code == 3) return code == 0 ? 0 : 1;
  return (code == 1 ? 2 : 11) + crossing_class;
}

struct SeenEnd {
  int distance, appearance, code;
};
WeightIndices indices(const SeenEnd& near, const SeenEnd& far, int length_class) {
  return {static_cast<std::uint16_t>(((near.code * 4 + far.code) * 8 + near.distance) * 8 +
                                     far.distance),
          static_cast<std::uint16_t>((near.appearance * 8 + near.distance) * 4 + length_class),
          static_cast<std::uint16_t>((far.appearance * 8 + far.distance) * 4 + length_class)};
}

// Only whole runs are tried. Heads, tails and gaps name no other entries: an unseen end equals an
// end without a crossing that is far away.
ReachableEntries find_reachable() {
  ReachableEntries result;
  LineDescriptor descriptor;
  const auto visit = [&] {
    const bool line = descriptor.run.length >= spec::morphological::kLongZ &&
                      spec::morphological::kRunShapes[descriptor.run.shape].clean_z;
    if (line) return;
    const LearnedEnds ends(descriptor, Side::kFirst);
    for (int k = 0; k < descriptor.run.length; ++k) {
      const WeightIndices i = ends.of_pixel(k);
      result.of_codes[i.codes] = true;
      result.of_near[i.near] = true;
      result.of_far[i.far] = true;
    }
  };
  for (int length = 1; length <= 40; ++length) {
    descriptor.run.length = static_cast<std::uint16_t>(length);
    for (int shape = 0; shape < 16; ++shape) {
      descriptor.run.shape = static_cast<std::uint8_t>(shape);
      const auto classes = [](int code) { return code == 1 || code == 2 ? kClasses : 1; };
      for (int start = 0; start < classes(descriptor.run.shape & 3); ++start) {
        for (int end = 0; end < classes(descriptor.run.shape >> 2); ++end) {
          descriptor.start_class = static_cast<std::uint8_t>(start);
          descriptor.end_class = static_cast<std::uint8_t>(end);
          visit();
        }
      }
    }
  }
  return result;
}

}  // namespace

int crossing_class(const AxisEdges& edges, const RunDescriptor& run, bool at_end, int room) {
  const int code = at_end ? run.shape >> 2 : run.shape & 3;
  if (code == 0 || code == 3) return 0;
  const int corner = at_end ? run.start + run.length : run.start;
  const int far_line = code == 1 ? run.line - 1 : run.line + 1;
  if (edges.across.at(corner, code == 1 ? run.line - 2 : run.line + 1)) return 2;
  if (edges.along.at(at_end ? corner - 1 : corner, far_line)) return 1;
  const int most = std::min(kLongestLook, room);
  int n = 0;
  while (n < most && edges.along.at(at_end ? corner + n : corner - 1 - n, far_line)) ++n;
  return n == 0 ? 0 : 2 + kAwayClass[static_cast<std::size_t>(n)];
}

LearnedEnds::LearnedEnds(const LineDescriptor& descriptor, Side own)
    : length_(descriptor.run.length) {
  const RunPart part = descriptor.run.part;
  const auto end_of = [&](int code, int crossing_class) {
    if (own == Side::kSecond) code = swapped(code);
    return End{code, appearance(code, crossing_class), true};
  };
  if (part != RunPart::kTail) start_ = end_of(descriptor.run.shape & 3, descriptor.start_class);
  if (part != RunPart::kHead) end_ = end_of(descriptor.run.shape >> 2, descriptor.end_class);
  length_class_ = part == RunPart::kWhole ? length_class(length_) : 3;
}

WeightIndices LearnedEnds::of_pixel(int k) const {
  const int to_start = k, to_end = length_ - 1 - k;
  const auto seen = [](const End& end, int distance) {
    return SeenEnd{end.seen ? distance_class(distance) : kUnseenDistance, end.appearance, end.code};
  };
  const SeenEnd start = seen(start_, to_start), end = seen(end_, to_end);
  const bool start_is_near =
      !end_.seen || (start_.seen &&
                     (to_start != to_end ? to_start < to_end : start.appearance >= end.appearance));
  return start_is_near ? indices(start, end, length_class_) : indices(end, start, length_class_);
}

void LearnedCoverage::count_descriptor(const LineDescriptor& descriptor) {
  auto& classes = classes_[static_cast<std::size_t>(descriptor.run.axis)];
  if (descriptor.run.part != RunPart::kTail) ++classes[0][descriptor.start_class];
  if (descriptor.run.part != RunPart::kHead) ++classes[1][descriptor.end_class];
}

std::vector<CoverageBin> LearnedCoverage::bins() const {
  std::vector<CoverageBin> result;
  const auto add = [&](std::string_view table, const auto& reachable, const auto& hits) {
    for (std::size_t i = 0; i < hits.size(); ++i)
      if (reachable[i]) result.push_back({std::string(table) + "/" + std::to_string(i), hits[i]});
  };
  add("A", reachable_entries().of_codes, of_codes_);
  add("B", reachable_entries().of_near, of_near_);
  add("C", reachable_entries().of_far, of_far_);
  for (const std::size_t axis : {0u, 1u}) {
    for (const std::size_t end : {0u, 1u}) {
      for (std::size_t i = 0; i < kClasses; ++i) {
        result.push_back({std::string(axis == 0 ? "class/horizontal/" : "class/vertical/") +
                              (end == 0 ? "start/" : "end/") + std::to_string(i),
                          classes_[axis][end][i]});
      }
    }
  }
  return result;
}

const ReachableEntries& reachable_entries() {
  static const ReachableEntries entries = find_reachable();
  return entries;
}

}  // namespace deburr::golden::morphological
