// SPDX-License-Identifier: MIT
// For tests of single blocks of the morphological engine: the registers that they read, and small
// engines.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tb/unit/rtl/morphological/support.h"

namespace deburr::tb::morphological_rtl {

// Registers with the reset values of a build, and their bus.
struct RegisterFile {
  explicit RegisterFile(const Parameters& p) : bus("bus"), software(bus, p), parameters(p) {
    bus.bus.bind(control.registers.bus);
    control.set_resets(spec::morphological::loaded_registers(p));
  }
  rtl::ControlRegisters control{"registers", spec::morphological::kRegisters,
                                rtl::morphological::control_layout()};
  platform::RegisterHost bus;
  platform::MorphologicalDriver software;
  const Parameters parameters;
};

// For units without a SlotSequencer: the test starts each frame.
struct Registers : RegisterFile {
  explicit Registers(const Parameters& p) : RegisterFile(p) {}
  Registers(const Parameters& p, int width, int height) : Registers(p) { frame(width, height); }
  // Units see the configuration in the next cycle.
  void frame(int width, int height, Cycle cycle = 0) {
    software.set_size(width, height);
    const rtl::morphological::Decoded decoded = rtl::morphological::decode(control, parameters);
    EXPECT_TRUE(decoded.valid);
    configuration.drive(cycle, decoded.configuration);
  }
  rtl::Wire<rtl::morphological::FrameConfiguration> configuration{
      "configuration", rtl::morphological::FrameConfiguration{}};
};

// With a ParameterStore, for a SlotSequencer. Without a sequencer, each call advances the time by
// one cycle.
struct WiredRegisters : RegisterFile {
  explicit WiredRegisters(const Parameters& p)
      : RegisterFile(p), store("parameter_store", control, p) {
    store.configuration_out(configuration);
    store.first_beat_in(first_beat);
    store.enabled_out(enabled);
    store.latch_in(latch_pulse);
    store.latched_out(latched);
    store.frame_done_in(frame_done);
    store.framing_in(framing);
  }
  void join(rtl::morphological::SlotSequencer& sequencer) {
    sequencer.configuration_in(configuration);
    sequencer.first_beat_out(first_beat);
    sequencer.enabled_in(enabled);
    sequencer.latch_out(latch_pulse);
    sequencer.latched_in(latched);
    sequencer.frame_done_out(frame_done);
    sequencer.framing_out(framing);
    control.on_busy([&] { return !sequencer.idle(); });
  }
  bool accepts_frames() {
    first_beat.raise(++now_);
    return enabled.read(now_);
  }
  // False if the engine rejects the size.
  bool latch() {
    latch_pulse.raise(++now_);
    return latched.read(now_).valid;
  }
  const rtl::morphological::FrameConfiguration& frame(int width, int height) {
    software.set_size(width, height);
    EXPECT_TRUE(latch());
    EXPECT_EQ(latched.read(now_).configuration, seen_by_units());
    return seen_by_units();
  }
  // The configuration in the cycle after the last call.
  const rtl::morphological::FrameConfiguration& seen_by_units() const {
    return configuration.read(now_ + 1);
  }

  rtl::morphological::ParameterStore store;
  rtl::Wire<rtl::morphological::FrameConfiguration> configuration{
      "configuration", rtl::morphological::FrameConfiguration{}};
  rtl::Pulse first_beat{"first_beat"}, latch_pulse{"latch"}, frame_done{"frame_done"},
      framing{"framing"};
  rtl::CombinationalWire<bool> enabled{"enabled"};
  rtl::CombinationalWire<rtl::morphological::Decoded> latched{"latched"};

 private:
  Cycle now_ = 0;
};

using unit_bench::cycles_of, unit_bench::Ends, unit_bench::read_one_cycle_early,
    unit_bench::tokens_of;

// Runs the unit one stage early from now on; this memory must report that a word is used too early.
inline void expect_used_early(rtl::Unit& unit, ClockDomain& clock, const char* memory) {
  EXPECT_THAT(read_one_cycle_early(unit, clock),
              ::testing::AllOf(::testing::HasSubstr(memory), ::testing::HasSubstr("is used")));
}

// An engine small enough for single blocks: a search range of four rows, no predictor.
inline constexpr int kReach = 4, kLag = kReach + spec::morphological::kRowLag;

inline Parameters small(int lanes_code = 0) {
  Parameters p = preset(spec::morphological::Preset::kMlaa, kReach, 8);
  p.lanes = static_cast<spec::morphological::Lanes>(lanes_code);
  p.line_pixels = 64;
  return p;
}

inline rtl::morphological::RunToken run_of(int length, int start, std::uint32_t slot = 0) {
  rtl::morphological::RunToken token{};
  token.run = {
      spec::morphological::Axis::kHorizontal, spec::morphological::RunPart::kWhole, 12,
      static_cast<std::uint16_t>(start),      static_cast<std::uint16_t>(length),   1 + 4 * 2};
  token.slot = slot;
  return token;
}

}  // namespace deburr::tb::morphological_rtl
