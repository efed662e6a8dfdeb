// SPDX-License-Identifier: MIT
#include "tb/engines/morphological/morphological_maps.h"

#include <algorithm>
#include <bit>
#include <limits>

namespace deburr::tb {
namespace {

enum : std::size_t { kEdges, kRunLength, kSteps };

using spec::morphological::RunDescriptor;

// Visits the pixels at the lower or right side of a run.
template <class Visit>
void each_pixel(const RunDescriptor& run, Visit&& visit) {
  const bool horizontal = run.axis == spec::morphological::Axis::kHorizontal;
  for (int i = run.start; i < run.start + run.length; ++i)
    horizontal ? visit(i, run.line) : visit(run.line, i);
}

float& value_at(PictureMap& map, int x, int y) {
  return map.values[static_cast<std::size_t>(y) * static_cast<std::size_t>(map.width) +
                    static_cast<std::size_t>(x)];
}

}  // namespace

void MorphologicalMaps::begin(int width, int height) {
  maps_ = {
      PictureMap("edges", "Edges", "edges", "Left and top edge of a pixel: 0 to 2.", width, height),
      PictureMap(
          "run_length", "Run lengths", "pixels",
          "Length of the run that a pixel's edge belongs to, of the longer one where it "
          "has two; of runs beyond the search range, what one of their two descriptors covers.",
          width, height),
      PictureMap("steps", "Predictor steps", "steps",
                 "Steps by which the predictors extended the runs of a pixel, over the pixels of "
                 "the run.",
                 width, height)};
  for (const std::size_t map : {kRunLength, kSteps})
    std::fill(maps_[map].values.begin(), maps_[map].values.end(), 0.0F);
}

void MorphologicalMaps::see(std::size_t position, const spec::morphological::BlendProbe& probe) {
  if (!maps_.empty() && position < maps_[kEdges].values.size())
    maps_[kEdges].values[position] = static_cast<float>(std::popcount(probe.edges));
}

void MorphologicalMaps::see(const RunDescriptor& run) {
  if (maps_.empty()) return;
  PictureMap& map = maps_[kRunLength];
  each_pixel(run, [&](int x, int y) {
    if (!map.has(x, y)) return;
    float& value = value_at(map, x, y);
    value = std::max(value, static_cast<float>(run.length));
  });
}

void MorphologicalMaps::see(const spec::morphological::LineDescriptor& line) {
  if (maps_.empty()) return;
  const int steps = line.left_steps + line.right_steps;
  each_pixel(line.run, [&](int x, int y) {
    maps_[kSteps].add(x, y, static_cast<double>(steps) / line.run.length);
  });
}

std::vector<PictureMap> MorphologicalMaps::maps(
    const rtl::morphological::MorphologicalEngine& engine, bool only_frame) const {
  std::vector<PictureMap> all = maps_;
  if (all.empty() || !only_frame) return all;
  const auto edge_pixels = static_cast<double>(engine.work().edge_pixels);
  all[kEdges].account = {"work.edge_detector_edge_pixels", edge_pixels,
                         static_cast<double>(all[kEdges].pixels_above_zero())};
  // The middle part of a run beyond the search range lacks a descriptor.
  if (engine.extractor.long_runs.value() == 0)
    all[kRunLength].account = {"the number of pixels with an edge", edge_pixels,
                               static_cast<double>(all[kRunLength].pixels_above_zero())};
  all[kSteps].account = {"the sum of steps of both predictors",
                         static_cast<double>(engine.endpoint_predictor_h.steps.value() +
                                             engine.endpoint_predictor_v.steps.value()),
                         all[kSteps].sum()};
  return all;
}

}  // namespace deburr::tb
