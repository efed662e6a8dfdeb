// SPDX-License-Identifier: MIT
// Takes a frame through its phases: begin, edges, resolve.
//
// Where: above the pipe. In the clock after START is written it has the ParameterStore latch the
// rules, which tells whether the frame is rejected. A phase begins in the clock after all units are
// done with the one before: their wires are registers of these units, and so is the phase. Never
// stalls.
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
  // START; the registers become the rules; whether they did, in the same clock.
  PulseIn start_in{"start_in"};
  PulseOut latch_out{"latch_out"};
  WireIn<spec::geometric::Rejection, WireKind::kCombinational> rejection_in{"rejection_in"};
  WireOut<Phase> phase_out{"phase_out"};
  // What ends the begin, the edges and the resolve.
  WireIn<bool> facing_loaded_in{"facing_loaded_in"}, vertices_cleared_in{"vertices_cleared_in"},
      depth_cleared_in{"depth_cleared_in"}, weights_cleared_in{"weights_cleared_in"};
  WireIn<bool> drawn_in{"drawn_in"}, copied_in{"copied_in"};
  WireIn<bool> resolved_in{"resolved_in"};
  PulseOut frame_done_out{"frame_done_out"};

  FrameSequencer(const sc_core::sc_module_name& name, ClockDomain& clock) : Unit(name, clock) {}
  Activity tick(Cycle cycle) override;
  void reset() override;

  // Between edges.
  bool idle() const { return state_ == Phase::kIdle; }

  Counter frame_cycles{"frame_cycles", "clk", "cycles of the last frame"};
  Counter edge_cycles{"edge_cycles", "clk", "of these, cycles until all edges are drawn"};
  Counter resolve_cycles{"resolve_cycles", "clk", "of these, the remaining cycles"};

  static Datasheet datasheet();

 private:
  bool begun(Cycle cycle) const;
  void enter(Cycle cycle, Phase next);

  Phase state_ = Phase::kIdle;   // on phase_out a clock later
  Cycle begun_ = 0, drawn_ = 0;  // cycles
};

}  // namespace deburr::rtl::geometric
