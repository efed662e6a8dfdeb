// SPDX-License-Identifier: MIT
// Negative tests of the filtering criterion: it must accept a plain sampler and reject the same
// sampler with an injected fault. Faults within Khronos's tolerance are listed with the verdict
// they get.
#include <gmock/gmock.h>

#include "golden/texture/texture_golden.h"
#include "tb/oracle/conformance.h"
#include "tb/oracle/plain_sampler.h"

namespace deburr::tb::texture::filtering_faults_test {
namespace {

using golden::ideal::Verdict;

FilterFactory plain_filter(Fault fault) {
  return [fault](const EncodedTexture& texture, const spec::texture::Descriptor& state) {
    return [sampler =
                PlainSampler(texture, sampler_of(state), fault)](const spec::texture::Quad& quad) {
      std::array<std::array<std::uint8_t, 4>, 4> colours;
      for (int lane = 0; lane < 4; ++lane)
        colours[static_cast<std::size_t>(lane)] = sampler.sample(quad, lane);
      return colours;
    };
  };
}

struct Outcome {
  Verdict verdict = Verdict::kHigh;
  int cases = 0, not_high = 0;
  double deviation = 0.0;
};

// All modes, wraps and formats with two texture sizes.
Outcome check_everywhere(const FilterFactory& filter) {
  Outcome outcome;
  std::uint32_t seed = 1;
  for (const Size& size : {Size{32, 64}, Size{31, 55}})
    for (std::uint8_t format = 0; format < 5; ++format)
      for (std::uint8_t mode = 0; mode < 12; ++mode)
        for (std::uint8_t wrap = 0; wrap < 3; ++wrap) {
          FilteringCase c{
              seed % 2 == 0 ? Pattern::kComposite : Pattern::kNoise, size, {}, 64, seed++};
          c.descriptor.format = static_cast<spec::texture::Format>(format);
          c.descriptor.min_filter = static_cast<spec::texture::MinFilter>(mode / 2);
          c.descriptor.mag_filter = static_cast<spec::texture::MagFilter>(mode % 2);
          c.descriptor.wrap_s = c.descriptor.wrap_t = static_cast<spec::texture::Wrap>(wrap);
          const CaseResult r = check(c, filter);
          outcome.verdict = std::max(outcome.verdict, r.verdict);
          outcome.deviation = std::max(outcome.deviation, r.deviation);
          outcome.not_high += r.verdict != Verdict::kHigh;
          ++outcome.cases;
        }
  return outcome;
}

struct Expectation {
  Fault fault;
  Verdict verdict;
  friend std::ostream& operator<<(std::ostream& out, const Expectation& e) {
    return out << kFaultNames[static_cast<std::size_t>(e.fault)];
  }
};

class InjectedFault : public testing::TestWithParam<Expectation> {};

TEST_P(InjectedFault, GetsExpectedVerdict) {
  const Outcome outcome = check_everywhere(plain_filter(GetParam().fault));
  std::printf("%d of %d cases are not high, largest deviation %.1f, verdict %s\n", outcome.not_high,
              outcome.cases, outcome.deviation, std::string(verdict_name(outcome.verdict)).c_str());
  EXPECT_EQ(outcome.verdict, GetParam().verdict);
}

INSTANTIATE_TEST_SUITE_P(
    Criterion, InjectedFault,
    testing::Values(Expectation{Fault::kNone, Verdict::kHigh},
                    // Rounding a weight to b bits costs up to 2^-(b+1), truncating up to 2^-b, so
                    // truncation gets a lower verdict. 3 bits rounded are the tolerance of `low`.
                    Expectation{Fault::kFiveBitWeights, Verdict::kHigh},
                    Expectation{Fault::kFiveBitTruncatedWeights, Verdict::kLow},
                    Expectation{Fault::kThreeBitWeights, Verdict::kLow},
                    Expectation{Fault::kThreeBitTruncatedWeights, Verdict::kFail},
                    Expectation{Fault::kHalfTexelShift, Verdict::kFail},
                    Expectation{Fault::kNearestHalfTexelShift, Verdict::kFail},
                    Expectation{Fault::kWrongWrap, Verdict::kFail},
                    Expectation{Fault::kNeighbourPastEdge, Verdict::kFail},
                    Expectation{Fault::kTruncatedIndex, Verdict::kFail},
                    Expectation{Fault::kTruncatedLevel, Verdict::kFail},
                    Expectation{Fault::kTwoBitLevelFraction, Verdict::kFail},
                    Expectation{Fault::kLevelTooLow, Verdict::kFail},
                    Expectation{Fault::kLevelTooHigh, Verdict::kFail},
                    Expectation{Fault::kSwappedLevels, Verdict::kFail},
                    Expectation{Fault::kSwappedAxes, Verdict::kFail},
                    Expectation{Fault::kLateMagnification, Verdict::kFail},
                    Expectation{Fault::kUnreplicatedChannels, Verdict::kFail},
                    Expectation{Fault::kEncodedSrgb, Verdict::kFail},
                    // At most one step of 255: only ColourBias below detects it.
                    Expectation{Fault::kTruncatedColour, Verdict::kHigh}),
    [](const auto& suite) {
      return std::string(kFaultNames[static_cast<std::size_t>(suite.param.fault)]);
    });

// Mean of result - exact over LINEAR filtering, where they differ by rounding only.
double colour_bias(const FilterFactory& filter) {
  double sum = 0.0;
  double count = 0.0;
  for (std::uint32_t seed = 1; seed <= 4; ++seed) {
    const EncodedTexture texture =
        make_texture(Pattern::kComposite, spec::texture::Format::kRgba8, 32, 64, seed);
    const golden::ideal::Texture ideal = ideal_texture(texture);
    spec::texture::Descriptor state;
    state.min_filter = spec::texture::MinFilter::kLinear;
    const golden::ideal::Sampler sampler = sampler_of(state);
    const QuadFilter sample = filter(texture, state);
    for (const spec::texture::Quad& quad : filtering_quads({32, 64}, 2048, seed)) {
      const auto colours = sample(quad);
      for (std::size_t lane = 0; lane < 4; ++lane) {
        const auto exact = exact_colour(ideal, sampler, fragment_of(quad, static_cast<int>(lane)));
        for (const std::size_t channel : {0u, 1u, 3u}) {  // B is constant within a level
          sum += colours[lane][channel] - exact[channel];
          count += 1.0;
        }
      }
    }
  }
  return sum / count;
}

TEST(ColourBias, GoldenRoundsAndTruncationIsDetected) {
  EXPECT_NEAR(colour_bias(golden_filter({})), 0.0, 0.02);
  EXPECT_NEAR(colour_bias(plain_filter(Fault::kNone)), 0.0, 0.02);
  EXPECT_LT(colour_bias(plain_filter(Fault::kTruncatedColour)), -0.4);
}

// A wrong texel in memory or a wrong mip base is detected in the golden model.
TEST(GoldenWithFault, SwappedMipBaseFails) {
  const FilterFactory faulty = [](const EncodedTexture& texture,
                                  const spec::texture::Descriptor& state) {
    struct Unit {
      EncodedMemory memory;
      std::unique_ptr<golden::texture::TextureGolden> golden;
    };
    auto unit = std::make_shared<Unit>();
    spec::texture::Descriptor descriptor = unit->memory.place(texture, state.layout);
    descriptor.min_filter = state.min_filter;
    descriptor.mag_filter = state.mag_filter;
    std::swap(descriptor.base[1], descriptor.base[2]);
    unit->golden = std::make_unique<golden::texture::TextureGolden>(
        spec::texture::Parameters{}, unit->memory.bytes(),
        golden::texture::TextureGolden::Traffic::kIgnore);
    unit->golden->set_texture(0, descriptor);
    return [unit](const spec::texture::Quad& quad) {
      std::array<std::array<std::uint8_t, 4>, 4> colours{};
      for (const spec::texture::Colour& colour : unit->golden->process(quad))
        colours[colour.lane] = colour.rgba;
      return colours;
    };
  };
  EXPECT_EQ(check({}, faulty).verdict, Verdict::kFail);
}

}  // namespace
}  // namespace deburr::tb::texture::filtering_faults_test
