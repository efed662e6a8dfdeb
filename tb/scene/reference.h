// SPDX-License-Identifier: MIT
// Software renderer for supersampled references, for plain and multi-sampled frames, and for depth.
// It finds visible surfaces like the rasteriser, but on an N times finer grid.
#pragma once

#include <array>
#include <cstdint>
#include <functional>

#include "tb/scene/image.h"
#include "tb/scene/scenes.h"

namespace deburr::tb {

enum class Shading : std::uint8_t {
  kTexture,  // texture colour only, from level 0: the ideal for the texture unit
  kLit,      // material x texture (trilinear, footprint of a whole pixel) x light, gamma 2.2
  kPhong     // as kLit with Phong's light at every sample: see GBuffer
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
  std::function<bool()> interrupted = nullptr;  // polled every few rows; true: render() throws
};

// The box-filtered picture: the mean of N x N samples, rounded half up. With samples = 1 this is
// the frame without anti-aliasing. Throws ConfigError and Interrupted.
Image render(const Scene& scene, const RenderOptions& options);

// 4x MSAA on the rotated grid (-2,-6) (6,-2) (-6,2) (2,6) sixteenths of a pixel: coverage and depth
// per sample, one colour per triangle at the pixel centre (kLit, kPhong), averaged in linear light.
Image render_msaa4(const Scene& scene, int width, int height, Shading shading = Shading::kLit);

// MSAA with N x N samples, N = 1..8, on the grid of render(). The result is the textured frame with
// one sample per pixel, but with smooth edges. A pixel that shows only one surface is as in that
// frame.
Image render_covered(const Scene& scene, int width, int height, int samples,
                     Shading shading = Shading::kLit);

// near/w at pixel centres, 0 for background.
DepthImage render_depth(const Scene& scene, int width, int height);

// Input of deferred lighting (paper 002, section 1.2), at pixel centres.
struct GBuffer {
  ImageOf<std::array<float, 3>> normal;  // unit length, facing the eye; 0 for background
  FloatImage albedo;                     // linear light
  DepthImage depth;                      // near/w, 0 for background
};
GBuffer render_gbuffer(const Scene& scene, int width, int height);
// Phong lighting of a G-buffer: both lights, ambient, specular. The result equals that of render()
// with kPhong and one sample.
Image light(const Scene& scene, const GBuffer& buffer);

// The frames used to evaluate morphological anti-aliasing, described in data/README.md.
struct LitFrames {
  Image noaa;       // one sample at the pixel centre
  Image reference;  // N x N samples, averaged in linear light
  DepthImage depth;
};
LitFrames render_lit_frames(const Scene& scene, int width, int height, int samples,
                            const std::function<bool()>& interrupted = nullptr,
                            Shading shading = Shading::kLit);

}  // namespace deburr::tb
