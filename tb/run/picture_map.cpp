// SPDX-License-Identifier: MIT
#include "tb/run/picture_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string_view>
#include <utility>

#include "spec/error.h"
#include "tb/run/amount.h"
#include "tb/scene/label.h"

namespace deburr::tb {
namespace {

constexpr float kNothing = std::numeric_limits<float>::quiet_NaN();

constexpr Rgba8 kPaper = {255, 255, 255, 255}, kInk = {0, 0, 0, 255}, kEmpty = {58, 60, 64, 255};

// Perceptually even in lightness and distinguishable with red-green colour blindness.
constexpr std::array<std::array<int, 3>, 9> kColours = {{{68, 1, 84},
                                                         {71, 44, 122},
                                                         {59, 81, 139},
                                                         {44, 113, 142},
                                                         {33, 144, 141},
                                                         {39, 173, 129},
                                                         {92, 200, 99},
                                                         {170, 220, 50},
                                                         {253, 231, 37}}};

Rgba8 colour_of(double part) {
  const double at = std::clamp(part, 0.0, 1.0) * static_cast<double>(kColours.size() - 1);
  const std::size_t low = std::min(static_cast<std::size_t>(at), kColours.size() - 2);
  Rgba8 colour = kInk;
  for (std::size_t c = 0; c < 3; ++c)
    colour[c] = static_cast<std::uint8_t>(
        std::lround(std::lerp(kColours[low][c], kColours[low + 1][c], at - double(low))));
  return colour;
}

constexpr double kKneePart = 1 - 1.0 / static_cast<double>(kColours.size() - 1);

void paste_within(Image& on, const Image& what, int left, int top) {
  for (int y = 0; y < what.height; ++y)
    for (int x = 0; x < what.width; ++x)
      if (left + x >= 0 && left + x < on.width) on.at(left + x, top + y) = what.at(x, y);
}

std::string scale_text(double value) { return amount(value); }

}  // namespace

double MapScale::part(double value) const {
  const auto share = [](double low, double high, double at) {
    return high > low ? std::clamp((at - low) / (high - low), 0.0, 1.0) : 0.0;
  };
  if (!bent()) return share(least, most, value);
  return value <= knee ? kKneePart * share(least, knee, value)
                       : std::lerp(kKneePart, 1.0, share(knee, most, value));
}

MapScale scale_of(const PictureMap& map) {
  std::vector<float> there;
  for (const float value : map.values)
    if (!std::isnan(value)) there.push_back(value);
  if (there.empty()) return {};
  std::sort(there.begin(), there.end());
  const double least = there.front(), most = there.back(),
               nearly = there[std::min(there.size() - 1, there.size() * 995 / 1000)];
  const bool bent = most - least > 2 * (nearly - least) && nearly > least;
  return {least, bent ? nearly : most, most};
}

std::vector<Rgba8> map_colours() {
  std::vector<Rgba8> colours;
  for (std::size_t i = 0; i < kColours.size(); ++i)
    colours.push_back(colour_of(static_cast<double>(i) / static_cast<double>(kColours.size() - 1)));
  return colours;
}

PictureMap::PictureMap(std::string map_name, std::string map_title, std::string map_unit,
                       std::string map_meaning, int map_width, int map_height)
    : name(std::move(map_name)),
      title(std::move(map_title)),
      unit(std::move(map_unit)),
      meaning(std::move(map_meaning)),
      width(map_width),
      height(map_height),
      values(static_cast<std::size_t>(map_width) * static_cast<std::size_t>(map_height), kNothing) {
}

bool PictureMap::has(int x, int y) const { return x >= 0 && y >= 0 && x < width && y < height; }

void PictureMap::set(int x, int y, double value) {
  if (has(x, y))
    values[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(x)] = static_cast<float>(value);
}

void PictureMap::add(int x, int y, double value) {
  if (!has(x, y)) return;
  float& pixel = values[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                        static_cast<std::size_t>(x)];
  pixel = (std::isnan(pixel) ? 0.0F : pixel) + static_cast<float>(value);
}

double PictureMap::sum() const {
  double sum = 0;
  for (const float value : values)
    if (!std::isnan(value)) sum += static_cast<double>(value);
  return sum;
}

std::size_t PictureMap::pixels_above_zero() const {
  return static_cast<std::size_t>(
      std::count_if(values.begin(), values.end(), [](float value) { return value > 0; }));
}

MapFigures figures_of(const PictureMap& map) {
  MapFigures f;
  f.name = map.name;
  f.title = map.title;
  f.unit = map.unit;
  f.meaning = map.meaning;
  for (const float value : map.values) {
    if (std::isnan(value)) continue;
    const double v = static_cast<double>(value);
    f.min = f.pixels == 0 ? v : std::min(f.min, v);
    f.max = f.pixels == 0 ? v : std::max(f.max, v);
    ++f.pixels;
  }
  f.sum = map.sum();
  if (map.account) f.account = map.account->of;
  return f;
}

void check_map(const PictureMap& map) {
  if (!map.account) return;
  constexpr double kRounding = 1e-5;  // rounding error of sums of floats
  const double error = std::abs(map.account->mapped - map.account->counted);
  DEBURR_CHECK(error <= kRounding * std::max(1.0, map.account->counted),
               fmt::format("map {}: its pixels add up to {}, but {} is {}", map.name,
                           map.account->mapped, map.account->of, map.account->counted));
}

Image picture_of(const PictureMap& map) {
  constexpr int kLeast = 200, kBar = 8, kGap = 4, kText = 9;
  const MapScale scale = scale_of(map);
  Image picture(std::max(map.width, kLeast), map.height + 3 * kGap + kBar + kText, kPaper);
  for (int y = 0; y < map.height; ++y)
    for (int x = 0; x < map.width; ++x) {
      const double value = static_cast<double>(
          map.values[static_cast<std::size_t>(y) * static_cast<std::size_t>(map.width) +
                     static_cast<std::size_t>(x)]);
      picture.at(x, y) = std::isnan(value) ? kEmpty : colour_of(scale.part(value));
    }
  const int top = map.height + kGap, right = picture.width - kGap;
  for (int x = kGap; x < right; ++x)
    for (int y = top; y < top + kBar; ++y)
      picture.at(x, y) = colour_of(static_cast<double>(x - kGap) / (right - kGap - 1));
  const Image low = label(scale_text(scale.least), 1),
              high = label(scale_text(scale.most) + " " + map.unit, 1);
  paste_within(picture, low, kGap, top + kBar + kGap);
  paste_within(picture, high, right - high.width, top + kBar + kGap);
  if (scale.bent()) {
    const int knee = kGap + static_cast<int>(std::lround(kKneePart * (right - kGap - 1)));
    for (int y = top; y < top + kBar; ++y) picture.at(knee, y) = kInk;
    const Image text = label(scale_text(scale.knee), 1);
    paste_within(picture, text, std::min(knee, right - high.width - kText) - text.width,
                 top + kBar + kGap);
  }
  return picture;
}

std::string pfm_of(const PictureMap& map) {
  static_assert(std::endian::native == std::endian::little, "the scale of -1 says so");
  std::string bytes = fmt::format("Pf\n{} {}\n-1.0\n", map.width, map.height);
  const auto row = static_cast<std::size_t>(map.width);
  for (int y = map.height - 1; y >= 0; --y) {
    const float* from = map.values.data() + static_cast<std::size_t>(y) * row;
    bytes.append(reinterpret_cast<const char*>(from), row * sizeof(float));
  }
  return bytes;
}

void read_pfm(const std::string& bytes, PictureMap& map) {
  const std::string head = fmt::format("Pf\n{} {}\n-1.0\n", map.width, map.height);
  const std::size_t size = map.values.size() * sizeof(float);
  if (!bytes.starts_with(head) || bytes.size() != head.size() + size)
    throw spec::ConfigError(
        fmt::format("not a portable float map of {} x {} values", map.width, map.height));
  const auto row = static_cast<std::size_t>(map.width);
  const char* from = bytes.data() + head.size();
  for (int y = map.height - 1; y >= 0; --y, from += row * sizeof(float))
    std::memcpy(map.values.data() + static_cast<std::size_t>(y) * row, from, row * sizeof(float));
}

MapCodes codes_of(const PictureMap& map) {
  constexpr double kMost = (1 << 24) - 2;  // steps between minimum and maximum
  const MapScale scale = scale_of(map);
  MapCodes codes{scale.least, (scale.most - scale.least) / kMost, Image(map.width, map.height)};
  // Multiples of 1 and of 1/256 are represented exactly.
  for (const double step : {1.0, 1.0 / 256}) {
    const bool fits = std::all_of(map.values.begin(), map.values.end(), [&](float value) {
      const double steps = (static_cast<double>(value) - scale.least) / step;
      return std::isnan(value) || (steps <= kMost && steps == std::round(steps));
    });
    if (!fits) continue;
    codes.step = step;
    break;
  }
  for (std::size_t i = 0; i < map.values.size(); ++i) {
    const double value = static_cast<double>(map.values[i]);
    const auto code =
        std::isnan(value)
            ? 0U
            : 1U + static_cast<std::uint32_t>(std::lround((value - scale.least) / codes.step));
    for (std::size_t c = 0; c < 3; ++c)
      codes.picture.pixels[i][c] = static_cast<std::uint8_t>(code >> (16 - 8 * c) & 255);
    codes.picture.pixels[i][3] = 255;
  }
  return codes;
}

}  // namespace deburr::tb
