// SPDX-License-Identifier: MIT
// Each test of one process has its own simulation (tb/harness/own_simulation.cpp).
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>
#include <systemc>

namespace deburr::tb::own_simulation_test {
namespace {

struct Sleeper : sc_core::sc_module {
  SC_HAS_PROCESS(Sleeper);
  explicit Sleeper(const sc_core::sc_module_name& name) : sc_module(name) { SC_THREAD(sleep); }
  void sleep() {
    wait(3, sc_core::SC_NS);
    woken = true;
    wait();  // its thread still exists, as those of units
  }
  bool woken = false;
};

TEST(OwnSimulation, StartsWithoutStateOfOthers) {
  EXPECT_EQ(sc_core::sc_get_status(), sc_core::SC_ELABORATION);
  EXPECT_EQ(sc_core::sc_time_stamp(), sc_core::SC_ZERO_TIME);
  EXPECT_TRUE(sc_core::sc_get_top_level_objects().empty());
  Sleeper sleeper("sleeper");
  EXPECT_STREQ(sleeper.name(), "sleeper");
  sc_core::sc_start(5, sc_core::SC_NS);
  EXPECT_TRUE(sleeper.woken);
  EXPECT_EQ(sc_core::sc_time_stamp(), sc_core::sc_time(5, sc_core::SC_NS));
}

TEST(OwnSimulation, EachTestOfProcessHasItsOwn) {
  const std::string program = std::filesystem::read_symlink("/proc/self/exe");
  const std::string twice =
      "'" + program + "' --gtest_filter=OwnSimulation.Starts* --gtest_repeat=2 --gtest_brief=1";
  EXPECT_EQ(std::system(twice.c_str()), 0);
}

}  // namespace
}  // namespace deburr::tb::own_simulation_test
