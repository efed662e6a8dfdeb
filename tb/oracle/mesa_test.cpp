// SPDX-License-Identifier: MIT
// Compares the golden model with Mesa's software rasterisers: llvmpipe without anisotropy, softpipe
// with it (llvmpipe gives the same image for every N). Skipped if Mesa is absent.
//
// Bit equality is never required, because the two drivers differ from each other. softpipe uses one
// level of detail per quad; llvmpipe and the unit use one per pixel.
#include <gmock/gmock.h>

#include <cmath>
#include <cstdlib>
#include <functional>

#include "spec/texture/parameters.h"
#include "tb/oracle/mesa_device.h"

namespace deburr::tb::texture::mesa_test {
namespace {

using golden::ideal::Verdict;
using spec::texture::Format;
using spec::texture::MinFilter;

spec::texture::Parameters papers_configuration() {
  return spec::texture::preset_parameters(spec::texture::Preset::kPaper);
}

// The configuration nearest to Mesa's arithmetic; results of the paper's are printed next to it.
spec::texture::Parameters exact_configuration() {
  spec::texture::Parameters parameters = papers_configuration();
  parameters.footprint = spec::texture::FootprintRule::kExact;
  parameters.log2 = spec::texture::Log2Rule::kExact;
  return parameters;
}

spec::texture::Parameters segments_configuration() {
  spec::texture::Parameters parameters = papers_configuration();
  parameters.log2 = spec::texture::Log2Rule::kSegments;
  return parameters;
}

// Agreement of two images over the pixels of a mask.
struct Agreement {
  double pixels = 0, within_one = 0, square = 0;
  double share() const { return within_one / pixels; }
  double psnr() const { return 10.0 * std::log10(255.0 * 255.0 * 3.0 * pixels / square); }

  void add(const std::array<std::uint8_t, 4>& a, const std::array<std::uint8_t, 4>& b) {
    int largest = 0;
    for (std::size_t c = 0; c < 4; ++c) {
      const int difference = std::abs(a[c] - b[c]);
      largest = std::max(largest, difference);
      if (c < 3) square += difference * difference;
    }
    within_one += largest <= 1;
    pixels += 1;
  }
};

golden::ideal::Fragment fragment_at(const CoordinateImage& image, std::size_t i) {
  const int x = static_cast<int>(i) % image.width;
  const int y = static_cast<int>(i) / image.width;
  return fragment_of(image.quad(x & ~1, y & ~1), 2 * (y & 1) + (x & 1));
}

// Whether a filter with a level error of up to `margin` can select another mip level or filter.
bool at_threshold(const golden::ideal::Fragment& f, const Size& size, MinFilter filter,
                  double margin) {
  const double rho = std::max(std::hypot(f.ds_dx * size.width, f.dt_dx * size.height),
                              std::hypot(f.ds_dy * size.width, f.dt_dy * size.height));
  const double lod = std::log2(rho);
  if (std::abs(lod) < margin) return true;
  const bool nearest_level =
      filter == MinFilter::kNearestMipmapNearest || filter == MinFilter::kLinearMipmapNearest;
  return nearest_level && lod > 0 && std::abs(lod - std::floor(lod) - 0.5) < margin;
}

class Mesa : public testing::Test {
 protected:
  void open(const std::string& driver) {
    std::string why;
    device_ = MesaDevice::open(driver, why);
    if (device_ == nullptr) GTEST_SKIP() << "Mesa is absent: " << why;
    std::printf("%s\n", device_->name().c_str());
  }

  // Visits every size and format, with alternating wraps (all of them without mip levels), on the
  // quads of the criterion and on a plane.
  using Visit = std::function<void(const CoordinateImage&, const EncodedTexture&, const Size&,
                                   const spec::texture::Descriptor&, const Pixels& mesa)>;
  void draw_all(MinFilter min_filter, Pattern pattern, bool with_quads, const Visit& visit) {
    std::uint32_t seed = 1;
    const bool every_wrap = min_filter <= MinFilter::kLinear;
    for (const Size& size : kFilteringSizes) {
      for (std::uint8_t format = 0; format < 5; ++format) {
        for (std::uint8_t wrap = 0; wrap < 3; ++wrap) {
          ++seed;
          if (!every_wrap && seed % 3 != 0) continue;
          const EncodedTexture texture =
              make_texture(pattern, static_cast<Format>(format), size.width, size.height, seed);
          spec::texture::Descriptor state;
          state.format = texture.format;
          state.min_filter = min_filter;
          state.mag_filter =
              min_filter == MinFilter::kNearest || min_filter == MinFilter::kNearestMipmapNearest
                  ? spec::texture::MagFilter::kNearest
                  : spec::texture::MagFilter::kLinear;
          state.wrap_s = static_cast<spec::texture::Wrap>(wrap);
          state.wrap_t = static_cast<spec::texture::Wrap>((wrap + size.height) % 3);
          PlaneView view;
          view.width = view.height = 64;
          view.repeats = 64.0 / size.width;
          view.s = -1.5;
          view.t = -2.5;
          const CoordinateImage image =
              with_quads ? quads_image(filtering_quads(size, 512, seed)) : plane(view);
          visit(image, texture, size, state, device_->draw(image, texture, state));
        }
      }
    }
  }

  std::unique_ptr<MesaDevice> device_;
};

class MesaDriver : public Mesa, public testing::WithParamInterface<const char*> {};

TEST_P(MesaDriver, NearestAndLinearAgreeWithinOneStep) {
  ASSERT_NO_FATAL_FAILURE(open(GetParam()));
  if (device_ == nullptr) return;
  for (const MinFilter filter : {MinFilter::kNearest, MinFilter::kLinear}) {
    for (const bool with_quads : {true, false}) {
      Agreement agreement;
      draw_all(filter, Pattern::kComposite, with_quads,
               [&](const CoordinateImage& image, const EncodedTexture& texture, const Size&,
                   const spec::texture::Descriptor& state, const Pixels& mesa) {
                 const Pixels ours = filter_image(image, golden_filter({})(texture, state));
                 for (std::size_t i = 0; i < ours.size(); ++i) agreement.add(ours[i], mesa[i]);
               });
      std::printf(
          "%s, %s: %.4f %% of %.0f pixels within 1, %.1f dB\n",
          std::string(spec::texture::kMinFilterNames[static_cast<std::size_t>(filter)]).c_str(),
          with_quads ? "quads" : "plane", 100.0 * agreement.share(), agreement.pixels,
          agreement.psnr());
      EXPECT_GE(agreement.share(), 0.98);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Mesa, MesaDriver, testing::Values("llvmpipe", "softpipe"),
                         [](const auto& suite) { return std::string(suite.param); });

TEST_F(Mesa, MipModesAgree) {
  ASSERT_NO_FATAL_FAILURE(open("llvmpipe"));
  if (device_ == nullptr) return;
  struct Configuration {
    const char* name;
    spec::texture::Parameters parameters;
    double margin;  // error of the level of detail, including llvmpipe's own
    double goal_db;
  };
  // The goal applies to the configurations that compute the same level of detail. `half` is up to
  // 0.16 levels above, which on noise exceeds 35 dB: its limit is a floor, and the measured value
  // is in the docs.
  const std::array<Configuration, 3> configuration = {
      Configuration{"exact, exact", exact_configuration(), 0.05, 35.0},
      Configuration{"half, segments", segments_configuration(), 0.2, 30.0},
      Configuration{"half, mitchell", papers_configuration(), 0.2, 30.0}};
  for (const MinFilter filter : {MinFilter::kNearestMipmapNearest, MinFilter::kLinearMipmapNearest,
                                 MinFilter::kNearestMipmapLinear, MinFilter::kLinearMipmapLinear}) {
    for (const bool with_quads : {true, false}) {
      std::array<Agreement, 3> all, kept;
      draw_all(
          filter, Pattern::kPyramid, with_quads,
          [&](const CoordinateImage& image, const EncodedTexture& texture, const Size& size,
              const spec::texture::Descriptor& state, const Pixels& mesa) {
            for (std::size_t r = 0; r < configuration.size(); ++r) {
              const Pixels ours =
                  filter_image(image, golden_filter(configuration[r].parameters)(texture, state));
              for (std::size_t i = 0; i < ours.size(); ++i) {
                all[r].add(ours[i], mesa[i]);
                if (!at_threshold(fragment_at(image, i), size, filter, configuration[r].margin))
                  kept[r].add(ours[i], mesa[i]);
              }
            }
          });
      for (std::size_t r = 0; r < configuration.size(); ++r) {
        std::printf(
            "%s, %s, %s: %.1f dB over %.0f pixels away from thresholds, %.1f dB over all\n",
            std::string(spec::texture::kMinFilterNames[static_cast<std::size_t>(filter)]).c_str(),
            with_quads ? "quads" : "plane", configuration[r].name, kept[r].psnr(), kept[r].pixels,
            all[r].psnr());
        EXPECT_GE(kept[r].psnr(), configuration[r].goal_db);
        EXPECT_GT(kept[r].pixels, 0.5 * all[r].pixels);
      }
    }
  }
}

// Checks the criterion with an independent program: a criterion that rejected Mesa's images would
// be suspect.
TEST_P(MesaDriver, MesaPassesTheFilteringCriterion) {
  ASSERT_NO_FATAL_FAILURE(open(GetParam()));
  if (device_ == nullptr) return;
  for (std::uint8_t mode = 0; mode < 6; ++mode) {
    const auto filter = static_cast<MinFilter>(mode);
    Verdict verdict = Verdict::kHigh;
    double deviation = 0.0;
    std::int64_t rejected = 0;
    std::int64_t fragments = 0;
    draw_all(filter, Pattern::kComposite, true,
             [&](const CoordinateImage& image, const EncodedTexture& texture, const Size&,
                 const spec::texture::Descriptor& state, const Pixels& mesa) {
               const golden::ideal::Texture ideal = ideal_texture(texture);
               const golden::ideal::Sampler sampler = sampler_of(state);
               golden::ideal::Checker checker(ideal, sampler);
               for (std::size_t i = 0; i < mesa.size(); ++i) {
                 const auto& c = mesa[i];
                 checker.add(fragment_at(image, i),
                             {static_cast<double>(c[0]), static_cast<double>(c[1]),
                              static_cast<double>(c[2]), static_cast<double>(c[3])});
               }
               verdict = std::max(verdict, checker.verdict());
               deviation = std::max(deviation, checker.deviation());
               rejected += checker.rejected();
               fragments += checker.fragments();
             });
    std::printf("%s: %s, largest deviation %.2f, %lld of %lld fragments are not high\n",
                std::string(spec::texture::kMinFilterNames[mode]).c_str(),
                std::string(verdict_name(verdict)).c_str(), deviation,
                static_cast<long long>(rejected), static_cast<long long>(fragments));
    EXPECT_NE(verdict, Verdict::kFail);
    if (filter <= MinFilter::kLinearMipmapNearest) {
      EXPECT_EQ(verdict, Verdict::kHigh);
    }
  }
}

TEST_F(Mesa, AnisotropicErrorFallsAsInSoftpipe) {
  ASSERT_NO_FATAL_FAILURE(open("softpipe"));
  if (device_ == nullptr) return;
  for (const Pattern pattern : {Pattern::kChecker, Pattern::kPyramid}) {
    const PlaneView view;
    const CoordinateImage image = plane(view);
    const EncodedTexture texture = make_texture(pattern, Format::kRgba8, 128, 128, 1);
    const auto reference = plane_reference(view, ideal_texture(texture), 16);
    spec::texture::Parameters ceil = exact_configuration();
    ceil.count = spec::texture::CountRule::kCeil;
    std::array<double, 5> paper{}, ceiling{}, theirs{};
    for (std::uint8_t lb_n = 0; lb_n <= 4; ++lb_n) {
      spec::texture::Descriptor state;
      state.max_anisotropy_log2 = lb_n;
      const Pixels mesa = device_->draw(image, texture, state);
      const Pixels ours = filter_image(image, golden_filter(ceil)(texture, state));
      paper[lb_n] = rms(filter_image(image, golden_filter(papers_configuration())(texture, state)),
                        reference);
      ceiling[lb_n] = rms(ours, reference);
      theirs[lb_n] = rms(mesa, reference);
      Agreement agreement;
      for (std::size_t i = 0; i < ours.size(); ++i) agreement.add(ours[i], mesa[i]);
      std::printf(
          "%s %2d x: RMS to reference %.2f (paper's rules) %.2f (exact, ceil) %.2f (softpipe); "
          "exact, ceil against softpipe %.1f dB\n",
          pattern == Pattern::kChecker ? "checker" : "noise", 1 << lb_n, paper[lb_n], ceiling[lb_n],
          theirs[lb_n], agreement.psnr());
      EXPECT_GE(agreement.psnr(), 15.0);  // a different picture would be below 10
    }
    for (const auto& errors : {paper, ceiling}) {
      EXPECT_LT(errors[1], errors[0]);
      EXPECT_LT(errors[4], errors[1]);
    }
    EXPECT_LT(theirs[4], theirs[0]);
    EXPECT_LT(ceiling[4], theirs[4]);
  }
}

// A wrong wrap mode and a wrong level are detected.
TEST_F(Mesa, InjectedFaultsAreDetected) {
  ASSERT_NO_FATAL_FAILURE(open("llvmpipe"));
  if (device_ == nullptr) return;
  Agreement wrap;
  draw_all(MinFilter::kLinear, Pattern::kComposite, true,
           [&](const CoordinateImage& image, const EncodedTexture& texture, const Size&,
               spec::texture::Descriptor state, const Pixels& mesa) {
             state.wrap_s =
                 static_cast<spec::texture::Wrap>((static_cast<int>(state.wrap_s) + 1) % 3);
             const Pixels ours = filter_image(image, golden_filter({})(texture, state));
             for (std::size_t i = 0; i < ours.size(); ++i) wrap.add(ours[i], mesa[i]);
           });
  EXPECT_LT(wrap.share(), 0.9);
  Agreement level;
  draw_all(MinFilter::kLinearMipmapLinear, Pattern::kPyramid, false,
           [&](const CoordinateImage& image, const EncodedTexture& texture, const Size& size,
               spec::texture::Descriptor state, const Pixels& mesa) {
             state.lod_bias = 128;  // half a level
             const Pixels ours =
                 filter_image(image, golden_filter(exact_configuration())(texture, state));
             for (std::size_t i = 0; i < ours.size(); ++i)
               if (!at_threshold(fragment_at(image, i), size, state.min_filter, 0.05))
                 level.add(ours[i], mesa[i]);
           });
  EXPECT_LT(level.psnr(), 35.0);
}

}  // namespace
}  // namespace deburr::tb::texture::mesa_test
