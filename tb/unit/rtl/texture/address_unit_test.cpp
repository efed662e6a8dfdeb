// SPDX-License-Identifier: MIT
// The AddressUnit: total latency of its blocks.
#include "rtl_model/texture/address_unit.h"

#include "tb/unit/rtl/datasheets.h"
#include "tb/unit/rtl/texture/support.h"

namespace deburr::tb::texture_rtl::address_unit_test {
namespace {

using namespace rtl::texture;

TEST(TextureRtlAddressUnit, LatencyFollowsConfiguration) {
  ClockDomain clock("clock", period());
  rtl::LatencyProbe probe;
  using spec::texture::Axes;
  using spec::texture::CountRule;
  using spec::texture::FootprintRule;
  using spec::texture::Log2Rule;
  struct Row {
    std::string name;
    FootprintRule footprint;
    Log2Rule log2;
    Axes axes;
    std::int32_t axis_cycles;
    CountRule count;
    Cycle latency;
  };
  // 3 + 2 + 1 + 3 + 3 + 5. The root takes 17 more than a shift and an addition, a correction two;
  // directions take 8 instead of 2, or 22 instead of 19, and axis_cycles - 1; any count takes one.
  const auto kHalf = FootprintRule::kHalf, kExact = FootprintRule::kExact;
  const std::vector<Row> rows = {
      // the earliest first
      {"half", kHalf, Log2Rule::kMitchell, Axes::kTwo, 1, CountRule::kFloor, 17},
      {"ceil", kHalf, Log2Rule::kMitchell, Axes::kTwo, 1, CountRule::kCeil, 17},
      {"any", kHalf, Log2Rule::kMitchell, Axes::kTwo, 1, CountRule::kAny, 18},
      {"corrected", kHalf, Log2Rule::kCorrected, Axes::kTwo, 1, CountRule::kFloor, 19},
      {"exact_log2", kHalf, Log2Rule::kExact, Axes::kTwo, 1, CountRule::kFloor, 19},
      {"four", kHalf, Log2Rule::kMitchell, Axes::kFour, 1, CountRule::kFloor, 23},
      {"four_in_two", kHalf, Log2Rule::kMitchell, Axes::kFour, 2, CountRule::kFloor, 24},
      {"eight_in_four", kHalf, Log2Rule::kMitchell, Axes::kEight, 4, CountRule::kFloor, 26},
      {"exact", kExact, Log2Rule::kMitchell, Axes::kTwo, 1, CountRule::kFloor, 34},
      {"deburr", kExact, Log2Rule::kSegments, Axes::kEight, 1, CountRule::kAny, 40}};
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
      p.axes = row.axes;
      p.axis_cycles = row.axis_cycles;
      p.count = row.count;
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
  for (const Row& row : rows)
    expect_latency(AddressUnit::datasheet(Bench::parameters(row)), row.latency);
}

}  // namespace
}  // namespace deburr::tb::texture_rtl::address_unit_test
