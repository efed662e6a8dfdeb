// SPDX-License-Identifier: MIT
// What this program was built from. Only the small generated file behind it is compiled again when
// the commit changes.
#pragma once

#include <string>

namespace deburr::tool {

struct BuildInfo {
  std::string version;   // of the project, "0.1.0"
  std::string commit;    // "1234abcd...", with "-dirty" when files differed; "unknown" without git
  std::string compiler;  // "GNU 12.2.0"
  std::string build;     // "Release"
  std::string systemc;   // "2.3.4"
  // Of every source that a result depends on: two programs with the same one, compiler and SystemC
  // give the same results.
  std::string model;  // SHA-256, the first 16 digits
};
const BuildInfo& build_info();

}  // namespace deburr::tool
