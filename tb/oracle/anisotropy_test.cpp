// SPDX-License-Identifier: MIT
// OpenGL specifies no quality for anisotropic filtering. On a plane seen at a shallow angle,
// aliasing must fall strictly as the number of samples rises from 1 to 2 to the maximum.
#include <gmock/gmock.h>

#include <cmath>

#include "tb/oracle/plane.h"

namespace deburr::tb::texture::anisotropy_test {
namespace {

constexpr Size kSize{128, 128};

const EncodedTexture& checker() {
  static const EncodedTexture texture =
      make_texture(Pattern::kChecker, spec::texture::Format::kRgba8, kSize.width, kSize.height, 1);
  return texture;
}

const std::vector<golden::ideal::Rgba>& reference() {
  static const std::vector<golden::ideal::Rgba> pixels =
      plane_reference({}, ideal_texture(checker()), 16);
  return pixels;
}

// Error against the supersampled plane for N_max = 1, 2, 4, 8, 16.
using Errors = std::vector<double>;

Errors errors(const std::function<QuadFilter(int lb_n)>& unit) {
  const CoordinateImage image = plane({});
  Errors result;
  for (int lb_n = 0; lb_n <= 4; ++lb_n)
    result.push_back(rms(filter_image(image, unit(lb_n)), reference()));
  std::printf("RMS to the supersampled plane at 1x 2x 4x 8x 16x: %.2f %.2f %.2f %.2f %.2f\n",
              result[0], result[1], result[2], result[3], result[4]);
  return result;
}

bool falls_strictly(const Errors& e) {
  constexpr double kVisible = 0.98;  // at least 2 % per step: more than rounding
  return e[1] < kVisible * e[0] && e[4] < kVisible * e[1];
}

Errors golden_errors(const spec::texture::Parameters& parameters,
                     spec::texture::MinFilter min_filter, bool honour_n_max = true) {
  return errors([&](int lb_n) {
    spec::texture::Descriptor state;
    state.min_filter = min_filter;
    state.max_anisotropy_log2 = static_cast<std::uint8_t>(honour_n_max ? lb_n : 0);
    return golden_filter(parameters)(checker(), state);
  });
}

TEST(Anisotropy, AliasingFallsWithMoreSamplesWithoutMipLevels) {
  EXPECT_TRUE(falls_strictly(golden_errors({}, spec::texture::MinFilter::kLinear)));
  EXPECT_TRUE(falls_strictly(golden_errors({}, spec::texture::MinFilter::kNearest)));
}

TEST(Anisotropy, ErrorFallsWithMoreSamplesForEveryFootprintRule) {
  for (std::size_t footprint = 0; footprint < spec::texture::kFootprintNames.size(); ++footprint) {
    for (std::size_t log2 = 0; log2 < spec::texture::kLog2Names.size(); ++log2) {
      spec::texture::Parameters parameters;
      parameters.footprint = static_cast<spec::texture::FootprintRule>(footprint);
      parameters.log2 = static_cast<spec::texture::Log2Rule>(log2);
      for (const spec::texture::CountRule count :
           {spec::texture::CountRule::kFloor, spec::texture::CountRule::kCeil,
            spec::texture::CountRule::kAny}) {
        parameters.count = count;
        const Errors e = golden_errors(parameters, spec::texture::MinFilter::kLinearMipmapLinear);
        EXPECT_TRUE(falls_strictly(e))
            << spec::texture::kFootprintNames[footprint] << " " << spec::texture::kLog2Names[log2];
      }
    }
  }
}

// With N_max ignored, or with all N samples at the pixel's centre, nothing falls.
TEST(AnisotropyFault, IgnoredSampleCountAndMissingSpreadAreDetected) {
  for (const spec::texture::MinFilter filter :
       {spec::texture::MinFilter::kLinear, spec::texture::MinFilter::kLinearMipmapLinear}) {
    EXPECT_FALSE(falls_strictly(golden_errors({}, filter, false)));
    spec::texture::Parameters heap;
    heap.spread = 0;
    EXPECT_FALSE(falls_strictly(golden_errors(heap, filter)));
  }
}

}  // namespace
}  // namespace deburr::tb::texture::anisotropy_test
