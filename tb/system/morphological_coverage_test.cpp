// SPDX-License-Identifier: MIT
// Functional coverage of the morphological engine over frames that run through the hardware model:
// shapes x orientation x length, predictions by side, outcome and length, what ended them, ends of
// long runs, frame borders, decisions of the blender. Every bin must be hit, with every frame
// identical to golden, runs and lines included.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <fstream>
#include <set>
#include <string>

#include "tb/harness/coverage.h"
#include "tb/harness/forked.h"
#include "tb/system/morphological_runs.h"

namespace deburr::tb::morphological_system {
namespace {

using golden::morphological::CoverageBin;
using golden::morphological::MorphologicalGolden;
using golden::morphological::RunCoverage;

MorphologicalInput transposed(const MorphologicalInput& f) {
  return draw(f.image.height, f.image.width, [&](int x, int y) { return f.image.at(y, x); });
}

// Greys that are sometimes too near for an edge, so that crossings go missing.
MorphologicalInput rectangles(Random& random) {
  const auto below = [&](int n) {
    return static_cast<int>(random.below(static_cast<std::uint32_t>(n)));
  };
  const int width = 1 + below(70), height = 1 + below(70);
  MorphologicalInput frame = flat(width, height, 128);
  for (int i = 0; i < 25; ++i) {
    const int x0 = below(width), y0 = below(height);
    const bool wide = random.chance(500);
    const int w = 1 + below(wide ? 40 : 3), h = 1 + below(wide ? 3 : 40);
    const int code = below(8) * 6 + below(2) * 100;
    for (int y = y0; y < std::min(height, y0 + h); ++y)
      for (int x = x0; x < std::min(width, x0 + w); ++x) frame.image.at(x, y) = grey(code);
  }
  return frame;
}

MorphologicalInput line(Random& random, bool steep) {
  const auto uniform = [&](double low, double high) {
    return low + (high - low) * random.below(1 << 24) / (1 << 24);
  };
  const double slope = 1 / uniform(1, 26), start = uniform(0, 20);
  const bool falling = random.chance(500);
  const MorphologicalInput frame =
      draw(120 + static_cast<int>(random.below(100)), 24 + static_cast<int>(random.below(20)),
           [&](int x, int y) {
             return grey(y < (falling ? start + slope * x : start + 20 - slope * x) ? 255 : 0);
           });
  return steep ? transposed(frame) : frame;
}

MorphologicalInput disc(Random& random) {
  const double radius = 5 + 195.0 * random.below(1000) / 1000, x0 = random.below(90),
               y0 = random.below(90) + radius;
  return draw(90, 90,
              [&](int x, int y) { return grey(std::hypot(x - x0, y - y0) < radius ? 220 : 10); });
}

spec::morphological::Parameters wide() {
  spec::morphological::Parameters p = preset(Preset::kDeburr);
  p.window_rows = 258;
  p.line_pixels = 512;
  return p;
}
spec::morphological::Parameters narrow() {
  spec::morphological::Parameters p = preset(Preset::kMlaaSlope);
  p.window_rows = 50;
  p.reach_columns = 24;
  p.line_pixels = 512;
  return p;
}

// Hits in the order of bins(); plain numbers, because they come from another process.
struct Hits {
  std::array<std::uint64_t, 1024> count{};
};

void add(Coverage& coverage, const Hits& hits) {
  const std::vector<CoverageBin> bins = RunCoverage().bins();
  ASSERT_LE(bins.size(), hits.count.size());
  for (std::size_t i = 0; i < bins.size(); ++i) {
    coverage.declare(bins[i].name);
    coverage.hit(bins[i].name, hits.count[i]);
  }
}

// Frames are added, golden alone, until no bin is empty; those that hit something new are kept.
std::vector<MorphologicalInput> telling_frames(const spec::morphological::Parameters& parameters) {
  Random random(7);
  MorphologicalGolden golden(parameters);
  std::set<std::string> met;
  std::vector<MorphologicalInput> kept;
  for (int round = 0; round < 1200; ++round) {
    MorphologicalInput frame = round % 6 < 3    ? rectangles(random)
                               : round % 6 == 3 ? line(random, false)
                               : round % 6 == 4 ? line(random, true)
                                                : disc(random);
    if (round % 120 == 119) frame = noise(100, 100, static_cast<std::uint64_t>(round));
    golden.clear_coverage();
    golden.process({frame.image.pixels, frame.image.width, frame.image.height});
    bool tells = false;
    for (const CoverageBin& bin : golden.coverage().bins())
      if (bin.hits > 0) tells |= met.insert(bin.name).second;
    if (tells) kept.push_back(std::move(frame));
  }
  return kept;
}

// What frames met, each of them identical to golden in the hardware model.
Hits met(const spec::morphological::Parameters& parameters,
         const std::vector<MorphologicalInput>& frames) {
  return forked<Hits>([&] {
    MorphologicalRunOptions options;
    options.morphological = parameters;
    options.records = true;
    Simulation simulation(options);
    MorphologicalEnvironment environment(simulation, frames, options);
    simulation.elaborate(environment);
    simulation.run();
    environment.check();
    Hits hits;
    std::size_t i = 0;
    for (const CoverageBin& bin : environment.golden_model().coverage().bins())
      hits.count.at(i++) = bin.hits;
    return hits;
  });
}

TEST(MorphologicalCoverage, EveryBinIsHit) {
  Coverage coverage;
  for (const auto& parameters : {wide(), narrow()})
    add(coverage, met(parameters, telling_frames(parameters)));
  std::ofstream("morphological_coverage.json") << coverage.json();
  EXPECT_GT(coverage.size(), 200u);
  EXPECT_TRUE(coverage.holes().empty()) << testing::PrintToString(coverage.holes());
}

TEST(MorphologicalCoverage, AHoleIsReported) {
  Coverage coverage;
  add(coverage, met(wide(), {flat(8, 8, 3)}));
  EXPECT_EQ(coverage.size() - coverage.holes().size(), 1u);  // decision/none
  EXPECT_THROW(coverage.hit("shape/diagonal"), spec::CheckFailed);
}

}  // namespace
}  // namespace deburr::tb::morphological_system
