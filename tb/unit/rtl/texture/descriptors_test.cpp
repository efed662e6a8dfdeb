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
