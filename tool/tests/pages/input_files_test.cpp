// SPDX-License-Identifier: MIT
// Keys depend on the contents of a run's input files, and a file that changes is detected before a
// result is stored under the old key.
#include "tool/pages/input_files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>

#include "spec/error.h"
#include "tb/base/file.h"
#include "tool/pages/run_context.h"

namespace deburr::tool::input_files_test {

using tb::sha256;

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

class InputFilesOfARun : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "deburr-inputs-XXXXXX").string();
    path_ = ::mkdtemp(name.data());
  }
  void TearDown() override { fs::remove_all(path_); }
  fs::path write(const std::string& name, const std::string& text) const {
    std::ofstream(path_ / name) << text;
    return path_ / name;
  }
  // On a file system with time stamps in jiffies, two writes of the same length could get equal
  // stamps.
  static void let_time_pass() { std::this_thread::sleep_for(std::chrono::milliseconds(20)); }
  // A run that shares intermediate results in the folder "cache".
  std::unique_ptr<RunContext> run(const std::vector<fs::path>& files) const {
    auto context = std::make_unique<RunContext>(path_ / "out", parameters_, "x", 0);
    context->share(std::make_shared<SharedInputs>(path_ / "cache"), files);
    return context;
  }
  static std::string shared(const RunContext& context, const std::string& made) {
    return context.shared_bytes("thing", {}, [&] { return made; });
  }

  fs::path path_;
  tb::ParameterSet parameters_;
};

TEST_F(InputFilesOfARun, ContentIsOneWord) {
  EXPECT_EQ(content_of(write("a", "abc")), sha256("abc"));
  EXPECT_EQ(content_of(path_ / "none"), kMissingFile);
  EXPECT_EQ(content_of(path_), kUnreadableFile);
  EXPECT_EQ(content_of(path_ / "a" / "b"), kMissingFile);
  ASSERT_EQ(::mkfifo((path_ / "pipe").c_str(), 0600), 0);
  EXPECT_EQ(content_of(path_ / "pipe"), kUnreadableFile);
  fs::create_symlink("a", path_ / "link");
  fs::create_symlink("none", path_ / "dangling");
  EXPECT_EQ(content_of(path_ / "link"), sha256("abc"));
  EXPECT_EQ(content_of(path_ / "dangling"), kMissingFile);
  for (const std::string name : {"a", "none", "pipe"})
    EXPECT_EQ(listed_content(input_entry(path_ / name, content_of(path_ / name))),
              content_of(path_ / name));
}

TEST_F(InputFilesOfARun, FilesAreReadOnce) {
  InputFiles files;
  const fs::path file = write("a", "one");
  EXPECT_EQ(files.content(file), sha256("one"));
  write("a", "another");
  EXPECT_EQ(files.content(file), sha256("one"));
  EXPECT_THAT(files.contents({path_ / "none", file}), ElementsAre(kMissingFile, sha256("one")));
  EXPECT_EQ(files.all().size(), 2u);
}

TEST_F(InputFilesOfARun, RejectsChangedFiles) {
  InputFiles files;
  const std::vector<fs::path> some = {write("a", "one"), path_ / "none"};
  files.contents(some);
  EXPECT_NO_THROW(files.reject_changed(some));
  let_time_pass();
  write("a", "one");
  EXPECT_NO_THROW(files.reject_changed(some)) << "it was only touched";
  let_time_pass();
  write("a", "two");
  EXPECT_THROW(files.reject_changed(some), spec::FileError);
  write("a", "one");
  write("none", "it has come");
  EXPECT_THROW(files.reject_changed(some), spec::FileError);
  EXPECT_NO_THROW(files.reject_changed({path_ / "unrequested"}));
}

TEST_F(InputFilesOfARun, KeysOfSharedResultsDependOnFiles) {
  const std::vector<fs::path> files = {write("m.obj", "mesh"), write("t.png", "old")};
  EXPECT_EQ(shared(*run(files), "of the old one"), "of the old one");
  EXPECT_EQ(shared(*run(files), "again"), "of the old one");
  write("t.png", "new");
  EXPECT_EQ(shared(*run(files), "of the new one"), "of the new one");
  fs::remove(path_ / "t.png");
  EXPECT_EQ(shared(*run(files), "of none"), "of none");
  write("t.png", "old");
  EXPECT_EQ(shared(*run(files), "again"), "of the old one");
}

TEST_F(InputFilesOfARun, ChangedFileKeepsNothingShared) {
  const std::vector<fs::path> files = {write("t.png", "old")};
  const auto context = run(files);
  EXPECT_THROW(context->shared_bytes("thing", {},
                                     [&] {
                                       let_time_pass();
                                       write("t.png", "new");
                                       return std::string("of which one?");
                                     }),
               spec::FileError);
  EXPECT_THROW(context->add_inputs(files), spec::FileError);
  write("t.png", "old");
  EXPECT_EQ(shared(*run(files), "of the old one"), "of the old one");
}

TEST_F(InputFilesOfARun, FileOutsideEveryKeyIsAnInternalError) {
  const std::vector<fs::path> files = {write("a", "one"), path_ / "none"};
  EXPECT_NO_THROW(run(files)->add_inputs(files));
  EXPECT_THROW(run(files)->add_inputs({write("b", "two")}), spec::CheckFailed);
}

TEST_F(InputFilesOfARun, ManifestListsFiles) {
  RunContext context(path_ / "out", parameters_, "x", 0);
  context.claim();
  context.add_inputs({write("a", "one"), path_ / "none"});
  context.add_configuration(write("c.yaml", "two"), "two");
  context.finish({});
  const Json manifest = Json::parse(tb::read_file(path_ / "out/manifest.json", 1 << 20));
  const Json expected = {{{"file", path_ / "a"}, {"sha256", sha256("one")}, {"bytes", 3}},
                         {{"file", path_ / "none"}, {"missing", true}},
                         {{"file", path_ / "c.yaml"},
                          {"sha256", sha256("two")},
                          {"role", "configuration"},
                          {"bytes", 3}}};
  EXPECT_EQ(manifest.at("inputs"), expected);
  const std::string page = tb::read_file(path_ / "out/report.html", 1 << 24);
  EXPECT_THAT(page, AllOf(HasSubstr("none  missing"), HasSubstr("configuration")));
}

TEST(DifferentInputs, DifferencesAreNamed) {
  const auto entry = [](const char* file, const char* content) {
    return input_entry(file, content);
  };
  const Json mesh = entry("m.obj", "1111111111"), texture = entry("t.png", "2222222222");
  const Json a = Json::array({mesh, texture});
  EXPECT_EQ(different_inputs(a, a), "");
  EXPECT_EQ(different_inputs(a, Json::array({entry("other/t.png", "2222222222"), mesh})), "");
  EXPECT_EQ(different_inputs(a, Json::array({mesh, entry("t.png", "3333333333")})),
            "A reads t.png (22222222), B reads t.png (33333333)");
  EXPECT_EQ(different_inputs(a, Json::array({mesh, entry("t.png", "missing")})),
            "A reads t.png (22222222), B reads t.png (missing)");
  EXPECT_EQ(different_inputs(a, Json::array({mesh, texture, texture})),
            "A reads no other file, B reads t.png (22222222)");
  EXPECT_EQ(
      different_inputs(a, Json::array({mesh, texture, input_entry("c", "4", "configuration")})),
      "");
  EXPECT_THAT(different_inputs(a, nullptr), HasSubstr("B reads no other file"));
}

}  // namespace
}  // namespace deburr::tool::input_files_test
