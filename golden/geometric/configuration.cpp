// SPDX-License-Identifier: MIT
#include "golden/geometric/configuration.h"

#include <string>

#include "spec/error.h"
#include "spec/geometric/records.h"
#include "spec/range_check.h"

namespace deburr::golden::geometric {

using spec::geometric::Refusal;

spec::geometric::Parameters preset_parameters(spec::geometric::Preset preset) {
  spec::geometric::Parameters p;
  for (const spec::geometric::PresetRow& row : spec::geometric::kPresets) {
    if (row.preset != preset) continue;
    p.preset = row.preset;
    p.select = row.select;
    p.crease = row.crease;
    p.combine = row.combine;
    p.frame_copy = row.frame_copy;
  }
  return p;
}

void check_parameters(const spec::geometric::Parameters& parameters) {
  spec::geometric::Parameters p = parameters;
  const spec::RangeCheck ranges{"geometric"};
  describe(p, ranges);
  if (p.pipelined && p.reciprocal_table != 0) {
    throw spec::ConfigError("geometric reciprocal_table = " + std::to_string(p.reciprocal_table) +
                            " has no effect beside pipelined dividers; set one of them to 0");
  }
  if (p.fills > p.memory_outstanding) {
    throw spec::ConfigError("geometric fills = " + std::to_string(p.fills) +
                            " exceeds memory.outstanding = " +
                            std::to_string(p.memory_outstanding) + "; raise that or lower fills");
  }
  if (p.face_limit % spec::geometric::kFacesInLine != 0) {
    throw spec::ConfigError("geometric face_limit = " + std::to_string(p.face_limit) +
                            " does not fill its banks; use a multiple of " +
                            std::to_string(spec::geometric::kFacesInLine));
  }
}

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
  }
}

}  // namespace deburr::golden::geometric
