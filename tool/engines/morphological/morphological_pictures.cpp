// SPDX-License-Identifier: MIT
#include "tool/engines/morphological/morphological_pictures.h"

#include <cstddef>
#include <cstdint>

namespace deburr::tool {

void add_smoothing_pictures(RunContext& context, const SmoothedFrame& frame,
                            const std::vector<spec::morphological::BlendTap>& taps) {
  add_frame_pictures(context, frame);
  std::vector<Shares> shares;
  shares.reserve(taps.size());
  for (const spec::morphological::BlendTap& tap : taps)
    shares.push_back({tap.first, tap.second, tap.horizontal});
  context.add_image("edges", edge_picture(frame.before, taps), "Edges",
                    "left edges red, top edges green");
  context.add_image("weights", shares_picture(frame.after.width, frame.after.height, shares),
                    "Weights",
                    "share of the upper or left neighbour red, of the lower or right one green, "
                    "blue where the two are left and right");
}

tb::Image edge_picture(const tb::Image& frame,
                       const std::vector<spec::morphological::BlendTap>& taps) {
  constexpr int kDim = 3;
  tb::Image picture(frame.width, frame.height);
  for (std::size_t i = 0; i < taps.size(); ++i) {
    const tb::Rgba8& p = frame.pixels[i];
    const auto grey = static_cast<std::uint8_t>((p[0] + 2 * p[1] + p[2]) / 4 / kDim);
    picture.pixels[i] = {taps[i].edges & 1 ? std::uint8_t{255} : grey,
                         taps[i].edges & 2 ? std::uint8_t{255} : grey, grey, 255};
  }
  return picture;
}

}  // namespace deburr::tool
