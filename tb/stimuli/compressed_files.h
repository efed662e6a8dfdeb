// SPDX-License-Identifier: MIT
// DDS and KTX files of compressed textures, for tests and fuzz seeds.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include "tb/scene/block_encoder.h"
#include "tb/scene/compressed_file.h"
#include "tb/scene/textures.h"

namespace deburr::tb::stimuli {

// The first `levels` levels of an image.
inline CompressedTexture compressed(const Image& image, spec::texture::Format format,
                                    std::size_t levels) {
  CompressedTexture texture{format, false, {}};
  for (const Image& level : mip_chain(image))
    if (texture.levels.size() < levels)
      texture.levels.push_back({level.width, level.height, encode_blocks(level, format)});
  return texture;
}

class FileBytes {
 public:
  explicit FileBytes(std::string_view magic, bool big_endian = false)
      : bytes_(magic), big_endian_(big_endian) {}
  FileBytes& words(std::initializer_list<std::uint64_t> values, std::size_t size = 4) {
    for (const std::uint64_t value : values)
      for (std::size_t i = 0; i < size; ++i)
        bytes_ += static_cast<char>(value >> 8 * (big_endian_ ? size - 1 - i : i));
    return *this;
  }
  FileBytes& zeros(std::size_t number) {
    bytes_.append(number, '\0');
    return *this;
  }
  FileBytes& blocks(const CompressedTexture::Level& level) {
    bytes_.append(level.blocks.begin(), level.blocks.end());
    return *this;
  }
  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
  bool big_endian_;
};

// BC formats: with a DX10 header, or with a FourCC.
inline std::string dds_file(const CompressedTexture& texture, std::string_view code = "DX10") {
  constexpr std::array<std::uint32_t, 4> kDxgi = {71, 77, 80, 83};
  const auto index = static_cast<std::size_t>(texture.format) -
                     static_cast<std::size_t>(spec::texture::Format::kBc1);
  const CompressedTexture::Level& first = texture.levels[0];
  FileBytes file("DDS ");
  file.words({124, 0xA1007, static_cast<std::uint64_t>(first.height),
              static_cast<std::uint64_t>(first.width), first.blocks.size(), 0,
              texture.levels.size()})
      .zeros(44)
      .words({32, 4});
  for (const char letter : code) file.words({static_cast<unsigned char>(letter)}, 1);
  file.zeros(20).words({0x401008}).zeros(16);
  if (code == "DX10") file.words({kDxgi[index] + texture.srgb, 3, 0, 1, 0});
  for (const auto& level : texture.levels) file.blocks(level);
  return file.bytes();
}

inline std::string ktx1_file(const CompressedTexture& texture, bool big_endian = false) {
  constexpr std::array<std::array<std::uint32_t, 2>, 7> kGl = {{{0x83F1, 0x8C4D},
                                                                {0x83F3, 0x8C4F},
                                                                {0x8DBB, 0},
                                                                {0x8DBD, 0},
                                                                {0x9274, 0x9275},
                                                                {0x9276, 0x9277},
                                                                {0x9278, 0x9279}}};
  const auto index = static_cast<std::size_t>(texture.format) -
                     static_cast<std::size_t>(spec::texture::Format::kBc1);
  FileBytes file("\xABKTX 11\xBB\r\n\x1A\n", big_endian);
  file.words({0x04030201, 0, 1, 0, kGl[index][texture.srgb], 0x1908,
              static_cast<std::uint64_t>(texture.levels[0].width),
              static_cast<std::uint64_t>(texture.levels[0].height), 0, 0, 1, texture.levels.size(),
              0});
  for (const auto& level : texture.levels) file.words({level.blocks.size()}).blocks(level);
  return file.bytes();
}

// The smallest level first, as the standard says.
inline std::string ktx2_file(const CompressedTexture& texture) {
  constexpr std::array<std::uint32_t, 7> kVulkan = {133, 137, 139, 141, 147, 149, 151};
  const auto index = static_cast<std::size_t>(texture.format) -
                     static_cast<std::size_t>(spec::texture::Format::kBc1);
  FileBytes file("\xABKTX 20\xBB\r\n\x1A\n");
  file.words({kVulkan[index] + texture.srgb, 1, static_cast<std::uint64_t>(texture.levels[0].width),
              static_cast<std::uint64_t>(texture.levels[0].height), 0, 0, 1, texture.levels.size(),
              0})
      .zeros(32);
  std::uint64_t end = 80 + 24 * texture.levels.size();
  for (const auto& level : texture.levels) end += level.blocks.size();
  for (const auto& level : texture.levels) {
    end -= level.blocks.size();
    file.words({end, level.blocks.size(), level.blocks.size()}, 8);
  }
  std::for_each(texture.levels.rbegin(), texture.levels.rend(),
                [&](const auto& level) { file.blocks(level); });
  return file.bytes();
}

// A file of each kind and size of blocks.
inline std::vector<std::string> small_compressed_files(const Image& image) {
  using spec::texture::Format;
  std::vector<std::string> files;
  for (const Format format : {Format::kBc1, Format::kBc5, Format::kEtc2RgbA1, Format::kEtc2Rgba8}) {
    const CompressedTexture texture = compressed(image, format, 3);
    files.push_back(ktx1_file(texture, format == Format::kBc1));
    files.push_back(ktx2_file(texture));
    if (format < Format::kEtc2Rgb) files.push_back(dds_file(texture));
  }
  files.push_back(dds_file(compressed(image, Format::kBc3, 1), "DXT5"));
  return files;
}

}  // namespace deburr::tb::stimuli
