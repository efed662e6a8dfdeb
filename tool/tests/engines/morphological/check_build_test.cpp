// SPDX-License-Identifier: MIT
// Configurations that the morphological engine cannot be built with.
#include "spec/morphological/check_build.h"

#include <gtest/gtest.h>

#include "rtl_model/morphological/morphological_engine.h"
#include "tool/tests/engines/check_build.h"

namespace deburr::tool::check_build_test {
namespace {

using Parameters = spec::morphological::Parameters;

BuildChecks<Parameters, rtl::morphological::MorphologicalEngine> checks() {
  return {"morphological",
          {
              {{{"window_rows", "67"}}, "window_rows", "even number of rows"},
              {{{"window_rows", "18"}},
               "steps",
               "make it at most 7, or give window_rows of at least 20"},
              {{{"edges.source", "predicated"}, {"edges.threshold_mode", "dynamic"}},
               "edges.threshold_mode",
               "must be fixed with edges.source = predicated"},
              {{{"edges.threshold_mode", "dynamic"}},
               "edges.threshold_mode",
               "must be fixed with edges.source = colour"},
              {{{"diagonals", "true"}}, "area", "area = learned with diagonals = true"},
              {{{"round_corners", "true"}}, "area", "area = learned with round_corners = true"},
              {{{"preset", "smaa"}, {"window_rows", "20"}, {"diagonal_steps", "10"}},
               "diagonal_steps",
               "window_rows of at least 22"},
              {{{"preset", "smaa"}, {"quality", "ultra"}, {"window_rows", "32"}},
               "diagonal_steps",
               "diagonal_steps = 16 with window_rows = 32"},
              {{{"preset", "smaa"}, {"ends", "gaps"}}, "border", "must be end with ends = gaps"},
              {{{"preset", "smaa"}, {"area", "analytic"}},
               "border",
               "must be end with area = analytic or learned"},
              {{{"line_pixels", "16"}, {"lanes", "4"}, {"storage", "memory"}},
               "line_pixels",
               "must be at least 17"},
          }};
}

TEST(MorphologicalCheckBuild, EveryRuleHasATestRow) { checks().expect_a_row_a_rule(); }

TEST(MorphologicalCheckBuild, EveryEntryPointGivesTheSameMessage) {
  checks().expect_the_same_words();
}

TEST(MorphologicalCheckBuild, RejectsOutOfRangeValues) { checks().expect_ranges(); }

TEST(MorphologicalCheckBuild, RangeEndsCanBeBuilt) { checks().expect_ends(); }

TEST(MorphologicalCheckBuild, RandomLegalConfigurationsCanBeBuilt) {
  checks().expect_all_else_is_built(300);
}

}  // namespace
}  // namespace deburr::tool::check_build_test
