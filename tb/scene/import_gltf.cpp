// SPDX-License-Identifier: MIT
#include <Imath/ImathMatrix.h>
#include <Imath/ImathQuat.h>
#include <fmt/format.h>
#include <tiny_gltf.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "spec/error.h"
#include "tb/scene/exact_math.h"
#include "tb/scene/image_io.h"
#include "tb/scene/import.h"
#include "tb/scene/mesh_builder.h"
#include "tb/scene/obj_text.h"

namespace deburr::tb {
namespace {

namespace fs = std::filesystem;
using Imath::M44d;
using Imath::V2d;
using Imath::V3d;

constexpr const char *kTransform = "KHR_texture_transform", *kWebp = "EXT_texture_webp",
                     *kDds = "MSFT_texture_dds", *kInstances = "EXT_mesh_gpu_instancing",
                     *kVisibility = "KHR_node_visibility",
                     *kSpecularGlossiness = "KHR_materials_pbrSpecularGlossiness";

bool is_applied(const std::string& extension) {
  return extension == kTransform || extension == kWebp || extension == kDds ||
         extension == kInstances || extension == kVisibility || extension == kSpecularGlossiness ||
         extension == "KHR_mesh_quantization";
}

// Required extensions that can be ignored: they change neither geometry nor base colour.
bool is_harmless(const std::string& extension) {
  return extension == "KHR_materials_unlit" || extension == "KHR_materials_variants";
}

spec::texture::Wrap wrap_of(int gl) {
  if (gl == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE) return spec::texture::Wrap::kClampToEdge;
  if (gl == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT) return spec::texture::Wrap::kMirroredRepeat;
  return spec::texture::Wrap::kRepeat;
}

// KHR_texture_transform: scale, then rotation, then offset. The rotation follows the example in the
// extension, as other readers do; the GLSL listing in the extension rotates the other way.
struct TextureTransform {
  V2d offset{0, 0}, scale{1, 1};
  double rotation = 0.0;

  V2d apply(const V2d& uv) const {
    const SinCos turn = sin_cos(rotation);
    const V2d scaled(uv.x * scale.x, uv.y * scale.y);
    return {offset.x + turn.cos * scaled.x + turn.sin * scaled.y,
            offset.y - turn.sin * scaled.x + turn.cos * scaled.y};
  }
};

// A member of an object, or an empty value.
const tinygltf::Value& member(const tinygltf::Value& value, const char* key) {
  static const tinygltf::Value none;
  return value.Has(key) ? value.Get(key) : none;
}

// An extension of an object, or an empty value.
const tinygltf::Value& extension_of(const tinygltf::ExtensionMap& extensions, const char* name) {
  static const tinygltf::Value none;
  const auto found = extensions.find(name);
  return found == extensions.end() ? none : found->second;
}

template <class Name>
std::string listed(const std::set<Name>& names) {
  constexpr std::size_t kMost = 20;
  std::string text;
  std::size_t shown = 0;
  for (const Name& name : names) {
    if (shown == kMost) return fmt::format("{} and {} more", text, names.size() - kMost);
    text += (shown++ > 0 ? ", " : "") + shown_name(fmt::format("{}", name));
  }
  return text;
}

struct MaterialUse {
  int texcoord = 0;  // n of the TEXCOORD_n that the base colour uses
  TextureTransform transform;
};

class GltfImporter final : public Importer {
 public:
  GltfImporter(const fs::path& path, const ImportOptions& options)
      : Importer(path, options), builder_(path) {}

  // tinygltf reads all buffers and images during parsing, including unused ones.
  void open() override { parse(); }

  Mesh build() override {
    import_materials();
    visit_scene();
    if (!drawn_ && hidden_nodes_)
      fail("all nodes with triangles are hidden (KHR_node_visibility); make one visible");
    add_notes();
    return builder_.finish();
  }

 private:
  [[noreturn]] void fail(const std::string& reason) const { fail_mesh(path(), reason); }

  // Numbers of an extension; `otherwise` if absent. Throws if their count is wrong.
  template <std::size_t N>
  std::array<double, N> numbers_of(const tinygltf::Value& value, const char* key,
                                   std::array<double, N> otherwise) const {
    if (!value.Has(key)) return otherwise;
    const tinygltf::Value& array = value.Get(key);
    bool good = array.IsArray() && array.ArrayLen() == N;
    for (std::size_t i = 0; i < N && good; ++i) {
      const tinygltf::Value& part = array.Get(static_cast<int>(i));
      good = part.IsNumber();
      otherwise[i] = part.GetNumberAsDouble();
    }
    if (!good) fail_member(key, fmt::format("{} numbers", N));
    return otherwise;
  }
  V2d pair_of(const tinygltf::Value& value, const char* key, double otherwise) const {
    const auto [x, y] = numbers_of<2>(value, key, {otherwise, otherwise});
    return {x, y};
  }
  double number_of(const tinygltf::Value& value, const char* key, double otherwise) const {
    if (!value.Has(key)) return otherwise;
    if (!value.Get(key).IsNumber()) fail_member(key, "a number");
    return value.Get(key).GetNumberAsDouble();
  }
  int integer_of(const tinygltf::Value& value, const char* key, int otherwise) const {
    if (!value.Has(key)) return otherwise;
    if (!value.Get(key).IsInt()) fail_member(key, "a whole number");
    return value.Get(key).GetNumberAsInt();
  }
  [[noreturn]] void fail_member(std::string_view key, std::string_view wanted) const {
    fail(fmt::format("'{}' is not {}; the file is damaged, export it again", shown_name(key),
                     wanted));
  }

  template <class Container>
  const auto& item(const Container& container, int index, const char* what) const {
    if (index < 0 || static_cast<std::size_t>(index) >= container.size())
      fail(fmt::format("{} {} is used, but there are {}; the file is damaged", what, index,
                       container.size()));
    return container[static_cast<std::size_t>(index)];
  }

  // Extensions of the file that this import does not apply.
  std::set<std::string> unread_extensions() const {
    std::set<std::string> names;
    const auto add = [&names](const std::string& name) {
      if (!is_applied(name)) names.insert(name);
    };
    const auto add_of = [&add](const auto& objects) {
      for (const auto& object : objects)
        for (const auto& [name, value] : object.extensions) add(name);
    };
    for (const std::string& name : model_.extensionsUsed) add(name);
    add_of(model_.nodes);
    add_of(model_.materials);
    add_of(model_.textures);
    for (const tinygltf::Mesh& mesh : model_.meshes) add_of(mesh.primitives);
    return names;
  }

  // Material properties that are ignored: only the base colour is read.
  std::set<std::string> unread_of_materials() const {
    std::set<std::string> names;
    for (const tinygltf::Material& material : model_.materials) {
      if (material.alphaMode == "MASK" || material.alphaMode == "BLEND")
        names.insert("alpha mode " + material.alphaMode);
      const auto& factor = material.emissiveFactor;
      if (std::any_of(factor.begin(), factor.end(), [](double part) { return part != 0.0; }))
        names.insert("emission");
      if (material.normalTexture.index >= 0) names.insert("normal maps");
      if (material.occlusionTexture.index >= 0) names.insert("occlusion maps");
      if (material.pbrMetallicRoughness.metallicRoughnessTexture.index >= 0)
        names.insert("metallic-roughness maps");
    }
    return names;
  }

  void add_notes() {
    if (skipped_primitives_) builder_.note("points and lines were left out");
    if (vertex_colours_) builder_.note("vertex colours were left out");
    if (!model_.skins.empty()) builder_.note("skins were left out: the bind pose is drawn");
    if (!model_.animations.empty())
      builder_.note("animations were left out: nodes and weights are as stored");
    if (!model_.cameras.empty()) builder_.note("cameras were left out");
    if (model_.scenes.size() > 1)
      builder_.note(fmt::format("scene {} of {} (from 0) is drawn, the others were left out",
                                scene_number(), model_.scenes.size()));
    if (hidden_nodes_) builder_.note("hidden nodes and their children were left out");
    if (incomplete_corners_ > 0)
      builder_.note(
          fmt::format("{} corners after the last whole triangle of a primitive were left "
                      "out; the file is damaged, export it again",
                      incomplete_corners_));
    if (!zeros_.empty())
      builder_.note(
          fmt::format("accessors without a buffer view, which are all zeros: {}", listed(zeros_)));
    if (const auto names = unread_of_materials(); !names.empty())
      builder_.note(
          fmt::format("only the base colour of materials is read: {} left out", listed(names)));
    if (const auto names = unread_extensions(); !names.empty())
      builder_.note(fmt::format("unsupported extensions were ignored: {}", listed(names)));
  }

  void parse() {
    std::string bytes = read_mesh();
    tinygltf::TinyGLTF loader;
    loader.SetFsCallbacks({&file_exists, &expand_name, &read_whole_file, nullptr, this});
    loader.SetImageLoader(&keep_encoded, this);
    const std::string folder = this->folder().string();
    std::string errors, warnings;
    bool good = false;
    try {
      const bool binary = bytes.compare(0, 4, "glTF") == 0;
      if (!binary && is_utf16(bytes)) fail("it is written in UTF-16; save it as UTF-8");
      check_length(bytes, binary);
      check_nesting(bytes, binary);
      if (binary) drop_chunk(bytes);
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
    // Checked before tinygltf's errors, since data held by an unsupported extension appears to be
    // missing.
    for (const std::string& extension : model_.extensionsRequired)
      if (!is_applied(extension) && !is_harmless(extension))
        fail(fmt::format("it requires the extension {}, which is not supported; export without it",
                         extension));
    while (errors.ends_with('\n')) errors.pop_back();
    for (char& c : errors) c = c == '\n' ? ' ' : c;
    // tinygltf drops a primitive without attributes. If it accepts a file, its messages are not
    // always errors.
    if (!good || errors.find("'attributes'") != std::string::npos) {
      const std::set<std::string> unread = unread_extensions();
      fail(fmt::format(
          "{}; {}the file is truncated or damaged, export it again",
          errors.empty() ? "no glTF could be read" : errors,
          unread.empty() ? "" : fmt::format("{} is not supported, or ", listed(unread))));
    }
    if (!model_.asset.version.starts_with("2."))
      fail(fmt::format("it is glTF {}, but only glTF 2 is supported; export it as glTF 2",
                       model_.asset.version.empty() ? "of no version" : model_.asset.version));
    if (const std::string& least = model_.asset.minVersion; !least.empty() && least != "2.0")
      fail(fmt::format("it requires glTF {}, but 2.0 is supported; export it as glTF 2.0", least));
  }

  // Keeps encoded images: OpenImageIO decodes the ones that a material uses. tinygltf does not
  // check that the buffer view lies within its buffer.
  static bool keep_encoded(tinygltf::Image* image, const int index, std::string* errors,
                           std::string*, int, int, const unsigned char* data, int size,
                           void* self) {
    auto& importer = *static_cast<GltfImporter*>(self);
    auto bytes = static_cast<std::size_t>(size);
    if (image->bufferView >= 0) {
      const auto& view = importer.model_.bufferViews[static_cast<std::size_t>(image->bufferView)];
      const auto& all = importer.model_.buffers[static_cast<std::size_t>(view.buffer)].data;
      if (view.byteOffset > all.size() || view.byteLength > all.size() - view.byteOffset) {
        *errors += fmt::format("image {} reaches beyond its buffer", index);
        return false;
      }
      bytes = view.byteLength;
    }
    importer.encoded_[index].assign(reinterpret_cast<const char*>(data), bytes);
    return true;
  }

  // tinygltf decodes data URIs of some types. URIs of other types arrive here as a file name with a
  // folder.
  static std::size_t start_of_data(const std::string& name) {
    constexpr std::string_view kEncoded = ";base64,";
    const std::size_t uri = name.find("data:"), data = name.find(kEncoded);
    if (uri == std::string::npos || data == std::string::npos || data < uri ||
        (uri > 0 && name[uri - 1] != '/'))
      return std::string::npos;
    return data + kEncoded.size();
  }

  // tinygltf turns every plus sign of a URI into a blank, although only %20 stands for a blank.
  static std::string expand_name(const std::string& name, void* self) {
    auto& importer = *static_cast<GltfImporter*>(self);
    const std::string folder = importer.folder().string();
    const std::size_t from = name.starts_with(folder) ? folder.size() : 0;
    std::error_code error;
    if (name.find(' ', from) == std::string::npos || start_of_data(name) != std::string::npos ||
        fs::exists(name, error))
      return name;
    std::string plus = name;
    std::replace(plus.begin() + static_cast<std::ptrdiff_t>(from), plus.end(), ' ', '+');
    if (fs::exists(plus, error)) return plus;
    importer.add_file(plus);
    return name;
  }

  // Callbacks of tinygltf. They must not throw. tinygltf searches the mesh's folder first, then the
  // current folder.
  static bool file_exists(const std::string& name, void* self) {
    if (name.ends_with('/')) return false;  // an empty name
    if (start_of_data(name) != std::string::npos) return true;
    static_cast<GltfImporter*>(self)->add_file(name);
    std::error_code error;
    return fs::status(name, error).type() != fs::file_type::not_found;
  }
  static bool read_whole_file(std::vector<unsigned char>* bytes, std::string*,
                              const std::string& name, void* self) {
    auto& importer = *static_cast<GltfImporter*>(self);
    if (const std::size_t data = start_of_data(name); data != std::string::npos) {
      std::string encoded = name.substr(data), type;
      std::replace(encoded.begin(), encoded.end(), ' ', '+');
      return tinygltf::DecodeDataURI(bytes, type, "data:text/plain;base64," + encoded, 0, false);
    }
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

  // tinygltf recurses once per level of unknown JSON, so limit the nesting.
  void check_nesting(const std::string& bytes, bool binary) const {
    constexpr int kMaxNesting = 1000;
    std::string_view json = bytes;
    if (binary) {  // the first chunk
      std::uint32_t length = 0;
      if (bytes.size() < 20) return;
      std::memcpy(&length, bytes.data() + 12, 4);
      json = json.substr(20, length);
    }
    int depth = 0;
    bool in_string = false;
    for (std::size_t i = 0; i < json.size(); ++i) {
      const char c = json[i];
      if (in_string && c == '\\') {
        ++i;
      } else if (c == '"') {
        in_string = !in_string;
      } else if (in_string) {
        continue;
      } else if (c == ']' || c == '}') {
        --depth;
      } else if ((c == '[' || c == '{') && ++depth > kMaxNesting) {
        fail(fmt::format("its JSON is nested more than {} levels deep; export it again",
                         kMaxNesting));
      }
    }
  }

  // Drops chunks after the JSON that are empty or of unknown type, since tinygltf rejects both.
  static void drop_chunk(std::string& bytes) {
    std::uint32_t json = 0, length = 0;
    if (bytes.size() < 20) return;
    std::memcpy(&json, bytes.data() + 12, 4);
    const std::size_t end = std::size_t{20} + json;
    if (bytes.size() < end + 8) return;
    std::memcpy(&length, bytes.data() + end, 4);
    if (length > 0 && bytes.compare(end + 4, 4, "BIN\0", 4) == 0) return;
    bytes.resize(end);
    const auto whole = static_cast<std::uint32_t>(end);
    std::memcpy(bytes.data() + 8, &whole, 4);
  }

  // ---- materials ----

  void import_materials() {
    for (const tinygltf::Material& material : model_.materials) {
      Material ours;
      ours.name = material.name;
      const auto& base = material.pbrMetallicRoughness;
      if (base.baseColorFactor.size() >= 3)
        ours.colour = {base.baseColorFactor[0], base.baseColorFactor[1], base.baseColorFactor[2]};
      int index = base.baseColorTexture.index;
      MaterialUse use = material_use(base.baseColorTexture.texCoord,
                                     extension_of(base.baseColorTexture.extensions, kTransform));
      if (material.extensions.contains(kSpecularGlossiness)) {  // replaces metallic-roughness
        const tinygltf::Value& diffuse = extension_of(material.extensions, kSpecularGlossiness);
        const auto colour = numbers_of<4>(diffuse, "diffuseFactor", {1, 1, 1, 1});
        ours.colour = {colour[0], colour[1], colour[2]};
        const tinygltf::Value& info = member(diffuse, "diffuseTexture");
        index = integer_of(info, "index", -1);
        use = material_use(integer_of(info, "texCoord", 0),
                           member(member(info, "extensions"), kTransform));
      }
      if (index >= 0 && options().textures) ours.texture = texture(index);
      uses_.push_back(use);
      builder_.add_material(ours);
    }
    uses_.emplace_back();
    builder_.add_material({"default", V3d(0.8, 0.8, 0.8), -1});
  }

  MaterialUse material_use(int texcoord, const tinygltf::Value& transform) const {
    MaterialUse use;
    use.transform.offset = pair_of(transform, "offset", 0);
    use.transform.scale = pair_of(transform, "scale", 1);
    use.transform.rotation = number_of(transform, "rotation", 0);
    use.texcoord = integer_of(transform, "texCoord", texcoord);
    return use;
  }

  // Prefers WebP to the fallback image; uses DDS only if there is no fallback.
  int image_of(int index, const tinygltf::Texture& texture) const {
    const int webp = integer_of(extension_of(texture.extensions, kWebp), "source", -1);
    const int dds = integer_of(extension_of(texture.extensions, kDds), "source", -1);
    const int source = webp >= 0 ? webp : texture.source >= 0 ? texture.source : dds;
    if (source >= 0) return source;
    std::set<std::string> names;
    for (const auto& [name, value] : texture.extensions) names.insert(name);
    fail(names.empty() ? fmt::format("texture {} has no image; export it again", index)
                       : fmt::format("texture {} has an image only in {}, which is not supported; "
                                     "export it as PNG, JPEG or WebP",
                                     index, listed(names)));
  }

  int texture(int index) {
    const tinygltf::Texture& from = item(model_.textures, index, "texture");
    Texture ours;
    if (from.sampler >= 0) {
      const tinygltf::Sampler& sampler = item(model_.samplers, from.sampler, "sampler");
      ours.wrap_s = wrap_of(sampler.wrapS);
      ours.wrap_t = wrap_of(sampler.wrapT);
    }
    const int source = image_of(index, from);
    const auto key = std::tuple(source, ours.wrap_s, ours.wrap_t);
    if (const auto found = textures_.find(key); found != textures_.end()) return found->second;
    const tinygltf::Image& image = item(model_.images, source, "image");
    const bool is_file = !image.uri.empty() && !image.uri.starts_with("data:");
    ours.name = is_file ? image.uri : !image.name.empty() ? image.name : "embedded";
    const auto encoded = encoded_.find(source);
    if (encoded == encoded_.end())
      fail(fmt::format(
          "its texture '{}' is missing; put it next to the file or give another texture",
          shown_name(ours.name)));
    ReadReport report;
    ours.image = read_image_memory(fmt::format("{}: {}", path().string(), shown_name(ours.name)),
                                   encoded->second, &report);
    ours.compressed = report.compressed;
    for (const std::string& conversion : report.conversions)
      builder_.note(fmt::format("'{}': {}", shown_name(ours.name), conversion));
    return textures_[key] = builder_.add_texture(std::move(ours));
  }

  // ---- geometry ----

  void visit_scene() {
    if (model_.scenes.empty()) {  // a file without scenes is a library of nodes: draw all roots
      std::vector<bool> child(model_.nodes.size(), false);
      for (const tinygltf::Node& node : model_.nodes)
        for (int index : node.children)
          if (index >= 0 && static_cast<std::size_t>(index) < child.size())
            child[static_cast<std::size_t>(index)] = true;
      for (std::size_t i = 0; i < child.size(); ++i)
        if (!child[i]) visit_node(static_cast<int>(i), M44d(), 0);
      return;
    }
    for (int node : item(model_.scenes, scene_number(), "scene").nodes) visit_node(node, M44d(), 0);
  }
  int scene_number() const { return std::max(model_.defaultScene, 0); }

  void visit_node(int index, const M44d& parent, int depth) {
    constexpr int kMaxDepth = 128;
    if (depth > kMaxDepth)
      fail("its nodes form a cycle or are nested too deeply; the file is damaged");
    count_drawn(1);
    const tinygltf::Node& node = item(model_.nodes, index, "node");
    const tinygltf::Value& visible = member(extension_of(node.extensions, kVisibility), "visible");
    if (visible.Type() != tinygltf::NULL_TYPE && !visible.IsBool())
      fail_member("visible", "true or false");
    if (visible.IsBool() && !visible.Get<bool>()) {
      hidden_nodes_ = true;
      return;
    }
    const M44d matrix = local_matrix(node) * parent;
    if (node.mesh >= 0) {
      const tinygltf::Mesh& mesh = item(model_.meshes, node.mesh, "mesh");
      const std::vector<M44d> places = places_of(node, matrix);
      count_drawn(std::max({places.size(), mesh.primitives.size(), std::size_t{1}}) - 1);
      for (const tinygltf::Primitive& primitive : mesh.primitives)
        import_primitive(primitive, node.weights.empty() ? mesh.weights : node.weights, places);
    }
    for (int child : node.children) visit_node(child, matrix, depth + 1);
  }

  void count_drawn(std::size_t more) {
    drawn_parts_ += more;
    if (drawn_parts_ > kMaxParts)
      fail(fmt::format("it draws more than {} nodes, instances and primitives; split it",
                       kMaxParts));
  }

  static M44d transform_of(const V3d& scale, const Imath::Quatd& rotation, const V3d& translation) {
    M44d matrix, move;
    matrix.setScale(scale);
    move.setTranslation(translation);
    return matrix * rotation.normalized().toMatrix44() * move;
  }

  // glTF stores matrices column by column. Imath multiplies row vectors from the left, so the same
  // sixteen numbers in the same order are Imath's matrix.
  M44d local_matrix(const tinygltf::Node& node) const {
    for (const auto& [name, numbers, count] : {std::tuple("matrix", &node.matrix, 16u),
                                               {"scale", &node.scale, 3u},
                                               {"rotation", &node.rotation, 4u},
                                               {"translation", &node.translation, 3u}})
      if (!numbers->empty() && numbers->size() != count)
        fail_member(name, fmt::format("{} numbers", count));
    if (node.matrix.size() == 16) {
      M44d matrix;
      for (int i = 0; i < 16; ++i) matrix[i / 4][i % 4] = node.matrix[static_cast<std::size_t>(i)];
      return matrix;
    }
    V3d scale(1, 1, 1), translation(0, 0, 0);
    Imath::Quatd rotation;
    if (node.scale.size() == 3) scale = V3d(node.scale[0], node.scale[1], node.scale[2]);
    if (node.rotation.size() == 4)
      rotation = {node.rotation[3], node.rotation[0], node.rotation[1], node.rotation[2]};
    if (node.translation.size() == 3)
      translation = V3d(node.translation[0], node.translation[1], node.translation[2]);
    return transform_of(scale, rotation, translation);
  }

  // Transforms of a node's mesh: one, or one per instance of EXT_mesh_gpu_instancing.
  std::vector<M44d> places_of(const tinygltf::Node& node, const M44d& matrix) const {
    if (!node.extensions.contains(kInstances)) return {matrix};
    const tinygltf::Value& attributes =
        member(extension_of(node.extensions, kInstances), "attributes");
    std::optional<std::size_t> count;
    for (const std::string& name : attributes.Keys()) {
      const int accessor = integer_of(attributes, name.c_str(), -1);
      const std::size_t own = item(model_.accessors, accessor, "accessor").count;
      if (own > kMaxParts)
        fail(
            fmt::format("a node has {} instances, at most {} are drawn; split it", own, kMaxParts));
      if (count.value_or(own) != own)
        fail(fmt::format("the attributes of instances have {} and {} elements; the file is damaged",
                         *count, own));
      count = own;
    }
    if (!count) fail("a node with EXT_mesh_gpu_instancing has no attributes; the file is damaged");
    const auto attribute = [&](const char* name, std::size_t needed) {
      return attributes.Has(name) ? read(integer_of(attributes, name, -1), needed) : Numbers();
    };
    const Numbers translations = attribute("TRANSLATION", 3), rotations = attribute("ROTATION", 4),
                  scales = attribute("SCALE", 3);
    std::vector<M44d> places(*count);
    for (std::size_t i = 0; i < places.size(); ++i) {
      Imath::Quatd rotation;
      if (rotations.count > 0)
        rotation = {rotations.at(i, 3), rotations.at(i, 0), rotations.at(i, 1), rotations.at(i, 2)};
      places[i] = transform_of(scales.count > 0 ? scales.three(i) : V3d(1, 1, 1), rotation,
                               translations.count > 0 ? translations.three(i) : V3d(0, 0, 0)) *
                  matrix;
    }
    return places;
  }

  struct Numbers {
    std::vector<double> values;
    std::size_t components = 0, count = 0;
    double at(std::size_t i, std::size_t component) const {
      return values[i * components + component];
    }
    V3d three(std::size_t i) const { return {at(i, 0), at(i, 1), at(i, 2)}; }
    V2d two(std::size_t i) const { return {at(i, 0), at(i, 1)}; }
  };

  // Location and layout of an accessor's elements.
  struct Layout {
    int buffer_view = -1;
    std::size_t byte_offset = 0, components = 1, count = 0;
    int component_type = 0;
    bool normalized = false;
  };

  std::vector<double> numbers(const Layout& layout, int accessor) const {
    const tinygltf::BufferView& view = item(model_.bufferViews, layout.buffer_view, "buffer view");
    const tinygltf::Buffer& buffer = item(model_.buffers, view.buffer, "buffer");
    const int component_bytes =
        tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(layout.component_type));
    if (component_bytes <= 0) fail_type(accessor);
    const auto each = static_cast<std::size_t>(component_bytes);
    const std::size_t element = each * layout.components;
    const std::size_t stride = view.byteStride != 0 ? view.byteStride : element;
    const std::size_t most = buffer.data.size();
    // Each term is bounded by the size of the buffer before it is added or multiplied, so nothing
    // overflows.
    const bool fits = view.byteOffset <= most && view.byteLength <= most - view.byteOffset &&
                      layout.byte_offset <= view.byteLength && stride >= element && stride <= 252 &&
                      layout.count <= most &&
                      (layout.count == 0 || (layout.count - 1) * stride + element <=
                                                view.byteLength - layout.byte_offset);
    if (!fits)
      fail(fmt::format("accessor {} reaches beyond its buffer; the file is truncated or damaged",
                       accessor));
    count_numbers(layout.count * layout.components);
    std::vector<double> values;
    values.reserve(layout.count * layout.components);
    const unsigned char* base = buffer.data.data() + view.byteOffset + layout.byte_offset;
    for (std::size_t i = 0; i < layout.count; ++i)
      for (std::size_t c = 0; c < layout.components; ++c)
        values.push_back(
            number(base + i * stride + c * each, layout.component_type, layout.normalized));
    return values;
  }

  // An accessor is decoded again for each use, so every use counts.
  void count_numbers(std::size_t numbers) const {
    numbers_read_ += numbers;
    if (numbers_read_ > kMaxNumbers)
      fail(
          fmt::format("its nodes and primitives read more than {} accessor values; reduce shared "
                      "use of accessors or split the file",
                      kMaxNumbers));
  }

  [[noreturn]] void fail_type(int accessor) const {
    fail(fmt::format("accessor {} has the wrong type; the file is damaged", accessor));
  }

  // An accessor without a buffer view is all zeros; sparse values replace some elements.
  Numbers read(int index, std::size_t needed) const {
    const tinygltf::Accessor& accessor = item(model_.accessors, index, "accessor");
    const int components =
        tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor.type));
    if (components <= 0 || static_cast<std::size_t>(components) < needed) fail_type(index);
    Numbers result;
    result.components = static_cast<std::size_t>(components);
    result.count = accessor.count;
    const Layout layout{accessor.bufferView, accessor.byteOffset,    result.components,
                        result.count,        accessor.componentType, accessor.normalized};
    if (accessor.bufferView != -1) {
      result.values = numbers(layout, index);
    } else {
      if (result.count > kMaxTriangles)
        fail(fmt::format("accessor {} has {} elements without a buffer view, the limit is {}",
                         index, result.count, kMaxTriangles));
      count_numbers(result.count * result.components);
      result.values.assign(result.count * result.components, 0.0);
      if (!accessor.sparse.isSparse) zeros_.insert(index);
    }
    if (accessor.sparse.isSparse) add_sparse(index, accessor, layout, result);
    return result;
  }

  void add_sparse(int index, const tinygltf::Accessor& accessor, Layout layout,
                  Numbers& result) const {
    const auto& sparse = accessor.sparse;
    layout.count = static_cast<std::size_t>(sparse.count);
    layout.buffer_view = sparse.values.bufferView;
    layout.byte_offset = static_cast<std::size_t>(sparse.values.byteOffset);
    const std::vector<double> values = numbers(layout, index);
    const std::vector<double> places =
        numbers({sparse.indices.bufferView, static_cast<std::size_t>(sparse.indices.byteOffset), 1,
                 layout.count, sparse.indices.componentType, false},
                index);
    for (std::size_t i = 0; i < places.size(); ++i) {
      if (!(places[i] >= 0.0 && places[i] < static_cast<double>(result.count)))
        fail(fmt::format(
            "accessor {} has {} elements, but a sparse element has index {}; the file is damaged",
            index, result.count, places[i]));
      std::copy_n(
          values.begin() + static_cast<std::ptrdiff_t>(i * result.components), result.components,
          result.values.begin() +
              static_cast<std::ptrdiff_t>(static_cast<std::size_t>(places[i]) * result.components));
    }
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
        fail(fmt::format("it has the component type {}, which glTF does not define", type));
    }
  }

  // Corner indices of triangle `t` of a list, strip or fan.
  static std::array<std::size_t, 3> corners_of(int mode, std::size_t t) {
    if (mode == TINYGLTF_MODE_TRIANGLE_STRIP)
      return t % 2 == 0 ? std::array{t, t + 1, t + 2} : std::array{t + 1, t, t + 2};
    if (mode == TINYGLTF_MODE_TRIANGLE_FAN) return {0, t + 1, t + 2};
    return {3 * t, 3 * t + 1, 3 * t + 2};
  }

  // Moves an attribute by the weighted deltas of the primitive's morph targets.
  void morph(const tinygltf::Primitive& primitive, const std::vector<double>& weights,
             const std::string& name, Numbers& base) const {
    for (std::size_t t = 0; t < std::min(primitive.targets.size(), weights.size()); ++t) {
      const auto found = primitive.targets[t].find(name);
      if (weights[t] == 0.0 || found == primitive.targets[t].end()) continue;
      const Numbers delta = read(found->second, base.components);
      if (delta.count != base.count)
        fail(
            fmt::format("morph target {} has {} elements for {}, its primitive {}; the file is "
                        "damaged",
                        t, delta.count, name, base.count));
      for (std::size_t i = 0; i < base.count; ++i)
        for (std::size_t c = 0; c < base.components; ++c)
          base.values[i * base.components + c] += weights[t] * delta.at(i, c);
    }
  }

  Numbers read_indices(int index) const {
    const tinygltf::Accessor& accessor = item(model_.accessors, index, "accessor");
    if (accessor.type != TINYGLTF_TYPE_SCALAR ||
        (accessor.componentType != TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE &&
         accessor.componentType != TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT &&
         accessor.componentType != TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT))
      fail_type(index);
    return read(index, 1);
  }

  void import_primitive(const tinygltf::Primitive& primitive, const std::vector<double>& weights,
                        const std::vector<M44d>& places) {
    const int mode = primitive.mode;
    if (mode < TINYGLTF_MODE_POINTS || mode > TINYGLTF_MODE_TRIANGLE_FAN)
      fail(fmt::format("a primitive has mode {}, which glTF does not define; export it again",
                       mode));
    if (mode < TINYGLTF_MODE_TRIANGLES) {
      skipped_primitives_ = true;
      return;
    }
    const auto attribute = [&](const std::string& name, std::size_t needed) {
      const auto found = primitive.attributes.find(name);
      if (found == primitive.attributes.end()) return Numbers();
      Numbers numbers = read(found->second, needed);
      morph(primitive, weights, name, numbers);
      return numbers;
    };
    const auto position = primitive.attributes.find("POSITION");
    if (position == primitive.attributes.end())
      fail("a primitive has no positions; the file is damaged");
    const tinygltf::Accessor& accessor = item(model_.accessors, position->second, "accessor");
    if (accessor.bufferView == -1 && !accessor.sparse.isSparse && !primitive.extensions.empty()) {
      std::set<std::string> names;
      for (const auto& [name, value] : primitive.extensions) names.insert(name);
      fail(fmt::format(
          "a primitive stores its positions only in {}, which is not supported; export without it",
          listed(names)));
    }
    if (primitive.material >= 0) item(model_.materials, primitive.material, "material");
    const std::size_t material = primitive.material < 0
                                     ? model_.materials.size()
                                     : static_cast<std::size_t>(primitive.material);
    const MaterialUse& use = uses_[material];
    vertex_colours_ = vertex_colours_ || primitive.attributes.contains("COLOR_0");

    const Numbers positions = attribute("POSITION", 3), normals = attribute("NORMAL", 3),
                  coordinates = attribute(fmt::format("TEXCOORD_{}", use.texcoord), 2);
    Numbers indices;
    if (primitive.indices >= 0) indices = read_indices(primitive.indices);

    const std::size_t corners = primitive.indices >= 0 ? indices.count : positions.count;
    const std::size_t triangles = mode == TINYGLTF_MODE_TRIANGLES ? corners / 3
                                  : corners >= 3                  ? corners - 2
                                                                  : 0;
    incomplete_corners_ += mode == TINYGLTF_MODE_TRIANGLES ? corners % 3
                           : corners < 3                   ? corners
                                                           : 0;
    if (triangles == 0 || places.empty()) return;
    drawn_ = true;
    const auto vertex_of = [&](std::size_t corner) {
      const double index =
          primitive.indices >= 0 ? indices.values[corner] : static_cast<double>(corner);
      if (!(index >= 0.0 && index < static_cast<double>(positions.count)))
        fail(fmt::format("vertex {} is used, but there are {}; the file is damaged", index,
                         positions.count));
      return static_cast<std::size_t>(index);
    };
    for (const M44d& matrix : places) {
      // A singular matrix has no inverse, so face normals are used.
      const double determinant = matrix.determinant();
      const M44d normal_matrix = matrix.inverse().transposed();
      const auto corner_at = [&](std::size_t k) {
        const std::size_t i = vertex_of(k);
        MeshBuilder::Corner corner;
        corner.position = positions.three(i) * matrix;
        if (i < normals.count && determinant != 0.0) {
          V3d normal;
          normal_matrix.multDirMatrix(normals.three(i), normal);
          corner.normal = normal;
        }
        if (i < coordinates.count) corner.uv = use.transform.apply(coordinates.two(i));
        return corner;
      };
      for (std::size_t t = 0; t < triangles; ++t) {
        std::array<std::size_t, 3> k = corners_of(mode, t);
        if (determinant < 0.0) std::swap(k[1], k[2]);
        builder_.add_triangle({corner_at(k[0]), corner_at(k[1]), corner_at(k[2])},
                              static_cast<std::uint32_t>(material));
      }
    }
  }

  static constexpr std::size_t kMaxParts = 1'000'000;
  static constexpr std::size_t kMaxNumbers = std::size_t{1} << 28;  // over all accessors
  MeshBuilder builder_;
  tinygltf::Model model_;
  std::map<int, std::string> encoded_;
  std::string unreadable_;         // reason why an existing file could not be read
  std::vector<MaterialUse> uses_;  // by material; the default material is last
  std::map<std::tuple<int, spec::texture::Wrap, spec::texture::Wrap>, int> textures_;
  std::size_t drawn_parts_ = 0;
  mutable std::size_t numbers_read_ = 0;
  std::size_t incomplete_corners_ = 0;
  mutable std::set<int> zeros_;  // accessors without data
  bool skipped_primitives_ = false, vertex_colours_ = false, hidden_nodes_ = false, drawn_ = false;
};

}  // namespace

std::unique_ptr<Importer> gltf_importer(const fs::path& path, const ImportOptions& options) {
  return std::make_unique<GltfImporter>(path, options);
}

}  // namespace deburr::tb
