// SPDX-License-Identifier: MIT
// Linked with the suites of the texture unit: they run with units of hdl/ in their places.
#include <gtest/gtest.h>

#include <vector>

#include "tb/system/texture_runs.h"

namespace deburr::tb::suites_with_twins_test {
namespace {

[[maybe_unused]] const bool twins = twins_do_the_work() = true;

// A suite runs with SystemC units where the build has no others, so that it says nothing of it.
TEST(SuitesWithTwins, TheBuildHasWhatTheyRunMost) {
  std::vector<spec::texture::Parameters> all = {paper_rules(), {}};
  for (int clocks : {1, 2, 4}) {
    spec::texture::Parameters storm;
    storm.axes = spec::texture::Axes::kEight;
    storm.axis_clocks = clocks;
    storm.srgb_output = spec::texture::SrgbOutput::kEncoded;
    all.push_back(storm);
  }
  for (spec::texture::Parameters& p : all) {
    EXPECT_NO_THROW(texture_twins({"address", "cache", "filter"}, as_built(p, {})));
    p.cache_bytes = 2048;
    p.cache_outstanding = 8;
    p.cache_fifo_depth = 24;
    EXPECT_NO_THROW(texture_twins({"address", "cache", "filter"}, p));
  }
}

}  // namespace
}  // namespace deburr::tb::suites_with_twins_test
