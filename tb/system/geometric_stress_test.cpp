// SPDX-License-Identifier: MIT
// Conditions that must not change any pixel, candidate or memory line of a rendered frame: stalls
// on every link, late and out-of-order memory responses, the order in which units are evaluated,
// the fast path, noise in unwritten memory, and a reset in mid-frame. (State after a reset in any
// cycle: tb/unit/rtl/geometric/kit.h.)
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tb/base/forked.h"
#include "tb/system/geometric_runs.h"

namespace deburr::tb::geometric_system::geometric_stress_test {
namespace {

class GeometricStress : public testing::TestWithParam<Preset> {
 protected:
  static GeometricRunOptions calm() {
    GeometricRunOptions options;
    options.geometric = preset(GetParam());
    options.geometric.weight_blocks = CacheLines::k16;  // so that blocks spill
    options.geometric.depth_lines = options.geometric.vertex_lines = CacheLines::k32;
    return options;
  }
  static GeometricOutcome run(const GeometricRunOptions& options) {
    // The frames are drawn before the first run, so that child processes do not draw them again.
    static const std::vector<Frame> kFrames = {scene_frame("object", 120, 90),
                                               random_frame(77, 50, 4)};
    return forked<GeometricOutcome>([&] { return simulate(kFrames, options); });
  }
};

TEST_P(GeometricStress, ConditionsDoNotChangeThePicture) {
  const GeometricOutcome quiet = run(calm());
  EXPECT_GT(quiet.spilled, 100u);
  const auto expect_same = [&](const char* what, auto&& change) {
    GeometricRunOptions options = calm();
    change(options);
    const GeometricOutcome outcome = run(options);
    EXPECT_EQ(outcome.hash, quiet.hash) << what;
    EXPECT_EQ(outcome.mismatches + outcome.traffic_mismatches, 0u) << what;
    EXPECT_EQ(outcome.comparisons, quiet.comparisons) << what;
    EXPECT_EQ(outcome.traffic_comparisons, quiet.traffic_comparisons) << what;
    return outcome;
  };
  for (const std::uint32_t permille : {50u, 300u, 600u}) {
    const GeometricOutcome slow = expect_same("stalls", [&](GeometricRunOptions& o) {
      o.stall_permille = permille;
      o.seed = permille;
    });
    EXPECT_GT(slow.cycles, quiet.cycles);
  }
  for (const int latency_max : {30, 300}) {
    expect_same("latency", [&](GeometricRunOptions& o) {
      o.memory.latency = 1;
      o.memory.latency_max = latency_max;
      o.memory.banks = 4;
      o.memory.bank_busy = 3;
    });
  }
  expect_same("little bandwidth", [](GeometricRunOptions& o) {
    o.memory.bytes_per_cycle = 8;
    o.memory.outstanding = 2;
  });
  const GeometricOutcome shuffled =
      expect_same("order of evaluation", [](GeometricRunOptions& o) { o.shuffle = true; });
  EXPECT_EQ(shuffled.cycles, quiet.cycles);
  const GeometricOutcome slow_path =
      expect_same("fast path off", [](GeometricRunOptions& o) { o.fast_path = false; });
  EXPECT_EQ(slow_path.cycles, quiet.cycles);
  EXPECT_GE(slow_path.activations, quiet.activations);
  const GeometricOutcome noisy =
      expect_same("poison", [](GeometricRunOptions& o) { o.poison = true; });
  EXPECT_EQ(noisy.cycles, quiet.cycles);
  expect_same("everything", [](GeometricRunOptions& o) {
    o.stall_permille = 150;
    o.memory.latency_max = 120;
    o.shuffle = o.poison = true;
    o.seed = 9;
  });
}

TEST_P(GeometricStress, SameSeedGivesTheSameCycles) {
  GeometricRunOptions options = calm();
  options.stall_permille = 150;
  options.memory.latency_max = 80;
  options.seed = 5;
  const GeometricOutcome first = run(options), second = run(options);
  EXPECT_EQ(first.cycles, second.cycles);
  options.seed = 6;
  EXPECT_NE(run(options).cycles, first.cycles);
}

TEST_P(GeometricStress, ResetRestartsTheRun) {
  const GeometricOutcome quiet = run(calm());
  for (const rtl::Cycle at : {3u, 40u, 150u, 900u, 4001u}) {
    GeometricRunOptions options = calm();
    options.reset_after = at;
    options.stall_permille = at == 900 ? 150 : 0;
    options.poison = true;
    const GeometricOutcome outcome = run(options);
    EXPECT_EQ(outcome.hash, quiet.hash) << "reset after " << at;
    EXPECT_EQ(outcome.mismatches + outcome.traffic_mismatches, 0u) << at;
    EXPECT_EQ(outcome.lines, quiet.lines);
  }
}

// A narrow bus still carries writes issued before the reset after their latency has passed.
TEST_P(GeometricStress, WritesBeforeAResetDoNotCorruptTheFrame) {
  GeometricRunOptions options = calm();
  options.memory.bytes_per_cycle = 4;
  options.memory.outstanding = 96;
  const GeometricOutcome quiet = run(options);
  constexpr rtl::Cycle kParts = 16;
  for (rtl::Cycle part = 1; part < kParts; ++part) {
    options.reset_after = quiet.cycles * part / kParts;
    const GeometricOutcome outcome = run(options);
    EXPECT_EQ(outcome.hash, quiet.hash) << "reset after " << options.reset_after;
    EXPECT_EQ(outcome.mismatches + outcome.traffic_mismatches, 0u) << options.reset_after;
  }
}

INSTANTIATE_TEST_SUITE_P(Geometric, GeometricStress, testing::ValuesIn(kPresets),
                         [](const auto& row) { return std::to_string(row.index); });

}  // namespace
}  // namespace deburr::tb::geometric_system::geometric_stress_test
