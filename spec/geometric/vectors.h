// SPDX-License-Identifier: MIT
// Test vectors of the geometric engine: golden model and RTL model must both produce them. The
// tables of docs/reference/geometric/vectors.md and algorithm.md are made from them. For the
// contents of frames and hashes see docs/reference/geometric/vectors.md.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "spec/geometric/packets.h"
#include "spec/geometric/parameters.h"

namespace deburr::spec::geometric {

// ---- frames -------------------------------------------------------------------------------------

// Base addresses of the regions, in the order of Region.
inline constexpr std::array<std::uint32_t, 9> kVectorBases = {
    0x30000, 0x10000, 0x20000, 0x40000, 0x60000, 0x50000, 0x70000, 0x80000, 0x90000};

struct FrameHashes {
  std::uint64_t pixels = 0, weights = 0, traffic = 0;
};

// Lines of memory; with frame_copy colours are read from the copy.
struct FrameLines {
  std::uint64_t vertex_reads = 0, depth_reads = 0, weight_reads = 0, weight_writes = 0,
                colour_reads = 0, colour_writes = 0;
};

struct FrameResult {
  FrameHashes hashes;
  Work work;
  FrameLines lines;

  template <class Self, class Visit>
  static constexpr void fields(Self& self, Visit&& visit) {
    visit("pixels", self.hashes.pixels);
    visit("weights", self.hashes.weights);
    visit("traffic", self.hashes.traffic);
    visit("edges", self.work.edges);
    visit("boundary", self.work.boundary_edges);
    visit("silhouette", self.work.silhouette_edges);
    visit("back", self.work.back_edges);
    visit("crease", self.work.crease_edges);
    visit("flat", self.work.flat_edges);
    visit("invalid", self.work.invalid_edges);
    visit("kept", self.work.kept_edges);
    visit("outside", self.work.outside_edges);
    visit("degenerate", self.work.degenerate_edges);
    visit("empty", self.work.empty_edges);
    visit("lines", self.work.lines);
    visit("columns", self.work.columns);
    visit("groups", self.work.groups);
    visit("candidates", self.work.candidates);
    visit("passed", self.work.passed);
    visit("blocks", self.work.blocks);
    visit("blended", self.work.blended_pixels);
    visit("vertex lines read", self.lines.vertex_reads);
    visit("depth lines read", self.lines.depth_reads);
    visit("weight lines read", self.lines.weight_reads);
    visit("weight lines written", self.lines.weight_writes);
    visit("colour lines read", self.lines.colour_reads);
    visit("colour lines written", self.lines.colour_writes);
  }
};

// Frames with random edges, with special cases, and with random edges and depths that differ from
// tile to tile.
enum class DrawnFrame : std::uint8_t { kRandom, kSpecial, kTiles };

struct FrameVector {
  char name;
  Preset preset;
  // Settings in addition to the preset, with the names and values of describe(): "walkers=1
  // mark=true".
  std::string_view settings;
  FrameResult result;
  DrawnFrame frame = DrawnFrame::kRandom;
};

inline constexpr std::array<FrameVector, 14> kFrameVectors = {{
    {'a',
     Preset::kDeburr,
     "",
     {{0x5ed6d27b9e2a4100, 0x16a62fc078e0ae10, 0x571e3afbe575aa9a},
      {300, 164, 63, 0, 38, 23, 12, 265, 5, 1, 17, 242, 7197, 2518, 8652, 5903, 191, 2296},
      {50, 779, 424, 424, 616, 191}}},
    {'b',
     Preset::kDeburr,
     "layout=raster",
     {{0x5ed6d27b9e2a4100, 0x16a62fc078e0ae10, 0xb1c2a4710f9f495d},
      {300, 164, 63, 0, 38, 23, 12, 265, 5, 1, 17, 242, 7197, 2518, 8652, 5903, 191, 2296},
      {50, 1183, 424, 424, 1006, 693}}},
    {'c',
     Preset::kDeburr,
     "walkers=1 depth_lines=16 weight_blocks=16 vertex_lines=16",
     {{0x5ed6d27b9e2a4100, 0x16a62fc078e0ae10, 0x2a2c504267ddbd78},
      {300, 164, 63, 0, 38, 23, 12, 265, 5, 1, 17, 242, 7197, 7197, 8652, 5903, 191, 2296},
      {371, 2546, 1741, 1741, 616, 191}}},
    {'d',
     Preset::kDeburr,
     "layout=raster walkers=2 depth_lines=16 weight_blocks=16 vertex_lines=16",
     {{0x5ed6d27b9e2a4100, 0x16a62fc078e0ae10, 0x0efc7f9ab80cae10},
      {300, 164, 63, 0, 38, 23, 12, 265, 5, 1, 17, 242, 7197, 4076, 8652, 5903, 191, 2296},
      {371, 4286, 1741, 1741, 1006, 693}}},
    {'e',
     Preset::kGpaaOptimised,
     "",
     {{0x31c35ac184f4e760, 0xbadcaac952dfc9ed, 0x9273c837cbb2c537},
      {300, 164, 63, 29, 16, 16, 12, 243, 5, 1, 15, 222, 6607, 2311, 5861, 4683, 191, 2126},
      {50, 707, 421, 421, 535, 191}}},
    {'f',
     Preset::kGpaa,
     "",
     {{0x9e2d94b3be2f9be4, 0x9d0d9b07b9151d21, 0xe27e145fd8e2b753},
      {300, 166, 0, 0, 0, 0, 4, 296, 5, 1, 18, 272, 8105, 2864, 7264, 5815, 191, 2302},
      {50, 871, 539, 539, 574, 191}}},
    {'g',
     Preset::kDeburr,
     "crease=off depth_test=own depth_bias=4 linear_light=false mark=true layout=raster walkers=2",
     {{0xa96fbaf32b65ea70, 0x58b5b54147af84d5, 0xa166da0c2e741042},
      {300, 164, 63, 0, 0, 61, 12, 227, 5, 1, 15, 206, 6087, 3446, 7251, 4699, 187, 2046},
      {50, 914, 355, 355, 971, 678}}},
    {'h',
     Preset::kDeburr,
     "select=all depth_test=off layout=raster weight_blocks=16",
     {{0xccf39e26309ee826, 0xa96b27c79b5369ab, 0xb7f71132189fd2cd},
      {300, 166, 0, 0, 0, 0, 4, 296, 5, 1, 18, 272, 8105, 2864, 9861, 9861, 191, 2591},
      {50, 0, 2546, 2546, 1093, 709}}},
    {'i',
     Preset::kDeburr,
     "cull=back coverage=distance crease_depth=0 combine=max",
     {{0xbfce4abe8f3b22f8, 0x6cc78624e74c2575, 0x05d525abe62406ac},
      {300, 164, 63, 29, 20, 12, 12, 247, 5, 1, 15, 226, 6686, 2332, 5953, 4779, 191, 2148},
      {50, 722, 438, 438, 579, 191}}},
    {'j',
     Preset::kDeburr,
     "coverage=distance",
     {{0x333871257333fe44, 0xb22368e821dbef00, 0x35730eba333a6421},
      {300, 164, 63, 0, 38, 23, 12, 265, 5, 1, 17, 242, 7197, 2518, 6429, 4401, 191, 2092},
      {50, 777, 394, 394, 579, 191}}},
    {'k',
     Preset::kDeburr,
     "crease_depth=0 cull=back",
     {{0xe4683f37ede5a63d, 0x0c416ca7daa7f504, 0xf64acdb637477706},
      {300, 164, 63, 29, 20, 12, 12, 247, 5, 1, 15, 226, 6686, 2332, 7980, 6375, 191, 2337},
      {50, 722, 464, 464, 619, 191}}},
    {'l',
     Preset::kDeburr,
     "combine=max",
     {{0x72cc2e5d349d5fa1, 0x1292f5074da19250, 0x1b4803bc35ca3e95},
      {300, 164, 63, 0, 38, 23, 12, 265, 5, 1, 17, 242, 7197, 2518, 8652, 5903, 191, 2296},
      {50, 779, 424, 424, 600, 191}}},
    {'m',
     Preset::kDeburr,
     "layout=raster walkers=1 depth_lines=16 weight_blocks=16 vertex_lines=16",
     {{0x5ed6d27b9e2a4100, 0x16a62fc078e0ae10, 0x0efc7f9ab80cae10},
      {300, 164, 63, 0, 38, 23, 12, 265, 5, 1, 17, 242, 7197, 7197, 8652, 5903, 191, 2296},
      {371, 4286, 1741, 1741, 1006, 693}}},
    {'n',
     Preset::kGpaa,
     "coverage=area depth_test=own",
     {{0x90df2ff5e5d7e9c7, 0x493a9c50771b9a09, 0xfb4b920d3d9abd4a},
      {300, 166, 0, 0, 0, 0, 4, 296, 5, 1, 18, 272, 8105, 2864, 9861, 6107, 188, 2212},
      {50, 729, 499, 499, 564, 188}}},
}};

inline constexpr std::array<FrameVector, 5> kSpecialFrameVectors = {{
    {'o',
     Preset::kDeburr,
     "crease_depth=4",
     {{0x2495477cdae39ac0, 0xa90bab035ef40c41, 0x4e75161c123618bc},
      {400, 188, 101, 0, 71, 40, 0, 360, 0, 2, 29, 329, 9397, 3238, 11314, 7042, 190, 2349},
      {50, 1004, 584, 584, 624, 190}},
     DrawnFrame::kSpecial},
    {'p',
     Preset::kDeburr,
     "layout=raster combine=max crease_depth=24 depth_bias=24",
     {{0x3f443a1d1bc5c5b9, 0x19b3de1900247c4e, 0xcc33a4233c4d3735},
      {400, 188, 101, 0, 71, 40, 0, 360, 0, 2, 29, 329, 9397, 3238, 11314, 6863, 190, 2326},
      {50, 1433, 569, 569, 1001, 681}},
     DrawnFrame::kSpecial},
    {'q',
     Preset::kGpaaOptimised,
     "crease=shading crease_depth=2 depth_bias=1",
     {{0xc3c9a5c2f838df62, 0x1bdab728dbe111fe, 0x41a5fe49bcd98c26},
      {400, 188, 101, 34, 49, 28, 0, 338, 0, 2, 28, 308, 8953, 3073, 8013, 6715, 190, 2372},
      {50, 964, 603, 603, 574, 190}},
     DrawnFrame::kSpecial},
    {'r',
     Preset::kGpaa,
     "coverage=area depth_test=own combine=max",
     {{0xa33109c3983d3a9a, 0x42c17af4f1c640c2, 0x9b178edac3fcf009},
      {400, 188, 0, 0, 0, 0, 0, 400, 0, 2, 33, 365, 10329, 3571, 12464, 6730, 188, 2172},
      {50, 919, 633, 633, 625, 188}},
     DrawnFrame::kSpecial},
    {'s',
     Preset::kDeburr,
     "crease=off linear_light=false mark=true",
     {{0xe892a8a7865272d2, 0xb41509b418bd4bea, 0x7d94d4ca836e4b9f},
      {400, 188, 101, 0, 0, 111, 0, 289, 0, 2, 23, 264, 7778, 2670, 9358, 6875, 190, 2333},
      {50, 876, 565, 565, 618, 190}},
     DrawnFrame::kSpecial},
}};

// Options for less traffic: docs/reference/geometric/memory.md.
inline constexpr std::array<FrameVector, 7> kTrafficFrameVectors = {{
    {'t',
     Preset::kDeburr,
     "colour_lines=8",
     {{0x5ed6d27b9e2a4100, 0x16a62fc078e0ae10, 0x55e3ff5251e538dd},
      {300, 164, 63, 0, 38, 23, 12, 265, 5, 1, 17, 242, 7197, 2518, 8652, 5903, 191, 2296},
      {50, 779, 424, 424, 444, 191}},
     DrawnFrame::kRandom},
    {'u',
     Preset::kDeburr,
     "records=split",
     {{0x5ed6d27b9e2a4100, 0x16a62fc078e0ae10, 0x6ea0d38514a92564},
      {300, 165, 65, 0, 39, 23, 12, 265, 5, 1, 17, 242, 7197, 2518, 8652, 5903, 191, 2296},
      {50, 779, 424, 424, 616, 191}},
     DrawnFrame::kRandom},
    {'v',
     Preset::kDeburr,
     "weight_blocks=16 write_buffer=4",
     {{0x5ed6d27b9e2a4100, 0x16a62fc078e0ae10, 0x6f5bf9a57d7ea4be},
      {300, 164, 63, 0, 38, 23, 12, 265, 5, 1, 17, 242, 7197, 2518, 8652, 5903, 191, 2296},
      {50, 779, 1710, 1710, 616, 191}},
     DrawnFrame::kRandom},
    {'w',
     Preset::kDeburr,
     "coarse_lines=4",
     {{0x3a5e377c1619f2d7, 0xb7269645d77de7a3, 0x95da7193b96be1c4},
      {300, 164, 63, 0, 38, 23, 12, 265, 5, 1, 17, 242, 7197, 2518, 8652, 4340, 172, 1906},
      {50, 480, 245, 245, 527, 172}},
     DrawnFrame::kTiles},
    {'x',
     Preset::kDeburr,
     "layout=raster walkers=2 records=split colour_lines=5 weight_blocks=16 write_buffer=3",
     {{0xcc605cb6d13cf759, 0xfc0fc445c794351b, 0xca392f17edf7c3d7},
      {400, 188, 101, 0, 71, 40, 0, 360, 0, 2, 29, 329, 9397, 5277, 11314, 7085, 190, 2350},
      {50, 1433, 2247, 2247, 737, 683}},
     DrawnFrame::kSpecial},
    {'y',
     Preset::kGpaaOptimised,
     "select=mesh colour_lines=8 weight_blocks=16 write_buffer=2 records=split",
     {{0x2f31ff2736b88364, 0xcf3fe65b4a95f09f, 0x2036689968a66ae1},
      {300, 167, 0, 0, 65, 68, 3, 229, 4, 1, 13, 211, 6370, 2230, 5697, 4562, 190, 2106},
      {50, 677, 1681, 1681, 416, 190}},
     DrawnFrame::kRandom},
    {'z',
     Preset::kDeburr,
     "select=mesh crease_depth=0 combine=max depth_test=own depth_lines=16 coarse_lines=4",
     {{0x03830b9e874438f3, 0x8b82d5265c309300, 0x4f92b86ddb8c28bb},
      {300, 166, 0, 0, 86, 44, 4, 252, 4, 1, 14, 233, 6879, 2417, 8266, 4658, 167, 1916},
      {50, 1121, 275, 275, 515, 167}},
     DrawnFrame::kTiles},
}};

// ---- lines --------------------------------------------------------------------------------------

inline constexpr int kLineVectorWidth = 1280, kLineVectorHeight = 720;

struct LineEnd {
  std::int32_t major, minor;  // 1/256 pixel
  std::uint32_t depth;
};

struct LineResult {
  std::int64_t first = 0, count = 0, position = 0, slope = 0, depth = 0, step = 0;

  template <class Self, class Visit>
  static constexpr void fields(Self& self, Visit&& visit) {
    visit("first", self.first);
    visit("count", self.count);
    visit("position", self.position);
    visit("slope", self.slope);
    visit("depth", self.depth);
    visit("step", self.step);
  }
};

struct LineVector {
  LineEnd a, b;  // in either order
  Axis axis;     // major axis
  LineResult result;
};

inline constexpr std::array<LineVector, 10> kLineVectors = {{
    {{2624, 128, 1000000},
     {5184, 1408, 2000000},
     Axis::kHorizontal,
     {10, 10, 10485888, 8388608, 4198399902, 409599975}},
    {{7000, 100, 16777215},
     {200000, -30000, 5},
     Axis::kVertical,
     {27, 693, 6144893, -2616550, 68705230854, -91151183}},
    {{-4194304, -1000, 3000000},
     {4194303, 150000, 9000000},
     Axis::kHorizontal,
     {0, 1280, 4882583128, 302000, 24576376464, 750000}},
    {{128, 1000, 77777}, {129, 1000, 77777}, Axis::kHorizontal, {0, 1, 65536128, 0, 318574592, 0}},
    {{1000, 1000, 500},
     {1700, 700, 90000},
     Axis::kHorizontal,
     {4, 3, 61266926, -7190235, 81650820, 134067929}},
    {{1000, 1000, 500},
     {1301, 1300, 400},
     Axis::kVertical,
     {4, 1, 75464505, 16721478, 1841159, -348364}},
    {{4000, 300, 5},
     {180000, 300, 16000000},
     Axis::kVertical,
     {16, 687, 19660928, 0, 83426703, 95325058}},
    {{-3158410, 17080, 7740877},
     {2054935, 63508, 10530565},
     Axis::kHorizontal,
     {0, 1280, 2962793762, 149411, 38629486108, 561098}},
    {{128, 1000, 77777}, {129, 1000, 99999}, Axis::kHorizontal, {0, 1, 65536128, 0, 318574592, 0}},
    {{1000, 5000, 16000000},
     {1255, 4900, 100},
     Axis::kVertical,
     {4, 1, 323773669, -6579300, 26471650404, 0}},
}};

}  // namespace deburr::spec::geometric
