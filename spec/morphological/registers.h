// SPDX-License-Identifier: MIT
// Register map of the morphological engine: 32 bits each, byte addresses.
#pragma once

#include <array>
#include <cstdint>

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
inline constexpr std::uint32_t kIdValue = 0xDEB00002;
inline constexpr std::uint32_t kControlEnable = 1u << 0;
inline constexpr std::uint32_t kControlClearCounters = 1u << 1;
inline constexpr std::uint32_t kStatusIdle = 1u << 0;
inline constexpr std::uint32_t kStatusFrameDone = 1u << 1;
inline constexpr std::uint32_t kStatusFraming = 1u << 2;
inline constexpr std::uint32_t kStatusMemoryError = 1u << 3;
inline constexpr std::uint32_t kStatusWrittenWhileBusy = 1u << 4;
}  // namespace reg

// Reset values marked 0 with the access kReadWrite are loaded from the parameters at construction.
inline constexpr std::array<RegisterInfo, 32> kRegisters = {{
    {reg::kId, "ID", Access::kReadOnly, reg::kIdValue,
     "Identifies the unit and the version of its register map."},
    {reg::kControl, "CONTROL", Access::kReadWrite, 1,
     "Bit 0 enable: frames are taken. Bit 1 clear the counters (command, reads 0)."},
    {reg::kStatus, "STATUS", Access::kWriteOneToClear, 1,
     "Bit 0 idle: no frame inside (read only). Sticky: bit 1 frame done, bit 2 start of frame, end "
     "of row or lane count not as SIZE says, bit 3 memory error response, bit 4 register written "
     "while a frame was inside (the write is ignored)."},
    {reg::kSize, "SIZE", Access::kReadWrite, 0,
     "Width [13:0] and height [29:16] of the frame in pixels, 1..8192 each."},
    {reg::kRules, "RULES", Access::kReadWrite, 0,
     "edges.source [1:0], threshold_mode [2], dynamic_luma [17, 3], local_contrast [5:4], "
     "predictor [7:6], steps [12:8], contiguous [13], safe [14], linear_light [15], trim [16], "
     "ends = crossings [18], area from the table [19], diagonals [20], round_corners [21], blend = "
     "strongest [22], leave [26, 24:23], area learned [25]. Blocks that are not built read as "
     "off."},
    {reg::kThreshold, "THRESHOLD", Access::kReadWrite, 0, "T, U0.16 [15:0]."},
    {reg::kThresholdOn, "THRESHOLD_ON", Access::kReadWrite, 0,
     "T of predicated edges where depth has an edge, U0.16 [15:0]."},
    {reg::kThresholdOff, "THRESHOLD_OFF", Access::kReadWrite, 0,
     "T of predicated edges where depth has none, U0.16 [15:0]."},
    {reg::kAlpha, "ALPHA", Access::kReadWrite, 0, "Factor of the dynamic threshold, U0.16 [15:0]."},
    {reg::kFloor, "FLOOR", Access::kReadWrite, 0,
     "Smallest luma step of a dynamic threshold, U0.16 [15:0]."},
    {reg::kDepthThreshold, "DEPTH_THRESHOLD", Access::kReadWrite, 0,
     "Relative depth step that is an edge, U0.16 [15:0]."},
    {reg::kPixelBase, "PIXEL_BASE", Access::kReadWrite, 0,
     "Byte address of the frame with storage = memory; a multiple of 64 (low bits read 0)."},
    {reg::kSmaa, "SMAA", Access::kReadWrite, 0,
     "search_steps [6:0], diagonal_steps [12:8], 0 for none, corner_rounding [24:16] in 1/256."},
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
     "Pixels that would have taken a share and took none, by the rule leave."},
    {reg::kSharesAddress, "SHARES_ADDRESS", Access::kReadWrite, 0,
     "Entry [11:0] of the learned shares that SHARES_DATA names: A 0..1023, B 1024..1663, C "
     "1664..2303."},
    {reg::kSharesData, "SHARES_DATA", Access::kReadWrite, 0,
     "The entry, S3.4 [7:0]; a write moves SHARES_ADDRESS on by one. The reset value is that of "
     "the "
     "first entry."},
    {reg::kSharesSum, "SHARES_SUM", Access::kReadOnly, 0,
     "Sum over all entries of (index + 1) x the entry as an unsigned byte, mod 2^32."},
}};

}  // namespace deburr::spec::morphological
