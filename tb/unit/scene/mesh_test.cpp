// SPDX-License-Identifier: MIT
// Question: do OBJ and glTF files arrive as they were meant, and is every broken one named?
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

TEST(Obj, MaterialsAndTextures) {
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
              AllOf(HasSubstr("not_there.bmp"), HasSubstr("give a texture of your own")));
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

TEST(Obj, MissingMaterialFileIsANote) {
  const TemporaryFolder folder;
  const Mesh mesh =
      import_mesh(folder.write("a.obj", std::string("mtllib none.mtl\nusemtl x\n") + kSquare));
  EXPECT_THAT(mesh.notes, Contains(HasSubstr("none.mtl")));
}

TEST(Obj, BoxProjectionAndFaceNormals) {
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

TEST(Obj, ALineThatEndsWithABackslashGoesOn) {
  const TemporaryFolder folder;
  for (const std::string end : {"\n", "\r\n"}) {
    const std::string three = "v 0 0 \\" + end + "0" + end + "v 1 0 0" + end + "v 0 1 0" + end;
    const Mesh mesh =
        import_mesh(folder.write("c.obj", three + "f 1 \\" + end + "2 \\" + end + "3" + end));
    ASSERT_EQ(mesh.triangles.size(), 1u);
    EXPECT_EQ(corner(mesh, 0, 2).position, V3d(0, 1, 0));
    EXPECT_THAT(import_error(folder.write("d.obj", three + "f 1 2 4" + end)),
                AllOf(HasSubstr("line 5"), HasSubstr("vertex 4, but there are 3")));
    // The name of a folder in a comment goes nowhere.
    EXPECT_EQ(import_mesh(folder.write("e.obj", "# C:\\meshes\\" + end + three + "f 1 2 3" + end))
                  .triangles.size(),
              1u);
  }
}

TEST(Obj, BrokenFilesAreNamedWithTheirLine) {
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
  // To tinyobjloader a line ends here, and another one begins.
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

// Every prefix of a file is an error, is noted, or is a whole number of lines, of which nobody can
// tell that there were more.
TEST(Obj, TruncationIsFoundWhereItCanBe) {
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

TEST(Obj, DamagedBytesNeverCrash) {
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

TEST(Obj, BoxesAreProjectedAlongTheirFaces) {
  struct Side {
    const char* corners;  // a triangle of the box 0..8, 0..4, 0..2
    std::array<V2d, 3> uv;
  };
  // A scale of half a repeat a unit, from the lowest corner of the box.
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

// Of the whole mesh, those triangles too that have coordinates of their own.
TEST(Obj, ABoxIsAroundEverything) {
  const TemporaryFolder folder;
  const Mesh mesh = import_mesh(folder.write(
      "a.obj",
      "v -4 0 0\nv 12 0 0\nv 0 0 1\nvt 0 0\nf 1/1 2/1 3/1\nv 0 0 0\nv 0 0 8\nv 8 0 0\nf 4 5 6\n"));
  EXPECT_EQ(corner(mesh, 1, 0).uv, V2d(1, 0));
  EXPECT_EQ(corner(mesh, 1, 1).uv, V2d(1, 2));
  EXPECT_EQ(corner(mesh, 1, 2).uv, V2d(3, 0));
}

TEST(Obj, WhatIsLeftOutIsNoted) {
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

// Seventeen colours: the last one begins a second row of cells of four by four texels.
TEST(Palette, HasACellForEachPlainMaterial) {
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

// ---- files --------------------------------------------------------------------------------------

// Of the import, from the folder on, which has to be the list that is had without it.
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

TEST(MeshFiles, OfAnObj) {
  const TemporaryFolder folder;
  fs::create_directories(folder / "sub folder");
  write_image(folder / "wood grain.png", noise(8, 8));
  folder.write("sub folder/my b.mtl", "newmtl b\nmap_Kd sub folder/../wood grain.png\n");
  folder.write("a.mtl",
               "newmtl a\nmap_Kd -s 2 2 1 wood grain.png\nnewmtl again\nmap_Kd wood grain.png\n"
               "map_Bump other.png\nnewmtl plain\n");
  folder.write("plain.obj", kSquare);
  EXPECT_THAT(files_of(folder, "plain.obj"), ElementsAre("plain.obj"));
  // Of the names of a line the first that is there is taken; a blank behind them is none.
  folder.write("m.obj", std::string("mtllib none.mtl a.mtl a.mtl \n  mtllib\tgone.mtl \r"
                                    "mtllib sub\\ folder/my\\ b.mtl\nmtllib a.mtl\nusemtl b\n") +
                            kSquare);
  const auto with_textures = ElementsAre("m.obj", "none.mtl", "a.mtl", "gone.mtl",
                                         "sub folder/my b.mtl", "wood grain.png", "wood grain.png");
  EXPECT_THAT(files_of(folder, "m.obj"), with_textures) << "by two names";
  EXPECT_THAT(files_of(folder, "m.obj", {.textures = false}),
              ElementsAre("m.obj", "none.mtl", "a.mtl", "gone.mtl", "sub folder/my b.mtl"));
  // A file of a name that had none is another mesh.
  folder.write("none.mtl", "newmtl b\n");
  EXPECT_THAT(files_of(folder, "m.obj"),
              ElementsAre("m.obj", "none.mtl", "gone.mtl", "sub folder/my b.mtl", "a.mtl",
                          "wood grain.png", "wood grain.png"));
}

TEST(MeshFiles, OfAnObjThatIsRejected) {
  const TemporaryFolder folder;
  const auto names = [&](const std::string& name) {
    std::vector<std::string> found;
    for (const fs::path& file : mesh_files(folder / name)) found.push_back(file.filename());
    return found;
  };
  EXPECT_THAT(names("none.obj"), ElementsAre("none.obj"));
  EXPECT_THAT(names("picture.png"), ElementsAre()) << "nobody opens it";
  folder.write("m.mtl", "newmtl a\nmap_Kd none.png\n");
  folder.write("m.obj", std::string("mtllib m.mtl\nusemtl a\n") + kSquare);
  EXPECT_THAT(import_error(folder / "m.obj"), HasSubstr("none.png"));
  EXPECT_THAT(names("m.obj"), ElementsAre("m.obj", "m.mtl", "none.png"));
  // What cannot be read is not what is not there; a pipe would be waited for.
  fs::remove(folder / "m.mtl");
  ASSERT_EQ(::mkfifo((folder / "m.mtl").c_str(), 0600), 0);
  EXPECT_THAT(import_error(folder / "m.obj"),
              AllOf(HasSubstr("m.mtl"), HasSubstr("not a regular file")));
  EXPECT_THAT(names("m.obj"), ElementsAre("m.obj", "m.mtl"));
}

TEST(MeshFiles, AreFoundOnce) {
  const TemporaryFolder folder;
  folder.write("m.obj", std::string("mtllib m.mtl\n") + kSquare);
  MeshFiles files;
  EXPECT_EQ(files.of(folder / "m.obj", {}).size(), 2u);
  folder.write("m.obj", kSquare);
  EXPECT_EQ(files.of(folder / "m.obj", {}).size(), 2u) << "a process has looked before";
  EXPECT_EQ(files.of(folder / "m.obj", {.textures = false}).size(), 1u);
  EXPECT_EQ(MeshFiles().of(folder / "m.obj", {}).size(), 1u);
}

TEST(MeshFiles, OfScenes) {
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
           R"(,"meshes":[{"primitives":[)" + primitive + R"(]}],"materials":[)" + material +
           R"(],"textures":[{"source":0,"sampler":0}],"samplers":[{"wrapS":33648,"wrapT":33071}],"images":[)" +
           image + R"(],"accessors":[
             {"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"},
             {"bufferView":1,"componentType":5126,"count":3,"type":"VEC2"},
             {"bufferView":2,"componentType":5123,"count":)" +
           std::to_string(index_count) +
           R"(,"type":"SCALAR"}],"bufferViews":[
             {"buffer":0,"byteOffset":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":24},
             {"buffer":0,"byteOffset":60,"byteLength":8},
             {"buffer":0,"byteOffset":68,"byteLength":)" +
           std::to_string(std::max<std::size_t>(binary.size() - 68, 1)) +
           R"(}],"buffers":[{"byteLength":)" + length +
           (uri.empty() ? "" : R"(,"uri":")" + uri + "\"") + "}]" + extra + "}";
  }
  std::string glb() const {
    std::string text = json("");
    while (text.size() % 4 != 0) text += ' ';
    std::string data = binary;
    while (data.size() % 4 != 0) data += '\0';
    auto word = [](std::size_t value) {
      std::string bytes(4, '\0');
      for (std::size_t i = 0; i < 4; ++i) bytes[i] = static_cast<char>(value >> (8 * i));
      return bytes;
    };
    return "glTF" + word(2) + word(28 + text.size() + data.size()) + word(text.size()) + "JSON" +
           text + word(data.size()) + std::string("BIN\0", 4) + data;
  }
};

TEST(Gltf, ExternalBufferAndTexture) {
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

TEST(MeshFiles, OfAGltf) {
  const TemporaryFolder folder;
  GltfFile file;
  folder.write("t b.bin", file.binary);
  write_image(folder / "wood grain.png", noise(8, 4));
  file.image = R"({"uri":"wood%20grain.png"},{"uri":"wood%20grain.png"},{"uri":"none.png"})";
  folder.write("t.gltf", file.json("t%20b.bin"));
  // What is not there is looked for in the current folder, too.
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

TEST(Gltf, EmbeddedTexture) {
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

TEST(Gltf, NodesTransformAndMirrorsKeepTheOutside) {
  const TemporaryFolder folder;
  write_image(folder / "wood.png", noise(4, 4));
  GltfFile file;
  // Parent: two up. Child: scaled by (2, 1, 1), turned a quarter about z, moved by x + 5.
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

TEST(Gltf, TextureTransform) {
  const TemporaryFolder folder;
  write_image(folder / "wood.png", noise(4, 4));
  GltfFile file;
  file.material =
      R"({"pbrMetallicRoughness":{"baseColorTexture":{"index":0,"extensions":{"KHR_texture_transform":
         {"offset":[0.25,0.5],"scale":[2,4],"rotation":1.5707963267948966}}}}})";
  file.extra =
      R"(,"extensionsUsed":["KHR_texture_transform"],"extensionsRequired":["KHR_texture_transform"])";
  const Mesh mesh = import_mesh(folder.write("t.glb", file.glb()));
  EXPECT_NEAR((corner(mesh, 0, 1).uv - V2d(0.25, 2.5)).length(), 0, 1e-9);   // (1, 0) -> (0, 2)
  EXPECT_NEAR((corner(mesh, 0, 2).uv - V2d(-3.75, 0.5)).length(), 0, 1e-9);  // (0, 1) -> (-4, 0)
}

TEST(Gltf, BrokenFilesAreNamed) {
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
              HasSubstr("it is glTF 1.0, and glTF 2 is read"));
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
  file = {};
  file.nodes = R"([{"mesh":0,"children":[0]}])";
  EXPECT_THAT(error(file), HasSubstr("cycle"));
  file.nodes = R"([{"mesh":4}])";
  EXPECT_THAT(error(file), HasSubstr("mesh 4"));
  file = {};
  file.extra = R"(,"extensionsRequired":["KHR_draco_mesh_compression"])";
  EXPECT_THAT(error(file), HasSubstr("KHR_draco_mesh_compression"));
}

TEST(Gltf, StripsAndFans) {
  const TemporaryFolder folder;
  write_image(folder / "wood.png", noise(4, 4));
  GltfFile file;
  file.index_count = 4;  // 0 1 2 0
  file.primitive = R"({"attributes":{"POSITION":0},"indices":2,"mode":5})";
  const Mesh strip = import_mesh(folder.write("s.glb", file.glb()));
  ASSERT_EQ(strip.triangles.size(), 2u);
  EXPECT_EQ(corner(strip, 1, 0).position, V3d(0, 1, 0));  // 2 1 0: every other one is turned
  file.primitive = R"({"attributes":{"POSITION":0},"indices":2,"mode":6})";
  const Mesh fan = import_mesh(folder.write("f.glb", file.glb()));
  EXPECT_EQ(corner(fan, 1, 1).position, V3d(0, 1, 0));  // 0 2 0
}

// Numbers of every width, as shares and apart from each other; what is left out is noted.
TEST(Gltf, QuantisedNumbersAndWhatIsLeftOut) {
  const TemporaryFolder folder;
  write_image(folder / "wood.png", noise(4, 4));
  GltfFile bytes;
  bytes.binary.clear();
  bytes.append<std::int16_t>(
      {0, 0, 0, 9, 32767, 0, 0, 9, 0, -32768, 0, 9});  // 24 bytes, eight a vertex
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

TEST(Gltf, DamagedBytesNeverCrash) {
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
