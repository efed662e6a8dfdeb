// SPDX-License-Identifier: MIT
// Functional coverage: named bins that are declared before they are hit, so that a hole is a bin
// with no hits and not a bin that nobody thought of. Runs are merged; the report lists the holes.
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "spec/error.h"

namespace deburr::tb {

class Coverage {
 public:
  void declare(const std::string& bin) { bins_.emplace(bin, 0); }

  // Throws CheckFailed for a bin that was not declared.
  void hit(const std::string& bin, std::uint64_t times = 1) {
    const auto found = bins_.find(bin);
    DEBURR_CHECK(found != bins_.end(), "coverage bin '" + bin + "' was not declared");
    found->second += times;
  }
  void merge(const Coverage& other) {
    for (const auto& [bin, hits] : other.bins_) bins_[bin] += hits;
  }

  std::size_t size() const { return bins_.size(); }
  std::vector<std::string> holes() const {
    std::vector<std::string> empty;
    for (const auto& [bin, hits] : bins_)
      if (hits == 0) empty.push_back(bin);
    return empty;
  }
  // {"bins": {"name": hits, ...}, "holes": ["name", ...]}; bin names need no escaping.
  std::string json() const {
    std::string bins, empty;
    for (const auto& [bin, hits] : bins_) {
      bins += fmt::format("{}\n    \"{}\": {}", bins.empty() ? "" : ",", bin, hits);
      if (hits == 0) empty += fmt::format("{}\"{}\"", empty.empty() ? "" : ", ", bin);
    }
    return fmt::format("{{\n  \"bins\": {{{}\n  }},\n  \"holes\": [{}]\n}}\n", bins, empty);
  }

 private:
  std::map<std::string, std::uint64_t> bins_;
};

}  // namespace deburr::tb
