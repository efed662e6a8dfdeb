// SPDX-License-Identifier: MIT
// Register map of the geometric engine: 32 bits each, byte addresses.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "spec/registers.h"

namespace deburr::spec::geometric {

namespace reg {
inline constexpr std::uint32_t kId = 0x00;
inline constexpr std::uint32_t kControl = 0x04;
inline constexpr std::uint32_t kStatus = 0x08;
inline constexpr std::uint32_t kSize = 0x0C;
inline constexpr std::uint32_t kRules = 0x10;
inline constexpr std::uint32_t kEdgeCount = 0x14;
inline constexpr std::uint32_t kVertexCount = 0x18;
inline constexpr std::uint32_t kFaceCount = 0x1C;
inline constexpr std::uint32_t kEdgeBase = 0x20;
inline constexpr std::uint32_t kVertexBase = 0x24;
inline constexpr std::uint32_t kFaceBase = 0x28;
inline constexpr std::uint32_t kDepthBase = 0x2C;
inline constexpr std::uint32_t kColourBase = 0x30;
inline constexpr std::uint32_t kWeightBase = 0x34;
inline constexpr std::uint32_t kCopyBase = 0x38;
inline constexpr std::uint32_t kRefusal = 0x3C;
inline constexpr std::uint32_t kEdges = 0x40;
inline constexpr std::uint32_t kBoundaryEdges = 0x44;
inline constexpr std::uint32_t kSilhouetteEdges = 0x48;
inline constexpr std::uint32_t kBackEdges = 0x4C;
inline constexpr std::uint32_t kCreaseEdges = 0x50;
inline constexpr std::uint32_t kFlatEdges = 0x54;
inline constexpr std::uint32_t kInvalidEdges = 0x58;
inline constexpr std::uint32_t kKeptEdges = 0x5C;
inline constexpr std::uint32_t kOutsideEdges = 0x60;
inline constexpr std::uint32_t kDegenerateEdges = 0x64;
inline constexpr std::uint32_t kEmptyEdges = 0x68;
inline constexpr std::uint32_t kLines = 0x6C;
inline constexpr std::uint32_t kColumns = 0x70;
inline constexpr std::uint32_t kGroups = 0x74;
inline constexpr std::uint32_t kCandidates = 0x78;
inline constexpr std::uint32_t kPassed = 0x7C;
inline constexpr std::uint32_t kBlocks = 0x80;
inline constexpr std::uint32_t kBlendedPixels = 0x84;
inline constexpr std::uint32_t kMemoryErrors = 0x88;
inline constexpr std::uint32_t kFrameCycles = 0x8C;
inline constexpr std::uint32_t kEdgeCycles = 0x90;
inline constexpr std::uint32_t kResolveCycles = 0x94;
inline constexpr std::uint32_t kIdValue = 0xDEB00003;
inline constexpr std::uint32_t kControlEnable = 1u << 0;
inline constexpr std::uint32_t kControlClearCounters = 1u << 1;
inline constexpr std::uint32_t kControlStart = 1u << 2;
inline constexpr std::uint32_t kStatusIdle = 1u << 0;
inline constexpr std::uint32_t kStatusFrameDone = 1u << 1;
inline constexpr std::uint32_t kStatusRefused = 1u << 2;
inline constexpr std::uint32_t kStatusMemoryError = 1u << 3;
inline constexpr std::uint32_t kStatusWrittenWhileBusy = 1u << 4;
inline constexpr std::uint32_t kStatusInvalidEdge = 1u << 5;
}  // namespace reg

// Why the last start was refused: the first that holds. Nothing is read or written then.
enum class Refusal : std::uint8_t {
  kNone,
  kDisabled,      // enable is 0 in the same write
  kSize,          // a side of 0 or over 8192
  kWidth,         // over line_pixels
  kTouchedWords,  // the frame needs more than touched_words
  kEdgeCount,     // over 2^24
  kVertexCount,   // over 2^24
  kFaceCount      // over face_limit, with select = edges
};
inline constexpr std::array<std::string_view, 8> kRefusalNames = {
    "none",          "disabled",   "size",         "width",
    "touched_words", "edge_count", "vertex_count", "face_count"};

// Reset values marked 0 with the access kReadWrite of RULES are loaded from the parameters at
// construction; bases read 0 in their low six bits.
inline constexpr std::array<RegisterInfo, 38> kRegisters = {{
    {reg::kId, "ID", Access::kReadOnly, reg::kIdValue,
     "Identifies the unit and the version of its register map."},
    {reg::kControl, "CONTROL", Access::kReadWrite, 1,
     "Bit 0 enable: frames may start. Bit 1 clear the counters (command, reads 0). Bit 2 start a "
     "frame (command, reads 0; when idle only)."},
    {reg::kStatus, "STATUS", Access::kWriteOneToClear, 1,
     "Bit 0 idle: no frame under way (read only). Sticky: bit 1 frame done, bit 2 start refused, "
     "bit 3 memory error response, bit 4 register written while a frame was under way (the write "
     "is ignored), bit 5 edge with an index out of range."},
    {reg::kSize, "SIZE", Access::kReadWrite, 0,
     "Width [13:0] and height [29:16] of the frame in pixels, 1..8192 each."},
    {reg::kRules, "RULES", Access::kReadWrite, 0,
     "select [0], crease [3:2], depth_test [5:4], combine [6], linear_light [7], depth_bias "
     "[12:8], "
     "mark [13], layout [14], frame_copy [15]."},
    {reg::kEdgeCount, "EDGE_COUNT", Access::kReadWrite, 0, "Records of the edge table, 0..2^24."},
    {reg::kVertexCount, "VERTEX_COUNT", Access::kReadWrite, 0, "Vertices, 0..2^24."},
    {reg::kFaceCount, "FACE_COUNT", Access::kReadWrite, 0, "Facing bits, 0..face_limit."},
    {reg::kEdgeBase, "EDGE_BASE", Access::kReadWrite, 0, "Byte address of the edge table."},
    {reg::kVertexBase, "VERTEX_BASE", Access::kReadWrite, 0, "Byte address of the vertices."},
    {reg::kFaceBase, "FACE_BASE", Access::kReadWrite, 0, "Byte address of the facing bits."},
    {reg::kDepthBase, "DEPTH_BASE", Access::kReadWrite, 0, "Byte address of the depth buffer."},
    {reg::kColourBase, "COLOUR_BASE", Access::kReadWrite, 0,
     "Byte address of the frame, which is blended in place."},
    {reg::kWeightBase, "WEIGHT_BASE", Access::kReadWrite, 0,
     "Byte address of room for the weights, 64 bytes a block of 4 x 4 pixels."},
    {reg::kCopyBase, "COPY_BASE", Access::kReadWrite, 0,
     "Byte address of room for a copy of the frame (frame_copy)."},
    {reg::kRefusal, "REFUSAL", Access::kReadOnly, 0,
     "Why the last start was refused [3:0]: 0 it was not, 1 disabled, 2 size, 3 width over "
     "line_pixels, 4 more blocks than touched_words hold, 5 edge, 6 vertex, 7 face count."},
    {reg::kEdges, "EDGES", Access::kReadOnly, 0, "Edges read."},
    {reg::kBoundaryEdges, "BOUNDARY_EDGES", Access::kReadOnly, 0, "Edges of a single face."},
    {reg::kSilhouetteEdges, "SILHOUETTE_EDGES", Access::kReadOnly, 0,
     "Edges between a face turned to the eye and one turned away."},
    {reg::kBackEdges, "BACK_EDGES", Access::kReadOnly, 0, "Edges of two faces turned away."},
    {reg::kCreaseEdges, "CREASE_EDGES", Access::kReadOnly, 0,
     "Creases between two faces turned to the eye."},
    {reg::kFlatEdges, "FLAT_EDGES", Access::kReadOnly, 0,
     "Edges between two faces turned to the eye that are no crease."},
    {reg::kInvalidEdges, "INVALID_EDGES", Access::kReadOnly, 0,
     "Edges with an index out of range."},
    {reg::kKeptEdges, "KEPT_EDGES", Access::kReadOnly, 0, "Edges whose vertices were fetched."},
    {reg::kOutsideEdges, "OUTSIDE_EDGES", Access::kReadOnly, 0,
     "Kept edges with a vertex that is not usable."},
    {reg::kDegenerateEdges, "DEGENERATE_EDGES", Access::kReadOnly, 0,
     "Kept edges with both ends in one place."},
    {reg::kEmptyEdges, "EMPTY_EDGES", Access::kReadOnly, 0,
     "Kept edges without a column of the frame."},
    {reg::kLines, "LINES", Access::kReadOnly, 0, "Lines set up and walked."},
    {reg::kColumns, "COLUMNS", Access::kReadOnly, 0, "Columns walked."},
    {reg::kGroups, "GROUPS", Access::kReadOnly, 0, "Clocks in which the walkers stepped."},
    {reg::kCandidates, "CANDIDATES", Access::kReadOnly, 0,
     "Pixels that a line would blend with a neighbour."},
    {reg::kPassed, "PASSED", Access::kReadOnly, 0, "Candidates that passed the depth test."},
    {reg::kBlocks, "BLOCKS", Access::kReadOnly, 0, "Blocks of 4 x 4 pixels that were touched."},
    {reg::kBlendedPixels, "BLENDED_PIXELS", Access::kReadOnly, 0, "Pixels that were blended."},
    {reg::kMemoryErrors, "MEMORY_ERRORS", Access::kReadOnly, 0, "Memory responses with an error."},
    {reg::kFrameCycles, "FRAME_CYCLES", Access::kReadOnly, 0,
     "Clocks of the last frame, from its start to its end."},
    {reg::kEdgeCycles, "EDGE_CYCLES", Access::kReadOnly, 0,
     "Of these until every edge was drawn and every weight written back."},
    {reg::kResolveCycles, "RESOLVE_CYCLES", Access::kReadOnly, 0, "Of these the rest."},
}};

}  // namespace deburr::spec::geometric
