// SPDX-License-Identifier: MIT
// The images of the vectors in spec/morphological/vectors.h.
#pragma once

#include <algorithm>
#include <cstdint>
#include <ostream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "spec/morphological/vectors.h"
#include "tb/stimuli/frames.h"

namespace deburr::spec::morphological {

inline void PrintTo(const FrameVector& v, std::ostream* out) { *out << v.name; }

}  // namespace deburr::spec::morphological

namespace deburr::tb::morphological {

inline Image vector_image(spec::morphological::VectorImage image) {
  switch (image) {
    case spec::morphological::VectorImage::kNoise:
      return stimuli::noise_image();
    case spec::morphological::VectorImage::kLine:
      return stimuli::line_image();
    case spec::morphological::VectorImage::kBlocks:
      return stimuli::blocks_image();
    case spec::morphological::VectorImage::kShades:
      return stimuli::shades_image();
    case spec::morphological::VectorImage::kText:
      return stimuli::text_image();
  }
  throw std::invalid_argument("no image of the vectors");
}

inline Image vector_image(const spec::morphological::PatternVector& pattern) {
  const std::string_view rows = pattern.rows;
  const int width = static_cast<int>(std::min(rows.find(' '), rows.size()));
  const int height = static_cast<int>(rows.size() + 1) / (width + 1);
  return stimuli::draw(width, height, [&](int x, int y) {
    return stimuli::grey(rows.at(static_cast<std::size_t>(y * (width + 1) + x)) == '1' ? 255 : 0);
  });
}

inline Image vector_image(const spec::morphological::GuardVector& v) {
  const std::string_view rows = v.rows;
  const int width = static_cast<int>(std::min(rows.find(' '), rows.size()));
  const int height = static_cast<int>(rows.size() + 1) / (width + 1);
  return stimuli::draw(width, height, [&](int x, int y) -> Rgba8 {
    switch (rows.at(static_cast<std::size_t>(y * (width + 1) + x))) {
      case '.':
        return {250, 240, 230, 255};
      case '#':
        return {30, 50, 70, 255};
      default:
        return {128, 128, 128, 255};
    }
  });
}

// A Z of the given length in row 2, starting at column 1.
inline Image vector_image(const spec::morphological::LimitVector& limit) {
  return stimuli::draw(limit.length + 2, 4, [&](int x, int y) {
    const bool white = y == 3 || (y == 2 && x > 0) || (y == 1 && x > limit.length);
    return stimuli::grey(white ? 255 : 0);
  });
}

inline std::vector<spec::morphological::FrameVector> frame_vectors() {
  std::vector<spec::morphological::FrameVector> all(spec::morphological::kFrameVectors.begin(),
                                                    spec::morphological::kFrameVectors.end());
  all.insert(all.end(), spec::morphological::kSmaaFrameVectors.begin(),
             spec::morphological::kSmaaFrameVectors.end());
  all.insert(all.end(), spec::morphological::kGuardFrameVectors.begin(),
             spec::morphological::kGuardFrameVectors.end());
  return all;
}

// A vector by its name.
inline spec::morphological::FrameVector frame_vector(std::string_view name) {
  for (const spec::morphological::FrameVector& v : frame_vectors())
    if (v.name == name) return v;
  throw std::out_of_range("no test vector " + std::string(name));
}

}  // namespace deburr::tb::morphological
