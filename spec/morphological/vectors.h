// SPDX-License-Identifier: MIT
// Test vectors of the morphological engine: golden model and RTL model must both produce them. The
// tables of docs/reference/morphological/vectors.md are made from them; images and hash: same page,
// "Test vectors".
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "spec/morphological/parameters.h"

namespace deburr::spec::morphological {

// ---- frames -------------------------------------------------------------------------------------

enum class VectorImage : std::uint8_t { kNoise, kLine, kBlocks, kShades, kText };
inline constexpr std::array<std::string_view, 5> kVectorImageNames = {"noise", "line", "blocks",
                                                                      "shades", "text"};

struct FrameResult {
  std::uint64_t hash = 0;
  std::uint64_t edge_pixels = 0, runs = 0, long_runs = 0, z_runs = 0, extended_runs = 0, steps = 0,
                probes = 0, diagonal_pixels = 0, blended_pixels = 0, bypassed_pixels = 0;

  template <class Self, class Visit>
  static constexpr void fields(Self& self, Visit&& visit) {
    visit("hash", self.hash);
    visit("edges", self.edge_pixels);
    visit("runs", self.runs);
    visit("long", self.long_runs);
    visit("z", self.z_runs);
    visit("extended", self.extended_runs);
    visit("steps", self.steps);
    visit("probes", self.probes);
    visit("taken", self.diagonal_pixels);
    visit("blended", self.blended_pixels);
    visit("left", self.bypassed_pixels);
  }
};

struct FrameVector {
  std::string_view name;
  VectorImage image;
  Preset preset;
  Quality quality;  // for presets with qualities
  // In addition to the preset, by the names and values of describe(): "steps=4 linear_light=false".
  std::string_view settings;
  FrameResult result;
};

inline constexpr std::array<FrameVector, 22> kFrameVectors = {{
    {"noise_mlaa",
     VectorImage::kNoise,
     Preset::kMlaa,
     Quality::kHigh,
     "",
     {0x00b097db028f25fd, 4407, 2958, 0, 1390, 0, 0, 0, 0, 3175}},
    {"noise_slope",
     VectorImage::kNoise,
     Preset::kMlaaSlope,
     Quality::kHigh,
     "",
     {0x6c40266cf03f3513, 4407, 2958, 0, 1390, 671, 1062, 9200, 0, 3282}},
    {"noise_deburr_line",
     VectorImage::kNoise,
     Preset::kDeburrLine,
     Quality::kHigh,
     "",
     {0x2820122eb9f04a52, 4407, 2958, 0, 1390, 10, 10, 7378, 0, 3178}},
    {"noise_deburr_line_codes",
     VectorImage::kNoise,
     Preset::kDeburrLine,
     Quality::kHigh,
     "linear_light=false",
     {0x8a5e9cf3676d7e0d, 4407, 2958, 0, 1390, 10, 10, 7378, 0, 3178}},
    {"line_mlaa",
     VectorImage::kLine,
     Preset::kMlaa,
     Quality::kHigh,
     "",
     {0x5d62265609239471, 436, 241, 0, 232, 0, 0, 0, 0, 418}},
    {"line_slope",
     VectorImage::kLine,
     Preset::kMlaaSlope,
     Quality::kHigh,
     "",
     {0x75ccf871d174feaf, 436, 241, 0, 232, 162, 871, 2560, 0, 457}},
    {"line_deburr_line",
     VectorImage::kLine,
     Preset::kDeburrLine,
     Quality::kHigh,
     "",
     {0x736d3ffd8a940ba4, 436, 241, 0, 232, 128, 584, 2832, 0, 425}},
    {"line_deburr_line_16",
     VectorImage::kLine,
     Preset::kDeburrLine,
     Quality::kHigh,
     "steps=16 edges.local_contrast=paper",
     {0x460d3c72f9dd7681, 436, 241, 0, 232, 128, 728, 3244, 0, 425}},
    {"line_slope_fit",
     VectorImage::kLine,
     Preset::kMlaaSlope,
     Quality::kHigh,
     "predictor=fit",
     {0x60fe73fcc1c70e9f, 436, 241, 0, 232, 162, 871, 2560, 0, 455}},
    {"blocks_mlaa",
     VectorImage::kBlocks,
     Preset::kMlaa,
     Quality::kHigh,
     "window_rows=20 search_columns=9",
     {0xfd1df0fe5908eab2, 1595, 1036, 19, 470, 0, 0, 0, 0, 1186}},
    {"blocks_slope",
     VectorImage::kBlocks,
     Preset::kMlaaSlope,
     Quality::kHigh,
     "steps=4 window_rows=20 search_columns=9",
     {0x5f03ca34a84ea782, 1595, 1036, 19, 470, 238, 626, 4119, 0, 1193}},
    {"blocks_deburr_line",
     VectorImage::kBlocks,
     Preset::kDeburrLine,
     Quality::kHigh,
     "steps=4 window_rows=20 search_columns=9",
     {0xbc2f9325b6057e5e, 1870, 1198, 24, 536, 204, 528, 4235, 0, 1386}},
    {"blocks_chord_safe",
     VectorImage::kBlocks,
     Preset::kMlaaSlope,
     Quality::kHigh,
     "safe=true edges.threshold=334305 edges.local_contrast=paper linear_light=false "
     "window_rows=20 "
     "search_columns=9",
     {0xdda27397e1d7e1a8, 1808, 1213, 15, 531, 262, 655, 4442, 0, 1354}},
    {"blocks_deburr_line_small",
     VectorImage::kBlocks,
     Preset::kDeburrLine,
     Quality::kHigh,
     "steps=3 window_rows=10 search_columns=7",
     {0xa765ccb0279eaaf0, 1870, 1198, 28, 536, 204, 314, 3587, 0, 1364}},
    {"blocks_slope_wide",
     VectorImage::kBlocks,
     Preset::kMlaaSlope,
     Quality::kHigh,
     "steps=8 window_rows=20 search_columns=30",
     {0xdc30d70a15925762, 1595, 1036, 14, 470, 239, 1315, 5984, 0, 1268}},
    {"blocks_slope_trim",
     VectorImage::kBlocks,
     Preset::kMlaaSlope,
     Quality::kHigh,
     "steps=8 trim=true window_rows=20 search_columns=30",
     {0x4a46970faa1de0ac, 1595, 1036, 14, 470, 180, 992, 5984, 0, 1276}},
    {"blocks_deburr_line_default",
     VectorImage::kBlocks,
     Preset::kDeburrLine,
     Quality::kHigh,
     "",
     {0xe86c7f9318eacf5e, 1870, 1198, 0, 538, 168, 660, 5382, 0, 1552}},
    {"blocks_not_trimmed",
     VectorImage::kBlocks,
     Preset::kDeburrLine,
     Quality::kHigh,
     "trim=false",
     {0x464376bac387fe0d, 1870, 1198, 0, 538, 222, 970, 5382, 0, 1552}},
    {"noise_deburr",
     VectorImage::kNoise,
     Preset::kDeburr,
     Quality::kHigh,
     "",
     {0xf2ed055a05e65abd, 4407, 2958, 0, 1390, 10, 10, 7378, 0, 5401}},
    {"line_deburr",
     VectorImage::kLine,
     Preset::kDeburr,
     Quality::kHigh,
     "",
     {0x2926d233992fd76d, 436, 241, 0, 232, 128, 584, 2832, 0, 491}},
    {"blocks_deburr",
     VectorImage::kBlocks,
     Preset::kDeburr,
     Quality::kHigh,
     "",
     {0xc26af783bead00f5, 1926, 1217, 1, 549, 193, 738, 5801, 0, 2879}},
    {"blocks_deburr_small",
     VectorImage::kBlocks,
     Preset::kDeburr,
     Quality::kHigh,
     "steps=3 window_rows=10 search_columns=7",
     {0x61b4c3d8f248be80, 1926, 1217, 26, 547, 227, 352, 3770, 0, 2890}},
}};

inline constexpr std::array<FrameVector, 38> kSmaaFrameVectors = {{
    {"smaa_noise_low",
     VectorImage::kNoise,
     Preset::kSmaa,
     Quality::kLow,
     "",
     {0xa14d804bfa3f9943, 4407, 4436, 0, 925, 0, 0, 0, 0, 3663}},
    {"smaa_noise_medium",
     VectorImage::kNoise,
     Preset::kSmaa,
     Quality::kMedium,
     "",
     {0xe0dcde1348002158, 4407, 4436, 0, 925, 0, 0, 0, 0, 3663}},
    {"smaa_noise_high",
     VectorImage::kNoise,
     Preset::kSmaa,
     Quality::kHigh,
     "",
     {0xf506112322a0e9fb, 4407, 4436, 0, 925, 0, 0, 0, 258, 3697}},
    {"smaa_noise_ultra",
     VectorImage::kNoise,
     Preset::kSmaa,
     Quality::kUltra,
     "",
     {0x2533ae842120f09a, 4407, 4436, 0, 925, 0, 0, 0, 258, 3697}},
    {"smaa_line_low",
     VectorImage::kLine,
     Preset::kSmaa,
     Quality::kLow,
     "",
     {0x9db66f99f089ca1b, 436, 243, 0, 234, 0, 0, 0, 0, 493}},
    {"smaa_line_medium",
     VectorImage::kLine,
     Preset::kSmaa,
     Quality::kMedium,
     "",
     {0x31bd84d55919f1e4, 436, 243, 0, 234, 0, 0, 0, 0, 493}},
    {"smaa_line_high",
     VectorImage::kLine,
     Preset::kSmaa,
     Quality::kHigh,
     "",
     {0x16327e1d2819199e, 436, 243, 0, 234, 0, 0, 0, 44, 482}},
    {"smaa_line_ultra",
     VectorImage::kLine,
     Preset::kSmaa,
     Quality::kUltra,
     "",
     {0x783242dfcee3642d, 436, 243, 0, 234, 0, 0, 0, 44, 482}},
    {"smaa_blocks_low",
     VectorImage::kBlocks,
     Preset::kSmaa,
     Quality::kLow,
     "",
     {0x60c439d95a24191f, 1549, 1127, 0, 452, 0, 0, 0, 0, 1344}},
    {"smaa_blocks_medium",
     VectorImage::kBlocks,
     Preset::kSmaa,
     Quality::kMedium,
     "",
     {0x19bd41f38003da43, 1549, 1127, 0, 452, 0, 0, 0, 0, 1402}},
    {"smaa_blocks_high",
     VectorImage::kBlocks,
     Preset::kSmaa,
     Quality::kHigh,
     "",
     {0x6bb2d259e849475d, 1549, 1127, 0, 452, 0, 0, 0, 4, 1410}},
    {"smaa_blocks_ultra",
     VectorImage::kBlocks,
     Preset::kSmaa,
     Quality::kUltra,
     "",
     {0x53249990ac83bace, 1808, 1331, 0, 540, 0, 0, 0, 8, 1649}},
    {"smaa_blocks_dynamic",
     VectorImage::kBlocks,
     Preset::kSmaaDynamic,
     Quality::kHigh,
     "",
     {0x324864b4835e834b, 1698, 1232, 0, 500, 0, 0, 0, 4, 1542}},
    {"smaa_blocks_longest",
     VectorImage::kBlocks,
     Preset::kSmaa,
     Quality::kHigh,
     "blend=longest",
     {0x1d3be4ecdcfac916, 1549, 1127, 0, 452, 0, 0, 0, 4, 1410}},
    {"smaa_blocks_codes",
     VectorImage::kBlocks,
     Preset::kSmaa,
     Quality::kHigh,
     "linear_light=false",
     {0x2c9b5c22edc1d318, 1549, 1127, 0, 452, 0, 0, 0, 4, 1410}},
    {"smaa_blocks_analytic",
     VectorImage::kBlocks,
     Preset::kSmaa,
     Quality::kHigh,
     "area=analytic border=end",
     {0x0362be74c387769e, 1549, 1127, 0, 452, 0, 0, 0, 4, 1311}},
    {"smaa_blocks_runs_alone",
     VectorImage::kBlocks,
     Preset::kSmaa,
     Quality::kHigh,
     "diagonals=false round_corners=false",
     {0xae3cda92278a9098, 1549, 1127, 0, 452, 0, 0, 0, 0, 1414}},
    {"smaa_blocks_gaps",
     VectorImage::kBlocks,
     Preset::kSmaa,
     Quality::kHigh,
     "ends=gaps border=end",
     {0x866d3fb9c9312b23, 1549, 1034, 0, 443, 0, 0, 0, 4, 1283}},
    {"smaa_blocks_small",
     VectorImage::kBlocks,
     Preset::kSmaa,
     Quality::kHigh,
     "window_rows=20 search_columns=9 diagonal_steps=8",
     {0x1062555c2f28f16b, 1549, 1127, 13, 451, 0, 0, 0, 4, 1282}},
    {"smaa_blocks_blunt",
     VectorImage::kBlocks,
     Preset::kSmaa,
     Quality::kHigh,
     "corner_rounding=256",
     {0xd9bf691be1e9de47, 1549, 1127, 0, 452, 0, 0, 0, 4, 1414}},
    {"smaa_blocks_mlaa",
     VectorImage::kBlocks,
     Preset::kMlaa,
     Quality::kHigh,
     "ends=crossings diagonals=true diagonal_steps=16 round_corners=true corner_rounding=64",
     {0x79094ad57908c708, 1595, 1179, 0, 464, 0, 0, 0, 4, 1407}},
    {"smaa_blocks_paper",
     VectorImage::kBlocks,
     Preset::kSmaa,
     Quality::kHigh,
     "edges.local_contrast=paper",
     {0x6bb2d259e849475d, 1549, 1127, 0, 452, 0, 0, 0, 4, 1410}},
    {"smaa_blocks_few_steps",
     VectorImage::kBlocks,
     Preset::kSmaa,
     Quality::kUltra,
     "search_steps=1 diagonal_steps=2",
     {0x661d40a645798516, 1808, 1331, 0, 540, 0, 0, 0, 2, 1416}},
    {"smaa_shades_high",
     VectorImage::kShades,
     Preset::kSmaa,
     Quality::kHigh,
     "",
     {0x3ed2510c4c582a01, 722, 233, 0, 141, 0, 0, 0, 0, 772}},
    {"smaa_shades_514",
     VectorImage::kShades,
     Preset::kSmaa,
     Quality::kHigh,
     "edges.threshold=131072",
     {0xf6277f611f496ceb, 1763, 745, 0, 346, 0, 0, 0, 0, 1486}},
    {"smaa_shades_514_paper",
     VectorImage::kShades,
     Preset::kSmaa,
     Quality::kHigh,
     "edges.threshold=131072 edges.local_contrast=paper",
     {0x6954cf0ea2ff4338, 1750, 739, 0, 340, 0, 0, 0, 0, 1497}},
    {"smaa_shades_dynamic",
     VectorImage::kShades,
     Preset::kSmaaDynamic,
     Quality::kHigh,
     "",
     {0x6954cf0ea2ff4338, 1750, 739, 0, 340, 0, 0, 0, 0, 1497}},
    {"smaa_shades_dynamic_floor",
     VectorImage::kShades,
     Preset::kSmaaDynamic,
     Quality::kHigh,
     "edges.floor=1",
     {0xa234984a50cdfca9, 2771, 1813, 0, 536, 0, 0, 0, 21, 2248}},
    {"smaa_shades_dynamic_alpha",
     VectorImage::kShades,
     Preset::kSmaaDynamic,
     Quality::kHigh,
     "edges.alpha=3355443",
     {0xdbe9e007f479b882, 1596, 663, 0, 302, 0, 0, 0, 0, 1398}},
    {"smaa_shades_current",
     VectorImage::kShades,
     Preset::kSmaaDynamic,
     Quality::kHigh,
     "edges.dynamic_luma=current edges.alpha=13421772 edges.floor=1",
     {0x0e2ea7d74b5cf4c4, 1250, 827, 0, 259, 0, 0, 0, 12, 913}},
    {"smaa_shades_max",
     VectorImage::kShades,
     Preset::kSmaaDynamic,
     Quality::kHigh,
     "edges.dynamic_luma=max edges.alpha=13421772 edges.floor=1",
     {0x9eb4c5c1529aa388, 918, 521, 0, 135, 0, 0, 0, 8, 624}},
    {"smaa_shades_min",
     VectorImage::kShades,
     Preset::kSmaaDynamic,
     Quality::kHigh,
     "edges.dynamic_luma=min edges.alpha=13421772 edges.floor=1",
     {0xba146b36bd5eb6f2, 2068, 1224, 0, 380, 0, 0, 0, 17, 1715}},
    {"smaa_shades_mean",
     VectorImage::kShades,
     Preset::kSmaaDynamic,
     Quality::kHigh,
     "edges.dynamic_luma=mean edges.alpha=13421772 edges.floor=1",
     {0x013b993059a14c8a, 1695, 852, 0, 285, 0, 0, 0, 8, 1383}},
    {"smaa_noise_end",
     VectorImage::kNoise,
     Preset::kSmaa,
     Quality::kHigh,
     "border=end",
     {0x790be221e5e9d20d, 4407, 4436, 0, 925, 0, 0, 0, 233, 3645}},
    {"smaa_line_end",
     VectorImage::kLine,
     Preset::kSmaa,
     Quality::kLow,
     "border=end",
     {0x6d7640674377e6eb, 436, 243, 0, 234, 0, 0, 0, 0, 491}},
    {"smaa_blocks_end",
     VectorImage::kBlocks,
     Preset::kSmaa,
     Quality::kHigh,
     "border=end",
     {0x2676e1aadb78529a, 1549, 1127, 0, 452, 0, 0, 0, 4, 1372}},
    {"smaa_noise_published",
     VectorImage::kNoise,
     Preset::kSmaa,
     Quality::kHigh,
     "area_values=published",
     {0xcd976e7ebdc94011, 4407, 4436, 0, 925, 0, 0, 0, 258, 3697}},
    {"smaa_blocks_published",
     VectorImage::kBlocks,
     Preset::kSmaa,
     Quality::kUltra,
     "area=table_minimal area_values=published",
     {0xd9bb420a5e15b561, 1808, 1331, 0, 540, 0, 0, 0, 8, 1645}},
}};

// With the text guard; one frame of text without it.
inline constexpr std::array<FrameVector, 10> kGuardFrameVectors = {{
    {"noise_deburr_guarded",
     VectorImage::kNoise,
     Preset::kDeburr,
     Quality::kHigh,
     "text_guard=true",
     {0xd0694dc704b1f019, 4407, 2958, 0, 1390, 10, 10, 7378, 0, 0, 5401}},
    {"line_deburr_guarded",
     VectorImage::kLine,
     Preset::kDeburr,
     Quality::kHigh,
     "text_guard=true",
     {0x2926d233992fd76d, 436, 241, 0, 232, 128, 584, 2832, 0, 491, 0}},
    {"blocks_deburr_guarded",
     VectorImage::kBlocks,
     Preset::kDeburr,
     Quality::kHigh,
     "text_guard=true",
     {0xb26e86f6d9f67952, 1926, 1217, 1, 549, 193, 738, 5801, 0, 2848, 31}},
    {"text_deburr",
     VectorImage::kText,
     Preset::kDeburr,
     Quality::kHigh,
     "",
     {0x1a6d8d4bf5009ec5, 4479, 1314, 0, 683, 0, 0, 3832, 0, 6453, 0}},
    {"text_deburr_guarded",
     VectorImage::kText,
     Preset::kDeburr,
     Quality::kHigh,
     "text_guard=true",
     {0x573fa0280b4ed8ea, 4479, 1314, 0, 683, 0, 0, 3832, 0, 4622, 1831}},
    {"text_small_guarded",
     VectorImage::kText,
     Preset::kDeburr,
     Quality::kHigh,
     "text_guard=true steps=3 window_rows=10 search_columns=7",
     {0xa649bfc23ae27b05, 4479, 1314, 242, 559, 0, 0, 3088, 0, 4783, 1837}},
    {"text_line_guarded",
     VectorImage::kText,
     Preset::kDeburrLine,
     Quality::kHigh,
     "text_guard=true",
     {0xcc8d214cfcd026d5, 4479, 1314, 0, 683, 0, 0, 3832, 0, 1656, 863}},
    {"text_slope_guarded",
     VectorImage::kText,
     Preset::kMlaaSlope,
     Quality::kHigh,
     "text_guard=true",
     {0x40d103d2035f03ba, 4479, 1314, 0, 683, 2, 2, 3837, 0, 1657, 863}},
    {"text_smaa_guarded",
     VectorImage::kText,
     Preset::kSmaa,
     Quality::kHigh,
     "text_guard=true",
     {0xbeb553a3335562fb, 4479, 1314, 0, 683, 0, 0, 0, 0, 2310, 1055}},
    {"blocks_smaa_guarded",
     VectorImage::kBlocks,
     Preset::kSmaa,
     Quality::kHigh,
     "text_guard=true",
     {0x03e6d65781efd7f6, 1549, 1127, 0, 452, 0, 0, 0, 4, 1389, 21}},
}};

// Pixels bypassed by the text guard. Rows of paper (.), ink (#) and a third colour (x), top row
// first; guarded pixels are g, others -.
struct GuardVector {
  std::string_view name, rows, guarded;
};
inline constexpr std::array<GuardVector, 10> kGuardVectors = {{
    {"grid",
     "######### #...#...# #...#...# #...#...# "
     "######### #...#...# #...#...# #...#...# "
     "#########",
     "ggggggggg ggggggggg ggggggggg ggggggggg "
     "ggggggggg ggggggggg ggggggggg ggggggggg "
     "ggggggggg"},
    {"grid and another colour",
     "######### #...#...# #...#...# #...#...# "
     "######### #...#...# #...#...# #...#...# "
     "########x",
     "ggggggggg ggggggggg ggggggggg ggg------ "
     "ggg------ ggg------ ggg------ ggg------ "
     "ggg------"},
    {"bars",
     "#...#...# #...#...# #...#...# #...#...# "
     "#...#...# #...#...# #...#...# #...#...# "
     "#...#...#",
     "--------- --------- --------- --------- "
     "--------- --------- --------- --------- "
     "---------"},
    {"three dots",
     "######### ....#.... ......... ....#.... "
     "######### ......... ....#.... ......... "
     "#########",
     "--------- ggggggggg ggggggggg ggggggggg "
     "ggggggggg ggggggggg ggggggggg --------- "
     "---------"},
    {"two dots",
     "######### ....#.... ......... ......... "
     "######### ......... ....#.... ......... "
     "#########",
     "--------- --------- --------- --------- "
     "--------- --------- --------- --------- "
     "---------"},
    {"twenty-four",
     "....###.... ....###.... ....###.... ....###.... "
     "####....... ####....... ####....... ........... "
     "........... ........... ...........",
     "----------- -ggggg----- -ggggg----- -ggggg----- "
     "-ggggg----- -ggggg----- ----------- ----------- "
     "----------- ----------- -----------"},
    {"twenty-three",
     "....###.... ....###.... ....###.... ....###.... "
     "....###.... ####....... ####....... ........... "
     "........... ........... ...........",
     "----------- ----------- ----------- ----------- "
     "----------- ----------- ----------- ----------- "
     "----------- ----------- -----------"},
    {"long",
     "....####.... ....####.... ....####.... ....####.... "
     "####........ ####........ ####........ ............ "
     "............ ............ ............",
     "------------ ------------ ------------ ------------ "
     "------------ ------------ ------------ ------------ "
     "------------ ------------ ------------"},
    {"small", "#.# .#. #.# .#.", "ggg ggg ggg ggg"},
    {"too small", "#.# .#. #.#", "--- --- ---"},
}};

// ---- runs ---------------------------------------------------------------------------------------

struct RunResult {
  std::int64_t scale = 0, offset = 0, slope = 0, inverse = 0, shift = 0, span = 0;

  template <class Self, class Visit>
  static constexpr void fields(Self& self, Visit&& visit) {
    visit("scale", self.scale);
    visit("offset", self.offset);
    visit("slope", self.slope);
    visit("inverse", self.inverse);
    visit("shift", self.shift);
    visit("span", self.span);
  }
};

// The fitted line through a run between two of the corners, from the first side to the second.
struct RunVector {
  std::array<int, 5> corners;  // in order; `count` of them are used
  int count;
  int start;  // index of the corner where the run starts; it ends at the next one
  RunResult result;
  std::string_view weights;  // per pixel: b before, a after
};

inline constexpr std::array<RunVector, 6> kRunVectors = {{
    {{0, 1}, 2, 0, {2, 1, 8388608, 4096, 0, 1}, "b32/a32"},
    {{0, 3}, 2, 0, {2, 3, 2796203, 12288, 0, 3}, "b85 b11/a11 a85"},
    {{0, 4}, 2, 0, {2, 4, 2097152, 16384, 0, 4}, "b96 b32 a32 a96"},
    {{0, 7}, 2, 0, {2, 7, 1198373, 28672, 0, 7}, "b110 b73 b37 b5/a5 a37 a73 a110"},
    {{-3, 0, 3, 5, 8}, 5, 1, {5, 13, 1242757, 11059, 1, 11}, "b71 b3/a27 a119"},
    {{0, 5, 11, 16}, 4, 0, {4, 32, 776723, 22118, 2, 16}, "b100 b52 b9/a4 a43 a90"},
}};

// ---- SMAA: weights of every edge ----------------------------------------------------------------

struct PatternResult {
  std::uint64_t hash = 0, diagonal_pixels = 0;

  template <class Self, class Visit>
  static constexpr void fields(Self& self, Visit&& visit) {
    visit("hash", self.hash);
    visit("taken", self.diagonal_pixels);
  }
};

struct PatternVector {
  std::string_view name;
  Quality quality;
  std::string_view rows;     // one digit per pixel, 0 black and 1 white; spaces separate rows
  std::string_view weights;  // t(x,y), l(x,y) first/second: non-zero weights of top and left edges
  PatternResult result;
};

inline constexpr std::array<PatternVector, 13> kPatternVectors = {{
    {"L",
     Quality::kHigh,
     "00000000 00001111 11111111",
     "t(4,1) 0/124, t(5,1) 0/117, t(6,1) 0/108, t(7,1) 0/102, t(0,2) 101/0, t(1,2) 108/0, t(2,2) "
     "116/0, t(3,2) 124/0, l(4,1) 20/20",
     {0x0626895dccdf5fbf, 0}},
    {"Z",
     Quality::kHigh,
     "00000000 00000011 00011111 11111111",
     "t(6,1) 0/124, t(7,1) 0/117, t(3,2) 0/80, t(4,2) 11/11, t(5,2) 80/0, t(0,3) 108/0, t(1,3) "
     "116/0, t(2,3) 124/0, l(6,1) 20/20, l(3,2) 20/20",
     {0xfc02ca96f5b6416d, 0}},
    {"U 1",
     Quality::kHigh,
     "00000 00100 11111",
     "t(2,1) 0/126, t(0,2) 116/0, t(1,2) 124/0, t(3,2) 124/0, t(4,2) 117/0, l(2,1) 20/20, l(3,1) "
     "20/20",
     {0xd00bdbd2dff0f000, 0}},
    {"U 4",
     Quality::kHigh,
     "000000 011110 111111",
     "t(1,1) 0/106, t(2,1) 0/76, t(3,1) 0/76, t(4,1) 0/106, t(0,2) 124/0, t(5,2) 126/0, l(1,1) "
     "20/20, l(5,1) 20/20",
     {0xf2313696d5c2d6ee, 0}},
    {"T",
     Quality::kHigh,
     "000000 000111 111000 111000",
     "t(3,1) 0/31, t(4,1) 0/29, t(5,1) 0/27, l(3,1) 20/8",
     {0x2f67a75e4caab466, 0}},
    {"box",
     Quality::kHigh,
     "00000000 00000000 00111100 00111100 00111100 00111100 00000000 00000000",
     "t(2,2) 0/27, t(3,2) 0/19, t(4,2) 0/19, t(5,2) 0/27, t(2,6) 27/0, t(3,6) 19/0, t(4,6) 19/0, "
     "t(5,6) 27/0, l(2,2) 0/27, l(6,2) 27/0, l(2,3) 0/19, l(6,3) 19/0, l(2,4) 0/19, l(6,4) 19/0, "
     "l(2,5) 0/27, l(6,5) 27/0",
     {0xebc16294237c987b, 0}},
    {"dot",
     Quality::kHigh,
     "000 010 000",
     "t(1,1) 0/126, t(1,2) 126/0, l(1,1) 0/126, l(2,1) 126/0",
     {0x7a6d46cfea983378, 0}},
    {"/",
     Quality::kHigh,
     "00000000 00000001 00000011 00000111 00001111 00011111 00111111 01111111 11111111",
     "t(7,1) 0/113, t(6,2) 3/84, t(5,3) 11/59, t(4,4) 22/39, t(3,5) 38/23, t(2,6) 59/11, t(1,7) "
     "83/3, t(0,8) 112/0",
     {0xe2cf6a507bd9166d, 8}},
    {"\\",
     Quality::kHigh,
     "00000000 10000000 11000000 11100000 11110000 11111000 11111100 11111110 11111111",
     "t(0,1) 0/112, t(1,2) 3/83, t(2,3) 11/59, t(3,4) 23/38, t(4,5) 39/22, t(5,6) 59/11, t(6,7) "
     "84/3, t(7,8) 113/0, l(1,1) 20/32, l(2,2) 32/32, l(3,3) 32/32, l(4,4) 32/32, l(5,5) 32/32, "
     "l(6,6) 32/32, l(7,7) 32/20",
     {0xd90fa5ce1126b4e1, 8}},
    {"/, medium",
     Quality::kMedium,
     "00000000 00000001 00000011 00000111 00001111 00011111 00111111 01111111 11111111",
     "t(7,1) 0/126, t(6,2) 32/32, t(5,3) 32/32, t(4,4) 32/32, t(3,5) 32/32, t(2,6) 32/32, t(1,7) "
     "32/32, t(0,8) 120/0, l(7,1) 32/32, l(6,2) 32/32, l(5,3) 32/32, l(4,4) 32/32, l(3,5) 32/32, "
     "l(2,6) 32/32, l(1,7) 32/32",
     {0x32950550b7c10753, 0}},
    {"/ of 3",
     Quality::kHigh,
     "000000 000001 000011 000111 111111",
     "t(5,1) 0/98, t(4,2) 12/46, t(3,3) 44/13, t(0,4) 108/0, t(1,4) 116/0, t(2,4) 96/0",
     {0xb01fb009c3c8ad77, 4}},
    {"line", Quality::kHigh, "0000000 1111111 0000000 0000000", "", {0x7cc1f94de234a73e, 0}},
    {"X",
     Quality::kHigh,
     "1000001 0100010 0010100 0001000 0010100 0100010 1000001",
     "t(0,1) 0/119, t(1,1) 66/62, t(5,1) 62/54, t(6,1) 62/56, t(1,2) 1/108, t(2,2) 66/62, t(4,2) "
     "65/35, t(5,2) 64/39, t(2,3) 3/100, t(3,3) 137/83, t(4,3) 69/26, t(2,4) 82/10, t(3,4) 82/109, "
     "t(4,4) 66/62, t(1,5) 97/3, t(2,5) 87/7, t(4,5) 8/89, t(5,5) 66/62, t(0,6) 115/0, t(1,6) "
     "100/2, t(5,6) 10/85, t(6,6) 66/62, l(2,1) 20/32, l(3,2) 20/8, l(5,4) 20/32, l(6,5) 20/20",
     {0xc0d03f8b5b391234, 22}},
}};

// ---- SMAA: the limit of the searches ------------------------------------------------------------

struct LimitResult {
  std::uint64_t hash = 0;

  template <class Self, class Visit>
  static constexpr void fields(Self& self, Visit&& visit) {
    visit("hash", self.hash);
  }
};

// A single Z in a frame, with quality low.
struct LimitVector {
  int length;
  std::string_view weights;  // first/second of each pixel
  LimitResult result;
};

inline constexpr std::array<LimitVector, 8> kLimitVectors = {{
    {7, "0/108 0/71 1/39 15/15 39/1 71/0 108/0", {0xaa21e83c9f57b1b5}},
    {8, "0/111 0/77 1/47 3/20 20/3 47/1 77/0 111/0", {0x300f24902f3524ef}},
    {9, "0/113 0/83 1/54 2/29 4/4 29/2 54/1 83/0 111/0", {0xb0cfab27e0eca598}},
    {10, "0/113 0/88 1/61 1/37 3/13 13/3 37/1 61/1 83/0 111/0", {0x1265a7ad5e9c634b}},
    {16,
     "0/113 0/88 0/67 0/52 0/38 0/30 0/22 6/14 11/0 17/0 24/0 31/0 45/0 61/0 83/0 111/0",
     {0x50d0f4820eac1534}},
    {17,
     "0/113 0/88 0/67 0/52 0/38 0/30 0/22 0/14 6/0 11/0 17/0 24/0 31/0 45/0 61/0 83/0 111/0",
     {0xdd4b6bac017d32fe}},
    {18,
     "0/113 0/88 0/67 0/52 0/38 0/30 0/22 0/14 0/0 6/0 11/0 17/0 24/0 31/0 45/0 61/0 83/0 111/0",
     {0x47d2e7d40e5c2578}},
    {19,
     "0/113 0/88 0/67 0/52 0/38 0/30 0/22 0/14 0/0 0/0 6/0 11/0 17/0 24/0 31/0 45/0 61/0 83/0 "
     "111/0",
     {0xa47de79f5ab9e7a2}},
}};

// ---- SMAA: tables -------------------------------------------------------------------------------

struct TableHashes {
  std::uint64_t half = 0, dip = 0, roots = 0, mix = 0, diagonals = 0;
  std::uint64_t published_half = 0, published_dip = 0, published_diagonals = 0;

  // Named as on the page.
  template <class Self, class Visit>
  static constexpr void fields(Self& self, Visit&& visit) {
    visit("T", self.half);
    visit("U", self.dip);
    visit("S", self.roots);
    visit("R", self.mix);
    visit("D", self.diagonals);
    visit("T, published", self.published_half);
    visit("U, published", self.published_dip);
    visit("D, published", self.published_diagonals);
  }
};

// Values in the order of hashing; numbers over 255 as bytes, highest first.
inline constexpr std::array<std::string_view, 8> kTableOrders = {
    "i, j = 0..15",
    "i, j = 0..15",
    "d = 0..224, 2 bytes",
    "s = 0..510, 3 bytes",
    "e1, e2 = 0..3, d1, d2 = 0..19, A, B",
    "as T",
    "as U",
    "as D"};
inline constexpr TableHashes kTableHashes = {
    0x08fb6f2f5185e12b, 0x4091cb22adf7523a, 0x0cdd319ff9fc3614, 0xf381b9d2ae2402d1,
    0xbd207affdb832b8f, 0x1ac3518888e5fed9, 0xd27dea44d582a429, 0xa682f0d6f6e9e26e};

// Weights after interpolation, for the distances l and r.
struct TableResult {
  std::uint64_t half = 0, dip = 0;

  template <class Self, class Visit>
  static constexpr void fields(Self& self, Visit&& visit) {
    visit("T", self.half);
    visit("U", self.dip);
  }
};

struct TableVector {
  int l, r;
  TableResult result;
};

inline constexpr std::array<TableVector, 9> kTableVectors = {{
    {0, 0, {32, 126}},
    {0, 1, {64, 89}},
    {1, 2, {33, 76}},
    {2, 3, {30, 67}},
    {3, 3, {15, 56}},
    {5, 7, {24, 47}},
    {31, 32, {7, 11}},
    {223, 224, {1, 1}},
    {0, 224, {128, 128}},
}};

}  // namespace deburr::spec::morphological
