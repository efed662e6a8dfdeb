// SPDX-License-Identifier: MIT
#include "tb/base/interrupt.h"

#include <fcntl.h>
#include <termios.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>

namespace deburr::tb {
namespace {

// Global, because a signal handler can access nothing else.
volatile std::sig_atomic_t interrupt_requested = 0;

extern "C" void on_interrupt(int) { interrupt_requested = 1; }

// Redirects a descriptor whose terminal is gone to /dev/null, so that later output cannot fail.
void leave_terminal(int descriptor) {
  termios settings{};
  if (::tcgetattr(descriptor, &settings) == 0 || errno != EIO) return;
  const int nowhere = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
  if (nowhere < 0) return;
  ::dup2(nowhere, descriptor);
  ::close(nowhere);
}

// Calls only async-signal-safe functions (POSIX).
extern "C" void on_hangup(int) {
  const int before = errno;
  interrupt_requested = 1;
  leave_terminal(STDOUT_FILENO);
  leave_terminal(STDERR_FILENO);
  errno = before;
}

// On hangup both the shell and the kernel may send SIGHUP, so a second one is not a request to
// kill. An ignored SIGHUP (nohup) stays ignored.
void catch_hangups() {
  struct sigaction action {};
  if (sigaction(SIGHUP, nullptr, &action) == 0 && action.sa_handler == SIG_IGN) return;
  action = {};
  action.sa_handler = on_hangup;
  sigemptyset(&action.sa_mask);
  sigaction(SIGHUP, &action, nullptr);
}

}  // namespace

void let_full_files_fail() { std::signal(SIGXFSZ, SIG_IGN); }

void let_broken_pipes_fail() { std::signal(SIGPIPE, SIG_IGN); }

void catch_interrupts() {
  struct sigaction action {};
  action.sa_handler = on_interrupt;
  sigemptyset(&action.sa_mask);
  action.sa_flags = static_cast<int>(SA_RESETHAND);  // a second signal has its default effect
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  catch_hangups();
}

bool interrupted() { return interrupt_requested != 0; }

}  // namespace deburr::tb
