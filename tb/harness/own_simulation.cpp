// SPDX-License-Identifier: MIT
// Linked into every test: each TEST of a process gets a simulation context of its own, where ctest
// starts a process for several of them (cmake/discover_tests.py) or a debugger runs a whole
// program. IEEE 1666 knows one elaboration a process; Debian's kernel makes a context where there
// is none.
#include <gtest/gtest.h>

#include <vector>

// As <sysc/kernel/sc_simcontext.h> declares them; null addresses in a program without SystemC.
namespace sc_core {
class sc_simcontext;
extern sc_simcontext* sc_curr_simcontext __attribute__((weak));
extern sc_simcontext* sc_default_global_context __attribute__((weak));
}  // namespace sc_core

namespace deburr::tb {
namespace {

class OwnSimulation : public testing::EmptyTestEventListener {
  void OnTestEnd(const testing::TestInfo& /*info*/) override {
    // Kept, with its processes and events, as at the end of a process: LeakSanitizer reports what
    // none holds. What SystemC keeps elsewhere lasts: counts and actions of reports, the mode of
    // sc_stop(), the last process made.
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
