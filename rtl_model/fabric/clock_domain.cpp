// SPDX-License-Identifier: MIT
#include "rtl_model/fabric/clock_domain.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <set>
#include <utility>

#include "rtl_model/fabric/counters.h"
#include "rtl_model/fabric/histogram.h"
#include "rtl_model/fabric/memory.h"
#include "rtl_model/fabric/ownership.h"
#include "rtl_model/fabric/unit.h"
#include "rtl_model/fabric/wire.h"

namespace deburr::rtl {
namespace {

// Objects besides units that the domain resets.
bool is_collected(const sc_core::sc_object& object) {
  return dynamic_cast<const LinkBase*>(&object) || dynamic_cast<const WireBase*>(&object) ||
         dynamic_cast<const MemoryBase*>(&object) || dynamic_cast<const Counter*>(&object) ||
         dynamic_cast<const Histogram*>(&object);
}

}  // namespace

ClockDomain::ClockDomain(const sc_core::sc_module_name& name, const sc_core::sc_time& period)
    : sc_module(name), period_(period), period_value_(period.value()) {
  DEBURR_CHECK(period_value_ > 0, fmt::format("{}: the period is zero", this->name()));
  SC_METHOD(activate);
}

void ClockDomain::add(Unit& unit) {
  units_.push_back(&unit);
  slots_.push_back({&unit, unit.activity_.data()});
}
void ClockDomain::add(Clocked& clocked) {
  adopt_module(clocked);
  slots_.push_back({&clocked, ignored_});
}
void ClockDomain::add_before(Clocked& clocked) {
  adopt_module(clocked);
  before_.push_back(&clocked);
}
void ClockDomain::add_after(Clocked& clocked) {
  adopt_module(clocked);
  after_.push_back(&clocked);
}
// A module that this domain ticks belongs to it.
void ClockDomain::adopt_module(const Clocked& clocked) {
  const auto* const object = dynamic_cast<const sc_core::sc_object*>(&clocked);
  if (object && !Ownership().given(*object)) adopt(*object);
}
void ClockDomain::add(LinkBase& link) {
  adopt(link);
  claim(link);
}
void ClockDomain::adopt(const sc_core::sc_object& object) {
  const Ownership ownership;
  const ClockDomain* const other = ownership.given(object);
  DEBURR_CHECK(!other || other == this,
               fmt::format("{} belongs to two clock domains ({} and {})", object.name(),
                           other ? other->name() : "", name()));
  if (!other) adopted_.push_back(&object);
}

void ClockDomain::replace(Unit& unit, std::vector<const Counter*> counted) {
  DEBURR_CHECK(cycle_ == 0 && !unit.replaced_,
               fmt::format("{} is replaced {}", unit.name(), cycle_ ? "in mid-run" : "twice"));
  unit.replaced_ = true;
  unit.counted_for_it_ = std::move(counted);
  std::erase_if(slots_, [&](const Slot& slot) { return slot.clocked == &unit; });
}

void ClockDomain::claim(LinkBase& link) {
  DEBURR_CHECK(link.clock_ == nullptr || link.clock_ == this,
               fmt::format("{} joins two clock domains ({} is one): a link has one clock",
                           link.name(), name()));
  if (link.clock_ == this) return;
  link.clock_ = this;
  links_.push_back(&link);
}

void ClockDomain::claim(WireBase& wire) {
  DEBURR_CHECK(wire.clock_ == nullptr || wire.clock_ == this,
               fmt::format("{} joins two clock domains ({} is one): a wire has one clock",
                           wire.name(), name()));
  if (wire.clock_ == this) return;
  wire.clock_ = this;
  wires_.push_back(&wire);
}

// A combinational wire is driven before it is read: the driver is added before its readers, and
// shuffling keeps that order. A driver that is not ticked (registers on a bus) drives between edges
// or when a unit reads it, and its value counts at once.
void ClockDomain::join_combinational() {
  std::vector<std::size_t> group(units_.size());  // lowest index of a unit joined to it
  std::iota(group.begin(), group.end(), std::size_t{0});
  const auto unit_of = [&](const std::string& port) -> std::optional<std::size_t> {
    const sc_core::sc_object* object = sc_core::sc_find_object(port.c_str());
    while (object && !dynamic_cast<const Unit*>(object)) object = object->get_parent_object();
    if (!object) return std::nullopt;
    const auto found = std::find(units_.begin(), units_.end(), object);
    DEBURR_CHECK(found != units_.end(),
                 fmt::format("{} does not belong to a unit of {}", port, name()));
    return static_cast<std::size_t>(found - units_.begin());
  };
  for (const WireBase* wire : wires_) {
    if (!wire->combinational() || wire->driver().empty()) continue;
    const std::optional<std::size_t> driver = unit_of(wire->driver());
    if (!driver) continue;
    for (const std::string& port : wire->readers()) {
      const std::optional<std::size_t> reader = unit_of(port);
      if (!reader) continue;
      DEBURR_CHECK(*driver < *reader,
                   fmt::format("{} is combinational, so {} must be ticked before {}: construct "
                               "it first",
                               wire->name(), units_[*driver]->name(), units_[*reader]->name()));
      const std::size_t from = std::max(group[*driver], group[*reader]),
                        to = std::min(group[*driver], group[*reader]);
      std::replace(group.begin(), group.end(), from, to);
    }
  }
  for (std::size_t first = 0; first < units_.size(); ++first) {
    std::vector<const Clocked*> members;
    for (std::size_t i = first; i < units_.size(); ++i)
      if (group[i] == first) members.push_back(units_[i]);
    if (members.size() > 1) joined_.push_back(std::move(members));
  }
}

void ClockDomain::end_of_elaboration() {
  find_domains();
  for_each<WirePortBase>([](const WirePortBase& port) {
    DEBURR_CHECK(port.bound(), fmt::format("{} is not bound to a wire", port.name()));
  });
  const Ownership ownership;
  std::set<sc_core::sc_object*> seen;  // units may nest
  const auto collect_own = [&](sc_core::sc_object& object) {
    if (!is_collected(object) || !seen.insert(&object).second) return;
    if (ownership.of(object) == this) collect(object);
  };
  // First the links and memories of units, in the order of the units.
  for (Unit* unit : units_) {
    unit->check_ports();
    walk(*unit, [&](sc_core::sc_object& object) {
      if (auto* port = dynamic_cast<PortBase*>(&object)) {
        if (port->link_base()) collect_own(*port->link_base());
      } else if (auto* wire_port = dynamic_cast<WirePortBase*>(&object)) {
        if (wire_port->wire_base()) collect_own(*wire_port->wire_base());
      } else {
        collect_own(object);
      }
    });
  }
  walk_all(collect_own);
  join_combinational();
}

void ClockDomain::collect(sc_core::sc_object& object) {
  if (auto* link = dynamic_cast<LinkBase*>(&object)) {
    claim(*link);
  } else if (auto* wire = dynamic_cast<WireBase*>(&object)) {
    claim(*wire);
  } else if (auto* memory = dynamic_cast<MemoryBase*>(&object)) {
    memory->check_ports();
    memories_.push_back(memory);
  } else if (auto* counter = dynamic_cast<Counter*>(&object)) {
    counters_.push_back(counter);
  } else if (auto* histogram = dynamic_cast<Histogram*>(&object)) {
    histograms_.push_back(histogram);
  }
}

void ClockDomain::shuffle(std::optional<std::uint64_t> seed) {
  if (shuffled_) slots_ = unshuffled_;
  shuffled_ = seed.has_value();
  if (!shuffled_) return;
  unshuffled_ = slots_;
  shuffle_state_ = (*seed * 0x9E3779B97F4A7C15) | 1;
}

void ClockDomain::reorder() {
  if (unshuffled_.size() != slots_.size()) unshuffled_ = slots_;  // units were added meanwhile
  for (std::size_t i = slots_.size(); i > 1; --i) {
    shuffle_state_ ^= shuffle_state_ << 13;
    shuffle_state_ ^= shuffle_state_ >> 7;
    shuffle_state_ ^= shuffle_state_ << 17;
    std::swap(slots_[i - 1], slots_[(shuffle_state_ >> 11) % i]);
  }
  for (const std::vector<const Clocked*>& members : joined_) keep_order(members);
}

// Restores the order of `members` within the slots that they occupy now.
void ClockDomain::keep_order(const std::vector<const Clocked*>& members) {
  std::vector<std::size_t> places;
  std::vector<Slot> in_order(members.size());
  for (std::size_t i = 0; i < slots_.size(); ++i) {
    const auto member = std::find(members.begin(), members.end(), slots_[i].clocked);
    if (member == members.end()) continue;
    places.push_back(i);
    in_order[static_cast<std::size_t>(member - members.begin())] = slots_[i];
  }
  // A replaced unit has no slot.
  std::erase_if(in_order, [](const Slot& slot) { return slot.clocked == nullptr; });
  for (std::size_t i = 0; i < places.size(); ++i) slots_[places[i]] = in_order[i];
}

void ClockDomain::follow() {
  DEBURR_CHECK(cycle_ == 0 && !follows_,
               fmt::format("{} follows a clock {}", name(), cycle_ ? "in mid-run" : "twice"));
  follows_ = cycle_by_cycle_ = true;
}

void ClockDomain::rise() {
  DEBURR_CHECK(
      follows_ && !risen_ && (cycle_ == 0 || rise_time_ != sc_core::sc_time_stamp()),
      fmt::format("{}: its clock rises twice at {}", name(), sc_core::sc_time_stamp().to_string()));
  risen_ = true;
  rise_time_ = sc_core::sc_time_stamp();
  rise_.notify(sc_core::SC_ZERO_TIME);
}

sc_core::sc_time ClockDomain::time_of(Cycle cycle) const {
  if (follows_) return rise_time_;
  return sc_core::sc_time::from_value(cycle * period_value_);
}

// A unit of another domain may call into this one: the offset is that of the calling domain's edge.
sc_core::sc_time ClockDomain::offset() {
  block_end_ = 0;
  for (ClockDomain* domain : domains_) {
    if (!domain->evaluating_) continue;
    domain->block_end_ = 0;
    if (domain->follows_) break;
    return domain->time_of(domain->cycle_ - domain->block_start_);
  }
  return sc_core::SC_ZERO_TIME;
}

void ClockDomain::notify(sc_core::sc_event& event, const sc_core::sc_time& delay) {
  event.notify(offset() + delay);
}

const sc_core::sc_event& ClockDomain::edge() {
  observed_ = true;
  return edge_;
}

// An activation at the time of an edge. Other processes of that time run first: whether the kernel
// calls them before or after this process depends on the length of the last block and must not
// matter.
void ClockDomain::activate() {
  using sc_core::SC_ZERO_TIME;
  if (!deferred_ &&
      sc_core::sc_pending_activity_at_current_time(sc_core::sc_get_curr_simcontext())) {
    deferred_ = true;
    next_trigger(SC_ZERO_TIME);
    return;
  }
  deferred_ = false;
  if (phase_ == Phase::kStop) {
    // Simulation time has caught up with the evaluated cycles: sc_start() may return here.
    phase_ = Phase::kEdge;
    stopped_in_ = sc_core::sc_delta_count();
    sc_core::sc_pause();
    next_trigger(SC_ZERO_TIME);
    return;
  }
  if (follows_ && !risen_) {
    next_trigger(rise_);
    return;
  }
  if (domains_.size() > 1) {
    if (stops_now()) {
      deferred_ = true;
      next_trigger(SC_ZERO_TIME);
      return;
    }
    for (const ClockDomain* domain : domains_) {
      if (domain == this) break;
      if (!domain->is_due()) continue;
      deferred_ = true;
      next_trigger(turn_);
      return;
    }
  }
  ++activations_;
  const bool good = attempt([this] {
    evaluate_edge();
    if (domains_.size() > 1) hand_on();  // before running on: others are still at this time
    while (may_run_on()) evaluate_block();
  });
  if (!good) return;
  if (observed_) edge_.notify(SC_ZERO_TIME);
  if (stop_requested_ || done_reached_) {
    stop_requested_ = false;
    phase_ = Phase::kStop;
  }
  if (!follows_)
    next_trigger(time_of(cycle_ - block_start_));
  else if (phase_ == Phase::kStop)
    next_trigger(SC_ZERO_TIME);
  else
    next_trigger(rise_);
}

// Returns false and ends the run after an error.
template <class Action>
bool ClockDomain::attempt(const Action& action) {
  evaluating_ = true;
  try {
    action();
  } catch (...) {
    evaluating_ = false;
    if (!in_run_) throw;  // the kernel turns it into a report
    failure_ = std::current_exception();
    sc_core::sc_pause();
    return false;
  }
  evaluating_ = false;
  return true;
}

// Edges of several domains at the same time take turns, since the order in which the kernel calls
// their processes depends on the length of their last blocks. Each process evaluates its own edge:
// SystemC identifies the driver of a signal by the process.
bool ClockDomain::is_due() const {
  return phase_ == Phase::kEdge && !failure_ &&
         (follows_ ? risen_ : sc_core::sc_time_stamp() == time_of(cycle_));
}

void ClockDomain::hand_on() {
  for (ClockDomain* domain : domains_)
    if (domain != this && domain->is_due()) return domain->turn_.notify();
}

// True if a domain ends the run at this time. Then no domain evaluates an edge of this time before
// the next run.
bool ClockDomain::stops_now() const {
  return std::any_of(domains_.begin(), domains_.end(), [](const ClockDomain* domain) {
    return domain->stopped_in_ == sc_core::sc_delta_count() ||
           (domain->phase_ == Phase::kStop &&
            sc_core::sc_time_stamp() == domain->time_of(domain->cycle_));
  });
}

inline void ClockDomain::evaluate_edge() {
  DEBURR_CHECK(sc_core::sc_time_stamp() == time_of(cycle_),
               fmt::format("{}: edge {} came at the wrong time", name(), cycle_));
  block_start_ = cycle_;
  block_end_ = 0;
  risen_ = false;
  evaluate();
}

void ClockDomain::evaluate() {
  const Cycle cycle = cycle_;
  if (!reset_n_) [[unlikely]] {
    reset_all();
    cycle_ = cycle + 1;
    reset_cycle_ = cycle_;
  } else {
    for (Clocked* clocked : before_) clocked->tick(cycle);
    if (shuffled_) [[unlikely]]
      reorder();
    for (const Slot& slot : slots_) ++slot.activity[slot.clocked->tick(cycle).code % kActivities];
    for (Clocked* clocked : after_) clocked->tick(cycle);
    cycle_ = cycle + 1;
  }
  if (done_ && (*done_)()) {
    done_reached_ = true;
    block_end_ = 0;
  }
}

// evaluate() up to the end of the block, without the cases that rarely occur. Whatever changes that
// (reset, stop, a call into SystemC) ends the block before the next cycle.
void ClockDomain::evaluate_block() {
  if (!reset_n_ || shuffled_ || !before_.empty()) {
    while (cycle_ < block_end_) evaluate();
    return;
  }
  Cycle cycle = cycle_;
  // declare_stall() keeps codes below kActivities.
  const auto tick = [&cycle](const Slot& slot) { ++slot.activity[slot.clocked->tick(cycle).code]; };
  const Slot* const begin = slots_.data();
  const Slot* const end = begin + slots_.size();
  const Slot* const end_of_fours = begin + slots_.size() / 4 * 4;
  do {
    const Slot* slot = begin;
    for (; slot != end_of_fours; slot += 4) {
      tick(slot[0]);
      tick(slot[1]);
      tick(slot[2]);
      tick(slot[3]);
    }
    for (; slot != end; ++slot) tick(*slot);
    for (Clocked* clocked : after_) clocked->tick(cycle);
    cycle_ = ++cycle;
    if (done_ && (*done_)()) {
      done_reached_ = true;
      return;
    }
  } while (cycle < block_end_);
}

// True if the next edge may be evaluated in this activation, which must be unobservable. Extends
// the end of the block to the latest safe cycle.
bool ClockDomain::may_run_on() {
  if (!fast_path_ || cycle_by_cycle_ || observed_ || stop_requested_ || done_reached_) return false;
  const std::uint64_t next = (cycle_ - block_start_) * period_value_;
  const std::uint64_t pending = sc_core::sc_time_to_pending_activity().value();
  DEBURR_CHECK(
      pending >= next - period_value_,
      fmt::format("{}: an event was notified in one of the cycles {}..{} without adding "
                  "the domain's offset, so its time is wrong: use ClockDomain::notify() or "
                  "offset(), or switch off the fast path",
                  name(), std::max(block_start_, cycle_ - std::min(cycle_, kBlock)), cycle_ - 1));
  if (pending <= next || cycle_ >= horizon_ ||
      sc_core::sc_get_curr_simcontext()->sim_status() != sc_core::SC_SIM_OK)
    return false;
  // Edges strictly before the next pending event and before the horizon.
  block_end_ =
      std::min({cycle_ + kBlock, block_start_ + (pending - 1) / period_value_ + 1, horizon_});
  return true;
}

void ClockDomain::reset_all() {
  for (const Slot& slot : slots_) slot.clocked->reset();
  for (Unit* unit : units_) unit->activity_.fill(0);
  for (LinkBase* link : links_) link->reset();
  for (WireBase* wire : wires_) wire->reset_at(cycle_);
  for (MemoryBase* memory : memories_) memory->reset();
  for (Counter* counter : counters_) counter->reset();
  for (Histogram* histogram : histograms_) histogram->reset();
  for (const std::function<void()>& action : on_reset_) action();
  for (Clocked* clocked : before_) clocked->reset();
  for (Clocked* clocked : after_) clocked->reset();
}

void ClockDomain::check_generates() const {
  DEBURR_CHECK(!follows_,
               fmt::format("{} follows a clock, so it cannot count its cycles in advance: call "
                           "sc_start() or run_free()",
                           name()));
}

void ClockDomain::run(Cycle cycles) {
  check_generates();
  if (cycles == 0) return;
  start(cycle_ + cycles, (cycle_ + cycles) * period_value_);
}

bool ClockDomain::run_until(const std::function<bool()>& done, Cycle limit) {
  check_generates();
  if (done()) return true;
  if (limit == 0) return false;
  done_ = &done;
  done_reached_ = false;
  try {
    start(cycle_ + limit, (cycle_ + limit) * period_value_);
  } catch (...) {
    done_ = nullptr;
    throw;
  }
  done_ = nullptr;
  return std::exchange(done_reached_, false);
}

void ClockDomain::run_free() { start(kNever, sc_core::sc_max_time().value()); }

// `horizon` promises all domains that sc_start() will not return earlier unless a domain requests
// it; so they may run on.
void ClockDomain::start(Cycle end, std::uint64_t horizon) {
  DEBURR_CHECK(!in_run_, fmt::format("{}: run() within run()", name()));
  find_domains();
  rethrow_failure();
  for (ClockDomain* domain : domains_) {
    domain->in_run_ = true;
    domain->horizon_ = (horizon - 1) / domain->period_value_ + 1;
  }
  const auto finish = [&] {
    for (ClockDomain* domain : domains_) {
      domain->in_run_ = false;
      domain->horizon_ = 0;
    }
  };
  try {
    if (end == kNever)
      sc_core::sc_start();
    else
      sc_core::sc_start(time_of(end) - sc_core::sc_time_stamp());
  } catch (const sc_core::sc_report& report) {
    finish();
    throw spec::SimulationError(report.what());
  } catch (...) {
    finish();
    throw;
  }
  finish();
  rethrow_failure();
  check_accounting();
}

void ClockDomain::find_domains() {
  if (domains_.empty()) for_each<ClockDomain>([&](ClockDomain& d) { domains_.push_back(&d); });
}

// An error in one domain ends the whole simulation.
void ClockDomain::rethrow_failure() const {
  for (const ClockDomain* domain : domains_)
    if (domain->failure_) std::rethrow_exception(domain->failure_);
}

void ClockDomain::check_accounting() const {
  for (const Unit* unit : units_) unit->check_accounting();
}

}  // namespace deburr::rtl
