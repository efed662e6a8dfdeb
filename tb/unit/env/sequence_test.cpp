// SPDX-License-Identifier: MIT
// Lists and patterns of files and cameras, and what is rejected of them.
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

TEST_F(Sequence, APatternGivesFilesInTheOrderOfTheirNumbers) {
  EXPECT_THAT(listed_files("frame.source", path("f*.png")),
              ElementsAre(path("f1.png"), path("f2.png"), path("f10.png")));
}

TEST_F(Sequence, AListKeepsItsOrder) {
  EXPECT_THAT(listed_files("frame.source", path("f10.png") + "; " + path("f?.png") + ";road"),
              ElementsAre(path("f10.png"), path("f1.png"), path("f2.png"), "road"));
}

TEST_F(Sequence, WhatIsThereUnderItsNameIsThatFile) {
  EXPECT_THAT(listed_files("frame.source", path("g[1].png")), ElementsAre(path("g[1].png")));
  EXPECT_THAT(listed_files("frame.source", path("a;b.png")), ElementsAre(path("a;b.png")));
  EXPECT_THAT(listed_files("frame.source", ""), ElementsAre(""));
}

TEST_F(Sequence, APatternThatMatchesNothingIsAnError) {
  EXPECT_THROW(listed_files("frame.source", path("h*.png")), spec::ConfigError);
}

TEST(FrameLists, GiveEachFrameItsEntryOrTheOnlyOne) {
  FrameLists lists;
  lists.add("scene.source", {"object"});
  EXPECT_EQ(lists.frames(), 1);
  lists.add("scene.eye", listed("0,1,4; 1,1,4 ;2,1,4"));
  EXPECT_EQ(lists.frames(), 3);
  EXPECT_EQ(lists.longest(), "scene.eye");
  EXPECT_EQ(lists.at("scene.source", 2), "object");
  EXPECT_EQ(lists.at("scene.eye", 1), "1,1,4");
}

TEST(FrameLists, AreEquallyLongAndWithoutHoles) {
  FrameLists lists;
  lists.add("scene.source", {"a.obj", "b.obj"});
  EXPECT_THROW(lists.add("scene.eye", {"0,0,1", "0,0,2", "0,0,3"}), spec::ConfigError);
  EXPECT_THROW(lists.add("scene.eye", {"0,0,1", ""}), spec::ConfigError);
}

}  // namespace
}  // namespace deburr::tb::sequence_test
