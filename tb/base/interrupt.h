// SPDX-License-Identifier: MIT
// Signals during a run. The first SIGINT (Ctrl-C) or SIGTERM requests a clean end; the second one
// kills. SIGHUP, sent when the terminal closes, always requests a clean end.
#pragma once

#include <exception>

namespace deburr::tb {

// Makes a write beyond a file size limit fail instead of killing the process.
void let_full_files_fail();
// Makes a write to a pipe without a reader fail instead of killing the process.
void let_broken_pipes_fail();
// Handles SIGINT, SIGTERM and SIGHUP, for commands that poll interrupted() while they work.
void catch_interrupts();
bool interrupted();

// Thrown when work was abandoned on request without a usable result.
struct Interrupted : std::exception {
  const char* what() const noexcept override { return "interrupted"; }
};

// Exit code of an interrupted run with a partial result (as shells report SIGINT).
inline constexpr int kInterruptedExit = 130;

}  // namespace deburr::tb
