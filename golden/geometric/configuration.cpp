// SPDX-License-Identifier: MIT
#include "golden/geometric/configuration.h"

#include <string>

#include "spec/error.h"

namespace deburr::golden::geometric {

using spec::geometric::Rejection;

Rejection rejection(const spec::geometric::Parameters& p, const FrameCounts& counts) {
  constexpr int kMax = spec::geometric::kMaxFrameSize;
  if (counts.width < 1 || counts.height < 1 || counts.width > kMax || counts.height > kMax)
    return Rejection::kSize;
  if (counts.width > p.line_pixels) return Rejection::kWidth;
  if (touched_words(counts.width, counts.height) > p.touched_words) return Rejection::kTouchedWords;
  if (counts.edge_count > spec::geometric::kMaxEdges) return Rejection::kEdgeCount;
  if (counts.vertex_count > spec::geometric::kMaxVertices) return Rejection::kVertexCount;
  if (p.select == spec::geometric::Select::kEdges &&
      counts.face_count > static_cast<std::uint64_t>(p.face_limit))
    return Rejection::kFaceCount;
  if (p.records == spec::geometric::RecordsLayout::kSplit &&
      counts.boundary_count > counts.edge_count)
    return Rejection::kBoundaryCount;
  return Rejection::kNone;
}

void check_frame(const spec::geometric::Parameters& p, const FrameCounts& counts) {
  const std::string frame = "a frame of " + std::to_string(counts.width) + " x " +
                            std::to_string(counts.height) + " pixels";
  switch (rejection(p, counts)) {
    case Rejection::kNone:
    case Rejection::kDisabled:
      return;
    case Rejection::kSize:
      throw spec::ConfigError(frame + "; width and height must be 1..8192");
    case Rejection::kWidth:
      throw spec::ConfigError(frame + " is wider than the row buffers of " +
                              std::to_string(p.line_pixels) + " pixels; raise line_pixels");
    case Rejection::kTouchedWords:
      throw spec::ConfigError(frame + " needs " +
                              std::to_string(touched_words(counts.width, counts.height)) +
                              " touched words, but the build has " +
                              std::to_string(p.touched_words) + "; raise touched_words");
    case Rejection::kEdgeCount:
      throw spec::ConfigError(std::to_string(counts.edge_count) + " edges; the limit is 2^24");
    case Rejection::kVertexCount:
      throw spec::ConfigError(std::to_string(counts.vertex_count) + " vertices; the limit is 2^24");
    case Rejection::kFaceCount:
      throw spec::ConfigError(std::to_string(counts.face_count) +
                              " faces, but the build stores facing bits for " +
                              std::to_string(p.face_limit) + "; raise face_limit");
    case Rejection::kBoundaryCount:
      throw spec::ConfigError(std::to_string(counts.boundary_count) + " boundary edges, but only " +
                              std::to_string(counts.edge_count) + " edges");
  }
}

}  // namespace deburr::golden::geometric
