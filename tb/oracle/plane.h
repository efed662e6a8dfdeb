// SPDX-License-Identifier: MIT
// A textured ground plane in perspective, as texture coordinates per pixel: the scene for comparing
// anisotropic filtering and other programs' filters.
#pragma once

#include <cstdint>
#include <vector>

#include "golden/ideal/filtering_criterion.h"
#include "spec/texture/packets.h"
#include "tb/oracle/conformance.h"

namespace deburr::tb::texture {

std::int32_t fixed(double coordinate);  // rounds to S7.24

// Texture coordinates S7.24 at the centres of width x height pixels, both even; row 0 is farthest.
struct CoordinateImage {
  int width = 0, height = 0;
  std::vector<std::int32_t> s, t;  // row-major

  spec::texture::Quad quad(int x, int y) const;  // of pixels (x, y) .. (x + 1, y + 1), x and y even
};

struct PlaneView {
  int width = 128, height = 96;
  double repeats = 1.0;     // times the texture repeats across the nearest row
  double horizon = 6.0;     // rows between row 0 and the horizon
  double turn = 0.35;       // rotation of the plane about its normal, radians
  double s = 0.0, t = 0.0;  // shift of the texture

  // Coordinates at a point of the image, in pixels.
  void coordinates(double x, double y, double& s_out, double& t_out) const;
};
CoordinateImage plane(const PlaneView& view);

// Unrelated quads, 32 per row; their number is a multiple of 32.
CoordinateImage quads_image(const std::vector<spec::texture::Quad>& quads);

using Pixels = std::vector<std::array<std::uint8_t, 4>>;  // row-major
Pixels filter_image(const CoordinateImage& image, const QuadFilter& filter);

// Reference image of the plane: each pixel averages n x n bilinear samples of level 0.
std::vector<golden::ideal::Rgba> plane_reference(const PlaneView& view,
                                                 const golden::ideal::Texture& texture, int n);
// Root mean square difference over R, G and B, 8-bit steps.
double rms(const Pixels& pixels, const std::vector<golden::ideal::Rgba>& reference);

}  // namespace deburr::tb::texture
