// SPDX-License-Identifier: MIT
// Pictures of a scene that no hardware made: the supersampled reference, plain and multi-sampled
// frames, and depth. Visibility is that of the rasteriser on an N times finer grid.
#pragma once

#include <array>
#include <cstdint>
#include <functional>

#include "tb/scene/image.h"
#include "tb/scene/scenes.h"

namespace deburr::tb {

enum class Shading : std::uint8_t {
  kTexture,  // the texture's colour alone, from level 0: what the texture unit should approach
  kLit,      // material x texture (trilinear, footprint of a whole pixel) x light, gamma 2.2
  kPhong     // the same surface with Phong's light at every sample: see GBuffer
};
enum class Sampling : std::uint8_t { kNearest, kBilinear };  // of level 0 in Shading::kTexture
enum class Averaging : std::uint8_t {
  kStored,  // as the texture unit filters stored bytes
  kLinear   // linear light: sRGB curve for kTexture, gamma 2.2 for kLit
};

struct RenderOptions {
  int width = 512, height = 512;  // pixels, 1..8192
  int samples = 1;                // N: N x N sub-samples at ((i + 1/2) / N, (j + 1/2) / N), 1..32
  Shading shading = Shading::kTexture;
  Sampling sampling = Sampling::kBilinear;
  Averaging averaging = Averaging::kStored;
  std::function<bool()> interrupted = nullptr;  // asked every few rows; true: render() throws
};

// The box-filtered picture: mean of N x N samples, rounded half up. samples = 1 is the frame
// without anti-aliasing. Throws ConfigError and Interrupted.
Image render(const Scene& scene, const RenderOptions& options);

// 4 x MSAA on the rotated grid (-2,-6) (6,-2) (-6,2) (2,6) sixteenths of a pixel: coverage and
// depth at each sample, colour once a triangle at the pixel centre, kLit or kPhong, averaged in
// linear light.
Image render_msaa4(const Scene& scene, int width, int height, Shading shading = Shading::kLit);

// The same with N x N samples on render()'s grid, 1..8: the frame with one sample, textures and
// all, of which edges alone are smoothed. Where a pixel shows one surface it is that frame's.
Image render_covered(const Scene& scene, int width, int height, int samples,
                     Shading shading = Shading::kLit);

// near/w at pixel centres, 0 = nothing there.
DepthImage render_depth(const Scene& scene, int width, int height);

// What deferred lighting starts from (paper 002, section 1.2), at pixel centres.
struct GBuffer {
  ImageOf<std::array<float, 3>> normal;  // unit length, turned to the eye; 0 where nothing is
  FloatImage albedo;                     // linear light
  DepthImage depth;                      // near/w, 0 = nothing there
};
GBuffer render_gbuffer(const Scene& scene, int width, int height);
// Phong's light on a G-buffer of the scene: both lights, ambient, specular. Equal to render() with
// kPhong and one sample.
Image light(const Scene& scene, const GBuffer& buffer);

// The set that morphological anti-aliasing is measured on, as data/README.md describes it.
struct LitFrames {
  Image noaa;       // one sample at the pixel centre
  Image reference;  // N x N samples, averaged in linear light
  DepthImage depth;
};
LitFrames render_lit_frames(const Scene& scene, int width, int height, int samples,
                            const std::function<bool()>& interrupted = nullptr,
                            Shading shading = Shading::kLit);

}  // namespace deburr::tb
