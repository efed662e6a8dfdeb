// SPDX-License-Identifier: MIT
// Pictures of what the geometric engine did besides the frame: weights and lines.
#pragma once

#include <span>
#include <string>

#include "spec/geometric/packets.h"
#include "spec/geometric/parameters.h"
#include "tb/engines/geometric/geometric_stimuli.h"
#include "tb/scene/image.h"
#include "tool/pages/run_context.h"

namespace deburr::tool {

// Weights, under this name, and classes.
void add_edge_pictures(RunContext& context, const tb::geometric::Frame& frame,
                       const spec::geometric::Parameters& parameters,
                       std::span<const spec::geometric::BlockRecord> blocks,
                       const std::string& weights = "weights");

// Weights of neighbours, twice as bright: up or left red, down or right green; blue where the pair
// is left and right.
tb::Image weight_picture(int width, int height,
                         std::span<const spec::geometric::BlockRecord> blocks);

// The lines that are drawn by these rules over the frame in grey: boundaries yellow, silhouettes
// red, creases cyan, edges that are not classified white; dark where the depth test fails.
tb::Image class_picture(const tb::geometric::Frame& frame,
                        const spec::geometric::Parameters& parameters);

}  // namespace deburr::tool
