// SPDX-License-Identifier: MIT
// What ends a run that is no deadlock and broke no rule: a failed comparison (exit code 1), or a
// spent budget of cycles (3).
#pragma once

#include <string>

#include "spec/error.h"

namespace deburr::tb {

class Mismatch : public spec::Error {
 public:
  explicit Mismatch(const std::string& text) : Error(spec::ExitCode::kMismatch, text) {}
};

class OutOfCycles : public spec::Error {
 public:
  explicit OutOfCycles(const std::string& text) : Error(spec::ExitCode::kSimulation, text) {}
};

}  // namespace deburr::tb
