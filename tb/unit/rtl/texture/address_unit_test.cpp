// SPDX-License-Identifier: MIT
// The AddressUnit: what its blocks take together.
#include "rtl_model/texture/address_unit.h"

#include "tb/unit/rtl/texture/support.h"

namespace deburr::tb::texture_rtl {
namespace {

using namespace rtl::texture;

TEST(TextureRtlAddressUnit, LatencyByRule) {
  ClockDomain clock("clock", period());
  rtl::LatencyProbe probe;
  struct Row {
    std::string name;
    spec::texture::FootprintRule footprint;
    spec::texture::Log2Rule log2;
    Cycle latency;
  };
  // 3 + 2 + 1 + 3 + 3 + 5; the root takes 17 more than a shift and an addition, a correction two.
  const std::vector<Row> rows = {
      {"half", spec::texture::FootprintRule::kHalf, spec::texture::Log2Rule::kMitchell, 17},
      {"corrected", spec::texture::FootprintRule::kHalf, spec::texture::Log2Rule::kCorrected, 19},
      {"exact_log2", spec::texture::FootprintRule::kHalf, spec::texture::Log2Rule::kExact, 19},
      {"exact", spec::texture::FootprintRule::kExact, spec::texture::Log2Rule::kMitchell, 34}};
  struct Bench {
    Bench(ClockDomain& domain, const Row& row, rtl::LatencyProbe& latency)
        : quads((row.name + "_quads").c_str()),
          texels((row.name + "_texels").c_str()),
          store(domain, row.name + "_"),
          unit(row.name.c_str(), domain, parameters(row), store.control, store.descriptors,
               latency) {
      unit.quads_in(quads);
      unit.texels_out(texels);
    }
    static spec::texture::Parameters parameters(const Row& row) {
      spec::texture::Parameters p;
      p.footprint = row.footprint;
      p.log2 = row.log2;
      return p;
    }
    Link<spec::texture::Quad> quads;
    Link<TexelToken> texels;
    Store store;
    AddressUnit unit;
  };
  std::vector<std::unique_ptr<Bench>> benches;
  for (const Row& row : rows) {
    benches.push_back(std::make_unique<Bench>(clock, row, probe));
    benches.back()->quads.push(0, {});
  }
  clock.run(1);
  const Cycle taken = 1;
  for (std::size_t i = 0; i < rows.size(); ++i)
    EXPECT_EQ(ready_at(clock, benches[i]->texels), taken + rows[i].latency) << rows[i].name;
}

}  // namespace
}  // namespace deburr::tb::texture_rtl
