// SPDX-License-Identifier: MIT
// Pictures of the geometric engine's intermediate results: weights and lines.
#pragma once

#include <span>
#include <string>

#include "spec/geometric/packets.h"
#include "spec/geometric/parameters.h"
#include "tb/engines/geometric/geometric_stimuli.h"
#include "tb/scene/image.h"
#include "tool/pages/run_context.h"

namespace deburr::tool {

// Adds a picture of the weights, under this name, and a picture of the classes.
void add_edge_pictures(RunContext& context, const tb::geometric::Frame& frame,
                       const spec::geometric::Parameters& parameters,
                       std::span<const spec::geometric::BlockRecord> blocks,
                       const std::string& weights = "weights");

// Blend weights, at double brightness: up or left red, down or right green; blue where the pair is
// left and right.
tb::Image weight_picture(int width, int height,
                         std::span<const spec::geometric::BlockRecord> blocks);

// The lines that this configuration draws, over the frame in grey: boundaries are yellow,
// silhouettes red, creases cyan, unclassified edges white. Lines are dark where the depth test
// fails.
tb::Image class_picture(const tb::geometric::Frame& frame,
                        const spec::geometric::Parameters& parameters);

}  // namespace deburr::tool
