// SPDX-License-Identifier: MIT
// Helpers of the tests of tb/scene: a temporary folder, small files, a screen measured in pixels,
// and the folder of real data if there is one.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <bit>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>

#include "spec/error.h"
#include "tb/base/fnv.h"
#include "tb/harness/test_paths.h"
#include "tb/scene/scenes.h"

namespace deburr::tb::test {

namespace fs = std::filesystem;

class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (fs::temp_directory_path() / "deburr-XXXXXX").string();
    path_ = ::mkdtemp(name.data());
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  fs::path operator/(const std::string& name) const { return path_ / name; }
  const fs::path& path() const { return path_; }
  fs::path write(const std::string& name, std::string_view bytes) const {
    std::ofstream(path_ / name, std::ios::binary) << bytes;
    return path_ / name;
  }
  std::size_t files() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(path_), {}));
  }

 private:
  fs::path path_;
};

inline std::string read_bytes(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

// FNV-1a hash of all bytes of an image.
template <class Pixel>
std::uint64_t fnv(const ImageOf<Pixel>& image) {
  FnvHash hash;
  for (const Pixel& pixel : image.pixels)
    for (const std::uint8_t byte : std::bit_cast<std::array<std::uint8_t, sizeof(Pixel)>>(pixel))
      hash.byte(byte);
  return hash.value();
}

// Runs `action`, which must throw a FileError, and returns its text.
template <class Action>
std::string file_error(Action&& action) {
  try {
    action();
  } catch (const spec::FileError& error) {
    EXPECT_EQ(error.code(), spec::ExitCode::kFile);
    return error.what();
  } catch (const std::exception& error) {
    ADD_FAILURE() << "expected a FileError, got: " << error.what();
    return "";
  }
  ADD_FAILURE() << "expected a FileError, got none";
  return "";
}

// NOLINTBEGIN(bugprone-macro-parentheses): a declared name cannot be parenthesised.
#define DEBURR_REQUIRE_DATA(folder)                                   \
  const ::std::filesystem::path folder = ::deburr::tb::data_folder(); \
  if (!::std::filesystem::is_directory(folder / "meshes"))            \
  GTEST_SKIP() << "no data folder: set DEBURR_DATA to one"
// NOLINTEND(bugprone-macro-parentheses)

// A scene on the plane z = 0 in which (x, y) is a screen position in pixels, with w = 1 everywhere.
// `size` is a power of two, so that positions are exact.
class FlatScreen {
 public:
  explicit FlatScreen(int size) : size_(size) {
    scene_.camera = {{0, 0, 1}, {0, 0, 0}, {0, 1, 0}, 1.57079632679489661923, 0.01};
    scene_.mesh.materials.push_back({"plain", {1, 1, 1}, 0});
    scene_.mesh.textures.push_back({"white", Image(4, 4, {255, 255, 255, 255})});
    scene_.sky_top = scene_.sky_bottom = {0, 0, 0, 255};
  }
  std::uint32_t vertex(double x, double y, double distance = 1.0) {
    const double half = 0.5 * size_;
    scene_.mesh.vertices.push_back(
        {{(x - half) / half * distance, (half - y) / half * distance, 1.0 - distance},
         {0, 0, 1},
         {x / size_, y / size_}});
    return static_cast<std::uint32_t>(scene_.mesh.vertices.size()) - 1;
  }
  void triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    scene_.mesh.triangles.push_back({{a, b, c}, 0});
  }
  void rectangle(double left, double top, double right, double bottom) {
    const auto a = vertex(left, top), b = vertex(right, top), c = vertex(right, bottom),
               d = vertex(left, bottom);
    triangle(a, b, c);
    triangle(a, c, d);
  }
  Scene& scene() { return scene_; }

 private:
  int size_;
  Scene scene_;
};

}  // namespace deburr::tb::test
