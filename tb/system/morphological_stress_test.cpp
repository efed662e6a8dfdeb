// SPDX-License-Identifier: MIT
// Data must not depend on timing: random stalls on every link, random memory latency, reset in
// mid-frame, fast path on and off. Invariant results are compared between processes. (Checkers,
// order of evaluation and seeds: tb/unit/rtl/morphological/kit.h.)
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <tuple>

#include "tb/base/forked.h"
#include "tb/system/morphological_runs.h"

namespace deburr::tb::morphological_system::morphological_stress_test {
namespace {

using spec::morphological::Lanes;
using spec::morphological::Storage;
using Variant = std::tuple<Lanes, Storage>;

MorphologicalRunOptions options_of(Lanes lanes, Storage storage, Preset which = Preset::kDeburr) {
  MorphologicalRunOptions options;
  options.morphological = preset(which, lanes);
  options.morphological.storage = storage;
  options.morphological.line_pixels = 512;
  options.memory.latency = 30;
  return options;
}

MorphologicalOutcome run(const MorphologicalRunOptions& options) {
  return forked<MorphologicalOutcome>([&] {
    return simulate({fans(16), blocks(150, 90, 2), noise(61, 40)}, options);
  });
}

void expect_same_data(const MorphologicalOutcome& a, const MorphologicalOutcome& b) {
  EXPECT_EQ(a.hash, b.hash);
  EXPECT_EQ(a.pixels, b.pixels);
  EXPECT_EQ(a.edge_pixels, b.edge_pixels);
  EXPECT_EQ(a.traffic_comparisons, b.traffic_comparisons);
  EXPECT_EQ(a.mismatches + b.mismatches + a.traffic_mismatches + b.traffic_mismatches, 0u);
}

class MorphologicalStress : public testing::TestWithParam<Variant> {
 protected:
  MorphologicalRunOptions calm() const {
    return options_of(std::get<0>(GetParam()), std::get<1>(GetParam()));
  }
};

TEST_P(MorphologicalStress, FastPathIsInvisible) {
  MorphologicalRunOptions fast = calm(), slow = calm();
  slow.fast_path = false;
  const MorphologicalOutcome a = run(fast), b = run(slow);
  expect_same_data(a, b);
  EXPECT_EQ(a.cycles, b.cycles);
  EXPECT_LT(a.activations, b.activations) << "the fast path was never taken";
}

TEST_P(MorphologicalStress, RandomStallsChangeOnlyTiming) {
  const MorphologicalOutcome quiet = run(calm());
  for (const std::uint32_t permille : {50u, 500u}) {
    MorphologicalRunOptions stalled = calm();
    stalled.stall_permille = permille;
    stalled.poison = true;
    stalled.seed = permille;
    stalled.shuffle = true;
    const MorphologicalOutcome outcome = run(stalled);
    expect_same_data(quiet, outcome);
    EXPECT_GT(outcome.cycles, quiet.cycles);
  }
}

TEST_P(MorphologicalStress, ResetInMidFrameRestarts) {
  const MorphologicalOutcome quiet = run(calm());
  // While rows fill, in the first flush rows, and in arbitrary cycles; also with stalls.
  for (const rtl::Cycle at : {40u, 3001u, 9000u, 12345u}) {
    MorphologicalRunOptions options = calm();
    options.reset_after = at;
    options.stall_permille = at == 3001 ? 150 : 0;
    options.poison = true;
    const MorphologicalOutcome outcome = run(options);
    EXPECT_EQ(quiet.hash, outcome.hash) << "reset after " << at;
    EXPECT_EQ(outcome.mismatches + outcome.traffic_mismatches, 0u);
    EXPECT_EQ(quiet.pixels, outcome.pixels);
  }
}

TEST_P(MorphologicalStress, SameSeedGivesTheSameCycles) {
  MorphologicalRunOptions options = calm();
  options.stall_permille = 150;
  options.poison = true;
  options.memory.latency_max = 200;
  const MorphologicalOutcome a = run(options), b = run(options);
  expect_same_data(a, b);
  EXPECT_EQ(a.cycles, b.cycles);
}

INSTANTIATE_TEST_SUITE_P(
    EachVariant, MorphologicalStress,
    testing::Values(Variant{Lanes::kOne, Storage::kLineBuffers},
                    Variant{Lanes::kTwo, Storage::kMemory},
                    Variant{Lanes::kFour, Storage::kLineBuffers},
                    Variant{Lanes::kFour, Storage::kMemory}),
    [](const auto& p) {
      return fmt::format(
          "lanes{}_{}",
          spec::morphological::kLanesNames[static_cast<std::size_t>(std::get<0>(p.param))],
          spec::morphological::kStorageNames[static_cast<std::size_t>(std::get<1>(p.param))]);
    });

TEST(MorphologicalMemory, MemoryTimingChangesNoData) {
  for (const Lanes lanes : {Lanes::kOne, Lanes::kFour}) {
    const MorphologicalOutcome quiet = run(options_of(lanes, Storage::kMemory));
    MorphologicalRunOptions options = options_of(lanes, Storage::kMemory);
    options.memory.latency_max = 400;
    options.memory.banks = 4;
    options.memory.bank_busy = 6;
    options.memory.outstanding = 8;
    options.memory.bytes_per_cycle = 16;
    options.stall_permille = 100;
    options.poison = true;
    options.shuffle = true;
    for (const std::uint64_t seed : {1u, 2u}) {
      options.seed = seed;
      expect_same_data(quiet, run(options));
    }
  }
}

// Both kinds of storage and all lane counts deliver the same pixels, for every preset.
TEST(MorphologicalMemory, StorageAndLanesChangeNoPixel) {
  for (const Preset which : kBuilt) {
    const MorphologicalOutcome one = run(options_of(Lanes::kOne, Storage::kLineBuffers, which));
    for (const Variant& v :
         {Variant{Lanes::kTwo, Storage::kLineBuffers}, Variant{Lanes::kFour, Storage::kMemory}})
      EXPECT_EQ(one.hash, run(options_of(std::get<0>(v), std::get<1>(v), which)).hash);
  }
}

struct Broken {
  const char* name;
  std::int64_t address, bytes;
  Lanes lanes;
};
void PrintTo(const Broken& broken, std::ostream* out) { *out << broken.name; }
class BrokenMemory : public testing::TestWithParam<Broken> {};

// The golden model predicts the black pixels and counts the lines read with an error; the register
// also counts each line's write.
TEST_P(BrokenMemory, ErrorResponsesReadAsZeroAndAreReported) {
  namespace reg = spec::morphological::reg;
  MorphologicalRunOptions options = options_of(GetParam().lanes, Storage::kMemory);
  options.memory.latency_max = 90;
  options.memory.error_address = GetParam().address;
  options.memory.error_bytes = GetParam().bytes;
  const std::vector<MorphologicalInput> frames = {blocks(150, 40)};  // 10 lines per row
  Simulation simulation(options);
  MorphologicalEnvironment environment(simulation, frames, options);
  simulation.elaborate(environment);
  EXPECT_THROW(simulation.run(), spec::SimulationError);
  EXPECT_NO_THROW(environment.check());
  EXPECT_EQ(environment.delivered_in_all(), 150u * 40u);
  EXPECT_NE(environment.host().read(reg::kStatus) & reg::kStatusMemoryError, 0u);
  const std::int64_t first = GetParam().address / 64,
                     end = (GetParam().address + GetParam().bytes + 63) / 64;
  const auto lines = static_cast<std::uint64_t>(std::min<std::int64_t>(end, 400) - first);
  EXPECT_EQ(environment.golden_model().memory_errors(), lines);
  EXPECT_EQ(environment.host().read(reg::kMemoryErrors), 2 * lines);
}
INSTANTIATE_TEST_SUITE_P(MorphologicalMemory, BrokenMemory,
                         testing::Values(Broken{"two_lines", 640, 128, Lanes::kOne},
                                         Broken{"a_byte", 12345, 1, Lanes::kTwo},
                                         Broken{"last_rows", 20000, 1 << 20, Lanes::kFour},
                                         Broken{"all", 0, 25600, Lanes::kFour}),
                         [](const auto& broken) { return broken.param.name; });

}  // namespace
}  // namespace deburr::tb::morphological_system::morphological_stress_test
