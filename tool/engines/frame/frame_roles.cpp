// SPDX-License-Identifier: MIT
#include "tool/engines/frame/frame_roles.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "spec/error.h"
#include "tool/run/shorthands.h"

namespace deburr::tool {
namespace {

bool has(const HandedOn& handed, Handed what) {
  return std::find(handed.begin(), handed.end(), what) != handed.end();
}

bool serves(const PictureDrawer& drawer, const PictureSmoother& smoother) {
  const HandedOn given = drawer.hands_on(), needed = smoother.needs();
  return std::all_of(needed.begin(), needed.end(), [&](Handed what) { return has(given, what); });
}

struct FrameChoice {
  std::size_t& smoothing;
  const std::vector<std::string>& names;
};

template <class Visitor>
void describe(FrameChoice& p, Visitor& v) {
  v.choice("smoothing", p.smoothing, p.names,
           "Engines that smooth the drawn frame: one, or two in sequence.");
}

std::vector<std::unique_ptr<CompositionRole>> roles_of_engines() {
  std::vector<std::unique_ptr<CompositionRole>> roles;
  for (const std::unique_ptr<Engine>& engine : engines())
    if (std::unique_ptr<CompositionRole> role = engine->role()) roles.push_back(std::move(role));
  return roles;
}

// The role as a `Role`, or null.
template <class Role>
std::unique_ptr<Role> as(std::unique_ptr<CompositionRole>& role) {
  auto* const found = dynamic_cast<Role*>(role.get());
  if (found) (void)role.release();
  return std::unique_ptr<Role>(found);
}

}  // namespace

bool Smoothing::follows() const {
  return mesh && rows && has(mesh->hands_on(), Handed::kMarkedPixels) && rows->looks_at_marks();
}

FrameRoles::FrameRoles() : FrameRoles(roles_of_engines()) {}

FrameRoles::FrameRoles(std::vector<std::unique_ptr<CompositionRole>> roles) {
  // The drawing engine determines the inputs of the others.
  for (std::unique_ptr<CompositionRole>& role : roles)
    if (!drawer_) drawer_ = as<PictureDrawer>(role);
  DEBURR_CHECK(drawer_, "no engine draws a picture");
  for (std::unique_ptr<CompositionRole>& role : roles) {
    if (std::unique_ptr<MeshSmoother> mesh = as<MeshSmoother>(role)) {
      if (!serves(*drawer_, *mesh)) continue;
      smoothings_.push_back({std::string(mesh->name()), mesh.get(), nullptr});
      mesh_.push_back(std::move(mesh));
    } else if (std::unique_ptr<RowSmoother> rows = as<RowSmoother>(role)) {
      if (!serves(*drawer_, *rows)) continue;
      smoothings_.push_back({std::string(rows->name()), nullptr, rows.get()});
      rows_.push_back(std::move(rows));
    }
  }
  DEBURR_CHECK(!smoothings_.empty(), "no engine smooths a picture");
  for (const std::unique_ptr<MeshSmoother>& mesh : mesh_)
    for (const std::unique_ptr<RowSmoother>& rows : rows_)
      smoothings_.push_back(
          {fmt::format("{}-{}", mesh->name(), rows->name()), mesh.get(), rows.get()});
  for (const Smoothing& smoothing : smoothings_) names_.push_back(smoothing.name);
}

std::vector<const MeshSmoother*> FrameRoles::mesh_smoothers() const {
  std::vector<const MeshSmoother*> all;
  for (const auto& mesh : mesh_) all.push_back(mesh.get());
  return all;
}

std::vector<const RowSmoother*> FrameRoles::row_smoothers() const {
  std::vector<const RowSmoother*> all;
  for (const auto& rows : rows_) all.push_back(rows.get());
  return all;
}

std::vector<const PictureSmoother*> FrameRoles::smoothers() const {
  std::vector<const PictureSmoother*> all;
  for (const auto& mesh : mesh_) all.push_back(mesh.get());
  for (const auto& rows : rows_) all.push_back(rows.get());
  return all;
}

std::vector<const CompositionRole*> FrameRoles::all() const {
  std::vector<const CompositionRole*> all = {drawer_.get()};
  for (const PictureSmoother* smoother : smoothers()) all.push_back(smoother);
  return all;
}

std::vector<const PictureSmoother*> FrameRoles::chosen_smoothers() const {
  std::vector<const PictureSmoother*> all;
  if (chosen().mesh) all.push_back(chosen().mesh);
  if (chosen().rows) all.push_back(chosen().rows);
  return all;
}

void FrameRoles::add_parameters(tb::ParameterSet& set) {
  drawer_->add_scene(set);
  FrameChoice choice{choice_, names_};
  set.add("frame", tb::ParameterKind::kRule, choice);
  drawer_->add_parameters(set);
  for (const auto& mesh : mesh_) mesh->add_parameters(set);
  for (const auto& rows : rows_) rows->add_parameters(set);
}

// Couples a pair of engines: the first marks the pixels that it has smoothed, and the second uses
// its settings for a follower. Explicit settings are kept.
void FrameRoles::resolve(tb::ParameterSet& set) {
  const Smoothing& smoothing = chosen();
  const std::string why = fmt::format("frame.smoothing = {}", smoothing.name);
  const auto follows = [&](const RowSmoother& rows) {
    return smoothing.follows() && smoothing.rows == &rows;
  };
  drawer_->apply_preset(set);
  for (const auto& mesh : mesh_) mesh->apply_preset(set);
  for (const auto& rows : rows_) {
    if (follows(*rows)) rows->follow_preset(set, why);
    rows->apply_preset(set);
  }
  for (const auto& mesh : mesh_)
    if (smoothing.follows() && smoothing.mesh == mesh.get()) mesh->mark(set, why);
  for (const auto& rows : rows_)
    if (follows(*rows)) rows->follow(set, why);

  const std::vector<const PictureSmoother*> chosen = chosen_smoothers();
  const auto resolve_one = [&](PictureSmoother& smoother) {
    if (std::find(chosen.begin(), chosen.end(), &smoother) != chosen.end())
      return smoother.resolve(set);
    for (const std::string& prefix : smoother.prefixes())
      set.reject_all(prefix, fmt::format("{} has no {}", why, smoother.title()));
  };
  for (const auto& mesh : mesh_) resolve_one(*mesh);
  for (const auto& rows : rows_) resolve_one(*rows);
  drawer_->resolve(set);
}

// If two engines have an option of the same name, the first engine's is used.
std::vector<Shorthand> FrameRoles::shorthands() const {
  std::vector<Shorthand> options;
  for (const CompositionRole* role : all())
    for (const Shorthand& one : role->shorthands())
      if (std::none_of(options.begin(), options.end(),
                       [&](const Shorthand& known) { return known.option == one.option; }))
        options.push_back(one);
  std::string values = names_.front() + " (default)";
  for (std::size_t i = 1; i < names_.size(); ++i)
    values += (i + 1 < names_.size() ? ", " : " or ") + names_[i];
  options.push_back({"--smoothing", "frame.smoothing", std::move(values)});
  return options;
}

}  // namespace deburr::tool
