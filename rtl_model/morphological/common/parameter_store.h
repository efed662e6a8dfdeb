// SPDX-License-Identifier: MIT
// The registers' side of the engine: the rules of a frame, and the sticky bits of STATUS.
//
// Where: beside the pipe, in front of the registers. Timing: a write counts from the next clock
// edge on. When the first beat of a frame waits (`first_beat`), `enabled` tells whether it may be
// taken. In the clock that takes it (`latch`) the registers become the rules, which units read from
// the next clock on; `latched` shows them to the SlotSequencer at once, or that SIZE is out of
// range, which sets the framing bit and nothing else. A write while a frame is inside is ignored
// (CONTROL and STATUS excepted) and sets a sticky bit. A pulse of a sticky bit sets it in its
// clock. Codes of CONFIG that no choice has count as code 0; steps are limited to
// window_rows / 2 - 2, those of SMAA's searches to their ranges; what was not built (depth lines
// with source = luma) reads as 0, and `contiguous`, crossings, clamp, tables, diagonals, corners
// and the text guard count as off in an engine that was built without them, and so do learned
// weights, whose registers read 0 then (else: WeightsLoader). A reset gives every register its
// reset value; SIZE is 0 then and must be written again. Nothing in here is ticked. Cost: 15 x 32
// flip-flops. Made for 300 MHz; longest path: the least of three 5-bit numbers.
#pragma once

#include <cstdint>
#include <optional>
#include <systemc>

#include "rtl_model/fabric/control_registers.h"
#include "rtl_model/fabric/wire.h"
#include "rtl_model/morphological/common/frame_configuration.h"
#include "spec/morphological/parameters.h"
#include "spec/morphological/registers.h"

namespace deburr::rtl::morphological {

// CONTROL and STATUS, for the engine's ControlRegisters.
ControlLayout control_layout();

Decoded decode(const ControlRegisters& registers, const spec::morphological::Parameters& p);

class ParameterStore final : public sc_core::sc_module {
 public:
  WireOut<FrameConfiguration> configuration_out{"configuration_out"};
  OnPulse first_beat_in;
  WireOut<bool, WireKind::kCombinational> enabled_out{"enabled_out"};
  OnPulse latch_in{"latch_in", [this](Cycle cycle) { latch(cycle); }};
  WireOut<Decoded, WireKind::kCombinational> latched_out{"latched_out"};
  // Each sets its bit of STATUS.
  OnPulse frame_done_in, framing_in;
  std::optional<OnPulse> memory_error_in;  // with storage = memory

  // Gives the registers the reset values that parameters set.
  ParameterStore(const sc_core::sc_module_name& name, ControlRegisters& registers,
                 const spec::morphological::Parameters& parameters);

 private:
  void latch(Cycle cycle);

  ControlRegisters& registers_;
  const spec::morphological::Parameters parameters_;
};

}  // namespace deburr::rtl::morphological
