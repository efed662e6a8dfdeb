// SPDX-License-Identifier: MIT
// Extends clean Z runs on both sides and sums their corners: all predictors of one axis.
//
// Position  Descriptor FIFOs -> EndpointPredictor -> LineUnit; one instance per axis. Per lane, a
//           FIFO feeds predictor_units predictors: one descriptor per cycle, to the first free
//           predictor. They share the read ports of their axis' edge memory by a static schedule
//           (PortSchedule).
// Output    Each predictor has a result register; one result per lane and cycle goes to the
//           LineUnit, one cycle after the predictor releases the descriptor.
// Stalls    downstream  The result registers are full.
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

  // Horizontal runs read rows, vertical runs read columns.
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
  Counter iterations{"iterations", "trials", "trials (one side or both)"};
  Counter occupancy{"occupancy", "clk",
                    "cycles in which a predictor held a descriptor, summed over predictors"};

  // Descriptor that is not extended and needs no class.
  static Datasheet datasheet(const spec::morphological::Parameters& parameters = {});
  // Descriptor extended by one step on both sides.
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
  const std::size_t lanes_, units_;  // units_: predictors per lane
  std::vector<Place> places_;
  std::vector<std::size_t> turn_;  // per lane: the predictor whose result is sent next
  std::uint32_t held_ = 0;         // descriptors and results inside
  std::uint32_t full_ = 0;         // full result registers
};

}  // namespace deburr::rtl::morphological
