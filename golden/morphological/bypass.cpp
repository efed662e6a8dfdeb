// SPDX-License-Identifier: MIT
#include "golden/morphological/bypass.h"

#include <bit>
#include <string>
#include <string_view>

namespace deburr::golden::morphological {
namespace {

using spec::morphological::Bypass;

struct Place {
  int dx, dy;
  std::string_view name;
};
constexpr std::array<Place, 5> kPlaces = {
    {{0, 0, "own"}, {0, -1, "up"}, {-1, 0, "left"}, {1, 0, "right"}, {0, 1, "down"}}};
constexpr std::array<std::string_view, 4> kBorderNames = {"top", "left", "right", "bottom"};

// Indices into kPlaces.
constexpr std::size_t first_neighbour(bool horizontal) { return horizontal ? 2 : 1; }
constexpr std::size_t second_neighbour(bool horizontal) { return horizontal ? 3 : 4; }

bool has(Marks marks, std::size_t place) { return (marks >> place & 1) != 0; }

}  // namespace

Marks marks_of(Bypass bypass, const ImageView& image, int x, int y) {
  if (bypass == Bypass::kNone || bypass == Bypass::kMasked) return 0;
  Marks marks = 0;
  const std::size_t places = bypass == Bypass::kMarked ? 1 : kPlaces.size();
  for (std::size_t i = 0; i < places; ++i) {
    const int at_x = x + kPlaces[i].dx, at_y = y + kPlaces[i].dy;
    if (at_x < 0 || at_y < 0 || at_x >= image.width || at_y >= image.height) continue;
    if (is_marked(image.at(at_x, at_y))) marks = static_cast<Marks>(marks | 1u << i);
  }
  return marks;
}

bool is_bypassed(Bypass bypass, Marks marks) {
  return bypass == Bypass::kBeside ? marks != 0 : has(marks, 0);
}

spec::morphological::BlendProbe remaining(Bypass bypass, Marks marks,
                                          const spec::morphological::BlendProbe& probe) {
  if (is_bypassed(bypass, marks)) return {};
  if (bypass != Bypass::kHalf) return probe;
  spec::morphological::BlendProbe result = probe;
  const auto halve = [&](std::uint8_t& weight, std::size_t neighbour) {
    if (has(marks, neighbour)) weight = static_cast<std::uint8_t>(weight >> 1);
  };
  halve(result.first, first_neighbour(probe.horizontal));
  halve(result.second, second_neighbour(probe.horizontal));
  return (result.first | result.second) != 0 ? result : spec::morphological::BlendProbe{};
}

void BypassCoverage::count_pixel(Bypass bypass, Marks marks,
                                 const spec::morphological::BlendProbe& probe,
                                 const ImageView& image, int x, int y) {
  if (bypass == Bypass::kNone || bypass == Bypass::kMasked) return;
  const bool left = is_bypassed(bypass, marks);
  if (bypass == Bypass::kBeside) {
    if (left) {
      const unsigned all = marks;
      ++beside_[std::has_single_bit(all) ? static_cast<std::size_t>(std::countr_zero(all)) : 5];
    }
    const std::array<bool, 4> on = {y == 0, x == 0, x == image.width - 1, y == image.height - 1};
    for (std::size_t border = 0; border < 4; ++border)
      if (on[border]) ++borders_[border][left ? 1 : 0];
    return;
  }
  if (left) {
    ++own_[bypass == Bypass::kHalf ? 1 : 0];
    return;
  }
  if (bypass != Bypass::kHalf) return;
  const std::size_t first = first_neighbour(probe.horizontal),
                    second = second_neighbour(probe.horizontal);
  if (probe.first != 0 && has(marks, first)) ++half_[first - 1];
  if (probe.second != 0 && has(marks, second)) ++half_[second - 1];
  const spec::morphological::BlendProbe rest = remaining(bypass, marks, probe);
  if ((rest.first | rest.second) == 0) ++half_[4];
}

std::vector<CoverageBin> BypassCoverage::bins() const {
  std::vector<CoverageBin> result = {{"bypass/marked/own", own_[0]}, {"bypass/half/own", own_[1]}};
  for (std::size_t i = 0; i < beside_.size(); ++i) {
    const std::string_view which = i < kPlaces.size() ? kPlaces[i].name : "several";
    result.push_back({"bypass/beside/" + std::string(which), beside_[i]});
  }
  for (std::size_t border = 0; border < 4; ++border) {
    const std::string name = "border/" + std::string(kBorderNames[border]);
    result.push_back({name + "/blended", borders_[border][0]});
    result.push_back({name + "/bypassed", borders_[border][1]});
  }
  for (std::size_t i = 0; i < half_.size(); ++i) {
    const std::string_view which = i < 4 ? kPlaces[i + 1].name : "nothing";
    result.push_back({"half/" + std::string(which), half_[i]});
  }
  return result;
}

}  // namespace deburr::golden::morphological
