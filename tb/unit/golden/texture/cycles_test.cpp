// SPDX-License-Identifier: MIT
// Predicted cycles and slots of small cases that are counted by hand from
// docs/reference/texture/cache.md, width.md and compressed.md. Preset paper: 17 cycles of address
// unit, 8 of the filter.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tuple>

#include "golden/texture/cycle_predictor.h"
#include "tb/unit/golden/texture/support.h"

namespace deburr::cycles_test {
namespace {

using namespace golden::texture;
using spec::texture::Parameters;
using Quad = std::vector<CacheRequest>;
using Quads = std::vector<Quad>;

constexpr std::uint32_t kLine = 64;

// A fragment of one request.
CacheRequest at(std::uint32_t a00, std::uint32_t a10, std::uint32_t a01, std::uint32_t a11) {
  return {.addresses = {a00, a10, a01, a11}, .last = true};
}
CacheRequest at(std::uint32_t address) { return at(address, address, address, address); }
const CacheRequest kInvalid = {.valid = false, .last = true};

Parameters narrow() { return preset_parameters(spec::texture::Preset::kPaper); }
Parameters wide() {
  Parameters p = narrow();
  p.width = p.fragments = 4;
  p.cache_outstanding = 0;
  p.cache_lookups = 8;
  p.cache_allocations = 4;
  p.cache_line_banks = 4;
  p.cache_bank_reads = 2;
  p.cache_fill_writes = 4;
  return p;
}

CyclePrediction predict(const Parameters& p, const Quads& quads, const MemoryTiming& memory = {}) {
  CyclePredictor predictor(p, memory);
  for (const Quad& quad : quads) predictor.add(quad);
  return predictor.finish();
}
std::uint64_t cycles(const Parameters& p, const Quads& quads, const MemoryTiming& memory = {}) {
  return predict(p, quads, memory).cycles;
}

Quads repeated(const Quad& quad, int n) { return Quads(static_cast<std::size_t>(n), quad); }
Quads joined(Quads first, const Quads& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}
// n quads; all requests of quad i read line first + i.
Quads lines(std::uint32_t first, std::uint32_t n, std::size_t requests) {
  Quads quads;
  for (std::uint32_t i = 0; i < n; ++i) quads.push_back(Quad(requests, at((first + i) * kLine)));
  return quads;
}

// ---- width 1 ------------------------------------------------------------------------------------

TEST(Cycles, OneFragmentTakesTheLatencyOfTheUnit) {
  EXPECT_EQ(cycles(narrow(), {{kInvalid}}), 30u);
  EXPECT_EQ(cycles({}, {{kInvalid}}), 53u);
  Parameters p = narrow();
  p.footprint = spec::texture::FootprintRule::kExact;
  EXPECT_EQ(cycles(p, {{kInvalid}}), 47u);
  p.axes = spec::texture::Axes::kEight;
  p.axis_cycles = 2;
  EXPECT_EQ(cycles(p, {{kInvalid}}), 51u);
  p = narrow();
  p.axes = spec::texture::Axes::kEight;
  p.axis_cycles = 4;
  p.log2 = spec::texture::Log2Rule::kExact;
  p.srgb_output = spec::texture::SrgbOutput::kEncoded;
  EXPECT_EQ(cycles(p, {{kInvalid}}), 30u + 6 + 3 + 2 + 1);
}

TEST(Cycles, FragmentTakesMaximumOfRequestsAndAxisCycles) {
  Parameters p = narrow();
  p.axes = spec::texture::Axes::kEight;
  for (const int axis_cycles : {1, 2, 4}) {
    p.axis_cycles = axis_cycles;
    const std::uint64_t one = cycles(p, {{kInvalid}});
    EXPECT_EQ(cycles(p, repeated({kInvalid}, 50)), one + 49 * static_cast<unsigned>(axis_cycles));
  }
  CacheRequest first = at(0);
  first.last = false;
  const Quad three = {first, first, at(0)};
  EXPECT_EQ(cycles(narrow(), repeated(three, 50)), 135u + 149);
  // A quad without covered lanes takes a cycle too.
  EXPECT_EQ(cycles(narrow(), {{}, {}, {kInvalid}, {}, {kInvalid}}), 34u);
}

TEST(Cycles, AMissTakesTheTimesOfTheTable) {
  EXPECT_EQ(cycles(narrow(), {{at(0)}}), 30u + 5 + 100);
  EXPECT_EQ(cycles(narrow(), {{at(0, kLine, 0, kLine)}}), 136u);
  EXPECT_EQ(cycles(narrow(), {{at(0, kLine, 2 * kLine, 3 * kLine)}}), 138u);
  EXPECT_EQ(cycles(narrow(), {{at(0)}}, {.latency = 7}), 30u + 5 + 7);
  EXPECT_EQ(cycles(narrow(), joined({{at(0)}}, repeated({at(4)}, 10))), 145u);
  EXPECT_EQ(predict(narrow(), {{at(0), at(4), at(kLine), at(0)}}).fills, 2u);
}

TEST(Cycles, ANarrowBusDelaysLines) {
  const Quads misses = lines(0, 20, 1);
  EXPECT_EQ(cycles(narrow(), misses, {.bytes_per_cycle = 64}), 135u + 19);
  EXPECT_EQ(cycles(narrow(), misses, {.bytes_per_cycle = 0}), 135u + 19);
  EXPECT_EQ(cycles(narrow(), misses, {.bytes_per_cycle = 16}), 135u + 3 + 19 * 4);
  Parameters p = narrow();
  p.cache_line_bytes = 128;  // two beats
  EXPECT_EQ(cycles(p, {{at(0)}}, {.bytes_per_cycle = 0}), 136u);
  EXPECT_EQ(cycles(p, {{at(0)}, {at(128)}}, {.bytes_per_cycle = 0}), 138u);
}

TEST(Cycles, EveryBankPassAndEveryFurtherLineTakesACycle) {
  const auto after_lines_0_and_1 = [](const CacheRequest& request) {
    return cycles(narrow(), {{at(0, kLine, 0, kLine)}, {request}}) - 136;
  };
  EXPECT_EQ(after_lines_0_and_1(at(0, kLine + 4, 8, 12)), 1u);
  EXPECT_EQ(after_lines_0_and_1(at(0, kLine, 0, kLine)), 2u);
  EXPECT_EQ(after_lines_0_and_1(at(0, 0, 4, kLine + 4)), 2u);
  EXPECT_EQ(after_lines_0_and_1(at(0, 3, 1, 2)), 1u);  // bytes of one word
  // Words 0 and 8 change places in a line that was first read by an odd row.
  CacheRequest odd_row_first = at(0, 0, kLine, kLine);
  odd_row_first.turned = {false, true};
  for (const std::uint32_t word : {0u, 8u}) {
    EXPECT_EQ(cycles(narrow(), {{odd_row_first}, {at(0, 0, kLine + 4 * word, kLine)}}) - 136,
              word == 8 ? 2u : 1u);
  }
  // Two passes of lines 0 and 1, and two lines to write, which have arrived: three cycles.
  Quads quads = {{at(0, kLine, 0, kLine)}};
  for (int i = 0; i < 40; ++i) quads.push_back({at(0, kLine, 0, kLine)});
  const std::uint64_t before = cycles(narrow(), quads, {.latency = 10});
  quads.push_back({at(0, kLine, 5 * kLine, 6 * kLine)});
  EXPECT_EQ(cycles(narrow(), quads, {.latency = 10}) - before, 3u);
}

// With a miss per request, an entry of the FIFO is held for L + 7 cycles and one of the FillBuffer
// for L + 6.
TEST(Cycles, FifoAndFillBufferLimitTheRateOfMisses) {
  const Quads misses = lines(0, 500, 1);
  const auto with = [&](int fifo, int outstanding, const MemoryTiming& memory = {}) {
    Parameters p = narrow();
    p.cache_fifo_depth = fifo;
    p.cache_outstanding = outstanding;
    return cycles(p, misses, memory);
  };
  EXPECT_EQ(with(107, 106), 135u + 499);
  EXPECT_EQ(with(0, 106), 135u + 499);  // derived
  EXPECT_EQ(with(106, 106), 135u + 499 + 499 / 106);
  EXPECT_EQ(with(107, 105), 135u + 499 + 499 / 105);
  EXPECT_EQ(with(0, 106, {.latency = 99}), 134u + 499);
  // 32 x width x (latency + 12) / 112 entries, rounded up to a multiple of 4, at least 8 and at
  // most 256.
  EXPECT_EQ(with(0, 0, {.latency = 5}), 40u + 499 + 499 / 8 * (11 - 8));
  EXPECT_EQ(with(0, 0, {.latency = 40}), 75u + 499 + 499 / 16 * (46 - 16));
  EXPECT_EQ(with(0, 0, {.latency = 101}), 136u + 499 + 499 / 36 * (107 - 36));
  EXPECT_EQ(with(0, 0, {.latency = 1000}), 1035u + 499 + 499 / 256 * (1006 - 256));
  EXPECT_EQ(with(0, 256, {.outstanding = 50}), 135u + 499 + 499 / 50 * 50);
}

// ---- groups -------------------------------------------------------------------------------------

TEST(Cycles, GroupFormerTakesTwoCycles) {
  for (const int width : {2, 4}) {
    Parameters p = wide();
    p.width = p.fragments = width;
    EXPECT_EQ(cycles(p, {{kInvalid}}), 32u);
    EXPECT_EQ(cycles(p, repeated(Quad(4, kInvalid), 50)), 32u + 50 * 4 / width - 1);
  }
}

// Groups of one quad of four fragments, and the slots of the first limit.
struct Formed {
  std::uint64_t groups;
  Slots slots;
};
Formed formed(const Parameters& p, const Quad& quad) {
  const CyclePrediction prediction = predict(p, {quad});
  return {prediction.groups, prediction.slots};
}

TEST(Cycles, GroupHasAtMostLDistinctLines) {
  const CacheRequest four_lines = at(0, kLine, 2 * kLine, 3 * kLine);
  const CacheRequest two_more = at(4 * kLine, 5 * kLine, 4 * kLine, 5 * kLine);
  Parameters p = wide();
  for (const int lookups : {4, 5, 6, 7}) {
    p.cache_lookups = lookups;
    const Formed six = formed(p, {four_lines, two_more, at(0), at(kLine)});
    EXPECT_EQ(six.groups, lookups < 6 ? 2u : 1u) << lookups;
    EXPECT_EQ(six.slots.lookups, lookups < 6 ? 3u : 0u) << lookups;
    const Formed seven = formed(p, {four_lines, two_more, at(6 * kLine), at(kLine)});
    EXPECT_EQ(seven.groups, lookups < 7 ? 2u : 1u) << lookups;
    EXPECT_EQ(seven.slots.lookups, lookups < 6 ? 3u : lookups < 7 ? 2u : 0u) << lookups;
  }
}

TEST(Cycles, GroupReadsAtMostRWordsOfABank) {
  Parameters p = wide();
  const Quad three_words = {at(0), at(4 * kLine), at(8 * kLine), at(0)};
  EXPECT_EQ(formed(p, three_words).groups, 2u);
  EXPECT_EQ(formed(p, three_words).slots.banks, 2u);
  EXPECT_EQ(formed(p, {at(0), at(4 * kLine), at(4 * kLine + 3), at(0)}).groups, 1u);
  EXPECT_EQ(formed(p, {at(0), at(4 * kLine), at(8 * kLine + 4), at(0)}).groups, 1u);
  EXPECT_EQ(formed(p, {at(0), at(4 * kLine), at(9 * kLine), at(0)}).groups, 1u);
  p.cache_line_banks = 8;
  EXPECT_EQ(formed(p, three_words).groups, 1u);
  p.cache_line_banks = 4;
  p.cache_bank_reads = 1;
  EXPECT_EQ(formed(p, three_words).groups, 4u);
  EXPECT_EQ(formed(p, three_words).slots.banks, 9u);
  CacheRequest odd_row = at(4 * kLine);
  odd_row.turned = {true, true};
  EXPECT_EQ(formed(p, {at(0), odd_row, at(0), at(0)}).groups, 1u);
}

TEST(Cycles, GroupHasAtMostWaysLinesOfASet) {
  Parameters p = wide();  // 128 sets
  const auto in_set_0 = [](std::uint32_t i) { return at(i * 128 * kLine + i * 4); };
  const Quad three = {in_set_0(0), in_set_0(1), in_set_0(2), in_set_0(0)};
  EXPECT_EQ(formed(p, three).groups, 2u);
  EXPECT_EQ(formed(p, three).slots.set, 2u);
  EXPECT_EQ(formed(p, {in_set_0(0), in_set_0(1), in_set_0(0), at(kLine)}).groups, 1u);
  p.cache_ways = 4;  // 64 sets
  EXPECT_EQ(formed(p, three).groups, 1u);
  p.cache_ways = 2;
  p.cache_bytes = 8192;
  EXPECT_EQ(formed(p, three).groups, 2u);
}

TEST(Cycles, TheFirstOfSeveralLimitsIsTheCause) {
  Parameters p = wide();
  p.cache_lookups = 4;
  // The third request exceeds all three limits at once: it needs a fifth line, a third word of bank
  // 0 and a third line of set 0.
  const auto in_set_0 = [](std::uint32_t i) { return i * 128 * kLine; };
  const Quad quad = {at(in_set_0(0), in_set_0(1), in_set_0(0), kLine), at(2 * kLine),
                     at(in_set_0(2)), at(in_set_0(2))};
  EXPECT_EQ(formed(p, quad).slots.lookups, 2u);
  p.cache_lookups = 5;
  EXPECT_EQ(formed(p, quad).slots.lookups, 0u);
  EXPECT_EQ(formed(p, quad).slots.banks, 2u);
}

TEST(Cycles, ARequestThatExceedsALimitLeavesAlone) {
  Parameters p = wide();
  p.cache_bank_reads = 1;
  const Formed alone = formed(p, {at(0, 4 * kLine, 0, 0), kInvalid, at(4), at(8)});
  EXPECT_EQ(alone.groups, 2u);
  EXPECT_EQ(alone.slots.banks, 3u);
}

TEST(Cycles, WalkingRegistersJoinTwoFragmentGroups) {
  const auto quad = [](std::size_t requests) { return Quad(requests, kInvalid); };
  Parameters p = wide();
  EXPECT_EQ(cycles(p, repeated(quad(3), 40)), 32u + 39);  // one quad per cycle
  p.fragments = 2;
  EXPECT_EQ(cycles(p, repeated(quad(4), 40)), 32u + 79);
  // Fragment groups of 5 requests: 4, 1 + 3, 2 + 2, 3 + 1, 4, 5 ...
  p.fragments = 4;
  CacheRequest first = kInvalid;
  first.last = false;
  EXPECT_EQ(cycles(p, repeated({first, kInvalid, kInvalid, kInvalid, kInvalid}, 40)), 32u + 49);
  // 4, 4, 1 + 1, 1: never three fragment groups.
  Quad nine(8, first);
  nine.push_back(kInvalid);
  EXPECT_EQ(cycles(p, {nine, quad(1), quad(1)}), 32u + 3);
}

TEST(Cycles, PartialQuadsAndStarvedSlots) {
  Parameters p = wide();
  EXPECT_EQ(formed(p, Quad(4, kInvalid)).slots, (Slots{.requests = 4}));
  EXPECT_EQ(formed(p, Quad(3, kInvalid)).slots, (Slots{.requests = 3, .partial_quad = 1}));
  p.fragments = 2;
  EXPECT_EQ(formed(p, Quad(3, kInvalid)).slots,
            (Slots{.requests = 3, .partial_quad = 3, .starved = 2}));
  EXPECT_EQ(formed(p, Quad(2, kInvalid)).slots, (Slots{.requests = 2, .starved = 2}));
  // Two quads without covered lanes between two full ones.
  p.fragments = 4;
  const Quad full(4, kInvalid);
  EXPECT_EQ(predict(p, {full, {}, {}, full}).slots, (Slots{.requests = 8, .starved = 8}));
}

// ---- ports of the cache -------------------------------------------------------------------------

TEST(Cycles, TagStageAllocatesALinesPerCycle) {
  Parameters p = wide();
  for (const int allocations : {1, 2, 3, 4}) {
    p.cache_allocations = allocations;
    for (std::uint32_t misses = 1; misses <= 4; ++misses) {
      Quad quad;
      for (std::uint32_t i = 0; i < 4; ++i) quad.push_back(at(std::min(i, misses - 1) * kLine));
      const auto a = static_cast<unsigned>(allocations);
      EXPECT_EQ(cycles(p, {quad}), 32u + 105 + misses - 1 + (misses + a - 1) / a - 1)
          << allocations << ", " << misses;
    }
  }
}

// The TagStage takes four cycles per group: two groups wait in its link, and later ones leave every
// fourth cycle.
TEST(Cycles, AllocateStallsTheGroupFormer) {
  Parameters p = wide();
  p.cache_allocations = 1;
  Quads quads;
  for (std::uint32_t i = 0; i < 6; ++i)
    quads.push_back({at(4 * i * kLine), at((4 * i + 1) * kLine), at((4 * i + 2) * kLine),
                     at((4 * i + 3) * kLine)});
  EXPECT_EQ(predict(p, quads).slots, (Slots{.requests = 24, .allocate = 3 * 3 * 4}));
}

// While the first group waits for its line, `depth` groups fit into the FIFO, two into the link
// before it, one into the TagStage and two into its link.
TEST(Cycles, AFullFifoStallsTheGroupFormer) {
  Parameters p = wide();
  const Quads quads = repeated(Quad(4, at(0)), 100);
  for (const int depth : {2, 5, 6, 26, 27}) {
    p.cache_fifo_depth = depth;
    const Slots slots = predict(p, quads, {.latency = 20}).slots;
    EXPECT_EQ(slots,
              (Slots{.requests = 400, .wait_fill = 4u * (27u - static_cast<unsigned>(depth))}));
  }
  p.cache_fifo_depth = 0;  // 40 + 4 + 3 + 16
  const Quads four_lines = joined({{at(0), at(kLine), at(2 * kLine), at(3 * kLine)}}, quads);
  EXPECT_EQ(predict(p, four_lines, {.latency = 40, .outstanding = 1}).slots,
            (Slots{.requests = 404, .wait_fill = 4 * (4 * 40 + 7 - 63 - 2), .write_fill = 4 * 2}));
}

// While the GroupFormer is blocked, its buffer and the walking registers take one quad more than
// they hold in the flow. A full link gives no quad in advance: it takes the next one a cycle late.
TEST(Cycles, BufferAndWalkingRegistersBridgeTwoGapsAfterAStall) {
  Parameters p = wide();
  p.cache_fifo_depth = 2;
  for (const int gap : {1, 2, 3, 20}) {
    const Quads quads = joined(repeated(Quad(4, at(0)), 60),
                               joined(repeated({}, gap), repeated(Quad(4, at(0)), 10)));
    const auto cycles_of_gap = static_cast<unsigned>(gap);
    EXPECT_EQ(predict(p, quads, {.latency = 100}).slots.starved,
              4 * (std::max(cycles_of_gap, 2u) - 2));
    // Width 1 has neither.
    Parameters one = narrow();
    one.cache_fifo_depth = 2;
    const Quads single =
        joined(repeated({at(0)}, 60), joined(repeated({}, gap), repeated({at(0)}, 10)));
    EXPECT_EQ(cycles(one, single), 135u + 69 + cycles_of_gap);
  }
}

TEST(Cycles, AFullMissQueueStallsTheGroupFormer) {
  Parameters p = wide();
  p.cache_outstanding = 8;
  const CyclePrediction prediction = predict(p, lines(0, 200, 4));
  // 8 lines in 106 cycles, the first one in cycle 22.
  const auto sent = [](unsigned line) { return 22 + line / 8 * 106 + line % 8; };
  EXPECT_EQ(prediction.cycles, 137u + sent(199) - 22);
  // 8 lines wait in the MissQueue, 2 in its link, 1 in the TagStage and 2 in its link: when line n
  // is sent, the MissQueue pops line n + 8, and two cycles later group n + 13 leaves.
  EXPECT_EQ(prediction.slots.all(), 4u * (sent(199 - 13) + 2 - 18 + 1));
  EXPECT_EQ(prediction.slots.requests, 800u);
  EXPECT_EQ(prediction.slots.miss_queue, prediction.slots.all() - 800);
}

// Requests of 4 words of one bank hold the DataStage until the four lines of the last group have
// arrived.
Quads held_then(const Quad& last, int holding) {
  Quads quads = {{at(0)}, {at(4 * kLine)}, {at(8 * kLine)}, {at(12 * kLine)}};
  for (int i = 0; i < holding; ++i) quads.push_back({at(0, 4 * kLine, 8 * kLine, 12 * kLine)});
  quads.push_back(last);
  return quads;
}

TEST(Cycles, DataStageReadsRWordsPerPass) {
  Parameters p = wide();
  const auto growth = [&] {
    return cycles(p, held_then({kInvalid}, 21), {.latency = 10}) -
           cycles(p, held_then({kInvalid}, 20), {.latency = 10});
  };
  p.cache_bank_reads = 1;
  EXPECT_EQ(growth(), 4u);
  p.cache_bank_reads = 2;
  EXPECT_EQ(growth(), 2u);
  p.cache_line_banks = 8;
  EXPECT_EQ(growth(), 1u);
}

TEST(Cycles, DataStageWritesDLinesPerCycleIntoDifferentBanks) {
  Parameters p = wide();
  const auto taken = [&](std::initializer_list<std::uint32_t> missed) {
    Quad last;
    for (const std::uint32_t line : missed) last.push_back(at(line * kLine + 4 * line % 64));
    return cycles(p, held_then(last, 20), {.latency = 10}) -
           cycles(p, held_then({kInvalid}, 20), {.latency = 10});
  };
  for (const int writes : {1, 2, 4}) {
    p.cache_fill_writes = writes;
    EXPECT_EQ(taken({16, 17, 18, 19}), static_cast<unsigned>(4 / writes - 1)) << writes;
    EXPECT_EQ(taken({16, 17, 18}), (writes == 4 ? 0u : writes == 2 ? 1u : 2u)) << writes;
    EXPECT_EQ(taken({16, 20, 24, 28}), 3u) << writes;
    EXPECT_EQ(taken({16, 17, 20, 21}), (writes == 1 ? 3u : 1u)) << writes;
    EXPECT_EQ(taken({16, 20, 17, 21}), (writes == 1 ? 3u : 2u)) << writes;
  }
}

// The FIFO is full, and each group of one request takes four passes: one cycle in which it leaves
// and three with a stall.
TEST(Cycles, BankPassesStallTheGroupFormer) {
  Parameters p = wide();
  p.cache_bank_reads = 1;
  p.cache_fifo_depth = 2;
  const auto slots = [&](int n) {
    return predict(p, held_then({kInvalid}, n), {.latency = 10}).slots;
  };
  const Slots fewer = slots(30), more = slots(40);
  EXPECT_EQ(more.banks - fewer.banks, 30u);
  EXPECT_EQ(more.bank_pass - fewer.bank_pass, 120u);
  EXPECT_EQ(more.all() - fewer.all(), 160u);
}

// The same with four lines to write into one bank.
TEST(Cycles, WritesStallTheGroupFormer) {
  Parameters p = wide();
  p.cache_fifo_depth = 2;
  const auto slots = [&](std::uint32_t n) {
    Quads quads;
    for (std::uint32_t i = 0; i < n; ++i) {
      Quad quad;
      for (std::uint32_t k = 0; k < 4; ++k) quad.push_back(at((16 * i + 4 * k) * kLine + 4 * k));
      quads.push_back(quad);
    }
    return predict(p, quads, {.latency = 1}).slots;
  };
  const Slots fewer = slots(30), more = slots(40);
  EXPECT_EQ(more.write_fill - fewer.write_fill, 120u);
  EXPECT_EQ(more.all() - fewer.all(), 160u);
}

// ---- BlockDecoder -------------------------------------------------------------------------------

Parameters with_decoders(Parameters p, int decoders) {
  p.decode = spec::texture::Decode::kAfter;
  p.cache_decoders = decoders;
  return p;
}
CacheRequest blocks(spec::texture::Format format, std::uint32_t a00, std::uint32_t a10,
                    std::uint32_t a01, std::uint32_t a11) {
  CacheRequest request = at(a00, a10, a01, a11);
  request.format = format;
  return request;
}
CacheRequest bc1(std::uint32_t a00, std::uint32_t a10, std::uint32_t a01, std::uint32_t a11) {
  return blocks(spec::texture::Format::kBc1, a00, a10, a01, a11);
}
CacheRequest bc3(std::uint32_t a00, std::uint32_t a10, std::uint32_t a01, std::uint32_t a11) {
  return blocks(spec::texture::Format::kBc3, a00, a10, a01, a11);
}

TEST(Cycles, BlockDecoderTakesThreeCycles) {
  for (const CacheRequest& request : {kInvalid, at(0), bc1(0, 8, 16, 24), bc3(0, 0, 16, 16)}) {
    EXPECT_EQ(cycles(with_decoders(narrow(), 0), {{request}}), cycles(narrow(), {{request}}) + 3);
    EXPECT_EQ(cycles(with_decoders(wide(), 0), {{request}}), cycles(wide(), {{request}}) + 3);
  }
}

TEST(Cycles, BlockDecoderTakesDBlocksPerCycle) {
  const std::array<CacheRequest, 4> of_n_blocks = {bc1(8, 8, 8, 8), bc1(8, 0, 8, 0),
                                                   bc1(0, 8, 16, 8), bc1(24, 16, 8, 0)};
  for (const unsigned decoders : {1u, 2u, 3u, 4u, 0u}) {
    const Parameters p = with_decoders(narrow(), static_cast<int>(decoders));
    for (unsigned n = 1; n <= 4; ++n) {
      const unsigned d = decoders == 0 ? 4 : decoders, interval = (n + d - 1) / d;
      const Quad quad = {of_n_blocks[n - 1]};
      EXPECT_EQ(cycles(p, {quad}), 30u + 105 + 3 + interval - 1) << decoders << ", " << n;
      EXPECT_EQ(cycles(p, repeated(quad, 50)), 30u + 105 + 3 + 50 * interval - 1)
          << decoders << ", " << n;
    }
    // Texels are not blocks.
    EXPECT_EQ(cycles(p, repeated({at(0, 4, 8, 12)}, 50)), 30u + 105 + 3 + 49);
  }
}

// A decoder that takes four cycles per request holds the link, stage 2 of the DataStage and so its
// stage 1. Of the following requests, of four passes and no blocks, the DataStage reads the first
// three in the time in which the decoder empties the link.
TEST(Cycles, BlockDecoderStallsTheDataStage) {
  const Parameters p = with_decoders(narrow(), 1);
  const CacheRequest lines_0_to_3 = at(0, kLine, 2 * kLine, 3 * kLine);
  const auto growth = [&](int passes) {
    const Quads heavy = joined({{lines_0_to_3}}, repeated({bc1(0, 8, 16, 24)}, 20));
    return cycles(p, joined(heavy, repeated({lines_0_to_3}, passes))) - cycles(p, heavy);
  };
  const std::array<unsigned, 6> expected = {0, 1, 2, 3, 7, 11};
  for (int passes = 0; passes < 6; ++passes)
    EXPECT_EQ(growth(passes), expected[static_cast<std::size_t>(passes)]) << passes;
}

TEST(Cycles, BlocksInTheSameBanksTakePasses) {
  const Parameters p = with_decoders(narrow(), 0);
  const auto passes = [&](const CacheRequest& request) {
    const Quads before = {{at(0, kLine, 2 * kLine, 3 * kLine)}, {kInvalid}};
    return cycles(p, joined(before, {{request}})) - cycles(p, before);
  };
  EXPECT_EQ(passes(bc1(0, 8, kLine + 16, kLine + 24)), 1u);
  EXPECT_EQ(passes(bc1(0, 0, kLine, kLine)), 2u);
  EXPECT_EQ(passes(bc1(0, kLine, 2 * kLine, 3 * kLine)), 4u);
  EXPECT_EQ(passes(bc3(0, 16, kLine + 32, kLine + 48)), 1u);
  EXPECT_EQ(passes(bc3(0, kLine, 16, kLine + 16)), 2u);
  // A word of rgba8 per texel: the second word of the block is not read.
  EXPECT_EQ(passes(at(0, 0, kLine + 4, kLine + 4)), 1u);
  // A block whose line misses is not read from the banks.
  EXPECT_EQ(passes(bc1(0, 0, 9 * kLine, 9 * kLine)), passes(bc1(8, 8, 9 * kLine, 9 * kLine)));
  // A turned line has its words 0 to 7 in banks 8 to 15.
  CacheRequest odd_row_first = bc1(0, 0, kLine, kLine);
  odd_row_first.turned = {false, true};
  for (const std::uint32_t word : {0u, 2u, 6u, 8u}) {
    const Quads before = {{odd_row_first}, {kInvalid}};
    const CacheRequest second = bc1(0, 0, kLine + 4 * word, kLine + 4 * word);
    EXPECT_EQ(cycles(p, joined(before, {{second}})) - cycles(p, before), word == 8 ? 2u : 1u);
  }
}

TEST(Cycles, GroupHasAtMostDBlocks) {
  const CacheRequest four = bc1(0, 8, 16, 24), two_more = bc1(32, 40, 0, 8);
  const CacheRequest one_more = bc1(48, 48, 48, 48);
  for (const int decoders : {4, 5, 6, 0}) {
    const Parameters p = with_decoders(wide(), decoders);
    const int d = decoders == 0 ? 6 : decoders;
    const Formed six = formed(p, {four, two_more, two_more, at(0)});
    EXPECT_EQ(six.groups, d < 6 ? 2u : 1u) << decoders;
    EXPECT_EQ(six.slots.decoders, d < 6 ? 3u : 0u) << decoders;
    const Formed seven = formed(p, {four, two_more, one_more, at(0)});
    // D = 4: one request, one, two; D = 5: one, three.
    EXPECT_EQ(seven.groups, d == 4 ? 3u : 2u) << decoders;
    EXPECT_EQ(seven.slots.decoders, d == 4 ? 6u : d == 5 ? 3u : 2u) << decoders;
  }
  // The same bytes in another format are another block.
  const Parameters p = with_decoders(wide(), 4);
  const auto fifth = [&](spec::texture::Format format) {
    return formed(p, {four, blocks(format, 8, 8, 8, 8), at(0), at(0)}).slots.decoders;
  };
  EXPECT_EQ(fifth(spec::texture::Format::kBc1), 0u);
  EXPECT_EQ(fifth(spec::texture::Format::kEtc2Rgb), 3u);
}

// Blocks of one format share all banks or none; blocks and texels of other sizes may share a bank
// by any of their words.
TEST(Cycles, GroupReadsEveryWordOfABlock) {
  Parameters p = with_decoders(wide(), 0);
  p.cache_bank_reads = 1;
  const auto two = [&](const CacheRequest& a, const CacheRequest& b) {
    return formed(p, {a, b}).slots.banks;
  };
  const std::uint32_t same_line_bank = 4 * kLine;
  for (std::uint32_t word = 0; word < 8; ++word) {
    const CacheRequest texel = at(same_line_bank + 4 * word);
    EXPECT_EQ(two(bc1(0, 0, 0, 0), texel), word < 2 ? 3u : 0u) << word;
    EXPECT_EQ(two(texel, bc3(0, 0, 0, 0)), word < 4 ? 3u : 0u) << word;
  }
}

TEST(Cycles, DecodersAreTheLastCause) {
  Parameters p = with_decoders(wide(), 4);
  // The second request needs a fifth block, a third word of bank 0 and a third line of set 0.
  const auto in_set_0 = [](std::uint32_t i) { return i * 128 * kLine; };
  const CacheRequest first = bc1(in_set_0(0), in_set_0(1), 8, 16);
  EXPECT_EQ(formed(p, {first, bc1(in_set_0(2), 8, 8, 8)}).slots.banks, 3u);
  EXPECT_EQ(formed(p, {first, bc1(in_set_0(2) + 32, 8, 8, 8)}).slots.set, 3u);
  EXPECT_EQ(formed(p, {first, bc1(kLine + 32, 8, 8, 8)}).slots.decoders, 3u);
}

// ---- decode = before ----------------------------------------------------------------------------

Parameters before(Parameters p, int compressed_lines = 0) {
  p.decode = spec::texture::Decode::kBefore;
  p.cache_compressed_lines = compressed_lines;
  return p;
}
// Block `number` of bc1, all texels at position `inside`: eight blocks per memory line.
CacheRequest block(std::uint32_t number, std::uint8_t inside = 0) {
  CacheRequest request = bc1(8 * number, 8 * number, 8 * number, 8 * number);
  request.inside.fill(inside);
  return request;
}
CacheRequest memory_line(std::uint32_t line) { return block(8 * line); }

TEST(Before, AMissTakesTheTimesOfTheTable) {
  const Parameters p = before(narrow());
  EXPECT_EQ(cycles(p, {{kInvalid}}), 30u);
  for (const int latency : {1, 7, 100}) {
    const MemoryTiming memory{.latency = latency};
    const auto l = static_cast<unsigned>(latency);
    EXPECT_EQ(cycles(p, {{block(3)}}, memory), 30u + 5 + l + 6);
    EXPECT_EQ(cycles(p, {{at(0)}}, memory), 30u + 5 + l + 2);
  }
  for (const int width : {2, 4}) {
    Parameters w = wide();
    w.width = w.fragments = width;
    EXPECT_EQ(cycles(before(w), {{block(3)}}), cycles(w, {{at(0)}}) + 6);
    EXPECT_EQ(cycles(before(w), {{at(0)}}), cycles(w, {{at(0)}}) + 2);
    EXPECT_EQ(cycles(before(w), {{kInvalid}}), cycles(w, {{kInvalid}}));
  }
}

// The second block is in the FillBuffer in cycle 9 after its request, whatever the latency.
TEST(Before, AMissOfAPresentMemoryLineTakesNoMemory) {
  for (const CacheRequest& other :
       {block(7), blocks(spec::texture::Format::kEtc2Rgba8, 0, 0, 0, 0)}) {
    const Quads quads = joined({{block(0)}}, joined(repeated({}, 300), {{other}}));
    const CyclePrediction prediction = predict(before(narrow()), quads);
    EXPECT_EQ(prediction.cycles, 301u + 30 + 5 + 3);
    EXPECT_EQ(prediction.fills, 2u);
    EXPECT_EQ(prediction.memory_lines, 1u);
  }
  // A decoded line that is present takes neither.
  const Quads hit = joined({{block(0)}}, joined(repeated({}, 300), {{block(0, 5)}}));
  EXPECT_EQ(cycles(before(narrow()), hit), 301u + 30);
}

// Blocks of one memory line follow each other through the decoder; two lines also take the bus.
TEST(Before, BlocksWaitForTheirMemoryLineAndEnterInOrder) {
  const Parameters p = before(narrow());
  const auto two = [](std::uint32_t a, std::uint32_t b) {
    return Quads{{bc1(8 * a, 8 * b, 8 * a, 8 * b)}};
  };
  EXPECT_EQ(cycles(p, two(0, 1)), 141u + 1);
  EXPECT_EQ(cycles(p, two(0, 8)), 141u + 1);
  const MemoryTiming narrow_bus{.bytes_per_cycle = 16};
  EXPECT_EQ(cycles(p, two(0, 1), narrow_bus), 141u + 3 + 1);
  EXPECT_EQ(cycles(p, two(0, 8), narrow_bus), 141u + 3 + 4);
  // Block 1 is ready while block 8 waits for its line.
  const Quads three = {{block(0)}, {block(8)}, {block(1)}};
  EXPECT_EQ(cycles(p, three, narrow_bus), 141u + 3 + 4 + 1);
  EXPECT_EQ(predict(p, three).memory_lines, 2u);
}

// With four compressed lines, the fifth memory line replaces the first one, whose block enters the
// decoder in cycle 8 + L. The BlockFetcher pops it in 9 + L instead of 8.
TEST(Before, AMemoryLineInUseIsNotReplaced) {
  Quads quads;
  for (std::uint32_t line = 0; line < 4; ++line) quads.push_back({memory_line(line)});
  EXPECT_EQ(cycles(before(narrow(), 4), quads), 141u + 3);
  quads.push_back({memory_line(4)});
  EXPECT_EQ(cycles(before(narrow(), 8), quads), 141u + 4);
  EXPECT_EQ(cycles(before(narrow(), 4), quads), 141u + 5 + 100);
  quads.push_back({memory_line(5)});
  EXPECT_EQ(cycles(before(narrow(), 4), quads), 141u + 6 + 100);
  // Another block of the first line waits for those of lines 1 to 3.
  quads.erase(quads.begin() + 4, quads.end());
  quads.push_back({block(1)});
  quads.push_back({memory_line(4)});
  EXPECT_EQ(cycles(before(narrow(), 8), quads), 141u + 5);
  EXPECT_EQ(cycles(before(narrow(), 4), quads), 141u + 9 + 100);
  // A line of another texture is requested at once; its response holds the decoder for a cycle. A
  // present block needs no line.
  quads.back() = {at(4 * kLine)};
  EXPECT_EQ(cycles(before(narrow(), 4), quads), 141u + 5 + 1);
  quads.back() = {block(2)};
  EXPECT_EQ(cycles(before(narrow(), 4), quads), 141u + 5);
}

// The block is pushed in cycle 11 + L. A response for another texture that is passed on in this
// cycle belongs to a request four cycles later.
TEST(Before, ResponsesForOtherTexturesHavePriorityOverTheDecoder) {
  const Parameters p = before(narrow());
  for (int later = 1; later <= 6; ++later) {
    const Quads one =
        joined({{block(0)}}, joined(repeated({kInvalid}, later - 1), {{at(9 * kLine)}}));
    EXPECT_EQ(cycles(p, one), 141u + static_cast<unsigned>(later) + (later == 4 ? 1 : 0)) << later;
  }
  const Quads three = joined(joined({{block(0)}}, repeated({kInvalid}, 3)), lines(9, 3, 1));
  EXPECT_EQ(cycles(p, three), 141u + 6 + 3);
  // The decoder stalls as a whole: the two blocks stay next to each other.
  const Quads two_blocks =
      joined(joined({{block(0)}, {block(1)}}, repeated({kInvalid}, 2)), lines(9, 3, 1));
  EXPECT_EQ(cycles(p, two_blocks), 141u + 6 + 3);
}

// The block is in the last stage of the decoder in cycles 11 + L to 28 + L, while lines pass until
// 27 + L. Those are in the FillBuffer before the older fill.
TEST(Before, LinesOfOtherTexturesOvertakeBlocks) {
  const Parameters p = before(narrow());
  const Quads quads = joined({{block(0)}}, lines(9, 20, 1));
  EXPECT_EQ(cycles(p, quads), 141u + 17 + 20);
}

// Memory takes one line and holds the next one. Before these, two links of two lines, eight lines
// of the MissQueue, two in its link, a group in the TagStage and two in its link.
TEST(Before, LinksOfTheBlockFetcherHaveTwoEntries) {
  Parameters p = wide();
  p.cache_outstanding = 8;
  const MemoryTiming memory{.latency = 1000, .outstanding = 1};
  const auto stalls = [&](const Parameters& build, std::uint32_t n) {
    Quads quads;
    for (std::uint32_t line = 0; line < n; ++line) quads.push_back(Quad(4, memory_line(line)));
    return predict(build, quads, memory).slots.miss_queue > 0;
  };
  EXPECT_FALSE(stalls(before(p), 2 + 2 * 2 + 8 + 2 + 1 + 2));
  EXPECT_TRUE(stalls(before(p), 2 + 2 * 2 + 8 + 2 + 1 + 2 + 1));
}

TEST(Before, WordsAreThoseOfTheDecodedLine) {
  const auto passes = [&](const CacheRequest& request) {
    const Quads present = {{block(0)}, {block(1)}, {block(2)}, {block(3)}, {at(kLine)}, {kInvalid}};
    return cycles(before(narrow()), joined(present, {{request}})) -
           cycles(before(narrow()), present);
  };
  const auto of = [](std::array<std::uint32_t, 4> numbers, std::array<std::uint8_t, 4> inside) {
    CacheRequest request = bc1(8 * numbers[0], 8 * numbers[1], 8 * numbers[2], 8 * numbers[3]);
    request.inside = inside;
    return request;
  };
  EXPECT_EQ(passes(of({0, 1, 2, 3}, {15, 12, 3, 0})), 1u);
  EXPECT_EQ(passes(of({0, 0, 0, 0}, {5, 6, 9, 10})), 1u);
  EXPECT_EQ(passes(of({0, 1, 0, 1}, {7, 4, 7, 4})), 1u);
  EXPECT_EQ(passes(of({0, 1, 2, 2}, {5, 5, 6, 5})), 3u);
  EXPECT_EQ(passes(of({0, 1, 2, 3}, {9, 9, 9, 9})), 4u);
  // Lines of odd rows of blocks are not turned.
  for (const std::uint8_t word : {std::uint8_t{0}, std::uint8_t{8}}) {
    CacheRequest odd_row = of({0, 0, 9, 9}, {0, 0, 0, 0}),
                 second = of({0, 0, 9, 9}, {0, 0, word, word});
    odd_row.turned = second.turned = {false, true};
    const Quads first = {{odd_row}, {kInvalid}};
    EXPECT_EQ(cycles(before(narrow()), joined(first, {{second}})) - cycles(before(narrow()), first),
              word == 0 ? 2u : 1u);
  }
}

TEST(Before, LimitsOfAGroupFollowFromDecodedLines) {
  Parameters p = before(wide());
  // Six blocks of a memory line are six lines, and there is no limit on blocks.
  const CacheRequest four = bc1(0, 8, 16, 24), two_more = bc1(32, 40, 32, 40);
  for (const int lookups : {4, 5, 6, 8}) {
    p.cache_lookups = lookups;
    p.cache_bank_reads = 2;
    const Formed six = formed(p, {four, two_more});
    EXPECT_EQ(six.groups, lookups < 6 ? 2u : 1u) << lookups;
    EXPECT_EQ(six.slots.lookups, lookups < 6 ? 3u : 0u) << lookups;
  }
  EXPECT_EQ(formed(p, {four, bc1(32, 40, 48, 56)}).groups, 1u);
  // Blocks 0, 4 and 8 are in one line bank of four.
  EXPECT_EQ(formed(p, {block(0, 7), block(4, 7), block(8, 7)}).slots.banks, 2u);
  EXPECT_EQ(formed(p, {block(0, 7), block(4, 7), block(8, 6)}).slots.banks, 0u);
  EXPECT_EQ(formed(p, {block(0, 7), block(4, 7), block(9, 7)}).slots.banks, 0u);
  CacheRequest odd_row = block(8, 7);  // not turned
  odd_row.turned = {true, true};
  EXPECT_EQ(formed(p, {block(0, 7), block(4, 7), odd_row}).slots.banks, 2u);
  // Lines of 128 sets.
  EXPECT_EQ(formed(p, {block(0, 0), block(128, 1), block(256, 2)}).slots.set, 2u);
  EXPECT_EQ(formed(p, {block(0, 0), block(128, 1), block(257, 2)}).slots.set, 0u);
  // The codec is part of the number: line 0 of each format is in set 0.
  EXPECT_EQ(formed(p, {block(0, 0), at(4), blocks(spec::texture::Format::kEtc2Rgba8, 0, 0, 0, 0)})
                .slots.set,
            2u);
}

// ---- whole frames -------------------------------------------------------------------------------

// A plane of 128 x 128 pixels.
struct Frame {
  std::vector<Quad> quads;
  std::uint64_t fills = 0, memory_lines = 0;
  Frame(const Parameters& p, spec::texture::Format format) {
    spec::texture::Descriptor sampler;
    sampler.format = format;
    sampler.max_anisotropy_log2 = 4;
    const tb::texture::EncodedTexture texture(tb::texture::noise(256, 256, 1), sampler);
    TextureGolden golden(p, texture.memory);
    golden.set_texture(0, texture.descriptor);
    for (const auto& quad : tb::texture::GroundPlane{.size = 128}.quads()) {
      quads.emplace_back();
      golden.process(quad, quads.back());
    }
    fills = golden.work().line_fills;
    memory_lines = golden.work().memory_lines;
  }
};

TEST(Cycles, FillsAndRequestsOfAFrameDoNotDependOnTheWidth) {
  using spec::texture::Blend, spec::texture::Format;
  using spec::texture::Decode;
  for (const auto& [blend, format, decode] :
       {std::tuple{Blend::kSample, Format::kRgba8, Decode::kAfter},
        {Blend::kLevel, Format::kRgba8, Decode::kBefore},
        {Blend::kLevel, Format::kBc1, Decode::kAfter},
        {Blend::kLevel, Format::kBc1, Decode::kBefore},
        {Blend::kSample, Format::kEtc2Rgba8, Decode::kAfter},
        {Blend::kSample, Format::kEtc2Rgba8, Decode::kBefore}}) {
    Parameters p;
    p.decode = decode;
    p.blend = blend;
    const Frame frame(p, format);
    const bool fewer = decode == Decode::kBefore && format != Format::kRgba8;
    EXPECT_EQ(frame.memory_lines < frame.fills, fewer);
    const CyclePrediction one = predict(p, frame.quads);
    EXPECT_EQ(one.fills, frame.fills);
    EXPECT_EQ(one.memory_lines, frame.memory_lines);
    for (const int width : {2, 4}) {
      Parameters w = wide();
      w.decode = decode;
      w.width = w.fragments = width;
      const CyclePrediction prediction = predict(w, frame.quads);
      EXPECT_EQ(prediction.fills, frame.fills);
      EXPECT_EQ(prediction.memory_lines, frame.memory_lines);
      EXPECT_EQ(prediction.requests, one.requests);
      EXPECT_EQ(prediction.slots.requests, one.requests);
      EXPECT_EQ(prediction.slots.all() % static_cast<unsigned>(width), 0u);
      EXPECT_LT(prediction.cycles, one.cycles);
    }
  }
}

// Fields of each request: which lines are turned, positions in blocks, validity, and the last of
// its fragment.
TEST(Cycles, RequestsHaveTheRowsOfTheirTexelsAndTheEndOfTheirFragment) {
  const Parameters p = with_decoders(narrow(), 0);
  using spec::texture::Format, spec::texture::Layout;
  for (const auto& [layout, format] : {std::pair{Layout::kLinear, Format::kRgba8},
                                       {Layout::kTiled, Format::kRgba8},
                                       {Layout::kLinear, Format::kBc3},
                                       {Layout::kTiled, Format::kBc3}}) {
    const int side = format == Format::kBc3 ? 4 : 1;
    spec::texture::Descriptor sampler;
    sampler.layout = layout;
    sampler.format = format;
    sampler.max_anisotropy_log2 = 4;
    const tb::texture::EncodedTexture texture(tb::texture::noise(64, 64, 1), sampler);
    TextureGolden golden(p, texture.memory);
    golden.set_texture(0, texture.descriptor);
    for (std::int32_t row = 0; row < 16; ++row) {
      spec::texture::Quad quad;
      quad.coverage = 0b0101;
      quad.t.fill((row + 1) * (spec::texture::kCoordinateOne / 64));  // between row and row + 1
      Quad requests;
      golden.process(quad, requests);
      ASSERT_EQ(requests.size(), 2u);
      EXPECT_EQ(requests[0].turned[0], layout == Layout::kLinear && row / side % 2 == 1);
      EXPECT_EQ(requests[0].turned[1], layout == Layout::kLinear && (row + 1) / side % 2 == 1);
      EXPECT_EQ(requests[0].format, format);
      // Columns 63 and 0.
      const int y = 4 * (row % 4), next_y = 4 * ((row + 1) % 4);
      EXPECT_THAT(requests[0].inside, side == 4 ? testing::ElementsAre(y + 3, y, next_y + 3, next_y)
                                                : testing::ElementsAre(0, 0, 0, 0));
      EXPECT_TRUE(requests[0].last && requests[1].last);
      quad.texture = 3;
      golden.process(quad, requests);
      ASSERT_EQ(requests.size(), 4u);
      EXPECT_TRUE(requests[0].valid && !requests[2].valid && requests[2].last);
      quad.texture = 0;
      quad.s = {0, spec::texture::kCoordinateOne / 8, 0, spec::texture::kCoordinateOne / 8};
      requests.clear();
      golden.process(quad, requests);  // 16 samples
      ASSERT_EQ(requests.size(), 32u);
      for (std::size_t i = 0; i < 32; ++i) EXPECT_EQ(requests[i].last, i % 16 == 15) << i;
    }
  }
}

}  // namespace
}  // namespace deburr::cycles_test
