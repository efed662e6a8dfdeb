// SPDX-License-Identifier: MIT
// Something that a run did, pixel by pixel of the picture that it worked on: samples, misses,
// latency. Left in the run directory as a picture in false colours with its scale, and as values.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "tb/run/result.h"
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
    std::string of;  // "work.sample_walker_samples", or what it is
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

// Colours of a map, from the least of its values to the most. Where a few values lie far above the
// rest, the last step of the colours is theirs, from `knee` on: all but 0.5 % of the pixels lie
// below. Else the knee is the most.
struct MapScale {
  double least = 0, knee = 0, most = 0;
  bool bent() const { return knee < most; }
  // Where a value lies among the colours, 0 to 1.
  double part(double value) const;
};
MapScale scale_of(const PictureMap& map);
// From the least to the most, at even distances.
std::vector<Rgba8> map_colours();

// In false colours (dark blue, green, yellow; grey: nothing there), with the scale below the
// picture: its least, its knee if it has one, its most.
Image picture_of(const PictureMap& map);
// Portable float map: one channel, 32 bits, little-endian, rows from the bottom.
std::string pfm_of(const PictureMap& map);
// Values of such a file. ConfigError for what is none.
void read_pfm(const std::string& bytes, PictureMap& map);

// Values as a picture whose 24 bits are 0 (nothing there) or 1 + (value - least) / step, so that a
// page can hold them: PNG packs them well.
struct MapCodes {
  double least = 0, step = 1;
  Image picture;
};
MapCodes codes_of(const PictureMap& map);

}  // namespace deburr::tb
