// SPDX-License-Identifier: MIT
#include "tool/sweep/metric_keys.h"

#include <gtest/gtest.h>

namespace deburr::tool::metric_keys_test {
namespace {

// A * stands for one or more characters, including dots.
TEST(MetricKeys, MatchPattern) {
  for (const auto& [key, pattern] : {std::pair{"cycles", "cycles"},
                                     {"units.a.busy", "units.*.busy"},
                                     {"units.tag_stage.busy", "units.*.busy"},
                                     {"units.a.b.busy", "units.*.busy"},
                                     {"links.a.b", "links.*.*"},
                                     {"work.x", "work.*"},
                                     {"work.xy", "*"}})
    EXPECT_TRUE(is_key_of(key, pattern)) << key << ", " << pattern;
  for (const auto& [key, pattern] : {std::pair{"cycles", "cycle"},
                                     {"cycle", "cycles"},
                                     {"units..busy", "units.*.busy"},
                                     {"units.a.idle", "units.*.busy"},
                                     {"unit.a.busy", "units.*.busy"},
                                     {"links.a.", "links.*.*"},
                                     {"work.", "work.*"},
                                     {"", "*"}})
    EXPECT_FALSE(is_key_of(key, pattern)) << key << ", " << pattern;
}

}  // namespace
}  // namespace deburr::tool::metric_keys_test
