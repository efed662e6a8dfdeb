// SPDX-License-Identifier: MIT
// Learned shares as a file: what `deburr train` writes and a run loads into the engine's registers
// (docs/reference/morphological/learned_shares.md, "Share files").
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "golden/morphological/learned_shares.h"

namespace deburr::tb::stimuli {

inline constexpr std::string_view kShareFileHead = "deburr-shares 1";

// All entries in the order of SHARES_ADDRESS: A, B, C.
std::vector<std::int8_t> entries_of(const golden::morphological::ShareTables& tables);
// What SHARES_SUM says of them.
std::uint32_t sum_of(const golden::morphological::ShareTables& tables);

// Each note becomes a comment, a line each.
std::string share_file_text(const golden::morphological::ShareTables& tables,
                            const std::vector<std::string>& notes);

// FileError that names file, line and what was expected. `name` is what errors call it.
golden::morphological::ShareTables parse_share_file(std::string_view name, std::string_view text);
golden::morphological::ShareTables read_share_file(const std::filesystem::path& file);

}  // namespace deburr::tb::stimuli
