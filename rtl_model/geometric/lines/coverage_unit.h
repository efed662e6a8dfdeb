// SPDX-License-Identifier: MIT
// Function  Computes the area that a line cuts off each pixel of a group, rounded, and the side of
//           the neighbour. Each column yields the pixel that contains the line, and with coverage =
//           area also the neighbour that it cuts.
// Position  After the LineWalker.
// Stalls    `downstream`.
// Source    Paper 002, eq (7); areas: docs/reference/geometric/algorithm.md.
//
// A column looks up two areas: that of the pixel in the near half of the table (less than half a
// pixel from the centre), that of the neighbour in the far half. At exactly half a pixel both are
// equal and stored in the far half.
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

  static Datasheet datasheet(const spec::geometric::Parameters& parameters = {});

 private:
  struct Beat {
    CandidateToken out;
    std::uint8_t leaves;  // bit k: the line leaves the pixel of lane k, so areas are read
    std::uint8_t half;    // bit k: exactly half a pixel from its centre
    std::array<std::uint16_t, kLanes> near, far;  // U10, table addresses
  };
  void find(Cycle cycle, const GroupToken& group, Beat& beat) const;
  void look_up(Cycle cycle, const Beat& beat);
  void finish(Cycle cycle, Beat& beat) const;

  EdgeLatency& latency_;  // measuring instrument
  Memory<std::uint8_t> near_rom_, far_rom_;
  std::vector<ReadPort<std::uint8_t>> near_, far_;  // by lane
  Pipe<Beat, 3> pipe_;
};

}  // namespace deburr::rtl::geometric
