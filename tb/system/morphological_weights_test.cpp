// SPDX-License-Identifier: MIT
// Learned weights in the hardware model, in whole runs against golden: mirrored frames, loaded
// tables, and coverage: classes of crossings by axis, end and side; parts of runs; and words of the
// three tables, each of which must be read or listed.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "tb/base/forked.h"
#include "tb/harness/coverage.h"
#include "tb/system/morphological_runs.h"

namespace deburr::tb::morphological_system::morphological_weights_test {
namespace {

using rtl::morphological::WeightsRom;
using spec::morphological::Axis;
using spec::morphological::Lanes;
using spec::morphological::RunPart;

// ---- mirrors ------------------------------------------------------------------------------------

constexpr int kWidth = 83, kHeight = 61;

struct Picture {
  std::array<Rgba8, std::size_t{kWidth} * kHeight> pixels{};
};

MorphologicalInput mirrored(const MorphologicalInput& frame, bool sideways, bool upright) {
  return draw(frame.image.width, frame.image.height, [&](int x, int y) {
    return frame.image.at(sideways ? frame.image.width - 1 - x : x,
                          upright ? frame.image.height - 1 - y : y);
  });
}

// The engine's result for a frame, mirrored back.
Picture smoothed(const MorphologicalInput& frame, Lanes lanes, bool sideways, bool upright) {
  return forked<Picture>([&] {
    MorphologicalRunOptions options;
    options.morphological = preset(Preset::kDeburr, lanes);
    options.morphological.window_rows = 34;
    options.morphological.search_columns = 20;
    options.morphological.line_pixels = 128;
    options.descriptors = true;
    const std::vector<MorphologicalInput> frames = {mirrored(frame, sideways, upright)};
    Simulation simulation(options);
    MorphologicalEnvironment environment(simulation, frames, options);
    simulation.elaborate(environment);
    simulation.run();
    environment.check();
    const MorphologicalInput back = mirrored({environment.frame(), {}}, sideways, upright);
    Picture picture;
    std::copy(back.image.pixels.begin(), back.image.pixels.end(), picture.pixels.begin());
    return picture;
  });
}

class Mirrors : public testing::TestWithParam<Lanes> {};

TEST_P(Mirrors, MirroredFrameGivesMirroredResult) {
  for (const MorphologicalInput& frame :
       {blocks(kWidth, kHeight, 3), noise(kWidth, kHeight, 4),
        draw(kWidth, kHeight, [](int x, int y) { return grey((x / 3 + y) % 9 < 4 ? 200 : 30); })}) {
    const Picture as_it_is = smoothed(frame, GetParam(), false, false);
    EXPECT_EQ(smoothed(frame, GetParam(), true, false).pixels, as_it_is.pixels);
    EXPECT_EQ(smoothed(frame, GetParam(), false, true).pixels, as_it_is.pixels);
    EXPECT_EQ(smoothed(frame, GetParam(), true, true).pixels, as_it_is.pixels);
  }
}
INSTANTIATE_TEST_SUITE_P(Each, Mirrors, testing::Values(Lanes::kOne, Lanes::kTwo, Lanes::kFour));

// ---- coverage -----------------------------------------------------------------------------------

constexpr std::array<std::size_t, 3> kWords = {1024, 640, 640};

// Table reads and run descriptors, as plain numbers because they come from another process.
struct Seen {
  std::array<std::array<std::uint64_t, 1024>, 3> words{};
  std::array<std::uint64_t, 2 * 2 * 2 * 9> classes{};  // axis, end, code - 1, class
  std::array<std::uint64_t, 2 * 3 * 2> parts{};        // axis, part, learned
  std::array<std::uint64_t, 16> shapes{};
  std::uint64_t gaps = 0;
};

Seen seen(const spec::morphological::Parameters& parameters,
          const std::vector<MorphologicalInput>& frames) {
  return forked<Seen>([&] {
    MorphologicalRunOptions options;
    options.morphological = parameters;
    options.check_links = false;
    Simulation simulation(options);
    MorphologicalEnvironment environment(simulation, frames, options);
    Seen all;
    environment.engine().area.weights_rom()->observer = [&](const WeightsRom::Query& query) {
      for (const std::size_t side : {0u, 1u}) {
        ++all.words[0][query.a[side]];
        ++all.words[1][query.b[side]];
        ++all.words[2][query.c[side]];
      }
      all.gaps += query.a[0] == 63 && query.b[0] == 31 && query.c[0] == 31;
    };
    environment.engine().observe_lines([&](const spec::morphological::LineDescriptor& line) {
      const auto axis = static_cast<std::size_t>(line.run.axis);
      const auto part = static_cast<std::size_t>(line.run.part);
      ++all.parts[(axis * 3 + part) * 2 + line.learned];
      if (!line.learned) return;
      ++all.shapes[line.run.shape];
      for (const std::size_t end : {0u, 1u}) {
        const auto code =
            static_cast<std::size_t>(end == 0 ? line.run.shape & 3 : line.run.shape >> 2);
        const std::size_t k = end == 0 ? line.start_class : line.end_class;
        if (code == 1 || code == 2) ++all.classes[((axis * 2 + end) * 2 + code - 1) * 9 + k];
      }
    });
    simulation.elaborate(environment);
    simulation.run();
    environment.check();
    return all;
  });
}

// Smallest and largest d of a class of distances; largest 99: unbounded.
std::pair<int, int> distances(int d_class) {
  constexpr std::array<std::pair<int, int>, 8> kDistances = {
      {{0, 0}, {1, 1}, {2, 2}, {3, 3}, {4, 5}, {6, 8}, {9, 15}, {16, 99}}};
  return kDistances[static_cast<std::size_t>(d_class)];
}
std::pair<int, int> lengths(int length_class) {
  constexpr std::array<std::pair<int, int>, 4> kLengths = {{{1, 1}, {2, 3}, {4, 7}, {8, 199}}};
  return kLengths[static_cast<std::size_t>(length_class)];
}

// By enumeration: whether a run of that length has a pixel at that distance from its nearer end, or
// from its farther one. Heads and tails have a nearer end at any distance; an invisible end counts
// as farther than all.
bool can_be_near(int e, int d_class, int length_class) {
  if (length_class == 3 && (e != 0 || d_class == 7)) return true;
  for (int length = lengths(length_class).first; length <= lengths(length_class).second; ++length)
    for (int d = distances(d_class).first; d <= distances(d_class).second; ++d)
      if (2 * d <= length - 1) return true;
  return false;
}
bool can_be_far(int e, int d_class, int length_class) {
  if (e == 0 && d_class == 7 && length_class == 3) return true;
  for (int length = lengths(length_class).first; length <= lengths(length_class).second; ++length)
    for (int d = distances(d_class).first; d <= distances(d_class).second; ++d)
      if (2 * d >= length - 1 && d <= length - 1) return true;
  return false;
}

void add(Coverage& coverage, const Seen& s) {
  constexpr std::array<const char*, 2> kAxes = {"horizontal", "vertical"}, kEnds = {"start", "end"},
                                       kSides = {"first", "second"};
  constexpr std::array<const char*, 3> kParts = {"whole", "head", "tail"};
  const auto count = [&](const std::string& bin, std::uint64_t hits) {
    coverage.declare(bin);
    coverage.hit(bin, hits);
  };
  for (std::size_t i = 0; i < s.classes.size(); ++i)
    count(fmt::format("class/{}/{}/{}/{}", kAxes[i / 36], kEnds[i / 18 % 2], kSides[i / 9 % 2],
                      i % 9),
          s.classes[i]);
  for (std::size_t i = 0; i < s.parts.size(); ++i)
    if (i / 2 % 3 == 0 || i % 2 == 1)  // heads and tails are learned
      count(
          fmt::format("part/{}/{}/{}", kAxes[i / 6], kParts[i / 2 % 3], i % 2 ? "learned" : "line"),
          s.parts[i]);
  for (std::size_t i = 0; i < s.shapes.size(); ++i)
    count(fmt::format("shape/{}", spec::morphological::kRunShapes[i].name), s.shapes[i]);
  count("gap", s.gaps);
}

TEST(WeightsCoverage, EveryClassAndReachableWordIsRead) {
  spec::morphological::Parameters p = preset(Preset::kDeburr);
  p.local_contrast = spec::morphological::LocalContrast::kOff;
  p.line_pixels = 512;
  Random random(23);
  Coverage coverage;
  std::array<std::set<std::size_t>, 3> asked;
  for (int round = 0; round < 4; ++round) {
    std::vector<MorphologicalInput> frames;
    for (int i = 0; i < 6; ++i) {
      // Sparse to dense edges; blocks with long sides; and runs longer than the search range.
      const std::uint32_t dark =
          std::array<std::uint32_t, 6>{20, 60, 150, 300, 500, 0}[static_cast<std::size_t>(i)];
      frames.push_back(
          dark != 0 ? draw(180, 140, [&](int, int) { return grey(random.chance(dark) ? 20 : 220); })
                    : blocks(400, 150, random.next()));
      // Bands with gaps and knots: long runs with every crossing at their ends.
      const int apart = 2 + static_cast<int>(random.below(5));
      MorphologicalInput bands = draw(400, 100, [&](int x, int y) {
        const bool band = (i % 2 != 0 ? x : y) % (2 * apart) < apart;
        return grey(band != random.chance(12) ? 200 : 40);
      });
      frames.push_back(std::move(bands));
    }
    spec::morphological::Parameters q = p;
    q.lanes = static_cast<Lanes>(round % 3);
    q.window_rows = round % 2 != 0 ? 26 : 66;
    q.search_columns = round % 2 != 0 ? 24 : 256;
    q.steps = 4;
    const Seen s = seen(q, frames);
    add(coverage, s);
    for (std::size_t table = 0; table < 3; ++table)
      for (std::size_t word = 0; word < kWords[table]; ++word)
        if (s.words[table][word] != 0) asked[table].insert(word);
  }
  EXPECT_TRUE(coverage.holes().empty()) << testing::PrintToString(coverage.holes());
  EXPECT_EQ(coverage.size(), 72u + 8 + 16 + 1);

  // Unreachable words are never read. Most of the words that the page allows are read; the rest is
  // listed, including some that only seem reachable here.
  constexpr std::array<std::size_t, 3> kNamed = {532, 300, 220};
  std::string rest;
  for (std::size_t table = 0; table < 3; ++table)
    for (std::size_t word = 0; word < kWords[table]; ++word) {
      const auto w = static_cast<int>(word);
      const bool can = table == 0   ? (w >> 3 & 7) <= (w & 7)
                       : table == 1 ? can_be_near(w >> 5, w >> 2 & 7, w & 3)
                                    : can_be_far(w >> 5, w >> 2 & 7, w & 3);
      const bool was = asked[table].contains(word);
      EXPECT_TRUE(can || !was) << "weights_"
                               << "abc"[table] << ' ' << word;
      if (can && !was) rest += fmt::format(" {}{}", "abc"[table], word);
    }
  for (std::size_t table = 0; table < 3; ++table) {
    EXPECT_LE(asked[table].size(), kNamed[table]);
    EXPECT_GE(asked[table].size() * 100, kNamed[table] * 92)
        << asked[table].size() << " of table " << table << ", not asked:" << rest;
  }
}

}  // namespace
}  // namespace deburr::tb::morphological_system::morphological_weights_test
