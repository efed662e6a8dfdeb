// SPDX-License-Identifier: MIT
// The blocks of the morphological engine one by one: values worked out by hand from the contract,
// latency and initiation interval to the clock.
#include <map>
#include <numeric>
#include <set>
#include <tuple>

#include "tb/harness/random.h"
#include "tb/unit/rtl/morphological/edge_memories.h"
#include "tb/unit/rtl/morphological/support.h"

namespace deburr::tb::morphological_rtl {
namespace {

using namespace rtl::morphological;  // NOLINT: a test of these
using rtl::Activity;
using spec::morphological::Axis;
using spec::morphological::RunPart;
using spec::morphological::RunRecord;

namespace reg = spec::morphological::reg;

// A ParameterStore with its bus, for blocks that read the rules of a frame.
struct Store {
  explicit Store(const Parameters& p) : store("store", p), bus("bus") {
    bus.socket.bind(store.registers.bus);
  }
  void frame(int width, int height) {
    store.write_size(width, height);
    ASSERT_TRUE(store.latch());
  }
  ParameterStore store;
  Bus bus;
};

// source -> block -> sink, with the clock of each beat.
template <class From, class To>
struct Ends {
  explicit Ends(ClockDomain& clock, const std::string& name = "")
      : in((name + "in").c_str()),
        out((name + "out").c_str()),
        source((name + "source").c_str(), clock),
        sink((name + "sink").c_str(), clock) {
    source.beats_out(in);
    sink.beats_in(out);
  }
  Link<From> in;
  Link<To> out;
  Driver<From> source;
  Sink<To> sink;
};

// ---- LumaUnit -----------------------------------------------------------------------------------

TEST(LumaUnitBlock, AddsTheWeightsExactlyAClockLater) {
  ClockDomain clock("clock", period());
  Parameters p = preset(spec::morphological::Preset::kDeburr);
  p.lanes = spec::morphological::Lanes::kTwo;
  Store store(p);
  store.frame(4, 4);
  Ends<SlotToken, LumaToken> ends(clock);
  LumaUnit luma("luma", clock, store.store);
  luma.slots_in(ends.in);
  luma.lumas_out(ends.out);
  SlotToken token{};
  token.pixel[0] = {255, 255, 255, 9};
  token.pixel[1] = {1, 2, 3, 9};
  token.depth = {7, 8, 0, 0};
  ends.source.send({token, token, token});
  clock.run(1);  // pushed in 0
  EXPECT_FALSE(ends.out.can_pop(clock.cycle()));
  clock.run(1);  // popped in 1
  EXPECT_TRUE(ends.out.can_pop(clock.cycle()));
  clock.run(4);
  ASSERT_EQ(ends.sink.beats().size(), 3u);
  EXPECT_THAT(ends.sink.cycles(), ::testing::ElementsAre(2, 3, 4));
  EXPECT_EQ(ends.sink.beats()[0].luma[0], 255u * 65536u);
  EXPECT_EQ(ends.sink.beats()[0].luma[1], 13933u + 2u * 46871u + 3u * 4732u);
  EXPECT_EQ(ends.sink.beats()[0].depth[1], 8u);
}

// ---- SlotSequencer, LumaUnit, EdgeDetector ------------------------------------------------------

struct Bits {
  bool left, top;
  friend bool operator==(const Bits&, const Bits&) = default;
};

// Frame in, edge bits out; the rules change by register between frames.
struct Front {
  explicit Front(const Parameters& p)
      : store(p),
        sequencer("sequencer", clock, store.store, probe),
        luma("luma", clock, store.store),
        edges("edges", clock, p, store.store) {
    driver.beats_out(in);
    sequencer.pixels_in(in);
    sequencer.frames_done_in(done);
    sequencer.slots_out(slots);
    sequencer.beats_out(beats);
    beat_sink.beats_in(beats);
    luma.slots_in(slots);
    luma.lumas_out(lumas);
    edges.lumas_in(lumas);
    edges.edges_out(bits);
    sink.beats_in(bits);
    clock.add(done);
  }
  // Bits of each pixel in raster order.
  std::vector<Bits> detect(const Frame& frame,
                           const std::map<std::uint32_t, std::uint32_t>& writes = {}) {
    clock.set_reset_n(false);
    clock.run(1);
    clock.set_reset_n(true);
    for (const auto& [offset, value] : writes) store.bus.write(offset, value);
    store.store.write_size(frame.width, frame.height);
    const auto all = beats_of(frame, 1);
    driver.send([all](std::uint64_t i, spec::morphological::PixelBeat& beat) {
      if (i >= all.size()) return false;
      beat = all[i];
      return true;
    });
    clock.run(static_cast<Cycle>((frame.height + 40) * frame.width + 20));
    std::vector<Bits> found;
    for (const EdgeToken& token : sink.beats())
      if (token.slot.row >= 1 && token.slot.row <= frame.height)
        found.push_back({(token.left & 1) != 0, (token.top & 1) != 0});
    return found;
  }

  ClockDomain clock{"clock", period()};
  Store store;
  LatencyProbe probe;
  Link<spec::morphological::PixelBeat> in{"in"};
  Link<FrameDoneToken> done{"done"};
  Link<SlotToken> slots{"slots"};
  Link<BeatToken> beats{"beats"};
  Link<LumaToken> lumas{"lumas"};
  Link<EdgeToken> bits{"bits"};
  Driver<spec::morphological::PixelBeat> driver{"driver", clock};
  SlotSequencer sequencer;
  LumaUnit luma;
  EdgeDetector edges;
  Sink<BeatToken> beat_sink{"beat_sink", clock};
  Sink<EdgeToken> sink{"sink", clock};
};

Frame row(std::initializer_list<int> values) {
  Frame frame(static_cast<int>(values.size()), 1);
  std::size_t i = 0;
  for (const int v : values) frame.pixel[i++] = grey(v);
  return frame;
}
std::string left_bits(const std::vector<Bits>& bits) {
  std::string text;
  for (const Bits b : bits) text += b.left ? '1' : '0';
  return text;
}
std::string top_bits(const std::vector<Bits>& bits) {
  std::string text;
  for (const Bits b : bits) text += b.top ? '1' : '0';
  return text;
}
Frame transposed(const Frame& frame) {
  Frame other = draw(frame.height, frame.width, [&](int x, int y) { return frame.at(y, x); });
  for (int y = 0; y < frame.height; ++y)
    for (int x = 0; x < frame.width; ++x)
      other.depth[static_cast<std::size_t>(x * frame.height + y)] =
          frame.depth[static_cast<std::size_t>(y * frame.width + x)];
  return other;
}

constexpr std::uint32_t kPlainRules = 0;  // luma, fixed, no local contrast

TEST(EdgeDetectorBlock, FixedThresholdIsMetNotExceeded) {
  Front front(preset(spec::morphological::Preset::kMlaa));
  // T = 0.1: 255 x 6554 = 1671270 lies between 25 and 26 codes; T = 0.02: between 5 and 6.
  const Frame steps = row({0, 25, 51, 26, 0, 255});
  EXPECT_EQ(left_bits(front.detect(steps)), "001011");
  EXPECT_EQ(left_bits(front.detect(transposed(steps))), "000000");
  EXPECT_EQ(top_bits(front.detect(transposed(steps))), "001011");
  EXPECT_EQ(left_bits(front.detect(row({0, 5, 11, 11}), {{reg::kThreshold, 1311}})), "0010");
  // Exactly on the threshold: 255 x 65536 / 255 = 65536 a code; T = 257 is 65535, T = 258 65790.
  EXPECT_EQ(left_bits(front.detect(row({0, 1}), {{reg::kThreshold, 257}})), "01");
  EXPECT_EQ(left_bits(front.detect(row({0, 1}), {{reg::kThreshold, 258}})), "00");
}

TEST(EdgeDetectorBlock, TakesThreeClocksFromBeatToBits) {
  Front front(preset(spec::morphological::Preset::kMlaa));
  front.detect(row({0, 255, 0}));
  // Taken by the sequencer a clock after the driver's push; one clock a block. The first slot
  // carries no bits, its token still shows the time.
  const Cycle first = front.sink.cycles()[0];
  EXPECT_EQ(front.beat_sink.cycles()[0], first - 2);  // sequencer -> pixel store
  for (std::size_t i = 1; i < front.sink.cycles().size(); ++i)
    ASSERT_EQ(front.sink.cycles()[i], first + i) << "one slot a clock";
  EXPECT_EQ(front.sink.cycles().size(), (1u + 37u) * 3u);
}

TEST(EdgeDetectorBlock, DynamicThresholdIsStrictAndHasAFloor) {
  Front front(preset(spec::morphological::Preset::kMlaa));
  const std::uint32_t current = 1u << 2, larger = 1u << 2 | 1u << 3;
  const std::map<std::uint32_t, std::uint32_t> alpha = {{reg::kAlpha, 6554}, {reg::kFloor, 514}};
  const auto with = [&](std::uint32_t rules) {
    auto writes = alpha;
    writes[reg::kRules] = rules;
    return writes;
  };
  // 10 codes of 100 are 655360 against 6554 x 100 = 655400: no. 11 codes: yes.
  EXPECT_EQ(left_bits(front.detect(row({90, 100}), with(current))), "00");
  EXPECT_EQ(left_bits(front.detect(row({89, 100}), with(current))), "01");
  // The other way round the current pixel is the darker one.
  EXPECT_EQ(left_bits(front.detect(row({100, 90}), with(current))), "01");
  EXPECT_EQ(left_bits(front.detect(row({100, 90}), with(larger))), "00");
  // Beside black alpha times luma is small; the floor (514 x 255 = 131070, two codes) rules.
  EXPECT_EQ(left_bits(front.detect(row({0, 1, 0, 2, 0}), with(current))), "00011");
}

TEST(EdgeDetectorBlock, DepthAndPredicatedSources) {
  Parameters p = preset(spec::morphological::Preset::kMlaa);
  p.edge_source = spec::morphological::EdgeSource::kDepth;
  Front front(p);
  Frame frame = row({0, 0, 0, 0, 0});
  // 3277 / 65536 of the larger: 50 of 1000 is not enough, 51 is; equal depths never.
  frame.depth = {1000, 950, 949, 1000, 0};
  EXPECT_EQ(left_bits(front.detect(frame)), "00011");
  frame.depth = {0, 0, 1, 0xFFFFFF, 0xFFFFFF};
  EXPECT_EQ(left_bits(front.detect(frame)), "00110");
  EXPECT_EQ(top_bits(front.detect(transposed(frame))), "00110");
  // Predicated: three codes on a depth edge (655), thirteen elsewhere (3277).
  Frame steps = row({0, 2, 5, 17, 30});
  steps.depth = {1000, 500, 1000, 1000, 1000};
  EXPECT_EQ(left_bits(front.detect(steps, {{reg::kRules, 2}})), "00101");
}

TEST(EdgeDetectorBlock, WithoutDepthLinesDepthReadsZero) {
  Front front(preset(spec::morphological::Preset::kMlaa));
  Frame frame = row({0, 255, 0});
  frame.depth = {1, 1000, 1};
  EXPECT_EQ(left_bits(front.detect(frame, {{reg::kRules, 1}})), "000");
  EXPECT_EQ(left_bits(front.detect(frame, {{reg::kRules, 2}})), "011");
}

TEST(EdgeDetectorBlock, LocalContrastIsStrictTwiceTheStep) {
  Front front(preset(spec::morphological::Preset::kMlaa));
  const std::uint32_t paper = 1u << 4, symmetric = 2u << 4;
  for (const std::uint32_t rules : {paper, symmetric}) {
    const std::map<std::uint32_t, std::uint32_t> writes = {{reg::kRules, rules}};
    // Steps 100 and 200: 2 x 100 > 200 is false. Steps 101 and 200: both stay.
    EXPECT_EQ(left_bits(front.detect(row({0, 100, 255 - 0}), {{reg::kRules, rules}})), "011");
    EXPECT_EQ(left_bits(front.detect(row({0, 85, 255}), writes)), "001");  // 85, 170
    EXPECT_EQ(left_bits(front.detect(row({0, 86, 255}), writes)), "011");  // 86, 169
    EXPECT_EQ(left_bits(front.detect(row({0, 170, 255}), writes)), "010");
    EXPECT_EQ(top_bits(front.detect(transposed(row({0, 85, 255})), writes)), "001");
  }
  // A strong step across, on one side only: the paper drops the bit of the pixel that sees it, the
  // symmetric form keeps it, since the other pixel of the pair sees none.
  const Frame corner = draw(
      4, 2, [](int x, int y) { return grey(y == 0 ? (x < 2 ? 100 : 140) : (x < 2 ? 100 : 255)); });
  const auto bits = [&](std::uint32_t rules) {
    return left_bits(front.detect(corner, {{reg::kRules, rules}}));
  };
  EXPECT_EQ(bits(kPlainRules), "00100010");
  EXPECT_EQ(bits(paper), "00000010");      // 2 x 40 > 115 is false
  EXPECT_EQ(bits(symmetric), "00100010");  // min(115, 0) = 0
}

TEST(SlotSequencerBlock, SaysWhatDisagreesWithSize) {
  Front front(preset(spec::morphological::Preset::kMlaa));
  const Frame frame = row({0, 1, 2});
  front.detect(frame);
  EXPECT_EQ(front.sequencer.framing_errors.value(), 0u);
  auto all = beats_of(frame, 1);
  all[0].start_of_frame = false;
  all[1].end_of_row = true;
  all[2].count = 3;
  front.clock.set_reset_n(false);
  front.clock.run(1);
  front.clock.set_reset_n(true);
  front.store.store.write_size(3, 1);
  front.driver.send([all](std::uint64_t i, spec::morphological::PixelBeat& beat) {
    if (i >= all.size()) return false;
    beat = all[i];
    return true;
  });
  front.clock.run(10);
  EXPECT_EQ(front.sequencer.framing_errors.value(), 3u);
  EXPECT_EQ(front.store.bus.read(reg::kStatus), reg::kStatusFraming);
}

// ---- RunExtractor -------------------------------------------------------------------------------

// Takes every record and finishes it some clocks later, at random.
class Finisher final : public rtl::Unit {
 public:
  LanePorts<rtl::In<RunToken>> h, v;
  rtl::Out<FinishToken> finished_out{"finished_out"};
  Finisher(const sc_core::sc_module_name& name, ClockDomain& clock, const ParameterStore& store)
      : Unit(name, clock), h("h", store.lanes()), v("v", store.lanes()), store_(store) {}
  Activity tick(Cycle cycle) override {
    for (LanePorts<rtl::In<RunToken>>* ports : {&h, &v})
      for (std::size_t lane = 0; lane < static_cast<std::size_t>(store_.lanes()); ++lane) {
        rtl::In<RunToken>& in = (*ports)[lane];
        if (!in.can_pop(cycle) || random.chance(wait_permille)) continue;
        ++pending_[in.front(cycle).slot / store_.rules().beats & 1];
        tokens.push_back({cycle, in.take(cycle)});
      }
    if ((pending_[0] | pending_[1]) && !random.chance(wait_permille)) {
      finished_out.push(cycle, {pending_});
      pending_ = {};
    }
    return rtl::kBusy;
  }
  void reset() override {}
  struct Taken {
    Cycle cycle;
    RunToken token;
  };
  std::vector<Taken> tokens;
  std::uint32_t wait_permille = 0;
  Random random{1};

 private:
  const ParameterStore& store_;
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

// Word for word from the contract, on whole planes.
std::vector<RunRecord> runs_by_definition(const Planes& planes, int reach_rows, int reach_columns) {
  std::vector<RunRecord> found;
  for (const bool vertical : {false, true}) {
    const int lines = vertical ? planes.width : planes.height;
    const int length = vertical ? planes.height : planes.width;
    const int reach = vertical ? reach_rows : reach_columns;
    const auto along = [&](int p, int q) {
      return vertical ? planes.left_at(q, p) : planes.top_at(p, q);
    };
    const auto code = [&](int p, int q) {
      const bool first = vertical ? planes.top_at(q - 1, p) : planes.left_at(p, q - 1);
      const bool second = vertical ? planes.top_at(q, p) : planes.left_at(p, q);
      return (first ? 1 : 0) + (second ? 2 : 0);
    };
    for (int q = 0; q < lines; ++q)
      for (int p = 0; p < length; ++p) {
        if (!along(p, q) || along(p - 1, q)) continue;
        int end = p;
        while (along(end, q)) ++end;
        const auto add = [&](RunPart part, int start, int size, int shape) {
          found.push_back({vertical ? Axis::kVertical : Axis::kHorizontal, part,
                           static_cast<std::uint16_t>(q), static_cast<std::uint16_t>(start),
                           static_cast<std::uint16_t>(size), static_cast<std::uint8_t>(shape)});
        };
        if (end - p > reach) {
          add(RunPart::kHead, p, reach / 2, code(p, q));
          add(RunPart::kTail, end - reach / 2, reach / 2, 4 * code(end, q));
        } else {
          add(RunPart::kWhole, p, end - p, code(p, q) + 4 * code(end, q));
        }
      }
  }
  return found;
}

auto key(const RunRecord& r) {
  return std::tuple(r.axis, r.line, r.start, r.part, r.length, r.shape);
}

struct Extraction {
  explicit Extraction(const Parameters& p)
      : store(p),
        memories(p, store.store),
        extractor("extractor", clock, p, store.store, memories.window, memories.rows),
        finisher("finisher", clock, store.store) {
    driver.beats_out(edges);
    extractor.edges_in(edges);
    extractor.finished_in(finished);
    extractor.area_slots_out(area_slots);
    extractor.fetches_out(fetches);
    area_sink.beats_in(area_slots);
    fetch_sink.beats_in(fetches);
    finisher.finished_out(finished);
    for (std::size_t lane = 0; lane < static_cast<std::size_t>(store.store.lanes()); ++lane) {
      finisher.h[lane](extractor.records(Axis::kHorizontal, lane));
      finisher.v[lane](extractor.records(Axis::kVertical, lane));
    }
    extractor.observer = [this](const RunRecord& run) { runs.push_back(run); };
  }
  void run(const Planes& planes) {
    store.store.write_size(planes.width, planes.height);
    ASSERT_TRUE(store.store.latch());
    const FrameRules rules = store.store.rules();
    const int lanes = store.store.lanes();
    std::uint32_t number = 0;
    for (std::uint32_t row = 0; row < rules.rows; ++row)
      for (std::uint32_t beat = 0; beat < rules.beats; ++beat) {
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
    ASSERT_TRUE(clock.run_until([&] { return area_sink.received() == slots; }, 2'000'000));
    clock.run(100);
  }

  ClockDomain clock{"clock", period()};
  Store store;
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
  std::vector<RunRecord> runs;
  std::uint64_t slots = 0;
};

struct Extract {
  int width, height, lanes_code, reach_rows, reach_columns;
  std::uint32_t permille, wait_permille;
};
void PrintTo(const Extract& e, std::ostream* out) {
  *out << e.width << 'x' << e.height << " lanes code " << e.lanes_code;
}
class RunExtraction : public ::testing::TestWithParam<Extract> {};

// Planes that no image gives: every code at both ends, runs of all lengths, long runs.
TEST_P(RunExtraction, FindsEveryRunOnce) {
  const Extract e = GetParam();
  Parameters p = preset(spec::morphological::Preset::kMlaa, e.reach_rows, e.reach_columns);
  p.lanes = static_cast<spec::morphological::Lanes>(e.lanes_code);
  p.record_fifo = 3;
  Extraction bench(p);
  bench.finisher.wait_permille = e.wait_permille;
  Random random(e.permille * 7u + static_cast<std::uint32_t>(e.width));
  Planes planes(e.width, e.height);
  for (int y = 0; y < e.height; ++y)
    for (int x = 0; x < e.width; ++x) {
      const auto at = static_cast<std::size_t>(y * e.width + x);
      planes.left[at] = x > 0 && random.chance(e.permille);
      planes.top[at] = y > 0 && random.chance(e.permille);
    }
  bench.run(planes);
  std::vector<RunRecord> expected = runs_by_definition(planes, e.reach_rows, e.reach_columns);
  const auto order = [](const RunRecord& a, const RunRecord& b) { return key(a) < key(b); };
  std::sort(expected.begin(), expected.end(), order);
  std::sort(bench.runs.begin(), bench.runs.end(), order);
  ASSERT_EQ(bench.runs.size(), expected.size());
  std::uint64_t horizontal = 0, heads = 0, records = 0;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    ASSERT_EQ(bench.runs[i], expected[i]) << i;
    horizontal += expected[i].axis == Axis::kHorizontal && expected[i].part != RunPart::kTail;
    heads += expected[i].part == RunPart::kHead;
    const spec::morphological::RunShape& shape = spec::morphological::kRunShapes[expected[i].shape];
    records += shape.before != spec::morphological::Side::kNone ||
               shape.after != spec::morphological::Side::kNone;
  }
  EXPECT_EQ(bench.extractor.horizontal_runs.value(), horizontal);
  EXPECT_EQ(bench.extractor.long_runs.value(), heads);
  EXPECT_EQ(bench.finisher.tokens.size(), records);  // those with a side, each once
  // The row being blended comes out with its edges.
  for (const AreaSlotToken& token : bench.area_sink.beats()) {
    const int y = token.slot.row - e.reach_rows - spec::morphological::kRowLag;
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

TEST(RunExtractorBlock, RecordIsThereAClockAfterTheRunEnds) {
  Extraction bench(preset(spec::morphological::Preset::kMlaa, 4, 8));
  Planes planes(30, 12);
  for (int x = 5; x < 9; ++x) planes.top[static_cast<std::size_t>(3 * 30 + x)] = true;
  planes.left[static_cast<std::size_t>(2 * 30 + 5)] = true;  // N of the start
  planes.left[static_cast<std::size_t>(3 * 30 + 9)] = true;  // S of the end
  bench.run(planes);
  ASSERT_EQ(bench.runs.size(), 3u);
  const RunRecord expected{Axis::kHorizontal, RunPart::kWhole, 3, 5, 4, 1 + 4 * 2};
  ASSERT_THAT(bench.runs, ::testing::Contains(expected));
  ASSERT_FALSE(bench.finisher.tokens.empty());
  for (const auto& [cycle, token] : bench.finisher.tokens) {
    if (token.run != expected) continue;
    // Row 3 in slot row 3 + 4 + 2, closed by column 9.
    EXPECT_EQ(token.slot, 9u * 30u + 9u);
    // Slot k is popped in clock k + 1; the record can be taken in the clock after.
    EXPECT_EQ(cycle, token.slot + 2);
    // The slot itself goes on in the same clock.
    EXPECT_EQ(bench.area_sink.cycles()[token.slot], token.slot + 2);
    EXPECT_EQ(token.start_code, 1);
    EXPECT_EQ(token.end_code, 2);
  }
}

TEST(RunExtractorBlock, AHorizontalRunOfOneMoreThanTheReachGivesHeadAndTailWithoutAStall) {
  Extraction bench(preset(spec::morphological::Preset::kMlaa, 4, 8));
  Planes planes(20, 12);
  for (int x = 11; x < 20; ++x) planes.top[static_cast<std::size_t>(3 * 20 + x)] = true;
  planes.left[static_cast<std::size_t>(2 * 20 + 11)] = true;
  bench.run(planes);
  EXPECT_THAT(bench.runs,
              ::testing::IsSupersetOf({RunRecord{Axis::kHorizontal, RunPart::kHead, 3, 11, 4, 1},
                                       RunRecord{Axis::kHorizontal, RunPart::kTail, 3, 16, 4, 0}}));
  EXPECT_EQ(bench.extractor.record_stalls.value(), 0u);
}

// ---- EndpointPredictor --------------------------------------------------------------------------

Parameters deburr_without_trim() {
  Parameters p = preset(spec::morphological::Preset::kDeburr);
  p.trim = false;
  return p;
}

// Two colours on either side of a stair: column x of it begins at row boundary(x).
struct Prediction {
  Prediction(const Parameters& p, Axis axis_, int width, int height,
             const std::function<int(int)>& boundary)
      : axis(axis_),
        store(p),
        edges(p, store.store),
        predictor(axis_ == Axis::kHorizontal
                      ? EndpointPredictor("predictor", clock, p, store.store, edges.rows)
                      : EndpointPredictor("predictor", clock, p, store.store, edges.window)),
        ends(clock) {
    predictor.records_in[0](ends.in);
    predictor.sums_out[0](ends.out);
    frame(width, height, boundary);
  }
  // Begins a frame: the registers count.
  void frame(int width, int height, const std::function<int(int)>& boundary) {
    const bool vertical = axis == Axis::kVertical;
    store.store.write_size(vertical ? height : width, vertical ? width : height);
    EXPECT_TRUE(store.store.latch());
    dark = [=](int x, int y) { return vertical ? x >= boundary(y) : y >= boundary(x); };
  }
  // A run; the memories show what is around it.
  RunToken z(int line, int start, int length, bool down) {
    edges.show(
        axis == Axis::kVertical ? start : line,
        [&](int x, int y) { return x > 0 && dark(x, y) != dark(x - 1, y); },
        [&](int x, int y) { return y > 0 && dark(x, y) != dark(x, y - 1); });
    RunToken token{};
    const int start_code = down ? 1 : 2, end_code = down ? 2 : 1;
    token.run = {axis,
                 RunPart::kWhole,
                 static_cast<std::uint16_t>(line),
                 static_cast<std::uint16_t>(start),
                 static_cast<std::uint16_t>(length),
                 static_cast<std::uint8_t>(start_code + 4 * end_code)};
    token.start_code = static_cast<std::uint8_t>(start_code);
    token.end_code = static_cast<std::uint8_t>(end_code);
    return token;
  }
  ClockDomain clock{"clock", period()};
  Axis axis;
  Store store;
  EdgeMemories edges;
  std::function<bool(int, int)> dark;
  EndpointPredictor predictor;
  Ends<RunToken, SumsToken> ends;
};

// Steps of the given lengths from column `from` on, on rows row + 1, row + 2, ..; flat before and
// after.
std::function<int(int)> stair(int from, std::vector<int> lengths, int row) {
  return [=](int x) {
    int y = row, at = from;
    for (const int length : lengths) {
      if (x < at) return y;
      at += length;
      ++y;
    }
    return x < at ? y : y + 1;
  };
}

constexpr std::uint32_t kTrimBit = 1u << 16;  // of RULES

class PredictorAxes : public ::testing::TestWithParam<Axis> {};

TEST_P(PredictorAxes, FollowsTheExampleOfTheContract) {
  // -3, [0, 3], 5, 8: one step of 3 to the left, steps of 2 and 3 to the right. The flat parts are
  // long, so that nothing follows. The run begins at column 23, on row 12.
  const auto steps = stair(20, {3, 3, 2, 3}, 10);
  Prediction bench(deburr_without_trim(), GetParam(), 60, 30, steps);
  bench.ends.source.send(bench.z(12, 23, 3, true));
  bench.clock.run(20);
  ASSERT_EQ(bench.ends.sink.beats().size(), 1u);
  const SumsToken& sums = bench.ends.sink.beats()[0];
  EXPECT_EQ(sums.left, 1);
  EXPECT_EQ(sums.right, 2);
  EXPECT_EQ(sums.first, -3);
  EXPECT_EQ(sums.last, 8);
  EXPECT_EQ(sums.sum, -3 + 0 + 3 + 5 + 8);
  EXPECT_EQ(sums.indexed_sum, 3 + 0 + 3 + 2 * 5 + 3 * 8);
  // k = 0: three candidates a side; k = 1: two a side; k = 2: two on the right.
  EXPECT_EQ(bench.predictor.probes.value(), 12u);
  EXPECT_EQ(bench.predictor.iterations.value(), 3u);
  EXPECT_EQ(bench.predictor.steps.value(), 3u);
  EXPECT_EQ(bench.predictor.extended_runs.value(), 1u);
  // Pushed in 0, popped in 1, trials in 1..3, result sent in 4, taken in 5.
  EXPECT_THAT(bench.ends.sink.cycles(), ::testing::ElementsAre(5));
}

TEST_P(PredictorAxes, GoesUpAsItGoesDown) {
  // Mirrored: rows fall with the columns; 3, 2, 3, 3 and the run is the third.
  const auto down = stair(20, {3, 2, 3, 3}, 10);
  Prediction bench(deburr_without_trim(), GetParam(), 60, 30, [&](int x) { return 24 - down(x); });
  bench.ends.source.send(bench.z(24 - 13, 25, 3, false));
  bench.clock.run(20);
  ASSERT_EQ(bench.ends.sink.beats().size(), 1u);
  EXPECT_EQ(bench.ends.sink.beats()[0].left, 2);
  EXPECT_EQ(bench.ends.sink.beats()[0].right, 1);
  EXPECT_EQ(bench.ends.sink.beats()[0].first, -5);
  EXPECT_EQ(bench.ends.sink.beats()[0].last, 6);
}

TEST_P(PredictorAxes, StopsWhereBothSidesDifferOneUpOneDown) {
  // 2, [3], 4: a curve. Safe: nothing is taken. Not safe: each side has its own L'.
  const auto steps = stair(20, {2, 3, 4}, 10);
  const bool safe = GetParam() == Axis::kHorizontal;
  Parameters p = deburr_without_trim();
  p.safe = safe;
  Prediction bench(p, GetParam(), 60, 30, steps);
  bench.ends.source.send(bench.z(12, 22, 3, true));
  bench.clock.run(20);
  ASSERT_EQ(bench.ends.sink.beats().size(), 1u);
  EXPECT_EQ(bench.ends.sink.beats()[0].left, safe ? 0 : 1);
  EXPECT_EQ(bench.ends.sink.beats()[0].right, safe ? 0 : 1);
  EXPECT_EQ(bench.predictor.probes.value(), safe ? 6u : 6u + 4u);
}

TEST_P(PredictorAxes, RunsOfOnePixelHaveTwoCandidatesAndTheFrameEnds) {
  // A diagonal from corner to corner of a small frame: N = 8 steps, but the frame is 6 long.
  const auto diagonal = [](int x) { return x; };
  Prediction bench(deburr_without_trim(), GetParam(), 7, 7, diagonal);
  bench.ends.source.send(bench.z(3, 3, 1, true));
  bench.clock.run(20);
  ASSERT_EQ(bench.ends.sink.beats().size(), 1u);
  EXPECT_EQ(bench.ends.sink.beats()[0].right, 2);  // the last corner, (7, 7), has no crossing
  EXPECT_EQ(bench.ends.sink.beats()[0].left, 2);   // (0, 0) and (1, 1): top(0, 0) is outside
  EXPECT_EQ(bench.predictor.probes.value(), 2u * 2u * 3u);
  // The frame's end is not the window's: with trim both sides are lost there.
  bench.store.store.leave();
  bench.store.bus.write(reg::kRules, bench.store.bus.read(reg::kRules) | kTrimBit);
  bench.frame(7, 7, diagonal);
  bench.ends.source.send(bench.z(3, 3, 1, true));
  bench.clock.run(20);
  ASSERT_EQ(bench.ends.sink.beats().size(), 2u);
  EXPECT_EQ(bench.ends.sink.beats()[1].right, 1);
  EXPECT_EQ(bench.ends.sink.beats()[1].left, 1);
  EXPECT_EQ(bench.predictor.probes.value(), 2u * 2u * 2u * 3u);
}

INSTANTIATE_TEST_SUITE_P(Both, PredictorAxes, ::testing::Values(Axis::kHorizontal, Axis::kVertical),
                         [](const auto& param) {
                           return param.param == Axis::kHorizontal ? "horizontal" : "vertical";
                         });

// Steps 4, [4], 4, 3, 3, 3, 3: corners -4, 0, 4, 8, 11. A sixth at 14 would need a slope above
// (12 - 1) / 3 and below (14 - 8 + 1) / 2 pixels a step: there is none.
SumsToken bend(bool safe) {
  Parameters p = deburr_without_trim();
  p.safe = safe;
  Prediction bench(p, Axis::kHorizontal, 70, 30, stair(20, {4, 4, 4, 3, 3, 3, 3}, 5));
  bench.ends.source.send(bench.z(7, 24, 4, true));
  bench.clock.run(30);
  return bench.ends.sink.beats().at(0);
}
TEST(EndpointPredictorBlock, SafeRefusesACornerThatFitsNoLine) {
  const SumsToken sums = bend(true);
  EXPECT_EQ(sums.left, 1);
  EXPECT_EQ(sums.right, 2);
  EXPECT_EQ(sums.last, 11);
}
TEST(EndpointPredictorBlock, NotSafeTakesIt) {
  const SumsToken sums = bend(false);
  EXPECT_EQ(sums.left, 1);
  EXPECT_EQ(sums.right, 5);
  EXPECT_EQ(sums.last, 20);
}

TEST(EndpointPredictorBlock, ARecordHoldsAPredictorForItsIterations) {
  // No extension (predictor none): one clock each. Two predictors share the work, one result
  // register a clock goes out: a record a clock.
  Parameters p = preset(spec::morphological::Preset::kMlaa);
  Prediction bench(p, Axis::kHorizontal, 60, 30, stair(20, {3}, 10));
  for (int i = 0; i < 20; ++i) bench.ends.source.send(bench.z(11, 20, 3, true));
  bench.clock.run(40);
  ASSERT_EQ(bench.ends.sink.cycles().size(), 20u);
  for (std::size_t i = 0; i < 20; ++i) EXPECT_EQ(bench.ends.sink.cycles()[i], 3 + i);
}

TEST(EndpointPredictorBlock, EightIterationsWithTwoPredictorsAreARecordEveryFourClocks) {
  // A long stair of steps of two pixels: N = 8 to both sides.
  Prediction bench(preset(spec::morphological::Preset::kDeburr), Axis::kHorizontal, 90, 60,
                   stair(10, std::vector<int>(30, 2), 10));
  for (int i = 0; i < 12; ++i) bench.ends.source.send(bench.z(26, 40, 2, true));
  bench.clock.run(100);
  ASSERT_EQ(bench.ends.sink.cycles().size(), 12u);
  EXPECT_EQ(bench.ends.sink.beats()[0].left, 8);
  EXPECT_EQ(bench.ends.sink.beats()[0].right, 8);
  // Popped in 1 and 2, eight trials each, sent a clock after the last: taken in 10, 11, 18, 19...
  for (std::size_t i = 0; i < 12; ++i)
    EXPECT_EQ(bench.ends.sink.cycles()[i], 10 + i / 2 * 8 + i % 2) << i;
  EXPECT_EQ(bench.predictor.occupancy.value(), 12u * 8u);
}

// ---- EndpointPredictor: trim --------------------------------------------------------------------

// How a side ends.
enum class Ended { kAfterN, kAtTheWindow, kContradicted, kLost };

// A side of a stair: its steps from the run outwards, then a flat part; what growth makes of it.
struct SideOfStair {
  std::vector<int> steps;
  int taken;
  Ended ended;
};
struct Stair {
  const char* name;
  bool safe;
  int n;       // N
  int length;  // L
  SideOfStair left, right;
};

// The engine of these tests reaches 32 pixels along either axis.
constexpr int kTrimReach = 32;

const std::vector<Stair>& stairs_to_trim() {
  using enum Ended;
  const auto times = [](int count, int length) {
    return std::vector<int>(static_cast<std::size_t>(count), length);
  };
  const auto then = [](std::vector<int> steps, std::initializer_list<int> more) {
    steps.insert(steps.end(), more);
    return steps;
  };
  static const std::vector<Stair> all = {
      // Lost: the next run is too long.
      {"no step", true, 8, 3, {{}, 0, kLost}, {{}, 0, kLost}},
      {"lost 0 1", true, 8, 3, {{}, 0, kLost}, {{3}, 1, kLost}},
      {"lost 1 1", true, 8, 3, {{3}, 1, kLost}, {{3}, 1, kLost}},
      {"lost 3 2", true, 8, 3, {{3, 3, 3}, 3, kLost}, {{3, 3}, 2, kLost}},
      {"lost 8 8", true, 16, 3, {times(8, 3), 8, kLost}, {times(8, 3), 8, kLost}},
      {"lost of one pixel", true, 8, 1, {{1, 1}, 2, kLost}, {{1, 1, 1}, 3, kLost}},
      {"lost of two lengths", true, 8, 3, {{3}, 1, kLost}, {{2, 3, 2}, 3, kLost}},
      {"apart: lost 3 2", false, 8, 3, {{3, 3, 3}, 3, kLost}, {{3, 3}, 2, kLost}},
      {"apart: lost 0 1", false, 8, 3, {{}, 0, kLost}, {{4}, 1, kLost}},
      {"apart: lost 8 1", false, 16, 3, {times(8, 3), 8, kLost}, {{2}, 1, kLost}},
      {"apart: lost of one pixel", false, 8, 1, {{2, 1, 2}, 3, kLost}, {{1}, 1, kLost}},
      // What safe refuses, each side by itself takes, until it is lost.
      {"apart: a bend", false, 8, 4, {{4}, 1, kLost}, {{4, 3, 3, 3, 3}, 5, kLost}},
      {"apart: a curve", false, 8, 3, {{2, 2, 3}, 3, kLost}, {{4, 4}, 2, kLost}},
      // Still open after N steps, whatever comes then.
      {"N = 1", true, 1, 3, {{3, 3}, 1, kAfterN}, {{3}, 1, kAfterN}},
      {"N = 2", true, 2, 3, {{3, 3}, 2, kAfterN}, {{2, 3, 2}, 2, kAfterN}},
      {"N = 3", true, 3, 3, {{3, 3, 3}, 3, kAfterN}, {{3}, 1, kLost}},
      {"N = 8", true, 8, 3, {times(9, 3), 8, kAfterN}, {times(8, 3), 8, kAfterN}},
      {"N = 8 and lost", true, 8, 3, {times(9, 3), 8, kAfterN}, {{3, 3}, 2, kLost}},
      {"apart: N = 3", false, 3, 3, {{2, 2, 2}, 3, kAfterN}, {{4, 4, 4}, 3, kAfterN}},
      {"apart: N = 8", false, 8, 3, {times(8, 3), 8, kAfterN}, {{3, 4}, 2, kLost}},
      // The window's end: 11 + 11 + 12, 8 + 3 x 8 + 9 and 8 + 2 x 8 + 9 are more than 32.
      {"window 1", true, 8, 11, {{11}, 1, kAtTheWindow}, {{}, 0, kLost}},
      {"window 2 3", true, 8, 8, {{8, 8}, 2, kAtTheWindow}, {{8, 8, 8}, 3, kAtTheWindow}},
      {"window 8", true, 16, 3, {{}, 0, kLost}, {{3, 3, 4, 3, 3, 3, 4, 3}, 8, kAtTheWindow}},
      {"window 9", true, 16, 3, {times(9, 3), 9, kAtTheWindow}, {times(3, 3), 3, kLost}},
      {"apart: window 2", false, 8, 8, {{8}, 1, kLost}, {{8, 8}, 2, kAtTheWindow}},
      // 28 pixels of 32 used (29 in the third): five (four) more are too many, one fewer is not.
      {"L + 1 beyond", true, 16, 4, {times(6, 4), 6, kAtTheWindow}, {{}, 0, kLost}},
      {"L within", true, 16, 4, {{}, 0, kLost}, {{3, 4, 3, 4, 3, 4, 3}, 7, kLost}},
      {"L beyond, L' within",
       true,
       16,
       4,
       {{}, 0, kLost},
       {{4, 3, 4, 3, 4, 3, 4}, 7, kAtTheWindow}},
      {"L' beyond", true, 16, 4, {{}, 0, kLost}, {{5, 5, 4, 5, 5}, 5, kAtTheWindow}},
      {"the other side's L'", true, 16, 4, {times(6, 4), 6, kLost}, {{3}, 1, kLost}},
      {"apart: its own L'", false, 16, 4, {times(6, 4), 6, kAtTheWindow}, {{3}, 1, kLost}},
      {"apart: L within", false, 16, 4, {{5}, 1, kLost}, {{3, 4, 3, 4, 3, 4, 3}, 7, kLost}},
      // L' is what it was before the step: the left side ends in the step that finds it.
      {"L' of this step", true, 8, 8, {{8, 8}, 2, kAtTheWindow}, {{8, 8, 7}, 3, kAtTheWindow}},
      // A hit that fits no line with the others (3).
      {"refused 1", true, 8, 4, {{4}, 1, kLost}, {{3, 3}, 1, kContradicted}},
      {"refused 2", true, 8, 4, {{}, 0, kLost}, {{4, 3, 3}, 2, kContradicted}},
      {"refused 3, the other goes on",
       true,
       8,
       4,
       {times(5, 4), 5, kLost},
       {{4, 4, 3, 3}, 3, kContradicted}},
      {"refused 8", true, 16, 3, {{3}, 1, kLost}, {then(times(7, 3), {2, 2}), 8, kContradicted}},
      // One step longer, the other shorter (2).
      {"a curve 0", true, 8, 3, {{2}, 0, kContradicted}, {{4}, 0, kContradicted}},
      {"a curve 1", true, 8, 3, {{3, 2}, 1, kContradicted}, {{3, 4}, 1, kContradicted}},
      {"a curve 2", true, 8, 3, {{3, 3, 4}, 2, kContradicted}, {{3, 3, 2}, 2, kContradicted}},
      {"a curve 3", true, 8, 3, {{3, 3, 3, 2}, 3, kContradicted}, {{3, 3, 3, 4}, 3, kContradicted}},
      {"a curve 8",
       true,
       16,
       3,
       {then(times(8, 3), {2}), 8, kContradicted},
       {then(times(8, 3), {4}), 8, kContradicted}},
      // Either hit fits a line with the corners so far, but no line fits both (4).
      {"not both 3",
       true,
       8,
       3,
       {{3, 2, 3, 2}, 3, kContradicted},
       {{2, 3, 3, 3}, 3, kContradicted}},
  };
  return all;
}

using KeepRule = int (*)(int taken, Ended);
int kept_by_contract(int taken, Ended ended) {
  if (ended == Ended::kContradicted) return taken / 2;
  if (ended == Ended::kLost) return std::max(0, taken - 1);
  return taken;
}

// Lets the predictor grow every stair, seen in all four ways.
struct Trimming : Prediction {
  static constexpr int kWidth = 2 * kTrimReach + 2, kHeight = 40, kLine = 20, kStart = 31;
  static Parameters parameters(spec::morphological::Predictor line) {
    Parameters p = preset(spec::morphological::Preset::kDeburr, kTrimReach, kTrimReach);
    p.predictor = line;
    return p;
  }
  Trimming(Axis axis_, spec::morphological::Predictor line)
      : Prediction(parameters(line), axis_, kWidth, kHeight, [](int) { return kLine; }) {}

  struct Grown {
    SumsToken sums;
    std::uint64_t probes, iterations, steps, extended;
  };
  Grown grow(const Stair& s, bool mirrored, bool flipped, bool trim) {
    std::vector<int> lengths(s.left.steps.rbegin(), s.left.steps.rend());
    const int before = std::accumulate(lengths.begin(), lengths.end(), 0);
    const int row = kLine - 1 - static_cast<int>(lengths.size());
    lengths.push_back(s.length);
    lengths.insert(lengths.end(), s.right.steps.begin(), s.right.steps.end());
    const auto steps = stair(kStart - before, lengths, row);
    store.store.leave();
    std::uint32_t rules = store.bus.read(reg::kRules);
    rules &= ~(0x1Fu << 8 | 1u << 14 | kTrimBit);
    rules |= static_cast<std::uint32_t>(s.n) << 8 | (s.safe ? 1u << 14 : 0) | (trim ? kTrimBit : 0);
    store.bus.write(reg::kRules, rules);
    frame(kWidth, kHeight, [&](int x) {
      const int y = steps(mirrored ? kWidth - 1 - x : x);
      return flipped ? kHeight - y : y;
    });
    const Grown from = counts();
    ends.source.send(z(flipped ? kHeight - kLine : kLine,
                       mirrored ? kWidth - kStart - s.length : kStart, s.length,
                       mirrored == flipped));
    clock.run(40);
    Grown to = counts();
    to.sums = ends.sink.beats().back();
    to.probes -= from.probes;
    to.iterations -= from.iterations;
    to.steps -= from.steps;
    to.extended -= from.extended;
    return to;
  }

 private:
  Grown counts() const {
    return {{},
            predictor.probes.value(),
            predictor.iterations.value(),
            predictor.steps.value(),
            predictor.extended_runs.value()};
  }
};

// The sums of a stair of which so many steps are kept on either side.
SumsToken sums_of(const Stair& s, int left, int right, bool mirrored) {
  std::vector<std::pair<int, int>> corners = {{0, 0}, {1, s.length}};
  int x = s.length;
  for (int i = 0; i < right; ++i)
    corners.emplace_back(i + 2, x += s.right.steps.at(static_cast<std::size_t>(i)));
  x = 0;
  for (int i = 0; i < left; ++i)
    corners.emplace_back(-i - 1, x -= s.left.steps.at(static_cast<std::size_t>(i)));
  SumsToken sums{};
  sums.left = static_cast<std::uint8_t>(mirrored ? right : left);
  sums.right = static_cast<std::uint8_t>(mirrored ? left : right);
  for (auto [i, x_i] : corners) {
    if (mirrored) {
      i = 1 - i;
      x_i = s.length - x_i;
    }
    sums.first = static_cast<std::int16_t>(std::min<int>(sums.first, x_i));
    sums.last = static_cast<std::int16_t>(std::max<int>(sums.last, x_i));
    sums.sum += x_i;
    sums.indexed_sum += i * x_i;
  }
  return sums;
}
bool same_line(const SumsToken& a, const SumsToken& b) {
  return a.left == b.left && a.right == b.right && a.first == b.first && a.last == b.last &&
         a.sum == b.sum && a.indexed_sum == b.indexed_sum;
}

class Trim : public ::testing::TestWithParam<std::tuple<Axis, spec::morphological::Predictor>> {
 protected:
  template <class Each>
  void each(Each&& visit) {
    Trimming bench(std::get<0>(GetParam()), std::get<1>(GetParam()));
    for (const Stair& s : stairs_to_trim())
      for (const bool mirrored : {false, true})
        for (const bool flipped : {false, true}) {
          SCOPED_TRACE(std::string(s.name) + (mirrored ? ", mirrored" : "") +
                       (flipped ? ", upwards" : ""));
          visit(bench, s, mirrored, flipped);
        }
  }
};

TEST_P(Trim, KeepsWhatTheEndOfASideLeavesCertain) {
  each([](Trimming& bench, const Stair& s, bool mirrored, bool flipped) {
    const auto grown = bench.grow(s, mirrored, flipped, true);
    const int left = kept_by_contract(s.left.taken, s.left.ended);
    const int right = kept_by_contract(s.right.taken, s.right.ended);
    const SumsToken expected = sums_of(s, left, right, mirrored);
    EXPECT_EQ(grown.sums.left, expected.left);
    EXPECT_EQ(grown.sums.right, expected.right);
    EXPECT_EQ(grown.sums.first, expected.first);
    EXPECT_EQ(grown.sums.last, expected.last);
    EXPECT_EQ(grown.sums.sum, expected.sum);
    EXPECT_EQ(grown.sums.indexed_sum, expected.indexed_sum);
    // Counted is what is kept, but every trial.
    EXPECT_EQ(grown.steps, static_cast<std::uint64_t>(left + right));
    EXPECT_EQ(grown.extended, left + right > 0 ? 1u : 0u);
    const auto trials = [](const SideOfStair& side) {
      return side.taken + (side.ended == Ended::kAfterN ? 0 : 1);
    };
    EXPECT_EQ(grown.iterations,
              static_cast<std::uint64_t>(std::max(trials(s.left), trials(s.right))));
  });
}

TEST_P(Trim, OffKeepsEveryStepAndTheTrialsAreTheSame) {
  each([](Trimming& bench, const Stair& s, bool mirrored, bool flipped) {
    const auto off = bench.grow(s, mirrored, flipped, false);
    EXPECT_TRUE(same_line(off.sums, sums_of(s, s.left.taken, s.right.taken, mirrored)));
    EXPECT_EQ(off.steps, static_cast<std::uint64_t>(s.left.taken + s.right.taken));
    const auto on = bench.grow(s, mirrored, flipped, true);
    EXPECT_EQ(on.probes, off.probes);
    EXPECT_EQ(on.iterations, off.iterations);
  });
}

// The stairs tell the rule from others: each of these is contradicted by one of them.
TEST_P(Trim, TheStairsCatchAWrongRule) {
  const std::vector<std::pair<const char*, KeepRule>> wrong = {
      {"nothing is given back", [](int n, Ended) { return n; }},
      {"lost gives back two",
       [](int n, Ended e) {
         return e == Ended::kLost ? std::max(0, n - 2) : kept_by_contract(n, e);
       }},
      {"lost gives back the half",
       [](int n, Ended e) { return e == Ended::kLost ? n / 2 : kept_by_contract(n, e); }},
      {"the half is rounded up",
       [](int n, Ended e) {
         return e == Ended::kContradicted ? (n + 1) / 2 : kept_by_contract(n, e);
       }},
      {"contradicted gives back one",
       [](int n, Ended e) {
         return e == Ended::kContradicted ? std::max(0, n - 1) : kept_by_contract(n, e);
       }},
      {"the window's end is taken for the line's",
       [](int n, Ended e) {
         return kept_by_contract(n, e == Ended::kAtTheWindow ? Ended::kLost : e);
       }},
      {"N is taken for the line's end",
       [](int n, Ended e) { return kept_by_contract(n, e == Ended::kAfterN ? Ended::kLost : e); }}};
  std::vector<int> caught(wrong.size());
  int right = 0;
  each([&](Trimming& bench, const Stair& s, bool mirrored, bool flipped) {
    const auto grown = bench.grow(s, mirrored, flipped, true);
    const auto agrees = [&](KeepRule kept) {
      return same_line(grown.sums, sums_of(s, kept(s.left.taken, s.left.ended),
                                           kept(s.right.taken, s.right.ended), mirrored));
    };
    right += !agrees(kept_by_contract);
    for (std::size_t i = 0; i < wrong.size(); ++i) caught[i] += !agrees(wrong[i].second);
  });
  EXPECT_EQ(right, 0);
  for (std::size_t i = 0; i < wrong.size(); ++i) EXPECT_GT(caught[i], 0) << wrong[i].first;
}

INSTANTIATE_TEST_SUITE_P(
    Predictors, Trim,
    ::testing::Combine(::testing::Values(Axis::kHorizontal, Axis::kVertical),
                       ::testing::Values(spec::morphological::Predictor::kChord,
                                         spec::morphological::Predictor::kFit)),
    [](const auto& param) {
      return std::string(std::get<0>(param.param) == Axis::kHorizontal ? "horizontal"
                                                                       : "vertical") +
             (std::get<1>(param.param) == spec::morphological::Predictor::kChord ? "_chord"
                                                                                 : "_fit");
    });

TEST(ParameterStoreBlock, TrimIsABitOfRulesLatchedWithTheFrame) {
  Store on(preset(spec::morphological::Preset::kDeburr));
  const std::uint32_t reset_value = on.bus.read(reg::kRules);
  EXPECT_EQ(reset_value,
            1u << 3 | 2u << 4 | 2u << 6 | 8u << 8 | 1u << 13 | 1u << 14 | 1u << 15 | kTrimBit);
  on.frame(8, 8);
  EXPECT_TRUE(on.store.rules().trim);
  on.bus.write(reg::kRules, reset_value & ~kTrimBit);  // ignored: a frame is inside
  EXPECT_EQ(on.bus.read(reg::kRules), reset_value);
  on.store.leave();
  on.bus.write(reg::kRules, reset_value & ~kTrimBit);
  EXPECT_EQ(on.bus.read(reg::kRules), reset_value & ~kTrimBit);
  EXPECT_TRUE(on.store.rules().trim) << "until the next frame begins";
  ASSERT_TRUE(on.store.latch());
  EXPECT_FALSE(on.store.rules().trim);
  EXPECT_TRUE(on.store.rules().safe);
  on.store.leave();
  on.bus.write(reg::kRules, ~0u);
  EXPECT_EQ(on.bus.read(reg::kRules), 0x1FFFFu) << "no bits beyond";
  on.store.reset();
  EXPECT_EQ(on.bus.read(reg::kRules), reset_value);
}

TEST(ParameterStoreBlock, ResetValueOfTrimIsTheParameter) {
  Store off(deburr_without_trim());
  EXPECT_EQ(off.bus.read(reg::kRules) & kTrimBit, 0u);
  off.frame(8, 8);
  EXPECT_FALSE(off.store.rules().trim);
}

// ---- LineUnit -----------------------------------------------------------------------------------

SumsToken sums_of(std::vector<int> corners, int left, int length) {
  SumsToken token{};
  token.run.run.part = RunPart::kWhole;
  token.run.run.length = static_cast<std::uint16_t>(length);
  token.run.run.shape = 9;
  token.left = static_cast<std::uint8_t>(left);
  token.right = static_cast<std::uint8_t>(static_cast<int>(corners.size()) - 2 - left);
  token.first = static_cast<std::int16_t>(corners.front());
  token.last = static_cast<std::int16_t>(corners.back());
  for (std::size_t i = 0; i < corners.size(); ++i) {
    token.sum += corners[i];
    token.indexed_sum += (static_cast<int>(i) - left) * corners[i];
  }
  return token;
}

struct Lines {
  explicit Lines(const Parameters& p, Axis axis = Axis::kHorizontal)
      : store(p), unit("divider", clock, p, store.store, axis), ends(clock) {
    store.frame(64, 64);
    unit.sums_in[0](ends.in);
    unit.lines_out[0](ends.out);
  }
  ClockDomain clock{"clock", period()};
  Store store;
  LineUnit unit;
  Ends<SumsToken, LineToken> ends;
};

TEST(LineUnitBlock, FitOfTheContractsTable) {
  Lines bench(preset(spec::morphological::Preset::kDeburr));
  struct Row {
    SumsToken in;
    int scale, offset, shift;
    std::uint32_t slope, inverse;
    int span;
  };
  const std::vector<Row> rows = {{sums_of({0, 1}, 0, 1), 2, 1, 0, 8388608, 4096, 1},
                                 {sums_of({0, 3}, 0, 3), 2, 3, 0, 2796203, 12288, 3},
                                 {sums_of({0, 4}, 0, 4), 2, 4, 0, 2097152, 16384, 4},
                                 {sums_of({0, 7}, 0, 7), 2, 7, 0, 1198373, 28672, 7},
                                 {sums_of({-3, 0, 3, 5, 8}, 1, 3), 5, 13, 1, 1242757, 11059, 11},
                                 {sums_of({0, 5, 11, 16}, 0, 5), 4, 32, 2, 776723, 22118, 16}};
  for (const Row& row : rows) bench.ends.source.send(row.in);
  bench.clock.run(60);
  ASSERT_EQ(bench.ends.sink.beats().size(), rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const spec::morphological::LineRecord& line = bench.ends.sink.beats()[i].line;
    EXPECT_EQ(line.scale, rows[i].scale) << i;
    EXPECT_EQ(line.offset, rows[i].offset) << i;
    EXPECT_EQ(line.shift, rows[i].shift) << i;
    EXPECT_EQ(line.slope, rows[i].slope) << i;
    EXPECT_EQ(line.inverse, rows[i].inverse) << i;
    EXPECT_EQ(line.span, rows[i].span) << i;
    EXPECT_EQ(line.before, spec::morphological::Side::kFirst);
    EXPECT_EQ(line.after, spec::morphological::Side::kSecond);
  }
  EXPECT_EQ(bench.unit.divides.value(), rows.size());
}

TEST(LineUnitBlock, ChordAndTheEndsOfALongRun) {
  Lines bench(preset(spec::morphological::Preset::kMlaaSlope, 32, 21));
  bench.ends.source.send(sums_of({-3, 0, 3, 5, 8}, 1, 3));
  SumsToken head = sums_of({0, 10}, 0, 10);
  head.run.run.part = RunPart::kHead;
  SumsToken tail = head;
  tail.run.run.part = RunPart::kTail;
  bench.ends.source.send({head, tail});
  bench.clock.run(60);
  ASSERT_EQ(bench.ends.sink.beats().size(), 3u);
  const spec::morphological::LineRecord& chord = bench.ends.sink.beats()[0].line;
  EXPECT_EQ(chord.scale, 2);
  EXPECT_EQ(chord.offset, 5);
  EXPECT_EQ(chord.slope, 3050403u);  // rdiv(4 x 2^24, 22) = 67108864 / 22 = 3050402.9
  EXPECT_EQ(chord.inverse, 11264u);  // 11 / 4 in U12.12
  for (const int i : {1, 2}) {
    const spec::morphological::LineRecord& line =
        bench.ends.sink.beats()[static_cast<std::size_t>(i)].line;
    EXPECT_EQ(line.scale, 2);
    EXPECT_EQ(line.offset, i == 1 ? 21 : 2 * 10 - 21);
    EXPECT_EQ(line.slope, 399458u);  // rdiv(2^24, 42) = 399457.5
    EXPECT_EQ(line.inverse, 21u << 12);
    EXPECT_EQ(line.shift, 0);
    EXPECT_EQ(line.span, 22);
  }
}

struct DividerTime {
  int latency, interval;
};
void PrintTo(const DividerTime& t, std::ostream* out) {
  *out << "latency " << t.latency << " interval " << t.interval;
}
class Divider : public ::testing::TestWithParam<DividerTime> {};

TEST_P(Divider, HasItsLatencyAndInterval) {
  const DividerTime time = GetParam();
  Parameters p = preset(spec::morphological::Preset::kDeburr);
  p.divider_latency = time.latency;
  p.divider_interval = time.interval;
  Lines bench(p);
  for (int i = 0; i < 10; ++i) bench.ends.source.send(sums_of({0, i + 1}, 0, i + 1));
  // Pushed in 0, popped in 1, the quotient is sent in 1 + latency.
  const auto ready = static_cast<Cycle>(2 + time.latency);
  bench.clock.run(ready);
  EXPECT_FALSE(bench.ends.out.can_pop(ready - 1));
  EXPECT_TRUE(bench.ends.out.can_pop(ready));
  bench.clock.run(200);
  ASSERT_EQ(bench.ends.sink.cycles().size(), 10u);
  for (std::size_t i = 0; i < 10; ++i) {
    EXPECT_EQ(bench.ends.sink.cycles()[i], ready + i * static_cast<Cycle>(time.interval)) << i;
    EXPECT_EQ(bench.ends.sink.beats()[i].line.span, i + 1);
  }
  EXPECT_EQ(bench.unit.occupancy.value(), 10u * static_cast<unsigned>(time.interval));
}
INSTANTIATE_TEST_SUITE_P(Times, Divider,
                         ::testing::Values(DividerTime{1, 1}, DividerTime{24, 1},
                                           DividerTime{24, 5}, DividerTime{7, 16},
                                           DividerTime{64, 3}));

// ---- Blender ------------------------------------------------------------------------------------

struct Blending {
  explicit Blending(const Parameters& p) : store(p), blender("blender", clock, store.store, probe) {
    store.frame(8, 8);
    shares_source.beats_out(shares);
    pixel_source.beats_out(pixels);
    blender.shares_in(shares);
    blender.pixels_in(pixels);
    blender.pixels_out(out);
    blender.frames_done_out(done);
    sink.beats_in(out);
    done_sink.beats_in(done);
  }
  // A pixel of row 2, column 3, between four neighbours.
  void send(const Shares& s, int centre, int up, int down, int left, int right) {
    ShareToken token{};
    token.slot.row = static_cast<std::uint16_t>(2 + 32 + 5);
    token.slot.beat = 3;
    token.any = true;
    token.shares[0] = s;
    token.left = 1;
    PixelToken around{};
    around.centre[0] = grey(centre);
    around.centre[0][3] = 77;
    around.above[0] = grey(up);
    around.below[0] = grey(down);
    around.before = grey(left);
    around.after = grey(right);
    probe.enters(clock.cycle());
    shares_source.send(token);
    pixel_source.send(around);
  }
  ClockDomain clock{"clock", period()};
  Store store;
  LatencyProbe probe;
  Link<ShareToken> shares{"shares"};
  Link<PixelToken> pixels{"pixels"};
  Link<spec::morphological::BlendedBeat> out{"out"};
  Link<FrameDoneToken> done{"done"};
  Driver<ShareToken> shares_source{"shares_source", clock};
  Driver<PixelToken> pixel_source{"pixel_source", clock};
  Blender blender;
  Sink<spec::morphological::BlendedBeat> sink{"sink", clock};
  Sink<FrameDoneToken> done_sink{"done_sink", clock};
};

TEST(BlenderBlock, ChoosesTheAxisAndRoundsTheMagnitude) {
  Parameters p = preset(spec::morphological::Preset::kDeburr);
  p.linear_light = false;
  Blending bench(p);
  struct Row {
    Shares s;
    bool horizontal;
    int first, second, result;
  };
  // centre 100, up 0, down 200, left 50, right 255
  const std::vector<Row> rows = {
      {{0, 0, 0, 0, 9, 9, 9, 9}, false, 0, 0, 100},
      {{32, 0, 0, 0, 3, 0, 0, 0}, false, 32, 0, 87},    // -3200 / 256 = -12.5: magnitude 13
      {{0, 32, 0, 0, 0, 3, 0, 0}, false, 0, 32, 113},   // +12.5: 13
      {{0, 0, 64, 0, 0, 0, 3, 0}, true, 64, 0, 87},     // -12.5
      {{0, 0, 0, 64, 0, 0, 0, 3}, true, 0, 64, 139},    // 64 x 155 / 256 = 38.75: 39
      {{10, 0, 0, 90, 8, 0, 0, 7}, false, 10, 0, 96},   // the longer line, -3.9
      {{90, 0, 0, 10, 7, 0, 0, 8}, true, 0, 10, 106},   // 6.05
      {{90, 0, 0, 10, 7, 99, 0, 8}, true, 0, 10, 106},  // a span without a share does not count
      {{5, 6, 10, 0, 8, 8, 8, 0}, false, 5, 6, 100},    // equal spans: 11 >= 10; (-500 + 600) / 256
      {{5, 6, 12, 0, 8, 8, 8, 0}, true, 12, 0, 98},     // 11 < 12; -600 / 256 = -2.3
      {{5, 5, 10, 0, 8, 8, 8, 0}, false, 5, 5, 100},    // a tie goes to up and down
      {{128, 128, 0, 0, 3, 3, 0, 0}, false, 128, 128, 100}};
  for (const Row& row : rows) bench.send(row.s, 100, 0, 200, 50, 255);
  bench.clock.run(40);
  ASSERT_EQ(bench.sink.beats().size(), rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const spec::morphological::BlendedBeat& beat = bench.sink.beats()[i];
    EXPECT_EQ(beat.tap[0].horizontal, rows[i].horizontal) << i;
    EXPECT_EQ(beat.tap[0].first, rows[i].first) << i;
    EXPECT_EQ(beat.tap[0].second, rows[i].second) << i;
    EXPECT_EQ(beat.tap[0].edges, 1) << i;
    EXPECT_EQ(beat.pixel[0][0], rows[i].result) << i;
    EXPECT_EQ(beat.pixel[0][2], rows[i].result) << i;
    EXPECT_EQ(beat.pixel[0][3], 77) << "alpha passes";
    // Pushed in i, popped in i + 1, sent in i + 2, taken in i + 3.
    EXPECT_EQ(bench.sink.cycles()[i], i + 3);
  }
  EXPECT_EQ(bench.blender.blended_pixels.value(), rows.size() - 1);
}

TEST(BlenderBlock, BlendsInLinearLight) {
  Blending bench(preset(spec::morphological::Preset::kDeburr));
  bench.send({128, 0, 0, 0, 3, 0, 0, 0}, 0, 255, 0, 0, 0);  // half of white: 2048 of 4095
  bench.send({0, 0, 0, 0, 0, 0, 0, 0}, 1, 0, 0, 0, 0);
  bench.clock.run(10);
  ASSERT_EQ(bench.sink.beats().size(), 2u);
  EXPECT_EQ(bench.sink.beats()[0].pixel[0][0], 188);  // encode(0.5)
  EXPECT_EQ(bench.sink.beats()[1].pixel[0][0], 1);
}

}  // namespace
}  // namespace deburr::tb::morphological_rtl
