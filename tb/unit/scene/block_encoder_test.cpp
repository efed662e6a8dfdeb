// SPDX-License-Identifier: MIT
// The encoder of blocks, whose arithmetic is its own, against the golden decoder: PSNR of the
// textures of the scenes, and cases without loss.
#include "tb/scene/block_encoder.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "tb/base/fnv.h"
#include "tb/base/random.h"
#include "tb/scene/compressed_file.h"
#include "tb/scene/textures.h"

namespace deburr::tb::block_encoder_test {
namespace {

using spec::texture::Format;

constexpr std::array kFormats = {Format::kBc1,      Format::kBc3,     Format::kBc4,
                                 Format::kBc5,      Format::kEtc2Rgb, Format::kEtc2RgbA1,
                                 Format::kEtc2Rgba8};
const char* name_of(Format format) {
  return spec::texture::kFormatNames[static_cast<std::size_t>(format)].data();
}

Image through_blocks(const Image& image, Format format) {
  const CompressedTexture::Level level{image.width, image.height, encode_blocks(image, format)};
  EXPECT_EQ(level.blocks.size(),
            static_cast<std::size_t>((image.width + 3) / 4) *
                static_cast<std::size_t>((image.height + 3) / 4) *
                spec::texture::kFormatBlockBytes[static_cast<std::size_t>(format)]);
  return decoded(level, format);
}

// The table of docs/reference/texture/compressed.md; the floor is about 1 dB lower.
TEST(BlockEncoder, PsnrOfEmbeddedTextures) {
  constexpr std::array kTextures = {"road", "brick", "stones", "gradient"};
  constexpr std::array<std::array<double, 4>, 7> kFloor = {{{37, 39, 37.5, 47.5},
                                                            {37, 39, 37.5, 47.5},
                                                            {43, 45, 44.5, 90},
                                                            {43, 45, 44.5, 90},
                                                            {35.5, 33, 38.5, 49.5},
                                                            {34.5, 32, 38.5, 49.5},
                                                            {35.5, 33, 38.5, 49.5}}};
  std::string table;
  for (std::size_t f = 0; f < kFormats.size(); ++f) {
    table += fmt::format("| `{}` |", name_of(kFormats[f]));
    for (std::size_t t = 0; t < kTextures.size(); ++t) {
      const Image image = make_texture(kTextures[t], 512, 512);
      const double psnr = block_psnr(image, through_blocks(image, kFormats[f]), kFormats[f]);
      table += fmt::format(" {:.1f} |", psnr);
      EXPECT_GE(psnr, kFloor[f][t]) << name_of(kFormats[f]) << ' ' << kTextures[t];
    }
    table += '\n';
  }
  fmt::print("{}", table);
}

// The same on every machine.
TEST(BlockEncoder, BlocksMatchRecordedHashes) {
  constexpr std::array<std::uint64_t, 7> kHashes = {
      0x2A52D4F378D332B6u, 0xABAF70110C05C4F2u, 0x4EEA3EE76DC82F9Bu, 0x9F6AA412386995C1u,
      0x94425442A161ECC0u, 0x4696BC390CFFAB5Eu, 0x69D94434697BC300u};
  Image image = stones(64, 64);
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) image.at(x, y)[3] = static_cast<std::uint8_t>(4 * x + 2 * (y % 2));
  for (std::size_t f = 0; f < kFormats.size(); ++f) {
    FnvHash hash;
    for (const std::uint8_t byte : encode_blocks(image, kFormats[f])) hash.byte(byte);
    EXPECT_EQ(hash.value(), kHashes[f]) << name_of(kFormats[f]);
  }
}

TEST(BlockEncoder, TexelsBeyondTheEdgeRepeatIt) {
  const Image image = make_texture("brick", 7, 5);
  Image padded(8, 8);
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 8; ++x) padded.at(x, y) = image.at(std::min(x, 6), std::min(y, 4));
  for (const Format format : kFormats)
    EXPECT_EQ(encode_blocks(image, format), encode_blocks(padded, format)) << name_of(format);
}

TEST(BlockEncoder, ExtremeColoursHaveNoLoss) {
  for (const int code : {0, 1, 2, 3, 4, 5, 6, 7}) {
    Image image(4, 4);
    for (Rgba8& texel : image.pixels)
      texel = {static_cast<std::uint8_t>(code & 1 ? 255 : 0),
               static_cast<std::uint8_t>(code & 2 ? 255 : 0),
               static_cast<std::uint8_t>(code & 4 ? 255 : 0), 255};
    for (const Format format :
         {Format::kBc1, Format::kBc3, Format::kEtc2Rgb, Format::kEtc2RgbA1, Format::kEtc2Rgba8})
      EXPECT_EQ(through_blocks(image, format), image) << name_of(format) << ' ' << code;
  }
}

// Black and white texels in every pattern of a row, so that end points are swapped and equal.
TEST(BlockEncoder, TwoColoursHaveNoLoss) {
  for (int pattern = 0; pattern < 16; ++pattern) {
    Image image(4, 4);
    for (int i = 0; i < 16; ++i)
      image.at(i % 4, i / 4) =
          (pattern >> i % 4 & 1) != 0 ? Rgba8{255, 255, 255, 255} : Rgba8{0, 0, 0, 255};
    for (const Format format : {Format::kBc1, Format::kBc3})
      EXPECT_EQ(through_blocks(image, format), image) << name_of(format) << ' ' << pattern;
  }
}

TEST(BlockEncoder, TexelsBelowHalfAlphaBecomeHoles) {
  Random random(1, "holes");
  for (std::uint32_t i = 0; i < 300; ++i) {
    Image image(4, 4);
    for (Rgba8& texel : image.pixels) {
      texel = {static_cast<std::uint8_t>(100 + random.below(8)), 60,
               static_cast<std::uint8_t>(40 + random.below(8)),
               static_cast<std::uint8_t>(random.chance(3u * i) ? 127 : 128)};
    }
    for (const Format format : {Format::kBc1, Format::kEtc2RgbA1}) {
      const Image back = through_blocks(image, format);
      for (std::size_t p = 0; p < 16; ++p) {
        if (image.pixels[p][3] < 128) {
          EXPECT_EQ(back.pixels[p], (Rgba8{0, 0, 0, 0})) << name_of(format);
          continue;
        }
        EXPECT_EQ(back.pixels[p][3], 255) << name_of(format);
        for (std::size_t c = 0; c < 3; ++c)
          EXPECT_NEAR(back.pixels[p][c], image.pixels[p][c], 9) << name_of(format);
      }
    }
  }
}

TEST(BlockEncoder, AlphaIsCloseAndExactIfConstant) {
  Image image(256, 4, {9, 9, 9, 255});
  for (int x = 0; x < 256; ++x) image.at(x, 0)[3] = static_cast<std::uint8_t>(x / 4 * 4);
  for (int y = 1; y < 4; ++y)
    for (int x = 0; x < 256; ++x) image.at(x, y)[3] = image.at(x, 0)[3];
  for (const Format format : {Format::kBc3, Format::kEtc2Rgba8}) {
    const Image back = through_blocks(image, format);
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
      EXPECT_EQ(back.pixels[i][3], image.pixels[i][3]) << name_of(format);
  }
  for (int x = 0; x < 256; ++x)
    for (int y = 0; y < 4; ++y)
      image.at(x, y)[3] = static_cast<std::uint8_t>(x / 4 % 2 == 0 ? x : 64 * y + x % 4);
  for (const Format format : {Format::kBc3, Format::kEtc2Rgba8}) {
    const Image back = through_blocks(image, format);
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
      EXPECT_NEAR(back.pixels[i][3], image.pixels[i][3], 16) << name_of(format);
  }
}

}  // namespace
}  // namespace deburr::tb::block_encoder_test
