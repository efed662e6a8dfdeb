// SPDX-License-Identifier: MIT
// Round-robin choice among requesters, and the unit that merges links with it.
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

// Who is granted last has the lowest priority next time: a requester waits for at most n-1 grants.
// Combinational; cost: one n-bit priority chain (two with wrap) and a register of log2(n) bits.
// Made for 250 MHz up to 32 requesters; longest path: their priority chain and the choice of one.
class RoundRobin {
 public:
  explicit RoundRobin(int requesters) : requesters_(requesters) {
    DEBURR_CHECK(requesters >= 1 && requesters <= 64,
                 "1 to 64 requesters, got " + std::to_string(requesters));
  }
  // The requester that would be granted among the bits set in `requests`; -1 if none.
  int choose(std::uint64_t requests) const {
    const std::uint64_t after = requests & ~((std::uint64_t{1} << next_) - 1);
    const std::uint64_t candidates = after ? after : requests;
    return candidates ? std::countr_zero(candidates) : -1;
  }
  // The grant was used: the requester goes to the end of the queue.
  void grant(int requester) { next_ = requester + 1 == requesters_ ? 0 : requester + 1; }
  void reset() { next_ = 0; }

 private:
  int requesters_, next_ = 0;
};

// N links into one, fair, one beat a clock. Latency 1 in addition to the output link, II 1.
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
