// SPDX-License-Identifier: MIT
#include "rtl_model/texture/filter_pipeline.h"

#include <string>

#include "spec/texture/descriptor.h"
#include "spec/texture/packets.h"
#include "spec/texture/tables.h"

namespace deburr::rtl::texture {
namespace {

using Texel = std::array<std::uint16_t, 4>;  // U8.4 each

constexpr std::uint32_t kCodedChannels = 4 * 3;

spec::texture::Format format_of(const TexelQuadToken& token) {
  return static_cast<spec::texture::Format>(token.control.format);
}

constexpr unsigned bit_after(int stage) { return 1u << (stage - 1); }

// Channels are widened to eight bits by repeating their high bits: wires.
constexpr std::uint16_t unorm8(std::uint32_t v) {
  return static_cast<std::uint16_t>((v & 255) << 4);
}
constexpr std::uint16_t unorm6(std::uint32_t v) { return unorm8((v & 63) << 2 | (v & 63) >> 4); }
constexpr std::uint16_t unorm5(std::uint32_t v) { return unorm8((v & 31) << 3 | (v & 31) >> 2); }
constexpr std::uint16_t unorm4(std::uint32_t v) { return unorm8((v & 15) << 4 | (v & 15)); }
constexpr std::uint16_t kOpaque = unorm8(255);

Texel unpack_rgba8(std::uint32_t raw) {
  return {unorm8(raw), unorm8(raw >> 8), unorm8(raw >> 16), unorm8(raw >> 24)};
}
Texel unpack_rgb565(std::uint32_t raw) {
  return {unorm5(raw >> 11), unorm6(raw >> 5), unorm5(raw), kOpaque};
}
Texel unpack_rgba4444(std::uint32_t raw) {
  return {unorm4(raw >> 12), unorm4(raw >> 8), unorm4(raw >> 4), unorm4(raw)};
}
Texel unpack_l8(std::uint32_t raw) { return {unorm8(raw), unorm8(raw), unorm8(raw), kOpaque}; }

}  // namespace

FilterPipeline::FilterPipeline(const sc_core::sc_module_name& name, ClockDomain& clock,
                               LatencyProbe& probe)
    : Unit(name, clock),
      occupancy{Counter{"stage_1", "clk", "clocks in which stage 1, fields, had a request"},
                Counter{"stage_2", "clk", "clocks in which stage 2, unpack, had a request"},
                Counter{"stage_3", "clk", "clocks in which stage 3, products, had a request"},
                Counter{"stage_4", "clk", "clocks in which stage 4, sums, had a request"},
                Counter{"stage_5", "clk", "clocks in which stage 5, vertical lerp, had a request"},
                Counter{"stage_6", "clk", "clocks in which stage 6, level lerp, had a request"},
                Counter{"stage_7", "clk", "clocks in which stage 7, accumulate, had a sample"},
                Counter{"stage_8", "clk", "clocks in which stage 8, pack, had a fragment"}},
      probe_(probe),
      srgb_("srgb",
            {.words = spec::texture::kSrgbToLinear.size(),
             .word_bits = 12,
             .kind = MemoryKind::kRom,
             .read_ports = kCodedChannels,
             .write_ports = 0,
             .latency = 1,
             .content = "linear light of a coded channel"},
            spec::texture::kSrgbToLinear) {
  for (std::uint32_t i = 0; i < kCodedChannels; ++i)
    linear_.emplace_back(srgb_, "texel_" + std::to_string(i / 3) + "_" + "rgb"[i % 3]);
}

// From the last stage to the first, so that each reads its predecessor's registers of the last
// clock.
Activity FilterPipeline::tick(Cycle cycle) {
  const unsigned before = occupied_;
  const bool arrives = texels_in.can_pop(cycle);
  if (before == 0 && !arrives) return kIdle;
  if ((before & bit_after(7)) && !colours_out.can_push(cycle)) {
    if (arrives) ++occupancy[0];
    for (std::size_t stage = 1; stage < kStages; ++stage)
      if (before >> (stage - 1) & 1) ++occupancy[stage];
    return kStalledDownstream;
  }
  unsigned after = 0;
  if (before & bit_after(7)) deliver(cycle);
  if (before & bit_after(6) && accumulate()) after |= bit_after(7);
  if (before & bit_after(5) && lerp_levels()) after |= bit_after(6);
  if (before & bit_after(4)) lerp_rows(), after |= bit_after(5);
  if (before & bit_after(3)) add(), after |= bit_after(4);
  if (before & bit_after(2)) multiply(), after |= bit_after(3);
  if (before & bit_after(1)) unpack(cycle), after |= bit_after(2);
  if (arrives) {
    raw_ = texels_in.front(cycle);
    texels_in.pop(cycle);
    look_up(cycle);
    after |= bit_after(1);
  }
  occupied_ = after;
  return kBusy;
}

// Stage 1: the coded channels go into the ROM.
void FilterPipeline::look_up(Cycle cycle) {
  ++occupancy[0];
  if (!raw_.ticket.valid || format_of(raw_) != spec::texture::Format::kSrgb8A8) return;
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t c = 0; c < 3; ++c)
      linear_[3 * i + c].read(cycle, raw_.texel[i] >> (8 * c) & 255);
}

// Stage 2.
void FilterPipeline::unpack(Cycle cycle) {
  ++occupancy[1];
  unpacked_.control = raw_.control;
  unpacked_.ticket = raw_.ticket;
  const auto each = [this](auto unpack_one) {
    for (std::size_t i = 0; i < 4; ++i) unpacked_.texel[i] = unpack_one(raw_.texel[i]);
  };
  switch (format_of(raw_)) {
    case spec::texture::Format::kRgba8:
      return each(unpack_rgba8);
    case spec::texture::Format::kRgb565:
      return each(unpack_rgb565);
    case spec::texture::Format::kRgba4444:
      return each(unpack_rgba4444);
    case spec::texture::Format::kL8:
      return each(unpack_l8);
    case spec::texture::Format::kSrgb8A8:
      if (!raw_.ticket.valid) return;  // its weight is 0
      for (std::size_t i = 0; i < 4; ++i) unpacked_.texel[i] = unpack_srgb(cycle, i);
  }
}

std::array<std::uint16_t, 4> FilterPipeline::unpack_srgb(Cycle cycle, std::size_t texel) const {
  const std::uint32_t raw = raw_.texel[texel];
  const auto linear = [&](std::size_t channel) {
    return linear_[3 * texel + channel].at(cycle, raw >> (8 * channel) & 255);
  };
  return {linear(0), linear(1), linear(2), unorm8(raw >> 24)};
}

// Stage 3: U8.4 x U1.8.
void FilterPipeline::multiply() {
  ++occupancy[2];
  products_.control = unpacked_.control;
  products_.ticket = unpacked_.ticket;
  const std::uint32_t right = unpacked_.control.fraction_u, left = 256 - right;
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t c = 0; c < 4; ++c)
      products_.texel[i][c] = unpacked_.texel[i][c] * (i & 1 ? right : left);
}

// Stage 4.
void FilterPipeline::add() {
  ++occupancy[3];
  sums_.control = products_.control;
  sums_.ticket = products_.ticket;
  for (std::size_t c = 0; c < 4; ++c) {
    sums_.upper[c] = products_.texel[0][c] + products_.texel[1][c];
    sums_.lower[c] = products_.texel[2][c] + products_.texel[3][c];
  }
}

// Stage 5: U8.20, rounded to U8.12.
void FilterPipeline::lerp_rows() {
  ++occupancy[4];
  row_.control = sums_.control;
  row_.ticket = sums_.ticket;
  const std::uint32_t lower = sums_.control.fraction_v, upper = 256 - lower;
  for (std::size_t c = 0; c < 4; ++c)
    row_.value[c] = (sums_.upper[c] * upper + sums_.lower[c] * lower + 128) >> 8;
}

// Stage 6: the levels of a sample in U8.20, rounded once to U8.12. True with the last of them.
bool FilterPipeline::lerp_levels() {
  ++occupancy[5];
  const std::uint32_t weight = row_.control.level_weight;
  for (std::size_t c = 0; c < 4; ++c) level_sum_[c] += row_.value[c] * weight;
  if (!row_.control.last_of_sample) return false;
  sample_.control = row_.control;
  sample_.ticket = row_.ticket;
  for (std::size_t c = 0; c < 4; ++c) sample_.value[c] = (level_sum_[c] + 128) >> 8;
  level_sum_ = {};
  return true;
}

// Stage 7: U15.12. True with the last sample of the fragment.
bool FilterPipeline::accumulate() {
  ++occupancy[6];
  const std::uint32_t weight = sample_.control.kernel_weight;
  for (std::size_t c = 0; c < 4; ++c) kernel_sum_[c] += sample_.value[c] * weight;
  if (!sample_.control.last_of_fragment) return false;
  total_ = {sample_.ticket, sample_.control.sum_log2, kernel_sum_};
  kernel_sum_ = {};
  return true;
}

// Stage 8: the sum of the weights is a power of two, so the division is a shift.
void FilterPipeline::deliver(Cycle cycle) {
  ++occupancy[7];
  const unsigned drop = 12u + total_.sum_log2;
  const std::uint32_t half = 1u << (drop - 1);
  spec::texture::Colour& colour = colours_out.emplace(cycle);
  colour.tag = total_.ticket.tag;
  colour.lane = total_.ticket.lane;
  colour.last = total_.ticket.last;
  for (std::size_t c = 0; c < 4; ++c)
    colour.rgba[c] = static_cast<std::uint8_t>((total_.value[c] + half) >> drop);
  ++fragments;
  fragment_latency.record(probe_.leaves(cycle + 1));
}

void FilterPipeline::reset() {
  occupied_ = 0;
  level_sum_ = {};
  kernel_sum_ = {};
}

}  // namespace deburr::rtl::texture
