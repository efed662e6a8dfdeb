// SPDX-License-Identifier: MIT
// A clock domain: generates the rising edge and ticks its units in a fixed order, in a single
// SystemC process.
//
// Edge c is at time c x period. Whatever other processes do at that time, in the same delta cycle,
// counts as before the edge.
//
// Running on: while no other process has an event pending up to and including the next edge, the
// domain evaluates further cycles in the same activation. This is unobservable if units keep two
// rules: they never call sc_time_stamp() (use time_of(cycle)), which is not checked; and they
// notify events and call TLM targets with the domain's offset added (notify(), offset()), which is
// checked. The domain asks the kernel again only after such a call and every kBlock cycles. It must
// know where sc_start() will end, so it runs on only inside run(), run_until() and run_free(); a
// bare sc_start() gives the same results cycle by cycle.
//
// A domain that follows a clock of the platform (ClockInput) has its edges where that clock rises,
// each an activation of its own; it runs in a bare sc_start() or run_free().
//
// Edges of several domains at the same time are evaluated in the order of the module hierarchy; at
// the top level, in the order of construction.
#pragma once

#include <cstdint>
#include <exception>
#include <functional>
#include <optional>
#include <systemc>
#include <utility>
#include <vector>

#include "rtl_model/fabric/clocked.h"
#include "rtl_model/fabric/link.h"

namespace deburr::rtl {

class Ownership;
class Unit;
class WireBase;

class ClockDomain final : public sc_core::sc_module {
 public:
  ClockDomain(const sc_core::sc_module_name& name, const sc_core::sc_time& period);
  const char* kind() const override { return "deburr_clock_domain"; }

  // --- Building. Units are evaluated in the order of addition. ---
  void add(Unit& unit);               // done by Unit's constructor
  void add(Clocked& clocked);         // something clocked that is not a Unit
  void add_before(Clocked& clocked);  // ticked before all units (stalls, faults)
  void add_after(Clocked& clocked);   // ticked after all units (checkers, traces)
  void add(LinkBase& link);           // only a link that is not bound to a unit's port
  // Assigns the object and everything below it to this domain, except units of other domains and
  // their parts. For a module that is not a Unit, and for a memory, counter or histogram outside
  // all units (rules: ownership.h). Modules added above are adopted automatically.
  void adopt(const sc_core::sc_object& object);

  // Another implementation does the work of the unit from now on, at the unit's ports, and updates
  // the counters in `counted`. The unit is neither ticked nor reset; its links and counters are
  // reset as before. Call before the first edge.
  void replace(Unit& unit, std::vector<const class Counter*> counted = {});

  // Adds an action for edges in reset (registers, which are not units).
  void on_reset(std::function<void()> action) { on_reset_.push_back(std::move(action)); }

  // --- Options, before or between runs ---
  void set_fast_path(bool on) { fast_path_ = on; }
  // Evaluates the units in a new random order each cycle; nullopt: in the order of addition. Units
  // joined by combinational wires keep their order among themselves.
  void shuffle(std::optional<std::uint64_t> seed);
  // Makes every edge an activation of its own (traces).
  void require_cycle_by_cycle() { cycle_by_cycle_ = true; }
  // Active low. While false, every edge resets instead of ticking.
  void set_reset_n(bool reset_n) {
    reset_n_ = reset_n;
    block_end_ = 0;
  }

  // --- A clock of the platform (ClockInput) ---
  // Call before the first edge: edge c is the rise number c. The period remains that of reports and
  // of memory timing in cycles.
  void follow();
  bool follows() const { return follows_; }
  // The clock rises now: the edge is evaluated at this time, after all other processes.
  void rise();

  // --- Running ---
  void run(Cycle cycles);
  // Returns true once `done` is true after an edge, false after `limit` cycles.
  bool run_until(const std::function<bool()>& done, Cycle limit);
  // Runs until request_stop() is called.
  void run_free();
  // Ends run_free(), run() or run_until() after the cycle that is being evaluated.
  void request_stop() {
    stop_requested_ = true;
    block_end_ = 0;
  }

  // --- Time ---
  const sc_core::sc_time& period() const { return period_; }
  Cycle cycle() const { return cycle_; }  // inside tick: the current edge; outside: the next one
  Cycle cycles_since_reset() const { return cycle_ - reset_cycle_; }
  // Of a domain that follows a clock only of the latest edge.
  sc_core::sc_time time_of(Cycle cycle) const;
  // Offset of the edge being evaluated from sc_time_stamp(). For a call into SystemC made
  // immediately after: the domain then checks for events that the call caused.
  sc_core::sc_time offset();
  // Notifies an event `delay` after the edge being evaluated (in the next delta cycle if zero).
  void notify(sc_core::sc_event& event, const sc_core::sc_time& delay = sc_core::SC_ZERO_TIME);
  // Notified at every edge after the units were ticked. Using it disables running on.
  const sc_core::sc_event& edge();

  const std::vector<Unit*>& units() const { return units_; }
  const std::vector<LinkBase*>& links() const { return links_; }  // complete after elaboration
  const std::vector<WireBase*>& wires() const { return wires_; }  // complete after elaboration
  std::uint64_t activations() const { return activations_; }      // tells if it runs on

  // Checks busy + stalled + idle = cycles for every unit; run() and run_until() call it at their
  // end.
  void check_accounting() const;

 private:
  friend Ownership;
  struct Slot {
    Clocked* clocked;
    std::uint64_t* activity;  // kActivities counters
  };
  enum class Phase { kEdge, kStop };  // what the next activation is for
  SC_HAS_PROCESS(ClockDomain);
  void end_of_elaboration() override;
  void collect(sc_core::sc_object& object);
  void activate();
  template <class Action>
  bool attempt(const Action& action);
  bool is_due() const;
  void hand_on();
  void adopt_module(const Clocked& clocked);
  bool stops_now() const;
  void find_domains();
  void rethrow_failure() const;
  void check_generates() const;
  [[gnu::always_inline]] void evaluate_edge();
  void evaluate();
  void evaluate_block();
  void reset_all();
  bool may_run_on();
  void start(Cycle end, std::uint64_t horizon);
  void reorder();
  void keep_order(const std::vector<const Clocked*>& members);
  void claim(LinkBase& link);
  void claim(WireBase& wire);
  void join_combinational();

  sc_core::sc_time period_;
  std::uint64_t period_value_;
  std::vector<Slot> slots_, unshuffled_;
  std::vector<Clocked*> before_, after_;
  std::vector<Unit*> units_;
  std::vector<LinkBase*> links_;
  std::vector<WireBase*> wires_;
  // Groups of units that combinational wires join, each in the order of addition.
  std::vector<std::vector<const Clocked*>> joined_;
  std::vector<class MemoryBase*> memories_;
  std::vector<class Counter*> counters_;
  std::vector<class Histogram*> histograms_;
  std::vector<std::function<void()>> on_reset_;
  std::vector<const sc_core::sc_object*> adopted_;
  std::vector<ClockDomain*> domains_;  // all domains of the simulation, including this one
  std::uint64_t ignored_[kActivities] = {};

  static constexpr Cycle kBlock = 256;
  Cycle cycle_ = 0, block_start_ = 0, reset_cycle_ = 0;
  Cycle block_end_ = 0;  // edges before this one may be evaluated without asking the kernel
  Cycle horizon_ = 0;    // the current run certainly reaches edges before this one
  std::uint64_t activations_ = 0;
  std::uint64_t shuffle_state_ = 0;
  Phase phase_ = Phase::kEdge;
  bool shuffled_ = false, fast_path_ = true, cycle_by_cycle_ = false, reset_n_ = true;
  bool deferred_ = false, stop_requested_ = false, in_run_ = false, evaluating_ = false;
  bool observed_ = false, follows_ = false, risen_ = false;
  sc_core::sc_time rise_time_;                    // of the latest edge of the clock that it follows
  std::uint64_t stopped_in_ = ~std::uint64_t{0};  // delta cycle of the last stop
  const std::function<bool()>* done_ = nullptr;
  bool done_reached_ = false;
  sc_core::sc_event edge_{"edge"}, turn_{"turn"};  // turn_: evaluates an edge at this time
  sc_core::sc_event rise_{"rise"};
  std::exception_ptr failure_;
};

}  // namespace deburr::rtl
