// SPDX-License-Identifier: MIT
#include "rtl_model/fabric/unit.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

namespace deburr::rtl {

Unit::Unit(const sc_core::sc_module_name& name, ClockDomain& clock)
    : sc_module(name),
      clock_(clock),
      names_{"idle", "busy", "downstream"},
      meanings_{"nothing to do", "did work", "had work, but an output was not ready"} {
  clock.add(*this);
}

Activity Unit::declare_stall(const char* cause, const char* meaning) {
  DEBURR_CHECK(names_.size() < kActivities,
               fmt::format("{}: more than {} stall causes", name(), kActivities - 2));
  DEBURR_CHECK(std::find(names_.begin(), names_.end(), cause) == names_.end(),
               fmt::format("{}: stall cause {} is declared twice", name(), cause));
  names_.emplace_back(cause);
  meanings_.emplace_back(meaning);
  return Activity{names_.size() - 1};
}

std::uint64_t Unit::stalled_cycles() const {
  return std::accumulate(activity_.begin() + kStalledDownstream.code, activity_.end(),
                         std::uint64_t{0});
}

std::vector<Unit::StallCause> Unit::stalls() const {
  std::vector<StallCause> causes;
  for (std::size_t i = kStalledDownstream.code; i < names_.size(); ++i)
    causes.push_back({names_[i], meanings_[i], activity_[i]});
  return causes;
}

const std::string& Unit::activity_name(Activity activity) const {
  DEBURR_CHECK(activity.code < names_.size(),
               fmt::format("{}: undeclared activity {}", name(), activity.code));
  return names_[activity.code];
}

void Unit::check_accounting() const {
  if (replaced_) return;
  const std::uint64_t cycles = clock_.cycles_since_reset();
  const std::uint64_t sum = std::accumulate(activity_.begin(), activity_.end(), std::uint64_t{0});
  DEBURR_CHECK(sum == cycles,
               fmt::format("{}: busy {} + stalled {} + idle {} = {}, but {} cycles since reset",
                           name(), busy_cycles(), stalled_cycles(), idle_cycles(), sum, cycles));
  for (std::size_t i = names_.size(); i < kActivities; ++i)
    DEBURR_CHECK(activity_[i] == 0, fmt::format("{}: {} cycles with the undeclared activity {}",
                                                name(), activity_[i], i));
}

void Unit::check_ports() const {
  for (const sc_core::sc_object* child : get_child_objects()) {
    if (const auto* port = dynamic_cast<const PortBase*>(child))
      DEBURR_CHECK(port->bound(), fmt::format("{} is not bound to a link", port->name()));
  }
}

// Out of line, to keep the code of its users small.
Unit::~Unit() = default;

}  // namespace deburr::rtl
