// SPDX-License-Identifier: MIT
// The frames that learned weights are trained and measured on. All that the ROMs are trained on is
// made by formula: scenes and shapes of the project's own. Meshes of a data folder are measured,
// and trained on in experiments alone.
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
  std::filesystem::path data = {};   // of meshes, kenney and frames; empty: none
  std::filesystem::path cache = {};  // rendered frames are kept there; empty: nowhere
  int samples = 8;                   // of a pixel's reference, each way
  int size = 512;                    // pixels a side of the rendered ones
};

// A frame that is not made yet.
struct FrameSource {
  std::string name;   // unique
  std::string group;  // frames of one mesh or scene
  std::function<ReferenceFrame()> make;
  std::function<tb::Mesh()> mesh = nullptr;  // what is seen; null: no mesh, or not known
};

// What the ROMs are trained on (studies/training/recipe.txt).
std::vector<FrameSource> training_set(const FrameOptions& options);
// Not to be trained on: by formula, then `track` and meshes of the data folder if one is named.
std::vector<FrameSource> held_out_set(const FrameOptions& options);
// Five views of each of nineteen meshes of the data folder.
std::vector<FrameSource> mesh_set(const FrameOptions& options);

// Discs, bars and triangles of flat colours at random.
ReferenceFrame shapes_frame(int width, int height, int samples, std::uint64_t seed);

// The frame with lines of text over all of it, the same in its reference, and where the text is.
struct Overlaid {
  ReferenceFrame frame;
  tb::Mask ink;
};
Overlaid overlaid(const ReferenceFrame& frame);

}  // namespace deburr::studies::training
