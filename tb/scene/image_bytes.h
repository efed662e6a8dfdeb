// SPDX-License-Identifier: MIT
// Serialises images for a cache on the same machine; not a file format.
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>

#include "spec/error.h"
#include "tb/scene/image.h"

namespace deburr::tb {

template <class Pixel>
void append_bytes(std::string& bytes, const ImageOf<Pixel>& image) {
  static_assert(std::is_trivially_copyable_v<Pixel>);
  const std::int32_t size[] = {image.width, image.height};
  bytes.append(reinterpret_cast<const char*>(size), sizeof(size));
  bytes.append(reinterpret_cast<const char*>(image.pixels.data()),
               image.pixels.size() * sizeof(Pixel));
}

// Reads what append_bytes() wrote, and removes it from the front of the bytes.
template <class Pixel>
ImageOf<Pixel> take_image(std::string_view& bytes) {
  std::int32_t size[2] = {};
  DEBURR_CHECK(bytes.size() >= sizeof(size), "a stored picture has no size");
  std::memcpy(size, bytes.data(), sizeof(size));
  bytes.remove_prefix(sizeof(size));
  ImageOf<Pixel> image(size[0], size[1]);
  const std::size_t length = image.pixels.size() * sizeof(Pixel);
  DEBURR_CHECK(bytes.size() >= length, "a stored picture ends early");
  std::memcpy(image.pixels.data(), bytes.data(), length);
  bytes.remove_prefix(length);
  return image;
}

}  // namespace deburr::tb
