// SPDX-License-Identifier: MIT
// Round-robin arbiter, and the unit that merges links with it.
#pragma once

#include <bit>
#include <cstdint>
#include <memory>
#include <string>
#include <systemc>
#include <vector>

#include "rtl_model/fabric/unit.h"
#include "spec/error.h"

namespace deburr::rtl {

// Function  Round-robin choice. The requester granted last has the lowest priority next time, so a
//           requester waits for at most n - 1 grants.
// Latency   0, combinational.
// Cost      A priority chain of n bits (two with wrap-around) and a register of log2(n) bits. Meets
//           250 MHz up to 32 requesters; longest path: priority chain, then the choice of one
//           requester.
class RoundRobin {
 public:
  explicit RoundRobin(int requesters) : requesters_(requesters) {
    DEBURR_CHECK(requesters >= 1 && requesters <= 64,
                 "1 to 64 requesters, got " + std::to_string(requesters));
  }
  // The requester to grant among the bits set in `requests`; -1 if none is set.
  int choose(std::uint64_t requests) const {
    const std::uint64_t after = requests & ~((std::uint64_t{1} << next_) - 1);
    const std::uint64_t candidates = after ? after : requests;
    return candidates ? std::countr_zero(candidates) : -1;
  }
  // Called when the grant was used: the requester gets the lowest priority.
  void grant(int requester) { next_ = requester + 1 == requesters_ ? 0 : requester + 1; }
  void reset() { next_ = 0; }

 private:
  int requesters_, next_ = 0;
};

// Merges N links into one, fairly, one beat per cycle. Latency 1 plus that of the output link,
// initiation interval 1.
template <class T>
class Merge final : public Unit {
 public:
  std::vector<std::unique_ptr<In<T>>> beats_in;
  Out<T> beats_out{"beats_out"};

  Merge(const sc_core::sc_module_name& name, ClockDomain& clock, int inputs)
      : Unit(name, clock), arbiter_(inputs) {
    for (int i = 0; i < inputs; ++i)
      beats_in.push_back(std::make_unique<In<T>>(("beats_in_" + std::to_string(i)).c_str()));
  }
  Activity tick(Cycle cycle) override {
    std::uint64_t requests = 0;
    for (std::size_t i = 0; i < beats_in.size(); ++i)
      requests |= std::uint64_t{beats_in[i]->can_pop(cycle)} << i;
    if (!requests) return kIdle;
    if (!beats_out.can_push(cycle)) return kStalledDownstream;
    const int chosen = arbiter_.choose(requests);
    arbiter_.grant(chosen);
    beats_out.push(cycle, beats_in[static_cast<std::size_t>(chosen)]->take(cycle));
    return kBusy;
  }
  void reset() override { arbiter_.reset(); }

 private:
  RoundRobin arbiter_;
};

}  // namespace deburr::rtl
