// SPDX-License-Identifier: MIT
// The morphological golden model on whole frames: symmetries and their exceptions, extreme frames,
// alpha, consistency of intermediate results, memory, and error messages.
#include <gmock/gmock.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "golden/morphological/area.h"
#include "golden/morphological/runs.h"
#include "spec/error.h"
#include "tb/base/random.h"
#include "tb/unit/golden/morphological/support.h"

namespace deburr::frames_test {
namespace {

using golden::morphological::BitPlane;
using golden::morphological::Decision;
using golden::morphological::DepthView;
using golden::morphological::ImageView;
using golden::morphological::MorphologicalGolden;
using golden::morphological::PredictedRun;
using golden::morphological::preset_parameters;
using spec::morphological::Preset;
using tb::Random;
using tb::morphological::Frame;
using tb::morphological::grey;
using tb::morphological::inverted;
using tb::morphological::mirrored_x;
using tb::morphological::mirrored_y;
using tb::morphological::smooth;
using tb::morphological::transposed;

std::vector<Frame> frames() {
  return {tb::morphological::noise_image(), tb::morphological::line_image(),
          tb::morphological::blocks_image(), tb::morphological::rendered_like(180, 120, 60)};
}

std::vector<spec::morphological::Parameters> configurations() {
  std::vector<spec::morphological::Parameters> result;
  for (const auto preset :
       {Preset::kMlaa, Preset::kMlaaSlope, Preset::kDeburrLine, Preset::kDeburr}) {
    result.push_back(preset_parameters(preset));
    result.push_back(preset_parameters(preset));
    result.back().window_rows = 22;
    result.back().search_columns = 12;
  }
  return result;
}

// ---- symmetries ---------------------------------------------------------------------------------

void expect_mirrored(const spec::morphological::Parameters& p, const Frame& frame) {
  const Frame output = smooth(p, frame);
  EXPECT_EQ(smooth(p, mirrored_x(frame)), mirrored_x(output));
  EXPECT_EQ(smooth(p, mirrored_y(frame)), mirrored_y(output));
}

TEST(Symmetry, MirroringTheInputMirrorsTheOutput) {
  for (const Frame& frame : frames())
    for (const auto& p : configurations()) expect_mirrored(p, frame);
}

TEST(Symmetry, MirroringRequiresSymmetricOptions) {
  using spec::morphological::DynamicLuma;
  const Frame frame = tb::morphological::rendered_like(180, 120, 60);
  spec::morphological::Parameters p = preset_parameters(Preset::kDeburrLine);
  p.local_contrast = spec::morphological::LocalContrast::kPaper;
  EXPECT_NE(smooth(p, mirrored_x(frame)), mirrored_x(smooth(p, frame)));
  p = preset_parameters(Preset::kMlaa);
  p.threshold_mode = spec::morphological::ThresholdMode::kDynamic;
  p.alpha = 7680000;
  for (const auto luma : {DynamicLuma::kMax, DynamicLuma::kMin, DynamicLuma::kMean}) {
    p.dynamic_luma = luma;
    expect_mirrored(p, frame);
  }
  p.dynamic_luma = DynamicLuma::kCurrent;
  EXPECT_NE(smooth(p, mirrored_x(frame)), mirrored_x(smooth(p, frame)));
  EXPECT_NE(smooth(p, mirrored_y(frame)), mirrored_y(smooth(p, frame)));
}

// Differences between the transposed result and the result of the transposed frame. Ties are
// counted separately: they choose up and down in both frames.
struct TransposedComparison {
  int ties = 0, differing_ties = 0, differing = 0;
  TransposedComparison(const spec::morphological::Parameters& p, const Frame& frame) {
    MorphologicalGolden a(p), b(p);
    const Frame turned = transposed(frame);
    a.process(frame.view());
    b.process(turned.view());
    for (int y = 0; y < frame.height; ++y) {
      for (int x = 0; x < frame.width; ++x) {
        const auto i = static_cast<std::size_t>(y * frame.width + x);
        const auto j = static_cast<std::size_t>(x * frame.height + y);
        const bool tie = a.decisions()[i] == Decision::kTie;
        EXPECT_EQ(b.decisions()[j] == Decision::kTie, tie);
        const bool same = a.pixels()[i] == b.pixels()[j];
        ties += tie;
        differing_ties += tie && !same;
        differing += !tie && !same;
      }
    }
  }
};

TEST(Symmetry, TransposingInputTransposesAllButTies) {
  int ties = 0, differing_ties = 0;
  for (const Frame& frame : frames()) {
    for (auto p : configurations()) {
      p.search_columns = golden::morphological::search_rows(p);
      for (const auto contrast :
           {p.local_contrast,
            spec::morphological::LocalContrast::kPaper}) {  // the paper's form transposes too
        p.local_contrast = contrast;
        const TransposedComparison comparison(p, frame);
        EXPECT_EQ(comparison.differing, 0);
        ties += comparison.ties;
        differing_ties += comparison.differing_ties;
      }
    }
  }
  EXPECT_GT(ties, 100);
  EXPECT_GT(differing_ties, 0);  // ties are really an exception
}

// SMAA treats both axes alike, except that diagonals are searched only from top edges.
TEST(Symmetry, TransposingInputTransposesSmaaExceptDiagonals) {
  using spec::morphological::DynamicLuma;
  spec::morphological::Parameters p = preset_parameters(Preset::kSmaa);
  p.search_columns = golden::morphological::search_rows(p);
  const auto differing = [&] {
    int sum = 0;
    for (const Frame& frame : frames()) sum += TransposedComparison(p, frame).differing;
    return sum;
  };
  p.diagonals = false;
  EXPECT_EQ(differing(), 0);
  p.threshold_mode = spec::morphological::ThresholdMode::kDynamic;
  for (const auto luma :
       {DynamicLuma::kCurrent, DynamicLuma::kMax, DynamicLuma::kMin, DynamicLuma::kMean}) {
    p.dynamic_luma = luma;
    EXPECT_EQ(differing(), 0);
  }
  p.search_steps = 2;  // limits most searches
  EXPECT_EQ(differing(), 0);
}

TEST(Symmetry, InvertingInputInvertsOutputInGammaSpace) {
  for (const Frame& frame : frames()) {
    for (auto p : configurations()) {
      p.linear_light = false;
      EXPECT_EQ(smooth(p, inverted(frame)), inverted(smooth(p, frame)));
      p.linear_light = true;
      EXPECT_NE(smooth(p, inverted(frame)), inverted(smooth(p, frame)));
    }
  }
  spec::morphological::Parameters p = preset_parameters(Preset::kMlaa);
  p.linear_light = false;
  p.threshold_mode =
      spec::morphological::ThresholdMode::kDynamic;  // relative to luma: not symmetric
  p.alpha = 7680000;
  const Frame frame = tb::morphological::rendered_like(180, 120, 60);
  EXPECT_NE(smooth(p, inverted(frame)), inverted(smooth(p, frame)));
}

// ---- extreme frames -----------------------------------------------------------------------------

TEST(ExtremeFrames, FlatFramesPassUnchanged) {
  for (const auto& p : configurations()) {
    for (const auto& [w, h] : {std::pair(1, 1), {1, 40}, {40, 1}, {64, 64}, {130, 7}}) {
      for (const int code : {0, 17, 255}) {
        const Frame frame(w, h, [&](int, int) { return grey(code); });
        MorphologicalGolden golden(p);
        EXPECT_EQ(golden.process(frame.view()), frame.pixels);
        spec::morphological::Work idle;
        idle.pixels = frame.pixels.size();
        EXPECT_EQ(golden.work(), idle);
      }
    }
  }
}

TEST(ExtremeFrames, SingleRowOrColumnPassesUnchanged) {
  Random random(1);
  for (const auto& p : configurations()) {
    if (p.area == spec::morphological::AreaSource::kLearned) continue;  // blends a little
    const Frame row(200, 1, [&](int, int) { return grey(static_cast<int>(random.word() & 255)); });
    MorphologicalGolden golden(p);
    // No crossings can exist, so nothing is blended.
    EXPECT_EQ(golden.process(row.view()), row.pixels);
    EXPECT_GT(golden.work().vertical_runs, 50u);
    EXPECT_EQ(golden.work().horizontal_runs, 0u);
    const Frame column = transposed(row);
    EXPECT_EQ(golden.process(column.view()), column.pixels);
    EXPECT_EQ(golden.work().vertical_runs, 0u);
  }
}

TEST(ExtremeFrames, ResultIsIndependentOfPreviousFrame) {
  const spec::morphological::Parameters p = preset_parameters(Preset::kDeburrLine);
  MorphologicalGolden golden(p);
  const Frame big = tb::morphological::rendered_like(300, 200, 90);
  const Frame small = tb::morphological::blocks_image();
  golden.process(big.view());
  EXPECT_EQ(golden.process(small.view()), smooth(p, small).pixels);
  EXPECT_EQ(golden.process(big.view()), smooth(p, big).pixels);
}

TEST(ExtremeFrames, InputRowsMayHavePadding) {
  const Frame frame = tb::morphological::line_image();
  std::vector<spec::morphological::Rgba8> spaced(static_cast<std::size_t>(frame.width + 9) *
                                                 static_cast<std::size_t>(frame.height));
  for (int y = 0; y < frame.height; ++y) {
    std::copy_n(&frame.at(0, y), frame.width, spaced.begin() + y * (frame.width + 9));
  }
  MorphologicalGolden golden(preset_parameters(Preset::kDeburrLine));
  const ImageView view(spaced, frame.width, frame.height,
                       static_cast<std::size_t>(frame.width) + 9);
  EXPECT_EQ(golden.process(view), smooth(golden.parameters(), frame).pixels);
}

// ---- alpha --------------------------------------------------------------------------------------

TEST(Alpha, PassesWithoutAffectingColours) {
  const Frame opaque = tb::morphological::rendered_like(120, 90, 40);
  Random random(2);
  Frame frame = opaque;
  for (spec::morphological::Rgba8& pixel : frame.pixels)
    pixel[3] = static_cast<std::uint8_t>(random.word());
  const auto p = preset_parameters(Preset::kDeburrLine);
  const Frame output = smooth(p, frame), expected = smooth(p, opaque);
  for (std::size_t i = 0; i < frame.pixels.size(); ++i) {
    EXPECT_EQ(output.pixels[i][3], frame.pixels[i][3]);
    spec::morphological::Rgba8 colour = output.pixels[i];
    colour[3] = 255;
    EXPECT_EQ(colour, expected.pixels[i]);
  }
}

// ---- intermediate results -----------------------------------------------------------------------

TEST(Intermediates, CountersMatchProbesAndRuns) {
  for (const Frame& frame : frames()) {
    for (const auto& p : configurations()) {
      MorphologicalGolden golden(p);
      golden.process(frame.view());
      const spec::morphological::Work& work = golden.work();
      spec::morphological::Work counted;
      counted.pixels = frame.pixels.size();
      for (int y = 0; y < frame.height; ++y) {
        for (int x = 0; x < frame.width; ++x) {
          const auto i = static_cast<std::size_t>(y * frame.width + x);
          const spec::morphological::BlendProbe& probe = golden.probes()[i];
          EXPECT_EQ(probe.edges,
                    (golden.edges().left.at(x, y) ? 1 : 0) | (golden.edges().top.at(x, y) ? 2 : 0));
          counted.edge_pixels += probe.edges != 0;
          counted.blended_pixels += (probe.first | probe.second) != 0;
          EXPECT_EQ(golden.decisions()[i] != Decision::kNone, (probe.first | probe.second) != 0);
          if ((probe.first | probe.second) == 0) {
            EXPECT_EQ(golden.pixels()[i], frame.pixels[i]);
          }
        }
      }
      for (const PredictedRun& run : golden.runs()) {
        const spec::morphological::RunDescriptor& r = run.line.run;
        const bool whole = r.part == spec::morphological::RunPart::kWhole;
        if (r.part != spec::morphological::RunPart::kTail) {
          ++(r.axis == spec::morphological::Axis::kHorizontal ? counted.horizontal_runs
                                                              : counted.vertical_runs);
        }
        counted.long_runs += r.part == spec::morphological::RunPart::kHead;
        counted.z_runs += whole && spec::morphological::kRunShapes[r.shape].clean_z;
        const std::uint64_t steps = std::uint64_t{run.line.left_steps} + run.line.right_steps;
        counted.extended_runs += steps != 0;
        counted.steps += steps;
        counted.probes += run.probes;
        counted.divides += run.line.before != spec::morphological::Side::kNone ||
                           run.line.after != spec::morphological::Side::kNone;
        EXPECT_LE(run.line.span, golden::morphological::search_range(p, r.axis) * 2 + 1);
        EXPECT_LE(run.iterations, p.steps);
      }
      EXPECT_EQ(counted, work);
    }
  }
}

TEST(Intermediates, RunsComeInCanonicalOrder) {
  MorphologicalGolden golden(preset_parameters(Preset::kMlaa));
  const Frame frame = tb::morphological::blocks_image();
  golden.process(frame.view());
  const auto key = [](const PredictedRun& run) {
    const spec::morphological::RunDescriptor& r = run.line.run;
    return r.axis == spec::morphological::Axis::kHorizontal ? std::tuple(0, r.line, r.start)
                                                            : std::tuple(1, r.start, r.line);
  };
  EXPECT_TRUE(std::is_sorted(
      golden.runs().begin(), golden.runs().end(),
      [&](const PredictedRun& a, const PredictedRun& b) { return key(a) < key(b); }));
}

TEST(Intermediates, PixelDetailKeepsNoIntermediates) {
  const Frame frame = tb::morphological::blocks_image();
  const auto p = preset_parameters(Preset::kDeburrLine);
  MorphologicalGolden everything(p), pixels(p, MorphologicalGolden::Detail::kPixels);
  EXPECT_EQ(everything.process(frame.view()), pixels.process(frame.view()));
  EXPECT_EQ(everything.work(), pixels.work());
  EXPECT_TRUE(pixels.probes().empty() && pixels.runs().empty() && pixels.decisions().empty());
}

// ---- memory -------------------------------------------------------------------------------------

TEST(FrameMemory, TrafficRequiresMemoryStorage) {
  const Frame frame = tb::morphological::blocks_image();
  auto p = preset_parameters(spec::morphological::Preset::kDeburrLine);
  MorphologicalGolden lines(p);
  lines.process(frame.view());
  EXPECT_TRUE(lines.traffic().empty());
  p.storage = spec::morphological::Storage::kMemory;
  MorphologicalGolden memory(p);
  EXPECT_EQ(memory.process(frame.view()), lines.pixels());
  EXPECT_EQ(memory.traffic(256).size(), 2u * 6 * 80);  // 90 pixels: 6 lines per row
  EXPECT_EQ(memory.traffic(256).front().address, 256u);
  EXPECT_EQ(memory.traffic(), memory.traffic(0));
}

TEST(FrameMemory, UnreadableLinesAreZeros) {
  const Frame frame(40, 8, [](int x, int y) { return grey(10 * x / 4 + 20 * y); });
  auto p = preset_parameters(spec::morphological::Preset::kDeburrLine);
  p.storage = spec::morphological::Storage::kMemory;
  MorphologicalGolden golden(p);
  const std::vector<spec::morphological::Rgba8> good = golden.process(frame.view());
  golden.set_read_errors([](std::uint32_t address) { return address == 1024 + 3 * 192 + 64; },
                         1024);
  const std::vector<spec::morphological::Rgba8> bad = golden.process(frame.view());
  EXPECT_EQ(golden.memory_errors(), 1u);
  for (int x = 0; x < 40; ++x) {
    const auto i = static_cast<std::size_t>(3 * 40 + x);
    if (x >= 16 && x < 32) {
      if ((golden.probes()[i].first | golden.probes()[i].second) == 0) {
        EXPECT_EQ(bad[i], spec::morphological::Rgba8{});
      }
      EXPECT_EQ(bad[i][3], 0);
    } else if (x < 15 || x > 32) {
      EXPECT_EQ(bad[i], good[i]);
    }
  }
}

TEST(FrameMemory, ReadsEachLineOncePerFrame) {
  const Frame frame(40, 8, [](int x, int y) { return grey(10 * x / 4 + 20 * y); });
  auto p = preset_parameters(spec::morphological::Preset::kDeburrLine);
  p.storage = spec::morphological::Storage::kMemory;
  MorphologicalGolden golden(p);
  golden.set_read_errors([](std::uint32_t) { return true; }, 1024);
  golden.process(frame.view());
  EXPECT_EQ(golden.memory_errors(), 8u * 3);  // 40 pixels: 3 lines per row
  golden.process(frame.view());
  EXPECT_EQ(golden.memory_errors(), 8u * 3) << "of each frame by itself";
}

TEST(FrameViews, RejectSizeMismatch) {
  const Frame frame = tb::morphological::line_image();
  const int width = frame.width, height = frame.height;
  const auto w = static_cast<std::size_t>(width), h = static_cast<std::size_t>(height);
  auto p = preset_parameters(spec::morphological::Preset::kDeburrLine);
  p.edge_source = spec::morphological::EdgeSource::kDepth;
  MorphologicalGolden golden(p);
  const std::vector<std::uint32_t> depth(w * h + h);
  const auto with = [&](const DepthView& view) { golden.process(frame.view(), view); };
  EXPECT_NO_THROW(with(DepthView(depth, width, height)));
  EXPECT_THROW(with(DepthView(depth, width - 1, height)), spec::CheckFailed);
  EXPECT_THROW(with(DepthView(depth, width, height - 1)), spec::CheckFailed);
  EXPECT_THROW(with(DepthView(depth, width, height, w - 1)), spec::CheckFailed);
  // The last row needs no padding.
  const std::span all(depth);
  EXPECT_NO_THROW(with(DepthView(all.first(w * h + h - 1), width, height, w + 1)));
  EXPECT_THROW(with(DepthView(all.first(w * h + h - 2), width, height, w + 1)), spec::CheckFailed);
  using golden::morphological::BitPlane;
  const auto edges = [&](int left_width, int left_height, int top_width, int top_height) {
    golden.process(frame.view(),
                   golden::morphological::EdgePlanes{BitPlane(left_width, left_height),
                                                     BitPlane(top_width, top_height)});
  };
  EXPECT_NO_THROW(edges(width, height, width, height));
  EXPECT_THROW(edges(width - 1, height, width, height), spec::CheckFailed);
  EXPECT_THROW(edges(width, height - 1, width, height), spec::CheckFailed);
  EXPECT_THROW(edges(width, height, width - 1, height), spec::CheckFailed);
  EXPECT_THROW(edges(width, height, width, height - 1), spec::CheckFailed);
}

// ---- named errors -------------------------------------------------------------------------------

std::string error_of(void (*change)(spec::morphological::Parameters&)) {
  auto p = preset_parameters(spec::morphological::Preset::kDeburrLine);
  change(p);
  try {
    MorphologicalGolden golden(p);
    return "";
  } catch (const spec::ConfigError& error) {
    return error.what();
  }
}

TEST(NamedErrors, ParameterErrorsNameLimitAndRemedy) {
  using P = spec::morphological::Parameters;
  struct Row {
    const char* error;  // part of the message; empty: accepted
    void (*change)(P&);
  };
  for (const Row& row : {
           Row{"", [](P&) {}},
           Row{"morphological.window_rows = 65: must be an even number of rows",
               [](P& p) { p.window_rows = 65; }},
           Row{"morphological.steps = 8 with window_rows = 18: must be at most window_rows / 2 - "
               "2, the limit of the edge window; make it at most 7, or give window_rows "
               "of at least 20",
               [](P& p) { p.window_rows = 18; }},
           Row{"", [](P& p) { p.window_rows = 18, p.steps = 7; }},
           Row{"", [](P& p) { p.window_rows = 20; }},
           Row{"outside 4..2048", [](P& p) { p.search_columns = 3; }},
           Row{"edges.threshold", [](P& p) { p.threshold = 0; }},
           Row{"outside 1..16777215", [](P& p) { p.threshold = 16777216; }},
           Row{"predicated",
               [](P& p) {
                 p.edge_source = spec::morphological::EdgeSource::kPredicated;
                 p.threshold_mode = spec::morphological::ThresholdMode::kDynamic;
               }},
           Row{"outside 1..112", [](P& p) { p.search_steps = 113; }},
           Row{"search_steps", [](P& p) { p.search_steps = 0; }},
           Row{"outside 1..16", [](P& p) { p.diagonal_steps = 17; }},
           Row{"diagonal_steps", [](P& p) { p.diagonal_steps = 0; }},
           Row{"outside 0..256", [](P& p) { p.corner_rounding = 257; }},
           Row{"corner_rounding", [](P& p) { p.corner_rounding = -1; }},
           Row{"edges.alpha", [](P& p) { p.alpha = 16777216; }},
           Row{"outside 0..16777215", [](P& p) { p.alpha = -1; }},
           Row{"", [](P& p) { p.alpha = 0; }},
           Row{"edges.floor", [](P& p) { p.floor = 0; }},
           Row{"morphological.diagonal_steps = 10 with window_rows = 20: must be at most "
               "window_rows / 2 - 1 with diagonals, the limit of the edge window; make it "
               "at most 9, or give window_rows of at least 22",
               [](P& p) {
                 p.steps = 4, p.diagonals = true, p.diagonal_steps = 10, p.window_rows = 20;
               }},
           Row{"",
               [](P& p) {
                 p.steps = 4, p.diagonals = true, p.diagonal_steps = 9, p.window_rows = 20;
               }},
       }) {
    const std::string error = error_of(row.change);
    if (*row.error == 0) {
      EXPECT_EQ(error, "");
    } else {
      EXPECT_THAT(error, testing::HasSubstr(row.error));
    }
  }
}

TEST(Presets, MatchContract) {
  using spec::morphological::Quality;
  struct Row {
    Quality quality;
    int threshold, search_steps, diagonal_steps, window_rows;
    bool diagonals, round_corners;
  };
  for (const Row& row : {Row{Quality::kLow, 2506752, 4, 8, 38, false, false},
                         Row{Quality::kMedium, 1671168, 8, 8, 70, false, false},
                         Row{Quality::kHigh, 1671168, 16, 8, 134, true, true},
                         Row{Quality::kUltra, 835584, 32, 16, 258, true, true}}) {
    for (const auto preset : {Preset::kSmaa, Preset::kSmaaDynamic}) {
      const spec::morphological::Parameters p = preset_parameters(preset, row.quality);
      const bool dynamic = preset == Preset::kSmaaDynamic;
      EXPECT_EQ(p.quality, row.quality);
      EXPECT_EQ(p.threshold, dynamic ? 501330 : row.threshold);
      EXPECT_EQ(p.search_steps, row.search_steps);
      EXPECT_EQ(p.diagonals, row.diagonals);
      EXPECT_EQ(p.diagonal_steps, row.diagonal_steps);
      EXPECT_EQ(p.round_corners, row.round_corners);
      EXPECT_EQ(p.corner_rounding, 64);
      EXPECT_EQ(p.window_rows, row.window_rows);
      EXPECT_EQ(p.ends, spec::morphological::Ends::kCrossings);
      EXPECT_EQ(p.border, spec::morphological::Border::kClamp);
      EXPECT_EQ(p.blend, spec::morphological::BlendRule::kStrongest);
      EXPECT_EQ(p.alpha, 1677721);
      EXPECT_EQ(p.floor, 131072);
      EXPECT_NO_THROW(MorphologicalGolden{p});
    }
  }
  // Quality has no effect on other presets.
  for (const auto preset :
       {Preset::kMlaa, Preset::kMlaaSlope, Preset::kDeburrLine, Preset::kDeburr}) {
    const spec::morphological::Parameters p = preset_parameters(preset, Quality::kUltra);
    EXPECT_EQ(p.window_rows, 66);
    EXPECT_EQ(p.ends, spec::morphological::Ends::kGaps);
    EXPECT_EQ(p.blend, spec::morphological::BlendRule::kLongest);
    EXPECT_FALSE(p.diagonals || p.round_corners);
  }
}

// ---- given edges, after the geometric engine ----------------------------------------------------

TEST(GivenEdges, ReproduceFrameTheyWereFoundIn) {
  for (const Frame& frame : frames()) {
    for (const auto& p : configurations()) {
      MorphologicalGolden found(p), given(p);
      found.process(frame.view());
      EXPECT_NE(found.pixels(), frame.pixels);
      EXPECT_EQ(given.process(frame.view(), found.edges()), found.pixels());
      EXPECT_EQ(given.edges(), found.edges());
      const BitPlane none(frame.width, frame.height);
      EXPECT_EQ(given.process(frame.view(), {none, none}), frame.pixels);
      const BitPlane lower(frame.width, frame.height - 1);
      EXPECT_THROW(given.process(frame.view(), {none, lower}), spec::CheckFailed);
    }
  }
}

TEST(FollowingGeometric, KeepsDynamicThresholdAndEdgeSource) {
  const spec::morphological::FollowingRules following;
  spec::morphological::Parameters p = preset_parameters(Preset::kDeburrLine);
  const spec::morphological::Parameters fixed = golden::morphological::following_geometric(p);
  EXPECT_EQ(fixed.bypass, following.bypass);
  EXPECT_EQ(fixed.edge_source, following.edge_source);
  EXPECT_EQ(fixed.threshold_on_depth_edge, following.threshold_on_depth_edge);
  EXPECT_EQ(fixed.threshold_off_depth_edge, following.threshold_off_depth_edge);
  p.threshold_mode = spec::morphological::ThresholdMode::kDynamic;
  p.threshold_on_depth_edge = following.threshold_on_depth_edge + 1;
  const spec::morphological::Parameters dynamic = golden::morphological::following_geometric(p);
  EXPECT_NE(p.bypass, following.bypass);
  EXPECT_EQ(dynamic.bypass, following.bypass);
  EXPECT_NE(p.edge_source, following.edge_source);
  EXPECT_EQ(dynamic.edge_source, p.edge_source);
  EXPECT_EQ(dynamic.threshold_on_depth_edge, p.threshold_on_depth_edge);
}

// Edges inside a surface are ignored, even black next to white.
TEST(FollowingGeometric, FindsEdgesOnlyAtDepthEdges) {
  const spec::morphological::Parameters p =
      golden::morphological::following_geometric(preset_parameters(Preset::kDeburrLine));
  const std::vector<spec::morphological::Rgba8> pixels = {{0, 0, 0, 255}, {255, 255, 255, 255}};
  for (const bool on : {false, true}) {
    const std::vector<std::uint32_t> depth = {1000000, on ? 2000000u : 1000000u};
    MorphologicalGolden golden(p);
    golden.process({pixels, 2, 1}, {depth, 2, 1});
    EXPECT_EQ(golden.edges().left.at(1, 0), on);
  }
}

TEST(NamedErrors, FrameSizeErrorsNameLimits) {
  auto p = preset_parameters(spec::morphological::Preset::kDeburrLine);
  const auto text = [&](int width, int height) -> std::string {
    try {
      golden::morphological::check_frame(p, width, height);
    } catch (const spec::ConfigError& error) {
      return error.what();
    }
    return "";
  };
  const auto none = [](const std::string& size) {
    return "a frame of " + size + " pixels; width and height must be 1..8192";
  };
  for (const auto& [width, height] : {std::pair{1, 1}, {8192, 1}, {1, 8192}, {8192, 8192}})
    EXPECT_EQ(text(width, height), "");
  EXPECT_EQ(text(0, 5), none("0 x 5"));
  EXPECT_EQ(text(5, 0), none("5 x 0"));
  EXPECT_EQ(text(8193, 5), none("8193 x 5"));
  EXPECT_EQ(text(5, 8193), none("5 x 8193"));
  p.line_pixels = 100;
  EXPECT_EQ(text(100, 5), "");
  EXPECT_EQ(
      text(101, 5),
      "a frame of 101 x 5 pixels is wider than the line buffers of 100 pixels; raise line_pixels");
  MorphologicalGolden golden(p);
  const std::vector<spec::morphological::Rgba8> pixels(8193);
  EXPECT_THROW(golden.process(ImageView(pixels, 101, 1)), spec::ConfigError);
  EXPECT_THROW(golden.process(ImageView(pixels, 100, 82)), spec::CheckFailed);
  EXPECT_NO_THROW(golden.process(ImageView(pixels, 100, 81)));
}

}  // namespace
}  // namespace deburr::frames_test
