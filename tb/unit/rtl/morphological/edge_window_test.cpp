// SPDX-License-Identifier: MIT
// Read ports of the edge memories: a clock that asks for more stops the simulation, and the busiest
// clock asks for all of them.
#include <algorithm>
#include <map>

#include "tb/unit/rtl/morphological/support.h"

namespace deburr::tb::morphological_rtl {
namespace {

using rtl::morphological::EdgeRows;
using rtl::morphological::EdgeWindow;
using rtl::morphological::ParameterStore;
using spec::morphological::Preset;

// A window with the top edges of row 5 set at columns 10 and up.
struct Window {
  explicit Window(const Parameters& p) : store("store", p), edges("edges", p, store) {
    bus.socket.bind(store.registers.bus);
    store.write_size(100, 20);
    EXPECT_TRUE(store.latch());
    for (int y = 0; y < 20; ++y)
      for (int x = 0; x < 100; ++x) edges.write(y, x, 0, y == 5 && x >= 10, 1);
  }
  Bus bus{"bus"};
  ParameterStore store;
  EdgeWindow edges;
};

Parameters built(bool contiguous, int reach_columns = 256) {
  Parameters p = preset(Preset::kDeburr, 32, reach_columns);
  p.contiguous = contiguous;
  return p;
}

TEST(EdgePorts, AreThoseOfExtractorAndPredictors) {
  Parameters p = built(true);
  p.predictor_units = 3;
  p.lanes = spec::morphological::Lanes::kTwo;
  Window w(p);
  EXPECT_EQ(w.edges.ports(), "37R1W");  // 1 + 2 sides x 6 x (2 + 1)
  ASSERT_NE(w.edges.rows(), nullptr);
  EXPECT_EQ(w.edges.rows()->ports(), "12R1W");
  EXPECT_EQ(w.edges.rows()->bits(), 67u * 256u);
  EXPECT_EQ(w.edges.rows()->stretch(), 128);
}

TEST(EdgePorts, WithoutContiguousThereAreNoRowsAndFewerPorts) {
  Window w(built(false));
  EXPECT_EQ(w.edges.ports(), "9R1W");  // 1 + 2 sides x 2 x (1 + 1)
  EXPECT_EQ(w.edges.rows(), nullptr);
}

TEST(EdgePorts, OneReadTooManyInAClockStops) {
  Window w(built(true));
  for (const rtl::Cycle cycle : {7u, 8u, 100u}) {
    for (int i = 0; i < 13; ++i) w.edges.read(cycle, 0, 2);
    try {
      w.edges.read(cycle, 0, 2);
      FAIL() << "no error";
    } catch (const spec::CheckFailed& error) {
      EXPECT_THAT(error.what(), ::testing::HasSubstr("edges: cycle " + std::to_string(cycle) +
                                                     ": one read too many for its 13 read ports"));
    }
  }
  for (int i = 0; i < 4; ++i) w.edges.read_row(5);
  EXPECT_THROW(w.edges.read_row(5), spec::CheckFailed);
  EXPECT_NO_THROW(w.edges.read_row(6));
}

TEST(EdgePorts, GiveTheColumnsThatTheyReadAndNoOthers) {
  Window w(built(true));
  const EdgeWindow::Columns columns = w.edges.read(1, 9, 3);
  EXPECT_EQ(columns.top_pair(10, 5), 2u);
  EXPECT_EQ(columns.top_pair(11, 5), 3u);
  EXPECT_FALSE(columns.left(11, 5));
  EXPECT_THROW(columns.top_pair(9, 5), spec::CheckFailed);
  EXPECT_THROW(columns.top_pair(12, 5), spec::CheckFailed);
  EXPECT_THROW(columns.left(8, 5), spec::CheckFailed);
}

TEST(EdgePorts, GiveAStretchOfHalfTheReachAndNoLonger) {
  Window w(built(true, 61));
  EXPECT_TRUE(w.edges.unbroken(10, 5, 31));
  EXPECT_FALSE(w.edges.unbroken(9, 5, 31));
  EXPECT_FALSE(w.edges.unbroken(-1, 5, 3));
  EXPECT_THROW(w.edges.unbroken(10, 5, 32), spec::CheckFailed);
}

// No step is longer than that: half the reach, then one more, as odd reaches allow.
class LongestStep : public ::testing::TestWithParam<int> {};
TEST_P(LongestStep, FitsIntoAPort) {
  const int reach = GetParam(), length = reach / 2, step = reach - length;
  Parameters p = preset(Preset::kDeburr, 32, reach);
  EngineBench bench(p);
  // Steps of `length` and `step` between long flat parts; the line goes down to the right.
  const int from = 90;
  bench.run(draw(250, 30, [&](int x, int y) {
    const int stair = x < from ? 0 : x < from + length ? 1 : x < from + length + step ? 2 : 3;
    return grey(y >= 10 + stair ? 255 : 0);
  }));
  // The run in row 11 ends where the step of row 12 begins: taken, and all of the reach is used.
  EXPECT_GE(bench.engine.predictor_h.extended_runs.value(), 1u);
}
INSTANTIATE_TEST_SUITE_P(Reaches, LongestStep, ::testing::Values(4, 5, 8, 9, 16, 33, 64, 65));

// As many as are stated, for each number of lanes: the busiest clock uses every port.
struct Build {
  int lanes_code, units;
  bool contiguous;
};
void PrintTo(const Build& b, std::ostream* out) { *out << b.lanes_code << ' ' << b.units; }
class BusiestClock : public ::testing::TestWithParam<Build> {};
TEST_P(BusiestClock, UsesEveryPort) {
  Parameters p = built(GetParam().contiguous);
  p.lanes = static_cast<spec::morphological::Lanes>(GetParam().lanes_code);
  p.predictor_units = GetParam().units;
  EngineBench bench(p);
  const Frame in = draw(96, 80, [](int x, int y) { return grey((x + y) / 2 % 2 != 0 ? 255 : 0); });
  bench.engine.set_frame_size(in.width, in.height);
  bench.driver.send(beats_of(in, lanes_of(p)));
  const auto beats = static_cast<std::uint64_t>(beats_a_row(in, p) * in.height);
  const rtl::morphological::ReadPorts& ports = bench.engine.window.read_ports();
  int most = 0, most_rows = 0;
  bench.bench->run(
      [&] {
        most = std::max(most, ports.used());
        if (p.contiguous)
          most_rows = std::max(most_rows, bench.engine.window.rows()->read_ports().used());
        return bench.sink.received() == beats && bench.engine.idle();
      },
      1'000'000);
  EXPECT_EQ(most, ports.count());
  EXPECT_EQ(most_rows, p.contiguous ? bench.engine.window.rows()->read_ports().count() : 0);
}
INSTANTIATE_TEST_SUITE_P(Builds, BusiestClock,
                         ::testing::Values(Build{0, 2, true}, Build{1, 2, true}, Build{2, 2, true},
                                           Build{0, 1, false}, Build{0, 4, true},
                                           Build{2, 1, false}));

}  // namespace
}  // namespace deburr::tb::morphological_rtl
