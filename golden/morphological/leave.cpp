// SPDX-License-Identifier: MIT
#include "golden/morphological/leave.h"

#include <bit>
#include <string>
#include <string_view>

namespace deburr::golden::morphological {
namespace {

using spec::morphological::Leave;

struct Place {
  int dx, dy;
  std::string_view name;
};
constexpr std::array<Place, 5> kPlaces = {
    {{0, 0, "own"}, {0, -1, "up"}, {-1, 0, "left"}, {1, 0, "right"}, {0, 1, "down"}}};
constexpr std::array<std::string_view, 4> kBorders = {"top", "left", "right", "bottom"};

}  // namespace

Marks marks_of(Leave leave, const ImageView& image, int x, int y) {
  if (leave == Leave::kNone) return 0;
  Marks marks = 0;
  const std::size_t places = leave == Leave::kBeside ? kPlaces.size() : 1;
  for (std::size_t i = 0; i < places; ++i) {
    const int at_x = x + kPlaces[i].dx, at_y = y + kPlaces[i].dy;
    if (at_x < 0 || at_y < 0 || at_x >= image.width || at_y >= image.height) continue;
    if (is_marked(image.at(at_x, at_y))) marks = static_cast<Marks>(marks | 1u << i);
  }
  return marks;
}

void LeaveCoverage::count_pixel(Leave leave, Marks marks, const ImageView& image, int x, int y) {
  if (leave == Leave::kMarked && marks != 0) ++marked_;
  if (leave != Leave::kBeside) return;
  if (marks != 0) {
    const unsigned all = marks;
    ++beside_[std::has_single_bit(all) ? static_cast<std::size_t>(std::countr_zero(all)) : 5];
  }
  const std::array<bool, 4> on = {y == 0, x == 0, x == image.width - 1, y == image.height - 1};
  for (std::size_t border = 0; border < 4; ++border)
    if (on[border]) ++borders_[border][marks != 0 ? 1 : 0];
}

std::vector<CoverageBin> LeaveCoverage::bins() const {
  std::vector<CoverageBin> result = {{"left/marked/own", marked_}};
  for (std::size_t i = 0; i < beside_.size(); ++i) {
    const std::string_view which = i < kPlaces.size() ? kPlaces[i].name : "several";
    result.push_back({"left/beside/" + std::string(which), beside_[i]});
  }
  for (std::size_t border = 0; border < 4; ++border) {
    const std::string name = "border/" + std::string(kBorders[border]);
    result.push_back({name + "/blended", borders_[border][0]});
    result.push_back({name + "/left", borders_[border][1]});
  }
  return result;
}

}  // namespace deburr::golden::morphological
