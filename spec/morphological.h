// SPDX-License-Identifier: MIT
// The morphological engine's contract: presets, parameters, packets, shape table, register map. No
// algorithm. Meaning: docs/morphological_engine.md; formats and rounding, to the bit:
// docs/number_formats_morphological.md; ROM contents: spec/morphological_tables.h.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "spec/parameters.h"
#include "spec/registers.h"

namespace deburr::spec {

// ---- choices ------------------------------------------------------------------------------------

enum class MorphologicalPreset : std::uint8_t { kMlaa, kMlaaSlope, kSmaa, kSmaaDynamic, kDeburr };
inline constexpr std::array<std::string_view, 5> kMorphologicalPresetNames = {
    "mlaa", "mlaa-slope", "smaa", "smaa-dynamic", "deburr"};

enum class Lanes : std::uint8_t { kOne, kTwo, kFour };
inline constexpr std::array<std::string_view, 3> kLanesNames = {"1", "2", "4"};
inline constexpr std::array<std::uint8_t, 3> kLaneCount = {1, 2, 4};
inline constexpr int kMaxLanes = 4;

enum class EdgeSource : std::uint8_t { kLuma, kDepth, kPredicated };
inline constexpr std::array<std::string_view, 3> kEdgeSourceNames = {"luma", "depth", "predicated"};

enum class ThresholdMode : std::uint8_t { kFixed, kDynamic };
inline constexpr std::array<std::string_view, 2> kThresholdModeNames = {"fixed", "dynamic"};

enum class DynamicLuma : std::uint8_t { kCurrent, kMax };
inline constexpr std::array<std::string_view, 2> kDynamicLumaNames = {"current", "max"};

enum class LocalContrast : std::uint8_t { kOff, kPaper, kSymmetric };
inline constexpr std::array<std::string_view, 3> kLocalContrastNames = {"off", "paper",
                                                                        "symmetric"};

enum class Predictor : std::uint8_t { kNone, kChord, kFit };
inline constexpr std::array<std::string_view, 3> kPredictorNames = {"none", "chord", "fit"};

enum class AreaSource : std::uint8_t { kAnalytic, kTableFull, kTableMerged };
inline constexpr std::array<std::string_view, 3> kAreaSourceNames = {"analytic", "table_full",
                                                                     "table_merged"};

enum class Storage : std::uint8_t { kLineBuffers, kMemory };
inline constexpr std::array<std::string_view, 2> kStorageNames = {"line_buffers", "memory"};

// ---- parameters ---------------------------------------------------------------------------------

inline constexpr int kMaxFrameSize = 8192;  // pixels, each way
inline constexpr int kMaxSteps = 16;        // N
inline constexpr int kMaxCorners = 2 * kMaxSteps + 2;
inline constexpr int kFrameLineBytes = 64;     // memory line of storage = memory
inline constexpr int kFramePixelBytes = 4;     // R, G, B, A
inline constexpr int kRecipFractionBits = 24;  // of LineRecord::slope
inline constexpr int kInverseFractionBits = 12;
inline constexpr int kMaxWeight = 128;      // U0.8: a half, the largest share of a neighbour
inline constexpr int kRowLag = 5;           // rows of delay beyond the reach
inline constexpr int kPipelineLatency = 6;  // clocks from a slot to its output beat

// Weights of luma, U0.16; they sum to exactly 65536.
inline constexpr std::array<std::uint32_t, 3> kLumaWeights = {13933, 46871, 4732};

// The defaults are the preset `deburr`.
struct MorphologicalParameters {
  MorphologicalPreset preset = MorphologicalPreset::kDeburr;
  Lanes lanes = Lanes::kOne;
  EdgeSource edge_source = EdgeSource::kLuma;
  ThresholdMode threshold_mode = ThresholdMode::kFixed;
  DynamicLuma dynamic_luma = DynamicLuma::kMax;
  std::int32_t threshold = 1966;                 // U0.16: 0.03
  std::int32_t threshold_on_depth_edge = 655;    // U0.16: 0.01
  std::int32_t threshold_off_depth_edge = 3277;  // U0.16: 0.05
  std::int32_t alpha = 6554;                     // U0.16: 0.1
  std::int32_t floor = 514;                      // U0.16: 2/255
  std::int32_t depth_threshold = 3277;           // U0.16: 0.05
  LocalContrast local_contrast = LocalContrast::kSymmetric;
  Predictor predictor = Predictor::kFit;
  std::int32_t steps = 8;
  bool contiguous = true;
  bool safe = true;
  bool trim = true;
  AreaSource area = AreaSource::kAnalytic;
  bool diagonals = false;
  bool round_corners = false;
  bool linear_light = true;
  std::int32_t window_rows = 66;
  std::int32_t reach_columns = 256;
  std::int32_t line_pixels = kMaxFrameSize;
  std::int32_t record_fifo = 256;
  std::int32_t predictor_units = 2;
  std::int32_t divider_latency = 24;
  std::int32_t divider_interval = 1;
  Storage storage = Storage::kLineBuffers;
  std::int32_t memory_outstanding = 32;
};

template <class Visitor>
void describe(MorphologicalParameters& p, Visitor& v) {
  v.choice("preset", p.preset, kMorphologicalPresetNames,
           "Named set of the rules below; rules given beside it override it.");
  v.choice("lanes", p.lanes, kLanesNames, "Pixels a clock.");
  v.choice("edges.source", p.edge_source, kEdgeSourceNames,
           "What makes an edge: luma, depth, or luma with a threshold that depth moves.");
  v.choice("edges.threshold_mode", p.threshold_mode, kThresholdModeNames,
           "fixed: T. dynamic: alpha times luma (paper 003), above a floor.");
  v.choice(
      "edges.dynamic_luma", p.dynamic_luma, kDynamicLumaNames,
      "Luma that alpha multiplies: of the current pixel (the paper) or the larger of the pair.");
  v.integer("edges.threshold", p.threshold, 1, 65535, "1/65536", "T, a share of full scale.");
  v.integer("edges.threshold_on_depth_edge", p.threshold_on_depth_edge, 1, 65535, "1/65536",
            "T of source = predicated where depth has an edge.");
  v.integer("edges.threshold_off_depth_edge", p.threshold_off_depth_edge, 1, 65535, "1/65536",
            "T of source = predicated where depth has no edge.");
  v.integer("edges.alpha", p.alpha, 0, 65535, "1/65536", "Factor of the dynamic threshold.");
  v.integer("edges.floor", p.floor, 1, 65535, "1/65536",
            "Smallest step that a dynamic threshold lets through.");
  v.integer("edges.depth_threshold", p.depth_threshold, 1, 65535, "1/65536",
            "Relative step of depth that is an edge.");
  v.choice("edges.local_contrast", p.local_contrast, kLocalContrastNames,
           "Drop edges beside one of twice the contrast: eq (2), (3) of paper 003, or a symmetric "
           "form of them.");
  v.choice("predictor", p.predictor, kPredictorNames,
           "Line through a run: its own ends, the chord of the extended ends (paper 000), or the "
           "least-squares line through all visited corners.");
  v.integer("steps", p.steps, 0, kMaxSteps, "step", "N: extensions tried on each side of a run.");
  v.boolean("contiguous", p.contiguous,
            "A step must be an unbroken run with the codes of the first at both corners.");
  v.boolean("safe", p.safe,
            "Both sides grow in lockstep, share L', and stop where no line fits all corners.");
  v.boolean("trim", p.trim,
            "A side that lost its line before N steps and the end of the reach gives back its last "
            "step; one that no line fits, half of its steps.");
  v.choice("area", p.area, kAreaSourceNames, "Where areas come from; only analytic is built.");
  v.boolean("diagonals", p.diagonals, "Diagonal patterns of SMAA; not built.");
  v.boolean("round_corners", p.round_corners, "Corner rounding of SMAA; not built.");
  v.boolean("linear_light", p.linear_light, "Blend in linear light (sRGB) instead of codes.");
  v.integer("window_rows", p.window_rows, 10, 258, "row",
            "Rows of edges held; even. A pixel depends on window_rows / 2 - 1 rows each way.");
  v.integer("reach_columns", p.reach_columns, 4, 2048, "pixel",
            "Longest horizontal run, and how far it may be extended.");
  v.integer("line_pixels", p.line_pixels, 1, kMaxFrameSize, "pixel",
            "Widest frame that the line buffers hold.");
  v.integer(
      "record_fifo", p.record_fifo, 2, 4096, "record",
      "Runs waiting for a predictor, for each axis and lane; a tenth of a row bears a burst.");
  v.integer("predictor_units", p.predictor_units, 1, 16, "unit",
            "Predictors for each axis and lane; each tries one step of both sides a clock.");
  v.integer("divider.latency", p.divider_latency, 1, 64, "clock", "Latency of the divider.");
  v.integer("divider.interval", p.divider_interval, 1, 64, "clock",
            "Initiation interval of the divider.");
  v.choice("storage", p.storage, kStorageNames,
           "Where delayed pixels wait: on-chip line buffers, or memory (written, then read once).");
  v.integer("memory.outstanding", p.memory_outstanding, 1, 256, "line",
            "Lines in flight with storage = memory, each direction.");
}

// What a preset sets; every other parameter keeps its default. `area`, `diagonals` and
// `round_corners` of the two SMAA presets name blocks that are not built yet.
struct MorphologicalPresetRow {
  MorphologicalPreset preset;
  ThresholdMode threshold_mode;
  DynamicLuma dynamic_luma;
  std::int32_t threshold;
  LocalContrast local_contrast;
  Predictor predictor;
  std::int32_t steps;
  bool contiguous;
  bool safe;
  bool trim;
  AreaSource area;
  bool diagonals;
};
inline constexpr std::array<MorphologicalPresetRow, 5> kMorphologicalPresets = {{
    {MorphologicalPreset::kMlaa, ThresholdMode::kFixed, DynamicLuma::kMax, 6554,
     LocalContrast::kOff, Predictor::kNone, 0, false, false, false, AreaSource::kAnalytic, false},
    {MorphologicalPreset::kMlaaSlope, ThresholdMode::kFixed, DynamicLuma::kMax, 6554,
     LocalContrast::kOff, Predictor::kChord, 4, false, false, false, AreaSource::kAnalytic, false},
    {MorphologicalPreset::kSmaa, ThresholdMode::kFixed, DynamicLuma::kMax, 6554,
     LocalContrast::kPaper, Predictor::kNone, 0, false, false, false, AreaSource::kTableFull, true},
    {MorphologicalPreset::kSmaaDynamic, ThresholdMode::kDynamic, DynamicLuma::kCurrent, 6554,
     LocalContrast::kPaper, Predictor::kNone, 0, false, false, false, AreaSource::kTableMerged,
     true},
    {MorphologicalPreset::kDeburr, ThresholdMode::kFixed, DynamicLuma::kMax, 1966,
     LocalContrast::kSymmetric, Predictor::kFit, 8, true, true, true, AreaSource::kAnalytic, false},
}};

// ---- packets ------------------------------------------------------------------------------------

using Rgba8 = std::array<std::uint8_t, 4>;  // R, G, B, A codes, U0.8 unorm

// A clock's worth of pixels of one row, raster order, lane 0 leftmost. Rows begin a new beat.
struct PixelBeat {
  std::array<Rgba8, kMaxLanes> pixel{};
  std::array<std::uint32_t, kMaxLanes> depth{};  // U24, grows towards the eye; 0 if there is none
  std::uint8_t count = 0;                        // valid lanes, 1..lanes; fewer only at a row's end
  bool start_of_frame = false;                   // first beat of the frame
  bool end_of_row = false;                       // last beat of a row
  friend bool operator==(const PixelBeat&, const PixelBeat&) = default;
};

// How a pixel was blended, for checks and pictures: first = share of the upper (left) neighbour,
// second = of the lower (right) one, U0.8; both 0 where the pixel passed unchanged.
struct BlendTap {
  bool horizontal = false;  // the neighbours are left and right
  std::uint8_t first = 0, second = 0;
  std::uint8_t edges = 0;  // bit 0 left, bit 1 top
  friend bool operator==(const BlendTap&, const BlendTap&) = default;
};

struct BlendedBeat {
  std::array<Rgba8, kMaxLanes> pixel{};
  std::array<BlendTap, kMaxLanes> tap{};
  std::uint8_t count = 0;
  bool start_of_frame = false;
  bool end_of_row = false;
  friend bool operator==(const BlendedBeat&, const BlendedBeat&) = default;
};

enum class Axis : std::uint8_t { kHorizontal, kVertical };  // direction of the run
// A run longer than the reach gives two records, one for each end.
enum class RunPart : std::uint8_t { kWhole, kHead, kTail };

// A closed run. Horizontal: `line` is the row of the top edges, positions are columns. Vertical:
// `line` is the column of the left edges, positions are rows. Corners are `start` and
// `start + length`; of a head (tail) only the first (second) is a corner of the run.
struct RunRecord {
  Axis axis = Axis::kHorizontal;
  RunPart part = RunPart::kWhole;
  std::uint16_t line = 0;
  std::uint16_t start = 0;
  std::uint16_t length = 0;  // pixels covered by this record
  std::uint8_t shape = 0;    // index of kRunShapes
  friend bool operator==(const RunRecord&, const RunRecord&) = default;
};

// Which pixel of the pair beside the edge the line enters.
enum class Side : std::uint8_t {
  kNone,
  kFirst,
  kSecond
};  // first: upper (left); second: lower (right)

// The line through a run. t(X) = (scale * X - offset) * slope + shift * 2^23, U/S x.24, X counted
// from the record's start; t < 0 belongs to `before`, t > 0 to `after`.
struct LineRecord {
  RunRecord run{};
  Side before = Side::kNone, after = Side::kNone;
  std::uint8_t left_steps = 0, right_steps = 0;  // extensions kept: up or left, down or right
  std::int32_t scale = 2;
  std::int32_t offset = 0;
  std::int32_t shift = 0;     // right_steps - left_steps
  std::uint32_t slope = 0;    // U0.24
  std::uint32_t inverse = 0;  // U12.12, pixels a step
  std::uint16_t span = 0;     // pixels between the two outermost corners: decides between axes
  friend bool operator==(const LineRecord&, const LineRecord&) = default;
};

// ---- the sixteen crossing codes -----------------------------------------------------------------

// Code of an end: bit 0 the crossing edge on the first side (north, west), bit 1 on the second
// (south, east). Index of the table: code of the start corner + 4 * code of the end corner.
struct RunShape {
  std::string_view name;
  Side before, after;
  bool clean_z;  // may be extended
};
inline constexpr std::array<RunShape, 16> kRunShapes = {{
    {"none-none", Side::kNone, Side::kNone, false},
    {"L-first-none", Side::kFirst, Side::kNone, false},
    {"L-second-none", Side::kSecond, Side::kNone, false},
    {"T-none", Side::kNone, Side::kNone, false},
    {"L-none-first", Side::kNone, Side::kFirst, false},
    {"U-first", Side::kFirst, Side::kFirst, false},
    {"Z-second-first", Side::kSecond, Side::kFirst, true},
    {"T-first", Side::kSecond, Side::kFirst, false},
    {"L-none-second", Side::kNone, Side::kSecond, false},
    {"Z-first-second", Side::kFirst, Side::kSecond, true},
    {"U-second", Side::kSecond, Side::kSecond, false},
    {"T-second", Side::kFirst, Side::kSecond, false},
    {"none-T", Side::kNone, Side::kNone, false},
    {"first-T", Side::kFirst, Side::kSecond, false},
    {"second-T", Side::kSecond, Side::kFirst, false},
    {"T-T", Side::kNone, Side::kNone, false},
}};

// One line access of storage = memory.
struct FrameAccess {
  std::uint32_t address = 0;  // bytes, multiple of kFrameLineBytes
  bool write = false;
  friend bool operator==(const FrameAccess&, const FrameAccess&) = default;
};

// Work of one frame: golden and hardware count the same.
struct MorphologicalWork {
  std::uint64_t pixels = 0;
  std::uint64_t edge_pixels = 0;      // pixels with a left or a top edge
  std::uint64_t horizontal_runs = 0;  // maximal runs, each counted once
  std::uint64_t vertical_runs = 0;
  std::uint64_t long_runs = 0;  // of both axes, longer than the reach
  std::uint64_t z_runs = 0;     // clean Z, not long
  std::uint64_t extended_runs = 0;
  std::uint64_t steps = 0;           // extensions kept
  std::uint64_t probes = 0;          // corners tested
  std::uint64_t divides = 0;         // records that have a side
  std::uint64_t blended_pixels = 0;  // pixels with a share of a neighbour
  friend bool operator==(const MorphologicalWork&, const MorphologicalWork&) = default;
};

// ---- registers (32 bits each, byte addresses) ---------------------------------------------------

namespace morphological_register {
inline constexpr std::uint32_t kId = 0x00;
inline constexpr std::uint32_t kControl = 0x04;
inline constexpr std::uint32_t kStatus = 0x08;
inline constexpr std::uint32_t kSize = 0x0C;
inline constexpr std::uint32_t kRules = 0x10;
inline constexpr std::uint32_t kThreshold = 0x14;
inline constexpr std::uint32_t kThresholdOn = 0x18;
inline constexpr std::uint32_t kThresholdOff = 0x1C;
inline constexpr std::uint32_t kAlpha = 0x20;
inline constexpr std::uint32_t kFloor = 0x24;
inline constexpr std::uint32_t kDepthThreshold = 0x28;
inline constexpr std::uint32_t kPixelBase = 0x2C;
inline constexpr std::uint32_t kPixels = 0x40;
inline constexpr std::uint32_t kEdgePixels = 0x44;
inline constexpr std::uint32_t kHorizontalRuns = 0x48;
inline constexpr std::uint32_t kVerticalRuns = 0x4C;
inline constexpr std::uint32_t kLongRuns = 0x50;
inline constexpr std::uint32_t kZRuns = 0x54;
inline constexpr std::uint32_t kExtendedRuns = 0x58;
inline constexpr std::uint32_t kSteps = 0x5C;
inline constexpr std::uint32_t kProbes = 0x60;
inline constexpr std::uint32_t kDivides = 0x64;
inline constexpr std::uint32_t kBlendedPixels = 0x68;
inline constexpr std::uint32_t kFrameCycles = 0x6C;
inline constexpr std::uint32_t kRecordStalls = 0x70;
inline constexpr std::uint32_t kMemoryErrors = 0x74;
inline constexpr std::uint32_t kIdValue = 0xDEB00002;
inline constexpr std::uint32_t kControlEnable = 1u << 0;
inline constexpr std::uint32_t kControlClearCounters = 1u << 1;
inline constexpr std::uint32_t kStatusIdle = 1u << 0;
inline constexpr std::uint32_t kStatusFrameDone = 1u << 1;
inline constexpr std::uint32_t kStatusFraming = 1u << 2;
inline constexpr std::uint32_t kStatusMemoryError = 1u << 3;
inline constexpr std::uint32_t kStatusWrittenWhileBusy = 1u << 4;
}  // namespace morphological_register

// Reset values marked 0 with the access kReadWrite are loaded from the parameters at construction.
inline constexpr std::array<RegisterInfo, 26> kMorphologicalRegisters = {{
    {morphological_register::kId, "ID", Access::kReadOnly, morphological_register::kIdValue,
     "Identifies the unit and the version of its register map."},
    {morphological_register::kControl, "CONTROL", Access::kReadWrite, 1,
     "Bit 0 enable: frames are taken. Bit 1 clear the counters (command, reads 0)."},
    {morphological_register::kStatus, "STATUS", Access::kWriteOneToClear, 1,
     "Bit 0 idle: no frame inside (read only). Sticky: bit 1 frame done, bit 2 start of frame, end "
     "of row or lane count not as SIZE says, bit 3 memory error response, bit 4 register written "
     "while a frame was inside (the write is ignored)."},
    {morphological_register::kSize, "SIZE", Access::kReadWrite, 0,
     "Width [13:0] and height [29:16] of the frame in pixels, 1..8192 each."},
    {morphological_register::kRules, "RULES", Access::kReadWrite, 0,
     "edges.source [1:0], threshold_mode [2], dynamic_luma [3], local_contrast [5:4], predictor "
     "[7:6], steps [12:8], contiguous [13], safe [14], linear_light [15], trim [16]."},
    {morphological_register::kThreshold, "THRESHOLD", Access::kReadWrite, 0, "T, U0.16 [15:0]."},
    {morphological_register::kThresholdOn, "THRESHOLD_ON", Access::kReadWrite, 0,
     "T of predicated edges where depth has an edge, U0.16 [15:0]."},
    {morphological_register::kThresholdOff, "THRESHOLD_OFF", Access::kReadWrite, 0,
     "T of predicated edges where depth has none, U0.16 [15:0]."},
    {morphological_register::kAlpha, "ALPHA", Access::kReadWrite, 0,
     "Factor of the dynamic threshold, U0.16 [15:0]."},
    {morphological_register::kFloor, "FLOOR", Access::kReadWrite, 0,
     "Smallest luma step of a dynamic threshold, U0.16 [15:0]."},
    {morphological_register::kDepthThreshold, "DEPTH_THRESHOLD", Access::kReadWrite, 0,
     "Relative depth step that is an edge, U0.16 [15:0]."},
    {morphological_register::kPixelBase, "PIXEL_BASE", Access::kReadWrite, 0,
     "Byte address of the frame with storage = memory; a multiple of 64 (low bits read 0)."},
    {morphological_register::kPixels, "PIXELS", Access::kReadOnly, 0, "Pixels delivered."},
    {morphological_register::kEdgePixels, "EDGE_PIXELS", Access::kReadOnly, 0,
     "Pixels with a left or a top edge."},
    {morphological_register::kHorizontalRuns, "HORIZONTAL_RUNS", Access::kReadOnly, 0,
     "Maximal runs of top edges."},
    {morphological_register::kVerticalRuns, "VERTICAL_RUNS", Access::kReadOnly, 0,
     "Maximal runs of left edges."},
    {morphological_register::kLongRuns, "LONG_RUNS", Access::kReadOnly, 0,
     "Runs of either axis that are longer than the reach."},
    {morphological_register::kZRuns, "Z_RUNS", Access::kReadOnly, 0,
     "Clean Z runs within the reach."},
    {morphological_register::kExtendedRuns, "EXTENDED_RUNS", Access::kReadOnly, 0,
     "Runs that keep at least one step."},
    {morphological_register::kSteps, "STEPS", Access::kReadOnly, 0, "Extensions kept."},
    {morphological_register::kProbes, "PROBES", Access::kReadOnly, 0, "Corners tested."},
    {morphological_register::kDivides, "DIVIDES", Access::kReadOnly, 0, "Divisions."},
    {morphological_register::kBlendedPixels, "BLENDED_PIXELS", Access::kReadOnly, 0,
     "Pixels that took a share of a neighbour."},
    {morphological_register::kFrameCycles, "FRAME_CYCLES", Access::kReadOnly, 0,
     "Clocks from the first input beat to the last output beat of the last frame, both counted."},
    {morphological_register::kRecordStalls, "RECORD_STALLS", Access::kReadOnly, 0,
     "Clocks in which the slot waited for records."},
    {morphological_register::kMemoryErrors, "MEMORY_ERRORS", Access::kReadOnly, 0,
     "Memory responses with an error."},
}};

}  // namespace deburr::spec
