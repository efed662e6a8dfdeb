// SPDX-License-Identifier: MIT
// Takes a frame through its phases: begin, edges, resolve.
//
// Where: above the pipe. START is judged in the clock after its write; a refused one has an effect
// on REFUSAL and STATUS alone. A phase begins in the clock after all units are done with the one
// before: their wires are registers of these units, and so is the phase. Never stalls.
#pragma once

#include <cstdint>
#include <systemc>

#include "rtl_model/fabric/datasheet.h"
#include "rtl_model/fabric/unit.h"
#include "rtl_model/fabric/wire.h"
#include "rtl_model/geometric/common/parameter_store.h"
#include "rtl_model/geometric/common/tokens.h"

namespace deburr::rtl::geometric {

class FrameSequencer final : public Unit {
 public:
  WireOut<Phase> phase_out{"phase_out"};
  // What ends the begin, the edges and the resolve.
  WireIn<bool> facing_loaded_in{"facing_loaded_in"}, vertices_cleared_in{"vertices_cleared_in"},
      depth_cleared_in{"depth_cleared_in"}, weights_cleared_in{"weights_cleared_in"};
  WireIn<bool> drawn_in{"drawn_in"}, copied_in{"copied_in"};
  WireIn<bool> resolved_in{"resolved_in"};

  FrameSequencer(const sc_core::sc_module_name& name, ClockDomain& clock, ParameterStore& store);
  Activity tick(Cycle cycle) override;
  void reset() override;

  // A bus write, from outside of time.
  void start(bool enabled) {
    started_ = true;
    start_enabled_ = enabled;
  }
  // Between edges.
  bool idle() const { return !started_ && state_ == Phase::kIdle; }
  spec::geometric::Refusal refused() const { return refused_; }

  Counter frame_cycles{"frame_cycles", "clk", "clocks of the last frame"};
  Counter edge_cycles{"edge_cycles", "clk", "of these until every edge was drawn"};
  Counter resolve_cycles{"resolve_cycles", "clk", "of these the rest"};

  static Datasheet datasheet();

 private:
  bool begun(Cycle cycle) const;
  void enter(Cycle cycle, Phase next);

  ParameterStore& store_;
  Phase state_ = Phase::kIdle;   // on phase_out a clock later
  Cycle begun_ = 0, drawn_ = 0;  // clocks
  bool started_ = false, start_enabled_ = false;
  spec::geometric::Refusal refused_{};
};

}  // namespace deburr::rtl::geometric
