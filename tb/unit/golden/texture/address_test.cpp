// SPDX-License-Identifier: MIT
// Texel addresses: each texel or block has its own address within its level, for every layout,
// format and size; the order of tiles; the checks of a descriptor.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <set>
#include <string>

#include "golden/texture/sampling.h"
#include "tb/unit/golden/texture/support.h"

namespace deburr::address_test {
namespace {

using namespace golden::texture;
using spec::texture::Format;
using spec::texture::Layout;

constexpr Format kFormats[] = {Format::kRgba8,   Format::kRgb565, Format::kRgba4444, Format::kL8,
                               Format::kSrgb8A8, Format::kBc1,    Format::kEtc2Rgba8};
constexpr auto kNone = spec::texture::Decode::kNone, kAfter = spec::texture::Decode::kAfter;

spec::texture::Descriptor descriptor(int width, int height, Format format, Layout layout) {
  spec::texture::Descriptor d;
  d.width = static_cast<std::uint16_t>(width);
  d.height = static_cast<std::uint16_t>(height);
  d.levels = static_cast<std::uint8_t>(1 + std::log2(std::max(width, height)));
  d.format = format;
  d.layout = layout;
  tb::texture::place_levels(d, 64);
  return d;
}

using Address = std::function<std::uint32_t(const spec::texture::Descriptor&, int, int, int)>;

// Number of texels or blocks, over all levels, whose address is misaligned, outside its level, or
// already used by another one.
int wrong_addresses(const Address& address, const spec::texture::Descriptor& d) {
  const bool blocks = spec::texture::is_compressed(d.format);
  const int side = blocks ? 4 : 1;
  const auto format = static_cast<std::size_t>(d.format);
  const std::uint32_t bytes =
      blocks ? spec::texture::kFormatBlockBytes[format] : spec::texture::kFormatBytes[format];
  int count = 0;
  std::vector<bool> taken;
  for (int k = 0; k < d.levels; ++k) {
    const std::uint64_t base = d.base[static_cast<std::size_t>(k)];
    const std::uint64_t end = base + level_bytes(d, k);
    if (taken.size() < end) taken.resize(end);
    for (int y = 0; y < level_size(d.height, k); y += side) {
      for (int x = 0; x < level_size(d.width, k); x += side) {
        const std::uint32_t at = address(d, k, x, y);
        if (at % bytes != 0 || at < base || at + bytes > end || taken[at]) {
          ++count;
        } else {
          taken[at] = true;
        }
      }
    }
  }
  return count;
}

TEST(Address, TexelsAndBlocksOfALevelHaveDistinctAddresses) {
  for (const Format format : kFormats) {
    for (const Layout layout : {Layout::kLinear, Layout::kTiled}) {
      for (const auto& [w, h] : {std::pair{1, 1},
                                 {2, 1},
                                 {1, 7},
                                 {3, 5},
                                 {4, 4},
                                 {5, 4},
                                 {8, 8},
                                 {9, 17},
                                 {16, 16},
                                 {64, 8},
                                 {8, 64},
                                 {100, 37},
                                 {127, 99},
                                 {128, 128},
                                 {200, 3},
                                 {1024, 5},
                                 {5, 1024}}) {
        EXPECT_EQ(wrong_addresses(texel_address, descriptor(w, h, format, layout)), 0)
            << w << 'x' << h << ' ' << static_cast<int>(format) << static_cast<int>(layout);
      }
    }
  }
  EXPECT_EQ(wrong_addresses(texel_address, descriptor(4096, 16, Format::kRgba8, Layout::kTiled)),
            0);
  EXPECT_EQ(wrong_addresses(texel_address, descriptor(4095, 9, Format::kRgb565, Layout::kTiled)),
            0);
}

TEST(Address, CheckFindsInjectedFaults) {
  const Address collide = [](const spec::texture::Descriptor& d, int k, int x, int y) {
    return texel_address(d, k, x, y) & ~std::uint32_t{4};
  };
  EXPECT_GT(wrong_addresses(collide, descriptor(64, 32, Format::kRgba8, Layout::kTiled)), 0);
  const Address transposed = [](const spec::texture::Descriptor& d, int k, int x, int y) {
    return texel_address(d, k, y, x);
  };
  EXPECT_GT(wrong_addresses(transposed, descriptor(64, 32, Format::kRgba8, Layout::kLinear)), 0);
}

TEST(Address, LinearRowsAreRoundedTo64Bytes) {
  const auto d = descriptor(17, 5, Format::kRgba8, Layout::kLinear);
  EXPECT_EQ(texel_address(d, 0, 16, 0) - d.base[0], 64u);
  EXPECT_EQ(texel_address(d, 0, 0, 1) - d.base[0], 128u);
  EXPECT_EQ(level_bytes(d, 0), 640u);
  const auto l8 = descriptor(64, 2, Format::kL8, Layout::kLinear);
  EXPECT_EQ(texel_address(l8, 0, 63, 1) - l8.base[0], 127u);
}

TEST(Address, TileIs64ContiguousBytesRowByRow) {
  const auto d = descriptor(32, 32, Format::kRgba8, Layout::kTiled);
  for (int y = 0; y < 4; ++y) {
    for (int x = 0; x < 4; ++x) {
      EXPECT_EQ(texel_address(d, 0, x, y) - d.base[0], static_cast<std::uint32_t>(4 * (4 * y + x)));
    }
  }
  const auto d16 = descriptor(32, 32, Format::kRgb565, Layout::kTiled);  // 8 x 4
  EXPECT_EQ(texel_address(d16, 0, 7, 3) - d16.base[0], 62u);
  EXPECT_EQ(texel_address(d16, 0, 8, 0) - d16.base[0], 64u);
  const auto d8 = descriptor(32, 32, Format::kL8, Layout::kTiled);  // 8 x 8
  EXPECT_EQ(texel_address(d8, 0, 7, 7) - d8.base[0], 63u);
  EXPECT_EQ(texel_address(d8, 0, 0, 8) - d8.base[0], 128u);
}

TEST(Address, TilesFollowTheMortonCurve) {
  const auto tile = [](const spec::texture::Descriptor& d, int column, int row) {
    return (texel_address(d, 0, 4 * column, 4 * row) - d.base[0]) / 64;
  };
  const auto square = descriptor(16, 16, Format::kRgba8, Layout::kTiled);
  const std::uint32_t expected[4][4] = {
      {0, 1, 4, 5}, {2, 3, 6, 7}, {8, 9, 12, 13}, {10, 11, 14, 15}};
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 4; ++column) {
      EXPECT_EQ(tile(square, column, row), expected[row][column]);
    }
  }
  // 8 x 2 tiles: one bit of column and row is interleaved; the remaining bits of the column are the
  // high bits.
  const auto wide = descriptor(32, 8, Format::kRgba8, Layout::kTiled);
  EXPECT_EQ(tile(wide, 1, 1), 3u);
  EXPECT_EQ(tile(wide, 2, 0), 4u);
  EXPECT_EQ(tile(wide, 7, 1), 15u);
  const auto tall = descriptor(8, 32, Format::kRgba8, Layout::kTiled);
  EXPECT_EQ(tile(tall, 0, 2), 4u);
  EXPECT_EQ(tile(tall, 1, 7), 15u);
  // 5 x 3 tiles are padded to a grid of 8 x 4.
  const auto odd = descriptor(20, 12, Format::kRgba8, Layout::kTiled);
  EXPECT_EQ(tile(odd, 4, 0), 16u);
  EXPECT_EQ(tile(odd, 4, 2), 24u);
  EXPECT_EQ(level_bytes(odd, 0), 32u * 64u);
}

TEST(Address, TexelsOfABlockHaveItsAddress) {
  for (const Layout layout : {Layout::kLinear, Layout::kTiled}) {
    const auto d = descriptor(23, 14, Format::kBc3, layout);
    for (int y = 0; y < 14; ++y)
      for (int x = 0; x < 23; ++x)
        EXPECT_EQ(texel_address(d, 0, x, y), texel_address(d, 0, x / 4 * 4, y / 4 * 4));
  }
}

TEST(Address, RowsOfBlocksAreRoundedTo64Bytes) {
  const auto bc1 = descriptor(33, 9, Format::kBc1, Layout::kLinear);  // 9 x 3 blocks
  EXPECT_EQ(texel_address(bc1, 0, 32, 3) - bc1.base[0], 64u);
  EXPECT_EQ(texel_address(bc1, 0, 4, 8) - bc1.base[0], 2u * 128 + 8);
  EXPECT_EQ(level_bytes(bc1, 0), 3u * 128);
  const auto bc3 = descriptor(16, 4, Format::kBc3, Layout::kLinear);
  EXPECT_EQ(texel_address(bc3, 0, 12, 0) - bc3.base[0], 48u);
  EXPECT_EQ(level_bytes(bc3, 0), 64u);
  EXPECT_EQ(level_bytes(bc3, 4), 64u);
}

// Tile number m of rgba8 has 64 bytes at 64 m; a block has its own bytes there.
TEST(Address, BlocksFollowTheCurveOfTiles) {
  for (const auto& [w, h] : {std::pair{64, 64}, {37, 90}, {120, 5}, {3, 1}}) {
    const auto tiles = descriptor(w, h, Format::kRgba8, Layout::kTiled);
    for (const auto& [format, bytes] : {std::pair{Format::kBc4, 8u}, {Format::kBc5, 16u}}) {
      const auto blocks = descriptor(w, h, format, Layout::kTiled);
      for (int k = 0; k < blocks.levels; ++k) {
        const auto level = static_cast<std::size_t>(k);
        EXPECT_EQ(level_bytes(blocks, k), level_bytes(tiles, k) / 64 * bytes);
        for (int y = 0; y < level_size(blocks.height, k); y += 4)
          for (int x = 0; x < level_size(blocks.width, k); x += 4)
            EXPECT_EQ(texel_address(blocks, k, x, y) - blocks.base[level],
                      (texel_address(tiles, k, x, y) - tiles.base[level]) / 64 * bytes);
      }
    }
  }
}

TEST(Address, LevelAddressesSumToTexelAddresses) {
  for (const Layout layout : {Layout::kLinear, Layout::kTiled}) {
    for (const Format format : {Format::kRgba8, Format::kBc1}) {
      const auto d = descriptor(21, 10, format, layout);
      for (int k = 0; k < d.levels; ++k) {
        const LevelAddresses all = level_addresses(d, k);
        const int width = level_size(d.width, k), height = level_size(d.height, k);
        ASSERT_EQ(all.column.size(), static_cast<std::size_t>(width)) << k;
        ASSERT_EQ(all.row.size(), static_cast<std::size_t>(height)) << k;
        for (int y = 0; y < height; ++y)
          for (int x = 0; x < width; ++x)
            EXPECT_EQ(
                all.column[static_cast<std::size_t>(x)] + all.row[static_cast<std::size_t>(y)],
                texel_address(d, k, x, y));
      }
    }
  }
}

TEST(Address, WrapsAt32Bits) {
  auto d = descriptor(64, 64, Format::kRgba8, Layout::kLinear);
  d.base[0] = 0xFFFFFFC0;
  EXPECT_EQ(texel_address(d, 0, 16, 0), 0u);
}

TEST(Descriptor, EachInvalidFieldIsNamed) {
  const auto good = descriptor(100, 50, Format::kRgb565, Layout::kTiled);
  ASSERT_EQ(descriptor_fault(good, kNone), nullptr);
  const auto fault = [&](auto&& change, spec::texture::Decode decode = kNone) {
    spec::texture::Descriptor d = good;
    change(d);
    const char* text = descriptor_fault(d, decode);
    EXPECT_EQ(valid(d, decode), text == nullptr);
    return std::string(text == nullptr ? "" : text);
  };
  using D = spec::texture::Descriptor;
  EXPECT_EQ(fault([](D& d) { d.width = 0; }), "width or height is zero");
  EXPECT_EQ(fault([](D& d) { d.height = 0; }), "width or height is zero");
  EXPECT_EQ(fault([](D& d) { d.width = 4097; }), "width or height is over 4096");
  EXPECT_EQ(fault([](D& d) { d.height = 65535; }), "width or height is over 4096");
  EXPECT_EQ(fault([](D& d) { d.levels = 0; }), "no level");
  EXPECT_EQ(fault([](D& d) { d.levels = 8; }), "more levels than the size allows");
  EXPECT_EQ(fault([](D& d) { d.format = static_cast<Format>(12); }), "unknown format");
  EXPECT_EQ(fault([](D& d) { d.format = static_cast<Format>(15); }, kAfter), "unknown format");
  EXPECT_EQ(fault([](D& d) { d.layout = static_cast<Layout>(2); }), "unknown layout");
  EXPECT_EQ(fault([](D& d) { d.wrap_s = static_cast<spec::texture::Wrap>(3); }),
            "unknown wrap mode");
  EXPECT_EQ(fault([](D& d) { d.wrap_t = static_cast<spec::texture::Wrap>(3); }),
            "unknown wrap mode");
  EXPECT_EQ(fault([](D& d) { d.min_filter = static_cast<spec::texture::MinFilter>(6); }),
            "unknown filter");
  EXPECT_EQ(fault([](D& d) { d.mag_filter = static_cast<spec::texture::MagFilter>(2); }),
            "unknown filter");
  EXPECT_EQ(fault([](D& d) { d.max_anisotropy_log2 = 5; }), "N_max is over 16");
  EXPECT_EQ(fault([](D& d) { d.base[6] += 32; }), "the base of a level is not a multiple of 64");
  constexpr const char* kCompressed = "the format is compressed, and decode is none";
  constexpr const char* kSrgb = "srgb is set, which only bc1, bc3 and etc2 have";
  for (std::uint8_t code = 0; code < 12; ++code) {
    const auto set = [code](D& d) { d.format = static_cast<Format>(code); };
    const auto set_srgb = [code](D& d) { d.format = static_cast<Format>(code), d.srgb = true; };
    EXPECT_EQ(fault(set), code < 5 ? "" : kCompressed);
    EXPECT_EQ(fault(set, kAfter), "");
    EXPECT_EQ(fault(set_srgb), code < 5 ? kSrgb : kCompressed);
    const bool may_be = code == 5 || code == 6 || code > 8;
    EXPECT_EQ(fault(set_srgb, kAfter), may_be ? "" : kSrgb);
  }
  // Valid: all levels, fewer levels, an unaligned base of a level that does not exist.
  EXPECT_EQ(fault([](D& d) { d.levels = 7; }), "");
  EXPECT_EQ(fault([](D& d) { d.levels = 1; }), "");
  EXPECT_EQ(fault([](D& d) { d.base[7] = 1; }), "");
  EXPECT_EQ(fault([](D& d) { d.width = d.height = 4096, d.levels = 13; }), "");
  EXPECT_EQ(fault([](D& d) { d.min_lod = 65535, d.max_lod = 0, d.lod_bias = -32768; }), "");
}

}  // namespace
}  // namespace deburr::address_test
