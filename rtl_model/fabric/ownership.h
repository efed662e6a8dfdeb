// SPDX-License-Identifier: MIT
// Which clock domain an object of the fabric belongs to: a link, wire, memory, counter, histogram,
// port or register block. The first of these rules that gives an answer:
//
//   1. the domain that it was given to: ClockDomain::adopt();
//   2. the domain of the units that hold its ports;
//   3. the domain of the innermost unit or adopted module around it (an Engine is adopted by the
//      domain that it is constructed with, and a module that is ticked by the one that ticks it);
//   4. the domain of the innermost module around it with units or clock domains in it, and
//      outside of all modules the only one with units, or where none has units the only one.
//      If there are several, that is an error.
//
// If rule 1, rule 2 and a unit around it give different domains, that is an error. An adopted
// module may hold parts of other domains.
// In a simulation of one domain everything belongs to it. Asked for outside of time: at the end of
// elaboration, and by observers as they are made.
#pragma once

#include <systemc>
#include <vector>

#include "rtl_model/fabric/clock_domain.h"
#include "rtl_model/fabric/counters.h"

namespace deburr::rtl {

class Ownership {
 public:
  Ownership();  // with the domains that exist now
  // nullptr: there is no clock domain. CheckFailed if the rules give two, or none.
  const ClockDomain* of(const sc_core::sc_object& object) const;
  // The same, but nullptr if the rules give none.
  const ClockDomain* find(const sc_core::sc_object& object) const;
  // By rule 1 alone, of this very object.
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

// For what watches a domain by its clock: CheckFailed if the object belongs to another one.
void check_owned(const ClockDomain& clock, const sc_core::sc_object& object);

}  // namespace deburr::rtl
