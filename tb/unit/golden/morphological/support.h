// SPDX-License-Identifier: MIT
// Helpers of the tests and the benchmark of the morphological golden model: images of tb/stimuli as
// input frames, hit coverage bins, and smoothing of one frame.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "golden/morphological/morphological_golden.h"
#include "spec/morphological/packets.h"
#include "spec/morphological/parameters.h"
#include "tb/scene/image.h"
#include "tb/stimuli/frames.h"

namespace deburr::tb::morphological {

using stimuli::blocks_image;
using stimuli::grey;
using stimuli::hash;
using stimuli::inverted;
using stimuli::line_image;
using stimuli::mirrored_x;
using stimuli::mirrored_y;
using stimuli::noise_image;
using stimuli::rendered_like;
using stimuli::shades_image;
using stimuli::text_image;
using stimuli::transposed;

// An image with a view for the golden model.
struct Frame : Image {
  using Image::Image;
  Frame() = default;
  Frame(Image image) : Image(std::move(image)) {}
  template <class Picture>  // Rgba8 picture(x, y), called in raster order
  Frame(int w, int h, Picture&& picture)
      : Image(stimuli::draw(w, h, std::forward<Picture>(picture))) {}
  golden::morphological::ImageView view() const { return {pixels, width, height}; }
};

using Hits = std::map<std::string, std::uint64_t>;
// Hit bins whose names start with `group`.
template <class Bins>
Hits hits_of(const Bins& bins, const std::string& group = "") {
  Hits hits;
  for (const auto& bin : bins)
    if (bin.hits != 0 && bin.name.starts_with(group)) hits[bin.name] = bin.hits;
  return hits;
}
// Names of hit bins in alphabetical order, with counts other than 1.
template <class Bins>
std::string names_of(const Bins& bins) {
  std::string names;
  for (const auto& [name, hits] : hits_of(bins)) {
    names += (names.empty() ? "" : " ") + name;
    if (hits != 1) names += " x " + std::to_string(hits);
  }
  return names;
}

inline Frame smooth(const spec::morphological::Parameters& parameters, const Frame& frame) {
  Frame result(frame.width, frame.height);
  golden::morphological::MorphologicalGolden golden(
      parameters, golden::morphological::MorphologicalGolden::Detail::kPixels);
  result.pixels = golden.process(frame.view());
  return result;
}

}  // namespace deburr::tb::morphological
