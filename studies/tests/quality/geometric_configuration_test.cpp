// SPDX-License-Identifier: MIT
// Gain of the options outermost, area, crease_depth and cull: on scenes of the project, and on
// meshes and cameras that nothing was tuned on (docs/measurements/geometric_quality.md).
#include <fmt/core.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "studies/quality/solids.h"
#include "studies/quality/views.h"
#include "tb/engines/geometric/geometric_stimuli.h"
#include "tb/unit/scene/fixtures.h"

namespace deburr::studies::geometric_configuration_test {
namespace {

using golden::geometric::GeometricGolden;
using golden::geometric::preset_parameters;
using spec::geometric::Combine;
using spec::geometric::CoverageRule;
using spec::geometric::Cull;
using spec::geometric::Parameters;
using spec::geometric::Preset;
using tb::Image;
using tb::geometric::Checker;

constexpr int kWidth = 640, kHeight = 480;

// ---- one option at a time -----------------------------------------------------------------------

// Preset `deburr` without the options under test.
Parameters plain() {
  Parameters p = preset_parameters(Preset::kDeburr);
  p.cull = Cull::kBack;
  p.coverage = CoverageRule::kDistance;
  p.crease_depth = 0;
  p.combine = Combine::kMax;
  p.face_limit = 1 << 17;  // for distant, fine meshes
  return p;
}

struct Way {
  const char* name;
  void (*change)(Parameters&);
};
constexpr Way kWays[] = {
    {"max of distances", [](Parameters&) {}},
    {"outermost", [](Parameters& p) { p.combine = Combine::kOutermost; }},
    {"area", [](Parameters& p) { p.coverage = CoverageRule::kArea; }},
    {"crease_depth", [](Parameters& p) { p.crease_depth = 3; }},
    {"all three",
     [](Parameters& p) {
       p.combine = Combine::kOutermost;
       p.coverage = CoverageRule::kArea;
       p.crease_depth = 3;
     }},
    {"all three, cull none",
     [](Parameters& p) {
       p.combine = Combine::kOutermost;
       p.coverage = CoverageRule::kArea;
       p.crease_depth = 3;
       p.cull = Cull::kNone;
     }},
};
constexpr std::size_t kAll = 4, kBothSides = 5;

struct Figures {
  double edges = 0, silhouettes = 0;  // dB
};
struct Measured {
  std::string name;
  Figures none, msaa;
  std::vector<Figures> ways;
  std::vector<std::uint64_t> lines;    // of memory, read and written
  std::vector<std::uint64_t> columns;  // columns walked
};

std::uint64_t lines_of_memory(const golden::geometric::Traffic& traffic) {
  std::uint64_t sum = 0;
  for (const auto* lists : {&traffic.reads, &traffic.writes})
    for (const auto& list : *lists) sum += list.size();
  return sum;
}

Measured measure(const tb::Scene& scene, const std::string& name, int width = kWidth,
                 int height = kHeight) {
  const Checker checker(scene, width, height, 8);
  const auto figures = [&](const Image& image) {
    return Figures{checker.edge_psnr(image), checker.silhouette_psnr(image)};
  };
  Measured m{name, figures(checker.frame.image), figures(checker.msaa), {}, {}, {}};
  std::string row = fmt::format("| {} | {:.2f} / {:.2f} | {:.2f} / {:.2f} |", name, m.none.edges,
                                m.none.silhouettes, m.msaa.edges, m.msaa.silhouettes);
  for (const Way& way : kWays) {
    Parameters p = plain();
    way.change(p);
    GeometricGolden golden(p);
    Image image = checker.frame.image;
    image.pixels = golden.process(checker.frame.input());
    m.ways.push_back(figures(image));
    m.lines.push_back(lines_of_memory(golden.traffic()));
    m.columns.push_back(golden.work().columns);
    row += fmt::format(" {:.2f} / {:.2f} |", m.ways.back().edges, m.ways.back().silhouettes);
  }
  fmt::print("{} {} {} {} lines\n", row, m.lines[0], m.lines[kAll], m.lines[kBothSides]);
  std::fflush(stdout);
  return m;
}

struct Gain {
  double mean = 0, worst = 1e9;
};
Gain gain_of(const std::vector<Measured>& all, std::size_t way, double Figures::*figure) {
  Gain gain;
  for (const Measured& m : all) {
    const double g = m.ways[way].*figure - m.ways[0].*figure;
    gain.mean += g / static_cast<double>(all.size());
    gain.worst = std::min(gain.worst, g);
  }
  return gain;
}

void print_gains(const char* which, const std::vector<Measured>& all) {
  for (std::size_t way = 1; way < std::size(kWays); ++way) {
    const Gain edges = gain_of(all, way, &Figures::edges),
               silhouettes = gain_of(all, way, &Figures::silhouettes);
    double lines = 0;
    for (const Measured& m : all)
      lines += (static_cast<double>(m.lines[way]) / static_cast<double>(m.lines[0]) - 1) * 100 /
               static_cast<double>(all.size());
    fmt::print("| {} | {} | {:+.2f}, {:+.2f} | {:+.2f}, {:+.2f} | {:+.1f} % |\n", which,
               kWays[way].name, edges.mean, edges.worst, silhouettes.mean, silhouettes.worst,
               lines);
  }
}

// Requires the mean gain on silhouettes, no loss on any scene's edges, and the mean memory traffic.
void expect_gain(const std::vector<Measured>& all, double silhouettes) {
  EXPECT_GE(gain_of(all, kAll, &Figures::silhouettes).mean, silhouettes);
  EXPECT_GE(gain_of(all, kAll, &Figures::edges).worst, -0.2);
  EXPECT_GE(gain_of(all, kBothSides, &Figures::edges).worst, -0.2);
  EXPECT_GE(gain_of(all, kBothSides, &Figures::silhouettes).mean, silhouettes - 0.1);
  double lines = 0;
  for (const Measured& m : all)
    lines += static_cast<double>(m.lines[kAll]) / static_cast<double>(m.lines[0]);
  EXPECT_LE(lines, 1.05 * static_cast<double>(all.size()));
}

// ---- scenes of the project ----------------------------------------------------------------------

TEST(LineConfiguration, ImprovesQualityOnProjectScenes) {
  std::vector<Measured> all;
  for (const char* name :
       {"cube", "sphere", "wheelcover", "wing", "canopy", "cylinders", "object", "road", "terrain"})
    all.push_back(measure(tb::make_scene(name), name));
  print_gains("known", all);
  expect_gain(all, 3);
}

// ---- scenes that nothing was tuned on -----------------------------------------------------------

TEST(LineConfiguration, ImprovesQualityOnOtherSolids) {
  std::vector<Measured> all;
  for (const SolidsName& kind : solids_names())
    for (const std::uint64_t seed : {1u, 2u})
      all.push_back(measure(make_solids(kind.name, seed), fmt::format("{} {}", kind.name, seed)));
  print_gains("solids", all);
  expect_gain(all, 1.5);
}

TEST(LineConfiguration, ImprovesQualityOnThirdPartyMeshes) {
  DEBURR_REQUIRE_DATA(data);
  std::vector<Measured> all;
  for (const char* name : {"kenney_truck", "teapot", "wing_open", "sphere32"}) {
    const tb::Scene scene =
        tb::load_scene((data / "meshes" / (std::string(name) + ".obj")).string());
    for (const double degrees : {0.0, 137.0})
      all.push_back(measure(turned(scene, degrees), fmt::format("{} {}", name, degrees)));
  }
  print_gains("meshes", all);
  expect_gain(all, 2);
}

// First rendered after the options were final.
TEST(LineConfiguration, ImprovesQualityOnHeldOutScenes) {
  std::vector<Measured> all;
  for (const SolidsName& kind : solids_names())
    for (const std::uint64_t seed : {11u, 12u})
      all.push_back(measure(make_solids(kind.name, seed), fmt::format("{} {}", kind.name, seed)));
  const std::filesystem::path data = tb::data_folder();
  if (std::filesystem::is_directory(data / "meshes")) {
    for (const char* name : {"WusonOBJ", "spot", "wing_fine", "terrain_open", "canopy_open"}) {
      const tb::Scene scene =
          tb::load_scene((data / "meshes" / (std::string(name) + ".obj")).string());
      for (const double degrees : {0.0, -71.0})
        all.push_back(measure(turned(scene, degrees), fmt::format("{} {}", name, degrees)));
    }
  }
  print_gains("others", all);
  expect_gain(all, 2);
}

// ---- the preset against its predecessor ---------------------------------------------------------

struct Presets {
  std::string name;
  Figures before, after;
  // Memory lines without crossing lines: before, with the three options, and with both sides drawn.
  std::uint64_t lines_before = 0, lines_of_configuration = 0, lines_after = 0;
  std::size_t crossing = 0;  // lines where surfaces intersect
};

Presets measure_presets(const tb::Scene& scene, const std::string& name) {
  const Checker checker(scene, kWidth, kHeight, 8, nullptr, {.crossings = true});
  tb::geometric::Frame frame = checker.frame;
  Presets m{name, {}, {}, 0, 0, 0, frame.table.crossings};
  const auto figures = [&](const Image& image) {
    return Figures{checker.edge_psnr(image), checker.silhouette_psnr(image)};
  };
  Parameters after = preset_parameters(Preset::kDeburr), configuration = plain();
  after.face_limit = configuration.face_limit;
  kWays[kAll].change(configuration);
  m.after = figures(tb::geometric::smoothed(frame, after).image);
  frame.table = tb::build_edge_table(scene.mesh);
  frame.screen = tb::project_edges(frame.table, scene.camera, kWidth, kHeight);
  m.before = figures(tb::geometric::smoothed(frame, plain()).image);
  for (const auto& [p, lines] : {std::pair{plain(), &m.lines_before},
                                 {configuration, &m.lines_of_configuration},
                                 {after, &m.lines_after}}) {
    GeometricGolden golden(p);
    golden.process(frame.input());
    *lines = lines_of_memory(golden.traffic());
  }
  fmt::print(
      "| {} | {:.2f} / {:.2f} | {:.2f} / {:.2f} | {:.2f} / {:.2f} | {:+.2f} / {:+.2f} | {} | "
      "{:+.1f} %, {:+.1f} % |\n",
      name, checker.edge_psnr(checker.frame.image), checker.silhouette_psnr(checker.frame.image),
      m.before.edges, m.before.silhouettes, m.after.edges, m.after.silhouettes,
      m.after.edges - m.before.edges, m.after.silhouettes - m.before.silhouettes, m.crossing,
      100.0 * static_cast<double>(m.lines_of_configuration) / static_cast<double>(m.lines_before) -
          100.0,
      100.0 * static_cast<double>(m.lines_after) / static_cast<double>(m.lines_before) - 100.0);
  std::fflush(stdout);
  return m;
}

// Checks mean gains, no loss on edges, and memory lines added by the options.
void check_presets(const char* which, const std::vector<Presets>& all, double silhouettes) {
  Figures mean, worst{1e9, 1e9};
  double configuration = 0, after = 0, through = 0;
  int views_through = 0;
  const double n = static_cast<double>(all.size());
  for (const Presets& m : all) {
    const double e = m.after.edges - m.before.edges, s = m.after.silhouettes - m.before.silhouettes;
    mean.edges += e / n;
    mean.silhouettes += s / n;
    worst.edges = std::min(worst.edges, e);
    worst.silhouettes = std::min(worst.silhouettes, s);
    configuration +=
        static_cast<double>(m.lines_of_configuration) / static_cast<double>(m.lines_before) / n;
    after += static_cast<double>(m.lines_after) / static_cast<double>(m.lines_before) / n;
    EXPECT_GT(e, -0.2) << m.name;
    for (const char* kind : {"chain", "crossing", "floor", "field"}) {
      if (m.name.rfind(kind, 0) != 0) continue;
      through += e;
      ++views_through;
    }
  }
  fmt::print(
      "| {} | {} | {:+.2f}, {:+.2f} | {:+.2f}, {:+.2f} | {:+.1f} % | {:+.1f} % | {:+.2f} |\n",
      which, all.size(), mean.edges, worst.edges, mean.silhouettes, worst.silhouettes,
      100 * (configuration - 1), 100 * (after - 1), through / std::max(views_through, 1));
  EXPECT_GT(mean.silhouettes, silhouettes);
  EXPECT_LT(configuration, 1.05);
  if (views_through > 0) {
    EXPECT_GT(through / views_through, 4);
  }
}

void check_views(const char* which, Half half) {
  std::vector<Presets> scenes, others;
  for (const MeasuredView& view : studies::views(half, tb::data_folder()))
    (view.group == "scenes" ? scenes : others).push_back(measure_presets(view.scene, view.name));
  check_presets(fmt::format("{}, scenes", which).c_str(), scenes, 2.9);
  check_presets(fmt::format("{}, other meshes", which).c_str(), others, 2);
}

TEST(Presets, GainOnTuningViews) { check_views("one half", Half::kChosenBy); }
TEST(Presets, GainOnHeldOutViews) { check_views("the other", Half::kHeldOut); }

// First rendered after crease_depth = 3 was chosen with views of both halves.
TEST(Presets, GainOnViewsUnusedForCreaseDepth) {
  std::vector<Presets> all;
  for (const double degrees : {0.0, 53.0}) {
    all.push_back(measure_presets(turned(make_solids("plates", 41), degrees),
                                  fmt::format("plates 41, {}", degrees)));
    for (const char* kind : {"shelves", "terraces"})
      all.push_back(measure_presets(turned(make_kind(kind, 41), degrees),
                                    fmt::format("{} 41, {}", kind, degrees)));
  }
  check_presets("never looked at", all, 1);
}

// Every face is turned away from the camera.
TEST(Presets, SmoothInsideACube) {
  for (const double degrees : {0.0, 33.0, 71.0, 118.0}) {
    const Checker checker(inside_a_cube(degrees), kWidth, kHeight, 8);
    const Image before = tb::geometric::smoothed(checker.frame, plain()).image,
                after = tb::geometric::smoothed(checker.frame, preset_parameters(Preset::kDeburr))
                            .image;
    fmt::print("| {} | {:.2f} | {:.2f} | {:.2f} | {:.2f} |\n", degrees,
               checker.edge_psnr(checker.frame.image), checker.edge_psnr(checker.msaa),
               checker.edge_psnr(before), checker.edge_psnr(after));
    EXPECT_EQ(before.pixels, checker.frame.image.pixels);
    EXPECT_GT(checker.edge_psnr(after), 38) << degrees;
  }
}

// ---- intersecting surfaces ----------------------------------------------------------------------

TEST(Crossings, GainFourDecibelsOnAverage) {
  double mean = 0, worst = 1e9;
  std::size_t views = 0;
  for (const char* kind : {"crossing", "floor"}) {
    for (const std::uint64_t seed : {1u, 2u, 11u, 12u}) {
      const tb::Scene scene = make_solids(kind, seed);
      const Checker checker(scene, kWidth, kHeight, 8, nullptr, {.crossings = true});
      tb::geometric::Frame without = checker.frame;
      without.table = tb::build_edge_table(scene.mesh);
      without.screen = tb::project_edges(without.table, scene.camera, kWidth, kHeight);
      Parameters p = plain();
      kWays[kBothSides].change(p);
      const Image before = tb::geometric::smoothed(without, p).image,
                  after = tb::geometric::smoothed(checker.frame, p).image;
      const double gain = checker.edge_psnr(after) - checker.edge_psnr(before);
      fmt::print("| {} {} | {:.2f} | {:.2f} | {:.2f} | {:.2f} | {:.2f} | {:.2f} | {} lines\n", kind,
                 seed, checker.edge_psnr(checker.frame.image), checker.edge_psnr(checker.msaa),
                 checker.edge_psnr(before), checker.edge_psnr(after),
                 checker.silhouette_psnr(before), checker.silhouette_psnr(after),
                 checker.frame.table.crossings);
      EXPECT_GE(checker.silhouette_psnr(after), checker.silhouette_psnr(before) - 0.3)
          << kind << seed;
      mean += gain;
      worst = std::min(worst, gain);
      ++views;
    }
  }
  mean /= static_cast<double>(views);
  fmt::print("| mean {:+.2f}, worst {:+.2f} |\n", mean, worst);
  EXPECT_GT(mean, 4);
  EXPECT_GT(worst, 0);
}

}  // namespace
}  // namespace deburr::studies::geometric_configuration_test
