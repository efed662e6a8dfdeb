// SPDX-License-Identifier: MIT
// The frames that learned shares are trained and measured on: scenes and shapes of the project's
// own, and the meshes of a data folder if there is one.
//
// `track` and seventeen of the meshes are never trained on
// (docs/measurements/morphological_quality.md, "Learned shares").
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "tb/training/share_samples.h"

namespace deburr::tb::training {

struct FrameOptions {
  std::filesystem::path data;   // of meshes, kenney and frames; empty: none
  std::filesystem::path cache;  // rendered frames are kept there; empty: nowhere
  int samples = 8;              // of a pixel's truth, each way
  int size = 512;               // pixels a side of the rendered ones
  int shapes = 6;               // frames of plain shapes
  int overlays = 0;             // of the first frames once more, with text
  int views = 5;                // of each mesh to be trained on
  std::function<void(const std::string&)> progress = {};
};

std::vector<TruthFrame> own_frames(const FrameOptions& options);
std::vector<TruthFrame> mesh_frames(const FrameOptions& options);
// Not to be trained on: of the project's own scenes, then `track` and meshes of the data folder.
std::vector<TruthFrame> held_out_frames(const FrameOptions& options);

// Discs, bars and triangles of flat colours at random.
TruthFrame shapes_frame(int width, int height, int samples, std::uint64_t seed);

// The frame with lines of text over all of it, the same in its truth, and where the text is.
struct Overlaid {
  TruthFrame frame;
  Mask ink;
};
Overlaid overlaid(const TruthFrame& frame);

}  // namespace deburr::tb::training
