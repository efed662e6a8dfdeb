// SPDX-License-Identifier: MIT
#include "rtl_model/morphological/front/luma_unit.h"

namespace deburr::rtl::morphological {

Activity LumaUnit::tick(Cycle cycle) {
  if (!slots_in.can_pop(cycle)) return kIdle;
  if (!lumas_out.can_push(cycle)) return kStalledDownstream;
  const SlotToken& token = slots_in.front(cycle);
  LumaToken& out = lumas_out.emplace(cycle);
  out.slot = token.slot;
  if (token.slot.row < store_.rules().height) {
    for (std::size_t i = 0; i < static_cast<std::size_t>(store_.lanes()); ++i) {
      const spec::morphological::Rgba8& p = token.pixel[i];
      out.luma[i] = spec::morphological::kLumaWeights[0] * p[0] +
                    spec::morphological::kLumaWeights[1] * p[1] +
                    spec::morphological::kLumaWeights[2] * p[2];
      out.depth[i] = token.depth[i];
    }
  }
  slots_in.pop(cycle);
  return kBusy;
}

}  // namespace deburr::rtl::morphological
