// SPDX-License-Identifier: MIT
#include "tb/base/interrupt.h"

#include <csignal>

namespace deburr::tb {
namespace {

// The one piece of global state: a signal handler can reach nothing else.
volatile std::sig_atomic_t interrupt_requested = 0;

extern "C" void on_interrupt(int) { interrupt_requested = 1; }

}  // namespace

void let_full_files_fail() { std::signal(SIGXFSZ, SIG_IGN); }

void let_broken_pipes_fail() { std::signal(SIGPIPE, SIG_IGN); }

void catch_interrupts() {
  struct sigaction action {};
  action.sa_handler = on_interrupt;
  sigemptyset(&action.sa_mask);
  action.sa_flags = static_cast<int>(SA_RESETHAND);  // the second signal acts as if never caught
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

bool interrupted() { return interrupt_requested != 0; }

}  // namespace deburr::tb
