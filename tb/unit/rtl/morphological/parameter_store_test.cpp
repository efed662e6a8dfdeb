// SPDX-License-Identifier: MIT
// Registers of the morphological engine: the value of each field that a frame sees, when a write
// takes effect, sizes, counters, and the tables of learned weights. The suite RegisterFile tests
// access and bits of each register; whole runs compared with the golden model test the effect of
// each field.
#include <algorithm>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "spec/morphological/learned_weights.h"
#include "tb/unit/rtl/morphological/parts.h"
#include "tb/unit/rtl/morphological/vectors.h"

namespace deburr::tb::morphological_rtl::parameter_store_test {
namespace {

using spec::morphological::Preset;
namespace reg = spec::morphological::reg;

TEST(ParameterStoreBlock, LatchesConfigurationWithTheFrame) {
  constexpr std::uint32_t kTrimBit = 1u << 17;
  WiredRegisters on(preset(spec::morphological::Preset::kDeburrLine));
  const std::uint32_t reset_value = on.bus.read(reg::kConfiguration);
  EXPECT_EQ(reset_value,
            1u << 3 | 2u << 5 | 2u << 7 | 8u << 9 | 1u << 14 | 1u << 15 | 1u << 16 | kTrimBit);
  EXPECT_TRUE(on.frame(8, 8).trim);
  on.bus.write(reg::kConfiguration, reset_value & ~kTrimBit);
  EXPECT_EQ(on.bus.read(reg::kConfiguration), reset_value & ~kTrimBit);
  EXPECT_TRUE(on.seen_by_units().trim) << "until the next frame begins";
  ASSERT_TRUE(on.latch());
  EXPECT_FALSE(on.seen_by_units().trim);
  EXPECT_TRUE(on.seen_by_units().safe);
  on.bus.write(reg::kConfiguration, ~0u);
  EXPECT_EQ(on.bus.read(reg::kConfiguration), 0x1FFFFFFFu) << "no bits beyond";
  on.control.reset();
  EXPECT_EQ(on.bus.read(reg::kConfiguration), reset_value);
}

TEST(ParameterStoreBlock, AcceptsFramesWhileEnabled) {
  WiredRegisters registers(small());
  EXPECT_TRUE(registers.accepts_frames());
  registers.bus.write(reg::kControl, 0);
  EXPECT_FALSE(registers.accepts_frames());
  EXPECT_EQ(registers.seen_by_units(), rtl::morphological::FrameConfiguration{})
      << "nothing is latched";
  registers.bus.write(reg::kControl, reg::kControlEnable);
  EXPECT_TRUE(registers.accepts_frames());
}

TEST(ParameterStoreBlock, EachPulseSetsItsStatusBit) {
  WiredRegisters registers(in_memory());
  rtl::Pulse memory_error("memory_error");
  (*registers.store.memory_error_in)(memory_error);
  Cycle cycle = 0;
  for (auto [pulse, bit] : {std::pair{&registers.frame_done, reg::kStatusFrameDone},
                            {&registers.framing, reg::kStatusFraming},
                            {&memory_error, reg::kStatusMemoryError}}) {
    pulse->raise(++cycle);
    EXPECT_EQ(registers.bus.read(reg::kStatus), reg::kStatusIdle | bit);
    registers.bus.write(reg::kStatus, bit);
  }
}

// The register SMAA: its reset value, and values outside each range.
TEST(ParameterStoreBlock, SmaaFieldsAreClampedToTheBuild) {
  Parameters p = smaa();
  p.diagonal_steps = 6;
  p.search_steps = 17;
  p.corner_rounding = 200;
  WiredRegisters store(p);
  EXPECT_EQ(store.bus.read(reg::kSmaa), 17u | 6u << 8 | 200u << 16);
  struct Row {
    std::uint32_t value;
    std::int32_t search, diagonal, loss;
  };
  for (const Row& row :
       {Row{17u | 6u << 8 | 200u << 16, 17, 6, 56}, Row{0, 1, 0, 256},
        Row{1u | 1u << 8 | 1u << 16, 1, 1, 255}, Row{112u | 7u << 8 | 256u << 16, 112, 6, 0},
        Row{127u | 31u << 8 | 511u << 16, 112, 6, 0}}) {
    store.bus.write(reg::kSmaa, row.value);
    const rtl::morphological::FrameConfiguration& configuration = store.frame(8, 8);
    EXPECT_TRUE(configuration.table && configuration.crossings && configuration.strongest);
    EXPECT_EQ(configuration.search_steps, row.search) << row.value;
    EXPECT_EQ(configuration.diagonal_steps, row.diagonal) << row.value;
    EXPECT_EQ(configuration.corner_loss, row.loss) << row.value;
  }
}

TEST(ParameterStoreBlock, DiagonalStepsAreClampedToTheSearchRange) {
  Parameters p = smaa();
  p.window_rows = 10;
  p.diagonal_steps = 4;
  WiredRegisters store(p);
  store.bus.write(reg::kSmaa, 4u | 31u << 8);
  store.frame(8, 8);
  EXPECT_EQ(store.seen_by_units().diagonal_steps, 4);
}

TEST(ParameterStoreBlock, StepsAreClampedToTheWindow) {
  for (const int window_rows : {10, 12, 34, 66}) {
    Parameters p = preset(Preset::kDeburrLine);
    p.window_rows = window_rows;
    WiredRegisters store(p);
    store.bus.write(reg::kConfiguration, 1u << 7 | 31u << 9);
    store.frame(8, 8);
    EXPECT_EQ(store.seen_by_units().steps, std::min(16, window_rows / 2 - 2)) << window_rows;
  }
}

// ---- decoded fields -----------------------------------------------------------------------------

// Names and values of the fields that differ from `from`.
std::string text_of(const rtl::morphological::FrameConfiguration& f,
                    const rtl::morphological::FrameConfiguration& from) {
  std::vector<std::pair<std::string_view, int>> fields;
  const auto collect = [&](std::string_view name, const auto& value, const auto&...) {
    fields.emplace_back(name, static_cast<int>(value));
  };
  rtl::morphological::FrameConfiguration::fields(from, collect);
  const auto before = fields;
  fields.clear();
  rtl::morphological::FrameConfiguration::fields(f, collect);
  std::string text;
  for (std::size_t i = 0; i < fields.size(); ++i)
    if (fields[i] != before[i])
      text += (text.empty() ? "" : ", ") + std::string(fields[i].first) + ' ' +
              std::to_string(fields[i].second);
  return text;
}
using ConfigurationRow = std::pair<std::uint32_t, std::string>;
void expect_configuration(const Parameters& p, const std::vector<ConfigurationRow>& rows) {
  WiredRegisters registers(p);
  registers.bus.write(reg::kSmaa, 5u << 8);
  registers.bus.write(reg::kConfiguration, 0);
  const rtl::morphological::FrameConfiguration none = registers.frame(8, 8);
  for (const auto& [value, fields] : rows) {
    registers.bus.write(reg::kConfiguration, value);
    EXPECT_EQ(text_of(registers.frame(8, 8), none), fields) << value;
  }
}

TEST(FrameConfiguration, EachConfigurationBitSetsItsField) {
  Parameters p = smaa();
  p.window_rows = 42;
  p.diagonal_steps = 8;
  p.contiguous = true;
  const auto unchanged = [](int v) { return v; };
  struct Field {
    const char* name;
    int low, bits;
    int (*shown)(int);
  };
  for (const Field& field : {Field{"source", 0, 2, unchanged},
                             {"dynamic", 2, 1, unchanged},
                             {"dynamic_luma", 3, 2, unchanged},
                             {"local_contrast", 5, 2, unchanged},
                             {"predictor", 7, 2, [](int v) { return v % 3; }},
                             {"steps", 9, 5, [](int) { return 0; }},  // without a predictor
                             {"contiguous", 14, 1, unchanged},
                             {"safe", 15, 1, unchanged},
                             {"linear_light", 16, 1, unchanged},
                             {"trim", 17, 1, unchanged},
                             {"crossings", 18, 1, unchanged},
                             {"table", 19, 1, unchanged},
                             {"diagonal_steps", 20, 1, [](int v) { return 5 * v; }},
                             {"corners", 21, 1, unchanged},
                             {"strongest", 22, 1, unchanged},
                             {"learned", 23, 1, [](int) { return 0; }},  // not built
                             {"bypass", 24, 3, [](int v) { return v < 5 ? v : 0; }}})
    for (int value = 0; value < 1 << field.bits; ++value) {
      const int shown = field.shown(value);
      expect_configuration(
          p, {{static_cast<std::uint32_t>(value) << field.low,
               shown == 0 ? "" : std::string(field.name) + ' ' + std::to_string(shown)}});
    }
  expect_configuration(p, {{1u << 7 | 1u << 9, "predictor 1, steps 1"},
                           {1u << 7 | 2u << 9, "predictor 1, steps 2"},
                           {1u << 7 | 4u << 9, "predictor 1, steps 4"},
                           {1u << 7 | 8u << 9, "predictor 1, steps 8"},
                           {2u << 7 | 16u << 9, "predictor 2, steps 16"},
                           {1u << 27, ""},
                           {1u << 27 | 1u << 18, "crossings 1"},
                           {1u << 27 | 1u << 19, "table 1"},
                           {1u << 27 | 3u << 18, "crossings 1, clamp 1, table 1"},
                           {0xF0000000, ""},
                           // Only with some sources of edges.
                           {1u << 2 | 1, "source 1"},
                           {1u << 2 | 2, "source 2"},
                           {1u << 2 | 3, "source 3"},
                           {1u << 5 | 1, "source 1"},
                           {1u << 5 | 2, "source 2, local_contrast 1"}});
  p.border = spec::morphological::Border::kEnd;  // clamp is not built
  expect_configuration(p, {{1u << 27 | 3u << 18, "crossings 1, table 1"}});
  p.text_guard = true;
  expect_configuration(p, {{1u << 28, "text_guard 1"}, {0xE0000000, ""}});
}
// Unused bits have no effect, even if the register file stores them.
TEST(FrameConfiguration, UnusedBitsAreIgnored) {
  rtl::ControlRegisters raw("raw", spec::morphological::kRegisters,
                            rtl::morphological::control_layout());
  const auto decoded = [&] { return rtl::morphological::decode(raw, smaa()); };
  const rtl::morphological::FrameConfiguration none = decoded().configuration;
  raw.write(reg::kConfiguration, 0xF0000000);
  EXPECT_EQ(text_of(decoded().configuration, none), "");
  raw.write(reg::kConfiguration, 0xF0000000 | 1u << 24);
  EXPECT_EQ(text_of(decoded().configuration, none), "bypass 1");
  raw.write(reg::kSize, 0xC000C000 | 40 | 30 << 16);
  EXPECT_EQ(decoded().configuration.width, 40);
  EXPECT_EQ(decoded().configuration.height, 30);
  raw.write(reg::kSmaa, 0xFE00E080);
  raw.write(reg::kConfiguration, 1u << 20);
  EXPECT_EQ(decoded().configuration.search_steps, 1);
  EXPECT_EQ(decoded().configuration.diagonal_steps, 0);
  EXPECT_EQ(decoded().configuration.corner_loss, 256);
}
TEST(FrameConfiguration, UnbuiltBlocksAreOff) {
  Parameters p = small();
  p.contiguous = false;
  expect_configuration(p, {{15u << 18 | 1u << 14 | 1u << 23 | 3u << 27, ""}});
  // A build with learned weights only. The second row sets all fields above bit 16 except `learned`
  // and the highest bit of `bypass`.
  expect_configuration(deburr(),
                       {{1u << 23, "learned 1"},
                        {0x7FE0000u & ~(1u << 23) & ~(1u << 26), "trim 1, strongest 1, bypass 3"},
                        {2u << 3, "dynamic_luma 2"},
                        {1u << 14, "contiguous 1"}});
}

TEST(FrameConfiguration, ThresholdsMatchTheirRegisters) {
  WiredRegisters r(preset(Preset::kMlaa));
  std::uint32_t value = 100;
  std::vector<std::uint32_t> wanted;
  for (const std::uint32_t offset :
       {reg::kThreshold, reg::kThresholdOn, reg::kThresholdOff, reg::kFloor, reg::kAlpha,
        reg::kDepthThreshold, reg::kPixelBase}) {
    r.bus.write(offset, value += 64 * 3 + (offset == reg::kPixelBase ? 64 - value % 64 : 0));
    wanted.push_back(value);
    EXPECT_EQ(r.bus.read(offset), value);
  }
  const rtl::morphological::FrameConfiguration& f = r.frame(8, 8);
  EXPECT_EQ((std::vector<std::uint32_t>{f.threshold, f.threshold_on, f.threshold_off, f.floor,
                                        f.alpha, f.depth_threshold, f.pixel_base}),
            wanted);
  for (const std::uint32_t offset : {reg::kThreshold, reg::kThresholdOn, reg::kThresholdOff,
                                     reg::kFloor, reg::kAlpha, reg::kDepthThreshold})
    r.bus.write(offset, ~0u);
  r.frame(8, 8);
  EXPECT_EQ((std::vector<std::uint32_t>{f.threshold, f.threshold_on, f.threshold_off, f.floor,
                                        f.alpha, f.depth_threshold}),
            (std::vector<std::uint32_t>{0xFFFFFF, 0xFFFFFF, 0xFFFFFF, 0xFFFFFF, 0xFFFFFF, 0xFFFF}));
}

TEST(FrameConfiguration, BeatsAndRowsFollowFrameSize) {
  struct Row {
    int lanes_code, width, height;
    std::uint32_t beats, rows;
    int last_count;
  };
  for (const Row& row : {Row{0, 1, 1, 1, 10, 1}, Row{0, 9, 7, 9, 16, 1}, Row{1, 1, 1, 1, 10, 1},
                         Row{1, 8, 7, 4, 16, 2}, Row{1, 9, 7, 5, 16, 1}, Row{2, 1, 1, 1, 10, 1},
                         Row{2, 8, 7, 2, 16, 4}, Row{2, 9, 7, 3, 16, 1}, Row{2, 11, 7, 3, 16, 3},
                         Row{2, 12, 7, 3, 16, 4}, Row{2, 13, 7, 4, 16, 1}}) {
    WiredRegisters r(small(row.lanes_code));
    const rtl::morphological::FrameConfiguration& f = r.frame(row.width, row.height);
    EXPECT_EQ(f.width, row.width);
    EXPECT_EQ(f.height, row.height);
    EXPECT_EQ(f.beats, row.beats) << row.width;
    EXPECT_EQ(f.rows, row.rows) << "height + R + 5, R = 4";
    EXPECT_EQ(f.last_count, row.last_count) << row.width;
  }
}

// A frame outside the limits is rejected with an error; a previous frame that is inside is not
// affected.
TEST(FrameConfiguration, RejectsSizesBeyondTheLimits) {
  Parameters p = small();
  p.line_pixels = 100;
  WiredRegisters r(p);
  const auto takes = [&](std::uint32_t width, std::uint32_t height) {
    r.bus.write(reg::kSize, width | height << 16);
    r.bus.write(reg::kStatus, ~0u);
    const rtl::morphological::FrameConfiguration before = r.seen_by_units();
    const bool taken = r.latch();
    EXPECT_EQ((r.bus.read(reg::kStatus) & reg::kStatusFraming) == 0, taken);
    EXPECT_EQ(r.seen_by_units().width, taken ? width : before.width);
    return taken;
  };
  EXPECT_TRUE(takes(1, 1));
  EXPECT_FALSE(takes(0, 1));
  EXPECT_FALSE(takes(1, 0));
  EXPECT_TRUE(takes(100, 8192));
  EXPECT_FALSE(takes(101, 8192));
  EXPECT_FALSE(takes(100, 8193));
}

// Unused register bits stay 0 for debug writes as well.
TEST(DebugWrites, DebugWritesTakeEffectFromTheNextFrame) {
  EngineBench bench(in_memory());
  ASSERT_TRUE(bench.bus.debug_write(reg::kPixelBase, 0x12345));
  ASSERT_TRUE(bench.bus.debug_write(reg::kSize, 97u | 61u << 16 | 0xC000C000u));
  ASSERT_TRUE(bench.bus.debug_write(reg::kThreshold, 0xAB000000u | 1671270u));
  ASSERT_TRUE(bench.bus.debug_write(reg::kConfiguration, 0xFE000000u | 1u << 16));
  const Frame in = noise();
  bench.driver.send(beats_of(in, 1));
  bench.bench->run([&] { return bench.sink.received() == 97u * 61u && bench.engine.idle(); },
                   1'000'000);
  EXPECT_EQ(bench.bus.read(reg::kPixelBase), 0x12340u);
  EXPECT_EQ(bench.bus.read(reg::kSize), 97u | 61u << 16);
  EXPECT_EQ(bench.bus.read(reg::kThreshold), 1671270u);
  EXPECT_EQ(bench.bus.read(reg::kConfiguration), 15u << 25 | 1u << 16);
  ASSERT_FALSE(bench.memory->lines_read().empty());
  EXPECT_EQ(bench.memory->lines_read()[0], 0x12340u);
  EXPECT_EQ(bench.bus.read(reg::kMemoryErrors), 0u);
}

// ---- during a frame -----------------------------------------------------------------------------

TEST(Registers, CountersAddUpAndAreCleared) {
  EngineBench bench(smaa());
  for (const std::uint32_t frames : {1u, 2u}) {
    bench.run(noise());
    EXPECT_EQ(bench.bus.read(reg::kPixels), frames * 97u * 61u);
    EXPECT_EQ(bench.bus.read(reg::kDiagonals), frames * 258u);  // as in the contract's vector
  }
  bench.bus.write(reg::kControl, reg::kControlEnable | reg::kControlClearCounters);
  EXPECT_EQ(bench.bus.read(reg::kControl), reg::kControlEnable);
  EXPECT_EQ(bench.bus.read(reg::kDiagonals), 0u);
  EXPECT_EQ(bench.engine.work(), spec::morphological::Work{});
}

TEST(Registers, WritesAreIgnoredDuringAFrame) {
  EngineBench bench(deburr_line());
  bench.send(line());
  bench.clock.run(500);
  EXPECT_EQ(bench.bus.read(reg::kStatus), 0u) << "not idle";
  for (const spec::RegisterInfo& info : spec::morphological::kRegisters)
    if (info.written() != 0 && info.offset != reg::kControl) {
      const std::uint32_t value = bench.bus.read(info.offset);
      bench.bus.write(info.offset, ~value);
      EXPECT_EQ(bench.bus.read(info.offset), value) << info.name;
    }
  EXPECT_EQ(bench.bus.read(reg::kThreshold), 501330u);
  EXPECT_EQ(bench.bus.read(reg::kSize), 200u | 150u << 16);
  EXPECT_EQ(bench.bus.read(reg::kStatus), reg::kStatusWrittenWhileBusy);
  bench.finish();
  EXPECT_EQ(hash(bench.last(200, 150)), vector_hash("line_deburr_line"));
  EXPECT_EQ(bench.bus.read(reg::kStatus),
            reg::kStatusIdle | reg::kStatusFrameDone | reg::kStatusWrittenWhileBusy);
  bench.bus.write(reg::kStatus, reg::kStatusFrameDone);
  EXPECT_EQ(bench.bus.read(reg::kStatus), reg::kStatusIdle | reg::kStatusWrittenWhileBusy);
}

TEST(Registers, DisablingLetsTheCurrentFrameFinish) {
  EngineBench bench(deburr_line());
  bench.send(noise());
  bench.send(noise());
  bench.clock.run(300);
  bench.bus.write(reg::kControl, 0);
  bench.clock.run(40'000);
  EXPECT_EQ(bench.sink.received(), 97u * 61u);
  bench.bus.write(reg::kControl, reg::kControlEnable);
  bench.clock.run(40'000);
  EXPECT_EQ(bench.sink.received(), 2u * 97u * 61u);
}

// Registers that always read as 0 are not stored.
TEST(RegisterBits, UnbuiltWeightRegistersStoreNothing) {
  WiredRegisters without(small());
  for (const std::uint32_t offset : {reg::kWeightsAddress, reg::kWeightsData}) {
    without.bus.write(offset, 0xFFFFFFFF);
    EXPECT_EQ(without.control.value(offset), 0u) << offset;
  }
}

// ---- the tables of learned weights

TEST(WeightsRegisters, EntriesLoadInSequence) {
  EngineBench bench(deburr());
  EXPECT_EQ(bench.bus.read(reg::kWeightsAddress), 0u);
  EXPECT_EQ(bench.bus.read(reg::kWeightsSum), spec::morphological::kWeightsSum);
  const auto shipped = [](std::int8_t entry) {
    return std::uint32_t{static_cast<std::uint8_t>(entry)};
  };
  // A read keeps the address, a write increments it.
  bench.bus.write(reg::kWeightsAddress, 1023);
  EXPECT_EQ(bench.bus.read(reg::kWeightsData), shipped(spec::morphological::kWeightsOfCodes[1023]));
  EXPECT_EQ(bench.bus.read(reg::kWeightsAddress), 1023u);
  std::uint32_t sum = spec::morphological::kWeightsSum;
  sum += 1024 * (0x5Au - shipped(spec::morphological::kWeightsOfCodes[1023]));
  bench.bus.write(reg::kWeightsData, 0xFFFFFF5A);
  EXPECT_EQ(bench.bus.read(reg::kWeightsAddress), 1024u);
  EXPECT_EQ(bench.bus.read(reg::kWeightsSum), sum);
  sum += 1025 * (0xA5u - shipped(spec::morphological::kWeightsOfNear[0]));
  bench.bus.write(reg::kWeightsData, 0xA5);
  EXPECT_EQ(bench.bus.read(reg::kWeightsSum), sum);
  bench.bus.write(reg::kWeightsAddress, 1023);
  EXPECT_EQ(bench.bus.read(reg::kWeightsData), 0x5Au);
  // Addresses beyond the tables store nothing; the address wraps.
  bench.bus.write(reg::kWeightsAddress, 0xFFFFFFFF);
  EXPECT_EQ(bench.bus.read(reg::kWeightsAddress), 4095u);
  bench.bus.write(reg::kWeightsData, 77);
  EXPECT_EQ(bench.bus.read(reg::kWeightsAddress), 0u);
  bench.bus.write(reg::kWeightsAddress, 2304);
  bench.bus.write(reg::kWeightsData, 77);
  bench.bus.write(reg::kWeightsAddress, 2304);
  EXPECT_EQ(bench.bus.read(reg::kWeightsData), 0u);
  EXPECT_EQ(bench.bus.read(reg::kWeightsSum), sum);
  EXPECT_EQ(bench.bus.try_write(reg::kWeightsSum, 1), tlm::TLM_COMMAND_ERROR_RESPONSE);
}

// Loaded weights take effect to the pixel, and a reset keeps them.
TEST(WeightsRegisters, LoadedWeightsSurviveAReset) {
  EngineBench bench(deburr());
  const Frame frame = blocks();
  const Frame before = bench.run(frame);
  bench.software.load_weights(std::vector<std::int8_t>(2304, -128));
  const std::uint32_t sum = bench.bus.read(reg::kWeightsSum);
  EXPECT_EQ(sum, 0x80u * (2304u * 2305u / 2));
  // All weights are 0, so only runs that are extended are blended.
  const Frame after = bench.run(frame);
  EXPECT_NE(after.pixel, before.pixel);
  reset_by(bench.clock, 2);
  EXPECT_EQ(bench.bus.read(reg::kWeightsSum), sum);
  EXPECT_EQ(bench.bus.read(reg::kWeightsAddress), 0u);
  EXPECT_EQ(bench.bus.read(reg::kWeightsData), 0x80u);
}

TEST(WeightsRegisters, WeightWritesAreIgnoredDuringAFrame) {
  EngineBench bench(deburr());
  bench.bus.write(reg::kWeightsAddress, 7);
  const std::uint32_t entry = bench.bus.read(reg::kWeightsData);
  bench.send(noise(40, 30));
  bench.clock.run(100);
  ASSERT_FALSE(bench.engine.idle());
  bench.bus.write(reg::kWeightsData, entry ^ 1);
  bench.bus.write(reg::kWeightsAddress, 9);
  EXPECT_EQ(bench.bus.read(reg::kWeightsAddress), 7u);
  EXPECT_EQ(bench.bus.read(reg::kWeightsData), entry);
  EXPECT_EQ(bench.bus.read(reg::kWeightsSum), spec::morphological::kWeightsSum);
  EXPECT_TRUE(bench.bus.read(reg::kStatus) & reg::kStatusWrittenWhileBusy);
  // A debug write is accepted.
  bench.bus.debug_write(reg::kWeightsData, entry ^ 1);
  EXPECT_EQ(bench.bus.read(reg::kWeightsAddress), 8u);
  EXPECT_EQ(bench.bus.read(reg::kWeightsSum),
            spec::morphological::kWeightsSum + 8 * ((entry ^ 1) - entry));
}

// Each counter register shows its own counter: all values differ, so swapped counters are noticed.
TEST(CounterRegisters, EachCounterRegisterShowsItsCounter) {
  Parameters p = preset(Preset::kMlaaSlope);
  p.storage = spec::morphological::Storage::kMemory;
  p.line_pixels = 64;
  p.predictor_units = 1;
  p.divider_interval = 16;
  p.descriptor_fifo = 2;
  p.window_rows = 14;
  p.search_columns = 5;
  p.bypass = spec::morphological::Bypass::kMarked;
  EngineBench bench(p);
  bench.memory->fail_range(64 * 5, 64 * 8);
  Frame frame = noise(64, 44);
  for (std::size_t i = 0; i < frame.pixel.size(); i += 7) frame.pixel[i][3] = 0;
  bench.run(frame);
  const auto& e = bench.engine;
  const std::map<std::uint32_t, std::uint64_t> shown = {
      {reg::kPixels, e.blender.pixels.value()},
      {reg::kEdgePixels, e.edges.edge_pixels.value()},
      {reg::kHorizontalRuns, e.extractor.horizontal_runs.value()},
      {reg::kVerticalRuns, e.extractor.vertical_runs.value()},
      {reg::kLongRuns, e.extractor.long_runs.value()},
      {reg::kZRuns, e.extractor.z_runs.value()},
      {reg::kExtendedRuns,
       e.endpoint_predictor_h.extended_runs.value() + e.endpoint_predictor_v.extended_runs.value()},
      {reg::kSteps, e.endpoint_predictor_h.steps.value() + e.endpoint_predictor_v.steps.value()},
      {reg::kProbes, e.endpoint_predictor_h.probes.value() + e.endpoint_predictor_v.probes.value()},
      {reg::kDivides, e.line_unit_h.divides.value() + e.line_unit_v.divides.value()},
      {reg::kBlendedPixels, e.blender.blended_pixels.value()},
      {reg::kBypassedPixels, e.blender.bypassed_pixels.value()},
      {reg::kFrameCycles, e.sequencer.frame_cycles.value()},
      {reg::kDescriptorStalls, e.extractor.descriptor_stalls.value()},
      {reg::kMemoryErrors, e.pixel_store.memory_errors.value()}};
  std::map<std::uint64_t, std::uint32_t> met = {{0, 0}};
  for (const auto& [offset, value] : shown) {
    EXPECT_EQ(bench.bus.read(offset), value) << offset;
    const auto [first, fresh] = met.emplace(value, offset);
    EXPECT_TRUE(fresh) << offset << " shows the same as " << first->second << ": " << value;
  }
  const spec::morphological::Work work = e.work();
  for (const spec::morphological::WorkCount& each : spec::morphological::kWorkCounts)
    EXPECT_EQ(work.*each.count, bench.bus.read(each.offset)) << each.offset;
  // One number for two causes.
  EXPECT_GT(e.extractor.interlock_stalls.value(), 0u);
  EXPECT_GT(e.extractor.descriptor_stalls.value(), e.extractor.interlock_stalls.value());
  EXPECT_EQ(e.pixel_store.memory_errors.value(), 2u * 3u);
}

}  // namespace
}  // namespace deburr::tb::morphological_rtl::parameter_store_test
