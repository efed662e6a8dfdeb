// SPDX-License-Identifier: MIT
// Functional coverage of the morphological engine over frames that run through the hardware model:
// shapes x orientation x length, predictions by side, outcome, length and end, ends of long runs,
// frame borders, decisions of the blender; SMAA's units: shapes x distances, limits, table entries,
// diagonals, thresholds; and bypass marks. Every bin must be hit, with every frame identical to
// golden, including runs and lines.
#include "tb/engines/morphological/morphological_coverage.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <span>
#include <string>
#include <string_view>

#include "tb/base/forked.h"
#include "tb/stimuli/frames.h"
#include "tb/system/coverage_text.h"
#include "tb/system/morphological_runs.h"

namespace deburr::tb::morphological_system::morphological_coverage_test {
namespace {

using golden::morphological::MorphologicalGolden;

MorphologicalInput transposed(const MorphologicalInput& f) {
  return draw(f.image.height, f.image.width, [&](int x, int y) { return f.image.at(y, x); });
}

// Greys that are sometimes too similar for an edge, so that crossings are missing.
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
  spec::morphological::Parameters p = preset(Preset::kDeburrLine);
  p.window_rows = 258;
  p.line_pixels = 512;
  return p;
}
spec::morphological::Parameters narrow() {
  spec::morphological::Parameters p = preset(Preset::kMlaaSlope);
  p.window_rows = 50;
  p.search_columns = 24;
  p.line_pixels = 512;
  return p;
}

// The bins of some groups; together the groups cover every bin (EveryBinBelongsToOneGroup).
using Groups = std::span<const std::string_view>;
constexpr std::string_view kRuns[] = {"shape",          "long-end", "prediction",
                                      "prediction-end", "border",   "decision"};
constexpr std::string_view kSmaa[] = {
    "table",    "table-entry",   "search",          "endless",         "corner",
    "diagonal", "diagonal-ends", "diagonal-length", "diagonal-beyond", "threshold"};
constexpr std::string_view kBypass[] = {"bypass", "bypass-border", "half"};
constexpr std::string_view kWeights[] = {"class"};
constexpr std::string_view kText[] = {"text", "text-border"};

Coverage part_of(const Coverage& all, Groups groups) {
  Coverage part;
  for (const auto& [bin, hits] : all.bins())
    for (const std::string_view group : groups)
      if (bin.starts_with("morphological/" + std::string(group) + "/")) {
        part.declare(bin);
        part.hit(bin, hits);
      }
  return part;
}

Coverage declared() { return morphological_coverage(MorphologicalGolden({})); }

// Whether golden hits a new bin in this frame.
bool tells(MorphologicalGolden& golden, Groups groups, const MorphologicalInput& frame,
           std::set<std::string>& met) {
  golden.clear_coverage();
  golden.process({frame.image.pixels, frame.image.width, frame.image.height});
  bool news = false;
  const Coverage now = part_of(morphological_coverage(golden), groups);
  for (const auto& [bin, hits] : now.bins())
    if (hits > 0) news |= met.insert(bin).second;
  return news;
}

// Adds frames, with golden only, until no bin is empty; keeps those that hit a new bin.
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
    if (tells(golden, kRuns, frame, met)) kept.push_back(std::move(frame));
  }
  return kept;
}

// Coverage of the frames in the hardware model, each identical to golden.
void run(Coverage& coverage, const spec::morphological::Parameters& parameters,
         const std::vector<MorphologicalInput>& frames) {
  add_text(coverage, forked_text([&] {
             MorphologicalRunOptions options;
             options.morphological = parameters;
             options.descriptors = true;
             Simulation simulation(options);
             MorphologicalEnvironment environment(simulation, frames, options);
             simulation.elaborate(environment);
             simulation.run();
             environment.check();
             return text_of(environment.coverage());
           }));
}

TEST(MorphologicalCoverage, EveryBinBelongsToOneGroup) {
  std::size_t bins = 0;
  for (const Groups groups :
       {Groups(kRuns), Groups(kSmaa), Groups(kBypass), Groups(kWeights), Groups(kText)})
    bins += part_of(declared(), groups).size();
  EXPECT_EQ(bins, declared().size());
}

TEST(MorphologicalCoverage, EveryBinIsHit) {
  Coverage all = declared();
  for (const auto& parameters : {wide(), narrow()})
    run(all, parameters, telling_frames(parameters));
  const Coverage coverage = part_of(all, kRuns);
  EXPECT_GT(coverage.size(), 200u);
  EXPECT_TRUE(coverage.holes().empty()) << testing::PrintToString(coverage.holes());
}

TEST(MorphologicalCoverage, MissedBinIsReported) {
  Coverage coverage = declared();
  run(coverage, wide(), {flat(8, 8, 3)});
  EXPECT_EQ(coverage.size() - coverage.holes().size(), 1u);  // decision/none
  EXPECT_THROW(coverage.hit("morphological/shape/diagonal"), spec::CheckFailed);
}

// ---- SMAA's units ------------------------------------------------------------------------------

// A stair of one-pixel steps across the frame, in either direction.
MorphologicalInput stair(int size, bool rises) {
  return draw(size, size,
              [&](int x, int y) { return grey((rises ? x + y >= size : y > x) ? 230 : 20); });
}

struct SmaaCase {
  const char* name;
  spec::morphological::Parameters parameters;
};

std::vector<SmaaCase> smaa_cases() {
  using spec::morphological::DynamicLuma;
  using spec::morphological::Quality;
  std::vector<SmaaCase> cases;
  const auto add_case = [&](const char* name, spec::morphological::Parameters p) {
    p.line_pixels = 512;
    cases.push_back({name, p});
  };
  for (const Quality q : {Quality::kLow, Quality::kUltra}) {
    spec::morphological::Parameters p = quality(Preset::kSmaa, q);
    p.local_contrast = spec::morphological::LocalContrast::kOff;
    add_case(q == Quality::kLow ? "low" : "ultra", p);
    if (q == Quality::kLow) continue;
    // Runs that end at the border have ends without crossings at every distance.
    p.border = spec::morphological::Border::kEnd;
    add_case("ultra, ending at the border", p);
  }
  for (const auto luma :
       {DynamicLuma::kCurrent, DynamicLuma::kMax, DynamicLuma::kMin, DynamicLuma::kMean}) {
    spec::morphological::Parameters p = preset(Preset::kSmaaDynamic);
    p.dynamic_luma = luma;
    add_case("dynamic", p);
  }
  // Long enough for the last entries of the table.
  spec::morphological::Parameters far = preset(Preset::kSmaa);
  far.search_steps = 112;
  far.search_columns = 1000;
  add_case("far", far);
  return cases;
}

std::vector<MorphologicalInput> smaa_frames(Random& random, int round) {
  if (round == 0) {
    // Starts with runs whose middle is far from both ends.
    return {{stimuli::long_step(420), {}},
            {stimuli::long_bar(420), {}},
            stair(60, true),
            stair(60, false),
            MorphologicalInput{stimuli::shades_image(90, 80), {}},
            rectangles(random)};
  }
  std::vector<MorphologicalInput> frames = {noise(120, 120, random.next())};
  for (const int width : {1, 2, 3, 6, 15, 40, 160}) {
    frames.push_back({stimuli::bands(width, 150, random), {}});
    frames.push_back(transposed(frames.back()));
  }
  return frames;
}

// For each case, the frames that hit new bins, with golden only.
std::vector<std::vector<MorphologicalInput>> telling_smaa_frames(
    const std::vector<SmaaCase>& cases) {
  const std::size_t bins = part_of(declared(), kSmaa).size();
  Random random(11);
  std::vector<MorphologicalGolden> goldens;
  for (const SmaaCase& each : cases) goldens.emplace_back(each.parameters);
  std::vector<std::vector<MorphologicalInput>> kept(cases.size());
  std::set<std::string> met;
  for (int round = 0; round < 40 && met.size() < bins; ++round)
    for (const MorphologicalInput& frame : smaa_frames(random, round))
      for (std::size_t i = 0; i < cases.size(); ++i)
        if (tells(goldens[i], kSmaa, frame, met)) kept[i].push_back(frame);
  return kept;
}

TEST(SmaaCoverage, EveryBinIsHit) {
  const std::vector<SmaaCase> cases = smaa_cases();
  const auto frames = telling_smaa_frames(cases);
  Coverage all = declared();
  for (std::size_t i = 0; i < cases.size(); ++i) {
    EXPECT_FALSE(frames[i].empty()) << cases[i].name << ' ' << i << " tells nothing";
    run(all, cases[i].parameters, frames[i]);
  }
  const Coverage coverage = part_of(all, kSmaa);
  // Shapes x distances of both axes, limits, borders, corners, table entries, both directions of
  // diagonals, thresholds.
  EXPECT_EQ(coverage.size(),
            2u * 16 * 5 + 2 * 2 * 2 + 2 * (4 + 4) + 2 * 2 + 2 * (16 + 4 + 3 + 1) + 1 + 4 * 2);
  EXPECT_TRUE(coverage.holes().empty()) << testing::PrintToString(coverage.holes());
}

// ---- bypass marks ------------------------------------------------------------------------------

// Random marks, also of border pixels. Lines have the smallest weights.
std::vector<MorphologicalInput> marked_frames() {
  Random random(13);
  std::vector<MorphologicalInput> frames;
  for (int i = 0; i < 24; ++i) {
    frames.push_back(i % 3 == 0   ? noise(60, 40, random.next())
                     : i % 3 == 1 ? rectangles(random)
                                  : line(random, i % 2 == 0));
    for (Rgba8& pixel : frames.back().image.pixels)
      pixel[3] = static_cast<std::uint8_t>(random.word() << 1 | (random.chance(200) ? 0 : 1));
  }
  return frames;
}

TEST(BypassCoverage, EveryBinIsHit) {
  using spec::morphological::Bypass;
  Coverage all = declared();
  for (const Bypass bypass : {Bypass::kMarked, Bypass::kBeside, Bypass::kHalf}) {
    spec::morphological::Parameters p = preset(Preset::kDeburrLine);
    p.line_pixels = 512;
    p.bypass = bypass;
    run(all, p, marked_frames());
  }
  const Coverage coverage = part_of(all, kBypass);
  EXPECT_EQ(coverage.size(), 2u + 6 + 4 * 2 + 5);
  EXPECT_TRUE(coverage.holes().empty()) << testing::PrintToString(coverage.holes());
}

TEST(BypassCoverage, DisabledBypassHitsNothing) {
  Coverage all = declared();
  run(all, narrow(), marked_frames());
  const Coverage coverage = part_of(all, kBypass);
  EXPECT_EQ(coverage.holes().size(), coverage.size());
}

// ---- the text guard -----------------------------------------------------------------------------

// With random marks as well, since a pixel can be bypassed for both reasons.
TEST(TextCoverage, EveryBinIsHit) {
  Random random(19);
  std::vector<MorphologicalInput> frames = {
      {stimuli::text_image(), {}}, {stimuli::transposed(stimuli::text_image()), {}}, flat(9, 9, 3)};
  for (int i = 0; i < 12; ++i) {
    const auto bar = [&] { return static_cast<int>(1 + random.below(5)); };
    MorphologicalInput frame = flat(50, 40, 200);
    for (int k = 0; k < 70; ++k) {
      const int w = bar(), h = bar(), x0 = static_cast<int>(random.below(50)),
                y0 = static_cast<int>(random.below(40));
      for (int y = y0; y < std::min(40, y0 + h); ++y)
        for (int x = x0; x < std::min(50, x0 + w); ++x) frame.image.at(x, y) = grey(20);
    }
    frames.push_back(std::move(frame));
  }
  for (MorphologicalInput& frame : frames)
    for (Rgba8& pixel : frame.image.pixels) pixel[3] = random.chance(100) ? 254 : 255;
  Coverage all = declared();
  spec::morphological::Parameters p = preset(Preset::kDeburr);
  p.line_pixels = 512;
  p.bypass = spec::morphological::Bypass::kMarked;
  p.text_guard = true;
  run(all, p, frames);
  const Coverage coverage = part_of(all, kText);
  EXPECT_EQ(coverage.size(), 6u + 6 + 2 + 4);
  EXPECT_TRUE(coverage.holes().empty()) << testing::PrintToString(coverage.holes());
}

TEST(TextCoverage, DisabledTextGuardHitsNothing) {
  Coverage all = declared();
  run(all, preset(Preset::kDeburr), {{stimuli::text_image(), {}}});
  const Coverage coverage = part_of(all, kText);
  EXPECT_EQ(coverage.holes().size(), coverage.size());
}

// ---- learned weights
// -----------------------------------------------------------------------------

TEST(WeightsCoverage, EveryClassIsHit) {
  Coverage all = declared();
  Random random(17);
  std::vector<MorphologicalInput> frames;
  for (int i = 0; i < 60; ++i)
    frames.push_back(i % 4 == 0   ? rectangles(random)
                     : i % 4 == 1 ? line(random, false)
                     : i % 4 == 2 ? line(random, true)
                                  : disc(random));
  spec::morphological::Parameters p = preset(Preset::kDeburr);
  p.line_pixels = 512;
  run(all, p, frames);
  const Coverage coverage = part_of(all, kWeights);
  EXPECT_EQ(coverage.size(), 2u * 2 * 9);
  EXPECT_TRUE(coverage.holes().empty()) << testing::PrintToString(coverage.holes());
}

// Missed bins are listed by name: all bins for a flat frame, all but a few for one stair.
TEST(SmaaCoverage, MissedBinsAreListed) {
  Coverage flat_alone = declared();
  run(flat_alone, smaa_cases()[0].parameters, {flat(9, 9, 3)});
  flat_alone = part_of(flat_alone, kSmaa);
  EXPECT_EQ(flat_alone.holes().size(), flat_alone.size());

  Coverage rising = declared();
  run(rising, preset(Preset::kSmaa), {stair(40, true)});
  rising = part_of(rising, kSmaa);
  std::set<std::string> hit;
  for (const auto& [bin, hits] : rising.bins()) hit.insert(bin);
  for (const std::string& hole : rising.holes()) hit.erase(hole);
  EXPECT_TRUE(hit.contains("morphological/diagonal/rising/0-0"));
  EXPECT_TRUE(hit.contains("morphological/diagonal-ends/rising/open-both"));
  EXPECT_TRUE(hit.contains("morphological/threshold/fixed"));
  for (const std::string& bin : hit) {
    EXPECT_EQ(bin.find("falling"), std::string::npos) << bin;
    EXPECT_FALSE(bin.starts_with("morphological/threshold/m")) << bin;
  }
  const std::vector<std::string> holes = rising.holes();
  EXPECT_EQ(std::count(holes.begin(), holes.end(), "morphological/diagonal/falling/0-0"), 1);
}

TEST(SmaaCoverage, HitBinsAreDeclared) {
  Coverage coverage = declared();
  EXPECT_EQ(coverage.holes().size(), coverage.size());
  EXPECT_THROW(add_text(coverage, "morphological/diagonal/level/0-0 1"), spec::CheckFailed);
}

}  // namespace
}  // namespace deburr::tb::morphological_system::morphological_coverage_test
