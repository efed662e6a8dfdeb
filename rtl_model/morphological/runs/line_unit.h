// SPDX-License-Identifier: MIT
// The line through a record's corners: scale, offset and shift from the sums, the slope by one
// division, its inverse by a table.
//
// Where: between an EndpointPredictor and the AreaUnit, one of these an axis, with one divider a
// lane. divider.latency is at least kLeastLatency: two cycles of products, and at most two of 24
// quotient bits a clock (radix 4); a longer one takes fewer bits a clock. Stalls: `interval` (the
// divider cannot start again yet), `downstream` (its pipe of latency / interval places, rounded up,
// is full; a result leaves in its clock). A learned record has no line: it passes the divider, in
// the clock that pops it, if no quotient leaves in that clock (else `downstream`). Source:
// least-squares line with equidistant heights; paper 000 for the chord.
#pragma once

#include <cstdint>
#include <systemc>
#include <vector>

#include "rtl_model/fabric/datasheet.h"
#include "rtl_model/fabric/memory.h"
#include "rtl_model/fabric/unit.h"
#include "rtl_model/fabric/wire.h"
#include "rtl_model/morphological/common/frame_configuration.h"
#include "rtl_model/morphological/common/tokens.h"

namespace deburr::rtl::morphological {

class LineUnit final : public Unit {
 public:
  // Two cycles of products, 24 quotient bits in twelve.
  static constexpr std::int32_t kLeastLatency = spec::morphological::kLeastDividerLatency;

  WireIn<FrameConfiguration> configuration_in{"configuration_in"};
  LanePorts<In<SumsToken>> sums_in;
  LanePorts<Out<LineToken>> lines_out;

  LineUnit(const sc_core::sc_module_name& name, ClockDomain& clock,
           const spec::morphological::Parameters& parameters, spec::morphological::Axis axis);
  Activity tick(Cycle cycle) override {
    if (sums_in.any_arrives(cycle, lanes_)) return work(cycle);
    if (in_flight_ == 0) return kIdle;
    return cycle < due_ ? kBusy : work(cycle);
  }
  void reset() override;

  Counter divides{"divides", "divisions", "divisions started"};
  // Against lanes x cycles: how full the dividers are.
  Counter occupancy{"occupancy", "clk",
                    "cycles in which a divider could not start a division, summed over dividers"};

  static Datasheet datasheet(const spec::morphological::Parameters& parameters);
  static Datasheet learned_datasheet();  // of a record without a line

 private:
  struct Division {
    LineToken result;
    Cycle ready;          // the quotient is in its register
    std::int32_t pixels;  // the inverse is so many times a word of the table
    std::uint32_t word;   // its address
  };
  // The divider of a lane; divisions in flight, oldest first, in a ring.
  struct Divider {
    std::vector<Division> flight;
    std::size_t oldest = 0, count = 0;
    Division* fresh = nullptr;  // in stage 2
    Cycle start_from = 0;
  };

  Activity work(Cycle cycle);
  static LineToken begun(const SumsToken& sums);
  void begin(Cycle cycle, std::size_t lane, const SumsToken& sums, Division& division);

  const std::size_t lanes_;
  const std::int32_t search_range_;
  const Cycle latency_, interval_;
  Activity interval_stall_;
  Memory<std::uint32_t> inverse_rom_;
  std::vector<ReadPort<std::uint32_t>> inverse_;  // a lane
  std::vector<Divider> dividers_;
  std::uint32_t in_flight_ = 0;  // divisions, of all lanes
  Cycle due_ = 0;                // if none begins: up to here they only go on
};

}  // namespace deburr::rtl::morphological
