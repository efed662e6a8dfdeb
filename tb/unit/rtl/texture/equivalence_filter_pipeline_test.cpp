// SPDX-License-Identifier: MIT
// The FilterPipeline against the functions of the golden model.
#include <fmt/format.h>

#include <cstdint>
#include <string>
#include <vector>

#include "golden/texture/filter.h"
#include "golden/texture/sampling.h"
#include "rtl_model/texture/filter_pipeline.h"
#include "tb/unit/rtl/texture/equivalence.h"

namespace deburr::tb::equivalence_filter_pipeline_test {
namespace {

namespace gold = golden::texture;

// Requests and the colours that the golden arithmetic makes of them.
struct FilterWork {
  std::vector<hw::TexelQuadToken> tokens;
  std::vector<spec::texture::Colour> colours;

  using Requests = std::vector<std::array<std::uint32_t, 4>>;  // texels as stored
  const spec::texture::Rules rules;
  // N samples of one or, with a level fraction, two requests each.
  void fragment(spec::texture::Format format, int samples, std::uint32_t fraction,
                const std::function<hw::TexelQuadToken()>& request) {
    spec::texture::Colour colour;
    colour.tag = static_cast<std::uint32_t>(colours.size());
    colour.lane = static_cast<std::uint8_t>(colour.tag & 3);
    colour.last = (colour.tag & 5) != 0;
    std::array<std::uint32_t, 4> sum{};
    for (int sample = 0; sample < samples; ++sample) {
      const std::uint32_t weight = gold::sample_weight(rules.kernel, sample, samples);
      std::array<std::array<std::uint32_t, 4>, 2> level{};
      for (std::uint32_t k = 0; k < (fraction ? 2u : 1u); ++k) {
        hw::TexelQuadToken token = request();
        const bool last_of_sample = k == 1 || fraction == 0;
        token.ticket = {colour.tag, colour.lane, colour.last, true, 0};
        token.control.level_weight = static_cast<std::uint16_t>(k ? fraction : 256 - fraction);
        token.control.index = static_cast<std::uint8_t>(sample);
        token.control.last_index = static_cast<std::uint8_t>(samples - 1);
        token.control.format = static_cast<std::uint8_t>(format);
        token.control.last_of_sample = last_of_sample;
        token.control.last_of_fragment = last_of_sample && sample == samples - 1;
        const std::uint32_t u = token.control.fraction_u, v = token.control.fraction_v;
        std::array<gold::Texel, 4> texel;
        for (std::size_t i = 0; i < 4; ++i) texel[i] = gold::decode_texel(format, token.texel[i]);
        for (std::size_t c = 0; c < 4; ++c)
          level[k][c] = gold::vertical_lerp(gold::horizontal_lerp(texel[0][c], texel[1][c], u),
                                            gold::horizontal_lerp(texel[2][c], texel[3][c], u), v);
        tokens.push_back(token);
      }
      for (std::size_t c = 0; c < 4; ++c)
        sum[c] += weight *
                  (fraction ? gold::level_lerp(level[0][c], level[1][c], fraction) : level[0][c]);
    }
    const bool codes = format == spec::texture::Format::kSrgb8A8 &&
                       rules.srgb_output == spec::texture::SrgbOutput::kEncoded;
    for (std::size_t c = 0; c < 4; ++c)
      colour.rgba[c] = codes && c < 3 ? gold::encode_result(sum[c]) : gold::round_result(sum[c]);
    colours.push_back(colour);
  }
};

FilterWork filter_work(const spec::texture::Rules& rules) {
  FilterWork work{.tokens = {}, .colours = {}, .rules = rules};
  // Every value of every format, unfiltered.
  const auto plain = [&](spec::texture::Format format, std::uint32_t word) {
    work.fragment(format, 1, 0, [word] {
      hw::TexelQuadToken t{};
      t.texel.fill(word);
      return t;
    });
  };
  for (std::uint32_t word = 0; word < 65536; ++word) {
    plain(spec::texture::Format::kRgb565, word);
    plain(spec::texture::Format::kRgba4444, word);
  }
  for (const auto format :
       {spec::texture::Format::kRgba8, spec::texture::Format::kSrgb8A8, spec::texture::Format::kL8})
    for (std::uint32_t value = 0; value < 256; ++value)
      plain(format, value * (format == spec::texture::Format::kL8 ? 1u : 0x01010101u));
  // Every combination of fractions at full contrast, both signs.
  for (std::uint32_t u = 0; u < 256; ++u)
    for (std::uint32_t v = 0; v < 256; v += 3)
      work.fragment(spec::texture::Format::kRgba8, 1, 0, [u, v] {
        hw::TexelQuadToken t{};
        t.texel = {0xFF00FF01, 0x00FF02FF, 0x7F80FF00, 0xFFFF00FF};
        t.control.fraction_u = static_cast<std::uint8_t>(u);
        t.control.fraction_v = static_cast<std::uint8_t>(v);
        return t;
      });
  // Whole fragments at random, extremes often.
  Random random(8);
  constexpr std::array<std::uint32_t, 5> kExtremes = {0, 0xFFFFFFFF, 0x00FF00FF, 0x01010101,
                                                      0x80808080};
  constexpr std::array<std::uint8_t, 5> kFractions = {0, 1, 128, 254, 255};
  for (int i = 0; i < 12'000; ++i) {
    const auto format = any_code<spec::texture::Format>(random, spec::texture::kFormatNames);
    const std::uint32_t mask =
        spec::texture::kFormatBytes[static_cast<std::size_t>(format)] == 4   ? 0xFFFFFFFF
        : spec::texture::kFormatBytes[static_cast<std::size_t>(format)] == 2 ? 0xFFFF
                                                                             : 0xFF;
    const bool extreme = random.chance(400);
    const auto fraction = [&] {
      return extreme ? any_of(random, kFractions) : static_cast<std::uint8_t>(random.below(256));
    };
    const int samples = rules.count == spec::texture::CountRule::kAny
                            ? 1 + static_cast<int>(random.below(16))
                            : 1 << random.below(5);
    work.fragment(format, samples, fraction(), [&] {
      hw::TexelQuadToken t{};
      for (std::uint32_t& texel : t.texel)
        texel = mask &
                (extreme ? any_of(random, kExtremes) : static_cast<std::uint32_t>(random.next()));
      t.control.fraction_u = fraction();
      t.control.fraction_v = fraction();
      return t;
    });
  }
  return work;
}

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
