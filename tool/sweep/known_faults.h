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
  // ConfigError for a name that no run of the engine accepts (run.fault; empty: none is injected).
  // Links and preconditions of a fault are checked only by the run. The first name of an engine
  // elaborates its model in its own process.
  void require(const std::string& engine, const std::string& fault);

 private:
  std::map<std::string, std::vector<std::string>> of_engines_;
};

}  // namespace deburr::tool
