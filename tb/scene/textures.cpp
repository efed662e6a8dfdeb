// SPDX-License-Identifier: MIT
#include "tb/scene/textures.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include "spec/error.h"
#include "tb/scene/exact_math.h"

namespace deburr::tb {
namespace {

// A bijective 32-bit mixer: every input bit changes every output bit about half the time.
constexpr std::uint32_t mix(std::uint32_t v) {
  v = (v ^ (v >> 16)) * 0x7FEB352Du;
  v = (v ^ (v >> 15)) * 0x846CA68Bu;
  return v ^ (v >> 16);
}

// White noise: an independent number for every (x, y, seed).
constexpr std::uint32_t hash(int x, int y, std::uint32_t seed) {
  return mix(mix(mix(seed + 0x9E3779B9u) ^ static_cast<std::uint32_t>(x)) ^
             (static_cast<std::uint32_t>(y) * 0x85EBCA6Bu));
}

constexpr int hash_range(int x, int y, std::uint32_t seed, int low, int high) {
  return low + static_cast<int>(hash(x, y, seed) % static_cast<std::uint32_t>(high - low + 1));
}

std::uint8_t to_byte(int value) { return static_cast<std::uint8_t>(std::clamp(value, 0, 255)); }

// Noise in -amplitude..amplitude, with features of `cell` texels. It repeats with the texture.
int smooth_noise(int x, int y, int width, int height, int cell, int amplitude, std::uint32_t seed) {
  const int columns = std::max(1, width / cell), rows = std::max(1, height / cell);
  const int cx = x / cell, cy = y / cell, fx = x % cell, fy = y % cell;
  auto corner = [&](int i, int j) {
    return hash_range((cx + i) % columns, (cy + j) % rows, seed, -amplitude, amplitude);
  };
  const int top = corner(0, 0) * (cell - fx) + corner(1, 0) * fx;
  const int bottom = corner(0, 1) * (cell - fx) + corner(1, 1) * fx;
  return (top * (cell - fy) + bottom * fy) / (cell * cell);
}

template <class Function>
Image fill(int width, int height, Function&& colour_at) {
  Image image(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) image.at(x, y) = colour_at(x, y);
  return image;
}

constexpr std::array<std::string_view, 7> kTextureNames = {
    "checker", "road", "brick", "stones", "zone_plate", "gradient", "noise"};

// ---- mip levels ---------------------------------------------------------------------------------

// One axis of the box filter. Source texel j covers [j, j+1) * target and target texel i covers [i,
// i+1) * source, both in units of 1 / (source * target) of the side. So the weights are integers,
// and for every target texel they sum to `source`.
struct Taps {
  int first = 0, count = 0;
  std::array<int, 3> weight{};
};

std::vector<Taps> box_taps(int source, int target) {
  std::vector<Taps> taps(static_cast<std::size_t>(target));
  for (int i = 0; i < target; ++i) {
    Taps& tap = taps[static_cast<std::size_t>(i)];
    const int begin = i * source, end = begin + source;
    tap.first = begin / target;
    for (int j = tap.first; j * target < end; ++j)
      tap.weight[static_cast<std::size_t>(tap.count++)] =
          std::min(end, (j + 1) * target) - std::max(begin, j * target);
  }
  return taps;
}

constexpr int kLinearOne = 1 << 24;

// Linear light of the byte value + half/2, U1.24.
std::int64_t linear_of(int value, int half) {
  return std::llround(srgb_to_linear((value + 0.5 * half) / 255.0) * kLinearOne);
}

class TransferTables {
 public:
  std::array<std::int64_t, 256> stored{}, linear{};  // byte -> value to average

  TransferTables() {
    for (int v = 0; v < 256; ++v) {
      stored[static_cast<std::size_t>(v)] = v;
      linear[static_cast<std::size_t>(v)] = linear_of(v, 0);
      boundary_[static_cast<std::size_t>(v)] =
          v < 255 ? linear_of(v, 1) : std::numeric_limits<std::int64_t>::max();
    }
    for (std::size_t s = 0; s < first_.size(); ++s)
      first_[s] =
          static_cast<std::uint8_t>(std::upper_bound(boundary_.begin(), boundary_.end(),
                                                     static_cast<std::int64_t>(s) << kStepBits) -
                                    boundary_.begin());
  }

  // The byte whose linear light is nearest.
  std::uint8_t byte_of(std::int64_t light) const {
    std::uint8_t value = first_[static_cast<std::size_t>(light >> kStepBits)];
    while (boundary_[value] <= light) ++value;
    return value;
  }

 private:
  // A step contains at most one boundary between bytes, so one comparison after the step's first
  // byte suffices.
  static constexpr int kStepBits = 12;
  std::array<std::int64_t, 256> boundary_{};  // least linear light that rounds to i + 1
  std::array<std::uint8_t, (kLinearOne >> kStepBits) + 1>
      first_{};  // byte at the start of the step
};

Image half_size(const Image& source, MipSpace space, bool to_even) {
  static const TransferTables tables;
  const int width = std::max(1, source.width / 2), height = std::max(1, source.height / 2);
  const std::vector<Taps> across = box_taps(source.width, width);
  const std::vector<Taps> down = box_taps(source.height, height);
  const std::int64_t total = std::int64_t{source.width} * source.height;
  // Most textures have power-of-two sides and need no division; others cost one division per
  // channel.
  const auto bits = static_cast<std::uint64_t>(2 * total);
  const int shift = std::has_single_bit(bits) ? std::countr_zero(bits) : 0;
  auto rounded_mean = [total, shift, to_even](std::int64_t sum) {
    const std::int64_t doubled = 2 * sum + total;
    const std::int64_t mean = shift != 0 ? doubled >> shift : doubled / (2 * total);
    return to_even && doubled == 2 * total * mean ? mean & ~std::int64_t{1} : mean;
  };

  // If both sides are even, the four weights are equal and can be omitted.
  if (space == MipSpace::kStored && source.width % 2 == 0 && source.height % 2 == 0)
    return fill(width, height, [&](int x, int y) {
      const Rgba8* const upper = &source.at(2 * x, 2 * y);
      const Rgba8* const lower = upper + source.width;
      Rgba8 result;
      for (std::size_t c = 0; c < 4; ++c)
        result[c] = static_cast<std::uint8_t>(
            (upper[0][c] + upper[1][c] + lower[0][c] + lower[1][c] + 2) / 4);
      return result;
    });

  return fill(width, height, [&](int x, int y) {
    const Taps& h = across[static_cast<std::size_t>(x)];
    const Taps& v = down[static_cast<std::size_t>(y)];
    std::array<std::int64_t, 4> sum{};
    for (int j = 0; j < v.count; ++j) {
      for (int i = 0; i < h.count; ++i) {
        const Rgba8& texel = source.at(h.first + i, v.first + j);
        const std::int64_t weight = std::int64_t{h.weight[static_cast<std::size_t>(i)]} *
                                    v.weight[static_cast<std::size_t>(j)];
        for (std::size_t c = 0; c < 4; ++c) {
          const auto& table = space == MipSpace::kSrgb && c < 3 ? tables.linear : tables.stored;
          sum[c] += weight * table[texel[c]];
        }
      }
    }
    Rgba8 result;
    for (std::size_t c = 0; c < 4; ++c) {
      const std::int64_t mean = rounded_mean(sum[c]);
      const bool encode = space == MipSpace::kSrgb && c < 3;
      result[c] = encode ? tables.byte_of(mean) : static_cast<std::uint8_t>(mean);
    }
    return result;
  });
}

}  // namespace

Image checkerboard(int width, int height, int cells, const Rgba8& a, const Rgba8& b) {
  std::vector<int> column(static_cast<std::size_t>(width));
  for (int x = 0; x < width; ++x) column[static_cast<std::size_t>(x)] = x * cells / width;
  Image image(width, height);
  for (int y = 0; y < height; ++y) {
    const int row = y * cells / height;
    std::transform(column.begin(), column.end(), &image.at(0, y),
                   [&](int across) { return (across + row) % 2 == 0 ? a : b; });
  }
  return image;
}

Image road(int width, int height, std::uint32_t seed) {
  const int patch = std::max(2, std::min(width, height) / 16);
  return fill(width, height, [&](int x, int y) -> Rgba8 {
    const int across = x * 1000 / width, along = y * 1000 / height;
    const int grain =
        hash_range(x, y, seed, -18, 18) + smooth_noise(x, y, width, height, patch, 14, seed + 1);
    const bool border = (across >= 50 && across < 85) || (across >= 915 && across < 950);
    const bool dash = across >= 480 && across < 520 && along >= 250 && along < 750;
    if (border)
      return {to_byte(225 + grain / 3), to_byte(225 + grain / 3), to_byte(218 + grain / 3), 255};
    if (dash)
      return {to_byte(232 + grain / 3), to_byte(190 + grain / 3), to_byte(60 + grain / 3), 255};
    // Two darker wheel tracks.
    const bool wheel = (across >= 190 && across < 330) || (across >= 670 && across < 810);
    const int level = (wheel ? 62 : 76) + grain;
    return {to_byte(level), to_byte(level), to_byte(level + 4), 255};
  });
}

Image brick(int width, int height, std::uint32_t seed) {
  constexpr int kCourses = 8, kBricks = 4;
  return fill(width, height, [&](int x, int y) -> Rgba8 {
    // Positions in 1/1024 of a brick, so that the bond is the same at every size.
    const int row = y * kCourses * 1024 / height;
    const int course = row / 1024;
    const int column = (x * kBricks * 1024 / width + (course % 2) * 512) % (kBricks * 1024);
    const int grain = hash_range(x, y, seed, -10, 10);
    if (row % 1024 < 110 || column % 1024 < 55)
      return {to_byte(188 + grain), to_byte(182 + grain), to_byte(170 + grain), 255};
    const int tone = hash_range(column / 1024, course, seed + 1, -28, 28) + grain;
    return {to_byte(158 + tone), to_byte(74 + tone * 2 / 3), to_byte(56 + tone / 2), 255};
  });
}

Image stones(int width, int height, std::uint32_t seed) {
  constexpr int kCell = 32;  // one stone per cell, centred anywhere in the cell
  const int columns = std::max(1, width / kCell), rows = std::max(1, height / kCell);
  return fill(width, height, [&](int x, int y) -> Rgba8 {
    int nearest = std::numeric_limits<int>::max(), second = nearest, tone = 0;
    for (int j = y / kCell - 1; j <= y / kCell + 1; ++j) {
      for (int i = x / kCell - 1; i <= x / kCell + 1; ++i) {
        const int column = (i + columns) % columns, row = (j + rows) % rows;
        const int dx = x - i * kCell - hash_range(column, row, seed + 1, 0, kCell - 1);
        const int dy = y - j * kCell - hash_range(column, row, seed + 2, 0, kCell - 1);
        const int distance = dx * dx + dy * dy;
        if (distance < nearest) {
          second = nearest;
          nearest = distance;
          tone = hash_range(column, row, seed + 3, -36, 36);
        } else {
          second = std::min(second, distance);
        }
      }
    }
    // The difference of the squared distances is twice the distance to the border, times the
    // distance between the centres.
    constexpr int kGap = 360;
    const int gap = -60 * std::max(0, kGap - (second - nearest)) / kGap;
    int shade = hash_range(x, y, seed + 4, -3, 3);
    for (int cell = 2; cell <= 128; cell *= 2)
      shade += smooth_noise(x, y, width, height, cell, std::min(cell + 1, 11),
                            seed + 4 + static_cast<unsigned>(cell));
    const int level = 128 + tone + gap + shade;
    return {to_byte(level + 6), to_byte(level), to_byte(level - 10 + tone / 4), 255};
  });
}

Image zone_plate(int width, int height) {
  const std::int64_t size = std::max(width, height);
  return fill(width, height, [&](int x, int y) -> Rgba8 {
    const std::int64_t dx = 2 * x - (width - 1), dy = 2 * y - (height - 1);
    // pi r^2 / size with r^2 = (dx^2 + dy^2) / 4, reduced to one turn in integers.
    const std::int64_t phase = (dx * dx + dy * dy) % (8 * size);
    const double wave =
        sin_cos(kPi * static_cast<double>(phase) / static_cast<double>(4 * size)).cos;
    const std::uint8_t value = to_byte(static_cast<int>(std::floor(127.5 + 127.5 * wave + 0.5)));
    return {value, value, value, 255};
  });
}

Image gradient(int width, int height) {
  return fill(width, height, [&](int x, int y) -> Rgba8 {
    const int s = width > 1 ? x * 255 / (width - 1) : 0,
              t = height > 1 ? y * 255 / (height - 1) : 0;
    return {to_byte(s), to_byte(t), to_byte(255 - s), 255};
  });
}

Image noise(int width, int height, std::uint32_t seed) {
  return fill(width, height, [&](int x, int y) -> Rgba8 {
    const std::uint32_t value = hash(x, y, seed);
    return {static_cast<std::uint8_t>(value), static_cast<std::uint8_t>(value >> 8),
            static_cast<std::uint8_t>(value >> 16), 255};
  });
}

std::span<const std::string_view> texture_names() { return kTextureNames; }

Image make_texture(std::string_view name, int width, int height, std::uint32_t seed) {
  if (width < 1 || height < 1 || width > spec::texture::kMaxTextureSize ||
      height > spec::texture::kMaxTextureSize)
    throw spec::ConfigError(
        fmt::format("a texture of {} x {} texels requested; each side must be 1 to {}", width,
                    height, spec::texture::kMaxTextureSize));
  if (name == "checker") return checkerboard(width, height);
  if (name == "road") return road(width, height, seed);
  if (name == "brick") return brick(width, height, seed);
  if (name == "stones") return stones(width, height, seed);
  if (name == "zone_plate") return zone_plate(width, height);
  if (name == "gradient") return gradient(width, height);
  if (name == "noise") return noise(width, height, seed);
  std::string known;
  for (std::string_view each : kTextureNames) known += fmt::format(" {}", each);
  throw spec::ConfigError(fmt::format("unknown texture '{}'; known:{}", name, known));
}

std::vector<Image> mip_chain(const Image& base, MipSpace space) {
  std::vector<Image> levels;
  levels.push_back(base);  // not an initialiser list, which would copy the image again
  while (levels.back().width > 1 || levels.back().height > 1)
    levels.push_back(half_size(levels.back(), space, base.width == 1 || base.height == 1));
  return levels;
}

double srgb_to_linear(double stored) {
  return stored <= 0.04045 ? stored / 12.92 : power((stored + 0.055) / 1.055, 2.4);
}

double linear_to_srgb(double linear) {
  return linear <= 0.0031308 ? linear * 12.92 : 1.055 * power(linear, 1.0 / 2.4) - 0.055;
}

}  // namespace deburr::tb
