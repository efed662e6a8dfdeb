// SPDX-License-Identifier: MIT
// A Kit: how the tests of an engine build it, give it work and see what comes of it. An engine
// declares one, and register_suites<Kit>() (tb/unit/rtl/engine_suites.h) gives its test program the
// suites over it: reset_suite.h, register_suite.h, stress_suite.h, register_noise.h,
// tb/unit/rtl/token_suite.h.
//
//   class Kit : public EngineKit {           // below: what it may leave out
//    public:
//     struct Build;                          // one kind of build, of constants alone
//     static const std::array<Build, N> kBuilds;
//     static std::string text_of(const Build&);
//     explicit Kit(const Build&, const Disturbance& = {});  // as new: without a reset
//     explicit Kit(Random&);                 // any build, for register noise
//     rtl::ClockDomain& clock();
//     platform::RegisterHost& bus();
//     rtl::Engine& engine();
//     rtl::RegisterSection section() const;  // with the reset values of the build
//     Bench& bench();
//     void start(Job);                       // after a reset, or after a job that is done
//     bool done();                           // all of it has come out
//     Outcome outcome();                     // of the last job
//     void expect_enough(Job);               // it has done what it is there for
//     void reset(rtl::Cycle cycles);
//     // What sticks is set, everything has counted; registers that are not to be inverted then.
//     void spoil();
//     static constexpr std::array kKept;
//     // Of register noise: accesses, cycles between two of them at most, offsets; what is done
//     // after one: work, starts, whatever comes in.
//     static constexpr int kAccesses;
//     static constexpr std::uint32_t kCycles, kMostOffset;
//     static constexpr std::uint64_t kNoiseSeeds;
//     void disturb(Random&);
//     // Tokens of the links inside; how many of their fields have a number format, at least; a
//     // header with a figure; builds that pages show (token_suite.h).
//     using Engine, Tokens = TokenList<...>;
//     static constexpr int kFormats;
//     static constexpr const char* kHeader;
//     static std::vector<Drawn<Parameters>> drawn_builds();
//   };
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "rtl_model/fabric/payload.h"
#include "tb/harness/bench.h"
#include "tb/harness/engine_state.h"
#include "tb/harness/unit_bench.h"

namespace deburr::tb {

// kWhole is compared; kBroken is longer, and is what resets break off.
enum class Job { kWhole, kBroken };

// What a bench has around the engine.
struct Disturbance {
  BenchOptions bench = {};
  std::uint32_t scatter = 0;  // answers of memory come up to so many cycles later
  // The driver writes the rules after each reset to an engine that is built with others
  // (other_configuration.h); else they are its reset values.
  bool program = false;
  sc_core::sc_time period = unit_bench::period();
};

// What a kit may leave out.
struct EngineKit {
  // Its rules are registers, which Disturbance::program writes.
  static constexpr bool kPrograms = false;
  // Offsets beside those of the engine's table.
  static std::vector<std::uint32_t> more_registers() { return {}; }
  // Between the cycles at which resets are tried; after a long reset memory owes nothing.
  static constexpr rtl::Cycle kStep = 1;
  static constexpr rtl::Cycle short_reset() { return 1; }
  static constexpr rtl::Cycle long_reset() { return 1; }
  // Kinds of jobs that the engine does not take; starts one, runs, expects what is to be seen.
  static constexpr int kRejected = 0;
  void reject(int /*kind*/, rtl::Cycle /*cycles*/) {}
  // These come: their input may wait in front.
  void queue(std::span<const Job> /*jobs*/) {}
  // Of register noise; memory has answered all that garbage asked after kNoiseReset.
  static constexpr rtl::Cycle kNoiseReset = 2000;
  void noise_begins() {}
  static std::string noise_ends() { return ""; }  // what is wrong by now
  void restore() {}  // after a reset: what it leaves as the noise has loaded it
  // The page with tables of links, wires and memories; the page with the figure, and the headers
  // of what it draws further in.
  static constexpr const char *kTables = "", *kFigure = "";
  static std::vector<std::string> below() { return {}; }
};

// A list of whatever a job leaves, under a name that a failed comparison says.
class NamedWords {
 public:
  explicit NamedWords(std::string name) : name_(std::move(name)) {}
  template <class List>
  NamedWords(std::string name, const List& list) : name_(std::move(name)) {
    for (const auto& item : list) add(item);
  }
  // Every field of a payload, an array, a number.
  template <class T>
  void add(const T& value) {
    if constexpr (rtl::HasFields<T>) {
      Visit visit{*this};
      T::fields(value, visit);
    } else if constexpr (requires { value.begin(); }) {
      for (const auto& item : value) add(item);
    } else {
      words_.push_back(static_cast<std::uint64_t>(value));
    }
  }
  bool empty() const { return words_.empty(); }
  // How many, and a hash.
  std::string text() const;
  // The first one that differs; empty if none does.
  static std::string difference(const NamedWords& was, const NamedWords& is);
  friend bool operator==(const NamedWords&, const NamedWords&) = default;

 private:
  struct Visit {
    NamedWords& words;
    template <class M, class... Rest>
    void operator()(std::string_view, const M& member, const Rest&...) {
      words.add(member);
    }
    template <class M, class... Rest>
    void lanes(std::string_view, const M& member, const Rest&...) {
      words.add(member);
    }
    template <class M>
    void lane_bits(std::string_view, const M& member, std::uint32_t) {
      words.add(member);
    }
  };
  std::string name_;
  std::vector<std::uint64_t> words_;
};

// What came of a job.
struct Outcome {
  std::vector<NamedWords> data;     // whatever was before it, and however slow things were
  std::vector<NamedWords> counted;  // the same after any reset: sums since then, and what caches do
  std::vector<NamedWords> cycles;   // when, from its start on, with nothing left of before
};

enum class Compared { kData, kCounted, kAll };

// What differs up to there; empty if nothing does.
std::string difference(const Outcome& was, const Outcome& is, Compared what);
std::string text_of(const Outcome& outcome, Compared what);

template <class Kit>
std::vector<std::string> state_of(Kit& kit) {
  return engine_state(kit.engine(), kit.bus(), kit.more_registers());
}

// A job from its start to its end.
template <class Kit>
Outcome run_job(Kit& kit, Job job) {
  kit.start(job);
  kit.bench().run([&] { return kit.done(); }, 200'000);
  return kit.outcome();
}

}  // namespace deburr::tb
