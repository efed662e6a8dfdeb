// SPDX-License-Identifier: MIT
// The Descriptors: they follow the registers, and each block reads through its own port. Decoding
// of registers is compared in equivalence_test.cpp, through the units that use it.
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

TEST(TextureRtlDescriptors, FollowRegisters) {
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
  EXPECT_FALSE(read.read(4, 16).valid);  // undefined handle
  clock.set_reset_n(false);
  clock.run(1);
  EXPECT_FALSE(read.read(5, 3).valid);
}

// A single row or column of texels is a valid texture.
TEST(TextureRtlDescriptors, AcceptTextureOneTexelWideOrHigh) {
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

// Each register alone, including SIZE of the first texture.
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
    EXPECT_EQ(read.read(++cycle, handle).level[2].row.front(), 128u) << +handle;
  }
}

// A format and `srgb`, of 0..15 and 0..1, are valid in a build with decoders and in one without.
TEST(TextureRtlDescriptors, AcceptBlocksOnlyWithDecoders) {
  spec::texture::Build with;
  with.decode = spec::texture::Decode::kAfter;
  for (const bool decoders : {false, true}) {
    ClockDomain clock("clock", period());
    Store store(clock, "", decoders ? with : spec::texture::Build{});
    auto read = store.descriptors.for_levels;
    rtl::Cycle cycle = 0;
    for (std::uint8_t format = 0; format < 16; ++format)
      for (const bool srgb : {false, true}) {
        spec::texture::Descriptor d = some_texture();
        d.format = static_cast<spec::texture::Format>(format);
        d.srgb = srgb;
        write_descriptor(store.bus, 3, d);
        // bc1 5, bc3 6, bc4 7, bc5 8, those of ETC2 9 to 11.
        const bool expected =
            format < 5 ? !srgb : decoders && format < 12 && (!srgb || (format != 7 && format != 8));
        const rtl::texture::TextureState& t = read.read(++cycle, 3);
        EXPECT_EQ(t.valid, expected) << +format << ' ' << srgb << ' ' << decoders;
        if (!t.valid) continue;
        EXPECT_EQ(t.codec, format < 5 ? 0 : format - 4);
        EXPECT_EQ(static_cast<int>(t.format), format < 5 ? format : srgb ? 4 : 0);
      }
  }
}

// Addresses of texels are those that software puts their blocks at.
TEST(TextureRtlDescriptors, AddressBlocksOfEveryLevel) {
  spec::texture::Build build;
  build.decode = spec::texture::Decode::kAfter;
  ClockDomain clock("clock", period());
  Store store(clock, "", build);
  auto read = store.descriptors.for_levels;
  rtl::Cycle cycle = 0;
  for (const auto format : {spec::texture::Format::kBc1, spec::texture::Format::kBc3})
    for (const auto layout : {spec::texture::Layout::kLinear, spec::texture::Layout::kTiled})
      for (const auto& [width, height] : {std::pair{64, 16}, {37, 61}, {3, 70}, {200, 5}}) {
        spec::texture::Descriptor d = some_texture();
        d.format = format;
        d.layout = layout;
        d.width = static_cast<std::uint16_t>(width);
        d.height = static_cast<std::uint16_t>(height);
        d.base[1] = 0x1000;
        write_descriptor(store.bus, 3, d);
        const rtl::texture::TextureState& t = read.read(++cycle, 3);
        for (int k = 0; k < 3; ++k) {
          const rtl::texture::LevelGeometry& level = t.level[static_cast<std::size_t>(k)];
          const platform::TexelLayout offsets = platform::texel_layout(d, k);
          for (int x = 0; x < level.width; ++x)
            for (int y = 0; y < level.height; ++y)
              ASSERT_EQ(level.column[static_cast<std::size_t>(x)] +
                            level.row[static_cast<std::size_t>(y)],
                        d.base[static_cast<std::size_t>(k)] + offsets.offset_of(x, y))
                  << x << ' ' << y << ' ' << k;
        }
      }
}

TEST(TextureRtlDescriptors, AllowOneReadPerCycleAndPort) {
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
