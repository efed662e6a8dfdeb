// SPDX-License-Identifier: MIT
// Parts of the AreaUnit, each on its own: the earliest cycle of every stage, which must equal its
// datasheet.
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

// A DescriptorStore with a vertical descriptor at row 0 of each of the first columns, and the walk
// that reads it.
struct Walk {
  Walk() : descriptors("descriptor_store", small(), kColumns, {stored, conflicts}) {
    StoredDescriptor descriptor;
    for (std::size_t x = 0; x < kDescriptors; ++x) {
      descriptor.span = static_cast<std::uint16_t>(100 + x);
      descriptors.column().write(x, x, {0, 3, 0}, descriptor);
    }
  }
  // Looks up column x in row 0. The second stage runs `match` cycles after the first, the third
  // `visit` cycles after the second. False if the memories reject an access.
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

// No stage can be skipped: each waits for the words that the previous stage has addressed.
TEST(DescriptorWalkBlock, LatencyMatchesDatasheet) {
  Walk bench;
  // Every attempt takes a new column, whose words no port has returned before.
  std::uint16_t x = 0;
  Cycle match = 0, visit = 0;
  while (match < 5 && !bench.finds(x++, match, 5)) ++match;
  while (visit < 5 && !bench.finds(x++, match, visit)) ++visit;
  ASSERT_LE(x, kDescriptors);
  // The next unit receives the edges one cycle after the last stage.
  expect_detects_one_cycle(
      DescriptorWalk::datasheet(), &rtl::Datasheet::latency,
      [&](const rtl::Datasheet& sheet) { expect_latency(sheet, match + visit + 1); });
}

// A line that meets an edge at one of its ends cuts off one trapezoid, not two triangles of which
// one is empty. At the middle of 254 pixels the two round differently.
TEST(AnalyticWeightsBlock, EdgeThatEndsOnTheLineGetsATrapezoid) {
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
  // q0 = 0 and q1 = 16, or the reverse: (16 + 16) >> 5, where the triangle gives (16 x 16 x inverse
  // + 2^28) >> 29 = 0.
  EXPECT_THAT(weights(0), ::testing::ElementsAre(1, 0));
  EXPECT_THAT(weights(-66052), ::testing::ElementsAre(0, 1));
  // Slightly off these positions there is no trapezoid.
  EXPECT_THAT(weights(-1), ::testing::ElementsAre(0, 0));
  EXPECT_THAT(weights(-66051), ::testing::ElementsAre(0, 0));
}

// One sharp corner of two, weight 7, corner_rounding = 73: 7 x 329 = 4 x 512 + 255, just below one
// half, rounds down.
TEST(CornerWeights, WeightsRoundToNearest) {
  FrameConfiguration configuration;
  configuration.corners = true;
  configuration.corner_loss = 256 - 73;
  const EdgeWeights weights = at_corners(configuration, {7, 7, 5}, 0b0001, 2);
  EXPECT_EQ(weights.first, 4);
  EXPECT_EQ(weights.second, 7) << "no corner on that side";
}

TEST(CornerWeights, WeightsStayWithoutCornerRounding) {
  FrameConfiguration configuration;
  configuration.corners = false;
  configuration.corner_loss = 256;
  const EdgeWeights weights = at_corners(configuration, {7, 9, 5}, 0b1111, 2);
  EXPECT_EQ(weights.first, 7);
  EXPECT_EQ(weights.second, 9);
}

// The unit takes the edge in the cycle after the request; one beat of weights can be requested per
// cycle.
TEST(LearnedWeightsBlock, LatencyAndIntervalMatchDatasheet) {
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
    weights[0].top.span = 1;  // learned weights have no span
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
  for (Cycle& clock : cycles) ++clock;  // the output register
  const auto check = [&](const rtl::Datasheet& sheet) { expect_cycles(sheet, cycles, kAsked + 1); };
  expect_detects_one_cycle(LearnedWeights::datasheet(), &rtl::Datasheet::latency, check);
  expect_detects_one_cycle(LearnedWeights::datasheet(), &rtl::Datasheet::interval, check);
}

// The row above is addressed one cycle before the weights of this row arrive; its weights leave in
// the cycle in which those arrive.
TEST(WeightRowsBlock, RowAboveArrivesOneCycleAfterItsAddress) {
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
