// SPDX-License-Identifier: MIT
#include "golden/geometric/configuration.h"

#include <string>

#include "spec/error.h"

namespace deburr::golden::geometric {

using spec::geometric::Refusal;

Refusal refusal(const spec::geometric::Parameters& p, const FrameCounts& counts) {
  constexpr int kMax = spec::geometric::kMaxFrameSize;
  if (counts.width < 1 || counts.height < 1 || counts.width > kMax || counts.height > kMax)
    return Refusal::kSize;
  if (counts.width > p.line_pixels) return Refusal::kWidth;
  if (touched_words(counts.width, counts.height) > p.touched_words) return Refusal::kTouchedWords;
  if (counts.edge_count > spec::geometric::kMaxEdges) return Refusal::kEdgeCount;
  if (counts.vertex_count > spec::geometric::kMaxVertices) return Refusal::kVertexCount;
  if (p.select == spec::geometric::Select::kEdges &&
      counts.face_count > static_cast<std::uint64_t>(p.face_limit))
    return Refusal::kFaceCount;
  if (p.records == spec::geometric::RecordsLayout::kSplit &&
      counts.boundary_count > counts.edge_count)
    return Refusal::kBoundaryCount;
  return Refusal::kNone;
}

void check_frame(const spec::geometric::Parameters& p, const FrameCounts& counts) {
  const std::string frame = "a frame of " + std::to_string(counts.width) + " x " +
                            std::to_string(counts.height) + " pixels";
  switch (refusal(p, counts)) {
    case Refusal::kNone:
    case Refusal::kDisabled:
      return;
    case Refusal::kSize:
      throw spec::ConfigError(frame + "; 1..8192 each way are possible");
    case Refusal::kWidth:
      throw spec::ConfigError(frame + " does not fit rows of " + std::to_string(p.line_pixels) +
                              " pixels; raise line_pixels");
    case Refusal::kTouchedWords:
      throw spec::ConfigError(frame + " needs " +
                              std::to_string(touched_words(counts.width, counts.height)) +
                              " touched words, the build has " + std::to_string(p.touched_words) +
                              "; raise touched_words");
    case Refusal::kEdgeCount:
      throw spec::ConfigError(std::to_string(counts.edge_count) +
                              " edges; at most 2^24 are possible");
    case Refusal::kVertexCount:
      throw spec::ConfigError(std::to_string(counts.vertex_count) +
                              " vertices; at most 2^24 are possible");
    case Refusal::kFaceCount:
      throw spec::ConfigError(std::to_string(counts.face_count) +
                              " faces, the build holds the facing bits of " +
                              std::to_string(p.face_limit) + "; raise face_limit");
    case Refusal::kBoundaryCount:
      throw spec::ConfigError(std::to_string(counts.boundary_count) + " boundaries of " +
                              std::to_string(counts.edge_count) + " edges");
  }
}

}  // namespace deburr::golden::geometric
