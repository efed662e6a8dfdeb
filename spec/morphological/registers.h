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
inline constexpr std::uint32_t kConfiguration = 0x10;
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
inline constexpr std::uint32_t kDescriptorStalls = 0x70;
inline constexpr std::uint32_t kMemoryErrors = 0x74;
inline constexpr std::uint32_t kDiagonals = 0x78;
inline constexpr std::uint32_t kBypassedPixels = 0x7C;
inline constexpr std::uint32_t kWeightsAddress = 0x80;
inline constexpr std::uint32_t kWeightsData = 0x84;
inline constexpr std::uint32_t kWeightsSum = 0x88;
inline constexpr std::uint32_t kIdValue = 0xDEB00105;

// Fields, lowest bit first. Codes are those of the enumerations in spec/morphological/.
namespace id {
inline constexpr std::array kFields = number(Access::kConstant, kIdValue);
}  // namespace id
namespace control {
inline constexpr Field kEnable{
    "enable", 0, 0, Access::kReadWrite, "enables the acceptance of frames", {}, 1};
inline constexpr Field kClearCounters{"clear_counters", 1, 1, Access::kCommand,
                                      "sets every counter to 0"};
inline constexpr std::array kFields = {kEnable, kClearCounters};
}  // namespace control
namespace status {
inline constexpr Field kIdle{"idle", 0, 0, Access::kReadOnly, "no frame in progress", {}, 1};
inline constexpr Field kFrameDone{"frame_done", 1, 1, Access::kWriteOneToClear,
                                  "a frame has been completed"};
inline constexpr Field kFraming{"framing", 2, 2, Access::kWriteOneToClear,
                                "start of frame, end of row or lane count contradicts SIZE"};
inline constexpr Field kMemoryError{"memory_error", 3, 3, Access::kWriteOneToClear,
                                    "a memory response had an error"};
inline constexpr Field kWrittenWhileBusy{
    "written_while_busy", 4, 4, Access::kWriteOneToClear,
    "a register was written while a frame was in progress; the write is ignored"};
inline constexpr std::array kFields = {kIdle, kFrameDone, kFraming, kMemoryError,
                                       kWrittenWhileBusy};
}  // namespace status
namespace size {
inline constexpr Field kWidth{"width", 13, 0, Access::kReadWrite, "pixels, 1..8192"};
inline constexpr Field kHeight{"height", 29, 16, Access::kReadWrite, "pixels, 1..8192"};
inline constexpr std::array kFields = {kWidth, kHeight};
}  // namespace size
namespace configuration {
inline constexpr Field kSource{"edges.source", 1, 0, Access::kReadWrite, {}, kEdgeSourceNames};
inline constexpr Field kThresholdMode{"threshold_mode",   2,  2,
                                      Access::kReadWrite, {}, kThresholdModeNames};
inline constexpr Field kDynamicLuma{"dynamic_luma",     4,  3,
                                    Access::kReadWrite, {}, kDynamicLumaNames};
inline constexpr Field kLocalContrast{"local_contrast",   6,  5,
                                      Access::kReadWrite, {}, kLocalContrastNames};
inline constexpr Field kPredictor{"predictor", 8, 7, Access::kReadWrite, {}, kPredictorNames};
inline constexpr Field kSteps{"steps", 13, 9, Access::kReadWrite, "0..16"};
inline constexpr Field kContiguous{"contiguous", 14, 14, Access::kReadWrite,
                                   "off if it is not built"};
inline constexpr Field kSafe{"safe", 15, 15, Access::kReadWrite,
                             "1: both sides extend in lockstep while one line fits"};
inline constexpr Field kLinearLight{"linear_light", 16, 16, Access::kReadWrite,
                                    "1: blend in linear light"};
inline constexpr Field kTrim{"trim", 17, 17, Access::kReadWrite,
                             "1: a side whose line was lost gives back steps"};
inline constexpr Field kCrossings{
    "ends", 18, 18, Access::kReadWrite, "gaps if crossings are not built", kEndsNames};
inline constexpr Field kTable{"area_table", 19, 19, Access::kReadWrite,
                              "1: areas from the table, if it is built"};
inline constexpr Field kDiagonals{"diagonals", 20, 20, Access::kReadWrite,
                                  "off if they are not built"};
inline constexpr Field kRoundCorners{"round_corners", 21, 21, Access::kReadWrite,
                                     "off if they are not built"};
inline constexpr Field kStrongest{"blend", 22, 22, Access::kReadWrite, {}, kBlendRuleNames};
inline constexpr Field kLearned{"area_learned", 23, 23, Access::kReadWrite,
                                "1: learned areas, if the ROMs are built"};
inline constexpr Field kBypass{"bypass", 26, 24, Access::kReadWrite, {}, kBypassNames};
inline constexpr Field kBorder{"border",    27, 27, Access::kReadWrite, "end if clamp is not built",
                               kBorderNames};
inline constexpr Field kTextGuard{"text_guard", 28, 28, Access::kReadWrite,
                                  "off if the guard is not built"};
inline constexpr std::array kFields = {
    kSource,    kThresholdMode, kDynamicLuma, kLocalContrast, kPredictor, kSteps,     kContiguous,
    kSafe,      kLinearLight,   kTrim,        kCrossings,     kTable,     kDiagonals, kRoundCorners,
    kStrongest, kLearned,       kBypass,      kBorder,        kTextGuard};
}  // namespace configuration
namespace threshold {
inline constexpr Field kValue{"value", kThresholdBits - 1, 0, Access::kReadWrite, "codes, U8.16"};
inline constexpr std::array kFields = {kValue};
}  // namespace threshold
namespace alpha {
inline constexpr Field kValue{"value", kThresholdBits - 1, 0, Access::kReadWrite, "U0.24"};
inline constexpr std::array kFields = {kValue};
}  // namespace alpha
namespace depth_threshold {
inline constexpr Field kValue{"value", 15, 0, Access::kReadWrite, "U0.16"};
inline constexpr std::array kFields = {kValue};
}  // namespace depth_threshold
namespace line_base {
inline constexpr Field kAddress = kLineAddress;
inline constexpr std::array kFields = {kAddress};
}  // namespace line_base
namespace smaa {
inline constexpr Field kSearchSteps{"search_steps", 6, 0, Access::kReadWrite, "1..112"};
inline constexpr Field kDiagonalSteps{"diagonal_steps", 12, 8, Access::kReadWrite,
                                      "0: none; at most the number built"};
inline constexpr Field kCornerRounding{"corner_rounding", 24, 16, Access::kReadWrite,
                                       "in 1/256, 0..256"};
inline constexpr std::array kFields = {kSearchSteps, kDiagonalSteps, kCornerRounding};
}  // namespace smaa
namespace weights_address {
inline constexpr Field kEntry{"entry", 11, 0, Access::kShared,
                              "A 0..1023, B 1024..1663, C 1664..2303"};
inline constexpr std::array kFields = {kEntry};
}  // namespace weights_address
namespace weights_data {
inline constexpr Field kWeight{"weight",          7,  0,           Access::kShared,
                               "S3.4; not reset", {}, std::nullopt};
inline constexpr std::array kFields = {kWeight};
}  // namespace weights_data
namespace weights_sum {
inline constexpr std::array kFields = number(Access::kReadOnly, std::nullopt);
}  // namespace weights_sum

inline constexpr std::uint32_t kControlEnable = control::kEnable.mask();
inline constexpr std::uint32_t kControlClearCounters = control::kClearCounters.mask();
inline constexpr std::uint32_t kStatusIdle = status::kIdle.mask();
inline constexpr std::uint32_t kStatusFrameDone = status::kFrameDone.mask();
inline constexpr std::uint32_t kStatusFraming = status::kFraming.mask();
inline constexpr std::uint32_t kStatusMemoryError = status::kMemoryError.mask();
inline constexpr std::uint32_t kStatusWrittenWhileBusy = status::kWrittenWhileBusy.mask();
}  // namespace reg

// During a frame, writes are ignored, except to CONTROL and STATUS.
inline constexpr bool kBusyIgnoresWrites = true;
inline constexpr std::array<RegisterInfo, 32> kRegisters = {{
    {reg::kId, "ID", "Identifies the unit and the version of its register map.", reg::id::kFields},
    {reg::kControl, "CONTROL", "Enable bit and command.", reg::control::kFields},
    {reg::kStatus, "STATUS", "State and events.", reg::status::kFields},
    {reg::kSize, "SIZE", "Size of the frame.", reg::size::kFields},
    {reg::kConfiguration, "CONFIG",
     "Configuration of the frame. Blocks that are not built count as off.",
     reg::configuration::kFields},
    {reg::kThreshold, "THRESHOLD", "T.", reg::threshold::kFields},
    {reg::kThresholdOn, "THRESHOLD_ON", "T of predicated edges at a depth edge.",
     reg::threshold::kFields},
    {reg::kThresholdOff, "THRESHOLD_OFF", "T of predicated edges without a depth edge.",
     reg::threshold::kFields},
    {reg::kAlpha, "ALPHA", "Factor of the dynamic threshold.", reg::alpha::kFields},
    {reg::kFloor, "FLOOR", "Lower limit of the dynamic threshold.", reg::threshold::kFields},
    {reg::kDepthThreshold, "DEPTH_THRESHOLD", "Relative depth step that is an edge.",
     reg::depth_threshold::kFields},
    {reg::kPixelBase, "PIXEL_BASE", "Byte address of the frame with storage = memory.",
     reg::line_base::kFields},
    {reg::kSmaa, "SMAA", "Searches and corners of SMAA.", reg::smaa::kFields},
    {reg::kPixels, "PIXELS", "Pixels delivered.", kCounter},
    {reg::kEdgePixels, "EDGE_PIXELS", "Pixels with a left or a top edge.", kCounter},
    {reg::kHorizontalRuns, "HORIZONTAL_RUNS", "Maximal runs of top edges.", kCounter},
    {reg::kVerticalRuns, "VERTICAL_RUNS", "Maximal runs of left edges.", kCounter},
    {reg::kLongRuns, "LONG_RUNS", "Runs of either axis longer than the search range.", kCounter},
    {reg::kZRuns, "Z_RUNS", "Clean Z runs within the search range.", kCounter},
    {reg::kExtendedRuns, "EXTENDED_RUNS", "Runs extended by at least one step.", kCounter},
    {reg::kSteps, "STEPS", "Extension steps kept.", kCounter},
    {reg::kProbes, "PROBES", "Corners tested.", kCounter},
    {reg::kDivides, "DIVIDES", "Divisions.", kCounter},
    {reg::kBlendedPixels, "BLENDED_PIXELS", "Blended pixels: those with a blend weight above 0.",
     kCounter},
    {reg::kFrameCycles, "FRAME_CYCLES",
     "Cycles of the last frame, from its first input beat to its last output beat, both included.",
     kCounter},
    {reg::kDescriptorStalls, "DESCRIPTOR_STALLS",
     "Cycles in which a slot waited for run descriptors.", kCounter},
    {reg::kMemoryErrors, "MEMORY_ERRORS", "Memory responses with an error.", kCounter},
    {reg::kDiagonals, "DIAGONALS", "Pixels whose top edge has the blend weights of a diagonal.",
     kCounter},
    {reg::kBypassedPixels, "BYPASSED_PIXELS",
     "Pixels whose blend weights `bypass` or `text_guard` set to 0.", kCounter},
    {reg::kWeightsAddress, "WEIGHTS_ADDRESS",
     "Index of the learned weight that WEIGHTS_DATA accesses.", reg::weights_address::kFields},
    {reg::kWeightsData, "WEIGHTS_DATA",
     "Learned weight at WEIGHTS_ADDRESS; a write increments WEIGHTS_ADDRESS.",
     reg::weights_data::kFields},
    {reg::kWeightsSum, "WEIGHTS_SUM",
     "Checksum: sum over all entries of (index + 1) x entry as an unsigned byte, mod 2^32.",
     reg::weights_sum::kFields},
}};
static_assert(fields_are_in_order(kRegisters));

// CONFIG and SMAA after a reset.
constexpr std::uint32_t configuration_word(const Parameters& p) {
  const auto code = [](auto value) { return static_cast<std::uint32_t>(value); };
  namespace configuration = reg::configuration;
  const bool learned = p.area == AreaSource::kLearned;
  const bool table = p.area != AreaSource::kAnalytic && !learned;
  return configuration::kSource.in(code(p.edge_source)) |
         configuration::kThresholdMode.in(code(p.threshold_mode)) |
         configuration::kDynamicLuma.in(code(p.dynamic_luma)) |
         configuration::kLocalContrast.in(code(p.local_contrast)) |
         configuration::kPredictor.in(code(p.predictor)) | configuration::kSteps.in(code(p.steps)) |
         configuration::kContiguous.in(code(p.contiguous)) | configuration::kSafe.in(code(p.safe)) |
         configuration::kLinearLight.in(code(p.linear_light)) |
         configuration::kTrim.in(code(p.trim)) | configuration::kCrossings.in(code(p.ends)) |
         configuration::kTable.in(code(table)) | configuration::kLearned.in(code(learned)) |
         configuration::kDiagonals.in(code(p.diagonals)) |
         configuration::kRoundCorners.in(code(p.round_corners)) |
         configuration::kStrongest.in(code(p.blend)) | configuration::kBypass.in(code(p.bypass)) |
         configuration::kBorder.in(code(p.border)) |
         configuration::kTextGuard.in(code(p.text_guard));
}
constexpr std::uint32_t smaa_word(const Parameters& p) {
  const auto code = [](auto value) { return static_cast<std::uint32_t>(value); };
  return reg::smaa::kSearchSteps.in(code(p.search_steps)) |
         reg::smaa::kDiagonalSteps.in(code(p.diagonal_steps)) |
         reg::smaa::kCornerRounding.in(code(p.corner_rounding));
}
// Registers whose reset values come from the parameters.
constexpr std::array<LoadedRegister, 8> loaded_registers(const Parameters& p) {
  const auto word = [](std::int64_t value) { return static_cast<std::uint32_t>(value); };
  return {{{reg::kConfiguration, configuration_word(p)},
           {reg::kThreshold, word(p.threshold)},
           {reg::kThresholdOn, word(p.threshold_on_depth_edge)},
           {reg::kThresholdOff, word(p.threshold_off_depth_edge)},
           {reg::kAlpha, word(p.alpha)},
           {reg::kFloor, word(p.floor)},
           {reg::kDepthThreshold, word(p.depth_threshold)},
           {reg::kSmaa, smaa_word(p)}}};
}
constexpr std::uint32_t size_word(std::uint32_t width, std::uint32_t height) {
  return reg::size::kWidth.in(width) | reg::size::kHeight.in(height);
}

}  // namespace deburr::spec::morphological
