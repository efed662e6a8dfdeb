// SPDX-License-Identifier: MIT
#include "tb/scene/png.h"

#include <zlib.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "spec/error.h"

namespace deburr::tb {
namespace {

using Bytes = std::vector<unsigned char>;

// Rendered images are flat areas with few edges. For these this level is three times as fast as
// zlib's default level, while files are a sixth larger.
constexpr int kLevel = 4;
// Stores each byte minus the byte above it. For such images a choice of filter per row gains
// nothing.
constexpr unsigned char kFilterUp = 2;
constexpr char kTrueColour = 2, kTrueColourAlpha = 6;

void put(std::string& bytes, std::uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(value >> shift & 0xFF);
}

void put_chunk(std::string& file, std::string_view name, std::string_view data) {
  put(file, static_cast<std::uint32_t>(data.size()));
  const std::size_t checked = file.size();
  file += name;
  file += data;
  put(file, static_cast<std::uint32_t>(::crc32_z(
                0, reinterpret_cast<const unsigned char*>(&file[checked]), file.size() - checked)));
}

Bytes filtered(const Image& image, std::size_t channels) {
  const auto width = static_cast<std::size_t>(image.width);
  const auto height = static_cast<std::size_t>(image.height);
  const std::vector<Rgba8> nothing(width, Rgba8{});
  const Rgba8* above = nothing.data();
  Bytes bytes(height * (1 + width * channels));
  unsigned char* to = bytes.data();
  for (std::size_t y = 0; y < height; ++y) {
    const Rgba8* const row = &image.pixels[y * width];
    *to++ = kFilterUp;
    for (std::size_t x = 0; x < width; ++x)
      for (std::size_t c = 0; c < channels; ++c)
        *to++ = static_cast<unsigned char>(row[x][c] - above[x][c]);
    above = row;
  }
  return bytes;
}

Bytes compressed(const Bytes& bytes) {
  uLongf size = ::compressBound(static_cast<uLong>(bytes.size()));
  Bytes result(size);
  const int code =
      ::compress2(result.data(), &size, bytes.data(), static_cast<uLong>(bytes.size()), kLevel);
  DEBURR_CHECK(code == Z_OK, "zlib: " + std::to_string(code));
  result.resize(size);
  return result;
}

}  // namespace

std::string encode_png(const Image& image) {
  const bool opaque = std::all_of(image.pixels.begin(), image.pixels.end(),
                                  [](const Rgba8& pixel) { return pixel[3] == 255; });
  std::string header;
  put(header, static_cast<std::uint32_t>(image.width));
  put(header, static_cast<std::uint32_t>(image.height));
  header += {8, opaque ? kTrueColour : kTrueColourAlpha, 0, 0, 0};
  const Bytes data = compressed(filtered(image, opaque ? 3 : 4));
  std::string file = "\x89PNG\r\n\x1a\n";
  put_chunk(file, "IHDR", header);
  put_chunk(file, "IDAT", {reinterpret_cast<const char*>(data.data()), data.size()});
  put_chunk(file, "IEND", "");
  return file;
}

}  // namespace deburr::tb
