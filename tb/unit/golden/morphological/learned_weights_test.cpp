// SPDX-License-Identifier: MIT
// Learned weights and colour edges of docs/reference/morphological/learned_weights.md: worked
// examples, a reference in Python, single table entries, and combinations with other options.
#include "golden/morphological/learned_weights.h"

#include <gmock/gmock.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "golden/morphological/configuration.h"
#include "spec/error.h"
#include "spec/morphological/check_build.h"
#include "tb/base/random.h"
#include "tb/harness/test_paths.h"
#include "tb/unit/golden/morphological/support.h"

namespace deburr::learned_weights_test {
namespace {

using golden::morphological::CoverageBin;
using golden::morphological::LearnedEnds;
using golden::morphological::MorphologicalGolden;
using golden::morphological::PredictedRun;
using golden::morphological::preset_parameters;
using golden::morphological::reachable_entries;
using golden::morphological::WeightIndices;
using golden::morphological::WeightTables;
using spec::morphological::Axis;
using spec::morphological::Bypass;
using spec::morphological::Parameters;
using spec::morphological::Preset;
using spec::morphological::Rgba8;
using spec::morphological::Side;
using tb::Random;
using tb::morphological::Frame;
using tb::morphological::grey;
using tb::morphological::Hits;
using tb::morphological::hits_of;
using tb::morphological::names_of;

Parameters deburr() { return preset_parameters(Preset::kDeburr); }
Parameters without_extension() {
  Parameters p = deburr();
  p.predictor = spec::morphological::Predictor::kNone;
  return p;
}

// ---- worked examples ----------------------------------------------------------------------------

Frame worked(std::string_view picture) {
  return {16, 8, [&](int x, int y) -> Rgba8 {
            switch (picture[static_cast<std::size_t>(16 * y + x)]) {
              case '#':
                return grey(230);
              case 'r':
                return {128, 40, 70, 255};
              case 'g':
                return {10, 76, 64, 255};
              case 'o':
                return {24, 24, 30, 255};
              default:
                return grey(20);
            }
          }};
}
constexpr std::string_view kCorner =
    "................"
    "................"
    "....########...."
    "....########...."
    "....########...."
    "................"
    "................"
    "................";
constexpr std::string_view kStair =
    "................"
    "................"
    "............####"
    "........########"
    "...#############"
    "################"
    "################"
    "################";
constexpr std::string_view kMarks =
    "................"
    "..#.......##...."
    "......#....#...."
    ".....###........"
    "......#......#.."
    "..............#."
    "..##............"
    "................";
constexpr std::string_view kHues =
    "rrrrrrrrrrrrrrrr"
    "rrrrrrrrrrrrrrrr"
    "rrrrrrrrgggggggg"
    "rrrrrgggggggoooo"
    "rrggggggggggoooo"
    "gggggggggggggggg"
    "gggggggggggggggg"
    "gggggggggggggggg";

// Table indices of both pixels of the edge at `position` of `line`.
std::array<WeightIndices, 2> indices_at(const MorphologicalGolden& golden, Axis axis, int position,
                                        int line) {
  for (const PredictedRun& run : golden.runs()) {
    const auto& r = run.line.run;
    const int k = position - r.start;
    if (r.axis != axis || r.line != line || k < 0 || k >= r.length) continue;
    EXPECT_TRUE(run.line.learned);
    return {LearnedEnds(run.line, Side::kFirst).of_pixel(k),
            LearnedEnds(run.line, Side::kSecond).of_pixel(k)};
  }
  ADD_FAILURE() << "no edge at " << position << " of line " << line;
  return {};
}

struct Worked {
  std::string_view picture;
  Axis axis;
  int position, line;
  WeightIndices first, second;
};
constexpr auto kTop = Axis::kHorizontal, kLeft = Axis::kVertical;
constexpr Worked kWorked[] = {
    {kCorner, kTop, 4, 2, {645, 419, 439}, {325, 131, 151}},
    {kCorner, kTop, 7, 2, {668, 431, 435}, {348, 143, 147}},
    {kCorner, kLeft, 3, 4, {649, 421, 421}, {329, 133, 133}},
    {kStair, kTop, 12, 2, {515, 546, 14}, {259, 258, 14}},
    {kStair, kTop, 8, 3, {579, 546, 270}, {387, 258, 558}},
    {kStair, kTop, 5, 4, {594, 522, 266}, {594, 554, 234}},
    {kStair, kLeft, 4, 3, {576, 416, 128}, {576, 416, 128}},
    {kMarks, kTop, 2, 1, {640, 384, 384}, {320, 96, 96}},
    {kMarks, kTop, 6, 2, {640, 448, 448}, {320, 160, 160}},
    {kMarks, kTop, 5, 3, {576, 384, 160}, {576, 448, 96}},
    {kMarks, kTop, 13, 5, {385, 97, 389}, {577, 385, 101}},
    {kHues, kTop, 8, 2, {517, 515, 23}, {261, 227, 23}},
    {kHues, kTop, 5, 3, {578, 513, 297}, {386, 225, 585}},
};

TEST(LearnedWeights, IndicesMatchWorkedExamples) {
  for (const Worked& w : kWorked) {
    MorphologicalGolden golden(without_extension());
    const Frame frame = worked(w.picture);
    golden.process(frame.view());
    const auto [first, second] = indices_at(golden, w.axis, w.position, w.line);
    EXPECT_EQ(first, w.first) << w.position << ' ' << w.line;
    EXPECT_EQ(second, w.second) << w.position << ' ' << w.line;
  }
}

// ---- Python reference ---------------------------------------------------------------------------

Frame patches(int width, int height, Random& random) {
  std::vector<Rgba8> colours;
  for (int i = 0; i < 4; ++i)
    colours.push_back({static_cast<std::uint8_t>(random.below(256)),
                       static_cast<std::uint8_t>(random.below(256)),
                       static_cast<std::uint8_t>(random.below(256)), 255});
  const double slope = random.uniform(-1.2, 1.2), bend = random.uniform(0, 0.05);
  return {width, height, [&](int x, int y) {
            const int band = static_cast<int>(std::floor((y + slope * x + bend * x * y) / 5.0));
            std::size_t i = static_cast<std::size_t>(band & 3);
            if (random.below(40) == 0) i = random.below(4);
            Rgba8 c = colours[i];
            c[0] = static_cast<std::uint8_t>(c[0] / 2 + random.below(8));
            return c;
          }};
}

TEST(LearnedWeights, PixelsMatchPythonReference) {
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("deburr_shares_" + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  Random random(5);
  std::uint64_t blended = 0;
  for (int i = 0; i < 12; ++i) {
    Frame frame = patches(30 + i, 26, random);
    for (Rgba8& pixel : frame.pixels)
      pixel[3] = static_cast<std::uint8_t>(random.below(256) | (random.below(30) == 0 ? 0u : 1u));
    Parameters p = without_extension();
    p.bypass = Bypass::kMasked;
    if (i % 2 != 0) {
      p.steps = 0;
      p.window_rows = 12;  // runs longer than the search range
      p.search_columns = 7;
    }
    MorphologicalGolden golden(p);
    golden.process(frame.view());
    blended += golden.work().blended_pixels;
    EXPECT_EQ(golden.work().bypassed_pixels, 0u);  // masked pixels have no weight
    std::ofstream(folder / "in", std::ios::binary)
        .write(reinterpret_cast<const char*>(frame.pixels.data()),
               static_cast<std::streamsize>(4 * frame.pixels.size()));
    const std::string command =
        "/usr/bin/python3 " +
        (tb::source_folder() / "tb/unit/golden/morphological/weights_reference.py").string() + " " +
        std::to_string(frame.width) + " " + std::to_string(frame.height) + " " +
        std::to_string(p.search_columns) + " " +
        std::to_string(golden::morphological::search_rows(p)) + " " + (folder / "in").string() +
        " " + (folder / "out").string();
    ASSERT_EQ(std::system(command.c_str()), 0) << command;
    std::ifstream out(folder / "out", std::ios::binary);
    int different = 0;
    for (const Rgba8& pixel : golden.pixels()) {
      std::array<char, 3> expected{};
      ASSERT_TRUE(out.read(expected.data(), 3));
      for (std::size_t c = 0; c < 3; ++c)
        different += pixel[c] != static_cast<std::uint8_t>(expected[c]);
      EXPECT_EQ(pixel[3] & 1, 1);
    }
    EXPECT_EQ(different, 0) << "frame " << i;
  }
  std::filesystem::remove_all(folder);
  EXPECT_GT(blended, 1000u);
}

// ---- learned descriptors ------------------------------------------------------------------------

// A clean Z of 15 pixels takes learned weights, one of 16 keeps its line.
TEST(LearnedWeights, LongZRunKeepsItsLine) {
  for (const int length : {15, 16}) {
    const Frame frame(60, 9, [&](int x, int y) {
      return grey(y >= 6 || (y == 5 && x >= 20) || (y == 4 && x >= 20 + length) ? 220 : 20);
    });
    MorphologicalGolden golden(without_extension());
    golden.process(frame.view());
    int found = 0;
    for (const PredictedRun& run : golden.runs()) {
      if (run.line.run.axis != Axis::kHorizontal || run.line.run.length != length) continue;
      ++found;
      EXPECT_EQ(run.line.learned, length == 15);
      EXPECT_EQ(run.line.span, length == 15 ? 0 : 16);
      if (!run.line.learned) continue;
      spec::morphological::LineDescriptor without;
      without.run = run.line.run;
      without.learned = true;
      without.scale = 0;
      without.start_class = run.line.start_class;
      without.end_class = run.line.end_class;
      EXPECT_EQ(run.line, without);
    }
    EXPECT_EQ(found, 1);
  }
}

TEST(LearnedWeights, UseLoadedTables) {
  MorphologicalGolden golden(without_extension());
  const Frame frame = worked(kCorner);
  WeightTables tables;
  tables.of_codes.fill(0);
  tables.of_near.fill(-128);
  tables.of_far.fill(-128);
  golden.set_weight_tables(tables);
  golden.process(frame.view());
  EXPECT_EQ(golden.work().blended_pixels, 0u);  // limited to -128: a weight of 0
  tables.of_far.fill(127);
  tables.of_codes.fill(2);
  golden.set_weight_tables(tables);
  golden.process(frame.view());
  EXPECT_EQ(golden.top_weights(5, 2).first, spec::morphological::kWeightOfSum[128 + 1]);
  tables.of_near.fill(127);
  golden.set_weight_tables(tables);
  golden.process(frame.view());
  EXPECT_EQ(golden.top_weights(5, 2).first, 128);
}

TEST(LearnedWeights, GapOfLongRunReadsItsOwnEntries) {
  Parameters p = without_extension();
  p.search_columns = 6;
  MorphologicalGolden golden(p);
  const Frame frame(16, 8, [](int, int y) { return grey(y < 4 ? 20 : 220); });
  WeightTables tables;
  tables.of_codes.fill(-128);
  tables.of_codes[63] = -20;
  tables.of_near.fill(0);
  tables.of_far.fill(0);
  tables.of_near[31] = 6;
  tables.of_far[31] = 7;
  golden.set_weight_tables(tables);
  golden.process(frame.view());
  for (int x = 0; x < 16; ++x) {
    const int expected = x >= 3 && x < 13 ? spec::morphological::kWeightOfSum[128 - 7] : 0;
    EXPECT_EQ(golden.top_weights(x, 4).first, expected) << x;
    EXPECT_EQ(golden.top_weights(x, 4).second, expected) << x;
  }
}

// An end that nothing crosses, or that is crossed on both sides, has class 0.
TEST(LearnedWeights, ClassIsZeroUnlessCrossedOnce) {
  using golden::morphological::AxisEdges;
  using golden::morphological::crossing_class;
  golden::morphological::EdgePlanes edges{golden::morphological::BitPlane(9, 9),
                                          golden::morphological::BitPlane(9, 9)};
  for (int x = 2; x < 6; ++x) edges.top.set(x, 4);
  spec::morphological::RunDescriptor run;
  run.line = 4, run.start = 2, run.length = 4;
  for (const bool both : {false, true}) {
    if (both)
      for (const int x : {2, 6})
        for (const int y : {2, 3, 4, 5}) edges.left.set(x, y);
    run.shape = both ? 15 : 0;
    for (const bool at_end : {false, true})
      EXPECT_EQ(crossing_class(AxisEdges::horizontal(edges), run, at_end, 20), 0);
  }
}

// ---- rejections, tables, coverage ---------------------------------------------------------------

TEST(LearnedWeights, RejectsIncompatibleOptions) {
  const auto rejected = [](auto&& change) {
    Parameters p = deburr();
    change(p);
    EXPECT_THROW(check_build(p), spec::ConfigError);
  };
  rejected([](Parameters& p) { p.threshold_mode = spec::morphological::ThresholdMode::kDynamic; });
  rejected([](Parameters& p) { p.diagonals = true; });
  rejected([](Parameters& p) { p.round_corners = true; });
  Parameters p = deburr();
  p.ends = spec::morphological::Ends::kCrossings;
  p.blend = spec::morphological::BlendRule::kStrongest;
  EXPECT_NO_THROW(check_build(p));
}

TEST(LearnedWeights, WeightOfSumMatchesFormula) {
  for (int z = -128; z < 128; ++z) {
    const int weight =
        std::min(128, static_cast<int>(std::floor(256 / (1 + std::exp(-z / 16.0)) + 0.5)));
    EXPECT_EQ(spec::morphological::kWeightOfSum[static_cast<std::size_t>(z + 128)],
              weight < 4 ? 0 : weight);
  }
}

TEST(LearnedWeights, ShippedTablesMatchChecksum) {
  const WeightTables tables;
  std::uint32_t sum = 0, index = 0;
  const auto add = [&](const auto& table) {
    for (const std::int8_t v : table) sum += ++index * static_cast<std::uint8_t>(v);
  };
  add(tables.of_codes);
  add(tables.of_near);
  add(tables.of_far);
  EXPECT_EQ(index, 2304u);
  EXPECT_EQ(sum, spec::morphological::kWeightsSum);
}

// Numbers of reachable entries: docs/reference/morphological/learned_weights.md, "Indices".
TEST(LearnedCoverage, HitsEveryReachableEntry) {
  const auto& reachable = reachable_entries();
  const auto count = [](const auto& flags) { return std::count(flags.begin(), flags.end(), true); };
  EXPECT_EQ(count(reachable.of_codes), 532);
  EXPECT_EQ(count(reachable.of_near), 300);
  EXPECT_EQ(count(reachable.of_far), 220);
  Random random(17);
  MorphologicalGolden wide(without_extension());
  Parameters small = without_extension();
  small.steps = 0;
  small.window_rows = 12;
  small.search_columns = 9;
  MorphologicalGolden narrow(small);
  std::set<std::string> holes;
  for (int round = 0; round < 400; ++round) {
    const Frame bands = tb::stimuli::bands(random.between(2, 90), 120, random);
    const Frame patchy = patches(120, 90, random);
    for (MorphologicalGolden* golden : {&wide, &narrow}) {
      golden->process(bands.view());
      golden->process(patchy.view());
      golden->process(Frame(tb::morphological::transposed(bands)).view());
    }
    if (round % 20 != 19) continue;
    std::map<std::string, std::uint64_t> hits;
    for (const MorphologicalGolden* golden : {&wide, &narrow})
      for (const CoverageBin& bin : golden->learned_coverage().bins()) hits[bin.name] += bin.hits;
    holes.clear();
    for (const auto& [name, n] : hits)
      if (n == 0) holes.insert(name);
    if (holes.empty()) break;
  }
  EXPECT_THAT(holes, testing::IsEmpty());
}

TEST(LearnedCoverage, StaysEmptyWithoutLearnedWeights) {
  MorphologicalGolden golden(preset_parameters(Preset::kDeburrLine));
  golden.process(Frame(tb::morphological::noise_image()).view());
  for (const CoverageBin& bin : golden.learned_coverage().bins())
    EXPECT_EQ(bin.hits, 0u) << bin.name;
}

// A whole run has a class at both ends, a head only at its start, a tail only at its end.
TEST(LearnedCoverage, CountsClassesOfDescriptorEnds) {
  using spec::morphological::RunPart;
  const auto classes = [](Axis axis, RunPart part, int start, int end) {
    golden::morphological::LearnedCoverage coverage;
    spec::morphological::LineDescriptor descriptor;
    descriptor.run.axis = axis;
    descriptor.run.part = part;
    descriptor.start_class = static_cast<std::uint8_t>(start);
    descriptor.end_class = static_cast<std::uint8_t>(end);
    coverage.count_descriptor(descriptor);
    return names_of(coverage.bins());
  };
  for (const Axis axis : {Axis::kHorizontal, Axis::kVertical}) {
    const std::string group = axis == Axis::kHorizontal ? "class/horizontal/" : "class/vertical/";
    for (int start = 0; start < 9; ++start) {
      for (int end = 0; end < 9; ++end) {
        const std::string first = group + "start/" + std::to_string(start),
                          last = group + "end/" + std::to_string(end);
        EXPECT_EQ(classes(axis, RunPart::kWhole, start, end), last + ' ' + first);
        EXPECT_EQ(classes(axis, RunPart::kHead, start, end), first);
        EXPECT_EQ(classes(axis, RunPart::kTail, start, end), last);
      }
    }
  }
}

TEST(LearnedCoverage, CountsEntriesOfEachWeight) {
  golden::morphological::LearnedCoverage coverage;
  EXPECT_EQ(coverage.bins().size(), 532u + 300 + 220 + 2 * 2 * 9);
  coverage.count_weight({645, 419, 439});  // frame `corner` of the page
  coverage.count_weight({645, 419, 439});
  coverage.count_weight({325, 131, 151});
  EXPECT_EQ(
      hits_of(coverage.bins()),
      (Hits{{"A/645", 2}, {"B/419", 2}, {"C/439", 2}, {"A/325", 1}, {"B/131", 1}, {"C/151", 1}}));
}

// All edges in the gap of a long run have one weight; a run as long as the search range has no gap.
TEST(LearnedCoverage, CountsGapOfLongRunOnce) {
  for (const int length : {6, 7, 8, 15}) {
    Parameters p = without_extension();
    p.search_columns = 6;
    MorphologicalGolden golden(p);
    golden.process(Frame(length, 8, [](int, int y) { return grey(y < 4 ? 20 : 220); }).view());
    EXPECT_EQ(golden.work().long_runs, length > 6 ? 1u : 0u);
    EXPECT_EQ(hits_of(golden.learned_coverage().bins())["A/63"], golden.work().long_runs);
  }
}

}  // namespace
}  // namespace deburr::learned_weights_test
