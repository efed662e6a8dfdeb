// SPDX-License-Identifier: MIT
// A scene and its fragments, independent of the engine that colours them.
#pragma once

#include <filesystem>
#include <vector>

#include "tb/scene/rasteriser.h"
#include "tb/scene/scenes.h"

namespace deburr::tb {

class DrawnScene {
 public:
  virtual ~DrawnScene() = default;
  virtual const Scene& scene() const = 0;
  virtual const FragmentStream& stream() const = 0;
  // Input files, including those that were looked for and not found.
  const std::vector<std::filesystem::path>& inputs() const { return scene().mesh.files; }

 protected:
  DrawnScene() = default;
  DrawnScene(const DrawnScene&) = default;
  DrawnScene(DrawnScene&&) = default;
  DrawnScene& operator=(const DrawnScene&) = default;
  DrawnScene& operator=(DrawnScene&&) = default;
};

}  // namespace deburr::tb
