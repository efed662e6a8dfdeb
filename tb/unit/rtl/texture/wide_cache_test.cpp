// SPDX-License-Identifier: MIT
// The TextureCache of a wide build as a whole: times, every cause of an empty slot, data, and fills
// in the order of width 1.
#include <deque>
#include <set>

#include "tb/base/random.h"
#include "tb/unit/rtl/datasheets.h"
#include "tb/unit/rtl/texture/cache_bench.h"

namespace deburr::tb::texture_rtl::wide_cache_test {
namespace {

using namespace rtl::texture;
using testing::ElementsAre;

std::vector<TexelToken> four_of(const TexelToken& t) { return {t, t, t, t}; }

TEST(TextureRtlWideCache, HitTakesTimeOfDatasheet) {
  WideBench b;
  b.add(four_of(in_line(0)));
  b.finish();
  const std::size_t first = b.ends.sink.taken.size();
  const Cycle start = b.clock.cycle();
  for (std::uint32_t i = 0; i < 8; ++i) b.add(four_of(in_line(0)));
  b.finish();
  std::vector<Cycle> seen;
  for (std::size_t i = first; i < b.ends.sink.taken.size(); ++i)
    seen.push_back(b.ends.sink.taken[i].cycle);
  ASSERT_EQ(seen.size(), 8u);
  const rtl::Datasheet sheet = TextureCache::datasheet(wide_cache());
  EXPECT_EQ(sheet.latency.cycles, kWideHit);
  const auto check = [&](const rtl::Datasheet& said) { expect_cycles(said, seen, start + 1); };
  expect_detects_one_cycle(sheet, &rtl::Datasheet::latency, check);
  expect_detects_one_cycle(sheet, &rtl::Datasheet::interval, check);
}

// The time of a group by its misses and how many lines are written per cycle.
class Width : public testing::TestWithParam<std::int32_t> {};
TEST_P(Width, MissTakesTimeOfMemory) {
  const std::int32_t width = GetParam();

  WideBench b(wide_cache(width));
  const auto time_of = [&](const std::vector<TexelToken>& requests) {
    const Cycle start = b.clock.cycle();
    b.add(requests);
    b.finish();
    return b.ends.sink.taken.back().cycle - start - 1;
  };
  const Cycle miss = kWideMiss + kMemoryLatency;
  EXPECT_EQ(time_of({in_line(0)}), miss);
  EXPECT_EQ(time_of({in_line(0)}), kWideHit);
  EXPECT_EQ(time_of({in_line(1), in_line(0)}), miss);
  // The MissQueue sends one line per cycle, and so they arrive.
  EXPECT_EQ(time_of({in_line(2), in_line(3)}), miss + 1);
  EXPECT_EQ(time_of({request({64 * 4, 64 * 5, 64 * 6, 64 * 7})}), miss + 3);
  EXPECT_EQ(time_of({in_line(2), in_line(3)}), kWideHit);
  b.check_data();
  EXPECT_EQ(b.cache.tag_stage.misses.value(), 8u);
  EXPECT_EQ(b.cache.miss_queue.line_fills.value(), 8u);
  EXPECT_EQ(b.cache.data_stage.lines_written.value(), 8u);
  check_slots(b.former());
}
INSTANTIATE_TEST_SUITE_P(TextureRtlWideCache, Width, testing::Values(2, 4));

// ---- Each cause in the cache -------------------------------------------------------------------

// Groups that leave the GroupFormer: the cycles, counted from the first one.
struct Leaving {
  std::vector<Cycle> cycles;
  void run(WideBench& b, Cycle cycles_to_run) {
    const auto& link = *b.cache.wide->group_former.groups_out.link_base();
    for (std::uint64_t before = link.pushes(); cycles_to_run > 0; --cycles_to_run) {
      b.clock.run(1);
      if (link.pushes() != before) cycles.push_back(b.clock.cycle() - 1);
      before = link.pushes();
    }
  }
  std::vector<Cycle> relative() const {
    std::vector<Cycle> found;
    for (const Cycle c : cycles) found.push_back(c - cycles.front());
    return found;
  }
};

// Four lines per group and one allocation per cycle: a group every four cycles. Three are taken
// before the first stop: two in the link, one in the TagStage.
TEST(TextureRtlWideCache, AllocateStopsThreeCyclesPerGroup) {
  spec::texture::Parameters p = wide_cache();
  p.cache_allocations = 1;
  p.cache_outstanding = 64;
  WideBench b(p);
  for (std::uint32_t i = 0; i < 6; ++i)
    b.add({in_line(4 * i), in_line(4 * i + 1), in_line(4 * i + 2), in_line(4 * i + 3)});
  Leaving groups;
  groups.run(b, 100);
  // Group 0 is in the TagStage from 1 on and looked up from 2 to 5, and so group 1 is taken in 5.
  EXPECT_THAT(groups.relative(), ElementsAre(0, 1, 2, 6, 10, 14));
  EXPECT_EQ(slots_of(b.former()), (Slots{{"allocate", 4u * 9}}));
  EXPECT_EQ(b.former().slots.value(), 4u * 15);
  b.check_data();
}

// The MissQueue has room for 8 lines, of a memory with a latency of 30.
TEST(TextureRtlWideCache, FullMissQueueStops) {
  spec::texture::Parameters p = wide_cache();
  p.cache_outstanding = 8;
  WideBench b(p, 30);
  for (std::uint32_t i = 0; i < 12; ++i)
    b.add({request({64 * 8 * i, 64 * (8 * i + 1), 64 * (8 * i + 2), 64 * (8 * i + 3)}),
           request({64 * (8 * i + 4), 64 * (8 * i + 5), 64 * (8 * i + 6), 64 * (8 * i + 7)})});
  Leaving groups;
  groups.run(b, 2000);
  b.check_data();
  EXPECT_EQ(stalls(b.cache.tag_stage, "fifo_full"), 0u);
  EXPECT_GT(stalls(b.cache.tag_stage, "miss_queue_full"), 200u);
  const Slots slots = slots_of(b.former());
  EXPECT_EQ(slots.at("starved") + slots.at("lookups"), 12u * 2) << "two requests per group";
  const Cycle between = groups.cycles.back() - groups.cycles.front() + 1;
  EXPECT_EQ(slots.at("miss_queue") + slots.at("allocate"), 4 * (between - 12));
  EXPECT_GT(slots.at("miss_queue"), 4u * 150);
  check_slots(b.former());
}

// A FIFO of two entries: the TagStage stops for what holds the DataStage, two cycles later.
spec::texture::Parameters short_fifo() {
  spec::texture::Parameters p = wide_cache();
  p.cache_fifo_depth = 2;
  return p;
}

// Hits behind one miss. The groups in front of the full GroupFormer: 1 at the DataStage and in the
// FIFO 1 (together two entries), 2 in `requests`, 1 in the TagStage, 2 in `groups`: the eighth
// group has to wait, from cycle 7 on. The first group leaves in c, and the DataStage pops it
// kWideMiss - 4 + latency cycles later; then a slot of `groups` is free five cycles behind that.
class Latency : public testing::TestWithParam<std::uint32_t> {};
TEST_P(Latency, WaitForLineStops) {
  const std::uint32_t latency = GetParam();

  WideBench b(short_fifo(), latency);
  for (int i = 0; i < 12; ++i) b.add(four_of(in_line(0)));
  Leaving groups;
  groups.run(b, 200);
  // Taken by the GroupFormer one cycle before the first group leaves: kWideMiss - 1 from there to
  // the cycle of the pop, minus the output of the DataStage (2).
  const Cycle popped = kWideMiss + latency - 1 - 2;
  const Cycle freed = popped + 3;  // FIFO, requests, groups: one cycle each
  EXPECT_THAT(groups.relative(),
              ElementsAre(0, 1, 2, 3, 4, 5, 6, freed, freed + 1, freed + 2, freed + 3, freed + 4));
  EXPECT_EQ(slots_of(b.former()), (Slots{{"wait_fill", 4u * (freed - 7)}}));
  b.check_data();
}
INSTANTIATE_TEST_SUITE_P(TextureRtlWideCache, Latency, testing::Values(20u, 21u, 30u));

// Four groups with four misses each, whose lines arrive one per cycle: the first one waits for its
// first line, and then each takes four cycles. The groups as above.
TEST(TextureRtlWideCache, WritesStop) {
  spec::texture::Parameters p = short_fifo();
  p.cache_outstanding = 64;
  WideBench b(p, 20);
  for (std::uint32_t i = 0; i < 4; ++i)
    b.add({in_line(4 * i), in_line(4 * i + 1), in_line(4 * i + 2), in_line(4 * i + 3)});
  for (int i = 0; i < 12; ++i) b.add(four_of(in_line(1)));
  Leaving groups;
  groups.run(b, 200);
  b.check_data();
  const Cycle freed = kWideMiss + 20 - 1 - 2 + 3 + 3;
  EXPECT_THAT(groups.relative(),
              ElementsAre(0, 1, 2, 3, 4, 5, 6, freed, freed + 4, freed + 8, freed + 12, freed + 13,
                          freed + 14, freed + 15, freed + 16, freed + 17));
  EXPECT_EQ(slots_of(b.former()),
            (Slots{{"wait_fill", 4u * (freed - 3 - 7)}, {"write_fill", 4u * 3 * 4}}));
  check_slots(b.former());
}

// Lines that are stored turned, read by a descriptor that does not turn them: the GroupFormer sees
// a word per bank, the DataStage two. A group every two cycles, once the links are full.
TEST(TextureRtlWideCache, PassesStop) {
  spec::texture::Parameters p = short_fifo();
  p.cache_bank_reads = 1;
  WideBench b(p);
  TexelToken turned = request({0, 4, 8, 12});
  turned.turned = {true, true};
  b.add({turned, in_line(4), turned, in_line(4)});
  b.finish();
  // Word 0 of line 0 is stored in bank 8, as is word 8 of line 4.
  const std::uint32_t other = 64 * 4 + 32;
  const TexelToken x = request({0, 0, 0, 0}), y = request({other, other, other, other});
  b.clock.run(20);
  ASSERT_EQ(slots_of(b.former()), Slots{});
  const Cycle start = b.clock.cycle();
  for (int i = 0; i < 16; ++i) b.add({x, y, x, y});
  Leaving groups;
  groups.run(b, 100);
  EXPECT_EQ(stalls(b.cache.data_stage, "bank_conflict"), 16u);
  // The DataStage pops a group in 5, 7, 9, ... (group 0 is there in 4), which frees a slot three
  // cycles later: in 8, 10, ..., as the eighth group needs one in 7.
  std::vector<Cycle> expected = {0, 1, 2, 3, 4, 5, 6};
  for (Cycle i = 0; expected.size() < 16; ++i) expected.push_back(8 + 2 * i);
  // Groups 0 to 3 had left before the links were full.
  EXPECT_EQ(groups.relative(), expected);
  const Slots slots = slots_of(b.former());
  EXPECT_EQ(slots.at("bank_pass"), 4u * (expected.back() + 1 - 16));
  EXPECT_EQ(slots.at("starved"), 4u * (start + 2 - 2 - 1));
  EXPECT_EQ(slots.size(), 2u);
  b.check_data();
  check_slots(b.former());
}

// The output is held in mid-group: every slot until it opens counts, and no data is lost.
class HeldOutput : public testing::TestWithParam<Cycle> {};
TEST_P(HeldOutput, StopsUntilItOpens) {
  const Cycle held = GetParam();

  WideBench b(short_fifo());
  b.add(four_of(in_line(0)));
  b.finish();
  b.clock.run(5);
  const Cycle start = b.clock.cycle();
  b.ends.sink.hold_from = start;
  b.ends.sink.hold_to = start + held;
  for (int i = 0; i < 16; ++i) b.add(four_of(in_line(0)));
  Leaving groups;
  groups.run(b, 200);
  // Ten groups are behind the GroupFormer: seven as above, one in the second stage of the
  // DataStage and two in the link. The first one left two cycles after its push.
  const Cycle first = start + 2, freed = start + held + 1 + 3;
  std::vector<Cycle> expected;
  for (Cycle i = 0; i < 10; ++i) expected.push_back(first + i);
  for (Cycle i = 0; i < 6; ++i) expected.push_back(freed + i);
  EXPECT_EQ(groups.cycles, expected) << held;
  const Slots slots = slots_of(b.former());
  EXPECT_EQ(slots.at("output"), 4 * (freed - (first + 10)));
  EXPECT_EQ(slots.size(), 2u);
  EXPECT_EQ(slots.at("starved"), 4 * (first - 2 - 1)) << "since the first group left in 2";
  b.check_data();
  check_slots(b.former());
}
INSTANTIATE_TEST_SUITE_P(TextureRtlWideCache, HeldOutput, testing::Values<Cycle>(20, 21, 33));

// ---- Random requests ---------------------------------------------------------------------------

// Footprints of 2 x 2 texels that walk through a linear or a tiled texture, also through a
// descriptor that does not turn the lines; and jumps, invalid fragments and scattered texels.
class Requests {
 public:
  explicit Requests(std::uint32_t seed) : random_(seed) {}
  TexelToken next() {
    const std::uint32_t what = number(64);
    if (what == 0) return invalid_request();
    if (what == 1) {
      TexelToken t = request({word(), word(), word(), word()}, tag_++);
      t.turned = {flip(), flip()};
      return t;
    }
    if (what < 5) {  // several lines of one set
      const std::uint32_t line = number(32);
      return request({64 * (line + 32 * (number(3))) + 4, 64 * (line + 32 * (number(3))) + 8,
                      64 * line, 64 * (line + 32 * (number(3)))},
                     tag_++);
    }
    if (what < 10) {
      x_ = number(256);
      y_ = number(64);
    } else {
      x_ = (x_ + number(3)) % 256;
      y_ = (y_ + number(2)) % 64;
    }
    if (number(128) == 0) layout_ = number(3);
    TexelToken t = request({at(0, 0), at(1, 0), at(0, 1), at(1, 1)}, tag_++);
    if (layout_ == 0) t.turned = {(y_ & 1) != 0, (y_ & 1) == 0};
    return t;
  }
  std::uint32_t number(std::uint32_t below) { return random_.below(below); }

 private:
  bool flip() { return number(2) == 0; }
  std::uint32_t word() { return number(4096) * 4; }
  std::uint32_t at(std::uint32_t dx, std::uint32_t dy) const {
    const std::uint32_t x = (x_ + dx) % 256, y = (y_ + dy) % 64;
    if (layout_ != 2) return 4 * (256 * y + x);  // linear, in layout 1 without turned lines
    return 64 * (64 * (y / 4) + x / 4) + 16 * (y % 4) + 4 * (x % 4);
  }
  tb::Random random_;
  std::uint32_t x_ = 0, y_ = 0, layout_ = 0, tag_ = 0;
};

// The lines that width 1 fetches: each use of a line by a request counts, least recently used.
std::vector<std::uint64_t> fills_of(const std::vector<TexelToken>& requests,
                                    const spec::texture::Parameters& p) {
  const auto bytes = static_cast<std::uint32_t>(p.cache_line_bytes);
  const auto ways = static_cast<std::size_t>(p.cache_ways);
  const auto sets = static_cast<std::uint32_t>(p.cache_bytes / p.cache_line_bytes / p.cache_ways);
  std::vector<std::deque<std::uint32_t>> recent(sets);
  std::vector<std::uint64_t> fills;
  for (const TexelToken& t : requests) {
    if (!t.ticket.valid) continue;
    std::vector<std::uint32_t> used;
    for (const std::uint32_t address : t.address) {
      const std::uint32_t line = address / bytes;
      if (std::find(used.begin(), used.end(), line) != used.end()) continue;
      used.push_back(line);
      std::deque<std::uint32_t>& set = recent[line % sets];
      const auto found = std::find(set.begin(), set.end(), line);
      if (found != set.end())
        set.erase(found);
      else
        fills.push_back(std::uint64_t{line} * bytes);
      set.push_front(line);
      if (set.size() > ways) set.pop_back();
    }
  }
  return fills;
}

// Without the second halves of lines of two beats.
std::vector<std::uint64_t> lines_of(std::vector<std::uint64_t> beats,
                                    const spec::texture::Parameters& p) {
  std::erase_if(beats, [&](std::uint64_t address) {
    return address % static_cast<std::uint64_t>(p.cache_line_bytes) != 0;
  });
  return beats;
}

// Recounts the slots from what the units did: the cause of a cycle in which a link was full is the
// activity of the TagStage in the previous cycle and of the DataStage two cycles before that.
class Recount {
 public:
  explicit Recount(WideBench& bench) : b_(bench), width_(bench.width) {}
  void run(Cycle cycles) {
    for (; cycles > 0; --cycles) step();
  }
  void step() {
    const rtl::texture::GroupFormer& former = b_.former();
    const rtl::LinkBase& out = *former.groups_out.link_base();
    const std::uint64_t requests = former.requests.value(), popped = b_.ends.in.pops();
    const std::uint64_t pushes = out.pushes();
    const bool empty = buffered_ == 0;
    std::vector<std::uint8_t> ahead;
    const std::string tag = tags_, data = data_.size() == 3 ? data_.front() : "";
    if (b_.ends.in.can_pop(b_.clock.cycle()))
      next_ = reinterpret_cast<const TexelGroup*>(b_.ends.in.head())->count;
    const auto tag_before = b_.cache.tag_stage.counts(), data_before = b_.cache.data_stage.counts();
    b_.clock.run(1);
    const std::uint64_t left = former.requests.value() - requests;
    if (out.pushes() == pushes) {
      EXPECT_EQ(left, 0u);
      ++since_[empty                                         ? "starved"
               : tag == "allocate"                           ? "allocate"
               : tag == "miss_queue_full"                    ? "miss_queue"
               : tag != "fifo_full"                          ? "output"
               : data == "bank_conflict"                     ? "bank_pass"
               : data == "wait_fill" || data == "write_fill" ? data
                                                             : "output"];
    } else {
      if (started_)
        for (const auto& [cause, cycles] : since_) slots_[cause] += width_ * cycles;
      since_.clear();
      started_ = true;
      latest_ = b_.clock.cycle() - 1;
      if (first_ == rtl::kNever) first_ = latest_;
      groups_ += width_ - left;
    }
    buffered_ -= left;
    if (b_.ends.in.pops() != popped) buffered_ += next_;
    EXPECT_LE(buffered_, 2 * width_);
    tags_ = done(b_.cache.tag_stage, tag_before);
    data_.push_back(done(b_.cache.data_stage, data_before));
    if (data_.size() > 3) data_.pop_front();
  }
  // The causes of stopped cycles, and the sum of all.
  void check() const {
    Slots slots = slots_of(b_.former());
    std::uint64_t in_groups = slots["lookups"] + slots["banks"] + slots["set"] + slots["decoders"] +
                              slots["partial_quad"] + slots["starved"];
    if (slots_.contains("starved")) in_groups -= slots_.at("starved");
    EXPECT_EQ(in_groups, groups_);
    for (const char* cause :
         {"allocate", "miss_queue", "wait_fill", "write_fill", "bank_pass", "output"})
      EXPECT_EQ(slots[cause], slots_.contains(cause) ? slots_.at(cause) : 0u) << cause;
    EXPECT_EQ(b_.former().slots.value(), width_ * (latest_ - first_ + 1));
    check_slots(b_.former());
  }
  const Slots& slots() const { return slots_; }

 private:
  static std::string done(const Unit& unit,
                          const std::array<std::uint64_t, rtl::kActivities>& before) {
    for (std::size_t code = 0; code < before.size(); ++code)
      if (unit.counts()[code] != before[code]) return unit.activity_name({code});
    return "";
  }
  WideBench& b_;
  std::uint64_t width_, buffered_ = 0, next_ = 0, groups_ = 0;
  std::string tags_;
  std::deque<std::string> data_;  // of the last three cycles
  bool started_ = false;
  Cycle first_ = rtl::kNever, latest_ = 0;
  Slots since_, slots_;
};

struct Build {
  const char* name;
  spec::texture::Parameters p;
  std::uint32_t latency, scatter;
  bool stalls;                           // of the output, at random
  std::vector<std::string> causes = {};  // some that must be seen
};
void PrintTo(const Build& c, std::ostream* out) { *out << c.name; }

std::vector<Build> builds() {
  const auto of = [](std::int32_t width, std::int32_t lookups, std::int32_t allocations,
                     std::int32_t banks, std::int32_t reads, std::int32_t writes, std::int32_t ways,
                     std::int32_t outstanding, std::int32_t depth) {
    spec::texture::Parameters p = wide_cache(width);
    p.cache_lookups = lookups;
    p.cache_allocations = allocations;
    p.cache_line_banks = banks;
    p.cache_bank_reads = reads;
    p.cache_fill_writes = writes;
    p.cache_ways = ways;
    p.cache_outstanding = outstanding;
    p.cache_fifo_depth = depth;
    return p;
  };
  spec::texture::Parameters small_lines = of(4, 8, 4, 4, 2, 4, 2, 32, 32),
                            long_lines = of(4, 6, 2, 4, 2, 2, 4, 32, 32);
  small_lines.cache_line_bytes = 32;
  long_lines.cache_line_bytes = 128;
  long_lines.cache_bytes = 8192;
  return {
      {"wide", of(4, 8, 4, 4, 2, 4, 2, 32, 48), 20, 0, false, {"partial_quad"}},
      {"wide, stalls", of(4, 8, 4, 4, 2, 4, 2, 32, 48), 20, 7, true},
      {"lean", of(4, 6, 2, 4, 2, 2, 2, 16, 24), 20, 0, true},
      {"least", of(4, 4, 1, 1, 1, 1, 1, 8, 2), 10, 0, false},
      {"least, stalls",
       of(4, 4, 1, 1, 1, 1, 1, 8, 2),
       10,
       5,
       true,
       {"lookups", "banks", "set", "starved", "allocate", "wait_fill", "write_fill", "bank_pass",
        "output"}},
      {"few lines", of(4, 8, 4, 4, 2, 4, 2, 8, 64), 20, 0, true, {"miss_queue"}},
      {"eight ways", of(4, 8, 3, 4, 1, 4, 8, 12, 4), 15, 0, true},
      {"two", of(2, 4, 2, 4, 1, 2, 2, 16, 32), 20, 0, false},
      {"two, stalls", of(2, 5, 1, 2, 2, 1, 4, 8, 3), 20, 9, true},
      {"lines of 32", small_lines, 20, 0, true},
      {"lines of 128", long_lines, 20, 5, true},
      {"decoders", with_decoders(of(4, 8, 4, 4, 2, 4, 2, 32, 48)), 20, 0, false, {"decoders"}},
      {"four decoders, stalls",
       with_decoders(of(4, 6, 2, 4, 1, 2, 2, 16, 24), 4),
       20,
       5,
       true,
       {"decoders", "banks", "bank_pass"}},
      {"two, decoders", with_decoders(of(2, 4, 2, 4, 1, 2, 2, 16, 32), 5), 20, 0, true},
      {"decoders, lines of 32", with_decoders(small_lines), 20, 0, true, {"decoders"}},
      {"decoders, lines of 128", with_decoders(long_lines), 20, 5, true, {"decoders"}},
  };
}

// The same with the blocks that the addresses are in.
TexelToken in_blocks_of(TexelToken t, bool large) {
  t.control.codec = codec_of(large ? spec::texture::Format::kBc5 : spec::texture::Format::kBc4);
  for (std::uint32_t& address : t.address) address &= large ? ~15u : ~7u;
  return t;
}

class Random : public testing::TestWithParam<std::tuple<Build, std::uint32_t>> {};
TEST_P(Random, DataFillsAndSlotsAreExact) {
  const auto& [c, seed] = GetParam();
  WideBench b(c.p, c.latency, c.scatter);
  Requests requests(seed);
  Cycle from = 0;
  for (int i = 0; i < 1500; ++i) {
    std::vector<TexelToken> token(b.width);
    if (requests.number(4) == 0)
      token.resize(1 + requests.number(static_cast<std::uint32_t>(b.width)));
    for (TexelToken& t : token) {
      t = requests.next();
      if (b.cache.block_decoder && requests.number(4) != 0)
        t = in_blocks_of(t, requests.number(2) == 0);
    }
    const unsigned partial = requests.number(2) == 0 ? 1u << (token.size() - 1) : 0u;
    if (requests.number(100) == 0) from += requests.number(60);
    b.ends.source.add(from++, token_of(token, static_cast<std::uint8_t>(partial)));
    b.asked.insert(b.asked.end(), token.begin(), token.end());
  }
  Recount recount(b);
  while (b.delivered() < b.asked.size() && b.clock.cycle() < 200'000) {
    if (c.stalls && b.clock.cycle() >= b.ends.sink.hold_to && requests.number(20) == 0) {
      b.ends.sink.hold_from = b.clock.cycle();
      b.ends.sink.hold_to = b.clock.cycle() + requests.number(12);
    }
    recount.step();
  }
  b.check_data();
  recount.check();
  EXPECT_EQ(lines_of(b.memory.lines_read(), c.p), fills_of(b.asked, c.p));
  const TagUnit& tags = b.cache.tag_stage;
  EXPECT_EQ(tags.misses.value(), b.cache.data_stage.lines_written.value());
  const Slots slots = slots_of(b.former());
  for (const std::string& cause : c.causes) EXPECT_TRUE(slots.contains(cause)) << cause;
}
INSTANTIATE_TEST_SUITE_P(TextureRtlWideCache, Random,
                         testing::Combine(testing::ValuesIn(builds()), testing::Range(1u, 4u)));

// ---- Building ----------------------------------------------------------------------------------

// 32 W x latency / 100, a multiple of 4 from 8 to 256; the FIFO has 16 groups more.
TEST(TextureRtlWideCache, OutstandingAndDepthFollowMemory) {
  spec::texture::Parameters p = wide_cache();
  p.cache_outstanding = p.cache_fifo_depth = 0;
  EXPECT_EQ(MissQueue::entries(p, {100, 1}), 128);
  EXPECT_EQ(MissQueue::entries(p, {101, 1}), 132);
  EXPECT_EQ(MissQueue::entries(p, {20, 1}), 40);
  EXPECT_EQ(MissQueue::entries(p, {1, 1}), 16);
  EXPECT_EQ(MissQueue::entries(p, {200, 1}), 244);
  EXPECT_EQ(MissQueue::entries(p, {4000, 1}), 256);
  EXPECT_EQ(LatencyFifo::depth(p, {100, 1}), 107 + 16);
  EXPECT_EQ(LatencyFifo::depth(p, {4090, 1}), 4096);
  p.width = 2;
  EXPECT_EQ(MissQueue::entries(p, {100, 1}), 64);
  EXPECT_EQ(MissQueue::entries(p, {200, 1}), 124);
  EXPECT_EQ(MissQueue::entries(p, {1, 1}), 8);
  p.width = 1;
  EXPECT_EQ(MissQueue::entries(p, {100, 1}), 32);
  EXPECT_EQ(LatencyFifo::depth(p, {100, 1}), 107);
  p.cache_outstanding = 12;
  EXPECT_EQ(MissQueue::entries(p, {100, 1}), 12);
}

// Exactly the units of its width, with the memories that they cost.
TEST(TextureRtlWideCache, BuildsUnitsOfItsWidth) {
  const CacheBench narrow;
  EXPECT_TRUE(narrow.cache.narrow && !narrow.cache.wide);
  spec::texture::Parameters p = wide_cache();
  p.cache_bytes = 16384;
  p.cache_outstanding = 128;
  p.cache_fifo_depth = 123;
  const WideBench b(p, kMemoryLatency, 0, "wide_");
  EXPECT_TRUE(!b.cache.narrow && b.cache.wide);
  std::string text;
  rtl::for_each<rtl::MemoryBase>(
      const_cast<TextureCache&>(b.cache), [&](const rtl::MemoryBase& memory) {
        text += std::string(memory.basename()) + " " + std::to_string(memory.words()) + " x " +
                std::to_string(memory.word_bits()) + " " + memory.ports() + ", " +
                memory.built_as() + "\n";
      });
  EXPECT_EQ(text,
            "fill_buffer 128 x 512 4R1W, 1R1W, 4 banks\n"
            "fill_buffer_arrived 128 x 1 4R5W, flip-flops\n"
            "lines 128 x 26 1R8W, flip-flops\n"
            "failed 128 x 1 1R1W, flip-flops\n"
            "requests_waiting 8 x 209 4R4W, flip-flops\n"
            "tags 128 x 43 8R8W, flip-flops, new word\n"
            "entries 123 x 543 1R1W, 1R1W\n"
            "banks_0 4096 x 32 16R4W of 16 words, 1R1W, 64 banks, old word\n"
            "banks_1 4096 x 32 16R4W of 16 words, 1R1W, 64 banks, old word\n"
            "response_buffer 128 x 514 1R1W, 1R1W\n");
  text.clear();
  rtl::for_each<rtl::LinkBase>(const_cast<TextureCache&>(b.cache), [&](const rtl::LinkBase& link) {
    text += std::string(link.basename()) + " " + std::to_string(link.payload_bits()) + "\n";
  });
  EXPECT_EQ(text,
            "entries_entries 543\ngroups 679\nrequests 543\nmisses 212\nmemory_requests 46\n"
            "memory_responses 560\n");
}

// A reset forgets groups, lines and slots.
TEST(TextureRtlWideCache, ResetForgetsEverything) {
  WideBench b;
  for (std::uint32_t i = 0; i < 30; ++i) b.add({in_line(i), in_line(i + 1), in_line(i)});
  b.clock.run(23);
  b.clock.set_reset_n(false);
  b.clock.run(40);
  b.clock.set_reset_n(true);
  b.asked.clear();
  ASSERT_TRUE(b.ends.sink.taken.empty());
  EXPECT_EQ(b.former().slots.value(), 0u);
  const Cycle start = b.clock.cycle();
  b.add({in_line(0), in_line(0)});
  b.clock.run(60);
  ASSERT_EQ(b.ends.sink.taken.size(), 1u);
  EXPECT_EQ(b.ends.sink.taken[0].cycle, start + 1 + kWideMiss + kMemoryLatency);
  b.check_data();
  EXPECT_EQ(b.former().slots.value(), 4u);
}

}  // namespace
}  // namespace deburr::tb::texture_rtl::wide_cache_test
