// SPDX-License-Identifier: MIT
// Who reads the edges when: the read ports of a memory, shared in time by the predictors of an
// axis.
//
// A predictor makes a trial every trial_cycles cycles, and a trial reads once for each side. These
// reads have fixed places in a table of trial_cycles x ports that goes round with the clock: the
// two of the first predictor come first, then those of the second, and so on, each port in turn.
// Numbers count the lanes first, so that the predictors of a lane begin in different cycles. So
// nobody waits for a port but for the clock in which a record's first trial may begin, there is
// nothing to arbitrate, and no memory has more ports than reads a clock. The left side reads in the
// clock of the right one or, if the table says so, in the next.
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
  // Of a predictor and side (0: right, 1: left).
  int phase(int predictor, int side) const { return (kSides * predictor + side) / ports_; }
  int port(int predictor, int side) const { return (kSides * predictor + side) % ports_; }
  // Cycles from the clock `since` the reset on to the first one that has this phase.
  Cycle wait(Cycle since, int phase) const {
    const auto cycles = static_cast<Cycle>(cycles_);
    return (static_cast<Cycle>(phase) + cycles - since % cycles) % cycles;
  }

 private:
  static constexpr int kSides = 2;
  int cycles_, ports_;
};

}  // namespace deburr::rtl::morphological
