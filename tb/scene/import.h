// SPDX-License-Identifier: MIT
// The two importers behind import_mesh() and mesh_files(). Internal to tb/scene.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tb/scene/mesh.h"

namespace deburr::tb {

// Reads one file in two steps, so that what it opens is known without the work of making a mesh.
class Importer {
 public:
  Importer(std::filesystem::path path, const ImportOptions& options)
      : path_(std::move(path)), options_(options) {}
  virtual ~Importer() = default;
  Importer(const Importer&) = delete;
  Importer& operator=(const Importer&) = delete;

  // Finds the file and everything that it names. FileError as of import_mesh().
  virtual void open() = 0;
  // Makes a mesh of what open() has found, and reads nothing else.
  virtual Mesh build() = 0;
  // What open() has found, and what it has looked for in vain, until it failed if it did.
  const std::vector<std::filesystem::path>& files() const { return files_; }

 protected:
  const std::filesystem::path& path() const { return path_; }
  const ImportOptions& options() const { return options_; }
  // Of the mesh's folder, which relative names begin in; empty for the current one.
  std::filesystem::path folder() const { return path_.parent_path(); }
  // Whatever is read of a file begins with this.
  void add_file(const std::filesystem::path& file) { add_once(files_, file); }
  // The mesh's own file.
  std::string read_mesh();
  // A file that the mesh names; nothing where it is not there.
  std::optional<std::string> read_named(const std::filesystem::path& file);

 private:
  std::filesystem::path path_;
  ImportOptions options_;
  std::vector<std::filesystem::path> files_;
};

std::unique_ptr<Importer> obj_importer(const std::filesystem::path& path,
                                       const ImportOptions& options);
std::unique_ptr<Importer> gltf_importer(const std::filesystem::path& path,
                                        const ImportOptions& options);

}  // namespace deburr::tb
