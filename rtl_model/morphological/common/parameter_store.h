// SPDX-License-Identifier: MIT
// Register side of the engine: configuration of a frame, and the sticky bits of STATUS.
//
// Position  Next to the pipeline, connected to the registers. Never clocked.
// Timing    A write takes effect at the next clock edge. When the first beat of a frame waits
//           (`first_beat`), `enabled` says whether it may be taken. In the cycle that takes it
//           (`latch`) the registers become the configuration, which units read from the next cycle
//           on. `latched` shows it to the SlotSequencer in the same cycle, or that SIZE is out of
//           range; that sets only the framing bit.
// Writes    While a frame is inside, writes are ignored and set a sticky bit, except to CONTROL and
//           STATUS.
// Decoding  Undefined codes of CONFIG count as code 0. Steps are limited to window_rows / 2 - 2,
//           those of the SMAA searches to their ranges. Features that are not built read as off,
//           depth as 0, and the registers of learned weights (WeightsLoader) as 0.
// Reset     Every register takes its reset value. SIZE becomes 0 and must be written again.
// Cost      15 x 32 flip-flops.
// Path      Made for 300 MHz; longest: minimum of three 5-bit numbers.
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

// Layout of CONTROL and STATUS for the engine's ControlRegisters.
ControlLayout control_layout();

Decoded decode(const ControlRegisters& registers, const spec::morphological::Parameters& p);

class ParameterStore final : public sc_core::sc_module {
 public:
  WireOut<FrameConfiguration> configuration_out{"configuration_out"};
  OnPulse first_beat_in;
  WireOut<bool, WireKind::kCombinational> enabled_out{"enabled_out"};
  OnPulse latch_in{"latch_in", [this](Cycle cycle) { latch(cycle); }};
  WireOut<Decoded, WireKind::kCombinational> latched_out{"latched_out"};
  // Each pulse sets its bit of STATUS.
  OnPulse frame_done_in, framing_in;
  std::optional<OnPulse> memory_error_in;  // with storage = memory

  // Sets the registers' reset values from the parameters.
  ParameterStore(const sc_core::sc_module_name& name, ControlRegisters& registers,
                 const spec::morphological::Parameters& parameters);

 private:
  void latch(Cycle cycle);

  ControlRegisters& registers_;
  const spec::morphological::Parameters parameters_;
};

}  // namespace deburr::rtl::morphological
