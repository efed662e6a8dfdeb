// SPDX-License-Identifier: MIT
// The SampleWalker alone. Expected values are worked out by hand from
// docs/reference/texture/formats.md.
#include "rtl_model/texture/sample_walker.h"

#include "tb/unit/rtl/datasheets.h"
#include "tb/unit/rtl/texture/support.h"

namespace deburr::tb::texture_rtl::sample_walker_test {
namespace {

using namespace rtl::texture;

struct WalkerBench {
  WalkerBench(ClockDomain& clock, const std::string& name, spec::texture::Kernel kernel,
              std::int32_t spread,
              spec::texture::CountRule count = spec::texture::CountRule::kFloor)
      : unit((name + "unit").c_str(), clock, count, kernel, spread), ends(clock, name) {
    unit.levels_in(ends.in);
    unit.samples_out(ends.out);
  }
  SampleWalker unit;
  Ends<LevelToken, SampleToken> ends;
};

TEST(TextureRtlWalker, PlacesSamplesByHand) {
  ClockDomain clock("clock", period());
  WalkerBench b(clock, "", spec::texture::Kernel::kBox, 64);
  // N = 4: (2i - 3) x 64 x axis / 2^9.
  b.ends.source.add({ticket(), 1000, -1000, 1 << 20, -(1 << 10), 3, 3, 0, true});
  // N = 2 and an axis of 3 ulp: -+192 / 256, rounded to -1 and 1; of 2 ulp: -+0.5, to 0 and 1.
  b.ends.source.add({ticket(), 0, 0, 3, 2, 1, 0, 0, true});
  clock.run(20);
  ASSERT_EQ(b.ends.sink.taken.size(), 6u);
  for (int i = 0; i < 4; ++i) {
    const SampleToken& s = b.ends.sink.taken[static_cast<std::size_t>(i)].token;
    EXPECT_EQ(s.s, 1000 + (2 * i - 3) * 131072);
    EXPECT_EQ(s.t, -1000 - (2 * i - 3) * 128);
    EXPECT_EQ(s.level_weight, 256);
    EXPECT_EQ(s.index, i);
    EXPECT_EQ(s.last_index, 3);
    EXPECT_EQ(s.level, 3);
    EXPECT_TRUE(s.last_of_sample);
    EXPECT_EQ(s.last_of_fragment, i == 3);
  }
  EXPECT_EQ(b.ends.sink.taken[4].token.s, -1);
  EXPECT_EQ(b.ends.sink.taken[5].token.s, 1);
  EXPECT_EQ(b.ends.sink.taken[4].token.t, 0);
  EXPECT_EQ(b.ends.sink.taken[5].token.t, 1);
}

// Half as long again, but for a tent of too few samples.
TEST(TextureRtlWalker, SpreadByKernel) {
  ClockDomain clock("clock", period());
  using spec::texture::CountRule;
  using spec::texture::Kernel;
  WalkerBench tent(clock, "tent_", Kernel::kTent, 96), box(clock, "box_", Kernel::kBox, 96),
      narrow(clock, "narrow_", Kernel::kTent, 32);
  for (WalkerBench* b : {&tent, &box, &narrow})
    for (const std::uint8_t last : std::to_array<std::uint8_t>({0, 1, 3, 7, 15}))
      b->ends.source.add({ticket(), 0, 0, 1 << 20, 0, last, 0, 0, true});
  clock.run(50);
  for (const auto& [b, widened, few] :
       {std::tuple{&tent, 96, 64}, {&box, 96, 96}, {&narrow, 32, 32}}) {
    ASSERT_EQ(b->ends.sink.taken.size(), 31u);
    std::size_t at = 0;
    for (const int count : {1, 2, 4, 8, 16})
      for (int i = 0; i < count; ++i) {
        const SampleToken& s = b->ends.sink.taken[at++].token;
        EXPECT_EQ(s.s,
                  (2 * i + 1 - count) * (count < 4 ? few : widened) * (1 << 20) / (128 * count));
        EXPECT_EQ(s.index, i);
        EXPECT_EQ(s.last_index, count - 1);
      }
  }
}

// Every N of 1 to 16, against the contract's formula.
TEST(TextureRtlWalker, AnyCountByTheFormula) {
  ClockDomain clock("clock", period());
  using spec::texture::Kernel;
  WalkerBench box(clock, "box_", Kernel::kBox, 64, spec::texture::CountRule::kAny),
      tent(clock, "tent_", Kernel::kTent, 102, spec::texture::CountRule::kAny);
  for (const auto& [bench, kernel, spread] :
       {std::tuple{&box, Kernel::kBox, 64}, {&tent, Kernel::kTent, 102}}) {
    WalkerBench& b = *bench;
    const std::int64_t axes[] = {1 << 20, -(1 << 20), 3, -5, 1234567891, -6074000999};
    for (const std::int64_t axis : axes)
      for (std::uint8_t last = 0; last < 16; ++last)
        b.ends.source.add({ticket(), 7, -9, axis, -axis / 3, last, 0, 0, true});
    clock.run(6 * 136 + 20);
    ASSERT_EQ(b.ends.sink.taken.size(), 6u * 136);
    std::size_t at = 0;
    for (const std::int64_t axis : axes)
      for (int count = 1; count <= 16; ++count)
        for (int i = 0; i < count; ++i) {
          const SampleToken& s = b.ends.sink.taken[at++].token;
          const int length = kernel == Kernel::kTent && count < 4 ? std::min(spread, 64) : spread;
          const auto offset = [&](std::int64_t d) {
            const int reciprocal = (2 * 65536 + count) / (2 * count);  // rounded
            const std::int64_t exact = d * (2 * i + 1 - count) * length * reciprocal;
            return (exact + (1 << 22)) >> 23;
          };
          EXPECT_EQ(s.s, 7 + offset(axis)) << "N " << count << " i " << i;
          EXPECT_EQ(s.t, -9 + offset(-axis / 3)) << "N " << count << " i " << i;
          EXPECT_EQ(s.last_index, count - 1);
          EXPECT_EQ(s.last_of_fragment, i == count - 1);
        }
  }
}

rtl::Datasheet sheet_of(spec::texture::CountRule count) {
  spec::texture::Parameters p;
  p.count = count;
  return SampleWalker::datasheet(p);
}

TEST(TextureRtlWalker, LatencyOfTheDatasheet) {
  ClockDomain clock("clock", period());
  using spec::texture::CountRule;
  WalkerBench floor(clock, "floor_", spec::texture::Kernel::kBox, 64),
      any(clock, "any_", spec::texture::Kernel::kBox, 64, CountRule::kAny);
  for (WalkerBench* b : {&floor, &any}) b->ends.in.push(0, {ticket(), 0, 0, 0, 0, 0, 0, 0, true});
  clock.run(1);
  const Cycle taken = 1;
  expect_latency(sheet_of(CountRule::kFloor), ready_at(clock, floor.ends.out) - taken);
  expect_latency(sheet_of(CountRule::kAny), ready_at(clock, any.ends.out) - taken);
}

// One sample each: a fragment a clock, also through the division; and nothing is lost in a stall.
TEST(TextureRtlWalker, AnyCountKeepsAFragmentAClock) {
  ClockDomain clock("clock", period());
  WalkerBench b(clock, "", spec::texture::Kernel::kBox, 64, spec::texture::CountRule::kAny);
  for (std::uint8_t i = 0; i < 60; ++i) b.ends.source.add({ticket(i), i, 0, 0, 0, 0, 0, 0, true});
  b.ends.sink.hold_from = 30;
  b.ends.sink.hold_to = 41;
  clock.run(100);
  ASSERT_EQ(b.ends.sink.taken.size(), 60u);
  for (std::size_t i = 0; i < 60; ++i) {
    const Cycle alone = i + 1 + sheet_of(spec::texture::CountRule::kAny).latency.clocks;
    EXPECT_EQ(b.ends.sink.taken[i].cycle, alone < 30 ? alone : alone + 11);
    EXPECT_EQ(b.ends.sink.taken[i].token.ticket.tag, i);
  }
}

// While its requests wait, fragments go on until each stage holds one.
TEST(TextureRtlWalker, StagesFillWhileTheOutputWaits) {
  ClockDomain clock("clock", period());
  using spec::texture::CountRule;
  WalkerBench floor(clock, "floor_", spec::texture::Kernel::kBox, 64),
      any(clock, "any_", spec::texture::Kernel::kBox, 64, CountRule::kAny);
  for (WalkerBench* b : {&floor, &any}) {
    b->ends.sink.hold_to = 1000;
    b->ends.source.add({ticket(), 0, 0, 0, 0, 15, 0, 0, true});
  }
  clock.run(30);
  for (WalkerBench* b : {&floor, &any})
    for (std::uint8_t i = 1; i < 6; ++i) b->ends.source.add({ticket(i), 0, 0, 0, 0, 0, 0, 0, true});
  clock.run(30);
  EXPECT_EQ(floor.ends.in.pops(), 2u);
  EXPECT_EQ(any.ends.in.pops(), 3u);
}

struct DividingBench : WalkerBench {
  explicit DividingBench(ClockDomain& domain)
      : WalkerBench(domain, "", spec::texture::Kernel::kBox, 64, spec::texture::CountRule::kAny) {
    ends.source.add(token);
    domain.run(2);  // taken in 1
  }
  const LevelToken token = {ticket(), 0, 0, 8, 8, 2, 0, 0, true};
};

TEST(TextureRtlWalkerReciprocal, AWordIsNotThereInTheClockOfItsRead) {
  ClockDomain clock("clock", period());
  DividingBench b(clock);
  EXPECT_THAT(of_a_stage_less(b.unit, clock), Rejects("reciprocal", kEarly));
}

TEST(TextureRtlWalkerReciprocal, OneFragmentAClock) {
  ClockDomain clock("clock", period());
  DividingBench b(clock);
  EXPECT_THAT(of_a_second_token(b.unit, b.ends.in, b.token, clock),
              Rejects("reciprocal", kTooMany));
}

// The largest offset: 15 x 128 x (2^32 - 1) needs all of the accumulator's bits.
TEST(TextureRtlWalker, ExtremesDoNotOverflow) {
  ClockDomain clock("clock", period());
  WalkerBench b(clock, "", spec::texture::Kernel::kBox, 128);
  const std::int64_t axis = (std::int64_t{1} << 32) - 1;
  b.ends.source.add({ticket(), INT32_MAX, INT32_MIN, axis, -axis, 15, 0, 0, true});
  clock.run(30);
  ASSERT_EQ(b.ends.sink.taken.size(), 16u);
  // -+15 x 128 x (2^32 - 1) / 2^11 = -+(15 x 2^28 - 15/16), rounded.
  EXPECT_EQ(b.ends.sink.taken[0].token.s, INT32_MAX - (15ll << 28) + 1);
  EXPECT_EQ(b.ends.sink.taken[15].token.s, INT32_MAX + (15ll << 28) - 1);
  EXPECT_EQ(b.ends.sink.taken[15].token.t, INT32_MIN - (15ll << 28) + 1);
}

TEST(TextureRtlWalker, CostsNTimesLevelsClocks) {
  ClockDomain clock("clock", period());
  WalkerBench b(clock, "", spec::texture::Kernel::kBox, 64);
  Cycle at = 4;  // pushed in 0, taken in 1, to be taken in 4
  std::vector<Cycle> last;
  for (std::uint8_t n = 0; n <= 4; ++n)
    for (const std::uint8_t fraction : std::to_array<std::uint8_t>({0, 77})) {
      b.ends.source.add(
          {ticket(), 0, 0, 0, 0, static_cast<std::uint8_t>((1 << n) - 1), 1, fraction, true});
      at += (1u << n) * (fraction ? 2 : 1);
      last.push_back(at - 1);
    }
  Ticket invalid = ticket();
  invalid.valid = false;
  b.ends.source.add({invalid, 0, 0, 0, 0, 0, 0, 0, false});
  last.push_back(at);
  clock.run(200);
  std::vector<Cycle> got;
  for (const auto& t : b.ends.sink.taken)
    if (t.token.last_of_fragment) got.push_back(t.cycle);
  EXPECT_EQ(got, last);
  // A trilinear sample: the finer level first, with the rest of the weight.
  const SampleToken &finer = b.ends.sink.taken[1].token, &coarser = b.ends.sink.taken[2].token;
  EXPECT_EQ(finer.level, 1);
  EXPECT_EQ(finer.level_weight, 256 - 77);
  EXPECT_FALSE(finer.last_of_sample);
  EXPECT_EQ(coarser.level, 2);
  EXPECT_EQ(coarser.level_weight, 77);
  EXPECT_TRUE(coarser.last_of_sample);
}

}  // namespace
}  // namespace deburr::tb::texture_rtl::sample_walker_test
