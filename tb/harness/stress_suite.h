// SPDX-License-Identifier: MIT
// Checks that disturbances do not change a bit of the results, for every build of an engine's Kit
// (engine_kit.h). Disturbances are stalls on every link, late and reordered memory responses,
// another evaluation order, the fast path on or off, checkers on or off, noise in unwritten fields,
// and configuration by register writes instead of reset values. Each simulation runs in its own
// process.
#pragma once

#include <gtest/gtest.h>

#include <initializer_list>
#include <string>

#include "tb/harness/engine_kit.h"
#include "tb/harness/in_child.h"

namespace deburr::tb {

template <class Kit>
class StressSuite {
 public:
  explicit StressSuite(const typename Kit::Build& build) : build_(build) {}

  void stalls_cost_time_and_nothing_else() {
    const Seen quiet = see({});
    for (const std::uint32_t permille : {50u, 300u, 600u}) {
      const Seen slow = see(disturbed(permille, permille));
      EXPECT_EQ(slow.data, quiet.data) << permille;
      EXPECT_GT(slow.cycles, quiet.cycles) << permille;
    }
    Disturbance late;
    late.scatter = 90;
    EXPECT_EQ(see(late).data, quiet.data) << "answers of memory in any order";
  }

  void order_fast_path_checkers_and_noise_are_invisible() {
    for (const std::uint32_t permille : {0u, 200u}) {
      Disturbance calm = disturbed(permille, 3, false);
      if (permille != 0) calm.scatter = 40;  // memory also answers late and out of order
      const std::string quiet = see(calm).all;
      const auto expect_same = [&](const char* what, auto&& change) {
        Disturbance disturbance = calm;
        change(disturbance.bench);
        EXPECT_EQ(see(disturbance).all, quiet) << what << ", stalls in " << permille << " of 1000";
      };
      for (const std::uint64_t seed : {1u, 2u})
        expect_same("order", [&](BenchOptions& bench) { bench.shuffle = seed; });
      expect_same("fast path", [](BenchOptions& bench) { bench.fast_path = false; });
      expect_same("checkers", [](BenchOptions& bench) { bench.check_links = false; });
      expect_same("widths", [](BenchOptions& bench) { bench.check_widths = true; });
      expect_same("noise", [](BenchOptions& bench) { bench.poison = true; });
    }
  }

  void written_configuration_gives_the_same_run_as_reset_values() {
    for (const std::uint32_t permille : {0u, 200u}) {
      Disturbance disturbance = disturbed(permille, 7, permille != 0);
      const std::string built = see(disturbance).all;
      disturbance.program = true;
      EXPECT_EQ(see(disturbance).all, built) << "stalls in " << permille << " of 1000";
      disturbance.bench.fast_path = false;
      EXPECT_EQ(see(disturbance).all, built) << "fast path, stalls in " << permille << " of 1000";
    }
  }

  void the_same_seed_gives_the_same_cycles() {
    const std::string once = see(disturbed(150, 5)).all;
    EXPECT_EQ(see(disturbed(150, 5)).all, once);
    EXPECT_NE(see(disturbed(150, 6)).all, once);
  }

 private:
  struct Seen {
    std::string data, all;
    rtl::Cycle cycles = 0;
  };
  static Disturbance disturbed(std::uint32_t permille, std::uint64_t seed, bool all = true) {
    Disturbance disturbance;
    disturbance.bench.stall_permille = permille;
    disturbance.bench.seed = seed;
    disturbance.bench.poison = all;
    if (all) disturbance.bench.shuffle = seed;
    disturbance.scatter = all ? 40 : 0;
    return disturbance;
  }
  // Runs two jobs in sequence.
  Seen see(const Disturbance& disturbance) const {
    const std::string text = in_child([&] {
      Kit kit(build_, disturbance);
      kit.reset(4);
      std::string data, all;
      const rtl::Cycle begin = kit.clock().cycle();
      for (const Job job : {Job::kWhole, Job::kBroken}) {
        const Outcome outcome = run_job(kit, job);
        data += text_of(outcome, Compared::kData);
        all += text_of(outcome, Compared::kAll);
      }
      for (const std::string& line : state_of(kit)) all += line + "\n";
      return std::to_string(kit.clock().cycle() - begin) + "\n" + data + kEnd + all;
    });
    const std::size_t line = text.find('\n'), end = text.find(kEnd);
    if (end == std::string::npos) {
      ADD_FAILURE() << text;
      return {};
    }
    return {text.substr(line, end - line), text.substr(end), std::stoull(text)};
  }
  static constexpr const char* kEnd = "all of it\n";

  const typename Kit::Build& build_;
};

}  // namespace deburr::tb
