// SPDX-License-Identifier: MIT
// Runs several simulations in one test; SystemC allows one elaboration per process.
#pragma once

#include <exception>
#include <functional>
#include <string>

#include "tb/base/forked.h"

namespace deburr::tb {

// Runs `simulation` in a child process and returns its text, or the text of its exception.
inline std::string in_child(const std::function<std::string()>& simulation) {
  try {
    return forked_text(simulation);
  } catch (const std::exception& error) {
    return std::string("exception: ") + error.what();
  }
}

}  // namespace deburr::tb
