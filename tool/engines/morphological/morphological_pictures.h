// SPDX-License-Identifier: MIT
// Pictures of the morphological engine's intermediate results: edges and weights.
#pragma once

#include <vector>

#include "spec/morphological/packets.h"
#include "tb/scene/image.h"
#include "tool/pages/run_context.h"
#include "tool/run/pictures.h"

namespace deburr::tool {

// add_frame_pictures(), plus edges and weights.
void add_smoothing_pictures(RunContext& context, const SmoothedFrame& frame,
                            const std::vector<spec::morphological::BlendProbe>& probes);

// Left edges red, top edges green, over the frame in grey.
tb::Image edge_picture(const tb::Image& frame,
                       const std::vector<spec::morphological::BlendProbe>& probes);

}  // namespace deburr::tool
