// SPDX-License-Identifier: MIT
// Fills unwritten link slots with noise. From the cycle after a beat is popped until its slot is
// refilled, every field of the slot holds a bad pattern, masked to its width. If a producer omits a
// field, or a consumer reads a beat after popping it, noise is read instead of a plausible old
// value. Rejects a link whose payload does not list its fields.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "rtl_model/fabric/clock_domain.h"
#include "rtl_model/fabric/link.h"
#include "tb/base/random.h"

namespace deburr::tb {

class Poison final : public rtl::Clocked {
 public:
  // Covers all existing links whose full name matches the glob. Construct it after the design and
  // before anything else that modifies links.
  Poison(rtl::ClockDomain& clock, std::uint64_t seed, const std::string& glob = "*");

  rtl::Activity tick(rtl::Cycle cycle) override;
  void reset() override;
  std::uint64_t slots() const { return slots_; }  // poisoned so far

 private:
  struct Poisoned {
    rtl::LinkBase* link;
    Random random;
    std::uint64_t pops = 0;  // pops whose slots are already poisoned
  };
  void fill_empty(Poisoned& poisoned);
  std::uint64_t seed_;
  std::vector<Poisoned> poisoned_;
  std::uint64_t slots_ = 0;
};

}  // namespace deburr::tb
