// SPDX-License-Identifier: MIT
// Configurations that the texture unit cannot be built with.
#include "spec/texture/check_build.h"

#include <gtest/gtest.h>

#include "rtl_model/texture/texture_unit.h"
#include "tool/tests/engines/check_build.h"

namespace deburr::tool::check_build_test {
namespace {

using Parameters = spec::texture::Parameters;

BuildChecks<Parameters, rtl::texture::TextureUnit> checks() {
  return {
      "texture",
      {
          {{{"cache.bytes", "3000"}}, "cache.bytes", "power of two"},
          {{{"cache.line_bytes", "48"}}, "cache.line_bytes", "power of two"},
          {{{"cache.ways", "3"}}, "cache.ways", "power of two"},
          {{{"cache.bytes", "256"}, {"cache.ways", "8"}},
           "cache.bytes",
           "with cache.line_bytes = 64, cache.ways = 8: must hold at least one set, with a line "
           "for each way; make it at least 512"},
          {{{"cache.fifo_depth", "1"}}, "cache.fifo_depth", "at least 2 entries"},
          {{{"axes", "eight"}, {"axis_cycles", "3"}}, "axis_cycles", "power of two"},
          {{{"axis_cycles", "4"}},
           "axis_cycles",
           "with axes = four: must be at most half of the directions"},
          {{{"preset", "paper"}, {"axis_cycles", "2"}},
           "axis_cycles",
           "make it at most 1 for 2 directions"},
          {{{"cache.bytes", "65536"}}, "cache.bytes", "make it at most 32768, or lines longer"},
          {{{"cache.bytes", "32768"}, {"cache.line_bytes", "32"}, {"cache.ways", "8"}},
           "cache.bytes",
           "at most 512 lines"},
          {{{"cache.outstanding", "3"}}, "cache.outstanding", "at least 4 lines"},
          {{{"width", "3"}}, "width", "power of two"},
          {{{"width", "4"}, {"fragments", "3"}}, "fragments", "power of two"},
          {{{"width", "4"}, {"cache.line_banks", "3"}}, "cache.line_banks", "power of two"},
          {{{"width", "4"},
            {"cache.line_banks", "4"},
            {"cache.fill_writes", "3"},
            {"cache.outstanding", "60"}},
           "cache.fill_writes",
           "power of two"},
          {{{"fragments", "2"}}, "fragments", "make it at most 1"},
          {{{"cache.lookups", "5"}}, "cache.lookups", "4, 4, 1, 1 and 1 with width = 1"},
          {{{"width", "2"}, {"cache.replacement", "fifo"}}, "cache.replacement", "must be lru"},
          {{{"width", "4"},
            {"cache.bytes", "1024"},
            {"cache.ways", "8"},
            {"cache.line_banks", "4"}},
           "cache.line_banks",
           "at most the number of sets"},
          {{{"width", "4"}, {"cache.bytes", "4096"}, {"cache.line_banks", "8"}},
           "cache.line_banks",
           "16 lines per bank"},
          {{{"width", "4"}, {"cache.fill_writes", "2"}}, "cache.fill_writes", "make it at most 1"},
          {{{"width", "4"},
            {"cache.line_banks", "4"},
            {"cache.fill_writes", "4"},
            {"cache.outstanding", "10"}},
           "cache.outstanding",
           "multiple of the fills"},
          {{{"width", "4"}, {"cache.lookups", "8"}, {"cache.outstanding", "4"}},
           "cache.outstanding",
           "make it at least 8"},
          {{{"decode", "after"}, {"cache.decoders", "5"}},
           "cache.decoders",
           "at most 4 with width = 1"},
          {{{"decode", "after"}, {"width", "4"}, {"cache.decoders", "3"}},
           "cache.decoders",
           "at least 4 with a width above 1"},
          {{{"decode", "before"}, {"cache.compressed_lines", "12"}},
           "cache.compressed_lines",
           "power of two, at least 4"},
          {{{"decode", "before"}, {"cache.line_bytes", "128"}},
           "cache.line_bytes",
           "must be 64 with decode = before"},
      }};
}

TEST(TextureCheckBuild, EveryRuleHasATestRow) { checks().expect_a_row_a_rule(); }

TEST(TextureCheckBuild, EveryEntryPointGivesTheSameMessage) { checks().expect_the_same_words(); }

TEST(TextureCheckBuild, RejectsOutOfRangeValues) { checks().expect_ranges(); }

TEST(TextureCheckBuild, RangeEndsCanBeBuilt) { checks().expect_ends(); }

TEST(TextureCheckBuild, RandomLegalConfigurationsCanBeBuilt) {
  checks().expect_all_else_is_built(600);
}

}  // namespace
}  // namespace deburr::tool::check_build_test
