// SPDX-License-Identifier: MIT
// The shader that the authors of SMAA publish, run: SMAA.hlsl in its GLSL mode, with the vertex
// shaders and the textures that come with it, on Mesa's llvmpipe.
//
// Its first two passes, each by itself, so that weights can be made from edges of someone else.
// Edges are a target of bytes as published; weights one of floats, so that no rounding of a target
// lies between.
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

// Of a pixel: an edge at its left and one above it, 255 or 0, as in the shader's target.
using SmaaEdgeImage = ImageOf<std::array<std::uint8_t, 2>>;
// Of a pixel: weights of its top edge, second and first pixel, and of its left edge.
using SmaaWeightImage = ImageOf<std::array<float, 4>>;

// What is run. The default is as published.
struct SmaaShaderRun {
  std::string preset;   // of the shader: LOW, MEDIUM, HIGH or ULTRA
  bool colour = false;  // edges of colour, not of luma
  // Words of the shader and what stands in their place; each must be there.
  std::vector<std::pair<std::string, std::string>> changes = {};
  int area_row = 0;      // of the seven, by subsample offset
  bool repeats = false;  // the samplers of the second pass repeat instead of clamping
};

class SmaaShader {
 public:
  // Null where Mesa is absent; `why` then says what.
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
