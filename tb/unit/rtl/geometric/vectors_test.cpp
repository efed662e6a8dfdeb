// SPDX-License-Identifier: MIT
// The frames of spec/geometric/vectors.h: pixels, weights, lists of accesses, and work counters.
#include "spec/geometric/vectors.h"

#include "tb/unit/rtl/geometric/support.h"
#include "tb/unit/spec/geometric/vector_names.h"

namespace deburr::tb::geometric_rtl::vectors_test {
namespace {

using spec::geometric::FrameResult;
using spec::geometric::FrameVector;

FrameResult result_of(const FrameVector& v) {
  Parameters p = preset_parameters(v.preset);
  apply_settings(p, v.settings);
  EngineOptions options;
  options.bench.check_widths = true;
  EngineBench b(p, options);
  b.load(contract_scene(v.frame));
  b.run();
  testing::Test::RecordProperty("edge_cycles", static_cast<int>(b.bus.read(reg::kEdgeCycles)));
  testing::Test::RecordProperty("resolve_cycles",
                                static_cast<int>(b.bus.read(reg::kResolveCycles)));
  return {{b.pixel_hash(), b.weight_hash(), b.traffic_hash()},
          b.engine.work(),
          {b.reads(b.bases.vertices).size(), b.reads(b.bases.depth).size(),
           b.reads(b.bases.weights).size(), b.writes(b.bases.weights).size(),
           b.reads(p.frame_copy ? b.bases.copy : b.bases.colour).size(),
           b.writes(b.bases.colour).size()}};
}

class Vectors : public ::testing::TestWithParam<FrameVector> {};

TEST_P(Vectors, PixelsWeightsAndTraffic) {
  EXPECT_EQ(differences(GetParam().result, result_of(GetParam())), "");
}
INSTANTIATE_TEST_SUITE_P(Page, Vectors, ::testing::ValuesIn(geometric::all_frame_vectors()),
                         [](const auto& test) { return std::string(1, test.param.name); });

// Frames that reduce memory traffic.
INSTANTIATE_TEST_SUITE_P(LessTraffic, Vectors,
                         ::testing::ValuesIn(spec::geometric::kTrafficFrameVectors),
                         [](const auto& test) { return std::string(1, test.param.name); });

TEST(FrameVectors, EachValueIsCompared) {
  const FrameVector& v = spec::geometric::kFrameVectors[0];
  expect_each_value_is_compared(v.result, result_of(v));
}

}  // namespace
}  // namespace deburr::tb::geometric_rtl::vectors_test
