// SPDX-License-Identifier: MIT
#include "tb/scene/mesh.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <fstream>
#include <map>

#include "spec/error.h"
#include "tb/base/fnv.h"
#include "tb/scene/exact_math.h"
#include "tb/scene/image_io.h"
#include "tb/scene/import.h"
#include "tb/scene/mesh_builder.h"

namespace deburr::tb {

namespace fs = std::filesystem;
using Imath::V2d;
using Imath::V3d;

void fail_mesh(const fs::path& path, const std::string& reason) {
  throw spec::FileError(
      fmt::format("cannot read the mesh '{}': {}", path.string(), printable(reason)));
}

std::string printable(std::string text) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    const auto next = static_cast<unsigned char>(i + 1 < text.size() ? text[i + 1] : 0);
    if (byte < ' ' || byte == 0x7F) text[i] = '?';
    if (byte == 0xC2 && next >= 0x80 && next < 0xA0) text.replace(i, 2, "?");  // U+0080 to U+009F
  }
  return text;
}

std::string shown_name(std::string_view name) {
  constexpr std::size_t kMost = 64;
  if (name.size() <= kMost) return printable(std::string(name));
  std::size_t end = kMost;
  while (end > kMost - 4 && (static_cast<unsigned char>(name[end]) & 0xC0) == 0x80) --end;
  return printable(std::string(name.substr(0, end))) + "...";
}

namespace {

// Reads a regular file completely. Calls `fail` with the reason on failure.
template <class Fail>
std::string whole_file(const fs::path& path, const Fail& fail) {
  std::error_code error;
  if (!fs::is_regular_file(path, error)) fail("not a regular file");
  const std::uintmax_t size = fs::file_size(path, error);
  if (error) fail(error.message());
  if (size > kMaxMeshFileBytes)
    fail(fmt::format("too large: it has {} bytes, the limit is {}; split or simplify the mesh",
                     size, kMaxMeshFileBytes));
  std::string bytes(size, '\0');
  std::ifstream file(path, std::ios::binary);
  if (!file.is_open() || (size > 0 && !file.read(bytes.data(), static_cast<std::streamsize>(size))))
    fail("it cannot be opened or read to its end; check its permissions");
  return bytes;
}

std::string extension_of(const fs::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

std::unique_ptr<Importer> importer_of(const fs::path& path, const ImportOptions& options) {
  const std::string extension = extension_of(path);
  if (extension == ".obj") return obj_importer(path, options);
  if (extension == ".gltf" || extension == ".glb") return gltf_importer(path, options);
  fail_mesh(path,
            fmt::format("the extension '{}' is not .obj, .gltf or .glb; convert it", extension));
}

}  // namespace

bool is_mesh_file(const fs::path& path) {
  const std::string extension = extension_of(path);
  return extension == ".obj" || extension == ".gltf" || extension == ".glb";
}

Bounds bounds(const Mesh& mesh) {
  if (mesh.vertices.empty()) return {V3d(0, 0, 0), V3d(0, 0, 0)};
  Bounds box{mesh.vertices[0].position, mesh.vertices[0].position};
  for (const Vertex& vertex : mesh.vertices) {
    for (int i = 0; i < 3; ++i) {
      box.low[i] = std::min(box.low[i], vertex.position[i]);
      box.high[i] = std::max(box.high[i], vertex.position[i]);
    }
  }
  return box;
}

Mesh import_mesh(const fs::path& path, const ImportOptions& options) {
  const std::unique_ptr<Importer> importer = importer_of(path, options);
  importer->open();
  Mesh mesh = importer->build();
  mesh.files = importer->files();
  return mesh;
}

std::vector<fs::path> mesh_files(const fs::path& path, const ImportOptions& options) {
  std::unique_ptr<Importer> importer;
  try {
    importer = importer_of(path, options);
    importer->open();
  } catch (const spec::FileError&) {  // import_mesh() reports the reason
  }
  return importer ? importer->files() : std::vector<fs::path>();
}

const std::vector<fs::path>& MeshFiles::of(const fs::path& path, const ImportOptions& options) {
  const auto [known, is_new] = known_.try_emplace({path, options.textures});
  if (is_new) known->second = mesh_files(path, options);
  return known->second;
}

void add_once(std::vector<fs::path>& files, const fs::path& file) {
  const std::string name = file.string();
  const fs::path plain =
      name.starts_with("./") && name.size() > 2 ? fs::path(name.substr(2)) : file;
  if (std::find(files.begin(), files.end(), plain) == files.end()) files.push_back(plain);
}

std::string Importer::read_mesh() {
  add_file(path_);
  std::error_code error;
  if (!fs::exists(path_, error)) fail_mesh(path_, "no such file; check the path");
  std::string bytes =
      whole_file(path_, [&](const std::string& reason) { fail_mesh(path_, reason); });
  if (bytes.empty()) fail_mesh(path_, "the file is empty (0 bytes); export it again");
  return bytes;
}

std::optional<std::string> Importer::read_named(const fs::path& file) {
  add_file(file);
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  if (status.type() == fs::file_type::not_found) return std::nullopt;
  return whole_file(file, [&](const std::string& reason) {
    fail_mesh(path_,
              fmt::format("it names '{}', and that cannot be read: {}", file.string(), reason));
  });
}

void texture_everything(Mesh& mesh, const Texture* fallback) {
  const bool any = std::any_of(mesh.materials.begin(), mesh.materials.end(),
                               [](const Material& material) { return material.texture >= 0; });
  if (!any && fallback != nullptr) {
    mesh.textures = {*fallback};
    for (Material& material : mesh.materials) material.texture = 0;
    return;
  }
  constexpr int kCell = 4, kColumns = 16;  // cells of 4 x 4 texels: bilinear filtering at the
                                           // centre does not reach a neighbour
  std::vector<std::size_t> plain;
  for (std::size_t i = 0; i < mesh.materials.size(); ++i)
    if (mesh.materials[i].texture < 0) plain.push_back(i);
  if (plain.empty()) return;
  const int rows = (static_cast<int>(plain.size()) + kColumns - 1) / kColumns;
  Texture palette;
  palette.name = "palette";
  palette.image = Image(kColumns * kCell, rows * kCell, {255, 255, 255, 255});
  std::map<std::uint32_t, V2d> centre;
  for (std::size_t k = 0; k < plain.size(); ++k) {
    Material& material = mesh.materials[plain[k]];
    const int left = static_cast<int>(k % kColumns) * kCell,
              top = static_cast<int>(k / kColumns) * kCell;
    Rgba8 colour{0, 0, 0, 255};
    for (int c = 0; c < 3; ++c)
      colour[static_cast<std::size_t>(c)] = static_cast<std::uint8_t>(
          std::lround(power(std::clamp(material.colour[c], 0.0, 1.0), 1.0 / 2.2) * 255.0));
    for (int y = 0; y < kCell; ++y) std::fill_n(&palette.image.at(left, top + y), kCell, colour);
    centre[static_cast<std::uint32_t>(plain[k])] =
        V2d((left + 0.5 * kCell) / palette.image.width, (top + 0.5 * kCell) / palette.image.height);
    material.texture = static_cast<int>(mesh.textures.size());
    material.colour = V3d(1, 1, 1);  // the palette holds it now
  }
  mesh.textures.push_back(std::move(palette));
  for (Triangle& triangle : mesh.triangles) {
    const auto found = centre.find(triangle.material);
    if (found == centre.end()) continue;
    for (std::uint32_t& index : triangle.vertex) {
      Vertex vertex =
          mesh.vertices[index];  // copied, because a textured triangle may use the same vertex
      vertex.uv = found->second;
      index = static_cast<std::uint32_t>(mesh.vertices.size());
      mesh.vertices.push_back(vertex);
    }
  }
}

// ---- MeshBuilder --------------------------------------------------------------------------------

namespace {

std::array<std::uint64_t, 8> bits(const Vertex& v) {
  const std::array<double, 8> values{v.position.x, v.position.y, v.position.z, v.normal.x,
                                     v.normal.y,   v.normal.z,   v.uv.x,       v.uv.y};
  std::array<std::uint64_t, 8> result;
  for (std::size_t i = 0; i < 8; ++i) result[i] = std::bit_cast<std::uint64_t>(values[i]);
  return result;
}

bool is_finite(const V3d& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

// The two coordinates perpendicular to the normal's largest component; y points up in the image.
V2d box_projection(const V3d& p, const V3d& normal) {
  const double x = std::abs(normal.x), y = std::abs(normal.y), z = std::abs(normal.z);
  if (y >= x && y >= z) return {p.x, p.z};
  if (x >= z) return {normal.x > 0 ? -p.z : p.z, -p.y};
  return {normal.z > 0 ? p.x : -p.x, -p.y};
}

}  // namespace

std::size_t MeshBuilder::Hash::operator()(const Vertex& vertex) const {
  std::uint64_t hash = kFnvStart;
  for (std::uint64_t value : bits(vertex)) {
    hash = (hash ^ value) * 0x9E3779B97F4A7C15u;
    hash ^= hash >> 29;
  }
  return static_cast<std::size_t>(hash);
}

bool MeshBuilder::Equal::operator()(const Vertex& a, const Vertex& b) const {
  return bits(a) == bits(b);
}

MeshBuilder::MeshBuilder(const fs::path& path) : path_(path) { mesh_.name = path.stem().string(); }

std::uint32_t MeshBuilder::vertex_index(Vertex vertex) {
  // Turns -0 into 0, so that equal vertices compare equal bit by bit.
  vertex.position += V3d(0, 0, 0);
  vertex.normal += V3d(0, 0, 0);
  vertex.uv += V2d(0, 0);
  const auto next = static_cast<std::uint32_t>(mesh_.vertices.size());
  const auto [where, inserted] = indices_.try_emplace(vertex, next);
  if (inserted) mesh_.vertices.push_back(vertex);
  return where->second;
}

void MeshBuilder::add_triangle(const std::array<Corner, 3>& corners, std::uint32_t material) {
  if (mesh_.triangles.size() >= kMaxTriangles)
    fail_mesh(path_,
              fmt::format("it has more than {} triangles; split or simplify it", kMaxTriangles));
  for (const Corner& corner : corners) {
    if (!is_finite(corner.position) ||
        (corner.uv && (!std::isfinite(corner.uv->x) || !std::isfinite(corner.uv->y))))
      fail_mesh(path_,
                fmt::format("triangle {} has a coordinate that is not a finite number; repair the "
                            "file or export it again",
                            mesh_.triangles.size()));
  }
  V3d face =
      (corners[1].position - corners[0].position).cross(corners[2].position - corners[0].position);
  face = face.length() > 0.0 ? face.normalized() : V3d(0, 1, 0);
  std::array<Corner, 3> complete = corners;
  for (Corner& corner : complete) {
    const double length =
        corner.normal && is_finite(*corner.normal) ? corner.normal->length() : 0.0;
    if (!(length > 0.0)) {
      corner.normal = face;
      ++without_normals_;
    } else {
      corner.normal = *corner.normal / length;
    }
  }
  Triangle triangle;
  triangle.material = material;
  const bool mapped = corners[0].uv && corners[1].uv && corners[2].uv;
  if (mapped) {
    for (std::size_t i = 0; i < 3; ++i)
      triangle.vertex[i] =
          vertex_index({complete[i].position, *complete[i].normal, *complete[i].uv});
  } else {
    unmapped_.push_back(complete);
    unmapped_triangle_.push_back(static_cast<std::uint32_t>(mesh_.triangles.size()));
  }
  mesh_.triangles.push_back(triangle);
}

void MeshBuilder::project_boxes() {
  if (unmapped_.empty()) return;
  V3d low = unmapped_[0][0].position, high = low;
  auto grow = [&](const V3d& p) {
    for (int i = 0; i < 3; ++i) {
      low[i] = std::min(low[i], p[i]);
      high[i] = std::max(high[i], p[i]);
    }
  };
  for (const auto& corners : unmapped_)
    for (const Corner& corner : corners) grow(corner.position);
  for (const Vertex& vertex : mesh_.vertices) grow(vertex.position);
  const V3d size = high - low;
  const double longest = std::max({size.x, size.y, size.z, 1e-30});
  for (std::size_t k = 0; k < unmapped_.size(); ++k) {
    const auto& c = unmapped_[k];
    const V3d face = (c[1].position - c[0].position).cross(c[2].position - c[0].position);
    Triangle& triangle = mesh_.triangles[unmapped_triangle_[k]];
    for (std::size_t i = 0; i < 3; ++i) {
      const V2d uv = box_projection(c[i].position - low, face) * (4.0 / longest);
      triangle.vertex[i] = vertex_index({c[i].position, *c[i].normal, uv});
    }
  }
  note(fmt::format("{} triangles without texture coordinates got a box projection",
                   unmapped_.size()));
}

int MeshBuilder::add_texture(Texture texture) {
  if (texture.image.width > spec::texture::kMaxTextureSize ||
      texture.image.height > spec::texture::kMaxTextureSize)
    fail_mesh(path_,
              fmt::format("its texture '{}' is {} x {} texels, the limit is {}; scale it down",
                          texture.name, texture.image.width, texture.image.height,
                          spec::texture::kMaxTextureSize));
  mesh_.textures.push_back(std::move(texture));
  return static_cast<int>(mesh_.textures.size()) - 1;
}

int MeshBuilder::texture_from_file(const fs::path& file, spec::texture::Wrap wrap) {
  if (const auto found = texture_files_.find({file, wrap}); found != texture_files_.end())
    return found->second;
  Texture texture;
  texture.wrap_s = texture.wrap_t = wrap;
  texture.name = file.filename().string();
  try {
    ReadReport report;
    texture.image = read_image(file, &report);
    texture.compressed = report.compressed;
    for (const std::string& conversion : report.conversions)
      note(fmt::format("'{}': {}", texture.name, conversion));
  } catch (const spec::FileError& error) {
    fail_mesh(
        path_,
        fmt::format("its texture cannot be used ({}); repair the reference or give another texture",
                    error.what()));
  }
  return texture_files_[{file, wrap}] = add_texture(std::move(texture));
}

// Drops unused materials and textures: a texture unit has only sixteen descriptors.
void MeshBuilder::drop_unused() {
  std::vector<int> new_material(mesh_.materials.size(), -1), new_texture(mesh_.textures.size(), -1);
  std::vector<Material> materials;
  std::vector<Texture> textures;
  for (Triangle& triangle : mesh_.triangles) {
    int& target = new_material[triangle.material];
    if (target < 0) {
      target = static_cast<int>(materials.size());
      materials.push_back(mesh_.materials[triangle.material]);
      if (int& texture = materials.back().texture; texture >= 0) {
        int& moved = new_texture[static_cast<std::size_t>(texture)];
        if (moved < 0) {
          moved = static_cast<int>(textures.size());
          textures.push_back(std::move(mesh_.textures[static_cast<std::size_t>(texture)]));
        }
        texture = moved;
      }
    }
    triangle.material = static_cast<std::uint32_t>(target);
  }
  mesh_.materials = std::move(materials);
  mesh_.textures = std::move(textures);
}

Mesh MeshBuilder::finish() {
  if (mesh_.triangles.empty())
    fail_mesh(path_,
              "there are no triangles in it; export faces, not only points, lines or curves");
  project_boxes();
  if (without_normals_ > 0)
    note(fmt::format("{} corners without a normal got their face's", without_normals_));
  drop_unused();
  indices_.clear();
  return std::move(mesh_);
}

}  // namespace deburr::tb
