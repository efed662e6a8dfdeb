// SPDX-License-Identifier: MIT
// Functional coverage. Bins are declared before they are hit, so a coverage hole is a bin with zero
// hits. To merge runs, their hits are added.
//
// Bin names are paths such as "texture/cache/miss": engine, coverage group, bin.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "spec/error.h"

namespace deburr::tb {

// Common prefix of the group's bins ("texture/cache") and the property that the bins observe.
struct CoverageGroup {
  std::string_view name, meaning;
};

class Coverage {
 public:
  void declare(const std::string& bin) { bins_.emplace(bin, 0); }

  // Throws CheckFailed for an undeclared bin.
  void hit(const std::string& bin, std::uint64_t times = 1) {
    const auto found = bins_.find(bin);
    DEBURR_CHECK(found != bins_.end(), "coverage bin '" + bin + "' was not declared");
    found->second += times;
  }
  void merge(const Coverage& other) {
    for (const auto& [bin, hits] : other.bins_) bins_[bin] += hits;
  }

  std::size_t size() const { return bins_.size(); }
  const std::map<std::string, std::uint64_t>& bins() const { return bins_; }
  std::vector<std::string> holes() const {
    std::vector<std::string> empty;
    for (const auto& [bin, hits] : bins_)
      if (hits == 0) empty.push_back(bin);
    return empty;
  }

 private:
  std::map<std::string, std::uint64_t> bins_;
};

}  // namespace deburr::tb
