// SPDX-License-Identifier: MIT
// Engines in separate clock domains of one simulation: actions on one engine change neither the
// results nor the cycles and counters of the others.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "tb/harness/in_child.h"
#include "tb/harness/interval_recorder.h"
#include "tb/harness/statistics.h"
#include "tb/unit/rtl/geometric/kit.h"
#include "tb/unit/rtl/morphological/kit.h"
#include "tb/unit/rtl/texture/kit.h"

namespace deburr::tb::engine_domains_test {
namespace {

using rtl::Cycle;

// Periods without a common divisor, so that every phase of one clock meets every phase of another.
sc_core::sc_time ps(std::uint64_t n) { return sc_core::sc_time::from_value(n); }
const std::vector<std::uint64_t> kPeriods = {7001, 9973, 11003};
// Cycles from each engine's start; long enough for its job.
constexpr Cycle kCycles = 6000;

// An engine with its own clock and its kit's environment in one module, so that its parts have the
// same names whatever else exists.
class Placed : public sc_core::sc_module {
 public:
  explicit Placed(const sc_core::sc_module_name& name) : sc_module(name) {}
  virtual rtl::ClockDomain& clock() = 0;
  virtual rtl::Engine& engine() = 0;
  virtual void start(Job job) = 0;
  virtual bool done() = 0;
  virtual void reset() = 0;
  // Beats, cycles, counters, registers, cycle accounts.
  virtual std::string seen() = 0;

  // Runs to cycle kCycles of its job.
  void finish() {
    ASSERT_LE(clock().cycle() - begin_, kCycles);
    clock().run(kCycles - (clock().cycle() - begin_));
    EXPECT_TRUE(done()) << name();
  }
  bool in_mid_job(Cycle more) { return !done() && clock().cycle() - begin_ + more < kCycles; }

 protected:
  Cycle begin_ = 0;
};

template <class Kit>
class PlacedKit final : public Placed {
 public:
  PlacedKit(const sc_core::sc_module_name& name, const typename Kit::Build& build,
            const Disturbance& disturbance)
      : Placed(name), kit_(build, disturbance) {}
  rtl::ClockDomain& clock() override { return kit_.clock(); }
  rtl::Engine& engine() override { return kit_.engine(); }
  void start(Job job) override {
    kit_.start(job);
    begin_ = clock().cycle();
  }
  bool done() override { return kit_.done(); }
  void reset() override { kit_.reset(kit_.long_reset()); }
  std::string seen() override {
    std::string text = text_of(kit_.outcome(), Compared::kAll);
    for (const std::string& line : state_of(kit_)) text += line + "\n";
    return text + statistics(clock()).dump();
  }

 private:
  Kit kit_;
};

enum Engine { kTexture, kMorphological, kGeometric };
constexpr std::array kEngines = {kTexture, kMorphological, kGeometric};
constexpr std::array kNames = {"texture", "morphological", "geometric"};

std::unique_ptr<Placed> place(Engine engine, const char* name, Disturbance disturbance) {
  if (engine == kTexture)
    return std::make_unique<PlacedKit<texture_rtl::Kit>>(name, texture_rtl::Kit::kBuilds[3],
                                                         disturbance);
  if (engine == kGeometric)
    return std::make_unique<PlacedKit<geometric_rtl::Kit>>(name, geometric_rtl::Kit::kBuilds[0],
                                                           disturbance);
  constexpr morphological_rtl::Kit::Build kBuild = {
      .lanes_code = 1,
      .storage = spec::morphological::Storage::kMemory,
      .divider_interval = 1,
      .width = 29,
      .memory_latency = 20};
  return std::make_unique<PlacedKit<morphological_rtl::Kit>>(name, kBuild, disturbance);
}

Disturbance at_period(std::uint64_t period) {
  Disturbance disturbance;
  disturbance.period = ps(period);
  return disturbance;
}
// Everything that a bench can attach to an engine and that a reset restarts.
Disturbance disturbed(std::uint64_t period) {
  Disturbance disturbance = at_period(period);
  disturbance.bench.stall_permille = 100;
  disturbance.bench.shuffle = 3;
  disturbance.bench.check_widths = disturbance.bench.poison = true;
  return disturbance;
}

std::string alone(Engine engine, const Disturbance& disturbance) {
  return in_child([&] {
    const auto placed = place(engine, "watched", disturbance);
    placed->start(Job::kWhole);
    placed->finish();
    return placed->seen();
  });
}

// Starts several jobs that a reset aborts while another engine works; returns their number.
int break_off(Placed& broken, Placed& working) {
  constexpr Cycle kStep = 61,
                  kLongest = 400;  // in its own cycles; in the other engine's, including the reset
  int resets = 0;
  for (; working.in_mid_job(kLongest); ++resets) {
    broken.start(Job::kBroken);
    broken.clock().run(kStep + static_cast<Cycle>(7 * (resets % 5)));
    EXPECT_FALSE(broken.done()) << "is in mid-job";
    broken.reset();
  }
  return resets;
}

void expect_seen(const std::string& together, const std::string& alone, const std::string& who) {
  EXPECT_GT(alone.size(), 1000U) << alone;
  EXPECT_FALSE(alone.starts_with("exception")) << alone;
  EXPECT_TRUE(together == alone) << who << "\n" << together.substr(0, 2000);
}

class Pair : public testing::TestWithParam<std::tuple<Engine, Engine>> {};

// In one simulation: a job of the watched engine, during which the other one is reset repeatedly,
// and then a job of the other one.
void expect_unchanged_by_resets(Engine watched, Engine reset,
                                Disturbance (*around)(std::uint64_t period)) {
  for (const auto& [period, other] : {std::pair{0, 2}, {2, 1}}) {
    const Disturbance mine = around(kPeriods[static_cast<std::size_t>(period)]);
    const Disturbance its = around(kPeriods[static_cast<std::size_t>(other)]);
    const std::string expected = alone(watched, mine);
    const std::string next = in_child([&] {
      const auto placed = place(reset, "reset", its);
      placed->reset();
      placed->start(Job::kWhole);
      placed->finish();
      return placed->seen();
    });
    const std::string together = in_child([&] {
      const auto first = place(watched, "watched", mine);
      const auto second = place(reset, "reset", its);
      first->start(Job::kWhole);
      const int resets = break_off(*second, *first);
      if (resets < 2) return fmt::format("only {} resets", resets);
      first->finish();
      if (first->seen() != expected) return first->seen();
      second->reset();
      second->start(Job::kWhole);
      second->finish();
      return second->seen();
    });
    expect_seen(together, next,
                fmt::format("{} or, after resets, {}", kNames[watched], kNames[reset]));
  }
}

TEST_P(Pair, ResetOfOneDuringJobLeavesOtherUnchanged) {
  expect_unchanged_by_resets(std::get<0>(GetParam()), std::get<1>(GetParam()), at_period);
}

// Stalls, noise in free slots and checks act on one clock domain only.
TEST_P(Pair, BenchOfOneLeavesOtherUnchanged) {
  expect_unchanged_by_resets(std::get<0>(GetParam()), std::get<1>(GetParam()), disturbed);
}

INSTANTIATE_TEST_SUITE_P(Engines, Pair,
                         testing::Combine(testing::ValuesIn(kEngines), testing::ValuesIn(kEngines)),
                         [](const auto& pair) {
                           return std::string(kNames[std::get<0>(pair.param)]) + "_" +
                                  kNames[std::get<1>(pair.param)];
                         });

// ---- Three domains with drifting phases --------------------------------------------------------

// All three, constructed in the order of their periods.
struct Three {
  explicit Three(bool fast_path) {
    for (std::size_t i = 0; i < kEngines.size(); ++i) {
      Disturbance disturbance = at_period(kPeriods[i]);
      disturbance.bench.fast_path = fast_path;
      engines.push_back(place(kEngines[i], kNames[i], disturbance));
    }
  }
  std::vector<std::unique_ptr<Placed>> engines;
};

std::vector<std::string> three_alone() {
  std::vector<std::string> seen;
  for (std::size_t i = 0; i < kEngines.size(); ++i)
    seen.push_back(in_child([&] {
      const auto placed = place(kEngines[i], kNames[i], at_period(kPeriods[i]));
      placed->start(Job::kWhole);
      placed->finish();
      return placed->seen();
    }));
  return seen;
}

TEST(ThreeDomains, WorkTogetherAsEachAlone) {
  const std::vector<std::string> expected = three_alone();
  for (const bool fast : {true, false})
    for (std::size_t i = 0; i < kEngines.size(); ++i)
      expect_seen(in_child([&] {
                    const Three three(fast);
                    for (const auto& engine : three.engines) engine->start(Job::kWhole);
                    // The others continue.
                    for (std::size_t before = 0; before < i; ++before)
                      three.engines[before]->clock().run(1);
                    three.engines[i]->finish();
                    return three.engines[i]->seen();
                  }),
                  expected[i], kNames[i]);
}

TEST(ThreeDomains, ResetsOfTwoLeaveThirdUnchanged) {
  const std::vector<std::string> expected = three_alone();
  for (const bool fast : {true, false})
    for (std::size_t i = 0; i < kEngines.size(); ++i)
      expect_seen(in_child([&] {
                    const Three three(fast);
                    Placed& working = *three.engines[i];
                    Placed &one = *three.engines[(i + 1) % 3], &two = *three.engines[(i + 2) % 3];
                    working.start(Job::kWhole);
                    int resets = 0;
                    while (working.in_mid_job(1000)) {
                      one.start(Job::kBroken);
                      two.clock().run(37);
                      two.start(Job::kBroken);
                      one.clock().run(53);
                      one.reset();
                      two.clock().run(11);
                      two.reset();
                      ++resets;
                    }
                    if (resets < 2) return fmt::format("only {} resets", resets);
                    working.finish();
                    return working.seen();
                  }),
                  expected[i], kNames[i]);
}

// ---- Faults, intervals, observers --------------------------------------------------------------

TEST(DomainFaults, FaultInOneDoesNotReachOther) {
  const Disturbance calm = disturbed(kPeriods[0]);
  Disturbance faulty = disturbed(kPeriods[1]);
  faulty.bench.check_links = false;  // they would stop it
  const std::string right = in_child([&] {
    const auto placed = place(kMorphological, "faulty", faulty);
    placed->start(Job::kWhole);
    placed->finish();
    return placed->seen();
  });
  const std::string expected = alone(kTexture, calm);
  faulty.bench.faults = {"flip:faulty.in:40:pixel.0.r.6"};
  const auto with_fault = [&](bool together) {
    return in_child([&] {
      const auto other = together ? place(kTexture, "watched", calm) : nullptr;
      const auto placed = place(kMorphological, "faulty", faulty);
      if (other) other->start(Job::kWhole);
      placed->start(Job::kWhole);
      if (other) {
        other->finish();
        if (other->seen() != expected) return "the other: " + other->seen();
      }
      placed->finish();
      return placed->seen();
    });
  };
  const std::string wrong = with_fault(false);
  EXPECT_NE(wrong, right);
  expect_seen(with_fault(true), wrong, "the faulty one");
}

// A fault acts in the cycles of its bench's domain.
TEST(DomainFaults, RejectsLinkOfOtherDomain) {
  const auto other = place(kTexture, "watched", at_period(kPeriods[0]));
  Disturbance disturbance = at_period(kPeriods[1]);
  disturbance.bench.faults = {"drop:watched.quads:3"};
  EXPECT_THAT(([&] { place(kMorphological, "faulty", disturbance); }),
              testing::ThrowsMessage<spec::ConfigError>(testing::HasSubstr(
                  "faulty.clock has no link named watched.quads; known:\n  faulty.in")));
}

void watch(IntervalRecorder& recorder, const Placed& placed) {
  for (const rtl::Unit* unit : const_cast<Placed&>(placed).engine().units()) {
    std::vector<std::string> activities;
    for (int i = 0; i < unit->activities(); ++i)
      activities.push_back(unit->activity_name({static_cast<std::size_t>(i)}));
    recorder.see(unit->basename(), *unit, activities);
  }
}

TEST(DomainIntervals, CountCyclesOfTheirOwnClock) {
  const auto windows = [](bool together) {
    return in_child([&] {
      const auto placed = place(kGeometric, "watched", at_period(kPeriods[0]));
      IntervalRecorder recorder(placed->clock(), {.cycles = 500, .lose = {}});
      watch(recorder, *placed);
      const auto other =
          together ? place(kMorphological, "reset", at_period(kPeriods[2])) : nullptr;
      placed->start(Job::kWhole);
      if (other && break_off(*other, *placed) < 2) return std::string("too few resets");
      placed->finish();
      recorder.finish();
      return recorder.json().dump();
    });
  };
  const std::string expected = windows(false);
  EXPECT_GT(expected.size(), 1000U);
  EXPECT_EQ(windows(true), expected);
}

TEST(DomainIntervals, RejectsUnitOfOtherDomain) {
  const auto one = place(kTexture, "one", at_period(kPeriods[0]));
  const auto two = place(kTexture, "two", at_period(kPeriods[1]));
  IntervalRecorder recorder(one->clock(), {.cycles = 500, .lose = {}});
  EXPECT_THAT(([&] { watch(recorder, *two); }),
              testing::ThrowsMessage<spec::CheckFailed>(testing::HasSubstr(
                  "belongs to two.clock, but is observed in the cycles of one.clock")));
}

TEST(DomainStatistics, IncludeOnlyPartsOfTheirDomain) {
  const auto one = place(kTexture, "one", at_period(kPeriods[0]));
  const auto two = place(kGeometric, "two", at_period(kPeriods[1]));
  const nlohmann::ordered_json json = statistics(two->clock());
  for (const char* kind : {"units", "counters", "histograms", "memories", "links", "wires"}) {
    EXPECT_FALSE(json[kind].empty()) << kind;
    for (const auto& [name, value] : json[kind].items())
      EXPECT_TRUE(name.starts_with("two.")) << kind << " " << name;
  }
}

// Beats of the other engine do not count as progress.
TEST(DomainWatchdog, DetectsDeadlockOfOneWhileOtherWorks) {
  const auto working = place(kGeometric, "working", at_period(kPeriods[0]));
  Disturbance disturbance = at_period(kPeriods[1]);
  disturbance.bench.patience = 400;
  disturbance.bench.faults = {"stuck_ready:stuck.in:100"};
  const auto stuck = place(kMorphological, "stuck", disturbance);
  working->start(Job::kWhole);
  stuck->start(Job::kWhole);
  EXPECT_THAT(([&] { working->clock().run(kCycles); }),
              testing::ThrowsMessage<spec::DeadlockError>(
                  testing::AllOf(testing::HasSubstr("stuck.clock: no link has moved a beat"),
                                 testing::Not(testing::HasSubstr("working.")))));
}

}  // namespace
}  // namespace deburr::tb::engine_domains_test
