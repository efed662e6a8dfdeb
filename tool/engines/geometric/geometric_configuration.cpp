// SPDX-License-Identifier: MIT
#include "tool/engines/geometric/geometric_configuration.h"

#include <fmt/format.h>

#include <cstdint>
#include <string_view>
#include <utility>

#include "spec/check_build.h"
#include "spec/error.h"
#include "spec/geometric/records.h"
#include "tb/run/amount.h"
#include "tool/run/input_rules.h"
#include "tool/run/preset_help.h"

namespace deburr::tool {
namespace {

constexpr std::string_view kGeometricPrefix = "geometric.";

std::string source_of(const spec::geometric::Parameters& values) {
  return fmt::format("preset {}",
                     spec::geometric::kPresetNames[static_cast<std::size_t>(values.preset)]);
}

}  // namespace

void apply_preset(tb::ParameterSet& set, const spec::geometric::Parameters& values) {
  const spec::geometric::Parameters configuration = preset_parameters(values.preset);
  for_each_of(values.preset, [&](std::string_view name, auto, auto) {
    set.imply(fmt::format("{}{}", kGeometricPrefix, name), spec::value_text(configuration, name),
              source_of(values));
  });
}

void imply_crossings(tb::ParameterSet& set, std::string_view name,
                     const spec::geometric::Parameters& values) {
  if (values.preset == spec::geometric::Preset::kDeburr)
    set.imply(std::string(name), "true", source_of(values));
}

std::string preset_label(const tb::ParameterSet& set, const spec::geometric::Parameters& values) {
  return with_changes(source_of(values), set, kGeometricPrefix);
}

void reject_unused_configuration(const tb::ParameterSet& set,
                                 const spec::geometric::Parameters& p) {
  const auto reject = [&](std::string_view name, std::string_view why) {
    set.reject(fmt::format("{}{}", kGeometricPrefix, name), why);
  };
  if (p.select == spec::geometric::Select::kAll) {
    reject("crease", "geometric.select = all draws every edge, whether it is a crease or not");
    reject("crease_depth", "geometric.select = all has no creases");
    reject("cull", "geometric.select = all draws every edge, whichever way its faces are turned");
    reject("face_limit", "geometric.select = all reads no facing bits");
  }
  if (p.select == spec::geometric::Select::kMesh) {
    reject("cull", "geometric.select = mesh ignores which way faces are turned");
    reject("face_limit", "geometric.select = mesh reads no facing bits");
  }
  if (p.crease == spec::geometric::Crease::kOff)
    reject("crease_depth", "geometric.crease = off has no creases");
  if (p.depth_test == spec::geometric::DepthTest::kOff)
    for (const char* const name : {"depth_bias", "crease_depth", "depth_lines"})
      reject(name, "geometric.depth_test = off reads no depth");
  if (p.combine == spec::geometric::Combine::kOutermost &&
      p.depth_test != spec::geometric::DepthTest::kFarther)
    reject("combine",
           "without geometric.depth_test = farther no pixel is known to be nearer than its "
           "neighbour, so outermost equals max");
  if (!p.frame_copy) reject("copy_lines", "geometric.frame_copy = false copies nothing");
  if (p.pipelined) {
    reject("dividers", "geometric.pipelined = true accepts a line every cycle with one divider");
    // A table with entries cannot be built (spec/geometric/check_build.h).
    if (p.reciprocal_table == 0)
      reject("reciprocal_table",
             "geometric.pipelined = true accepts a line every cycle without one");
  }
}

void reject_too_many_faces(const tb::Scene& scene, const spec::geometric::Parameters& p) {
  constexpr std::uint64_t kStep = spec::geometric::kFacesInLine;
  const std::uint64_t faces = scene.mesh.triangles.size();
  const std::string mesh = fmt::format("the mesh '{}' has {} faces", scene.name, faces);
  if (faces > spec::geometric::kMaxFaces)
    throw spec::ConfigError(fmt::format("{}, the engine supports at most {}: simplify the mesh",
                                        mesh, spec::geometric::kMaxFaces));
  if (p.select == spec::geometric::Select::kEdges &&
      faces > static_cast<std::uint64_t>(p.face_limit))
    throw spec::ConfigError(
        fmt::format("{}, the hardware has facing bits for {}: raise the limit (--set "
                    "geometric.face_limit={}) or simplify the mesh",
                    mesh, p.face_limit, (faces + kStep - 1) / kStep * kStep));
}

std::vector<std::string> build_notes(const spec::geometric::Parameters& p) {
  if (p.latency_fifo >= p.fills) return {};
  return {
      fmt::format("geometric.latency_fifo = {} is below geometric.fills = {}: lookups stall before "
                  "all fills are outstanding",
                  p.latency_fifo, p.fills)};
}

std::vector<std::string> dropped_notes(const spec::geometric::Work& work) {
  if (work.edges == 0 || work.lines != 0) return {};
  std::string why;
  for (const auto& [count, what] :
       {std::pair{work.back_edges, "turned away from the eye"},
        {work.flat_edges, "no crease"},
        {work.outside_edges, "behind the eye or outside the guard band"},
        {work.empty_edges, "outside the frame"},
        {work.degenerate_edges, "without length"},
        {work.invalid_edges, "with an index out of range"}})
    if (count != 0)
      why += fmt::format("{}{} {}", why.empty() ? "" : ", ", tb::grouped(count), what);
  std::string note = fmt::format("all {} edges were dropped ({}): nothing was smoothed",
                                 tb::grouped(work.edges), why);
  if (work.back_edges != 0)
    note +=
        "; for a camera inside the mesh, or a mesh with the opposite winding order, set "
        "geometric.cull = none";
  return {note};
}

std::vector<Shorthand> edge_shorthands() {
  return {
      {"--preset", "geometric.preset",
       preset_help(spec::geometric::kPresetNames, spec::geometric::Configuration().preset)},
      {"--layout", "geometric.layout",
       "Pixel order of the colour and depth buffers: tiled (default) or raster"},
      {"--walkers", "geometric.walkers", "Pixels of a line walked per cycle: 1, 2 or 4 (default)"}};
}

}  // namespace deburr::tool
