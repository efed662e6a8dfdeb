// SPDX-License-Identifier: MIT
// Reset tests for every build of an engine's Kit (engine_kit.h). After a reset the engine must
// behave like a new engine, to the bit and to the cycle, and every register, counter, histogram and
// cycle account must have its initial value. A job that follows another job must have the same
// outcome as on a new engine.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "tb/harness/engine_kit.h"

namespace deburr::tb {

template <class Kit>
class ResetSuite {
 public:
  explicit ResetSuite(const typename Kit::Build& build) : kit_(build) {}

  // Tries resets in half of the cycles: even ones or odd ones, as `half` (0 or 1) says.
  void any_clock_of_a_job_may_be_the_last(rtl::Cycle half) {
    const Outcome fresh = first();
    kit_.expect_enough(Job::kWhole);
    kit_.reset(kit_.short_reset());
    const rtl::Cycle begin = kit_.clock().cycle();
    run_job(kit_, Job::kBroken);
    kit_.expect_enough(Job::kBroken);
    const rtl::Cycle last = kit_.clock().cycle() - begin;
    bool long_reset = true;
    for (rtl::Cycle tried = 0, at = 0; at < last; at = ++tried * Kit::kStep * kCyclesApart) {
      if (((tried + 1) / 2 + half) % 2 != 0) continue;
      SCOPED_TRACE("reset " + std::to_string(at) + " cycles into a job");
      kit_.reset(kit_.short_reset());
      kit_.start(Job::kBroken);
      kit_.clock().run(at);
      if (at > 0) {
        ASSERT_FALSE(kit_.done());
      }
      expect_as_fresh(fresh, long_reset);
      long_reset = !long_reset;
      if (::testing::Test::HasFatalFailure()) return;
    }
  }

  void a_rejected_job_may_be_the_last() {
    const Outcome fresh = first();
    for (int kind = 0; kind < Kit::kRejected; ++kind)
      for (const rtl::Cycle at : {0u, 1u, 2u, 3u, 9u, 20u}) {
        SCOPED_TRACE("reset " + std::to_string(at) + " cycles after a job of kind " +
                     std::to_string(kind));
        kit_.reset(kit_.short_reset());
        kit_.reject(kind, at);
        expect_as_fresh(fresh, true);
        if (::testing::Test::HasFatalFailure()) return;
      }
  }

  void a_job_after_another_is_what_it_is_by_itself() {
    const Outcome whole = first();
    kit_.reset(kit_.long_reset());
    const Outcome broken = run_job(kit_, Job::kBroken);
    kit_.reset(kit_.long_reset());
    constexpr std::array kJobs = {Job::kBroken, Job::kWhole, Job::kWhole, Job::kBroken};
    kit_.queue(kJobs);
    for (const Job job : kJobs) {
      kit_.start(job);
      ASSERT_TRUE(kit_.clock().run_until([&] { return kit_.done(); }, 200'000));
      EXPECT_EQ(difference(job == Job::kWhole ? whole : broken, kit_.outcome(), Compared::kData),
                "");
    }
  }

  void everything_reads_as_in_a_new_engine() {
    kit_.clock().run(5);
    const std::vector<std::string> fresh = state_of(kit_);
    spoil();
    EXPECT_NE(state_difference(fresh, state_of(kit_)), "")
        << "the jobs changed no state, so the test shows nothing";
    kit_.reset(kit_.long_reset());
    kit_.clock().run(5);
    EXPECT_EQ(state_difference(fresh, state_of(kit_)), "");
  }

  void the_next_job_is_that_of_a_new_engine() {
    const Outcome fresh = run_job(kit_, Job::kWhole);
    const std::vector<std::string> state = state_of(kit_);
    kit_.reset(kit_.long_reset());
    spoil();
    kit_.reset(kit_.long_reset());
    EXPECT_EQ(difference(fresh, run_job(kit_, Job::kWhole), Compared::kAll), "");
    EXPECT_EQ(state_difference(state, state_of(kit_)), "");
  }

 private:
  // A whole job after a reset, with the states before and after it.
  Outcome first() {
    kit_.reset(kit_.long_reset());
    at_reset_ = state_of(kit_);
    const Outcome fresh = run_job(kit_, Job::kWhole);
    EXPECT_FALSE(fresh.data.front().empty());
    after_ = state_of(kit_);
    return fresh;
  }
  void expect_as_fresh(const Outcome& fresh, bool long_reset) {
    kit_.reset(long_reset ? kit_.long_reset() : kit_.short_reset());
    ASSERT_TRUE(kit_.engine().idle());
    ASSERT_EQ(state_difference(at_reset_, state_of(kit_)), "");
    const Outcome again = run_job(kit_, Job::kWhole);
    // After a short reset, outstanding memory responses still occupy the data bus for a while.
    const bool all = long_reset || kit_.long_reset() == kit_.short_reset();
    ASSERT_EQ(difference(fresh, again, all ? Compared::kAll : Compared::kCounted), "");
    if (all) {
      ASSERT_EQ(state_difference(after_, state_of(kit_)), "");
    }
  }
  // Also writes another value to every writable register.
  void spoil() {
    kit_.spoil();
    for (const spec::RegisterInfo& info : kit_.engine().control.registers.table())
      if (info.written() != 0 &&
          std::find(Kit::kKept.begin(), Kit::kKept.end(), info.offset) == Kit::kKept.end())
        kit_.bus().write(info.offset, ~kit_.bus().read(info.offset));
  }

  Kit kit_;
  std::vector<std::string> at_reset_, after_;
};

}  // namespace deburr::tb
