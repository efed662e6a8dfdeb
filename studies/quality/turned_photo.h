// SPDX-License-Identifier: MIT
// A photograph on a surface at a shallow angle, seen by a camera that is rotated about its own
// axis: every pixel has the same footprint, ratio : 1 texels. Measures anisotropic filtering in
// every direction, which an upright camera does not show.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "golden/ideal/footprint.h"
#include "golden/ideal/texture_image.h"
#include "golden/texture/texture_golden.h"
#include "rtl_model/platform/texture_memory.h"
#include "spec/texture/packets.h"
#include "spec/texture/parameters.h"
#include "tb/scene/image.h"

namespace deburr::studies {

// A photograph with its mip levels, for the unit and for the ideal filters.
class PhotoTexture {
 public:
  explicit PhotoTexture(tb::Image image);
  const tb::Image& image() const { return image_; }
  const golden::ideal::TextureImage& ideal() const { return ideal_; }
  std::span<const std::uint8_t> memory() const { return memory_.bytes(); }
  spec::texture::Descriptor descriptor(int lb_n_max) const;

 private:
  tb::Image image_;
  golden::ideal::TextureImage ideal_;
  platform::TextureMemory memory_;
};

struct Turn {
  double degrees = 0;  // of the camera
  double ratio = 6;    // length of the footprint in texels
  double width = 1;    // footprint width in texels
  int size = 96;       // pixels per side, even
};

struct FilterFigures {
  double psnr = 0;  // dB against the supersampled parallelogram, R, G and B
  // Fraction of the detail lost by a trilinear filter that this filter keeps; 1: as much as the
  // reference.
  double detail = 0;
  double samples = 0;  // per fragment
  double bilinears = 0;
};

class TurnedPhoto {
 public:
  TurnedPhoto(const PhotoTexture& photo, const Turn& turn);

  FilterFigures golden(const spec::texture::Parameters& parameters, int lb_n_max = 4) const;
  FilterFigures ellipse(const spec::texture::Parameters& parameters, int lb_n_max = 4) const;
  // `rgba` holds one colour per pixel in the order of the quads.
  FilterFigures check(std::span<const std::uint8_t> rgba) const;
  const std::vector<spec::texture::Quad>& quads() const { return quads_; }
  const std::vector<golden::ideal::Colour>& reference() const { return reference_; }

 private:
  const PhotoTexture& photo_;
  std::vector<spec::texture::Quad> quads_;
  std::vector<golden::ideal::PixelFootprint> footprints_;
  std::vector<golden::ideal::Colour> reference_, blurred_;  // blurred: trilinear
};

}  // namespace deburr::studies
