// SPDX-License-Identifier: MIT
// Registers of the morphological engine: reset values, when a write counts, and what each field
// does: as much as the parameter of the same name, to the pixel. An engine that is told by its
// registers is compared with one that was built like that; and each counter register shows its
// counter.
#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "spec/morphological/learned_weights.h"
#include "tb/unit/rtl/morphological/parts.h"
#include "tb/unit/rtl/morphological/placed_engine.h"
#include "tb/unit/rtl/morphological/vectors.h"

namespace deburr::tb::morphological_rtl::parameter_store_test {
namespace {

using spec::morphological::Preset;
namespace reg = spec::morphological::reg;
using P = Parameters;

TEST(ParameterStoreBlock, TrimIsABitOfRulesLatchedWithTheFrame) {
  WiredRegisters on(preset(spec::morphological::Preset::kDeburrLine));
  const std::uint32_t reset_value = on.bus.read(reg::kConfiguration);
  EXPECT_EQ(reset_value,
            1u << 3 | 2u << 5 | 2u << 7 | 8u << 9 | 1u << 14 | 1u << 15 | 1u << 16 | kTrimBit);
  EXPECT_TRUE(on.frame(8, 8).trim);
  on.bus.write(reg::kConfiguration, reset_value & ~kTrimBit);
  EXPECT_EQ(on.bus.read(reg::kConfiguration), reset_value & ~kTrimBit);
  EXPECT_TRUE(on.units_see().trim) << "until the next frame begins";
  ASSERT_TRUE(on.latch());
  EXPECT_FALSE(on.units_see().trim);
  EXPECT_TRUE(on.units_see().safe);
  on.bus.write(reg::kConfiguration, ~0u);
  EXPECT_EQ(on.bus.read(reg::kConfiguration), 0x1FFFFFFFu) << "no bits beyond";
  on.control.reset();
  EXPECT_EQ(on.bus.read(reg::kConfiguration), reset_value);
}

TEST(ParameterStoreBlock, LetsFramesInWhileEnabled) {
  WiredRegisters registers(small());
  EXPECT_TRUE(registers.lets_frames_in());
  registers.bus.write(reg::kControl, 0);
  EXPECT_FALSE(registers.lets_frames_in());
  EXPECT_EQ(registers.units_see(), rtl::morphological::FrameConfiguration{})
      << "nothing is latched";
  registers.bus.write(reg::kControl, reg::kControlEnable);
  EXPECT_TRUE(registers.lets_frames_in());
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

TEST(ParameterStoreBlock, ResetValueOfTrimIsTheParameter) {
  WiredRegisters off(deburr_without_trim());
  EXPECT_EQ(off.bus.read(reg::kConfiguration) & kTrimBit, 0u);
  EXPECT_FALSE(off.frame(8, 8).trim);
}

// The register SMAA: its reset value, and values that no range has.
TEST(ParameterStoreBlock, SmaaIsLimitedToItsRangesAndToWhatIsBuilt) {
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
  // Each block is switched by its own bit.
  const std::uint32_t configuration = store.bus.read(reg::kConfiguration);
  for (int bit = 18; bit <= 22; ++bit) {
    store.bus.write(reg::kConfiguration, configuration & ~(1u << bit));
    store.bus.write(reg::kSmaa, 4u | 6u << 8);
    store.frame(8, 8);
    EXPECT_EQ(store.units_see().crossings, bit != 18);
    EXPECT_EQ(store.units_see().table, bit != 19);
    EXPECT_EQ(store.units_see().diagonal_steps, bit != 20 ? 6 : 0);
    EXPECT_EQ(store.units_see().corners, bit != 21);
    EXPECT_EQ(store.units_see().corner_loss, 256);
    EXPECT_EQ(store.units_see().strongest, bit != 22);
  }
}

TEST(ParameterStoreBlock, DiagonalStepsAreAtMostTheReach) {
  Parameters p = smaa();
  p.window_rows = 10;
  p.diagonal_steps = 4;
  WiredRegisters store(p);
  store.bus.write(reg::kSmaa, 4u | 31u << 8);
  store.frame(8, 8);
  EXPECT_EQ(store.units_see().diagonal_steps, 4);
}

TEST(ParameterStoreBlock, StepsAreAtMostWhatTheWindowAllows) {
  for (const int window_rows : {10, 12, 34, 66}) {
    Parameters p = preset(Preset::kDeburrLine);
    p.window_rows = window_rows;
    WiredRegisters store(p);
    store.bus.write(reg::kConfiguration, 1u << 7 | 31u << 9);
    store.frame(8, 8);
    EXPECT_EQ(store.units_see().steps, std::min(16, window_rows / 2 - 2)) << window_rows;
  }
}

// ---- what is decoded, bit by bit
// ------------------------------------------------------------------

// The fields of CONFIG that are not 0.
std::string text_of(const rtl::morphological::FrameConfiguration& f) {
  std::string text;
  const auto add = [&](const char* name, auto value) {
    if (const int number = static_cast<int>(value); number != 0)
      text += (text.empty() ? "" : ", ") + std::string(name) + ' ' + std::to_string(number);
  };
  add("source", f.source);
  add("dynamic", f.dynamic);
  add("dynamic_luma", f.dynamic_luma);
  add("local_contrast", f.local_contrast);
  add("predictor", f.predictor);
  add("steps", f.steps);
  add("contiguous", f.contiguous);
  add("safe", f.safe);
  add("linear_light", f.linear_light);
  add("trim", f.trim);
  add("crossings", f.crossings);
  add("table", f.table);
  add("clamp", f.clamp);
  add("diagonal_steps", f.diagonal_steps);
  add("corners", f.corners);
  add("strongest", f.strongest);
  add("bypass", f.bypass);
  add("text_guard", f.text_guard);
  add("learned", f.learned);
  return text;
}
using ConfigurationRow = std::pair<std::uint32_t, const char*>;
void expect_configuration(const Parameters& p, const std::vector<ConfigurationRow>& rows) {
  WiredRegisters registers(p);
  registers.bus.write(reg::kSmaa, 5u << 8);
  for (const auto& [value, fields] : rows) {
    registers.bus.write(reg::kConfiguration, value);
    registers.frame(8, 8);
    EXPECT_EQ(text_of(registers.units_see()), fields) << value;
  }
}

TEST(FrameConfiguration, EachBitOfRulesIsItsFields) {
  Parameters p = smaa();
  p.window_rows = 42;
  p.diagonal_steps = 8;
  p.contiguous = true;
  expect_configuration(p, {{0, ""},
                           {1, "source 1"},
                           {2, "source 2"},
                           {3, "source 3"},
                           {1u << 2, "dynamic 1"},
                           {1u << 3, "dynamic_luma 1"},
                           {2u << 3, "dynamic_luma 2"},
                           {3u << 3, "dynamic_luma 3"},
                           {1u << 5, "local_contrast 1"},
                           {2u << 5, "local_contrast 2"},
                           {3u << 5, "local_contrast 3"},
                           {1u << 7, "predictor 1"},
                           {2u << 7, "predictor 2"},
                           {3u << 7, ""},
                           {31u << 9, ""},
                           {1u << 7 | 1u << 9, "predictor 1, steps 1"},
                           {1u << 7 | 2u << 9, "predictor 1, steps 2"},
                           {1u << 7 | 4u << 9, "predictor 1, steps 4"},
                           {1u << 7 | 8u << 9, "predictor 1, steps 8"},
                           {2u << 7 | 16u << 9, "predictor 2, steps 16"},
                           {1u << 14, "contiguous 1"},
                           {1u << 15, "safe 1"},
                           {1u << 16, "linear_light 1"},
                           {1u << 17, "trim 1"},
                           {1u << 18, "crossings 1"},
                           {1u << 19, "table 1"},
                           {1u << 20, "diagonal_steps 5"},
                           {1u << 21, "corners 1"},
                           {1u << 22, "strongest 1"},
                           {1u << 23, ""},
                           {1u << 24, "bypass 1"},
                           {2u << 24, "bypass 2"},
                           {3u << 24, "bypass 3"},
                           {4u << 24, "bypass 4"},
                           {5u << 24, ""},
                           {6u << 24, ""},
                           {7u << 24, ""},
                           {1u << 27, ""},
                           {1u << 27 | 1u << 18, "crossings 1"},
                           {1u << 27 | 1u << 19, "table 1"},
                           {1u << 27 | 3u << 18, "crossings 1, table 1, clamp 1"},
                           {0xF0000000, ""}});
  p.border = spec::morphological::Border::kEnd;  // clamp is not built
  expect_configuration(p, {{1u << 27 | 3u << 18, "crossings 1, table 1"}});
  p.text_guard = true;
  expect_configuration(p, {{1u << 28, "text_guard 1"}, {0xE0000000, ""}});
}
// Bits of no field count nowhere, whatever holds the registers.
TEST(FrameConfiguration, OtherBitsAreNotLookedAt) {
  rtl::ControlRegisters raw("raw", spec::morphological::kRegisters,
                            rtl::morphological::control_layout());
  const auto decoded = [&] { return rtl::morphological::decode(raw, smaa()); };
  raw.write(reg::kConfiguration, 0xF0000000);
  EXPECT_EQ(text_of(decoded().configuration), "");
  raw.write(reg::kConfiguration, 0xF0000000 | 1u << 24);
  EXPECT_EQ(text_of(decoded().configuration), "bypass 1");
  raw.write(reg::kSize, 0xC000C000 | 40 | 30 << 16);
  EXPECT_EQ(decoded().configuration.width, 40);
  EXPECT_EQ(decoded().configuration.height, 30);
  raw.write(reg::kSmaa, 0xFE00E080);
  raw.write(reg::kConfiguration, 1u << 20);
  EXPECT_EQ(decoded().configuration.search_steps, 1);
  EXPECT_EQ(decoded().configuration.diagonal_steps, 0);
  EXPECT_EQ(decoded().configuration.corner_loss, 256);
}
TEST(FrameConfiguration, OfAnEngineWithLearnedShares) {
  // All but what ends at bit 16, learned and the highest bit of leave.
  expect_configuration(deburr(),
                       {{1u << 23, "learned 1"},
                        {0x7FE0000u & ~(1u << 23) & ~(1u << 26), "trim 1, strongest 1, bypass 3"},
                        {2u << 3, "dynamic_luma 2"},
                        {1u << 14, "contiguous 1"}});
}

TEST(FrameConfiguration, ThresholdsAreThoseOfTheirRegisters) {
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

TEST(FrameConfiguration, SizesInBeatsAndRows) {
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

// Out of them a frame is rejected, and says so; one that was inside before is not touched.
TEST(FrameConfiguration, LimitsOfASize) {
  Parameters p = small();
  p.line_pixels = 100;
  WiredRegisters r(p);
  const auto takes = [&](std::uint32_t width, std::uint32_t height) {
    r.bus.write(reg::kSize, width | height << 16);
    r.bus.write(reg::kStatus, ~0u);
    const rtl::morphological::FrameConfiguration before = r.units_see();
    const bool taken = r.latch();
    EXPECT_EQ((r.bus.read(reg::kStatus) & reg::kStatusFraming) == 0, taken);
    EXPECT_EQ(r.units_see().width, taken ? width : before.width);
    return taken;
  };
  EXPECT_TRUE(takes(1, 1));
  EXPECT_FALSE(takes(0, 1));
  EXPECT_FALSE(takes(1, 0));
  EXPECT_TRUE(takes(100, 8192));
  EXPECT_FALSE(takes(101, 8192));
  EXPECT_FALSE(takes(100, 8193));
}

// Bits that a register does not have stay 0 on this way as well.
TEST(DebugWrites, CountFromTheNextFrameWithTheBitsThatExist) {
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

// A rule that the engine was not built for counts as off.
TEST(ContiguousRegister, IsOffInAnEngineBuiltWithoutIt) {
  namespace reg = spec::morphological::reg;
  constexpr std::uint32_t kContiguous = 1u << 14;
  Parameters built = deburr_line();
  built.contiguous = false;
  EngineBench bench(built);
  const Frame without = bench.run(blocks());
  const std::uint64_t steps = bench.engine.work().steps;
  bench.bus.write(reg::kConfiguration, bench.bus.read(reg::kConfiguration) | kContiguous);
  EXPECT_EQ(hash(bench.run(blocks())), hash(without));
  EXPECT_EQ(bench.engine.work().steps, 2 * steps);
  EXPECT_NE(hash(without), vector_hash("blocks_deburr_line_default"))
      << "the rule would have changed the frame";
}

// ---- the register map ---------------------------------------------------------------------------

TEST(Registers, ResetValuesAreTheParameters) {
  Parameters p = deburr_line();
  p.alpha = 1234;
  EngineBench bench(p);
  EXPECT_EQ(bench.bus.read(reg::kId), reg::kIdValue);
  EXPECT_EQ(bench.bus.read(reg::kControl), reg::kControlEnable);
  // luma, fixed, max, symmetric, fit, 8 steps, contiguous, safe, linear light, trim
  EXPECT_EQ(bench.bus.read(reg::kConfiguration),
            1u << 3 | 2u << 5 | 2u << 7 | 8u << 9 | 1u << 14 | 1u << 15 | 1u << 16 | 1u << 17);
  EXPECT_EQ(bench.bus.read(reg::kThreshold), 501330u);
  EXPECT_EQ(bench.bus.read(reg::kAlpha), 1234u);
  EXPECT_EQ(bench.bus.read(reg::kFloor), 131072u);
  EXPECT_EQ(bench.bus.read(reg::kDepthThreshold), 3277u);
  EXPECT_EQ(bench.bus.read(reg::kSize), 0u);
  bench.bus.write(reg::kPixelBase, 0x12345);
  EXPECT_EQ(bench.bus.read(reg::kPixelBase), 0x12340u);
  bench.bus.write(reg::kSize, 0xFFFFFFFF);
  EXPECT_EQ(bench.bus.read(reg::kSize), 0x3FFF3FFFu);
  EXPECT_EQ(bench.bus.try_write(reg::kPixels, 1), tlm::TLM_COMMAND_ERROR_RESPONSE);
}

// Bit by bit from the contract's table.
TEST(Registers, ResetValuesOfSmaaAreThePresets) {
  constexpr std::uint32_t kLinear = 1u << 16, kCrossings = 1u << 18, kTable = 1u << 19,
                          kDiagonals = 1u << 20, kCorners = 1u << 21, kStrongest = 1u << 22,
                          kClamp = 1u << 27;
  using spec::morphological::Quality;
  struct Row {
    Preset preset;
    Quality quality;
    std::uint32_t configuration, threshold, smaa;
  };
  constexpr std::uint32_t kFixed = 1u << 3 | 3u << 5 | kLinear | kCrossings | kTable | kStrongest |
                                   kClamp,
                          kDynamic = 1u << 2 | 1u << 5 | kLinear | kCrossings | kTable |
                                     kStrongest | kClamp;
  struct Owner : sc_core::sc_module {
    Owner(const sc_core::sc_module_name& name, const Parameters& p) : sc_module(name), store(p) {}
    WiredRegisters store;
  };
  for (const Row& row :
       {Row{Preset::kSmaa, Quality::kLow, kFixed, 2506752, 4u | 8u << 8 | 64u << 16},
        Row{Preset::kSmaa, Quality::kMedium, kFixed, 1671168, 8u | 8u << 8 | 64u << 16},
        Row{Preset::kSmaa, Quality::kHigh, kFixed | kDiagonals | kCorners, 1671168,
            16u | 8u << 8 | 64u << 16},
        Row{Preset::kSmaa, Quality::kUltra, kFixed | kDiagonals | kCorners, 835584,
            32u | 16u << 8 | 64u << 16},
        Row{Preset::kSmaaDynamic, Quality::kHigh, kDynamic | kDiagonals | kCorners, 501330,
            16u | 8u << 8 | 64u << 16}}) {
    Owner owner("owner", smaa(row.quality, row.preset));
    EXPECT_EQ(owner.store.bus.read(reg::kConfiguration), row.configuration);
    EXPECT_EQ(owner.store.bus.read(reg::kThreshold), row.threshold);
    EXPECT_EQ(owner.store.bus.read(reg::kSmaa), row.smaa);
    owner.store.bus.write(reg::kSmaa, 0);
    owner.store.bus.write(reg::kConfiguration, 0);
    owner.store.control.reset();
    EXPECT_EQ(owner.store.bus.read(reg::kConfiguration), row.configuration);
    EXPECT_EQ(owner.store.bus.read(reg::kSmaa), row.smaa);
  }
}

TEST(Registers, DiagonalsAreCountedShownAndCleared) {
  EngineBench bench(smaa());
  bench.run(noise());
  EXPECT_EQ(bench.bus.read(reg::kDiagonals), 258u);  // of the contract's vector
  bench.run(noise());
  EXPECT_EQ(bench.bus.read(reg::kDiagonals), 2 * 258u);
  EXPECT_EQ(bench.bus.try_write(reg::kDiagonals, 1), tlm::TLM_COMMAND_ERROR_RESPONSE);
  EXPECT_EQ(bench.bus.read(reg::kDiagonals), 2 * 258u);
  // Switched off they are not looked for.
  bench.bus.write(reg::kConfiguration, bench.bus.read(reg::kConfiguration) & ~(1u << 20));
  bench.run(noise());
  EXPECT_EQ(bench.bus.read(reg::kDiagonals), 2 * 258u);
  bench.bus.write(reg::kControl, reg::kControlEnable | reg::kControlClearCounters);
  EXPECT_EQ(bench.bus.read(reg::kDiagonals), 0u);
}

TEST(Registers, DiagonalsReadZeroWhereNotBuilt) {
  EngineBench bench(deburr_line());
  bench.run(noise());
  EXPECT_EQ(bench.bus.read(reg::kDiagonals), 0u);
}

// The rules of a frame inside stand still.
TEST(Registers, SmaaCountsFromTheNextFrame) {
  EngineBench bench(smaa());
  bench.software.set_size(97, 61);
  bench.driver.send(beats_of(noise(), 1));
  bench.clock.run(500);
  const std::uint32_t before = bench.bus.read(reg::kSmaa);
  bench.bus.write(reg::kSmaa, 1);
  EXPECT_EQ(bench.bus.read(reg::kSmaa), before);
  EXPECT_EQ(bench.bus.read(reg::kStatus), reg::kStatusWrittenWhileBusy);
  bench.bench->run([&] { return bench.sink.received() == 97u * 61u && bench.engine.idle(); },
                   100'000);
  EXPECT_EQ(hash(bench.last(97, 61)), vector_hash("smaa_noise_high"));
  bench.wanted = bench.sink.received();
  bench.bus.write(reg::kSmaa, 1);
  EXPECT_NE(hash(bench.run(noise())), vector_hash("smaa_noise_high"));
}

TEST(Registers, RulesCountFromTheNextFrame) {
  EngineBench bench(deburr_line());
  EXPECT_EQ(hash(bench.run(blocks())), vector_hash("blocks_deburr_line_default"));
  // Without trim the same trials, but every step is kept.
  EXPECT_EQ(bench.bus.read(reg::kSteps), 660u);
  bench.bus.write(reg::kConfiguration, bench.bus.read(reg::kConfiguration) & ~(1u << 17));
  EXPECT_EQ(hash(bench.run(blocks())), vector_hash("blocks_not_trimmed"));
  EXPECT_EQ(bench.bus.read(reg::kSteps), 660u + 970u);
  EXPECT_EQ(bench.bus.read(reg::kProbes), 2u * 5382u);
  // mlaa: T = 0.1, no local contrast, no predictor.
  bench.bus.write(reg::kConfiguration, 1u << 16);
  bench.bus.write(reg::kThreshold, 1671270);
  EXPECT_EQ(hash(bench.run(line())), vector_hash("line_mlaa"));
  // mlaa-slope.
  bench.bus.write(reg::kConfiguration, 1u << 16 | 1u << 7 | 4u << 9);
  EXPECT_EQ(hash(bench.run(noise())), vector_hash("noise_slope"));
  // Codes that no choice has: luma, none.
  bench.bus.write(reg::kConfiguration, 1u << 16 | 3u | 3u << 7 | 31u << 9);
  EXPECT_EQ(hash(bench.run(line())), vector_hash("line_mlaa"));
}

TEST(Registers, WritesWhileAFrameIsInsideAreIgnoredAndSaidSo) {
  EngineBench bench(deburr_line());
  bench.software.set_size(200, 150);
  bench.driver.send(beats_of(line(), 1));
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
  bench.bench->run([&] { return bench.sink.received() == 30000 && bench.engine.idle(); }, 100'000);
  EXPECT_EQ(hash(bench.last(200, 150)), vector_hash("line_deburr_line"));
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
  EXPECT_EQ(bench.bus.read(reg::kFrameCycles), (61u + 37u) * 97u + kPipe);
  bench.run(noise());
  check(2);
  bench.bus.write(reg::kControl, reg::kControlEnable | reg::kControlClearCounters);
  EXPECT_EQ(bench.bus.read(reg::kControl), reg::kControlEnable);
  check(0);
  EXPECT_EQ(bench.engine.work(), spec::morphological::Work{});
}

TEST(Registers, ClearingEnableLetsTheFrameInsideFinish) {
  EngineBench bench(deburr_line());
  bench.software.set_size(97, 61);
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

// ---- fields -------------------------------------------------------------------------------------

// Engines beside each other, each with the frames of its own.
struct Engine : PlacedEngine {
  using PlacedEngine::PlacedEngine;
  // Pixels and taps of the frame.
  std::vector<spec::morphological::BlendedBeat> run(ClockDomain& clock, const Frame& frame) {
    software.set_size(frame.width, frame.height);
    bus.write(reg::kControl, reg::kControlEnable | reg::kControlClearCounters);
    const auto beats = beats_of(frame, lanes_of(engine.parameters()));
    const std::size_t before = sink.beats().size(), wanted = before + beats.size();
    driver.send(beats);
    EXPECT_TRUE(
        clock.run_until([&] { return sink.beats().size() == wanted && engine.idle(); }, 500'000));
    return {sink.beats().begin() + static_cast<std::ptrdiff_t>(before), sink.beats().end()};
  }
};

// Something for every rule: long stairs, steps of many heights side by side, bends, depth, marks.
Frame motley() {
  stimuli::Sequence s;
  const auto below = [&](int n) { return static_cast<int>(s.next() >> 8) % n; };
  Frame frame = draw(64, 44, [](int x, int y) { return grey(2 * x + 3 * y < 150 ? 90 : 160); });
  for (std::size_t i = 0; i < frame.depth.size(); ++i) frame.depth[i] = 4'000'000;
  for (int i = 0; i < 60; ++i) {
    const bool wide = below(2) != 0;
    const int x0 = below(64), y0 = below(44), slope = below(5);
    const int w = 1 + below(wide ? 20 : 4), h = 1 + below(wide ? 4 : 20), code = below(230);
    const auto depth = static_cast<std::uint32_t>(3'000'000 + below(20) * 100'000);
    for (int y = y0; y < std::min(44, y0 + h); ++y)
      for (int x = x0 + (wide ? 0 : (y - y0) / (slope + 1)); x < std::min(64, x0 + w); ++x) {
        frame.at(x, y) = {static_cast<std::uint8_t>(code), static_cast<std::uint8_t>(code / 2 + 20),
                          static_cast<std::uint8_t>(255 - code),
                          static_cast<std::uint8_t>(8 + code % 2)};
        frame.depth[static_cast<std::size_t>(y * 64 + x)] = depth;
      }
  }
  // Two long stairs of short steps, which every limit of steps can be seen on.
  for (int y = 0; y < 44; ++y)
    for (int x = 0; x < 64; ++x)
      if (const int above = 26 * y - 10 * x - 60; above >= 0 && above < 26 * 8)
        frame.at(x, y) = grey(250);
  return frame;
}

P plain() {
  P p;  // luma, fixed, no local contrast, chord of 4 steps, no further rule, linear light
  p.edge_source = spec::morphological::EdgeSource::kLuma;
  p.threshold_mode = spec::morphological::ThresholdMode::kFixed;
  p.dynamic_luma = spec::morphological::DynamicLuma::kCurrent;
  p.threshold = 765000;
  p.area = spec::morphological::AreaSource::kAnalytic;
  p.local_contrast = spec::morphological::LocalContrast::kOff;
  p.predictor = spec::morphological::Predictor::kChord;
  p.steps = 4;
  p.contiguous = p.safe = p.trim = false;
  p.window_rows = 2 * 20 + 2;
  p.search_columns = 60;
  p.line_pixels = 64;
  return p;
}

struct Field {
  const char* name;
  void (*from)(P&);  // what both engines are built with ..
  std::uint32_t offset;
  int low, high;  // .. the bits that one of them is told ..
  std::uint32_t value;
  void (*to)(P&);       // .. and what the other one is built with in addition
  bool changes = true;  // the pixels
};
void PrintTo(const Field& f, std::ostream* out) { *out << f.name; }

class RegisterField : public ::testing::TestWithParam<Field> {};

TEST_P(RegisterField, DoesWhatTheParameterDoes) {
  const Field field = GetParam();
  ClockDomain clock("clock", period());
  P from = plain();
  field.from(from);
  P to = from;
  field.to(to);
  Engine told("told", clock, from), built("built", clock, to);
  const Frame frame = motley();
  const auto before = told.run(clock, frame);
  const std::uint32_t mask = static_cast<std::uint32_t>(
      ((std::uint64_t{1} << (field.high - field.low + 1)) - 1) << field.low);
  const std::uint32_t old = told.bus.read(field.offset);
  EXPECT_EQ(told.bus.try_write(field.offset, (old & ~mask) | field.value << field.low),
            tlm::TLM_OK_RESPONSE);
  EXPECT_EQ(told.bus.read(field.offset), (old & ~mask) | field.value << field.low);
  const auto after = told.run(clock, frame);
  EXPECT_EQ(after, built.run(clock, frame));
  EXPECT_EQ(told.engine.work(), built.engine.work());
  EXPECT_EQ(after != before, field.changes) << "the frame shows nothing";
}

void as_it_is(P&) {}
void depth(P& p) { p.edge_source = spec::morphological::EdgeSource::kDepth; }
void predicated(P& p) { p.edge_source = spec::morphological::EdgeSource::kPredicated; }
void luma(P& p) { p.edge_source = spec::morphological::EdgeSource::kLuma; }
void colour(P& p) { p.edge_source = spec::morphological::EdgeSource::kColour; }
void learned(P& p) { p.area = spec::morphological::AreaSource::kLearned; }
void as_analytic(P& p) { p.area = spec::morphological::AreaSource::kAnalytic; }
void masked(P& p) { p.bypass = spec::morphological::Bypass::kMasked; }
void dynamic(P& p) {
  p.threshold_mode = spec::morphological::ThresholdMode::kDynamic;
  p.alpha = 2304000;
  p.floor = 229500;
}
void fit(P& p) { p.predictor = spec::morphological::Predictor::kFit; }
void marked(P& p) { p.bypass = spec::morphological::Bypass::kMarked; }
void beside(P& p) { p.bypass = spec::morphological::Bypass::kBeside; }
void half(P& p) { p.bypass = spec::morphological::Bypass::kHalf; }
void as_before(P& p) { p.bypass = spec::morphological::Bypass::kNone; }
template <int kSteps>
void steps(P& p) {
  p.steps = kSteps;
}
void narrow(P& p) {  // R = 6
  p.window_rows = 14;
  p.steps = 1;
}
void highest(P& p) {  // R = 17: R - 1 is the largest N
  p.window_rows = 36;
}

INSTANTIATE_TEST_SUITE_P(
    Configuration, RegisterField,
    ::testing::Values(
        Field{"source_luma", depth, reg::kConfiguration, 0, 1, 0, luma},
        Field{"source_depth", predicated, reg::kConfiguration, 0, 1, 1, depth},
        Field{"source_predicated", depth, reg::kConfiguration, 0, 1, 2, predicated},
        Field{"source_colour", depth, reg::kConfiguration, 0, 1, 3, colour},
        Field{"source_colour_where_no_depth_is", as_it_is, reg::kConfiguration, 0, 1, 3, colour},
        Field{"dynamic_does_not_go_with_colour", colour, reg::kConfiguration, 2, 2, 1, as_it_is,
              false},
        Field{"area_from_lines", learned, reg::kConfiguration, 23, 23, 0, as_analytic},
        Field{"learned_is_off_where_not_built", as_it_is, reg::kConfiguration, 23, 23, 1, as_it_is,
              false},
        Field{"tables_are_off_beside_learned", learned, reg::kConfiguration, 19, 21, 7, as_it_is,
              false},
        Field{"bypass_masked", as_it_is, reg::kConfiguration, 24, 26, 4, masked},
        Field{"bypass_5_is_none", marked, reg::kConfiguration, 24, 26, 5, as_before},
        Field{"bypass_7_is_none", half, reg::kConfiguration, 24, 26, 7, as_before},
        Field{"mode_dynamic", as_it_is, reg::kConfiguration, 2, 2, 1,
              [](P& p) { p.threshold_mode = spec::morphological::ThresholdMode::kDynamic; }},
        Field{"mode_fixed", dynamic, reg::kConfiguration, 2, 2, 0,
              [](P& p) { p.threshold_mode = spec::morphological::ThresholdMode::kFixed; }},
        Field{"dynamic_does_not_go_with_predicated", predicated, reg::kConfiguration, 2, 2, 1,
              as_it_is, false},
        Field{"dynamic_does_not_go_with_depth", depth, reg::kConfiguration, 2, 2, 1, as_it_is,
              false},
        Field{"dynamic_luma_max", dynamic, reg::kConfiguration, 3, 4, 1,
              [](P& p) { p.dynamic_luma = spec::morphological::DynamicLuma::kMax; }},
        Field{"dynamic_luma_min", dynamic, reg::kConfiguration, 3, 4, 2,
              [](P& p) { p.dynamic_luma = spec::morphological::DynamicLuma::kMin; }},
        Field{"dynamic_luma_mean",
              [](P& p) {
                dynamic(p);
                p.dynamic_luma = spec::morphological::DynamicLuma::kMax;
              },
              reg::kConfiguration, 3, 4, 3,
              [](P& p) { p.dynamic_luma = spec::morphological::DynamicLuma::kMean; }},
        Field{"blend_strongest", as_it_is, reg::kConfiguration, 22, 22, 1,
              [](P& p) { p.blend = spec::morphological::BlendRule::kStrongest; }},
        Field{"bypass_marked", as_it_is, reg::kConfiguration, 24, 26, 1, marked},
        Field{"bypass_beside", as_it_is, reg::kConfiguration, 24, 26, 2, beside},
        Field{"bypass_none", beside, reg::kConfiguration, 24, 26, 0, as_before},
        Field{"bypass_half", as_it_is, reg::kConfiguration, 24, 26, 3, half},
        Field{"crossings_are_off_where_not_built", as_it_is, reg::kConfiguration, 18, 18, 1,
              as_it_is, false},
        Field{"tables_are_off_where_not_built", as_it_is, reg::kConfiguration, 19, 19, 1, as_it_is,
              false},
        Field{"diagonals_are_off_where_not_built", as_it_is, reg::kConfiguration, 20, 20, 1,
              as_it_is, false},
        Field{"corners_are_off_where_not_built", as_it_is, reg::kConfiguration, 21, 21, 1, as_it_is,
              false},
        Field{"local_contrast_paper", as_it_is, reg::kConfiguration, 5, 6, 1,
              [](P& p) { p.local_contrast = spec::morphological::LocalContrast::kPaper; }},
        Field{"local_contrast_symmetric", as_it_is, reg::kConfiguration, 5, 6, 2,
              [](P& p) { p.local_contrast = spec::morphological::LocalContrast::kSymmetric; }},
        Field{"local_contrast_smaa", as_it_is, reg::kConfiguration, 5, 6, 3,
              [](P& p) { p.local_contrast = spec::morphological::LocalContrast::kSmaa; }},
        Field{"local_contrast_does_not_go_with_depth", depth, reg::kConfiguration, 5, 6, 2,
              as_it_is, false},
        Field{"predictor_none", as_it_is, reg::kConfiguration, 7, 8, 0,
              [](P& p) { p.predictor = spec::morphological::Predictor::kNone; }},
        Field{"predictor_chord", fit, reg::kConfiguration, 7, 8, 1,
              [](P& p) { p.predictor = spec::morphological::Predictor::kChord; }},
        Field{"predictor_fit", as_it_is, reg::kConfiguration, 7, 8, 2, fit},
        Field{"predictor_3_is_none", as_it_is, reg::kConfiguration, 7, 8, 3,
              [](P& p) { p.predictor = spec::morphological::Predictor::kNone; }},
        Field{"steps_0", as_it_is, reg::kConfiguration, 9, 13, 0, steps<0>},
        Field{"steps_1", fit, reg::kConfiguration, 9, 13, 1, steps<1>},
        Field{"steps_16", as_it_is, reg::kConfiguration, 9, 13, 16, steps<16>},
        Field{"steps_31_are_16", as_it_is, reg::kConfiguration, 9, 13, 31, steps<16>},
        Field{"steps_17_are_16", as_it_is, reg::kConfiguration, 9, 13, 17, steps<16>},
        Field{"steps_16_at_the_limit", highest, reg::kConfiguration, 9, 13, 31, steps<16>},
        Field{"steps_6_are_R_less_1", narrow, reg::kConfiguration, 9, 13, 6, steps<5>},
        Field{"steps_31_are_R_less_1", narrow, reg::kConfiguration, 9, 13, 31, steps<5>},
        Field{"contiguous_off", [](P& p) { p.contiguous = true; }, reg::kConfiguration, 14, 14, 0,
              [](P& p) { p.contiguous = false; }},
        Field{"safe", fit, reg::kConfiguration, 15, 15, 1, [](P& p) { p.safe = true; }},
        Field{"linear_light", as_it_is, reg::kConfiguration, 16, 16, 0,
              [](P& p) { p.linear_light = false; }},
        Field{"trim", fit, reg::kConfiguration, 17, 17, 1, [](P& p) { p.trim = true; }}),
    [](const auto& field) { return field.param.name; });

// All of SMAA's blocks, each of which a bit of CONFIG switches off and a field of SMAA moves.
void with_smaa(P& p) {
  p.ends = spec::morphological::Ends::kCrossings;
  p.area = spec::morphological::AreaSource::kTableMerged;
  p.search_steps = 4;
  p.diagonals = true;
  p.diagonal_steps = 8;
  p.round_corners = true;
  p.corner_rounding = 64;
  p.blend = spec::morphological::BlendRule::kStrongest;
  p.predictor = spec::morphological::Predictor::kNone;
  p.steps = 0;
}
template <int kSteps>
void search_steps(P& p) {
  p.search_steps = kSteps;
}
template <int kSteps>
void diagonal_steps(P& p) {
  p.diagonal_steps = kSteps;
}
template <int kWeight>
void corner_rounding(P& p) {
  p.corner_rounding = kWeight;
}
void clamped(P& p) {
  with_smaa(p);
  p.border = spec::morphological::Border::kClamp;
}
void not_clamped(P& p) { p.border = spec::morphological::Border::kEnd; }
void no_diagonals(P& p) { p.diagonals = false; }
void no_corners(P& p) { p.round_corners = false; }

INSTANTIATE_TEST_SUITE_P(
    Smaa, RegisterField,
    ::testing::Values(
        Field{"ends_gaps", with_smaa, reg::kConfiguration, 18, 18, 0,
              [](P& p) { p.ends = spec::morphological::Ends::kGaps; }},
        Field{"area_analytic", with_smaa, reg::kConfiguration, 19, 19, 0,
              [](P& p) { p.area = spec::morphological::AreaSource::kAnalytic; }},
        Field{"border_end", clamped, reg::kConfiguration, 27, 27, 0, not_clamped},
        Field{"border_is_end_with_gaps", clamped, reg::kConfiguration, 18, 18, 0,
              [](P& p) {
                not_clamped(p);
                p.ends = spec::morphological::Ends::kGaps;
              }},
        Field{"border_is_end_without_a_table", clamped, reg::kConfiguration, 19, 19, 0,
              [](P& p) {
                not_clamped(p);
                p.area = spec::morphological::AreaSource::kAnalytic;
              }},
        Field{"clamp_is_off_where_not_built", with_smaa, reg::kConfiguration, 27, 27, 1, as_it_is,
              false},
        Field{"clamp_does_not_go_with_gaps", as_it_is, reg::kConfiguration, 27, 27, 1, as_it_is,
              false},
        Field{"diagonals_off", with_smaa, reg::kConfiguration, 20, 20, 0, no_diagonals},
        Field{"corners_off", with_smaa, reg::kConfiguration, 21, 21, 0, no_corners},
        Field{"blend_longest", with_smaa, reg::kConfiguration, 22, 22, 0,
              [](P& p) { p.blend = spec::morphological::BlendRule::kLongest; }},
        Field{"dynamic_luma_current",
              [](P& p) {
                dynamic(p);
                p.dynamic_luma = spec::morphological::DynamicLuma::kMin;
              },
              reg::kConfiguration, 3, 4, 0,
              [](P& p) { p.dynamic_luma = spec::morphological::DynamicLuma::kCurrent; }},
        Field{"search_steps_1", with_smaa, reg::kSmaa, 0, 6, 1, search_steps<1>},
        Field{"search_steps_5", with_smaa, reg::kSmaa, 0, 6, 5, search_steps<5>},
        Field{"search_steps_112", with_smaa, reg::kSmaa, 0, 6, 112, search_steps<112>},
        Field{"search_steps_0_is_1", with_smaa, reg::kSmaa, 0, 6, 0, search_steps<1>},
        Field{"search_steps_113_is_112", with_smaa, reg::kSmaa, 0, 6, 113, search_steps<112>},
        Field{"search_steps_127_is_112", with_smaa, reg::kSmaa, 0, 6, 127, search_steps<112>},
        Field{"search_steps_count_for_tables_alone", as_it_is, reg::kSmaa, 0, 6, 1, as_it_is,
              false},
        Field{"diagonal_steps_2", with_smaa, reg::kSmaa, 8, 12, 2, diagonal_steps<2>},
        Field{"diagonal_steps_1", with_smaa, reg::kSmaa, 8, 12, 1, diagonal_steps<1>},
        Field{"diagonal_steps_0_are_none", with_smaa, reg::kSmaa, 8, 12, 0, no_diagonals},
        Field{"diagonal_steps_9_are_as_many_as_built", with_smaa, reg::kSmaa, 8, 12, 9, as_it_is,
              false},
        Field{"diagonal_steps_31_are_as_many_as_built", with_smaa, reg::kSmaa, 8, 12, 31, as_it_is,
              false},
        Field{"corner_rounding_0", with_smaa, reg::kSmaa, 16, 24, 0, corner_rounding<0>},
        Field{"corner_rounding_1", with_smaa, reg::kSmaa, 16, 24, 1, corner_rounding<1>},
        Field{"corner_rounding_255", with_smaa, reg::kSmaa, 16, 24, 255, corner_rounding<255>},
        Field{"corner_rounding_256_is_none", with_smaa, reg::kSmaa, 16, 24, 256, no_corners},
        Field{"corner_rounding_257_is_256", with_smaa, reg::kSmaa, 16, 24, 257,
              corner_rounding<256>},
        Field{"corner_rounding_511_is_256", with_smaa, reg::kSmaa, 16, 24, 511,
              corner_rounding<256>}),
    [](const auto& field) { return field.param.name; });

INSTANTIATE_TEST_SUITE_P(
    Thresholds, RegisterField,
    ::testing::Values(
        Field{"threshold", as_it_is, reg::kThreshold, 0, 23, 5100000,
              [](P& p) { p.threshold = 5100000; }},
        Field{"threshold_on", predicated, reg::kThresholdOn, 0, 23, 5100000,
              [](P& p) { p.threshold_on_depth_edge = 5100000; }},
        Field{"threshold_off", predicated, reg::kThresholdOff, 0, 23, 5100000,
              [](P& p) { p.threshold_off_depth_edge = 5100000; }},
        Field{"threshold_on_counts_for_predicated_alone", as_it_is, reg::kThresholdOn, 0, 23,
              15300000, as_it_is, false},
        Field{"threshold_off_counts_for_predicated_alone", as_it_is, reg::kThresholdOff, 0, 23,
              15300000, as_it_is, false},
        Field{"threshold_does_not_count_for_predicated", predicated, reg::kThreshold, 0, 23,
              15300000, as_it_is, false},
        Field{"alpha", dynamic, reg::kAlpha, 0, 23, 7680000, [](P& p) { p.alpha = 7680000; }},
        Field{"floor", dynamic, reg::kFloor, 0, 23, 2295000, [](P& p) { p.floor = 2295000; }},
        Field{"depth_threshold", depth, reg::kDepthThreshold, 0, 15, 12000,
              [](P& p) { p.depth_threshold = 12000; }}),
    [](const auto& field) { return field.param.name; });

TEST(RegisterBits, ThatDoNotExistReadAsZero) {
  EngineBench bench(plain());
  const std::map<std::uint32_t, std::uint32_t> bits = {
      {reg::kSize, 0x3FFF3FFF},       {reg::kConfiguration, 0x1FFFFFFF},
      {reg::kThreshold, 0xFFFFFF},    {reg::kThresholdOn, 0xFFFFFF},
      {reg::kThresholdOff, 0xFFFFFF}, {reg::kAlpha, 0xFFFFFF},
      {reg::kFloor, 0xFFFFFF},        {reg::kDepthThreshold, 0xFFFF},
      {reg::kPixelBase, 0xFFFFFFC0},  {reg::kSmaa, 0x01FF1F7F},
      {reg::kWeightsAddress, 0},      {reg::kWeightsData, 0}};
  for (const auto& [offset, mask] : bits) {
    bench.bus.write(offset, 0xFFFFFFFF);
    EXPECT_EQ(bench.bus.read(offset), mask) << offset;
    bench.bus.write(offset, 0);
    EXPECT_EQ(bench.bus.read(offset), 0u) << offset;
  }
}

// What always reads as 0 is not kept either.
TEST(RegisterBits, OfLearnedSharesAreNotBuiltWithoutThem) {
  WiredRegisters without(plain());
  for (const std::uint32_t offset : {reg::kWeightsAddress, reg::kWeightsData}) {
    without.bus.write(offset, 0xFFFFFFFF);
    EXPECT_EQ(without.control.value(offset), 0u) << offset;
  }
}

// ---- the tables of learned weights
// ---------------------------------------------------------------

TEST(WeightsRegisters, LoadAnEntryAfterTheOther) {
  EngineBench bench(deburr());
  EXPECT_EQ(bench.bus.read(reg::kWeightsAddress), 0u);
  EXPECT_EQ(bench.bus.read(reg::kWeightsSum), spec::morphological::kWeightsSum);
  const auto shipped = [](std::int8_t entry) {
    return std::uint32_t{static_cast<std::uint8_t>(entry)};
  };
  EXPECT_EQ(bench.bus.read(reg::kWeightsData), shipped(spec::morphological::kWeightsOfCodes[0]));
  for (const auto& [address, entry] : {std::pair{1023u, spec::morphological::kWeightsOfCodes[1023]},
                                       {1024u, spec::morphological::kWeightsOfNear[0]},
                                       {1664u, spec::morphological::kWeightsOfFar[0]},
                                       {2303u, spec::morphological::kWeightsOfFar[639]}}) {
    bench.bus.write(reg::kWeightsAddress, address);
    EXPECT_EQ(bench.bus.read(reg::kWeightsData), shipped(entry)) << address;
  }
  // A read moves nothing, a write moves on.
  EXPECT_EQ(bench.bus.read(reg::kWeightsAddress), 2303u);
  bench.bus.write(reg::kWeightsAddress, 1023);
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
  // Beyond the tables nothing is kept; the address goes round.
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

// What is loaded counts, to the pixel, and a reset leaves it as it is.
TEST(WeightsRegisters, CountFromTheNextFrameAndStayInAReset) {
  EngineBench bench(deburr());
  const Frame frame = blocks();
  const Frame before = bench.run(frame);
  bench.software.load_weights(std::vector<std::int8_t>(2304, -128));
  const std::uint32_t sum = bench.bus.read(reg::kWeightsSum);
  EXPECT_EQ(sum, 0x80u * (2304u * 2305u / 2));
  // All weights 0: only runs that extend are blended.
  const Frame after = bench.run(frame);
  EXPECT_NE(after.pixel, before.pixel);
  bench.clock.set_reset_n(false);
  bench.clock.run(2);
  bench.clock.set_reset_n(true);
  EXPECT_EQ(bench.bus.read(reg::kWeightsSum), sum);
  EXPECT_EQ(bench.bus.read(reg::kWeightsAddress), 0u);
  EXPECT_EQ(bench.bus.read(reg::kWeightsData), 0x80u);
}

TEST(WeightsRegisters, AreIgnoredWhileAFrameIsInside) {
  EngineBench bench(deburr());
  bench.bus.write(reg::kWeightsAddress, 7);
  const std::uint32_t entry = bench.bus.read(reg::kWeightsData);
  const Frame frame = noise(40, 30);
  bench.software.set_size(frame.width, frame.height);
  bench.driver.send(beats_of(frame, 1));
  bench.clock.run(100);
  ASSERT_FALSE(bench.engine.idle());
  bench.bus.write(reg::kWeightsData, entry ^ 1);
  bench.bus.write(reg::kWeightsAddress, 9);
  EXPECT_EQ(bench.bus.read(reg::kWeightsAddress), 7u);
  EXPECT_EQ(bench.bus.read(reg::kWeightsData), entry);
  EXPECT_EQ(bench.bus.read(reg::kWeightsSum), spec::morphological::kWeightsSum);
  EXPECT_TRUE(bench.bus.read(reg::kStatus) & reg::kStatusWrittenWhileBusy);
  // A debug write is not rejected.
  bench.bus.debug_write(reg::kWeightsData, entry ^ 1);
  EXPECT_EQ(bench.bus.read(reg::kWeightsAddress), 8u);
  EXPECT_EQ(bench.bus.read(reg::kWeightsSum),
            spec::morphological::kWeightsSum + 8 * ((entry ^ 1) - entry));
}

// A beat's depth has 24 bits; what lies above them is not looked at.
TEST(Depth, Has24Bits) {
  P p = plain();
  p.edge_source = spec::morphological::EdgeSource::kDepth;
  EngineBench bench(p);
  Frame frame = motley();
  const Frame expected = bench.run(frame);
  const spec::morphological::Work work = bench.engine.work();
  ASSERT_GT(work.blended_pixels, 100u);
  stimuli::Sequence s;
  for (std::uint32_t& d : frame.depth) d |= s.next() & 0xFF000000;
  EXPECT_EQ(bench.run(frame).pixel, expected.pixel);
  EXPECT_EQ(bench.engine.work().edge_pixels, 2 * work.edge_pixels);
  EXPECT_EQ(bench.engine.work().blended_pixels, 2 * work.blended_pixels);
}

// Each counter register shows a count of its own: all differ, so that none can stand for another.
TEST(CounterRegisters, ShowTheirCounters) {
  P p = plain();
  p.storage = spec::morphological::Storage::kMemory;
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
  // Two causes in one number.
  EXPECT_GT(e.extractor.interlock_stalls.value(), 0u);
  EXPECT_GT(e.extractor.descriptor_stalls.value(), e.extractor.interlock_stalls.value());
  EXPECT_EQ(e.pixel_store.memory_errors.value(), 2u * 3u);
}

}  // namespace
}  // namespace deburr::tb::morphological_rtl::parameter_store_test
