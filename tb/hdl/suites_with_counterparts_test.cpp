// SPDX-License-Identifier: MIT
// Linked with the suites of the texture unit: these run with units of hdl/ instead of SystemC
// units, and fail if one of them was idle.
#include <gtest/gtest.h>

#include <exception>
#include <string>
#include <utility>
#include <vector>

#include "tb/base/forked.h"
#include "tb/system/texture_runs.h"

namespace deburr::tb::suites_with_counterparts_test {
namespace {

using Units = std::vector<std::string>;

// Tests that use configurations that are not all built, by name prefix, with the units that may
// stay SystemC.
const std::vector<std::pair<std::string, Units>>& exceptions() {
  static const std::vector<std::pair<std::string, Units>> all = {
      {"Texture/EveryOption.", {"address", "filter"}},
      {"Texture/EveryCache.", {"cache"}},
      {"Texture/FifoDepth.", {"cache"}},
      {"FifoDepthOfANarrowMemory.", {"cache"}},
      {"TextureStress/HiddenLatency.", {"cache"}},
      {"TextureStress.ShortFifoDoesNotHideLatency", {"cache"}},
      {"TextureStress.RandomMemoryLatencyChangesNoData", {"cache"}},
      {"FrameReset.MissingResetIsDetected", {"cache"}}};
  return all;
}
Units not_built() {
  const testing::TestInfo* const test = testing::UnitTest::GetInstance()->current_test_info();
  const std::string name = std::string(test->test_suite_name()) + "." + test->name();
  for (const auto& [begin, units] : exceptions())
    if (name.starts_with(begin)) return units;
  return {};
}

[[maybe_unused]] const bool counterparts = [] {
  not_all_built = not_built;
  return counterparts_do_the_work() = true;
}();

// Without a built counterpart a suite silently runs with SystemC units, so check the main
// configurations.
TEST(SuitesWithCounterparts, MainConfigurationsAreBuilt) {
  std::vector<spec::texture::Parameters> all = {stimuli::paper_configuration(), {}};
  for (int cycles : {1, 2, 4}) {
    spec::texture::Parameters storm;
    storm.axes = spec::texture::Axes::kEight;
    storm.axis_cycles = cycles;
    storm.srgb_output = spec::texture::SrgbOutput::kEncoded;
    all.push_back(storm);
  }
  for (spec::texture::Parameters& p : all) {
    EXPECT_NO_THROW(texture_counterparts({"address", "cache", "filter"}, as_built(p, {}), 1));
    p.cache_bytes = 2048;
    p.cache_outstanding = 8;
    p.cache_fifo_depth = 24;
    EXPECT_NO_THROW(texture_counterparts({"address", "cache", "filter"}, p, 1));
  }
}

// Injected: runs in which one unit stays SystemC, because it is not built for their configuration.
TEST(SuitesWithCounterparts, RunWithIdleCounterpartFails) {
  spec::texture::Parameters ways, spread, kernel;
  ways.cache_ways = 4;
  spread.spread = 11;
  kernel.footprint = spec::texture::FootprintRule::kQuarter;
  kernel.log2 = spec::texture::Log2Rule::kCorrected;
  kernel.count = spec::texture::CountRule::kCeil;
  kernel.kernel = spec::texture::Kernel::kTent;
  kernel.spread = 102;
  const auto failure = [](const spec::texture::Parameters& parameters) -> std::string {
    TextureRunOptions options;
    options.texture = parameters;
    try {
      forked<TextureOutcome>([&] { return simulate(picture("plane", 32), {}, options); });
    } catch (const std::exception& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(failure({}), "");
  EXPECT_EQ(failure(ways), "the unit cache in SystemVerilog has moved no beat");
  EXPECT_EQ(failure(spread), "the unit address in SystemVerilog has moved no beat");
  EXPECT_EQ(failure(kernel), "the unit filter in SystemVerilog has moved no beat");
}

}  // namespace
}  // namespace deburr::tb::suites_with_counterparts_test
