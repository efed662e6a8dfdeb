// SPDX-License-Identifier: MIT
// Register map of the morphological engine: 32 bits each, byte addresses.
#pragma once

#include <array>
#include <cstdint>

#include "spec/morphological/parameters.h"
#include "spec/registers.h"

namespace deburr::spec::morphological {

namespace reg {
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
inline constexpr std::uint32_t kSmaa = 0x30;
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
inline constexpr std::uint32_t kDiagonals = 0x78;
inline constexpr std::uint32_t kLeftPixels = 0x7C;
inline constexpr std::uint32_t kSharesAddress = 0x80;
inline constexpr std::uint32_t kSharesData = 0x84;
inline constexpr std::uint32_t kSharesSum = 0x88;
inline constexpr std::uint32_t kIdValue = 0xDEB00104;

// Fields, from the lowest bit on. Codes are those of the enumerations of spec/morphological/.
namespace control {
inline constexpr Field kEnable{"enable", 0, 0, "frames are taken"};
inline constexpr Field kClearCounters{"clear_counters", 1, 1, "command, reads 0"};
inline constexpr std::array kFields = {kEnable, kClearCounters};
}  // namespace control
namespace status {
inline constexpr Field kIdle{"idle", 0, 0, "no frame inside; read only"};
inline constexpr Field kFrameDone{"frame_done", 1, 1, "sticky"};
inline constexpr Field kFraming{
    "framing", 2, 2, "sticky: start of frame, end of row or lane count are not as SIZE says"};
inline constexpr Field kMemoryError{"memory_error", 3, 3, "sticky: memory answered with an error"};
inline constexpr Field kWrittenWhileBusy{
    "written_while_busy", 4, 4,
    "sticky: a register was written while a frame was inside; the write is ignored"};
inline constexpr std::array kFields = {kIdle, kFrameDone, kFraming, kMemoryError,
                                       kWrittenWhileBusy};
}  // namespace status
namespace size {
inline constexpr Field kWidth{"width", 13, 0, "pixels, 1..8192"};
inline constexpr Field kHeight{"height", 29, 16, "pixels, 1..8192"};
inline constexpr std::array kFields = {kWidth, kHeight};
}  // namespace size
namespace rules {
inline constexpr Field kSource{"edges.source", 1, 0, {}, kEdgeSourceNames};
inline constexpr Field kThresholdMode{"threshold_mode", 2, 2, {}, kThresholdModeNames};
inline constexpr Field kDynamicLuma{"dynamic_luma", 4, 3, {}, kDynamicLumaNames};
inline constexpr Field kLocalContrast{"local_contrast", 6, 5, {}, kLocalContrastNames};
inline constexpr Field kPredictor{"predictor", 8, 7, {}, kPredictorNames};
inline constexpr Field kSteps{"steps", 13, 9, "0..16"};
inline constexpr Field kContiguous{"contiguous", 14, 14, "off where it is not built"};
inline constexpr Field kSafe{"safe", 15, 15, "1: both sides grow in lockstep, while one line fits"};
inline constexpr Field kLinearLight{"linear_light", 16, 16, "1: blend in linear light"};
inline constexpr Field kTrim{"trim", 17, 17, "1: a side that lost its line gives back steps"};
inline constexpr Field kCrossings{"ends", 18, 18, "gaps where crossings are not built", kEndsNames};
inline constexpr Field kTable{"area_table", 19, 19, "1: areas from the table, where it is built"};
inline constexpr Field kDiagonals{"diagonals", 20, 20, "off where they are not built"};
inline constexpr Field kRoundCorners{"round_corners", 21, 21, "off where they are not built"};
inline constexpr Field kStrongest{"blend", 22, 22, {}, kBlendRuleNames};
inline constexpr Field kLearned{"area_learned", 23, 23,
                                "1: areas are learned, where the ROMs are built"};
inline constexpr Field kLeave{"leave", 26, 24, {}, kLeaveNames};
inline constexpr Field kBorder{"border", 27, 27, "end where clamp is not built", kBorderNames};
inline constexpr Field kTextGuard{"text_guard", 28, 28, "off where the guard is not built"};
inline constexpr std::array kFields = {
    kSource,    kThresholdMode, kDynamicLuma, kLocalContrast, kPredictor, kSteps,     kContiguous,
    kSafe,      kLinearLight,   kTrim,        kCrossings,     kTable,     kDiagonals, kRoundCorners,
    kStrongest, kLearned,       kLeave,       kBorder,        kTextGuard};
}  // namespace rules
namespace threshold {
inline constexpr Field kValue{"value", kThresholdBits - 1, 0, "codes, U8.16"};
inline constexpr std::array kFields = {kValue};
}  // namespace threshold
namespace alpha {
inline constexpr Field kValue{"value", kThresholdBits - 1, 0, "U0.24"};
inline constexpr std::array kFields = {kValue};
}  // namespace alpha
namespace depth_threshold {
inline constexpr Field kValue{"value", 15, 0, "U0.16"};
inline constexpr std::array kFields = {kValue};
}  // namespace depth_threshold
namespace line_base {
inline constexpr Field kAddress = kLineAddress;
inline constexpr std::array kFields = {kAddress};
}  // namespace line_base
namespace smaa {
inline constexpr Field kSearchSteps{"search_steps", 6, 0, "1..112"};
inline constexpr Field kDiagonalSteps{"diagonal_steps", 12, 8, "0 for none, at most those built"};
inline constexpr Field kCornerRounding{"corner_rounding", 24, 16, "in 1/256, 0..256"};
inline constexpr std::array kFields = {kSearchSteps, kDiagonalSteps, kCornerRounding};
}  // namespace smaa
namespace shares_address {
inline constexpr Field kEntry{"entry", 11, 0, "A 0..1023, B 1024..1663, C 1664..2303"};
inline constexpr std::array kFields = {kEntry};
}  // namespace shares_address
namespace shares_data {
inline constexpr Field kShare{"share", 7, 0, "S3.4"};
inline constexpr std::array kFields = {kShare};
}  // namespace shares_data

inline constexpr std::uint32_t kControlEnable = control::kEnable.mask();
inline constexpr std::uint32_t kControlClearCounters = control::kClearCounters.mask();
inline constexpr std::uint32_t kStatusIdle = status::kIdle.mask();
inline constexpr std::uint32_t kStatusFrameDone = status::kFrameDone.mask();
inline constexpr std::uint32_t kStatusFraming = status::kFraming.mask();
inline constexpr std::uint32_t kStatusMemoryError = status::kMemoryError.mask();
inline constexpr std::uint32_t kStatusWrittenWhileBusy = status::kWrittenWhileBusy.mask();
}  // namespace reg

// Reset values marked 0 with the access kReadWrite are loaded from the parameters at construction.
inline constexpr std::array<RegisterInfo, 32> kRegisters = {{
    {reg::kId, "ID", Access::kReadOnly, reg::kIdValue,
     "Identifies the unit and the version of its register map."},
    {reg::kControl, "CONTROL", Access::kReadWrite, 1, "Switch and command.", reg::control::kFields},
    {reg::kStatus, "STATUS", Access::kWriteOneToClear, 1, "State, and what has happened.",
     reg::status::kFields},
    {reg::kSize, "SIZE", Access::kReadWrite, 0, "Size of the frame.", reg::size::kFields},
    {reg::kRules, "RULES", Access::kReadWrite, 0,
     "The rules of the frame. Blocks that are not built count as off.", reg::rules::kFields},
    {reg::kThreshold, "THRESHOLD", Access::kReadWrite, 0, "T.", reg::threshold::kFields},
    {reg::kThresholdOn, "THRESHOLD_ON", Access::kReadWrite, 0,
     "T of predicated edges where depth has an edge.", reg::threshold::kFields},
    {reg::kThresholdOff, "THRESHOLD_OFF", Access::kReadWrite, 0,
     "T of predicated edges where depth has none.", reg::threshold::kFields},
    {reg::kAlpha, "ALPHA", Access::kReadWrite, 0, "Factor of the dynamic threshold.",
     reg::alpha::kFields},
    {reg::kFloor, "FLOOR", Access::kReadWrite, 0, "Smallest luma step of a dynamic threshold.",
     reg::threshold::kFields},
    {reg::kDepthThreshold, "DEPTH_THRESHOLD", Access::kReadWrite, 0,
     "Relative depth step that is an edge.", reg::depth_threshold::kFields},
    {reg::kPixelBase, "PIXEL_BASE", Access::kReadWrite, 0,
     "Byte address of the frame with storage = memory.", reg::line_base::kFields},
    {reg::kSmaa, "SMAA", Access::kReadWrite, 0, "Searches and corners of SMAA.",
     reg::smaa::kFields},
    {reg::kPixels, "PIXELS", Access::kReadOnly, 0, "Pixels delivered."},
    {reg::kEdgePixels, "EDGE_PIXELS", Access::kReadOnly, 0, "Pixels with a left or a top edge."},
    {reg::kHorizontalRuns, "HORIZONTAL_RUNS", Access::kReadOnly, 0, "Maximal runs of top edges."},
    {reg::kVerticalRuns, "VERTICAL_RUNS", Access::kReadOnly, 0, "Maximal runs of left edges."},
    {reg::kLongRuns, "LONG_RUNS", Access::kReadOnly, 0,
     "Runs of either axis that are longer than the reach."},
    {reg::kZRuns, "Z_RUNS", Access::kReadOnly, 0, "Clean Z runs within the reach."},
    {reg::kExtendedRuns, "EXTENDED_RUNS", Access::kReadOnly, 0,
     "Runs that keep at least one step."},
    {reg::kSteps, "STEPS", Access::kReadOnly, 0, "Extensions kept."},
    {reg::kProbes, "PROBES", Access::kReadOnly, 0, "Corners tested."},
    {reg::kDivides, "DIVIDES", Access::kReadOnly, 0, "Divisions."},
    {reg::kBlendedPixels, "BLENDED_PIXELS", Access::kReadOnly, 0,
     "Pixels that took a share of a neighbour."},
    {reg::kFrameCycles, "FRAME_CYCLES", Access::kReadOnly, 0,
     "Clocks from the first input beat to the last output beat of the last frame, both counted."},
    {reg::kRecordStalls, "RECORD_STALLS", Access::kReadOnly, 0,
     "Clocks in which the slot waited for records."},
    {reg::kMemoryErrors, "MEMORY_ERRORS", Access::kReadOnly, 0, "Memory responses with an error."},
    {reg::kDiagonals, "DIAGONALS", Access::kReadOnly, 0,
     "Pixels whose top edge took its shares from a diagonal."},
    {reg::kLeftPixels, "LEFT_PIXELS", Access::kReadOnly, 0,
     "Pixels that would have taken a share and took none, by the rules leave and text_guard."},
    {reg::kSharesAddress, "SHARES_ADDRESS", Access::kReadWrite, 0,
     "Entry of the learned shares that SHARES_DATA names.", reg::shares_address::kFields},
    {reg::kSharesData, "SHARES_DATA", Access::kReadWrite, 0,
     "The entry; a write moves SHARES_ADDRESS on by one. The reset value is that of the first "
     "entry.",
     reg::shares_data::kFields},
    {reg::kSharesSum, "SHARES_SUM", Access::kReadOnly, 0,
     "Sum over all entries of (index + 1) x the entry as an unsigned byte, mod 2^32."},
}};
static_assert(fields_are_in_order(kRegisters));

// RULES and SMAA of a build after a reset.
constexpr std::uint32_t rules_word(const Parameters& p) {
  const auto code = [](auto value) { return static_cast<std::uint32_t>(value); };
  namespace rules = reg::rules;
  const bool learned = p.area == AreaSource::kLearned;
  const bool table = p.area != AreaSource::kAnalytic && !learned;
  return rules::kSource.in(code(p.edge_source)) | rules::kThresholdMode.in(code(p.threshold_mode)) |
         rules::kDynamicLuma.in(code(p.dynamic_luma)) |
         rules::kLocalContrast.in(code(p.local_contrast)) |
         rules::kPredictor.in(code(p.predictor)) | rules::kSteps.in(code(p.steps)) |
         rules::kContiguous.in(code(p.contiguous)) | rules::kSafe.in(code(p.safe)) |
         rules::kLinearLight.in(code(p.linear_light)) | rules::kTrim.in(code(p.trim)) |
         rules::kCrossings.in(code(p.ends)) | rules::kTable.in(code(table)) |
         rules::kLearned.in(code(learned)) | rules::kDiagonals.in(code(p.diagonals)) |
         rules::kRoundCorners.in(code(p.round_corners)) | rules::kStrongest.in(code(p.blend)) |
         rules::kLeave.in(code(p.leave)) | rules::kBorder.in(code(p.border)) |
         rules::kTextGuard.in(code(p.text_guard));
}
constexpr std::uint32_t smaa_word(const Parameters& p) {
  const auto code = [](auto value) { return static_cast<std::uint32_t>(value); };
  return reg::smaa::kSearchSteps.in(code(p.search_steps)) |
         reg::smaa::kDiagonalSteps.in(code(p.diagonal_steps)) |
         reg::smaa::kCornerRounding.in(code(p.corner_rounding));
}
constexpr std::uint32_t size_word(std::uint32_t width, std::uint32_t height) {
  return reg::size::kWidth.in(width) | reg::size::kHeight.in(height);
}

}  // namespace deburr::spec::morphological
