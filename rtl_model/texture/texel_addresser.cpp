// SPDX-License-Identifier: MIT
#include "rtl_model/texture/texel_addresser.h"

#include <array>

namespace deburr::rtl::texture {
namespace {

constexpr int kFractionBits = 24;
constexpr std::int64_t kOne = std::int64_t{1} << kFractionBits;

// The bits of a 5-bit number in the even places of a 10-bit one: wires.
constexpr auto kSpread = [] {
  std::array<std::uint16_t, 32> table{};
  for (unsigned i = 0; i < 32; ++i)
    for (unsigned bit = 0; bit < 5; ++bit)
      table[i] = static_cast<std::uint16_t>(table[i] | (i >> bit & 1) << (2 * bit));
  return table;
}();
std::uint32_t spread(std::uint32_t tile) {  // U10
  return kSpread[tile & 31] | std::uint32_t{kSpread[tile >> 5]} << 10;
}

// Where tile number `tile` along one axis stands in Morton order, its bits in even places: the low
// `common` bits interleave with those of the other axis, the others stand above both.
std::uint32_t morton_part(std::uint32_t tile, int common) {
  return spread(tile & ((1u << common) - 1)) | tile >> common << (2 * common);
}
// The same with the interleaved bits in the odd places.
std::uint32_t odd_morton_part(std::uint32_t tile, int common) {
  return spread(tile & ((1u << common) - 1)) << 1 | tile >> common << (2 * common);
}

std::int64_t wrapped(std::int64_t position, spec::texture::Wrap wrap) {
  if (wrap == spec::texture::Wrap::kRepeat) {
    position &= kOne - 1;
  } else if (wrap == spec::texture::Wrap::kMirroredRepeat) {
    position &= 2 * kOne - 1;
    if (position & kOne) position ^= 2 * kOne - 1;  // 2^25 - 1 - q is the complement of q
  }
  return position;
}

}  // namespace

TexelAddresser::TexelAddresser(const sc_core::sc_module_name& name, ClockDomain& clock,
                               const Descriptors::Reader& descriptors)
    : Unit(name, clock), descriptors_(descriptors) {}

Activity TexelAddresser::tick(Cycle cycle) {
  const bool arrives = samples_in.can_pop(cycle);
  if (stages_.empty() && !arrives) return kIdle;
  if (stages_.leaving() && !texels_out.can_push(cycle)) return kStalledDownstream;
  stages_.step();
  if (stages_.works(5)) address(stages_.leave(), texels_out.emplace(cycle));
  if (stages_.works(4)) split(stages_.at(4));
  if (stages_.works(3)) scale(stages_.at(3));
  if (stages_.works(2)) wrap(stages_.at(2));
  if (arrives) {
    choose(cycle, samples_in.front(cycle), stages_.enter());
    samples_in.pop(cycle);
  }
  return kBusy;
}

// Stage 1.
void TexelAddresser::choose(Cycle cycle, const SampleToken& sample, Entry& entry) {
  const TextureState& texture = descriptors_.read(cycle, sample.ticket.texture);
  entry.ticket = sample.ticket;
  entry.control = {0,
                   0,
                   sample.level_weight,
                   sample.kernel_weight,
                   sample.sum_log2,
                   static_cast<std::uint8_t>(texture.format),
                   sample.last_of_sample,
                   sample.last_of_fragment};
  entry.linear = sample.linear;
  entry.level = sample.level;
  entry.texture = &texture;
  entry.s = sample.s;
  entry.t = sample.t;
  if (sample.ticket.valid) ++bilinears;
}

// Stage 2.
void TexelAddresser::wrap(Entry& entry) {
  entry.geometry = &entry.texture->level[entry.level];
  entry.s = wrapped(entry.s, entry.texture->wrap_s);
  entry.t = wrapped(entry.t, entry.texture->wrap_t);
}

// Stage 3: S9.24 x U13.
void TexelAddresser::scale(Entry& entry) {
  entry.s *= entry.geometry->width;
  entry.t *= entry.geometry->height;
}

// Stage 4.
void TexelAddresser::split(Entry& entry) {
  if (!entry.ticket.valid) return;
  entry.x = neighbours(entry.s, entry.geometry->width, entry.texture->wrap_s, entry.linear);
  entry.y = neighbours(entry.t, entry.geometry->height, entry.texture->wrap_t, entry.linear);
  entry.control.fraction_u = entry.x.fraction;
  entry.control.fraction_v = entry.y.fraction;
}

TexelAddresser::Axis TexelAddresser::neighbours(std::int64_t scaled, std::int32_t size,
                                                spec::texture::Wrap wrap, bool linear) {
  Axis axis;
  if (linear) {
    // Half a texel less, rounded from 24 to 8 fraction bits: both constants are one addition.
    const std::int64_t u = (scaled - (kOne >> 1) + (1 << 15)) >> 16;
    axis.first = static_cast<std::int32_t>(u >> 8);
    axis.second = axis.first + 1;
    axis.fraction = static_cast<std::uint8_t>(u & 255);
  } else {
    axis.first = axis.second = static_cast<std::int32_t>(scaled >> kFractionBits);
    axis.fraction = 0;
  }
  const std::int32_t last = size - 1;
  const bool repeats = wrap == spec::texture::Wrap::kRepeat;
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
void TexelAddresser::address(const Entry& entry, TexelToken& out) {
  out.ticket = entry.ticket;
  out.control = entry.control;
  if (!out.ticket.valid) return;
  const TextureState& texture = *entry.texture;
  const LevelGeometry& level = *entry.geometry;
  const auto x0 = static_cast<std::uint32_t>(entry.x.first),
             x1 = static_cast<std::uint32_t>(entry.x.second),
             y0 = static_cast<std::uint32_t>(entry.y.first),
             y1 = static_cast<std::uint32_t>(entry.y.second);

  std::uint32_t column0, column1, row0, row1;
  const bool linear_layout = texture.layout == spec::texture::Layout::kLinear;
  if (linear_layout) {
    column0 = x0 << texture.texel_log2;
    column1 = x1 << texture.texel_log2;
    row0 = y0 * level.pitch;
    row1 = y1 * level.pitch;
  } else {
    // A tile of 64 bytes has 2^(6 - texel_log2) texels, its width takes the larger half of the
    // bits.
    const int width_log2 = (7 - texture.texel_log2) / 2, row_log2 = width_log2 + texture.texel_log2;
    const int height_log2 = 6 - row_log2;
    const int common =
        level.tiles_x_log2 < level.tiles_y_log2 ? level.tiles_x_log2 : level.tiles_y_log2;
    const auto column = [&](std::uint32_t x) {
      return morton_part(x >> width_log2, common) << 6 | (x & ((1u << width_log2) - 1))
                                                             << texture.texel_log2;
    };
    const auto row = [&](std::uint32_t y) {
      return odd_morton_part(y >> height_log2, common) << 6 | (y & ((1u << height_log2) - 1))
                                                                  << row_log2;
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
