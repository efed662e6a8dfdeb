// SPDX-License-Identifier: MIT
// Which clock domain an object of the fabric belongs to: a link, wire, memory, counter, histogram,
// port or register block. The first matching rule applies:
//
//   1. the domain assigned by ClockDomain::adopt();
//   2. the domain of the units that hold its ports;
//   3. the domain of the innermost enclosing unit or adopted module. An Engine is adopted by the
//      domain it is constructed with, a ticked module by the domain that ticks it;
//   4. the only domain in the innermost enclosing module that contains units or clock domains;
//      outside all modules, the only domain with units, or if none has units, the only domain.
//      Several domains are an error.
//
// It is an error if rule 1, rule 2 and an enclosing unit give different domains. An adopted module
// may contain parts of other domains. In a simulation with one domain everything belongs to it.
// Evaluated at the end of elaboration, and by observers at their construction.
#pragma once

#include <systemc>
#include <vector>

#include "rtl_model/fabric/clock_domain.h"
#include "rtl_model/fabric/counters.h"

namespace deburr::rtl {

class Ownership {
 public:
  Ownership();  // with the existing domains
  // nullptr if no clock domain exists. CheckFailed if the rules give several domains, or none.
  const ClockDomain* of(const sc_core::sc_object& object) const;
  // The same, but nullptr if no rule applies.
  const ClockDomain* find(const sc_core::sc_object& object) const;
  // By rule 1 only, for this object itself.
  const ClockDomain* given(const sc_core::sc_object& object) const;

 private:
  const ClockDomain* around(const sc_core::sc_object* object) const;
  bool stands_in_unit(const sc_core::sc_object& object) const;

  std::vector<const ClockDomain*> domains_;
};

// Visits every object of a type that belongs to a domain: for_each_of<LinkBase>(clock, ...).
template <class T, class F>
void for_each_of(const ClockDomain& clock, F&& visit) {
  const Ownership ownership;
  for_each<T>([&](T& object) {
    if (ownership.of(dynamic_cast<const sc_core::sc_object&>(object)) == &clock) visit(object);
  });
}

// For observers of a domain: CheckFailed if the object belongs to another domain.
void check_owned(const ClockDomain& clock, const sc_core::sc_object& object);

}  // namespace deburr::rtl
