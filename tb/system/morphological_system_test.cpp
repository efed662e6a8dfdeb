// SPDX-License-Identifier: MIT
// Whole frames through the hardware model of the morphological engine: every pixel, probe, run,
// line, counter and memory line equal to the golden model, for every preset, and the cycles
// documented in docs/reference/morphological/hardware.md.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <iterator>
#include <string>
#include <tuple>

#include "tb/base/forked.h"
#include "tb/harness/test_paths.h"
#include "tb/system/morphological_runs.h"

namespace deburr::tb::morphological_system::morphological_system_test {
namespace {

using Frames = std::vector<MorphologicalInput>;

std::uint64_t pixels_of(const Frames& frames) {
  std::uint64_t pixels = 0;
  for (const MorphologicalInput& frame : frames) pixels += frame.image.pixels.size();
  return pixels;
}

// Everything was delivered and compared: the pixel and the probe of every pixel.
MorphologicalOutcome expect_identical(const Frames& frames,
                                      const MorphologicalRunOptions& options) {
  const MorphologicalOutcome outcome = simulate(frames, options);
  EXPECT_EQ(outcome.mismatches, 0u);
  EXPECT_EQ(outcome.traffic_mismatches, 0u);
  EXPECT_EQ(outcome.pixels, pixels_of(frames));
  EXPECT_GE(outcome.comparisons, 2 * pixels_of(frames));
  if (options.morphological.storage == spec::morphological::Storage::kMemory) {
    std::uint64_t lines = 0;
    for (const MorphologicalInput& frame : frames)
      lines += static_cast<std::uint64_t>((4 * frame.image.width + 63) / 64) *
               static_cast<std::uint64_t>(frame.image.height);
    EXPECT_EQ(outcome.traffic_comparisons, 2 * lines);
  }
  return outcome;
}

template <class Tuple>
std::string name_of(const testing::TestParamInfo<Tuple>& info) {
  std::string name{
      spec::morphological::kPresetNames[static_cast<std::size_t>(std::get<0>(info.param))]};
  std::replace(name.begin(), name.end(), '-', '_');
  return fmt::format("{}_{}", name, info.index);
}

// ---- frames of full size ------------------------------------------------------------------------

using Size = std::tuple<Preset, std::pair<int, int>>;
class RenderedFrame : public testing::TestWithParam<Size> {};

TEST_P(RenderedFrame, FramesMatchGolden) {
  const auto [which, size] = GetParam();
  MorphologicalRunOptions options;
  options.morphological = preset(which);
  options.check_links = false;  // covered by smaller frames; here they would double the run time
  const Frames frames = {rendered("road", size.first, size.second)};
  const MorphologicalOutcome outcome = expect_identical(frames, options);
  // No stalls: the frame takes the cycles of the formula, and every pixel the same time.
  EXPECT_EQ(outcome.frame_cycles,
            frame_cycles_by_formula(options.morphological, size.first, size.second));
  EXPECT_EQ(outcome.latency_min, latency_by_formula(options.morphological, size.first));
  EXPECT_EQ(outcome.latency_max, outcome.latency_min);
  EXPECT_GT(outcome.edge_pixels, outcome.pixels / 1000);
}

INSTANTIATE_TEST_SUITE_P(Morphological, RenderedFrame,
                         testing::Combine(testing::ValuesIn(kBuilt),
                                          testing::Values(std::pair{1280, 720},
                                                          std::pair{1920, 1080})),
                         name_of<Size>);

// Hashes are compared with those of the same model on other machines, so only this test detects a
// channel that the hash omits.
TEST(Morphological, HashCoversEveryChannelAndProbeOfEveryPixel) {
  const Frames frames = {blocks(40, 30)};
  MorphologicalRunOptions options;
  options.morphological = preset(Preset::kDeburr);
  Simulation simulation(options);
  MorphologicalEnvironment environment(simulation, frames, options);
  simulation.elaborate(environment);
  simulation.run();
  environment.check();
  OutputHash hash;
  for (std::size_t i = 0; i < environment.probes().size(); ++i) {
    const Rgba8& p = environment.frame().pixels[i];
    const spec::morphological::BlendProbe& t = environment.probes()[i];
    const int bytes[] = {p[0], p[1], p[2], p[3], t.first, t.second, t.edges, t.horizontal};
    std::uint64_t word = 0;
    for (std::size_t n = std::size(bytes); n-- > 0;)
      word = word * 256 + static_cast<std::uint64_t>(bytes[n]);
    hash.add(word);
  }
  EXPECT_EQ(environment.probes().size(), pixels_of(frames));
  EXPECT_EQ(environment.pixel_hash(), hash.value());
}

TEST(Morphological, FullHdAt60FramesFitsIn148MHz) {
  const Parameters p;
  EXPECT_EQ(frame_cycles_by_formula(p, 1920, 1080), 2144663u);
  EXPECT_LT(60e-6 * static_cast<double>(frame_cycles_by_formula(p, 1920, 1080)), 148.5);
  const Parameters four = preset(Preset::kDeburr, spec::morphological::Lanes::kFour);
  EXPECT_LT(60e-6 * static_cast<double>(frame_cycles_by_formula(four, 3840, 2160)), 148.5);
}

// ---- external frames ---------------------------------------------------------------------------

using Named = std::tuple<Preset, const char*>;
class DataFrame : public testing::TestWithParam<Named> {};

TEST_P(DataFrame, FramesMatchGolden) {
  const auto [which, name] = GetParam();
  const std::filesystem::path file = data_folder() / "frames" / name;
  if (!std::filesystem::exists(file))
    GTEST_SKIP() << "no " << file << ": set DEBURR_DATA to the folder that holds frames/";
  FrameParameters p;
  p.source = file.string();
  MorphologicalRunOptions options;
  options.morphological = preset(which);
  options.check_links = false;
  expect_identical({load_frame(p, 1).input}, options);
}

INSTANTIATE_TEST_SUITE_P(Morphological, DataFrame,
                         testing::Values(std::tuple{Preset::kMlaa, "track_720p_noaa.png"},
                                         std::tuple{Preset::kMlaaSlope, "track_720p_noaa.png"},
                                         std::tuple{Preset::kDeburrLine, "track_720p_noaa.png"},
                                         std::tuple{Preset::kDeburr, "track_720p_noaa.png"},
                                         std::tuple{Preset::kDeburr, "track_1080p_noaa.png"}),
                         name_of<Named>);

// ---- synthetic frames: presets x lanes x storage ------------------------------------------------

using Variant = std::tuple<Preset, spec::morphological::Lanes, spec::morphological::Storage>;
class EveryVariant : public testing::TestWithParam<Variant> {
 protected:
  MorphologicalRunOptions options() const {
    const auto [which, lanes, storage] = GetParam();
    MorphologicalRunOptions o;
    o.morphological = preset(which, lanes);
    o.morphological.storage = storage;
    o.morphological.line_pixels = 1024;
    o.memory.latency = 40;
    o.descriptors = true;
    return o;
  }
};

TEST_P(EveryVariant, FansOfLinesAreIdenticalToGolden) {
  expect_identical({fans(48, 1), fans(37, 2)}, options());
}

TEST_P(EveryVariant, NoiseAndChecksAreIdenticalToGolden) {
  expect_identical({noise(131, 77), checkerboard(64, 50), noise(16, 90, 3), blocks(150, 120, 4)},
                   options());
}

TEST_P(EveryVariant, OddSizesAreIdenticalToGolden) {
  expect_identical({noise(1, 1), noise(1, 70), noise(300, 1), flat(1, 1, 9), noise(2, 2),
                    noise(3, 80, 5), blocks(5, 100, 6), blocks(100, 5, 7), flat(40, 40, 0),
                    flat(17, 9, 255), noise(1, 2), noise(2, 1), checkerboard(7, 7)},
                   options());
}

INSTANTIATE_TEST_SUITE_P(
    Morphological, EveryVariant,
    testing::Combine(testing::ValuesIn(kBuilt),
                     testing::Values(spec::morphological::Lanes::kOne,
                                     spec::morphological::Lanes::kTwo,
                                     spec::morphological::Lanes::kFour),
                     testing::Values(spec::morphological::Storage::kLineBuffers,
                                     spec::morphological::Storage::kMemory)),
    name_of<Variant>);

// ---- the widest and the highest frame -----------------------------------------------------------

using Stored = std::tuple<Preset, spec::morphological::Storage>;
class Widest : public testing::TestWithParam<Stored> {};

TEST_P(Widest, FramesMatchGolden) {
  const auto [which, storage] = GetParam();
  MorphologicalRunOptions options;
  options.morphological = preset(which, spec::morphological::Lanes::kFour);
  options.morphological.storage = storage;
  options.descriptors = true;
  expect_identical({noise(8192, 3), blocks(8192, 9)}, options);
}

INSTANTIATE_TEST_SUITE_P(
    Morphological, Widest,
    testing::Combine(testing::ValuesIn(kBuilt),
                     testing::Values(spec::morphological::Storage::kLineBuffers,
                                     spec::morphological::Storage::kMemory)),
    name_of<Stored>);

TEST(Morphological, HighestFrameIsIdenticalToGolden) {
  MorphologicalRunOptions options;
  options.morphological.line_pixels = 64;
  options.descriptors = true;
  expect_identical({noise(2, 8192), blocks(11, 8192, 2)}, options);
}

// ---- every option of edges, predictor and light -------------------------------------------------

using Rule = std::tuple<int, int>;
class EveryOption : public testing::TestWithParam<Rule> {};

TEST_P(EveryOption, FramesMatchGolden) {
  const auto [edges, line] = GetParam();
  MorphologicalRunOptions options;
  Parameters& p = options.morphological;
  constexpr spec::morphological::EdgeSource kSources[] = {
      spec::morphological::EdgeSource::kLuma,       spec::morphological::EdgeSource::kDepth,
      spec::morphological::EdgeSource::kPredicated, spec::morphological::EdgeSource::kLuma,
      spec::morphological::EdgeSource::kLuma,       spec::morphological::EdgeSource::kColour};
  p.edge_source = kSources[edges];
  p.area = (edges + line) % 2 != 0 ? spec::morphological::AreaSource::kLearned
                                   : spec::morphological::AreaSource::kAnalytic;
  p.threshold_mode = edges == 3 || edges == 4 ? spec::morphological::ThresholdMode::kDynamic
                                              : spec::morphological::ThresholdMode::kFixed;
  p.dynamic_luma = edges == 3 ? spec::morphological::DynamicLuma::kCurrent
                              : spec::morphological::DynamicLuma::kMax;
  p.local_contrast = static_cast<spec::morphological::LocalContrast>((edges + line) % 3);
  p.predictor = static_cast<spec::morphological::Predictor>(line % 3);
  p.steps = std::array<std::int32_t, 6>{0, 3, 16, 16, 1, 8}[static_cast<std::size_t>(line)];
  p.contiguous = line % 2 == 1;
  p.safe = line >= 3;
  p.linear_light = line != 2;
  p.window_rows = line == 1 ? 10 : 2 * p.steps + 4 + (line == 5 ? 200 : 30);
  p.search_columns = line == 1 ? 4 : 60 + 100 * line;
  p.line_pixels = 400;
  options.descriptors = true;
  if (p.window_rows > 258) p.window_rows = 258;
  expect_identical(
      {blocks(170, 140, static_cast<std::uint64_t>(edges + 1)), fans(20), noise(60, 60)}, options);
}

INSTANTIATE_TEST_SUITE_P(Morphological, EveryOption,
                         testing::Combine(testing::Range(0, 6), testing::Range(0, 6)));

// ---- SMAA: qualities, and its units mixed with those of other presets
// ----------------------------

using Qualities = std::tuple<Preset, spec::morphological::Quality, spec::morphological::Lanes>;
class EveryQuality : public testing::TestWithParam<Qualities> {};

TEST_P(EveryQuality, FramesMatchGolden) {
  const auto [which, how, lanes] = GetParam();
  MorphologicalRunOptions options;
  options.morphological = quality(which, how);
  options.morphological.lanes = lanes;
  options.morphological.line_pixels = 1024;
  options.descriptors = true;
  expect_identical({fans(40, 3), noise(131, 77), blocks(150, 120, 4), noise(5, 90, 3)}, options);
}

INSTANTIATE_TEST_SUITE_P(Morphological, EveryQuality,
                         testing::Combine(testing::Values(Preset::kSmaa, Preset::kSmaaDynamic),
                                          testing::Values(spec::morphological::Quality::kLow,
                                                          spec::morphological::Quality::kMedium,
                                                          spec::morphological::Quality::kHigh,
                                                          spec::morphological::Quality::kUltra),
                                          testing::Values(spec::morphological::Lanes::kOne,
                                                          spec::morphological::Lanes::kTwo,
                                                          spec::morphological::Lanes::kFour)),
                         name_of<Qualities>);

class EveryMix : public testing::TestWithParam<int> {};

// Each option is drawn at random.
TEST_P(EveryMix, FramesMatchGolden) {
  Random random(static_cast<std::uint64_t>(GetParam()) + 11);
  const auto below = [&](int n) {
    return static_cast<int>(random.below(static_cast<std::uint32_t>(n)));
  };
  MorphologicalRunOptions options;
  Parameters& p = options.morphological;
  const auto lanes = static_cast<spec::morphological::Lanes>(below(3));
  p = preset(kBuilt[below(6)], lanes);
  p.threshold_mode = static_cast<spec::morphological::ThresholdMode>(below(2));
  p.dynamic_luma = static_cast<spec::morphological::DynamicLuma>(below(4));
  p.floor = 1 + below(255 * 900);
  p.local_contrast = static_cast<spec::morphological::LocalContrast>(below(4));
  p.ends = static_cast<spec::morphological::Ends>(below(2));
  p.predictor = static_cast<spec::morphological::Predictor>(below(3));
  p.area = static_cast<spec::morphological::AreaSource>(below(5));
  p.search_steps = 1 + below(below(2) ? 112 : 6);
  p.diagonals = below(3) != 0;
  p.diagonal_steps = 1 + below(16);
  p.round_corners = below(3) != 0;
  p.corner_rounding = below(257);
  p.blend = static_cast<spec::morphological::BlendRule>(below(2));
  p.linear_light = below(2) != 0;
  p.steps = below(9);
  p.window_rows =
      2 * (std::max({p.steps + 1, p.diagonals ? p.diagonal_steps : 0, 4}) + 1) + 2 * below(12);
  p.search_columns = 4 + below(80);
  p.line_pixels = 400;
  p.storage = static_cast<spec::morphological::Storage>(below(2));
  p.bypass = static_cast<spec::morphological::Bypass>(below(5));
  if (p.edge_source == spec::morphological::EdgeSource::kColour)
    p.threshold_mode = spec::morphological::ThresholdMode::kFixed;
  if (p.area == spec::morphological::AreaSource::kLearned) p.diagonals = p.round_corners = false;
  const bool table = p.area != spec::morphological::AreaSource::kAnalytic &&
                     p.area != spec::morphological::AreaSource::kLearned;
  if (table && p.ends == spec::morphological::Ends::kCrossings)
    p.border = static_cast<spec::morphological::Border>(below(2));
  else
    p.border = spec::morphological::Border::kEnd;
  if (table || p.diagonals) p.area_values = static_cast<spec::morphological::AreaValues>(below(2));
  options.descriptors = true;
  const auto seed = static_cast<std::uint64_t>(GetParam());
  expect_identical({blocks(97, 80, seed + 1), fans(13, seed), noise(60, 50, seed),
                    noise(1 + below(24), 40, seed), blocks(1 + below(24), 90, seed)},
                   options);
}

INSTANTIATE_TEST_SUITE_P(Morphological, EveryMix, testing::Range(0, 60));

// ---- pixels marked by another engine -----------------------------------------------------------

using Marks = std::tuple<Preset, spec::morphological::Lanes, spec::morphological::Bypass>;
class MarkedFrames : public testing::TestWithParam<Marks> {};

// Random marks, in lines, and at the borders.
MorphologicalInput marked(MorphologicalInput frame, std::uint64_t seed) {
  Random random(seed, "marks");
  const int width = frame.image.width, height = frame.image.height;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const bool border = x == 0 || y == 0 || x + 1 == width || y + 1 == height;
      const bool mark = random.chance(border ? 300 : 60) || (x + 3 * y) % 41 == 0;
      std::uint8_t& alpha = frame.image.at(x, y)[3];
      alpha = static_cast<std::uint8_t>((random.word() & 0xFE) | !mark);
    }
  return frame;
}

TEST_P(MarkedFrames, FramesMatchGolden) {
  const auto [which, lanes, bypass] = GetParam();
  MorphologicalRunOptions options;
  Parameters& p = options.morphological;
  p = preset(which, lanes);
  p.bypass = bypass;
  p.line_pixels = 512;
  if (bypass == spec::morphological::Bypass::kBeside)
    p.storage = spec::morphological::Storage::kMemory;
  options.descriptors = true;
  expect_identical({marked(blocks(133, 90, 5), 1), marked(fans(15, 2), 2), marked(noise(67, 50), 3),
                    marked(noise(3, 40), 4), marked(noise(90, 2), 5)},
                   options);
}

INSTANTIATE_TEST_SUITE_P(Morphological, MarkedFrames,
                         testing::Combine(testing::ValuesIn(kBuilt),
                                          testing::Values(spec::morphological::Lanes::kOne,
                                                          spec::morphological::Lanes::kTwo,
                                                          spec::morphological::Lanes::kFour),
                                          testing::Values(spec::morphological::Bypass::kMarked,
                                                          spec::morphological::Bypass::kBeside,
                                                          spec::morphological::Bypass::kHalf,
                                                          spec::morphological::Bypass::kMasked)),
                         name_of<Marks>);

TEST(Morphological, AddressesBeginAtPixelBase) {
  MorphologicalRunOptions options;
  options.morphological.storage = spec::morphological::Storage::kMemory;
  options.pixel_base = 0x1240;
  expect_identical({blocks(99, 40)}, options);
}

// ---- the window ---------------------------------------------------------------------------------

struct Late {
  const char* name;
  Preset preset;
  bool contiguous;
  spec::morphological::Lanes lanes;
};
void PrintTo(const Late& late, std::ostream* out) { *out << late.name; }
class LateDescriptors : public testing::TestWithParam<Late> {};

// Run descriptors of a slot row are still extended while the next one writes the window; an
// additional row is kept for that. Conditions: N = R - 1, one slow predictor, room for all
// descriptors, one-pixel steps with a few flaws, and more rows than the window has.
TEST_P(LateDescriptors, UseRowsTheyWereFoundIn) {
  MorphologicalRunOptions options;
  Parameters& p = options.morphological;
  p = preset(GetParam().preset, GetParam().lanes);
  p.contiguous = GetParam().contiguous;
  p.window_rows = 10;
  p.search_columns = 64;
  p.steps = 3;
  p.predictor_units = 1;
  p.descriptor_fifo = 4096;
  p.line_pixels = 128;
  options.descriptors = true;
  const MorphologicalInput frame = draw(97, 61, [](int x, int y) {
    const std::uint32_t h =
        static_cast<std::uint32_t>(x) * 73856093u ^ static_cast<std::uint32_t>(y) * 19349663u;
    return grey(((x + y) / 2 % 2 != 0) != ((h >> 7) % 17 == 0) ? 255 : 0);
  });
  const MorphologicalOutcome outcome = expect_identical({frame, noise(97, 61), frame}, options);
  EXPECT_GT(outcome.descriptor_stalls, 0u) << "no descriptor is late";
}
INSTANTIATE_TEST_SUITE_P(
    Morphological, LateDescriptors,
    testing::Values(
        Late{"mlaa_slope", Preset::kMlaaSlope, false, spec::morphological::Lanes::kOne},
        Late{"contiguous", Preset::kMlaaSlope, true, spec::morphological::Lanes::kOne},
        Late{"deburr_line", Preset::kDeburrLine, true, spec::morphological::Lanes::kOne},
        Late{"deburr", Preset::kDeburr, true, spec::morphological::Lanes::kOne},
        Late{"deburr_two_lanes", Preset::kDeburr, false, spec::morphological::Lanes::kTwo},
        Late{"two_lanes", Preset::kMlaaSlope, true, spec::morphological::Lanes::kTwo}),
    [](const auto& late) { return late.param.name; });

// ---- throughput ---------------------------------------------------------------------------------

using Laned = std::tuple<Preset, spec::morphological::Lanes>;
class Throughput : public testing::TestWithParam<Laned> {};

// 1.00 x lanes pixels per cycle while a fifth of all pixels lie on edges.
TEST_P(Throughput, SustainedWithAFifthOfPixelsOnEdges) {
  const auto [which, lanes] = GetParam();
  MorphologicalRunOptions options;
  options.morphological = preset(which, lanes);
  options.morphological.local_contrast = spec::morphological::LocalContrast::kOff;
  const Frames frames = {a_fifth(640, 120)};
  const MorphologicalOutcome outcome = expect_identical(frames, options);
  EXPECT_LE(outcome.edge_pixels * 5, outcome.pixels);
  EXPECT_GE(outcome.edge_pixels * 1000, outcome.pixels * 198);
  EXPECT_EQ(
      outcome.input_cycles,
      platform::beats_a_row(640, spec::morphological::kLaneCount[static_cast<std::size_t>(lanes)]) *
          120);
  EXPECT_EQ(outcome.frame_cycles, frame_cycles_by_formula(options.morphological, 640, 120));
  EXPECT_EQ(outcome.descriptor_stalls, 0u);
}

// With all pixels on edges a frame takes longer, reports it, and drops nothing.
TEST_P(Throughput, StallsWithEveryPixelOnEdges) {
  const auto [which, lanes] = GetParam();
  MorphologicalRunOptions options;
  options.morphological = preset(which, lanes);
  options.morphological.local_contrast = spec::morphological::LocalContrast::kOff;
  options.morphological.predictor_units = 1;
  options.morphological.divider_interval = 4;
  const MorphologicalOutcome outcome = expect_identical({noise(400, 60)}, options);
  EXPECT_GT(outcome.frame_cycles, frame_cycles_by_formula(options.morphological, 400, 60));
  EXPECT_GT(outcome.descriptor_stalls, 0u);
}

INSTANTIATE_TEST_SUITE_P(Morphological, Throughput,
                         testing::Combine(testing::ValuesIn(kBuilt),
                                          testing::Values(spec::morphological::Lanes::kOne,
                                                          spec::morphological::Lanes::kTwo,
                                                          spec::morphological::Lanes::kFour)),
                         name_of<Laned>);

class Clustered : public testing::TestWithParam<spec::morphological::Lanes> {};

// One-pixel diagonals next to each other, at either border and in the middle, up to the number
// allowed by docs/reference/morphological/hardware.md: no queue is too short. With a fifth of every
// row on them the slots stall, and nothing else changes.
TEST_P(Clustered, DiagonalsStallOnlyBeyondTheBound) {
  MorphologicalRunOptions options;
  options.morphological = preset(Preset::kDeburr, GetParam());
  options.check_links = false;
  const auto run = [&](int first, int columns) {
    return forked<MorphologicalOutcome>(
        [&] { return simulate({clustered(1920, 16, first, columns)}, options); });
  };
  const std::uint64_t formula = frame_cycles_by_formula(options.morphological, 1920, 16);
  for (const int first : {0, 601, 1920 * 3 / 5}) {
    const MorphologicalOutcome within = run(first, 200);  // 100 descriptors per axis and row
    EXPECT_EQ(within.mismatches, 0u);
    EXPECT_EQ(within.descriptor_stalls, 0u);
    EXPECT_EQ(within.frame_cycles, formula);
    const MorphologicalOutcome fifth = run(first, 1920 * 2 / 5 - 4);
    EXPECT_EQ(fifth.mismatches, 0u);
    EXPECT_GE(fifth.edge_pixels * 1000, fifth.pixels * 195);
    EXPECT_GT(fifth.descriptor_stalls, 0u);
    EXPECT_EQ(fifth.frame_cycles, formula + fifth.descriptor_stalls);
  }
}
INSTANTIATE_TEST_SUITE_P(
    Morphological, Clustered,
    testing::Values(spec::morphological::Lanes::kOne, spec::morphological::Lanes::kTwo,
                    spec::morphological::Lanes::kFour),
    [](const auto& lanes) {
      return fmt::format("{}_lanes",
                         spec::morphological::kLanesNames[static_cast<std::size_t>(lanes.param)]);
    });

// ---- memory sizing ------------------------------------------------------------------------------

// The sizing rule of docs/reference/morphological/hardware.md: the given number of lines in flight
// per direction keeps up with a memory of 100 cycles, one fewer does not.
struct Sizing {
  spec::morphological::Lanes lanes;
  int lines;
};
class FrameMemory : public testing::TestWithParam<Sizing> {
 protected:
  // Cycles in excess of the formula.
  static std::uint64_t lost(spec::morphological::Lanes lanes, int lines) {
    const Frames frames = {flat(1280, 48, 90)};
    MorphologicalRunOptions options;
    options.morphological = preset(Preset::kMlaa, lanes);
    options.morphological.storage = spec::morphological::Storage::kMemory;
    if (lines > 0) options.morphological.memory_outstanding = lines;
    const MorphologicalOutcome outcome = expect_identical(frames, options);
    return outcome.frame_cycles - frame_cycles_by_formula(options.morphological, 1280, 48);
  }
};

TEST_P(FrameMemory, SizingRuleKeepsUp) { EXPECT_EQ(lost(GetParam().lanes, GetParam().lines), 0u); }
TEST_P(FrameMemory, OneLineFewerFallsBehind) {
  EXPECT_GT(lost(GetParam().lanes, GetParam().lines - 1), 100u);
}
TEST_P(FrameMemory, DefaultKeepsUp) { EXPECT_EQ(lost(GetParam().lanes, 0), 0u); }

INSTANTIATE_TEST_SUITE_P(
    Morphological, FrameMemory,
    testing::Values(Sizing{spec::morphological::Lanes::kOne, 7},
                    Sizing{spec::morphological::Lanes::kTwo, 13},
                    Sizing{spec::morphological::Lanes::kFour, 26}),
    [](const auto& sizing) {
      return fmt::format(
          "{}_lanes",
          spec::morphological::kLanesNames[static_cast<std::size_t>(sizing.param.lanes)]);
    });

}  // namespace
}  // namespace deburr::tb::morphological_system::morphological_system_test
