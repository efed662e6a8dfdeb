// SPDX-License-Identifier: MIT
// Register map of the geometric engine: 32 bits each, byte addresses.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "spec/geometric/parameters.h"
#include "spec/registers.h"

namespace deburr::spec::geometric {

// The reason why the last START was rejected: the first one in this order that holds. Memory is
// then neither read nor written.
enum class Rejection : std::uint8_t {
  kNone,
  kDisabled,      // enable is 0 in the same write
  kSize,          // a side of 0 or over 8192
  kWidth,         // over line_pixels
  kTouchedWords,  // the frame needs more than touched_words
  kEdgeCount,     // over 2^24
  kVertexCount,   // over 2^24
  kFaceCount,     // over face_limit, with select = edges
  kBoundaryCount  // over EDGE_COUNT, with records = split
};
inline constexpr std::array<std::string_view, 9> kRejectionNames = {
    "none",       "disabled",     "size",       "width",         "touched_words",
    "edge_count", "vertex_count", "face_count", "boundary_count"};

namespace reg {
inline constexpr std::uint32_t kId = 0x00;
inline constexpr std::uint32_t kControl = 0x04;
inline constexpr std::uint32_t kStatus = 0x08;
inline constexpr std::uint32_t kSize = 0x0C;
inline constexpr std::uint32_t kConfiguration = 0x10;
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
inline constexpr std::uint32_t kRejection = 0x3C;
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
inline constexpr std::uint32_t kBoundaryCount = 0x98;
inline constexpr std::uint32_t kPairBase = 0x9C;
inline constexpr std::uint32_t kOtherPairBase = 0xA0;
inline constexpr std::uint32_t kCoarseBase = 0xA4;
inline constexpr std::uint32_t kIdValue = 0xDEB00005;

// Fields, lowest bit first. Codes are those of the enumerations in spec/geometric/.
namespace id {
inline constexpr std::array kFields = number(Access::kConstant, kIdValue);
}  // namespace id
namespace control {
inline constexpr Field kEnable{"enable", 0, 0, Access::kReadWrite, "enables the start of frames",
                               {},       1};
inline constexpr Field kClearCounters{"clear_counters", 1, 1, Access::kCommand,
                                      "sets every counter to 0"};
inline constexpr Field kStart{"start", 2, 2, Access::kCommand, "starts a frame; when idle only"};
inline constexpr std::array kFields = {kEnable, kClearCounters, kStart};
}  // namespace control
namespace status {
inline constexpr Field kIdle{"idle", 0, 0, Access::kReadOnly, "no frame in progress", {}, 1};
inline constexpr Field kFrameDone{"frame_done", 1, 1, Access::kWriteOneToClear,
                                  "a frame has been completed"};
inline constexpr Field kRejected{"refused", 2, 2, Access::kWriteOneToClear,
                                 "a start was rejected, see REJECTION"};
inline constexpr Field kMemoryError{"memory_error", 3, 3, Access::kWriteOneToClear,
                                    "a memory response had an error"};
inline constexpr Field kWrittenWhileBusy{
    "written_while_busy", 4, 4, Access::kWriteOneToClear,
    "a register was written while a frame was in progress; the write is ignored"};
inline constexpr Field kInvalidEdge{"invalid_edge", 5, 5, Access::kWriteOneToClear,
                                    "an edge has an index out of range"};
inline constexpr std::array kFields = {kIdle,        kFrameDone,        kRejected,
                                       kMemoryError, kWrittenWhileBusy, kInvalidEdge};
}  // namespace status
namespace size {
inline constexpr Field kWidth{"width", 13, 0, Access::kReadWrite, "pixels, 1..8192"};
inline constexpr Field kHeight{"height", 29, 16, Access::kReadWrite, "pixels, 1..8192"};
inline constexpr std::array kFields = {kWidth, kHeight};
}  // namespace size
namespace configuration {
inline constexpr Field kSelect{"select", 1, 0, Access::kReadWrite, {}, kSelectNames};
inline constexpr Field kCrease{"crease", 3, 2, Access::kReadWrite, {}, kCreaseNames};
inline constexpr Field kDepthTest{"depth_test", 5, 4, Access::kReadWrite, {}, kDepthTestNames};
inline constexpr Field kCombine{"combine", 7, 6, Access::kReadWrite, {}, kCombineNames};
inline constexpr Field kDepthBias{"depth_bias", 12, 8, Access::kReadWrite,
                                  "1..24; 0 counts as 1, more as 24"};
inline constexpr Field kMark{"mark", 13, 13, Access::kReadWrite,
                             "1: clear bit 0 of alpha of blended pixels"};
inline constexpr Field kLayout{"layout", 14, 14, Access::kReadWrite, {}, kLayoutNames};
inline constexpr Field kFrameCopy{"frame_copy", 15, 15, Access::kReadWrite,
                                  "1: blend from a copy of the frame"};
inline constexpr Field kCoverage{"coverage", 16, 16, Access::kReadWrite, {}, kCoverageNames};
inline constexpr Field kCull{"cull", 17, 17, Access::kReadWrite, {}, kCullNames};
inline constexpr Field kCreaseDepth{"crease_depth", 22, 18, Access::kReadWrite,
                                    "1..24; 0: creases of any depth, more counts as 24"};
inline constexpr Field kLinearLight{"linear_light", 23, 23, Access::kReadWrite,
                                    "1: blend in linear light"};
inline constexpr std::array kFields = {kSelect,    kCrease, kDepthTest,   kCombine,
                                       kDepthBias, kMark,   kLayout,      kFrameCopy,
                                       kCoverage,  kCull,   kCreaseDepth, kLinearLight};
}  // namespace configuration
namespace line_base {
inline constexpr Field kAddress = kLineAddress;
inline constexpr std::array kFields = {kAddress};
}  // namespace line_base
namespace rejection {
inline constexpr Field kReason{"reason", 3, 0, Access::kReadOnly, {}, kRejectionNames};
inline constexpr std::array kFields = {kReason};
}  // namespace rejection

inline constexpr std::uint32_t kControlEnable = control::kEnable.mask();
inline constexpr std::uint32_t kControlClearCounters = control::kClearCounters.mask();
inline constexpr std::uint32_t kControlStart = control::kStart.mask();
inline constexpr std::uint32_t kStatusIdle = status::kIdle.mask();
inline constexpr std::uint32_t kStatusFrameDone = status::kFrameDone.mask();
inline constexpr std::uint32_t kStatusRejected = status::kRejected.mask();
inline constexpr std::uint32_t kStatusMemoryError = status::kMemoryError.mask();
inline constexpr std::uint32_t kStatusWrittenWhileBusy = status::kWrittenWhileBusy.mask();
inline constexpr std::uint32_t kStatusInvalidEdge = status::kInvalidEdge.mask();
}  // namespace reg

// During a frame, writes are ignored, except to CONTROL and STATUS.
inline constexpr bool kBusyIgnoresWrites = true;
inline constexpr std::array<RegisterInfo, 42> kRegisters = {{
    {reg::kId, "ID", "Identifies the unit and the version of its register map.", reg::id::kFields},
    {reg::kControl, "CONTROL", "Enable bit and commands.", reg::control::kFields},
    {reg::kStatus, "STATUS", "State and events.", reg::status::kFields},
    {reg::kSize, "SIZE", "Size of the frame.", reg::size::kFields},
    {reg::kConfiguration, "CONFIG", "Configuration of the frame, and its memory layout.",
     reg::configuration::kFields},
    {reg::kEdgeCount, "EDGE_COUNT", "Records of the edge table, 0..2^24.", kNumber},
    {reg::kVertexCount, "VERTEX_COUNT", "Vertices, 0..2^24.", kNumber},
    {reg::kFaceCount, "FACE_COUNT", "Facing bits, 0..face_limit.", kNumber},
    {reg::kEdgeBase, "EDGE_BASE", "Byte address of the edge table.", reg::line_base::kFields},
    {reg::kVertexBase, "VERTEX_BASE", "Byte address of the vertices.", reg::line_base::kFields},
    {reg::kFaceBase, "FACE_BASE", "Byte address of the facing bits.", reg::line_base::kFields},
    {reg::kDepthBase, "DEPTH_BASE", "Byte address of the depth buffer.", reg::line_base::kFields},
    {reg::kColourBase, "COLOUR_BASE", "Byte address of the frame, blended in place.",
     reg::line_base::kFields},
    {reg::kWeightBase, "WEIGHT_BASE",
     "Byte address of the weight buffer, 64 bytes per block of 4 x 4 pixels.",
     reg::line_base::kFields},
    {reg::kCopyBase, "COPY_BASE",
     "Byte address of the buffer for a copy of the frame (frame_copy).", reg::line_base::kFields},
    {reg::kRejection, "REJECTION",
     "Reason of the last rejected start: the first that applies; 0: accepted.",
     reg::rejection::kFields},
    {reg::kEdges, "EDGES", "Edges read.", kCounter},
    {reg::kBoundaryEdges, "BOUNDARY_EDGES", "Boundary edges: edges of a single face.", kCounter},
    {reg::kSilhouetteEdges, "SILHOUETTE_EDGES",
     "Silhouette edges: between a front face and a back face.", kCounter},
    {reg::kBackEdges, "BACK_EDGES", "Edges of two back faces, dropped by cull.", kCounter},
    {reg::kCreaseEdges, "CREASE_EDGES",
     "Creases between two front faces, or back faces that are not culled.", kCounter},
    {reg::kFlatEdges, "FLAT_EDGES",
     "Flat edges between two front faces, or back faces that are not culled: not creases.",
     kCounter},
    {reg::kInvalidEdges, "INVALID_EDGES", "Edges with an index out of range.", kCounter},
    {reg::kKeptEdges, "KEPT_EDGES", "Edges whose vertices were fetched.", kCounter},
    {reg::kOutsideEdges, "OUTSIDE_EDGES", "Kept edges with a vertex that is not usable.", kCounter},
    {reg::kDegenerateEdges, "DEGENERATE_EDGES", "Kept edges whose two ends coincide.", kCounter},
    {reg::kEmptyEdges, "EMPTY_EDGES", "Kept edges that cover no column of the frame.", kCounter},
    {reg::kLines, "LINES", "Lines set up and walked.", kCounter},
    {reg::kColumns, "COLUMNS", "Columns walked.", kCounter},
    {reg::kGroups, "GROUPS", "Cycles in which the walkers step.", kCounter},
    {reg::kCandidates, "CANDIDATES", "Candidates: pixels that a line would blend with a neighbour.",
     kCounter},
    {reg::kPassed, "PASSED", "Candidates that passed the depth test.", kCounter},
    {reg::kBlocks, "BLOCKS", "Touched blocks of 4 x 4 pixels.", kCounter},
    {reg::kBlendedPixels, "BLENDED_PIXELS", "Blended pixels.", kCounter},
    {reg::kMemoryErrors, "MEMORY_ERRORS", "Memory responses with an error.", kCounter},
    {reg::kFrameCycles, "FRAME_CYCLES", "Cycles of the last frame, from start to end.", kCounter},
    {reg::kEdgeCycles, "EDGE_CYCLES",
     "Cycles of the last frame until all edges are drawn and all weights written back.", kCounter},
    {reg::kResolveCycles, "RESOLVE_CYCLES", "Cycles of the last frame after EDGE_CYCLES.",
     kCounter},
    {reg::kBoundaryCount, "BOUNDARY_COUNT",
     "Boundaries of the edge table, 0..EDGE_COUNT (records = split).", kNumber},
    {reg::kPairBase, "PAIR_BASE", "Byte address of the vertices of boundaries (records = split).",
     reg::line_base::kFields},
    {reg::kOtherPairBase, "OTHER_PAIR_BASE",
     "Byte address of the vertices of all other edges (records = split).", reg::line_base::kFields},
    {reg::kCoarseBase, "COARSE_BASE", "Byte address of the coarse depth (coarse_lines).",
     reg::line_base::kFields},
}};
static_assert(fields_are_in_order(kRegisters));

// CONFIG after a reset.
constexpr std::uint32_t configuration_word(const Parameters& p) {
  const auto code = [](auto value) { return static_cast<std::uint32_t>(value); };
  namespace configuration = reg::configuration;
  return configuration::kSelect.in(code(p.select)) | configuration::kCrease.in(code(p.crease)) |
         configuration::kDepthTest.in(code(p.depth_test)) |
         configuration::kCombine.in(code(p.combine)) |
         configuration::kLinearLight.in(code(p.linear_light)) |
         configuration::kDepthBias.in(code(p.depth_bias)) | configuration::kMark.in(code(p.mark)) |
         configuration::kLayout.in(code(p.layout)) |
         configuration::kFrameCopy.in(code(p.frame_copy)) |
         configuration::kCoverage.in(code(p.coverage)) | configuration::kCull.in(code(p.cull)) |
         configuration::kCreaseDepth.in(code(p.crease_depth));
}
// Registers whose reset values come from the parameters.
constexpr std::array<LoadedRegister, 1> loaded_registers(const Parameters& p) {
  return {{{reg::kConfiguration, configuration_word(p)}}};
}
constexpr std::uint32_t size_word(std::uint32_t width, std::uint32_t height) {
  return reg::size::kWidth.in(width) | reg::size::kHeight.in(height);
}

}  // namespace deburr::spec::geometric
