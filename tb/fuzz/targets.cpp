// SPDX-License-Identifier: MIT
#include "tb/fuzz/targets.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>
#include <string>

#include "spec/error.h"
#include "tb/fuzz/c_calls.h"
#include "tb/fuzz/engine_parameters.h"
#include "tb/fuzz/run_files.h"
#include "tb/run/parameter_set.h"
#include "tb/scene/image_io.h"
#include "tb/scene/mesh.h"
#include "tb/scene/png.h"
#include "tb/stimuli/compressed_files.h"
#include "tb/stimuli/weight_file.h"
#include "tb/traces/fragment_reader.h"
#include "tb/traces/fragment_writer.h"

namespace deburr::tb {
namespace {

namespace fs = std::filesystem;

// The input as a temporary file, because the readers take files.
class InputFile {
 public:
  InputFile(std::string_view bytes, std::string_view extension)
      : file_(fs::temp_directory_path() /
              ("deburr-fuzz-" + std::to_string(::getpid()) + std::string(extension))) {
    std::ofstream(file_, std::ios::binary) << bytes;
  }
  ~InputFile() {
    std::error_code ignored;
    fs::remove(file_, ignored);
  }
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;
  const fs::path& path() const { return file_; }

 private:
  fs::path file_;
};

// Accepts success and named errors alike.
template <class Read>
void taken_or_rejected(Read&& read) {
  try {
    read();
  } catch (const spec::Error&) {
  }
}

void require(bool condition, const char* what) {
  if (!condition) throw std::logic_error(what);
}

void pictures(std::string_view bytes) {
  taken_or_rejected([&] {
    const Image image = read_image_memory("input", bytes);
    require(image.width > 0 && image.height > 0 &&
                image.pixels.size() ==
                    static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height),
            "the number of pixels is not width x height");
  });
}

void depths(std::string_view bytes) {
  const InputFile file(bytes, ".png");
  taken_or_rejected([&] {
    const DepthImage image = read_depth(file.path());
    require(image.pixels.size() ==
                static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height),
            "the number of depths is not width x height");
  });
}

// Never OpenImageIO's part, so that mutations stay with these readers.
void compressed_textures(std::string_view bytes) {
  if (!is_compressed_file(bytes.substr(0, kCompressedHeaderBytes))) return;
  taken_or_rejected([&] {
    const CompressedTexture texture = read_compressed("input", bytes);
    for (const CompressedTexture::Level& level : texture.levels) {
      const Image image = decoded(level, texture.format);
      require(image.width == level.width && image.height == level.height && !image.empty(),
              "a level has no texels");
    }
  });
}

void mesh(std::string_view bytes, std::string_view extension, const ImportOptions& options = {}) {
  const InputFile file(bytes, extension);
  taken_or_rejected([&] {
    const Mesh read = import_mesh(file.path(), options);
    for (const Triangle& triangle : read.triangles)
      for (const std::uint32_t corner : triangle.vertex)
        require(corner < read.vertices.size(), "a triangle uses a vertex that is not in the mesh");
  });
}
// Reads the input as a mesh and as a material file; images that it names are not read.
void obj(std::string_view bytes) {
  mesh(bytes, ".obj");
  const InputFile materials(bytes, ".mtl");
  mesh("mtllib " + materials.path().filename().string() +
           "\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 1\nusemtl a\nf 1/1 2/2 3/1\n",
       ".obj", {.textures = false});
}
void gltf(std::string_view bytes) { mesh(bytes, bytes.starts_with("glTF") ? ".glb" : ".gltf"); }

void read_traces(std::string_view bytes) {
  const InputFile file(bytes, ".trace");
  constexpr std::size_t kTextures = 2;
  taken_or_rejected([&] {
    traces::FragmentReader reader(file.path(), kTextures);
    traces::TracedQuad quad;
    while (reader.next(quad))
      require(quad.quad.texture < kTextures, "a quad uses a texture that does not exist");
  });
}

void configurations(std::string_view bytes) {
  const InputFile file(bytes, ".yaml");
  EngineParameters engines;
  ParameterSet set;
  engines.add_to(set);
  taken_or_rejected([&] {
    set.load(file.path());
    // Accepted input must survive a write and a second read.
    const std::string resolved = set.resolved().dump(), yaml = set.yaml();
    const InputFile again(yaml, ".again.yaml");
    set.load(again.path());
    require(set.resolved().dump() == resolved,
            "the configuration changed when it was written and read again");
  });
}

void weights(std::string_view bytes) {
  taken_or_rejected([&] {
    // Accepted input must survive a write and a second read.
    const auto read = stimuli::parse_weight_file("input", bytes);
    const std::string text = stimuli::weight_file_text(read, {});
    const auto again = stimuli::parse_weight_file("again", text);
    require(stimuli::entries_of(again) == stimuli::entries_of(read),
            "the weights changed when they were written and read again");
  });
}

constexpr std::string_view kPpm = "P3\n2 1\n255\n255 0 0 0 255 0\n";
constexpr std::string_view kObj =
    "mtllib none.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nvt 0 0\nvt 1 0\nvn 0 0 1\n"
    "f 1/1/1 2/2/1 3/1/1\nf 2//1 4//1 3//1\n";
// A byte order mark; faces: C-shaped, self-intersecting, with a hole and bridge, of zero area;
// colours; a curve.
constexpr std::string_view kPolygons =
    "\xEF\xBB\xBFv 0 0 0\nv 3 0 0 1 0 0\nv 3 1 0\nv 1 1 0\nv 1 2 0\nv 3 2 0\nv 3 3 0\nv 0 3 0\n"
    "f 1 2 3 4 5 6 7 8 # C\nf 1 7 2 8\nf 1 2 7 8 1 4 5 \\\n6 3 4\nf 1 2 2 1 1\ncurv 0 1 1 2\n";
constexpr std::string_view kMaterials =
    "\xEF\xBB\xBFnewmtl a\nKd 0.5\nmap_Kd -s 2 3 -o 0.5 -clamp on -mm 0 2 -cc on a b.png\nd 0.5\n"
    "newmtl b\nKd spectral a.rfl\nmap_d -bm 1 a.png\nnewmtl c\nKd 1 \\\n0,5 0\nnewmtl d\n";
constexpr std::string_view kGltf =
    R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0,)"
    R"("scale":[1,2,3]}],"meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1,)"
    R"("mode":4}]}],"buffers":[{"byteLength":42,"uri":"data:application/octet-stream;base64,)"
    R"(AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAABAAIA"}],"bufferViews":[)"
    R"({"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":6}],"accessors":[)"
    R"({"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]},)"
    R"({"bufferView":1,"componentType":5123,"count":3,"type":"SCALAR"}]})";
// A morph target with sparse values, instances, zeros, a hidden node, images of every kind.
constexpr std::string_view kGltfExtensions =
    R"({"asset":{"version":"2.0"},"extensionsUsed":["EXT_mesh_gpu_instancing","ACME"],)"
    R"("nodes":[{"mesh":0,"weights":[0.5],"extensions":{"EXT_mesh_gpu_instancing":{)"
    R"("attributes":{"TRANSLATION":0,"ROTATION":4,"SCALE":0}}}},{"mesh":0,"extensions":{)"
    R"("KHR_node_visibility":{"visible":false}}}],"meshes":[{"weights":[1],"primitives":[)"
    R"({"attributes":{"POSITION":0,"TEXCOORD_1":3},"indices":1,"material":0,"targets":[)"
    R"({"POSITION":2}]}]}],"materials":[{"pbrMetallicRoughness":{"baseColorTexture":{"index":0,)"
    R"("extensions":{"KHR_texture_transform":{"offset":[0,1],"rotation":1.5,"scale":[0.5,2],)"
    R"("texCoord":1}}}}},{"extensions":{"KHR_materials_pbrSpecularGlossiness":{)"
    R"("diffuseFactor":[1,0,0,1],"diffuseTexture":{"index":1}}}}],"textures":[{"extensions":{)"
    R"("EXT_texture_webp":{"source":0}}},{"source":1}],"images":[{"uri":"data:image/webp;base64,)"
    R"(UklGRh4AAABXRUJQVlA4TBEAAAAvAQAAAA8Q87//8x8OMqL/AQA="},{"bufferView":3}],)"
    R"("buffers":[{"byteLength":74,"uri":"data:application/octet-stream;base64,)"
    R"(AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAABAAIAAAAAAAAAAAAAAAAAAEABAAAAUDYK)"
    R"(MSAxCjI1NQphYmM="}],)"
    R"("bufferViews":[{"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":6},)"
    R"({"buffer":0,"byteOffset":44,"byteLength":16},{"buffer":0,"byteOffset":60,"byteLength":14}],)"
    R"("accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"},)"
    R"({"bufferView":1,"componentType":5123,"count":3,"type":"SCALAR"},{"componentType":5126,)"
    R"("count":3,"type":"VEC3","sparse":{"count":1,"indices":{"bufferView":2,"byteOffset":12,)"
    R"("componentType":5121},"values":{"bufferView":2}}},{"componentType":5126,"count":3,)"
    R"("type":"VEC2"},{"componentType":5126,"count":3,"type":"VEC4"}]})";
// Nested lists, and a node that is drawn twice.
constexpr std::string_view kGltfNested =
    R"({"asset":{"version":"2.0"},"extensionsUsed":["A\u001b"],"extras":[[[[[[[[{"a":[["\\"]]}]]]]]]]],"nodes":[{)"
    R"("children":[1,1]},{"children":[2,2]},{"mesh":0}],"meshes":[{"primitives":[{)"
    R"("attributes":{"POSITION":0}}]}],"accessors":[{"componentType":5126,"count":3,)"
    R"("type":"VEC3"}]})";
constexpr std::string_view kTrace =
    "deburr-fragments 1\nsize 640 480\n# comment\n"
    "quad 0 f f 0 10 20 0.5 0.25 0.51 0.25 0.5 0.26 0.51 0.26\n"
    "fragment 0 13 21 0.53 0.26 0.01 0 0 0.01\nfragment 1 - - 0.25 0.75 0.001 0 0 0.004\nend 3\n";

// In hexadecimal: colours with alpha, straight or premultiplied; a part of the EXR lies outside its
// display window. And a depth of 16 bits.
constexpr std::string_view kWebp =
    "524946463a000000574542505650384c2d0000002f030000101f20242053a2672e111210aaffbbdc91850484e6ff"
    "482724210161baecaf1e2abf55c0a85344ff0300";
constexpr std::string_view kExr =
    "762f3101020000006368616e6e656c730063686c6973740049000000410002000000000000000100000001000000"
    "42000200000000000000010000000100000047000200000000000000010000000100000052000200000000000000"
    "010000000100000000636f6d7072657373696f6e00636f6d7072657373696f6e0001000000006461746157696e64"
    "6f7700626f7832690010000000ffffffff000000000000000000000000646973706c617957696e646f7700626f78"
    "32690010000000000000000000000001000000000000006c696e654f72646572006c696e654f7264657200010000"
    "0000706978656c417370656374526174696f00666c6f617400040000000000803f73637265656e57696e646f7743"
    "656e746572007632660008000000000000000000000073637265656e57696e646f77576964746800666c6f617400"
    "040000000000803f00530100000000000000000000200000000000003f0000003f0000803e0000803e0000000000"
    "0000000000003f0000003f";
constexpr std::string_view kTiff =
    "49492a00080000000b00000103000100000001000000010103000100000001000000020103000400000092000000"
    "03010300010000000100000006010300010000000200000011010400010000009a00000015010300010000000400"
    "00001601030001000000010000001701040001000000040000001c01030001000000010000005201030001000000"
    "010000000000000008000800080008000808090a";
constexpr std::string_view kDds =
    "444453207c0000000710000004000000040000000000000000000000000000000000000000000000000000000000"
    "00000000000000000000000000000000000000000000000000000000000020000000040000004458543220000000"
    "ff00000000ff00000000ff00000000ff001000000000000000000000000000000000000088888888888888880050"
    "000000000000";
constexpr std::string_view kDepthPng =
    "89504e470d0a1a0a0000000d49484452000000030000000110000000006e1b972b0000000f49444154789c636060"
    "6860fcff1f0005070280488e14ce0000000049454e44ae426082";

std::string made_of(std::string_view text) { return std::string(text); }

std::string of_hex(std::string_view digits) {
  std::string bytes;
  for (std::size_t i = 0; i + 1 < digits.size(); i += 2)
    bytes += static_cast<char>(std::stoi(std::string(digits.substr(i, 2)), nullptr, 16));
  return bytes;
}

Image small_picture(int width, int height, std::uint8_t alpha) {
  Image image(width, height);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    const auto code = static_cast<std::uint8_t>(37 * i);
    image.pixels[i] = {code, static_cast<std::uint8_t>(255 - code), 7, alpha};
  }
  return image;
}

std::vector<std::string> pictures_seeds() {
  return {made_of(kPpm),
          encode_png(small_picture(5, 3, 255)),
          encode_png(small_picture(2, 7, 9)),
          of_hex(kWebp),
          of_hex(kExr),
          of_hex(kTiff),
          of_hex(kDds)};
}
std::vector<std::string> depths_seeds() {
  return {encode_png(small_picture(5, 3, 255)), of_hex(kDepthPng), of_hex(kExr)};
}
std::vector<std::string> compressed_textures_seeds() {
  return stimuli::small_compressed_files(small_picture(9, 6, 200));
}
std::vector<std::string> obj_seeds() {
  return {made_of(kObj), made_of(kPolygons), made_of(kMaterials)};
}

// The same mesh as .gltf and as .glb.
std::vector<std::string> gltf_seeds() {
  std::vector<std::string> seeds;
  for (const std::string_view text : {kGltf, kGltfExtensions, kGltfNested}) {
    std::string json = made_of(text);
    seeds.push_back(json);
    while (json.size() % 4 != 0) json += ' ';
    std::string& glb = seeds.emplace_back("glTF");
    const auto put = [&glb](std::size_t value) {
      traces::put_little_endian(glb, static_cast<std::uint32_t>(value));
    };
    put(2);
    put(28 + json.size());
    put(json.size());
    glb += "JSON";
    glb += json;
    put(0);
    glb += std::string_view("BIN\0", 4);
  }
  return seeds;
}

std::vector<std::string> traces_seeds() {
  std::vector<std::string> seeds = {made_of(kTrace)};
  for (const traces::TraceFormat format :
       {traces::TraceFormat::kText, traces::TraceFormat::kBinary}) {
    const InputFile file("", ".seed");
    traces::FragmentWriter writer(file.path(), format, 8, 6);
    traces::TracedQuad quad;
    quad.placed = true;
    quad.quad.coverage = 0xF;
    for (int i = 0; i < 3; ++i) {
      quad.quad.x = static_cast<decltype(quad.quad.x)>(2 * i);
      writer.put(quad);
    }
    writer.finish();
    std::ostringstream bytes;
    bytes << std::ifstream(file.path(), std::ios::binary).rdbuf();
    seeds.push_back(bytes.str());
  }
  return seeds;
}

// The first parameters of each engine, as a map and by dotted names; and all parameters.
std::vector<std::string> configurations_seeds() {
  EngineParameters engines;
  ParameterSet set;
  engines.add_to(set);
  std::map<std::string, std::vector<const Parameter*>> by_engine;
  for (const Parameter& parameter : set.all())
    by_engine[parameter.name.substr(0, parameter.name.find('.'))].push_back(&parameter);
  std::string few;
  for (const auto& [engine, parameters] : by_engine) {
    const Parameter& first = *parameters.front();
    few += engine + ": {" + first.name.substr(engine.size() + 1) + ": " + first.text() + "}\n";
    if (parameters.size() > 1) few += parameters[1]->name + ": " + parameters[1]->text() + "\n";
  }
  return {few, set.yaml()};
}

std::vector<std::string> weights_seeds() {
  return {stimuli::weight_file_text({}, {}), stimuli::weight_file_text({}, {"a note"})};
}

constexpr std::array<FuzzTarget, 10> kTargets{
    {{"pictures", pictures, pictures_seeds},
     {"compressed_textures", compressed_textures, compressed_textures_seeds},
     {"depths", depths, depths_seeds},
     {"obj", obj, obj_seeds},
     {"gltf", gltf, gltf_seeds},
     {"traces", read_traces, traces_seeds},
     {"configurations", configurations, configurations_seeds},
     {"run_files", run_files, run_files_seeds},
     {"weights", weights, weights_seeds},
     {"c_calls", c_calls, c_calls_seeds}}};

}  // namespace

std::span<const FuzzTarget> fuzz_targets() { return kTargets; }

const FuzzTarget& fuzz_target(std::string_view name) {
  const auto found = std::find_if(kTargets.begin(), kTargets.end(),
                                  [&](const FuzzTarget& target) { return target.name == name; });
  if (found == kTargets.end())
    throw std::invalid_argument("no fuzz target '" + std::string(name) + "'");
  return *found;
}

}  // namespace deburr::tb
