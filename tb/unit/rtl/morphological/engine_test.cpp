// SPDX-License-Identifier: MIT
// The whole morphological engine: sizes, symmetry, reset, registers, memory, accounts, bad
// parameters, and faults that the checks must catch.
#include <fstream>
#include <sstream>

#include "tb/unit/rtl/morphological/support.h"

namespace deburr::tb::morphological_rtl {
namespace {

namespace reg = spec::morphological::reg;
using spec::morphological::Preset;

Parameters deburr() { return preset(Preset::kDeburr); }

// ---- sizes --------------------------------------------------------------------------------------

struct Size {
  int width, height;
};
void PrintTo(const Size& s, std::ostream* out) { *out << s.width << 'x' << s.height; }
class Sizes : public ::testing::TestWithParam<Size> {};

// Frames of any size, one after the other, through each kind of engine: the same pixels.
TEST_P(Sizes, GiveTheSamePixelsInEveryEngine) {
  const Size size = GetParam();
  ClockDomain clock("clock", period());
  const Frame frame = noise(size.width, size.height);
  struct Kind {
    int lanes_code;
    spec::morphological::Storage storage;
  };
  const Kind kinds[] = {{0, spec::morphological::Storage::kLineBuffers},
                        {1, spec::morphological::Storage::kMemory},
                        {2, spec::morphological::Storage::kLineBuffers}};
  struct One {
    One(const std::string& prefix, ClockDomain& clock, const Parameters& p)
        : driver((prefix + "driver").c_str(), clock),
          engine((prefix + "engine").c_str(), clock, p),
          sink((prefix + "sink").c_str(), clock),
          bus((prefix + "bus").c_str()),
          in((prefix + "in").c_str()),
          out((prefix + "out").c_str()) {
      driver.beats_out(in);
      engine.pixels_in(in);
      engine.pixels_out(out);
      sink.beats_in(out);
      bus.socket.bind(engine.registers);
      if (engine.memory()) {
        MemoryModelParameters m;
        m.latency_max = 50;
        memory = std::make_unique<MemoryModel>((prefix + "memory").c_str(), period(), m);
        engine.memory()->bind(memory->ports);
      }
    }
    Driver<spec::morphological::PixelBeat> driver;
    rtl::morphological::MorphologicalEngine engine;
    Sink<spec::morphological::BlendedBeat> sink;
    Bus bus;
    Link<spec::morphological::PixelBeat> in;
    Link<spec::morphological::BlendedBeat> out;
    std::unique_ptr<MemoryModel> memory;
  };
  std::vector<std::unique_ptr<One>> engines;
  std::uint64_t wanted = 0;
  for (const Kind& kind : kinds) {
    Parameters p = preset(Preset::kMlaaSlope, 6, 9);
    p.lanes = static_cast<spec::morphological::Lanes>(kind.lanes_code);
    p.storage = kind.storage;
    p.line_pixels = size.width;
    engines.push_back(std::make_unique<One>("k" + std::to_string(kind.lanes_code) + "_", clock, p));
  }
  for (auto& one : engines) {
    one->engine.set_frame_size(size.width, size.height);
    const auto beats = beats_of(frame, lanes_of(one->engine.parameters()));
    wanted += 2 * beats.size();
    one->driver.send(beats);
    one->driver.send(beats);
  }
  ASSERT_TRUE(clock.run_until(
      [&] {
        std::uint64_t received = 0;
        for (auto& one : engines) received += one->sink.received();
        return received == wanted;
      },
      4'000'000));
  std::vector<std::vector<Rgba8>> pixels;
  for (auto& one : engines) {
    std::vector<Rgba8>& all = pixels.emplace_back();
    for (const spec::morphological::BlendedBeat& beat : one->sink.beats()) {
      for (std::size_t i = 0; i < beat.count; ++i) all.push_back(beat.pixel[i]);
      EXPECT_EQ(beat.end_of_row, all.size() % static_cast<std::size_t>(size.width) == 0);
    }
    ASSERT_EQ(all.size(), 2 * frame.pixel.size());
    EXPECT_TRUE(std::equal(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(all.size() / 2),
                           all.begin() + static_cast<std::ptrdiff_t>(all.size() / 2)))
        << "the second frame is the first one again";
  }
  EXPECT_EQ(pixels[1], pixels[0]);
  EXPECT_EQ(pixels[2], pixels[0]);
}

INSTANTIATE_TEST_SUITE_P(Any, Sizes,
                         ::testing::Values(Size{1, 1}, Size{1, 2}, Size{2, 1}, Size{1, 70},
                                           Size{70, 1}, Size{2, 2}, Size{3, 5}, Size{4, 4},
                                           Size{5, 3}, Size{6, 40}, Size{7, 7}, Size{16, 16},
                                           Size{17, 9}, Size{63, 20}, Size{64, 20}, Size{65, 20},
                                           Size{127, 11}, Size{1000, 3}, Size{8192, 2}));

// A frame of one row or one column has no corner with a crossing: it passes unchanged.
TEST(SizesBlock, OneColumnPassesUnchanged) {
  EngineBench bench(deburr());
  const Frame column = noise(1, 50);
  EXPECT_EQ(hash(bench.run(column)), hash(column));
  const Frame line_of_noise = noise(200, 1);
  EXPECT_EQ(hash(bench.run(line_of_noise)), hash(line_of_noise));
  const Frame flat = draw(40, 40, [](int, int) { return grey(200); });
  EXPECT_EQ(hash(bench.run(flat)), hash(flat));
  EXPECT_EQ(bench.engine.blender.blended_pixels.value(), 0u);
}

TEST(Pixels, AlphaPassesAndAnIsolatedStepBlendsAsTheContractsTableSays) {
  EngineBench bench(preset(Preset::kMlaa));
  // A Z of three pixels: boundary on row 6 for x < 5, on row 7 from 8 on; between on row 6 / 7 ..
  Frame frame = draw(13, 12, [](int x, int y) {
    const int boundary = x < 5 ? 5 : x < 8 ? 6 : 7;
    Rgba8 p = grey(y >= boundary ? 255 : 0);
    p[3] = static_cast<std::uint8_t>(x + y);
    return p;
  });
  const Frame out = bench.run(frame);
  // Shares of the run of three on top edges of row 6: b85 b11/a11 a85.
  const auto tap = [&](int x, int y) {
    return bench.sink.beats()[static_cast<std::size_t>(y * 13 + x)].tap[0];
  };
  // Before: the start's crossing is north, so the upper pixels (row 5) take from below.
  EXPECT_EQ(tap(5, 5).second, 85);
  EXPECT_EQ(tap(6, 5).second, 11);
  EXPECT_EQ(tap(6, 6).first, 11);
  EXPECT_EQ(tap(7, 6).first, 85);
  EXPECT_EQ(tap(6, 6).edges, 2);
  EXPECT_EQ(tap(6, 3), spec::morphological::BlendTap{});
  for (int y = 0; y < 12; ++y)
    for (int x = 0; x < 13; ++x) EXPECT_EQ(out.at(x, y)[3], x + y);
}

// Mirroring the frame mirrors the output, whatever its size.
TEST(Symmetry, MirroredFramesGiveMirroredOutput) {
  Parameters p = preset(Preset::kDeburr, 9, 9);
  p.lanes = spec::morphological::Lanes::kTwo;
  p.steps = 5;
  EngineBench bench(p);
  const Frame frame = blocks(91, 60);
  const int w = frame.width, h = frame.height;
  const Frame out = bench.run(frame);
  const Frame across = bench.run(draw(w, h, [&](int x, int y) { return frame.at(w - 1 - x, y); }));
  const Frame upright = bench.run(draw(w, h, [&](int x, int y) { return frame.at(x, h - 1 - y); }));
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      ASSERT_EQ(across.at(w - 1 - x, y), out.at(x, y)) << x << ' ' << y;
      ASSERT_EQ(upright.at(x, h - 1 - y), out.at(x, y)) << x << ' ' << y;
    }
}

TEST(Symmetry, InvertedCodesGiveInvertedOutput) {
  Parameters p = deburr();
  p.linear_light = false;
  EngineBench bench(p);
  const Frame frame = blocks();
  const auto inverse = [](Rgba8 c) {
    for (std::size_t i = 0; i < 3; ++i) c[i] = static_cast<std::uint8_t>(255 - c[i]);
    return c;
  };
  const Frame out = bench.run(frame);
  const Frame inverted = bench.run(
      draw(frame.width, frame.height, [&](int x, int y) { return inverse(frame.at(x, y)); }));
  for (std::size_t i = 0; i < out.pixel.size(); ++i)
    ASSERT_EQ(inverted.pixel[i], inverse(out.pixel[i])) << i;
}

// ---- reset --------------------------------------------------------------------------------------

class ResetAt : public ::testing::TestWithParam<int> {};

TEST_P(ResetAt, AnyClockLeavesNothingBehind) {
  Parameters p = preset(Preset::kMlaaSlope);
  p.storage = GetParam() % 2 ? spec::morphological::Storage::kMemory
                             : spec::morphological::Storage::kLineBuffers;
  EngineBench::Options options;
  options.memory_latency = 90;
  EngineBench bench(p, options);
  bench.engine.set_frame_size(97, 61);
  bool first = true;
  const auto dense = beats_of(noise(), 1), wanted = beats_of(line(), 1);
  bench.driver.send([&](std::uint64_t i, spec::morphological::PixelBeat& beat) {
    const auto& beats = first ? dense : wanted;
    if (i >= beats.size()) return false;
    beat = beats[i];
    return true;
  });
  bench.clock.run(static_cast<Cycle>(GetParam()));
  EXPECT_FALSE(bench.engine.idle());
  bench.clock.set_reset_n(false);
  first = false;
  bench.clock.run(2);
  bench.clock.set_reset_n(true);
  EXPECT_EQ(bench.bus.read(reg::kSize), 0u);
  EXPECT_EQ(bench.bus.read(reg::kStatus), reg::kStatusIdle);
  EXPECT_EQ(bench.engine.work(), spec::morphological::Work{});
  bench.engine.set_frame_size(200, 150);
  bench.bench->run([&] { return bench.sink.received() == 200 * 150 && bench.engine.idle(); },
                   1'000'000);
  EXPECT_EQ(hash(bench.last(200, 150)), 0x75ccf871d174feafu);
  EXPECT_EQ(bench.engine.work().probes, 2560u);
}
INSTANTIATE_TEST_SUITE_P(Clocks, ResetAt,
                         ::testing::Values(5, 100, 3301, 3402, 3777, 4500, 5002, 6001, 7500, 9300));

// ---- registers ----------------------------------------------------------------------------------

TEST(Registers, ResetValuesAreTheParameters) {
  Parameters p = deburr();
  p.alpha = 1234;
  EngineBench bench(p);
  EXPECT_EQ(bench.bus.read(reg::kId), reg::kIdValue);
  EXPECT_EQ(bench.bus.read(reg::kControl), reg::kControlEnable);
  // luma, fixed, max, symmetric, fit, 8 steps, contiguous, safe, linear light, trim
  EXPECT_EQ(bench.bus.read(reg::kRules),
            1u << 3 | 2u << 4 | 2u << 6 | 8u << 8 | 1u << 13 | 1u << 14 | 1u << 15 | 1u << 16);
  EXPECT_EQ(bench.bus.read(reg::kThreshold), 1966u);
  EXPECT_EQ(bench.bus.read(reg::kAlpha), 1234u);
  EXPECT_EQ(bench.bus.read(reg::kFloor), 514u);
  EXPECT_EQ(bench.bus.read(reg::kDepthThreshold), 3277u);
  EXPECT_EQ(bench.bus.read(reg::kSize), 0u);
  bench.bus.write(reg::kPixelBase, 0x12345);
  EXPECT_EQ(bench.bus.read(reg::kPixelBase), 0x12340u);
  bench.bus.write(reg::kSize, 0xFFFFFFFF);
  EXPECT_EQ(bench.bus.read(reg::kSize), 0x3FFF3FFFu);
  EXPECT_EQ(bench.bus.write(reg::kPixels, 1), tlm::TLM_COMMAND_ERROR_RESPONSE);
}

TEST(Registers, RulesCountFromTheNextFrame) {
  EngineBench bench(deburr());
  EXPECT_EQ(hash(bench.run(blocks())), 0xe86c7f9318eacf5eu);
  // Without trim the same trials, but every step is kept.
  EXPECT_EQ(bench.bus.read(reg::kSteps), 660u);
  bench.bus.write(reg::kRules, bench.bus.read(reg::kRules) & ~(1u << 16));
  EXPECT_EQ(hash(bench.run(blocks())), 0x464376bac387fe0du);
  EXPECT_EQ(bench.bus.read(reg::kSteps), 660u + 970u);
  EXPECT_EQ(bench.bus.read(reg::kProbes), 2u * 5382u);
  // mlaa: T = 0.1, no local contrast, no predictor.
  bench.bus.write(reg::kRules, 1u << 15);
  bench.bus.write(reg::kThreshold, 6554);
  EXPECT_EQ(hash(bench.run(line())), 0x5d62265609239471u);
  // mlaa-slope.
  bench.bus.write(reg::kRules, 1u << 15 | 1u << 6 | 4u << 8);
  EXPECT_EQ(hash(bench.run(noise())), 0x6c40266cf03f3513u);
  // Codes that no choice has: luma, off, none.
  bench.bus.write(reg::kRules, 1u << 15 | 3u | 3u << 4 | 3u << 6 | 31u << 8);
  EXPECT_EQ(hash(bench.run(line())), 0x5d62265609239471u);
}

TEST(Registers, WritesWhileAFrameIsInsideAreIgnoredAndSaidSo) {
  EngineBench bench(deburr());
  bench.engine.set_frame_size(200, 150);
  bench.driver.send(beats_of(line(), 1));
  bench.clock.run(500);
  EXPECT_EQ(bench.bus.read(reg::kStatus), 0u) << "not idle";
  bench.bus.write(reg::kThreshold, 60000);
  bench.bus.write(reg::kSize, 5);
  EXPECT_EQ(bench.bus.read(reg::kThreshold), 1966u);
  EXPECT_EQ(bench.bus.read(reg::kSize), 200u | 150u << 16);
  EXPECT_EQ(bench.bus.read(reg::kStatus), reg::kStatusWrittenWhileBusy);
  bench.bench->run([&] { return bench.sink.received() == 30000 && bench.engine.idle(); }, 100'000);
  EXPECT_EQ(hash(bench.last(200, 150)), 0x736d3ffd8a940ba4u);
  EXPECT_EQ(bench.bus.read(reg::kStatus),
            reg::kStatusIdle | reg::kStatusFrameDone | reg::kStatusWrittenWhileBusy);
  bench.bus.write(reg::kStatus, reg::kStatusFrameDone);
  EXPECT_EQ(bench.bus.read(reg::kStatus), reg::kStatusIdle | reg::kStatusWrittenWhileBusy);
}

TEST(Registers, CountersShowTheWorkAddUpAndAreCleared) {
  EngineBench bench(preset(Preset::kMlaaSlope));
  bench.run(noise());
  const auto check = [&](std::uint32_t frames) {
    EXPECT_EQ(bench.bus.read(reg::kPixels), frames * 97u * 61u);
    EXPECT_EQ(bench.bus.read(reg::kHorizontalRuns) + bench.bus.read(reg::kVerticalRuns),
              frames * 2958u);
    EXPECT_EQ(bench.bus.read(reg::kLongRuns), 0u);
    EXPECT_EQ(bench.bus.read(reg::kZRuns), frames * 1390u);
    EXPECT_EQ(bench.bus.read(reg::kExtendedRuns), frames * 671u);
    EXPECT_EQ(bench.bus.read(reg::kSteps), frames * 1062u);
    EXPECT_EQ(bench.bus.read(reg::kProbes), frames * 9200u);
    EXPECT_EQ(bench.bus.read(reg::kBlendedPixels), frames * 3175u + frames * 107u);
    EXPECT_EQ(bench.bus.read(reg::kDivides), frames * 2958u);  // every run has a side
  };
  check(1);
  EXPECT_EQ(bench.bus.read(reg::kFrameCycles), (61u + 37u) * 97u + 6u);
  bench.run(noise());
  check(2);
  bench.bus.write(reg::kControl, reg::kControlEnable | reg::kControlClearCounters);
  EXPECT_EQ(bench.bus.read(reg::kControl), reg::kControlEnable);
  check(0);
  EXPECT_EQ(bench.engine.work(), spec::morphological::Work{});
}

TEST(Registers, ClearingEnableLetsTheFrameInsideFinish) {
  EngineBench bench(deburr());
  bench.engine.set_frame_size(97, 61);
  bench.driver.send(beats_of(noise(), 1));
  bench.driver.send(beats_of(noise(), 1));
  bench.clock.run(300);
  bench.bus.write(reg::kControl, 0);
  bench.clock.run(40'000);
  EXPECT_EQ(bench.sink.received(), 97u * 61u);
  bench.bus.write(reg::kControl, reg::kControlEnable);
  bench.clock.run(40'000);
  EXPECT_EQ(bench.sink.received(), 2u * 97u * 61u);
}

struct BadSize {
  std::uint32_t width, height;
};
void PrintTo(const BadSize& s, std::ostream* out) { *out << s.width << 'x' << s.height; }
class BadSizes : public ::testing::TestWithParam<BadSize> {};
TEST_P(BadSizes, TakeNoFrameAndSetTheFramingBit) {
  EngineBench bench(deburr());
  bench.bus.write(reg::kSize, GetParam().width | GetParam().height << 16);
  bench.driver.send(beats_of(noise(10, 10), 1));
  bench.clock.run(200);
  EXPECT_EQ(bench.sink.received(), 0u);
  EXPECT_EQ(bench.in.pops(), 0u);
  EXPECT_EQ(bench.bus.read(reg::kStatus), reg::kStatusIdle | reg::kStatusFraming);
  // The right size heals it.
  bench.engine.set_frame_size(10, 10);
  bench.clock.run(3000);
  EXPECT_EQ(bench.sink.received(), 100u);
}
INSTANTIATE_TEST_SUITE_P(Bad, BadSizes,
                         ::testing::Values(BadSize{0, 0}, BadSize{0, 10}, BadSize{10, 0},
                                           BadSize{257, 10}, BadSize{8193, 10}, BadSize{10, 8193}));

TEST(Framing, SizeWinsAndDataGoOn) {
  EngineBench bench(deburr());
  bench.engine.set_frame_size(20, 10);
  // Beats of a frame of 25 x 8: the same number. They are pixels of 20 x 10 now.
  const Frame sent = noise(25, 8);
  bench.driver.send(beats_of(sent, 1));
  bench.bench->run([&] { return bench.sink.received() == 200 && bench.engine.idle(); }, 10'000);
  EXPECT_TRUE(bench.sink.beats()[19].end_of_row);
  EXPECT_EQ(bench.bus.read(reg::kStatus) & reg::kStatusFraming, reg::kStatusFraming);
  EXPECT_EQ(bench.engine.sequencer.framing_errors.value(), 8u + 10u - 2u * 2u);
  const Frame out = bench.last(20, 10);
  const spec::morphological::Work work = bench.engine.work();
  EXPECT_GT(work.blended_pixels, 50u);
  bench.bus.write(reg::kControl, reg::kControlEnable | reg::kControlClearCounters);
  bench.bus.write(reg::kStatus, reg::kStatusFraming);
  Frame framed(20, 10);
  framed.pixel = sent.pixel;
  bench.driver.send(beats_of(framed, 1));
  bench.bench->run([&] { return bench.sink.received() == 400 && bench.engine.idle(); }, 10'000);
  EXPECT_EQ(bench.last(20, 10).pixel, out.pixel);
  EXPECT_EQ(bench.engine.work(), work);
  EXPECT_EQ(bench.bus.read(reg::kStatus) & reg::kStatusFraming, 0u);
}

// ---- memory -------------------------------------------------------------------------------------

TEST(Memory, EachLineIsWrittenOnceAndReadOnceInOrder) {
  Parameters p = preset(Preset::kMlaa);
  p.storage = spec::morphological::Storage::kMemory;
  EngineBench bench(p);
  bench.bus.write(reg::kPixelBase, 0x4000);
  const Frame frame = noise(97, 61);
  bench.run(frame);
  const std::uint64_t lines = 61 * 7;  // 97 pixels are 388 bytes, 7 lines
  EXPECT_EQ(bench.memory->writes(), lines);
  EXPECT_EQ(bench.memory->reads(), lines);
  EXPECT_EQ(bench.engine.pixel_store.lines_written.value(), lines);
  EXPECT_EQ(bench.engine.pixel_store.lines_read.value(), lines);
  EXPECT_EQ(bench.engine.memory_port->bytes_written.value(), lines * 64);
  ASSERT_EQ(bench.memory->lines_read().size(), lines);
  for (std::uint64_t i = 0; i < lines; ++i)
    ASSERT_EQ(bench.memory->lines_read()[i], 0x4000 + 64 * i);
  const auto bytes = bench.memory->dump(0x4000, lines * 64);
  for (int y = 0; y < 61; ++y)
    for (int x = 0; x < 112; ++x)
      for (std::size_t c = 0; c < 4; ++c)
        ASSERT_EQ(bytes[static_cast<std::size_t>(y * 448 + 4 * x) + c],
                  x < 97 ? frame.at(x, y)[c] : 0)
            << x << ' ' << y;
}

TEST(Memory, AnErrorIsCountedAndTheLineReadsAsZeros) {
  Parameters p = preset(Preset::kMlaa);
  p.storage = spec::morphological::Storage::kMemory;
  EngineBench bench(p);
  bench.memory->fail_range(64 * 3, 64 * 4);  // written and read: two errors
  const Frame out = bench.run(draw(64, 2, [](int, int) { return grey(200); }));
  for (int x = 0; x < 64; ++x) EXPECT_EQ(out.at(x, 0)[0], x < 48 ? 200 : 0) << x;
  EXPECT_EQ(out.at(50, 0)[3], 0);
  EXPECT_EQ(bench.bus.read(reg::kMemoryErrors), 2u);
  EXPECT_EQ(bench.bus.read(reg::kStatus),
            reg::kStatusIdle | reg::kStatusFrameDone | reg::kStatusMemoryError);
}

TEST(Memory, OutstandingIsKept) {
  Parameters p = preset(Preset::kMlaa);
  p.storage = spec::morphological::Storage::kMemory;
  p.lanes = spec::morphological::Lanes::kFour;
  p.memory_outstanding = 3;
  EngineBench::Options options;
  options.memory_latency = 200;
  EngineBench bench(p, options);
  bench.run(noise());
  EXPECT_EQ(bench.memory->most_outstanding(), 6u);
}

// ---- accounts, waves, memories ------------------------------------------------------------------

TEST(Accounts, EveryUnitHasItsNameAndEveryClockItsClass) {
  EngineBench bench(deburr());
  bench.run(blocks());
  std::vector<std::string> names;
  for (const rtl::Unit* unit : bench.engine.units()) {
    names.emplace_back(unit->basename());
    EXPECT_EQ(unit->busy_cycles() + unit->stalled_cycles() + unit->idle_cycles(),
              bench.clock.cycle());
  }
  EXPECT_THAT(names, ::testing::UnorderedElementsAre(
                         "sequencer", "luma", "edges", "extractor", "predictor_h", "predictor_v",
                         "divider_h", "divider_v", "area", "pixel_store", "blender"));
  // Every slot is a busy clock of the pipe.
  EXPECT_EQ(bench.engine.sequencer.busy_cycles(), (80u + 37u) * 90u);
  EXPECT_EQ(bench.engine.blender.busy_cycles(), 80u * 90u + 1u);
  EXPECT_EQ(bench.engine.beat_latency.count(), 80u * 90u);
}

TEST(Accounts, MemoriesAreThoseOfTheContract) {
  Parameters p;  // defaults
  p.line_pixels = 1920;
  p.edge_source = spec::morphological::EdgeSource::kPredicated;
  EngineBench bench(p);
  std::map<std::string, std::uint64_t> bits;
  for (const rtl::Storage* storage : bench.engine.memories())
    bits[storage->basename()] = storage->bits();
  EXPECT_EQ(bits["edge_window"], 257'280u);
  EXPECT_EQ(bits["luma_lines"], 138'240u);
  EXPECT_EQ(bits["depth_lines"], 92'160u);
  EXPECT_EQ(bits["pixel_lines"], 2'396'160u);
  EXPECT_EQ(bits["left_weight_lines"] + bits["top_weight_lines"], 92'160u);
  EXPECT_EQ(bits["row_records"], 207'360u);
  EXPECT_EQ(bits["column_records"], 209'280u);
  EXPECT_EQ(bits["record_fifo_h0"], 256u * 59u);
  EXPECT_EQ(bench.engine.window.bits_at(960), 257'280u / 2);
}

TEST(Waves, ShowTheLinksOfTheEngine) {
  const std::string file = ::testing::TempDir() + "morphological_rtl.vcd";
  {
    EngineBench::Options options;
    options.bench.trace = rtl::TraceOptions{};
    options.bench.trace->file = file;
    options.bench.trace->scopes = {"engine*"};
    EngineBench bench(deburr(), options);
    EXPECT_EQ(hash(bench.run(blocks())), 0xe86c7f9318eacf5eu);
  }
  std::stringstream text;
  text << std::ifstream(file).rdbuf();
  EXPECT_THAT(text.str(), ::testing::HasSubstr("edge_bits"));
  EXPECT_THAT(text.str(), ::testing::HasSubstr("extractor"));
  std::remove(file.c_str());
}

TEST(Observers, SeeEveryRunAndEveryLine) {
  EngineBench bench(deburr());
  std::uint64_t runs = 0, lines = 0;
  bench.engine.observe_runs([&](const spec::morphological::RunRecord&) { ++runs; });
  bench.engine.observe_lines([&](const spec::morphological::LineRecord& line) {
    ++lines;
    EXPECT_LE(line.slope, 1u << 23);
  });
  bench.run(blocks());
  EXPECT_EQ(runs, 1198u);
  EXPECT_EQ(lines, bench.engine.work().divides);
}

// ---- parameters ---------------------------------------------------------------------------------

struct BadParameter {
  const char* says;
  void (*change)(Parameters&);
};
void PrintTo(const BadParameter& b, std::ostream* out) { *out << b.says; }
class BadParameters : public ::testing::TestWithParam<BadParameter> {};
TEST_P(BadParameters, AreNamed) {
  ClockDomain clock("clock", period());
  Parameters p = deburr();
  GetParam().change(p);
  try {
    rtl::morphological::MorphologicalEngine engine("engine", clock, p);
    FAIL() << "no error";
  } catch (const spec::ConfigError& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr(GetParam().says));
  }
}
INSTANTIATE_TEST_SUITE_P(
    Bad, BadParameters,
    ::testing::Values(
        BadParameter{"window_rows", [](auto& p) { p.window_rows = 67; }},
        BadParameter{"window_rows", [](auto& p) { p.window_rows = 8; }},
        BadParameter{"steps need window_rows of at least 20", [](auto& p) { p.window_rows = 18; }},
        BadParameter{"reach_columns", [](auto& p) { p.reach_columns = 3; }},
        BadParameter{"predicated",
                     [](auto& p) {
                       p.edge_source = spec::morphological::EdgeSource::kPredicated;
                       p.threshold_mode = spec::morphological::ThresholdMode::kDynamic;
                     }},
        BadParameter{"table_full is not built",
                     [](auto& p) { p.area = spec::morphological::AreaSource::kTableFull; }},
        BadParameter{"diagonals: not built", [](auto& p) { p.diagonals = true; }},
        BadParameter{"round_corners: not built", [](auto& p) { p.round_corners = true; }},
        BadParameter{"threshold", [](auto& p) { p.threshold = 0; }},
        BadParameter{"line_pixels", [](auto& p) { p.line_pixels = 8193; }}));

TEST(BadFrames, AreNamed) {
  EngineBench bench(deburr());
  EXPECT_THROW(bench.engine.set_frame_size(0, 5), spec::ConfigError);
  EXPECT_THROW(bench.engine.set_frame_size(5, 8193), spec::ConfigError);
  EXPECT_THROW(bench.engine.set_frame_size(257, 5), spec::ConfigError);
  EXPECT_NO_THROW(bench.engine.set_frame_size(256, 5));
}

// ---- faults -------------------------------------------------------------------------------------

struct Planted {
  const char* fault;
};
void PrintTo(const Planted& p, std::ostream* out) { *out << p.fault; }
class Faults : public ::testing::TestWithParam<Planted> {};

// Each of these must be noticed: by the hash, a check, or the watchdog.
TEST_P(Faults, AreCaught) {
  EngineBench::Options options;
  options.bench.faults = {GetParam().fault};
  options.bench.check_links = false;
  options.bench.patience = 5'000;
  EngineBench bench(preset(Preset::kMlaaSlope), options);
  bool caught = false;
  try {
    caught = hash(bench.run(noise(), 100'000)) != 0x6c40266cf03f3513u ||
             bench.engine.work().probes != 9200u;
  } catch (const spec::SimulationError& error) {
    // A planted fault that was never reached is no catch.
    caught = std::string(error.what()).find("never") == std::string::npos;
  } catch (const std::exception&) {
    caught = true;
  }
  EXPECT_TRUE(caught);
}
INSTANTIATE_TEST_SUITE_P(
    Planted, Faults,
    ::testing::Values(Planted{"flip:engine.slots:2000:79"},         // a high bit of green
                      Planted{"flip:engine.lumas:3000:87"},         // a high bit of luma
                      Planted{"flip:engine.edge_bits:2500:64"},     // a left edge
                      Planted{"drop:engine.edge_bits:2500"},        // a slot is lost
                      Planted{"duplicate:engine.area_slots:4500"},  // a slot comes twice
                      Planted{"flip:engine.sums_h0:200:195"},       // position of the last corner
                      Planted{"drop:engine.lines_v0:50"},           // a record is lost
                      Planted{"drop:engine.finished:20"},           // a record never ends
                      Planted{"flip:engine.pixels:3000:135"},       // a pixel to be blended
                      Planted{"drop:engine.shares:3000"},           // a slot is lost
                      Planted{"drop:engine.frames_done:0"},         // the frame never ends
                      Planted{"stuck_ready:engine.beats:3000"}));

}  // namespace
}  // namespace deburr::tb::morphological_rtl
