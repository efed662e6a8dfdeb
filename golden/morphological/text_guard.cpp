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

// A row or a column of the plane.
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

// Sets strokes[i] to 1 if value i is in a run of equal values that is a stroke, else to 0.
void mark_strokes(const PlaneLine<std::uint8_t>& colours, const PlaneLine<std::uint8_t>& strokes) {
  for (int first = 0, end = 0; first < colours.length; first = end) {
    while (end < colours.length && colours[end] == colours[first]) ++end;
    for (int i = first; i < end; ++i) strokes[i] = end - first <= kMostStroke ? 1 : 0;
  }
}

// Joins each value with all values within kGuardSearchRange of it.
template <class Value, class Join>
void spread(const PlaneLine<Value>& line, Join&& join) {
  std::vector<Value> old(static_cast<std::size_t>(line.length));
  for (int i = 0; i < line.length; ++i) old[static_cast<std::size_t>(i)] = line[i];
  for (int i = 0; i < line.length; ++i) {
    const int first = std::max(0, i - kGuardSearchRange),
              last = std::min(line.length - 1, i + kGuardSearchRange);
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

constexpr std::array<std::string_view, 6> kCauseBins = {
    "guarded", "one-colour", "more-colours", "few-in-rows", "few-in-columns", "few"};
constexpr std::array<std::string_view, 6> kJustBins = {"3-in-rows", "3-in-columns", "24",
                                                       "2-in-rows", "2-in-columns", "23"};
constexpr std::array<std::string_view, 2> kKeptBins = {"by-guard", "by-bypass-too"};
constexpr std::array<std::string_view, 4> kBorderBins = {"top", "left", "right", "bottom"};

}  // namespace

int colour_hash(const Rgba8& pixel) {
  return folded(pixel[0]) ^ rotated(folded(pixel[1]), 1) ^ rotated(folded(pixel[2]), 3);
}

TextGuard::TextGuard(const ImageView& image) : pixels_(image.width, image.height) {
  PlaneOf<std::uint8_t> hashes(image.width, image.height), row_strokes = hashes,
                                                           column_strokes = hashes;
  PlaneOf<std::uint64_t> colours(image.width, image.height);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const int hash = colour_hash(image.at(x, y));
      hashes.row(y)[x] = static_cast<std::uint8_t>(hash);
      colours.row(y)[x] = std::uint64_t{1} << hash;
    }
  for_each_row(hashes, [&](int y, const PlaneLine<std::uint8_t>& line) {
    mark_strokes(line, {row_strokes.row(y), 1, line.length});
  });
  for_each_column(hashes, [&](int x, const PlaneLine<std::uint8_t>& line) {
    mark_strokes(line, {column_strokes.row(0) + x, column_strokes.stride(), line.length});
  });
  const auto plus = [](int a, int b) { return a + b; };
  spread_both_ways(row_strokes, plus);
  spread_both_ways(column_strokes, plus);
  spread_both_ways(colours, [](std::uint64_t a, std::uint64_t b) { return a | b; });
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      pixels_.row(y)[x] = {static_cast<std::uint8_t>(std::popcount(colours.at(x, y))),
                           row_strokes.at(x, y), column_strokes.at(x, y)};
}

void GuardCoverage::count_pixel(const GuardedPixel& p) {
  const std::array<bool, 4> holds = {p.two_colours(), p.enough_in_rows(), p.enough_in_columns(),
                                     p.enough()};
  const auto missing = std::count(holds.begin(), holds.end(), false);
  if (p.colours == 1) ++causes_[1];
  const std::array<bool, 3> just = {p.row_strokes == kLeastStrokes,
                                    p.column_strokes == kLeastStrokes, p.of_both() == kLeastOfBoth};
  const std::array<bool, 3> just_not = {p.row_strokes == kLeastStrokes - 1,
                                        p.column_strokes == kLeastStrokes - 1,
                                        p.of_both() == kLeastOfBoth - 1};
  if (missing == 0) {
    ++causes_[0];
    for (std::size_t i = 0; i < just.size(); ++i) just_[i] += just[i];
  } else if (missing == 1) {
    if (p.colours > 2) ++causes_[2];
    for (std::size_t i = 1; i < holds.size(); ++i)
      if (!holds[i]) {
        ++causes_[2 + i];
        just_[2 + i] += just_not[i - 1];
      }
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
  add("text/just/", kJustBins, just_);
  add("text/kept/", kKeptBins, kept_);
  add("text-border/", kBorderBins, borders_);
  return result;
}

}  // namespace deburr::golden::morphological
