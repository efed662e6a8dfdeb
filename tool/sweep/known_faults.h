// SPDX-License-Identifier: MIT
// Which faults runs of an engine can plant, known before there is one: a name that no run takes is
// said by `plan`, not by every run.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace deburr::tool {

class KnownFaults {
 public:
  // ConfigError for a name that no run of the engine takes (run.fault; empty: none is injected). A
  // link and what a fault needs are seen by the run alone. The first name of an engine elaborates
  // its model, in a process of its own.
  void require(const std::string& engine, const std::string& fault);

 private:
  std::map<std::string, std::vector<std::string>> of_engines_;
};

}  // namespace deburr::tool
