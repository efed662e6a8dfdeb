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
  py::object kept;  // of an unpickled frame: its properties; else null
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
  for (const auto& [name, value] : py::reinterpret_borrow<py::dict>(given)) {
    const std::string wanted = py::cast<std::string>(py::str(name));
    golden::c::set_base(bases, wanted,
                        static_cast<std::uint32_t>(
                            golden::c::number_in_range(wanted, text_of(value), 0, 0xFFFFFFFF)));
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
  const WithoutGil others_run;
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

py::dict traffic_of(const GeometricFrame& frame, const py::object& self) {
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
  using Frame = GeometricFrame;
  using Self = py::object;
  ResultClass<Frame>(module, "GeometricFrame",
                     "A frame that the geometric engine's golden model smoothed.")
      .property("pixels", "The smoothed frame, uint8 of (height, width, 4).",
                [](const Frame& frame, const Self& self) {
                  return view(frame.golden->pixels(), frame.shape(), self);
                })
      .property("weights",
                "uint8 of (height, width, 4), U0.8: blend weights of the upper, lower, left and "
                "right neighbour.",
                [](const Frame& frame, const Self& self) {
                  return view(frame.golden->weights(), frame.shape(), self);
                })
      .property(
          "work", "Work counters, by the names of the registers.",
          [](const Frame& frame, const Self&) {
            return figures(golden::c::counters_of(
                spec::geometric::kWorkCounts, spec::geometric::kRegisters, frame.golden->work()));
          })
      .detail(
          "classes", "Class of each edge, as an index into EDGE_CLASSES; with detail.",
          [](const Frame& frame, const Self& self) { return view(frame.golden->classes(), self); })
      .detail(
          "lines", "Records of the walked lines; with detail.",
          [](const Frame& frame, const Self& self) { return view(frame.golden->lines(), self); })
      .detail("candidates", "Pixels that a line would blend with a neighbour; with detail.",
              [](const Frame& frame, const Self& self) {
                return view(frame.golden->candidates(), self);
              })
      .detail(
          "blocks", "Blocks of 4 x 4 pixels as they were resolved; with detail.",
          [](const Frame& frame, const Self& self) { return view(frame.golden->blocks(), self); })
      .detail("traffic",
              "Memory lines by region, reads and writes separately, each in order; with detail.",
              &traffic_of)
      .property("memory_errors", "Accesses that memory answered with an error.",
                [](const Frame& frame, const Self&) { return frame.golden->memory_errors(); })
      .detail("coverage", "Bins of functional coverage and how often each was met; with detail.",
              [](const Frame& frame, const Self&) {
                py::dict bins;
                add_bins(bins, frame.golden->coverage().bins());
                return bins;
              });
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
