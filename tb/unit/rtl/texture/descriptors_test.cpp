// SPDX-License-Identifier: MIT
// The Descriptors: they follow the registers, and each block reads through its own port.
#include "rtl_model/texture/descriptors.h"

#include <array>

#include "spec/error.h"
#include "tb/unit/rtl/texture/support.h"

namespace deburr::tb::texture_rtl::descriptors_test {
namespace {

spec::texture::Descriptor some_texture() {
  spec::texture::Descriptor d;
  d.width = 64;
  d.height = 16;
  d.levels = 3;
  return d;
}

TEST(TextureRtlDescriptors, FollowTheRegisters) {
  ClockDomain clock("clock", period());
  Store store(clock);
  auto read = store.descriptors.for_levels;
  EXPECT_FALSE(read.read(1, 3).valid);
  write_descriptor(store.bus, 3, some_texture());
  const rtl::texture::TextureState& t = read.read(2, 3);
  EXPECT_TRUE(t.valid);
  EXPECT_EQ(t.level[2].width, 16);
  EXPECT_EQ(t.level[2].height, 4);
  EXPECT_FALSE(read.read(3, 2).valid);
  EXPECT_FALSE(read.read(4, 16).valid);  // no such handle
  clock.set_reset_n(false);
  clock.run(1);
  EXPECT_FALSE(read.read(5, 3).valid);
}

// Level clamps are U8.8, shown with 12 fraction bits: no bit of them is lost.
TEST(TextureRtlDescriptors, ClampsHaveAllTheirBits) {
  ClockDomain clock("clock", period());
  Store store(clock);
  auto read = store.descriptors.for_levels;
  rtl::Cycle cycle = 0;
  for (int bit = 0; bit < 16; ++bit) {
    spec::texture::Descriptor d = some_texture();
    d.min_lod = static_cast<std::uint16_t>(1u << bit);
    d.max_lod = static_cast<std::uint16_t>(1u << (15 - bit));
    write_descriptor(store.bus, 3, d);
    const rtl::texture::TextureState& t = read.read(++cycle, 3);
    EXPECT_EQ(t.min_lod, 1 << (bit + 4));
    EXPECT_EQ(t.max_lod, 1 << (15 - bit + 4));
  }
}

// Levels end at 1 x 1, whichever side is longer; tiles that a side fills exactly count once.
TEST(TextureRtlDescriptors, EveryLevelHasItsSizeAndItsTiles) {
  ClockDomain clock("clock", period());
  Store store(clock);
  auto read = store.descriptors.for_levels;
  rtl::Cycle cycle = 0;
  for (const bool high : {false, true}) {
    spec::texture::Descriptor d = some_texture();
    d.width = high ? 64 : 128;
    d.height = high ? 128 : 64;
    d.levels = 8;
    write_descriptor(store.bus, 3, d);
    const rtl::texture::TextureState& t = read.read(++cycle, 3);
    ASSERT_TRUE(t.valid);
    // RGBA8 in tiles of 4 x 4.
    const std::array<int, 8> shorter = {64, 32, 16, 8, 4, 2, 1, 1},
                             lb_tiles = {4, 3, 2, 1, 0, 0, 0, 0};
    for (std::size_t k = 0; k < 8; ++k) {
      EXPECT_EQ(high ? t.level[k].width : t.level[k].height, shorter[k]) << k;
      EXPECT_EQ(high ? t.level[k].height : t.level[k].width, 128 >> k) << k;
      EXPECT_EQ(t.level[k].mixed_log2, lb_tiles[k]) << k;
    }
  }
}

// A row or a column of texels is a texture.
TEST(TextureRtlDescriptors, OneTexelIsEnoughOfASide) {
  ClockDomain clock("clock", period());
  Store store(clock);
  auto read = store.descriptors.for_levels;
  rtl::Cycle cycle = 0;
  for (const auto& [width, height, levels] :
       {std::array<std::uint8_t, 3>{64, 1, 7}, {1, 64, 7}, {1, 1, 1}}) {
    spec::texture::Descriptor d = some_texture();
    d.width = width;
    d.height = height;
    d.levels = levels;
    write_descriptor(store.bus, 3, d);
    EXPECT_TRUE(read.read(++cycle, 3).valid) << d.width << " x " << d.height;
  }
}

// A tile that a side fills in part counts as a whole one.
TEST(TextureRtlDescriptors, TilesAreRoundedUp) {
  ClockDomain clock("clock", period());
  Store store(clock);
  auto read = store.descriptors.for_levels;
  rtl::Cycle cycle = 0;
  const std::array<std::uint16_t, 7> sides = {1, 4, 5, 8, 9, 16, 17};
  const std::array<int, 7> lb_tiles = {0, 0, 1, 1, 2, 2, 3};  // of 4 x 4 texels
  for (std::size_t i = 0; i < sides.size(); ++i)
    for (const bool high : {false, true}) {
      spec::texture::Descriptor d = some_texture();
      d.width = high ? sides[i] : std::uint16_t{256};
      d.height = high ? std::uint16_t{256} : sides[i];
      d.levels = 1;
      write_descriptor(store.bus, 3, d);
      EXPECT_EQ(read.read(++cycle, 3).level[0].mixed_log2, lb_tiles[i]) << sides[i] << high;
    }
}

// Rows of a linear level begin at multiples of 64 bytes.
TEST(TextureRtlDescriptors, RowsBeginAtMultiplesOf64Bytes) {
  ClockDomain clock("clock", period());
  Store store(clock);
  auto read = store.descriptors.for_levels;
  rtl::Cycle cycle = 0;
  for (const auto& [width, pitch] : {std::array<std::uint16_t, 2>{1, 64},
                                     {63, 64},
                                     {64, 64},
                                     {65, 128},
                                     {128, 128},
                                     {129, 192}}) {
    spec::texture::Descriptor d = some_texture();
    d.format = spec::texture::Format::kL8;
    d.layout = spec::texture::Layout::kLinear;
    d.width = width;
    d.levels = 1;
    write_descriptor(store.bus, 3, d);
    EXPECT_EQ(read.read(++cycle, 3).level[0].pitch, pitch) << width;
  }
}

// Each register by itself, that of the first texture's SIZE too.
TEST(TextureRtlDescriptors, FollowEveryRegister) {
  namespace reg = spec::texture::reg;
  ClockDomain clock("clock", period());
  Store store(clock);
  auto read = store.descriptors.for_levels;
  rtl::Cycle cycle = 0;
  for (const std::uint8_t handle : {std::uint8_t{0}, std::uint8_t{15}}) {
    write_descriptor(store.bus, handle, some_texture());
    const std::uint32_t at = reg::kTextureBase + handle * reg::kTextureStride;
    store.bus.write(at + reg::kSize, 32 | 8 << 16);
    EXPECT_EQ(read.read(++cycle, handle).width, 32) << +handle;
    EXPECT_EQ(read.read(++cycle, handle).height, 8) << +handle;
    store.bus.write(at + reg::kLodBias, 3);
    EXPECT_EQ(read.read(++cycle, handle).bias, 3 * 16) << +handle;
    store.bus.write(at + reg::kLevelBase + 4 * (spec::texture::kMaxLevels - 1), 64);
    store.bus.write(at + reg::kLevelBase + 8, 128);
    EXPECT_EQ(read.read(++cycle, handle).level[2].base, 128u) << +handle;
  }
}

// What MODE has no name for changes nothing.
TEST(TextureRtlDescriptors, OtherBitsOfModeDoNotMatter) {
  namespace reg = spec::texture::reg;
  ClockDomain clock("clock", period());
  Store store(clock);
  auto read = store.descriptors.for_levels;
  rtl::Cycle cycle = 0;
  const std::uint32_t mode = reg::kTextureBase + 3 * reg::kTextureStride + reg::kMode;
  for (const auto layout : {spec::texture::Layout::kLinear, spec::texture::Layout::kTiled}) {
    spec::texture::Descriptor d = some_texture();
    d.layout = layout;
    write_descriptor(store.bus, 3, d);
    store.bus.write(mode, store.bus.read(mode) | 0xF80E80E8);
    const rtl::texture::TextureState& t = read.read(++cycle, 3);
    EXPECT_TRUE(t.valid);
    EXPECT_EQ(t.layout, layout);
    EXPECT_EQ(t.levels, 3);
    EXPECT_EQ(t.format, d.format);
    EXPECT_EQ(t.wrap_s, d.wrap_s);
    EXPECT_EQ(t.mag_filter, d.mag_filter);
    EXPECT_EQ(t.max_count_log2, d.max_anisotropy_log2);
  }
}

TEST(TextureRtlDescriptors, OneReadAClockAndPort) {
  ClockDomain clock("clock", period());
  Store store(clock);
  auto levels = store.descriptors.for_levels, texels = store.descriptors.for_texels;
  levels.read(1, 3);
  texels.read(1, 3);
  EXPECT_THROW(levels.read(1, 4), spec::CheckFailed);
  levels.read(2, 4);
}

}  // namespace
}  // namespace deburr::tb::texture_rtl::descriptors_test
