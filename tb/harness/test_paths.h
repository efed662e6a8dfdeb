// SPDX-License-Identifier: MIT
// Where a test finds what it does not hold itself. Compiled once for all test programs, so that
// none of them depends on where the checkout is.
#pragma once

#include <filesystem>

namespace deburr::tb {

std::filesystem::path source_folder();  // the checkout
std::filesystem::path command_path();   // the command `deburr` of the same build
// Meshes, textures and frames that others made: $DEBURR_DATA, or ../shared/data beside the
// checkout. It may be absent.
std::filesystem::path data_folder();

}  // namespace deburr::tb
