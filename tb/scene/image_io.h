// SPDX-License-Identifier: MIT
// Reads and writes image files. 8-bit PNG files are written here; everything else uses OpenImageIO,
// which is loaded on first use (image_codec.h). Every failure throws a spec::FileError that names
// the file, the reason and what to do. A failed write leaves no partial or temporary file.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "tb/scene/compressed_file.h"
#include "tb/scene/image.h"

namespace deburr::tb {

inline constexpr int kMaxImageSide = 8192;  // checked in the header, before allocation

// How a file was converted to RGBA8: one line for each lossy conversion, with the number of changed
// values unless all changed.
struct ReadReport {
  int channels = 0;
  std::string format;  // pixel type of the file: "uint8", "uint16", "half", "float"
  std::vector<std::string> conversions;
  std::shared_ptr<const CompressedTexture> compressed = nullptr;  // of a file of blocks
};

// Reads any format that OpenImageIO knows, and the compressed textures of compressed_file.h (level
// 0, decoded), as RGBA8 with alpha not premultiplied.
//   premultiplied colours      divided by alpha before the conversions below; unchanged where
//                              alpha is 0
//   16-bit and other integers  v * 255 / max, rounded half up
//   half, float                NaN -> 0, clamped to [0, 1]; linear light (EXR, HDR) is encoded with
//                              the sRGB curve, anything else is taken as encoded; times 255,
//                              rounded half up
//   palette                    expanded
//   one channel                copied to R, G and B; alpha 255
//   two channels               grey and alpha
//   three channels             alpha 255
//   more than four             the first three colour channels, and alpha
//   a data window (EXR)        placed in the whole image, 0 around it; cropped to the image
// Only the first sub-image and level 0 are read. Throws FileError: missing, not a regular file,
// empty, unknown format, truncated or corrupt, side over kMaxImageSide, volume or deep image.
Image read_image(const std::filesystem::path& path, ReadReport* report = nullptr);
// Decodes an image file in memory (embedded in a glTF); `name` is used in error messages.
Image read_image_memory(const std::string& name, std::string_view bytes,
                        ReadReport* report = nullptr);

// Reads a depth image: 24 bits in R, G, B (most significant first; 8-bit file with three or more
// channels) as value / (2^24 - 1); 16-bit grey as value / (2^16 - 1), rounded to 24 bits; or one
// float channel, in a multi-channel EXR the one named Z or depth. Pixels outside a data window are
// 0. Throws FileError for other files and for NaN. Inexact conversions are reported.
DepthImage read_depth(const std::filesystem::path& path, ReadReport* report = nullptr);

// Encodes by file extension (.png, .exr, .tif, ...: every format that OpenImageIO can write to
// memory) and writes the file atomically. Before that, files encoded by OpenImageIO are decoded and
// compared pixel by pixel (lossy formats: size only).
void write_image(const std::filesystem::path& path, const Image& image);
// 24-bit depth in R, G, B, in the format of read_depth(): round(depth * (2^24 - 1)).
void write_depth24(const std::filesystem::path& path, const DepthImage& depth);
void write_mask(const std::filesystem::path& path, const Mask& mask);  // 0 and 255

}  // namespace deburr::tb
