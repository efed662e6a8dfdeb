// SPDX-License-Identifier: MIT
#include "rtl_model/texture/derivative_unit.h"

#include <bit>

#include "rtl_model/texture/datasheets.h"

namespace deburr::rtl::texture {
namespace {

// Magnitude of a difference in texels: S8.24 x U13 = U20.24, rounded to U15.16 plus one overflow
// bit (bit 31 or above).
std::uint64_t in_texels(std::int64_t difference, std::uint16_t size) {
  const auto magnitude = static_cast<std::uint64_t>(difference < 0 ? -difference : difference);
  return (magnitude * size + (1u << 7)) >> 8;
}

std::uint32_t saturate(std::uint64_t texels) {
  constexpr std::uint64_t kLargest = (std::uint64_t{1} << 31) - 1;  // U15.16
  return static_cast<std::uint32_t>(texels > kLargest ? kLargest : texels);
}

std::int64_t difference(std::int32_t to, std::int32_t from) {
  return std::int64_t{to} - from;  // S8.24
}

}  // namespace

template <class Width>
DerivativeUnitOf<Width>::DerivativeUnitOf(const sc_core::sc_module_name& name, ClockDomain& clock,
                                          ControlRegisters& registers,
                                          const Descriptors::Reader& descriptors,
                                          LatencyProbe& probe,
                                          spec::texture::Derivatives derivatives, std::int32_t most)
    : DerivativeUnitBase(name, clock),
      registers_(registers),
      descriptors_(descriptors),
      probe_(probe),
      most_(static_cast<std::size_t>(most)),
      own_(derivatives == spec::texture::Derivatives::kFine ? 3 : 0) {}

template <class Width>
Activity DerivativeUnitOf<Width>::tick(Cycle cycle) {
  const bool works = waiting_ != 0 || (registers_.enabled() && quads_in.can_pop(cycle));
  if (pipe_.empty() && !works) return kIdle;
  if (pipe_.leaves() && !derivatives_out.can_push(cycle)) return kStalledDownstream;
  pipe_.move();
  if (const auto* done = pipe_.at(kStages)) derivatives_out.push(cycle, *done);
  if (!works) return kBusy;
  if (waiting_ == 0) take(cycle);
  if (waiting_ == 0) return kBusy;
  const TextureState& texture = descriptors_.read(cycle, quad_.texture);
  auto& group = pipe_.enter();
  if constexpr (Width::kMost == 1) {
    split(texture, group);
  } else {
    group.count = 0;
    do split(texture, group.at[group.count]);
    while (++group.count < most_ && waiting_ != 0);
  }
  return kBusy;
}

template <class Width>
inline void DerivativeUnitOf<Width>::take(Cycle cycle) {
  quad_ = quads_in.take(cycle);
  waiting_ = quad_.coverage & 0xF;
  ++quads;
  for (unsigned lanes = waiting_; lanes != 0; lanes &= lanes - 1) probe_.enters(cycle);
}

// Computes all stages for one lane at once. Intermediate results are not observable, since a
// descriptor does not change while the unit is busy.
template <class Width>
inline void DerivativeUnitOf<Width>::split(const TextureState& texture, DerivativeToken& out) {
  const auto lane = static_cast<unsigned>(std::countr_zero(waiting_));
  waiting_ &= waiting_ - 1;
  const auto& s = quad_.s;
  const auto& t = quad_.t;
  const unsigned row = lane & own_ & 2, column = lane & own_ & 1;
  out.ticket = {quad_.tag, static_cast<std::uint8_t>(lane), waiting_ == 0, texture.valid,
                static_cast<std::uint8_t>(quad_.texture & 15)};
  out.s = s[lane];
  out.t = t[lane];
  out.s_x = difference(s[row + 1], s[row]);
  out.t_x = difference(t[row + 1], t[row]);
  out.s_y = difference(s[2 + column], s[column]);
  out.t_y = difference(t[2 + column], t[column]);
  const std::uint64_t s_x = in_texels(out.s_x, texture.width),
                      t_x = in_texels(out.t_x, texture.height),
                      s_y = in_texels(out.s_y, texture.width),
                      t_y = in_texels(out.t_y, texture.height);
  out.size_s_x = saturate(s_x);
  out.size_t_x = saturate(t_x);
  out.size_s_y = saturate(s_y);
  out.size_t_y = saturate(t_y);

  ++fragments;
  if (quad_.clamped >> lane & 1) ++clamped;
  if (!texture.valid) {
    ++invalid;
    registers_.set_sticky(spec::texture::reg::kStatusInvalidTexture);
  } else if (((s_x | t_x | s_y | t_y) >> 31) != 0) {
    ++saturated;
  }
}

template <class Width>
void DerivativeUnitOf<Width>::reset() {
  waiting_ = 0;
  pipe_.reset();
  probe_.reset();
}

template <class Width>
Datasheet DerivativeUnitOf<Width>::datasheet(const spec::texture::Parameters& p) {
  constexpr std::uint32_t kQuad = kPayloadBits<spec::texture::Quad> - 2 * 16,  // without x and y
      kKept = kPayloadBits<DerivativeToken> - 4 * 31 + 1;  // without the sizes; and valid
  Datasheet sheet = {
      .unit = "DerivativeUnit",
      .does =
          "Splits a quad into its covered fragments, with coordinate differences along their "
          "row and column (`derivatives = coarse`: row 0 and column 0).",
      .latency = {3},
      .interval =
          {1,
           "one cycle per covered lane, or per group of at most `fragments` lanes (a quad without "
           "covered lanes: 1)"},
      .stages = {{.clock = "1",
                  .work = "next covered lane, its four differences, descriptor selected",
                  .operators = {op::priority(4), 2 * op::mux(32, 4), 4 * op::subtract(33)},
                  .longest = {op::mux(32, 2), op::subtract(33)},
                  .registers = kKept},
                 {.clock = "2",
                  .work = "products of the four differences with the width or height of level 0",
                  .operators = {4 * op::multiply(33, 13)},
                  .longest = {op::multiply(33, 13)},
                  .registers = kKept + 4 * 46},
                 {.clock = "3",
                  .work = "magnitude, rounding and saturation of each",
                  .operators = {4 * op::magnitude(46), op::logic(4 * 38)},
                  .longest = {op::magnitude(46)}}},
      .formats = "S7.24 in; S8.24 and U15.16 out, rounded to nearest, saturated at 2^31 - 1.",
      .copies = Sizes(p).fragments,
      .per = "fragment",
      .shared = {op::mux(kQuad, 2)},
      .shared_registers = kQuad + 2 * 13};
  if (p.derivatives == spec::texture::Derivatives::kFine) {  // row and column of the lane
    Stage& first = sheet.stages[0];
    first.operators.push_back(8 * op::mux(32, 2));
    first.longest = {op::mux(32, 2), op::priority(4), op::mux(32, 2), op::subtract(33)};
  }
  return sheet;
}

template class DerivativeUnitOf<Narrow>;
template class DerivativeUnitOf<Wide>;

}  // namespace deburr::rtl::texture
