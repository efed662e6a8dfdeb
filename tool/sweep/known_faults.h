// SPDX-License-Identifier: MIT
// The faults that runs of an engine can inject, known before any run, so that `plan` rejects an
// unknown name.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace deburr::tool {

class KnownFaults {
 public:
  // ConfigError if no run of the engine accepts the name (run.fault; empty: no fault is injected).
  // Only the run checks the links and the preconditions of a fault. For the first name of an
  // engine, the engine's model is elaborated in a process of its own.
  void require(const std::string& engine, const std::string& fault);

 private:
  std::map<std::string, std::vector<std::string>> of_engines_;
};

}  // namespace deburr::tool
