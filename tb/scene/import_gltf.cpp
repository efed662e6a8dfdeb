// SPDX-License-Identifier: MIT
#include <Imath/ImathMatrix.h>
#include <Imath/ImathQuat.h>
#include <fmt/core.h>
#include <tiny_gltf.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <tuple>

#include "spec/error.h"
#include "tb/scene/exact_math.h"
#include "tb/scene/image_io.h"
#include "tb/scene/import.h"
#include "tb/scene/mesh_builder.h"

namespace deburr::tb {
namespace {

namespace fs = std::filesystem;
using Imath::M44d;
using Imath::V2d;
using Imath::V3d;

// Extensions that a file may require and that this import either obeys or may ignore.
bool is_supported(const std::string& extension) {
  return extension == "KHR_texture_transform" || extension == "KHR_mesh_quantization" ||
         extension.rfind("KHR_materials_", 0) == 0;
}

spec::texture::Wrap wrap_of(int gl) {
  if (gl == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE) return spec::texture::Wrap::kClampToEdge;
  if (gl == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT) return spec::texture::Wrap::kMirroredRepeat;
  return spec::texture::Wrap::kRepeat;
}

// KHR_texture_transform: scale, then rotation, then offset.
struct TextureTransform {
  V2d offset{0, 0}, scale{1, 1};
  double rotation = 0.0;

  V2d apply(const V2d& uv) const {
    const SinCos turn = sin_cos(rotation);
    const V2d scaled(uv.x * scale.x, uv.y * scale.y);
    return {offset.x + turn.cos * scaled.x - turn.sin * scaled.y,
            offset.y + turn.sin * scaled.x + turn.cos * scaled.y};
  }
};

V2d pair_of(const tinygltf::Value& value, const char* key, const V2d& otherwise) {
  if (!value.Has(key)) return otherwise;
  const tinygltf::Value& array = value.Get(key);
  if (!array.IsArray() || array.ArrayLen() != 2) return otherwise;
  return {array.Get(0).GetNumberAsDouble(), array.Get(1).GetNumberAsDouble()};
}

struct MaterialUse {
  int texcoord = 0;  // which TEXCOORD_n the base colour reads
  TextureTransform transform;
};

class GltfImporter final : public Importer {
 public:
  GltfImporter(const fs::path& path, const ImportOptions& options)
      : Importer(path, options), builder_(path) {}

  // tinygltf reads buffers and images as it comes to them, those too that no material uses.
  void open() override { parse(); }

  Mesh build() override {
    for (const std::string& extension : model_.extensionsRequired)
      if (!is_supported(extension))
        fail(fmt::format("it requires the extension {}, which is not supported; export without it",
                         extension));
    import_materials();
    visit_scene();
    if (skipped_primitives_) builder_.note("points and lines were left out");
    if (vertex_colours_) builder_.note("vertex colours were left out");
    if (!model_.skins.empty()) builder_.note("skins were left out: the bind pose is drawn");
    return builder_.finish();
  }

 private:
  [[noreturn]] void fail(const std::string& reason) const { fail_mesh(path(), reason); }

  template <class Container>
  const auto& item(const Container& container, int index, const char* what) const {
    if (index < 0 || static_cast<std::size_t>(index) >= container.size())
      fail(fmt::format("{} {} is used, but there are {}; the file is damaged", what, index,
                       container.size()));
    return container[static_cast<std::size_t>(index)];
  }

  void parse() {
    const std::string bytes = read_mesh();
    tinygltf::TinyGLTF loader;
    loader.SetFsCallbacks({&file_exists, [](const std::string& name, void*) { return name; },
                           &read_whole_file, nullptr, this});
    // Keep encoded images as they are: only those that a material uses are decoded, by OpenImageIO.
    loader.SetImageLoader(
        [](tinygltf::Image*, const int index, std::string*, std::string*, int, int,
           const unsigned char* data, int size, void* self) {
          static_cast<GltfImporter*>(self)->encoded_[index].assign(
              reinterpret_cast<const char*>(data), static_cast<std::size_t>(size));
          return true;
        },
        this);
    const std::string folder = this->folder().string();
    std::string errors, warnings;
    bool good = false;
    try {
      const bool binary = bytes.compare(0, 4, "glTF") == 0;
      check_length(bytes, binary);
      good = binary
                 ? loader.LoadBinaryFromMemory(&model_, &errors, &warnings,
                                               reinterpret_cast<const unsigned char*>(bytes.data()),
                                               static_cast<unsigned>(bytes.size()), folder)
                 : loader.LoadASCIIFromString(&model_, &errors, &warnings, bytes.data(),
                                              static_cast<unsigned>(bytes.size()), folder);
    } catch (const spec::Error&) {
      throw;
    } catch (const std::exception& error) {
      errors += error.what();
    }
    if (!unreadable_.empty()) throw spec::FileError(unreadable_);
    if (!good) {
      for (char& c : errors) c = c == '\n' ? ' ' : c;
      fail(fmt::format("{}; the file is truncated or damaged, export it again",
                       errors.empty() ? "no glTF could be read" : errors));
    }
    if (!model_.asset.version.starts_with("2."))
      fail(fmt::format("it is glTF {}, and glTF 2 is read; export it as that",
                       model_.asset.version.empty() ? "of no version" : model_.asset.version));
  }

  // What tinygltf asks of files, which no exception may leave. It looks in the mesh's folder first,
  // and in the current one where that has no such file.
  static bool file_exists(const std::string& name, void* self) {
    if (name.ends_with('/')) return false;  // an empty name
    static_cast<GltfImporter*>(self)->add_file(name);
    std::error_code error;
    return fs::status(name, error).type() != fs::file_type::not_found;
  }
  static bool read_whole_file(std::vector<unsigned char>* bytes, std::string*,
                              const std::string& name, void* self) {
    auto& importer = *static_cast<GltfImporter*>(self);
    try {
      const std::optional<std::string> text = importer.read_named(name);
      if (text) bytes->assign(text->begin(), text->end());
      return text.has_value();
    } catch (const spec::FileError& error) {
      importer.unreadable_ = error.what();
      return false;
    }
  }

  void check_length(const std::string& bytes, bool binary) const {
    if (!binary) return;
    std::uint32_t stated = 0;
    if (bytes.size() >= 12) std::memcpy(&stated, bytes.data() + 8, 4);
    if (bytes.size() < 12 || stated > bytes.size())
      fail(fmt::format("its header says {} bytes, the file has {}: it is truncated; copy it again",
                       stated, bytes.size()));
  }

  // ---- materials ----

  void import_materials() {
    for (const tinygltf::Material& material : model_.materials) {
      Material ours;
      ours.name = material.name;
      const auto& base = material.pbrMetallicRoughness;
      if (base.baseColorFactor.size() >= 3)
        ours.colour = {base.baseColorFactor[0], base.baseColorFactor[1], base.baseColorFactor[2]};
      MaterialUse use;
      if (base.baseColorTexture.index >= 0) {
        use = material_use(base.baseColorTexture);
        if (options().textures) ours.texture = texture(base.baseColorTexture.index);
      }
      uses_.push_back(use);
      builder_.add_material(ours);
    }
    uses_.emplace_back();
    builder_.add_material({"default", V3d(0.8, 0.8, 0.8), -1});
  }

  static MaterialUse material_use(const tinygltf::TextureInfo& info) {
    MaterialUse use;
    use.texcoord = info.texCoord;
    const auto found = info.extensions.find("KHR_texture_transform");
    if (found == info.extensions.end()) return use;
    const tinygltf::Value& value = found->second;
    use.transform.offset = pair_of(value, "offset", V2d(0, 0));
    use.transform.scale = pair_of(value, "scale", V2d(1, 1));
    if (value.Has("rotation")) use.transform.rotation = value.Get("rotation").GetNumberAsDouble();
    if (value.Has("texCoord")) use.texcoord = value.Get("texCoord").GetNumberAsInt();
    return use;
  }

  int texture(int index) {
    const tinygltf::Texture& from = item(model_.textures, index, "texture");
    Texture ours;
    if (from.sampler >= 0) {
      const tinygltf::Sampler& sampler = item(model_.samplers, from.sampler, "sampler");
      ours.wrap_s = wrap_of(sampler.wrapS);
      ours.wrap_t = wrap_of(sampler.wrapT);
    }
    const auto key = std::tuple(from.source, ours.wrap_s, ours.wrap_t);
    if (const auto found = textures_.find(key); found != textures_.end()) return found->second;
    const tinygltf::Image& image = item(model_.images, from.source, "image");
    ours.name = !image.uri.empty() ? image.uri : !image.name.empty() ? image.name : "embedded";
    const auto encoded = encoded_.find(from.source);
    if (encoded == encoded_.end())
      fail(fmt::format(
          "its texture '{}' is missing; put it beside the file or give a texture of your own",
          ours.name));
    ReadReport report;
    ours.image = read_image_memory(fmt::format("{}: {}", path().string(), ours.name),
                                   encoded->second, &report);
    for (const std::string& conversion : report.conversions)
      builder_.note(fmt::format("'{}': {}", ours.name, conversion));
    return textures_[key] = builder_.add_texture(std::move(ours));
  }

  // ---- geometry ----

  void visit_scene() {
    if (model_.scenes.empty()) {  // a file may be a mere library of nodes: draw all roots
      std::vector<bool> child(model_.nodes.size(), false);
      for (const tinygltf::Node& node : model_.nodes)
        for (int index : node.children)
          if (index >= 0 && static_cast<std::size_t>(index) < child.size())
            child[static_cast<std::size_t>(index)] = true;
      for (std::size_t i = 0; i < child.size(); ++i)
        if (!child[i]) visit_node(static_cast<int>(i), M44d(), 0);
      return;
    }
    const int scene = model_.defaultScene >= 0 ? model_.defaultScene : 0;
    for (int node : item(model_.scenes, scene, "scene").nodes) visit_node(node, M44d(), 0);
  }

  void visit_node(int index, const M44d& parent, int depth) {
    constexpr int kMaxDepth = 128, kMaxVisits = 1'000'000;
    if (depth > kMaxDepth || ++visits_ > kMaxVisits)
      fail("its nodes form a cycle or are nested too deeply; the file is damaged");
    const tinygltf::Node& node = item(model_.nodes, index, "node");
    const M44d matrix = local_matrix(node) * parent;
    if (node.mesh >= 0)
      for (const tinygltf::Primitive& primitive : item(model_.meshes, node.mesh, "mesh").primitives)
        import_primitive(primitive, matrix);
    for (int child : node.children) visit_node(child, matrix, depth + 1);
  }

  // glTF stores columns one after the other; Imath multiplies row vectors from the left, so the
  // same sixteen numbers in the same order are Imath's matrix.
  static M44d local_matrix(const tinygltf::Node& node) {
    M44d matrix;
    if (node.matrix.size() == 16) {
      for (int i = 0; i < 16; ++i) matrix[i / 4][i % 4] = node.matrix[static_cast<std::size_t>(i)];
      return matrix;
    }
    if (node.scale.size() == 3) matrix.setScale(V3d(node.scale[0], node.scale[1], node.scale[2]));
    if (node.rotation.size() == 4)
      matrix *= Imath::Quatd(node.rotation[3], node.rotation[0], node.rotation[1], node.rotation[2])
                    .normalized()
                    .toMatrix44();
    if (node.translation.size() == 3) {
      M44d move;
      move.setTranslation(V3d(node.translation[0], node.translation[1], node.translation[2]));
      matrix *= move;
    }
    return matrix;
  }

  struct Numbers {
    std::vector<double> values;
    std::size_t components = 0, count = 0;
    V3d three(std::size_t i) const {
      return {values[i * components], values[i * components + 1], values[i * components + 2]};
    }
    V2d two(std::size_t i) const { return {values[i * components], values[i * components + 1]}; }
  };

  Numbers read(int index, std::size_t needed) const {
    const tinygltf::Accessor& accessor = item(model_.accessors, index, "accessor");
    if (accessor.sparse.isSparse) fail("it has sparse accessors; export without them");
    const tinygltf::BufferView& view = item(model_.bufferViews, accessor.bufferView, "buffer view");
    const tinygltf::Buffer& buffer = item(model_.buffers, view.buffer, "buffer");
    const int component_bytes =
        tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(accessor.componentType));
    const int components =
        tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor.type));
    if (component_bytes <= 0 || components <= 0 || static_cast<std::size_t>(components) < needed)
      fail(fmt::format("accessor {} has the wrong type; the file is damaged", index));
    const std::size_t element =
        static_cast<std::size_t>(component_bytes) * static_cast<std::size_t>(components);
    const std::size_t stride = view.byteStride != 0 ? view.byteStride : element;
    const std::size_t most = buffer.data.size();
    // Each term is bounded by the buffer before it is added or multiplied, so nothing can wrap.
    const bool fits = view.byteOffset <= most && view.byteLength <= most - view.byteOffset &&
                      accessor.byteOffset <= view.byteLength && stride >= element &&
                      stride <= 252 && accessor.count <= most &&
                      (accessor.count == 0 || (accessor.count - 1) * stride + element <=
                                                  view.byteLength - accessor.byteOffset);
    if (!fits)
      fail(fmt::format("accessor {} reaches beyond its buffer; the file is truncated or damaged",
                       index));
    Numbers numbers;
    numbers.components = static_cast<std::size_t>(components);
    numbers.count = accessor.count;
    numbers.values.reserve(numbers.count * numbers.components);
    const unsigned char* base = buffer.data.data() + view.byteOffset + accessor.byteOffset;
    for (std::size_t i = 0; i < numbers.count; ++i)
      for (std::size_t c = 0; c < numbers.components; ++c)
        numbers.values.push_back(
            number(base + i * stride + c * static_cast<std::size_t>(component_bytes),
                   accessor.componentType, accessor.normalized));
    return numbers;
  }

  template <class Value>
  static double load(const unsigned char* from, bool normalized) {
    Value value;
    std::memcpy(&value, from, sizeof value);
    const auto number = static_cast<double>(value);
    if (!normalized || std::is_floating_point_v<Value>) return number;
    return std::max(-1.0, number / static_cast<double>(std::numeric_limits<Value>::max()));
  }

  double number(const unsigned char* from, int type, bool normalized) const {
    switch (type) {
      case TINYGLTF_COMPONENT_TYPE_BYTE:
        return load<std::int8_t>(from, normalized);
      case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
        return load<std::uint8_t>(from, normalized);
      case TINYGLTF_COMPONENT_TYPE_SHORT:
        return load<std::int16_t>(from, normalized);
      case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
        return load<std::uint16_t>(from, normalized);
      case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
        return load<std::uint32_t>(from, normalized);
      case TINYGLTF_COMPONENT_TYPE_FLOAT:
        return load<float>(from, false);
      default:
        fail(fmt::format("it has numbers of type {}, which glTF does not have", type));
    }
  }

  // The corners of triangle `t` of a list, strip or fan.
  static std::array<std::size_t, 3> corners_of(int mode, std::size_t t) {
    if (mode == TINYGLTF_MODE_TRIANGLE_STRIP)
      return t % 2 == 0 ? std::array{t, t + 1, t + 2} : std::array{t + 1, t, t + 2};
    if (mode == TINYGLTF_MODE_TRIANGLE_FAN) return {0, t + 1, t + 2};
    return {3 * t, 3 * t + 1, 3 * t + 2};
  }

  void import_primitive(const tinygltf::Primitive& primitive, const M44d& matrix) {
    const int mode = primitive.mode < 0 ? TINYGLTF_MODE_TRIANGLES : primitive.mode;
    if (mode < TINYGLTF_MODE_TRIANGLES) {
      skipped_primitives_ = true;
      return;
    }
    auto attribute = [&](const std::string& name) {
      const auto found = primitive.attributes.find(name);
      return found == primitive.attributes.end() ? -1 : found->second;
    };
    if (attribute("POSITION") < 0) fail("a primitive has no positions; the file is damaged");
    const auto material = primitive.material < 0
                              ? static_cast<std::uint32_t>(model_.materials.size())
                              : static_cast<std::uint32_t>(primitive.material);
    if (material >= uses_.size()) fail(fmt::format("material {} does not exist", material));
    const MaterialUse& use = uses_[material];
    vertex_colours_ = vertex_colours_ || attribute("COLOR_0") >= 0;

    const Numbers positions = read(attribute("POSITION"), 3);
    Numbers normals, coordinates, indices;
    if (attribute("NORMAL") >= 0) normals = read(attribute("NORMAL"), 3);
    if (const int accessor = attribute(fmt::format("TEXCOORD_{}", use.texcoord)); accessor >= 0)
      coordinates = read(accessor, 2);
    if (primitive.indices >= 0) indices = read(primitive.indices, 1);

    const std::size_t corners = primitive.indices >= 0 ? indices.count : positions.count;
    const std::size_t triangles = mode == TINYGLTF_MODE_TRIANGLES ? corners / 3
                                  : corners >= 3                  ? corners - 2
                                                                  : 0;
    const bool mirrored = matrix.determinant() < 0.0;
    const M44d normal_matrix = matrix.inverse().transposed();
    auto corner_at = [&](std::size_t k) {
      const double index =
          primitive.indices >= 0 ? indices.values[k * indices.components] : static_cast<double>(k);
      if (!(index >= 0.0 && index < static_cast<double>(positions.count)))
        fail(fmt::format("vertex {} is used, but there are {}; the file is damaged", index,
                         positions.count));
      const auto i = static_cast<std::size_t>(index);
      MeshBuilder::Corner corner;
      corner.position = positions.three(i) * matrix;
      if (i < normals.count) {
        V3d normal;
        normal_matrix.multDirMatrix(normals.three(i), normal);
        corner.normal = normal;
      }
      if (i < coordinates.count) corner.uv = use.transform.apply(coordinates.two(i));
      return corner;
    };
    for (std::size_t t = 0; t < triangles; ++t) {
      std::array<std::size_t, 3> k = corners_of(mode, t);
      if (mirrored) std::swap(k[1], k[2]);
      builder_.add_triangle({corner_at(k[0]), corner_at(k[1]), corner_at(k[2])}, material);
    }
  }

  MeshBuilder builder_;
  tinygltf::Model model_;
  std::map<int, std::string> encoded_;
  std::string unreadable_;         // why a file that is there could not be read
  std::vector<MaterialUse> uses_;  // by material, the default material last
  std::map<std::tuple<int, spec::texture::Wrap, spec::texture::Wrap>, int> textures_;
  int visits_ = 0;
  bool skipped_primitives_ = false, vertex_colours_ = false;
};

}  // namespace

std::unique_ptr<Importer> gltf_importer(const fs::path& path, const ImportOptions& options) {
  return std::make_unique<GltfImporter>(path, options);
}

}  // namespace deburr::tb
