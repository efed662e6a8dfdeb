// SPDX-License-Identifier: MIT
// The fuzz targets: all readers of external data, and the C interface, which external code calls.
// An input is accepted, or rejected by a named error (spec/error.h); any other exception, a crash,
// a leak or a hang is a bug. The same functions run under libFuzzer (fuzzer.cpp) and on inputs that
// it found before (replay_test.cpp).
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace deburr::tb {

struct FuzzTarget {
  std::string_view name;
  void (*run)(std::string_view bytes);
  std::vector<std::string> (*seeds)();  // small accepted inputs, the starting point of mutations
};

// pictures, compressed_textures, depths, obj, gltf, traces, configurations, run_files, weights,
// c_calls
std::span<const FuzzTarget> fuzz_targets();
// Throws for an unknown name.
const FuzzTarget& fuzz_target(std::string_view name);

}  // namespace deburr::tb
