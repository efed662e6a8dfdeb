// SPDX-License-Identifier: MIT
// A soak test: random configurations of all engines in sequence, each against its golden model,
// until the time is over.
//
// SystemC elaborates once per process, so every run is a child, forked after the configuration is
// drawn. Memory is checked twice: for this process, which draws thousands of scenes and
// configurations, and for long runs, children that simulate hundreds of frames.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace deburr::tool {

struct SoakOptions {
  std::vector<std::string> engines;  // empty: all
  double seconds = 3600;
  std::uint64_t runs = 0;  // 0: as many as time allows
  std::uint64_t seed = 1;
  std::uint64_t long_every = 100;  // one run in N is a long one; 0: none
  // Override the random settings: to inject a fault, or to test one setting.
  std::vector<std::pair<std::string, std::string>> settings;
};

// Prints progress; returns the exit code: 0, or 1 for a mismatch, a failure or memory growth.
int soak(SoakOptions options);

}  // namespace deburr::tool
