// SPDX-License-Identifier: MIT
// What smoothing does to what is right: tables of docs/measurements/morphological_harm.md. And what
// FLIP and SSIM say of frames with reference: of docs/measurements/morphological_quality.md. One
// part of each is of frames by formula, which every clone has; the other of frames that others made
// (DEBURR_DATA).
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "studies/quality/harm_frames.h"

namespace deburr::studies::harm {

std::string formula_tables();
// FileError where the folder has not what they need.
std::string data_tables(const std::filesystem::path& data);

// PSNR, FLIP and SSIM over the frame.
std::string formula_frames_with_reference();
std::string data_frames_with_reference(const std::filesystem::path& data);
// What of that is not there; empty: all is.
std::string missing_data(const std::filesystem::path& data);

// A frame that is right as it is, smoothed by a preset without the text guard and with it: pixels
// that change by more than 2 codes, %.
struct GuardedText {
  Text kind;
  double without, with;
};
// Of `deburr`, on each kind of page.
std::vector<GuardedText> guarded_text(int width, int height);
std::string guard_tables();
// What the guard takes from thin things that look as text does.
std::string wires_table();
std::string data_guard_table(const std::filesystem::path& data);

// Of the table of frames that are right the row of a page of aliased text, made of one of
// this kind: as quick as a test that runs every time should be.
std::string text_table(Text kind);
// The same of the first of guard_tables().
std::string guarded_text_table(Text kind);

}  // namespace deburr::studies::harm
