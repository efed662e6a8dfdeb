// SPDX-License-Identifier: MIT
// The parts of the AreaUnit alone: in which cycles each can do its stages at the earliest, and that
// this is what its datasheet says.
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "rtl_model/morphological/blend/area_unit.h"
#include "tb/unit/rtl/datasheets.h"
#include "tb/unit/rtl/morphological/parts.h"

namespace deburr::tb::morphological_rtl::area_parts_test {
namespace {

using namespace rtl::morphological;  // NOLINT: a test of these

constexpr std::size_t kColumns = 64, kDescriptors = 16;

// A DescriptorStore with a vertical record in each of the first columns, in row 0, and its walk.
struct Walk {
  Walk() : descriptors("descriptor_store", small(), kColumns, {stored, conflicts}) {
    StoredDescriptor descriptor;
    for (std::size_t x = 0; x < kDescriptors; ++x) {
      descriptor.span = static_cast<std::uint16_t>(100 + x);
      descriptors.column().write(x, x, {0, 3, 0}, descriptor);
    }
  }
  // Column x in row 0, with the second stage so many cycles after the first one, and the third one
  // so many after that. False: the memories do not allow it.
  bool finds(std::uint16_t x, Cycle match, Cycle visit) {
    const Slot slot{x, kLag - 1, x};
    const Cycle cycle = Cycle{100} * (x + 1u);
    DescriptorWalk::Beat beat{};
    std::vector<int> spans;
    try {
      walk.address<false>(cycle, configuration, slot, beat);
      walk.match<false, false>(cycle + match, slot, beat);
      walk.visit_edges(cycle + match + visit, beat,
                       [&](std::size_t number, const StoredDescriptor& descriptor,
                           const DescriptorWalk::Edge& edge) {
                         EXPECT_EQ(number, 1u) << "the left edge of lane 0";
                         EXPECT_EQ(edge.k, 0);
                         spans.push_back(descriptor.span);
                       });
    } catch (const spec::CheckFailed&) {
      return false;
    }
    EXPECT_THAT(spans, ::testing::ElementsAre(100 + x));
    return true;
  }

  const FrameConfiguration configuration = Registers(small(), 20, 7).configuration.driven();
  rtl::Counter stored{"stored", "records", "stored"}, conflicts{"conflicts", "clk", "waited"};
  rtl::Counter horizontal{"horizontal", "edges", "along"}, vertical{"vertical", "edges", "down"};
  DescriptorStore descriptors;
  DescriptorWalk walk{"descriptor_walk", small(), descriptors, {horizontal, vertical}};
};

// No stage can be left out: each waits for the words that the one before has addressed.
TEST(DescriptorWalkBlock, HasTheLatencyOfItsDatasheet) {
  Walk bench;
  // A column each, whose words no port has shown before.
  std::uint16_t x = 0;
  Cycle match = 0, visit = 0;
  while (match < 5 && !bench.finds(x++, match, 5)) ++match;
  while (visit < 5 && !bench.finds(x++, match, visit)) ++visit;
  ASSERT_LE(x, kDescriptors);
  // The next unit gets its edges a clock after the last stage.
  expect_notices_a_clock(
      DescriptorWalk::datasheet(), &rtl::Datasheet::latency,
      [&](const rtl::Datasheet& sheet) { expect_latency(sheet, match + visit + 1); });
}

// A line that meets an edge at one of its ends cuts off a trapezoid of it, not two triangles of
// which one is nothing: at the middle of 254 pixels they round apart.
TEST(AnalyticWeightsBlock, AnEdgeThatBeginsOrEndsOnTheLineHasATrapezoid) {
  StoredDescriptor descriptor;
  descriptor.growth = 66052;          // 2^24 / 254
  descriptor.inverse = 254u * 4096u;  // U12.12
  descriptor.span = 254;
  descriptor.before = spec::morphological::Side::kSecond;
  descriptor.after = spec::morphological::Side::kFirst;
  const auto weights = [&](std::int64_t t) {
    descriptor.t = t;
    const EdgeWeights found = AnalyticWeights::of(descriptor, 0);
    return std::array<int, 2>{found.first, found.second};
  };
  // q0 = 0, q1 = 16, or the other way round: (16 + 16) >> 5, where the triangle is
  // (16 x 16 x inverse + 2^28) >> 29 = 0.
  EXPECT_THAT(weights(0), ::testing::ElementsAre(1, 0));
  EXPECT_THAT(weights(-66052), ::testing::ElementsAre(0, 1));
  // Off its ends.
  EXPECT_THAT(weights(-1), ::testing::ElementsAre(0, 0));
  EXPECT_THAT(weights(-66051), ::testing::ElementsAre(0, 0));
}

// A weight of 7 at one sharp corner of two, corner_rounding = 73: 7 x 329 is 255 above 4 x 512, a
// half less one, and rounds down.
TEST(CornerWeights, AreRoundedToNearest) {
  FrameConfiguration configuration;
  configuration.corners = true;
  configuration.corner_loss = 256 - 73;
  const EdgeWeights weights = at_corners(configuration, {7, 7, 5}, 0b0001, 2);
  EXPECT_EQ(weights.first, 4);
  EXPECT_EQ(weights.second, 7) << "no corner on that side";
}

TEST(CornerWeights, StayWhereCornersAreNotRounded) {
  FrameConfiguration configuration;
  configuration.corners = false;
  configuration.corner_loss = 256;
  const EdgeWeights weights = at_corners(configuration, {7, 9, 5}, 0b1111, 2);
  EXPECT_EQ(weights.first, 7);
  EXPECT_EQ(weights.second, 9);
}

// Asked in one clock, it has the edge in the next; a beat of weights may be asked for in each.
TEST(LearnedWeightsBlock, HaveTheLatencyAndIntervalOfTheirDatasheet) {
  LearnedWeights unit("learned", 1);
  StoredDescriptor descriptor;
  descriptor.learned = true;
  descriptor.shape = 1 + 4 * 2;
  descriptor.start_class = 2;
  descriptor.end_class = 6;
  constexpr Cycle kAsked = 10;
  constexpr std::int32_t kLength = 3;
  // Cycles in which weights leave the last stage.
  std::vector<Cycle> cycles;
  std::vector<int> sums;
  for (Cycle cycle = kAsked; cycle < kAsked + 12; ++cycle) {
    BeatWeights weights{};
    weights[0].top.span = 1;  // learned weights have none
    unit.move(cycle, &weights);
    if (weights[0].top.span == 0) {
      cycles.push_back(cycle);
      sums.push_back(weights[0].top.first + weights[0].top.second);
    }
    const auto k = static_cast<std::int32_t>(cycle - kAsked);
    if (k < kLength) unit.ask(0, descriptor, k, kLength - 1 - k);
  }
  ASSERT_EQ(cycles.size(), static_cast<std::size_t>(kLength));
  EXPECT_GT(sums[0] + sums[1] + sums[2], 0);
  for (Cycle& clock : cycles) ++clock;  // a register
  const auto check = [&](const rtl::Datasheet& sheet) { expect_cycles(sheet, cycles, kAsked + 1); };
  expect_notices_a_clock(LearnedWeights::datasheet(), &rtl::Datasheet::latency, check);
  expect_notices_a_clock(LearnedWeights::datasheet(), &rtl::Datasheet::interval, check);
}

// The row above is addressed a clock before the weights of this row come, and what they were goes
// out in the clock in which they do.
TEST(WeightRowsBlock, HaveTheRowAboveAClockAfterItsAddress) {
  WeightRows rows("weight_rows", small(), kColumns);
  const auto weights_of_row = [](int row) {
    BeatWeights weights{};
    weights[0].top = {static_cast<std::uint8_t>(10 + row), static_cast<std::uint8_t>(20 + row), 3};
    return weights;
  };
  WeightToken out{};
  const auto join = [&](Cycle read, Cycle cycle, int row) {
    rows.read(read, 0);
    rows.join(cycle, 20, 0, 1, 0, weights_of_row(row), out);
  };
  rows.write(10, 0, 0, weights_of_row(0));
  EXPECT_THROW(join(20, 20, 1), spec::CheckFailed);
  join(21, 22, 1);
  EXPECT_TRUE(out.any);
  EXPECT_EQ(out.weights[0].up, 20);
  EXPECT_EQ(out.weights[0].down, 11);
}

}  // namespace
}  // namespace deburr::tb::morphological_rtl::area_parts_test
