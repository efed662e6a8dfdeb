// SPDX-License-Identifier: MIT
#include "golden/morphological/text_guard.h"

#include <algorithm>
#include <bit>
#include <string>
#include <string_view>

namespace deburr::golden::morphological {
namespace {

using spec::morphological::Rgba8;

constexpr int kHashBits = 6, kHashes = 1 << kHashBits;

int folded(int code) { return code % kHashes ^ code / kHashes; }
int rotated(int bits, int left) { return (bits << left | bits >> (kHashBits - left)) % kHashes; }

// A line of the plane, a row or a column.
template <class Value>
struct PlaneLine {
  Value* first;
  std::size_t step;
  int length;
  Value& operator[](int i) const { return first[static_cast<std::size_t>(i) * step]; }
};

template <class Value, class Visit>
void for_each_row(PlaneOf<Value>& plane, Visit&& visit) {
  for (int y = 0; y < plane.height; ++y) visit(y, PlaneLine<Value>{plane.row(y), 1, plane.width});
}
template <class Value, class Visit>
void for_each_column(PlaneOf<Value>& plane, Visit&& visit) {
  for (int x = 0; x < plane.width; ++x)
    visit(x, PlaneLine<Value>{plane.row(0) + x, plane.stride(), plane.height});
}

// 1 where the value lies in a run of equal ones that is a stroke.
void mark_strokes(const PlaneLine<std::uint8_t>& colours, const PlaneLine<std::uint8_t>& strokes) {
  for (int first = 0, end = 0; first < colours.length; first = end) {
    while (end < colours.length && colours[end] == colours[first]) ++end;
    for (int i = first; i < end; ++i) strokes[i] = end - first <= kMostStroke ? 1 : 0;
  }
}

// Each value becomes that of all within reach of it.
template <class Value, class Join>
void spread(const PlaneLine<Value>& line, Join&& join) {
  std::vector<Value> old(static_cast<std::size_t>(line.length));
  for (int i = 0; i < line.length; ++i) old[static_cast<std::size_t>(i)] = line[i];
  for (int i = 0; i < line.length; ++i) {
    const int first = std::max(0, i - kGuardReach),
              last = std::min(line.length - 1, i + kGuardReach);
    Value all{};
    for (int k = first; k <= last; ++k)
      all = static_cast<Value>(join(all, old[static_cast<std::size_t>(k)]));
    line[i] = all;
  }
}
template <class Value, class Join>
void spread_both_ways(PlaneOf<Value>& plane, Join&& join) {
  for_each_row(plane, [&](int, const PlaneLine<Value>& line) { spread(line, join); });
  for_each_column(plane, [&](int, const PlaneLine<Value>& line) { spread(line, join); });
}

constexpr std::array<std::string_view, 6> kCauseBins = {"guarded", "one-colour",  "more-colours",
                                                        "wide",    "few-in-rows", "few-in-columns"};
constexpr std::array<std::string_view, 3> kStrokeBins = {"row", "column", "both"};
constexpr std::array<std::string_view, 4> kJustBins = {"12-in-rows", "12-in-columns", "11-in-rows",
                                                       "11-in-columns"};
constexpr std::array<std::string_view, 2> kKeptBins = {"by-guard", "by-leave-too"};
constexpr std::array<std::string_view, 4> kBorderBins = {"top", "left", "right", "bottom"};

}  // namespace

int colour_hash(const Rgba8& pixel) {
  return folded(pixel[0]) ^ rotated(folded(pixel[1]), 1) ^ rotated(folded(pixel[2]), 3);
}

TextGuard::TextGuard(const ImageView& image) : pixels_(image.width, image.height) {
  PlaneOf<std::uint8_t> hashes(image.width, image.height), in_row = hashes, in_column = hashes;
  PlaneOf<std::uint64_t> colours(image.width, image.height);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const int hash = colour_hash(image.at(x, y));
      hashes.row(y)[x] = static_cast<std::uint8_t>(hash);
      colours.row(y)[x] = std::uint64_t{1} << hash;
    }
  for_each_row(hashes, [&](int y, const PlaneLine<std::uint8_t>& line) {
    mark_strokes(line, {in_row.row(y), 1, line.length});
  });
  for_each_column(hashes, [&](int x, const PlaneLine<std::uint8_t>& line) {
    mark_strokes(line, {in_column.row(0) + x, in_column.stride(), line.length});
  });
  PlaneOf<std::uint8_t> row_strokes = in_row, column_strokes = in_column;
  const auto plus = [](int a, int b) { return a + b; };
  spread_both_ways(row_strokes, plus);
  spread_both_ways(column_strokes, plus);
  spread_both_ways(colours, [](std::uint64_t a, std::uint64_t b) { return a | b; });
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      pixels_.row(y)[x] = {static_cast<std::uint8_t>(std::popcount(colours.at(x, y))),
                           in_row.at(x, y) != 0, in_column.at(x, y) != 0, row_strokes.at(x, y),
                           column_strokes.at(x, y)};
}

void GuardCoverage::count_pixel(const GuardedPixel& p) {
  const std::array<bool, 4> holds = {p.two_colours(), p.in_stroke(), p.enough_in_rows(),
                                     p.enough_in_columns()};
  const auto failing = std::count(holds.begin(), holds.end(), false);
  if (p.colours == 1) ++causes_[1];
  if (failing == 0) {
    ++causes_[0];
    ++strokes_[!p.in_column_stroke ? 0 : !p.in_row_stroke ? 1 : 2];
    if (p.row_strokes == kLeastStrokes) ++just_[0];
    if (p.column_strokes == kLeastStrokes) ++just_[1];
  } else if (failing == 1) {
    if (p.colours > 2) ++causes_[2];
    if (!p.in_stroke()) ++causes_[3];
    if (!p.enough_in_rows()) ++causes_[4];
    if (!p.enough_in_columns()) ++causes_[5];
    if (p.row_strokes == kLeastStrokes - 1) ++just_[2];
    if (p.column_strokes == kLeastStrokes - 1) ++just_[3];
  }
}

void GuardCoverage::count_frame(const TextGuard& guard, int width, int height) {
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const GuardedPixel& pixel = guard.at(x, y);
      count_pixel(pixel);
      if (!pixel.guarded()) continue;
      const std::array<bool, 4> on = {y == 0, x == 0, x == width - 1, y == height - 1};
      for (std::size_t border = 0; border < on.size(); ++border)
        if (on[border]) ++borders_[border];
    }
  }
}

std::vector<CoverageBin> GuardCoverage::bins() const {
  std::vector<CoverageBin> result;
  const auto add = [&](std::string_view group, const auto& names, const auto& hits) {
    for (std::size_t i = 0; i < names.size(); ++i)
      result.push_back({std::string(group) + std::string(names[i]), hits[i]});
  };
  add("text/", kCauseBins, causes_);
  add("text/stroke/", kStrokeBins, strokes_);
  add("text/just/", kJustBins, just_);
  add("text/kept/", kKeptBins, kept_);
  add("text-border/", kBorderBins, borders_);
  return result;
}

}  // namespace deburr::golden::morphological
