// SPDX-License-Identifier: MIT
// OBJ and glTF files are read as specified, and every invalid file is named.
#include "tb/scene/mesh.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cmath>
#include <cstring>

#include "tb/base/random.h"
#include "tb/scene/image_io.h"
#include "tb/scene/textures.h"
#include "tb/unit/scene/fixtures.h"

namespace deburr::tb::mesh_test {
namespace {

namespace fs = std::filesystem;

using Imath::V2d;
using Imath::V3d;
using test::file_error;
using test::TemporaryFolder;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsSupersetOf;
using ::testing::Not;

constexpr const char* kSquare =
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
    "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
    "f 1/1 2/2 3/3 4/4\n";

std::string import_error(const fs::path& path) {
  return file_error([&] { import_mesh(path); });
}

const Vertex& corner(const Mesh& mesh, std::size_t triangle, std::size_t k) {
  return mesh.vertices[mesh.triangles[triangle].vertex[k]];
}

TEST(Obj, PolygonsBecomeTrianglesAndVIsFlipped) {
  const TemporaryFolder folder;
  const Mesh mesh = import_mesh(folder.write("square.obj", kSquare));
  EXPECT_EQ(mesh.name, "square");
  EXPECT_EQ(mesh.triangles.size(), 2u);
  EXPECT_EQ(mesh.vertices.size(), 4u);  // equal corners are shared
  for (const Vertex& vertex : mesh.vertices) {
    EXPECT_EQ(vertex.uv, V2d(vertex.position.x, 1.0 - vertex.position.y));
    EXPECT_EQ(vertex.normal, V3d(0, 0, 1));
  }
  const Bounds box = bounds(mesh);
  EXPECT_EQ(box.low, V3d(0, 0, 0));
  EXPECT_EQ(box.high, V3d(1, 1, 0));
  EXPECT_EQ(mesh.materials.size(), 1u);
}

TEST(Obj, ReadsMaterialsAndTextures) {
  const TemporaryFolder folder;
  write_image(folder / "wood grain.png", noise(8, 8));
  folder.write("m.mtl",
               "newmtl wood\nKd 1 1 1\nmap_Kd wood grain.png\nnewmtl red\nKd 1 0 0\nnewmtl unused\n"
               "map_Kd not_there.bmp\n");
  folder.write("unused.mtl",
               "newmtl wood\nKd 1 1 1\nmap_Kd wood grain.png\nnewmtl red\nKd 1 0 0\n");
  const std::string body = std::string(kSquare) + "v 0 0 1\n";
  const std::string faces = "usemtl wood\nf 1/1 2/2 5/3\nusemtl red\nf 1 2 5\n";
  EXPECT_THAT(import_error(folder.write("missing.obj", "mtllib m.mtl\n" + body + faces)),
              AllOf(HasSubstr("not_there.bmp"), HasSubstr("give another texture")));
  const fs::path path = folder.write("good.obj", "mtllib unused.mtl\n" + body + faces);
  Mesh mesh = import_mesh(path);
  ASSERT_EQ(mesh.materials.size(), 3u);  // default (the square), wood, red
  ASSERT_EQ(mesh.textures.size(), 1u);
  EXPECT_EQ(mesh.textures[0].image, noise(8, 8));
  EXPECT_EQ(mesh.materials[mesh.triangles[2].material].name, "wood");
  EXPECT_EQ(mesh.materials[mesh.triangles[3].material].colour, V3d(1, 0, 0));
  EXPECT_THAT(mesh.notes, Contains(HasSubstr("box projection")));
  EXPECT_TRUE(import_mesh(path, {.textures = false}).textures.empty());

  // Plain materials become cells of a palette.
  texture_everything(mesh, nullptr);
  ASSERT_EQ(mesh.textures.size(), 2u);
  const Image& palette = mesh.textures[1].image;
  const V2d uv = corner(mesh, 3, 0).uv;
  EXPECT_EQ(
      palette.at(static_cast<int>(uv.x * palette.width), static_cast<int>(uv.y * palette.height)),
      (Rgba8{255, 0, 0, 255}));
  EXPECT_EQ(corner(mesh, 3, 1).uv, uv);
  EXPECT_EQ(corner(mesh, 2, 0).uv, V2d(0, 1));  // a textured neighbour keeps its coordinates
}

TEST(Obj, MissingMaterialFileGivesNote) {
  const TemporaryFolder folder;
  const Mesh mesh =
      import_mesh(folder.write("a.obj", std::string("mtllib none.mtl\nusemtl x\n") + kSquare));
  EXPECT_THAT(mesh.notes, Contains(HasSubstr("none.mtl")));
}

TEST(Obj, BoxProjectionUsesFaceNormals) {
  const TemporaryFolder folder;
  const Mesh mesh = import_mesh(folder.write("floor.obj", "v 0 0 0\nv 0 0 8\nv 8 0 0\nf 1 2 3\n"));
  EXPECT_EQ(corner(mesh, 0, 0).normal, V3d(0, 1, 0));
  EXPECT_EQ(corner(mesh, 0, 1).uv, V2d(0, 4));  // four repeats over the longest side
  EXPECT_EQ(corner(mesh, 0, 2).uv, V2d(4, 0));
  EXPECT_EQ(mesh.notes.size(), 2u);
}

TEST(Obj, NegativeIndicesCountBackwards) {
  const TemporaryFolder folder;
  const Mesh mesh = import_mesh(folder.write("n.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\n"));
  EXPECT_EQ(corner(mesh, 0, 2).position, V3d(0, 1, 0));
}

TEST(Obj, BackslashContinuesLine) {
  const TemporaryFolder folder;
  for (const std::string end : {"\n", "\r\n"}) {
    const std::string three = "v 0 0 \\" + end + "0" + end + "v 1 0 0" + end + "v 0 1 0" + end;
    const Mesh mesh =
        import_mesh(folder.write("c.obj", three + "f 1 \\" + end + "2 \\" + end + "3" + end));
    ASSERT_EQ(mesh.triangles.size(), 1u);
    EXPECT_EQ(corner(mesh, 0, 2).position, V3d(0, 1, 0));
    EXPECT_THAT(import_error(folder.write("d.obj", three + "f 1 2 4" + end)),
                AllOf(HasSubstr("line 5"), HasSubstr("vertex 4, but there are 3")));
    // A backslash within a comment does not continue the line.
    EXPECT_EQ(import_mesh(folder.write("e.obj", "# C:\\meshes\\" + end + three + "f 1 2 3" + end))
                  .triangles.size(),
              1u);
  }
}

TEST(Obj, ErrorNamesLineOfInvalidFile) {
  const TemporaryFolder folder;
  auto error = [&](const std::string& text) { return import_error(folder.write("bad.obj", text)); };
  const std::string three = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  EXPECT_THAT(import_error(folder / "none.obj"), HasSubstr("no such file"));
  EXPECT_THAT(error(""), HasSubstr("empty (0 bytes)"));
  EXPECT_THAT(error("# nothing\n"), HasSubstr("no triangles"));
  EXPECT_THAT(error(three + "l 1 2\np 3\n"), HasSubstr("no triangles"));
  EXPECT_THAT(error("v 0 0 0\nv nan 0 0\nv 0 1 0\nf 1 2 3\n"),
              AllOf(HasSubstr("line 2"), HasSubstr("'nan'")));
  EXPECT_THAT(error("v 0 0 inf\n" + three + "f 1 2 3\n"), HasSubstr("not a finite number"));
  EXPECT_THAT(error("v 0 0 1e38\n" + three + "f 1 2 3\n"),
              HasSubstr("'1e38' in a vertex is beyond 1e30"));
  EXPECT_THAT(error("v 0 0 1e999\n" + three + "f 1 2 3\n"), HasSubstr("line 1"));
  EXPECT_THAT(error("v 0 0 12x\n" + three + "f 1 2 3\n"), HasSubstr("'12x'"));
  EXPECT_THAT(error(three + "f 1 2 4\n"),
              AllOf(HasSubstr("line 4"), HasSubstr("vertex 4, but there are 3")));
  EXPECT_THAT(error(three + "f 1 2 -4\n"), HasSubstr("out of range"));
  // tinyobjloader ends the line here and begins another.
  EXPECT_THAT(error(three + "# \rf 1 2 4\n"),
              AllOf(HasSubstr("line 5"), HasSubstr("vertex 4, but there are 3")));
  EXPECT_THAT(error(three + "f 1/1 2/1 3/1\n"), HasSubstr("texture coordinate 1, but there are 0"));
  EXPECT_THAT(error(three + "f 1//9 2//9 3//9\n"), HasSubstr("normal 9"));
  EXPECT_THAT(error(three + "f 0 1 2\n"), HasSubstr("not a face corner"));
  EXPECT_THAT(error(three + "f 1 2 x\n"), HasSubstr("not a face corner"));
  EXPECT_THAT(error(three + "f 1 2 99999999999999999999\n"), HasSubstr("not a face corner"));
  EXPECT_THAT(error(three + "f 1 2 3\nf 1 2"),
              AllOf(HasSubstr("line 5"), HasSubstr("2 corners")));  // truncated
  EXPECT_THAT(error("v 0 0 0\nv 1 0"), HasSubstr("2 numbers instead of 3"));
  EXPECT_THAT(import_error(folder.write("x.stl", "solid")), HasSubstr("not .obj, .gltf or .glb"));
  EXPECT_THAT(import_mesh(folder.write("end.obj", three + "f 1 2 3")).notes,
              Contains(HasSubstr("truncated")));
}

// Every prefix of a file is an error, gives a note, or consists of whole lines, where truncation
// cannot be detected.
TEST(Obj, DetectsTruncationWherePossible) {
  const TemporaryFolder folder;
  const std::string whole = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3\nf 2 3 4\n";
  int errors = 0, noted = 0;
  for (std::size_t size = 1; size < whole.size(); ++size) {
    const fs::path file = folder.write("cut.obj", whole.substr(0, size));
    try {
      const Mesh mesh = import_mesh(file);
      if (whole[size - 1] == '\n') continue;
      EXPECT_THAT(mesh.notes, Contains(HasSubstr("truncated"))) << size;
      ++noted;
    } catch (const spec::FileError&) {
      ++errors;
    }
  }
  EXPECT_EQ(noted, 2) << "the last digits of the two faces";
  EXPECT_GT(errors, 32 + 4);
}

TEST(Obj, CorruptBytesDoNotCrash) {
  const TemporaryFolder folder;
  const std::string good =
      std::string(kSquare) + "vn 0 0 1\nf 1//1 2//1 3//1\nf -4/1/1 -3/2/1 -2/3/1\n";
  Random random(7);
  int rejected = 0;
  for (int i = 0; i < 600; ++i) {
    std::string bytes = good;
    for (int k = 0; k < 2; ++k)
      bytes[random.next() % bytes.size()] = static_cast<char>(random.word());
    try {
      import_mesh(folder.write("fuzz.obj", bytes));
    } catch (const spec::FileError&) {
      ++rejected;
    }
  }
  EXPECT_GT(rejected, 200);
}

TEST(Obj, BoxProjectionFollowsEachFaceNormal) {
  struct Side {
    const char* corners;  // a triangle of the box 0..8, 0..4, 0..2
    std::array<V2d, 3> uv;
  };
  // A scale of half a repeat per unit, from the lowest corner of the box.
  const Side sides[] = {
      {"v 0 4 2\nv 8 4 2\nv 8 4 0\n", {V2d(0, 1), V2d(4, 1), V2d(4, 0)}},     // up
      {"v 0 0 0\nv 8 0 0\nv 8 0 2\n", {V2d(0, 0), V2d(4, 0), V2d(4, 1)}},     // down
      {"v 8 0 2\nv 8 0 0\nv 8 4 0\n", {V2d(-1, 0), V2d(0, 0), V2d(0, -2)}},   // right
      {"v 0 0 0\nv 0 0 2\nv 0 4 2\n", {V2d(0, 0), V2d(1, 0), V2d(1, -2)}},    // left
      {"v 0 0 2\nv 8 0 2\nv 8 4 2\n", {V2d(0, 0), V2d(4, 0), V2d(4, -2)}},    // front
      {"v 8 0 0\nv 0 0 0\nv 0 4 0\n", {V2d(-4, 0), V2d(0, 0), V2d(0, -2)}}};  // back
  const TemporaryFolder folder;
  for (const Side& side : sides) {
    const Mesh mesh = import_mesh(
        folder.write("b.obj", std::string(side.corners) +
                                  "v 0 0 0\nv 8 4 2\nv 0 4 2\nvn 0 0 2\nf 1//1 2//1 3\nf 4 5 6\n"));
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_EQ(corner(mesh, 0, k).uv, side.uv[k]) << side.corners << k;
    EXPECT_EQ(corner(mesh, 0, 0).normal, V3d(0, 0, 1)) << "one unit long";
    EXPECT_THAT(mesh.notes,
                ElementsAre("2 triangles without texture coordinates got a box projection",
                            "4 corners without a normal got their face's"));
  }
}

// The box of the whole mesh, including triangles that have texture coordinates.
TEST(Obj, ProjectionBoxEnclosesWholeMesh) {
  const TemporaryFolder folder;
  const Mesh mesh = import_mesh(folder.write(
      "a.obj",
      "v -4 0 0\nv 12 0 0\nv 0 0 1\nvt 0 0\nf 1/1 2/1 3/1\nv 0 0 0\nv 0 0 8\nv 8 0 0\nf 4 5 6\n"));
  EXPECT_EQ(corner(mesh, 1, 0).uv, V2d(1, 0));
  EXPECT_EQ(corner(mesh, 1, 1).uv, V2d(1, 2));
  EXPECT_EQ(corner(mesh, 1, 2).uv, V2d(3, 0));
}

TEST(Obj, NotesListOmittedStatements) {
  const TemporaryFolder folder;
  const Mesh mesh = import_mesh(
      folder.write("n.obj", std::string("v 9 9 +9\nl 1 2\n") + "usemtl none\n" + kSquare));
  EXPECT_THAT(mesh.notes, Contains("points and lines were left out"));
  EXPECT_EQ(mesh.materials[0].colour, V3d(0.8, 0.8, 0.8));
  EXPECT_EQ(mesh.materials[0].name, "default");
  write_image(folder / "t.png", noise(8, 8));
  folder.write("m.mtl", "newmtl a\nKd 0.5 0.25 0.125\nmap_Kd .\\t.png\n");
  const Mesh named =
      import_mesh(folder.write("m.obj", std::string("mtllib m.mtl\nusemtl a\n") + kSquare));
  EXPECT_EQ(named.textures.at(0).image, noise(8, 8));
  EXPECT_EQ(named.materials.at(0).colour, V3d(0.5, 0.25, 0.125));
}

// Seventeen colours: the last begins a second row of cells of four by four texels.
TEST(Palette, GivesEachPlainMaterialOneCell) {
  Mesh mesh;
  for (int i = 0; i < 17; ++i) {
    mesh.materials.push_back({"m", V3d(i / 16.0, 0.5, 2), -1});
    for (int k = 0; k < 3; ++k) mesh.vertices.push_back({V3d(k, i, 0), V3d(0, 0, 1), V2d(k, k)});
    const auto first = static_cast<std::uint32_t>(3 * i);
    mesh.triangles.push_back({{first, first + 1, first + 2}, static_cast<std::uint32_t>(i)});
  }
  Mesh textured = mesh;
  const Texture wood{"wood", noise(4, 4)};
  texture_everything(textured, &wood);
  ASSERT_EQ(textured.textures.size(), 1u);
  EXPECT_EQ(textured.textures[0].name, "wood");
  EXPECT_EQ(textured.materials[16].texture, 0);
  EXPECT_EQ(textured.materials[16].colour, V3d(1, 0.5, 2)) << "and not in a palette";
  texture_everything(mesh, nullptr);
  ASSERT_EQ(mesh.textures.size(), 1u);
  const Image& palette = mesh.textures[0].image;
  EXPECT_EQ(palette.width, 64);
  EXPECT_EQ(palette.height, 8);
  for (int i = 0; i < 17; ++i) {
    const int left = i % 16 * 4, top = i / 16 * 4;
    const auto red = static_cast<std::uint8_t>(std::lround(255 * std::pow(i / 16.0, 1 / 2.2)));
    for (const auto& [x, y] : {std::pair(0, 0), {3, 0}, {0, 3}, {3, 3}})
      EXPECT_EQ(palette.at(left + x, top + y), (Rgba8{red, 186, 255, 255})) << i;
    EXPECT_EQ(mesh.materials[static_cast<std::size_t>(i)].colour, V3d(1, 1, 1));
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_EQ(corner(mesh, static_cast<std::size_t>(i), k).uv,
                V2d((left + 2) / 64.0, (top + 2) / 8.0));
  }
  EXPECT_EQ(palette.at(4, 4), (Rgba8{255, 255, 255, 255})) << "nobody's";
  EXPECT_EQ(mesh.vertices.size(), 2u * 51);
}

// ---- Files -------------------------------------------------------------------------------------

// Files of the import, relative to the folder; they must equal the list that is obtained without an
// import.
std::vector<std::string> files_of(const TemporaryFolder& folder, const std::string& name,
                                  const ImportOptions& options = {}) {
  std::vector<std::string> files;
  for (const fs::path& file : import_mesh(folder / name, options).files)
    files.push_back(fs::relative(file.parent_path(), folder.path()) / file.filename());
  std::vector<std::string> listed;
  for (const fs::path& file : mesh_files(folder / name, options))
    listed.push_back(fs::relative(file.parent_path(), folder.path()) / file.filename());
  EXPECT_EQ(files, listed);
  for (std::string& file : files)
    if (file.starts_with("./")) file.erase(0, 2);
  return files;
}

TEST(MeshFiles, ListFilesOfObj) {
  const TemporaryFolder folder;
  fs::create_directories(folder / "sub folder");
  write_image(folder / "wood grain.png", noise(8, 8));
  folder.write("sub folder/my b.mtl", "newmtl b\nmap_Kd sub folder/../wood grain.png\n");
  folder.write("a.mtl",
               "newmtl a\nmap_Kd -s 2 2 1 wood grain.png\nnewmtl again\nmap_Kd wood grain.png\n"
               "map_Bump other.png\nnewmtl plain\n");
  folder.write("plain.obj", kSquare);
  EXPECT_THAT(files_of(folder, "plain.obj"), ElementsAre("plain.obj"));
  // The first existing name of a line is used; a trailing blank is not part of it.
  folder.write("m.obj", std::string("mtllib none.mtl a.mtl a.mtl \n  mtllib\tgone.mtl \r"
                                    "mtllib sub\\ folder/my\\ b.mtl\nmtllib a.mtl\nusemtl b\n") +
                            kSquare);
  const auto with_textures = ElementsAre("m.obj", "none.mtl", "a.mtl", "gone.mtl",
                                         "sub folder/my b.mtl", "wood grain.png", "wood grain.png");
  EXPECT_THAT(files_of(folder, "m.obj"), with_textures) << "by two names";
  EXPECT_THAT(files_of(folder, "m.obj", {.textures = false}),
              ElementsAre("m.obj", "none.mtl", "a.mtl", "gone.mtl", "sub folder/my b.mtl"));
  // Once a file of a missing name exists, the mesh differs.
  folder.write("none.mtl", "newmtl b\n");
  EXPECT_THAT(files_of(folder, "m.obj"),
              ElementsAre("m.obj", "none.mtl", "gone.mtl", "sub folder/my b.mtl", "a.mtl",
                          "wood grain.png", "wood grain.png"));
}

TEST(MeshFiles, ListFilesOfRejectedObj) {
  const TemporaryFolder folder;
  const auto names = [&](const std::string& name) {
    std::vector<std::string> found;
    for (const fs::path& file : mesh_files(folder / name)) found.push_back(file.filename());
    return found;
  };
  EXPECT_THAT(names("none.obj"), ElementsAre("none.obj"));
  EXPECT_THAT(names("picture.png"), ElementsAre()) << "no import opens it";
  folder.write("m.mtl", "newmtl a\nmap_Kd none.png\n");
  folder.write("m.obj", std::string("mtllib m.mtl\nusemtl a\n") + kSquare);
  EXPECT_THAT(import_error(folder / "m.obj"), HasSubstr("none.png"));
  EXPECT_THAT(names("m.obj"), ElementsAre("m.obj", "m.mtl", "none.png"));
  // An unreadable file is not a missing file; opening a pipe would block.
  fs::remove(folder / "m.mtl");
  ASSERT_EQ(::mkfifo((folder / "m.mtl").c_str(), 0600), 0);
  EXPECT_THAT(import_error(folder / "m.obj"),
              AllOf(HasSubstr("m.mtl"), HasSubstr("not a regular file")));
  EXPECT_THAT(names("m.obj"), ElementsAre("m.obj", "m.mtl"));
}

TEST(MeshFiles, CacheTheirFiles) {
  const TemporaryFolder folder;
  folder.write("m.obj", std::string("mtllib m.mtl\n") + kSquare);
  MeshFiles files;
  EXPECT_EQ(files.of(folder / "m.obj", {}).size(), 2u);
  folder.write("m.obj", kSquare);
  EXPECT_EQ(files.of(folder / "m.obj", {}).size(), 2u) << "a process has looked before";
  EXPECT_EQ(files.of(folder / "m.obj", {.textures = false}).size(), 1u);
  EXPECT_EQ(MeshFiles().of(folder / "m.obj", {}).size(), 1u);
}

TEST(MeshFiles, ListFilesOfScenes) {
  const TemporaryFolder folder;
  MeshFiles meshes;
  folder.write("m.obj", std::string("mtllib m.mtl\n") + kSquare);
  folder.write("m.mtl", "newmtl a\nmap_Kd t.png\n");
  for (const char* name : {"t.png", "u.png"}) write_image(folder / name, noise(4, 4));
  const std::string mesh = folder / "m.obj", texture = folder / "u.png";
  std::vector<std::string> sources = {mesh};
  for (const SceneName& scene : scene_names()) sources.emplace_back(scene.name);
  for (const std::string& source : sources)
    for (const std::string& wanted : {std::string(), std::string("brick"), texture}) {
      SCOPED_TRACE(source + " " + wanted);
      const SceneOptions options{.texture = wanted, .texture_size = 16};
      EXPECT_EQ(scene_files(source, options, meshes), load_scene(source, options).mesh.files);
    }
  EXPECT_EQ(scene_files(mesh, {}, meshes).size(), 3u);
  EXPECT_EQ(scene_files(mesh, {.texture = texture}, meshes).size(), 3u) << "instead of the mesh's";
  EXPECT_EQ(scene_files("cube", {.texture = texture}, meshes).size(), 0u);
  EXPECT_EQ(scene_files("plane", {.texture = texture}, meshes).size(), 1u);
}

// ---- glTF ---------------------------------------------------------------------------------------

// Builds files piece by piece; the defaults are one textured triangle.
struct GltfFile {
  std::string binary;
  std::string nodes = R"([{"mesh":0}])";
  std::string extra;
  std::string material = R"({"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}})";
  std::string image = R"({"uri":"wood.png"})";
  std::string primitive =
      R"({"attributes":{"POSITION":0,"TEXCOORD_0":1},"indices":2,"material":0})";
  std::string textures = R"([{"source":0,"sampler":0}])";
  std::string accessors;  // after the first three, each with a comma before it
  std::string mesh = "";  // members of the mesh, each with a comma before it
  std::string indices = R"("bufferView":2,"componentType":5123,"type":"SCALAR")";
  int index_count = 3;

  template <class Value>
  void append(std::initializer_list<Value> values) {
    for (const Value value : values)
      binary.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  GltfFile() {
    append<float>({0, 0, 0, 1, 0, 0, 0, 1, 0});  // 36 bytes
    append<float>({0, 0, 1, 0, 0, 1});           // 24
    append<std::uint16_t>({0, 1, 2, 0});         // 8
  }
  std::string json(const std::string& uri) const {
    const std::string length = std::to_string(binary.size());
    return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":)" + nodes +
           R"(,"meshes":[{"primitives":[)" + primitive + R"(])" + mesh + R"(}],"materials":[)" +
           material + R"(],"textures":)" + textures +
           R"(,"samplers":[{"wrapS":33648,"wrapT":33071}],"images":[)" + image + R"(],"accessors":[
             {"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"},
             {"bufferView":1,"componentType":5126,"count":3,"type":"VEC2"},
             {)" +
           indices + R"(,"count":)" + std::to_string(index_count) + "}" + accessors +
           R"(],"bufferViews":[
             {"buffer":0,"byteOffset":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":24},
             {"buffer":0,"byteOffset":60,"byteLength":8},
             {"buffer":0,"byteOffset":68,"byteLength":)" +
           std::to_string(std::max<std::size_t>(binary.size() - 68, 1)) +
           R"(},
             {"buffer":0,"byteOffset":60,"byteLength":12}],"buffers":[{"byteLength":)" +
           length + (uri.empty() ? "" : R"(,"uri":")" + uri + "\"") + "}]" + extra + "}";
  }
  std::string glb() const { return glb_of(json(""), std::string("BIN\0", 4), binary); }
  static std::string glb_of(std::string text, const std::string& type, std::string data) {
    while (text.size() % 4 != 0) text += ' ';
    while (data.size() % 4 != 0) data += '\0';
    auto word = [](std::size_t value) {
      std::string bytes(4, '\0');
      for (std::size_t i = 0; i < 4; ++i) bytes[i] = static_cast<char>(value >> (8 * i));
      return bytes;
    };
    return "glTF" + word(2) + word(28 + text.size() + data.size()) + word(text.size()) + "JSON" +
           text + word(data.size()) + type + data;
  }
};

TEST(Gltf, ReadsExternalBufferAndTexture) {
  const TemporaryFolder folder;
  const GltfFile file;
  folder.write("t.bin", file.binary);
  write_image(folder / "wood.png", noise(8, 4));
  const Mesh mesh = import_mesh(folder.write("t.gltf", file.json("t.bin")));
  ASSERT_EQ(mesh.triangles.size(), 1u);
  EXPECT_EQ(corner(mesh, 0, 1).position, V3d(1, 0, 0));
  EXPECT_EQ(corner(mesh, 0, 1).uv, V2d(1, 0));  // not flipped
  EXPECT_EQ(corner(mesh, 0, 0).normal, V3d(0, 0, 1));
  ASSERT_EQ(mesh.textures.size(), 1u);
  EXPECT_EQ(mesh.textures[0].image, noise(8, 4));
  EXPECT_EQ(mesh.textures[0].wrap_s, spec::texture::Wrap::kMirroredRepeat);
  EXPECT_EQ(mesh.textures[0].wrap_t, spec::texture::Wrap::kClampToEdge);
}

TEST(MeshFiles, ListFilesOfGltf) {
  const TemporaryFolder folder;
  GltfFile file;
  folder.write("t b.bin", file.binary);
  write_image(folder / "wood grain.png", noise(8, 4));
  file.image = R"({"uri":"wood%20grain.png"},{"uri":"wood%20grain.png"},{"uri":"none.png"})";
  folder.write("t.gltf", file.json("t%20b.bin"));
  // A missing file is also searched for in the current folder.
  EXPECT_THAT(import_mesh(folder / "t.gltf").files,
              ElementsAre(folder / "t.gltf", folder / "t b.bin", folder / "wood grain.png",
                          folder / "none.png", fs::path("none.png")));
  EXPECT_EQ(mesh_files(folder / "t.gltf"), import_mesh(folder / "t.gltf").files);
  EXPECT_EQ(mesh_files(folder / "t.gltf", {.textures = false}),
            import_mesh(folder / "t.gltf", {.textures = false}).files);
  file.image = R"({"uri":"wood grain.png"})";
  folder.write("t.glb", file.glb());
  EXPECT_THAT(files_of(folder, "t.glb"), ElementsAre("t.glb", "wood grain.png"));
  file.image = R"({"uri":"data:image/png;base64,AAAA"})";
  file.material = "{}";
  folder.write("inside.glb", file.glb());
  EXPECT_THAT(files_of(folder, "inside.glb"), ElementsAre("inside.glb"));
  folder.write("gone.gltf", file.json("gone.bin"));
  EXPECT_THAT(mesh_files(folder / "gone.gltf"),
              ElementsAre(folder / "gone.gltf", folder / "gone.bin", fs::path("gone.bin")));
  fs::remove(folder / "t b.bin");
  ASSERT_EQ(::mkfifo((folder / "t b.bin").c_str(), 0600), 0);
  EXPECT_THAT(import_error(folder / "t.gltf"),
              AllOf(HasSubstr("t b.bin"), HasSubstr("not a regular file")));
}

TEST(Gltf, ReadsEmbeddedTexture) {
  const TemporaryFolder folder;
  write_image(folder / "e.png", gradient(8, 8));
  GltfFile file;
  file.binary += test::read_bytes(folder / "e.png");
  file.image = R"({"bufferView":3,"mimeType":"image/png","name":"inside"})";
  const Mesh mesh = import_mesh(folder.write("t.glb", file.glb()));
  ASSERT_EQ(mesh.textures.size(), 1u);
  EXPECT_EQ(mesh.textures[0].name, "inside");
  EXPECT_EQ(mesh.textures[0].image, gradient(8, 8));
}

TEST(Gltf, MirroringNodesKeepFacesOutward) {
  const TemporaryFolder folder;
  write_image(folder / "wood.png", noise(4, 4));
  GltfFile file;
  // Parent: two up. Child: scaled by (2, 1, 1), rotated by 90 degrees about z, moved by x + 5.
  file.nodes =
      R"([{"children":[1],"matrix":[1,0,0,0, 0,1,0,0, 0,0,1,0, 0,2,0,1]},
          {"mesh":0,"scale":[2,1,1],"rotation":[0,0,0.70710678118,0.70710678118],"translation":[5,0,0]}])";
  Mesh mesh = import_mesh(folder.write("n.glb", file.glb()));
  EXPECT_NEAR((corner(mesh, 0, 0).position - V3d(5, 2, 0)).length(), 0, 1e-9);
  EXPECT_NEAR((corner(mesh, 0, 1).position - V3d(5, 4, 0)).length(), 0, 1e-9);
  EXPECT_NEAR((corner(mesh, 0, 2).position - V3d(4, 2, 0)).length(), 0, 1e-9);
  EXPECT_NEAR((corner(mesh, 0, 0).normal - V3d(0, 0, 1)).length(), 0, 1e-9);
  file.nodes = R"([{"mesh":0,"scale":[-1,1,1]}])";
  mesh = import_mesh(folder.write("m.glb", file.glb()));
  const V3d face = (corner(mesh, 0, 1).position - corner(mesh, 0, 0).position)
                       .cross(corner(mesh, 0, 2).position - corner(mesh, 0, 0).position);
  EXPECT_GT(face.z, 0);
}

// By hand: (x, y, z) becomes (1.2 x - 2.4 y + 1, 6.4 x + 7.2 y + 8, 10 z + 6), and a normal is
// transformed by the transposed inverse of that matrix.
TEST(Gltf, UnequalScalesTransformPointsAndNormals) {
  const TemporaryFolder folder;
  write_image(folder / "wood.png", noise(4, 4));
  GltfFile file;
  file.append<float>({1, 2, 3, 4, -5, 6, -7, 8, 9});  // positions
  file.append<float>({2, 3, 6, 6, -3, 2, -2, 6, 3});  // normals
  file.accessors = R"(,{"bufferView":3,"componentType":5126,"count":3,"type":"VEC3"},
      {"bufferView":3,"byteOffset":36,"componentType":5126,"count":3,"type":"VEC3"})";
  file.primitive = R"({"attributes":{"POSITION":3,"NORMAL":4},"indices":2,"material":0})";
  // The child's rotation about z has cosine 0.6 and sine 0.8.
  file.nodes = R"([{"children":[1],"scale":[1,4,2]},{"mesh":0,"scale":[2,3,5],"translation":[1,2,3],
      "rotation":[0,0,0.4472135954999579,0.8944271909999159]}])";
  const Mesh mesh = import_mesh(folder.write("n.glb", file.glb()));
  const V3d positions[] = {{-2.6, 28.8, 36}, {17.8, -2.4, 66}, {-26.6, 20.8, 96}};
  const V3d normals[] = {{-0.2, 0.35, 0.6}, {2.6, 0.45, 0.2}, {-2.2, 0.1, 0.3}};
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR((corner(mesh, 0, k).position - positions[k]).length(), 0, 1e-9) << k;
    EXPECT_NEAR((corner(mesh, 0, k).normal - normals[k].normalized()).length(), 0, 1e-9) << k;
  }
}

// By hand: u' = offset + cos u + sin v, v' = offset - sin u + cos v, with (u, v) already scaled.
TEST(Gltf, TextureTransformScalesRotatesAndMoves) {
  const TemporaryFolder folder;
  write_image(folder / "wood.png", noise(4, 4));
  GltfFile file;
  file.extra =
      R"(,"extensionsUsed":["KHR_texture_transform"],"extensionsRequired":["KHR_texture_transform"])";
  const auto expect_uv = [&](const std::string& transform, const V2d& a, const V2d& b,
                             const V2d& c) {
    SCOPED_TRACE(transform);
    file.material =
        R"({"pbrMetallicRoughness":{"baseColorTexture":{"index":0,"extensions":{"KHR_texture_transform":{)" +
        transform + "}}}}}";
    const Mesh mesh = import_mesh(folder.write("t.glb", file.glb()));
    EXPECT_NEAR((corner(mesh, 0, 0).uv - a).length(), 0, 1e-9);
    EXPECT_NEAR((corner(mesh, 0, 1).uv - b).length(), 0, 1e-9);  // of (1, 0)
    EXPECT_NEAR((corner(mesh, 0, 2).uv - c).length(), 0, 1e-9);  // of (0, 1)
  };
  // The example of the extension: the lower left quadrant, 0 <= u <= 0.5 <= v <= 1.
  expect_uv(R"("offset":[0,1],"rotation":1.5707963267948966,"scale":[0.5,0.5])", {0, 1}, {0, 0.5},
            {0.5, 1});
  expect_uv(R"("offset":[0.25,0.5],"scale":[2,4],"rotation":1.5707963267948966)", {0.25, 0.5},
            {0.25, -1.5}, {4.25, 0.5});
  // An angle of cosine 0.6 and sine 0.8.
  expect_uv(R"("offset":[0.25,0.5],"scale":[2,4],"rotation":0.9272952180016122)", {0.25, 0.5},
            {1.45, -1.1}, {3.45, 2.9});
  expect_uv(R"("offset":[0.25,0.5])", {0.25, 0.5}, {1.25, 0.5}, {0.25, 1.5});
  expect_uv(R"("scale":[2,4])", {0, 0}, {2, 0}, {0, 4});
  // Coordinates other than the material's.
  file.append<float>({3, 5, 7, 11, 13, 17});
  file.accessors = R"(,{"bufferView":3,"componentType":5126,"count":3,"type":"VEC2"})";
  file.primitive =
      R"({"attributes":{"POSITION":0,"TEXCOORD_0":1,"TEXCOORD_1":3},"indices":2,"material":0})";
  expect_uv(R"("texCoord":1,"scale":[1,2])", {3, 10}, {7, 22}, {13, 34});
}

// The transform's texCoord replaces that of the texture, but only where it is given.
TEST(Gltf, TextureTransformMayReplaceTexCoord) {
  const TemporaryFolder folder;
  write_image(folder / "wood.png", noise(4, 4));
  GltfFile file;
  file.append<float>({3, 5, 7, 11, 13, 17});
  file.accessors = R"(,{"bufferView":3,"componentType":5126,"count":3,"type":"VEC2"})";
  file.primitive =
      R"({"attributes":{"POSITION":0,"TEXCOORD_0":1,"TEXCOORD_1":3},"indices":2,"material":0})";
  for (const bool glossy : {false, true})
    for (const auto& [transform, second] : {std::pair("", true), {R"("texCoord":0)", false}}) {
      const std::string use =
          std::string(R"({"index":0,"texCoord":1,"extensions":{"KHR_texture_transform":{)") +
          transform + "}}}";
      file.material =
          glossy ? R"({"extensions":{"KHR_materials_pbrSpecularGlossiness":{"diffuseTexture":)" +
                       use + "}}}"
                 : R"({"pbrMetallicRoughness":{"baseColorTexture":)" + use + "}}";
      EXPECT_EQ(corner(import_mesh(folder.write("t.glb", file.glb())), 0, 2).uv,
                second ? V2d(13, 17) : V2d(0, 1));
    }
}

TEST(Gltf, MorphTargetsMoveByTheirWeights) {
  const TemporaryFolder folder;
  write_image(folder / "wood.png", noise(4, 4));
  GltfFile file;
  file.append<float>({0, 0, 2, 0, 0, 4, 0, 0, 8});    // accessor 3
  file.append<float>({0, 2, 0, 0, 0, 0, 0, 0, -16});  // accessor 4
  file.append<float>({4, 0, 0});                      // accessor 5: of vertex 2 only
  file.append<std::uint16_t>({2, 0});
  file.accessors = R"(,{"bufferView":3,"componentType":5126,"count":3,"type":"VEC3"},
      {"bufferView":3,"byteOffset":36,"componentType":5126,"count":3,"type":"VEC3"},
      {"componentType":5126,"count":3,"type":"VEC3","sparse":{"count":1,
        "indices":{"bufferView":3,"byteOffset":84,"componentType":5123},
        "values":{"bufferView":3,"byteOffset":72}}})";
  const auto primitive = [](const std::string& first, const std::string& second) {
    return R"({"attributes":{"POSITION":0,"NORMAL":3,"TEXCOORD_0":1},"indices":2,"material":0,"targets":[)" +
           first + "," + second + "]}";
  };
  file.primitive = primitive(R"({"POSITION":3,"NORMAL":4,"TEXCOORD_0":1})", R"({"POSITION":5})");
  file.mesh = R"(,"weights":[0.5,0.25])";
  const auto expect_positions = [&](const V3d& a, const V3d& b, const V3d& c) {
    const Mesh mesh = import_mesh(folder.write("m.glb", file.glb()));
    EXPECT_EQ(corner(mesh, 0, 0).position, a);
    EXPECT_EQ(corner(mesh, 0, 1).position, b);
    EXPECT_EQ(corner(mesh, 0, 2).position, c);
    return mesh;
  };
  const Mesh mesh = expect_positions({0, 0, 1}, {1, 0, 2}, {1, 1, 4});
  EXPECT_EQ(corner(mesh, 0, 1).uv, V2d(1.5, 0));
  // (0, 0, 2) plus half of (0, 2, 0); (0, 0, 8) plus half of (0, 0, -16) has length 0.
  EXPECT_NEAR((corner(mesh, 0, 0).normal - V3d(0, 1, 2) / std::sqrt(5.0)).length(), 0, 1e-12);
  file.nodes = R"([{"mesh":0,"weights":[0,1]}])";
  expect_positions({0, 0, 0}, {1, 0, 0}, {4, 1, 0});
  file.nodes = R"([{"mesh":0,"weights":[1]}])";
  EXPECT_EQ(corner(expect_positions({0, 0, 2}, {1, 0, 4}, {0, 1, 8}), 0, 2).normal, V3d(0, 0, -1));
  file.nodes = R"([{"mesh":0}])";
  file.mesh = "";
  expect_positions({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  file.mesh = R"(,"weights":[0.5])";
  file.primitive = primitive(R"({"POSITION":1})", "{}");
  EXPECT_THAT(import_error(folder.write("e.glb", file.glb())), HasSubstr("wrong type"));
  file.accessors += R"(,{"bufferView":3,"componentType":5126,"count":2,"type":"VEC3"})";
  file.primitive = primitive(R"({"POSITION":6})", "{}");
  EXPECT_THAT(import_error(folder.write("e.glb", file.glb())),
              HasSubstr("morph target 0 has 2 elements for POSITION, its primitive 3"));
}

TEST(Gltf, SparseAccessorsReplaceElements) {
  const TemporaryFolder folder;
  write_image(folder / "wood.png", noise(4, 4));
  GltfFile file;
  file.append<float>({5, 6, 7, 8, 9, 10});
  file.append<std::uint8_t>({0, 2, 0, 0});
  const auto sparse = [](const std::string& base, const std::string& offset) {
    return R"(,{)" + base + R"("componentType":5126,"count":3,"type":"VEC3","sparse":{"count":2,
        "indices":{"bufferView":3,"byteOffset":)" +
           offset + R"(,"componentType":5121},"values":{"bufferView":3}}})";
  };
  file.primitive = R"({"attributes":{"POSITION":3},"indices":2})";
  file.accessors = sparse(R"("bufferView":0,)", "24");
  const Mesh replaced = import_mesh(folder.write("s.glb", file.glb()));
  EXPECT_EQ(corner(replaced, 0, 0).position, V3d(5, 6, 7));
  EXPECT_EQ(corner(replaced, 0, 1).position, V3d(1, 0, 0));
  EXPECT_EQ(corner(replaced, 0, 2).position, V3d(8, 9, 10));
  file.accessors = sparse("", "24");
  const Mesh zeros = import_mesh(folder.write("z.glb", file.glb()));
  EXPECT_EQ(corner(zeros, 0, 1).position, V3d(0, 0, 0));
  EXPECT_EQ(corner(zeros, 0, 2).position, V3d(8, 9, 10));
  EXPECT_THAT(zeros.notes, Not(Contains(HasSubstr("buffer view"))));
  file.accessors = sparse("", "27");  // its second index is outside the buffer view
  EXPECT_THAT(import_error(folder.write("e.glb", file.glb())), HasSubstr("reaches beyond"));
  file.binary[92] = 3;
  file.accessors = sparse("", "24");
  EXPECT_THAT(import_error(folder.write("e.glb", file.glb())),
              HasSubstr("accessor 3 has 3 elements, but a sparse element has index 3"));
}

TEST(Gltf, AccessorWithoutBufferViewIsZero) {
  const TemporaryFolder folder;
  write_image(folder / "wood.png", noise(4, 4));
  GltfFile file;
  file.accessors = R"(,{"componentType":5126,"count":3,"type":"VEC2"})";
  file.primitive = R"({"attributes":{"POSITION":0,"TEXCOORD_0":3},"indices":2,"material":0})";
  const Mesh mesh = import_mesh(folder.write("z.glb", file.glb()));
  for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(corner(mesh, 0, k).uv, V2d(0, 0));
  EXPECT_THAT(mesh.notes, Contains("accessors without a buffer view, which are all zeros: 3"));
  file.accessors = R"(,{"componentType":5126,"count":4000000000,"type":"VEC2"})";
  EXPECT_THAT(import_error(folder.write("e.glb", file.glb())),
              HasSubstr("accessor 3 has 4000000000 elements without a buffer view"));
}

TEST(Gltf, EveryInstanceIsDrawn) {
  const TemporaryFolder folder;
  write_image(folder / "wood.png", noise(4, 4));
  GltfFile file;
  file.append<float>({0, 0, 0, 10, 0, 0, 0, 0, 0});  // translations
  file.append<float>({1, 1, 1, 2, 3, 1, -1, 1, 1});  // scales
  file.append<std::int16_t>({0, 0, 0, 32767, 0, 0, 32767, 32767, 0, 0, 0, 32767});
  file.accessors = R"(,{"bufferView":3,"componentType":5126,"count":3,"type":"VEC3"},
      {"bufferView":3,"byteOffset":36,"componentType":5126,"count":3,"type":"VEC3"},
      {"bufferView":3,"byteOffset":72,"componentType":5122,"normalized":true,"count":3,"type":"VEC4"},
      {"bufferView":3,"componentType":5126,"count":2,"type":"SCALAR"})";
  const auto nodes = [](const std::string& attributes) {
    return R"([{"mesh":0,"scale":[2,2,2],"translation":[0,0,5],"extensions":{"EXT_mesh_gpu_instancing":
        {"attributes":{)" +
           attributes + "}}}}]";
  };
  file.extra = R"(,"extensionsRequired":["EXT_mesh_gpu_instancing"])";
  file.nodes = nodes(R"("TRANSLATION":3,"SCALE":4,"ROTATION":5)");
  const Mesh mesh = import_mesh(folder.write("i.glb", file.glb()));
  ASSERT_EQ(mesh.triangles.size(), 3u);
  EXPECT_EQ(corner(mesh, 0, 1).position, V3d(2, 0, 5));
  // Scaled, rotated by 90 degrees about z, moved by 10; then the node's transform.
  EXPECT_NEAR((corner(mesh, 1, 1).position - V3d(20, 4, 5)).length(), 0, 1e-9);
  EXPECT_NEAR((corner(mesh, 1, 2).position - V3d(14, 0, 5)).length(), 0, 1e-9);
  EXPECT_EQ(corner(mesh, 2, 1).position, V3d(0, 2, 5));  // mirrored: corners 1 and 2 are swapped
  EXPECT_EQ(corner(mesh, 2, 2).position, V3d(-2, 0, 5));
  file.nodes = nodes(R"("_ID":3)");
  EXPECT_EQ(import_mesh(folder.write("j.glb", file.glb())).triangles.size(), 3u);
  file.nodes = nodes(R"("TRANSLATION":3,"_ID":6)");
  EXPECT_THAT(import_error(folder.write("e.glb", file.glb())), HasSubstr("have 3 and 2 elements"));
  file.nodes = nodes("");
  EXPECT_THAT(import_error(folder.write("e.glb", file.glb())), HasSubstr("no attributes"));
  file.accessors = R"(,{"componentType":5126,"count":4000000000,"type":"VEC3"})";
  file.nodes = nodes(R"("TRANSLATION":3,"SCALE":3)");
  EXPECT_THAT(import_error(folder.write("e.glb", file.glb())),
              HasSubstr("a node has 4000000000 instances, at most 1000000 are drawn"));
}

TEST(Gltf, HiddenNodesAreOmitted) {
  const TemporaryFolder folder;
  write_image(folder / "wood.png", noise(4, 4));
  GltfFile file;
  const auto nodes = [](const std::string& visible) {
    return R"([{"mesh":0,"children":[1]},{"children":[2],"extensions":{"KHR_node_visibility":)" +
           visible + R"(}},{"mesh":0,"translation":[0,0,1]}])";
  };
  const auto drawn = [&](const std::string& visible) {
    file.nodes = nodes(visible);
    return import_mesh(folder.write("v.glb", file.glb()));
  };
  EXPECT_EQ(drawn(R"({"visible":true})").triangles.size(), 2u);
  EXPECT_EQ(drawn("{}").triangles.size(), 2u);
  EXPECT_THAT(drawn("{}").notes, Not(Contains(HasSubstr("hidden"))));
  EXPECT_EQ(drawn(R"({"visible":false})").triangles.size(), 1u);
  EXPECT_THAT(drawn(R"({"visible":false})").notes,
              Contains("hidden nodes and their children were left out"));
  file.nodes = R"([{"mesh":0,"extensions":{"KHR_node_visibility":{"visible":false}}}])";
  EXPECT_THAT(import_error(folder.write("v.glb", file.glb())), HasSubstr("are hidden"));
}

TEST(Gltf, UnsupportedOptionalExtensionsGiveNotes) {
  const TemporaryFolder folder;
  write_image(folder / "wood.png", noise(4, 4));
  GltfFile file;
  file.extra =
      R"(,"extensionsUsed":["KHR_lights_punctual","KHR_texture_transform","KHR_materials_unlit"])";
  file.nodes = R"([{"mesh":0,"extensions":{"ACME_of_its_own":{}}}])";
  EXPECT_THAT(import_mesh(folder.write("o.glb", file.glb())).notes,
              Contains("unsupported extensions were ignored: ACME_of_its_own, KHR_lights_punctual, "
                       "KHR_materials_unlit"));
  file.extra = R"(,"extensionsUsed":["KHR_texture_transform"])";
  file.nodes = R"([{"mesh":0}])";
  EXPECT_THAT(import_mesh(folder.write("o.glb", file.glb())).notes,
              Not(Contains(HasSubstr("extensions"))));
}

TEST(Gltf, UnsupportedRequiredExtensionsAreErrors) {
  const TemporaryFolder folder;
  write_image(folder / "wood.png", noise(4, 4));
  GltfFile file;
  for (const std::string name : {"KHR_draco_mesh_compression", "EXT_meshopt_compression",
                                 "KHR_texture_basisu", "KHR_materials_clearcoat", "ACME_x"}) {
    file.extra = R"(,"extensionsRequired":["KHR_texture_transform",")" + name + R"("])";
    const auto named = HasSubstr("requires the extension " + name);
    EXPECT_THAT(import_error(folder.write("r.glb", file.glb())), named);
    // Where tinygltf fails first: indices without a buffer view, a buffer without a URI.
    file.indices = R"("componentType":5123,"type":"SCALAR")";
    EXPECT_THAT(import_error(folder.write("r.glb", file.glb())), named);
    file.indices = GltfFile().indices;
    EXPECT_THAT(import_error(folder.write("r.gltf", file.json(""))), named);
  }
  for (const std::string name :
       {"KHR_texture_transform", "KHR_mesh_quantization", "KHR_node_visibility", "EXT_texture_webp",
        "KHR_materials_pbrSpecularGlossiness", "KHR_materials_unlit"}) {
    file.extra = R"(,"extensionsRequired":[")" + name + R"("])";
    EXPECT_EQ(import_mesh(folder.write("r.glb", file.glb())).triangles.size(), 1u) << name;
  }
  // Used, but not declared as required.
  file.extra = R"(,"extensionsUsed":["KHR_draco_mesh_compression"])";
  EXPECT_THAT(import_error(folder.write("r.gltf", file.json(""))),
              HasSubstr("KHR_draco_mesh_compression is not supported, or"));
  file.accessors = R"(,{"componentType":5126,"count":3,"type":"VEC3"})";
  file.primitive =
      R"({"attributes":{"POSITION":3},"indices":2,"extensions":{"KHR_draco_mesh_compression":{}}})";
  EXPECT_THAT(import_error(folder.write("r.glb", file.glb())),
              HasSubstr("its positions only in KHR_draco_mesh_compression"));
}

TEST(Gltf, TextureTakesItsImageFromExtension) {
  const TemporaryFolder folder;
  write_image(folder / "wood.png", noise(4, 4));
  write_image(folder / "other.png", gradient(8, 8));
  GltfFile file;
  file.image = R"({"uri":"wood.png"},{"uri":"other.png"})";
  const auto texture = [&](const std::string& text) {
    file.textures = "[" + text + "]";
    return import_mesh(folder.write("t.glb", file.glb())).textures.at(0).image;
  };
  EXPECT_EQ(texture(R"({"extensions":{"EXT_texture_webp":{"source":1}}})"), gradient(8, 8));
  EXPECT_EQ(texture(R"({"source":0,"extensions":{"EXT_texture_webp":{"source":1}}})"),
            gradient(8, 8));
  EXPECT_EQ(texture(R"({"extensions":{"MSFT_texture_dds":{"source":1}}})"), gradient(8, 8));
  EXPECT_EQ(texture(R"({"source":0,"extensions":{"MSFT_texture_dds":{"source":1}}})"), noise(4, 4));
  EXPECT_EQ(texture(R"({"source":0,"extensions":{"KHR_texture_basisu":{"source":1}}})"),
            noise(4, 4));
  const auto error = [&](const std::string& text) {
    file.textures = "[" + text + "]";
    return import_error(folder.write("t.glb", file.glb()));
  };
  EXPECT_THAT(error(R"({"extensions":{"KHR_texture_basisu":{"source":1}}})"),
              HasSubstr("texture 0 has an image only in KHR_texture_basisu"));
  EXPECT_THAT(error(R"({"sampler":0})"), HasSubstr("texture 0 has no image"));
  EXPECT_THAT(error(R"({"extensions":{"EXT_texture_webp":{"source":2}}})"), HasSubstr("image 2"));
  // Two texels, red and blue, as Pillow writes them without loss.
  file.image =
      R"({"uri":"data:image/webp;base64,UklGRh4AAABXRUJQVlA4TBEAAAAvAQAAAA8Q87//8x8OMqL/AQA="})";
  Image two(2, 1);
  two.pixels = {{255, 0, 0, 255}, {0, 0, 255, 255}};
  EXPECT_EQ(texture(R"({"extensions":{"EXT_texture_webp":{"source":0}}})"), two);
  EXPECT_THAT(files_of(folder, "t.glb"), ElementsAre("t.glb"));
}

TEST(Gltf, SpecularGlossinessDiffuseIsTheColour) {
  const TemporaryFolder folder;
  write_image(folder / "wood.png", noise(4, 4));
  GltfFile file;
  file.material = R"({"pbrMetallicRoughness":{"baseColorFactor":[0,0,0,1]},"extensions":
      {"KHR_materials_pbrSpecularGlossiness":{"diffuseFactor":[0.25,0.5,0.75,1],"diffuseTexture":{
        "index":0,"extensions":{"KHR_texture_transform":{"offset":[0.25,0.5]}}}}}})";
  const Mesh mesh = import_mesh(folder.write("s.glb", file.glb()));
  ASSERT_EQ(mesh.textures.size(), 1u);
  EXPECT_EQ(mesh.textures[0].image, noise(4, 4));
  EXPECT_EQ(mesh.materials[0].colour, V3d(0.25, 0.5, 0.75));
  EXPECT_EQ(corner(mesh, 0, 1).uv, V2d(1.25, 0.5));
  file.material = R"({"extensions":{"KHR_materials_pbrSpecularGlossiness":{}}})";
  EXPECT_EQ(import_mesh(folder.write("d.glb", file.glb())).materials[0].colour, V3d(1, 1, 1));
}

TEST(Gltf, IncompleteTriangleGivesNote) {
  const TemporaryFolder folder;
  write_image(folder / "wood.png", noise(4, 4));
  GltfFile file;
  file.append<std::uint16_t>({1, 2});  // 0 1 2 0 1 2
  const std::string two = "2 corners after the last whole triangle of a primitive were left out";
  for (const auto& [mode, count, triangles, note] :
       {std::tuple(4, 3, 1u, false), {4, 5, 1u, true}, {5, 4, 2u, false}, {6, 4, 2u, false}}) {
    file.index_count = count;
    file.indices = R"("bufferView":2,"componentType":5123,"type":"SCALAR")";
    if (count > 4) file.indices = R"("bufferView":4,"componentType":5123,"type":"SCALAR")";
    file.primitive = R"({"attributes":{"POSITION":0,"TEXCOORD_0":1},"indices":2,"mode":)" +
                     std::to_string(mode) + "}";
    const Mesh mesh = import_mesh(folder.write("c.glb", file.glb()));
    EXPECT_EQ(mesh.triangles.size(), triangles) << mode << ' ' << count;
    EXPECT_EQ(std::count_if(mesh.notes.begin(), mesh.notes.end(),
                            [&](const std::string& text) { return text.starts_with(two); }),
              note ? 1 : 0);
  }
}

TEST(Gltf, UnsupportedFeaturesGiveNotes) {
  const TemporaryFolder folder;
  write_image(folder / "wood.png", noise(4, 4));
  GltfFile file;
  file.extra = R"(,"cameras":[{"type":"perspective","perspective":{"yfov":1,"znear":1}}],
      "animations":[{"channels":[],"samplers":[]}])";
  file.material =
      R"({"alphaMode":"MASK","emissiveFactor":[0,1,0],"normalTexture":{"index":0},"pbrMetallicRoughness":
         {"baseColorTexture":{"index":0}}},{"occlusionTexture":{"index":0},"pbrMetallicRoughness":
         {"metallicRoughnessTexture":{"index":0}}})";
  EXPECT_THAT(import_mesh(folder.write("n.glb", file.glb())).notes,
              IsSupersetOf({"animations were left out: nodes and weights are as stored",
                            "cameras were left out",
                            "only the base colour of materials is read: alpha mode MASK, emission, "
                            "metallic-roughness maps, normal maps, occlusion maps left out"}));
  const auto scenes = [](const std::string& scene) {
    return R"({"asset":{"version":"2.0"},)" + scene +
           R"("scenes":[{"nodes":[0]},{"nodes":[1]}],"nodes":[{"mesh":0},{"mesh":0,"translation":[0,0,9]}],
      "meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"buffers":[{"byteLength":68,"uri":"s.bin"}],
      "bufferViews":[{"buffer":0,"byteLength":36}],
      "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}]})";
  };
  folder.write("s.bin", file.binary);
  const Mesh first = import_mesh(folder.write("s.gltf", scenes("")));
  EXPECT_THAT(first.notes, Contains("scene 0 of 2 (from 0) is drawn, the others were left out"));
  EXPECT_EQ(corner(first, 0, 0).position, V3d(0, 0, 0));
  const Mesh second = import_mesh(folder.write("s.gltf", scenes(R"("scene":1,)")));
  EXPECT_THAT(second.notes, Contains("scene 1 of 2 (from 0) is drawn, the others were left out"));
  EXPECT_EQ(corner(second, 0, 0).position, V3d(0, 0, 9));
}

TEST(Gltf, PlusSignInUriIsKept) {
  const TemporaryFolder folder;
  write_image(folder / "a+b.png", gradient(8, 8));
  GltfFile file;
  file.image = R"({"uri":"a+b.png"})";
  EXPECT_EQ(import_mesh(folder.write("p.glb", file.glb())).textures.at(0).image, gradient(8, 8));
  EXPECT_THAT(files_of(folder, "p.glb"), ElementsAre("p.glb", "a+b.png"));
  write_image(folder / "a b.png", noise(4, 4));
  file.image = R"({"uri":"a%20b.png"})";
  EXPECT_EQ(import_mesh(folder.write("p.glb", file.glb())).textures.at(0).image, noise(4, 4));
}

TEST(Gltf, EmptyOrUnknownChunkAfterJsonIsIgnored) {
  const TemporaryFolder folder;
  write_image(folder / "wood.png", noise(4, 4));
  const GltfFile file;
  folder.write("t.bin", file.binary);
  const std::string text = file.json("t.bin"), type("BIN\0", 4);
  for (const std::string& bytes :
       {GltfFile::glb_of(text, type, ""), GltfFile::glb_of(text, "ACME", "1234")})
    EXPECT_EQ(import_mesh(folder.write("t.glb", bytes)).triangles.size(), 1u);
  EXPECT_THAT(import_error(folder.write("e.glb", GltfFile::glb_of(file.json(""), type, ""))),
              HasSubstr("empty BIN chunk"));
}

TEST(Gltf, FlattenedNodeGetsFaceNormals) {
  const TemporaryFolder folder;
  write_image(folder / "wood.png", noise(4, 4));
  GltfFile file;
  file.append<float>({1, 0, 0, 1, 0, 0, 1, 0, 0});
  file.accessors = R"(,{"bufferView":3,"componentType":5126,"count":3,"type":"VEC3"})";
  file.primitive =
      R"({"attributes":{"POSITION":0,"NORMAL":3,"TEXCOORD_0":1},"indices":2,"material":0})";
  file.nodes = R"([{"mesh":0,"scale":[1,1,0]}])";
  EXPECT_EQ(corner(import_mesh(folder.write("f.glb", file.glb())), 0, 0).normal, V3d(0, 0, 1));
}

TEST(Gltf, ErrorNamesInvalidFile) {
  const TemporaryFolder folder;
  write_image(folder / "wood.png", noise(4, 4));
  auto error = [&](const GltfFile& file) {
    return import_error(folder.write("bad.glb", file.glb()));
  };
  const GltfFile good;
  ASSERT_EQ(import_mesh(folder.write("good.glb", good.glb())).triangles.size(), 1u);

  const std::string bytes = good.glb();
  for (std::size_t size = 1; size < bytes.size(); size += 37)
    EXPECT_NE(import_error(folder.write("cut.glb", bytes.substr(0, size))), "") << size;
  EXPECT_THAT(import_error(folder.write("cut.glb", bytes.substr(0, bytes.size() - 20))),
              HasSubstr("truncated"));
  EXPECT_THAT(import_error(folder.write("e.glb", "")), HasSubstr("empty"));
  EXPECT_NE(import_error(folder.write("j.gltf", "{ \"asset\": ")), "");
  EXPECT_NE(import_error(folder.write("k.gltf", "[]")), "");
  EXPECT_THAT(import_error(folder.write("o.gltf", R"({"asset":{"version":"1.0"}})")),
              HasSubstr("it is glTF 1.0, but only glTF 2 is supported"));
  EXPECT_THAT(
      import_error(folder.write("o.gltf", R"({"asset":{"version":"2.0","minVersion":"2.1"}})")),
      HasSubstr("it requires glTF 2.1"));
  EXPECT_THAT(import_error(folder.write("l.gltf", good.json("none.bin"))), HasSubstr("none.bin"));

  GltfFile file;
  file.image = R"({"uri":"not_there.png"})";
  EXPECT_THAT(error(file), AllOf(HasSubstr("not_there.png"), HasSubstr("missing")));
  file = {};
  file.index_count = 300;
  EXPECT_THAT(error(file), HasSubstr("reaches beyond its buffer"));
  file = {};
  const std::uint16_t wild = 9;
  std::memcpy(file.binary.data() + 62, &wild, 2);
  EXPECT_THAT(error(file), HasSubstr("vertex 9 is used, but there are 3"));
  file = {};
  const float nan = std::nanf("");
  std::memcpy(file.binary.data() + 12, &nan, 4);
  EXPECT_THAT(error(file), HasSubstr("not a finite number"));
  file = {};
  file.primitive = R"({"attributes":{"POSITION":77}})";
  EXPECT_THAT(error(file), HasSubstr("accessor 77"));
  file.primitive = R"({"attributes":{"TEXCOORD_0":1}})";
  EXPECT_THAT(error(file), HasSubstr("no positions"));
  file.primitive = R"({"attributes":{"POSITION":1}})";
  EXPECT_THAT(error(file), HasSubstr("wrong type"));
  file.primitive = R"({"attributes":{"POSITION":0},"mode":1})";
  EXPECT_THAT(error(file), HasSubstr("no triangles"));
  file.primitive = R"({"attributes":{"POSITION":0},"mode":7})";
  EXPECT_THAT(error(file), HasSubstr("mode 7"));
  file.primitive = R"({"attributes":{"POSITION":0},"material":1})";
  EXPECT_THAT(error(file), HasSubstr("material 1"));
  file.primitive = R"({"attributes":{"POSITION":0}},{"mode":4})";
  EXPECT_THAT(error(file), HasSubstr("'attributes' property is missing"));
  file = {};
  file.indices = R"("bufferView":0,"componentType":5126,"type":"SCALAR")";
  EXPECT_THAT(error(file), HasSubstr("accessor 2 has the wrong type"));
  file.indices = R"("bufferView":2,"componentType":5121,"type":"VEC2")";
  EXPECT_THAT(error(file), HasSubstr("accessor 2 has the wrong type"));
  file = {};
  file.image = R"({"bufferView":4})";
  EXPECT_THAT(error(file), HasSubstr("image 0 reaches beyond its buffer"));
  file = {};
  file.nodes = R"([{"mesh":0,"children":[0]}])";
  EXPECT_THAT(error(file), HasSubstr("cycle"));
  file.nodes = R"([{"mesh":4}])";
  EXPECT_THAT(error(file), HasSubstr("mesh 4"));
}

TEST(Gltf, RejectsJsonOfMoreThanAThousandLevels) {
  const TemporaryFolder folder;
  write_image(folder / "wood.png", noise(4, 4));
  GltfFile file;
  const auto lists = [](int levels) {  // brackets and quotes within a string do not count
    const auto count = static_cast<std::size_t>(levels);
    return R"(,"extras":[")" + std::string(2000, '[') + R"(\"{[",)" + std::string(count, '[') +
           std::string(count, ']') + "]";
  };
  file.extra = lists(998);  // within a list and the file's object: 1000
  EXPECT_EQ(import_mesh(folder.write("d.glb", file.glb())).triangles.size(), 1u);
  folder.write("t.bin", file.binary);
  for (const int levels : {999, 100'000}) {
    file.extra = lists(levels);
    const auto named = HasSubstr("JSON is nested more than 1000 levels deep; export it again");
    EXPECT_THAT(import_error(folder.write("d.glb", file.glb())), named);
    EXPECT_THAT(import_error(folder.write("d.gltf", file.json("t.bin"))), named);
  }
  const std::string objects = [] {
    std::string text;
    for (int i = 0; i < 100'000; ++i) text += R"({"a":)";
    return text;
  }();
  EXPECT_THAT(import_error(folder.write("o.gltf", objects)), HasSubstr("nested more than 1000"));
}

// Each number of the file is allowed, but not their product.
TEST(Gltf, ProductsOfCountsAreLimited) {
  const TemporaryFolder folder;
  write_image(folder / "wood.png", noise(4, 4));
  GltfFile file;
  const auto doubled = [](int levels, const std::string& last) {  // drawn 2^levels times
    std::string nodes = "[";
    for (int i = 1; i <= levels; ++i)
      nodes += R"({"children":[)" + std::to_string(i) + "," + std::to_string(i) + "]},";
    return nodes + last + "]";
  };
  const std::string many = R"(,{"componentType":5126,"count":600000,"type":"VEC3"})";
  const std::string instances =
      R"({"mesh":0,"extensions":{"EXT_mesh_gpu_instancing":{"attributes":{"TRANSLATION":3}}}})";
  const auto error = [&] { return import_error(folder.write("p.glb", file.glb())); };
  const auto drawn = HasSubstr("draws more than 1000000 nodes, instances and primitives; split it");
  file.accessors = many;
  file.index_count = 2;  // not a triangle
  file.primitive = R"({"attributes":{"POSITION":0},"indices":2})";
  file.nodes = doubled(1, instances);
  EXPECT_THAT(error(), drawn);
  file.nodes = doubled(0, instances);
  EXPECT_THAT(error(), HasSubstr("no triangles"));
  file.primitive = R"({"attributes":{"POSITION":0},"mode":1})";
  for (int i = 0; i < 99; ++i) file.primitive += R"(,{"attributes":{"POSITION":0},"mode":1})";
  file.nodes = doubled(14, R"({"mesh":0})");
  EXPECT_THAT(error(), drawn);
  // 600 000 positions of 3 numbers: read once more than 2^28 allows.
  const auto read = HasSubstr("read more than 268435456 accessor values; reduce shared use");
  file.primitive = R"({"attributes":{"POSITION":3},"indices":2})";
  file.nodes = doubled(8, R"({"mesh":0})");
  EXPECT_THAT(error(), read);
  file.nodes = doubled(1, R"({"mesh":0})");
  EXPECT_THAT(error(), HasSubstr("no triangles"));
  std::string targets, weights;
  for (int i = 0; i < 200; ++i) {
    targets += std::string(i > 0 ? "," : "") + R"({"POSITION":3})";
    weights += std::string(i > 0 ? "," : "") + "1";
  }
  file.primitive = R"({"attributes":{"POSITION":3},"indices":2,"targets":[)" + targets + "]}";
  file.mesh = R"(,"weights":[)" + weights + "]";
  file.nodes = R"([{"mesh":0}])";
  EXPECT_THAT(error(), read);
}

TEST(Gltf, ErrorNamesMembersWithWrongNumbers) {
  const TemporaryFolder folder;
  write_image(folder / "wood.png", noise(4, 4));
  const auto error = [&](const GltfFile& file) {
    return import_error(folder.write("m.glb", file.glb()));
  };
  for (const auto& [member, reason] :
       {std::pair(R"("offset":[0,"1"])", "'offset' is not 2 numbers"),
        {R"("offset":0.5)", "'offset' is not 2 numbers"},
        {R"("scale":[1,1,1])", "'scale' is not 2 numbers"},
        {R"("scale":{"x":1})", "'scale' is not 2 numbers"},
        {R"("rotation":"1")", "'rotation' is not a number"},
        {R"("texCoord":"1")", "'texCoord' is not a whole number"}}) {
    GltfFile file;
    file.material = std::string(R"({"pbrMetallicRoughness":{"baseColorTexture":{"index":0,)") +
                    R"("extensions":{"KHR_texture_transform":{)" + member + "}}}}}";
    EXPECT_THAT(error(file), HasSubstr(std::string(reason) + "; the file is damaged"));
  }
  GltfFile file;
  file.material =
      R"({"extensions":{"KHR_materials_pbrSpecularGlossiness":{"diffuseFactor":[1,0]}}})";
  EXPECT_THAT(error(file), HasSubstr("'diffuseFactor' is not 4 numbers"));
  for (const auto& [member, reason] :
       {std::pair(R"("matrix":[1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0])", "'matrix' is not 16 numbers"),
        {R"("scale":[1,1])", "'scale' is not 3 numbers"},
        {R"("rotation":[0,0,1])", "'rotation' is not 4 numbers"},
        {R"("translation":[0,0,1,0])", "'translation' is not 3 numbers"},
        {R"("extensions":{"KHR_node_visibility":{"visible":0}})", "'visible' is not true or false"},
        {R"("extensions":{"EXT_mesh_gpu_instancing":{"attributes":{"TRANSLATION":"0"}}})",
         "'TRANSLATION' is not a whole number"}}) {
    GltfFile node;
    node.nodes = std::string(R"([{"mesh":0,)") + member + "}]";
    EXPECT_THAT(error(node), HasSubstr(reason));
  }
}

// A file can neither control the terminal nor fill it.
TEST(Gltf, NamesAreShortenedWithoutControlCharacters) {
  const TemporaryFolder folder;
  write_image(folder / "wood.png", noise(4, 4));
  GltfFile file;
  const auto used = [&](const std::string& names) {
    file.extra = R"(,"extensionsUsed":[)" + names + "]";
    for (const std::string& note : import_mesh(folder.write("n.glb", file.glb())).notes)
      if (note.starts_with("unsupported extensions were ignored: ")) return note.substr(37);
    return std::string();
  };
  EXPECT_EQ(used(R"("A\u001b[31m\u0007\n\u009b\u007f\u00e4")"), "A?[31m????\xC3\xA4");
  EXPECT_EQ(used('"' + std::string(64, 'x') + '"'), std::string(64, 'x'));
  EXPECT_EQ(used('"' + std::string(65, 'x') + '"'), std::string(64, 'x') + "...");
  // A two-byte character is not split.
  EXPECT_EQ(used('"' + std::string(63, 'x') + "\xC3\xA4\""), std::string(63, 'x') + "...");
  std::string names, shown;
  for (int i = 10; i < 30; ++i) names += "\"E" + std::to_string(i) + "\",";
  for (int i = 10; i < 30; ++i) shown += (i > 10 ? ", E" : "E") + std::to_string(i);
  EXPECT_EQ(used(names + R"("E29")"), shown);
  EXPECT_EQ(used(names + R"("E30","E31")"), shown + " and 2 more");
  file.extra = R"(,"extensionsRequired":["\u001b[31m"])";
  EXPECT_THAT(import_error(folder.write("n.glb", file.glb())), HasSubstr("extension ?[31m,"));
  file = {};
  file.image = R"({"uri":")" + std::string(65, 'y') + R"("})";
  EXPECT_THAT(import_error(folder.write("n.glb", file.glb())),
              HasSubstr("texture '" + std::string(64, 'y') + "...' is missing"));
}

TEST(Gltf, ErrorNamesUtf16) {
  const TemporaryFolder folder;
  for (const std::string_view bytes :
       {std::string_view("\xFF\xFE{\0", 4), std::string_view("\xFE\xFF\0{", 4),
        std::string_view("{\0}\0", 4), std::string_view("\0{\0}", 4)})
    EXPECT_THAT(import_error(folder.write("u.gltf", std::string(bytes))),
                HasSubstr("it is written in UTF-16; save it as UTF-8"));
}

TEST(Gltf, ReadsStripsAndFans) {
  const TemporaryFolder folder;
  write_image(folder / "wood.png", noise(4, 4));
  GltfFile file;
  file.index_count = 4;  // 0 1 2 0
  file.primitive = R"({"attributes":{"POSITION":0},"indices":2,"mode":5})";
  const Mesh strip = import_mesh(folder.write("s.glb", file.glb()));
  ASSERT_EQ(strip.triangles.size(), 2u);
  EXPECT_EQ(corner(strip, 1, 0).position, V3d(0, 1, 0));  // 2 1 0: every second one is reversed
  file.primitive = R"({"attributes":{"POSITION":0},"indices":2,"mode":6})";
  const Mesh fan = import_mesh(folder.write("f.glb", file.glb()));
  EXPECT_EQ(corner(fan, 1, 1).position, V3d(0, 1, 0));  // 0 2 0
}

// Numbers of every width, normalised and strided; omitted parts give notes.
TEST(Gltf, ReadsQuantisedNumbersAndNotesOmissions) {
  const TemporaryFolder folder;
  write_image(folder / "wood.png", noise(4, 4));
  GltfFile bytes;
  bytes.binary.clear();
  bytes.append<std::int16_t>(
      {0, 0, 0, 9, 32767, 0, 0, 9, 0, -32768, 0, 9});  // 24 bytes, eight per vertex
  bytes.append<std::int8_t>({0, 0, 127, 9, 0, 0, 127, 9, 0, 0, 127, 9});  // 12
  bytes.append<std::uint16_t>({0, 0, 65535, 0, 0, 13107});                // 12: 13107 is a fifth
  bytes.append<std::uint8_t>({2, 1, 0, 51, 102, 255, 0, 0});              // 8
  folder.write("q.bin", bytes.binary);
  const auto gltf = [&](const std::string& uv) {
    return R"({"asset":{"version":"2.0"},"nodes":[{"children":[1]},{"mesh":0,"translation":[0,0,5]}],"skins":[{"joints":[0]}],
      "extensionsRequired":["KHR_mesh_quantization"],"extensionsUsed":["KHR_mesh_quantization"],
      "meshes":[{"primitives":[{"mode":0,"attributes":{"POSITION":0}},
        {"attributes":{"POSITION":0,"NORMAL":1,"COLOR_0":1,"TEXCOORD_1":)" +
           uv + R"(},"indices":3,"material":0}, {"attributes":{"POSITION":0},"indices":3}]}],
      "materials":[{"name":"m","pbrMetallicRoughness":{"baseColorFactor":[0.25,0.5,0.75,1],
        "baseColorTexture":{"index":0,"texCoord":1}}}],
      "textures":[{"source":0}],"images":[{"uri":"wood.png"}],
      "accessors":[{"bufferView":0,"componentType":5122,"normalized":true,"count":3,"type":"VEC3"},
        {"bufferView":1,"componentType":5120,"normalized":true,"count":3,"type":"VEC3"},
        {"bufferView":2,"componentType":5123,"normalized":true,"count":3,"type":"VEC2"},
        {"bufferView":3,"componentType":5121,"count":3,"type":"SCALAR"},
        {"bufferView":3,"componentType":5121,"normalized":true,"byteOffset":2,"count":3,"type":"VEC2"}],
      "bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":24,"byteStride":8},
        {"buffer":0,"byteOffset":24,"byteLength":12,"byteStride":4},{"buffer":0,"byteOffset":36,"byteLength":12},
        {"buffer":0,"byteOffset":48,"byteLength":8}],
      "buffers":[{"byteLength":56,"uri":"q.bin"}]})";
  };
  const Mesh mesh = import_mesh(folder.write("q.gltf", gltf("2")));
  ASSERT_EQ(mesh.triangles.size(), 2u);
  EXPECT_EQ(corner(mesh, 0, 0).position, V3d(0, -1, 5));
  EXPECT_EQ(corner(mesh, 0, 1).position, V3d(1, 0, 5));
  EXPECT_EQ(corner(mesh, 0, 2).position, V3d(0, 0, 5));
  EXPECT_EQ(corner(mesh, 0, 0).normal, V3d(0, 0, 1));
  EXPECT_NEAR(corner(mesh, 0, 0).uv.y, 0.2, 1e-12);
  EXPECT_EQ(corner(mesh, 0, 1).uv, V2d(1, 0));
  ASSERT_EQ(mesh.materials.size(), 2u);
  EXPECT_EQ(mesh.materials[0].colour, V3d(0.25, 0.5, 0.75));
  EXPECT_EQ(mesh.materials[mesh.triangles[1].material].name, "default");
  EXPECT_EQ(mesh.materials[mesh.triangles[1].material].colour, V3d(0.8, 0.8, 0.8));
  EXPECT_EQ(mesh.textures.at(0).wrap_s, spec::texture::Wrap::kRepeat);
  EXPECT_THAT(mesh.notes,
              ElementsAre("points and lines were left out", "vertex colours were left out",
                          "skins were left out: the bind pose is drawn",
                          "1 triangles without texture coordinates got a box projection",
                          "3 corners without a normal got their face's"));
  const Mesh other = import_mesh(folder.write("o.gltf", gltf("4")));  // bytes 50 and on
  EXPECT_NEAR(corner(other, 0, 2).uv.y, 0.2, 1e-12);
  EXPECT_NEAR(corner(other, 0, 1).uv.x, 0.4, 1e-12);
  EXPECT_EQ(corner(other, 0, 1).uv.y, 1);
}

TEST(Gltf, CorruptBytesDoNotCrash) {
  const TemporaryFolder folder;
  write_image(folder / "wood.png", noise(4, 4));
  const std::string good = GltfFile().glb();
  Random random(5);
  int rejected = 0;
  for (int i = 0; i < 400; ++i) {
    std::string bytes = good;
    for (int k = 0; k < 3; ++k)
      bytes[random.next() % bytes.size()] = static_cast<char>(random.word());
    try {
      import_mesh(folder.write("fuzz.glb", bytes));
    } catch (const spec::FileError&) {
      ++rejected;
    }
  }
  EXPECT_GT(rejected, 200);
}

TEST(Data, EveryMeshOfTheDataFolderLoads) {
  DEBURR_REQUIRE_DATA(data);
  int meshes = 0;
  for (const auto& entry : fs::recursive_directory_iterator(data)) {
    const std::string extension = entry.path().extension().string();
    if (extension != ".obj" && extension != ".glb") continue;
    const Mesh mesh = import_mesh(entry.path());
    EXPECT_FALSE(mesh.triangles.empty()) << entry.path();
    EXPECT_LE(mesh.textures.size(), 16u) << entry.path();
    ++meshes;
  }
  EXPECT_GE(meshes, 30);
}

}  // namespace
}  // namespace deburr::tb::mesh_test
