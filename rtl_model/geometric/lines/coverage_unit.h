// SPDX-License-Identifier: MIT
// What a line cuts off each pixel of a group, and across which side.
//
// Where: behind the LineWalker. Latency 2, a group a clock; a group without a candidate leaves
// nothing. Stages: 1 distance, direction, depth; 2 coverage, borders, candidates. Stalls:
// `downstream`. Formats: distance S0.16, coverage U0.8, rounded. Cost a lane: 17-bit add, 17-bit
// magnitude, two 14-bit compares; 4 adds of 38 bits. Made for 250 MHz; longest path: 38-bit add.
// Source: paper 002, eq (7).
#pragma once

#include <cstdint>
#include <systemc>

#include "rtl_model/fabric/pipe.h"
#include "rtl_model/fabric/unit.h"
#include "rtl_model/geometric/edge_latency.h"
#include "rtl_model/geometric/parameter_store.h"
#include "rtl_model/geometric/tokens.h"

namespace deburr::rtl::geometric {

class CoverageUnit final : public Unit {
 public:
  In<GroupToken> groups_in{"groups_in"};
  Out<CandidateToken> candidates_out{"candidates_out"};

  CoverageUnit(const sc_core::sc_module_name& name, ClockDomain& clock, const ParameterStore& store,
               EdgeLatency& latency)
      : Unit(name, clock), store_(store), latency_(latency) {}
  Activity tick(Cycle cycle) override;
  void reset() override { pipe_.reset(); }

  Counter candidates{"candidates", "pixels", "pixels with a neighbour and a coverage"};

 private:
  void find(const GroupToken& group, CandidateToken& out);

  const ParameterStore& store_;
  EdgeLatency& latency_;  // an instrument
  Pipe<CandidateToken, 2> pipe_;
};

}  // namespace deburr::rtl::geometric
