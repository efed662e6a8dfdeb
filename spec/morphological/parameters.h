// SPDX-License-Identifier: MIT
// Parameters and presets of the morphological engine: the configuration, which changes pixels, and
// build parameters, which change cycles and cost. Meaning: docs/reference/morphological/index.md
// and docs/reference/morphological/smaa.md; formats and rounding, to the bit:
// docs/reference/morphological/algorithm.md.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "spec/parameters.h"
#include "spec/presets.h"

namespace deburr::spec::morphological {

enum class Preset : std::uint8_t { kMlaa, kMlaaSlope, kSmaa, kSmaaDynamic, kDeburrLine, kDeburr };
inline constexpr std::array<std::string_view, 6> kPresetNames = {
    "mlaa", "mlaa-slope", "smaa", "smaa-dynamic", "deburr-line", "deburr"};

// For the two SMAA presets; a row of kQualities.
enum class Quality : std::uint8_t { kLow, kMedium, kHigh, kUltra };
inline constexpr std::array<std::string_view, 4> kQualityNames = {"low", "medium", "high", "ultra"};

enum class Lanes : std::uint8_t { kOne, kTwo, kFour };
inline constexpr std::array<std::string_view, 3> kLanesNames = {"1", "2", "4"};
inline constexpr std::array<std::uint8_t, 3> kLaneCount = {1, 2, 4};
inline constexpr int kMaxLanes = 4;

enum class EdgeSource : std::uint8_t { kLuma, kDepth, kPredicated, kColour };
inline constexpr std::array<std::string_view, 4> kEdgeSourceNames = {"luma", "depth", "predicated",
                                                                     "colour"};

enum class ThresholdMode : std::uint8_t { kFixed, kDynamic };
inline constexpr std::array<std::string_view, 2> kThresholdModeNames = {"fixed", "dynamic"};

enum class DynamicLuma : std::uint8_t { kCurrent, kMax, kMin, kMean };
inline constexpr std::array<std::string_view, 4> kDynamicLumaNames = {"current", "max", "min",
                                                                      "mean"};

enum class LocalContrast : std::uint8_t { kOff, kPaper, kSymmetric, kSmaa };
inline constexpr std::array<std::string_view, 4> kLocalContrastNames = {"off", "paper", "symmetric",
                                                                        "smaa"};

// Where a run ends: at a gap only, or also at a crossing edge.
enum class Ends : std::uint8_t { kGaps, kCrossings };
inline constexpr std::array<std::string_view, 2> kEndsNames = {"gaps", "crossings"};

// Edges outside the frame: none, or those of the nearest pixel, as a sampler clamps.
enum class Border : std::uint8_t { kEnd, kClamp };
inline constexpr std::array<std::string_view, 2> kBorderNames = {"end", "clamp"};

enum class Predictor : std::uint8_t { kNone, kChord, kFit };
inline constexpr std::array<std::string_view, 3> kPredictorNames = {"none", "chord", "fit"};

// Source of the areas of a run. The three tables are layouts of the same table and give the same
// pixels. With learned weights, a clean Z that was extended or is long takes its weights from the
// line; all other runs take them from ROMs (docs/reference/morphological/learned_weights.md).
enum class AreaSource : std::uint8_t {
  kAnalytic,
  kTableFull,
  kTableMerged,
  kTableMinimal,
  kLearned
};
inline constexpr std::array<std::string_view, 5> kAreaSourceNames = {
    "analytic", "table_full", "table_merged", "table_minimal", "learned"};

// Entries of the tables of runs and diagonals: rounded areas, or the published bytes.
enum class AreaValues : std::uint8_t { kExact, kPublished };
inline constexpr std::array<std::string_view, 2> kAreaValuesNames = {"exact", "published"};

enum class BlendRule : std::uint8_t { kLongest, kStrongest };
inline constexpr std::array<std::string_view, 2> kBlendRuleNames = {"longest", "strongest"};

// Bypassed pixels. none; marked: marked pixels; beside: also their four neighbours; half: marked
// pixels, and their neighbours take half the weight of a marked pixel; masked: marked pixels, which
// also have no edges. A pixel is marked if bit 0 of its alpha is 0.
enum class Bypass : std::uint8_t { kNone, kMarked, kBeside, kHalf, kMasked };
inline constexpr std::array<std::string_view, 5> kBypassNames = {"none", "marked", "beside", "half",
                                                                 "masked"};

enum class Storage : std::uint8_t { kLineBuffers, kMemory };
inline constexpr std::array<std::string_view, 2> kStorageNames = {"line_buffers", "memory"};

inline constexpr int kMaxFrameSize = 8192;  // pixels per axis
inline constexpr int kMaxSteps = 16;        // N
inline constexpr int kMaxCorners = 2 * kMaxSteps + 2;
inline constexpr int kMaxSearchSteps = 112;     // N of SMAA; keeps distances below kTableDistances
inline constexpr int kMaxDiagonalSteps = 16;    // M
inline constexpr int kMaxCornerRounding = 256;  // 1/256; keeps the whole weight
inline constexpr int kFrameLineBytes = 64;      // line of memory with storage = memory
inline constexpr int kFramePixelBytes = 4;      // R, G, B, A
inline constexpr int kRecipFractionBits = 24;   // of LineDescriptor::slope
inline constexpr int kInverseFractionBits = 12;
inline constexpr int kMaxWeight = 128;  // U0.8: 1/2, the largest weight of a run
// With blend = strongest, which normalises weights.
inline constexpr int kMaxDiagonalWeight = 255;
inline constexpr int kMixFractionBits = 4;       // fraction bits of strongest in addition to U0.8
inline constexpr int kThresholdBits = 24;        // U8.16 codes; alpha U0.24
inline constexpr std::int32_t kOneCode = 65536;  // one code in a threshold
// Larger than any step between pixels, even a step of 255 codes.
inline constexpr std::int32_t kMaxThreshold = (1 << kThresholdBits) - 1;
inline constexpr int kLongZ = 16;  // pixels; a clean Z this long keeps its line (area = learned)
inline constexpr int kRowLag = 5;  // rows of delay beyond the search range
inline constexpr int kLeastDividerLatency = 14;

// Cycles from the cycle in which a block accepts a slot to the cycle in which the next block
// accepts it. For the Blender: to the push of its output beat.
inline constexpr int kSequencerLatency = 1;
inline constexpr int kLumaLatency = 2;
inline constexpr int kEdgeLatency = 4;
inline constexpr int kExtractorLatency = 2;
inline constexpr int kAreaLatency = 9;
inline constexpr int kPixelStoreLatency = 2;  // in parallel to AreaUnit
inline constexpr int kBlenderLatency = 5;
// Cycles from a slot to its output beat.
inline constexpr int kPipelineLatency = kSequencerLatency + kLumaLatency + kEdgeLatency +
                                        kExtractorLatency + kAreaLatency + kBlenderLatency;

// Luma weights, U0.16; their sum is exactly 65536.
inline constexpr std::array<std::uint32_t, 3> kLumaWeights = {13933, 46871, 4732};

// Configuration: it changes pixels. Golden model and RTL model both implement it. The defaults are
// those of preset `deburr`.
struct Configuration {
  Preset preset = Preset::kDeburr;
  Quality quality = Quality::kHigh;
  EdgeSource edge_source = EdgeSource::kColour;
  ThresholdMode threshold_mode = ThresholdMode::kFixed;
  DynamicLuma dynamic_luma = DynamicLuma::kMax;
  std::int32_t threshold = 1310720;                // U8.16: 20 codes
  std::int32_t threshold_on_depth_edge = 167025;   // U8.16: 0.01 of 255
  std::int32_t threshold_off_depth_edge = 835635;  // U8.16: 0.05 of 255
  std::int32_t alpha = 1677721;                    // U0.24: 0.1, rounded down
  std::int32_t floor = 131072;                     // U8.16: 2 codes
  std::int32_t depth_threshold = 3277;             // U0.16: 0.05
  LocalContrast local_contrast = LocalContrast::kSymmetric;
  Ends ends = Ends::kGaps;
  Border border = Border::kEnd;
  Predictor predictor = Predictor::kFit;
  std::int32_t steps = 8;
  bool contiguous = true;
  bool safe = true;
  bool trim = true;
  AreaSource area = AreaSource::kLearned;
  AreaValues area_values = AreaValues::kExact;
  std::int32_t search_steps = 16;
  bool diagonals = false;
  std::int32_t diagonal_steps = 8;
  bool round_corners = false;
  std::int32_t corner_rounding = 64;
  BlendRule blend = BlendRule::kLongest;
  Bypass bypass = Bypass::kNone;
  bool text_guard = false;
  bool linear_light = true;
  std::int32_t window_rows = 66;
  std::int32_t search_columns = 256;
};

// Configuration for a frame that the geometric engine has already smoothed. It is applied on top of
// a preset with a fixed threshold: luma edges count only at depth edges, and never at blended
// pixels. `preset` applies if no preset was given. It has no learned weights, since those were not
// trained on the edges that the geometric engine leaves.
struct FollowingRules {
  Preset preset = Preset::kDeburrLine;
  EdgeSource edge_source = EdgeSource::kPredicated;
  std::int32_t threshold_on_depth_edge = 501330;  // U8.16: 0.03 of 255
  std::int32_t threshold_off_depth_edge = kMaxThreshold;
  Bypass bypass = Bypass::kMasked;
};

// Build parameters: they change cycles and cost, but no pixels. Runs that differ only in these have
// the same golden picture.
struct Build {
  Lanes lanes = Lanes::kOne;
  std::int32_t line_pixels = kMaxFrameSize;
  std::int32_t descriptor_fifo = 256;
  std::int32_t predictor_units = 2;
  std::int32_t trial_cycles = 4;
  std::int32_t divider_latency = 24;
  std::int32_t divider_interval = 1;
  Storage storage = Storage::kLineBuffers;
  std::int32_t memory_outstanding = 32;
};

struct Parameters : Configuration, Build {};

template <class Visitor>
void describe(Configuration& p, Visitor& v) {
  v.choice(
      "preset", p.preset, kPresetNames,
      "Named configuration: sets the parameters below. A parameter that is given overrides it.");
  v.choice("quality", p.quality, kQualityNames,
           "Quality level of the presets smaa and smaa-dynamic. The preset, and parameters that "
           "are given, override it.");
  v.choice("edges.source", p.edge_source, kEdgeSourceNames,
           "Edge criterion: luma, depth, luma with a threshold controlled by depth, or the largest "
           "step of R, G and B. Local contrast with colour uses steps between neighbours, as the "
           "ports of SMAA do; SMAA's published text compares the pixel itself with left-left "
           "(pull request 11 of its repository).");
  v.choice("edges.threshold_mode", p.threshold_mode, kThresholdModeNames,
           "fixed: T. dynamic: alpha times luma (paper 003), at least floor (our addition).");
  v.choice("edges.dynamic_luma", p.dynamic_luma, kDynamicLumaNames,
           "Luma that alpha multiplies: of the current pixel (paper 003), or the larger, the "
           "smaller or the mean of the pair.");
  v.integer("edges.threshold", p.threshold, 1, kMaxThreshold, "code / 65536",
            "T: the smallest step that is an edge, 16711680 times the step relative to full scale. "
            "With a T or edges.floor below 65536, one code, noise causes edges.");
  v.integer("edges.threshold_on_depth_edge", p.threshold_on_depth_edge, 1, kMaxThreshold,
            "code / 65536", "T of source = predicated at a depth edge.");
  v.integer("edges.threshold_off_depth_edge", p.threshold_off_depth_edge, 1, kMaxThreshold,
            "code / 65536", "T of source = predicated without a depth edge.");
  v.integer("edges.alpha", p.alpha, 0, kMaxThreshold, "1/16777216",
            "Factor of the dynamic threshold; rounded down, so that a step of exactly alpha times "
            "luma is an edge.");
  v.integer("edges.floor", p.floor, 1, kMaxThreshold, "code / 65536",
            "Lower limit of the dynamic threshold.");
  v.integer("edges.depth_threshold", p.depth_threshold, 1, 65535, "1/65536",
            "Relative depth step that is an edge.");
  v.choice("edges.local_contrast", p.local_contrast, kLocalContrastNames,
           "Drop edges next to an edge of twice the contrast: by equations (2) and (3) of paper "
           "003, by a symmetric form of them, or as SMAA does, which keeps an edge of exactly half "
           "the contrast.");
  v.choice("ends", p.ends, kEndsNames,
           "Where runs end: at gaps, or also at crossing edges (SMAA).");
  v.choice("border", p.border, kBorderNames,
           "Edges outside the frame: end: none, so runs end at the border. clamp: those of the "
           "nearest pixel, as with SMAA's samplers; needs ends = crossings and a table.");
  v.choice("predictor", p.predictor, kPredictorNames,
           "Line through a run: its own ends, the chord of the extended ends (paper 000), or the "
           "least-squares line through all visited corners.");
  v.integer("steps", p.steps, 0, kMaxSteps, "step",
            "N: maximum number of extensions on each side of a run.");
  v.boolean(
      "contiguous", p.contiguous,
      "Extend only by unbroken runs whose corners both have the crossing codes of the first.");
  v.boolean("safe", p.safe,
            "Extend both sides in lockstep with one L', and stop when no line fits all corners.");
  v.boolean("trim", p.trim,
            "A side whose line was lost before N steps and before the end of the search range "
            "gives back its last step; a side that no line fits gives back half of its steps.");
  v.choice("area", p.area, kAreaSourceNames,
           "Source of areas: the line itself (analytic), or SMAA's table as published, as merged "
           "in paper 003, or minimised; the tables give the same pixels. learned: analytic for "
           "long or extended clean Z runs, learned ROMs otherwise.");
  v.choice("area_values", p.area_values, kAreaValuesNames,
           "Entries of the run and diagonal tables: exact areas, rounded to nearest, or the bytes "
           "published by SMAA's authors.");
  v.integer("search_steps", p.search_steps, 1, kMaxSearchSteps, "step",
            "N: a table covers 2 N - 1 pixels to the left (up) and 2 N to the right (down).");
  v.boolean("diagonals", p.diagonals, "Diagonal patterns of SMAA, with priority over the others.");
  v.integer("diagonal_steps", p.diagonal_steps, 1, kMaxDiagonalSteps, "step",
            "M: pixels that a diagonal is followed in each direction.");
  v.boolean(
      "round_corners", p.round_corners,
      "Corner rounding of SMAA: less weight where a crossing edge continues for a second pixel.");
  v.integer("corner_rounding", p.corner_rounding, 0, kMaxCornerRounding, "1/256",
            "Fraction of the weight that remains at such a corner.");
  v.choice("blend", p.blend, kBlendRuleNames,
           "Axis and weights of a pixel: those of the longer line, or those of the larger blend "
           "weight, with weights proportional to their squares (SMAA).");
  v.choice("bypass", p.bypass, kBypassNames,
           "Bypassed pixels: none; marked: pixels that the geometric engine marked (bit 0 of alpha "
           "is 0); beside: also their four neighbours; half: marked ones, and a neighbour takes "
           "half the blend weight of a marked pixel; masked: marked ones, which also cause no "
           "edges. All but none end the mark.");
  v.boolean("text_guard", p.text_guard,
            "Bypass aliased text of two colours: pixels surrounded by strokes of 1 to 3 pixels in "
            "both axes.");
  v.boolean("linear_light", p.linear_light, "Blend in linear light (sRGB) instead of codes.");
  v.integer("window_rows", p.window_rows, 10, 258, "row",
            "Rows of edges in the edge window; even. The result of a pixel depends on window_rows "
            "/ 2 - 1 rows of edges up and down.");
  v.integer("search_columns", p.search_columns, 4, 2048, "pixel",
            "Search range of horizontal runs: longest run, and limit of its extension.");
}

template <class Visitor>
void describe(Build& p, Visitor& v) {
  v.choice("lanes", p.lanes, kLanesNames, "Pixels per cycle.");
  v.integer("line_pixels", p.line_pixels, 1, kMaxFrameSize, "pixel",
            "Maximum frame width of the line buffers.");
  v.integer("descriptor_fifo", p.descriptor_fifo, 2, 4096, "record",
            "Run descriptors waiting for a predictor, for each axis and lane; a tenth of a row is "
            "enough for a burst.");
  v.integer("predictor_units", p.predictor_units, 1, 16, "unit",
            "Predictors for each axis and lane; each tries one step of both sides at a time.");
  v.integer("trial_cycles", p.trial_cycles, 1, 8, "clk",
            "Cycles between two trials of a predictor; below 4 stages weight a cycle.");
  v.integer("divider.latency", p.divider_latency, kLeastDividerLatency, 64, "clk",
            "Latency of the divider: two cycles of products, then at most two of 24 quotient bits "
            "per cycle.");
  v.integer("divider.interval", p.divider_interval, 1, 64, "clk",
            "Initiation interval of the divider.");
  v.choice("storage", p.storage, kStorageNames,
           "Storage of delayed pixels: on-chip line buffers, or memory (written, then read once).");
  v.integer("memory.outstanding", p.memory_outstanding, 1, 256, "line",
            "Lines in flight with storage = memory, in each direction.");
}

template <class Visitor>
void describe(Parameters& p, Visitor& v) {
  describe(static_cast<Configuration&>(p), v);
  describe(static_cast<Build&>(p), v);
}

// The parameters that a quality of the SMAA presets sets; the preset's own row is applied after it.
// Where diagonal_steps or corner_rounding is unused, it keeps its default.
struct QualityRow {
  Quality quality;
  std::int32_t threshold;  // U8.16, only of `smaa`
  std::int32_t search_steps;
  bool diagonals;
  std::int32_t diagonal_steps;
  bool round_corners;
  std::int32_t corner_rounding;
  std::int32_t window_rows;
};
inline constexpr std::array<QualityRow, 4> kQualities = {{
    {Quality::kLow, 2506752, 4, false, 8, false, 64, 38},
    {Quality::kMedium, 1671168, 8, false, 8, false, 64, 70},
    {Quality::kHigh, 1671168, 16, true, 8, true, 64, 134},
    {Quality::kUltra, 835584, 32, true, 16, true, 64, 258},
}};

// The parameters that a preset sets; all others keep their defaults.
struct PresetRow {
  Preset preset;
  EdgeSource edge_source;
  ThresholdMode threshold_mode;
  DynamicLuma dynamic_luma;
  std::int32_t threshold;  // U8.16; 0: from the quality
  LocalContrast local_contrast;
  Predictor predictor;
  std::int32_t steps;
  bool contiguous;
  bool safe;
  bool trim;
  AreaSource area;
  Ends ends;
  Border border;
  BlendRule blend;
  bool has_qualities;  // apply a row of kQualities first
};
inline constexpr std::array<PresetRow, 6> kPresets = {{
    {Preset::kMlaa, EdgeSource::kLuma, ThresholdMode::kFixed, DynamicLuma::kMax, 1671270,
     LocalContrast::kOff, Predictor::kNone, 0, false, false, false, AreaSource::kAnalytic,
     Ends::kGaps, Border::kEnd, BlendRule::kLongest, false},
    {Preset::kMlaaSlope, EdgeSource::kLuma, ThresholdMode::kFixed, DynamicLuma::kMax, 1671270,
     LocalContrast::kOff, Predictor::kChord, 4, false, false, false, AreaSource::kAnalytic,
     Ends::kGaps, Border::kEnd, BlendRule::kLongest, false},
    {Preset::kSmaa, EdgeSource::kLuma, ThresholdMode::kFixed, DynamicLuma::kMax, 0,
     LocalContrast::kSmaa, Predictor::kNone, 0, false, false, false, AreaSource::kTableFull,
     Ends::kCrossings, Border::kClamp, BlendRule::kStrongest, true},
    {Preset::kSmaaDynamic, EdgeSource::kLuma, ThresholdMode::kDynamic, DynamicLuma::kCurrent,
     501330, LocalContrast::kPaper, Predictor::kNone, 0, false, false, false,
     AreaSource::kTableMerged, Ends::kCrossings, Border::kClamp, BlendRule::kStrongest, true},
    {Preset::kDeburrLine, EdgeSource::kLuma, ThresholdMode::kFixed, DynamicLuma::kMax, 501330,
     LocalContrast::kSymmetric, Predictor::kFit, 8, true, true, true, AreaSource::kAnalytic,
     Ends::kGaps, Border::kEnd, BlendRule::kLongest, false},
    {Preset::kDeburr, EdgeSource::kColour, ThresholdMode::kFixed, DynamicLuma::kMax, 1310720,
     LocalContrast::kSymmetric, Predictor::kFit, 8, true, true, true, AreaSource::kLearned,
     Ends::kGaps, Border::kEnd, BlendRule::kLongest, false},
}};

constexpr bool has_qualities(Preset preset) {
  return row_of(kPresets, &PresetRow::preset, preset).has_qualities;
}

// Calls set(name, member, value) for each parameter of a preset, after those of its quality
// (spec/presets.h).
template <class Set>
constexpr void for_each_of(Preset preset, Quality quality, Set&& set) {
  const PresetRow& row = row_of(kPresets, &PresetRow::preset, preset);
  // Only qualities enable these blocks, so no other preset uses them.
  bool diagonals = false, round_corners = false;
  std::int32_t threshold = row.threshold;
  if (row.has_qualities) {
    const QualityRow& of = row_of(kQualities, &QualityRow::quality, quality);
    diagonals = of.diagonals;
    round_corners = of.round_corners;
    if (threshold == 0) threshold = of.threshold;
    set("search_steps", &Configuration::search_steps, of.search_steps);
    set("diagonal_steps", &Configuration::diagonal_steps, of.diagonal_steps);
    set("corner_rounding", &Configuration::corner_rounding, of.corner_rounding);
    set("window_rows", &Configuration::window_rows, of.window_rows);
  }
  set("edges.source", &Configuration::edge_source, row.edge_source);
  set("edges.threshold_mode", &Configuration::threshold_mode, row.threshold_mode);
  set("edges.dynamic_luma", &Configuration::dynamic_luma, row.dynamic_luma);
  set("edges.threshold", &Configuration::threshold, threshold);
  set("edges.local_contrast", &Configuration::local_contrast, row.local_contrast);
  set("ends", &Configuration::ends, row.ends);
  set("border", &Configuration::border, row.border);
  set("predictor", &Configuration::predictor, row.predictor);
  set("steps", &Configuration::steps, row.steps);
  set("contiguous", &Configuration::contiguous, row.contiguous);
  set("safe", &Configuration::safe, row.safe);
  set("trim", &Configuration::trim, row.trim);
  set("area", &Configuration::area, row.area);
  set("diagonals", &Configuration::diagonals, diagonals);
  set("round_corners", &Configuration::round_corners, round_corners);
  set("blend", &Configuration::blend, row.blend);
}

// The defaults with the values of a preset and of its quality. Throws ConfigError if either is
// unknown.
constexpr Parameters preset_parameters(Preset preset, Quality quality = Quality::kHigh) {
  Parameters p;
  p.preset = preset;
  p.quality = quality;
  for_each_of(preset, quality,
              [&](std::string_view, auto member, auto value) { p.*member = value; });
  return p;
}

}  // namespace deburr::spec::morphological
