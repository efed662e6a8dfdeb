// SPDX-License-Identifier: MIT
// The write buffer of the WeightCombiner: which blocks go over the port and in which order, and in
// which clock, as docs/reference/geometric/memory.md has them.
#include <map>
#include <set>

#include "rtl_model/geometric/common/block_pixels.h"
#include "tb/base/random.h"
#include "tb/unit/rtl/geometric/combiner_bench.h"

namespace deburr::tb::geometric_rtl::write_buffer_test {
namespace {

using namespace rtl::geometric;  // NOLINT: names of units and tokens
using spec::geometric::CacheLines;
using spec::geometric::Weights;
using testing::ElementsAre;
using testing::ElementsAreArray;

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

// The cycles in which the combiner sends something, and gets something.
struct Port {
  explicit Port(CombinerBench& bench) : b(bench) {}
  void run() {
    while (!b.drawn->read(b.clock.cycle())) step();
    drawn = b.clock.cycle();
  }
  void step() {
    const std::uint64_t sent_before = sends().pushes(), got_before = gets().pops();
    const Cycle now = b.clock.cycle();
    if (before_clock) before_clock(now);
    b.clock.run(1);
    if (sends().pushes() != sent_before) sent.push_back(now);
    if (gets().pops() != got_before) got.push_back(now);
  }
  rtl::Link<rtl::MemoryRequest>& sends() { return b.unit.memory.requests_out.link(); }
  rtl::Link<rtl::MemoryResponse>& gets() { return b.unit.memory.responses_in.link(); }
  CombinerBench& b;
  std::function<void(Cycle)> before_clock;
  std::vector<Cycle> sent, got;
  Cycle drawn = 0;
};

// ---- which blocks

TEST(WriteBuffer, AHitLeavesItsPlaceToWhatItReplaces) {
  CombinerBench b(with_buffer(2));
  // 4 puts 0 into place 0, 8 puts 4 into place 1; 0 is a hit and leaves its place to 8; 12 puts 0
  // into the next place, which is place 0 still: 8 leaves.
  draw(b, {0, 4, 8, 0, 12});
  b.until_drawn();
  EXPECT_EQ(b.unit.buffer_hits.value(), 1u);
  EXPECT_EQ(b.unit.blocks_read.value(), 0u);
  EXPECT_THAT(b.memory.lines_read(), testing::IsEmpty());
  // Then what is left, from the next place on, which is place 1.
  EXPECT_THAT(b.memory.lines_written(), ElementsAre(address_of(8), address_of(4), address_of(0)));
  EXPECT_EQ(b.unit.blocks_written.value(), 3u);
  EXPECT_EQ(text_of(b.unit.buffered_blocks), "2 x 1");
}
TEST(WriteBuffer, EmptyPlacesAreLeftOut) {
  CombinerBench b(with_buffer(8));
  draw(b, {0, 4, 8, 12});
  b.until_drawn();
  EXPECT_THAT(b.memory.lines_written(), ElementsAre(address_of(0), address_of(4), address_of(8)));
  EXPECT_EQ(text_of(b.unit.buffered_blocks), "3 x 1");
}
TEST(WriteBuffer, ABlockThatHasLeftIsRead) {
  CombinerBench b(with_buffer(1));
  draw(b, {0, 4, 8, 0});
  b.until_drawn();
  EXPECT_EQ(b.unit.buffer_hits.value(), 0u);
  EXPECT_THAT(b.memory.lines_read(), ElementsAre(address_of(0)));
  EXPECT_THAT(b.memory.lines_written(), ElementsAre(address_of(0), address_of(4), address_of(8)));
}

// The rule of the page, in words of its own: a list of blocks in the order in which they came.
class Rule {
 public:
  using Block = std::pair<int, int>;
  Rule(int cache_bits, std::size_t places)
      : low_((cache_bits + 1) / 2), high_(cache_bits - low_), ring_(places) {}
  void look_up(Block x) {
    const int index = x.first % (1 << low_) + (x.second % (1 << high_) << low_);
    const auto there = cache.find(index);
    if (there != cache.end() && there->second == x) return;
    const bool touched = !touched_.insert(x).second;
    const auto place = std::find(ring_.begin(), ring_.end(), std::optional(x));
    if (place != ring_.end()) {
      ++hits;
      *place = there->second;
    } else {
      if (touched) reads.push_back(address_of(x.first, x.second));
      if (there != cache.end()) {
        if (ring_.empty()) {
          write(there->second);
        } else {
          if (ring_[next_]) write(*ring_[next_]);
          ring_[next_] = there->second;
          next_ = (next_ + 1) % ring_.size();
        }
      }
    }
    cache[index] = x;
  }
  void end() {
    for (std::size_t i = 0; i < ring_.size(); ++i)
      if (const auto& block = ring_[(next_ + i) % ring_.size()]) write(*block);
  }
  std::vector<std::uint64_t> reads, writes;
  std::uint64_t hits = 0;
  std::map<int, Block> cache;

 private:
  void write(Block block) { writes.push_back(address_of(block.first, block.second)); }
  int low_, high_;
  std::vector<std::optional<Block>> ring_;
  std::size_t next_ = 0;
  std::set<Block> touched_;
};

// Random groups, of which some have second candidates in the block below, with a memory that is
// near, far, and taken by others for a while.
std::string random_blocks(int places, std::uint32_t latency, int fills, std::uint64_t seed) {
  Random random(seed, "blocks");
  CombinerBench b(with_buffer(places, fills), latency);
  Rule rule(4, static_cast<std::size_t>(places));
  std::map<std::pair<int, int>, std::array<std::uint8_t, 64>> weights;
  const int across = random.between(5, 60);
  for (int i = 0; i < 800; ++i) {
    WeightToken t = CombinerBench::token(random.between(0, across), random.between(0, 2));
    t.place[0] = static_cast<std::uint8_t>(random.between(0, 15));
    t.coverage[0] = static_cast<std::uint8_t>(random.between(1, 128));
    t.forward = 1;
    const auto set = [&](int by, int place, int direction, std::uint8_t coverage) {
      std::uint8_t& weight =
          weights[{t.block_x, by}][static_cast<std::size_t>(4 * place + direction)];
      weight = std::max(weight, coverage);
    };
    rule.look_up({t.block_x, t.block_y});
    set(t.block_y, t.place[0], 1, t.coverage[0]);
    if (random.chance(200)) {
      t.seconds = 1;
      t.second[0] = static_cast<std::uint8_t>(random.between(1, 64));
      const bool below = t.place[0] >= 12;
      if (below) rule.look_up({t.block_x, t.block_y + 1});
      set(t.block_y + below, (t.place[0] + 4) % 16, 0, t.second[0]);
    }
    b.source.add(t);
  }
  rule.end();
  b.source.add(CombinerBench::end());
  while (!b.drawn->read(b.clock.cycle())) {
    if (random.chance(300)) b.requests.hold_push(b.clock.cycle());
    if (random.chance(200)) b.in.hold_pop(b.clock.cycle());
    b.clock.run(1);
  }
  std::string wrong;
  if (b.memory.lines_read() != rule.reads) wrong += "reads ";
  if (b.memory.lines_written() != rule.writes) wrong += "writes ";
  if (b.unit.buffer_hits.value() != rule.hits) wrong += "hits ";
  std::set<std::pair<int, int>> cached;
  for (const auto& [index, block] : rule.cache) cached.insert(block);
  for (const auto& [block, bytes] : weights)
    if (!cached.contains(block) && b.memory.dump(address_of(block.first, block.second), 64) !=
                                       std::vector<std::uint8_t>(bytes.begin(), bytes.end()))
      wrong += "weights ";
  if (places > 0 && places < 100 && rule.hits == 0) wrong += "nothing was hit";
  return wrong;
}
TEST(WriteBuffer, RandomBlocksByTheRule) {
  for (const int places : {0, 1, 2, 3, 8, 64, 128})
    for (std::uint64_t seed = 0; seed < 6; ++seed) {
      const std::uint32_t latency = std::array{1u, 20u, 100u}[seed % 3];
      const int fills = seed % 2 == 0 ? 8 : 0;
      EXPECT_EQ(in_child([&] { return random_blocks(places, latency, fills, seed); }), "")
          << places << " places, seed " << seed;
    }
}

// ---- in which clock

// Two blocks of one index in turn: each is a hit in the place that the one before has just taken.
TEST(WriteBuffer, AHitAClock) {
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
      // From the source, and into stage 1.
      return std::to_string(cycles) + " " + std::to_string(b.unit.buffer_hits.value()) + " " +
             std::to_string(stalls(b.unit, "spill"));
    });
    EXPECT_EQ(got, buffered ? "203 198 0" : "waits");
  }
}

// A block that has left the ring is read in the clock after the answer of its write, and not a
// clock before.
TEST(WriteBuffer, ABlockOnItsWayOutIsWaitedFor) {
  CombinerBench b(with_buffer(1));
  draw(b, {0, 4, 8, 0});
  Port port(b);
  port.run();
  // The write of 0, its answer, the read of it; the write of 4, and its answer and the line.
  ASSERT_EQ(port.sent.size(), 4u);
  EXPECT_EQ(port.sent[1], port.got[0] + 1);
  EXPECT_GT(stalls(b.unit, "spill"), 20u);
}

// The last token is in stage 5 five cycles after its push; then a read of a place in each clock,
// and its request in the clock after that.
TEST(WriteBuffer, IsWrittenABlockAClockAfterTheLastToken) {
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
      // `drawn` is driven in the clock of the last answer, if there is one.
      const Cycle last = port.got.empty() ? from + 5 : port.got.back();
      return text + "drawn " + std::to_string(port.drawn - last);
    });
    EXPECT_EQ(got, blocks == 1 ? "drawn 1" : blocks == 2 ? "7 drawn 1" : "7 8 9 10 drawn 1");
  }
}
TEST(WriteBuffer, WaitsForTheLinkAtTheEnd) {
  CombinerBench b(with_buffer(8));
  for (int i = 0; i < 5; ++i) b.source.add(CombinerBench::token(4 * i, 0));
  b.clock.run(30);
  const Cycle from = b.clock.cycle();
  b.in.push(from, CombinerBench::end());
  const std::uint64_t waited = stalls(b.unit, "downstream");
  Port port(b);
  port.before_clock = [&](Cycle now) {
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
// Each write needs a place in the list of blocks on their way out.
TEST(WriteBuffer, WaitsForTheListAtTheEnd) {
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
  // In the clock of an answer the unit is busy.
  EXPECT_EQ(stalls(b.unit, "spill"), port.got[0] - (from + 15));
}
// Without a block in it the buffer costs no clock; nor has a build without it anything of it.
TEST(WriteBuffer, CostsNothingWhereNothingIsReplaced) {
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
