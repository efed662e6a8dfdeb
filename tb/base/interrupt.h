// SPDX-License-Identifier: MIT
// Ctrl-C in a run: the first one asks for a clean end, the second one kills. So does SIGTERM; a
// terminal that is closed (SIGHUP) asks for a clean end, however often.
#pragma once

#include <exception>

namespace deburr::tb {

// Lets a write beyond a file size limit fail instead of killing.
void let_full_files_fail();
// Lets a write into a pipe that nobody reads fail instead of killing.
void let_broken_pipes_fail();
// Takes over SIGINT, SIGTERM and SIGHUP, for commands that ask interrupted() while they work.
void catch_interrupts();
bool interrupted();

// Thrown where work was given up because someone asked for it, and nothing of it is of use.
struct Interrupted : std::exception {
  const char* what() const noexcept override { return "interrupted"; }
};

// Exit code of a run that was interrupted but left its partial result (as a shell reports SIGINT).
inline constexpr int kInterruptedExit = 130;

}  // namespace deburr::tb
