// SPDX-License-Identifier: MIT
// Stimuli of the tests of the filter pipeline, with the golden model's results: every value of
// every format, every pair of fractions at full contrast, random whole fragments.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "golden/texture/filter.h"
#include "golden/texture/sampling.h"
#include "rtl_model/texture/tokens.h"
#include "spec/texture/descriptor.h"
#include "spec/texture/packets.h"
#include "spec/texture/parameters.h"
#include "tb/base/random.h"
#include "tb/stimuli/texture_quads.h"
#include "tb/unit/rtl/texture/equivalence.h"

namespace deburr::tb {

// Requests and their golden colours.
struct FilterWork {
  std::vector<hw::TexelQuadToken> tokens;
  std::vector<spec::texture::Colour> colours;

  using Requests = std::vector<std::array<std::uint32_t, 4>>;  // texels as stored
  const spec::texture::Configuration configuration;
  // N samples of one request or, with a level fraction, two requests each.
  void fragment(spec::texture::Format format, int samples, std::uint32_t fraction,
                const std::function<hw::TexelQuadToken()>& request) {
    spec::texture::Colour colour;
    colour.tag = static_cast<std::uint32_t>(colours.size());
    colour.lane = static_cast<std::uint8_t>(colour.tag & 3);
    colour.last = (colour.tag & 5) != 0;
    std::array<std::uint32_t, 4> sum{};
    using spec::texture::Kernel;
    const bool by_axis = configuration.kernel == Kernel::kAxis,
               tent = by_axis && samples >= 5 && colour.tag % 3 != 0;
    const Kernel kernel = !by_axis ? configuration.kernel : tent ? Kernel::kTent : Kernel::kBox;
    for (int sample = 0; sample < samples; ++sample) {
      const std::uint32_t weight = golden::texture::sample_weight(kernel, sample, samples);
      std::array<std::array<std::uint32_t, 4>, 2> level{};
      for (std::uint32_t k = 0; k < (fraction ? 2u : 1u); ++k) {
        hw::TexelQuadToken token = request();
        const bool last_of_sample = k == 1 || fraction == 0;
        token.ticket = {colour.tag, colour.lane, colour.last, true, 0};
        token.control.level_weight = static_cast<std::uint16_t>(k ? fraction : 256 - fraction);
        token.control.index = static_cast<std::uint8_t>(sample);
        token.control.last_index = static_cast<std::uint8_t>(samples - 1 + (tent ? hw::kTent : 0));
        token.control.format = static_cast<std::uint8_t>(format);
        token.control.last_of_sample = last_of_sample;
        token.control.last_of_fragment = last_of_sample && sample == samples - 1;
        const std::uint32_t u = token.control.fraction_u, v = token.control.fraction_v;
        std::array<golden::texture::Texel, 4> texel;
        for (std::size_t i = 0; i < 4; ++i)
          texel[i] = golden::texture::decode_texel(format, token.texel[i]);
        for (std::size_t c = 0; c < 4; ++c)
          level[k][c] = golden::texture::vertical_lerp(
              golden::texture::horizontal_lerp(texel[0][c], texel[1][c], u),
              golden::texture::horizontal_lerp(texel[2][c], texel[3][c], u), v);
        tokens.push_back(token);
      }
      for (std::size_t c = 0; c < 4; ++c)
        sum[c] +=
            weight * (fraction ? golden::texture::level_lerp(level[0][c], level[1][c], fraction)
                               : level[0][c]);
    }
    const bool codes = format == spec::texture::Format::kSrgb8A8 &&
                       configuration.srgb_output == spec::texture::SrgbOutput::kEncoded;
    for (std::size_t c = 0; c < 4; ++c)
      colour.rgba[c] = codes && c < 3 ? golden::texture::encode_result(sum[c])
                                      : golden::texture::round_result(sum[c]);
    colours.push_back(colour);
  }
};

inline FilterWork filter_work(const spec::texture::Configuration& configuration) {
  FilterWork work{.tokens = {}, .colours = {}, .configuration = configuration};
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
  // Random whole fragments, often with extreme values.
  Random random(8);
  constexpr std::array<std::uint32_t, 5> kExtremes = {0, 0xFFFFFFFF, 0x00FF00FF, 0x01010101,
                                                      0x80808080};
  constexpr std::array<std::uint8_t, 5> kFractions = {0, 1, 128, 254, 255};
  for (int i = 0; i < 12'000; ++i) {
    const auto format = static_cast<spec::texture::Format>(random.below(5));
    const std::uint32_t mask =
        spec::texture::kFormatBytes[static_cast<std::size_t>(format)] == 4   ? 0xFFFFFFFF
        : spec::texture::kFormatBytes[static_cast<std::size_t>(format)] == 2 ? 0xFFFF
                                                                             : 0xFF;
    const bool extreme = random.chance(400);
    const auto fraction = [&] {
      return extreme ? stimuli::any_of(random, kFractions)
                     : static_cast<std::uint8_t>(random.below(256));
    };
    const int samples = configuration.count == spec::texture::CountRule::kAny
                            ? 1 + static_cast<int>(random.below(16))
                            : 1 << random.below(5);
    work.fragment(format, samples, fraction(), [&] {
      hw::TexelQuadToken t{};
      for (std::uint32_t& texel : t.texel)
        texel = mask & (extreme ? stimuli::any_of(random, kExtremes)
                                : static_cast<std::uint32_t>(random.next()));
      t.control.fraction_u = fraction();
      t.control.fraction_v = fraction();
      return t;
    });
  }
  return work;
}

}  // namespace deburr::tb
