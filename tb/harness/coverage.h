// SPDX-License-Identifier: MIT
// Functional coverage: named bins that are declared before they are hit, so that a hole is a bin
// with no hits and not a bin that nobody thought of. A merge of runs is a sum.
//
// Names are paths, "texture/cache/miss": the engine, a group of bins that look at the same thing,
// and the bin.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "spec/error.h"

namespace deburr::tb {

// The beginning that names of bins share, "texture/cache", and what they look at.
struct CoverageGroup {
  std::string_view name, meaning;
};

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
