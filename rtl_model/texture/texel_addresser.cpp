// SPDX-License-Identifier: MIT
#include "rtl_model/texture/texel_addresser.h"

#include <algorithm>
#include <array>

#include "rtl_model/texture/datasheets.h"
#include "spec/texture/packets.h"

namespace deburr::rtl::texture {
namespace {

using spec::texture::kCoordinateFractionBits;

constexpr std::int64_t kOne = std::int64_t{1} << kCoordinateFractionBits;

}  // namespace

template <class Width>
TexelAddresserOf<Width>::TexelAddresserOf(const sc_core::sc_module_name& name, ClockDomain& clock,
                                          const Descriptors::Reader& descriptors,
                                          const std::optional<Descriptors::Reader>& younger)
    : TexelAddresserBase(name, clock), descriptors_(descriptors), younger_(younger) {}

template <class Width>
Activity TexelAddresserOf<Width>::tick(Cycle cycle) {
  const bool arrives = samples_in.can_pop(cycle);
  if (pipe_.empty() && !arrives) return kIdle;
  if (pipe_.leaves() && !texels_out.can_push(cycle)) return kStalledDownstream;
  pipe_.move();
  if (const auto* done = pipe_.at(kStages)) texels_out.push(cycle, *done);
  if (arrives) enter(cycle, samples_in.take(cycle));
  return kBusy;
}

// A group has requests of at most two quads.
template <class Width>
inline void TexelAddresserOf<Width>::enter(
    Cycle cycle, const typename Width::template Requests<SampleToken>& samples) {
  const std::uint8_t first = nth(samples, 0).ticket.texture;
  const TextureState& texture = descriptors_.read(cycle, first);
  auto& texels = pipe_.enter();
  if constexpr (Width::kMost == 1) {
    request(texture, samples, texels);
  } else {
    texels.partial = samples.partial;
    const TextureState* second = nullptr;
    each(samples, texels, [&](const SampleToken& sample, TexelToken& out) {
      const bool other = sample.ticket.texture != first;
      if (other && !second) second = &younger_->read(cycle, sample.ticket.texture);
      request(other ? *second : texture, sample, out);
    });
  }
}

// Computes all stages at once. Intermediate results are not observable, since a descriptor does not
// change while the unit is busy.
template <class Width>
inline void TexelAddresserOf<Width>::request(const TextureState& texture, const SampleToken& sample,
                                             TexelToken& out) {
  // Stage 1.
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
  // Stage 5.
  const std::uint32_t left = level.column[x.first], right = level.column[x.second],
                      upper = level.row[y.first], lower = level.row[y.second];
  out.address = {upper + left, upper + right, lower + left, lower + right};
  const bool rows = texture.layout == spec::texture::Layout::kLinear;
  out.turned = {rows && y.first % 2 != 0, rows && y.second % 2 != 0};
  if (texture.codec == 0) [[likely]]
    return;
  out.turned = {rows && y.first / 4 % 2 != 0, rows && y.second / 4 % 2 != 0};
  control.codec = texture.codec;
  control.within = static_cast<std::uint8_t>(x.first % 4 | x.second % 4 << 2 | y.first % 4 << 4 |
                                             y.second % 4 << 6);
}

// Stages 2 to 4 for one axis: wraps the coordinate, scales it to texels, splits it, and brings both
// texels into range.
template <class Width>
inline typename TexelAddresserOf<Width>::Axis TexelAddresserOf<Width>::scale(
    std::int64_t position, std::int32_t size, spec::texture::Wrap wrap, bool linear) {
  if (wrap == spec::texture::Wrap::kRepeat) {
    position &= kOne - 1;
  } else if (wrap == spec::texture::Wrap::kMirroredRepeat) {
    position &= 2 * kOne - 1;
    if (position & kOne) position ^= 2 * kOne - 1;  // 2^25 - 1 - q is the complement of q
  }
  const std::int64_t scaled = position * size;  // S22.24
  std::int32_t first, second;
  std::uint8_t fraction = 0;
  if (linear) {
    // Subtracts half a texel and rounds from 24 to 8 fraction bits; both constants need one adder.
    const std::int64_t u = (scaled - (kOne >> 1) + (1 << 15)) >> 16;
    first = static_cast<std::int32_t>(u >> 8);
    second = first + 1;
    fraction = static_cast<std::uint8_t>(u & 255);
  } else {
    first = second = static_cast<std::int32_t>(scaled >> kCoordinateFractionBits);
  }
  const std::int32_t last = size - 1;
  if (first >= 0 && second <= last) [[likely]]
    return {static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(second), fraction};
  const bool repeats = wrap == spec::texture::Wrap::kRepeat;
  const auto into_range = [&](std::int32_t x) {
    if (x < 0) x = repeats ? last : 0;
    if (x > last) x = repeats ? 0 : last;
    return static_cast<std::uint32_t>(x);
  };
  return {into_range(first), into_range(second), fraction};
}

template <class Width>
Datasheet TexelAddresserOf<Width>::datasheet(const spec::texture::Parameters& p) {
  const bool wide = p.width > 1;
  // Ticket, weight, index and count, flags and format of a request, and valid.
  const bool blocks = p.decode != spec::texture::Decode::kNone;
  const std::uint32_t kept = 40 + 9 + 2 * 4 + selects_kernel(p) + 2 + (blocks ? 5 : 3) + 1;
  const std::uint32_t position = Sizes(p).position;
  // Size, layout, wrap modes and bases of the levels of a descriptor.
  constexpr std::uint32_t kDescriptor = 26 + 1 + 4 + spec::texture::kMaxLevels * 26;
  const std::uint32_t descriptors = wide ? 2 : 1, bases = descriptors * spec::texture::kMaxLevels;
  Datasheet sheet = {
      .unit = "TexelAddresser",
      .variant = (wide ? "`width` above 1" : "`width = 1`") + with_blocks(p),
      .does = "Computes the addresses of a sample's four texels and its bilinear fractions.",
      .latency = {5},
      .stages = {{.clock = "1",
                  .work = "descriptor selected",
                  .longest = {op::mux(26, spec::texture::kMaxTextures)},
                  .registers = kept + 2 * position + 4 + 1},
                 {.clock = "2",
                  .work = "level selected, both coordinates wrapped",
                  .operators = {op::mux(26, bases), 2 * op::shift(13, 13), op::logic(200)},
                  .longest = {op::mux(26, bases)},
                  .registers = kept + 2 * position + 2 * 13 + 26 + 4 + 1 + 1},
                 {.clock = "3",
                  .work = "products with the level's width and height",
                  .operators = {2 * op::multiply(position, 13)},
                  .longest = {op::multiply(position, 13)},
                  .registers = kept + 2 * 32 + 2 * 13 + 26 + 4 + 1 + 1},
                 {.clock = "4",
                  .work = "subtract half a texel, round, split into texel and fraction, bring both "
                          "texels of each axis into range",
                  .operators = {2 * op::add(32), 2 * op::mux(20, 2), 2 * op::add(14),
                                2 * op::subtract(13), 4 * op::compare(14), 4 * op::mux(12, 3)},
                  .longest = {op::add(32), op::mux(20, 2), op::add(14), op::compare(14),
                              op::mux(12, 3)},
                  .registers = kept + 2 * 8 + 4 * 12 + 2 * 13 + 26 + 1},
                 // `linear`: a multiple of 64 as the pitch. `tiled`: tiles and places in them of
                 // two columns and two rows, of which the common bits are interleaved.
                 {.clock = "5",
                  .work = "two column parts, two row parts, four sums",
                  .operators = {op::mux(10, 3), op::add(10), 2 * op::multiply(12, 9),
                                2 * op::mux(14, 3), 2 * op::subtract(13), op::count_ones(10),
                                4 * op::mux(12, 2), 8 * op::shift(12, 16), 4 * op::mux(6, 3),
                                4 * op::mux(28, 2),
                                2 * op::add(26), 4 * op::add(32), op::logic(150)},
                  .longest = {op::subtract(13), op::count_ones(10), 2 * op::shift(12, 16),
                              op::mux(28, 2), op::add(32)}}},
      .formats = "position S9.24, texel position rounded to 8 fraction bits, address U32.",
      .copies = Sizes(p).width,
      .per = "request",
      .shared_registers = descriptors * kDescriptor};
  // Blocks instead of tiles.
  if (blocks) sheet.stages[4].operators.push_back(4 * op::mux(12 + 28, 2));
  if (wide) sheet.stages[1].operators.push_back(op::mux(26 + 1 + 4, 2));
  return sheet;
}

template class TexelAddresserOf<Narrow>;
template class TexelAddresserOf<Wide>;

}  // namespace deburr::rtl::texture
