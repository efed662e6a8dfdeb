// SPDX-License-Identifier: MIT
#include "rtl_model/fabric/wire.h"

#include <fmt/format.h>

namespace deburr::rtl {

void WireBase::fail(const char* what, Cycle cycle) const {
  throw spec::CheckFailed(fmt::format(
      "{}: cycle {}: {} ({} wire; driver {}, readers {})", name(), cycle, what,
      combinational() ? "combinational" : "registered", driver_.empty() ? "unbound" : driver_,
      readers_.empty() ? "unbound" : fmt::format("{}", fmt::join(readers_, ", "))));
}

void Pulse::raise(Cycle cycle) {
  if (raised_ == cycle) fail("raised twice in a cycle", cycle);
  const bool goes_on = cycle != 0 && raised_ == cycle - 1;
  count(cycle, goes_on ? 0U : 2U, true);  // includes the falling edge
  raised_ = cycle;
  for (const std::function<void(Cycle)>* take : takers_) (*take)(cycle);
}

const std::byte* Pulse::seen(Cycle cycle) const {
  static constexpr bool kLow = false, kHigh = true;
  return reinterpret_cast<const std::byte*>(read(cycle) ? &kHigh : &kLow);
}

void WirePortBase::bind_wire(WireBase& wire) {
  DEBURR_CHECK(!base_ && !outer_, fmt::format("{} is bound twice", name()));
  resolve(wire);
}

void WirePortBase::bind_port(WirePortBase& outer) {
  DEBURR_CHECK(!base_ && !outer_, fmt::format("{} is bound twice", name()));
  DEBURR_CHECK(side_ == Side::kReader || outer.inner_.empty(),
               fmt::format("{} already has a driver inside: {}", outer.name(),
                           outer.inner_.empty() ? "" : outer.inner_.front()->name()));
  outer_ = &outer;
  outer.inner_.push_back(this);
  if (!outer.base_) return;
  // The outer port has claimed the wire already; the claim moves inwards.
  if (side_ == Side::kDriver)
    outer.base_->driver_.clear();
  else
    std::erase(outer.base_->readers_, outer.name());
  resolve(*outer.base_);
}

void WirePortBase::resolve(WireBase& wire) {
  base_ = &wire;
  resolved(wire);
  if (!inner_.empty()) {
    for (WirePortBase* port : inner_) port->resolve(wire);
    return;
  }
  if (side_ == Side::kReader) {
    wire.readers_.emplace_back(name());
    return;
  }
  DEBURR_CHECK(wire.driver_.empty(),
               fmt::format("{} has two drivers: {} and {}", wire.name(), wire.driver_, name()));
  wire.driver_ = name();
}

// Out of line, to keep the code of its users small.
WireBase::~WireBase() = default;

// Out of line, to keep the code of its users small.
WirePortBase::~WirePortBase() = default;

}  // namespace deburr::rtl
