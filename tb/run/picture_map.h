// SPDX-License-Identifier: MIT
// Per-pixel map of a quantity of a run, such as samples, misses or latency. Stored in the run
// directory as a false-colour picture with scale and as values.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "tb/run/result.h"
#include "tb/scene/image.h"

namespace deburr::tb {

struct PictureMap {
  // An empty map: no pixel has a value.
  PictureMap(std::string map_name, std::string map_title, std::string map_unit,
             std::string map_meaning, int map_width, int map_height);

  std::string name, title, unit, meaning;
  int width, height;
  std::vector<float> values;  // top row first; NaN: no value

  // Cross-check of the map's total against an independent count of the model.
  struct Account {
    std::string of;  // "work.sample_walker_samples", or a description
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
// Throws CheckFailed if the total differs from the model's count.
void check_map(const PictureMap& map);

// Colour scale from minimum to maximum. If a few values are far above all others, the last colour
// step covers all values from `knee` on, where 99.5 % of the pixels are below the knee. Otherwise
// the knee is the maximum.
struct MapScale {
  double least = 0, knee = 0, most = 0;
  bool bent() const { return knee < most; }
  // Position of a value on the scale, 0 to 1.
  double part(double value) const;
};
MapScale scale_of(const PictureMap& map);
// Colours at even steps from minimum to maximum.
std::vector<Rgba8> map_colours();

// False-colour picture (dark blue, green, yellow; grey: no value) with the scale below it: minimum,
// knee if any, maximum.
Image picture_of(const PictureMap& map);
// Portable float map: one channel, 32 bits, little-endian, bottom row first.
std::string pfm_of(const PictureMap& map);
// Reads the values of such a file. Throws ConfigError for an invalid one.
void read_pfm(const std::string& bytes, PictureMap& map);

// Values as 24-bit codes of a picture that a page can embed: 0 (no value) or 1 + (value - minimum)
// / step. PNG compresses them well.
struct MapCodes {
  double least = 0, step = 1;
  Image picture;
};
MapCodes codes_of(const PictureMap& map);

}  // namespace deburr::tb
