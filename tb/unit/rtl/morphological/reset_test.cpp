// SPDX-License-Identifier: MIT
// Reset of the morphological engine at every clock of a frame: what comes after it is, to the bit
// and to the clock, what comes after a reset of an engine that never had a frame. And whatever
// sticks is forgotten: every register and figure reads as in a new engine.
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "tb/harness/engine_state.h"
#include "tb/unit/rtl/morphological/support.h"
#include "tb/unit/rtl/morphological/vectors.h"

namespace deburr::tb::morphological_rtl::reset_test {
namespace {

namespace reg = spec::morphological::reg;
using spec::morphological::Preset;

struct Variant {
  int lanes_code;
  spec::morphological::Storage storage;
  int divider_interval;
  int width;  // of the frame after the reset
  std::uint32_t memory_latency;
  bool smaa = false;          // with all of its blocks
  bool learned = false;       // shares
  const char* settings = "";  // beside that
};
void PrintTo(const Variant& v, std::ostream* out) {
  *out << int{spec::morphological::kLaneCount[static_cast<std::size_t>(v.lanes_code)]} << " lanes, "
       << spec::morphological::kStorageNames[static_cast<std::size_t>(v.storage)] << ", interval "
       << v.divider_interval << ", width " << v.width << (v.smaa ? ", smaa" : "")
       << (v.learned ? ", learned" : "") << ' ' << v.settings;
}

// All that a frame leaves behind.
struct Trail {
  std::vector<spec::morphological::BlendedBeat> beats;
  std::vector<Cycle> cycles;  // of the beats, from the end of the reset on
  std::vector<spec::morphological::RunRecord> runs;
  std::vector<spec::morphological::LineRecord> lines;  // in the order in which they are stored
  std::vector<std::uint8_t> memory;
  spec::morphological::Work work;
  std::uint64_t frame_cycles = 0, record_stalls = 0, memory_lines = 0;
};

class EveryClock : public ::testing::TestWithParam<Variant> {
 protected:
  static Parameters parameters() {
    const Variant v = GetParam();
    Parameters p = preset(spec::morphological::Preset::kMlaaSlope, 4, 6);
    p.steps = 3;
    p.lanes = static_cast<spec::morphological::Lanes>(v.lanes_code);
    p.storage = v.storage;
    p.divider_interval = v.divider_interval;
    p.divider_latency = 14;
    p.predictor_units = 1;
    p.record_fifo = 2;
    p.line_pixels = 32;
    if (v.learned) {
      p.edge_source = spec::morphological::EdgeSource::kColour;
      p.area = spec::morphological::AreaSource::kLearned;
    }
    if (v.smaa) {
      p.predictor = spec::morphological::Predictor::kNone;
      p.steps = 0;
      p.ends = spec::morphological::Ends::kCrossings;
      p.area = spec::morphological::AreaSource::kTableMerged;
      p.search_steps = 2;
      p.diagonals = true;
      p.diagonal_steps = 4;
      p.round_corners = true;
      p.blend = spec::morphological::BlendRule::kStrongest;
    }
    apply_settings(p, v.settings);
    return p;
  }
  static EngineBench::Options options() {
    EngineBench::Options options;
    options.memory_latency = GetParam().memory_latency;
    return options;
  }
  // With depths, and marks for who looks at them.
  static Frame marked(Frame frame) {
    for (std::size_t i = 0; i < frame.pixel.size(); ++i) {
      frame.depth[i] = std::uint32_t{frame.pixel[i][0]} << 16;
      if (i % 5 == 0) frame.pixel[i][3] = 254;
    }
    return frame;
  }
  void SetUp() override {
    bench.driver.send([this](std::uint64_t i, spec::morphological::PixelBeat& beat) {
      if (i >= beats.size()) return false;
      beat = beats[i];
      return true;
    });
    bench.engine.observe_runs(
        [this](const spec::morphological::RunRecord& run) { trail.runs.push_back(run); });
    bench.engine.observe_lines(
        [this](const spec::morphological::LineRecord& line) { trail.lines.push_back(line); });
  }
  // The frame of the next beats.
  void expect(const Frame& next) {
    frame = &next;
    bench.software.set_size(next.width, next.height);
    wanted += beats_of(next, lanes_of(p)).size();
    trail = {};
  }
  void reset(Cycle clocks) {
    bench.clock.set_reset_n(false);
    bench.clock.run(clocks);
    bench.clock.set_reset_n(true);
    wanted = 0;
  }
  void reset_to(const Frame& next, Cycle clocks) {
    reset(clocks);
    beats = beats_of(next, lanes_of(p));
    expect(next);
  }
  const Trail& finish() {
    const Cycle begin = bench.clock.cycle();
    EXPECT_TRUE(bench.clock.run_until(
        [&] {
          return bench.sink.received() == wanted &&
                 (bench.bus.read(reg::kStatus) & reg::kStatusIdle) != 0;
        },
        20'000));
    const auto from = static_cast<std::ptrdiff_t>(bench.sink.beats().size() -
                                                  beats_of(*frame, lanes_of(p)).size());
    trail.beats = {bench.sink.beats().begin() + from, bench.sink.beats().end()};
    for (auto cycle = bench.sink.cycles().begin() + from; cycle != bench.sink.cycles().end();
         ++cycle)
      trail.cycles.push_back(*cycle - begin);
    trail.work = bench.engine.work();
    trail.frame_cycles = bench.engine.sequencer.frame_cycles.value();
    trail.record_stalls = bench.engine.extractor.record_stalls.value();
    if (in_memory) {
      trail.memory_lines = bench.engine.pixel_store.lines_written.value() * 1000 +
                           bench.engine.pixel_store.lines_read.value();
      trail.memory = bench.memory->dump(0, static_cast<std::uint64_t>(64 * frame->height));
    }
    return trail;
  }

  const Parameters p = parameters();
  const bool in_memory = p.storage == spec::morphological::Storage::kMemory;
  EngineBench bench{p, options()};
  // Neither ends with a line of memory, so that lines are padded. The second: small steps, and
  // beside them an edge that is longer than the reach.
  const Frame broken = marked(noise(29, 12)),
              whole = marked(draw(GetParam().width, 11, [](int x, int y) {
                const int width = GetParam().width;
                return grey(x < width - 2 ? (y + x) / 3 % 2 * 255 : (x - width + 2) * 255);
              }));
  const Frame* frame = nullptr;
  std::vector<spec::morphological::PixelBeat> beats;
  std::size_t wanted = 0;  // beats since the last reset
  Trail trail;
};

TEST_P(EveryClock, OfAFrameMayBeTheLast) {
  reset_to(whole, 1);
  const Trail fresh = finish();
  ASSERT_FALSE(fresh.lines.empty());
  // Steps that narrow keep no line where shares are learned.
  ASSERT_EQ(fresh.work.divides == 0, GetParam().learned && GetParam().width <= 4);
  ASSERT_GT(fresh.work.long_runs, 0u);
  reset_to(broken, 1);
  const Cycle clocks = bench.clock.cycle();
  finish();
  const Cycle last = bench.clock.cycle() - clocks;
  ASSERT_GT(trail.record_stalls, 0u);
  ASSERT_EQ(trail.work.diagonal_pixels != 0, GetParam().smaa);
  for (Cycle at = 1; at < last; at += kClocksApart) {
    SCOPED_TRACE("reset " + std::to_string(at) + " clocks into a frame");
    reset_to(broken, 1);
    bench.clock.run(at);
    // What memory still owes takes its data bus for a while, unless it has come by then.
    const bool long_reset = in_memory && at % 2 != 0;
    reset_to(whole, long_reset ? 40 : 1);
    const Trail& after = finish();
    ASSERT_EQ(after.beats, fresh.beats);
    ASSERT_EQ(after.runs, fresh.runs);
    ASSERT_EQ(after.work, fresh.work);
    ASSERT_EQ(after.memory_lines, fresh.memory_lines);
    ASSERT_EQ(after.memory, fresh.memory);
    if (in_memory && !long_reset) continue;
    ASSERT_EQ(after.cycles, fresh.cycles);
    ASSERT_EQ(after.lines, fresh.lines);
    ASSERT_EQ(after.frame_cycles, fresh.frame_cycles);
    ASSERT_EQ(after.record_stalls, fresh.record_stalls);
  }
}

// A frame without a size, or one that is too wide: nothing is taken, and a reset forgets it.
TEST_P(EveryClock, OfARejectedFrameMayBeTheLast) {
  reset_to(whole, 1);
  const Trail fresh = finish();
  for (const std::uint32_t size : {0u, 33u | 12u << 16})
    for (const Cycle at : {1, 2, 3, 20}) {
      SCOPED_TRACE("reset " + std::to_string(at) + " clocks after a frame of " +
                   std::to_string(size & 0x3FFF) + " pixels");
      reset_to(broken, 1);
      bench.bus.write(reg::kSize, size);
      bench.clock.run(at);
      ASSERT_EQ(bench.engine.work(), spec::morphological::Work{});
      ASSERT_EQ((bench.bus.read(reg::kStatus) & reg::kStatusFraming) != 0, at > 1);
      reset_to(whole, 1);
      ASSERT_EQ(bench.bus.read(reg::kStatus), reg::kStatusIdle);
      const Trail& after = finish();
      ASSERT_EQ(after.beats, fresh.beats);
      ASSERT_EQ(after.runs, fresh.runs);
      ASSERT_EQ(after.work, fresh.work);
      ASSERT_EQ(after.cycles, fresh.cycles);
      ASSERT_EQ(after.lines, fresh.lines);
      ASSERT_EQ(after.frame_cycles, fresh.frame_cycles);
      ASSERT_EQ(after.record_stalls, fresh.record_stalls);
    }
}

// Frames of different sizes, one behind the other: each is what it is by itself. The engine is
// disabled while a frame is inside, so that the next one waits for its size.
TEST_P(EveryClock, AFrameAfterAnotherIsWhatItIsByItself) {
  reset_to(broken, 1);
  const Trail first = finish();
  reset_to(whole, 1);
  const Trail fresh = finish();
  reset(1);
  beats.clear();
  const std::vector<const Frame*> frames = {&broken, &whole, &whole, &broken};
  for (const Frame* next : frames) {
    const auto more = beats_of(*next, lanes_of(p));
    beats.insert(beats.end(), more.begin(), more.end());
  }
  for (const Frame* next : frames) {
    expect(*next);
    bench.bus.write(reg::kControl, reg::kControlEnable);
    bench.clock.run(5);
    ASSERT_EQ(bench.bus.read(reg::kStatus) & reg::kStatusIdle, 0u);
    bench.bus.write(reg::kControl, 0);
    const Trail &after = finish(), &expected = next == &whole ? fresh : first;
    EXPECT_EQ(after.beats, expected.beats);
    EXPECT_EQ(after.runs, expected.runs);
    EXPECT_EQ(after.memory, expected.memory);
  }
}

// The frame of one beat a row has its first record a few clocks after the reset. Where a line is
// answered in the clock in which another is written, its read waits.
INSTANTIATE_TEST_SUITE_P(
    Engines, EveryClock,
    ::testing::Values(
        Variant{0, spec::morphological::Storage::kLineBuffers, 16, 9, 20},
        Variant{1, spec::morphological::Storage::kLineBuffers, 8, 9, 20},
        Variant{2, spec::morphological::Storage::kLineBuffers, 5, 9, 20},
        Variant{2, spec::morphological::Storage::kLineBuffers, 16, 4, 20},
        Variant{0, spec::morphological::Storage::kMemory, 4, 9, 20},
        Variant{1, spec::morphological::Storage::kMemory, 9, 9, 20},
        Variant{2, spec::morphological::Storage::kMemory, 5, 9, 20},
        Variant{2, spec::morphological::Storage::kMemory, 5, 9, 21},
        Variant{2, spec::morphological::Storage::kMemory, 5, 9, 22},
        Variant{2, spec::morphological::Storage::kMemory, 5, 9, 23},
        Variant{0, spec::morphological::Storage::kLineBuffers, 16, 9, 20, true},
        Variant{1, spec::morphological::Storage::kLineBuffers, 8, 9, 20, true},
        Variant{2, spec::morphological::Storage::kLineBuffers, 16, 4, 20, true},
        Variant{1, spec::morphological::Storage::kMemory, 9, 9, 20, true},
        Variant{0, spec::morphological::Storage::kLineBuffers, 16, 9, 20, false, true},
        Variant{1, spec::morphological::Storage::kLineBuffers, 8, 9, 20, false, true},
        Variant{2, spec::morphological::Storage::kLineBuffers, 16, 4, 20, false, true},
        Variant{2, spec::morphological::Storage::kMemory, 5, 9, 21, false, true},
        Variant{0, spec::morphological::Storage::kLineBuffers, 16, 9, 20, false, false,
                "text_guard=true"},
        Variant{1, spec::morphological::Storage::kMemory, 9, 9, 20, false, true, "text_guard=true"},
        Variant{2, spec::morphological::Storage::kLineBuffers, 16, 4, 20, true, false,
                "text_guard=true"}));

// Every rule of edges, lines and areas in some build, and every time of a trial.
INSTANTIATE_TEST_SUITE_P(
    Rules, EveryClock,
    ::testing::Values(
        Variant{0, spec::morphological::Storage::kLineBuffers, 16, 9, 20, false, false,
                "predictor=fit contiguous=true safe=true trim=true "
                "edges.local_contrast=symmetric trial_clocks=1"},
        Variant{1, spec::morphological::Storage::kLineBuffers, 16, 31, 20, false, false,
                "edges.source=predicated edges.local_contrast=smaa trial_clocks=2"},
        Variant{2, spec::morphological::Storage::kLineBuffers, 16, 9, 20, false, false,
                "edges.source=depth leave=half trial_clocks=3 predictor_units=2"},
        Variant{0, spec::morphological::Storage::kMemory, 16, 31, 20, false, false,
                "edges.threshold_mode=dynamic edges.local_contrast=paper leave=beside "
                "trial_clocks=8 linear_light=false"},
        Variant{1, spec::morphological::Storage::kLineBuffers, 16, 9, 20, true, false,
                "area=table_full edges.threshold_mode=dynamic edges.dynamic_luma=current"},
        Variant{2, spec::morphological::Storage::kLineBuffers, 16, 31, 20, true, false,
                "area=table_minimal leave=marked"},
        Variant{1, spec::morphological::Storage::kLineBuffers, 16, 9, 20, false, true,
                "predictor=fit trim=true leave=half trial_clocks=5"}));

// Frames of ordinary size, with a reset in mid-run.
class ResetAt : public ::testing::TestWithParam<int> {
 protected:
  // Noise until the reset, and what is to be seen of it.
  void interrupt(EngineBench& bench) {
    bench.software.set_size(97, 61);
    bench.driver.send([this](std::uint64_t i, spec::morphological::PixelBeat& beat) {
      const auto& beats = before_ ? dense_ : wanted_;
      if (i >= beats.size()) return false;
      beat = beats[i];
      return true;
    });
    bench.clock.run(static_cast<Cycle>(GetParam()));
    EXPECT_FALSE(bench.engine.idle());
    bench.clock.set_reset_n(false);
    before_ = false;
    bench.clock.run(2);
    bench.clock.set_reset_n(true);
    EXPECT_EQ(bench.bus.read(reg::kSize), 0u);
    EXPECT_EQ(bench.bus.read(reg::kStatus), reg::kStatusIdle);
    EXPECT_EQ(bench.engine.work(), spec::morphological::Work{});
  }
  // A frame of the contract's vectors, from its first beat on.
  std::uint64_t next_frame(EngineBench& bench) {
    bench.software.set_size(200, 150);
    bench.bench->run([&] { return bench.sink.received() == 200 * 150 && bench.engine.idle(); },
                     1'000'000);
    return hash(bench.last(200, 150));
  }

 private:
  bool before_ = true;
  std::vector<spec::morphological::PixelBeat> dense_ = beats_of(noise(), 1),
                                              wanted_ = beats_of(line(), 1);
};

TEST_P(ResetAt, AnyClockOfSmaaLeavesNothing) {
  EngineBench bench(smaa());
  interrupt(bench);
  EXPECT_EQ(next_frame(bench), vector_hash("smaa_line_high"));
  EXPECT_EQ(bench.engine.work().diagonal_pixels, 44u);
}

TEST_P(ResetAt, AnyClockLeavesNothing) {
  Parameters p = preset(Preset::kMlaaSlope);
  p.storage = GetParam() % 2 ? spec::morphological::Storage::kMemory
                             : spec::morphological::Storage::kLineBuffers;
  EngineBench::Options options;
  options.memory_latency = 90;
  EngineBench bench(p, options);
  interrupt(bench);
  EXPECT_EQ(next_frame(bench), vector_hash("line_slope"));
  EXPECT_EQ(bench.engine.work().probes, 2560u);
}
INSTANTIATE_TEST_SUITE_P(Clocks, ResetAt,
                         ::testing::Values(5, 100, 3301, 3402, 3777, 4500, 5002, 6001, 7500, 9300));

// ---- whatever sticks ----------------------------------------------------------------------------

struct Sticky {
  spec::morphological::Storage storage;
  bool learned;
};
void PrintTo(const Sticky& s, std::ostream* out) {
  *out << spec::morphological::kStorageNames[static_cast<std::size_t>(s.storage)]
       << (s.learned ? ", learned" : "");
}

class AfterReset : public ::testing::TestWithParam<Sticky> {
 protected:
  using State = std::vector<std::string>;
  static Parameters parameters() {
    Parameters p = preset(GetParam().learned ? Preset::kDeburr : Preset::kMlaaSlope, 6);
    p.steps = 4;
    p.storage = GetParam().storage;
    return p;
  }
  State state() { return engine_state(bench.engine, bench.bus); }
  void reset() {
    send({});
    bench.clock.set_reset_n(false);
    bench.clock.run(40);  // answers of memory go by
    bench.clock.set_reset_n(true);
  }
  // Once in a reset at most: the driver begins again after it.
  void send(std::vector<spec::morphological::PixelBeat> beats) {
    bench.driver.send(
        [all = std::move(beats)](std::uint64_t i, spec::morphological::PixelBeat& beat) {
          if (i < all.size()) beat = all[i];
          return i < all.size();
        });
  }

  // Pixels, clocks and figures of a frame.
  State job() {
    const Cycle begin = bench.clock.cycle();
    bench.software.set_size(40, 30);
    send(beats_of(noise(40, 30), 1));
    bench.bench->run([&] { return bench.sink.received() == 1200 && bench.engine.idle(); }, 100'000);
    State trail = state();
    for (const Cycle cycle : bench.sink.cycles())
      trail.push_back("beat in " + std::to_string(cycle - begin));
    trail.push_back("pixels " + std::to_string(hash(bench.last(40, 30))));
    return trail;
  }

  void spoil() {
    if (bench.memory)
      bench.memory->fail_request(bench.memory->reads() + bench.memory->writes() + 3);
    const Frame frame = noise(33, 20);
    bench.software.set_size(33, 20);
    std::vector<spec::morphological::PixelBeat> beats = beats_of(frame, 1);
    beats[40].start_of_frame = true;  // not as SIZE says
    send(beats);
    bench.clock.run(50);
    bench.bus.write(reg::kThreshold, 77);  // while a frame is inside
    EXPECT_TRUE(
        bench.clock.run_until([&] { return bench.driver.done() && bench.engine.idle(); }, 50'000));
    std::uint32_t sticky = reg::kStatusIdle | reg::kStatusFrameDone | reg::kStatusFraming |
                           reg::kStatusWrittenWhileBusy;
    if (bench.memory) sticky |= reg::kStatusMemoryError;
    EXPECT_EQ(bench.bus.read(reg::kStatus), sticky);
    // Every writable register has another value, and counters have counted.
    // The tables that SHARES_DATA writes stay in a reset: it writes what is there.
    for (const spec::RegisterInfo& info : spec::morphological::kRegisters)
      if (info.access == spec::Access::kReadWrite && info.offset != reg::kControl) {
        const std::uint32_t value = bench.bus.read(info.offset);
        bench.bus.write(info.offset, info.offset == reg::kSharesData ? value : ~value);
      }
    for (const std::uint32_t counter : {reg::kPixels, reg::kEdgePixels, reg::kFrameCycles})
      EXPECT_GT(bench.bus.read(counter), 0u) << counter;
    EXPECT_GT(bench.engine.beat_latency.max(), 0u);
    bench.bus.write(reg::kControl, 0);
    EXPECT_EQ(bench.bus.read(reg::kControl), 0u);
  }

  EngineBench bench{parameters()};
};

TEST_P(AfterReset, EverythingReadsAsInANewEngine) {
  bench.clock.run(5);
  const State fresh = state();
  spoil();
  EXPECT_NE(state_difference(fresh, state()), "") << "there is something to forget";
  reset();
  bench.clock.run(5);
  EXPECT_EQ(state_difference(fresh, state()), "");
}

TEST_P(AfterReset, TheNextFrameIsThatOfANewEngine) {
  const State fresh = job();
  ASSERT_GT(fresh.size(), 1200u);
  reset();
  spoil();
  reset();
  EXPECT_EQ(state_difference(fresh, job()), "");
}

INSTANTIATE_TEST_SUITE_P(Morphological, AfterReset,
                         ::testing::Values(Sticky{spec::morphological::Storage::kLineBuffers,
                                                  false},
                                           Sticky{spec::morphological::Storage::kMemory, false},
                                           Sticky{spec::morphological::Storage::kLineBuffers, true},
                                           Sticky{spec::morphological::Storage::kMemory, true}));

}  // namespace
}  // namespace deburr::tb::morphological_rtl::reset_test
