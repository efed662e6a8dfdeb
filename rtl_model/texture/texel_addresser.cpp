// SPDX-License-Identifier: MIT
#include "rtl_model/texture/texel_addresser.h"

#include <algorithm>
#include <array>

#include "spec/texture/packets.h"

namespace deburr::rtl::texture {
namespace {

using spec::texture::kCoordinateFractionBits;

constexpr std::int64_t kOne = std::int64_t{1} << kCoordinateFractionBits;

// The bits of a 10-bit number in the even places of a 20-bit one: wires.
constexpr auto kSpread = [] {
  std::array<std::uint32_t, 1024> table{};
  for (std::uint32_t i = 0; i < table.size(); ++i)
    for (unsigned bit = 0; bit < 10; ++bit) table[i] |= (i >> bit & 1) << (2 * bit);
  return table;
}();

}  // namespace

TexelAddresser::TexelAddresser(const sc_core::sc_module_name& name, ClockDomain& clock,
                               const Descriptors::Reader& descriptors)
    : Unit(name, clock), descriptors_(descriptors) {}

Activity TexelAddresser::tick(Cycle cycle) {
  const bool arrives = samples_in.can_pop(cycle);
  if (pipe_.empty() && !arrives) return kIdle;
  if (pipe_.leaves() && !texels_out.can_push(cycle)) return kStalledDownstream;
  pipe_.move();
  if (const TexelToken* done = pipe_.at(kStages)) texels_out.push(cycle, *done);
  if (arrives) {
    request(cycle, samples_in.front(cycle), pipe_.enter());
    samples_in.pop(cycle);
  }
  return kBusy;
}

// All stages: what is between them cannot be seen from outside, since a descriptor stands still
// while the unit is busy.
inline void TexelAddresser::request(Cycle cycle, const SampleToken& sample, TexelToken& out) {
  // Stage 1.
  const TextureState& texture = descriptors_.read(cycle, sample.ticket.texture);
  out.ticket = sample.ticket;
  FilterControl& control = out.control;
  control = {0,
             0,
             sample.level_weight,
             sample.index,
             sample.last_index,
             static_cast<std::uint8_t>(texture.format),
             sample.last_of_sample,
             sample.last_of_fragment};
  if (!sample.ticket.valid) return;
  ++bilinears;
  // Stage 2.
  const LevelGeometry& level = texture.level[sample.level];
  const Axis x = scale(sample.s, level.width, texture.wrap_s, sample.linear),
             y = scale(sample.t, level.height, texture.wrap_t, sample.linear);
  control.fraction_u = x.fraction;
  control.fraction_v = y.fraction;
  address(texture, level, x, y, out);
}

// Stages 2 to 4, one axis: wrap the coordinate; scale it to texels; split it, bring both texels
// into range.
inline TexelAddresser::Axis TexelAddresser::scale(std::int64_t position, std::int32_t size,
                                                  spec::texture::Wrap wrap, bool linear) {
  if (wrap == spec::texture::Wrap::kRepeat) {
    position &= kOne - 1;
  } else if (wrap == spec::texture::Wrap::kMirroredRepeat) {
    position &= 2 * kOne - 1;
    if (position & kOne) position ^= 2 * kOne - 1;  // 2^25 - 1 - q is the complement of q
  }
  const std::int64_t scaled = position * size;  // S22.24
  Axis axis;
  if (linear) {
    // Half a texel less, rounded from 24 to 8 fraction bits: both constants are one addition.
    const std::int64_t u = (scaled - (kOne >> 1) + (1 << 15)) >> 16;
    axis.first = static_cast<std::int32_t>(u >> 8);
    axis.second = axis.first + 1;
    axis.fraction = static_cast<std::uint8_t>(u & 255);
  } else {
    axis.first = axis.second = static_cast<std::int32_t>(scaled >> kCoordinateFractionBits);
    axis.fraction = 0;
  }
  const std::int32_t last = size - 1;
  const bool repeats = wrap == spec::texture::Wrap::kRepeat;
  if (axis.first >= 0 && axis.second <= last) [[likely]]
    return axis;
  const auto into_range = [&](std::int32_t x) {
    if (x < 0) return repeats ? last : 0;
    if (x > last) return repeats ? 0 : last;
    return x;
  };
  axis.first = into_range(axis.first);
  axis.second = into_range(axis.second);
  return axis;
}

// Stage 5.
inline void TexelAddresser::address(const TextureState& texture, const LevelGeometry& level,
                                    const Axis& x, const Axis& y, TexelToken& out) {
  const auto x0 = static_cast<std::uint32_t>(x.first), x1 = static_cast<std::uint32_t>(x.second),
             y0 = static_cast<std::uint32_t>(y.first), y1 = static_cast<std::uint32_t>(y.second);

  std::uint32_t column0, column1, row0, row1;
  const bool linear_layout = texture.layout == spec::texture::Layout::kLinear;
  if (linear_layout) {
    column0 = x0 << texture.texel_log2;
    column1 = x1 << texture.texel_log2;
    row0 = y0 * level.pitch;
    row1 = y1 * level.pitch;
  } else {
    const unsigned width_log2 = texture.tile_width_log2, height_log2 = texture.tile_height_log2;
    const unsigned row_log2 = width_log2 + texture.texel_log2;
    const std::uint32_t texels_x = (1u << width_log2) - 1, texels_y = (1u << height_log2) - 1;
    // The tiles stand in Morton order: the low `common` bits of their numbers interleave, those of
    // columns in the even places, the others stand above both.
    const unsigned common = level.mixed_log2;
    const std::uint32_t mixed = (1u << common) - 1;
    const auto column = [&](std::uint32_t at) {
      const std::uint32_t tile = at >> width_log2, low = tile & mixed;
      return (kSpread[low] | (tile ^ low) << common) << 6 | (at & texels_x) << texture.texel_log2;
    };
    const auto row = [&](std::uint32_t at) {
      const std::uint32_t tile = at >> height_log2, low = tile & mixed;
      return (kSpread[low] << 1 | (tile ^ low) << common) << 6 | (at & texels_y) << row_log2;
    };
    column0 = column(x0);
    column1 = column(x1);
    row0 = row(y0);
    row1 = row(y1);
  }
  out.address = {level.base + column0 + row0, level.base + column1 + row0,
                 level.base + column0 + row1, level.base + column1 + row1};
  out.turned = {linear_layout && (y0 & 1), linear_layout && (y1 & 1)};
}

}  // namespace deburr::rtl::texture
