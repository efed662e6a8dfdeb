// SPDX-License-Identifier: MIT
// Fills what nobody has written: a slot of a link carries a bad pattern in every field, masked to
// the field's width, from the clock after its beat was popped until it is refilled. A producer that
// leaves a field out, or a consumer that looks at a beat once more after its pop, then reads noise
// that changes with every beat and field instead of a plausible old value. A link whose payload
// does not list its fields is rejected.
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
  // All links whose full name matches the glob and that exist now: construct it after the design,
  // and before anything else that acts on links.
  Poison(rtl::ClockDomain& clock, std::uint64_t seed, const std::string& glob = "*");

  rtl::Activity tick(rtl::Cycle cycle) override;
  void reset() override;
  std::uint64_t slots() const { return slots_; }  // filled so far

 private:
  struct Poisoned {
    rtl::LinkBase* link;
    Random random;
    std::uint64_t pops = 0;  // of the beats whose slots are poisoned
  };
  void fill_empty(Poisoned& poisoned);
  std::uint64_t seed_;
  std::vector<Poisoned> poisoned_;
  std::uint64_t slots_ = 0;
};

}  // namespace deburr::tb
