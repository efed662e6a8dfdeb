// SPDX-License-Identifier: MIT
// The geometric engine's part of the module.
#include <memory>
#include <utility>

#include "golden/c/frame_handle.h"
#include "golden/c/geometric_handle.h"
#include "golden/geometric/geometric_golden.h"
#include "python/bindings/arrays.h"
#include "python/bindings/frames.h"
#include "python/bindings/module.h"

namespace deburr::spec::geometric {

template <class Visit>
void record_fields(const Vertex& vertex, Visit& visit) {
  visit("x", vertex.x);
  visit("y", vertex.y);
  visit("depth", vertex.depth);
  visit("usable", vertex.usable);
}
template <class Visit>
void record_fields(const Edge& edge, Visit& visit) {
  visit("v0", edge.v0);
  visit("v1", edge.v1);
  visit("f0", edge.f0);
  visit("f1", edge.f1);
  visit("flags", edge.flags);
}

}  // namespace deburr::spec::geometric

namespace deburr::python {
namespace {

using golden::geometric::GeometricGolden;
using spec::geometric::Edge;
using spec::geometric::Vertex;

struct GeometricFrame {
  std::unique_ptr<GeometricGolden> golden;
  bool detail = false;

  Shape shape() const { return {golden->height(), golden->width()}; }
  void require_detail(const char* what) const {
    golden::c::require(detail, std::string(what) + " were not recorded: give detail=True");
  }
};

// A copy of the mesh that the frame was drawn from.
struct Mesh {
  std::vector<Edge> edges;
  std::vector<Vertex> vertices;
  std::vector<std::uint8_t> facing;
  std::uint32_t faces = 0;
};

template <class Record>
std::vector<Record> records(const py::object& given, const char* name, const char* dtype,
                            std::size_t most) {
  const std::string wanted = std::string("an array of ") + dtype + " of (n,)";
  const py::array array = checked_list<Record>(given, name, wanted);
  golden::c::require(static_cast<std::size_t>(array.size()) <= most,
                     std::to_string(array.size()) + " " + name + "; the limit is 2^24");
  const auto all = elements<Record>(array);
  return {all.begin(), all.end()};
}

Mesh mesh_of(const py::object& vertices, const py::object& edges, const py::object& facing) {
  Mesh mesh;
  mesh.vertices = records<Vertex>(vertices, "vertices", "VERTEX", spec::geometric::kMaxVertices);
  mesh.edges = records<Edge>(edges, "edges", "EDGE", spec::geometric::kMaxEdges);
  // Keeps only the bits that a memory word has for this field.
  for (Vertex& vertex : mesh.vertices) vertex.depth &= 0xFFFFFF;
  for (Edge& edge : mesh.edges)
    for (std::uint32_t* const index : {&edge.v0, &edge.v1, &edge.f0, &edge.f1})
      *index &= spec::geometric::kIndexMask;
  const py::array bits = checked_list<bool>(facing, "facing", "bool of (faces,)");
  mesh.faces = static_cast<std::uint32_t>(bits.size());
  mesh.facing.resize((std::size_t{mesh.faces} + 7) / 8);
  const auto all = elements<std::uint8_t>(bits);
  for (std::size_t face = 0; face < all.size(); ++face)
    if (all[face] != 0) mesh.facing[face >> 3] |= static_cast<std::uint8_t>(1u << (face & 7));
  return mesh;
}

// Base addresses of the memory regions by name; regions that are not given lie at 0.
golden::geometric::Bases bases_of(const py::object& given) {
  golden::geometric::Bases bases;
  if (given.is_none()) return bases;
  golden::c::require(py::isinstance<py::dict>(given),
                     "bases: expected a dictionary of addresses, got " + described(given));
  const struct {
    const char* name;
    std::uint32_t* base;
  } regions[] = {
      {"edges", &bases.edges}, {"vertices", &bases.vertices}, {"facing", &bases.facing},
      {"depth", &bases.depth}, {"colour", &bases.colour},     {"weights", &bases.weights},
      {"copy", &bases.copy},   {"pairs", &bases.pairs},       {"coarse", &bases.coarse}};
  for (const auto& [name, value] : py::reinterpret_borrow<py::dict>(given)) {
    const std::string wanted = py::cast<std::string>(py::str(name));
    std::vector<std::string> known;
    std::uint32_t* base = nullptr;
    for (const auto& region : regions) {
      known.emplace_back(region.name);
      if (wanted == region.name) base = region.base;
    }
    if (!base) golden::c::reject_name("region of memory", wanted, known);
    *base = static_cast<std::uint32_t>(
        golden::c::number_in_range(wanted, text_of(value), 0, 0xFFFFFFFF));
    golden::c::require(*base % spec::geometric::kLineBytes == 0,
                       "the base of " + wanted + ", " + std::to_string(*base) +
                           ", is not a multiple of " + std::to_string(spec::geometric::kLineBytes));
  }
  return bases;
}

GeometricFrame smooth_geometric(const py::object& pixels, const py::object& depth,
                                const py::object& vertices, const py::object& edges,
                                const py::object& facing, const py::object& bases, bool detail,
                                const py::object& lines, const py::dict& parameters) {
  auto texts = golden::c::geometric_texts();
  set_all(texts, parameters);
  const FramePixels frame = frame_pixels(pixels);
  const FrameDepth depths = frame_depth(depth, frame.view.width, frame.view.height);
  golden::c::require(
      !depth.is_none() || texts.values().depth_test == spec::geometric::DepthTest::kOff,
      "the frame has no depth: give one, or depth_test=\"off\"");
  const Mesh mesh = mesh_of(vertices, edges, facing);
  const golden::geometric::Bases places = bases_of(bases);
  auto errors = error_lines(lines);
  using Detail = GeometricGolden::Detail;
  GeometricFrame result;
  result.detail = detail;
  const py::gil_scoped_release others_run;
  result.golden = std::make_unique<GeometricGolden>(texts.values(),
                                                    detail ? Detail::kEverything : Detail::kPixels);
  if (errors) result.golden->set_memory_errors(std::move(errors));
  golden::geometric::FrameInput input;
  input.image = frame.view;
  input.depth = depths.view;
  input.edges = mesh.edges;
  input.vertices = mesh.vertices;
  input.facing = {mesh.facing, mesh.faces};
  input.bases = places;
  result.golden->process(input);
  return result;
}

py::dict traffic_of(const py::object& self) {
  const auto& frame = py::cast<const GeometricFrame&>(self);
  frame.require_detail("lines of memory");
  const auto& traffic = frame.golden->traffic();
  py::dict regions;
  for (std::size_t i = 0; i < spec::geometric::kRegionNames.size(); ++i) {
    py::dict both;
    both["reads"] = view(traffic.reads[i], self);
    both["writes"] = view(traffic.writes[i], self);
    regions[py::str(std::string(spec::geometric::kRegionNames[i]))] = both;
  }
  return regions;
}

}  // namespace

void add_geometric(py::module_& module) {
  const auto of = [](const py::object& self) -> const GeometricFrame& {
    return py::cast<const GeometricFrame&>(self);
  };
  py::class_<GeometricFrame>(module, "GeometricFrame",
                             "A frame that the geometric engine's golden model smoothed.")
      .def_property_readonly(
          "pixels",
          [of](const py::object& self) {
            return view(of(self).golden->pixels(), of(self).shape(), self);
          },
          "The smoothed frame, uint8 of (height, width, 4).")
      .def_property_readonly(
          "weights",
          [of](const py::object& self) {
            return view(of(self).golden->weights(), of(self).shape(), self);
          },
          "uint8 of (height, width, 4), U0.8: blend weights of the upper, lower, left and right "
          "neighbour.")
      .def_property_readonly(
          "work",
          [](const GeometricFrame& frame) {
            return figures(golden::c::counters_of(
                spec::geometric::kWorkCounts, spec::geometric::kRegisters, frame.golden->work()));
          },
          "Work counters, by the names of the registers.")
      .def_property_readonly(
          "classes",
          [of](const py::object& self) {
            of(self).require_detail("classes");
            return view(of(self).golden->classes(), self);
          },
          "Class of each edge, as an index into EDGE_CLASSES; with detail.")
      .def_property_readonly(
          "lines",
          [of](const py::object& self) {
            of(self).require_detail("lines");
            return view(of(self).golden->lines(), self);
          },
          "Records of the walked lines; with detail.")
      .def_property_readonly(
          "candidates",
          [of](const py::object& self) {
            of(self).require_detail("candidates");
            return view(of(self).golden->candidates(), self);
          },
          "Pixels that a line would blend with a neighbour; with detail.")
      .def_property_readonly(
          "blocks",
          [of](const py::object& self) {
            of(self).require_detail("blocks");
            return view(of(self).golden->blocks(), self);
          },
          "Blocks of 4 x 4 pixels as they were resolved; with detail.")
      .def_property_readonly(
          "traffic", traffic_of,
          "Memory lines by region, reads and writes separately, each in order; with detail.")
      .def_property_readonly(
          "memory_errors",
          [](const GeometricFrame& frame) { return frame.golden->memory_errors(); },
          "Accesses that memory answered with an error.")
      .def_property_readonly(
          "coverage",
          [](const GeometricFrame& frame) {
            frame.require_detail("bins of coverage");
            py::dict bins;
            add_bins(bins, frame.golden->coverage().bins());
            return bins;
          },
          "Bins of functional coverage and how often each was met; with detail.")
      .def_property_readonly("detail", [](const GeometricFrame& frame) { return frame.detail; });
  module.def("geometric", &smooth_geometric);
  module.def("geometric_parameters", [] { return parameter_rows(spec::geometric::Parameters{}); });
  module.attr("VERTEX") = dtype_of<Vertex>();
  module.attr("EDGE") = dtype_of<Edge>();
  py::list classes;
  for (const std::string_view name : spec::geometric::kEdgeClassNames)
    classes.append(std::string(name));
  module.attr("EDGE_CLASSES") = py::tuple(classes);
}

}  // namespace deburr::python
