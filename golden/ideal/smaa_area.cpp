// SPDX-License-Identifier: MIT
#include "golden/ideal/smaa_area.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

namespace deburr::golden::ideal {
namespace {

struct AreaPoint {
  double x = 0, y = 0;
};

// Area between the axis and a line over pixel `l`. Heights above the axis count for the first
// pixel.
SmaaWeights area_under(AreaPoint from, AreaPoint to, int l) {
  const double slope = (to.y - from.y) / (to.x - from.x);
  const auto height = [&](double x) { return from.y + slope * (x - from.x); };
  const double begin = std::max<double>(l, from.x), end = std::min<double>(l + 1, to.x);
  if (begin >= end) return {};
  SmaaWeights area;
  const auto add = [&](double x1, double x2) {
    const double signed_area = (height(x1) + height(x2)) / 2 * (x2 - x1);
    (signed_area < 0 ? area.second : area.first) += std::abs(signed_area);
  };
  const double zero = slope == 0 ? begin : from.x - from.y / slope;
  if (zero > begin && zero < end) {
    add(begin, zero);
    add(zero, end);
  } else {
    add(begin, end);
  }
  return area;
}

SmaaWeights sum(SmaaWeights a, SmaaWeights b) { return {a.first + b.first, a.second + b.second}; }
SmaaWeights half(SmaaWeights a) { return {a.first / 2, a.second / 2}; }

// Smooths short dips.
SmaaWeights smoothed(SmaaWeights a, int length) {
  const auto smooth = [&](double area) {
    const double round = std::sqrt(2 * area) / 2;
    return std::lerp(round, area, std::min(1.0, length / 32.0));
  };
  return {smooth(a.first), smooth(a.second)};
}

}  // namespace

SmaaWeights smaa_area(int pattern, int l, int r, double offset) {
  const int length = l + r + 1;
  const double first = 0.5 + offset, second = offset - 0.5;
  const AreaPoint middle{length / 2.0, 0};
  const double last = length;
  const auto start = [&](double height) { return area_under({0, height}, middle, l); };
  const auto end = [&](double height) { return area_under(middle, {last, height}, l); };
  const auto whole = [&](double from, double to) { return area_under({0, from}, {last, to}, l); };
  // With an offset, the line of a Z is the mean of one line and the two lines that meet on the
  // axis.
  const auto z = [&](double from, double to) {
    return offset == 0 ? whole(from, to) : half(sum(whole(from, to), sum(start(from), end(to))));
  };
  const auto dip = [&](double height) {
    return sum(smoothed(start(height), length), smoothed(end(height), length));
  };
  // A line that crosses once counts only from the nearer half of its run.
  switch (pattern) {
    case 1:
      return l <= r ? start(second) : SmaaWeights{};
    case 2:
      return l >= r ? end(second) : SmaaWeights{};
    case 3:
      return dip(second);
    case 4:
      return l <= r ? start(first) : SmaaWeights{};
    case 6:
      return z(first, second);
    case 7:
    case 14:
      return whole(first, second);
    case 8:
      return l >= r ? end(first) : SmaaWeights{};
    case 9:
      return z(second, first);
    case 11:
    case 13:
      return whole(second, first);
    case 12:
      return dip(first);
    default:
      return {};
  }
}

int loss_by_merging(double offset) {
  int largest = 0;
  const auto code = [](double area) { return static_cast<int>(255 * area); };
  for (const auto& [stored, read] :
       {std::pair{6, 7}, std::pair{6, 14}, std::pair{9, 11}, std::pair{9, 13}}) {
    for (int i = 0; i < 16; ++i) {
      for (int j = 0; j < 16; ++j) {
        const SmaaWeights a = smaa_area(stored, i * i, j * j, offset),
                          b = smaa_area(read, i * i, j * j, offset);
        largest = std::max({largest, std::abs(code(a.second) - code(b.second)),
                            std::abs(code(a.first) - code(b.first))});
      }
    }
  }
  return largest;
}

}  // namespace deburr::golden::ideal
