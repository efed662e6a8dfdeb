// SPDX-License-Identifier: MIT
// Function  Sequences the phases of a frame: begin, edges, resolve. In the cycle after the write of
//           START it makes the ParameterStore latch the configuration, which also tells whether the
//           frame is rejected.
// Position  Controls the pipeline.
// Latency   A phase begins in the cycle after all units have finished the previous one: their done
//           wires are registered, and so is the phase.
// Stalls    None.
#pragma once

#include <cstdint>
#include <systemc>

#include "rtl_model/fabric/datasheet.h"
#include "rtl_model/fabric/unit.h"
#include "rtl_model/fabric/wire.h"
#include "rtl_model/geometric/common/tokens.h"
#include "spec/geometric/registers.h"

namespace deburr::rtl::geometric {

class FrameSequencer final : public Unit {
 public:
  // START; latch of the registers into the configuration; rejection, in the same cycle.
  PulseIn start_in{"start_in"};
  PulseOut latch_out{"latch_out"};
  WireIn<spec::geometric::Rejection, WireKind::kCombinational> rejection_in{"rejection_in"};
  WireOut<Phase> phase_out{"phase_out"};
  // These end the begin, edge and resolve phases.
  WireIn<bool> facing_loaded_in{"facing_loaded_in"}, vertices_cleared_in{"vertices_cleared_in"},
      depth_cleared_in{"depth_cleared_in"}, weights_cleared_in{"weights_cleared_in"};
  WireIn<bool> drawn_in{"drawn_in"}, copied_in{"copied_in"};
  WireIn<bool> resolved_in{"resolved_in"};
  PulseOut frame_done_out{"frame_done_out"};

  FrameSequencer(const sc_core::sc_module_name& name, ClockDomain& clock) : Unit(name, clock) {}
  Activity tick(Cycle cycle) override;
  void reset() override;

  // Call between edges.
  bool idle() const { return state_ == Phase::kIdle; }

  Counter frame_cycles{"frame_cycles", "clk", "cycles of the last frame"};
  Counter edge_cycles{"edge_cycles", "clk", "cycles of the last frame until every edge was drawn"};
  Counter resolve_cycles{"resolve_cycles", "clk",
                         "cycles of the last frame after every edge was drawn"};

  static Datasheet datasheet();

 private:
  bool begun(Cycle cycle) const;
  void enter(Cycle cycle, Phase next);

  Phase state_ = Phase::kIdle;   // on phase_out one cycle later
  Cycle begun_ = 0, drawn_ = 0;  // cycles
};

}  // namespace deburr::rtl::geometric
