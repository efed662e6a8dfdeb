// SPDX-License-Identifier: MIT
#include "rtl_model/morphological/front/luma_unit.h"

namespace deburr::rtl::morphological {

Activity LumaUnit::tick(Cycle cycle) {
  const bool arrives = slots_in.can_pop(cycle);
  if (pipe_.empty() && !arrives) return kIdle;
  if (pipe_.leaves() && !lumas_out.can_push(cycle)) return kStalledDownstream;
  pipe_.move();
  if (const LumaToken* sum = pipe_.at(2)) lumas_out.push(cycle, *sum);
  if (!arrives) return kBusy;
  const SlotToken& token = slots_in.take(cycle);
  LumaToken& out = pipe_.enter();
  out.slot = token.slot;
  const FrameConfiguration& configuration = configuration_in.read(cycle);
  if (token.slot.row < configuration.height) {
    const bool colour = configuration.source == spec::morphological::EdgeSource::kColour;
    const bool masked = configuration.bypass == spec::morphological::Bypass::kMasked;
    for (std::size_t i = 0; i < lanes_; ++i) {
      const spec::morphological::Rgba8& p = token.pixel[i];
      out.luma[i] = colour ? p[0] | std::uint32_t{p[1]} << 8 | std::uint32_t{p[2]} << 16
                           : spec::morphological::kLumaWeights[0] * p[0] +
                                 spec::morphological::kLumaWeights[1] * p[1] +
                                 spec::morphological::kLumaWeights[2] * p[2];
      if (masked && (p[3] & 1) == 0) out.luma[i] |= kMarkedLuma;
      out.depth[i] = token.depth[i];
    }
  }
  return kBusy;
}

Datasheet LumaUnit::datasheet(const spec::morphological::Parameters& p) {
  constexpr std::uint32_t kProducts = 22 + 24 + 21, kMark = 1;
  return {.unit = "LumaUnit",
          .does = "Luma of each pixel, or its three codes unchanged.",
          .latency = {2},
          // Weights of 7, 7 and 4 signed digits. The codes, shifted, take the bits of the products.
          .stages = {{.clock = "1",
                      .work = "three products, or the three codes unchanged",
                      .operators = {2 * op::multiply_constant(8, 6), op::multiply_constant(8, 3),
                                    op::mux(kProducts, 2)},
                      .longest = {op::multiply_constant(8, 6), op::mux(24, 2)},
                      .registers = kProducts + kMark + (has_depth(p) ? 24u : 0u)},
                     {.clock = "2",
                      .work = "sum",
                      .operators = {2 * op::add(24)},
                      .longest = {2 * op::add(24)}}},
          .formats = "U8.16 luma, or three U0.8 codes.",
          .copies = lane_copies(p),
          .per = "lane",
          .shared_registers = kPayloadBits<Slot> + 1,
          .megahertz = 300};
}

}  // namespace deburr::rtl::morphological
