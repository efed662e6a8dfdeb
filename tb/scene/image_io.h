// SPDX-License-Identifier: MIT
// Image files in and out. PNG files of 8 bits are written here, all else goes through OpenImageIO,
// which is loaded when it is first needed (image_codec.h). Every failure is a spec::FileError that
// names the file, the reason and what to do; a failed write leaves neither a half-written file nor
// a temporary one.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "tb/scene/image.h"

namespace deburr::tb {

inline constexpr int kMaxImageSide = 8192;  // checked on the header, before anything is allocated

// How a file became RGBA8; one line for each conversion that changed something, for the report,
// with how many values were changed where that is not all of them.
struct ReadReport {
  int channels = 0;
  std::string format;  // the file's own pixel type: "uint8", "uint16", "half", "float"
  std::vector<std::string> conversions;
};

// Reads any format that OpenImageIO knows, as RGBA8 with alpha not premultiplied.
//   colour times alpha         divided by alpha, before what follows; as it is where alpha is 0
//   16-bit and other integers  v * 255 / max, rounded half up
//   half, float                NaN -> 0, clamped to [0, 1]; where the file says that it is linear
//                              light (EXR, HDR), R, G and B go through the sRGB curve, else it is
//                              taken as encoded; times 255, rounded half up
//   palette                    expanded
//   one channel                copied to R, G and B; alpha 255
//   two channels               grey and alpha
//   three channels             alpha 255
//   more than four             the first three of colour, and alpha
//   a part of a picture        (an EXR's data window) in its place, 0 around; what is outside is
//   cut
// Only the first sub-image and level 0 are read. Throws FileError: missing, not a regular file,
// empty, unknown format, truncated or corrupt, side over kMaxImageSide, volume or deep image.
Image read_image(const std::filesystem::path& path, ReadReport* report = nullptr);
// The same from an encoded file in memory (an image embedded in a glTF); `name` is for error texts.
Image read_image_memory(const std::string& name, std::string_view bytes,
                        ReadReport* report = nullptr);

// A depth picture: 24 bits in R, G, B (most significant first; 8-bit file with three or more
// channels) as value / (2^24 - 1); 16 bits of grey as value / (2^16 - 1), rounded to 24 bits; or
// one float channel, of an EXR of several the one named Z or depth. 0 where a part of a picture is
// not. Throws FileError for all else, and for a NaN. Values that 24 bits make others are reported.
DepthImage read_depth(const std::filesystem::path& path, ReadReport* report = nullptr);

// Encodes by extension (.png, .exr, .tif, ... whatever OpenImageIO writes to memory) and writes it
// atomically. What OpenImageIO encoded is decoded first and compared pixel by pixel (lossy formats:
// size only).
void write_image(const std::filesystem::path& path, const Image& image);
// 24-bit depth in R, G, B, as read_depth reads it: round(depth * (2^24 - 1)).
void write_depth24(const std::filesystem::path& path, const DepthImage& depth);
void write_mask(const std::filesystem::path& path, const Mask& mask);  // 0 and 255

}  // namespace deburr::tb
