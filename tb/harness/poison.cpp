// SPDX-License-Identifier: MIT
#include "tb/harness/poison.h"

#include <fmt/format.h>

#include "rtl_model/fabric/glob.h"
#include "rtl_model/fabric/ownership.h"
#include "spec/error.h"

namespace deburr::tb {

Poison::Poison(rtl::ClockDomain& clock, std::uint64_t seed, const std::string& glob) : seed_(seed) {
  rtl::for_each_of<rtl::LinkBase>(clock, [&](rtl::LinkBase& link) {
    if (!rtl::glob_match(glob, link.name())) return;
    poisoned_.push_back({&link, Random(seed, link.name()), link.pops()});
    fill_empty(poisoned_.back());
  });
  if (poisoned_.empty())
    throw spec::ConfigError(fmt::format("poison: no link of {} matches {}", clock.name(), glob));
  clock.add_before(*this);
}

void Poison::fill_empty(Poisoned& p) {
  rtl::LinkBase& link = *p.link;
  for (std::uint64_t beat = link.pushes(); beat < link.pops() + link.depth(); ++beat, ++slots_)
    link.payload().fill(link.beat(beat), p.random.next());
}

// Between cycles: poisons the slots of beats popped in the last cycle.
rtl::Activity Poison::tick(rtl::Cycle) {
  for (Poisoned& p : poisoned_)
    for (; p.pops < p.link->pops(); ++p.pops, ++slots_)
      p.link->payload().fill(p.link->beat(p.pops), p.random.next());
  return rtl::kIdle;
}

void Poison::reset() {
  for (Poisoned& p : poisoned_) {
    p.random = Random(seed_, p.link->name());
    p.pops = 0;
    fill_empty(p);
  }
}

}  // namespace deburr::tb
