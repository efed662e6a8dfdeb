// SPDX-License-Identifier: MIT
#include "tool/engines/morphological/morphological_pictures.h"

#include <cstddef>
#include <cstdint>

namespace deburr::tool {

void add_smoothing_pictures(RunContext& context, const SmoothedFrame& frame,
                            const std::vector<spec::morphological::BlendProbe>& probes) {
  add_frame_pictures(context, frame);
  std::vector<Weights> weights;
  weights.reserve(probes.size());
  for (const spec::morphological::BlendProbe& probe : probes)
    weights.push_back({probe.first, probe.second, probe.horizontal});
  context.add_image("edges", edge_picture(frame.before, probes), "Edges",
                    "left edges red, top edges green");
  context.add_image("weights", weights_picture(frame.after.width, frame.after.height, weights),
                    "Weights",
                    "weight of the upper or left neighbour red, of the lower or right one green, "
                    "blue where the two are left and right");
}

tb::Image edge_picture(const tb::Image& frame,
                       const std::vector<spec::morphological::BlendProbe>& probes) {
  constexpr int kDim = 3;
  tb::Image picture(frame.width, frame.height);
  for (std::size_t i = 0; i < probes.size(); ++i) {
    const tb::Rgba8& p = frame.pixels[i];
    const auto grey = static_cast<std::uint8_t>((p[0] + 2 * p[1] + p[2]) / 4 / kDim);
    picture.pixels[i] = {probes[i].edges & 1 ? std::uint8_t{255} : grey,
                         probes[i].edges & 2 ? std::uint8_t{255} : grey, grey, 255};
  }
  return picture;
}

}  // namespace deburr::tool
