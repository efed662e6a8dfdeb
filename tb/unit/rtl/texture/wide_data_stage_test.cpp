// SPDX-License-Identifier: MIT
// The WideDataStage alone: cycles of passes and writes, and misuse of the banks.
#include "tb/unit/rtl/datasheets.h"
#include "tb/unit/rtl/texture/cache_bench.h"

namespace deburr::tb::texture_rtl::wide_data_stage_test {
namespace {

using namespace rtl::texture;
using testing::ElementsAre;

spec::texture::Parameters ports(std::int32_t reads = 2, std::int32_t writes = 4) {
  spec::texture::Parameters p = wide_cache();
  p.cache_bank_reads = reads;
  p.cache_fill_writes = writes;
  return p;
}

// A group whose lines are in these slots. Requests are added with `read`.
struct Group {
  CacheGroup token{};
  std::uint8_t texels = 0;
  Group& line(std::uint16_t slot, bool missed = false, bool turned = false) {
    token.slot[token.lines] = slot;
    token.missed[token.lines] = missed;
    token.turned[token.lines++] = turned;
    return *this;
  }
  // The next texel; four make a request.
  Group& read(std::uint8_t line, std::uint8_t word) {
    const auto n = static_cast<std::size_t>(texels / 4);
    token.count = static_cast<std::uint8_t>(n + 1);
    token.at[n].ticket = request({}).ticket;
    token.at[n].control = request({}).control;
    for (std::size_t i = texels++ % 4; i < 4; ++i) {
      token.at[n].index[i] = line;
      token.at[n].offset[i] = static_cast<std::uint8_t>(4 * word);
    }
    return *this;
  }
};

struct StageBench {
  explicit StageBench(const spec::texture::Parameters& p = ports())
      : fills("fills", 32, 64, static_cast<std::uint32_t>(p.cache_fill_writes)),
        stage("stage", clock, p, fills.reader()) {
    stage.requests_in(requests);
    stage.texels_out->bind(texels);
    stage.lines_used_out(lines_used);
    stage.stall_out(stall);
  }
  // A line of this byte arrives in this cycle.
  void arrive(std::uint8_t byte = 0) {
    std::array<std::uint8_t, 64> line;
    line.fill(byte);
    fills.fill(clock.cycle(), fills.reserve(clock.cycle()), 0, line, true);
    clock.run(1);
  }
  ClockDomain clock{"clock", period()};
  FillBuffer fills;
  Link<CacheGroup> requests{"requests", 8};
  Link<TexelQuadGroup> texels{"texels"};
  rtl::Wire<std::uint8_t> lines_used{"lines_used", 0};
  rtl::Wire<SlotStall> stall{"stall", SlotStall::kNone};
  WideDataStage stage;
};

TEST(TextureRtlWideDataStage, LatencyMatchesDatasheet) {
  StageBench b;
  b.requests.push(0, Group().line(3).read(0, 0).token);
  const Cycle latency = ready_at(b.clock, b.texels) - 1;
  expect_detects_one_cycle(WideDataStage::datasheet(), &rtl::Datasheet::latency,
                           [&](const rtl::Datasheet& sheet) { expect_latency(sheet, latency); });
}

// Cycles of one group whose lines have all arrived, and its stalls.
struct Cycles {
  Cycle taken;
  std::uint64_t wait_fill, write_fill, bank_conflict;
  friend bool operator==(const Cycles&, const Cycles&) = default;
  friend void PrintTo(const Cycles& c, std::ostream* out) {
    *out << c.taken << " cycles, wait_fill " << c.wait_fill << ", write_fill " << c.write_fill
         << ", bank_conflict " << c.bank_conflict;
  }
};
struct Case {
  const char* name;
  std::int32_t reads, writes;
  Group group;
  Cycles cycles;
  std::vector<int> used;  // lines written in each cycle of the group
};
void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

Group hits(const std::vector<std::pair<std::uint16_t, std::uint8_t>>& words) {
  Group group;
  std::uint8_t i = 0;
  for (const auto& [slot, word] : words) group.line(slot).read(i++, word);
  return group;
}
Group misses(const std::vector<std::uint16_t>& slots) {
  Group group;
  std::uint8_t i = 0;
  for (const std::uint16_t slot : slots) group.line(slot, true).read(i++, 0);
  return group;
}
// Slots 0, 4, 8, ... are in line bank 0.
std::vector<Case> cases() {
  return {
      {"one hit", 1, 1, hits({{0, 0}}), {1, 0, 0, 0}, {0}},
      {"nothing", 2, 4, Group(), {1, 0, 0, 0}, {0}},
      {"two words of a bank, one read", 1, 1, hits({{0, 5}, {4, 5}}), {2, 0, 0, 1}, {0, 0}},
      {"two words of a bank, two reads", 2, 1, hits({{0, 5}, {4, 5}}), {1, 0, 0, 0}, {0}},
      {"three words, two reads", 2, 4, hits({{0, 5}, {4, 5}, {8, 5}}), {2, 0, 0, 1}, {0, 0}},
      {"four words, two reads",
       2,
       4,
       hits({{0, 5}, {4, 5}, {8, 5}, {12, 5}}),
       {2, 0, 0, 1},
       {0, 0}},
      {"five words, two reads",
       2,
       4,
       hits({{0, 5}, {4, 5}, {8, 5}, {12, 5}, {16, 5}}),
       {3, 0, 0, 2},
       {0, 0, 0}},
      {"eight words, one read",
       1,
       4,
       hits({{0, 5}, {4, 5}, {8, 5}, {12, 5}, {16, 5}, {20, 5}, {24, 5}, {28, 5}}),
       {8, 0, 0, 7},
       {0, 0, 0, 0, 0, 0, 0, 0}},
      {"words of other line banks",
       1,
       4,
       hits({{0, 5}, {1, 5}, {2, 5}, {3, 5}}),
       {1, 0, 0, 0},
       {0}},
      {"one word again",
       1,
       1,
       Group().line(0).read(0, 5).read(0, 5).read(0, 6).read(0, 5),
       {1, 0, 0, 0},
       {0}},
      {"turned lines",
       1,
       1,
       Group().line(0).line(4, false, true).read(0, 5).read(1, 5),
       {1, 0, 0, 0},
       {0}},
      {"turned into the bank",
       1,
       1,
       Group().line(0).line(4, false, true).read(0, 5).read(1, 13),
       {2, 0, 0, 1},
       {0, 0}},
      {"one miss", 2, 4, misses({0}), {1, 0, 0, 0}, {1}},
      {"four misses in four banks", 2, 4, misses({0, 1, 2, 3}), {1, 0, 0, 0}, {4}},
      {"four misses, two writes", 2, 2, misses({0, 1, 2, 3}), {2, 0, 1, 0}, {2, 2}},
      {"four misses, one write", 2, 1, misses({0, 1, 2, 3}), {4, 0, 3, 0}, {1, 1, 1, 1}},
      {"four misses in one bank", 2, 4, misses({0, 4, 8, 12}), {4, 0, 3, 0}, {1, 1, 1, 1}},
      {"banks 0 1 0 1", 2, 4, misses({0, 1, 4, 5}), {2, 0, 1, 0}, {2, 2}},
      {"banks 0 0 1 1", 2, 4, misses({0, 4, 1, 5}), {3, 0, 2, 0}, {1, 2, 1}},
      {"eight misses", 2, 4, misses({0, 1, 2, 3, 4, 5, 6, 7}), {2, 0, 1, 0}, {4, 4}},
      {"pass and miss",
       1,
       4,
       Group().line(0).line(5, true).read(0, 5).read(1, 5),
       {1, 0, 0, 0},
       {1}},
      {"misses read no bank",
       1,
       4,
       Group().line(0).line(4, true).line(8, true).read(0, 5).read(1, 5).read(2, 5),
       {2, 0, 1, 0},
       {1, 1}},
      {"writes begin in last pass",
       1,
       4,
       Group()
           .line(0)
           .line(4)
           .line(8)
           .line(5, true)
           .line(9, true)
           .read(0, 5)
           .read(1, 5)
           .read(2, 5)
           .read(3, 5)
           .read(4, 5),
       {4, 0, 1, 2},
       {0, 0, 1, 1}},
  };
}

class WideDataStageCycles : public testing::TestWithParam<std::tuple<Case, Cycle>> {};
TEST_P(WideDataStageCycles, GroupTakesPassesThenWrites) {
  const auto& [c, held] = GetParam();
  // Also while earlier texels are held: then it begins when they move on.
  StageBench b(ports(c.reads, c.writes));
  std::uint64_t lines = 0;
  for (std::size_t k = 0; k < c.group.token.lines; ++k)
    if (c.group.token.missed[k]) {
      b.arrive();
      ++lines;
    }
  b.clock.run(3);
  const CacheGroup before = Group().line(40).read(0, 0).token;
  // Three groups in a row: the link to the FilterPipeline holds two, stage 2 one.
  Cycle pushed = b.clock.cycle();
  if (held != 0) {
    for (int i = 0; i < 3; ++i) {
      b.requests.push(pushed++, before);
      b.clock.run(1);
    }
  }
  CacheGroup group = c.group.token;
  if (group.count == 0) {
    group.count = 1;
    group.at[0].ticket = invalid_request().ticket;
  }
  b.requests.push(pushed, group);
  b.requests.push(pushed + 1, before);
  const Cycle opens = pushed + held;
  std::vector<int> used;
  Cycle done = 0;
  const std::uint64_t wanted = held != 0 ? 4 : 1;
  Cycle began = 0;
  while (done == 0 && b.clock.cycle() < opens + 60) {
    const Cycle now = b.clock.cycle();
    if (now >= opens && b.texels.can_pop(now)) b.texels.pop(now);
    const std::uint64_t written = b.stage.lines_written.value();
    const bool at_head = b.requests.pops() == wanted - 1 && now > pushed;
    const std::uint64_t stalled = b.stage.cycles_of(rtl::kStalledDownstream);
    b.clock.run(1);
    if (at_head && b.stage.cycles_of(rtl::kStalledDownstream) == stalled) {
      if (began == 0) began = now;
      used.push_back(static_cast<int>(b.stage.lines_written.value() - written));
    }
    if (b.requests.pops() == wanted) done = now;
  }
  EXPECT_EQ(done - began + 1, c.cycles.taken) << "held " << held;
  // An entry of the link is free one cycle after its pop.
  EXPECT_EQ(began, held == 0 ? pushed + 1 : opens + 1);
  EXPECT_EQ(used, c.used) << "held " << held;
  EXPECT_EQ((Cycles{done - began + 1, stalls(b.stage, "wait_fill"), stalls(b.stage, "write_fill"),
                    stalls(b.stage, "bank_conflict")}),
            c.cycles);
  EXPECT_EQ(b.stage.conflicts.value(), c.cycles.bank_conflict != 0 ? 1u : 0u);
  b.clock.run(2);
  EXPECT_EQ(b.stage.lines_written.value(), lines);
}
INSTANTIATE_TEST_SUITE_P(TextureRtlWideDataStage, WideDataStageCycles,
                         testing::Combine(testing::ValuesIn(cases()),
                                          testing::Values<Cycle>(0, 1, 2, 5)));

// Lines are taken as they arrive, in order, and the wires report each cycle one cycle (writes) and
// two cycles (stalls) later.
TEST(TextureRtlWideDataStage, WaitsForLinesInOrder) {
  StageBench b;
  for (int i = 0; i < 5; ++i) b.fills.reserve(0);
  b.requests.push(0, Group()
                         .line(0)
                         .line(4)
                         .line(8)
                         .line(1, true)
                         .line(2, true)
                         .line(5, true)
                         .line(3, true)
                         .line(6, true)
                         .read(0, 5)
                         .read(1, 5)
                         .read(2, 5)
                         .read(3, 5)
                         .read(4, 5)
                         .read(5, 5)
                         .read(6, 5)
                         .read(7, 5)
                         .token);
  // Popped from 1 on: passes in 1 and 2. Fills arrive in the cycles 0 to 4 of this order, and are
  // ready two cycles later.
  const std::array<std::uint32_t, 5> entry = {0, 2, 4, 3, 1};
  const std::array<std::uint8_t, 64> line{};
  std::vector<int> used;
  std::vector<SlotStall> stall;
  for (Cycle now = 0; now < 14; ++now) {
    if (now >= 1 && now < 6) b.fills.fill(now, entry[now - 1], 0, line, true);
    used.push_back(b.lines_used.read(now));
    stall.push_back(b.stall.read(now));
    b.clock.run(1);
  }
  // Fill 0 (bank 1) is there in 3, fills 1 (bank 2), 2 (bank 1) and 3 (bank 3) in 7, as is fill 4
  // (bank 2), which has to wait for the next cycle.
  EXPECT_THAT(used, ElementsAre(0, 0, 0, 0, 1, 0, 0, 0, 3, 1, 0, 0, 0, 0));
  using enum SlotStall;
  EXPECT_THAT(stall, ElementsAre(kNone, kNone, kNone, kBankPass, kWaitFill, kWriteFill, kWaitFill,
                                 kWaitFill, kWaitFill, kWriteFill, kNone, kNone, kNone, kNone));
  EXPECT_EQ(stalls(b.stage, "bank_conflict"), 1u);
  EXPECT_EQ(stalls(b.stage, "wait_fill"), 4u);
  EXPECT_EQ(stalls(b.stage, "write_fill"), 2u);
}

// Texels that cannot leave stop everything, and the wire says so.
TEST(TextureRtlWideDataStage, WireReportsHeldOutput) {
  StageBench b;
  for (Cycle now = 0; now < 6; ++now) {
    b.requests.push(now, Group().line(0).read(0, 0).token);
    b.clock.run(1);
  }
  // Pushed in 2 and 3, held from 4 on: reported two cycles later.
  EXPECT_EQ(b.stage.cycles_of(rtl::kStalledDownstream), 2u);
  EXPECT_EQ(b.stall.read(5), SlotStall::kNone);
  EXPECT_EQ(b.stall.read(6), SlotStall::kOutput);
}

// A read of a slot in the cycle of a write returns the old line. The texel that missed gets the new
// line.
TEST(TextureRtlWideDataStage, ReadsOldWordOfLineThatIsReplaced) {
  StageBench b;
  b.arrive(1);
  b.arrive(2);
  b.clock.run(3);
  const Cycle start = b.clock.cycle();
  b.requests.push(start, misses({7}).token);
  b.requests.push(start + 1, Group().line(7).line(7, true).read(0, 3).read(1, 3).token);
  b.requests.push(start + 2, hits({{7, 3}}).token);
  std::vector<std::array<std::uint32_t, 4>> texels;
  while (texels.size() < 3) {
    if (b.texels.can_pop(b.clock.cycle()))
      texels.push_back(b.texels.take(b.clock.cycle()).at[0].texel);
    b.clock.run(1);
    ASSERT_LT(b.clock.cycle(), start + 30);
  }
  EXPECT_EQ(texels[0][0], 0x01010101u);
  EXPECT_THAT(texels[1], ElementsAre(0x01010101, 0x02020202, 0x02020202, 0x02020202));
  EXPECT_EQ(texels[2][0], 0x02020202u);
}

// Fills that are written in one cycle, each into its slot, turned or not.
TEST(TextureRtlWideDataStage, EachFillOfCycleIsWritten) {
  StageBench b;
  for (std::uint8_t byte = 1; byte < 5; ++byte) b.arrive(byte);
  b.clock.run(3);
  const Cycle start = b.clock.cycle();
  const auto group = [](bool missed) {
    Group lines;
    for (std::uint8_t i = 0; i < 4; ++i)
      lines.line(static_cast<std::uint16_t>(8 + 5 * i), missed, i % 2 != 0).read(i, 3);
    return lines.token;
  };
  b.requests.push(start, group(true));
  b.requests.push(start + 1, group(false));
  for (int i = 0; i < 2; ++i) {
    ASSERT_EQ(ready_at(b.clock, b.texels), start + 3 + static_cast<Cycle>(i));
    EXPECT_THAT(b.texels.take(b.clock.cycle()).at[0].texel,
                ElementsAre(0x01010101, 0x02020202, 0x03030303, 0x04040404));
  }
}

// ---- Misuse of the banks -----------------------------------------------------------------------

TEST(TextureRtlWideDataStage, RejectsWordReadInSameCycle) {
  StageBench b;
  b.requests.push(0, hits({{0, 0}}).token);
  b.clock.run(2);
  EXPECT_THAT(read_one_cycle_early(b.stage, b.clock), Rejects("banks", kEarly));
}
TEST(TextureRtlWideDataStage, RejectsSlotBeyondLastLine) {
  StageBench b;
  b.requests.push(0, hits({{64, 0}}).token);
  EXPECT_THAT(rejection([&] { b.clock.run(2); }), Rejects("banks", "expected at most"));
}
// A second read per bank and cycle is a second copy.
TEST(TextureRtlWideDataStage, PortsAreThoseOfTheBuild) {
  const auto built = [](std::int32_t reads, std::int32_t writes) {
    StageBench b(ports(reads, writes));
    std::string text;
    rtl::for_each<rtl::MemoryBase>(b.stage, [&](const rtl::MemoryBase& memory) {
      text += std::string(memory.basename()) + " " + std::to_string(memory.words()) + " x " +
              std::to_string(memory.word_bits()) + " " + memory.ports() + ", " + memory.built_as() +
              ", " + std::to_string(memory.physical_bits()) + ". ";
    });
    return text;
  };
  EXPECT_EQ(built(1, 1), "banks 1024 x 32 16R1W of 16 words, 1R1W, 64 banks, old word, 32768. ");
  EXPECT_EQ(built(2, 4),
            "banks_0 1024 x 32 16R4W of 16 words, 1R1W, 64 banks, old word, 32768. "
            "banks_1 1024 x 32 16R4W of 16 words, 1R1W, 64 banks, old word, 32768. ");
}

}  // namespace
}  // namespace deburr::tb::texture_rtl::wide_data_stage_test
