// SPDX-License-Identifier: MIT
// Meshes made by formula that stand for those of the data folder where there is none: uniform
// colours, edges that are mostly geometry, as such models have them. Written as OBJ, so that they
// come by the way of any other mesh.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace deburr::studies {

// "street": houses along a road; "vehicle": boxes on wheels; "forest": cones on trunks; another
// one for each seed. Leaves NAME.obj and NAME.mtl in the folder and gives the path of the first.
std::filesystem::path write_stand_in(const std::filesystem::path& folder, const std::string& kind,
                                     std::uint64_t seed);

}  // namespace deburr::studies
