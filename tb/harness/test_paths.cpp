// SPDX-License-Identifier: MIT
#include "tb/harness/test_paths.h"

#include <cstdlib>

namespace deburr::tb {

std::filesystem::path source_folder() { return DEBURR_SOURCE_DIR; }

std::filesystem::path command_path() { return DEBURR_COMMAND; }

std::filesystem::path data_folder() {
  const char* const given = std::getenv("DEBURR_DATA");
  return given != nullptr ? std::filesystem::path(given) : source_folder() / "../shared/data";
}

}  // namespace deburr::tb
