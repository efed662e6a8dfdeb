// SPDX-License-Identifier: MIT
// Reads files named by a user (regular files of limited size only) and fingerprints them for the
// manifest. For writing see atomic_file.h.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace deburr::tb {

// Whether a file exists; false also if it cannot be queried, for example because its name is too
// long.
bool is_there(const std::filesystem::path& path);
bool is_folder(const std::filesystem::path& path);
// Reads a regular file of at most `max_bytes`; throws FileError otherwise.
std::string read_file(const std::filesystem::path& file, std::size_t max_bytes);
// The name of the standard input, which may be a pipe.
inline constexpr std::string_view kStandardInput = "/dev/stdin";
// Reads the standard input to its end; throws FileError if it exceeds `max_bytes`.
std::string read_standard_input(std::size_t max_bytes);
// SHA-256 of a file's content in lower-case hexadecimal.
std::string sha256_of_file(const std::filesystem::path& file);
std::string sha256(std::string_view bytes);

}  // namespace deburr::tb
