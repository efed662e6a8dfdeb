// SPDX-License-Identifier: MIT
// Run errors other than deadlocks and violations: a failed comparison (exit code 1), an exhausted
// cycle budget (3).
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
