// SPDX-License-Identifier: MIT
// Frames for the geometric engine: a lit scene with its edges, depths and facing bits; and a
// measure of how well an anti-aliased frame matches the supersampled reference.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "golden/geometric/geometric_golden.h"
#include "tb/engines/geometric/edge_table.h"
#include "tb/scene/image.h"
#include "tb/scene/quality.h"
#include "tb/scene/reference.h"
#include "tb/scene/scenes.h"

namespace deburr::tb::geometric {

// Memory contents for the engine, made from a scene. Owns the data that the golden model's input
// refers to.
struct Frame {
  Image image;  // Phong lighting of the G-buffer
  DepthImage depth;
  std::vector<std::uint32_t> depths;  // U24
  EdgeTable table;
  ScreenEdges screen;
  golden::geometric::FrameInput input(const golden::geometric::Bases& bases = {}) const;
};
Frame make_frame(const Scene& scene, int width, int height, const EdgeTableOptions& options = {});

// A frame and its reference.
struct Checker {
  Frame frame;
  Image reference, msaa;
  Mask edges, silhouettes;
  Checker(const Scene& scene, int width, int height, int samples,
          const std::function<bool()>& interrupted = nullptr, const EdgeTableOptions& options = {});
  double edge_rmse(const Image& image) const;  // in codes, over edge pixels
  double silhouette_rmse(const Image& image) const;
  double edge_psnr(const Image& image) const;  // dB
  double silhouette_psnr(const Image& image) const;
};

// Output and work counts of the golden model with this configuration.
struct Smoothed {
  Image image;
  spec::geometric::Work work;
};
Smoothed smoothed(const Frame& frame, const spec::geometric::Parameters& parameters);

}  // namespace deburr::tb::geometric
