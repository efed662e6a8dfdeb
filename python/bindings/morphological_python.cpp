// SPDX-License-Identifier: MIT
// The morphological engine's part of the module.
#include <memory>
#include <utility>

#include "golden/c/frame_handle.h"
#include "golden/c/morphological_handle.h"
#include "golden/morphological/morphological_golden.h"
#include "python/bindings/arrays.h"
#include "python/bindings/frames.h"
#include "python/bindings/module.h"

namespace deburr::golden::morphological {

template <class Visit>
void record_fields(const PredictedRun& run, Visit& visit) {
  visit("line", run.line);
  visit("far_left", run.far_left);
  visit("far_right", run.far_right);
  visit("probes", run.probes);
  visit("iterations", run.iterations);
  visit("left", run.left);
  visit("right", run.right);
  visit("left_end", run.left_end);
  visit("right_end", run.right_end);
}

}  // namespace deburr::golden::morphological

namespace deburr::spec::morphological {

template <class Visit>
void record_fields(const FrameAccess& access, Visit& visit) {
  visit("address", access.address);
  visit("write", access.write);
}

}  // namespace deburr::spec::morphological

namespace deburr::python {
namespace {

using golden::morphological::MorphologicalGolden;

struct MorphologicalFrame {
  std::unique_ptr<MorphologicalGolden> golden;
  bool detail = false;

  Shape shape() const { return {golden->height(), golden->width()}; }
  Shape shape(py::ssize_t channels) const { return {golden->height(), golden->width(), channels}; }
  py::object kept;  // of an unpickled frame: its properties; else null
};

MorphologicalFrame smooth_morphological(const py::object& pixels, const py::object& depth,
                                        const py::object& edges, bool detail,
                                        const py::object& lines, const py::dict& parameters) {
  auto texts = golden::c::morphological_texts();
  set_all(texts, parameters);
  const FramePixels frame = frame_pixels(pixels);
  const int width = frame.view.width, height = frame.view.height;
  golden::c::require(
      edges.is_none() || depth.is_none(),
      "edges and depth were given: depth is only used to find edges; give one of them");
  const FrameDepth depths = frame_depth(depth, width, height);
  py::array bits;
  if (!edges.is_none()) {
    constexpr const char* kWanted = "uint8 of (height, width)";
    bits = checked(edges, "edges", py::dtype::of<std::uint8_t>(), 2, kWanted);
    if (bits.shape(0) != height || bits.shape(1) != width)
      reject_array(
          "edges",
          "the size of the pixels, (" + std::to_string(height) + ", " + std::to_string(width) + ")",
          edges);
  }
  auto errors = error_lines(lines);
  using Detail = MorphologicalGolden::Detail;
  MorphologicalFrame result;
  result.detail = detail;
  const WithoutGil others_run;
  result.golden = std::make_unique<MorphologicalGolden>(
      texts.values(), detail ? Detail::kEverything : Detail::kPixels);
  if (errors) result.golden->set_read_errors(std::move(errors));
  if (edges.is_none()) {
    result.golden->process(frame.view, depths.view);
  } else {
    const std::span<const std::uint8_t> values(static_cast<const std::uint8_t*>(bits.data()),
                                               static_cast<std::size_t>(bits.size()));
    result.golden->process(
        frame.view, golden::c::edge_planes(values, static_cast<std::size_t>(width), width, height));
  }
  return result;
}

py::array edges_of(const MorphologicalFrame& frame) {
  const MorphologicalGolden& golden = *frame.golden;
  std::vector<std::uint8_t> edges;
  edges.reserve(golden.pixels().size());
  for (int y = 0; y < golden.height(); ++y)
    for (int x = 0; x < golden.width(); ++x)
      edges.push_back(static_cast<std::uint8_t>((golden.edges().left.at(x, y) ? 1 : 0) |
                                                (golden.edges().top.at(x, y) ? 2 : 0)));
  return owned(std::move(edges), frame.shape());
}

py::array weights_of(const MorphologicalFrame& frame) {
  const MorphologicalGolden& golden = *frame.golden;
  std::vector<std::uint8_t> weights;
  weights.reserve(4 * golden.pixels().size());
  for (int y = 0; y < golden.height(); ++y) {
    for (int x = 0; x < golden.width(); ++x) {
      const auto top = golden.top_weights(x, y), left = golden.left_weights(x, y);
      weights.insert(weights.end(), {top.first, top.second, left.first, left.second});
    }
  }
  return owned(std::move(weights), frame.shape(4));
}

py::dict coverage_of(const MorphologicalGolden& golden) {
  py::dict bins;
  add_bins(bins, golden.coverage().bins());
  add_bins(bins, golden.smaa_coverage().bins());
  add_bins(bins, golden.bypass_coverage().bins());
  add_bins(bins, golden.learned_coverage().bins());
  add_bins(bins, golden.guard_coverage().bins());
  return bins;
}

}  // namespace

void add_morphological(py::module_& module) {
  using Frame = MorphologicalFrame;
  using Self = py::object;
  ResultClass<Frame>(module, "MorphologicalFrame",
                     "A frame that the morphological engine's golden model smoothed.")
      .property("pixels", "The smoothed frame, uint8 of (height, width, 4).",
                [](const Frame& frame, const Self& self) {
                  return view(frame.golden->pixels(), frame.shape(), self);
                })
      .property("edges",
                "uint8 of (height, width): bit 0 an edge to the left neighbour, bit 1 to the upper "
                "one.",
                [](const Frame& frame, const Self&) { return edges_of(frame); })
      .property("weights",
                "uint8 of (height, width, 4), U0.8: blend weights at the upper edge for the upper "
                "pixel and for this one, then at the left edge for the left pixel and for this "
                "one.",
                [](const Frame& frame, const Self&) { return weights_of(frame); })
      .property("work", "Work counters, by the names of the registers.",
                [](const Frame& frame, const Self&) {
                  return figures(golden::c::counters_of(spec::morphological::kWorkCounts,
                                                        spec::morphological::kRegisters,
                                                        frame.golden->work()));
                })
      .detail("probes", "How each pixel was blended, records of (height, width); with detail.",
              [](const Frame& frame, const Self& self) {
                return view(frame.golden->probes(), frame.shape(), self);
              })
      .detail("decisions",
              "Rule that chose the axis of each pixel, uint8 of (height, width); with detail.",
              [](const Frame& frame, const Self& self) {
                return view(frame.golden->decisions(), frame.shape(), self);
              })
      .detail("runs", "Every run of edges with its line and the predictor's result; with detail.",
              [](const Frame& frame, const Self& self) { return view(frame.golden->runs(), self); })
      .property("traffic", "Memory lines that storage = memory writes and reads, in order.",
                [](const Frame& frame, const Self&) { return owned(frame.golden->traffic()); })
      .property("memory_errors", "Reads that memory answered with an error.",
                [](const Frame& frame, const Self&) { return frame.golden->memory_errors(); })
      .detail("coverage", "Bins of functional coverage and how often each was met; with detail.",
              [](const Frame& frame, const Self&) { return coverage_of(*frame.golden); });
  module.def("morphological", &smooth_morphological);
  module.def("morphological_parameters",
             [] { return parameter_rows(spec::morphological::Parameters{}); });
  module.attr("RUN") = dtype_of<golden::morphological::PredictedRun>();
}

}  // namespace deburr::python
