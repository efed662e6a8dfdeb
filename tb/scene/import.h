// SPDX-License-Identifier: MIT
// The importers used by import_mesh() and mesh_files(). Internal to tb/scene.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tb/scene/mesh.h"

namespace deburr::tb {

// Reads a mesh in two steps, so that the names of all opened files are known without building the
// mesh.
class Importer {
 public:
  Importer(std::filesystem::path path, const ImportOptions& options)
      : path_(std::move(path)), options_(options) {}
  virtual ~Importer() = default;
  Importer(const Importer&) = delete;
  Importer& operator=(const Importer&) = delete;

  // Finds the mesh file and all files that it names. Throws FileError as import_mesh() does.
  virtual void open() = 0;
  // Builds a mesh from the files that open() found; reads no other files.
  virtual Mesh build() = 0;
  // Files that open() found, and files that it looked for but did not find, even if open() failed.
  const std::vector<std::filesystem::path>& files() const { return files_; }

 protected:
  const std::filesystem::path& path() const { return path_; }
  const ImportOptions& options() const { return options_; }
  // Folder of the mesh, to which relative names refer; empty for the current folder.
  std::filesystem::path folder() const { return path_.parent_path(); }
  // Called before a file is read.
  void add_file(const std::filesystem::path& file) { add_once(files_, file); }
  // The mesh's own file.
  std::string read_mesh();
  // Contents of a file named by the mesh; empty if the file does not exist.
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
