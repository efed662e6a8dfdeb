// SPDX-License-Identifier: MIT
// The line through a record's corners: scale, offset and shift from the sums, the slope by one
// division, its inverse by a table.
//
// Where: between an EndpointPredictor and the AreaUnit, one of these an axis, with one divider a
// lane. Latency divider.latency, initiation interval divider.interval a lane; latency 1 more to
// the AreaUnit by the link. Stalls: `interval` (the divider cannot start again yet), `downstream`
// (its pipe of latency / interval places, rounded up, is full).
// Formats: slope U0.24 = rdiv(a 2^24, b), inverse U12.12 from U1.26. Cost a lane: a pipelined
// divider 36 / 27 bits, two multipliers 18 x 6 and 24 x 27, a ROM of 2 x 34 x 27 bits.
// Source: least-squares line with equidistant heights; paper 000 for the chord.
#pragma once

#include <cstdint>
#include <systemc>
#include <vector>

#include "rtl_model/fabric/unit.h"
#include "rtl_model/morphological/parameter_store.h"
#include "rtl_model/morphological/tokens.h"

namespace deburr::rtl::morphological {

class LineUnit final : public Unit {
 public:
  LanePorts<In<SumsToken>> sums_in;
  LanePorts<Out<LineToken>> lines_out;

  LineUnit(const sc_core::sc_module_name& name, ClockDomain& clock,
           const spec::morphological::Parameters& parameters, const ParameterStore& store,
           spec::morphological::Axis axis);
  Activity tick(Cycle cycle) override {
    return in_flight_ == 0 && !sums_in.any_arrives(cycle, lanes_) ? kIdle : work(cycle);
  }
  void reset() override;

  Counter divides{"divides", "divisions", "divisions started"};
  // Against lanes x clocks: how full the dividers are.
  Counter occupancy{"occupancy", "clk",
                    "clocks in which a divider could not start another, summed"};

 private:
  struct Division {
    LineToken result;
    Cycle ready;  // the quotient is in its register
  };
  // The divider of a lane; divisions in flight, oldest first, in a ring.
  struct Divider {
    std::vector<Division> flight;
    std::size_t oldest = 0, count = 0;
    Cycle start_from = 0;
  };

  Activity work(Cycle cycle);
  LineToken line_of(const SumsToken& sums) const;

  const ParameterStore& store_;
  const std::size_t lanes_;
  const std::int32_t reach_;
  const Cycle latency_, interval_;
  Activity interval_stall_;
  std::vector<Divider> dividers_;
  std::uint32_t in_flight_ = 0;  // divisions, of all lanes
};

}  // namespace deburr::rtl::morphological
