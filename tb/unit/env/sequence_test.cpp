// SPDX-License-Identifier: MIT
// Lists and patterns of files and cameras, and the inputs that are rejected.
#include "tb/env/sequence.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "spec/error.h"

namespace deburr::tb::sequence_test {
namespace {

using testing::ElementsAre;
namespace fs = std::filesystem;

class Sequence : public testing::Test {
 protected:
  Sequence() : folder_(fs::temp_directory_path() / ("deburr_seq_" + std::to_string(::getpid()))) {
    fs::create_directories(folder_);
    for (const char* name : {"f10.png", "f2.png", "f1.png", "g[1].png", "a;b.png"})
      std::ofstream(folder_ / name) << name;
  }
  ~Sequence() override { fs::remove_all(folder_); }
  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  fs::path folder_;
};

TEST_F(Sequence, PatternOrdersFilesByNumber) {
  EXPECT_THAT(listed_files("frame.source", path("f*.png")),
              ElementsAre(path("f1.png"), path("f2.png"), path("f10.png")));
}

TEST_F(Sequence, ListKeepsItsOrder) {
  EXPECT_THAT(listed_files("frame.source", path("f10.png") + "; " + path("f?.png") + ";road"),
              ElementsAre(path("f10.png"), path("f1.png"), path("f2.png"), "road"));
}

TEST_F(Sequence, ExistingFileWinsOverPattern) {
  EXPECT_THAT(listed_files("frame.source", path("g[1].png")), ElementsAre(path("g[1].png")));
  EXPECT_THAT(listed_files("frame.source", path("a;b.png")), ElementsAre(path("a;b.png")));
  EXPECT_THAT(listed_files("frame.source", ""), ElementsAre(""));
}

TEST_F(Sequence, PatternWithoutMatchIsAnError) {
  EXPECT_THROW(listed_files("frame.source", path("h*.png")), spec::ConfigError);
}

TEST_F(Sequence, NumbersAreOrderedByValue) {
  for (const char* name : {"n1a10", "n01b", "n1a9", "n", "n007", "n2", "m9", "n1a"})
    std::ofstream(folder_ / name) << name;
  EXPECT_THAT(listed_files("frame.source", path("[mn]*")),
              ElementsAre(path("m9"), path("n"), path("n1a"), path("n1a9"), path("n1a10"),
                          path("n01b"), path("n2"), path("n007")));
}

TEST(Listed, TrimsBlanksAroundEntries) {
  EXPECT_THAT(listed(" a b \t;\tc;;d "), ElementsAre("a b", "c", "", "d"));
  EXPECT_THAT(listed(""), ElementsAre(""));
  EXPECT_THAT(listed(";"), ElementsAre("", ""));
}

TEST(FrameLists, GiveEachFrameItsEntryOrSharedOne) {
  FrameLists lists;
  lists.add("scene.source", {"object"});
  EXPECT_EQ(lists.frames(), 1);
  lists.add("scene.eye", listed("0,1,4; 1,1,4 ;2,1,4"));
  EXPECT_EQ(lists.frames(), 3);
  EXPECT_EQ(lists.longest(), "scene.eye");
  EXPECT_EQ(lists.at("scene.source", 2), "object");
  EXPECT_EQ(lists.at("scene.eye", 1), "1,1,4");
}

TEST(FrameLists, RejectUnequalLengthsAndGaps) {
  FrameLists lists;
  lists.add("scene.source", {"a.obj", "b.obj"});
  EXPECT_THROW(lists.add("scene.eye", {"0,0,1", "0,0,2", "0,0,3"}), spec::ConfigError);
  EXPECT_THROW(lists.add("scene.eye", {"0,0,1", ""}), spec::ConfigError);
}

TEST(FrameLists, ErrorNamesListsOfUnequalLength) {
  FrameLists lists;
  lists.add("scene.source", {"a.obj", "b.obj"});
  lists.add("scene.target", {"0,0,0"});
  try {
    lists.add("scene.eye", {"0,0,1", "0,0,2", "0,0,3"});
    ADD_FAILURE();
  } catch (const spec::ConfigError& error) {
    EXPECT_THAT(error.what(),
                testing::HasSubstr("scene.source lists 2 frames, but scene.eye lists 3"));
  }
  EXPECT_EQ(lists.frames(), 2);
  lists.add("scene.eye", {"0,0,1", "0,0,2"});
  EXPECT_EQ(lists.longest(), "scene.eye");
  EXPECT_EQ(lists.at("scene.eye", 1), "0,0,2");
  EXPECT_THROW(lists.at("scene.roll", 0), spec::CheckFailed);
}

TEST(Camera, SelectedPerFrame) {
  CameraParameters camera{"0,0,1;0,0,2", " 5,5,5 "};
  FrameLists lists;
  add_camera(lists, camera);
  EXPECT_EQ(lists.frames(), 2);
  choose_camera(camera, lists, 1);
  EXPECT_EQ(camera.eye, "0,0,2");
  EXPECT_EQ(camera.target, "5,5,5");
}

// Omitted values are the scene's own; its near plane is for its own eye.
TEST(Camera, ReplacesCameraOfScene) {
  Scene scene;
  const auto camera = [](const char* eye, const char* target) {
    return CameraParameters{eye, target};
  };
  scene.camera = {{1, 2, 3}, {4, 5, 6}, {0, 1, 0}, 0.7, 0.025};
  look(scene, {});
  EXPECT_EQ(scene.camera.near_plane, 0.025);
  look(scene, camera("", "-1.5,2e1,.5"));
  EXPECT_EQ(scene.camera.target, Imath::V3d(-1.5, 20, 0.5));
  EXPECT_EQ(scene.camera.eye, Imath::V3d(1, 2, 3));
  EXPECT_EQ(scene.camera.near_plane, 0.025);
  EXPECT_EQ(scene.camera.fov_y, 0.7);
  look(scene, {.eye = "0,0,8", .target = "0,0,0", .fov = 0.9, .roll = 90});
  EXPECT_EQ(scene.camera.eye, Imath::V3d(0, 0, 8));
  EXPECT_EQ(scene.camera.near_plane, Camera{}.near_plane);
  EXPECT_EQ(scene.camera.fov_y, 0.9);
  EXPECT_NEAR(scene.camera.up.x, 1, 1e-12);
  for (const char* wrong :
       {"1,2", "1,2,3,4", "1,2,3 ", "1;2;3", "a,b,c", "1,2,nan", "1,,3", "1,2,", "1,2,inf"}) {
    EXPECT_THROW(look(scene, camera(wrong, "")), spec::ConfigError) << wrong;
    EXPECT_THROW(look(scene, camera("", wrong)), spec::ConfigError) << wrong;
  }
  EXPECT_THROW(look(scene, camera("1,2,3", "1,2,3")), spec::ConfigError);
}

}  // namespace
}  // namespace deburr::tb::sequence_test
