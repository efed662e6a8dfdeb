// SPDX-License-Identifier: MIT
#include "studies/training/weight_samples.h"

#include <algorithm>
#include <cstddef>

#include "golden/morphological/configuration.h"
#include "golden/morphological/morphological_golden.h"
#include "spec/morphological/packets.h"
#include "spec/morphological/shapes.h"

namespace deburr::studies::training {
namespace {

namespace gm = golden::morphological;
using spec::morphological::Axis;

// One edge's data, for its first and second pixel.
struct EdgeSource {
  Source source = Source::kNone;
  std::array<gm::WeightIndices, 2> indices = {gm::kGapIndices, gm::kGapIndices};
  std::array<std::uint8_t, 2> weight{};
  std::uint16_t span = 0;
};
using EdgePlane = tb::ImageOf<EdgeSource>;

struct Sources {
  EdgePlane top, left;
};

Sources sources_of(const gm::MorphologicalGolden& golden) {
  const int width = golden.width(), height = golden.height();
  Sources result{EdgePlane(width, height), EdgePlane(width, height)};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      if (golden.edges().top.at(x, y)) result.top.at(x, y).source = Source::kLearned;
      if (golden.edges().left.at(x, y)) result.left.at(x, y).source = Source::kLearned;
    }
  }
  for (const gm::PredictedRun& run : golden.runs()) {
    const spec::morphological::LineDescriptor& line = run.line;
    const bool horizontal = line.run.axis == Axis::kHorizontal;
    const gm::LearnedEnds first(line, spec::morphological::Side::kFirst);
    const gm::LearnedEnds second(line, spec::morphological::Side::kSecond);
    for (int k = 0; k < line.run.length; ++k) {
      const int along = line.run.start + k;
      EdgeSource& edge =
          horizontal ? result.top.at(along, line.run.line) : result.left.at(line.run.line, along);
      if (line.learned) {
        edge.indices = {first.of_pixel(k), second.of_pixel(k)};
        continue;
      }
      const gm::EdgeWeights weights = gm::weights(line, k);
      edge.source = Source::kLine;
      edge.weight = {weights.first, weights.second};
      edge.span = line.span;
    }
  }
  return result;
}

std::array<std::uint8_t, 3> rgb(const tb::Rgba8& pixel) { return {pixel[0], pixel[1], pixel[2]}; }

}  // namespace

std::vector<WeightSample> samples_of(const ReferenceFrame& frame) {
  gm::MorphologicalGolden golden(gm::preset_parameters(spec::morphological::Preset::kDeburr));
  const tb::Image& image = frame.frame;
  golden.process({image.pixels, image.width, image.height});
  const Sources sources = sources_of(golden);
  std::vector<WeightSample> result;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      WeightSample sample;
      std::array<int, 2> span{};
      bool any = false;
      const auto take = [&](std::size_t i, const EdgePlane& plane, int edge_x, int edge_y,
                            std::size_t side, int to_x, int to_y) {
        if (edge_x >= image.width || edge_y >= image.height) return;
        const EdgeSource& edge = plane.at(edge_x, edge_y);
        if (edge.source == Source::kNone) return;
        any = true;
        sample.source[i] = edge.source;
        sample.indices[i] = edge.indices[side];
        sample.weight[i] = edge.weight[side];
        sample.neighbour[i] = rgb(image.at(to_x, to_y));
        if (edge.weight[side] != 0) span[i / 2] = std::max<int>(span[i / 2], edge.span);
      };
      take(0, sources.top, x, y, 1, x, y - 1);
      take(1, sources.top, x, y + 1, 0, x, y + 1);
      take(2, sources.left, x, y, 1, x - 1, y);
      take(3, sources.left, x + 1, y, 0, x + 1, y);
      if (!any) continue;
      sample.longer = static_cast<std::int8_t>(span[0] > span[1] ? 1 : span[0] < span[1] ? -1 : 0);
      sample.own = rgb(image.at(x, y));
      sample.reference = rgb(frame.reference.at(x, y));
      result.push_back(sample);
    }
  }
  return result;
}

}  // namespace deburr::studies::training
