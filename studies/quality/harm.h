// SPDX-License-Identifier: MIT
// Damage by smoothing to pixels that were correct: tables of
// docs/measurements/morphological_harm.md; and FLIP and SSIM of frames with a reference, for
// docs/measurements/morphological_quality.md. Each has procedural frames, which every clone can
// make, and third-party frames (DEBURR_DATA).
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "studies/quality/harm_frames.h"

namespace deburr::studies::harm {

std::string formula_tables();
// Throws FileError if the folder lacks a required file.
std::string data_tables(const std::filesystem::path& data);

// PSNR, FLIP and SSIM over the frame.
std::string formula_frames_with_reference();
std::string data_frames_with_reference(const std::filesystem::path& data);
// The missing files; empty: all are present.
std::string missing_data(const std::filesystem::path& data);

// A frame that needs no smoothing, filtered by a preset without and with the text guard: pixels
// that change by more than 2 codes, in %.
struct GuardedText {
  Text kind;
  double without, with;
};
// Preset `deburr` on each kind of page.
std::vector<GuardedText> guarded_text(int width, int height);
std::string guard_tables();
// The loss by the guard on thin objects that look like text.
std::string wires_table();
std::string data_guard_table(const std::filesystem::path& data);

// The row for aliased text in the table of frames that need no smoothing, measured on one page of
// this kind: fast enough for a test that always runs.
std::string text_table(Text kind);
// The same for the first table of guard_tables().
std::string guarded_text_table(Text kind);

}  // namespace deburr::studies::harm
