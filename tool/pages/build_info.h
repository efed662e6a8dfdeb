// SPDX-License-Identifier: MIT
// The sources and tools from which this program was built. When the commit changes, only a small
// generated file is recompiled.
#pragma once

#include <string>

namespace deburr::tool {

struct BuildInfo {
  std::string version;   // project version, "0.1.0"
  std::string commit;    // "1234abcd...", with "-dirty" for modified files; "unknown" without git
  std::string compiler;  // "GNU 12.2.0"
  std::string build;     // "Release"
  std::string systemc;   // "2.3.4"
  // Hash of every source that affects results: two programs with the same hash, compiler and
  // SystemC give the same results.
  std::string model;  // SHA-256, the first 16 digits
};
const BuildInfo& build_info();

}  // namespace deburr::tool
