// SPDX-License-Identifier: MIT
// The registers' side of the engine: START, what stands against a frame, its rules, and the sticky
// bits of STATUS.
//
// Where: beside the pipe, in front of the registers. A write counts from the next clock edge on:
// START is on `start` in the clock after its write. In that clock the FrameSequencer answers with
// `latch`, and gets `rejection`: the registers as they are then become the rules, which units read
// from the next clock on, or the frame is rejected, which has an effect on REJECTION and STATUS
// alone. A write while a frame is under way is ignored (CONTROL and STATUS excepted) and sets a
// sticky bit. Codes of CONFIG that no choice has count as code 0. A pulse of a sticky bit sets it
// in its clock. Nothing in here is ticked. Cost: the registers, and 60 bits of sizes. Made for 250
// MHz; longest path: 11 x 11 multiply (words of the TouchedMap).
#pragma once

#include <cstdint>
#include <optional>
#include <systemc>

#include "rtl_model/fabric/clock_domain.h"
#include "rtl_model/fabric/control_registers.h"
#include "rtl_model/fabric/wire.h"
#include "rtl_model/geometric/common/frame_configuration.h"
#include "spec/geometric/parameters.h"
#include "spec/geometric/registers.h"

namespace deburr::rtl::geometric {

// CONTROL and STATUS, for the engine's ControlRegisters.
ControlLayout control_layout();

// What the registers say of a frame.
FrameConfiguration decode(const ControlRegisters& registers);
// Why it is not drawn.
spec::geometric::Rejection rejection(const FrameConfiguration& configuration, bool enabled,
                                     const spec::geometric::Parameters& parameters);
inline PayloadShape rejection_shape() { return {.widths = {{"value", 4}}}; }

class ParameterStore final : public sc_core::sc_module {
 public:
  WireOut<FrameConfiguration> configuration_out{"configuration_out"};
  PulseOut start_out{"start_out"};
  OnPulse latch_in{"latch_in", [this](Cycle cycle) { latch(cycle); }};
  WireOut<spec::geometric::Rejection, WireKind::kCombinational> rejection_out{"rejection_out"};
  // Each sets its bit of STATUS.
  OnPulse frame_done_in, invalid_edge_in, memory_error_in;
  std::optional<OnPulse> invalid_pair_in;  // with records = split

  // Gives the registers the reset values that parameters set.
  ParameterStore(const sc_core::sc_module_name& name, ClockDomain& clock,
                 ControlRegisters& registers, const spec::geometric::Parameters& parameters);

  // START is written and not yet checked. Between edges.
  bool starting() const { return starting_; }

 private:
  void start();
  void latch(Cycle cycle);

  ClockDomain& clock_;
  ControlRegisters& registers_;
  const spec::geometric::Parameters parameters_;
  bool starting_ = false, start_enabled_ = false;  // the latter as START was written
  spec::geometric::Rejection rejection_{};
};

}  // namespace deburr::rtl::geometric
