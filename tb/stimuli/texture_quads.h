// SPDX-License-Identifier: MIT
// Random texture descriptors and quads: every value that registers and the input link can carry,
// with corner cases over-represented.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "spec/texture/descriptor.h"
#include "spec/texture/packets.h"
#include "spec/texture/parameters.h"
#include "tb/base/random.h"

namespace deburr::tb::stimuli {

template <class T, std::size_t N>
T any_of(Random& random, const std::array<T, N>& choices) {
  return choices[random.below(static_cast<std::uint32_t>(N))];
}
template <class Enum, std::size_t N>
Enum any_code(Random& random, const std::array<std::string_view, N>&) {
  return static_cast<Enum>(random.below(static_cast<std::uint32_t>(N)));
}

// The defaults with the paper's configuration.
inline spec::texture::Parameters paper_configuration() {
  return preset_parameters(spec::texture::Preset::kPaper);
}

// A random configuration and kernel; cache parameters keep their defaults.
inline spec::texture::Parameters random_configuration(Random& random) {
  spec::texture::Parameters p;
  p.axes = any_code<spec::texture::Axes>(random, spec::texture::kAxesNames);
  p.axis_cycles = 1 << random.below(1 + static_cast<std::uint32_t>(p.axes));
  p.srgb_output = any_code<spec::texture::SrgbOutput>(random, spec::texture::kSrgbOutputNames);
  p.footprint = any_code<spec::texture::FootprintRule>(random, spec::texture::kFootprintNames);
  p.log2 = any_code<spec::texture::Log2Rule>(random, spec::texture::kLog2Names);
  p.count = any_code<spec::texture::CountRule>(random, spec::texture::kCountNames);
  p.count_cap = any_code<spec::texture::CountCap>(random, spec::texture::kCountCapNames);
  p.kernel = any_code<spec::texture::Kernel>(random, spec::texture::kKernelNames);
  p.spread = any_of(random, std::array{0, 1, 64, 77, 102, 128});
  p.blend = any_code<spec::texture::Blend>(random, spec::texture::kBlendNames);
  p.derivatives = any_code<spec::texture::Derivatives>(random, spec::texture::kDerivativesNames);
  return p;
}

// Width 2 or 4 with random ports, for the cache of `p`.
inline void random_width(Random& random, spec::texture::Parameters& p) {
  const auto power_up_to = [&](std::int32_t most) {
    std::uint32_t powers = 1;
    while (1 << powers <= most) ++powers;
    return 1 << random.below(powers);
  };
  p.width = random.chance(500) ? 2 : 4;
  p.fragments = power_up_to(p.width);
  p.cache_lookups = 4 + static_cast<std::int32_t>(random.below(5));
  p.cache_allocations = 1 + static_cast<std::int32_t>(random.below(4));
  const std::int32_t lines = p.cache_bytes / p.cache_line_bytes;
  const std::int32_t few = std::max(lines / 16, 256 / p.cache_line_bytes);
  p.cache_line_banks =
      power_up_to(std::min({spec::texture::kMostLineBanks, lines / p.cache_ways, few}));
  p.cache_bank_reads = 1 + static_cast<std::int32_t>(random.below(2));
  p.cache_fill_writes = power_up_to(std::min(spec::texture::kMostFillWrites, p.cache_line_banks));
  p.cache_replacement = spec::texture::Replacement::kLru;
  p.cache_outstanding = any_of(random, std::array{0, 8, 20, 64});
}

inline void random_size(Random& random, spec::texture::Descriptor& d) {
  const auto up_to = [&](std::uint32_t n) {
    return static_cast<std::uint16_t>(1 + random.below(n));
  };
  switch (random.below(8)) {
    case 0:
      d.width = d.height = 1;
      break;
    case 1:
      d.width = 1, d.height = up_to(300);
      break;
    case 2:
      d.width = up_to(300), d.height = 1;
      break;
    case 3:
      d.width = 4096, d.height = 1;
      break;
    case 4:
      d.width = up_to(4), d.height = 4096;
      break;
    case 5:
      d.width = d.height = static_cast<std::uint16_t>(1u << random.below(11));
      break;
    case 6:
      d.width = up_to(600), d.height = up_to(600);
      break;
    default:
      d.width = up_to(4096), d.height = up_to(4096);
      break;
  }
}

// A descriptor that the unit accepts. Levels start anywhere in memory, may overlap, and are
// sometimes outside it; min_lod may exceed max_lod.
inline spec::texture::Descriptor random_texture(Random& random, std::uint32_t memory_bytes) {
  spec::texture::Descriptor d;
  random_size(random, d);
  const auto most =
      static_cast<std::uint32_t>(std::bit_width(unsigned{std::max(d.width, d.height)}));
  d.levels = static_cast<std::uint8_t>(random.chance(600) ? most : 1 + random.below(most));
  d.format = static_cast<spec::texture::Format>(random.below(5));  // not in blocks
  d.layout = any_code<spec::texture::Layout>(random, spec::texture::kLayoutNames);
  d.wrap_s = any_code<spec::texture::Wrap>(random, spec::texture::kWrapNames);
  d.wrap_t = any_code<spec::texture::Wrap>(random, spec::texture::kWrapNames);
  d.min_filter = any_code<spec::texture::MinFilter>(random, spec::texture::kMinFilterNames);
  d.mag_filter = any_code<spec::texture::MagFilter>(random, spec::texture::kMagFilterNames);
  d.max_anisotropy_log2 = static_cast<std::uint8_t>(random.below(5));
  if (random.chance(500))
    d.lod_bias = static_cast<std::int16_t>(static_cast<int>(random.below(1025)) - 512);
  if (random.chance(200)) d.lod_bias = static_cast<std::int16_t>(random.next());
  if (random.chance(100)) d.lod_bias = std::numeric_limits<std::int16_t>::min();
  if (random.chance(300)) d.min_lod = static_cast<std::uint16_t>(random.below(6 << 8));
  if (random.chance(300)) d.max_lod = static_cast<std::uint16_t>(random.below(6 << 8));
  if (random.chance(50)) d.max_lod = std::numeric_limits<std::uint16_t>::max();
  for (std::uint32_t& base : d.base) {
    const bool outside = random.chance(40);
    base =
        (outside ? static_cast<std::uint32_t>(random.next()) : random.below(memory_bytes)) & ~63u;
  }
  return d;
}

// Makes a descriptor invalid by a code that the registers can hold.
inline void spoil(Random& random, spec::texture::Descriptor& d) {
  switch (random.below(10)) {
    case 0:
      d.width = 0;
      break;
    case 1:
      d.height = 0;
      break;
    case 2:
      d.width = static_cast<std::uint16_t>(4097 + random.below(60000));
      break;
    case 3:
      d.height = 4097;
      break;
    case 4:
      d.levels = 0;
      break;
    case 5:
      d.width = d.height = 64;
      d.levels = static_cast<std::uint8_t>(8 + random.below(8));
      break;
    case 6:
      d.format = static_cast<spec::texture::Format>(5 + random.below(3));
      break;
    case 7:
      d.wrap_t = static_cast<spec::texture::Wrap>(3);
      break;
    case 8:
      d.min_filter = static_cast<spec::texture::MinFilter>(6 + random.below(2));
      break;
    default:
      d.base[0] |= 1 + random.below(63);
      break;
  }
}

inline constexpr std::array<std::int32_t, 14> kCoordinateCorners = {
    std::numeric_limits<std::int32_t>::min(),  // -128
    std::numeric_limits<std::int32_t>::min() + 1,
    -2 * spec::texture::kCoordinateOne,
    -spec::texture::kCoordinateOne,
    -spec::texture::kCoordinateOne - 1,
    -1,
    0,
    1,
    spec::texture::kCoordinateOne / 2,
    spec::texture::kCoordinateOne - 1,
    spec::texture::kCoordinateOne,
    2 * spec::texture::kCoordinateOne,
    std::numeric_limits<std::int32_t>::max() - 1,
    std::numeric_limits<std::int32_t>::max()};

// Four values of one coordinate: a slightly curved plane with a slope of any magnitude along each
// axis, equal values, extreme values, or unrelated values.
inline std::array<std::int32_t, 4> random_coordinates(Random& random) {
  std::array<std::int32_t, 4> c{};
  switch (random.below(12)) {
    case 0:
      for (std::int32_t& lane : c) lane = static_cast<std::int32_t>(random.next());
      return c;
    case 1:
      for (std::int32_t& lane : c) lane = any_of(random, kCoordinateCorners);
      return c;
    case 2:
      c.fill(any_of(random, kCoordinateCorners));
      return c;
    default:
      break;
  }
  const auto within = [&](std::int64_t limit) {
    const auto span = static_cast<std::uint32_t>(2 * limit + 1);
    return static_cast<std::int64_t>(random.below(span)) - limit;
  };
  const std::int64_t base = within(4 * spec::texture::kCoordinateOne);
  const std::int64_t along = within(1 << (4 + random.below(20))),
                     across = within(1 << (4 + random.below(20)));
  for (std::int64_t lane = 0; lane < 4; ++lane) {
    const std::int64_t value = base + (lane & 1) * along + (lane >> 1) * across + within(16);
    c[static_cast<std::size_t>(lane)] = static_cast<std::int32_t>(value);
  }
  return c;
}

inline spec::texture::Quad random_quad(Random& random, std::uint32_t tag, std::uint8_t texture) {
  spec::texture::Quad q;
  q.tag = tag;
  q.texture = texture;
  q.coverage = static_cast<std::uint8_t>(random.chance(500) ? 15 : random.below(16));
  q.clamped = static_cast<std::uint8_t>(random.chance(800) ? 0 : random.below(16));
  q.s = random_coordinates(random);
  q.t = random_coordinates(random);
  return q;
}

}  // namespace deburr::tb::stimuli
