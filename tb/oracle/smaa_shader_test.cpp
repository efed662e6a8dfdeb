// SPDX-License-Identifier: MIT
// Compares the published SMAA shader, run on Mesa, with golden/morphological and with
// golden/ideal/smaa, its port in exact arithmetic: edges from the same picture, weights from the
// same edges, including the frame's border. Skipped if Mesa or the files are absent.
#include "tb/oracle/smaa_shader.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "golden/ideal/smaa.h"
#include "golden/morphological/diagonals.h"
#include "golden/morphological/morphological_golden.h"
#include "tb/oracle/smaa_files.h"
#include "tb/oracle/smaa_frames.h"

namespace deburr::tb::smaa_shader_test {
namespace {

using golden::ideal::SmaaBorder;
using golden::ideal::SmaaEdges;
using golden::ideal::SmaaMargins;
using golden::ideal::SmaaPixelWeights;
using golden::ideal::SmaaSettings;
using golden::ideal::SmaaWeights;
using golden::morphological::EdgeWeights;
using golden::morphological::MorphologicalGolden;
using spec::morphological::AreaValues;
using spec::morphological::Border;
using spec::morphological::EdgeSource;
using spec::morphological::Parameters;
using spec::morphological::Preset;
using spec::morphological::Quality;

// Texture coordinates are exact in single precision if both sizes are powers of two.
std::vector<Image> power_of_two_frames() {
  std::vector<Image> all = {
      stimuli::noise_image(128, 64),        stimuli::line_image(256, 128),
      stimuli::blocks_image(128, 128),      stimuli::shades_image(64, 128),
      stimuli::random_edges(512, 256, 200), stimuli::random_edges(1, 64, 500),
      stimuli::random_edges(64, 1, 500),    stimuli::random_edges(4, 4, 500),
      stimuli::diagonals(256, 128, 3),      stimuli::rendered_like(1024, 512, 400)};
  add_scenes(all, 1024, 512);
  return all;
}

SmaaShaderRun run_of(Quality quality, bool colour) {
  constexpr std::array<const char*, 4> kNames = {"LOW", "MEDIUM", "HIGH", "ULTRA"};
  return {kNames[static_cast<std::size_t>(quality)], colour};
}

// Fixes the published colour edge detection, which compares the pixel itself with the pixels two to
// the left and two above instead of comparing their neighbours (pull request 11 of its repository).
SmaaShaderRun mended(SmaaShaderRun run) {
  run.changes.emplace_back("t = abs(C - Cleftleft)", "t = abs(Cleft - Cleftleft)");
  run.changes.emplace_back("t = abs(C - Ctoptop)", "t = abs(Ctop - Ctoptop)");
  return run;
}

// Rounded coordinates mix a little of the neighbours into a texel fetched at its centre. A GPU
// filters in steps of 1/256, so it adds nothing; llvmpipe filters in single precision. The shader
// compares such fetches with 0.
SmaaShaderRun whole_texels(SmaaShaderRun run) {
  for (const auto* const edge : {"if (e.r", "if (e.r", "int2(1, 0)).r", "if (e.g"})
    run.changes.emplace_back(std::string(edge) + " > 0.0)", std::string(edge) + " > 0.5)");
  return run;
}

Parameters preset(Quality quality, bool colour) {
  Parameters p = golden::morphological::preset_parameters(Preset::kSmaa, quality);
  p.edge_source = colour ? EdgeSource::kColour : EdgeSource::kLuma;
  return p;
}

class PublishedShader : public testing::Test {
 protected:
  void SetUp() override {
    for (const char* const name : {"SMAA.hlsl", "AreaTex.h", "SearchTex.h"})
      if (!std::filesystem::exists(smaa_file(name))) GTEST_SKIP() << no_smaa_file(name);
    std::string why;
    shader_ = SmaaShader::open(why);
    if (shader_ == nullptr) GTEST_SKIP() << "Mesa is absent: " << why;
    fmt::print("{}\n", shader_->name());
  }

  void expect_weights_at_other_sizes(std::span<const Quality> qualities);

  std::unique_ptr<SmaaShader> shader_;
};

// ---- edges --------------------------------------------------------------------------------------

// Decides an edge at the left of (x, y) or above it, in the units of `step`, which compares two
// pixels; outside the frame the sampler returns the nearest pixel.
template <class Step>
SmaaMargins margins(const Image& image, double threshold, int x, int y, bool left, Step&& step) {
  const auto at = [&](int px, int py) -> const Rgba8& {
    return image.at(std::clamp(px, 0, image.width - 1), std::clamp(py, 0, image.height - 1));
  };
  const Rgba8& c = at(x, y);
  const double own = step(c, left ? at(x - 1, y) : at(x, y - 1));
  const double largest = std::max(
      {step(c, at(x - 1, y)), step(c, at(x, y - 1)), step(c, at(x + 1, y)), step(c, at(x, y + 1)),
       step(at(x - 1, y), at(x - 2, y)), step(at(x, y - 1), at(x, y - 2))});
  return {own - threshold, 2 * own - largest};
}

double luma_step(const Rgba8& a, const Rgba8& b) {
  return std::abs(0.2126 * (a[0] - b[0]) + 0.7152 * (a[1] - b[1]) + 0.0722 * (a[2] - b[2])) / 255;
}

double colour_step(const Rgba8& a, const Rgba8& b) {
  return std::max({std::abs(a[0] - b[0]), std::abs(a[1] - b[1]), std::abs(a[2] - b[2])}) / 255.0;
}

struct EdgeFigures {
  int edges = 0;
  int golden = 0;       // differences of golden
  int port = 0;         // differences of exact arithmetic
  int unexplained = 0;  // differences of golden that rounding does not explain
  int port_unexplained = 0;

  void add(bool published, bool found, const SmaaMargins& exact, double rounding) {
    constexpr double kSingle = 1e-6;  // single precision, a few units
    const auto within = [&](double by) {
      return std::abs(exact.threshold) <= by || std::abs(exact.contrast) <= 2 * by;
    };
    edges += published;
    golden += published != found;
    port += published != exact.edge();
    unexplained += published != found && !within(rounding + kSingle);
    port_unexplained += published != exact.edge() && !within(kSingle);
  }
};

// `changed` modifies golden's parameters.
EdgeFigures edge_figures(SmaaShader& shader, const SmaaShaderRun& run, Quality quality,
                         const std::vector<Image>& frames, void (*changed)(Parameters&) = nullptr) {
  // Each of luma's three weights is rounded by 2^-17 at most; colour steps are exact.
  const double rounding = run.colour ? 0 : 3.0 / 131072;
  const double threshold = smaa_settings(quality).threshold;
  EdgeFigures figures;
  for (const Image& image : frames) {
    const SmaaEdgeImage published = shader.edges(image, run);
    Parameters p = preset(quality, run.colour);
    if (changed != nullptr) changed(p);
    MorphologicalGolden golden(p, MorphologicalGolden::Detail::kPixels);
    golden.process({image.pixels, image.width, image.height});
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x)
        for (const bool left : {true, false}) {
          const SmaaMargins exact = run.colour ? margins(image, threshold, x, y, left, colour_step)
                                               : margins(image, threshold, x, y, left, luma_step);
          figures.add(published.at(x, y)[left ? 0 : 1] != 0,
                      (left ? golden.edges().left : golden.edges().top).at(x, y), exact, rounding);
        }
  }
  return figures;
}

std::vector<Image> frames_for_edges() {
  std::vector<Image> all = power_of_two_frames();
  for (Image& image : smaa_frames()) all.push_back(std::move(image));
  all.push_back(random_colours(700, 500));
  return all;
}

TEST_F(PublishedShader, EdgesAreCloseToGolden) {
  const std::vector<Image> frames = frames_for_edges();
  for (const bool colour : {false, true})
    for (const Quality quality : kSmaaQualities) {
      const SmaaShaderRun run = run_of(quality, colour);
      const EdgeFigures found = edge_figures(*shader_, colour ? mended(run) : run, quality, frames);
      fmt::print("| {}, {} | {} | {} | {} | {} |\n", colour ? "colour, mended" : "luma",
                 name_of(quality), found.edges, found.golden, found.unexplained, found.port);
      EXPECT_GT(found.edges, 100000);
      EXPECT_EQ(found.unexplained, 0);
      EXPECT_EQ(found.port_unexplained, 0);
      // Colour steps are exact, so contrasts of exactly the factor are frequent.
      EXPECT_LT(found.golden, found.edges / (colour ? 500 : 10000));
      if (!colour) continue;
      const EdgeFigures text = edge_figures(*shader_, run, quality, frames);
      fmt::print("| colour as it is, {} | {} | {} | {} | {} |\n", name_of(quality), text.edges,
                 text.golden, text.unexplained, text.port);
      EXPECT_GT(text.unexplained, 100) << "the fault of the published text is seen";
    }
}

// ---- weights ------------------------------------------------------------------------------------

// Differences of one model's weights, in 1/255.
struct WeightFigures {
  int over_1 = 0, over_3 = 0;
  double largest = 0;
  void add(double off) {
    over_1 += off > 1;
    over_3 += off > 3.1;
    largest = std::max(largest, off);
  }
};

// Comparison with the shader's weights.
struct Comparison {
  int edges = 0;
  int last_steps =
      0;  // edges where a search makes one step more than the port; excluded from the figures
  int unexplained = 0;  // other differences from the port
  int crossing = 0;     // of preset.over_3, where two diagonals cross
  WeightFigures port, published, preset;
};

// Weights of an edge by its sides; an 8-bit target holds one at most.
double difference(const SmaaWeights& a, const SmaaWeights& b) {
  return 255 * std::max(std::abs(std::min(1.0, a.first) - std::min(1.0, b.first)),
                        std::abs(std::min(1.0, a.second) - std::min(1.0, b.second)));
}
SmaaWeights weights_of(EdgeWeights weights) {
  return {weights.first / 256.0, weights.second / 256.0};
}
SmaaWeights weights_of(const std::array<float, 4>& texel, bool top) {
  return top ? SmaaWeights{texel[1], texel[0]} : SmaaWeights{texel[3], texel[2]};
}

// Tolerance between the shader and its port, in 1/255: where coordinates are exact, and where
// rounded coordinates mix neighbours into the crossing edges of corners and diagonals, which the
// shader does not round. The third is the threshold above which a search step is visible.
constexpr double kExact = 0.005, kRounded = 0.7, kStep = 0.05;

class Frame {
 public:
  Frame(const Image& image, Quality quality, bool colour, void (*changed)(Parameters&))
      : quality_(quality), edges_(image.width, image.height, SmaaBorder::kClamp) {
    Parameters p = preset(quality, colour);
    if (changed != nullptr) changed(p);
    exact_ = std::make_unique<MorphologicalGolden>(p, MorphologicalGolden::Detail::kPixels);
    p.area_values = AreaValues::kPublished;
    published_ = std::make_unique<MorphologicalGolden>(p, MorphologicalGolden::Detail::kPixels);
    for (MorphologicalGolden* const golden : {exact_.get(), published_.get()})
      golden->process({image.pixels, image.width, image.height});
    texels_ = SmaaEdgeImage(image.width, image.height);
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x) {
        const bool left = exact_->edges().left.at(x, y), top = exact_->edges().top.at(x, y);
        edges_.set_left(x, y, left);
        edges_.set_top(x, y, top);
        texels_.at(x, y) = {static_cast<std::uint8_t>(left ? 255 : 0),
                            static_cast<std::uint8_t>(top ? 255 : 0)};
      }
  }

  const SmaaEdgeImage& texels() const { return texels_; }

  void compare(const SmaaWeightImage& shader, double within, Comparison& figures) const {
    for (int y = 0; y < texels_.height; ++y)
      for (int x = 0; x < texels_.width; ++x)
        for (const bool top : {true, false}) {
          if (!(top ? edges_.top(x, y) : edges_.left(x, y))) continue;
          ++figures.edges;
          compare_edge(weights_of(shader.at(x, y), top), within, x, y, top, figures);
        }
  }

 private:
  SmaaWeights port(int x, int y, bool top, std::array<int, 2> more_steps) const {
    SmaaSettings settings = smaa_settings(quality_);
    settings.more_steps = more_steps;
    const SmaaPixelWeights weights = smaa_weights(edges_, settings, x, y);
    return top ? weights.top : weights.left;
  }

  void compare_edge(const SmaaWeights& shader, double within, int x, int y, bool top,
                    Comparison& figures) const {
    const double off = difference(shader, port(x, y, top, {}));
    if (off > kStep && has_a_step_more(shader, std::min(off, within), x, y, top)) {
      ++figures.last_steps;
      return;
    }
    figures.unexplained += off > within;
    const auto golden = [&](const MorphologicalGolden& of) {
      return difference(shader, weights_of(top ? of.top_weights(x, y) : of.left_weights(x, y)));
    };
    figures.port.add(off);
    figures.published.add(golden(*published_));
    figures.preset.add(golden(*exact_));
    if (golden(*exact_) > 3.1 && top) figures.crossing += two_diagonals(x, y);
  }

  // Whether the weight is nearer to the port with one more step at either end or both. A rounded
  // coordinate that is still inside the search limit adds a step, never removes one.
  bool has_a_step_more(const SmaaWeights& shader, double than, int x, int y, bool top) const {
    constexpr std::array<std::array<int, 2>, 3> kMore = {{{1, 0}, {0, 1}, {1, 1}}};
    return std::any_of(kMore.begin(), kMore.end(), [&](const std::array<int, 2>& more) {
      return difference(shader, port(x, y, top, more)) < than;
    });
  }

  bool two_diagonals(int x, int y) const {
    const Parameters& p = exact_->parameters();
    return p.diagonals &&
           rising_diagonal(exact_->edges(), p.diagonal_steps, x, y, p.border).counts() &&
           falling_diagonal(exact_->edges(), p.diagonal_steps, x, y, p.border).counts();
  }

  Quality quality_;
  SmaaEdges edges_;
  SmaaEdgeImage texels_;
  std::unique_ptr<MorphologicalGolden> exact_, published_;
};

Comparison compared(SmaaShader& shader, const SmaaShaderRun& run, Quality quality,
                    const std::vector<Image>& frames, double within,
                    void (*changed)(Parameters&) = nullptr) {
  Comparison figures;
  for (const Image& image : frames) {
    const Frame frame(image, quality, run.colour, changed);
    frame.compare(shader.weights(frame.texels(), run), within, figures);
  }
  return figures;
}

void print(const std::string& what, const Comparison& found) {
  fmt::print("| {} | {} | {} | {:.3f} | {} | {:.2f} | {} | {} | {:.2f} |\n", what, found.edges,
             found.last_steps, found.port.largest, found.published.over_1, found.published.largest,
             found.preset.over_1, found.preset.over_3, found.preset.largest);
}

void expect_published(const Comparison& found) {
  EXPECT_EQ(found.unexplained, 0);
  EXPECT_EQ(found.published.over_1, 0);
  // One side of an edge gets area A of a diagonal. If a second diagonal crosses the edge, that side
  // also gets area B of the second one (ExactDiagonals.AreasDifferFromPublishedBytes).
  EXPECT_EQ(found.preset.over_3, found.crossing);
  EXPECT_LE(found.preset.largest, 3.7);
}

TEST_F(PublishedShader, WeightsMatchWhereSinglePrecisionIsExact) {
  const std::vector<Image> frames = power_of_two_frames();
  for (const bool colour : {false, true})
    for (const Quality quality : kSmaaQualities) {
      const Comparison found = compared(*shader_, run_of(quality, colour), quality, frames, kExact);
      print(fmt::format("{}, {}", colour ? "colour" : "luma", name_of(quality)), found);
      EXPECT_GT(found.edges, 50000);
      EXPECT_EQ(found.last_steps, 0);
      expect_published(found);
    }
}

// At other sizes the rounding of coordinates decides whether a search makes another step.
void PublishedShader::expect_weights_at_other_sizes(std::span<const Quality> qualities) {
  std::vector<Image> frames = smaa_frames();
  frames.push_back(stimuli::rendered_like(1280, 720, 400));
  // Limit per thousand edges by quality: twice the measured value.
  constexpr std::array<int, 4> kLastSteps = {94, 27, 12, 5};
  for (const bool colour : {false, true})
    for (const Quality quality : qualities) {
      const Comparison found =
          compared(*shader_, whole_texels(run_of(quality, colour)), quality, frames, kRounded);
      print(fmt::format("{}, {}", colour ? "colour" : "luma", name_of(quality)), found);
      EXPECT_GT(found.edges, 10000);
      EXPECT_LT(1000 * found.last_steps,
                kLastSteps[static_cast<std::size_t>(quality)] * found.edges);
      expect_published(found);
    }
}

TEST_F(PublishedShader, WeightsAreCloseAtOtherSizes) {
  expect_weights_at_other_sizes(std::array{Quality::kHigh});
}

// Label long.
TEST_F(PublishedShader, WeightsAreCloseAtOtherSizesForEveryQuality) {
  expect_weights_at_other_sizes(kSmaaQualities);
}

// ---- injected faults
// -----------------------------------------------------------------------------

TEST_F(PublishedShader, OtherThresholdIsDetected) {
  const std::vector<Image> frames = smaa_frames();
  for (const bool colour : {false, true}) {
    SmaaShaderRun run = run_of(Quality::kHigh, colour);
    if (colour) run = mended(run);
    // Half a code higher.
    run.changes.emplace_back("#define SMAA_THRESHOLD 0.1\n#define SMAA_MAX_SEARCH_STEPS 16",
                             "#define SMAA_THRESHOLD 0.102\n#define SMAA_MAX_SEARCH_STEPS 16");
    EXPECT_GT(edge_figures(*shader_, run, Quality::kHigh, frames).unexplained, 10) << colour;
  }
  const auto half_a_code = [](Parameters& p) { p.threshold += 32768; };
  EXPECT_GT(
      edge_figures(*shader_, run_of(Quality::kHigh, false), Quality::kHigh, frames, half_a_code)
          .unexplained,
      10);
}

TEST_F(PublishedShader, OtherRowOfAreasIsDetected) {
  SmaaShaderRun run = run_of(Quality::kHigh, false);
  run.area_row = 1;
  const Comparison found = compared(*shader_, run, Quality::kHigh, power_of_two_frames(), kExact);
  EXPECT_GT(found.unexplained, 100);
}

// Rounding can add one step to a search; two more or one fewer are detected.
TEST_F(PublishedShader, OtherSearchLimitIsDetected) {
  for (const char* const steps : {"3", "6"}) {
    SmaaShaderRun run = whole_texels(run_of(Quality::kLow, false));
    run.changes.emplace_back(
        "#define SMAA_THRESHOLD 0.15\n#define SMAA_MAX_SEARCH_STEPS 4",
        "#define SMAA_THRESHOLD 0.15\n#define SMAA_MAX_SEARCH_STEPS " + std::string(steps));
    const Comparison found = compared(*shader_, run, Quality::kLow, smaa_frames(), kRounded);
    fmt::print("{} steps: {} of {} edges\n", steps, found.unexplained, found.edges);
    EXPECT_GT(found.unexplained, 100) << steps;
  }
}

TEST_F(PublishedShader, OtherBorderIsDetected) {
  const std::vector<Image> frames = {stimuli::random_edges(128, 64, 300),
                                     stimuli::line_image(128, 64)};
  SmaaShaderRun run = run_of(Quality::kHigh, false);
  EXPECT_EQ(compared(*shader_, run, Quality::kHigh, frames, kExact).published.over_1, 0);
  const auto ends = [](Parameters& p) { p.border = Border::kEnd; };
  EXPECT_GT(compared(*shader_, run, Quality::kHigh, frames, kExact, ends).published.over_1, 10);
  run.repeats = true;
  EXPECT_GT(compared(*shader_, run, Quality::kHigh, frames, kExact).unexplained, 10);
}

}  // namespace
}  // namespace deburr::tb::smaa_shader_test
