// SPDX-License-Identifier: MIT
// C interface of the morphological engine.
#include <array>
#include <optional>
#include <vector>

#include "golden/c/frame_handle.h"
#include "golden/c/morphological_handle.h"
#include "golden/morphological/morphological_golden.h"
#include "spec/morphological/check_build.h"

namespace deburr::golden::c {
namespace {

enum class MorphologicalPlane : std::size_t { kPixels, kEdges, kWeights, kProbes, kDecisions };
constexpr std::array<Plane, 5> kMorphologicalPlanes = {{{"pixels", 4, false},
                                                        {"edges", 1, false},
                                                        {"weights", 4, false},
                                                        {"probes", 4, true},
                                                        {"decisions", 1, true}}};

using MorphologicalModel =
    ModelHandle<morphological::MorphologicalGolden, spec::morphological::Parameters>;

struct MorphologicalHandle final : MorphologicalModel {
  MorphologicalHandle() : MorphologicalModel(morphological_texts()) {}
  static constexpr const char* kWanted = "morphological";

  const char* engine() const override { return "morphological"; }
  std::span<const Counter> counters() override {
    shown = counters_of(spec::morphological::kWorkCounts, spec::morphological::kRegisters,
                        model.get() ? model.get()->work() : spec::morphological::Work{});
    return shown;
  }

  std::span<const Plane> planes() const override { return kMorphologicalPlanes; }
  void begin_frame() override { edges.reset(); }
  void process() override {
    const int w = static_cast<int>(width), h = static_cast<int>(height);
    const morphological::ImageView image(pixels, w, h);
    model.process(texts.values(), everything, [&](morphological::MorphologicalGolden& golden) {
      golden.set_read_errors(error_lines);
      if (edges) {
        golden.process(image, *edges);
      } else {
        golden.process(
            image, has_depth ? morphological::DepthView(depth, w, h) : morphological::DepthView());
      }
    });
  }
  Rgba8 plane_pixel(std::size_t plane, int x, int y) const override {
    const morphological::MorphologicalGolden& golden = *model.get();
    const std::size_t i = static_cast<std::size_t>(y) * static_cast<std::size_t>(golden.width()) +
                          static_cast<std::size_t>(x);
    switch (static_cast<MorphologicalPlane>(plane)) {
      case MorphologicalPlane::kEdges:
        return {static_cast<std::uint8_t>((golden.edges().left.at(x, y) ? 1 : 0) |
                                          (golden.edges().top.at(x, y) ? 2 : 0))};
      case MorphologicalPlane::kWeights: {
        const auto top = golden.top_weights(x, y), left = golden.left_weights(x, y);
        return {top.first, top.second, left.first, left.second};
      }
      case MorphologicalPlane::kProbes: {
        const auto& probe = golden.probes()[i];
        return {static_cast<std::uint8_t>(probe.horizontal), probe.first, probe.second,
                probe.edges};
      }
      case MorphologicalPlane::kDecisions:
        return {static_cast<std::uint8_t>(golden.decisions()[i])};
      case MorphologicalPlane::kPixels:
        break;
    }
    return golden.pixels()[i];
  }

  std::optional<morphological::EdgePlanes> edges;
};

}  // namespace
}  // namespace deburr::golden::c

using deburr::golden::c::MorphologicalHandle;

extern "C" {

deburr_golden* deburr_morphological_new(void) {
  return deburr::golden::c::new_handle<MorphologicalHandle>();
}

int deburr_morphological_edges(deburr_golden* golden, const uint8_t* edges, size_t edges_size,
                               uint32_t stride) {
  namespace c = deburr::golden::c;
  return c::call_of<MorphologicalHandle>(golden, __func__, [&](MorphologicalHandle& h) {
    c::require_frame(h);
    const auto given = c::array_of(edges, edges_size, "edges");
    const std::size_t distance = c::row_distance("edges", edges_size, h.width, h.height, stride);
    const int width = static_cast<int>(h.width), height = static_cast<int>(h.height);
    h.edges = c::edge_planes(given, distance, width, height);
  });
}

}  // extern "C"
