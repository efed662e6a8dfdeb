// SPDX-License-Identifier: MIT
// Files that are there whole or not at all.
#pragma once

#include <filesystem>
#include <initializer_list>
#include <string_view>

namespace deburr::tb {

// Writes `bytes` to a temporary file in the same folder, fsyncs, closes, checks the size and
// renames it to `path`. Every step is checked: a full disk is reported here and the old file stays
// as it was.
void write_file_atomically(const std::filesystem::path& path, std::string_view bytes);

struct FileContent {
  std::filesystem::path path;
  std::string_view bytes;
};
// The same for files that belong together: none is replaced before all have been written.
void write_files_atomically(std::initializer_list<FileContent> contents);

// All but the renaming, before work that takes long: throws what a write would throw now, and
// leaves nothing.
void try_to_write(const std::filesystem::path& path, std::string_view bytes);

}  // namespace deburr::tb
