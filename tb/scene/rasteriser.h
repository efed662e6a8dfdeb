// SPDX-License-Identifier: MIT
// Converts a scene to the texture unit's input: 2 x 2 quads of fragments with rounded coordinates.
//
// Position  Before TextureUnit (docs/reference/scenes.md).
// Formats   Vertices 24.8, edge functions exact 64-bit integers with the top-left rule, coordinates
//           S7.24, perspective correct.
// Note      (s, t) at a pixel centre are computed from the edge functions in double with + - * /
//           and without contraction, so that a scene gives the same bits on every machine.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "spec/texture/packets.h"
#include "tb/scene/image.h"
#include "tb/scene/scenes.h"

namespace deburr::tb {

// Order of the quads within a triangle. Triangles keep the order of the mesh.
enum class Traversal : std::uint8_t {
  kRaster,   // rows of quads, top to bottom
  kTiles8x8  // 8 x 8 pixel tiles in rows, quads in rows inside a tile
};

enum class Visibility : std::uint8_t {
  kVisible,  // as after a depth pre-pass: at most one fragment per pixel, the nearest
  kOverdraw  // every fragment of every triangle, including hidden ones
};

struct RasterOptions {
  int width = 512, height = 512;  // pixels, 1..8192
  Traversal traversal = Traversal::kTiles8x8;
  Visibility visibility = Visibility::kVisible;
};

struct RasterCounts {
  std::uint64_t triangles = 0;   // of the mesh
  std::uint64_t outside = 0;     // entirely outside the picture or nearer than the near plane
  std::uint64_t clipped = 0;     // cut by the near plane or the guard band
  std::uint64_t degenerate = 0;  // zero area after snapping, or a vertex that is not finite
  std::uint64_t quads = 0;
  std::uint64_t fragments = 0;      // covered lanes
  std::uint64_t clamped_lanes = 0;  // lanes with a NaN, infinite or saturated coordinate
};

// A frame as a list of quads. quads[i].tag == i, so a colour's tag and lane give its pixel.
struct FragmentStream {
  int width = 0, height = 0;
  std::vector<spec::texture::Quad> quads;
  // Per quad, the lanes whose colour is visible: all covered lanes in kVisible, fewer in kOverdraw.
  std::vector<std::uint8_t> visible;
  DepthImage depth;  // near/w of the nearest surface at pixel centres, 0 for background
  RasterCounts counts;

  struct Pixel {
    int x, y;
  };
  Pixel pixel(std::uint32_t tag, int lane) const {
    return {quads[tag].x + (lane & 1), quads[tag].y + (lane >> 1)};
  }
};

// Throws ConfigError for a size outside 1..8192 or an invalid camera.
FragmentStream rasterise(const Scene& scene, const RasterOptions& options);

// Rounds a coordinate to S7.24, half up. NaN becomes 0, and values out of range saturate; in both
// cases `clamped` is set. Otherwise `clamped` does not change.
std::int32_t snap_coordinate(double coordinate, bool& clamped);

// Assembles a frame from colours by tag and lane. The background is the scene's sky.
class FrameAssembler {
 public:
  FrameAssembler(const FragmentStream& stream, const Scene& scene);
  // Throws CheckFailed for an unknown tag, an uncovered lane or a second colour for a lane.
  void put(const spec::texture::Colour& colour);
  std::uint64_t missing() const { return missing_; }  // covered lanes without a colour so far
  const Image& frame() const { return frame_; }

 private:
  const FragmentStream& stream_;
  Image frame_;
  std::vector<std::uint8_t> pending_;  // per quad: lanes still without a colour
  std::uint64_t missing_ = 0;
};

// The sky's colour at pixel row y (may be fractional) of a picture `height` pixels high.
Rgba8 sky(const Scene& scene, double y, int height);

}  // namespace deburr::tb
