// SPDX-License-Identifier: MIT
// Learned weights as a file: what `deburr train` writes and a run loads into the engine's registers
// (docs/reference/morphological/learned_weights.md, "Weight files").
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "golden/morphological/learned_weights.h"

namespace deburr::tb::stimuli {

inline constexpr std::string_view kWeightFileHead = "deburr-weights 1";

// All entries in the order of WEIGHTS_ADDRESS: A, B, C.
std::vector<std::int8_t> entries_of(const golden::morphological::WeightTables& tables);
// Their checksum as in WEIGHTS_SUM.
std::uint32_t sum_of(const golden::morphological::WeightTables& tables);

// Each note becomes a comment line.
std::string weight_file_text(const golden::morphological::WeightTables& tables,
                             const std::vector<std::string>& notes);

// Throws FileError with file, line and expectation. `name` is the file name in errors.
golden::morphological::WeightTables parse_weight_file(std::string_view name, std::string_view text);
golden::morphological::WeightTables read_weight_file(const std::filesystem::path& file);

}  // namespace deburr::tb::stimuli
