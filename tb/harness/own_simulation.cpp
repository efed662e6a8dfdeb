// SPDX-License-Identifier: MIT
// Linked into every test program: gives each TEST its own simulation context when several run in
// one process (cmake/discover_tests.py, or a debugger). IEEE 1666 allows one elaboration per
// process; Debian's kernel creates a new context if none exists.
#include <gtest/gtest.h>

#include <vector>

// As declared in <sysc/kernel/sc_simcontext.h>; null addresses in a program without SystemC.
namespace sc_core {
class sc_simcontext;
extern sc_simcontext* sc_curr_simcontext __attribute__((weak));
extern sc_simcontext* sc_default_global_context __attribute__((weak));
}  // namespace sc_core

namespace deburr::tb {
namespace {

class OwnSimulation : public testing::EmptyTestEventListener {
  void OnTestEnd(const testing::TestInfo& /*info*/) override {
    // Ended contexts are kept with their processes and events, as they are at process exit.
    // Otherwise LeakSanitizer would report them. Other SystemC state persists: counts and actions
    // of reports, the mode of sc_stop(), the last process created.
    static auto& ended = *new std::vector<sc_core::sc_simcontext*>;
    ended.push_back(sc_core::sc_curr_simcontext);
    sc_core::sc_curr_simcontext = nullptr;
    sc_core::sc_default_global_context = nullptr;
  }
};

[[maybe_unused]] const bool listens = [] {
  if (&sc_core::sc_curr_simcontext != nullptr && &sc_core::sc_default_global_context != nullptr)
    testing::UnitTest::GetInstance()->listeners().Append(new OwnSimulation);
  return true;
}();

}  // namespace
}  // namespace deburr::tb
