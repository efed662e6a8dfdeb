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

// A ParameterStore with its bus, and a frame inside.
struct Registers {
  explicit Registers(const Parameters& p) : store(control, p), bus("bus"), software(bus, p) {
    bus.bus.bind(control.registers.bus);
  }
  Registers(const Parameters& p, int width, int height) : Registers(p) { frame(width, height); }
  void frame(int width, int height) {
    software.set_size(width, height);
    EXPECT_TRUE(store.latch());
  }
  // As the reset of the engine does.
  void reset() {
    control.reset();
    store.reset();
  }
  rtl::ControlRegisters control{"registers", spec::morphological::kRegisters,
                                rtl::morphological::control_layout()};
  rtl::morphological::ParameterStore store;
  platform::RegisterHost bus;
  platform::MorphologicalDriver software;
};

using unit_bench::clocks_of, unit_bench::Ends, unit_bench::of_a_stage_less, unit_bench::tokens_of;

// An engine small enough for single blocks: four rows of reach, no predictor.
inline constexpr int kReach = 4, kLag = kReach + spec::morphological::kRowLag;

inline Parameters small(int lanes_code = 0) {
  Parameters p = preset(spec::morphological::Preset::kMlaa, kReach, 8);
  p.lanes = static_cast<spec::morphological::Lanes>(lanes_code);
  p.line_pixels = 64;
  return p;
}

inline Parameters deburr_without_trim() {
  Parameters p = preset(spec::morphological::Preset::kDeburrLine);
  p.trim = false;
  return p;
}
inline constexpr std::uint32_t kTrimBit = 1u << 17;  // of RULES

inline rtl::morphological::RunToken run_of(int length, int start, std::uint32_t slot = 0) {
  rtl::morphological::RunToken token{};
  token.run = {
      spec::morphological::Axis::kHorizontal, spec::morphological::RunPart::kWhole, 12,
      static_cast<std::uint16_t>(start),      static_cast<std::uint16_t>(length),   1 + 4 * 2};
  token.slot = slot;
  return token;
}

}  // namespace deburr::tb::morphological_rtl
