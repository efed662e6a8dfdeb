// SPDX-License-Identifier: MIT
// Function  Register side of the engine: START, the check of a frame, its configuration, and the
//           sticky bits of STATUS.
// Position  Between the registers and the pipeline.
// Latency   A write takes effect at the next clock edge: `start` is high in the cycle after the
//           write of START. In that cycle the FrameSequencer drives `latch` and reads `rejection`.
//           The current register values become the configuration, which units read from the next
//           cycle on; or the frame is rejected, which only changes REJECTION and STATUS. A pulse of
//           a sticky bit sets it in its cycle.
// Cost      In the datasheet of the FrameSequencer.
//
// A write during a frame is ignored (except to CONTROL and STATUS) and sets a sticky bit. Unknown
// codes of CONFIG count as code 0. This module is not ticked.
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

// Layout of CONTROL and STATUS for the engine's ControlRegisters.
ControlLayout control_layout();

// Decodes the frame configuration from the registers.
FrameConfiguration decode(const ControlRegisters& registers);
// The reason for rejecting the frame, if any.
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

  // Sets the reset values that parameters define.
  ParameterStore(const sc_core::sc_module_name& name, ClockDomain& clock,
                 ControlRegisters& registers, const spec::geometric::Parameters& parameters);

  // True if START was written and is not yet checked. Call between edges.
  bool starting() const { return starting_; }

 private:
  void start();
  void latch(Cycle cycle);

  ClockDomain& clock_;
  ControlRegisters& registers_;
  const spec::geometric::Parameters parameters_;
  bool starting_ = false,
       start_enabled_ = false;  // start_enabled_: value of enable when START was written
  spec::geometric::Rejection rejection_{};
};

}  // namespace deburr::rtl::geometric
