// SPDX-License-Identifier: MIT
// Base class of every hardware unit: an sc_module with named link ports, ticked by its clock
// domain. Every cycle is accounted for exactly once.
//
//   class Halver final : public Unit {
//    public:
//     In<Token> tokens_in{"tokens_in"};
//     Out<Token> halves_out{"halves_out"};
//     Halver(const sc_core::sc_module_name& name, ClockDomain& clock) : Unit(name, clock) {}
//     Activity tick(Cycle cycle) override {
//       if (!tokens_in.can_pop(cycle)) return kIdle;
//       if (!halves_out.can_push(cycle)) return kStalledDownstream;
//       halves_out.push(cycle, halve(tokens_in.take(cycle)));
//       return kBusy;
//     }
//     void reset() override {}
//   };
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <systemc>
#include <vector>

#include "rtl_model/fabric/clock_domain.h"
#include "rtl_model/fabric/clocked.h"
#include "rtl_model/fabric/counters.h"
#include "rtl_model/fabric/histogram.h"
#include "rtl_model/fabric/link.h"

namespace deburr::rtl {

class Unit : public Clocked, public sc_core::sc_module {
 public:
  struct StallCause {
    std::string name, meaning;
    std::uint64_t cycles;
  };

  ~Unit() override;
  const char* kind() const override { return "deburr_unit"; }
  ClockDomain& clock() const { return clock_; }

  std::uint64_t idle_cycles() const { return activity_[kIdle.code]; }
  std::uint64_t busy_cycles() const { return activity_[kBusy.code]; }
  std::uint64_t stalled_cycles() const;
  std::uint64_t cycles_of(Activity activity) const { return activity_[activity.code]; }
  const std::array<std::uint64_t, kActivities>& counts() const { return activity_; }  // by code
  std::vector<StallCause> stalls() const;
  // "idle", "busy" or the name of the cause.
  const std::string& activity_name(Activity activity) const;
  int activities() const { return static_cast<int>(names_.size()); }

  // Another implementation does its work (ClockDomain::replace): it keeps no cycle account, and
  // only the counters that the replacement updates are valid.
  bool replaced() const { return replaced_; }
  const std::vector<const Counter*>& counted_for_it() const { return counted_for_it_; }

  // Checks busy + stalled + idle = cycles since reset.
  void check_accounting() const;
  // Checks that every port is bound; the domain calls it at the end of elaboration.
  void check_ports() const;

 protected:
  Unit(const sc_core::sc_module_name& name, ClockDomain& clock);
  // Declares a stall cause; call in the constructor. "downstream" is predefined.
  Activity declare_stall(const char* cause, const char* meaning);

 private:
  friend class ClockDomain;
  ClockDomain& clock_;
  std::array<std::uint64_t, kActivities> activity_{};
  std::vector<std::string> names_, meanings_;
  bool replaced_ = false;
  std::vector<const Counter*> counted_for_it_;
};

}  // namespace deburr::rtl
