// SPDX-License-Identifier: MIT
#include "rtl_model/texture/filter_pipeline.h"

#include <string>

#include "spec/texture/descriptor.h"
#include "spec/texture/packets.h"
#include "spec/texture/tables.h"

namespace deburr::rtl::texture {
namespace {

constexpr std::uint32_t kCodedChannels = 4 * 3;

spec::texture::Format format_of(const TexelQuadToken& token) {
  return static_cast<spec::texture::Format>(token.control.format);
}

// Channels are widened to eight bits by repeating their high bits: wires. U8.4.
constexpr std::uint32_t unorm8(std::uint32_t v) { return (v & 255) << 4; }
constexpr std::uint32_t unorm6(std::uint32_t v) { return unorm8((v & 63) << 2 | (v & 63) >> 4); }
constexpr std::uint32_t unorm5(std::uint32_t v) { return unorm8((v & 31) << 3 | (v & 31) >> 2); }
constexpr std::uint32_t unorm4(std::uint32_t v) { return unorm8((v & 15) << 4 | (v & 15)); }
constexpr std::uint32_t kOpaque = unorm8(255);

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
  const bool arrives = texels_in.can_pop(cycle);
  if (requests_.empty() && !has_sample_ && !has_total_ && !arrives) return kIdle;
  count_stages(arrives);
  if (has_total_ && !colours_out.can_push(cycle)) return kStalledDownstream;
  if (has_total_) deliver(cycle);
  if (has_sample_) accumulate();
  requests_.move();
  if (const Request* request = requests_.at(6)) lerp_levels(*request);
  if (Request* request = requests_.at(2)) filter(cycle, *request);
  if (arrives) {
    Request& request = requests_.enter();
    request.token = texels_in.front(cycle);
    texels_in.pop(cycle);
    look_up(cycle, request.token);
  }
  return kBusy;
}

// What each stage has before it in this clock.
inline void FilterPipeline::count_stages(bool arrives) {
  occupancy[6] += has_sample_;
  occupancy[7] += has_total_;
  if (arrives && requests_.full()) [[likely]] {
    for (std::size_t i = 0; i < kRequestStages; ++i) ++occupancy[i];
    return;
  }
  occupancy[0] += arrives;
  for (std::size_t stage = 2; stage <= kRequestStages; ++stage)
    occupancy[stage - 1] += requests_.at(stage - 1) != nullptr;
}

// Stage 1: the coded channels go into the ROM.
inline void FilterPipeline::look_up(Cycle cycle, const TexelQuadToken& token) {
  if (!token.ticket.valid || format_of(token) != spec::texture::Format::kSrgb8A8) return;
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t c = 0; c < 3; ++c)
      linear_[3 * i + c].read(cycle, token.texel[i] >> (8 * c) & 255);
}

// Stages 3 to 5: what is between them cannot be seen from outside.
template <class Unpack>
inline void FilterPipeline::lerp(Request& request, Unpack&& unpack) {
  const FilterControl& control = request.token.control;
  // Stages 3 and 4: U8.4 x U1.8.
  const std::uint32_t right = control.fraction_u, left = 256 - right;
  const Channels upper = unpack(0) * left + unpack(1) * right,
                 lower = unpack(2) * left + unpack(3) * right;
  // Stage 5: U8.20, rounded to U8.12.
  const std::uint32_t down = control.fraction_v, up = 256 - down;
  request.row = (upper * up + lower * down).rounded(8);
}

// Stages 2 to 5.
inline void FilterPipeline::filter(Cycle cycle, Request& request) const {
  const TexelQuadToken& token = request.token;
  if (format_of(token) != spec::texture::Format::kRgba8) return filter_other(cycle, request);
  lerp(request, [&](std::size_t i) { return Channels::of_bytes(token.texel[i]); });
}

void FilterPipeline::filter_other(Cycle cycle, Request& request) const {
  const TexelQuadToken& token = request.token;
  const auto lerp_each = [&](auto&& unpack_one) {
    lerp(request, [&](std::size_t i) { return unpack_one(token.texel[i]); });
  };
  switch (format_of(token)) {
    case spec::texture::Format::kRgba8:
      return;
    case spec::texture::Format::kRgb565:
      return lerp_each([](std::uint32_t raw) {
        return Channels::of(unorm5(raw >> 11), unorm6(raw >> 5), unorm5(raw), kOpaque);
      });
    case spec::texture::Format::kRgba4444:
      return lerp_each([](std::uint32_t raw) {
        return Channels::of(unorm4(raw >> 12), unorm4(raw >> 8), unorm4(raw >> 4), unorm4(raw));
      });
    case spec::texture::Format::kL8:
      return lerp_each([](std::uint32_t raw) {
        return Channels::of(unorm8(raw), unorm8(raw), unorm8(raw), kOpaque);
      });
    case spec::texture::Format::kSrgb8A8:
      if (!token.ticket.valid) return;  // its weight is 0
      return lerp(request, [&](std::size_t i) { return unpack_srgb(cycle, token, i); });
  }
}

FilterPipeline::Channels FilterPipeline::unpack_srgb(Cycle cycle, const TexelQuadToken& token,
                                                     std::size_t texel) const {
  const std::uint32_t raw = token.texel[texel];
  const auto linear = [&](std::size_t channel) {
    return linear_[3 * texel + channel].at(cycle, raw >> (8 * channel) & 255);
  };
  return Channels::of(linear(0), linear(1), linear(2), unorm8(raw >> 24));
}

// Stage 6: the levels of a sample in U8.20, rounded once to U8.12; on with the last of them.
void FilterPipeline::lerp_levels(const Request& request) {
  const FilterControl& control = request.token.control;
  level_sum_ = level_sum_ + request.row * control.level_weight;
  if (!control.last_of_sample) return;
  sample_ = {request.token.ticket, control.kernel_weight, control.sum_log2,
             control.last_of_fragment, level_sum_.rounded(8)};
  has_sample_ = true;
  level_sum_ = {};
}

// Stage 7: U15.12; on with the last sample of the fragment.
void FilterPipeline::accumulate() {
  has_sample_ = false;
  kernel_sum_ = kernel_sum_ + sample_.value * sample_.kernel_weight;
  if (!sample_.last_of_fragment) return;
  total_ = {sample_.ticket, sample_.sum_log2, kernel_sum_};
  has_total_ = true;
  kernel_sum_ = {};
}

// Stage 8: the sum of the weights is a power of two, so the division is a shift.
inline void FilterPipeline::deliver(Cycle cycle) {
  has_total_ = false;
  spec::texture::Colour& colour = colours_out.emplace(cycle);
  colour.tag = total_.ticket.tag;
  colour.lane = total_.ticket.lane;
  colour.last = total_.ticket.last;
  const auto value = total_.value.rounded(12U + total_.sum_log2).each();
  for (std::size_t c = 0; c < 4; ++c) colour.rgba[c] = static_cast<std::uint8_t>(value[c]);
  ++fragments;
  fragment_latency.record(probe_.leaves(cycle + 1));
}

void FilterPipeline::reset() {
  requests_.reset();
  level_sum_ = {};
  has_sample_ = false;
  kernel_sum_ = {};
  has_total_ = false;
}

}  // namespace deburr::rtl::texture
