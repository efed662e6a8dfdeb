// SPDX-License-Identifier: MIT
// Fits the line through a descriptor's corners: scale, offset and shift from the sums, slope by one
// division, inverse slope by a table.
//
// Position  EndpointPredictor -> LineUnit -> AreaUnit; one per axis, one divider per lane.
// Latency   divider.latency >= kLeastLatency: two cycles of products, then at most two of 24
//           quotient bits per cycle (radix 4). A larger latency computes fewer bits per cycle.
// Stalls    interval    The divider cannot start yet.
//           downstream  The divider's pipeline of ceil(latency / interval) entries is full. A
//                       result leaves in the cycle in which it is ready.
// Note      A descriptor with learned weights has no line: it bypasses the divider in the cycle
//           that pops it, if no quotient leaves in that cycle (else stall `downstream`).
// Source    Least-squares line with equidistant heights; paper 000 for the chord.
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
  // Two cycles of products, 12 cycles for 24 quotient bits.
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
  // Relative to lanes x cycles: utilisation of the dividers.
  Counter occupancy{"occupancy", "clk",
                    "cycles in which a divider could not start a division, summed over dividers"};

  static Datasheet datasheet(const spec::morphological::Parameters& parameters);
  // Descriptor with learned weights.
  static Datasheet learned_datasheet(const spec::morphological::Parameters& parameters = {});

 private:
  struct Division {
    LineToken result;
    Cycle ready;          // the quotient is in its register
    std::int32_t pixels;  // factor of the table word, for the inverse
    std::uint32_t word;   // address of the table word
  };
  // A lane's divider; a ring buffer of divisions in flight, oldest first.
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
  std::vector<ReadPort<std::uint32_t>> inverse_;  // per lane
  std::vector<Divider> dividers_;
  std::uint32_t in_flight_ = 0;  // divisions in all lanes
  Cycle due_ = 0;                // without a new input, nothing changes before this cycle
};

}  // namespace deburr::rtl::morphological
