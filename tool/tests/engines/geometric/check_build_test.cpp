// SPDX-License-Identifier: MIT
// Configurations that the geometric engine cannot be built with.
#include "spec/geometric/check_build.h"

#include <gtest/gtest.h>

#include "rtl_model/geometric/geometric_engine.h"
#include "tool/tests/engines/check_build.h"

namespace deburr::tool::check_build_test {
namespace {

using Parameters = spec::geometric::Parameters;

BuildChecks<Parameters, rtl::geometric::GeometricEngine> checks() {
  return {"geometric",
          {
              {{{"reciprocal_table", "4"}}, "reciprocal_table", "use 0, or pipelined = false"},
              {{{"face_limit", "8193"}}, "face_limit", "multiple of 512"},
              {{{"fills", "7"}}, "fills", "at least 8 lines"},
              {{{"fills", "64"}, {"memory.outstanding", "63"}},
               "fills",
               "fills = 64 with memory.outstanding = 63"},
              {{{"resolve_lines", "15"}}, "resolve_lines", "at least 16 lines"},
              {{{"frame_copy", "true"}, {"copy_lines", "1"}}, "copy_lines", "at least 2 lines"},
              {{{"coarse_lines", "16"}, {"depth_test", "off"}},
               "coarse_lines",
               "must be none with depth_test = off"},
          }};
}

TEST(GeometricCheckBuild, EveryRuleHasATestRow) { checks().expect_a_row_a_rule(); }

TEST(GeometricCheckBuild, EveryEntryPointGivesTheSameMessage) { checks().expect_the_same_words(); }

TEST(GeometricCheckBuild, RejectsOutOfRangeValues) { checks().expect_ranges(); }

TEST(GeometricCheckBuild, RangeEndsCanBeBuilt) { checks().expect_ends(); }

TEST(GeometricCheckBuild, RandomLegalConfigurationsCanBeBuilt) {
  checks().expect_all_else_is_built(300);
}

}  // namespace
}  // namespace deburr::tool::check_build_test
