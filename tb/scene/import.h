// SPDX-License-Identifier: MIT
// The two importers behind import_mesh. Internal to tb/scene.
#pragma once

#include <filesystem>

#include "tb/scene/mesh.h"

namespace deburr::tb {

Mesh import_obj(const std::filesystem::path& path, const ImportOptions& options);
Mesh import_gltf(const std::filesystem::path& path, const ImportOptions& options);

}  // namespace deburr::tb
