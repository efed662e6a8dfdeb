// SPDX-License-Identifier: MIT
#include "tool/engines/geometric/geometric_pictures.h"

#include <algorithm>
#include <cstdint>
#include <vector>

#include "golden/geometric/classify.h"
#include "golden/geometric/line.h"
#include "golden/geometric/resolve.h"
#include "tool/run/pictures.h"

namespace deburr::tool {

using tb::Rgba8;

namespace {

using golden::geometric::LineFate;
using spec::geometric::EdgeClass;
using spec::geometric::LineRecord;

Rgba8 colour_of(EdgeClass c) {
  switch (c) {
    case EdgeClass::kBoundary:
      return {255, 220, 0, 255};
    case EdgeClass::kSilhouette:
      return {255, 40, 40, 255};
    case EdgeClass::kCrease:
      return {0, 220, 255, 255};
    default:
      return {255, 255, 255, 255};
  }
}

Rgba8 dimmed(const Rgba8& colour) {
  constexpr int kDim = 3;
  Rgba8 out = colour;
  for (std::size_t c = 0; c < 3; ++c) out[c] = static_cast<std::uint8_t>(colour[c] / kDim);
  return out;
}

Rgba8 dim_grey(const Rgba8& p) {
  const auto grey = static_cast<std::uint8_t>((p[0] + 2 * p[1] + p[2]) / 4);
  return dimmed({grey, grey, grey, 255});
}

// Visits the pixels of a line that lie in the frame, with the neighbour that each would blend with.
template <class Visit>
void walk(const LineRecord& line, int rows, Visit&& visit) {
  const bool horizontal = line.axis == spec::geometric::Axis::kHorizontal;
  std::int64_t position = line.position, depth = line.depth;
  for (int c = line.first; c < line.first + line.count;
       ++c, position += line.slope, depth += line.depth_step) {
    const auto [row, distance, d] = golden::geometric::point_at(position, depth);
    const int neighbour =
        row + (golden::geometric::is_forward(distance, line.tie_forward) ? 1 : -1);
    if (std::min(row, neighbour) < 0 || std::max(row, neighbour) >= rows) continue;
    if (horizontal)
      visit(c, row, c, neighbour, d);
    else
      visit(row, c, neighbour, c, d);
  }
}

}  // namespace

tb::Image weight_picture(int width, int height,
                         std::span<const spec::geometric::BlockRecord> blocks) {
  const tb::Image shape(width, height);
  std::vector<Weights> weights(shape.pixels.size());
  for (const spec::geometric::BlockRecord& block : blocks)
    for (std::size_t i = 0; i < block.weights.size(); ++i) {
      const int x = 4 * block.x + static_cast<int>(i % 4),
                y = 4 * block.y + static_cast<int>(i / 4);
      if (!(block.blended >> i & 1) || x >= width || y >= height) continue;
      const golden::geometric::Probe probe = golden::geometric::probe_of(block.weights[i]);
      weights[shape.index(x, y)] = {static_cast<std::uint8_t>(probe.first),
                                    static_cast<std::uint8_t>(probe.second), probe.left_right};
    }
  return weights_picture(width, height, weights);
}

tb::Image class_picture(const tb::geometric::Frame& frame,
                        const spec::geometric::Parameters& parameters) {
  const golden::geometric::FrameInput input = frame.input();
  const int width = frame.image.width, height = frame.image.height;
  tb::Image picture(width, height);
  std::transform(frame.image.pixels.begin(), frame.image.pixels.end(), picture.pixels.begin(),
                 dim_grey);
  // Visible lines are drawn over hidden ones.
  for (const bool seen : {false, true})
    for (const spec::geometric::Edge& edge : input.edges) {
      const EdgeClass c = golden::geometric::classify(
          parameters, edge, static_cast<std::uint32_t>(input.vertices.size()), input.facing);
      LineRecord line;
      if (!golden::geometric::is_kept(c) ||
          golden::geometric::set_up_line(input.vertices[edge.v0], input.vertices[edge.v1], width,
                                         height, line) != LineFate::kLine)
        continue;
      const Rgba8 colour = colour_of(c);
      const int rows = line.axis == spec::geometric::Axis::kHorizontal ? height : width;
      walk(line, rows, [&](int x, int y, int nx, int ny, std::uint32_t depth) {
        const bool passes = golden::geometric::passes(parameters, c == EdgeClass::kCrease, depth,
                                                      input.depth.at(x, y), input.depth.at(nx, ny));
        if (passes == seen) picture.at(x, y) = seen ? colour : dimmed(colour);
      });
    }
  return picture;
}

void add_edge_pictures(RunContext& context, const tb::geometric::Frame& frame,
                       const spec::geometric::Parameters& parameters,
                       std::span<const spec::geometric::BlockRecord> blocks,
                       const std::string& weights) {
  context.add_image(weights, weight_picture(frame.image.width, frame.image.height, blocks),
                    weights == "weights" ? "Weights" : "Weights along edges",
                    "weight of the upper or left neighbour red, of the lower or right one green, "
                    "blue where the two are left and right");
  context.add_image("classes", class_picture(frame, parameters), "Lines",
                    "boundaries yellow, silhouettes red, creases cyan, edges that are not "
                    "classified white; dark where the depth test fails");
}

}  // namespace deburr::tool
