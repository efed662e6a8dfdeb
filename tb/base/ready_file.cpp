// SPDX-License-Identifier: MIT
#include "tb/base/ready_file.h"

#include <system_error>

namespace deburr::tb {

std::filesystem::path ready_file(const std::filesystem::path& named) {
  namespace fs = std::filesystem;
  std::error_code ignored;
  if (named.is_absolute() || fs::exists(named, ignored)) return named;
  const fs::path program = fs::read_symlink("/proc/self/exe", ignored);
  const fs::path installed =
      (program.parent_path() / DEBURR_DATA_FROM_PROGRAM / named).lexically_normal();
  return fs::is_regular_file(installed, ignored) ? installed : named;
}

}  // namespace deburr::tb
