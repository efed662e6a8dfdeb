// SPDX-License-Identifier: MIT
// Clock and reset of a platform as the clock and reset of a domain.
//
//     rtl::ClockDomain clock("clock", sc_time(1, SC_NS));
//     rtl::ClockInput input("input", clock);
//     input.clock(platform_clock);      // sc_clock, or a signal that a divider or a gate drives
//     input.reset_n(platform_reset_n);
//
// Position  Between signals and a ClockDomain, which has its edges where `clock` rises: gated,
//           divided, shifted or of a changing period. A process that the same rise triggers and the
//           domain see each other's writes as ClockDomain says: the domain comes last.
// Reset     Active low, sampled at the rise: a value that is written at that time counts from the
//           next rise on, as for a flip-flop. ResetInput below is for a domain with a clock of its
//           own; there a value that is written at the time of an edge counts at this edge.
#pragma once

#include <systemc>

#include "rtl_model/fabric/clock_domain.h"

namespace deburr::rtl {

class ClockInput final : public sc_core::sc_module {
 public:
  sc_core::sc_in<bool> clock{"clock"};
  sc_core::sc_in<bool> reset_n{"reset_n"};

  ClockInput(const sc_core::sc_module_name& name, ClockDomain& domain)
      : sc_module(name), domain_(domain) {
    domain_.follow();
    SC_METHOD(rises);
    sensitive << clock.pos();
    dont_initialize();
  }

 private:
  SC_HAS_PROCESS(ClockInput);
  void rises() {
    domain_.set_reset_n(reset_n.read());
    domain_.rise();
  }

  ClockDomain& domain_;
};

class ResetInput final : public sc_core::sc_module {
 public:
  sc_core::sc_in<bool> reset_n{"reset_n"};

  ResetInput(const sc_core::sc_module_name& name, ClockDomain& domain)
      : sc_module(name), domain_(domain) {
    SC_METHOD(changes);
    sensitive << reset_n;
  }

 private:
  SC_HAS_PROCESS(ResetInput);
  void changes() { domain_.set_reset_n(reset_n.read()); }

  ClockDomain& domain_;
};

}  // namespace deburr::rtl
