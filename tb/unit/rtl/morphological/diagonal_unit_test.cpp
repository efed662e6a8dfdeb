// SPDX-License-Identifier: MIT
// DiagonalUnit against the golden model's function, bit-exact: random edges and stairs in rows of
// any number of beats; its cycles and its ports.
#include <cstdint>
#include <string>
#include <vector>

#include "golden/morphological/diagonals.h"
#include "tb/base/random.h"
#include "tb/unit/rtl/datasheets.h"
#include "tb/unit/rtl/morphological/parts.h"

namespace deburr::tb::morphological_rtl::diagonal_unit_test {
namespace {

using namespace rtl::morphological;  // NOLINT: a test of these
using golden::morphological::BitPlane;
using golden::morphological::diagonal_weights;
using golden::morphological::DiagonalEnds;
using golden::morphological::DiagonalWeights;
using golden::morphological::EdgePlanes;
using golden::morphological::falling_diagonal;
using golden::morphological::rising_diagonal;
using spec::morphological::kMaxDiagonalSteps;
namespace reg = spec::morphological::reg;

constexpr Cycle kStages = 5;

// The build of a unit: M, and the lanes.
struct Build {
  int steps, lanes_code;
};
void PrintTo(const Build& b, std::ostream* out) {
  *out << "M = " << b.steps << ", lanes code " << b.lanes_code;
}

Parameters built_as(const Build& build) {
  Parameters p = smaa(spec::morphological::Quality::kUltra);
  p.diagonal_steps = build.steps;
  p.border = spec::morphological::Border::kEnd;
  p.lanes = static_cast<spec::morphological::Lanes>(build.lanes_code);
  p.line_pixels = 128;
  return p;
}

// columns -> DiagonalUnit -> one word per beat.
struct Diagonals {
  explicit Diagonals(const Parameters& p, Cycle opens = 0)
      : built(p.diagonal_steps),
        lanes(lanes_of(p)),
        search_range(search_range_of(p)),
        registers(p),
        columns("columns", 2, diagonal_columns_shape(p, lanes)),
        unit("diagonals", clock, p),
        gate("gate", clock, opens) {
    unit.configuration_in(registers.configuration);
    driver.out(columns);
    unit.columns_in(columns);
    gate.in(unit.weights());
  }
  int beats(const EdgePlanes& edges) const { return (edges.top.width() + lanes - 1) / lanes; }
  std::size_t words(const EdgePlanes& edges) const {
    return static_cast<std::size_t>(beats(edges)) * static_cast<std::size_t>(edges.top.height());
  }
  Cycle delay() const { return static_cast<Cycle>(diagonal_delay(built, lanes)); }

  // Columns of a beat around row y, as the RunExtractor forwards them.
  DiagonalColumnsToken token(const EdgePlanes& edges, int y, int beat) const {
    DiagonalColumnsToken t{};
    t.slot = {static_cast<std::uint32_t>((y + search_range + 3) * beats(edges) + beat),
              static_cast<std::uint16_t>(y + search_range + 3), static_cast<std::uint16_t>(beat)};
    for (int lane = 0; lane < lanes; ++lane)
      for (int k = 0; k <= 2 * built; ++k) {
        const int x = beat * lanes + lane;
        const auto i = static_cast<std::size_t>(lane);
        t.left[i] |= std::uint64_t{edges.left.at(x, y + k - built)} << k;
        t.top[i] |= std::uint64_t{edges.top.at(x, y + k - built)} << k;
      }
    return t;
  }
  // Sends a frame at one beat per cycle from the next cycle on, with `gap` idle cycles between
  // rows.
  void send(const EdgePlanes& edges, Cycle gap = 0) {
    registers.frame(edges.top.width(), edges.top.height(), clock.cycle());
    Cycle at = clock.cycle();
    for (int y = 0; y < edges.top.height(); ++y, at += gap)
      for (int beat = 0; beat < beats(edges); ++beat) driver.add(at++, token(edges, y, beat));
  }
  // Runs a frame and returns its words. In rows with fewer beats than a diagonal needs, it pauses
  // after each row as the RunExtractor does.
  std::vector<DiagonalWeightsToken> run(const EdgePlanes& edges) {
    const std::size_t before = gate.taken.size(), wanted = before + words(edges);
    send(edges, static_cast<Cycle>(beats(edges)) < delay() ? delay() : 0);
    clock.run_until([&] { return gate.taken.size() >= wanted; }, 1'000'000);
    clock.run(delay() + 20);
    const auto tokens = tokens_of(gate);
    return {tokens.begin() + static_cast<std::ptrdiff_t>(before), tokens.end()};
  }

  const int built, lanes, search_range;
  ClockDomain clock{"clock", period()};
  Registers registers;
  Link<DiagonalColumnsToken> columns;
  unit_bench::Source<DiagonalColumnsToken> driver{"driver", clock};
  DiagonalUnit unit;
  unit_bench::Sink<DiagonalWeightsToken> gate;
};

// The golden model's words for a frame, and the number of table entries that it has read.
struct Expected {
  std::vector<DiagonalWeightsToken> words;
  std::uint64_t taken = 0, reads = 0;
};

// `margin`: width of a border around the frame that is not part of it.
Expected expected(const EdgePlanes& edges, int steps, int lanes, int margin = 0) {
  const int width = edges.top.width() - 2 * margin;
  Expected all;
  for (int y = margin; y < edges.top.height() - margin; ++y)
    for (int x0 = 0; x0 < width; x0 += lanes) {
      DiagonalWeightsToken word{};
      for (int lane = 0; lane < std::min(lanes, width - x0); ++lane) {
        const int x = margin + x0 + lane;
        if (steps == 0 || !edges.top.at(x, y)) continue;
        const DiagonalEnds rising = rising_diagonal(edges, steps, x, y),
                           falling = falling_diagonal(edges, steps, x, y);
        all.reads += std::uint64_t{rising.counts()} + std::uint64_t{falling.counts()};
        const DiagonalWeights weights = diagonal_weights(rising, falling);
        if (!weights.taken()) continue;
        ++all.taken;
        const auto i = static_cast<std::size_t>(lane);
        word.taken = static_cast<std::uint8_t>(word.taken | 1u << lane);
        word.first[i] = static_cast<std::uint8_t>(std::min(255, weights.first));
        word.second[i] = static_cast<std::uint8_t>(std::min(255, weights.second));
        word.span[i] = static_cast<std::uint8_t>(weights.span);
      }
      all.words.push_back(word);
    }
  return all;
}

// Lanes without a diagonal hold stale bits and are not compared.
std::size_t differences(const std::vector<DiagonalWeightsToken>& got, const Expected& want) {
  if (got.size() != want.words.size()) return 1'000'000 + got.size();
  std::size_t count = 0;
  for (std::size_t i = 0; i < got.size(); ++i) {
    count += got[i].taken != want.words[i].taken;
    for (std::size_t lane = 0; lane < 4; ++lane)
      if (got[i].taken & want.words[i].taken & 1u << lane)
        count += got[i].first[lane] != want.words[i].first[lane] ||
                 got[i].second[lane] != want.words[i].second[lane] ||
                 got[i].span[lane] != want.words[i].span[lane];
  }
  return count;
}

EdgePlanes empty(int width, int height) {
  return {BitPlane(width, height), BitPlane(width, height)};
}

// Random edges, and stairs in both directions on top of them, with random gaps.
EdgePlanes random_edges(int width, int height, std::uint64_t seed) {
  Random random(seed);
  EdgePlanes edges = empty(width, height);
  const std::uint32_t density = 50 + random.below(700);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      // Edges never lie on the border.
      if (x > 0 && random.chance(density)) edges.left.set(x, y);
      if (y > 0 && random.chance(density)) edges.top.set(x, y);
    }
  for (int stair = 0; stair < width * height / 60; ++stair) {
    const int x0 = random.between(0, width - 1), y0 = random.between(0, height - 1),
              length = random.between(1, 40);
    const bool rises = random.chance(500);
    for (int i = 0; i < length; ++i) {
      const int x = x0 + i, y = rises ? y0 - i : y0 + i, side = rises ? x : x + 1;
      if (x >= width || y < 1 || y >= height) break;
      if (!random.chance(20)) edges.top.set(x, y);
      if (side > 0 && side < width && !random.chance(20)) edges.left.set(side, y);
    }
  }
  return edges;
}

// ---- results ------------------------------------------------------------------------------------

class DiagonalBuilds : public ::testing::TestWithParam<Build> {};

// Rows of 1 to 2 M + 3 columns, with fewer and with more beats than a diagonal needs.
TEST_P(DiagonalBuilds, RandomEdgesMatchGolden) {
  const Parameters p = built_as(GetParam());
  Diagonals bench(p);
  std::uint64_t taken = 0;
  const auto compare = [&](int width, int height, int seed) {
    const EdgePlanes edges = random_edges(width, height, static_cast<std::uint64_t>(seed));
    const Expected want = expected(edges, p.diagonal_steps, bench.lanes);
    EXPECT_EQ(differences(bench.run(edges), want), 0u) << width << 'x' << height << ' ' << seed;
    taken += want.taken;
  };
  for (int seed = 1; seed <= 6; ++seed) compare(75, 50, seed);
  for (int width = 1; width <= 2 * p.diagonal_steps + 3; ++width) compare(width, 20, width);
  EXPECT_EQ(bench.unit.diagonal_pixels.value(), taken);
  if (p.diagonal_steps == 1) {
    EXPECT_EQ(taken, 0u) << "with one step d1 + d2 is never above 2";
  } else {
    EXPECT_GT(taken, 1'500u);
  }
}

INSTANTIATE_TEST_SUITE_P(Each, DiagonalBuilds,
                         ::testing::Values(Build{1, 0}, Build{2, 1}, Build{3, 2}, Build{8, 0},
                                           Build{8, 1}, Build{8, 2}, Build{15, 0}, Build{16, 0},
                                           Build{16, 1}, Build{16, 2}));

// With border = clamp, pixels beyond the frame have the edges of the nearest pixel: the expected
// words are those of a frame that contains these pixels. In the narrowest frames the next row
// starts while pixels of this row are still in the unit.
TEST_P(DiagonalBuilds, ClampRepeatsBorderEdges) {
  Parameters p = built_as(GetParam());
  p.border = spec::morphological::Border::kClamp;
  const int m = p.diagonal_steps, margin = m + 2;
  Diagonals bench(p);
  std::size_t changed = 0;
  for (int width = 1; width <= 2 * m + 3 + 2 * bench.lanes; ++width)
    for (const int height : {1, 2, 12}) {
      const EdgePlanes edges = random_edges(width, height, static_cast<std::uint64_t>(width));
      EdgePlanes wide = empty(width + 2 * margin, height + 2 * margin);
      for (int y = 0; y < height + 2 * margin; ++y)
        for (int x = 0; x < width + 2 * margin; ++x) {
          const int u = std::clamp(x - margin, 0, width - 1),
                    v = std::clamp(y - margin, 0, height - 1);
          if (edges.left.at(u, v)) wide.left.set(x, y);
          if (edges.top.at(u, v)) wide.top.set(x, y);
        }
      const Expected want = expected(wide, m, bench.lanes, margin);
      const auto got = bench.run(edges);
      EXPECT_EQ(differences(got, want), 0u) << width << 'x' << height;
      changed += differences(got, expected(edges, m, bench.lanes));
    }
  if (m > 1) {
    EXPECT_GT(changed, m == 2 ? 3u : 20u) << "the border shows nowhere";
  }
}

// The register selects fewer steps than were built; one step more or less would be noticed.
TEST(DiagonalUnitBlock, RegisterLimitsTheSteps) {
  const Parameters p = built_as({kMaxDiagonalSteps, 0});
  const EdgePlanes edges = random_edges(90, 60, 5);
  Diagonals bench(p);
  for (const int steps : {1, 2, 3, 7, 8, 15, 16, 31}) {
    bench.registers.bus.write(reg::kSmaa, static_cast<std::uint32_t>(steps) << 8);
    const auto words = bench.run(edges);
    const int used = std::min(steps, kMaxDiagonalSteps);
    EXPECT_EQ(differences(words, expected(edges, used, 1)), 0u) << steps;
    for (const int other : {used - 1, used + 1})
      if (other >= 1) {
        EXPECT_GT(differences(words, expected(edges, other, 1)), 0u) << steps << " as " << other;
      }
  }
}

// ---- cycles -------------------------------------------------------------------------------------

class DiagonalCycles : public ::testing::TestWithParam<Build> {};

// One beat per cycle goes in and one word per cycle comes out, D + 5 cycles after its columns,
// without edges and with all edges set.
TEST_P(DiagonalCycles, LatencyMatchesDatasheet) {
  const Parameters p = built_as(GetParam());
  Diagonals bench(p);
  const Cycle latency = DiagonalUnit::datasheet(p).latency.cycles;
  const int width = 3 * (p.diagonal_steps + 1) + 1;
  Cycle idle = 0, cycles = 0;
  for (const bool all : {false, true}) {
    EdgePlanes edges = empty(width, 9);
    for (int y = 0; all && y < 9; ++y)
      for (int x = 0; x < width; ++x) {
        edges.left.set(x, y);
        edges.top.set(x, y);
      }
    const Cycle begins = bench.clock.cycle();
    const std::size_t first = bench.gate.taken.size();
    ASSERT_EQ(bench.run(edges).size(), bench.words(edges));
    for (std::size_t i = 0; i < bench.words(edges); ++i)
      // Sent in k, popped in k + 1, taken `latency` cycles later.
      ASSERT_EQ(bench.gate.taken[first + i].cycle, begins + i + 1 + latency) << i;
    idle = bench.unit.idle_cycles();
    cycles = bench.clock.cycle();
  }
  EXPECT_EQ(stalls(bench.unit, "downstream"), 0u);
  EXPECT_EQ(bench.unit.busy_cycles() + idle, cycles);
  // Four bubbles follow each last beat, then the shifts that end the row.
  const EdgePlanes edges = empty(width, 9);
  EXPECT_EQ(bench.unit.busy_cycles(), 2 * (bench.words(edges) + bench.delay() + kStages - 1));
}

// A row finishes even if no further beats come, by the same number of shifts: a word of the row's
// last D beats does not wait for the next row.
TEST_P(DiagonalCycles, RowFinishesWithoutTheNextRow) {
  const Parameters p = built_as(GetParam());
  Diagonals bench(p);
  const EdgePlanes edges = random_edges(3 * p.diagonal_steps + 8, 6, 9);
  const Cycle gap = 3 * bench.delay() + 20;
  bench.send(edges, gap);
  const auto beats = static_cast<std::size_t>(bench.beats(edges));
  bench.clock.run(static_cast<Cycle>(bench.words(edges)) + 7 * gap);
  EXPECT_EQ(differences(tokens_of(bench.gate), expected(edges, p.diagonal_steps, bench.lanes)), 0u);
  ASSERT_EQ(bench.gate.taken.size(), bench.words(edges));
  for (std::size_t i = 0; i < bench.words(edges); ++i)
    ASSERT_EQ(bench.gate.taken[i].cycle, i + i / beats * gap + 1 + bench.delay() + kStages) << i;
}

// A gap inside a row delays everything older than the newest columns; nothing is lost.
TEST_P(DiagonalCycles, GapInARowLosesNothing) {
  const Parameters p = built_as(GetParam());
  Diagonals bench(p);
  const EdgePlanes edges = random_edges(4 * p.diagonal_steps + 9, 5, 2);
  bench.registers.frame(edges.top.width(), edges.top.height());
  Random random(4);
  Cycle at = 0;
  std::vector<Cycle> sent;
  for (int y = 0; y < 5; ++y)
    for (int beat = 0; beat < bench.beats(edges); ++beat) {
      at += random.chance(300) ? random.below(30) : 1;
      sent.push_back(at);
      bench.driver.add(at++, bench.token(edges, y, beat));
    }
  bench.clock.run(at + 2 * bench.delay() + 40);
  EXPECT_EQ(differences(tokens_of(bench.gate), expected(edges, p.diagonal_steps, bench.lanes)), 0u);
  for (std::size_t i = 0; i < bench.gate.taken.size(); ++i) {
    EXPECT_GE(bench.gate.taken[i].cycle, sent[i] + 1 + bench.delay() + kStages);
  }
}
INSTANTIATE_TEST_SUITE_P(Each, DiagonalCycles,
                         ::testing::Values(Build{1, 0}, Build{8, 0}, Build{8, 1}, Build{8, 2},
                                           Build{16, 0}, Build{16, 2}));

// The FIFO holds one row and 16 beats; once it is full, the whole unit stalls.
TEST(DiagonalUnitBlock, StallsBeyondOneRowAndSixteenBeats) {
  Parameters p = built_as({8, 0});
  p.line_pixels = 50;
  constexpr Cycle kOpens = 150;
  Diagonals bench(p, kOpens);
  const EdgePlanes edges = random_edges(50, 8, 6);
  bench.send(edges);
  bench.clock.run(kOpens + 450);
  EXPECT_EQ(differences(tokens_of(bench.gate), expected(edges, 8, 1)), 0u);
  // Word i would be pushed in i + D + 5; word 66 waits until the first one is taken.
  constexpr Cycle kPush = 9 + 5;
  EXPECT_EQ(stalls(bench.unit, "downstream"), kOpens + 1 - (66 + kPush));
  for (std::size_t i = 0; i < bench.gate.taken.size(); ++i)
    ASSERT_EQ(bench.gate.taken[i].cycle, kOpens + i);
}

// ---- memories and ports -------------------------------------------------------------------------

template <class Memory = rtl::MemoryBase>
Memory& memory_of(Diagonals& bench, const std::string& name) {
  Memory* found = nullptr;
  rtl::for_each<rtl::MemoryBase>(bench.unit, [&](rtl::MemoryBase& memory) {
    if (memory.basename() == name) found = dynamic_cast<Memory*>(&memory);
  });
  if (found == nullptr) throw std::runtime_error("no memory " + name);
  return *found;
}
using Rom = rtl::Memory<std::uint16_t>;

// Ports match the table of the contract. Reads are limited to the directions that count.
TEST_P(DiagonalCycles, PortsAndAccessesMatchTheContract) {
  const Parameters p = built_as(GetParam());
  Diagonals bench(p);
  const auto lanes = static_cast<std::uint64_t>(bench.lanes),
             m = static_cast<std::uint64_t>(p.diagonal_steps),
             d = static_cast<std::uint64_t>(bench.delay());
  EXPECT_EQ(d, (m + lanes) / lanes);
  Rom& rom = memory_of<Rom>(bench, "diagonal_rom");
  EXPECT_EQ(rom.shape().words, 6400u);
  EXPECT_EQ(rom.shape().word_bits, 16u);
  EXPECT_EQ(rom.shape().kind, rtl::MemoryKind::kRom);
  EXPECT_EQ(rom.shape().latency, 1u);
  EXPECT_EQ(rom.shape().read_ports, 2 * lanes);
  auto& window = memory_of<rtl::PortedMemory>(bench, "diagonal_window");
  EXPECT_EQ(window.shape().words, (d + 1) * lanes + m + 1);
  EXPECT_EQ(window.shape().word_bits, 4 * m + 2 + 7);
  EXPECT_EQ(window.shape().kind, rtl::MemoryKind::kFlops);
  const rtl::MemoryBase& fifo = memory_of(bench, "diagonal_weights");
  EXPECT_EQ(fifo.shape().words, (128 + lanes - 1) / lanes + 16);
  EXPECT_EQ(fifo.shape().word_bits, 23 * lanes);
  for (const rtl::MemoryBase* memory : {static_cast<const rtl::MemoryBase*>(&rom),
                                        static_cast<const rtl::MemoryBase*>(&window), &fifo})
    EXPECT_EQ(memory->not_implementable(), "") << memory->name();

  const EdgePlanes edges = random_edges(70, 30, 8);
  bench.run(edges);
  EXPECT_EQ(rom.reads(), expected(edges, p.diagonal_steps, bench.lanes).reads);
  // One write per shift; all words are read at fixed bits. D more shifts follow the last beat.
  EXPECT_EQ(window.writes(), bench.words(edges) + bench.delay());
  EXPECT_EQ(window.reads(), bench.words(edges) + bench.delay());
}

// 16 steps in either direction and the row between them. No engine is built with more steps.
TEST(DiagonalTokens, ColumnsHaveOneBitPerRow) {
  const rtl::Payload columns = rtl::Payload::of<DiagonalColumnsToken>();
  EXPECT_EQ(columns.find("left.0")->bits, 33u);
  EXPECT_EQ(columns.find("top.0")->bits, 33u);
}

// Reads the word one stage early.
TEST(DiagonalUnitMemory, RomWordNeedsOneCycleAfterItsAddress) {
  const Parameters p = built_as({8, 0});
  Diagonals bench(p);
  EdgePlanes edges = empty(40, 20);  // a falling stair
  for (int i = 0; i <= 6; ++i) {
    edges.top.set(i, i);
    edges.left.set(i + 1, i);
  }
  bench.send(edges);
  // The first pixel is popped in 1.
  const Cycle addressed = 1 + bench.delay() + 3;
  bench.clock.run(addressed + 1);
  expect_used_early(bench.unit, bench.clock, "diagonal_rom");
}

// Flips bits of one plane in one row.
TEST(DiagonalFault, FlippedEdgeIsNoticed) {
  const Parameters p = built_as({8, 0});
  Diagonals bench(p);
  EdgePlanes edges = random_edges(75, 60, 3);
  const Expected want = expected(edges, 8, 1);
  edges.left.row(30)[0] ^= std::uint64_t{0xFFFF} << 20;
  EXPECT_GT(differences(bench.run(edges), want), 0u);
}

}  // namespace
}  // namespace deburr::tb::morphological_rtl::diagonal_unit_test
