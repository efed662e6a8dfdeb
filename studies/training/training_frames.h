// SPDX-License-Identifier: MIT
// The frames that learned weights are trained and measured on. The ROMs are trained only on
// procedural scenes and shapes of the project. Meshes of a data folder are measured, and trained on
// only in experiments.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "studies/training/weight_samples.h"
#include "tb/scene/scenes.h"

namespace deburr::studies::training {

struct FrameOptions {
  std::filesystem::path data = {};   // with meshes, kenney and frames; empty: none
  std::filesystem::path cache = {};  // cache of rendered frames; empty: none
  int samples = 8;                   // per pixel of the reference, in each direction
  int size = 512;                    // side in pixels of rendered frames
};

// A frame that is rendered or loaded on demand.
struct FrameSource {
  std::string name;   // unique
  std::string group;  // frames of one mesh or scene
  std::function<ReferenceFrame()> make;
  std::function<tb::Mesh()> mesh = nullptr;  // the visible mesh; null: none, or unknown
};

// The training set of the ROMs (studies/training/recipe.txt).
std::vector<FrameSource> training_set(const FrameOptions& options);
// Held-out frames: procedural ones, then `track` and meshes of the data folder if given.
std::vector<FrameSource> held_out_set(const FrameOptions& options);
// Five views of each of nineteen meshes of the data folder.
std::vector<FrameSource> mesh_set(const FrameOptions& options);

// Random discs, bars and triangles in flat colours.
ReferenceFrame shapes_frame(int width, int height, int samples, std::uint64_t seed);

// The frame and its reference with lines of text over them, and where the text is.
struct Overlaid {
  ReferenceFrame frame;
  tb::Mask ink;
};
Overlaid overlaid(const ReferenceFrame& frame);

}  // namespace deburr::studies::training
