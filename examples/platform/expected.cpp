// SPDX-License-Identifier: MIT
#include "expected.h"

#include "golden/morphological/morphological_golden.h"
#include "golden/texture/texture_golden.h"

namespace platform {

namespace {

// The register values that software writes for texture 0.
deburr::spec::texture::Descriptor floor_texture() {
  using namespace deburr::spec::texture;
  Descriptor d;
  d.width = d.height = kSide;
  d.levels = kLevels;
  d.format = Format::kRgba8;
  d.layout = Layout::kLinear;
  d.wrap_s = d.wrap_t = Wrap::kRepeat;
  d.min_filter = MinFilter::kLinearMipmapLinear;
  d.mag_filter = MagFilter::kLinear;
  d.max_anisotropy_log2 = 3;
  d.max_lod = 12 << 8;
  std::uint32_t base = kTexture - kMemory;
  for (unsigned k = 0, side = kSide; k < kLevels; ++k, side /= 2) {
    d.base[k] = base;
    base += side * ((4 * side + 63) / 64 * 64);
  }
  return d;
}

}  // namespace

Frame expected(const deburr::spec::texture::Parameters& texture,
               const deburr::spec::morphological::Parameters& smoother,
               std::span<const std::uint8_t> memory) {
  deburr::golden::texture::TextureGolden sampler(
      texture, memory, deburr::golden::texture::TextureGolden::Traffic::kIgnore);
  sampler.set_texture(0, floor_texture());
  Frame frame;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) frame.at(x, y) = plain_colour(x, y);
  for (int number = 0; number < kQuads; ++number)
    for (const Colour& colour : sampler.process(quad_of(number))) put(frame, colour);

  using deburr::golden::morphological::MorphologicalGolden;
  MorphologicalGolden golden(smoother, MorphologicalGolden::Detail::kPixels);
  Frame smooth;
  smooth.pixels = golden.process({frame.pixels, kWidth, kHeight});
  return smooth;
}

}  // namespace platform
