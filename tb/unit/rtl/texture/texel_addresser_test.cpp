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

}  // namespace
}  // namespace deburr::tb::texture_rtl::texel_addresser_test
