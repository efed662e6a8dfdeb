// SPDX-License-Identifier: MIT
// What a line cuts off the pixels of a group, and across which side: of each column the pixel in
// which it lies, and with coverage = area the neighbour that it cuts, too.
//
// Where: after the LineWalker. Stalls: `downstream`. Coverage is rounded. Source: paper 002, eq
// (7); areas: docs/reference/geometric/algorithm.md. A column looks two areas up: the pixel's in
// the near half of the table, up to half a pixel from the centre, the neighbour's in the far one.
// Just half a pixel away both are the same, which is in the far half.
#pragma once

#include <array>
#include <cstdint>
#include <systemc>
#include <vector>

#include "rtl_model/fabric/datasheet.h"
#include "rtl_model/fabric/memory.h"
#include "rtl_model/fabric/pipe.h"
#include "rtl_model/fabric/unit.h"
#include "rtl_model/fabric/wire.h"
#include "rtl_model/geometric/common/edge_latency.h"
#include "rtl_model/geometric/common/frame_configuration.h"
#include "rtl_model/geometric/common/tokens.h"

namespace deburr::rtl::geometric {

class CoverageUnit final : public Unit {
 public:
  WireIn<FrameConfiguration> configuration_in{"configuration_in"};
  In<GroupToken> groups_in{"groups_in"};
  Out<CandidateToken> candidates_out{"candidates_out"};

  CoverageUnit(const sc_core::sc_module_name& name, ClockDomain& clock,
               const spec::geometric::Parameters& parameters, EdgeLatency& latency);
  Activity tick(Cycle cycle) override;
  void reset() override { pipe_.reset(); }

  Counter candidates{"candidates", "pixels", "pixels with a neighbour and a coverage"};

  static Datasheet datasheet();

 private:
  struct Beat {
    CandidateToken out;
    std::uint8_t leaves;  // bit k: the line leaves the pixel of lane k, so that areas are read
    std::uint8_t half;    // bit k: half a pixel from its centre
    std::array<std::uint16_t, kLanes> near, far;  // U10, where in the tables
  };
  void find(Cycle cycle, const GroupToken& group, Beat& beat) const;
  void look_up(Cycle cycle, const Beat& beat);
  void finish(Cycle cycle, Beat& beat) const;

  EdgeLatency& latency_;  // an instrument
  Memory<std::uint8_t> near_rom_, far_rom_;
  std::vector<ReadPort<std::uint8_t>> near_, far_;  // lane
  Pipe<Beat, 3> pipe_;
};

}  // namespace deburr::rtl::geometric
