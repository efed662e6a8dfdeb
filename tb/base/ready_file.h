// SPDX-License-Identifier: MIT
// Files that come with the program: ready sweeps and testplans, by their paths in the repository.
#pragma once

#include <filesystem>

namespace deburr::tb {

// The file as it was named, where there is one or its path is absolute; else the installed one of
// that path (share/deburr), where there is that.
std::filesystem::path ready_file(const std::filesystem::path& named);

}  // namespace deburr::tb
