// SPDX-License-Identifier: MIT
#include "studies/quality/turned_photo.h"

#include <cmath>
#include <numbers>

#include "golden/ideal/box.h"
#include "golden/ideal/ellipse.h"
#include "spec/error.h"
#include "tb/engines/texture/texture_levels.h"
#include "tb/scene/textures.h"

namespace deburr::studies {
namespace {

constexpr int kBox = 24;  // points per reference pixel, in each direction

std::vector<std::uint8_t> bytes_of(const tb::Image& image) {
  std::vector<std::uint8_t> bytes;
  for (const tb::Rgba8& texel : image.pixels) bytes.insert(bytes.end(), texel.begin(), texel.end());
  return bytes;
}

std::int32_t fixed(double coordinate) {
  return static_cast<std::int32_t>(std::lround(coordinate * spec::texture::kCoordinateOne));
}

}  // namespace

PhotoTexture::PhotoTexture(tb::Image image)
    : image_(std::move(image)), ideal_(image_.width, image_.height, bytes_of(image_)) {
  const std::vector<tb::Image> levels = tb::mip_chain(image_);
  memory_.add(levels_of(levels), {});
}

spec::texture::Descriptor PhotoTexture::descriptor(int lb_n_max) const {
  spec::texture::Descriptor descriptor = memory_.descriptors().front();
  descriptor.max_anisotropy_log2 = static_cast<std::uint8_t>(lb_n_max);
  return descriptor;
}

TurnedPhoto::TurnedPhoto(const PhotoTexture& photo, const Turn& turn) : photo_(photo) {
  DEBURR_CHECK(turn.size % 2 == 0, "width and height of an image must be even");
  const double angle = turn.degrees * std::numbers::pi / 180;
  const double cosine = std::cos(angle), sine = std::sin(angle);
  const auto at = [&](double x, double y) {
    const double across = x - 0.5 * turn.size, down = y - 0.5 * turn.size;
    const double s = turn.ratio * turn.width * (cosine * across - sine * down);
    const double t = turn.width * (sine * across + cosine * down);
    // An offset that does not align with the texel grid.
    return std::pair{s / photo.image().width + 0.4137, t / photo.image().height + 0.2731};
  };
  for (int y = 0; y < turn.size; y += 2) {
    for (int x = 0; x < turn.size; x += 2) {
      spec::texture::Quad quad;
      quad.x = static_cast<std::uint16_t>(x);
      quad.y = static_cast<std::uint16_t>(y);
      for (std::size_t lane = 0; lane < 4; ++lane) {
        const auto [s, t] =
            at(x + static_cast<double>(lane & 1) + 0.5, y + static_cast<double>(lane >> 1) + 0.5);
        quad.s[lane] = fixed(s);
        quad.t[lane] = fixed(t);
      }
      quads_.push_back(quad);
    }
  }
  footprints_ = golden::ideal::pixel_footprints(quads_, photo.image().width, photo.image().height);
  reference_ = golden::ideal::box_image(photo.ideal(), footprints_, kBox);
  for (const golden::ideal::PixelFootprint& f : footprints_)
    blurred_.push_back(
        golden::ideal::trilinear(photo.ideal(), f.s, f.t, std::log2(turn.ratio * turn.width)));
}

FilterFigures TurnedPhoto::golden(const spec::texture::Parameters& parameters, int lb_n_max) const {
  using golden::texture::TextureGolden;
  TextureGolden golden(parameters, photo_.memory(), TextureGolden::Traffic::kIgnore);
  golden.set_texture(0, photo_.descriptor(lb_n_max));
  std::vector<std::uint8_t> rgba;
  for (const spec::texture::Quad& quad : quads_)
    for (const spec::texture::Colour& colour : golden.process(quad))
      rgba.insert(rgba.end(), colour.rgba.begin(), colour.rgba.end());
  FilterFigures figures = check(rgba);
  const auto fragments = static_cast<double>(golden.work().fragments);
  figures.samples = static_cast<double>(golden.work().samples) / fragments;
  figures.bilinears = static_cast<double>(golden.work().bilinears) / fragments;
  return figures;
}

FilterFigures TurnedPhoto::ellipse(const spec::texture::Parameters& parameters,
                                   int lb_n_max) const {
  std::vector<std::uint8_t> rgba;
  for (const golden::ideal::Colour& colour : golden::ideal::ellipse_image(
           photo_.ideal(), parameters, photo_.descriptor(lb_n_max), footprints_))
    for (const double channel : colour)
      rgba.push_back(static_cast<std::uint8_t>(std::lround(channel)));
  return check(rgba);
}

FilterFigures TurnedPhoto::check(std::span<const std::uint8_t> rgba) const {
  FilterFigures figures;
  figures.psnr = golden::ideal::psnr(reference_, rgba);
  double kept = 0, there = 0;
  for (std::size_t i = 0; i < reference_.size(); ++i)
    for (std::size_t c = 0; c < 3; ++c) {
      const double detail = reference_[i][c] - blurred_[i][c];
      kept += (rgba[4 * i + c] - blurred_[i][c]) * detail;
      there += detail * detail;
    }
  figures.detail = kept / there;
  return figures;
}

}  // namespace deburr::studies
