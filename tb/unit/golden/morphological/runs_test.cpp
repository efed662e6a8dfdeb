// SPDX-License-Identifier: MIT
// Runs are found, cut and extended as the contract says: runs compared with a walk over single
// bits, consistent sets with a search for a line, and extensions with the lines that were drawn.
#include "golden/morphological/runs.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <numeric>
#include <tuple>

#include "golden/morphological/edges.h"
#include "golden/morphological/predictor.h"
#include "tb/base/random.h"
#include "tb/unit/golden/morphological/support.h"

namespace deburr::runs_test {
namespace {

using golden::morphological::AxisEdges;
using golden::morphological::BitPlane;
using golden::morphological::ConsistentSet;
using golden::morphological::EdgePlanes;
using golden::morphological::MorphologicalGolden;
using golden::morphological::Outcome;
using golden::morphological::PredictedRun;
using golden::morphological::preset_parameters;
using golden::morphological::SideEnd;
using spec::morphological::Preset;
using tb::Random;
using tb::morphological::Frame;
using tb::morphological::grey;

// ---- planes and runs ----------------------------------------------------------------------------

BitPlane random_plane(int width, int height, int percent, Random& random) {
  BitPlane plane(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      if (random.word() % 100 < static_cast<unsigned>(percent)) plane.set(x, y);
    }
  }
  return plane;
}

TEST(BitPlanes, TransposeAndReadZeroOutside) {
  Random random(1);
  for (const int width : {1, 63, 64, 65, 200}) {
    for (const int height : {1, 64, 70}) {
      const BitPlane plane = random_plane(width, height, 50, random);
      const BitPlane turned = plane.transposed();
      EXPECT_EQ(turned.width(), height);
      for (int y = -1; y <= height; ++y) {
        for (int x = -1; x <= width; ++x) ASSERT_EQ(turned.at(y, x), plane.at(x, y));
      }
      EXPECT_FALSE(plane.at(-1, 0) || plane.at(0, -1) || plane.at(width, 0) || plane.at(0, height));
      EXPECT_EQ(turned.transposed(), plane);
      EXPECT_EQ(turned.count(), plane.count());
    }
  }
}

TEST(Runs, MatchBitwiseWalk) {
  using spec::morphological::Ends;
  Random random(2);
  for (const int width : {1, 63, 64, 65, 128, 129, 400}) {
    for (const auto& [along, across] : {std::pair{5, 10}, {50, 50}, {97, 1}, {98, 60}, {100, 0}}) {
      const AxisEdges edges{spec::morphological::Axis::kHorizontal,
                            random_plane(width, 8, along, random),
                            random_plane(width, 8, across, random)};
      for (const Ends ends : {Ends::kGaps, Ends::kCrossings}) {
        for (int y = 0; y < 8; ++y) {
          std::vector<std::pair<int, int>> found, expected;
          golden::morphological::for_each_run(
              edges, ends, y, [&](int first, int end) { found.emplace_back(first, end); });
          for (int x = 0; x < width; ++x) {
            if (!edges.along.at(x, y)) continue;
            if (edges.along.at(x - 1, y) && (ends == Ends::kGaps || edges.crossings(x, y) == 0)) {
              expected.back().second = x + 1;
            } else {
              expected.emplace_back(x, x + 1);
            }
          }
          EXPECT_EQ(found, expected);
        }
      }
    }
  }
}

TEST(Runs, ShapeEncodesCrossings) {
  for (int code = 0; code < 16; ++code) {
    AxisEdges edges{spec::morphological::Axis::kHorizontal, BitPlane(12, 6), BitPlane(12, 6)};
    for (int x = 4; x < 9; ++x) edges.along.set(x, 3);
    if ((code & 1) != 0) edges.across.set(4, 2);
    if ((code & 2) != 0) edges.across.set(4, 3);
    if ((code & 4) != 0) edges.across.set(9, 2);
    if ((code & 8) != 0) edges.across.set(9, 3);
    edges.across.set(6, 2);  // a crossing in the middle does not end a run
    const auto descriptors = find_runs(preset_parameters(Preset::kMlaa), edges);
    ASSERT_EQ(descriptors.size(), 1u);
    EXPECT_EQ(descriptors[0],
              (spec::morphological::RunDescriptor{spec::morphological::Axis::kHorizontal,
                                                  spec::morphological::RunPart::kWhole, 3, 4, 5,
                                                  static_cast<std::uint8_t>(code)}));
  }
}

TEST(Runs, FarBitsMarkContinuedCrossings) {
  spec::morphological::Parameters p = preset_parameters(Preset::kMlaa);
  for (int far = 0; far < 16; ++far) {
    AxisEdges edges{spec::morphological::Axis::kHorizontal, BitPlane(12, 6), BitPlane(12, 6)};
    for (int x = 4; x < 9; ++x) edges.along.set(x, 3);
    if ((far & 1) != 0) edges.across.set(4, 1);
    if ((far & 2) != 0) edges.across.set(4, 4);
    if ((far & 4) != 0) edges.across.set(9, 1);
    if ((far & 8) != 0) edges.across.set(9, 4);
    p.round_corners = true;
    p.search_columns = 256;
    auto descriptors = find_runs(p, edges);
    ASSERT_EQ(descriptors.size(), 1u);
    EXPECT_EQ(descriptors[0].far, far);
    EXPECT_EQ(descriptors[0].shape, 0);
    p.search_columns = 4;
    descriptors = find_runs(p, edges);
    ASSERT_EQ(descriptors.size(), 2u);
    EXPECT_EQ(descriptors[0].far, far & 3);
    EXPECT_EQ(descriptors[1].far, far & 12);
    p.round_corners = false;
    EXPECT_EQ(find_runs(p, edges)[0].far, 0);
  }
}

TEST(Runs, LongRunsAreCutToHeadAndTail) {
  spec::morphological::Parameters p = preset_parameters(Preset::kMlaa);
  p.search_columns = 9;
  for (int length = 1; length <= 40; ++length) {
    AxisEdges edges{spec::morphological::Axis::kHorizontal, BitPlane(50, 4), BitPlane(50, 4)};
    for (int x = 3; x < 3 + length; ++x) edges.along.set(x, 2);
    edges.across.set(3, 1);           // start: N
    edges.across.set(3 + length, 2);  // end: S
    const auto descriptors = find_runs(p, edges);
    if (length <= 9) {
      ASSERT_EQ(descriptors.size(), 1u);
      EXPECT_EQ(descriptors[0].shape, 1 + 4 * 2);
      continue;
    }
    ASSERT_EQ(descriptors.size(), 2u);
    EXPECT_EQ(descriptors[0], (spec::morphological::RunDescriptor{
                                  spec::morphological::Axis::kHorizontal,
                                  spec::morphological::RunPart::kHead, 2, 3, 4, 1}));
    EXPECT_EQ(descriptors[1],
              (spec::morphological::RunDescriptor{
                  spec::morphological::Axis::kHorizontal, spec::morphological::RunPart::kTail, 2,
                  static_cast<std::uint16_t>(3 + length - 4), 4, 8}));
  }
}

TEST(Runs, VerticalRunsMatchTransposedFrame) {
  Random random(3);
  const EdgePlanes edges{random_plane(90, 70, 60, random), random_plane(90, 70, 60, random)};
  const EdgePlanes turned{edges.top.transposed(), edges.left.transposed()};
  auto p = preset_parameters(spec::morphological::Preset::kDeburrLine);
  p.search_columns = golden::morphological::search_rows(p);
  auto vertical = find_runs(p, AxisEdges::vertical(edges));
  for (spec::morphological::RunDescriptor& run : vertical)
    run.axis = spec::morphological::Axis::kHorizontal;
  EXPECT_EQ(vertical, find_runs(p, AxisEdges::horizontal(turned)));
  EXPECT_GT(vertical.size(), 100u);
}

// ---- consistent sets ----------------------------------------------------------------------------

// Searches for a pitch p and a phase a with X_i = ceil(a + i p), trying the midpoints between all
// critical pitches.
bool line_exists(const std::vector<ConsistentSet::Corner>& corners) {
  std::vector<double> critical;
  for (const auto& a : corners) {
    for (const auto& b : corners) {
      if (a.index >= b.index) continue;
      const double steps = b.index - a.index, pixels = b.position - a.position;
      critical.push_back((pixels - 1) / steps);
      critical.push_back((pixels + 1) / steps);
    }
  }
  std::sort(critical.begin(), critical.end());
  for (std::size_t i = 1; i < critical.size(); ++i) {
    const double pitch = (critical[i - 1] + critical[i]) / 2;
    if (critical[i] - critical[i - 1] < 1e-9) continue;
    double low = -1e9, high = 1e9;  // a in (low, high]
    for (const auto& c : corners) {
      low = std::max(low, c.position - 1 - c.index * pitch);
      high = std::min(high, c.position - c.index * pitch);
    }
    if (high - low > 1e-9) return true;
  }
  return false;
}

TEST(ConsistentSets, ConsistentIffLineExists) {
  Random random(4);
  int consistent = 0;
  for (int i = 0; i < 20000; ++i) {
    const int length = 1 + static_cast<int>(random.word() % 9);
    // Sometimes steps of any length, not only those that the predictor tries.
    const bool any = random.word() % 8 == 0;
    ConsistentSet set(length);
    std::vector<ConsistentSet::Corner> corners = {{0, 0}, {1, length}};
    int right = length, left = 0;
    const int sides = 1 + static_cast<int>(random.word() % 6);
    for (int k = 0; k < sides; ++k) {
      const auto step = [&] {
        return any ? random.between(1, 2 * length + 3) : random.between(length - 1, length + 1);
      };
      corners.push_back({k + 2, right += step()});
      EXPECT_EQ(set.consistent_with(corners.back()), line_exists(corners));
      auto both = corners;
      both.push_back({-k - 1, left - step()});
      EXPECT_EQ(set.consistent_with(corners.back(), both.back()), line_exists(both));
      set.add(corners.back());
      corners.push_back({-k - 1, left -= step()});
      EXPECT_EQ(set.consistent_with(corners.back()), line_exists(corners));
      set.add(corners.back());
      EXPECT_EQ(set.consistent(), line_exists(corners));
    }
    consistent += set.consistent();
  }
  EXPECT_GT(consistent, 1000);
  EXPECT_LT(consistent, 19000);
}

// ---- extension on straight lines ----------------------------------------------------------------

struct Line {
  double slope, start;
  Frame frame(int width, int height) const {
    return Frame(width, height,
                 [&](int x, int y) { return grey(y + 0.5 < start + slope * (x + 0.5) ? 255 : 0); });
  }
};

// A frame with all rows that the line crosses, plus a margin.
Frame line_frame(double slope, double phase, int width) {
  return Line{slope, 3 + phase}.frame(width, static_cast<int>(slope * width) + 8);
}

// The horizontal clean Z runs, in order.
std::vector<PredictedRun> complete_runs(const MorphologicalGolden& golden) {
  std::vector<PredictedRun> runs;
  for (const PredictedRun& run : golden.runs()) {
    if (run.line.run.axis == spec::morphological::Axis::kHorizontal &&
        spec::morphological::kRunShapes[run.line.run.shape].clean_z) {
      runs.push_back(run);
    }
  }
  return runs;
}

TEST(Extension, FollowsStraightLineOnBothSides) {
  Random random(5);
  spec::morphological::Parameters p = preset_parameters(Preset::kDeburrLine);
  p.search_columns = 2048;
  std::size_t inner = 0;
  for (int i = 0; i < 300; ++i) {
    const double slope = 1 / random.uniform(1.05, 12);
    MorphologicalGolden golden(p);
    const Frame frame = line_frame(slope, random.uniform(0, 1), 400);
    golden.process(frame.view());
    const std::vector<PredictedRun> runs = complete_runs(golden);
    for (std::size_t r = 8; r + 8 < runs.size(); ++r) {
      const PredictedRun& run = runs[r];
      ASSERT_EQ(run.line.left_steps, 8);
      ASSERT_EQ(run.line.right_steps, 8);
      EXPECT_EQ(run.left_end, SideEnd::kSteps);
      EXPECT_EQ(run.iterations, 8);
      // The outermost corners are those of the runs eight rows away.
      const int start = run.line.run.start;
      EXPECT_EQ(start + run.far_left, runs[r - 8].line.run.start);
      EXPECT_EQ(start + run.far_right, runs[r + 8].line.run.start + runs[r + 8].line.run.length);
      EXPECT_EQ(run.line.span, run.far_right - run.far_left);
      ++inner;
    }
  }
  EXPECT_GT(inner, 5000u);
}

// Bright above a staircase that rises to the right with steps of these lengths.
Frame staircase(const std::vector<int>& lengths) {
  const int steps = static_cast<int>(lengths.size());
  Frame frame(std::accumulate(lengths.begin(), lengths.end(), 0) + 2, steps + 5,
              [](int, int) { return grey(0); });
  int x = 0;
  for (int i = 0; i < steps; ++i) {
    for (int end = x + lengths[static_cast<std::size_t>(i)]; x < end; ++x) {
      for (int y = 0; y < steps + 3 - i; ++y) frame.at(x, y) = grey(255);
    }
  }
  return frame;
}

// ---- trim ---------------------------------------------------------------------------------------

spec::morphological::Parameters trimmed(Preset preset, bool trim) {
  spec::morphological::Parameters p = preset_parameters(preset);
  p.trim = trim;
  return p;
}

std::vector<PredictedRun> runs_of(const Frame& frame, const spec::morphological::Parameters& p) {
  MorphologicalGolden golden(p);
  golden.process(frame.view());
  return golden.runs();
}

// The horizontal run that begins at column x.
PredictedRun run_at(const Frame& frame, const spec::morphological::Parameters& p, int x) {
  for (const PredictedRun& run : runs_of(frame, p)) {
    if (run.line.run.axis == spec::morphological::Axis::kHorizontal && run.line.run.start == x)
      return run;
  }
  ADD_FAILURE() << "no run begins at column " << x;
  return {};
}

struct Kept {
  int left, right;
  bool operator==(const Kept&) const = default;
};
Kept kept(const PredictedRun& run) { return {run.line.left_steps, run.line.right_steps}; }
void PrintTo(const Kept& k, std::ostream* out) { *out << k.left << " and " << k.right; }

TEST(Trim, KeepsAllStepsAtStepOrRangeLimit) {
  const Frame frame = staircase(std::vector<int>(25, 3));
  spec::morphological::Parameters p = trimmed(Preset::kDeburrLine, true);
  const PredictedRun all = run_at(frame, p, 36);
  EXPECT_EQ(kept(all), (Kept{8, 8}));
  EXPECT_EQ(all.left_end, SideEnd::kSteps);
  // From X = 9, candidate steps of 3, 2 and 4 end at 12, 11 and 13.
  for (const auto& [search_range, steps, end] : {std::tuple{10, 2, SideEnd::kReach},
                                                 {11, 2, SideEnd::kReach},
                                                 {12, 3, SideEnd::kReach},
                                                 {15, 4, SideEnd::kReach}}) {
    p.search_columns = search_range;
    const PredictedRun run = run_at(frame, p, 36);
    EXPECT_EQ(kept(run), (Kept{steps, steps})) << "reach " << search_range;
    EXPECT_EQ(run.right_end, end);
  }
  // A step of 9 loses the line if the largest candidate, 4, was within the search range.
  p.search_columns = 13;
  const Frame bent = staircase({3, 3, 3, 3, 3, 3, 3, 9, 2});
  EXPECT_EQ(kept(run_at(bent, p, 12)).right, 1);
  p.search_columns = 12;
  EXPECT_EQ(kept(run_at(bent, p, 12)).right, 2);
}

// Applies the contract's rule to untrimmed runs of many bends and expects the trimmed runs.
TEST(Trim, KeptStepsMatchContract) {
  Random random(9);
  std::map<std::pair<SideEnd, int>, int> seen;
  const auto expected = [&](SideEnd end, int steps) {
    ++seen[{end, std::min(steps, 3)}];
    if (end == SideEnd::kNoHit) return steps == 0 ? 0 : steps - 1;
    if (end == SideEnd::kInconsistent || end == SideEnd::kCurve) return steps / 2;
    return steps;
  };
  for (int i = 0; i < 600; ++i) {
    // Parabolas of random curvature; every fourth one is a line.
    const double bend = i % 4 == 0 ? 0 : random.uniform(0.002, 0.05),
                 first = random.uniform(1, i % 3 == 0 ? 28 : 6);
    std::vector<int> lengths, corner = {0};
    for (int k = 0; k < 24; ++k) {
      const double at = first * (k + 1) + bend * (k + 1) * (k + 1);
      lengths.push_back(std::max(1, static_cast<int>(at) - corner.back()));
      corner.push_back(corner.back() + lengths.back());
    }
    const Frame frame = staircase(lengths);
    for (const auto preset : {Preset::kDeburrLine, Preset::kMlaaSlope}) {
      spec::morphological::Parameters p = trimmed(preset, false);
      p.window_rows = 20;
      p.search_columns = 30;
      const std::vector<PredictedRun> whole = runs_of(frame, p);
      p.trim = true;
      const std::vector<PredictedRun> cut = runs_of(frame, p);
      ASSERT_EQ(whole.size(), cut.size());
      for (std::size_t r = 0; r < cut.size(); ++r) {
        const PredictedRun &a = whole[r], &b = cut[r];
        ASSERT_EQ(a.line.run, b.line.run);
        EXPECT_EQ(b.line.left_steps, expected(a.left_end, a.line.left_steps));
        EXPECT_EQ(b.line.right_steps, expected(a.right_end, a.line.right_steps));
        EXPECT_EQ(b.line.span, b.far_right - b.far_left);
        // Trials of dropped steps count too; iterations are those of the side with more trials.
        EXPECT_EQ(b.probes, a.probes);
        EXPECT_EQ(b.iterations, a.iterations);
        const auto trials = [](int steps, SideEnd end) {
          return steps + (end == SideEnd::kSteps ? 0 : 1);
        };
        if (preset == Preset::kMlaaSlope && a.left != Outcome::kUntried) {
          EXPECT_EQ(a.iterations, std::max(trials(a.line.left_steps, a.left_end),
                                           trials(a.line.right_steps, a.right_end)));
        }
        if (b.line.run.axis != spec::morphological::Axis::kHorizontal ||
            b.left == Outcome::kUntried)
          continue;
        // The outermost corners are those of the staircase.
        const auto own = std::find(corner.begin(), corner.end(), b.line.run.start);
        ASSERT_NE(own, corner.end());
        if (preset == Preset::kMlaaSlope) continue;  // its hits need not be steps
        EXPECT_EQ(b.far_left, *(own - b.line.left_steps) - *own);
        EXPECT_EQ(b.far_right, *(own + 1 + b.line.right_steps) - *own);
      }
    }
  }
  // Two sides never contradict each other before either has taken a step.
  for (const auto& [end, fewest] : {std::pair{SideEnd::kNoHit, 0},
                                    {SideEnd::kReach, 0},
                                    {SideEnd::kInconsistent, 1},
                                    {SideEnd::kCurve, 0}}) {
    for (int steps = fewest; steps <= 3; ++steps) {
      EXPECT_GT((seen[{end, steps}]), 10) << "end " << static_cast<int>(end) << ", " << steps;
    }
  }
}

}  // namespace
}  // namespace deburr::runs_test
