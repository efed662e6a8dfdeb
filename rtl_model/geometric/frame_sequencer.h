// SPDX-License-Identifier: MIT
// Takes a frame through its phases: begin, edges, resolve.
//
// Where: above the pipe. START is judged in the clock after its write; a refused one has an effect
// on REFUSAL and STATUS alone. A phase begins in the clock after all units are done with the one
// before, whose flags are registers of these units. Never stalls.
#pragma once

#include <cstdint>
#include <functional>
#include <systemc>

#include "rtl_model/fabric/datasheet.h"
#include "rtl_model/fabric/unit.h"
#include "rtl_model/geometric/parameter_store.h"
#include "rtl_model/geometric/wire.h"

namespace deburr::rtl::geometric {

class FrameSequencer final : public Unit {
 public:
  FrameSequencer(const sc_core::sc_module_name& name, ClockDomain& clock, ParameterStore& store);
  Activity tick(Cycle cycle) override;
  void reset() override;

  // What ends a phase; asked in each of its clocks.
  std::function<bool(Cycle)> begin_done, edges_done, resolve_done;
  Phase phase(Cycle cycle) const { return phase_.get(cycle); }

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
  void enter(Cycle cycle, Phase next);

  ParameterStore& store_;
  Wire<Phase> phase_{Phase::kIdle};
  Phase state_ = Phase::kIdle;
  Cycle begun_ = 0, drawn_ = 0;  // clocks
  bool started_ = false, start_enabled_ = false;
  spec::geometric::Refusal refused_{};
};

}  // namespace deburr::rtl::geometric
