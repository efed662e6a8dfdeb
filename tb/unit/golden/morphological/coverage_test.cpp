// SPDX-License-Identifier: MIT
// Can every functional coverage bin of the morphological engine be reached? Random rectangles,
// lines, discs and noise hit them all.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "tb/stimuli/random.h"
#include "tb/unit/golden/morphological/support.h"

namespace deburr {
namespace {

using golden::morphological::CoverageBin;
using golden::morphological::MorphologicalGolden;
using golden::morphological::preset_parameters;
using golden::morphological::RunCoverage;
using golden::morphological::SmaaCoverage;
using spec::morphological::Preset;
using tb::Random;
using tb::morphological::Frame;
using tb::morphological::grey;

int below(Random& random, int n) {
  return static_cast<int>(random.word() % static_cast<unsigned>(n));
}

// Greys that are sometimes too near for an edge, so that crossings go missing.
Frame rectangles(Random& random) {
  const int width = 1 + below(random, 70), height = 1 + below(random, 70);
  Frame frame(width, height, [](int, int) { return grey(128); });
  for (int i = 0; i < 25; ++i) {
    const int x0 = below(random, width), y0 = below(random, height);
    const bool flat = random.word() % 2 == 0;
    const int w = 1 + below(random, flat ? 40 : 3), h = 1 + below(random, flat ? 3 : 40);
    const int code = below(random, 8) * 6 + below(random, 2) * 100;
    for (int y = y0; y < std::min(height, y0 + h); ++y) {
      for (int x = x0; x < std::min(width, x0 + w); ++x) frame.at(x, y) = grey(code);
    }
  }
  return frame;
}

Frame line(Random& random, bool steep) {
  const double slope = 1 / random.uniform(1, 26), start = random.uniform(0, 20);
  const bool falling = random.word() % 2 == 0;
  const Frame frame(120 + below(random, 100), 24 + below(random, 20), [&](int x, int y) {
    const double at = falling ? start + slope * x : start + 20 - slope * x;
    return grey(y < at ? 255 : 0);
  });
  return steep ? Frame(tb::morphological::transposed(frame)) : frame;
}

Frame disc(Random& random) {
  const double radius = random.uniform(5, 200), x0 = random.uniform(0, 90),
               y0 = random.uniform(0, 90) + radius;
  return Frame(90, 90,
               [&](int x, int y) { return grey(std::hypot(x - x0, y - y0) < radius ? 220 : 10); });
}

std::set<std::string> holes(const std::map<std::string, std::uint64_t>& hits) {
  std::set<std::string> result;
  for (const auto& [name, count] : hits) {
    if (count == 0) result.insert(name);
  }
  return result;
}

TEST(RunCoverage, EveryBinCanBeReached) {
  Random random(7);
  spec::morphological::Parameters wide = preset_parameters(Preset::kDeburrLine);
  wide.window_rows = 258;
  spec::morphological::Parameters narrow = preset_parameters(Preset::kMlaaSlope);
  narrow.window_rows = 50;
  narrow.reach_columns = 24;
  MorphologicalGolden a(wide), b(narrow);
  std::map<std::string, std::uint64_t> hits;
  const auto collect = [&] {
    hits.clear();
    for (const MorphologicalGolden* golden : {&a, &b}) {
      for (const CoverageBin& bin : golden->coverage().bins()) hits[bin.name] += bin.hits;
    }
  };
  for (int round = 0; round < 60; ++round) {
    for (int i = 0; i < 20; ++i) {
      for (const Frame& frame : {rectangles(random), rectangles(random), rectangles(random),
                                 line(random, false), line(random, true), disc(random)}) {
        a.process(frame.view());
        b.process(frame.view());
      }
    }
    const Frame noise = tb::morphological::noise_image(100, 100);
    a.process(noise.view());
    collect();
    if (holes(hits).empty()) break;
  }
  EXPECT_THAT(holes(hits), testing::IsEmpty());
  EXPECT_EQ(hits.size(), a.coverage().bins().size());  // names are unique
}

TEST(RunCoverage, AnEmptyFrameLeavesHoles) {
  MorphologicalGolden golden(preset_parameters(Preset::kDeburrLine));
  const Frame frame(8, 8, [](int, int) { return grey(3); });
  golden.process(frame.view());
  std::size_t hit = 0;
  for (const CoverageBin& bin : golden.coverage().bins()) hit += bin.hits != 0;
  EXPECT_EQ(hit, 1u);  // decision/none
}

TEST(SmaaCoverage, EveryBinCanBeReached) {
  using spec::morphological::DynamicLuma;
  using spec::morphological::Quality;
  Random random(11);
  std::vector<MorphologicalGolden> goldens;
  for (const Quality quality : {Quality::kLow, Quality::kUltra}) {
    spec::morphological::Parameters p = preset_parameters(Preset::kSmaa, quality);
    p.local_contrast = spec::morphological::LocalContrast::kOff;
    goldens.emplace_back(p);
  }
  for (const auto luma :
       {DynamicLuma::kCurrent, DynamicLuma::kMax, DynamicLuma::kMin, DynamicLuma::kMean}) {
    spec::morphological::Parameters p = preset_parameters(Preset::kSmaaDynamic);
    p.dynamic_luma = luma;
    goldens.emplace_back(p);
  }
  // Runs that reach the last entries of the table: a step, and a bar on a floor.
  spec::morphological::Parameters far = preset_parameters(Preset::kSmaa);
  far.search_steps = 112;
  far.reach_columns = 1000;
  goldens.emplace_back(far);
  const Frame step = tb::stimuli::long_step(420), bar = tb::stimuli::long_bar(420);
  const Frame stairs = tb::stimuli::diagonals(60, 60, 3),
              other_way = tb::morphological::mirrored_x(stairs);
  const Frame noise = tb::morphological::noise_image(300, 300),
              shades = tb::morphological::shades_image();
  for (MorphologicalGolden& golden : goldens)
    for (const Frame& frame : {step, bar, stairs, other_way, noise, shades})
      golden.process(frame.view());
  std::map<std::string, std::uint64_t> hits;
  for (int round = 0; round < 40; ++round) {
    for (const int width : {1, 2, 3, 6, 15, 40, 160}) {
      const Frame frame = tb::stimuli::bands(width, 150, random);
      for (MorphologicalGolden& golden : goldens) {
        golden.process(frame.view());
        golden.process(Frame(tb::morphological::transposed(frame)).view());
      }
    }
    hits.clear();
    for (const MorphologicalGolden& golden : goldens)
      for (const CoverageBin& bin : golden.smaa_coverage().bins()) hits[bin.name] += bin.hits;
    if (holes(hits).empty()) break;
  }
  EXPECT_THAT(holes(hits), testing::IsEmpty());
  EXPECT_EQ(hits.size(), goldens[0].smaa_coverage().bins().size());  // names are unique
}

// Presets without SMAA's blocks hit nothing.
TEST(SmaaCoverage, StaysEmptyWithoutItsBlocks) {
  MorphologicalGolden golden(preset_parameters(Preset::kDeburrLine));
  golden.process(Frame(tb::morphological::noise_image()).view());
  for (const CoverageBin& bin : golden.smaa_coverage().bins()) EXPECT_EQ(bin.hits, 0u) << bin.name;
}

// Holes in the list of bins itself would not show as bins that nobody hits.
std::map<std::string, std::size_t> groups_of(const std::vector<CoverageBin>& bins) {
  std::map<std::string, std::size_t> sizes;
  for (const CoverageBin& bin : bins) ++sizes[bin.name.substr(0, bin.name.find('/'))];
  return sizes;
}

std::map<std::string, std::uint64_t> hits_of(const std::vector<CoverageBin>& bins) {
  std::map<std::string, std::uint64_t> hits;
  for (const CoverageBin& bin : bins)
    if (bin.hits != 0) hits[bin.name] = bin.hits;
  return hits;
}

TEST(RunCoverage, ListsEveryBinOfEveryGroup) {
  const std::map<std::string, std::size_t> expected = {
      {"shape", 2 * 16 * 6},     {"long-end", 2 * 4}, {"prediction", 2 * 2 * (4 * 6 - 1)},
      {"prediction-end", 2 * 5}, {"border", 2 * 4},   {"decision", 8}};
  EXPECT_EQ(groups_of(RunCoverage().bins()), expected);
}

TEST(SmaaCoverage, ListsEveryBinOfEveryGroup) {
  const std::map<std::string, std::size_t> expected = {
      {"table", 2 * 16 * 5},   {"table-entry", 2 * 2},   {"search", 2 * 2 * 2},
      {"diagonal", 2 * 16},    {"diagonal-ends", 2 * 4}, {"diagonal-length", 2 * 3},
      {"threshold", 1 + 4 * 2}};
  EXPECT_EQ(groups_of(SmaaCoverage().bins()), expected);
}

TEST(RunCoverage, CountsDecisionsAndBordersOnce) {
  using spec::morphological::RunPart;
  RunCoverage coverage;
  coverage.count_pixel(golden::morphological::Decision::kNone);
  coverage.count_pixels(golden::morphological::Decision::kNone, 4);
  EXPECT_THAT(hits_of(coverage.bins()), testing::ElementsAre(testing::Pair("decision/none", 5)));

  spec::morphological::RunRecord run;
  run.part = RunPart::kTail;
  run.start = 3, run.length = 5, run.line = 4;
  RunCoverage inside, at_end;
  inside.count_run(run, {}, 9, 9);
  at_end.count_run(run, {}, 8, 9);
  EXPECT_EQ(hits_of(inside.bins()).size(), 1u);  // the long end alone
  EXPECT_EQ(hits_of(at_end.bins()).size(), 2u);
}

TEST(SmaaCoverage, EntriesOfTheTableAreTheFirstAndTheLast) {
  using golden::morphological::TableAddress;
  const auto entries = [](int before, int after) {
    SmaaCoverage coverage;
    TableAddress address;
    while (spec::morphological::kRunShapes[static_cast<std::size_t>(address.shape)].before ==
           spec::morphological::kRunShapes[static_cast<std::size_t>(address.shape)].after)
      ++address.shape;
    address.before = before, address.after = after;
    coverage.count_pixel(spec::morphological::Axis::kHorizontal, address);
    const auto hits = hits_of(coverage.bins());
    return std::pair(hits.contains("table-entry/half/first"),
                     hits.contains("table-entry/half/last"));
  };
  EXPECT_EQ(entries(0, 0), std::pair(true, false));
  EXPECT_EQ(entries(0, 1), std::pair(false, false));
  EXPECT_EQ(entries(14 * 14 - 1, 14 * 14), std::pair(false, false));
  EXPECT_EQ(entries(14 * 14, 14 * 14), std::pair(false, true));
}

TEST(RunCoverage, LengthBinsAreThoseOfTheirNames) {
  const std::map<int, std::size_t> expected = {{1, 0}, {2, 1}, {3, 2},  {4, 2},  {5, 3},
                                               {8, 3}, {9, 4}, {16, 4}, {17, 5}, {2048, 5}};
  for (const auto& [length, bin] : expected) EXPECT_EQ(RunCoverage::length_bin(length), bin);
}

}  // namespace
}  // namespace deburr
