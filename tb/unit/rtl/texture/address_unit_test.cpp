// SPDX-License-Identifier: MIT
// The AddressUnit: what its blocks take together.
#include "rtl_model/texture/address_unit.h"

#include "tb/unit/rtl/texture/support.h"

namespace deburr::tb::texture_rtl {
namespace {

using namespace rtl::texture;

TEST(TextureRtlAddressUnit, LatencyIsSevenAndWithExactTwentyTwo) {
  ClockDomain clock("clock", period());
  Store store(clock);
  FragmentProbe probe(256);
  for (const bool exact : {false, true}) {
    spec::texture::Parameters p;
    if (exact) p.footprint = spec::texture::FootprintRule::kExact;
    // Each stays to the end of the simulation, as modules must.
    auto* unit = new AddressUnit(exact ? "exact" : "half", clock, p, store.store, probe);
    auto* quads = new Link<spec::texture::Quad>(exact ? "exact_quads" : "half_quads");
    auto* texels = new Link<TexelToken>(exact ? "exact_texels" : "half_texels");
    unit->quads_in(*quads);
    unit->texels_out(*texels);
    quads->push(0, {});
    if (!exact) continue;
    clock.run(1);
    const Cycle taken = 1;
    const auto* half = dynamic_cast<Link<TexelToken>*>(sc_core::sc_find_object("half_texels"));
    EXPECT_EQ(ready_at(clock, *half), taken + 7);
    EXPECT_EQ(ready_at(clock, *texels), taken + 22);
  }
}

}  // namespace
}  // namespace deburr::tb::texture_rtl
