// SPDX-License-Identifier: MIT
#include "rtl_model/texture/filter_pipeline.h"

#include "spec/texture/descriptor.h"
#include "spec/texture/packets.h"
#include "spec/texture/tables.h"

namespace deburr::rtl::texture {
namespace {

using Texel = std::array<std::uint16_t, 4>;  // U8.4 each

constexpr unsigned bit_after(int stage) { return 1u << (stage - 1); }

// Channels are widened to eight bits by repeating their high bits: wires.
constexpr std::uint16_t unorm8(std::uint32_t v) {
  return static_cast<std::uint16_t>((v & 255) << 4);
}
constexpr std::uint16_t unorm6(std::uint32_t v) { return unorm8((v & 63) << 2 | (v & 63) >> 4); }
constexpr std::uint16_t unorm5(std::uint32_t v) { return unorm8((v & 31) << 3 | (v & 31) >> 2); }
constexpr std::uint16_t unorm4(std::uint32_t v) { return unorm8((v & 15) << 4 | (v & 15)); }
constexpr std::uint16_t kOpaque = unorm8(255);

Texel unpack_texel(spec::texture::Format format, std::uint32_t raw) {
  switch (format) {
    case spec::texture::Format::kRgba8:
      return {unorm8(raw), unorm8(raw >> 8), unorm8(raw >> 16), unorm8(raw >> 24)};
    case spec::texture::Format::kRgb565:
      return {unorm5(raw >> 11), unorm6(raw >> 5), unorm5(raw), kOpaque};
    case spec::texture::Format::kRgba4444:
      return {unorm4(raw >> 12), unorm4(raw >> 8), unorm4(raw >> 4), unorm4(raw)};
    case spec::texture::Format::kL8:
      return {unorm8(raw), unorm8(raw), unorm8(raw), kOpaque};
    case spec::texture::Format::kSrgb8A8:
      return {spec::texture::kSrgbToLinear[raw & 255], spec::texture::kSrgbToLinear[raw >> 8 & 255],
              spec::texture::kSrgbToLinear[raw >> 16 & 255], unorm8(raw >> 24)};
  }
  return {};
}

}  // namespace

FilterPipeline::FilterPipeline(const sc_core::sc_module_name& name, ClockDomain& clock,
                               FragmentProbe& probe)
    : Unit(name, clock),
      occupancy{Counter{"stage_1", "clk", "clocks in which stage 1, unpack, had a request"},
                Counter{"stage_2", "clk", "clocks in which stage 2, products, had a request"},
                Counter{"stage_3", "clk", "clocks in which stage 3, sums, had a request"},
                Counter{"stage_4", "clk", "clocks in which stage 4, vertical lerp, had a request"},
                Counter{"stage_5", "clk", "clocks in which stage 5, level lerp, had a request"},
                Counter{"stage_6", "clk", "clocks in which stage 6, accumulate, had a sample"},
                Counter{"stage_7", "clk", "clocks in which stage 7, pack, had a fragment"}},
      probe_(probe) {}

// From the last stage to the first, so that each reads its predecessor's registers of the last
// clock.
Activity FilterPipeline::tick(Cycle cycle) {
  const unsigned before = occupied_;
  const bool arrives = texels_in.can_pop(cycle);
  if (before == 0 && !arrives) return kIdle;
  if ((before & bit_after(6)) && !colours_out.can_push(cycle)) {
    if (arrives) ++occupancy[0];
    for (std::size_t stage = 1; stage < kStages; ++stage)
      if (before >> (stage - 1) & 1) ++occupancy[stage];
    return kStalledDownstream;
  }
  unsigned after = 0;
  if (before & bit_after(6)) deliver(cycle);
  if (before & bit_after(5) && accumulate()) after |= bit_after(6);
  if (before & bit_after(4) && lerp_levels()) after |= bit_after(5);
  if (before & bit_after(3)) lerp_rows(), after |= bit_after(4);
  if (before & bit_after(2)) add(), after |= bit_after(3);
  if (before & bit_after(1)) multiply(), after |= bit_after(2);
  if (arrives) {
    unpack(texels_in.front(cycle));
    texels_in.pop(cycle);
    after |= bit_after(1);
  }
  occupied_ = after;
  return kBusy;
}

// Stage 1.
void FilterPipeline::unpack(const TexelQuadToken& token) {
  ++occupancy[0];
  unpacked_.control = token.control;
  unpacked_.ticket = token.ticket;
  const auto format = static_cast<spec::texture::Format>(token.control.format);
  for (std::size_t i = 0; i < 4; ++i) unpacked_.texel[i] = unpack_texel(format, token.texel[i]);
}

// Stage 2: U8.4 x U1.8.
void FilterPipeline::multiply() {
  ++occupancy[1];
  products_.control = unpacked_.control;
  products_.ticket = unpacked_.ticket;
  const std::uint32_t right = unpacked_.control.fraction_u, left = 256 - right;
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t c = 0; c < 4; ++c)
      products_.texel[i][c] = unpacked_.texel[i][c] * (i & 1 ? right : left);
}

// Stage 3.
void FilterPipeline::add() {
  ++occupancy[2];
  sums_.control = products_.control;
  sums_.ticket = products_.ticket;
  for (std::size_t c = 0; c < 4; ++c) {
    sums_.upper[c] = products_.texel[0][c] + products_.texel[1][c];
    sums_.lower[c] = products_.texel[2][c] + products_.texel[3][c];
  }
}

// Stage 4: U8.20, rounded to U8.12.
void FilterPipeline::lerp_rows() {
  ++occupancy[3];
  row_.control = sums_.control;
  row_.ticket = sums_.ticket;
  const std::uint32_t lower = sums_.control.fraction_v, upper = 256 - lower;
  for (std::size_t c = 0; c < 4; ++c)
    row_.value[c] = (sums_.upper[c] * upper + sums_.lower[c] * lower + 128) >> 8;
}

// Stage 5: the levels of a sample in U8.20, rounded once to U8.12. True with the last of them.
bool FilterPipeline::lerp_levels() {
  ++occupancy[4];
  const std::uint32_t weight = row_.control.level_weight;
  for (std::size_t c = 0; c < 4; ++c) level_sum_[c] += row_.value[c] * weight;
  if (!row_.control.last_of_sample) return false;
  sample_.control = row_.control;
  sample_.ticket = row_.ticket;
  for (std::size_t c = 0; c < 4; ++c) sample_.value[c] = (level_sum_[c] + 128) >> 8;
  level_sum_ = {};
  return true;
}

// Stage 6: U15.12. True with the last sample of the fragment.
bool FilterPipeline::accumulate() {
  ++occupancy[5];
  const std::uint32_t weight = sample_.control.kernel_weight;
  for (std::size_t c = 0; c < 4; ++c) kernel_sum_[c] += sample_.value[c] * weight;
  if (!sample_.control.last_of_fragment) return false;
  total_ = {sample_.ticket, sample_.control.sum_log2, kernel_sum_};
  kernel_sum_ = {};
  return true;
}

// Stage 7: the sum of the weights is a power of two, so the division is a shift.
void FilterPipeline::deliver(Cycle cycle) {
  ++occupancy[6];
  const unsigned drop = 12u + total_.sum_log2;
  const std::uint32_t half = 1u << (drop - 1);
  spec::texture::Colour& colour = colours_out.emplace(cycle);
  colour.tag = total_.ticket.tag;
  colour.lane = total_.ticket.lane;
  colour.last = total_.ticket.last;
  for (std::size_t c = 0; c < 4; ++c)
    colour.rgba[c] = static_cast<std::uint8_t>((total_.value[c] + half) >> drop);
  ++fragments;
  fragment_latency.record(probe_.left(cycle + 1));
}

void FilterPipeline::reset() {
  occupied_ = 0;
  level_sum_ = {};
  kernel_sum_ = {};
}

}  // namespace deburr::rtl::texture
