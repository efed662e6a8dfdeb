// SPDX-License-Identifier: MIT
// write_seeds TARGET DIRECTORY: writes a fuzzer's initial inputs, one per file.
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <string>

#include "tb/fuzz/targets.h"

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fputs("usage: write_seeds TARGET DIRECTORY\n", stderr);
    return 2;
  }
  try {
    std::filesystem::create_directories(argv[2]);
    int number = 0;
    for (const std::string& seed : deburr::tb::fuzz_target(argv[1]).seeds())
      std::ofstream(std::filesystem::path(argv[2]) / ("seed" + std::to_string(number++)),
                    std::ios::binary)
          << seed;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "write_seeds: %s\n", error.what());
    return 1;
  }
  return 0;
}
