// SPDX-License-Identifier: MIT
// Textures in memory and descriptors in registers, compared with docs/reference/texture/formats.md
// ("Addresses") and docs/reference/texture/index.md by hand, and the inputs that the driver of the
// texture unit rejects.
#include "rtl_model/platform/texture_driver.h"

#include "spec/texture/registers.h"
#include "tb/unit/platform/fakes.h"

namespace deburr::tb::texture_driver_test {
namespace {

using platform::Texel;
using platform::TexelLayout;
using platform::TextureDriver;
using spec::texture::Descriptor;
using spec::texture::Format;
using spec::texture::Layout;
using testing::ElementsAre;
using testing::HasSubstr;
namespace reg = spec::texture::reg;

// ---- Records -----------------------------------------------------------------------------------

TEST(TexelLayout, RowsBeginAtMultiplesOf64Bytes) {
  const TexelLayout words(Layout::kLinear, Format::kRgba8, 17, 5),
      bytes(Layout::kLinear, Format::kL8, 64, 3);
  EXPECT_EQ(words.bytes(), 640u);
  EXPECT_EQ(words.offset_of(16, 0), 64u);
  EXPECT_EQ(words.offset_of(3, 4), 4u * 128 + 12);
  EXPECT_EQ(bytes.bytes(), 192u);
  EXPECT_EQ(bytes.offset_of(63, 2), 191u);
  EXPECT_EQ(TexelLayout(Layout::kLinear, Format::kRgb565, 33, 1).bytes(), 128u);
}

TEST(TexelLayout, TilesHold64BytesRowByRow) {
  const TexelLayout words(Layout::kTiled, Format::kSrgb8A8, 4, 4),
      halves(Layout::kTiled, Format::kRgba4444, 8, 4), bytes(Layout::kTiled, Format::kL8, 8, 8);
  EXPECT_EQ(words.offset_of(3, 2), 4u * 11);
  EXPECT_EQ(halves.offset_of(7, 3), 62u);
  EXPECT_EQ(bytes.offset_of(5, 6), 53u);
  for (const TexelLayout* layout : {&words, &halves, &bytes}) EXPECT_EQ(layout->bytes(), 64u);
}

// 8 x 2 tiles: one row bit between two column bits, the remaining column bits above.
TEST(TexelLayout, TilesFollowMortonOrder) {
  const TexelLayout wide(Layout::kTiled, Format::kRgba8, 32, 8),
      high(Layout::kTiled, Format::kRgba8, 8, 32);
  std::vector<std::uint32_t> across, down;
  for (int tile = 0; tile < 8; ++tile) across.push_back(wide.offset_of(4 * tile, 4) / 64);
  for (int tile = 0; tile < 8; ++tile) down.push_back(high.offset_of(4, 4 * tile) / 64);
  EXPECT_THAT(across, ElementsAre(2, 3, 6, 7, 10, 11, 14, 15));
  EXPECT_THAT(down, ElementsAre(1, 3, 5, 7, 9, 11, 13, 15));
  EXPECT_EQ(wide.bytes(), 1024u);
  // Five tiles take the space of eight, three that of four.
  EXPECT_EQ(TexelLayout(Layout::kTiled, Format::kRgba8, 17, 9).bytes(), 64u * 8 * 4);
}

// The code whose channel is closest to a byte: 255 c / top, with 4, 5 and 6 bits.
TEST(EncodeTexel, NarrowChannelsUseNearestCode) {
  for (std::uint32_t byte = 0; byte < 256; ++byte) {
    const auto channel = static_cast<std::uint8_t>(byte);
    const auto nearest = [&](std::uint32_t top) {
      std::uint32_t code = 0;
      while (code < top && 510 * code + 255 < 2 * byte * top) ++code;
      return code;
    };
    const auto code = [&](Format format, std::size_t which) {
      Texel texel{};
      texel[which] = channel;
      return platform::encode_texel(format, texel);
    };
    ASSERT_EQ(code(Format::kRgb565, 0), nearest(31) << 11) << byte;
    ASSERT_EQ(code(Format::kRgb565, 1), nearest(63) << 5) << byte;
    ASSERT_EQ(code(Format::kRgb565, 2), nearest(31)) << byte;
    ASSERT_EQ(code(Format::kRgb565, 3), 0u) << byte;
    for (std::size_t which = 0; which < 4; ++which)
      ASSERT_EQ(code(Format::kRgba4444, which), nearest(15) << (12 - 4 * which)) << byte;
  }
}
// L is 0.299 R + 0.587 G + 0.114 B in 1/256, rounded.
TEST(EncodeTexel, LuminanceIsWeighted) {
  const auto code = [](std::uint8_t r, std::uint8_t g, std::uint8_t b) {
    return platform::encode_texel(Format::kL8, {r, g, b, 77});
  };
  for (int grey = 0; grey < 256; ++grey) {
    const auto v = static_cast<std::uint8_t>(grey);
    EXPECT_EQ(code(v, v, v), v) << "grey stays grey";
  }
  EXPECT_EQ(code(255, 0, 0), 77u) << "76.7";
  EXPECT_EQ(code(0, 255, 0), 149u) << "149.4";
  EXPECT_EQ(code(0, 0, 255), 29u) << "28.9";
  EXPECT_EQ(code(0, 1, 0), 1u) << "0.59";
  EXPECT_EQ(code(1, 0, 0), 0u) << "0.3";
  EXPECT_EQ(code(0, 64, 0), 38u) << "37.5 in 1/256";
  EXPECT_EQ(code(1, 43, 0), 25u) << "25.496 in 1/256";
}
TEST(EncodeTexel, FullBytesKeepTheirOrder) {
  for (const Format format : {Format::kRgba8, Format::kSrgb8A8})
    EXPECT_EQ(platform::encode_texel(format, {1, 2, 3, 4}), 0x04030201u);
}

TEST(TextureMemory, PlacesLevelsConsecutively) {
  const std::vector<Texel> large(16, Texel{1, 2, 3, 4}), small(4, Texel{5, 6, 7, 8});
  const platform::TextureLevel levels[] = {{4, 4, large}, {2, 2, small}};
  platform::TextureMemory textures;
  EXPECT_EQ(textures.add(levels, {}), 0);
  EXPECT_EQ(textures.add(levels, {}), 1);
  const Descriptor& d = textures.descriptors()[1];
  EXPECT_EQ(d.width, 4);
  EXPECT_EQ(d.height, 4);
  EXPECT_EQ(d.levels, 2);
  EXPECT_EQ(d.base[0], 256u);
  EXPECT_EQ(d.base[1], 384u);
  EXPECT_EQ(textures.bytes().size(), 512u);
  EXPECT_EQ(textures.bytes()[256 + 60], 1);
  EXPECT_EQ(textures.bytes()[384 + 16 + 4 + 3], 8) << "second texel of the second row";
  EXPECT_EQ(textures.bytes()[384 + 8], 0);
}

// A level ends at the next multiple of 128 bytes; one that ends there leaves no gap.
TEST(TextureMemory, LevelBeginsAtMultipleOf128Bytes) {
  const std::vector<Texel> texels(64, Texel{1, 2, 3, 4});
  const auto level = [&](int width, int height) {
    return platform::TextureLevel{
        width, height, std::span(texels).first(static_cast<std::size_t>(width * height))};
  };
  // 256, 64 and 64 bytes; 64 bytes of L8.
  const platform::TextureLevel large[] = {level(8, 8), level(4, 4), level(2, 2)},
                               small[] = {level(8, 8)};
  platform::TextureMemory textures;
  textures.add(large, {});
  EXPECT_EQ(textures.bytes().size(), 512u);
  Descriptor bytes;
  bytes.format = Format::kL8;
  textures.add(small, bytes);
  EXPECT_THAT(std::span(textures.descriptors()[0].base).first(3), ElementsAre(0u, 256u, 384u));
  EXPECT_EQ(textures.descriptors()[1].base[0], 512u);
  EXPECT_EQ(textures.bytes().size(), 640u);
}

// 20 x 6 texels: 5 x 2 blocks. By hand: rows of 40 or 80 bytes, padded to multiples of 64; Morton
// order of 8 x 2 blocks, of which only the lowest bits interleave.
TEST(TextureMemory, BlocksTakePlacesOfTexels) {
  using spec::texture::Layout;
  const platform::TexelLayout rows(Layout::kLinear, Format::kBc1, 20, 6),
      large_rows(Layout::kLinear, Format::kEtc2Rgba8, 20, 6),
      tiles(Layout::kTiled, Format::kBc4, 20, 6), large_tiles(Layout::kTiled, Format::kBc3, 20, 6);
  EXPECT_EQ(rows.offset_of(19, 3), 32u);
  EXPECT_EQ(rows.offset_of(15, 4), 64u + 24);
  EXPECT_EQ(rows.bytes(), 128u);
  EXPECT_EQ(large_rows.offset_of(19, 5), 128u + 64);
  EXPECT_EQ(large_rows.bytes(), 256u);
  EXPECT_EQ(tiles.offset_of(4, 0), 8u);
  EXPECT_EQ(tiles.offset_of(3, 4), 16u);
  EXPECT_EQ(tiles.offset_of(8, 0), 32u);
  EXPECT_EQ(tiles.offset_of(19, 5), 64u + 16);
  EXPECT_EQ(tiles.bytes(), 16u * 8);
  EXPECT_EQ(large_tiles.offset_of(19, 5), 2 * (64u + 16));
  EXPECT_EQ(large_tiles.bytes(), 16u * 16);
  EXPECT_EQ(platform::TexelLayout(Layout::kTiled, Format::kBc1, 1, 1).bytes(), 8u);
}

TEST(TextureMemory, TakesBlocksRowByRow) {
  std::vector<std::uint8_t> large(10 * 8), small(3 * 8);
  for (std::size_t i = 0; i < large.size(); ++i) large[i] = static_cast<std::uint8_t>(i);
  for (std::size_t i = 0; i < small.size(); ++i) small[i] = static_cast<std::uint8_t>(100 + i);
  const platform::BlockLevel levels[] = {{20, 6, large}, {10, 3, small}};
  platform::TextureMemory textures;
  Descriptor d;
  d.format = Format::kEtc2Rgb;
  d.layout = spec::texture::Layout::kLinear;
  EXPECT_EQ(textures.add(levels, d), 0);
  d.layout = spec::texture::Layout::kTiled;
  EXPECT_EQ(textures.add(levels, d), 1);
  EXPECT_EQ(textures.descriptors()[1].levels, 2);
  EXPECT_EQ(textures.descriptors()[1].width, 20);
  EXPECT_THAT(std::span(textures.descriptors()[1].base).first(2), ElementsAre(256u, 384u));
  const auto byte = [&](std::size_t at) { return textures.bytes()[at]; };
  EXPECT_EQ(byte(32 + 7), 4 * 8 + 7) << "the last block of the first row";
  EXPECT_EQ(byte(40), 0);
  EXPECT_EQ(byte(64 + 8), 6 * 8) << "the second row";
  EXPECT_EQ(byte(128 + 16 + 7), 123);
  EXPECT_EQ(byte(256 + 16), 5 * 8) << "row 1 of the tiled one";
  EXPECT_EQ(byte(256 + 64 + 16 + 7), 79);
  EXPECT_EQ(byte(384 + 16), 116) << "one row of blocks: in order";
  EXPECT_EQ(textures.bytes().size(), 512u);
}

TEST(TextureMemory, RejectsBlocksAndTexelsOfTheOtherKind) {
  const std::vector<Texel> texels(16);
  const std::vector<std::uint8_t> bytes(16);
  const auto rejection = [&](const auto& level, Format format) {
    platform::TextureMemory textures;
    Descriptor d;
    d.format = format;
    return error_of<spec::ConfigError>([&] { textures.add(std::span(&level, 1), d); });
  };
  EXPECT_EQ(rejection(platform::TextureLevel{4, 4, texels}, Format::kBc1),
            "mip level 0 has texels, but bc1 has blocks: encode the level first");
  EXPECT_EQ(rejection(platform::BlockLevel{4, 4, bytes}, Format::kRgba8),
            "mip level 0 has blocks, but rgba8 has none");
  EXPECT_EQ(rejection(platform::BlockLevel{4, 4, bytes}, Format::kBc5), "");
  EXPECT_EQ(rejection(platform::BlockLevel{5, 4, bytes}, Format::kBc1), "");
  EXPECT_EQ(rejection(platform::BlockLevel{4, 4, bytes}, Format::kBc1),
            "mip level 0 of 4 x 4 texels has 16 bytes, but 1 x 1 blocks of bc1 have 8");
  EXPECT_EQ(rejection(platform::BlockLevel{5, 4, bytes}, Format::kBc3),
            "mip level 0 of 5 x 4 texels has 16 bytes, but 2 x 1 blocks of bc3 have 32");
  EXPECT_EQ(rejection(platform::BlockLevel{0, 4, bytes}, Format::kBc3),
            "texture of 0 x 4 texels: each side must be 1 to 4096");
}

TEST(TextureMemory, RejectsEmptyAndOversizedSides) {
  const std::vector<Texel> texels(4097);
  const auto rejection = [&](int width, int height) {
    const platform::TextureLevel level[] = {
        {width, height, std::span(texels).first(static_cast<std::size_t>(width * height))}};
    platform::TextureMemory textures;
    return error_of<spec::ConfigError>([&] { textures.add(level, {}); });
  };
  EXPECT_EQ(rejection(0, 4), "texture of 0 x 4 texels: each side must be 1 to 4096");
  EXPECT_EQ(rejection(4, 0), "texture of 4 x 0 texels: each side must be 1 to 4096");
  EXPECT_EQ(rejection(4097, 1), "texture of 4097 x 1 texels: each side must be 1 to 4096");
  EXPECT_EQ(rejection(4096, 1), "");
  EXPECT_EQ(rejection(1, 1), "");
}

// ---- Driver ------------------------------------------------------------------------------------

struct Bed {
  Bed() {
    registers.values[reg::kId] = 0xDEB00002;
    registers.values[reg::kStatus] = 1;
  }
  FakeRegisters registers;
  FakeMemory memory{4096};
  TextureDriver driver{registers, memory};
};

// 16 x 8 texels, two levels of 512 and 128 bytes.
Descriptor valid() {
  Descriptor d;
  d.width = 16;
  d.height = 8;
  d.levels = 2;
  d.base[1] = 512;
  return d;
}

std::string rejection(const Descriptor& d, int handle = 0) {
  Bed b;
  const std::string text = error_of<spec::ConfigError>([&] { b.driver.set_texture(handle, d); });
  EXPECT_EQ(b.registers.written.empty(), !text.empty());
  return text;
}

TEST(TextureDriver, WritesDescriptor) {
  Bed b;
  Descriptor d = valid();
  d.format = Format::kRgb565;
  d.wrap_s = spec::texture::Wrap::kClampToEdge;
  d.lod_bias = -2;
  b.driver.set_texture(3, d);
  ASSERT_EQ(b.registers.written.size(), 17u);
  using Write = std::pair<std::uint32_t, std::uint32_t>;
  EXPECT_EQ(b.registers.written[0], (Write{0x280, 16 | 8 << 16}));
  EXPECT_EQ(b.registers.written[1],
            (Write{0x284, 1u | 1u << 4 | 2u << 8 | 5u << 12 | 1u << 16 | 2u << 20}));
  EXPECT_EQ(b.registers.written[2], (Write{0x288, 0xFFFE}));
  EXPECT_EQ(b.registers.written[3], (Write{0x28C, 0x0C000000}));
  EXPECT_EQ(b.registers.written[5], (Write{0x294, 512}));
}

TEST(TextureDriver, LoadsInvalidatesAndReads) {
  Bed b;
  b.driver.identify();
  b.driver.load(std::vector<std::uint8_t>{1, 2, 3});
  EXPECT_THAT(b.memory.read(0, 4), ElementsAre(1, 2, 3, 0xEE));
  b.registers.values[reg::kControl] = 1;
  b.driver.invalidate();
  EXPECT_EQ(b.registers.values[reg::kControl], 3u);
  b.registers.values[reg::kControl] = 1;
  b.driver.clear_counters();
  EXPECT_EQ(b.registers.values[reg::kControl], 5u);
  for (std::uint32_t i = 0; i < 7; ++i) b.registers.values[reg::kFragments + 4 * i] = 10 + i;
  const platform::TextureWork work = b.driver.work();
  EXPECT_EQ(work.fragments, 10u);
  EXPECT_EQ(work.bilinears, 11u);
  EXPECT_EQ(work.line_fills, 12u);
  EXPECT_EQ(work.clamped, 13u);
  EXPECT_EQ(work.saturated, 14u);
  EXPECT_EQ(work.memory_errors, 15u);
  EXPECT_EQ(work.invalid_fragments, 16u);
  EXPECT_EQ(b.driver.memory_errors(), 15u);
}

TEST(TextureDriver, WritesNothingToBusyUnit) {
  Bed b;
  b.registers.values[reg::kStatus] = 0;
  EXPECT_EQ(error_of<spec::SimulationError>([&] { b.driver.set_texture(0, valid()); }),
            "driver of the texture unit: a descriptor while it is busy: wait until STATUS says "
            "idle");
  EXPECT_THAT(error_of<spec::SimulationError>([&] { b.driver.invalidate(); }),
              HasSubstr("an invalidate command while it is busy"));
  EXPECT_TRUE(b.registers.written.empty());
}

TEST(TextureDriver, RejectsUnsupportedDescriptors) {
  const auto with = [](auto&& change) {
    Descriptor d = valid();
    change(d);
    return rejection(d);
  };
  EXPECT_EQ(rejection(valid()), "");
  EXPECT_EQ(rejection(valid(), 15), "");
  EXPECT_EQ(rejection(valid(), 16),
            "driver of the texture unit: handle of a texture: expected 0..15, got 16");
  EXPECT_THAT(rejection(valid(), -1), HasSubstr("got -1"));
  EXPECT_THAT(with([](Descriptor& d) { d.width = 0; }),
              HasSubstr("width of a texture: expected 1..4096, got 0"));
  EXPECT_THAT(with([](Descriptor& d) { d.height = 0; }), HasSubstr("height of a texture"));
  EXPECT_THAT(with([](Descriptor& d) { d.height = 4097; }), HasSubstr("height of a texture"));
  EXPECT_THAT(with([](Descriptor& d) { d.levels = 0; }),
              HasSubstr("levels of a texture: expected 1..5, got 0"));
  EXPECT_THAT(with([](Descriptor& d) { d.levels = 6; }), HasSubstr("got 6"));
  EXPECT_THAT(
      with([](Descriptor& d) { d.base[1] = 544; }),
      HasSubstr("texture 0: region level 1 begins at 0x220, which is not a multiple of 64"));
  EXPECT_THAT(with([](Descriptor& d) { d.base[1] = 448; }),
              HasSubstr("texture 0: region level 0 (0x0 to 0x1ff) overlaps region level 1 (0x1c0 "
                        "to 0x23f)"));
  EXPECT_THAT(with([](Descriptor& d) { d.base[0] = 3648; }),
              HasSubstr("region level 0 (0xe40 to 0x103f) ends past the memory of 4096 bytes"));
  EXPECT_EQ(with([](Descriptor& d) { d.base[0] = 3584; }), "");
  EXPECT_EQ(with([](Descriptor& d) { d.base[2] = 7; }), "") << "unused level";
  EXPECT_EQ(with([](Descriptor& d) { d.width = d.height = d.levels = 1; }), "");
}

TEST(TextureDriver, RejectsTextureLargerThanMemory) {
  Bed b;
  EXPECT_THAT(error_of<spec::ConfigError>([&] { b.driver.load(std::vector<std::uint8_t>(4097)); }),
              HasSubstr("region textures (0x0 to 0x1000) ends past the memory of 4096 bytes"));
  EXPECT_NO_THROW(b.driver.load(std::vector<std::uint8_t>(4096)));
}

}  // namespace
}  // namespace deburr::tb::texture_driver_test
