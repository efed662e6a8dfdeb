// SPDX-License-Identifier: MIT
// Parts that several units of the geometric engine share, each on its own with hand-computed
// results: the FillStore for lines in flight from memory, and the latency measurement of edges.
#include <cstdlib>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "rtl_model/geometric/common/edge_latency.h"
#include "rtl_model/geometric/common/fill_store.h"
#include "spec/error.h"
#include "tb/unit/rtl/geometric/support.h"

namespace deburr::tb::geometric_rtl::shared_parts_test {
namespace {

using rtl::Histogram;
using rtl::geometric::EdgeLatency;
using rtl::geometric::FillStore;

// ---- FillStore

TEST(FillStore, ReturnsLinesInTheOrderOfEntries) {
  FillStore<std::uint32_t> store("store", 3, 32, "words");
  EXPECT_TRUE(store.empty());
  for (std::uint32_t place = 0; place < 3; ++place) {
    ASSERT_TRUE(store.can_reserve(1));
    EXPECT_EQ(store.reserve(), place);
    EXPECT_FALSE(store.empty());
  }
  EXPECT_FALSE(store.can_reserve(2));
  // The second line arrives first: nothing can be read yet.
  store.fill(10, 1, 11);
  store.read_ahead(10);
  store.read_ahead(11);
  EXPECT_FALSE(store.ready(12));
  // Filled in cycle t, ready from t + 2 on.
  store.fill(12, 0, 10);
  store.read_ahead(12);
  EXPECT_FALSE(store.ready(13));
  store.read_ahead(13);
  EXPECT_FALSE(store.ready(13));
  EXPECT_TRUE(store.ready(14));
  store.read_ahead(14);  // the line stays ready
  EXPECT_TRUE(store.ready(15));
  EXPECT_EQ(store.line(15), 10u);
  // Then one line per cycle.
  store.release(15);
  EXPECT_FALSE(store.can_reserve(15));
  EXPECT_TRUE(store.can_reserve(16));
  store.read_ahead(15);
  EXPECT_FALSE(store.ready(15));
  EXPECT_TRUE(store.ready(16));
  EXPECT_EQ(store.line(16), 11u);
  store.release(16);
  store.read_ahead(16);
  EXPECT_FALSE(store.ready(17)) << "the third has not come";
  // The first entry is reused, after the third.
  EXPECT_EQ(store.reserve(), 0u);
  store.fill(17, 0, 20);
  store.fill(18, 2, 12);
  store.read_ahead(19);
  ASSERT_TRUE(store.ready(20));
  EXPECT_EQ(store.line(20), 12u);
  store.release(20);
  EXPECT_FALSE(store.empty());
  store.read_ahead(20);
  ASSERT_TRUE(store.ready(21));
  EXPECT_EQ(store.line(21), 20u);
  store.release(21);
  EXPECT_TRUE(store.empty());
  store.read_ahead(21);
  EXPECT_FALSE(store.ready(22));
}
TEST(FillStore, RejectsSecondFillAndUnknownEntry) {
  FillStore<std::uint32_t> store("store", 3, 32, "words");
  for (int i = 0; i < 3; ++i) store.reserve();
  store.fill(5, 2, 1);
  EXPECT_THROW(store.fill(6, 2, 1), spec::CheckFailed);
  EXPECT_THROW(store.fill(7, 3, 1), spec::CheckFailed);
  store.fill(8, 1, 1);
}
TEST(FillStore, ResetEmptiesEveryEntry) {
  FillStore<std::uint32_t> store("store", 2, 32, "words");
  store.reserve();
  store.reserve();
  store.fill(3, 0, 10);
  store.fill(4, 1, 11);
  store.read_ahead(4);
  store.release(5);
  store.read_ahead(5);
  store.reset();
  EXPECT_TRUE(store.empty());
  EXPECT_FALSE(store.ready(6));
  store.read_ahead(6);
  EXPECT_FALSE(store.ready(7)) << "what had come is gone";
  ASSERT_TRUE(store.can_reserve(6));
  const std::uint32_t place = store.reserve();
  ASSERT_TRUE(store.can_reserve(6));
  store.reserve();
  EXPECT_FALSE(store.can_reserve(6));
  store.fill(7, place, 12);
  store.read_ahead(8);
  ASSERT_TRUE(store.ready(9));
  EXPECT_EQ(store.line(9), 12u);
}

// Two units see one store, each through its own side.
TEST(FillStore, FillerAndReaderShareOneStore) {
  FillStore<std::uint32_t> store("store", 1, 32, "words");
  FillStore<std::uint32_t>::Filler filler = store.filler();
  FillStore<std::uint32_t>::Reader reader = store.reader();
  ASSERT_TRUE(filler.can_reserve(1));
  filler.fill(2, filler.reserve(), 7);
  EXPECT_FALSE(filler.can_reserve(3));
  reader.read_ahead(3);
  EXPECT_FALSE(reader.ready(3));
  ASSERT_TRUE(reader.ready(4));
  EXPECT_EQ(reader.line(4), 7u);
  reader.release(4);
  EXPECT_FALSE(filler.can_reserve(4));
  EXPECT_TRUE(filler.can_reserve(5));
  EXPECT_EQ(filler.reserve(), 0u);
  filler.reset();
  EXPECT_TRUE(store.empty());
}

// ---- EdgeLatency

struct Latencies {
  Histogram histogram{"latency", "clk", "of an edge"};
  // Records into the histogram as the units do.
  struct Recorded : EdgeLatency {
    Histogram& histogram;
    explicit Recorded(Histogram& h) : histogram(h) {}
    void write(Cycle cycle) { record(EdgeLatency::write(cycle)); }
    void end() { record(EdgeLatency::end()); }
    void record(std::optional<Cycle> latency) {
      if (latency) histogram.record(*latency);
    }
  } edges{histogram};
  // Events in order, one word or letter each:
  //   L10*3  three edges leave in cycle 10      + -  the next one is kept or dropped
  //   W20    a group is written in cycle 20     = /  it is a line or not
  //   E      the end of the frame               G g  the last group of a line, or another group
  //   P n    some of a group pass, or none      c x  it has candidates, or none
  void apply_events(const std::string& events) {
    std::istringstream words(events);
    for (std::string word; words >> word;) {
      const std::size_t times = word.find('*');
      const auto cycle = static_cast<Cycle>(std::atoi(word.c_str() + 1));
      switch (word[0]) {
        case 'L':
          edges.leave(cycle,
                      times == word.npos ? 1u : static_cast<std::uint32_t>(word.back() - '0'));
          break;
        case 'W':
          edges.write(cycle);
          break;
        case 'E':
          edges.end();
          break;
        default:
          for (const char event : word) stage(event);
      }
    }
  }
  void stage(char event) {
    switch (event) {
      case '+':
      case '-':
        return edges.decided(event == '+');
      case '=':
      case '/':
        return edges.set_up(event == '=');
      case 'G':
      case 'g':
        return edges.walk(event == 'G');
      case 'c':
      case 'x':
        return edges.cover(event == 'c');
      default:
        return edges.test(event == 'P');
    }
  }
  std::vector<std::uint64_t> all() const {
    std::vector<std::uint64_t> values;
    for (const Histogram::Bin& bin : histogram.bins())
      values.insert(values.end(), bin.count, bin.low);
    return values;
  }
};
using testing::ElementsAre;

TEST(EdgeLatency, LatencyRunsFromReaderToLastGroup) {
  struct Row {
    const char *what, *events;
    std::vector<std::uint64_t> latencies;
  };
  for (const Row& row : std::vector<Row>{
           {"another group may come", "L10 += gcP gcP GcP W20 W21", {}},
           {"the last of three groups", "L10 += gcP gcP GcP W20 W21 W25 E", {15}},
           {"edges that are no line", "L10*3 L20*2 -+-++ /== GcP GcP W40 W51 E", {20, 31}},
           {"lines without a candidate, without one that passes, without a last group",
            "L10 += L11 += L12 += L13 += gx GcP Gx Gcn gcP gcn Gx W100 W200 E",
            {90, 187}},
           {"many on their way", "L1*2 L5 +++ === gGGgG ccccc PPPPP W10 W20 W30 W40 W50", {19, 29}},
           {"and the last one",
            "L1*2 L5 +++ === gGGgG ccccc PPPPP W10 W20 W30 W40 W50 E",
            {19, 29, 45}},
           {"what nobody announced, as injected faults send it", "+= GcP W9 E", {}},
           {"and nothing waits for it", "+= GcP W9 E L10 += GcP W17 W19 E", {7}},
           {"two frames, and one without a line", "L1 += GcP W4 E L11 += GcP W19 E E", {3, 8}}}) {
    Latencies l;
    l.apply_events(row.events);
    EXPECT_EQ(l.all(), row.latencies) << row.what;
  }
}
TEST(EdgeLatency, ResetDropsEdgesInFlight) {
  for (const char* const before :
       {"L1", "L1 +", "L1 +=", "L1 += g", "L1 += gc", "L1 += gcP", "L1 += gcP W4"}) {
    Latencies l;
    l.apply_events(before);
    l.edges.reset();
    l.apply_events("L10 += GcP W15 E");
    EXPECT_THAT(l.all(), ElementsAre(5)) << before;
  }
  // An edge classified as a boundary whose vertex pair has not come yet.
  Latencies l;
  l.edges.leave(1, 1);
  l.edges.decided(true, true);
  l.edges.reset();
  l.edges.leave(10, 1);
  l.edges.decided(true, true);
  l.edges.paired(true);
  l.apply_events("= GcP W15 E");
  EXPECT_THAT(l.all(), ElementsAre(5));
}

}  // namespace
}  // namespace deburr::tb::geometric_rtl::shared_parts_test
