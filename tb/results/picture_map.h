// SPDX-License-Identifier: MIT
// Something that a run did, pixel by pixel of the picture that it worked on: samples, misses,
// latency. Left in the run directory as a picture in false colours with its scale, and as values.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "tb/results/result.h"
#include "tb/scene/image.h"

namespace deburr::tb {

struct PictureMap {
  // Nothing in any pixel.
  PictureMap(std::string map_name, std::string map_title, std::string map_unit,
             std::string map_meaning, int map_width, int map_height);

  std::string name, title, unit, meaning;
  int width, height;
  std::vector<float> values;  // rows from the top; NaN: nothing there

  // What the values must come to by a count that the model made by itself.
  struct Account {
    std::string of;  // "work.walker_samples", or what it is
    double counted = 0, mapped = 0;
  };
  std::optional<Account> account{};

  void set(int x, int y, double value);
  void add(int x, int y, double value);
  bool has(int x, int y) const;
  double sum() const;
  std::size_t pixels_above_zero() const;
};

// Range and sum, for result.json.
MapFigures figures_of(const PictureMap& map);
// CheckFailed if the map does not come to what the model counted.
void check_map(const PictureMap& map);

// In false colours (dark blue, green, yellow; grey: nothing there), with the scale below the
// picture. The scale ends where all but 0.5 % of the pixels end, marked by a +, if the largest
// value is more than twice that.
Image picture_of(const PictureMap& map);
// Portable float map: one channel, 32 bits, little-endian, rows from the bottom.
std::string pfm_of(const PictureMap& map);

}  // namespace deburr::tb
