// SPDX-License-Identifier: MIT
// A file named by a parameter of an engine is one of the engine's input files.
#include "tool/pages/input_files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "tool/run/run_once.h"

namespace deburr::tool::input_files_test {
namespace {

namespace fs = std::filesystem;
using ::testing::Contains;
using ::testing::IsEmpty;

class InputFilesOfEngines : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "deburr-engines-XXXXXX").string();
    path_ = ::mkdtemp(name.data());
    std::ofstream(path_ / "m.obj") << "mtllib m.mtl\n";
    std::ofstream(path_ / "f.png") << "some frame";
  }
  void TearDown() override { fs::remove_all(path_); }
  fs::path path_;
};

// Other settings that make a parameter effective.
const std::map<std::string, std::string> kBeside = {{"frame.depth", "frame.source"},
                                                    {"frame.reference", "frame.source"}};

TEST_F(InputFilesOfEngines, ContainEveryFileNamedByParameters) {
  int parameters = 0;
  for (const std::unique_ptr<Engine>& engine : engines()) {
    const BoundEngine probe(*engine);
    tb::MeshFiles meshes;
    EXPECT_THAT(engine->input_files(meshes), IsEmpty()) << engine->name() << " by default";
    for (const tb::Parameter& parameter : probe.set.all()) {
      if (parameter.range.find("file") == std::string::npos) continue;
      ++parameters;
      const std::unique_ptr<Engine> another = engine_named(std::string(engine->name()));
      BoundEngine bound(*another);
      const bool mesh = parameter.name == "scene.source";
      const fs::path file = path_ / (mesh ? "m.obj" : "f.png");
      bound.set.set(parameter.name, file.string(), "test");
      if (const auto beside = kBeside.find(parameter.name); beside != kBeside.end())
        bound.set.set(beside->second, (path_ / "frame.png").string(), "test");
      std::vector<fs::path> files = another->input_files(meshes);
      for (fs::path& other : surroundings_files(bound.set)) files.push_back(std::move(other));
      EXPECT_THAT(files, Contains(file)) << parameter.name;
      EXPECT_EQ(std::count(files.begin(), files.end(), path_ / "m.mtl"), mesh) << parameter.name;
    }
  }
  EXPECT_GE(parameters, 10);
}

}  // namespace
}  // namespace deburr::tool::input_files_test
