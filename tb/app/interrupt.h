// SPDX-License-Identifier: MIT
// Ctrl-C: the first one asks for a clean end, the second one kills.
#pragma once

namespace deburr::tb {

// Takes over SIGINT and SIGTERM, and lets a write beyond a file size limit fail instead of killing.
void install_signal_handlers();
bool interrupted();

// Exit code of a run that was interrupted but left its partial result (as a shell reports SIGINT).
inline constexpr int kInterruptedExit = 130;

}  // namespace deburr::tb
