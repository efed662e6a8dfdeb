// SPDX-License-Identifier: MIT
// Injected faults on named links, to show that the checks can fail. A fault acts between two
// cycles, on a beat that has been pushed and that the consumer has not seen.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "rtl_model/fabric/clock_domain.h"
#include "rtl_model/fabric/link.h"

namespace deburr::tb {

struct Fault {
  enum class Kind { kDrop, kDuplicate, kFlip, kStuckReady };
  Kind kind;
  std::string link;  // full name
  std::uint64_t at =
      0;  // number of the beat, from 0; kStuckReady: the cycle from which ready is low
  std::string bit = {};  // kFlip: a field, one of its bits or the number of a bit: Payload::bit()

  // "drop:<link>:<beat>", "duplicate:<link>:<beat>", "flip:<link>:<beat>:<field>[.<bit>]" or
  // "flip:<link>:<beat>:<bit>", "stuck_ready:<link>:<cycle>". ConfigError if it is none of these.
  static Fault parse(const std::string& text);
};

class FaultInjector final : public rtl::Clocked {
 public:
  // ConfigError if there is no such link, or no such field or bit in it. Construct it after the
  // design.
  FaultInjector(rtl::ClockDomain& clock, const std::vector<Fault>& faults);

  rtl::Activity tick(rtl::Cycle cycle) override;
  void reset() override {}
  std::size_t fired() const;
  // Throws SimulationError if a fault was never reached: such a run has shown nothing.
  void check_fired() const;

 private:
  struct Injected {
    Fault fault;
    rtl::LinkBase* link;
    rtl::Payload::Bit bit;
    bool fired = false;
  };
  static bool act(const Injected& injected, rtl::Cycle cycle);
  std::vector<Injected> injected_;
};

}  // namespace deburr::tb
