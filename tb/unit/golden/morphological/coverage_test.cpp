// SPDX-License-Identifier: MIT
// Functional coverage of the morphological golden model: random rectangles, lines, discs and noise
// hit every bin, and each bin counts the events that its name says.
#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
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
using tb::morphological::Hits;
using tb::morphological::hits_of;
using tb::morphological::names_of;

int below(Random& random, int n) {
  return static_cast<int>(random.word() % static_cast<unsigned>(n));
}

// Greys sometimes differ too little for an edge, so some crossings are missing.
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
  // Runs that are long enough for the last table entries: a step, and a bar on a floor.
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

TEST(SmaaCoverage, StaysEmptyWithoutSmaaBlocks) {
  MorphologicalGolden golden(preset_parameters(Preset::kDeburrLine));
  golden.process(Frame(tb::morphological::noise_image()).view());
  for (const CoverageBin& bin : golden.smaa_coverage().bins()) EXPECT_EQ(bin.hits, 0u) << bin.name;
}

// Number of bins per group: a bin missing from the list would not show up as a bin without hits.
std::map<std::string, std::size_t> groups_of(const std::vector<CoverageBin>& bins) {
  std::map<std::string, std::size_t> sizes;
  for (const CoverageBin& bin : bins) ++sizes[bin.name.substr(0, bin.name.find('/'))];
  return sizes;
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

TEST(MorphologicalGolden, ClearCoverageResetsAllBins) {
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

// ---- single events of RunCoverage ---------------------------------------------------------------

using spec::morphological::Axis;
using spec::morphological::RunDescriptor;
using spec::morphological::RunPart;

constexpr std::array<const char*, 2> kAxisNames = {"horizontal", "vertical"};
std::string axis_prefix(const char* group, std::size_t axis) {
  return std::string(group) + '/' + kAxisNames[axis] + '/';
}

std::string shape_name(int shape) {
  return std::string(spec::morphological::kRunShapes[static_cast<std::size_t>(shape)].name);
}

// A run that does not touch the border of a 40 x 40 frame.
RunDescriptor inner_run(std::size_t axis, int length, int shape, RunPart part = RunPart::kWhole) {
  RunDescriptor run;
  run.axis = static_cast<Axis>(axis);
  run.part = part;
  run.start = 3, run.line = 4;
  run.length = static_cast<std::uint16_t>(length);
  run.shape = static_cast<std::uint8_t>(shape);
  return run;
}

std::string counted_run(const RunDescriptor& run,
                        const golden::morphological::Prediction& prediction = {}, int extent = 40,
                        int lines = 40) {
  RunCoverage coverage;
  coverage.count_run(run, prediction, extent, lines);
  return names_of(coverage.bins());
}

const std::map<int, std::string> kLengthsByName = {{1, "1"},    {2, "2"},     {3, "3-4"},
                                                   {4, "3-4"},  {5, "5-8"},   {8, "5-8"},
                                                   {9, "9-16"}, {16, "9-16"}, {17, "17+"}};

TEST(RunCoverage, CountsShapeLengthAndLongRunEnds) {
  const std::array<std::string, 4> ends = {"none", "first", "second", "T"};
  for (std::size_t axis = 0; axis < 2; ++axis) {
    for (int shape = 0; shape < 16; ++shape)
      for (const auto& [length, name] : kLengthsByName)
        EXPECT_EQ(counted_run(inner_run(axis, length, shape)),
                  axis_prefix("shape", axis) + shape_name(shape) + '/' + name);
    for (int code = 0; code < 4; ++code) {
      const std::string expected =
          axis_prefix("long-end", axis) + ends[static_cast<std::size_t>(code)];
      EXPECT_EQ(counted_run(inner_run(axis, 5, code, RunPart::kHead)), expected);
      EXPECT_EQ(counted_run(inner_run(axis, 5, 4 * code, RunPart::kTail)), expected);
    }
  }
}

TEST(RunCoverage, CountsPredictionOutcomeAndReason) {
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
  for (std::size_t axis = 0; axis < 2; ++axis)
    for (const auto& [length, length_name] : kLengthsByName)
      for (const bool right : {false, true})
        for (const auto& [outcome, outcome_name] : outcomes)
          for (const auto& [why, reason] : reasons) {
            if (outcome == Outcome::kEarly && length == 1) continue;  // no steps of 0
            Prediction prediction;
            (right ? prediction.right : prediction.left).outcome = outcome;
            (right ? prediction.right : prediction.left).why = why;
            EXPECT_EQ(counted_run(inner_run(axis, length, 9), prediction),
                      axis_prefix("prediction-end", axis) + reason + ' ' +
                          axis_prefix("prediction", axis) + (right ? "right/" : "left/") +
                          outcome_name + '/' + length_name + ' ' + axis_prefix("shape", axis) +
                          "Z-first-second/" + length_name);
          }
}

// Runs of five pixels without crossings in a 12 x 9 frame.
TEST(RunCoverage, CountsRunsAtFrameBorders) {
  struct Row {
    std::uint16_t start, line;
    std::vector<std::string> borders;
  };
  for (std::size_t axis = 0; axis < 2; ++axis) {
    for (const Row& row : {Row{1, 2, {}}, Row{0, 2, {"start-on-border"}}, Row{6, 2, {}},
                           Row{7, 2, {"end-on-border"}}, Row{1, 1, {"first-line"}}, Row{1, 7, {}},
                           Row{1, 8, {"last-line"}}, Row{0, 8, {"last-line", "start-on-border"}}}) {
      RunDescriptor run = inner_run(axis, 5, 0);
      run.start = row.start;
      run.line = row.line;
      std::string expected;
      for (const std::string& border : row.borders)
        expected += axis_prefix("border", axis) + border + ' ';
      EXPECT_EQ(counted_run(run, {}, 12, 9),
                expected + axis_prefix("shape", axis) + "none-none/5-8");
    }
  }
}

TEST(RunCoverage, CountsDecisionsPerPixel) {
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
    coverage.count_pixels(decision, 4);
    EXPECT_EQ(hits_of(coverage.bins()), (Hits{{"decision/" + name, 5}}));
  }
}

// ---- single events of SmaaCoverage --------------------------------------------------------------

using golden::morphological::SearchEnd;
using golden::morphological::TableAddress;
using enum SearchEnd;

template <class Count>
std::string counted(Count&& count) {
  SmaaCoverage coverage;
  count(coverage);
  return names_of(coverage.bins());
}

std::string counted_pixel(std::size_t axis, const TableAddress& address) {
  return counted([&](SmaaCoverage& c) { c.count_pixel(static_cast<Axis>(axis), address); });
}

TEST(SmaaCoverage, CountsShapeDistanceAndSearchLimit) {
  const std::map<int, std::string> names = {{1, "1-3"},  {3, "1-3"},   {4, "4-8"}, {8, "4-8"},
                                            {9, "9-24"}, {24, "9-24"}, {25, "25+"}};
  for (std::size_t axis = 0; axis < 2; ++axis) {
    for (int shape = 0; shape < 16; ++shape) {
      for (const auto& [distance, name] : names) {
        const std::string expected = axis_prefix("table", axis) + shape_name(shape) + '/' + name;
        EXPECT_EQ(counted_pixel(axis, {shape, distance, 0}), expected);
        EXPECT_EQ(counted_pixel(axis, {shape, distance - 1, distance}), expected);
      }
    }
    const auto search = [&](SearchEnd start, SearchEnd end) {
      return counted_pixel(axis, {0, 1, 1, start, end});
    };
    const std::string table = axis_prefix("table", axis) + "none-none/1-3";
    EXPECT_EQ(search(kWithin, kWithin), table);
    EXPECT_EQ(search(kAtLimit, kWithin), axis_prefix("search", axis) + "start/at " + table);
    EXPECT_EQ(search(kBeyond, kWithin), axis_prefix("search", axis) + "start/beyond " + table);
    EXPECT_EQ(search(kWithin, kAtLimit), axis_prefix("search", axis) + "end/at " + table);
    EXPECT_EQ(search(kWithin, kBeyond), axis_prefix("search", axis) + "end/beyond " + table);
  }
}

// U shapes read the dip tile, other shapes with a side the half tile; shapes without a side read no
// entry.
TEST(SmaaCoverage, CountsFirstAndLastTableEntry) {
  constexpr int kLast = 14 * 14;
  for (int shape = 0; shape < 16; ++shape) {
    const std::string name = shape_name(shape);
    const bool nothing =
        std::set<std::string>{"none-none", "T-none", "none-T", "T-T"}.contains(name);
    const std::string tile = name.starts_with("U-") ? "dip/" : "half/";
    for (const auto& [before, after] : {std::pair{0, 0},
                                        {0, 1},
                                        {1, 0},
                                        {kLast - 1, kLast},
                                        {kLast, kLast - 1},
                                        {kLast, kLast}}) {
      SmaaCoverage coverage;
      coverage.count_pixel(Axis::kHorizontal, {shape, before, after});
      Hits expected;
      if (before == after && !nothing)
        expected["table-entry/" + tile + (before == 0 ? "first" : "last")] = 1;
      EXPECT_EQ(hits_of(coverage.bins(), "table-entry/"), expected) << name;
    }
  }
}

TEST(SmaaCoverage, CountsDiagonalCodesEndsAndLength) {
  using golden::morphological::DiagonalEnds;
  const std::array<std::string, 4> ends = {"closed", "open-1", "open-2", "open-both"};
  for (const bool rising : {false, true}) {
    const std::string direction = rising ? "rising/" : "falling/";
    const auto diagonal = [&](const DiagonalEnds& found, bool beyond = false) {
      return counted([&](SmaaCoverage& c) { c.count_diagonal(rising, found, beyond); });
    };
    for (int e1 = 0; e1 < 4; ++e1) {
      for (int e2 = 0; e2 < 4; ++e2) {
        for (std::size_t open = 0; open < 4; ++open) {
          const DiagonalEnds found{1, 2, e1, e2, open % 2 != 0, open / 2 != 0};
          const std::string expected = "diagonal-ends/" + direction + ends[open] +
                                       " diagonal-length/" + direction + "3 diagonal/" + direction +
                                       std::to_string(e1) + '-' + std::to_string(e2);
          EXPECT_EQ(diagonal(found), expected);
          EXPECT_EQ(diagonal(found, true),
                    (rising ? "diagonal-beyond/rising " : "diagonal-beyond/falling ") + expected);
        }
      }
    }
    for (const bool beyond : {false, true}) EXPECT_EQ(diagonal({2, 0}, beyond), "");  // too short
    for (const auto& [pixels, name] : std::map<int, std::string>{{4, "4-7"}, {7, "4-7"}, {8, "8+"}})
      EXPECT_THAT(diagonal({pixels - 1, 1}),
                  testing::HasSubstr("diagonal-length/" + direction + name));
  }
}

TEST(SmaaCoverage, CountsEndlessEndsAndRepeatedCrossings) {
  struct Row {
    std::uint8_t endless;
    int shape, extent;
    const char* bin;
    RunPart part = RunPart::kWhole;
  };
  for (std::size_t axis = 0; axis < 2; ++axis) {
    for (const Row& row :
         {Row{0, 9, 40, ""}, Row{1, 8, 40, "start"}, Row{2, 1, 8, "end"}, Row{3, 0, 8, "both"},
          Row{0, 5, 8, "repeated"}, Row{0, 5, 9, ""},  // does not reach the border
          Row{0, 4, 8, "repeated", RunPart::kTail}, Row{0, 1, 8, "", RunPart::kHead}}) {
      RunDescriptor run = inner_run(axis, 5, row.shape, row.part);
      run.endless = row.endless;
      EXPECT_EQ(counted([&](SmaaCoverage& c) { c.count_descriptor(run, row.extent); }),
                *row.bin == 0 ? "" : axis_prefix("endless", axis) + row.bin);
    }
  }
}

TEST(SmaaCoverage, CountsNearerEndOfCorners) {
  struct Row {
    TableAddress address;
    int far;
    const char* bin;
  };
  for (std::size_t axis = 0; axis < 2; ++axis)
    for (const Row& row :
         {Row{{9, 2, 3}, 1, "start"}, Row{{9, 3, 3}, 1, "middle"}, Row{{9, 4, 3}, 1, "end"},
          Row{{8, 7, 3, kBeyond, kWithin}, 3, "cut"}, Row{{8, 7, 3, kBeyond, kWithin}, 7, "end"},
          Row{{1, 3, 8, kWithin, kBeyond}, 12, "cut"},
          Row{{1, 7, 8, kAtLimit, kAtLimit}, 12, "start"}})
      EXPECT_EQ(counted([&](SmaaCoverage& c) {
                  c.count_corner(static_cast<Axis>(axis), row.address, row.far);
                }),
                axis_prefix("corner", axis) + row.bin);
}

TEST(SmaaCoverage, CountsThresholdsByMode) {
  using spec::morphological::DynamicLuma;
  const std::map<DynamicLuma, std::string> names = {{DynamicLuma::kCurrent, "current"},
                                                    {DynamicLuma::kMax, "max"},
                                                    {DynamicLuma::kMin, "min"},
                                                    {DynamicLuma::kMean, "mean"}};
  for (const auto& [luma, name] : names) {
    for (const bool floor : {false, true})
      EXPECT_EQ(counted([&, luma = luma](SmaaCoverage& c) { c.count_threshold(luma, floor); }),
                "threshold/" + name + (floor ? "/floor" : "/alpha"));
  }
  SmaaCoverage fixed;
  fixed.count_fixed(7);
  fixed.count_fixed(2);
  EXPECT_EQ(hits_of(fixed.bins()), (Hits{{"threshold/fixed", 9}}));
}

// The darker pixel is black in the first pair and 150 in the second: a tenth of 0 is below the
// floor of 10 codes, a tenth of 150 is not.
TEST(SmaaCoverage, CountsThresholdOfEachEdgeInFrame) {
  using spec::morphological::AreaSource;
  using spec::morphological::DynamicLuma;
  const auto code = [](int i) { return grey(i == 0 ? 0 : i == 1 ? 150 : 220); };
  const Frame across(4, 1, [&](int x, int) { return code(x); });
  const Frame down(1, 4, [&](int, int y) { return code(y); });
  const auto hits = [](const spec::morphological::Parameters& p, const Frame& frame) {
    MorphologicalGolden golden(p);
    golden.process(frame.view());
    return hits_of(golden.smaa_coverage().bins(), "threshold/");
  };
  spec::morphological::Parameters p = preset_parameters(Preset::kSmaaDynamic);
  p.local_contrast = spec::morphological::LocalContrast::kOff;
  p.dynamic_luma = DynamicLuma::kMin;
  p.alpha = 1677721;
  p.floor = 655360;
  for (const Frame& frame : {across, down})
    EXPECT_EQ(hits(p, frame), (Hits{{"threshold/min/floor", 1}, {"threshold/min/alpha", 1}}));
  // A fixed threshold is counted only with a block of SMAA: tables or diagonals.
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

std::uint64_t sum_of(const SmaaCoverage& coverage, const std::string& group) {
  std::uint64_t sum = 0;
  for (const auto& [name, hits] : hits_of(coverage.bins(), group)) sum += hits;
  return sum;
}

// One corner of a rectangle with edges of 12 and 4 pixels: each edge reads the table, and both runs
// at the corner have a far bit.
TEST(SmaaCoverage, CountsEachEdgeAndCornerInFrame) {
  const Frame corner(24, 9, [](int x, int y) { return grey(x < 12 && y < 4 ? 230 : 20); });
  MorphologicalGolden golden(preset_parameters(Preset::kSmaa));
  golden.process(corner.view());
  EXPECT_EQ(sum_of(golden.smaa_coverage(), axis_prefix("table", 0)), 12u);
  EXPECT_EQ(sum_of(golden.smaa_coverage(), axis_prefix("table", 1)), 4u);
  EXPECT_EQ(sum_of(golden.smaa_coverage(), axis_prefix("corner", 0)), 12u);
  EXPECT_EQ(sum_of(golden.smaa_coverage(), axis_prefix("corner", 1)), 4u);
}

// Falling diagonals that end one pixel beyond the last row or column: the border repeats their last
// top edge.
TEST(SmaaCoverage, CountsDiagonalsThatContinueBeyondFrame) {
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
    EXPECT_EQ(hits_of(golden.smaa_coverage().bins(), "diagonal-beyond/"),
              (Hits{{"diagonal-beyond/falling", 5}}))
        << c.width;
  }
}

}  // namespace
}  // namespace deburr::coverage_test
