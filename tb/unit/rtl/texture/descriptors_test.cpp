// SPDX-License-Identifier: MIT
// The Descriptors: they follow the registers, and each block reads through its own port.
#include "rtl_model/texture/descriptors.h"

#include "spec/error.h"
#include "tb/unit/rtl/texture/support.h"

namespace deburr::tb::texture_rtl {
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
}  // namespace deburr::tb::texture_rtl
