// SPDX-License-Identifier: MIT
#include "tb/harness/fault_injector.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "rtl_model/fabric/ownership.h"
#include "spec/error.h"

namespace deburr::tb {
namespace {

std::uint64_t number(const std::string& text, const std::string& whole) {
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size())
    throw spec::ConfigError(fmt::format("fault {}: {} is not a number", whole, text));
  return value;
}

}  // namespace

Fault Fault::parse(const std::string& text) {
  std::vector<std::string> parts(1);
  for (const char c : text) {
    if (c == ':')
      parts.emplace_back();
    else
      parts.back() += c;
  }
  Fault fault{};
  const std::string& kind = parts[0];
  if (kind == "drop")
    fault.kind = Kind::kDrop;
  else if (kind == "duplicate")
    fault.kind = Kind::kDuplicate;
  else if (kind == "flip")
    fault.kind = Kind::kFlip;
  else if (kind == "stuck_ready")
    fault.kind = Kind::kStuckReady;
  else
    throw spec::ConfigError(fmt::format(
        "fault {}: unknown kind {}; known are drop, duplicate, flip and stuck_ready", text, kind));
  if (parts.size() != (fault.kind == Kind::kFlip ? 4U : 3U))
    throw spec::ConfigError(fmt::format(
        "fault {}: expected drop:LINK:BEAT, duplicate:LINK:BEAT, flip:LINK:BEAT:FIELD[.BIT], "
        "flip:LINK:BEAT:BIT or stuck_ready:LINK:CYCLE",
        text));
  fault.link = parts[1];
  fault.at = number(parts[2], text);
  if (fault.kind == Kind::kFlip) fault.bit = parts[3];
  return fault;
}

FaultInjector::FaultInjector(rtl::ClockDomain& clock, const std::vector<Fault>& faults) {
  for (const Fault& fault : faults) {
    rtl::LinkBase* found = nullptr;
    std::string known;
    rtl::for_each_of<rtl::LinkBase>(clock, [&](rtl::LinkBase& link) {
      known += std::string("\n  ") + link.name();
      if (fault.link == link.name()) found = &link;
    });
    if (!found)
      throw spec::ConfigError(
          fmt::format("fault: {} has no link named {}; known:{}", clock.name(), fault.link, known));
    rtl::Payload::Bit bit{};
    if (fault.kind == Fault::Kind::kFlip) {
      try {
        bit = found->payload().bit(fault.bit);
      } catch (const spec::ConfigError& error) {
        throw spec::ConfigError(fmt::format("fault on {}: {}", fault.link, error.what()));
      }
    }
    injected_.push_back({fault, found, bit});
  }
  clock.add_before(*this);
}

bool FaultInjector::act(const Injected& injected, rtl::Cycle cycle) {
  const Fault& fault = injected.fault;
  rtl::LinkBase& link = *injected.link;
  if (fault.kind == Fault::Kind::kStuckReady) {
    if (cycle < fault.at) return false;
    link.hold_push(cycle);
    return true;
  }
  // A link takes one push per cycle, so in the cycle after its push the beat is still the newest.
  if (link.pushes() != fault.at + 1 || link.empty()) return false;
  if (fault.kind == Fault::Kind::kDrop) return link.drop_newest();
  if (fault.kind == Fault::Kind::kFlip) {
    link.payload().flip(link.beat(fault.at), injected.bit);
    return true;
  }
  if (link.duplicate_newest(cycle)) return true;
  link.hold_push(cycle);  // no space for the duplicate: block pushes until there is
  return false;
}

rtl::Activity FaultInjector::tick(rtl::Cycle cycle) {
  for (Injected& injected : injected_)
    if (!injected.fired || injected.fault.kind == Fault::Kind::kStuckReady)
      injected.fired = act(injected, cycle);
  return rtl::kIdle;
}

std::size_t FaultInjector::fired() const {
  return static_cast<std::size_t>(
      std::count_if(injected_.begin(), injected_.end(), [](const Injected& p) { return p.fired; }));
}

void FaultInjector::check_fired() const {
  for (const Injected& injected : injected_)
    if (!injected.fired)
      throw spec::SimulationError(
          fmt::format("the fault on {} at {} was never reached: the run ended before it",
                      injected.fault.link, injected.fault.at));
}

}  // namespace deburr::tb
