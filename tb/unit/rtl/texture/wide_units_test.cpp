// SPDX-License-Identifier: MIT
// The units of widths above 1 (docs/reference/texture/width.md) alone: groups, cycles and stalls by
// hand; values are those of the units of width 1 with the same tokens.
#include "rtl_model/texture/address_unit.h"
#include "rtl_model/texture/filter_pipeline.h"
#include "tb/base/random.h"
#include "tb/unit/rtl/datasheets.h"
#include "tb/unit/rtl/texture/support.h"

namespace deburr::tb::texture_rtl::wide_units_test {
namespace {

using namespace rtl::texture;
using testing::ElementsAre;

constexpr Cycle kHoldFrom = 30, kHold = 11;
// When a token can be taken that would be there in cycle `alone` if the sink had not held the
// output.
Cycle after_hold(Cycle alone) { return alone < kHoldFrom ? alone : alone + kHold; }

template <class Group, class Token>
Group group_of(const std::vector<Token>& tokens) {
  Group group{};
  group.count = static_cast<std::uint8_t>(tokens.size());
  std::copy(tokens.begin(), tokens.end(), group.at.begin());
  return group;
}
template <class Ends>
auto flat(const Ends& ends) {
  std::vector<std::remove_cvref_t<decltype(ends.sink.taken[0].token.at[0])>> all;
  for (const auto& taken : ends.sink.taken)
    all.insert(all.end(), taken.token.at.begin(), taken.token.at.begin() + taken.token.count);
  return all;
}
template <class Token>
void expect_same(const std::vector<Token>& narrow, const std::vector<Token>& wide) {
  ASSERT_EQ(narrow.size(), wide.size());
  ASSERT_FALSE(narrow.empty());
  for (std::size_t i = 0; i < narrow.size(); ++i)
    EXPECT_EQ(rtl::payload_difference(narrow[i], wide[i]), "") << i;
}

// ---- DerivativeUnit

struct DerivativeBench {
  DerivativeBench(ClockDomain& clock, const std::string& name, std::int32_t fragments)
      : store(clock, name),
        unit((name + "unit").c_str(), clock, store.control, store.descriptors.for_derivatives,
             probe, spec::texture::Derivatives::kFine, fragments),
        narrow((name + "narrow").c_str(), clock, store.control, store.descriptors.for_levels,
               narrow_probe),
        ends(clock, name),
        narrow_ends(clock, name + "narrow_") {
    unit.quads_in(ends.in);
    unit.derivatives_out(ends.out);
    narrow.quads_in(narrow_ends.in);
    narrow.derivatives_out(narrow_ends.out);
    spec::texture::Descriptor d;
    d.width = 256;
    d.height = 128;
    write_descriptor(store.bus, 0, d);
  }
  void add(std::uint8_t coverage) {
    spec::texture::Quad q;
    q.coverage = coverage;
    q.clamped = 3;
    for (std::size_t i = 0; i < 4; ++i)
      q.s[i] = static_cast<std::int32_t>(random.word()),
      q.t[i] = static_cast<std::int32_t>(random.word());
    ends.source.add(q);
    narrow_ends.source.add(q);
  }
  Random random{1};
  Store store;
  rtl::LatencyProbe probe, narrow_probe;
  wide::DerivativeUnit unit;
  DerivativeUnit narrow;
  Ends<spec::texture::Quad, FragmentGroup<DerivativeToken>> ends;
  Ends<spec::texture::Quad, DerivativeToken> narrow_ends;
};

// A quad with n covered lanes takes max(1, ceil(n / F)) cycles.
TEST(TextureRtlWide, DerivativeUnitAcceptsCoveredLanesOfOneQuad) {
  ClockDomain clock("clock", period());
  DerivativeBench one(clock, "one_", 1), two(clock, "two_", 2), four(clock, "four_", 4);
  for (DerivativeBench* b : {&one, &two, &four})
    for (const std::uint8_t coverage : std::to_array<std::uint8_t>({0xF, 0xD, 0, 0, 4, 0xF}))
      b->add(coverage);
  clock.run(30);
  // The first quad is pushed in cycle 0 and taken in 1.
  const auto taken_in = [](const DerivativeBench& b) {
    std::vector<Cycle> when = cycles_of(b.ends.sink);
    for (Cycle& cycle : when) cycle -= DerivativeUnit::datasheet().latency.cycles;
    return when;
  };
  const auto counts = [](const DerivativeBench& b) {
    std::vector<int> all;
    for (const auto& taken : b.ends.sink.taken) all.push_back(taken.token.count);
    return all;
  };
  EXPECT_THAT(taken_in(one), ElementsAre(1, 2, 3, 4, 5, 6, 7, 10, 11, 12, 13, 14));
  EXPECT_THAT(taken_in(two), ElementsAre(1, 2, 3, 4, 7, 8, 9));
  EXPECT_THAT(counts(two), ElementsAre(2, 2, 2, 1, 1, 2, 2));
  EXPECT_THAT(taken_in(four), ElementsAre(1, 2, 5, 6));
  EXPECT_THAT(counts(four), ElementsAre(4, 3, 1, 4));
  for (const DerivativeBench* b : {&one, &two, &four}) {
    expect_same(tokens_of(b->narrow_ends.sink), flat(b->ends));
    EXPECT_EQ(b->unit.quads.value(), 6u);
    EXPECT_EQ(b->unit.fragments.value(), 12u);
    EXPECT_EQ(b->unit.clamped.value(), b->narrow.clamped.value());
    EXPECT_EQ(b->probe.inside(), 12u);
  }
}

TEST(TextureRtlWide, DerivativeUnitStallsInMidQuad) {
  ClockDomain clock("clock", period());
  DerivativeBench b(clock, "", 2);
  for (int i = 0; i < 20; ++i) b.add(0xF);
  b.ends.sink.hold_from = kHoldFrom;
  b.ends.sink.hold_to = kHoldFrom + kHold;
  clock.run(120);
  ASSERT_EQ(b.ends.sink.taken.size(), 40u);
  for (Cycle i = 0; i < 40; ++i)
    EXPECT_EQ(b.ends.sink.taken[i].cycle,
              after_hold(1 + DerivativeUnit::datasheet().latency.cycles + i));
  expect_same(tokens_of(b.narrow_ends.sink), flat(b.ends));
}

// ---- Units whose groups keep their fragments

// Both units with the same tokens, in groups of 4, 1, 3, 2, 4, 1, ...
template <class From, class To>
struct Kept {
  Kept(ClockDomain& clock, const std::string& name)
      : one(clock, name + "one_"), many(clock, name) {}
  void add(std::size_t groups, const std::function<From(std::uint32_t)>& token) {
    std::uint32_t number = 0;
    for (std::size_t i = 0; i < groups; ++i) {
      std::vector<From> tokens;
      for (std::size_t n = std::array<std::size_t, 4>{4, 1, 3, 2}[i % 4]; n > 0; --n) {
        tokens.push_back(token(number++));
        one.source.add(tokens.back());
      }
      many.source.add(group_of<FragmentGroup<From>>(tokens));
    }
  }
  void hold() {
    many.sink.hold_from = kHoldFrom;
    many.sink.hold_to = kHoldFrom + kHold;
  }
  void expect(const rtl::Datasheet& sheet, std::size_t groups, bool held) {
    expect_same(tokens_of(one.sink), flat(many));
    ASSERT_EQ(many.sink.taken.size(), groups);
    for (std::size_t i = 0; i < groups; ++i) {
      EXPECT_EQ(many.sink.taken[i].token.count, (std::array{4, 1, 3, 2}[i % 4]));
      const Cycle alone = 1 + sheet.latency.cycles + i * sheet.interval.cycles;
      EXPECT_EQ(many.sink.taken[i].cycle, held ? after_hold(alone) : alone) << title(sheet);
    }
  }
  Ends<From, To> one;
  Ends<FragmentGroup<From>, FragmentGroup<To>> many;
};

Random fragments_random(2);
DerivativeToken derivative_token(std::uint32_t number) {
  Random& r = fragments_random;
  const auto size = [&] { return r.word() >> (1 + r.below(31)); };
  const auto step = [&] { return std::int64_t{static_cast<std::int32_t>(r.word())}; };
  return {ticket(number), 1, 2, step(), step(), step(), step(), size(), size(), size(), size()};
}

TEST(TextureRtlWide, FootprintUnitHandlesAGroupPerCycle) {
  using spec::texture::FootprintRule;
  ClockDomain clock("clock", period());
  using Bench = Kept<DerivativeToken, FootprintToken>;
  std::vector<std::unique_ptr<sc_core::sc_module>> units;
  std::vector<std::pair<std::unique_ptr<Bench>, rtl::Datasheet>> benches;
  for (const auto& [name, rule] :
       {std::pair{"half_", FootprintRule::kHalf}, {"exact_", FootprintRule::kExact}}) {
    spec::texture::Parameters p;
    p.footprint = rule;
    auto bench = std::make_unique<Bench>(clock, name);
    auto narrow = std::make_unique<FootprintUnit>((std::string(name) + "n").c_str(), clock, rule);
    auto wide =
        std::make_unique<wide::FootprintUnit>((std::string(name) + "w").c_str(), clock, rule);
    narrow->derivatives_in(bench->one.in);
    narrow->footprints_out(bench->one.out);
    wide->derivatives_in(bench->many.in);
    wide->footprints_out(bench->many.out);
    bench->add(40, derivative_token);
    bench->hold();
    units.push_back(std::move(narrow));
    units.push_back(std::move(wide));
    benches.emplace_back(std::move(bench), FootprintUnit::datasheet(p));
  }
  clock.run(200);
  for (auto& [bench, sheet] : benches) bench->expect(sheet, 40, true);
}

TEST(TextureRtlWide, AxisUnitHandlesAGroupPerInterval) {
  using spec::texture::Axes, spec::texture::FootprintRule;
  ClockDomain clock("clock", period());
  using Bench = Kept<DerivativeToken, FootprintToken>;
  std::vector<std::unique_ptr<sc_core::sc_module>> units;
  std::vector<std::pair<std::unique_ptr<Bench>, rtl::Datasheet>> benches;
  for (const auto& [name, rule, cycles] : {std::tuple{"max_", FootprintRule::kMax, 1},
                                           {"exact_", FootprintRule::kExact, 1},
                                           {"four_", FootprintRule::kExact, 4}}) {
    spec::texture::Parameters p;
    p.axes = Axes::kEight;
    p.footprint = rule;
    p.axis_cycles = cycles;
    auto bench = std::make_unique<Bench>(clock, name);
    auto narrow =
        std::make_unique<AxisUnit>((std::string(name) + "n").c_str(), clock, p.axes, rule, cycles);
    auto wide = std::make_unique<wide::AxisUnit>((std::string(name) + "w").c_str(), clock, p.axes,
                                                 rule, cycles);
    narrow->derivatives_in(bench->one.in);
    narrow->footprints_out(bench->one.out);
    wide->derivatives_in(bench->many.in);
    wide->footprints_out(bench->many.out);
    bench->add(40, derivative_token);
    if (cycles == 1) bench->hold();
    units.push_back(std::move(narrow));
    units.push_back(std::move(wide));
    benches.emplace_back(std::move(bench), AxisUnit::datasheet(p));
  }
  clock.run(600);
  for (auto& [bench, sheet] : benches) bench->expect(sheet, 40, sheet.interval.cycles == 1);
}

TEST(TextureRtlWide, Log2UnitHandlesAGroupPerCycle) {
  using spec::texture::Log2Rule;
  ClockDomain clock("clock", period());
  using Bench = Kept<FootprintToken, Log2Token>;
  std::vector<std::unique_ptr<sc_core::sc_module>> units;
  std::vector<std::pair<std::unique_ptr<Bench>, rtl::Datasheet>> benches;
  for (const auto& [name, rule] :
       {std::pair{"mitchell_", Log2Rule::kMitchell}, {"exact_", Log2Rule::kExact}}) {
    spec::texture::Parameters p;
    p.log2 = rule;
    auto bench = std::make_unique<Bench>(clock, name);
    auto narrow = std::make_unique<Log2Unit>((std::string(name) + "n").c_str(), clock, rule);
    auto wide = std::make_unique<wide::Log2Unit>((std::string(name) + "w").c_str(), clock, rule, 4);
    narrow->footprints_in(bench->one.in);
    narrow->logs_out(bench->one.out);
    wide->footprints_in(bench->many.in);
    wide->logs_out(bench->many.out);
    bench->add(40, [](std::uint32_t number) -> FootprintToken {
      Random& r = fragments_random;
      return {ticket(number),
              1,
              2,
              3,
              4,
              r.word() >> r.below(32),
              r.chance(500),
              std::uint64_t{r.word()} << r.below(15)};
    });
    bench->hold();
    units.push_back(std::move(narrow));
    units.push_back(std::move(wide));
    benches.emplace_back(std::move(bench), Log2Unit::datasheet(p));
  }
  clock.run(200);
  for (auto& [bench, sheet] : benches) bench->expect(sheet, 40, true);
}

TEST(TextureRtlWide, LevelUnitHandlesAGroupPerCycle) {
  ClockDomain clock("clock", period());
  Store store(clock);
  const spec::texture::Parameters p;
  LevelUnit narrow("narrow", clock, store.descriptors.for_levels, p.axes, p.count, p.count_cap);
  wide::LevelUnit wide("wide", clock, store.descriptors.for_texels, p.axes, p.count, p.count_cap);
  Kept<Log2Token, LevelToken> bench(clock, "");
  narrow.logs_in(bench.one.in);
  narrow.levels_out(bench.one.out);
  wide.logs_in(bench.many.in);
  wide.levels_out(bench.many.out);
  spec::texture::Descriptor d;
  d.width = d.height = 256;
  d.levels = 9;  // the last one has 1 x 1 texels
  d.min_filter = spec::texture::MinFilter::kLinearMipmapLinear;
  d.max_lod = 12 << 8;
  d.max_anisotropy_log2 = 4;
  write_descriptor(store.bus, 0, d);
  bench.add(40, [](std::uint32_t number) -> Log2Token {
    Random& r = fragments_random;
    const auto lb = [&] { return static_cast<std::int32_t>(r.below(1 << 16)) - (1 << 14); };
    return {ticket(number), 1, 2, 3, 4, lb(), lb(), r.chance(500)};
  });
  bench.hold();
  clock.run(200);
  bench.expect(LevelUnit::datasheet(), 40, true);
  std::array<int, 2> several{};  // fragments of more than one sample, in the last level and not
  for (const auto& taken : bench.one.sink.taken)
    if (taken.token.last_index != 0) ++several[taken.token.level == 8 ? 0 : 1];
  EXPECT_EQ(several[0], 0);
  EXPECT_GT(several[1], 10);
  EXPECT_EQ(wide.two_levels.value(), narrow.two_levels.value());
  EXPECT_EQ(wide.magnified.value(), narrow.magnified.value());
}

// ---- SampleWalker

spec::texture::Build four_by_four() {
  return preset_parameters(spec::texture::Preset::kDeburr, spec::texture::NamedBuild::kWide);
}
struct WalkerBench {
  WalkerBench(ClockDomain& clock, const std::string& name,
              const spec::texture::Build& build = four_by_four(),
              spec::texture::Blend blend = spec::texture::Blend::kSample,
              spec::texture::Kernel kernel = spec::texture::Kernel::kBox)
      : unit((name + "unit").c_str(), clock, spec::texture::CountRule::kAny, kernel, 64, blend,
             build),
        narrow((name + "narrow").c_str(), clock, spec::texture::CountRule::kAny, kernel, 64, blend),
        ends(clock, name),
        narrow_ends(clock, name + "narrow_") {
    unit.levels_in(ends.in);
    unit.samples_out(ends.out);
    narrow.levels_in(narrow_ends.in);
    narrow.samples_out(narrow_ends.out);
  }
  // A group of fragments with these numbers of samples.
  void add(const std::vector<int>& samples, std::uint8_t fraction = 0) {
    std::vector<LevelToken> tokens;
    for (const int n : samples) {
      tokens.push_back({ticket(number++), 100, 200, 3000, -5000, static_cast<std::uint8_t>(n - 1),
                        4, fraction, true, number % 3 == 0});
      narrow_ends.source.add(tokens.back());
    }
    ends.source.add(group_of<FragmentGroup<LevelToken>>(tokens));
  }
  // "cycle: requests/partial" of every token.
  std::vector<std::string> tokens() const {
    std::vector<std::string> all;
    for (const auto& taken : ends.sink.taken)
      all.push_back(std::to_string(taken.cycle) + ": " + std::to_string(taken.token.count) + "/" +
                    std::to_string(taken.token.partial));
    return all;
  }
  std::uint32_t number = 0;
  wide::SampleWalker unit;
  SampleWalker narrow;
  Ends<FragmentGroup<LevelToken>, SampleGroup> ends;
  Ends<LevelToken, SampleToken> narrow_ends;
};

// Groups of 6, 4, 1, 1 and 2 requests. The first is taken in 1 and walks from 4 on. 4: four of A;
// 5: two of A, two of B; 6: two of B, C; then the walking registers are empty, and one group
// arrives per cycle.
TEST(TextureRtlWide, SampleWalkerTakesRequestsOfTwoGroups) {
  ClockDomain clock("clock", period());
  WalkerBench b(clock, ""), held(clock, "held_");
  held.ends.sink.hold_to = 20;
  for (WalkerBench* bench : {&b, &held}) {
    bench->add({3, 3});
    bench->add({1, 1, 1, 1});
    bench->add({1});
    bench->add({1});
    bench->add({2});
  }
  clock.run(60);
  spec::texture::Parameters p;
  const Cycle first = 1 + SampleWalker::datasheet(p).latency.cycles;
  EXPECT_EQ(first, 5u);
  EXPECT_THAT(b.tokens(), ElementsAre("5: 4/0", "6: 4/2", "7: 3/4", "8: 1/1", "9: 2/2"));
  // Two tokens wait in the link. B and C fill the registers meanwhile, D and E the stages before.
  EXPECT_THAT(held.tokens(), ElementsAre("20: 4/0", "21: 4/2", "22: 3/4", "23: 1/1", "24: 2/2"));
  for (WalkerBench* bench : {&b, &held}) {
    expect_same(tokens_of(bench->narrow_ends.sink), flat(bench->ends));
    EXPECT_EQ(bench->unit.samples.value(), 14u);
  }
}

// One group per cycle moves into the walking registers, so groups of one request give one per
// cycle; while the output is held, two of them gather there and leave together.
TEST(TextureRtlWide, SampleWalkerGathersGroupsWhileOutputIsHeld) {
  ClockDomain clock("clock", period());
  WalkerBench b(clock, ""), held(clock, "held_");
  held.ends.sink.hold_to = 20;
  for (WalkerBench* bench : {&b, &held})
    for (int i = 0; i < 6; ++i) bench->add({1});
  clock.run(60);
  EXPECT_THAT(b.tokens(), ElementsAre("5: 1/1", "6: 1/1", "7: 1/1", "8: 1/1", "9: 1/1", "10: 1/1"));
  EXPECT_THAT(held.tokens(), ElementsAre("20: 1/1", "21: 1/1", "22: 2/3", "23: 1/1", "24: 1/1"));
  EXPECT_EQ(held.unit.cycles_of(rtl::kStalledDownstream), 15u);  // 6 to 20
}

// Requests have the values and the order of width 1, in full groups while there are enough.
TEST(TextureRtlWide, SampleWalkerKeepsOrderAndValues) {
  using spec::texture::Blend;
  ClockDomain clock("clock", period());
  spec::texture::Build two = four_by_four(), one;
  two.width = 2;
  two.fragments = 2;
  one.width = 2;
  WalkerBench four(clock, "four_"),
      level(clock, "level_", four_by_four(), Blend::kLevel, spec::texture::Kernel::kAxis),
      narrow(clock, "narrow_", two, Blend::kLevel), single(clock, "single_", one);
  Random random(3);
  for (int i = 0; i < 40; ++i) {
    const auto fraction = static_cast<std::uint8_t>(random.chance(500) ? random.below(256) : 0);
    std::vector<int> samples(2);
    for (int& n : samples) n = 2 + static_cast<int>(random.below(15));
    for (WalkerBench* b : {&four, &level, &narrow}) b->add(samples, fraction);
    single.add({samples[0]}, fraction);
  }
  clock.run(3000);
  for (WalkerBench* b : {&four, &level, &narrow, &single}) {
    const std::size_t width = b == &four || b == &level ? 4 : 2;
    const auto requests = flat(b->ends);
    expect_same(tokens_of(b->narrow_ends.sink), requests);
    EXPECT_EQ(b->ends.sink.taken.size(), (requests.size() + width - 1) / width);
    EXPECT_EQ(spread(b->ends) + 1, b->ends.sink.taken.size());
    // Groups have F fragments.
    for (const auto& taken : b->ends.sink.taken)
      EXPECT_TRUE(width == 4 || taken.token.partial == 0);
  }
}

// ---- TexelAddresser

TEST(TextureRtlWide, TexelAddresserReadsTwoDescriptors) {
  ClockDomain clock("clock", period());
  spec::texture::Build build;
  build.width = 4;
  Store store(clock, "", build), narrow_store(clock, "narrow_");
  wide::TexelAddresser unit("unit", clock, store.descriptors.for_texels,
                            store.descriptors.for_younger_texels);
  TexelAddresser narrow("narrow", clock, narrow_store.descriptors.for_texels);
  Ends<SampleGroup, TexelGroup> ends(clock);
  Ends<SampleToken, TexelToken> narrow_ends(clock, "narrow_ends_");
  unit.samples_in(ends.in);
  unit.texels_out(ends.out);
  narrow.samples_in(narrow_ends.in);
  narrow.texels_out(narrow_ends.out);
  for (std::uint32_t handle = 0; handle < 2; ++handle) {
    spec::texture::Descriptor d;
    d.width = handle == 0 ? 256 : 64;
    d.height = 128;
    d.base[0] = handle << 20;
    for (Store* s : {&store, &narrow_store}) write_descriptor(s->bus, handle, d);
  }
  Random random(4);
  for (std::uint8_t i = 0; i < 40; ++i) {
    std::vector<SampleToken> tokens;
    for (int n = 1 + i % 4; n > 0; --n) {
      tokens.push_back({ticket(i, n <= 2 ? 1 : 0), random.word() >> 4, random.word() >> 4, 256, 0,
                        0, 0, true, true, true});
      narrow_ends.source.add(tokens.back());
    }
    SampleGroup group = group_of<SampleGroup>(tokens);
    group.partial = i % 16;
    ends.source.add(group);
  }
  ends.sink.hold_from = kHoldFrom;
  ends.sink.hold_to = kHoldFrom + kHold;
  clock.run(200);
  expect_same(tokens_of(narrow_ends.sink), flat(ends));
  ASSERT_EQ(ends.sink.taken.size(), 40u);
  for (std::size_t i = 0; i < 40; ++i) {
    EXPECT_EQ(ends.sink.taken[i].cycle,
              after_hold(1 + TexelAddresser::datasheet().latency.cycles + i));
    EXPECT_EQ(ends.sink.taken[i].token.partial, i % 16);
  }
  EXPECT_EQ(unit.bilinears.value(), 100u);
}

// ---- AddressUnit

struct AddressBench {
  AddressBench(ClockDomain& clock, const std::string& name, const spec::texture::Parameters& p)
      : store(clock, name, p),
        narrow_store(clock, name + "narrow_"),
        unit((name + "unit").c_str(), clock, p, store.control, store.descriptors, probe),
        narrow((name + "narrow").c_str(), clock, narrow_of(p), narrow_store.control,
               narrow_store.descriptors, narrow_probe),
        ends(clock, name),
        narrow_ends(clock, name + "narrow_") {
    unit.quads_in(ends.in);
    unit.texels_out(ends.out);
    narrow.quads_in(narrow_ends.in);
    narrow.texels_out(narrow_ends.out);
    for (std::uint32_t handle = 0; handle < 2; ++handle) {
      spec::texture::Descriptor d;
      d.width = d.height = 256;
      d.levels = 5;
      d.min_filter = spec::texture::MinFilter::kLinearMipmapLinear;
      d.max_lod = 12 << 8;
      d.max_anisotropy_log2 = 4;
      for (std::uint32_t k = 0; k < 5; ++k) d.base[k] = (handle << 20) + (k << 16);
      for (Store* s : {&store, &narrow_store}) write_descriptor(s->bus, handle, d);
    }
  }
  static spec::texture::Parameters narrow_of(spec::texture::Parameters p) {
    p.width = p.fragments = 1;
    return p;
  }
  rtl::LatencyProbe probe, narrow_probe;
  Store store, narrow_store;
  wide::AddressUnit unit;
  AddressUnit narrow;
  Ends<spec::texture::Quad, TexelGroup> ends;
  Ends<spec::texture::Quad, TexelToken> narrow_ends;
};

// The same requests in the same order at every width, with the latency of width 1.
TEST(TextureRtlWide, AddressUnitKeepsRequestsAndLatency) {
  ClockDomain clock("clock", period());
  std::vector<std::pair<std::unique_ptr<AddressBench>, spec::texture::Parameters>> benches;
  for (const auto& [name, width, fragments, blend, derivatives, axes] :
       {std::tuple{"four_", 4, 4, spec::texture::Blend::kSample, spec::texture::Derivatives::kFine,
                   spec::texture::Axes::kFour},
        {"level_", 4, 2, spec::texture::Blend::kLevel, spec::texture::Derivatives::kCoarse,
         spec::texture::Axes::kTwo},
        {"two_", 2, 1, spec::texture::Blend::kLevel, spec::texture::Derivatives::kFine,
         spec::texture::Axes::kEight}}) {
    spec::texture::Parameters p;
    p.width = width;
    p.fragments = fragments;
    p.blend = blend;
    p.derivatives = derivatives;
    p.axes = axes;
    benches.emplace_back(std::make_unique<AddressBench>(clock, name, p), p);
  }
  Random random(5);
  for (int i = 0; i < 200; ++i) {
    spec::texture::Quad q;
    q.tag = static_cast<std::uint32_t>(i);
    q.texture = static_cast<std::uint8_t>(random.below(2));
    q.coverage = static_cast<std::uint8_t>(i == 0 ? 15 : random.below(16));
    for (std::size_t lane = 0; lane < 4; ++lane) {
      q.s[lane] = static_cast<std::int32_t>(random.below(1U << (15 + random.below(10))));
      q.t[lane] = static_cast<std::int32_t>(random.below(1U << (15 + random.below(10))));
    }
    for (auto& [bench, p] : benches) {
      bench->ends.source.add(q);
      bench->narrow_ends.source.add(q);
    }
  }
  clock.run(20'000);
  for (auto& [bench, p] : benches) {
    expect_same(tokens_of(bench->narrow_ends.sink), flat(bench->ends));
    expect_latency(AddressUnit::datasheet(p), bench->ends.sink.taken.at(0).cycle - 1);
    EXPECT_LT(2 * bench->ends.sink.taken.back().cycle,
              bench->narrow_ends.sink.taken.back().cycle * 3 / 2);
  }
}

// ---- FilterPipeline

struct FilterBench {
  FilterBench(ClockDomain& clock, const std::string& name, const spec::texture::Configuration& c)
      : configuration(c),
        unit((name + "unit").c_str(), clock, c, probe, 4),
        narrow((name + "narrow").c_str(), clock, c, narrow_probe),
        ends(clock, name),
        narrow_ends(clock, name + "narrow_") {
    unit.texels_in(ends.in);
    unit.colours_out(ends.out);
    narrow.texels_in(narrow_ends.in);
    narrow.colours_out(narrow_ends.out);
  }
  // Requests of one fragment with N samples of one or two levels.
  void fragment(int samples, bool two_levels) {
    const bool by_level = configuration.blend == spec::texture::Blend::kLevel;
    const int levels = two_levels ? 2 : 1;
    const auto format = static_cast<std::uint8_t>(random.below(5));
    const bool valid = samples * levels > 1 || random.chance(900);
    for (int i = 0; i < samples * levels; ++i) {
      const int sample = by_level ? i % samples : i / levels,
                level = by_level ? i / samples : i % levels;
      TexelQuadToken t{};
      t.ticket = {tag, static_cast<std::uint8_t>(tag % 4), tag % 3 == 0, valid, 0};
      t.control.fraction_u = static_cast<std::uint8_t>(random.below(256));
      t.control.fraction_v = static_cast<std::uint8_t>(random.below(256));
      t.control.level_weight = two_levels ? (level == 0 ? 179 : 77) : 256;
      t.control.index = static_cast<std::uint8_t>(sample);
      const bool tent = configuration.kernel == spec::texture::Kernel::kAxis && tag % 2 == 0;
      t.control.last_index = static_cast<std::uint8_t>(samples - 1 + (tent ? kTent : 0));
      t.control.format = format;
      t.control.last_of_sample = by_level ? sample == samples - 1 : level == levels - 1;
      t.control.last_of_fragment = i == samples * levels - 1;
      for (std::uint32_t& texel : t.texel) texel = random.word();
      requests.push_back(t);
      narrow_ends.source.add(t);
    }
    probe.enters(0);
    narrow_probe.enters(0);
    ++tag;
  }
  // Sends the requests in groups of `count()` requests.
  void send(const std::function<std::size_t()>& count) {
    for (std::size_t at = 0; at < requests.size();) {
      const std::size_t end = std::min(at + count(), requests.size());
      const std::vector<TexelQuadToken> tokens(requests.begin() + static_cast<std::ptrdiff_t>(at),
                                               requests.begin() + static_cast<std::ptrdiff_t>(end));
      ends.source.add(group_of<TexelQuadGroup>(tokens));
      ending.push_back(static_cast<std::size_t>(
          std::count_if(tokens.begin(), tokens.end(),
                        [](const TexelQuadToken& t) { return t.control.last_of_fragment; })));
      at = end;
    }
  }
  Cycle latency() const {
    spec::texture::Parameters p;
    static_cast<spec::texture::Configuration&>(p) = configuration;
    return FilterPipeline::datasheet(p).latency.cycles;
  }
  void expect_colours() const {
    std::vector<spec::texture::Colour> all;
    for (const auto& taken : ends.sink.taken)
      all.insert(all.end(), taken.token.begin(), taken.token.end());
    ASSERT_EQ(all.size(), narrow_ends.sink.taken.size());
    for (std::size_t i = 0; i < all.size(); ++i)
      EXPECT_EQ(rtl::payload_difference(narrow_ends.sink.taken[i].token.colour[0], all[i]), "")
          << i;
    EXPECT_EQ(unit.fragments.value(), all.size());
  }
  Random random{6};
  std::uint32_t tag = 0;
  std::vector<TexelQuadToken> requests;
  std::vector<std::size_t> ending;  // fragments that end in each group
  spec::texture::Configuration configuration;
  rtl::LatencyProbe probe, narrow_probe;
  wide::FilterPipeline unit;
  FilterPipeline narrow;
  Ends<TexelQuadGroup, spec::texture::ColourGroup> ends;
  Ends<TexelQuadToken, spec::texture::ColourGroup> narrow_ends;
};

// The colours of a group leave in one beat; a group in which no fragment ends gives no beat.
TEST(TextureRtlWide, FilterPipelineDeliversColoursOfAGroupInOneBeat) {
  ClockDomain clock("clock", period());
  spec::texture::Configuration encoded;
  encoded.blend = spec::texture::Blend::kLevel;
  encoded.kernel = spec::texture::Kernel::kTent;
  encoded.srgb_output = spec::texture::SrgbOutput::kEncoded;
  spec::texture::Configuration by_axis;
  by_axis.kernel = spec::texture::Kernel::kAxis;
  FilterBench sample(clock, "sample_", by_axis), level(clock, "level_", encoded);
  for (FilterBench* b : {&sample, &level}) {
    for (int i = 0; i < 200; ++i)
      b->fragment(b->random.chance(600) ? 1 : 1 + static_cast<int>(b->random.below(16)),
                  b->random.chance(300));
    b->send([b] { return 1 + b->random.below(4); });
  }
  clock.run(5000);
  for (FilterBench* b : {&sample, &level}) {
    b->expect_colours();
    std::vector<std::pair<Cycle, std::size_t>> expected, seen;
    for (std::size_t i = 0; i < b->ending.size(); ++i)  // group i is taken in cycle 1 + i
      if (b->ending[i] != 0) expected.emplace_back(1 + i + b->latency(), b->ending[i]);
    for (const auto& taken : b->ends.sink.taken) seen.emplace_back(taken.cycle, taken.token.count);
    EXPECT_EQ(seen, expected);
  }
}

TEST(TextureRtlWide, FilterPipelineStallsAsAWhole) {
  ClockDomain clock("clock", period());
  FilterBench b(clock, "", {});
  for (int i = 0; i < 240; ++i) b.fragment(1, false);
  b.send([] { return std::size_t{4}; });
  b.ends.sink.hold_from = kHoldFrom;
  b.ends.sink.hold_to = kHoldFrom + kHold;
  clock.run(400);
  b.expect_colours();
  ASSERT_EQ(b.ends.sink.taken.size(), 60u);
  for (std::size_t i = 0; i < 60; ++i)
    EXPECT_EQ(b.ends.sink.taken[i].cycle, after_hold(1 + i + b.latency()));
  EXPECT_EQ(b.unit.cycles_of(rtl::kStalledDownstream), kHold);
}

// A reset in mid-group drops sums, fragments and requests.
TEST(TextureRtlWide, ResetDropsPartOfAGroup) {
  ClockDomain clock("clock", period());
  WalkerBench walker(clock, "walker_");
  FilterBench filter(clock, "filter_", {});
  walker.add({16, 16, 16, 16});
  filter.fragment(16, true);
  filter.send([] { return std::size_t{4}; });
  clock.run(11);
  clock.set_reset_n(false);
  clock.run(1);
  clock.set_reset_n(true);
  filter.requests.clear();
  filter.probe.reset();
  filter.narrow_probe.reset();
  filter.unit.fragments.reset();
  filter.narrow_ends.sink.taken.clear();
  walker.add({1});
  filter.fragment(1, false);
  filter.send([] { return std::size_t{4}; });
  clock.run(30);
  ASSERT_EQ(walker.ends.sink.taken.size(), 1u);
  EXPECT_EQ(walker.ends.sink.taken[0].token.count, 1);
  filter.expect_colours();
}

// ---- links

TEST(TextureRtlWide, LinksHaveTheBitsOfTheirGroups) {
  spec::texture::Parameters p;
  p.width = 4;
  p.fragments = 2;
  p.axes = spec::texture::Axes::kTwo;
  const auto bits = [](const auto& payload) { return payload.bits(); };
  EXPECT_EQ(bits(rtl::Payload::of<FragmentGroup<FootprintToken>>(
                fragment_links<Wide>(p, footprint_shape(p)))),
            2 + 2 * 234u);
  EXPECT_EQ(bits(rtl::Payload::of<TexelGroup>(request_links<Wide>(p, texel_shape(p)))),
            3 + 4 + 4 * 208u);
  p.fragments = 1;
  EXPECT_EQ(
      bits(rtl::Payload::of<FragmentGroup<LevelToken>>(fragment_links<Wide>(p, axis_shape(p)))),
      187u);
  EXPECT_EQ(bits(rtl::Payload::of<TexelGroup>(request_links<Wide>(p, texel_shape(p)))),
            3 + 4 * 208u);
}

}  // namespace
}  // namespace deburr::tb::texture_rtl::wide_units_test
