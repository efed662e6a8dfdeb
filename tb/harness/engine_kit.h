// SPDX-License-Identifier: MIT
// A Kit is the interface through which the shared test suites build an engine, give it work and
// collect the outcome. Each engine declares a Kit; register_suites<Kit>()
// (tb/unit/rtl/engine_suites.h) instantiates the suites for it: reset_suite.h, register_suite.h,
// stress_suite.h, register_noise.h, tb/unit/rtl/token_suite.h.
//
//   class Kit : public EngineKit {           // EngineKit has defaults of optional members
//    public:
//     struct Build;                          // one build configuration, a literal type
//     static const std::array<Build, N> kBuilds;
//     static std::string text_of(const Build&);
//     explicit Kit(const Build&, const Disturbance& = {});  // new, not yet reset
//     explicit Kit(Random&);                 // random build, for register noise
//     rtl::ClockDomain& clock();
//     platform::RegisterHost& bus();
//     rtl::Engine& engine();
//     rtl::RegisterSection section() const;  // with the reset values of the build
//     Bench& bench();
//     void start(Job);                       // after a reset or a finished job
//     bool done();                           // all output has been delivered
//     Outcome outcome();                     // of the last job
//     void expect_enough(Job);               // checks that the job met its purpose
//     void reset(rtl::Cycle cycles);
//     // Sets every sticky bit and makes every counter non-zero. kKept: registers that the
//     // suite must not invert afterwards.
//     void spoil();
//     static constexpr std::array kKept;
//     // Register noise: number of accesses, most cycles between two of them, largest offset;
//     // disturb() runs after each access: input data, starts.
//     static constexpr int kAccesses;
//     static constexpr std::uint32_t kCycles, kMostOffset;
//     static constexpr std::uint64_t kNoiseSeeds;
//     void disturb(Random&);
//     // token_suite.h: tokens of internal links, least number of fields with a number format,
//     // header with the pipeline figure, builds that the pages show.
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

// The outcome of a kWhole job is compared; a kBroken job is longer and is interrupted by resets.
enum class Job { kWhole, kBroken };

// Disturbances that the bench applies to the engine.
struct Disturbance {
  BenchOptions bench = {};
  std::uint32_t scatter = 0;  // memory answers up to this many cycles late
  // True: the engine is built with a different configuration (other_configuration.h) and the driver
  // writes the wanted one after each reset. False: the wanted configuration is the reset value.
  bool program = false;
  sc_core::sc_time period = unit_bench::period();
};

// Defaults of optional members of a Kit.
struct EngineKit {
  // Whether the configuration is held in registers, written if Disturbance::program is set.
  static constexpr bool kPrograms = false;
  // Register offsets in addition to those in the engine's table.
  static std::vector<std::uint32_t> more_registers() { return {}; }
  // Distance of the cycles in which resets are tried. After a long reset no memory response is
  // pending.
  static constexpr rtl::Cycle kStep = 1;
  static constexpr rtl::Cycle short_reset() { return 1; }
  static constexpr rtl::Cycle long_reset() { return 1; }
  // Number of kinds of jobs that the engine must reject. The function starts a job of one kind,
  // runs it and checks that it is rejected.
  static constexpr int kRejected = 0;
  void reject(int /*kind*/, rtl::Cycle /*cycles*/) {}
  // Announces the next jobs, so that their input may already wait at the engine.
  void queue(std::span<const Job> /*jobs*/) {}
  // For register noise: a reset this long outlasts every memory request that noise may have caused.
  static constexpr rtl::Cycle kNoiseReset = 2000;
  void noise_begins() {}
  // Error found at the end of a noise run; empty: none.
  static std::string noise_ends() { return ""; }
  void restore() {}  // after a reset: reloads state that reset keeps and noise may have changed
  // The page with the tables of links, wires and memories; the page with the pipeline figure; and
  // the headers of the sub-units that the figure shows.
  static constexpr const char *kTables = "", *kFigure = "";
  static std::vector<std::string> below() { return {}; }
};

// A named list of words produced by a job; the name appears in a failed comparison.
class NamedWords {
 public:
  explicit NamedWords(std::string name) : name_(std::move(name)) {}
  template <class List>
  NamedWords(std::string name, const List& list) : name_(std::move(name)) {
    for (const auto& item : list) add(item);
  }
  // Adds every field of a payload, an array or a number.
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
  // Number of words and a hash.
  std::string text() const;
  // Describes the first word that differs; empty if the lists are equal.
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

// Observations of a job, grouped by their dependence on timing and history.
struct Outcome {
  std::vector<NamedWords> data;  // independent of earlier jobs and of timing
  // The same after any reset: counts since the reset, cache behaviour.
  std::vector<NamedWords> counted;
  // Cycles from the start of the job; comparable only if no earlier state remains.
  std::vector<NamedWords> cycles;
};

enum class Compared { kData, kCounted, kAll };

// Describes the differences in all categories up to `what`; empty if there are none.
std::string difference(const Outcome& was, const Outcome& is, Compared what);
std::string text_of(const Outcome& outcome, Compared what);

template <class Kit>
std::vector<std::string> state_of(Kit& kit) {
  return engine_state(kit.engine(), kit.bus(), kit.more_registers());
}

// Runs a job from start to end.
template <class Kit>
Outcome run_job(Kit& kit, Job job) {
  kit.start(job);
  kit.bench().run([&] { return kit.done(); }, 200'000);
  return kit.outcome();
}

}  // namespace deburr::tb
