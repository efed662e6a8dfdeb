// SPDX-License-Identifier: MIT
// Injects faults on named links to show that checks can fail. A fault acts between two cycles, on a
// beat that has been pushed but that the consumer has not yet seen.
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
      0;  // number of the beat, from 0; kStuckReady: cycle from which ready stays low
  std::string bit = {};  // kFlip: a field, "field.bit", or a bit number: Payload::bit()

  // Parses "drop:<link>:<beat>", "duplicate:<link>:<beat>", "flip:<link>:<beat>:<field>[.<bit>]",
  // "flip:<link>:<beat>:<bit>" or "stuck_ready:<link>:<cycle>". Throws ConfigError for anything
  // else.
  static Fault parse(const std::string& text);
};

class FaultInjector final : public rtl::Clocked {
 public:
  // Construct it after the design. Throws ConfigError if the link does not exist, or if its payload
  // does not have the field or bit.
  FaultInjector(rtl::ClockDomain& clock, const std::vector<Fault>& faults);

  rtl::Activity tick(rtl::Cycle cycle) override;
  void reset() override {}
  std::size_t fired() const;
  // Throws SimulationError if a fault never fired, since the run then proves nothing.
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
