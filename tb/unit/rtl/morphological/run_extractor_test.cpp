// SPDX-License-Identifier: MIT
// RunExtractor: finds every run of the golden model once; the latency of its descriptors, and its
// stalls.
#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "golden/morphological/runs.h"
#include "tb/base/apply_settings.h"
#include "tb/base/random.h"
#include "tb/unit/rtl/datasheets.h"
#include "tb/unit/rtl/morphological/edge_memories.h"
#include "tb/unit/rtl/morphological/parts.h"

namespace deburr::tb::morphological_rtl::run_extractor_test {
namespace {

using namespace rtl::morphological;  // NOLINT: a test of these
using golden::morphological::AxisEdges;
using golden::morphological::BitPlane;
using golden::morphological::EdgePlanes;
using rtl::Activity;
using spec::morphological::Axis;
using spec::morphological::Ends;
using spec::morphological::Preset;
using spec::morphological::RunDescriptor;
using spec::morphological::RunPart;

namespace reg = spec::morphological::reg;

EdgePlanes empty(int width, int height) {
  return {BitPlane(width, height), BitPlane(width, height)};
}
std::vector<RunDescriptor> runs_by_golden(const EdgePlanes& planes, const Parameters& p) {
  std::vector<RunDescriptor> runs;
  for (const AxisEdges& edges :
       {AxisEdges::horizontal(planes, p.border), AxisEdges::vertical(planes, p.border)}) {
    const std::vector<RunDescriptor> found = golden::morphological::find_runs(p, edges);
    runs.insert(runs.end(), found.begin(), found.end());
  }
  return runs;
}

// Takes every descriptor and finishes it after a random number of cycles.
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
  void send(const EdgePlanes& planes) {
    registers.frame(planes.top.width(), planes.top.height(), clock.cycle());
    const FrameConfiguration configuration = registers.configuration.driven();
    const auto lanes = static_cast<int>(finisher.lanes());
    std::uint32_t number = 0;
    for (std::uint32_t row = 0; row < configuration.rows; ++row)
      for (std::uint32_t beat = 0; beat < configuration.beats; ++beat) {
        EdgeToken token{};
        token.slot = {number++, static_cast<std::uint16_t>(row), static_cast<std::uint16_t>(beat)};
        for (int i = 0; i < lanes; ++i) {
          const int x = static_cast<int>(beat) * lanes + i, y = static_cast<int>(row) - 1;
          token.left = static_cast<std::uint8_t>(token.left | int{planes.left.at(x, y)} << i);
          token.top = static_cast<std::uint8_t>(token.top | int{planes.top.at(x, y)} << i);
        }
        driver.send(token);
        ++slots;
      }
  }
  void run(const EdgePlanes& planes) {
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

auto key(const RunDescriptor& r) {
  return std::tuple(r.axis, r.line, r.start, r.part, r.length, r.shape);
}

struct Frames {
  int width, height, lanes_code, search_rows, search_columns;
  std::uint32_t permille, wait_permille;
};
void PrintTo(const Frames& f, std::ostream* out) {
  *out << f.width << 'x' << f.height << " lanes code " << f.lanes_code;
}
class RunExtraction : public ::testing::TestWithParam<std::tuple<Frames, const char*>> {};

// Edge planes that no image produces: every code at both ends, runs of all lengths, long runs.
TEST_P(RunExtraction, FindsEveryRunOfGoldenOnce) {
  const auto& [f, settings] = GetParam();
  Parameters p = preset(Preset::kMlaa, f.search_rows, f.search_columns);
  p.lanes = static_cast<spec::morphological::Lanes>(f.lanes_code);
  p.descriptor_fifo = 3;
  apply_settings(p, settings);
  const bool learned = p.area == spec::morphological::AreaSource::kLearned,
             crossings = p.ends == Ends::kCrossings;
  Extraction bench(p);
  bench.finisher.wait_permille = f.wait_permille;
  Random random(f.permille * 7u + static_cast<std::uint32_t>(f.width));
  EdgePlanes planes = empty(f.width, f.height);
  for (int y = 0; y < f.height; ++y)
    for (int x = 0; x < f.width; ++x) {
      // With crossings, a band of each axis has few edges of the other axis; otherwise no run would
      // be long.
      if (x > 0 && random.chance(crossings && y % 16 < 6 ? 30 : f.permille)) planes.left.set(x, y);
      if (y > 0 && random.chance(crossings && x % 16 < 4 ? 30 : f.permille)) planes.top.set(x, y);
    }
  bench.run(planes);
  std::vector<RunDescriptor> expected = runs_by_golden(planes, p);
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
  // Runs of a column use its two entries alternately, including runs without a side.
  std::map<std::pair<int, int>, std::uint8_t> entry;
  std::uint8_t turn = 0;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const RunDescriptor& run = expected[i];
    if (run.axis != Axis::kVertical) continue;
    if (i == 0 || expected[i - 1].axis != run.axis || expected[i - 1].line != run.line) turn = 0;
    if (run.part != RunPart::kTail) turn ^= 1;
    entry[{run.line, run.start}] = crossings ? turn : 0;
  }
  for (const auto& [cycle, token] : bench.finisher.tokens) {
    const bool vertical = token.run.axis == Axis::kVertical;
    ASSERT_EQ(token.entry, vertical ? entry.at({token.run.line, token.run.start}) : 0);
    if (token.run.part != RunPart::kWhole) continue;
    // Whether edges continue before its start and after its end.
    const RunDescriptor& run = token.run;
    const auto along = [&planes, &run, vertical](int at) {
      return vertical ? planes.left.at(run.line, at) : planes.top.at(at, run.line);
    };
    ASSERT_EQ(token.beyond,
              (along(run.start - 1) ? 1 : 0) | (along(run.start + run.length) ? 2 : 0));
  }
  // The row being blended leaves with its edges.
  for (const AreaSlotToken& token : bench.area_sink.beats()) {
    const int y = token.slot.row - f.search_rows - spec::morphological::kRowLag;
    for (int i = 0; i < lanes_of(p); ++i) {
      const int x = token.slot.beat * lanes_of(p) + i;
      ASSERT_EQ((token.left >> i & 1) != 0, planes.left.at(x, y));
      ASSERT_EQ((token.top >> i & 1) != 0, planes.top.at(x, y));
    }
  }
}
INSTANTIATE_TEST_SUITE_P(
    Planes, RunExtraction,
    ::testing::Combine(
        ::testing::Values(Frames{70, 40, 0, 4, 4, 500, 0}, Frames{70, 40, 0, 4, 4, 900, 500},
                          Frames{67, 60, 1, 5, 7, 800, 300}, Frames{131, 50, 2, 9, 30, 930, 0},
                          Frames{129, 90, 2, 8, 5, 950, 700},
                          Frames{1, 50, 0, 4, 4, 900, 0}, Frames{50, 1, 2, 4, 4, 900, 0},
                          Frames{3, 70, 2, 32, 256, 970, 0}, Frames{64, 64, 0, 6, 2048, 1000, 0}),
        ::testing::Values("", "ends=crossings", "area=learned", "ends=crossings area=learned",
                          "round_corners=true", "ends=crossings round_corners=true",
                          "ends=crossings area=table_full border=clamp",
                          "ends=crossings area=table_full border=clamp round_corners=true")));

TEST(RunExtractorBlock, SlotAndDescriptorLatenciesMatchDatasheet) {
  Extraction bench(preset(spec::morphological::Preset::kMlaa, 4, 8));
  EdgePlanes planes = empty(30, 12);
  for (int x = 5; x < 9; ++x) planes.top.set(x, 3);
  planes.left.set(5, 2);  // N of the start
  planes.left.set(9, 3);  // S of the end
  bench.run(planes);
  ASSERT_EQ(bench.runs.size(), 3u);
  const RunDescriptor expected{Axis::kHorizontal, RunPart::kWhole, 3, 5, 4, 1 + 4 * 2};
  ASSERT_THAT(bench.runs, ::testing::Contains(expected));
  ASSERT_FALSE(bench.finisher.tokens.empty());
  for (const auto& [cycle, token] : bench.finisher.tokens) {
    if (token.run != expected) continue;
    // Row 3 is in slot row 3 + 4 + 2; column 9 closes the run.
    EXPECT_EQ(token.slot, 9u * 30u + 9u);
    // Slot k is taken in cycle k + 1.
    expect_latency(RunExtractor::descriptor_datasheet(), cycle - (token.slot + 1));
    expect_latency(RunExtractor::slot_datasheet(),
                   bench.area_sink.cycles()[token.slot] - (token.slot + 1));
  }
}

// The last slot that arrives: it is taken, its words arrive one cycle later, and its run is known
// three cycles after that. Then the unit is idle.
TEST(RunExtractorBlock, BusyUntilTheRunIsKnownThenIdle) {
  Extraction bench(preset(spec::morphological::Preset::kMlaa, 4, 8));
  EdgePlanes planes = empty(30, 12);
  for (int x = 5; x < 9; ++x) planes.top.set(x, 3);
  bench.send(planes);
  // Row 3 is in slot row 3 + 4 + 2, column 9 closes the run; a slot is sent in the cycle of its
  // number.
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

TEST(RunExtractorBlock, RunOneLongerThanSearchRangeSplitsWithoutStall) {
  Extraction bench(preset(spec::morphological::Preset::kMlaa, 4, 8));
  EdgePlanes planes = empty(20, 12);
  for (int x = 11; x < 20; ++x) planes.top.set(x, 3);
  planes.left.set(11, 2);
  bench.run(planes);
  EXPECT_THAT(bench.runs, ::testing::IsSupersetOf(
                              {RunDescriptor{Axis::kHorizontal, RunPart::kHead, 3, 11, 4, 1},
                               RunDescriptor{Axis::kHorizontal, RunPart::kTail, 3, 16, 4, 0}}));
  EXPECT_EQ(bench.extractor.descriptor_stalls.value(), 0u);
}

// One descriptor per column, axis and cycle, and one more at the end of a row, cause no stall.
TEST(RunExtractorBlock, DescriptorInEveryColumnDoesNotStall) {
  Parameters p = preset(spec::morphological::Preset::kMlaa, 4, 8);
  p.ends = spec::morphological::Ends::kCrossings;
  p.round_corners = true;
  Extraction bench(p);
  EdgePlanes planes = empty(40, 12);
  for (int y = 0; y < 12; ++y)
    for (int x = 0; x < 40; ++x) {
      if (x > 0) planes.left.set(x, y);
      if (y > 0 && (x + y) % 3 != 0) planes.top.set(x, y);
    }
  bench.run(planes);
  EXPECT_EQ(bench.runs.size(), runs_by_golden(planes, p).size());
  EXPECT_EQ(bench.extractor.descriptor_stalls.value(), 0u);
}

// DESCRIPTOR_STALLS counts cycles in which a slot waits, not cycles without a slot.
TEST(DescriptorStalls, CountsOnlyCyclesOfWaitingSlots) {
  Parameters p = preset(Preset::kDeburrLine);
  p.lanes = spec::morphological::Lanes::kFour;
  p.descriptor_fifo = 2;
  p.predictor_units = 1;
  p.divider_interval = 16;
  EngineBench::Options options;
  options.driver = {600, 40};
  EngineBench bench(p, options);
  const Frame in = noise();
  bench.send(in);
  const auto& extractor = bench.engine.extractor;
  std::uint64_t before = 0, waiting = 0, wrong = 0, due = 0, full = 0;
  bool arrives = false;
  rtl::Activity descriptors{};
  for (int code = 0; code < extractor.activities(); ++code)
    if (extractor.activity_name({static_cast<std::uint8_t>(code)}) == "descriptors")
      descriptors = {static_cast<std::uint8_t>(code)};
  std::uint64_t lost = 0;
  bench.finish([&] {
    const std::uint64_t now = extractor.descriptor_stalls.value();
    const std::uint64_t lost_now = extractor.cycles_of(descriptors);
    if (now != before) ++(arrives ? waiting : wrong);
    if (lost_now != lost) ++(arrives ? due : full);
    before = now;
    lost = lost_now;
    arrives = extractor.edges_in.can_pop(bench.clock.cycle());
  });
  EXPECT_EQ(wrong, 0u);
  EXPECT_GT(waiting, 100u);
  EXPECT_EQ(waiting, extractor.descriptor_stalls.value());
  EXPECT_EQ(waiting, due) << "a slot waited for records in so many cycles";
  EXPECT_GT(full, 10u) << "records waited for their FIFO while no slot did";
  EXPECT_EQ(bench.bus.read(reg::kDescriptorStalls), extractor.descriptor_stalls.value());
}

}  // namespace
}  // namespace deburr::tb::morphological_rtl::run_extractor_test
