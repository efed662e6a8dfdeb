// SPDX-License-Identifier: MIT
// A libFuzzer program for the target that it is compiled for; libFuzzer provides main().
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "tb/fuzz/targets.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const deburr::tb::FuzzTarget& target = deburr::tb::fuzz_target(DEBURR_FUZZ_TARGET);
  target.run({reinterpret_cast<const char*>(data), size});
  return 0;
}
