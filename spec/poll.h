// SPDX-License-Identifier: MIT
// Lets the caller of a long calculation end it. Models call poll() between rows; it does nothing
// unless the calling thread has set poll_function, which may throw.
#pragma once

namespace deburr::spec {

using PollFunction = void (*)();
inline constinit thread_local PollFunction poll_function = nullptr;

inline void poll() {
  if (poll_function != nullptr) poll_function();
}

}  // namespace deburr::spec
