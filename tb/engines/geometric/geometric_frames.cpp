// SPDX-License-Identifier: MIT
#include "tb/engines/geometric/geometric_frames.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "spec/error.h"
#include "tb/base/random.h"
#include "tb/scene/mesh.h"
#include "tb/scene/motion.h"

namespace deburr::tb {
namespace {

void reject_what_has_no_edges(const std::string& source) {
  if (!std::filesystem::path(source).has_extension() || is_mesh_file(source)) return;
  throw spec::ConfigError(
      fmt::format("scene.source = '{}' is no mesh: an image has no edges; give a mesh file (.obj, "
                  ".gltf, .glb) or the name of a scene",
                  source));
}

void reject_empty(const Scene& scene, const EdgeTable& table) {
  if (!table.edges.empty()) return;
  throw spec::ConfigError(
      fmt::format("the mesh '{}' has no edges: none of its {} faces has an area; export a mesh "
                  "whose faces have three different corners",
                  scene.name, table.faces()));
}

std::vector<std::string> notes_of(const EdgeTable& table) {
  std::vector<std::string> notes;
  const auto note = [&](std::uint64_t count, std::string_view what) {
    if (count > 0) notes.push_back(fmt::format("{} {}", count, what));
  };
  note(table.faces_without_area, "faces have no area, or a corner that is not finite: no edges");
  note(table.disagreeing,
       "edges belong to two faces that pass them in the same direction: drawn as boundaries");
  note(table.crowded, "edges belong to three faces or more: drawn as boundaries");
  note(table.crossings, "lines along which faces pass through each other: drawn as boundaries");
  return notes;
}

}  // namespace

FrameLists lists_of(const GeometricSceneParameters& scene) {
  FrameLists lists;
  lists.add("scene.source", listed_files("scene.source", scene.source));
  add_camera(lists, scene);
  return lists;
}

GeometricSceneParameters in_frame(GeometricSceneParameters scene, const FrameLists& lists,
                                  int frame) {
  scene.source = lists.at("scene.source", frame);
  choose_camera(scene, lists, frame);
  return scene;
}

Image geometric_reference(const Scene& scene, int width, int height, int samples,
                          const std::function<bool()>& interrupted) {
  RenderOptions options;
  options.width = width;
  options.height = height;
  options.samples = samples;
  options.shading = Shading::kPhong;
  options.averaging = Averaging::kLinear;
  options.interrupted = interrupted;
  return render(scene, options);
}

void shuffle_edges(geometric::Frame& frame, std::uint64_t seed) {
  Random random(seed, "edges");
  std::vector<spec::geometric::Edge>& edges = frame.screen.edges;
  for (std::size_t i = edges.size(); i > 1; --i)
    std::swap(edges[i - 1], edges[random.below(static_cast<std::uint32_t>(i))]);
}

LoadedGeometricFrame load_geometric_frame(const GeometricSceneParameters& p, std::uint32_t seed,
                                          bool reference, const std::function<bool()>& interrupted,
                                          const std::function<void(const Scene&)>& accept) {
  if (!is_scene_name(p.source)) reject_what_has_no_edges(p.source);
  LoadedGeometricFrame loaded;
  loaded.scene = load_scene(p.source, {.seed = seed, .plain = true});
  if (accept) accept(loaded.scene);
  look(loaded.scene, p);
  loaded.scene.camera = moved(loaded.scene.camera, p.move.motion, p.move.frame);
  loaded.frame = geometric::make_frame(loaded.scene, p.width, p.height, {.crossings = p.crossings});
  reject_empty(loaded.scene, loaded.frame.table);
  if (p.edge_order == EdgeOrder::kShuffled) shuffle_edges(loaded.frame, seed);
  loaded.notes = loaded.scene.mesh.notes;
  for (std::string& note : notes_of(loaded.frame.table)) loaded.notes.push_back(std::move(note));
  loaded.inputs = loaded.scene.mesh.files;
  if (reference) {
    loaded.reference =
        geometric_reference(loaded.scene, p.width, p.height, p.reference_samples, interrupted);
    loaded.reference_name =
        fmt::format("supersampled-{}", p.reference_samples * p.reference_samples);
  }
  return loaded;
}

std::vector<std::filesystem::path> frame_files(const GeometricSceneParameters& p,
                                               MeshFiles& meshes) {
  return scene_files(p.source, {.plain = true}, meshes);
}

}  // namespace deburr::tb
