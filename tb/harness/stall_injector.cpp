// SPDX-License-Identifier: MIT
#include "tb/harness/stall_injector.h"

#include <fmt/format.h>

#include "rtl_model/fabric/glob.h"
#include "rtl_model/fabric/ownership.h"
#include "spec/error.h"

namespace deburr::tb {

StallInjector::StallInjector(rtl::ClockDomain& clock, const Options& options) : options_(options) {
  if (options.push_permille >= 1000 || options.pop_permille >= 1000)
    throw spec::ConfigError(
        fmt::format("random stalls in {} and {} of 1000 cycles: both must be below 1000, otherwise "
                    "no beat ever moves",
                    options.push_permille, options.pop_permille));
  rtl::for_each_of<rtl::LinkBase>(clock, [&](rtl::LinkBase& link) {
    if (rtl::glob_match(options.glob, link.name()))
      stalled_.push_back({&link, Random(options.seed, link.name())});
  });
  if (stalled_.empty())
    throw spec::ConfigError(
        fmt::format("random stalls: no link of {} matches {}", clock.name(), options.glob));
  clock.add_before(*this);
}

rtl::Activity StallInjector::tick(rtl::Cycle cycle) {
  for (Stalled& stalled : stalled_) {
    if (stalled.random.chance(options_.push_permille)) {
      stalled.link->hold_push(cycle);
      ++stalls_;
    }
    if (stalled.random.chance(options_.pop_permille)) {
      stalled.link->hold_pop(cycle);
      ++stalls_;
    }
  }
  return rtl::kIdle;
}

void StallInjector::reset() {
  for (Stalled& stalled : stalled_) stalled.random = Random(options_.seed, stalled.link->name());
}

}  // namespace deburr::tb
