// SPDX-License-Identifier: MIT
// What is fuzzed: everything that reads bytes which somebody else wrote, and the C interface, whose
// calls somebody else makes. An input is taken, or rejected by a named error (spec/error.h); any
// other exception, a crash, a leak or a hang is a bug. The same functions run under libFuzzer
// (fuzzer.cpp) and on what it once found (replay_test.cpp).
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace deburr::tb {

struct FuzzTarget {
  std::string_view name;
  void (*run)(std::string_view bytes);
  std::vector<std::string> (*seeds)();  // small inputs that are taken; others are made of them
};

// pictures, depths, obj, gltf, traces, configurations, run_files, weights, c_calls
std::span<const FuzzTarget> fuzz_targets();
// Throws for an unknown name.
const FuzzTarget& fuzz_target(std::string_view name);

}  // namespace deburr::tb
