// SPDX-License-Identifier: MIT
// What a failed comparison throws: exit code 1.
#pragma once

#include <string>

#include "spec/error.h"

namespace deburr::tb {

class Mismatch : public spec::Error {
 public:
  explicit Mismatch(const std::string& text) : Error(spec::ExitCode::kMismatch, text) {}
};

}  // namespace deburr::tb
