// SPDX-License-Identifier: MIT
// Files installed with the program, such as sweeps and testplans, by their paths in the repository.
#pragma once

#include <filesystem>

namespace deburr::tb {

// Returns `named` if it exists or is absolute; otherwise the installed file of that path
// (share/deburr), if it exists.
std::filesystem::path ready_file(const std::filesystem::path& named);

}  // namespace deburr::tb
