// SPDX-License-Identifier: MIT
// Helpers for tests of a single unit: a Source and a Sink, which stall on request and record
// cycles; Ends, which combines both with their links; and checks of stall causes and of rejected
// memory accesses. For whole runs, driver.h has endpoints with random stalls.
//
//   unit_bench::Ends<Token, Result> ends(clock);   // source -> in -> [unit] -> out -> sink
//   halver.tokens_in(ends.in);
//   halver.halves_out(ends.out);
//   ends.source.add(token);
//   clock.run(10);
//   cycles_of(ends.sink);                          // cycles in which results were taken
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <systemc>
#include <vector>

#include "rtl_model/fabric/clock_domain.h"
#include "rtl_model/fabric/link.h"
#include "rtl_model/fabric/unit.h"
#include "spec/error.h"

namespace deburr::tb::unit_bench {

// Clock period for tests that measure cycles only.
inline sc_core::sc_time period() { return {10, sc_core::SC_NS}; }

// Pushes its tokens in order, each in the given cycle or, if there is no space then, as soon as
// there is.
template <class T>
class Source final : public rtl::Unit {
 public:
  rtl::Out<T> out{"out"};
  Source(const sc_core::sc_module_name& name, rtl::ClockDomain& clock) : Unit(name, clock) {}
  rtl::Activity tick(rtl::Cycle cycle) override {
    if (done() || tokens_[next_].from > cycle) return rtl::kIdle;
    if (!out.can_push(cycle)) return rtl::kStalledDownstream;
    out.push(cycle, tokens_[next_++].token);
    return rtl::kBusy;
  }
  void reset() override {
    tokens_.clear();
    next_ = 0;
  }
  void add(const T& token) { add(0, token); }
  void add(rtl::Cycle from, const T& token) { tokens_.push_back({from, token}); }
  // Sends token `index` and all later ones not before cycle `from`.
  void delay(std::size_t index, rtl::Cycle from) {
    for (; index < tokens_.size(); ++index) tokens_[index].from = from;
  }
  std::size_t sent() const { return next_; }
  bool done() const { return next_ == tokens_.size(); }

 private:
  struct Timed {
    rtl::Cycle from;
    T token;
  };
  std::vector<Timed> tokens_;
  std::size_t next_ = 0;
};

// Takes every token at once, unless it is told to wait, and records the first cycle in which it
// could have taken the token.
template <class T>
class Sink final : public rtl::Unit {
 public:
  struct Taken {
    rtl::Cycle cycle;
    T token;
  };
  rtl::In<T> in{"in"};
  Sink(const sc_core::sc_module_name& name, rtl::ClockDomain& clock, rtl::Cycle opens = 0)
      : Unit(name, clock), hold_to(opens) {}
  rtl::Activity tick(rtl::Cycle cycle) override {
    if (!in.can_pop(cycle) || (cycle >= hold_from && cycle < hold_to)) return rtl::kIdle;
    taken.push_back({cycle, in.take(cycle)});
    return rtl::kBusy;
  }
  void reset() override { taken.clear(); }
  std::vector<Taken> taken;
  rtl::Cycle hold_from = 0, hold_to;  // takes nothing in [hold_from, hold_to)
};

template <class T>
std::vector<rtl::Cycle> cycles_of(const Sink<T>& sink) {
  std::vector<rtl::Cycle> cycles;
  for (const auto& taken : sink.taken) cycles.push_back(taken.cycle);
  return cycles;
}

template <class T>
std::vector<T> tokens_of(const Sink<T>& sink) {
  std::vector<T> tokens;
  for (const auto& taken : sink.taken) tokens.push_back(taken.token);
  return tokens;
}

// Cycles that a unit lost to a stall cause. Throws CheckFailed for an unknown name.
inline std::uint64_t stalls(const rtl::Unit& unit, std::string_view cause) {
  for (const rtl::Unit::StallCause& stall : unit.stalls())
    if (stall.name == cause) return stall.cycles;
  DEBURR_CHECK(false, std::string(unit.name()) + " has no cause " + std::string(cause));
  return 0;
}

// Error text of an access that a memory must reject.
template <class Access>
std::string rejection(Access&& access) {
  try {
    access();
  } catch (const spec::CheckFailed& failure) {
    return failure.what();
  }
  return "nothing";
}
// Ticks the unit a second time in the current cycle. This models a missing pipeline stage: a word
// is used one cycle too early.
inline std::string read_one_cycle_early(rtl::Unit& unit, const rtl::ClockDomain& clock) {
  return rejection([&] { unit.tick(clock.cycle() - 1); });
}

// A test's own unit between two links. The test binds its ports.
template <class From, class To>
struct Ends {
  explicit Ends(rtl::ClockDomain& clock, const std::string& name = "")
      : in((name + "in").c_str()),
        out((name + "out").c_str()),
        source((name + "source").c_str(), clock),
        sink((name + "sink").c_str(), clock) {
    source.out(in);
    sink.in(out);
  }
  rtl::Link<From> in;
  rtl::Link<To> out;
  Source<From> source;
  Sink<To> sink;
};

// Cycles from the first to the last output.
template <class From, class To>
rtl::Cycle spread(const Ends<From, To>& ends) {
  return ends.sink.taken.back().cycle - ends.sink.taken.front().cycle;
}

}  // namespace deburr::tb::unit_bench
