// SPDX-License-Identifier: MIT
// The engines of a composition, as they declare themselves (tool/run/composition.h), and the valid
// combinations of smoothing engines: a single one, or one that smooths along the edges of the mesh,
// followed by one that smooths the finished picture.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "tool/run/composition.h"

namespace deburr::tool {

// A value of frame.smoothing: one of the two engines, or both.
struct Smoothing {
  std::string name;  // "NAME", "NAME-NAME"
  const MeshSmoother* mesh = nullptr;
  const RowSmoother* rows = nullptr;
  // Whether the second engine reads the marks of the first.
  bool follows() const;
};

class FrameRoles {
 public:
  // The roles of engines(). Excludes the composition itself.
  FrameRoles();
  explicit FrameRoles(std::vector<std::unique_ptr<CompositionRole>> roles);

  const PictureDrawer& drawer() const { return *drawer_; }
  // In processing order.
  std::vector<const CompositionRole*> all() const;
  std::vector<const PictureSmoother*> smoothers() const;

  const std::vector<Smoothing>& smoothings() const { return smoothings_; }
  const Smoothing& chosen() const { return smoothings_[choice_]; }
  // The selected smoothing engines, in processing order.
  std::vector<const PictureSmoother*> chosen_smoothers() const;
  // Every smoothing engine, for a description of all.
  std::vector<const MeshSmoother*> mesh_smoothers() const;
  std::vector<const RowSmoother*> row_smoothers() const;

  void add_parameters(tb::ParameterSet& set);
  // Applies presets and the coupling of the selected engines; rejects invalid settings.
  void resolve(tb::ParameterSet& set);
  std::vector<Shorthand> shorthands() const;

 private:
  std::unique_ptr<PictureDrawer> drawer_;
  std::vector<std::unique_ptr<MeshSmoother>> mesh_;
  std::vector<std::unique_ptr<RowSmoother>> rows_;
  std::vector<Smoothing> smoothings_;
  std::vector<std::string> names_;  // of smoothings_
  std::size_t choice_ = 0;
};

}  // namespace deburr::tool
