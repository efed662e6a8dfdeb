// SPDX-License-Identifier: MIT
// The BC decoder with bc = truncated equals libsquish, to the bit.
#include <gmock/gmock.h>
#include <squish.h>

#include "tb/oracle/blocks.h"

namespace deburr::tb::texture::squish_test {
namespace {

using spec::texture::BlockRule;
using spec::texture::Format;

// Texels of the picture. The library does not decode blocks of BC4 and BC5 by themselves: they are
// given to it as alpha of BC3.
std::vector<std::uint8_t> decompress(const BlockPicture& picture) {
  const std::size_t side = picture.texels_per_side();
  const auto of = [side](const std::uint8_t* blocks, int format) {
    std::vector<std::uint8_t> texels(side * side * 4);
    squish::DecompressImage(texels.data(), static_cast<int>(side), static_cast<int>(side), blocks,
                            format);
    return texels;
  };
  if (picture.format == Format::kBc1) return of(picture.blocks.data(), squish::kDxt1);
  if (picture.format == Format::kBc3) return of(picture.blocks.data(), squish::kDxt5);
  std::vector<std::uint8_t> texels(side * side * 4);
  for (std::size_t c = 0; c < picture.channels(); ++c) {
    std::vector<std::uint8_t> bc3(picture.side * picture.side * 16);
    for (std::size_t i = 0; i < picture.side * picture.side; ++i)
      std::copy_n(&picture.blocks[i * picture.block_bytes + 8 * c], 8, &bc3[16 * i]);
    const auto values = of(bc3.data(), squish::kDxt5);
    for (std::size_t i = 0; i < side * side; ++i) texels[4 * i + c] = values[4 * i + 3];
  }
  return texels;
}

class Squish : public testing::TestWithParam<Format> {};

TEST_P(Squish, DecodesAMillionBlocksEqually) {
  const BlockPicture picture(GetParam(), 1000, 1);
  EXPECT_THAT(wrong_texels(picture, BlockRule::kTruncated, decompress(picture), 4),
              testing::Each(0u));
}

TEST_P(Squish, FindsTheOtherRoundingAndSwappedSelectors) {
  const BlockPicture picture(GetParam(), 16, 1);
  const auto texels = decompress(picture);
  EXPECT_THAT(wrong_texels(picture, BlockRule::kRounded, texels, 4),
              testing::Each(testing::Gt(0u)));
  EXPECT_THAT(wrong_texels(picture, BlockRule::kTruncated, texels, 4, swapped_selectors),
              testing::Each(testing::Gt(0u)));
}

INSTANTIATE_TEST_SUITE_P(Bc, Squish,
                         testing::Values(Format::kBc1, Format::kBc3, Format::kBc4, Format::kBc5),
                         [](const auto& suite) { return std::string(format_name(suite.param)); });

}  // namespace
}  // namespace deburr::tb::texture::squish_test
