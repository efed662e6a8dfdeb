// SPDX-License-Identifier: MIT
// Compares ways of combining the geometric and the morphological engine: on every scene from its
// own camera and from others that nothing was tuned on, against supersampling
// (docs/measurements/geometric_quality.md, "Both engines").
#include <fmt/core.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "golden/ideal/geometric.h"
#include "golden/morphological/morphological_golden.h"
#include "spec/geometric/tables.h"
#include "studies/quality/solids.h"
#include "studies/quality/views.h"
#include "tb/engines/geometric/geometric_stimuli.h"
#include "tb/unit/scene/fixtures.h"

namespace deburr::studies::geometric_morphological_test {
namespace {

using golden::geometric::GeometricGolden;
using golden::ideal::Light;
using golden::ideal::NearestEdges;
using golden::ideal::SideWeights;
using golden::morphological::EdgePlanes;
using golden::morphological::MorphologicalGolden;
using spec::morphological::Bypass;
using spec::morphological::Parameters;
using spec::morphological::Preset;
using tb::Image;
using tb::geometric::Checker;

constexpr int kWidth = 640, kHeight = 480;

Parameters configuration(Preset preset, Bypass bypass = Bypass::kNone) {
  Parameters p = golden::morphological::preset_parameters(preset);
  p.bypass = bypass;
  return p;
}

// Luma edges at depth edges, blended by the fitted line.
Parameters at_depth(Bypass bypass) {
  Parameters p = configuration(Preset::kDeburrLine, bypass);
  p.edge_source = spec::morphological::EdgeSource::kPredicated;
  const spec::morphological::FollowingRules following;
  p.threshold_on_depth_edge = following.threshold_on_depth_edge;
  p.threshold_off_depth_edge = following.threshold_off_depth_edge;
  return p;
}

Image smoothed(const Image& image, const tb::geometric::Frame& frame, const Parameters& p) {
  MorphologicalGolden golden(p, MorphologicalGolden::Detail::kPixels);
  Image result = image;
  result.pixels = golden.process({image.pixels, image.width, image.height},
                                 {frame.depths, image.width, image.height});
  return result;
}

spec::geometric::Parameters marking() {
  spec::geometric::Parameters p =
      golden::geometric::preset_parameters(spec::geometric::Preset::kDeburr);
  p.mark = true;
  return p;
}

// ---- the two channels ---------------------------------------------------------------------------

std::vector<NearestEdges> channels_of(const GeometricGolden& golden) {
  std::vector<SideWeights> weights;
  for (const spec::geometric::Weights& w : golden.weights())
    weights.push_back({w[0] / 256.0, w[1] / 256.0, w[2] / 256.0, w[3] / 256.0});
  return golden::ideal::nearest_edges(weights);
}

// Blends by the channels only, in the light of the engine's tables.
Image blended_by(const std::vector<NearestEdges>& channels, const Image& frame) {
  std::vector<Light> light;
  for (const tb::Rgba8& pixel : frame.pixels) {
    Light l;
    for (std::size_t c = 0; c < 3; ++c) l[c] = spec::geometric::kLinear12FromSrgb[pixel[c]];
    light.push_back(l);
  }
  const std::vector<Light> result = golden::ideal::blended(light, channels, frame.width);
  Image image = frame;
  for (std::size_t i = 0; i < result.size(); ++i) {
    for (std::size_t c = 0; c < 3; ++c) {
      image.pixels[i][c] =
          spec::geometric::kSrgbFromLinear12[static_cast<std::size_t>(std::lround(result[i][c]))];
    }
  }
  return image;
}

// Converts the channels to edges between pixels: between a pixel and the neighbour that it blends
// with. A line gives one such edge per column. Where the line moves on by one row, the crossing
// edge that ends a run is missing and is added.
EdgePlanes edges_of(const std::vector<NearestEdges>& channels, int width, int height) {
  EdgePlanes edges;
  for (auto* plane : {&edges.left, &edges.top}) plane->resize(width, height);
  const auto at = [&](int x, int y) {
    return channels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                    static_cast<std::size_t>(x)];
  };
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const NearestEdges e = at(x, y);
      if (e.horizontal != 0.0) edges.left.set(x + (e.horizontal > 0.0 ? 1 : 0), y);
      if (e.vertical != 0.0) edges.top.set(x, y + (e.vertical > 0.0 ? 1 : 0));
    }
  }
  EdgePlanes result = edges;
  const auto& [left, top] = edges;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const bool rises = top.at(x - 1, y + 1) && top.at(x, y) && !top.at(x - 1, y);
      const bool falls = top.at(x - 1, y) && top.at(x, y + 1) && !top.at(x, y);
      if (x > 0 && (rises || falls)) result.left.set(x, y);
      const bool to_left = left.at(x + 1, y - 1) && left.at(x, y) && !left.at(x, y - 1);
      const bool to_right = left.at(x, y - 1) && left.at(x + 1, y) && !left.at(x, y);
      if (y > 0 && (to_left || to_right)) result.top.set(x, y);
    }
  }
  return result;
}

// Luma edges where one of the two pixels has a channel.
EdgePlanes luma_edges_at(const std::vector<NearestEdges>& channels, const Image& frame) {
  MorphologicalGolden golden(configuration(Preset::kDeburrLine),
                             MorphologicalGolden::Detail::kPixels);
  golden.process({frame.pixels, frame.width, frame.height});
  EdgePlanes result;
  for (auto* plane : {&result.left, &result.top}) plane->resize(frame.width, frame.height);
  const auto has = [&](int x, int y) {
    const NearestEdges& e =
        channels[static_cast<std::size_t>(y) * static_cast<std::size_t>(frame.width) +
                 static_cast<std::size_t>(x)];
    return e.horizontal != 0.0 || e.vertical != 0.0;
  };
  for (int y = 0; y < frame.height; ++y) {
    for (int x = 0; x < frame.width; ++x) {
      if (golden.edges().left.at(x, y) && (has(x, y) || has(x - 1, y))) result.left.set(x, y);
      if (golden.edges().top.at(x, y) && (has(x, y) || has(x, y - 1))) result.top.set(x, y);
    }
  }
  return result;
}

// ---- all combinations ---------------------------------------------------------------------------

struct Figures {
  double edges = 0, silhouettes = 0;  // RMSE
};
using Table = std::map<std::string, Figures>;

double better_by(double a, double than) { return 20 * std::log10(than / a); }  // dB

// Learned weights with their own edges.
constexpr std::pair<const char*, Bypass> kFollowers[] = {{"nothing left", Bypass::kNone},
                                                         {"marked", Bypass::kMarked},
                                                         {"beside", Bypass::kBeside},
                                                         {"half", Bypass::kHalf},
                                                         {"masked", Bypass::kMasked}};

Table measure(const tb::Scene& scene, const std::string& name, int width, int height, int samples) {
  const Checker checker(scene, width, height, samples);
  const Image& frame = checker.frame.image;
  Table table;
  const auto add = [&](const char* way, const Image& image) {
    table[way] = {checker.edge_rmse(image), checker.silhouette_rmse(image)};
    fmt::print("| {} | {} | {:.2f} / {:.2f} |\n", name, way, table[way].edges,
               table[way].silhouettes);
  };
  const auto with_edges = [&](const EdgePlanes& edges) {
    MorphologicalGolden golden(configuration(Preset::kDeburrLine),
                               MorphologicalGolden::Detail::kPixels);
    Image result = frame;
    result.pixels = golden.process({frame.pixels, width, height}, edges);
    return result;
  };

  GeometricGolden golden(marking(), GeometricGolden::Detail::kPixels);
  Image geometric = frame;
  geometric.pixels = golden.process(checker.frame.input());
  const std::vector<NearestEdges> channels = channels_of(golden);

  add("none", frame);
  add("msaa4", checker.msaa);
  add("morphological", smoothed(frame, checker.frame, configuration(Preset::kDeburr)));
  add("geometric", geometric);
  for (const auto& [way, bypass] : kFollowers)
    add(way, smoothed(geometric, checker.frame, configuration(Preset::kDeburr, bypass)));
  add("depth, half", smoothed(geometric, checker.frame, at_depth(Bypass::kHalf)));
  add("as built", smoothed(geometric, checker.frame,
                           golden::morphological::following_geometric(
                               configuration(spec::morphological::FollowingRules().preset))));
  add("two channels", blended_by(channels, frame));
  add("channels as edges", with_edges(edges_of(channels, width, height)));
  add("luma edges at channels", with_edges(luma_edges_at(channels, frame)));
  std::fflush(stdout);
  return table;
}

// Checked for every scene and camera. Where hidden lines lie within a pixel of visible ones
// (terrain), the geometric engine's own weights are wrong.
void check_ways(const Table& t, bool lines_are_apart) {
  const auto gain = [&](const char* way, const char* than) {
    return Figures{better_by(t.at(way).edges, t.at(than).edges),
                   better_by(t.at(way).silhouettes, t.at(than).silhouettes)};
  };
  for (const char* way : {"as built", "beside"}) {
    EXPECT_GT(gain(way, "geometric").edges, -0.02) << way;
    EXPECT_GT(gain(way, "geometric").silhouettes, -0.02) << way;
  }
  EXPECT_GT(gain("as built", "nothing left").silhouettes, 0.6);
  // The channels carry less information than the four weights.
  EXPECT_LT(gain("two channels", "geometric").edges, 0.2);
  if (!lines_are_apart) return;
  EXPECT_GT(gain("as built", "msaa4").silhouettes, 0);
  EXPECT_GT(gain("as built", "morphological").silhouettes, 1);
  // Runs of edges carry less information than distances, regardless of the source of the edges.
  EXPECT_LT(gain("channels as edges", "as built").silhouettes, -0.5);
  EXPECT_LT(gain("luma edges at channels", "as built").silhouettes, -0.4);
}

class Joined : public testing::TestWithParam<const char*> {};

TEST_P(Joined, ImplementedCombinationIsBest) {
  const std::string name = GetParam();
  for (const int degrees : {0, 25, -50, 77}) {
    SCOPED_TRACE(degrees);
    check_ways(measure(turned(tb::make_scene(name), degrees), fmt::format("{} {}", name, degrees),
                       kWidth, kHeight, degrees == 0 ? 16 : 8),
               name != "terrain");
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, Joined,
                         testing::Values("cube", "sphere", "wheelcover", "wing", "canopy",
                                         "cylinders", "object", "road", "terrain"));

TEST(Joined, ImplementedCombinationIsBestOnTrack) {
  DEBURR_REQUIRE_DATA(data);
  const tb::Camera cameras[] = {{{4.6, 2.6, 12.5}, {-0.6, 0.4, -4}, {0, 1, 0}, 1.0, 0.1},
                                {{-4, 1.5, 10}, {2, 0.5, -4}, {0, 1, 0}, 1.0, 0.1},
                                {{8, 1.2, 2}, {-4, 0.8, -2}, {0, 1, 0}, 1.0, 0.1}};
  int camera = 0;
  for (const tb::Camera& each : cameras) {
    tb::SceneOptions options;
    options.camera = each;
    const tb::Scene scene = tb::load_scene((data / "meshes" / "scene_track.obj").string(), options);
    check_ways(measure(scene, fmt::format("track {}", camera++), 1280, 720, 8), true);
  }
}

// ---- consequences, on views of every kind -------------------------------------------------------

struct Way {
  const char* name;
  Parameters configuration;
};

std::vector<Way> followers() {
  const Parameters following = golden::morphological::following_geometric(
      configuration(spec::morphological::FollowingRules().preset));
  std::vector<Way> ways;
  for (const auto& [name, bypass] : kFollowers)
    ways.push_back({name, configuration(Preset::kDeburr, bypass)});
  Parameters luma = configuration(Preset::kDeburr, Bypass::kMasked);
  luma.edge_source = spec::morphological::EdgeSource::kLuma;
  luma.threshold = configuration(Preset::kDeburrLine).threshold;
  Parameters both = at_depth(Bypass::kMasked);
  both.area = spec::morphological::AreaSource::kLearned;
  Parameters depth = configuration(Preset::kDeburr, Bypass::kMasked);
  depth.edge_source = spec::morphological::EdgeSource::kDepth;
  ways.push_back({"masked, luma", luma});
  ways.push_back({"masked, luma at depth", both});
  ways.push_back({"masked, depth", depth});
  ways.push_back({"masked, line", configuration(Preset::kDeburrLine, Bypass::kMasked)});
  ways.push_back({"beside, line, luma at depth", at_depth(Bypass::kBeside)});
  ways.push_back({"half, line, luma at depth", at_depth(Bypass::kHalf)});
  ways.push_back({"as built", following});
  return ways;
}

struct Gain {
  double mean = 0, worst = 1e9;
  std::string view;
};

// Gain of each combination over the geometric engine alone, and over the better single engine.
struct Gains {
  // edges, silhouettes
  std::array<Gain, 2> over_geometric, over_better;
};

std::map<std::string, Gains> gains_of_followers(Half half, const std::filesystem::path& data) {
  std::map<std::string, Gains> gains;
  const std::vector<MeasuredView> views = studies::views(half, data);
  for (const MeasuredView& view : views) {
    const Checker checker(view.scene, kWidth, kHeight, 8, nullptr, {.crossings = true});
    const auto figures = [&](const Image& image) {
      return std::array{checker.edge_psnr(image), checker.silhouette_psnr(image)};
    };
    spec::geometric::Parameters p = marking();
    p.face_limit = 1 << 17;
    const Image drawn = tb::geometric::smoothed(checker.frame, p).image;
    const auto geometric = figures(drawn),
               morphological = figures(
                   smoothed(checker.frame.image, checker.frame, configuration(Preset::kDeburr)));
    std::string row = fmt::format("| {} | {:.2f} / {:.2f} | {:.2f} / {:.2f} |", view.name,
                                  geometric[0], geometric[1], morphological[0], morphological[1]);
    for (const Way& way : followers()) {
      const auto after = figures(smoothed(drawn, checker.frame, way.configuration));
      row += fmt::format(" {:.2f} / {:.2f} |", after[0], after[1]);
      for (std::size_t i = 0; i < 2; ++i) {
        const auto add = [&](Gain& gain, double before) {
          gain.mean += (after[i] - before) / static_cast<double>(views.size());
          if (after[i] - before < gain.worst) gain = {gain.mean, after[i] - before, view.name};
        };
        add(gains[way.name].over_geometric[i], geometric[i]);
        add(gains[way.name].over_better[i], std::max(geometric[i], morphological[i]));
      }
    }
    fmt::print("{}\n", row);
    std::fflush(stdout);
  }
  for (const Way& way : followers()) {
    std::string row = fmt::format("| {} |", way.name);
    for (const auto* const than : {&gains[way.name].over_geometric, &gains[way.name].over_better})
      for (const Gain& gain : *than)
        row += fmt::format(" {:+.2f}, {:+.2f} ({}) |", gain.mean, gain.worst, gain.view);
    fmt::print("{}\n", row);
  }
  fmt::print("{} views\n", views.size());
  return gains;
}

// On every view, the implemented combination loses nothing against the geometric engine; the same
// holds for every other combination that gains.
void check_followers(const std::map<std::string, Gains>& gains) {
  const Gains& built = gains.at("as built");
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_GT(built.over_geometric[i].worst, -0.02) << built.over_geometric[i].view;
    EXPECT_GE(built.over_geometric[i].mean, 0);
    for (const char* other : {"half, line, luma at depth", "marked", "half"})
      EXPECT_GT(built.over_geometric[i].worst, gains.at(other).over_geometric[i].worst) << other;
  }
  // Edges of unfiltered textures: here the morphological engine alone is better.
  EXPECT_LT(built.over_better[0].worst, -2);
  EXPECT_GT(gains.at("masked").over_better[0].worst, -0.5);
}

// The views that the configuration was chosen on.
TEST(Followers, LoseNothingOnTuningViews) {
  DEBURR_REQUIRE_DATA(data);
  check_followers(gains_of_followers(Half::kChosenBy, data));
}

// Held-out views.
TEST(Followers, LoseNothingOnHeldOutViews) {
  DEBURR_REQUIRE_DATA(data);
  check_followers(gains_of_followers(Half::kHeldOut, data));
}

// ---- the outermost line -------------------------------------------------------------------------

TEST(Outermost, ReducesErrorsOfHiddenLines) {
  spec::geometric::Parameters p = marking();
  p.coverage = spec::geometric::CoverageRule::kDistance;  // only this option
  p.crease_depth = 0;
  for (const char* name : {"wheelcover", "canopy", "cylinders", "object", "terrain"}) {
    for (const int degrees : {0, 25, -50, 77}) {
      const Checker checker(turned(tb::make_scene(name), degrees), kWidth, kHeight, 8);
      const auto followed = [&](const Image& image) {
        return smoothed(image, checker.frame, at_depth(Bypass::kHalf));
      };
      const auto combined = [&](spec::geometric::Combine combine) {
        p.combine = combine;
        return tb::geometric::smoothed(checker.frame, p).image;
      };
      const Image largest = combined(spec::geometric::Combine::kMax);
      const Image outermost = combined(spec::geometric::Combine::kOutermost);
      std::string row = fmt::format("| {} {} |", name, degrees);
      for (const Image& image :
           {checker.msaa, largest, outermost, followed(largest), followed(outermost)})
        row += fmt::format(" {:.2f} / {:.2f} |", checker.edge_rmse(image),
                           checker.silhouette_rmse(image));
      fmt::print("{}\n", row);
      const double gain =
          better_by(checker.silhouette_rmse(outermost), checker.silhouette_rmse(largest));
      EXPECT_GT(gain, std::string(name) == "terrain" ? 1 : -0.1) << name << ' ' << degrees;
    }
  }
}

// ---- the channels by themselves -----------------------------------------------------------------

// The nearer side of each axis, and the neighbour across the nearer edge of both.
TEST(NearestEdges, KeepTheNearerSide) {
  const std::vector<SideWeights> weights = {{0, 0, 0, 0.25}, {0.5, 0.25, 0.125, 0}, {0, 0, 0, 0}};
  const std::vector<NearestEdges> e = golden::ideal::nearest_edges(weights);
  EXPECT_EQ(e[0].horizontal, 0.25);
  EXPECT_EQ(e[1].vertical, -0.5);
  EXPECT_EQ(e[1].horizontal, -0.125);
  EXPECT_EQ(e[2].vertical, 0.0);

  const std::vector<Light> frame = {{8, 8, 8}, {0, 0, 0}, {4, 4, 4}, {16, 16, 16}};
  const std::vector<Light> image =
      golden::ideal::blended(frame, std::vector<NearestEdges>{{0.25, 0}, {}, {0.25, -0.5}, {}}, 2);
  EXPECT_EQ(image[0][0], 8 - 0.25 * 8);
  EXPECT_EQ(image[1][0], 0);
  EXPECT_EQ(image[2][0], 4 + 0.5 * 4);
  EXPECT_EQ(image[3][0], 16);
}

}  // namespace
}  // namespace deburr::studies::geometric_morphological_test
