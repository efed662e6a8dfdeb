// SPDX-License-Identifier: MIT
// Paths of files outside the test programs. Compiled once, so that no test program depends on the
// location of the checkout.
#pragma once

#include <filesystem>

namespace deburr::tb {

std::filesystem::path source_folder();  // root of the checkout
std::filesystem::path command_path();   // the command `deburr` of the same build
// Third-party meshes, textures and frames: $DEBURR_DATA, or ../shared/data next to the checkout.
// May be absent.
std::filesystem::path data_folder();

}  // namespace deburr::tb
