// SPDX-License-Identifier: MIT
// Extends clean Z runs to both sides and sums up their corners: the predictors of an axis.
//
// Where: between the record FIFOs and the LineUnit, one of these an axis. For each lane a FIFO
// feeds predictor_units predictors, a record a clock to the first that is free; each has a result
// register, and one of these a lane and clock goes to the LineUnit. The predictors weight the read
// ports of their axis' memory by a fixed schedule (PortSchedule). A result is sent in the clock
// after the one in which its record is let go (Predictor). Stalls: `downstream` (the result
// registers are still full).
#pragma once

#include <cstdint>
#include <deque>
#include <systemc>
#include <vector>

#include "rtl_model/fabric/datasheet.h"
#include "rtl_model/fabric/unit.h"
#include "rtl_model/fabric/wire.h"
#include "rtl_model/morphological/common/frame_configuration.h"
#include "rtl_model/morphological/common/tokens.h"
#include "rtl_model/morphological/runs/edge_port.h"
#include "rtl_model/morphological/runs/edge_rows.h"
#include "rtl_model/morphological/runs/edge_window.h"
#include "rtl_model/morphological/runs/port_schedule.h"
#include "rtl_model/morphological/runs/predictor.h"

namespace deburr::rtl::morphological {

class EndpointPredictor final : public Unit {
 public:
  WireIn<FrameConfiguration> configuration_in{"configuration_in"};
  LanePorts<In<RunToken>> descriptors_in;
  LanePorts<Out<SumsToken>> sums_out;

  // Of horizontal runs, which read rows; of vertical runs, which read columns.
  EndpointPredictor(const sc_core::sc_module_name& name, ClockDomain& clock,
                    const spec::morphological::Parameters& parameters, EdgeRows& rows);
  EndpointPredictor(const sc_core::sc_module_name& name, ClockDomain& clock,
                    const spec::morphological::Parameters& parameters, EdgeWindow& window);
  Activity tick(Cycle cycle) override {
    return held_ == 0 && !descriptors_in.any_arrives(cycle, lanes_) ? kIdle : work(cycle);
  }
  void reset() override;

  Counter extended_runs{"extended_runs", "runs", "runs extended by at least one step"};
  Counter steps{"steps", "steps", "extension steps kept"};
  Counter probes{"probes", "corners", "corners tested"};
  Counter iterations{"iterations", "trials", "trials, of one side or of both"};
  Counter occupancy{"occupancy", "clk", "occupied cycles, summed over predictors"};

  static Datasheet datasheet();  // of a record that is not extended and has no class to be found
  // Of a record that is extended by one step of both sides.
  static Datasheet trial_datasheet(const spec::morphological::Parameters& parameters);
  static Datasheet class_datasheet(const spec::morphological::Parameters& parameters);

 private:
  // A predictor and its result register.
  struct Place {
    Predictor predictor;
    bool full = false;
    SumsToken result{};
  };

  EndpointPredictor(const sc_core::sc_module_name& name, ClockDomain& clock,
                    const spec::morphological::Parameters& parameters, EdgeMemory& edges,
                    std::int32_t search_range, bool vertical);
  Activity work(Cycle cycle);

  const PortSchedule schedule_;
  const std::size_t lanes_, units_;  // units_: predictors a lane
  std::vector<Place> places_;
  std::vector<std::size_t> turn_;  // of each lane: the predictor whose result is sent next
  std::uint32_t held_ = 0;         // records and results inside
  std::uint32_t full_ = 0;         // result registers
};

}  // namespace deburr::rtl::morphological
