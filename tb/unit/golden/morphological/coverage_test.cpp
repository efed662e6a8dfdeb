// SPDX-License-Identifier: MIT
// Can every functional coverage bin of the morphological engine be reached? Random rectangles,
// lines, discs and noise hit them all.
#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "tb/base/random.h"
#include "tb/unit/golden/morphological/support.h"

namespace deburr::coverage_test {
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
  narrow.search_columns = 24;
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
    if (quality == Quality::kLow) continue;
    // Runs that end at the border have ends without crossings at every distance.
    p.border = spec::morphological::Border::kEnd;
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
  far.search_columns = 1000;
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
      {"diagonal-beyond", 2},  {"endless", 2 * 4},       {"corner", 2 * 4},
      {"threshold", 1 + 4 * 2}};
  EXPECT_EQ(groups_of(SmaaCoverage().bins()), expected);
}

TEST(MorphologicalGolden, ForgetsCoverageWhenItIsCleared) {
  const Frame noise(tb::morphological::noise_image());
  for (const auto& [preset, bins] :
       {std::pair(
            Preset::kDeburr,
            +[](const MorphologicalGolden& g) { return g.learned_coverage().bins(); }),
        {Preset::kSmaa, +[](const MorphologicalGolden& g) { return g.smaa_coverage().bins(); }},
        {Preset::kMlaa, +[](const MorphologicalGolden& g) { return g.coverage().bins(); }}}) {
    MorphologicalGolden golden(preset_parameters(preset));
    golden.process(noise.view());
    EXPECT_THAT(hits_of(bins(golden)), testing::Not(testing::IsEmpty()));
    golden.clear_coverage();
    EXPECT_THAT(hits_of(bins(golden)), testing::IsEmpty());
  }
}

// ---- what each bin counts, one thing at a time --------------------------------------------------

using Hits = std::map<std::string, std::uint64_t>;
template <class... Names>
Hits once(Names... names) {
  return {{names, 1}...};
}

using spec::morphological::Axis;
using spec::morphological::RunDescriptor;
using spec::morphological::RunPart;

constexpr std::array<const char*, 2> kAxisNames = {"horizontal", "vertical"};

std::string path(std::initializer_list<std::string> parts) {
  std::string name;
  for (const std::string& part : parts) {
    if (!name.empty()) name += '/';
    name += part;
  }
  return name;
}

std::string shape_name(int shape) {
  return std::string(spec::morphological::kRunShapes[static_cast<std::size_t>(shape)].name);
}

// A run that touches no border of a frame of 40 x 40.
RunDescriptor inner_run(std::size_t axis, int length, int shape, RunPart part = RunPart::kWhole) {
  RunDescriptor run;
  run.axis = static_cast<Axis>(axis);
  run.part = part;
  run.start = 3, run.line = 4;
  run.length = static_cast<std::uint16_t>(length);
  run.shape = static_cast<std::uint8_t>(shape);
  return run;
}

Hits hits_of_run(const RunDescriptor& run, const golden::morphological::Prediction& prediction = {},
                 int extent = 40, int lines = 40) {
  RunCoverage coverage;
  coverage.count_run(run, prediction, extent, lines);
  return hits_of(coverage.bins());
}

const std::map<int, std::string> kLengthsByName = {{1, "1"},    {2, "2"},     {3, "3-4"},
                                                   {4, "3-4"},  {5, "5-8"},   {8, "5-8"},
                                                   {9, "9-16"}, {16, "9-16"}, {17, "17+"}};

TEST(RunCoverage, WholeRunsHaveAShapeAndALength) {
  for (std::size_t axis = 0; axis < 2; ++axis)
    for (int shape = 0; shape < 16; ++shape)
      for (const auto& [length, name] : kLengthsByName)
        EXPECT_EQ(
            hits_of_run(inner_run(axis, length, shape)),
            once(std::string("shape/") + kAxisNames[axis] + '/' + shape_name(shape) + '/' + name));
}

TEST(RunCoverage, PartsOfLongRunsHaveTheCrossingOfTheirEnd) {
  const std::array<std::string, 4> names = {"none", "first", "second", "T"};
  for (std::size_t axis = 0; axis < 2; ++axis) {
    for (int code = 0; code < 4; ++code) {
      const Hits expected = once(std::string("long-end/") + kAxisNames[axis] + '/' +
                                 names[static_cast<std::size_t>(code)]);
      EXPECT_EQ(hits_of_run(inner_run(axis, 5, code, RunPart::kHead)), expected);
      EXPECT_EQ(hits_of_run(inner_run(axis, 5, 4 * code, RunPart::kTail)), expected);
    }
  }
}

TEST(RunCoverage, SidesThatWereTriedHaveAnOutcomeAndAReason) {
  using golden::morphological::Extension;
  using golden::morphological::Outcome;
  using golden::morphological::Prediction;
  using golden::morphological::SideEnd;
  const std::map<Outcome, std::string> outcomes = {{Outcome::kNone, "none"},
                                                   {Outcome::kExact, "exact"},
                                                   {Outcome::kEarly, "early"},
                                                   {Outcome::kLate, "late"}};
  const std::map<SideEnd, std::string> reasons = {{SideEnd::kSteps, "all-steps"},
                                                  {SideEnd::kNoHit, "no-hit"},
                                                  {SideEnd::kReach, "out-of-reach"},
                                                  {SideEnd::kInconsistent, "inconsistent"},
                                                  {SideEnd::kCurve, "curve"}};
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const std::string of_axis = kAxisNames[axis];
    for (const auto& [length, length_name] : kLengthsByName) {
      for (const bool right : {false, true}) {
        for (const auto& [outcome, outcome_name] : outcomes) {
          if (outcome == Outcome::kEarly && length == 1) continue;  // a step of 0 is none
          for (const auto& [why, reason] : reasons) {
            Prediction prediction;
            Extension& side = right ? prediction.right : prediction.left;
            side.outcome = outcome;
            side.why = why;
            EXPECT_EQ(hits_of_run(inner_run(axis, length, 9), prediction),
                      once(path({"shape", of_axis, "Z-first-second", length_name}),
                           path({"prediction", of_axis, right ? "right" : "left", outcome_name,
                                 length_name}),
                           path({"prediction-end", of_axis, reason})));
          }
        }
      }
    }
  }
}

TEST(RunCoverage, RunsTouchTheFramesBorders) {
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const auto borders = [&](int start, int line) {
      RunDescriptor run = inner_run(axis, 5, 0);
      run.start = static_cast<std::uint16_t>(start);
      run.line = static_cast<std::uint16_t>(line);
      Hits hits = hits_of_run(run, {}, 12, 9);
      hits.erase(std::string("shape/") + kAxisNames[axis] + "/none-none/5-8");
      return hits;
    };
    const std::string of_axis = std::string("border/") + kAxisNames[axis] + '/';
    EXPECT_EQ(borders(1, 2), Hits{});
    EXPECT_EQ(borders(0, 2), once(of_axis + "start-on-border"));
    EXPECT_EQ(borders(6, 2), Hits{});
    EXPECT_EQ(borders(7, 2), once(of_axis + "end-on-border"));
    EXPECT_EQ(borders(1, 1), once(of_axis + "first-line"));
    EXPECT_EQ(borders(1, 7), Hits{});
    EXPECT_EQ(borders(1, 8), once(of_axis + "last-line"));
    EXPECT_EQ(borders(0, 8), once(of_axis + "start-on-border", of_axis + "last-line"));
  }
}

TEST(RunCoverage, DecisionsAreCountedByThePixel) {
  using golden::morphological::Decision;
  const std::map<Decision, std::string> names = {
      {Decision::kNone, "none"},
      {Decision::kOnlyUpDown, "only-up-down"},
      {Decision::kOnlyLeftRight, "only-left-right"},
      {Decision::kLongerUpDown, "longer-up-down"},
      {Decision::kLongerLeftRight, "longer-left-right"},
      {Decision::kStrongerUpDown, "stronger-up-down"},
      {Decision::kStrongerLeftRight, "stronger-left-right"},
      {Decision::kTie, "tie"}};
  for (const auto& [decision, name] : names) {
    RunCoverage coverage;
    coverage.count_pixel(decision);
    EXPECT_EQ(hits_of(coverage.bins()), once("decision/" + name));
    coverage.count_pixels(decision, 4);
    EXPECT_EQ(hits_of(coverage.bins()), (Hits{{"decision/" + name, 5}}));
  }
}

// ---- SMAA's -------------------------------------------------------------------------------------

using golden::morphological::SearchEnd;
using golden::morphological::TableAddress;

Hits hits_of_pixel(std::size_t axis, const TableAddress& address) {
  SmaaCoverage coverage;
  coverage.count_pixel(static_cast<Axis>(axis), address);
  return hits_of(coverage.bins());
}

TEST(SmaaCoverage, PixelsHaveAShapeAndTheLongerDistance) {
  const std::map<int, std::string> names = {{1, "1-3"},  {3, "1-3"},   {4, "4-8"}, {8, "4-8"},
                                            {9, "9-24"}, {24, "9-24"}, {25, "25+"}};
  for (std::size_t axis = 0; axis < 2; ++axis) {
    for (int shape = 0; shape < 16; ++shape) {
      for (const auto& [distance, name] : names) {
        const Hits expected =
            once(std::string("table/") + kAxisNames[axis] + '/' + shape_name(shape) + '/' + name);
        EXPECT_EQ(hits_of_pixel(axis, {shape, distance, 0}), expected);
        EXPECT_EQ(hits_of_pixel(axis, {shape, distance - 1, distance}), expected);
      }
    }
  }
}

TEST(SmaaCoverage, SearchesEndAtTheLimitOrBeyondIt) {
  constexpr int kNothing = 0;  // a shape without sides
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const std::string of_axis = kAxisNames[axis];
    const std::string table = "table/" + of_axis + "/none-none/1-3";
    const auto search = [&](SearchEnd start, SearchEnd end) {
      return hits_of_pixel(axis, {kNothing, 1, 1, start, end});
    };
    using enum SearchEnd;
    EXPECT_EQ(search(kWithin, kWithin), once(table));
    EXPECT_EQ(search(kAtLimit, kWithin), once(table, "search/" + of_axis + "/start/at"));
    EXPECT_EQ(search(kBeyond, kWithin), once(table, "search/" + of_axis + "/start/beyond"));
    EXPECT_EQ(search(kWithin, kAtLimit), once(table, "search/" + of_axis + "/end/at"));
    EXPECT_EQ(search(kWithin, kBeyond), once(table, "search/" + of_axis + "/end/beyond"));
  }
}

// Of the half tile by shapes with one side or with two, of the dip tile by those that dip; a shape
// that reads nothing has no entry.
TEST(SmaaCoverage, EntriesOfTheTableAreTheFirstAndTheLast) {
  const auto entries = [](int shape, int before, int after) {
    std::set<std::string> names;
    for (const auto& [name, count] : hits_of_pixel(0, {shape, before, after})) {
      EXPECT_EQ(count, 1u);
      if (name.starts_with("table-entry/")) names.insert(name.substr(12));
    }
    return names;
  };
  using Names = std::set<std::string>;
  for (int shape = 0; shape < 16; ++shape) {
    const std::string name = shape_name(shape);
    const bool dips = name.starts_with("U-");
    const bool nothing =
        std::set<std::string>{"none-none", "T-none", "none-T", "T-T"}.contains(name);
    const std::string tile = dips ? "dip/" : "half/";
    const auto only = [&](const std::string& entry) {
      return nothing ? Names{} : Names{tile + entry};
    };
    EXPECT_EQ(entries(shape, 0, 0), only("first")) << name;
    EXPECT_EQ(entries(shape, 0, 1), Names{});
    EXPECT_EQ(entries(shape, 1, 0), Names{});
    EXPECT_EQ(entries(shape, 14 * 14 - 1, 14 * 14), Names{});
    EXPECT_EQ(entries(shape, 14 * 14, 14 * 14 - 1), Names{});
    EXPECT_EQ(entries(shape, 14 * 14, 14 * 14), only("last")) << name;
  }
}

TEST(SmaaCoverage, DiagonalsHaveCodesEndsAndALength) {
  using golden::morphological::DiagonalEnds;
  const auto diagonal = [](bool rising, const DiagonalEnds& ends) {
    SmaaCoverage coverage;
    coverage.count_diagonal(rising, ends, false);
    const Hits hits = hits_of(coverage.bins());
    Hits beyond = hits;
    if (!hits.empty()) beyond[rising ? "diagonal-beyond/rising" : "diagonal-beyond/falling"] = 1;
    SmaaCoverage over_the_border;
    over_the_border.count_diagonal(rising, ends, true);
    EXPECT_EQ(hits_of(over_the_border.bins()), beyond);
    return hits;
  };
  const std::array<std::string, 4> ends = {"closed", "open-1", "open-2", "open-both"};
  for (const bool rising : {false, true}) {
    const std::string direction = rising ? "rising" : "falling";
    for (int e1 = 0; e1 < 4; ++e1) {
      for (int e2 = 0; e2 < 4; ++e2) {
        for (std::size_t open = 0; open < 4; ++open) {
          EXPECT_EQ(
              diagonal(rising, {1, 2, e1, e2, open % 2 != 0, open / 2 != 0}),
              once(path({"diagonal", direction, std::to_string(e1) + '-' + std::to_string(e2)}),
                   path({"diagonal-ends", direction, ends[open]}),
                   path({"diagonal-length", direction, "3"})));
        }
      }
    }
    EXPECT_EQ(diagonal(rising, {2, 0}), Hits{});  // too short to count
    for (const auto& [pixels, name] : std::map<int, std::string>{{4, "4-7"}, {7, "4-7"}, {8, "8+"}})
      EXPECT_TRUE(
          diagonal(rising, {pixels - 1, 1}).contains(path({"diagonal-length", direction, name})));
  }
}

TEST(SmaaCoverage, RecordsAreEndlessOrRepeatACrossing) {
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const std::string of_axis = std::string("endless/") + kAxisNames[axis] + '/';
    const auto descriptor = [&](int endless, int shape, int extent,
                                RunPart part = RunPart::kWhole) {
      RunDescriptor run = inner_run(axis, 5, shape, part);
      run.endless = static_cast<std::uint8_t>(endless);
      SmaaCoverage coverage;
      coverage.count_descriptor(run, extent);
      return hits_of(coverage.bins());
    };
    EXPECT_EQ(descriptor(0, 9, 40), Hits{});
    EXPECT_EQ(descriptor(1, 8, 40), once(of_axis + "start"));
    EXPECT_EQ(descriptor(2, 1, 8), once(of_axis + "end"));
    EXPECT_EQ(descriptor(3, 0, 8), once(of_axis + "both"));
    EXPECT_EQ(descriptor(0, 5, 8), once(of_axis + "repeated"));
    EXPECT_EQ(descriptor(0, 5, 9), Hits{});  // does not meet the border
    EXPECT_EQ(descriptor(0, 4, 8, RunPart::kTail), once(of_axis + "repeated"));
    EXPECT_EQ(descriptor(0, 1, 8, RunPart::kHead), Hits{});
  }
}

TEST(SmaaCoverage, CornersHaveANearerEndOrAreCut) {
  using enum SearchEnd;
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const std::string of_axis = std::string("corner/") + kAxisNames[axis] + '/';
    const auto corner = [&](const TableAddress& address, int far) {
      SmaaCoverage coverage;
      coverage.count_corner(static_cast<Axis>(axis), address, far);
      return hits_of(coverage.bins());
    };
    EXPECT_EQ(corner({9, 2, 3}, 1), once(of_axis + "start"));
    EXPECT_EQ(corner({9, 3, 3}, 1), once(of_axis + "middle"));
    EXPECT_EQ(corner({9, 4, 3}, 1), once(of_axis + "end"));
    EXPECT_EQ(corner({8, 7, 3, kBeyond, kWithin}, 3), once(of_axis + "cut"));
    EXPECT_EQ(corner({8, 7, 3, kBeyond, kWithin}, 7), once(of_axis + "end"));
    EXPECT_EQ(corner({1, 3, 8, kWithin, kBeyond}, 12), once(of_axis + "cut"));
    EXPECT_EQ(corner({1, 7, 8, kAtLimit, kAtLimit}, 12), once(of_axis + "start"));
  }
}

TEST(SmaaCoverage, ThresholdsAreFixedOrOfTheFloorOrAlpha) {
  using spec::morphological::DynamicLuma;
  const std::map<DynamicLuma, std::string> names = {{DynamicLuma::kCurrent, "current"},
                                                    {DynamicLuma::kMax, "max"},
                                                    {DynamicLuma::kMin, "min"},
                                                    {DynamicLuma::kMean, "mean"}};
  for (const auto& [luma, name] : names) {
    SmaaCoverage floor, alpha;
    floor.count_threshold(luma, true);
    alpha.count_threshold(luma, false);
    EXPECT_EQ(hits_of(floor.bins()), once("threshold/" + name + "/floor"));
    EXPECT_EQ(hits_of(alpha.bins()), once("threshold/" + name + "/alpha"));
  }
  SmaaCoverage fixed;
  fixed.count_fixed(7);
  fixed.count_fixed(2);
  EXPECT_EQ(hits_of(fixed.bins()), (Hits{{"threshold/fixed", 9}}));
}

// The darker of a pair is black, then 150: a tenth of 0 lies below the floor of 10 codes, of 150 it
// does not.
TEST(SmaaCoverage, EdgesOfAFrameAreOfTheFloorOrAlpha) {
  using spec::morphological::AreaSource;
  using spec::morphological::DynamicLuma;
  const auto code = [](int i) { return grey(i == 0 ? 0 : i == 1 ? 150 : 220); };
  const Frame across(4, 1, [&](int x, int) { return code(x); });
  const Frame down(1, 4, [&](int, int y) { return code(y); });
  const auto hits = [](const spec::morphological::Parameters& p, const Frame& frame) {
    MorphologicalGolden golden(p);
    golden.process(frame.view());
    Hits result = hits_of(golden.smaa_coverage().bins());
    std::erase_if(result, [](const auto& bin) { return !bin.first.starts_with("threshold/"); });
    return result;
  };
  spec::morphological::Parameters p = preset_parameters(Preset::kSmaaDynamic);
  p.local_contrast = spec::morphological::LocalContrast::kOff;
  p.dynamic_luma = DynamicLuma::kMin;
  p.alpha = 1677721;
  p.floor = 655360;
  for (const Frame& frame : {across, down})
    EXPECT_EQ(hits(p, frame), once("threshold/min/floor", "threshold/min/alpha"));
  // A fixed one is counted with SMAA's blocks: tables, or diagonals.
  p.threshold_mode = spec::morphological::ThresholdMode::kFixed;
  for (const bool diagonals : {false, true}) {
    for (const AreaSource area : {AreaSource::kAnalytic, AreaSource::kTableFull}) {
      p.diagonals = diagonals;
      p.area = area;
      p.border = spec::morphological::Border::kEnd;
      const bool counted = diagonals || area == AreaSource::kTableFull;
      for (const Frame& frame : {across, down})
        EXPECT_EQ(hits(p, frame), (counted ? Hits{{"threshold/fixed", 2}} : Hits{}));
    }
  }
}

// A step of a row, 24 columns wide.
TEST(SmaaCoverage, EachEdgeOfAFrameIsAPixelOfTheTable) {
  const Frame step(24, 9, [](int x, int y) { return grey(y < (x < 12 ? 4 : 5) ? 230 : 20); });
  MorphologicalGolden golden(preset_parameters(Preset::kSmaa));
  golden.process(step.view());
  std::uint64_t pixels = 0;
  for (const auto& [name, hits] : hits_of(golden.smaa_coverage().bins()))
    if (name.starts_with("table/")) pixels += hits;
  EXPECT_EQ(golden.edges().top.count() + golden.edges().left.count(), 25u);
  EXPECT_EQ(pixels, 25u);
}

// The one corner of a rectangle: both runs that meet there have a far bit.
TEST(SmaaCoverage, EachEdgeOfAFrameThatLeadsToACornerIsCounted) {
  const Frame corner(24, 9, [](int x, int y) { return grey(x < 12 && y < 4 ? 230 : 20); });
  MorphologicalGolden golden(preset_parameters(Preset::kSmaa));
  golden.process(corner.view());
  EXPECT_EQ(golden.edges().top.count(), 12u);
  EXPECT_EQ(golden.edges().left.count(), 4u);
  std::uint64_t across = 0, down = 0;
  for (const auto& [name, hits] : hits_of(golden.smaa_coverage().bins())) {
    if (name.starts_with(std::string("corner/") + kAxisNames[0])) across += hits;
    if (name.starts_with(std::string("corner/") + kAxisNames[1])) down += hits;
  }
  EXPECT_EQ(across, 12u);
  EXPECT_EQ(down, 4u);
}

// Falling diagonals that end a pixel beyond the last row, or the last column, by a top edge alone:
// the border repeats it.
TEST(SmaaCoverage, DiagonalsAreBeyondTheFrameFromItsBorderOn) {
  struct Case {
    int width, height;
    std::vector<std::pair<int, int>> top, left;
  };
  for (const Case& c : {Case{12,
                             6,
                             {{2, 1}, {3, 2}, {4, 3}, {5, 4}, {6, 5}, {7, 5}},
                             {{3, 1}, {4, 2}, {5, 3}, {6, 4}, {7, 5}}},
                        Case{7,
                             12,
                             {{2, 1}, {3, 2}, {4, 3}, {5, 4}, {6, 5}, {6, 6}},
                             {{3, 1}, {4, 2}, {5, 3}, {6, 4}, {6, 5}}}}) {
    golden::morphological::EdgePlanes edges{{c.width, c.height}, {c.width, c.height}};
    for (const auto& [x, y] : c.top) edges.top.set(x, y);
    for (const auto& [x, y] : c.left) edges.left.set(x, y);
    const Frame frame(c.width, c.height, [](int, int) { return grey(9); });
    MorphologicalGolden golden(preset_parameters(Preset::kSmaa));
    golden.process(frame.view(), edges);
    Hits hits = hits_of(golden.smaa_coverage().bins());
    std::erase_if(hits, [](const auto& bin) { return !bin.first.starts_with("diagonal-beyond/"); });
    EXPECT_EQ(hits, (Hits{{"diagonal-beyond/falling", 5}})) << c.width;
  }
}

TEST(RunCoverage, LengthBinsAreThoseOfTheirNames) {
  const std::map<int, std::size_t> expected = {{1, 0}, {2, 1}, {3, 2},  {4, 2},  {5, 3},
                                               {8, 3}, {9, 4}, {16, 4}, {17, 5}, {2048, 5}};
  for (const auto& [length, bin] : expected) EXPECT_EQ(RunCoverage::length_bin(length), bin);
}

}  // namespace
}  // namespace deburr::coverage_test
