// SPDX-License-Identifier: MIT
// Memory records of the geometric engine: vertices, edges, facing bits, buffers of pixels and
// weights. Little-endian 32-bit words. Meaning and addresses: docs/reference/geometric/memory.md.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace deburr::spec::geometric {

inline constexpr int kLineBytes = 64;  // line of memory; every base address is a multiple of it

// ---- Vertices: 16 bytes, four per line
inline constexpr int kVertexBytes = 16;
inline constexpr int kVerticesInLine = 4;
struct Vertex {
  std::int32_t x = 0, y = 0;  // words 0, 1: S.8 pixels, snapped
  std::uint32_t depth = 0;    // word 2, bits 23..0
  bool usable = false;        // word 3, bit 0
  friend bool operator==(const Vertex&, const Vertex&) = default;
};

// ---- Edges: 16 bytes, four per line
inline constexpr int kEdgeBytes = 16;
inline constexpr int kEdgesInLine = 4;
inline constexpr std::uint32_t kIndexMask = 0xFFFFFF;  // of vertices and faces
inline constexpr int kFlagShift = 24;                  // in word 2
namespace flag {
inline constexpr std::uint8_t kBoundary = 1u << 0;      // one face, or two faces that do not agree
inline constexpr std::uint8_t kAngle = 1u << 1;         // eq (4): N1 . N2 <= 0.99
inline constexpr std::uint8_t kSplitNormals = 1u << 2;  // shaded with different normals
inline constexpr std::uint8_t kSeam = 1u << 3;          // different material or texture coordinates
}  // namespace flag
struct Edge {
  std::uint32_t v0 = 0, v1 = 0;  // words 0, 1: vertices, bits 23..0
  std::uint32_t f0 = 0, f1 = 0;  // words 2, 3: faces, bits 23..0; f1 is ignored at a boundary
  std::uint8_t flags = 0;        // word 2, bits 31..24
  friend bool operator==(const Edge&, const Edge&) = default;
};

// ---- Edges in two arrays (records = split): 6 bytes each, ten per line
// The last four bytes of a line are ignored. Bit i of a record is bit i of its bytes, lowest byte
// first.
inline constexpr int kSplitBytes = 6;
inline constexpr int kSplitInLine = 10;
// Faces and flags of all edges.
inline constexpr int kSplitFaceBits = 21;  // f0 in bits 20..0, then f1
inline constexpr std::uint32_t kSplitFaceMask = (1u << kSplitFaceBits) - 1;
inline constexpr int kSplitFlagShift = 2 * kSplitFaceBits;  // bits 45..42
// Vertices; boundaries and other edges in separate arrays. v0 in bits 23..0, then v1.
inline constexpr int kSplitVertexBits = 24;

// ---- Coarse depth: a lower bound of the depths in a tile of 8 x 8 pixels, 16 bits per tile
inline constexpr int kCoarseBytes = 2;
inline constexpr int kCoarseShift = 8;   // from depth to coarse depth
inline constexpr int kCoarseAcross = 8;  // tiles per line
inline constexpr int kCoarseDown = 4;

// ---- Facing bits: face f is bit f & 7 of byte f >> 3; 1: front face
inline constexpr int kFacesInLine = 512;

// ---- Pixels: 4 bytes each
inline constexpr int kPixelBytes = 4;
inline constexpr int kPixelsInLine = 16;
// Byte of a pixel's weights word.
enum class Direction : std::uint8_t { kUp, kDown, kLeft, kRight };
inline constexpr std::array<std::string_view, 4> kDirectionNames = {"up", "down", "left", "right"};

// ---- Classes of edges
enum class EdgeClass : std::uint8_t {
  kInvalid,  // an index is out of range: dropped
  kBoundary,
  kSilhouette,
  kBack,  // both faces are back faces, cull = back: dropped
  kCrease,
  kFlat,         // dropped
  kUnclassified  // select = all, not a boundary
};
inline constexpr std::array<std::string_view, 7> kEdgeClassNames = {
    "invalid", "boundary", "silhouette", "back", "crease", "flat", "unclassified"};

}  // namespace deburr::spec::geometric
