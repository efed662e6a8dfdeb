// SPDX-License-Identifier: MIT
// The TexelAddresser alone: its cycles. Values are compared in equivalence_test.cpp.
#include "rtl_model/texture/texel_addresser.h"

#include "tb/unit/rtl/datasheets.h"
#include "tb/unit/rtl/texture/support.h"

namespace deburr::tb::texture_rtl::texel_addresser_test {
namespace {

using namespace rtl::texture;

TEST(TextureRtlAddresser, LatencyMatchesDatasheetWithOneRequestPerCycle) {
  ClockDomain clock("clock", period());
  Store store(clock);
  TexelAddresser unit("unit", clock, store.descriptors.for_texels);
  Ends<SampleToken, TexelToken> ends(clock);
  unit.samples_in(ends.in);
  unit.texels_out(ends.out);
  for (int i = 0; i < 5; ++i) ends.source.add({});
  ends.sink.hold_from = 9;
  ends.sink.hold_to = 12;
  clock.run(20);
  const Cycle first = 1 + TexelAddresser::datasheet().latency.cycles;  // pushed in 0, taken in 1
  EXPECT_THAT(cycles_of(ends.sink), testing::ElementsAre(first, first + 1, first + 2, 12, 13));
  EXPECT_EQ(unit.bilinears.value(), 0u);  // their tickets are not valid
}

// 6 x 6 texels in 2 x 2 blocks of BC1: columns 5 and 0, which repeat, and rows 3 and 4.
TEST(TextureRtlAddresser, GivesBlocksAndPlacesInThem) {
  spec::texture::Build build;
  build.decode = spec::texture::Decode::kAfter;
  ClockDomain clock("clock", period());
  Store store(clock, "", build);
  spec::texture::Descriptor d;
  d.width = d.height = 6;
  d.levels = 1;
  d.format = spec::texture::Format::kBc1;
  d.srgb = true;
  d.layout = spec::texture::Layout::kLinear;
  write_descriptor(store.bus, 0, d);
  TexelAddresser unit("unit", clock, store.descriptors.for_texels);
  Ends<SampleToken, TexelToken> ends(clock);
  unit.samples_in(ends.in);
  unit.texels_out(ends.out);
  SampleToken sample{};
  sample.ticket = ticket();
  sample.t = spec::texture::kCoordinateOne * 2 / 3;
  sample.linear = true;
  ends.source.add(sample);
  d.format = spec::texture::Format::kRgba8;
  d.srgb = false;
  write_descriptor(store.bus, 1, d);
  sample.ticket.texture = 1;
  ends.source.add(sample);
  clock.run(20);
  ASSERT_EQ(ends.sink.taken.size(), 2u);
  const TexelToken &blocks = ends.sink.taken[0].token, &texels = ends.sink.taken[1].token;
  EXPECT_THAT(blocks.address, testing::ElementsAre(8, 0, 64 + 8, 64));
  EXPECT_THAT(blocks.turned, testing::ElementsAre(false, true));
  EXPECT_EQ(blocks.control.codec, 1);
  EXPECT_EQ(blocks.control.within, 1 | 0 << 2 | 3 << 4 | 0 << 6);
  EXPECT_EQ(blocks.control.format, static_cast<int>(spec::texture::Format::kSrgb8A8));
  EXPECT_EQ(texels.control.codec, 0);
  EXPECT_THAT(texels.address, testing::ElementsAre(192 + 20, 192, 256 + 20, 256));
  EXPECT_THAT(texels.turned, testing::ElementsAre(true, false));
}

}  // namespace
}  // namespace deburr::tb::texture_rtl::texel_addresser_test
