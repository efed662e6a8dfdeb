// SPDX-License-Identifier: MIT
// What a line cuts off each pixel of a group, and across which side.
//
// Where: behind the LineWalker. Stalls: `downstream`. Coverage is rounded. Source: paper 002, eq
// (7).
#pragma once

#include <cstdint>
#include <systemc>

#include "rtl_model/fabric/datasheet.h"
#include "rtl_model/fabric/pipe.h"
#include "rtl_model/fabric/unit.h"
#include "rtl_model/fabric/wire.h"
#include "rtl_model/geometric/common/edge_latency.h"
#include "rtl_model/geometric/common/frame_rules.h"
#include "rtl_model/geometric/common/tokens.h"

namespace deburr::rtl::geometric {

class CoverageUnit final : public Unit {
 public:
  WireIn<FrameRules> rules_in{"rules_in"};
  In<GroupToken> groups_in{"groups_in"};
  Out<CandidateToken> candidates_out{"candidates_out"};

  CoverageUnit(const sc_core::sc_module_name& name, ClockDomain& clock, EdgeLatency& latency)
      : Unit(name, clock), latency_(latency) {}
  Activity tick(Cycle cycle) override;
  void reset() override { pipe_.reset(); }

  Counter candidates{"candidates", "pixels", "pixels with a neighbour and a coverage"};

  static Datasheet datasheet();

 private:
  void find(Cycle cycle, const GroupToken& group, CandidateToken& out) const;

  EdgeLatency& latency_;  // an instrument
  Pipe<CandidateToken, 2> pipe_;
};

}  // namespace deburr::rtl::geometric
