// SPDX-License-Identifier: MIT
// The write buffer of the WeightCombiner: the cycles in which blocks are transferred, by
// docs/reference/geometric/memory.md. tb/system/geometric_system_test.cpp compares the blocks and
// their order with the golden model.
#include <functional>

#include "tb/unit/rtl/geometric/combiner_bench.h"

namespace deburr::tb::geometric_rtl::write_buffer_test {
namespace {

using namespace rtl::geometric;  // NOLINT: names of units and tokens
using spec::geometric::CacheLines;
using spec::geometric::Weights;
using testing::ElementsAre;

// Sixteen blocks in the cache: (0, 0), (4, 0), (8, 0), ... have the same index.
Parameters with_buffer(int places, int fills = 0) {
  Parameters p;
  p.combine = spec::geometric::Combine::kMax;
  p.weight_blocks = CacheLines::k16;
  p.write_buffer = places;
  p.fills = fills;
  return p;
}
std::uint64_t address_of(int bx, int by = 0) {
  return static_cast<std::uint64_t>(64 * (512 * by + bx));
}
void draw(CombinerBench& b, std::initializer_list<int> columns) {
  for (const int bx : columns) b.source.add(CombinerBench::token(bx, 0));
  b.source.add(CombinerBench::end());
}

// The cycles in which the combiner sends a request or takes a response.
struct Port {
  explicit Port(CombinerBench& bench) : b(bench) {}
  void run() {
    while (!b.drawn->read(b.clock.cycle())) step();
    drawn = b.clock.cycle();
  }
  void step() {
    const std::uint64_t sent_before = sends().pushes(), got_before = gets().pops();
    const Cycle now = b.clock.cycle();
    if (before_cycle) before_cycle(now);
    b.clock.run(1);
    if (sends().pushes() != sent_before) sent.push_back(now);
    if (gets().pops() != got_before) got.push_back(now);
  }
  rtl::Link<rtl::MemoryRequest>& sends() { return b.unit.memory.requests_out.link(); }
  rtl::Link<rtl::MemoryResponse>& gets() { return b.unit.memory.responses_in.link(); }
  CombinerBench& b;
  std::function<void(Cycle)> before_cycle;
  std::vector<Cycle> sent, got;
  Cycle drawn = 0;
};

// Two blocks of one index alternately: each hits the buffer entry that the other has just taken.
TEST(WriteBuffer, OneHitPerCycle) {
  for (const bool buffered : {false, true}) {
    const std::string got = in_child([buffered] {
      CombinerBench b(with_buffer(buffered ? 1 : 0));
      for (int i = 0; i < 100; ++i)
        for (const int bx : {0, 4}) {
          WeightToken t = CombinerBench::token(bx, 0);
          t.place[0] = static_cast<std::uint8_t>(i % 16);
          t.coverage[0] = static_cast<std::uint8_t>(i + 1);
          t.forward = bx != 0;
          b.source.add(t);
        }
      b.source.add(CombinerBench::token(8, 0));
      b.source.add(CombinerBench::end());
      const Cycle from = b.clock.cycle();
      b.clock.run_until([&] { return b.in.pops() == 202; }, 100'000);
      const Cycle cycles = b.clock.cycle() - from;
      if (!buffered) return std::string(cycles > 2000 ? "waits" : "does not wait");
      b.until_drawn();
      // The largest coverage of each pixel is its last one.
      for (int i = 84; i < 100; ++i)
        for (const int bx : {0, 4}) {
          Weights wanted{};
          wanted[bx != 0] = static_cast<std::uint8_t>(i + 1);
          if (weights_at(b, 4 * bx + i % 4, i % 16 / 4) != wanted) return std::string("weights");
        }
      // From the source into stage 1.
      return std::to_string(cycles) + " " + std::to_string(b.unit.buffer_hits.value()) + " " +
             std::to_string(stalls(b.unit, "spill"));
    });
    EXPECT_EQ(got, buffered ? "203 198 0" : "waits");
  }
}

// A block that has left the buffer is read in the cycle after the response to its write, and not
// earlier.
TEST(WriteBuffer, BlockBeingWrittenIsWaitedFor) {
  CombinerBench b(with_buffer(1));
  draw(b, {0, 4, 8, 0});
  Port port(b);
  port.run();
  // The write of 0, its response, the read of 0; the write of 4, its response, and the line.
  ASSERT_EQ(port.sent.size(), 4u);
  EXPECT_EQ(port.sent[1], port.got[0] + 1);
  EXPECT_GT(stalls(b.unit, "spill"), 20u);
}

// The last token is in stage 5 five cycles after its push. Then one entry is read per cycle, and
// its request is sent in the next cycle.
TEST(WriteBuffer, OneBlockPerCycleIsWrittenAfterTheLastToken) {
  for (const int blocks : {1, 2, 5}) {
    const std::string got = in_child([blocks] {
      CombinerBench b(with_buffer(8));
      for (int i = 0; i < blocks; ++i) b.source.add(CombinerBench::token(4 * i, 0));
      b.clock.run(30);
      const Cycle from = b.clock.cycle();
      b.in.push(from, CombinerBench::end());
      Port port(b);
      port.run();
      std::string text;
      for (const Cycle c : port.sent) text += std::to_string(c - from) + " ";
      // `drawn` is driven in the cycle of the last response, if there is one.
      const Cycle last = port.got.empty() ? from + 5 : port.got.back();
      return text + "drawn " + std::to_string(port.drawn - last);
    });
    EXPECT_EQ(got, blocks == 1 ? "drawn 1" : blocks == 2 ? "7 drawn 1" : "7 8 9 10 drawn 1");
  }
}
TEST(WriteBuffer, FlushWaitsForTheLink) {
  CombinerBench b(with_buffer(8));
  for (int i = 0; i < 5; ++i) b.source.add(CombinerBench::token(4 * i, 0));
  b.clock.run(30);
  const Cycle from = b.clock.cycle();
  b.in.push(from, CombinerBench::end());
  const std::uint64_t waited = stalls(b.unit, "downstream");
  Port port(b);
  port.before_cycle = [&](Cycle now) {
    if (now - from >= 8 && now - from < 11) port.sends().hold_push(now);
  };
  port.run();
  std::vector<Cycle> sent;
  for (const Cycle c : port.sent) sent.push_back(c - from);
  EXPECT_THAT(sent, ElementsAre(7, 11, 12, 13));
  EXPECT_EQ(stalls(b.unit, "downstream") - waited, 3u);
  EXPECT_THAT(b.memory.lines_written(),
              ElementsAre(address_of(0), address_of(4), address_of(8), address_of(12)));
}
// Each write needs an entry in the list of blocks being written.
TEST(WriteBuffer, FlushWaitsForTheList) {
  CombinerBench b(with_buffer(16, 8), 60);
  for (int i = 0; i < 13; ++i) b.source.add(CombinerBench::token(4 * i, 0));
  b.clock.run(40);
  const Cycle from = b.clock.cycle();
  b.in.push(from, CombinerBench::end());
  Port port(b);
  port.run();
  ASSERT_EQ(port.sent.size(), 12u);
  EXPECT_EQ(port.sent[7], from + 14);
  EXPECT_EQ(port.sent[8], port.got[0] + 1);
  EXPECT_EQ(port.sent[11], port.got[3] + 1);
  // The unit is busy in the cycle of a response.
  EXPECT_EQ(stalls(b.unit, "spill"), port.got[0] - (from + 15));
}
// An empty buffer costs no cycles, and a build without it has none of its memories.
TEST(WriteBuffer, CostsNothingWithoutReplacement) {
  std::string first;
  for (const int places : {0, 8}) {
    const std::string got = in_child([places] {
      CombinerBench b(with_buffer(places));
      draw(b, {0, 1, 2, 3, 0});
      const Cycle cycles = b.until_drawn();
      int memories = 0;
      rtl::for_each<rtl::MemoryBase>(b.unit, [&](rtl::MemoryBase& memory) {
        memories += std::string_view(memory.basename()).starts_with("write_");
      });
      if (memories != (places == 0 ? 0 : 2)) return std::string("memories");
      return std::to_string(cycles);
    });
    if (first.empty()) first = got;
    EXPECT_EQ(got, first);
  }
  EXPECT_NE(first, "memories");
}

}  // namespace
}  // namespace deburr::tb::geometric_rtl::write_buffer_test
