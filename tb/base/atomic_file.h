// SPDX-License-Identifier: MIT
// Writes files atomically: a file appears complete or not at all.
#pragma once

#include <filesystem>
#include <initializer_list>
#include <string_view>

namespace deburr::tb {

// Writes `bytes` to a temporary file in the same folder, calls fsync, closes it, checks its size
// and renames it to `path`. Every step is checked: a full disk throws here and the old file is
// unchanged.
void write_file_atomically(const std::filesystem::path& path, std::string_view bytes);

struct FileContent {
  std::filesystem::path path;
  std::string_view bytes;
};
// As above for files that belong together: all are written before the first one is replaced.
void write_files_atomically(std::initializer_list<FileContent> contents);

// Does everything except the rename, before long work: throws errors that a write would throw now
// and leaves no file.
void try_to_write(const std::filesystem::path& path, std::string_view bytes);

}  // namespace deburr::tb
