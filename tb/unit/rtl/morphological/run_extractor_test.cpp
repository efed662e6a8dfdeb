// SPDX-License-Identifier: MIT
// RunExtractor: every run once, its record to the clock, and what counts as waiting.
#include <map>
#include <numeric>
#include <set>
#include <string>
#include <tuple>

#include "tb/base/random.h"
#include "tb/unit/rtl/datasheets.h"
#include "tb/unit/rtl/morphological/edge_memories.h"
#include "tb/unit/rtl/morphological/parts.h"

namespace deburr::tb::morphological_rtl::run_extractor_test {
namespace {

using namespace rtl::morphological;  // NOLINT: a test of these
using rtl::Activity;
using spec::morphological::Axis;
using spec::morphological::Preset;
using spec::morphological::RunDescriptor;
using spec::morphological::RunPart;

namespace reg = spec::morphological::reg;

// Takes every record and finishes it some cycles later, at random.
class Finisher final : public rtl::Unit {
 public:
  LanePorts<rtl::In<RunToken>> h, v;
  rtl::Out<FinishToken> finished_out{"finished_out"};
  rtl::WireIn<FrameConfiguration> configuration_in{"configuration_in"};
  Finisher(const sc_core::sc_module_name& name, ClockDomain& clock, int lanes)
      : Unit(name, clock), h("h", lanes), v("v", lanes), lanes_(static_cast<std::size_t>(lanes)) {}
  Activity tick(Cycle cycle) override {
    for (LanePorts<rtl::In<RunToken>>* ports : {&h, &v})
      for (std::size_t lane = 0; lane < lanes_; ++lane) {
        rtl::In<RunToken>& in = (*ports)[lane];
        if (!in.can_pop(cycle) || random.chance(wait_permille)) continue;
        ++pending_[in.front(cycle).slot / configuration_in.read(cycle).beats & 1];
        tokens.push_back({cycle, in.take(cycle)});
      }
    if ((pending_[0] | pending_[1]) && !random.chance(wait_permille)) {
      finished_out.push(cycle, {pending_});
      pending_ = {};
    }
    return rtl::kBusy;
  }
  void reset() override {}
  std::size_t lanes() const { return lanes_; }
  struct Taken {
    Cycle cycle;
    RunToken token;
  };
  std::vector<Taken> tokens;
  std::uint32_t wait_permille = 0;
  Random random{1};

 private:
  const std::size_t lanes_;
  std::array<std::uint8_t, 2> pending_{};
};

struct Planes {
  int width, height;
  std::vector<bool> left, top;
  Planes(int w, int h)
      : width(w),
        height(h),
        left(static_cast<std::size_t>(w * h)),
        top(static_cast<std::size_t>(w * h)) {}
  bool left_at(int x, int y) const {
    return x >= 0 && y >= 0 && x < width && y < height &&
           left[static_cast<std::size_t>(y * width + x)];
  }
  bool top_at(int x, int y) const {
    return x >= 0 && y >= 0 && x < width && y < height &&
           top[static_cast<std::size_t>(y * width + x)];
  }
};

// A plane as its nearest pixel has it, beyond the frame too.
Planes clamped(const Planes& planes, int margin) {
  Planes wide(planes.width + 2 * margin, planes.height + 2 * margin);
  for (int y = 0; y < wide.height; ++y)
    for (int x = 0; x < wide.width; ++x) {
      const int u = std::clamp(x - margin, 0, planes.width - 1),
                v = std::clamp(y - margin, 0, planes.height - 1);
      wide.left[static_cast<std::size_t>(y * wide.width + x)] = planes.left_at(u, v);
      wide.top[static_cast<std::size_t>(y * wide.width + x)] = planes.top_at(u, v);
    }
  return wide;
}

// Word for word from the contract, on whole planes.
std::vector<RunDescriptor> runs_by_definition(const Planes& planes,
                                              const Parameters& configuration) {
  const bool clamp = configuration.border == spec::morphological::Border::kClamp;
  constexpr int kMargin = 2;
  const Planes around = clamped(planes, kMargin);
  // Edges about a corner, which beyond the frame are nothing or those of the nearest pixel.
  const auto left_at = [&](int x, int y) {
    return clamp ? around.left_at(x + kMargin, y + kMargin) : planes.left_at(x, y);
  };
  const auto top_at = [&](int x, int y) {
    return clamp ? around.top_at(x + kMargin, y + kMargin) : planes.top_at(x, y);
  };
  const bool crossings = configuration.ends == spec::morphological::Ends::kCrossings;
  const int search_rows = search_range_of(configuration),
            search_columns = configuration.search_columns;
  const bool corners = configuration.round_corners;
  std::vector<RunDescriptor> found;
  for (const bool vertical : {false, true}) {
    const int lines = vertical ? planes.width : planes.height;
    const int length = vertical ? planes.height : planes.width;
    const int search_range = vertical ? search_rows : search_columns;
    const auto along = [&](int p, int q) {
      return vertical ? planes.left_at(q, p) : planes.top_at(p, q);
    };
    const auto code = [&](int p, int q) {
      const bool first = vertical ? top_at(q - 1, p) : left_at(p, q - 1);
      const bool second = vertical ? top_at(q, p) : left_at(p, q);
      return (first ? 1 : 0) + (second ? 2 : 0);
    };
    const auto far = [&](int at, int q) {
      if (!corners || (at == length && code(at, q) == 0)) return 0;
      const bool first = vertical ? top_at(q - 2, at) : left_at(at, q - 2);
      const bool second = vertical ? top_at(q + 1, at) : left_at(at, q + 1);
      return (first ? 1 : 0) + (second ? 2 : 0);
    };
    for (int q = 0; q < lines; ++q)
      for (int p = 0; p < length; ++p) {
        const auto crossed = [&](int at) { return crossings && code(at, q) != 0; };
        if (!along(p, q) || (along(p - 1, q) && !crossed(p))) continue;
        int end = p + 1;
        while (along(end, q) && !crossed(end)) ++end;
        const int endless_start = clamp && p == 0,
                  endless_end = clamp && end == length && code(end, q) == 0;
        const auto add = [&](RunPart part, int start, int size, int shape, int sharp, int endless) {
          found.push_back({vertical ? Axis::kVertical : Axis::kHorizontal, part,
                           static_cast<std::uint16_t>(q), static_cast<std::uint16_t>(start),
                           static_cast<std::uint16_t>(size), static_cast<std::uint8_t>(shape),
                           static_cast<std::uint8_t>(sharp), static_cast<std::uint8_t>(endless)});
        };
        if (end - p > search_range) {
          add(RunPart::kHead, p, search_range / 2, code(p, q), far(p, q), endless_start);
          add(RunPart::kTail, end - search_range / 2, search_range / 2, 4 * code(end, q),
              4 * far(end, q), 2 * endless_end);
        } else {
          add(RunPart::kWhole, p, end - p, code(p, q) + 4 * code(end, q),
              far(p, q) + 4 * far(end, q), endless_start + 2 * endless_end);
        }
      }
  }
  return found;
}

auto key(const RunDescriptor& r) {
  return std::tuple(r.axis, r.line, r.start, r.part, r.length, r.shape);
}

struct Extraction {
  explicit Extraction(const Parameters& p)
      : registers(p),
        memories(p),
        extractor("extractor", clock, p, memories.window, memories.rows),
        finisher("finisher", clock, lanes_of(p)) {
    extractor.configuration_in(registers.configuration);
    finisher.configuration_in(registers.configuration);
    driver.beats_out(edges);
    extractor.edges_in(edges);
    extractor.finished_in(finished);
    extractor.area_slots_out(area_slots);
    extractor.fetches_out(fetches);
    area_sink.beats_in(area_slots);
    fetch_sink.beats_in(fetches);
    finisher.finished_out(finished);
    for (std::size_t lane = 0; lane < finisher.lanes(); ++lane) {
      finisher.h[lane](extractor.descriptors(Axis::kHorizontal, lane));
      finisher.v[lane](extractor.descriptors(Axis::kVertical, lane));
    }
    extractor.observer = [this](const RunDescriptor& run) { runs.push_back(run); };
  }
  void send(const Planes& planes) {
    registers.frame(planes.width, planes.height, clock.cycle());
    const FrameConfiguration configuration = registers.configuration.driven();
    const auto lanes = static_cast<int>(finisher.lanes());
    std::uint32_t number = 0;
    for (std::uint32_t row = 0; row < configuration.rows; ++row)
      for (std::uint32_t beat = 0; beat < configuration.beats; ++beat) {
        EdgeToken token{};
        token.slot = {number++, static_cast<std::uint16_t>(row), static_cast<std::uint16_t>(beat)};
        for (int i = 0; i < lanes; ++i) {
          const int x = static_cast<int>(beat) * lanes + i, y = static_cast<int>(row) - 1;
          token.left = static_cast<std::uint8_t>(token.left | int{planes.left_at(x, y)} << i);
          token.top = static_cast<std::uint8_t>(token.top | int{planes.top_at(x, y)} << i);
        }
        driver.send(token);
        ++slots;
      }
  }
  void run(const Planes& planes) {
    send(planes);
    ASSERT_TRUE(clock.run_until([&] { return area_sink.received() == slots; }, 2'000'000));
    clock.run(100);
  }

  ClockDomain clock{"clock", period()};
  Registers registers;
  EdgeMemories memories;
  RunExtractor extractor;
  Finisher finisher;
  Link<EdgeToken> edges{"edges"};
  Link<FinishToken> finished{"finished"};
  Link<AreaSlotToken> area_slots{"area_slots"};
  Link<FetchToken> fetches{"fetches"};
  Driver<EdgeToken> driver{"driver", clock};
  Sink<AreaSlotToken> area_sink{"area_sink", clock};
  Sink<FetchToken> fetch_sink{"fetch_sink", clock};
  std::vector<RunDescriptor> runs;
  std::uint64_t slots = 0;
};

struct Extract {
  int width, height, lanes_code, search_rows, search_columns;
  std::uint32_t permille, wait_permille;
};
void PrintTo(const Extract& e, std::ostream* out) {
  *out << e.width << 'x' << e.height << " lanes code " << e.lanes_code;
}
class RunExtraction : public ::testing::TestWithParam<Extract> {};

void extract(const Extract& e, spec::morphological::Ends ends, bool corners, bool learned = false,
             bool clamp = false);

// Planes that no image gives: every code at both ends, runs of all lengths, long runs.
TEST_P(RunExtraction, FindsEveryRunOnce) {
  extract(GetParam(), spec::morphological::Ends::kGaps, false);
}
TEST_P(RunExtraction, EndsRunsAtCrossings) {
  extract(GetParam(), spec::morphological::Ends::kCrossings, false);
}
TEST_P(RunExtraction, KeepsRecordsWithoutASideForLearnedShares) {
  extract(GetParam(), spec::morphological::Ends::kGaps, false, true);
}
TEST_P(RunExtraction, KeepsThemAtCrossings) {
  extract(GetParam(), spec::morphological::Ends::kCrossings, false, true);
}
TEST_P(RunExtraction, FindsSharpCorners) {
  extract(GetParam(), spec::morphological::Ends::kGaps, true);
}
TEST_P(RunExtraction, FindsSharpCornersAtCrossings) {
  extract(GetParam(), spec::morphological::Ends::kCrossings, true);
}

TEST_P(RunExtraction, RepeatsTheOutermostEdges) {
  extract(GetParam(), spec::morphological::Ends::kCrossings, false, false, true);
}
TEST_P(RunExtraction, RepeatsThemForSharpCorners) {
  extract(GetParam(), spec::morphological::Ends::kCrossings, true, false, true);
}

void extract(const Extract& e, spec::morphological::Ends ends, bool corners, bool learned,
             bool clamp) {
  Parameters p = preset(spec::morphological::Preset::kMlaa, e.search_rows, e.search_columns);
  p.lanes = static_cast<spec::morphological::Lanes>(e.lanes_code);
  p.descriptor_fifo = 3;
  p.ends = ends;
  p.round_corners = corners;
  if (learned) p.area = spec::morphological::AreaSource::kLearned;
  if (clamp) {
    p.area = spec::morphological::AreaSource::kTableFull;
    p.border = spec::morphological::Border::kClamp;
  }
  Extraction bench(p);
  bench.finisher.wait_permille = e.wait_permille;
  Random random(e.permille * 7u + static_cast<std::uint32_t>(e.width));
  Planes planes(e.width, e.height);
  for (int y = 0; y < e.height; ++y)
    for (int x = 0; x < e.width; ++x) {
      const auto at = static_cast<std::size_t>(y * e.width + x);
      // With crossings a band of each axis has few of the other one, else no run would be long.
      const bool thin = ends == spec::morphological::Ends::kCrossings;
      planes.left[at] = x > 0 && random.chance(thin && y % 16 < 6 ? 30 : e.permille);
      planes.top[at] = y > 0 && random.chance(thin && x % 16 < 4 ? 30 : e.permille);
    }
  bench.run(planes);
  std::vector<RunDescriptor> expected = runs_by_definition(planes, p);
  const auto order = [](const RunDescriptor& a, const RunDescriptor& b) { return key(a) < key(b); };
  std::sort(expected.begin(), expected.end(), order);
  std::sort(bench.runs.begin(), bench.runs.end(), order);
  ASSERT_EQ(bench.runs.size(), expected.size());
  std::uint64_t horizontal = 0, heads = 0, descriptors = 0;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    ASSERT_EQ(bench.runs[i], expected[i]) << i;
    horizontal += expected[i].axis == Axis::kHorizontal && expected[i].part != RunPart::kTail;
    heads += expected[i].part == RunPart::kHead;
    const spec::morphological::RunShape& shape = spec::morphological::kRunShapes[expected[i].shape];
    descriptors += learned || shape.before != spec::morphological::Side::kNone ||
                   shape.after != spec::morphological::Side::kNone;
  }
  EXPECT_EQ(bench.extractor.horizontal_runs.value(), horizontal);
  EXPECT_EQ(bench.extractor.long_runs.value(), heads);
  EXPECT_EQ(bench.finisher.tokens.size(), descriptors);  // those with a side, each once
  // Runs of a column take its two entries in turn, those without a side as well.
  std::map<std::pair<int, int>, std::uint8_t> entry;
  std::uint8_t turn = 0;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const RunDescriptor& run = expected[i];
    if (run.axis != Axis::kVertical) continue;
    if (i == 0 || expected[i - 1].axis != run.axis || expected[i - 1].line != run.line) turn = 0;
    if (run.part != RunPart::kTail) turn ^= 1;
    entry[{run.line, run.start}] = ends == spec::morphological::Ends::kCrossings ? turn : 0;
  }
  for (const auto& [cycle, token] : bench.finisher.tokens) {
    const bool vertical = token.run.axis == Axis::kVertical;
    ASSERT_EQ(token.entry, vertical ? entry.at({token.run.line, token.run.start}) : 0);
    if (token.run.part != RunPart::kWhole) continue;
    // Edges go on before its start, after its end.
    const RunDescriptor& run = token.run;
    const auto along = [&planes, &run, vertical](int at) {
      return vertical ? planes.left_at(run.line, at) : planes.top_at(at, run.line);
    };
    ASSERT_EQ(token.beyond,
              (along(run.start - 1) ? 1 : 0) | (along(run.start + run.length) ? 2 : 0));
  }
  // The row being blended comes out with its edges.
  for (const AreaSlotToken& token : bench.area_sink.beats()) {
    const int y = token.slot.row - e.search_rows - spec::morphological::kRowLag;
    for (int i = 0; i < lanes_of(p); ++i) {
      const int x = token.slot.beat * lanes_of(p) + i;
      ASSERT_EQ((token.left >> i & 1) != 0, planes.left_at(x, y));
      ASSERT_EQ((token.top >> i & 1) != 0, planes.top_at(x, y));
    }
  }
}
INSTANTIATE_TEST_SUITE_P(
    Planes, RunExtraction,
    ::testing::Values(Extract{70, 40, 0, 4, 4, 500, 0}, Extract{70, 40, 0, 4, 4, 900, 500},
                      Extract{67, 60, 1, 5, 7, 800, 300}, Extract{131, 50, 2, 9, 30, 930, 0},
                      Extract{129, 90, 2, 8, 5, 950, 700}, Extract{1, 50, 0, 4, 4, 900, 0},
                      Extract{50, 1, 2, 4, 4, 900, 0}, Extract{3, 70, 2, 32, 256, 970, 0},
                      Extract{64, 64, 0, 6, 2048, 1000, 0}));

TEST(RunExtractorBlock, SlotsAndRecordsHaveTheLatenciesOfTheDatasheet) {
  Extraction bench(preset(spec::morphological::Preset::kMlaa, 4, 8));
  Planes planes(30, 12);
  for (int x = 5; x < 9; ++x) planes.top[static_cast<std::size_t>(3 * 30 + x)] = true;
  planes.left[static_cast<std::size_t>(2 * 30 + 5)] = true;  // N of the start
  planes.left[static_cast<std::size_t>(3 * 30 + 9)] = true;  // S of the end
  bench.run(planes);
  ASSERT_EQ(bench.runs.size(), 3u);
  const RunDescriptor expected{Axis::kHorizontal, RunPart::kWhole, 3, 5, 4, 1 + 4 * 2};
  ASSERT_THAT(bench.runs, ::testing::Contains(expected));
  ASSERT_FALSE(bench.finisher.tokens.empty());
  for (const auto& [cycle, token] : bench.finisher.tokens) {
    if (token.run != expected) continue;
    // Row 3 in slot row 3 + 4 + 2, closed by column 9.
    EXPECT_EQ(token.slot, 9u * 30u + 9u);
    // Slot k is taken in clock k + 1.
    expect_latency(RunExtractor::descriptor_datasheet(), cycle - (token.slot + 1));
    expect_latency(RunExtractor::slot_datasheet(),
                   bench.area_sink.cycles()[token.slot] - (token.slot + 1));
  }
}

// A slot behind which none comes: taken, its words a clock later, its run known three cycles after
// that. Then there is nothing to do.
TEST(RunExtractorBlock, IsBusyUntilARunIsKnownAndThenIdle) {
  Extraction bench(preset(spec::morphological::Preset::kMlaa, 4, 8));
  Planes planes(30, 12);
  for (int x = 5; x < 9; ++x) planes.top[static_cast<std::size_t>(3 * 30 + x)] = true;
  bench.send(planes);
  // Row 3 in slot row 3 + 4 + 2, closed by column 9; sent in the clock of its number.
  bench.clock.run(9 * 30 + 9 + 1);
  std::string busy;
  for (int i = 0; i < 20; ++i) {
    bench.edges.hold_push(bench.clock.cycle());
    const std::uint64_t before = bench.extractor.busy_cycles();
    EXPECT_EQ(bench.runs.size(), i < 5 ? 0u : 1u) << i;
    bench.clock.run(1);
    busy += bench.extractor.busy_cycles() != before ? 'b' : '.';
  }
  EXPECT_EQ(busy, std::string(5, 'b') + std::string(15, '.'));
}

TEST(RunExtractorBlock, AHorizontalRunOfOneMoreThanTheSearchRangeGivesHeadAndTailWithoutAStall) {
  Extraction bench(preset(spec::morphological::Preset::kMlaa, 4, 8));
  Planes planes(20, 12);
  for (int x = 11; x < 20; ++x) planes.top[static_cast<std::size_t>(3 * 20 + x)] = true;
  planes.left[static_cast<std::size_t>(2 * 20 + 11)] = true;
  bench.run(planes);
  EXPECT_THAT(bench.runs, ::testing::IsSupersetOf(
                              {RunDescriptor{Axis::kHorizontal, RunPart::kHead, 3, 11, 4, 1},
                               RunDescriptor{Axis::kHorizontal, RunPart::kTail, 3, 16, 4, 0}}));
  EXPECT_EQ(bench.extractor.descriptor_stalls.value(), 0u);
}

// A record a column, axis and clock, and one more where a row ends: nobody waits.
TEST(RunExtractorBlock, ADescriptorInEveryColumnDoesNotStall) {
  Parameters p = preset(spec::morphological::Preset::kMlaa, 4, 8);
  p.ends = spec::morphological::Ends::kCrossings;
  p.round_corners = true;
  Extraction bench(p);
  Planes planes(40, 12);
  for (int y = 0; y < 12; ++y)
    for (int x = 0; x < 40; ++x) {
      planes.left[static_cast<std::size_t>(y * 40 + x)] = x > 0;
      planes.top[static_cast<std::size_t>(y * 40 + x)] = y > 0 && (x + y) % 3 != 0;
    }
  bench.run(planes);
  EXPECT_EQ(bench.runs.size(), runs_by_definition(planes, p).size());
  EXPECT_EQ(bench.extractor.descriptor_stalls.value(), 0u);
}

// ---- the border repeats its edges ---------------------------------------------------------------

// Runs at each side of the frame, endless or ended by the last crossing edge, and far bits beyond
// it.
TEST(ClampedBorder, RunsThatNoEdgeCrossesAreEndless) {
  Parameters p = preset(spec::morphological::Preset::kMlaa, 4, 8);
  p.ends = spec::morphological::Ends::kCrossings;
  p.area = spec::morphological::AreaSource::kTableFull;
  p.round_corners = true;
  p.border = spec::morphological::Border::kClamp;
  constexpr int kWidth = 12, kHeight = 10;
  Planes horizontal(kWidth, kHeight);
  const auto top = [&](int from, int to, int y) {
    for (int x = from; x < to; ++x) horizontal.top[static_cast<std::size_t>(y * kWidth + x)] = true;
  };
  const auto left = [&](int x, int y) {
    horizontal.left[static_cast<std::size_t>(y * kWidth + x)] = true;
  };
  top(0, 3, 1);  // from the left border; its crossing N is in row 0
  left(3, 0);
  top(8, 12, 9);  // to the right border, from a crossing S in the last row
  left(8, 9);
  top(11, 12, 5);  // the last pixel, between a crossing and the one that repeats it
  left(11, 5);
  top(2, 12, 7);  // longer than the reach: the tail is endless, the head starts at a crossing
  left(2, 6);
  const std::vector<RunDescriptor> wanted = {
      {Axis::kHorizontal, RunPart::kWhole, 1, 0, 3, 1 << 2, 1 << 2, 1},
      {Axis::kHorizontal, RunPart::kWhole, 9, 8, 4, 2, 2, 2},
      {Axis::kHorizontal, RunPart::kWhole, 5, 11, 1, 2 | 2 << 2, 0, 0},
      {Axis::kHorizontal, RunPart::kHead, 7, 2, 4, 1, 0, 0},
      {Axis::kHorizontal, RunPart::kTail, 7, 8, 4, 0, 0, 2}};
  Planes vertical(kHeight, kWidth);
  std::vector<RunDescriptor> transposed = wanted;
  for (RunDescriptor& run : transposed) run.axis = Axis::kVertical;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      vertical.left[static_cast<std::size_t>(x * kHeight + y)] = horizontal.top_at(x, y);
      vertical.top[static_cast<std::size_t>(x * kHeight + y)] = horizontal.left_at(x, y);
    }
  p.window_rows = 18;  // R = 8, as the columns
  struct Owner : sc_core::sc_module {
    Owner(const sc_core::sc_module_name& name, const Parameters& parameters)
        : sc_module(name), bench(parameters) {}
    Extraction bench;
  };
  Owner across("across", p), down("down", p);
  across.bench.run(horizontal);
  down.bench.run(vertical);
  EXPECT_THAT(across.bench.runs, ::testing::IsSupersetOf(wanted));
  EXPECT_THAT(down.bench.runs, ::testing::IsSupersetOf(transposed));
}

// DESCRIPTOR_STALLS: cycles in which a slot waits, not those in which none has come.
TEST(DescriptorStalls, CountOnlyWhereASlotWaits) {
  Parameters p = preset(Preset::kDeburrLine);
  p.lanes = spec::morphological::Lanes::kFour;
  p.descriptor_fifo = 2;
  p.predictor_units = 1;
  p.divider_interval = 16;
  EngineBench::Options options;
  options.driver = {600, 40};
  EngineBench bench(p, options);
  const Frame in = noise();
  bench.software.set_size(in.width, in.height);
  bench.driver.send(beats_of(in, lanes_of(p)));
  const auto beats = static_cast<std::uint64_t>(beats_a_row(in, p) * in.height);
  const auto& extractor = bench.engine.extractor;
  std::uint64_t before = 0, waiting = 0, wrong = 0, due = 0, full = 0;
  bool arrives = false;
  rtl::Activity descriptors{};
  for (int code = 0; code < extractor.activities(); ++code)
    if (extractor.activity_name({static_cast<std::uint8_t>(code)}) == "descriptors")
      descriptors = {static_cast<std::uint8_t>(code)};
  std::uint64_t lost = 0;
  bench.bench->run(
      [&] {
        const std::uint64_t now = extractor.descriptor_stalls.value();
        const std::uint64_t lost_now = extractor.cycles_of(descriptors);
        if (now != before) ++(arrives ? waiting : wrong);
        if (lost_now != lost) ++(arrives ? due : full);
        before = now;
        lost = lost_now;
        arrives = extractor.edges_in.can_pop(bench.clock.cycle());
        return bench.sink.received() == beats && bench.engine.idle();
      },
      1'000'000);
  EXPECT_EQ(wrong, 0u);
  EXPECT_GT(waiting, 100u);
  EXPECT_EQ(waiting, extractor.descriptor_stalls.value());
  EXPECT_EQ(waiting, due) << "a slot waited for records in so many cycles";
  EXPECT_GT(full, 10u) << "records waited for their FIFO while no slot did";
  EXPECT_EQ(bench.bus.read(reg::kDescriptorStalls), extractor.descriptor_stalls.value());
}

}  // namespace
}  // namespace deburr::tb::morphological_rtl::run_extractor_test
