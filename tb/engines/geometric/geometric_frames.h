// SPDX-License-Identifier: MIT
// Input of the geometric engine: a scene or a mesh file, lit without anti-aliasing, with depth,
// edges and optionally a supersampled reference.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tb/engines/geometric/geometric_stimuli.h"
#include "tb/env/camera_parameters.h"
#include "tb/env/sequence.h"
#include "tb/run/given_work.h"
#include "tb/scene/image.h"
#include "tb/scene/scenes.h"

namespace deburr::tb {

// Order of the records in the edge table.
enum class EdgeOrder : std::uint8_t { kTable, kShuffled };
inline constexpr std::array<std::string_view, 2> kEdgeOrderNames = {"table", "shuffled"};

struct GeometricSceneParameters : CameraParameters {
  std::string source = "wheelcover";
  std::int32_t width = 640, height = 480;
  bool crossings = false;
  EdgeOrder edge_order = EdgeOrder::kTable;
  std::int32_t reference_samples = 16;
  std::int32_t count = 1;
  CameraMove move{};  // of its camera; not a parameter
};

template <class Visitor>
void describe(GeometricSceneParameters& p, Visitor& v) {
  v.text("source", p.source, "name | file or list",
         "A procedural scene (cube, wheelcover, wing, canopy, sphere, terrain, plane, quad, "
         "tunnel, object, road, cylinders) or a mesh file (.obj, .gltf, .glb); for one mesh per "
         "frame, a list or a pattern.");
  v.integer("width", p.width, 1, 8192, "pixel", "Width of the frame.");
  v.integer("height", p.height, 1, 8192, "pixel", "Height of the frame.");
  describe(static_cast<CameraParameters&>(p), v);
  v.boolean("crossings", p.crossings, "Also draw the lines along which faces intersect.");
  v.choice("edge_order", p.edge_order, kEdgeOrderNames,
           "Order of the edge table: its own, or shuffled by run.seed.");
  v.integer("reference_samples", p.reference_samples, 1, 32, "",
            "N of the N x N samples per pixel of the reference image.");
  v.integer("count", p.count, 1, 100, "frame", "Number of times the frame is smoothed.");
  v.is_work("source", GivenWork::kSource);
  for (const char* const name : {"width", "height", "reference_samples", "count"})
    v.is_work(name, GivenWork::kSetting);
}

// Per-frame values: meshes and cameras may be lists.
FrameLists lists_of(const GeometricSceneParameters& scene);
GeometricSceneParameters in_frame(GeometricSceneParameters scene, const FrameLists& lists,
                                  int frame);

struct LoadedGeometricFrame {
  Scene scene;
  geometric::Frame frame;
  std::optional<Image> reference;
  std::string reference_name;                 // "supersampled-256"
  std::vector<std::string> notes;             // decisions made about the mesh
  std::vector<std::filesystem::path> inputs;  // files that were read or looked for
};

// `accept` may throw to reject a scene before it is rendered. Throws ConfigError for a name that is
// neither a scene nor a mesh and for a mesh without edges; FileError as import_mesh(); Interrupted.
LoadedGeometricFrame load_geometric_frame(
    const GeometricSceneParameters& parameters, std::uint32_t seed, bool reference,
    const std::function<bool()>& interrupted = nullptr,
    const std::function<void(const Scene&)>& accept = nullptr);

// LoadedGeometricFrame::inputs, without loading.
std::vector<std::filesystem::path> frame_files(const GeometricSceneParameters& parameters,
                                               MeshFiles& meshes);

// Reference image of a scene: the same lighting with N x N samples per pixel, averaged in linear
// light.
Image geometric_reference(const Scene& scene, int width, int height, int samples,
                          const std::function<bool()>& interrupted = nullptr);

// Shuffles the records of the edge table.
void shuffle_edges(geometric::Frame& frame, std::uint64_t seed);

}  // namespace deburr::tb
