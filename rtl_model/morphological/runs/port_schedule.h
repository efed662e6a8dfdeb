// SPDX-License-Identifier: MIT
// Static schedule for the edge memories' read ports, shared in time by the predictors of one axis.
//
// A predictor starts a trial every trial_cycles cycles and reads once per side. The reads have
// fixed slots in a table of trial_cycles x ports entries that repeats from reset on: first both
// reads of predictor 0, then those of predictor 1, and so on, ports in rotation. Predictors are
// numbered with the lane first, so the predictors of a lane start in different cycles. The ports
// need no arbiter and are no more than the reads per cycle; a descriptor waits only for its
// predictor's first cycle. The left side reads in the cycle of the right side or, if the table says
// so, one later.
#pragma once

#include "rtl_model/fabric/clocked.h"
#include "spec/morphological/parameters.h"

namespace deburr::rtl::morphological {

class PortSchedule {
 public:
  explicit PortSchedule(const spec::morphological::Parameters& p)
      : cycles_(p.trial_cycles),
        ports_((kSides * p.predictor_units *
                    spec::morphological::kLaneCount[static_cast<std::size_t>(p.lanes)] +
                cycles_ - 1) /
               cycles_) {}

  int cycles() const { return cycles_; }
  int ports() const { return ports_; }
  // By predictor and side (0: right, 1: left).
  int phase(int predictor, int side) const { return (kSides * predictor + side) / ports_; }
  int port(int predictor, int side) const { return (kSides * predictor + side) % ports_; }
  // Cycles from cycle `since` (counted from reset) to the next cycle with this phase.
  Cycle wait(Cycle since, int phase) const {
    const auto cycles = static_cast<Cycle>(cycles_);
    return (static_cast<Cycle>(phase) + cycles - since % cycles) % cycles;
  }

 private:
  static constexpr int kSides = 2;
  int cycles_, ports_;
};

}  // namespace deburr::rtl::morphological
