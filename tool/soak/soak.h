// SPDX-License-Identifier: MIT
// A soak: random configurations of all engines one after another, each against its golden model,
// for as long as there is time.
//
// SystemC elaborates once a process, so every run is a child, which this process forks when it has
// drawn the configuration. Memory is checked twice: this process's, which draws thousands of scenes
// and configurations, and that of long runs, children that simulate hundreds of frames.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace deburr::tool {

struct SoakOptions {
  std::vector<std::string> engines;  // none: all
  double seconds = 3600;
  std::uint64_t runs = 0;  // 0: as many as there is time for
  std::uint64_t seed = 1;
  std::uint64_t long_every = 100;  // each so-manieth run is a long one; 0: none
  // Over the random ones: to plant a fault, or to look at one thing.
  std::vector<std::pair<std::string, std::string>> settings;
};

// Prints as it goes; what it returns is the exit code: 0, 1 for a mismatch, a failure or memory
// that grew.
int soak(SoakOptions options);

}  // namespace deburr::tool
