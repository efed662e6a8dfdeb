// SPDX-License-Identifier: MIT
// Runs the shader published by the authors of SMAA: SMAA.hlsl in its GLSL mode, with the published
// vertex shaders and textures, on Mesa's llvmpipe.
//
// The first two passes run separately, so that weights can be computed from given edges. The edge
// target has bytes, as published; the weight target has floats, so that the target does not round.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "tb/oracle/mesa_context.h"
#include "tb/scene/image.h"

namespace deburr::tb {

// Per pixel: the edges at its left and above it, 255 or 0, as in the shader's target.
using SmaaEdgeImage = ImageOf<std::array<std::uint8_t, 2>>;
// Per pixel: weights of its top edge (second and first pixel), then of its left edge.
using SmaaWeightImage = ImageOf<std::array<float, 4>>;

// Options of a run. The defaults are as published.
struct SmaaShaderRun {
  std::string preset;   // of the shader: LOW, MEDIUM, HIGH or ULTRA
  bool colour = false;  // colour edges instead of luma edges
  // Replacements in the shader's text; each text must be found.
  std::vector<std::pair<std::string, std::string>> changes = {};
  int area_row = 0;      // one of the seven, by subsample offset
  bool repeats = false;  // the samplers of the second pass repeat instead of clamping
};

class SmaaShader {
 public:
  // Null if Mesa is absent; `why` then holds the reason.
  static std::unique_ptr<SmaaShader> open(std::string& why);
  ~SmaaShader();
  SmaaShader(const SmaaShader&) = delete;
  SmaaShader& operator=(const SmaaShader&) = delete;

  SmaaEdgeImage edges(const Image& image, const SmaaShaderRun& run);
  SmaaWeightImage weights(const SmaaEdgeImage& edges, const SmaaShaderRun& run);

  std::string name() const { return context_->name(); }

 private:
  SmaaShader() = default;
  std::unique_ptr<MesaContext> context_;
  std::string text_;
  std::vector<std::uint8_t> areas_, searches_;
};

}  // namespace deburr::tb
