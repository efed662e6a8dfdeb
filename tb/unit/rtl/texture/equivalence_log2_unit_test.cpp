// SPDX-License-Identifier: MIT
// The Log2Unit against the functions of the golden model.
#include <fmt/format.h>

#include <cstdint>
#include <string>
#include <vector>

#include "golden/texture/footprint.h"
#include "rtl_model/texture/log2_unit.h"
#include "tb/unit/rtl/texture/equivalence.h"

namespace deburr::tb::equivalence_log2_unit_test {
namespace {

namespace gold = golden::texture;

class Log2Equivalence : public testing::TestWithParam<int> {};

TEST_P(Log2Equivalence, EveryLeadingOneEveryMantissa) {
  const auto rule = static_cast<spec::texture::Log2Rule>(GetParam());
  Verdict v;
  const auto compare = [&](std::uint64_t d) {
    ++v.compared;
    if (hw::Log2Unit::log2(rule, d) != gold::log2_fixed(rule, d) && v.mismatches++ == 0)
      v.first = d;
  };
  for (std::uint32_t d = 0; d < 1u << 21; ++d) compare(d);  // below it everything
  Random random(1);
  for (int p = 12; p < 47; ++p) {                                    // an area has 47 bits
    const std::uint64_t below = (std::uint64_t{1} << (p - 12)) - 1;  // bits that are cut off
    for (std::uint32_t y = 0; y < 4096; ++y) {
      const std::uint64_t d = std::uint64_t{4096u | y} << (p - 12);
      for (const std::uint64_t low : {std::uint64_t{0}, 1u & below, below, below >> 1,
                                      below ^ (below >> 1), random.next() & below}) {
        compare(d | low);
      }
    }
  }
  expect_equal(v, 2'000'000);
}

INSTANTIATE_TEST_SUITE_P(Texture, Log2Equivalence, testing::Range(0, 4), [](const auto& p) {
  return std::string(spec::texture::kLog2Names[static_cast<std::size_t>(p.param)]);
});

// No rule passes for another.
TEST(Log2Equivalence, TellsRulesApart) {
  for (std::size_t a = 0; a < spec::texture::kLog2Names.size(); ++a) {
    for (std::size_t b = 0; b < spec::texture::kLog2Names.size(); ++b) {
      std::uint64_t different = 0;
      for (std::uint32_t d = 0; d < 1u << 16; ++d) {
        different += hw::Log2Unit::log2(static_cast<spec::texture::Log2Rule>(a), d) !=
                     gold::log2_fixed(static_cast<spec::texture::Log2Rule>(b), d);
      }
      EXPECT_EQ(different == 0, a == b)
          << spec::texture::kLog2Names[a] << " " << spec::texture::kLog2Names[b];
    }
  }
}

}  // namespace
}  // namespace deburr::tb::equivalence_log2_unit_test
