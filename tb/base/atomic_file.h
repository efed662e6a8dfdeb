// SPDX-License-Identifier: MIT
// Files that belong together. One file alone: image_io.h.
#pragma once

#include <filesystem>
#include <initializer_list>
#include <string_view>

namespace deburr::tb {

struct FileContent {
  std::filesystem::path path;
  std::string_view bytes;
};
// As write_file_atomically() (image_io.h), and none is replaced before all have been written.
void write_files_atomically(std::initializer_list<FileContent> contents);

}  // namespace deburr::tb
