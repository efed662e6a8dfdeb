// SPDX-License-Identifier: MIT
// Several simulations in one test: SystemC elaborates once a process.
#pragma once

#include <exception>
#include <functional>
#include <string>

#include "tb/base/forked.h"

namespace deburr::tb {

// The text that a simulation in a process of its own gives back, its exceptions included.
inline std::string in_child(const std::function<std::string()>& simulation) {
  try {
    return forked_text(simulation);
  } catch (const std::exception& error) {
    return std::string("exception: ") + error.what();
  }
}

}  // namespace deburr::tb
