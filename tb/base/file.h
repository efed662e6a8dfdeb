// SPDX-License-Identifier: MIT
// Reading what a user names (bounded, regular files only) and fingerprints for the manifest.
// Writing is atomic_file.h.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace deburr::tb {

// What cannot be asked for, as by a name that is too long, is not there.
bool is_there(const std::filesystem::path& path);
bool is_folder(const std::filesystem::path& path);
// Reads a regular file of at most `max_bytes`; FileError otherwise.
std::string read_file(const std::filesystem::path& file, std::size_t max_bytes);
// The name of the standard input, which may be a pipe.
inline constexpr std::string_view kStandardInput = "/dev/stdin";
// All of the standard input, to its end; FileError where that is more than `max_bytes`.
std::string read_standard_input(std::size_t max_bytes);
// SHA-256 of a file's content, lower-case hexadecimal.
std::string sha256_of_file(const std::filesystem::path& file);
std::string sha256(std::string_view bytes);

}  // namespace deburr::tb
