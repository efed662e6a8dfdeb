// SPDX-License-Identifier: MIT
#include "rtl_model/fabric/ownership.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string>

#include "rtl_model/fabric/link.h"
#include "rtl_model/fabric/memory.h"
#include "rtl_model/fabric/unit.h"
#include "rtl_model/fabric/wire.h"
#include "spec/error.h"

namespace deburr::rtl {
namespace {

struct Ends {
  const char* kind = "part of a unit";
  std::vector<const sc_core::sc_object*> held_by;
};

// The units that hold the ports of a link, wire or memory.
Ends ends_of(const sc_core::sc_object& object) {
  Ends ends;
  const auto add = [&ends](const std::string& port) {
    if (const sc_core::sc_object* const found = sc_core::sc_find_object(port.c_str()))
      ends.held_by.push_back(found);
  };
  if (const auto* link = dynamic_cast<const LinkBase*>(&object)) {
    ends.kind = "link";
    add(link->producer());
    add(link->consumer());
  } else if (const auto* wire = dynamic_cast<const WireBase*>(&object)) {
    ends.kind = "wire";
    add(wire->driver());
    for (const std::string& reader : wire->readers()) add(reader);
  } else if (const auto* memory = dynamic_cast<const MemoryBase*>(&object)) {
    ends.kind = "memory";
    ends.held_by = memory->port_holders();
  }
  return ends;
}

}  // namespace

Ownership::Ownership() {
  for_each<ClockDomain>([this](const ClockDomain& domain) { domains_.push_back(&domain); });
}

const ClockDomain* Ownership::given(const sc_core::sc_object& object) const {
  for (const ClockDomain* domain : domains_) {
    const auto& adopted = domain->adopted_;
    if (std::find(adopted.begin(), adopted.end(), &object) != adopted.end()) return domain;
  }
  return nullptr;
}

const ClockDomain* Ownership::around(const sc_core::sc_object* object) const {
  for (; object; object = object->get_parent_object()) {
    if (const auto* unit = dynamic_cast<const Unit*>(object)) return &unit->clock();
    if (const ClockDomain* const domain = given(*object)) return domain;
  }
  return nullptr;
}

// True if the innermost object that rule 3 finds is a unit.
bool Ownership::stands_in_unit(const sc_core::sc_object& object) const {
  for (const sc_core::sc_object* place = &object; place; place = place->get_parent_object()) {
    if (dynamic_cast<const Unit*>(place)) return true;
    if (place != &object && given(*place)) return false;
  }
  return false;
}

const ClockDomain* Ownership::find(const sc_core::sc_object& object) const {
  if (domains_.size() < 2) return domains_.empty() ? nullptr : domains_.front();
  if (const auto* link = dynamic_cast<const LinkBase*>(&object); link && link->memory())
    return find(*link->memory());
  const ClockDomain* found = given(object);
  const Ends ends = ends_of(object);
  const auto take = [&](const ClockDomain* domain) {
    if (found && domain && found != domain)
      throw spec::CheckFailed(fmt::format("{} joins two clock domains ({} and {}): a {} has one",
                                          object.name(), found->name(), domain->name(), ends.kind));
    if (domain) found = domain;
  };
  for (const sc_core::sc_object* end : ends.held_by) take(around(end));
  if (!found || stands_in_unit(object)) take(around(&object));
  const sc_core::sc_object* module = object.get_parent_object();
  std::set<const ClockDomain*> inside;
  for (; !found && inside.empty() && module; module = module->get_parent_object())
    walk(const_cast<sc_core::sc_object&>(*module), [&](const sc_core::sc_object& each) {
      if (const auto* domain = dynamic_cast<const ClockDomain*>(&each)) inside.insert(domain);
      if (const auto* unit = dynamic_cast<const Unit*>(&each)) inside.insert(&unit->clock());
    });
  if (inside.empty())
    for (const ClockDomain* domain : domains_)
      if (!domain->units().empty()) inside.insert(domain);
  return !found && inside.size() == 1 ? *inside.begin() : found;
}

const ClockDomain* Ownership::of(const sc_core::sc_object& object) const {
  const ClockDomain* const found = find(object);
  if (found || domains_.empty()) return found;
  std::string names;
  for (const ClockDomain* domain : domains_)
    names += fmt::format("{}{}", names.empty() ? "" : ", ", domain->name());
  throw spec::CheckFailed(fmt::format(
      "{}: its clock domain is unknown: it is outside all units and engines, no unit holds a port "
      "of it, and several domains surround it ({}). Make it a member of the unit that uses it, or "
      "name its domain: ClockDomain::adopt()",
      object.name(), names));
}

void check_owned(const ClockDomain& clock, const sc_core::sc_object& object) {
  const ClockDomain* const owner = Ownership().of(object);
  DEBURR_CHECK(owner == &clock,
               fmt::format("{} belongs to {}, but is observed in the cycles of {}: use an "
                           "observer of its own domain",
                           object.name(), owner ? owner->name() : "no domain", clock.name()));
}

}  // namespace deburr::rtl
