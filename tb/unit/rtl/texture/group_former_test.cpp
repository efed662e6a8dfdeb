// SPDX-License-Identifier: MIT
// The GroupFormer alone: limits of a group, their order, the buffer, and every slot under its
// cause.
#include "tb/unit/rtl/datasheets.h"
#include "tb/unit/rtl/texture/cache_bench.h"

namespace deburr::tb::texture_rtl::group_former_test {
namespace {

using namespace rtl::texture;
using spec::texture::Format;
using testing::ElementsAre;
using testing::ElementsAreArray;

struct FormerBench {
  explicit FormerBench(const spec::texture::Parameters& p = wide_cache())
      : former("former", clock, p) {
    former.texels_in(ends.in);
    former.groups_out(ends.out);
    former.stall_in(stall);
  }
  // The cycle in which each group left, and its requests.
  std::vector<std::pair<Cycle, int>> groups() const {
    std::vector<std::pair<Cycle, int>> found;
    for (const auto& taken : ends.sink.taken)
      found.emplace_back(taken.cycle - 1, taken.token.count);
    return found;
  }
  ClockDomain clock{"clock", period()};
  Ends<TexelGroup, LineGroup> ends{clock};
  rtl::Wire<SlotStall> stall{"stall", SlotStall::kNone};
  GroupFormer former;
};
// The token that is pushed in cycle c is taken in c + 1 and leaves in c + kThrough.
constexpr Cycle kThrough = 2;

// `texels` words from `word` on of a line.
std::uint32_t at(std::uint32_t line, std::uint32_t word) { return 64 * line + 4 * word; }
TexelToken two_lines(std::uint32_t a, std::uint32_t b) {
  return request({at(a, 0), at(a, 1), at(b, 2), at(b, 3)});
}
TexelToken one_word(std::uint32_t line, std::uint32_t word, bool turned = false) {
  TexelToken t = request({at(line, word), at(line, word), at(line, word), at(line, word)});
  t.turned = {turned, turned};
  return t;
}

TEST(TextureRtlGroupFormer, LatencyAndIntervalMatchDatasheet) {
  FormerBench b;
  for (std::uint32_t i = 0; i < 9; ++i)
    b.ends.source.add(token_of({in_line(i), in_line(i), in_line(i), in_line(i)}));
  b.clock.run(20);
  ASSERT_EQ(b.ends.sink.taken.size(), 9u);
  const auto check = [&](const rtl::Datasheet& sheet) {
    expect_cycles(sheet, cycles_of(b.ends.sink), 1);
  };
  expect_detects_one_cycle(GroupFormer::datasheet(), &rtl::Datasheet::latency, check);
  expect_detects_one_cycle(GroupFormer::datasheet(), &rtl::Datasheet::interval, check);
  EXPECT_EQ(b.former.slots.value(), 9u * 4);
  EXPECT_EQ(b.former.requests.value(), 9u * 4);
  EXPECT_EQ(slots_of(b.former), Slots{});
}

struct Limit {
  const char* name;
  spec::texture::Parameters build;
  std::vector<TexelGroup> tokens;
  std::vector<int> groups;  // requests of each
  Slots slots;
};
void PrintTo(const Limit& c, std::ostream* out) { *out << c.name; }

spec::texture::Parameters with(std::int32_t lookups, std::int32_t reads, std::int32_t ways = 2) {
  spec::texture::Parameters p = wide_cache();
  p.cache_lookups = lookups;
  p.cache_bank_reads = reads;
  p.cache_ways = ways;
  return p;
}
spec::texture::Parameters of_width(std::int32_t width) {
  spec::texture::Parameters p = wide_cache(width);
  p.cache_lookups = 4;
  p.cache_line_banks = p.cache_fill_writes = 2;
  p.cache_bank_reads = 1;
  return p;
}

// The next `count` blocks from this one on; the texels after them are in the last one.
TexelToken blocks(Format format, std::uint32_t first, std::uint32_t count) {
  const std::uint32_t bytes = spec::texture::kFormatBlockBytes[static_cast<std::size_t>(format)];
  std::array<std::uint32_t, 4> address;
  for (std::uint32_t i = 0; i < 4; ++i) address[i] = (first + std::min(i, count - 1)) * bytes;
  return in_blocks(format, address);
}

// Lines in different line banks have different banks of words: 0, 1, 2, 3. Sets: line mod 32.
std::vector<Limit> limits() {
  const TexelToken a = two_lines(0, 1), b = two_lines(2, 3), c = two_lines(4, 5),
                   d = two_lines(6, 7);
  const TexelToken nothing = invalid_request();
  // Four words of bank 0 in lines of one set: exceeds banks and set by itself.
  const TexelToken heap = request({at(0, 0), at(32, 0), at(64, 0), at(96, 0)});
  return {
      {"eight lines", with(8, 2), {token_of({a, b, c, d})}, {4}, {}},
      {"lines that are used again", with(4, 2), {token_of({a, b, a, b})}, {4}, {}},
      {"lookups", with(4, 2), {token_of({a, b, c, d})}, {2, 2}, {{"lookups", 2}, {"starved", 2}}},
      {"lookups, five lines",
       with(5, 2),
       {token_of({a, b, two_lines(0, 4), d})},
       {3, 1},
       {{"lookups", 1}, {"starved", 3}}},
      {"lookups, six lines",
       with(6, 2),
       {token_of({a, b, c, d})},
       {3, 1},
       {{"lookups", 1}, {"starved", 3}}},
      // Lines 0 and 4 are in line bank 0.
      {"banks, one read",
       with(8, 1),
       {token_of({one_word(0, 3), one_word(4, 3)})},
       {1, 1},
       {{"banks", 3}, {"starved", 3}}},
      {"banks, two reads",
       with(8, 2),
       {token_of({one_word(0, 3), one_word(4, 3), one_word(8, 3)})},
       {2, 1},
       {{"banks", 2}, {"starved", 3}}},
      {"one word read again",
       with(8, 1),
       {token_of({one_word(0, 3), one_word(0, 3)})},
       {2},
       {{"starved", 2}}},
      {"other line banks",
       with(8, 1),
       {token_of({one_word(0, 3), one_word(1, 3), one_word(2, 3), one_word(7, 3)})},
       {4},
       {}},
      {"other words",
       with(8, 1),
       {token_of({one_word(0, 3), one_word(4, 4)})},
       {2},
       {{"starved", 2}}},
      {"turned lines",
       with(8, 1),
       {token_of({one_word(0, 3), one_word(4, 3, true), one_word(8, 11)})},
       {2, 1},
       {{"banks", 2}, {"starved", 3}}},
      {"one line turned and not",
       with(8, 1),
       {token_of({one_word(0, 3), one_word(0, 11, true)})},
       {1, 1},
       {{"banks", 3}, {"starved", 3}}},
      {"set",
       with(8, 2),
       {token_of({one_word(0, 0), one_word(32, 1), one_word(64, 2)})},
       {2, 1},
       {{"set", 2}, {"starved", 3}}},
      {"set of four ways",
       with(8, 2, 4),
       {token_of({one_word(0, 0), one_word(16, 1), one_word(32, 2), one_word(48, 3)})},
       {4},
       {}},
      {"lines of a set used again",
       with(8, 2),
       {token_of({one_word(0, 0), one_word(32, 1), one_word(0, 2), one_word(32, 3)})},
       {4},
       {}},
      // The first of the limits that the next request exceeds.
      {"lookups before banks",
       with(4, 1),
       {token_of({a, b, request({at(4, 0), at(4, 0), at(4, 0), at(4, 0)})})},
       {2, 1},
       {{"lookups", 2}, {"starved", 3}}},
      {"lookups before set",
       with(4, 2),
       {token_of({two_lines(0, 32), b, one_word(64, 7)})},
       {2, 1},
       {{"lookups", 2}, {"starved", 3}}},
      {"banks before set",
       with(8, 1),
       {token_of({two_lines(0, 32), request({at(64, 0), at(64, 0), at(64, 0), at(64, 0)})})},
       {1, 1},
       {{"banks", 3}, {"starved", 3}}},
      // A request that alone exceeds the limits forms a group of its own, whatever follows.
      {"alone",
       with(8, 2),
       {token_of({heap, one_word(1, 0), heap, nothing})},
       {1, 1, 1, 1},
       {{"banks", 9}, {"starved", 3}}},
      {"alone, one set",
       with(8, 2),
       {token_of({request({at(0, 0), at(32, 1), at(64, 2), at(96, 3)}), nothing})},
       {1, 1},
       {{"set", 3}, {"starved", 3}}},
      {"alone, more lines behind it",
       with(4, 2),
       {token_of({heap, a})},
       {1, 1},
       {{"lookups", 3}, {"starved", 3}}},
      {"invalid", with(4, 1), {token_of({nothing, a, nothing, b})}, {4}, {}},
      {"partial quad",
       with(8, 2),
       {token_of({a, b}, 2), token_of({c, d})},
       {2, 2},
       {{"partial_quad", 2}, {"starved", 2}}},
      {"starved, partial earlier", with(8, 2), {token_of({a, b}, 1)}, {2}, {{"starved", 2}}},
      {"full, partial", with(8, 2), {token_of({a, b, a, b}, 8)}, {4}, {}},
      {"limit before partial",
       with(4, 2),
       {token_of({a, b, c}, 4)},
       {2, 1},
       {{"lookups", 2}, {"partial_quad", 3}}},
      // Blocks of lines 0 and 1 of which each has its banks; BC1 has eight in a line.
      {"six blocks",
       with_decoders(with(8, 2)),
       {token_of({blocks(Format::kBc1, 0, 4), blocks(Format::kBc4, 8, 2),
                  blocks(Format::kBc1, 0, 2), two_lines(2, 3)})},
       {4},
       {}},
      {"decoders",
       with_decoders(with(8, 2)),
       {token_of({blocks(Format::kBc1, 0, 4), blocks(Format::kBc1, 8, 3), two_lines(2, 3)})},
       {1, 2},
       {{"decoders", 3}, {"starved", 2}}},
      {"decoders, seventh of the third",
       with_decoders(with(8, 2)),
       {token_of(
           {blocks(Format::kBc1, 0, 4), blocks(Format::kBc1, 8, 2), blocks(Format::kBc1, 10, 1)})},
       {2, 1},
       {{"decoders", 2}, {"starved", 3}}},
      {"four decoders",
       with_decoders(with(8, 2), 4),
       {token_of({blocks(Format::kBc1, 0, 3), blocks(Format::kBc1, 2, 2),
                  blocks(Format::kBc1, 0, 4), blocks(Format::kBc1, 0, 1)})},
       {4},
       {}},
      {"four decoders, five blocks",
       with_decoders(with(8, 2), 4),
       {token_of({blocks(Format::kBc1, 0, 3), blocks(Format::kBc1, 2, 3)})},
       {1, 1},
       {{"decoders", 3}, {"starved", 3}}},
      // The same bytes in another format are another block, but the same words.
      {"formats of a block",
       with_decoders(with(8, 1), 4),
       {token_of({blocks(Format::kBc1, 0, 4), blocks(Format::kBc4, 0, 1)})},
       {1, 1},
       {{"decoders", 3}, {"starved", 3}}},
      // Lines 0 and 4 are in line bank 0. A word of a texel, then of a block of two and of four.
      {"banks, word of a block",
       with_decoders(with(8, 1)),
       {token_of({one_word(4, 1), blocks(Format::kBc1, 0, 1)})},
       {1, 1},
       {{"banks", 3}, {"starved", 3}}},
      {"banks, last word of a block",
       with_decoders(with(8, 1)),
       {token_of({one_word(4, 3), blocks(Format::kBc3, 0, 1)})},
       {1, 1},
       {{"banks", 3}, {"starved", 3}}},
      {"banks, word after a block",
       with_decoders(with(8, 1)),
       {token_of({one_word(4, 2), blocks(Format::kBc1, 0, 1)})},
       {2},
       {{"starved", 2}}},
      {"banks before decoders",
       with_decoders(with(8, 1), 4),
       {token_of({blocks(Format::kBc1, 0, 4), blocks(Format::kBc1, 32, 1)})},
       {1, 1},
       {{"banks", 3}, {"starved", 3}}},
      {"set before decoders",
       with_decoders(with(8, 2), 4),
       {token_of({in_blocks(Format::kBc1, {at(32, 0), at(32, 0), at(64, 2), at(64, 2)}),
                  blocks(Format::kBc1, 0, 4)})},
       {1, 1},
       {{"set", 3}, {"starved", 3}}},
      {"width 2, decoders",
       with_decoders(of_width(2)),
       {token_of({blocks(Format::kBc1, 0, 4), blocks(Format::kBc1, 4, 3)})},
       {1, 1},
       {{"decoders", 1}, {"starved", 1}}},
      {"width 2", of_width(2), {token_of({one_word(0, 0), one_word(1, 0)})}, {2}, {}},
      {"width 2, lookups",
       of_width(2),
       {token_of({two_lines(0, 1), request({at(2, 4), at(3, 4), at(4, 5), at(4, 5)})})},
       {1, 1},
       {{"lookups", 1}, {"starved", 1}}},
      {"width 2, banks",
       of_width(2),
       {token_of({one_word(0, 0), one_word(2, 0)})},
       {1, 1},
       {{"banks", 1}, {"starved", 1}}},
  };
}

// Groups leave one per cycle, with exactly these requests and slots.
class Limits : public testing::TestWithParam<Limit> {};
TEST_P(Limits, GroupIsLongestSequenceWithinLimits) {
  const Limit& c = GetParam();
  FormerBench b(c.build);
  std::vector<TexelToken> asked;
  for (const TexelGroup& token : c.tokens) {
    b.ends.source.add(token);
    asked.insert(asked.end(), token.at.begin(), token.at.begin() + token.count);
  }
  b.clock.run(20);
  std::vector<std::pair<Cycle, int>> expected;
  for (const int requests : c.groups) expected.emplace_back(kThrough + expected.size(), requests);
  EXPECT_EQ(b.groups(), expected);
  EXPECT_EQ(slots_of(b.former), c.slots);
  EXPECT_EQ(b.former.requests.value(), asked.size());
  EXPECT_EQ(b.former.slots.value(), c.groups.size() * static_cast<std::size_t>(c.build.width));
  check_slots(b.former);
  // Every request in order, with its addresses as lines of the group, in the order of first use.
  std::size_t i = 0;
  for (const auto& taken : b.ends.sink.taken) {
    const LineGroup& group = taken.token;
    std::vector<std::uint32_t> lines;
    for (std::size_t n = 0; n < group.count; ++n, ++i) {
      if (!asked[i].ticket.valid) continue;
      for (std::size_t k = 0; k < 4; ++k) {
        const std::uint32_t line = group.line[group.at[n].index[k]];
        EXPECT_EQ(64 * line + group.at[n].offset[k], asked[i].address[k]);
        if (std::find(lines.begin(), lines.end(), line) == lines.end()) {
          lines.push_back(line);
          EXPECT_EQ(group.turned[lines.size() - 1], asked[i].turned[k / 2]);
        }
      }
    }
    EXPECT_EQ(lines, std::vector(group.line.begin(), group.line.begin() + group.lines));
  }
  EXPECT_EQ(i, asked.size());
}
INSTANTIATE_TEST_SUITE_P(TextureRtlGroupFormer, Limits, testing::ValuesIn(limits()),
                         [](const auto& test) {
                           std::string name = test.param.name;
                           std::erase_if(name, [](char c) { return !std::isalnum(c); });
                           return name;
                         });

// A cycle in which nothing has come is counted when the next group leaves; the last ones are not.
TEST(TextureRtlGroupFormer, StarvesBetweenGroupsOnly) {
  FormerBench b;
  const TexelGroup full = token_of({in_line(0), in_line(0), in_line(0), in_line(0)});
  b.ends.source.add(5, full);
  b.ends.source.add(9, full);
  b.clock.run(10);  // the second one is pushed in 9
  EXPECT_EQ(b.former.slots.value(), 4u);
  EXPECT_EQ(slots_of(b.former), Slots{});
  b.clock.run(20);
  EXPECT_THAT(b.groups(), ElementsAre(std::pair(5 + kThrough, 4), std::pair(9 + kThrough, 4)));
  EXPECT_EQ(slots_of(b.former), (Slots{{"starved", 4u * 3}}));
  EXPECT_EQ(b.former.slots.value(), 4u * 5);
  // A reset forgets what was not counted, and the next group is the first one again.
  b.clock.set_reset_n(false);
  b.clock.run(1);
  b.clock.set_reset_n(true);
  b.ends.source.add(b.clock.cycle() + 4, full);
  b.clock.run(20);
  EXPECT_EQ(slots_of(b.former), Slots{});
  EXPECT_EQ(b.former.slots.value(), 4u);
}

// The buffer holds two tokens of four; further ones wait in the link until all of one fits.
TEST(TextureRtlGroupFormer, TokenWaitsUntilAllOfItFits) {
  FormerBench b(with(4, 2));
  b.ends.sink.hold_to = 20;
  const TexelGroup token = token_of({two_lines(0, 1), two_lines(2, 3), two_lines(4, 5)});
  for (int i = 0; i < 6; ++i) b.ends.source.add(token);
  b.clock.run(20);
  // Groups of two wait in the link; of the third token one request has left.
  EXPECT_EQ(b.ends.out.occupancy(), 2u);
  EXPECT_EQ(b.former.requests.value(), 4u);
  EXPECT_EQ(b.ends.in.pops(), 4u) << "12 requests, 4 have left";
  EXPECT_EQ(b.former.cycles_of(rtl::kStalledDownstream), 20 - 4u);
  b.clock.run(1);  // popped in 20, the link is free in 21
  EXPECT_EQ(b.ends.in.pops(), 4u);
  b.clock.run(1);  // two requests have left in 21: six wait, and three do not fit
  EXPECT_EQ(b.former.requests.value(), 6u);
  EXPECT_EQ(b.ends.in.pops(), 4u);
  b.clock.run(1);
  EXPECT_EQ(b.former.requests.value(), 8u);
  EXPECT_EQ(b.ends.in.pops(), 5u);
  b.clock.run(30);
  EXPECT_EQ(b.former.requests.value(), 18u);
  check_slots(b.former);
}

// The link is full in 4, 5, 6 and 7: each cycle counts under what the wire says in it; without a
// cause (a testbench holds the link) under `output`. The last cycle before a group counts, too.
struct Stop {
  SlotStall stall;
  const char* cause;
};
class Stops : public testing::TestWithParam<std::tuple<Stop, Cycle>> {};
TEST_P(Stops, CountUnderCauseInTheWire) {
  const auto& [stop, from] = GetParam();
  FormerBench b;
  b.ends.sink.hold_to = 7;
  for (int i = 0; i < 6; ++i)
    b.ends.source.add(token_of({in_line(0), in_line(0), in_line(0), in_line(0)}));
  b.clock.run(from);
  b.stall.drive(from - 1, stop.stall);
  b.clock.run(1);
  b.stall.drive(from, SlotStall::kWaitFill);  // from the next cycle on
  b.clock.run(10);
  EXPECT_THAT(cycles_of(b.ends.sink), ElementsAre(7, 8, 9, 10, 11, 12));
  Slots expected;
  for (Cycle t = 4; t < 8; ++t)
    expected[t < from ? "output" : t == from ? stop.cause : "wait_fill"] += 4;
  EXPECT_EQ(slots_of(b.former), expected);
  EXPECT_EQ(b.former.slots.value(), 4u * 10) << "groups from 2 to 11";
  check_slots(b.former);
}
INSTANTIATE_TEST_SUITE_P(TextureRtlGroupFormer, Stops,
                         testing::Combine(testing::Values(Stop{SlotStall::kNone, "output"},
                                                          Stop{SlotStall::kOutput, "output"},
                                                          Stop{SlotStall::kAllocate, "allocate"},
                                                          Stop{SlotStall::kMissQueue, "miss_queue"},
                                                          Stop{SlotStall::kWaitFill, "wait_fill"},
                                                          Stop{SlotStall::kWriteFill, "write_fill"},
                                                          Stop{SlotStall::kBankPass, "bank_pass"}),
                                          testing::Range<Cycle>(3, 9)));

// An empty buffer is starved, also while the link is full.
TEST(TextureRtlGroupFormer, EmptyBufferStarvesBehindFullLink) {
  FormerBench b;
  b.ends.sink.hold_to = 10;
  const TexelGroup full = token_of({in_line(0), in_line(0), in_line(0), in_line(0)});
  b.ends.source.add(full);
  b.ends.source.add(full);
  b.ends.source.add(5, full);  // in the buffer from 7 on
  b.clock.run(20);
  EXPECT_EQ(slots_of(b.former), (Slots{{"starved", 4u * 3}, {"output", 4u * 4}}));
  check_slots(b.former);
}

TEST(TextureRtlGroupFormer, RejectsSecondTokenInOneCycle) {
  FormerBench b;
  const TexelGroup full = token_of({in_line(0), in_line(0), in_line(0), in_line(0)});
  b.ends.in.push(0, full);
  b.clock.run(2);
  EXPECT_THAT(of_a_second_token(b.former, b.ends.in, full, b.clock),
              Rejects("requests_waiting", kTooMany));
}

}  // namespace
}  // namespace deburr::tb::texture_rtl::group_former_test
