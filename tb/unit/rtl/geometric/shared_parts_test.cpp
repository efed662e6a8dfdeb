// SPDX-License-Identifier: MIT
// What several units of the geometric engine share, each by itself and by hand: the places of
// lines on their way from memory, the way of an edge.
#include <optional>
#include <tuple>
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

TEST(FillStore, GivesLinesInTheOrderOfTheirPlaces) {
  FillStore<std::uint32_t> store("store", 3, 32, "words");
  EXPECT_TRUE(store.empty());
  for (std::uint32_t place = 0; place < 3; ++place) {
    ASSERT_TRUE(store.can_reserve(1));
    EXPECT_EQ(store.reserve(), place);
    EXPECT_FALSE(store.empty());
  }
  EXPECT_FALSE(store.can_reserve(2));
  // The second one comes first: nothing to be read.
  store.fill(10, 1, 11);
  store.read_ahead(10);
  store.read_ahead(11);
  EXPECT_FALSE(store.ready(12));
  // Filled in clock t, there from t + 2 on.
  store.fill(12, 0, 10);
  store.read_ahead(12);
  EXPECT_FALSE(store.ready(13));
  store.read_ahead(13);
  EXPECT_FALSE(store.ready(13));
  EXPECT_TRUE(store.ready(14));
  store.read_ahead(14);  // it waits
  EXPECT_TRUE(store.ready(15));
  EXPECT_EQ(store.line(15), 10u);
  // Then a line a clock.
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
  // The first place again, behind the third.
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
TEST(FillStore, APlaceIsFilledOnceAndIsOneOfThem) {
  FillStore<std::uint32_t> store("store", 3, 32, "words");
  for (int i = 0; i < 3; ++i) store.reserve();
  store.fill(5, 2, 1);
  EXPECT_THROW(store.fill(6, 2, 1), spec::CheckFailed);
  EXPECT_THROW(store.fill(7, 3, 1), spec::CheckFailed);
  store.fill(8, 1, 1);
}
TEST(FillStore, AResetEmptiesEveryPlace) {
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

// Two units, each with its side alone, see one store.
TEST(FillStore, HasASideForEachUnit) {
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
  // Its histogram is its user's.
  struct Recorded : EdgeLatency {
    Histogram& histogram;
    explicit Recorded(Histogram& h) : histogram(h) {}
    void write(Cycle cycle) { record(EdgeLatency::write(cycle)); }
    void end() { record(EdgeLatency::end()); }
    void record(std::optional<Cycle> latency) {
      if (latency) histogram.record(*latency);
    }
  } edges{histogram};
  // An edge on its way to the first stage behind the reader that knows it: the walker.
  void line(Cycle left) {
    edges.leave(left, 1);
    edges.decided(true);
    edges.set_up(true);
  }
  // A group that passes everything.
  void group(bool last) {
    edges.walk(last);
    edges.cover(true);
    edges.test(true);
  }
  std::vector<std::uint64_t> all() const {
    std::vector<std::uint64_t> values;
    for (const Histogram::Bin& bin : histogram.bins())
      values.insert(values.end(), bin.count, bin.low);
    return values;
  }
};
using testing::ElementsAre;
using testing::IsEmpty;

TEST(EdgeLatency, IsFromItsLeavingToItsLastGroup) {
  Latencies l;
  l.line(10);
  for (const bool last : {false, false, true}) l.group(last);
  l.edges.write(20);
  l.edges.write(21);
  EXPECT_THAT(l.all(), IsEmpty()) << "another group may come";
  l.edges.write(25);
  l.edges.end();
  EXPECT_THAT(l.all(), ElementsAre(15));
}
TEST(EdgeLatency, EdgesThatAreNoLineAreLeftOut) {
  Latencies l;
  l.edges.leave(10, 3);
  l.edges.leave(20, 2);
  for (const bool kept : {false, true, false, true, true}) l.edges.decided(kept);
  for (const bool line : {false, true, true}) l.edges.set_up(line);  // of 10, 20, 20
  l.group(true);
  l.group(true);
  l.edges.write(40);
  l.edges.write(51);
  l.edges.end();
  EXPECT_THAT(l.all(), ElementsAre(20, 31));
}
TEST(EdgeLatency, GroupsThatEndOnTheWayAreLeftOut) {
  Latencies l;
  for (const Cycle left : {10, 11, 12, 13}) l.line(left);
  struct Group {
    bool last, covers, passes;
  };
  // The second line has no candidate, the third none that passes, the fourth loses its last group.
  for (const auto& [last, covers, passes] : {Group{false, false, false},
                                             {true, true, true},
                                             {true, false, false},
                                             {true, true, false},
                                             {false, true, true},
                                             {false, true, false},
                                             {true, false, false}}) {
    l.edges.walk(last);
    l.edges.cover(covers);
    if (covers) l.edges.test(passes);
  }
  l.edges.write(100);
  l.edges.write(200);
  l.edges.end();
  EXPECT_THAT(l.all(), ElementsAre(90, 187));
}
TEST(EdgeLatency, OfManyOnTheirWayEachIsItsOwn) {
  Latencies l;
  l.edges.leave(1, 2);
  l.edges.leave(5, 1);
  for (int i = 0; i < 3; ++i) l.edges.decided(true);
  for (int i = 0; i < 3; ++i) l.edges.set_up(true);
  for (const bool last : {false, true, true, false, true}) l.edges.walk(last);
  for (int i = 0; i < 5; ++i) l.edges.cover(true);
  for (int i = 0; i < 5; ++i) l.edges.test(true);
  for (const Cycle written : {10, 20, 30, 40, 50}) l.edges.write(written);
  EXPECT_THAT(l.all(), ElementsAre(19, 29));
  l.edges.end();
  EXPECT_THAT(l.all(), ElementsAre(19, 29, 45));
}
// What nobody announced, as injected faults send it, is not counted, and nothing waits for it.
TEST(EdgeLatency, TokensThatWereNotAnnouncedCountNowhere) {
  Latencies l;
  l.edges.decided(true);
  l.edges.set_up(true);
  l.group(true);
  l.edges.write(9);
  l.edges.end();
  EXPECT_THAT(l.all(), IsEmpty());
  l.line(10);
  l.group(true);
  l.edges.write(17);
  l.edges.write(19);
  l.edges.end();
  EXPECT_THAT(l.all(), ElementsAre(7));
}
TEST(EdgeLatency, AResetForgetsWhatIsOnTheWay) {
  for (int stage = 0; stage < 7; ++stage) {
    Latencies l;
    l.edges.leave(1, 1);
    if (stage > 0) l.edges.decided(true);
    if (stage > 1) l.edges.set_up(true);
    if (stage > 2) l.edges.walk(false);
    if (stage > 3) l.edges.cover(true);
    if (stage > 4) l.edges.test(true);
    if (stage > 5) l.edges.write(4);
    l.edges.reset();
    l.line(10);
    l.group(true);
    l.edges.write(15);
    l.edges.end();
    EXPECT_THAT(l.all(), ElementsAre(5)) << stage;
  }
  // One that is a boundary but for its pair, which has not come.
  Latencies l;
  l.edges.leave(1, 1);
  l.edges.decided(true, true);
  l.edges.reset();
  l.edges.leave(10, 1);
  l.edges.decided(true, true);
  l.edges.paired(true);
  l.edges.set_up(true);
  l.group(true);
  l.edges.write(15);
  l.edges.end();
  EXPECT_THAT(l.all(), ElementsAre(5));
}
TEST(EdgeLatency, AFrameAfterAnotherBeginsAnew) {
  Latencies l;
  l.line(1);
  l.group(true);
  l.edges.write(4);
  l.edges.end();
  l.line(11);
  l.group(true);
  l.edges.write(19);
  l.edges.end();
  l.edges.end();  // of a frame without a line
  EXPECT_THAT(l.all(), ElementsAre(3, 8));
}

}  // namespace
}  // namespace deburr::tb::geometric_rtl::shared_parts_test
