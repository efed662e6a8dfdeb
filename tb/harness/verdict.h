// SPDX-License-Identifier: MIT
// Errors of a run other than deadlocks and protocol violations: a failed comparison (exit code 1)
// and an exhausted cycle budget (3).
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
