// SPDX-License-Identifier: MIT
// Procedural meshes that replace those of the data folder where it is missing: uniform colours, and
// edges that are mostly geometry, as in such models. They are written as OBJ and loaded like any
// other mesh.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace deburr::studies {

// "street": houses along a road; "vehicle": boxes on wheels; "forest": cones on trunks; each seed
// gives another one. Writes NAME.obj and NAME.mtl to the folder; returns the path of NAME.obj.
std::filesystem::path write_stand_in(const std::filesystem::path& folder, const std::string& kind,
                                     std::uint64_t seed);

}  // namespace deburr::studies
