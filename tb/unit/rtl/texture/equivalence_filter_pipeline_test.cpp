// SPDX-License-Identifier: MIT
// The FilterPipeline against the functions of the golden model.
#include <fmt/format.h>

#include <cstdint>
#include <string>
#include <vector>

#include "rtl_model/texture/filter_pipeline.h"
#include "tb/unit/rtl/texture/equivalence.h"
#include "tb/unit/rtl/texture/filter_work.h"

namespace deburr::tb::equivalence_filter_pipeline_test {
namespace {

Verdict compare_filter(const spec::texture::Rules& rules, bool fault) {
  const FilterWork work = filter_work(rules);
  Pair<hw::TexelQuadToken, spec::texture::Colour> bench;
  rtl::LatencyProbe probe;
  hw::FilterPipeline unit("unit", bench.clock, rules, probe);
  unit.texels_in(bench.in);
  unit.colours_out(bench.out);
  bench.run(
      work.tokens.size(),
      [&](std::uint64_t i) {
        hw::TexelQuadToken token = work.tokens[i];
        if (token.control.last_of_fragment) probe.enters(bench.clock.cycle());
        if (fault && i == kFaultyToken) token.texel[0] ^= 0x8000;
        return token;
      },
      work.colours.size(),
      [&](std::uint64_t i, const spec::texture::Colour& got) { return got == work.colours[i]; });
  return bench.verdict;
}

class FilterEquivalence : public testing::TestWithParam<std::tuple<int, int, int>> {};

TEST_P(FilterEquivalence, UnitIsTheArithmetic) {
  const auto [count, kernel, output] = GetParam();
  spec::texture::Rules rules;
  rules.count = static_cast<spec::texture::CountRule>(count);
  rules.kernel = static_cast<spec::texture::Kernel>(kernel);
  rules.srgb_output = static_cast<spec::texture::SrgbOutput>(output);
  expect_equal(compare_filter(rules, false), 160'000);
}
INSTANTIATE_TEST_SUITE_P(Texture, FilterEquivalence,
                         testing::Combine(testing::Values(0, 2), testing::Range(0, 2),
                                          testing::Range(0, 2)),
                         [](const auto& p) {
                           const auto i = [](int v) { return static_cast<std::size_t>(v); };
                           return fmt::format(
                               "{}_{}_{}", spec::texture::kCountNames[i(std::get<0>(p.param))],
                               spec::texture::kKernelNames[i(std::get<1>(p.param))],
                               spec::texture::kSrgbOutputNames[i(std::get<2>(p.param))]);
                         });

TEST(FilterEquivalence, NoticesAWrongBit) { expect_noticed(compare_filter({}, true)); }

}  // namespace
}  // namespace deburr::tb::equivalence_filter_pipeline_test
