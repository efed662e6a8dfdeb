// SPDX-License-Identifier: MIT
// Life cycle of a directory of results: its owner, the removal of earlier results, the state after
// a crash.
#include "tool/pages/run_directory.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "spec/error.h"
#include "tb/base/file.h"

namespace deburr::tool::run_directory_test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;

constexpr const char* kHead = "result.json";
const std::vector<std::string> kNames = {"after.png", "before.png", "golden.png", kHead};
using Contents = std::map<std::string, std::string>;

class Life : public testing::Test {
 protected:
  Life()
      : root_(fs::temp_directory_path() / ("deburr_life_" + std::to_string(::getpid()))),
        path_(root_ / "runs/out") {
    fs::create_directories(root_);
  }
  ~Life() override { fs::remove_all(root_); }

  static void put(const fs::path& file, const std::string& text) { std::ofstream(file) << text; }
  // Everything in the directory except the manifest, whose list of files differs.
  Contents contents() const {
    Contents found;
    for (const auto& entry : fs::directory_iterator(path_))
      if (entry.path().filename() != "manifest.json")
        found[entry.path().filename().string()] =
            entry.is_directory() ? "a folder" : tb::read_file(entry.path(), 1 << 16);
    return found;
  }
  void claim(RunDirectory& directory, IfTaken if_taken = IfTaken::kReject) const {
    directory.claim("deburr run", kNames, if_taken);
  }
  static void draft(const RunDirectory& directory, const Contents& files) {
    for (const auto& [name, text] : files) put(directory.draft() / name, text);
  }
  void leave(const Contents& files) const {
    RunDirectory directory(path_);
    claim(directory);
    draft(directory, files);
    directory.publish({{"unit", "x"}}, kHead);
  }
  // A process that claims the directory, writes this draft and is killed.
  void die_with(const Contents& files) const {
    const pid_t child = ::fork();
    if (child == 0) {
      RunDirectory directory(path_);
      claim(directory);
      draft(directory, files);
      ::raise(SIGKILL);
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    ASSERT_TRUE(WIFSIGNALED(status));
  }
  template <class Error, class Action>
  static std::string text_of(Action action) {
    try {
      action();
    } catch (const Error& error) {
      return error.what();
    }
    return "nothing was thrown";
  }

  fs::path root_, path_;
  const Contents old_ = {{"before.png", "old"}, {"golden.png", "old"}, {kHead, "old"}};
  const Contents new_ = {{"after.png", "new"}, {"before.png", "new"}, {kHead, "new"}};
};

TEST_F(Life, FinishedRunReplacesEarlierResultsAndKeepsForeignFiles) {
  leave(old_);
  put(path_ / "notes.txt", "mine");
  put(path_ / "photo.png", "mine");
  RunDirectory directory(path_);
  claim(directory);
  draft(directory, new_);
  Contents seen = contents();
  EXPECT_EQ(seen.erase(".deburr_run"), 1u);
  Contents expected = old_;
  expected["notes.txt"] = expected["photo.png"] = "mine";
  EXPECT_EQ(seen, expected);
  directory.publish({}, kHead);
  expected = new_;
  expected["notes.txt"] = expected["photo.png"] = "mine";
  EXPECT_EQ(contents(), expected);
}

TEST_F(Life, UnfinishedRunLeavesNothing) {
  {
    RunDirectory directory(path_);
    claim(directory);
    draft(directory, new_);
  }
  EXPECT_TRUE(fs::is_empty(root_)) << "nor the folders that it made";
  fs::create_directories(path_);
  { RunDirectory never_claimed(path_); }
  EXPECT_TRUE(fs::is_empty(path_));
  leave(old_);
  {
    RunDirectory directory(path_);
    claim(directory);
    draft(directory, new_);
  }
  EXPECT_EQ(contents(), old_);
}

TEST_F(Life, RemovesFilesOfDeadRun) {
  die_with(new_);
  EXPECT_TRUE(fs::exists(path_ / ".deburr_run/before.png"));
  EXPECT_FALSE(fs::exists(path_ / "before.png"));
  leave(old_);
  EXPECT_EQ(contents(), old_);
  die_with(new_);
  leave({{kHead, "third"}});
  EXPECT_EQ(contents(), (Contents{{kHead, "third"}}));
}

TEST_F(Life, NextRunCompletesInterruptedMove) {
  const std::vector<std::pair<std::string, bool>> steps = {
      // file, and whether it is moved or removed
      {kHead, false},       {"golden.png", false}, {"after.png", true},
      {"before.png", true}, {kHead, true},         {"manifest.json", true}};
  for (std::size_t done = 0; done <= steps.size(); ++done) {
    fs::remove_all(path_);
    leave(old_);
    put(path_ / "notes.txt", "mine");
    die_with(new_);
    const fs::path draft = path_ / ".deburr_run";
    put(draft / "manifest.json", R"({"files": ["after.png", "before.png", "result.json"]})");
    for (std::size_t i = 0; i < done; ++i)
      if (const auto& [name, moves] = steps[i]; moves)
        fs::rename(draft / name, path_ / name);
      else
        fs::remove(path_ / name);
    {
      RunDirectory next(path_);
      claim(next);
    }
    Contents expected = new_;
    expected["notes.txt"] = "mine";
    EXPECT_EQ(contents(), expected) << done << " steps";
    leave(old_);
    expected = old_;
    expected["notes.txt"] = "mine";
    EXPECT_EQ(contents(), expected) << done << " steps";
  }
}

TEST_F(Life, DirectoryBelongsToOneRun) {
  RunDirectory first(path_), second(path_);
  claim(first);
  EXPECT_THAT(text_of<spec::FileError>([&] { claim(second); }),
              testing::AllOf(HasSubstr("used by another run"), HasSubstr("--wait"),
                             HasSubstr("process " + std::to_string(::getpid()) + " on ")));
  draft(first, new_);
  first.publish({}, kHead);
  claim(second);
  EXPECT_EQ(fs::exists(second.draft()), true);
}

TEST_F(Life, ClaimFileNamesOwner) {
  RunDirectory first(path_), second(path_);
  first.claim("deburr run x --seed 3", kNames, IfTaken::kReject);
  const nlohmann::json claim =
      nlohmann::json::parse(tb::read_file(path_ / ".deburr_run/claim.json", 1 << 16));
  char host[256] = {};
  ::gethostname(host, sizeof host - 1);
  EXPECT_EQ(claim.at("state"), "running");
  EXPECT_EQ(claim.at("process"), ::getpid());
  EXPECT_EQ(claim.at("host"), host);
  EXPECT_EQ(claim.at("command"), "deburr run x --seed 3");
  EXPECT_THAT(claim.at("started").get<std::string>(),
              testing::MatchesRegex("....-..-..T..:..:..Z"));
  EXPECT_EQ(claim.size(), 5u);
  EXPECT_THAT(text_of<spec::FileError>([&] { this->claim(second); }),
              HasSubstr("process " + std::to_string(::getpid()) + " on " + host + " since " +
                        claim.at("started").get<std::string>() + " (deburr run x --seed 3)"));
}

TEST_F(Life, WaitingRunGetsTheDirectory) {
  auto first = std::make_unique<RunDirectory>(path_);
  claim(*first);
  std::thread ends([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    draft(*first, new_);
    first->publish({}, kHead);
  });
  RunDirectory second(path_);
  claim(second, IfTaken::kWait);
  ends.join();
  Contents seen = contents();
  seen.erase(".deburr_run");
  EXPECT_EQ(seen, new_) << "the first was over when the second began";
}

TEST_F(Life, KeepsFilesNotNamedByManifest) {
  fs::create_directories(path_);
  for (const char* name : {"before.png", kHead, "manifest.json"}) {
    put(path_ / name, "{}");
    RunDirectory directory(path_);
    EXPECT_THAT(text_of<spec::ConfigError>([&] { claim(directory); }), HasSubstr(name));
    EXPECT_EQ(tb::read_file(path_ / name, 10), "{}");
    fs::remove(path_ / name);
  }
  // A file that appears during the run.
  RunDirectory directory(path_);
  claim(directory);
  draft(directory, new_);
  put(path_ / "after.png", "mine");
  EXPECT_THROW(directory.publish({}, kHead), spec::ConfigError);
  EXPECT_EQ(tb::read_file(path_ / "after.png", 10), "mine");
}

TEST_F(Life, ManifestNamesOnlyFilesOfRuns) {
  leave(old_);
  put(path_ / "thesis.tex", "mine");
  put(root_ / "runs/other.png", "mine");
  put(path_ / "manifest.json", R"({"files": ["thesis.tex", "../other.png", 7, "result.json",
                                             "before.png", "golden.png"]})");
  leave(new_);
  EXPECT_TRUE(fs::exists(path_ / "thesis.tex"));
  EXPECT_TRUE(fs::exists(root_ / "runs/other.png"));
  EXPECT_FALSE(fs::exists(path_ / "golden.png"));
}

TEST_F(Life, RunKeepsItsInputs) {
  leave(old_);
  put(path_ / "mine.png", "mine");
  fs::create_symlink(path_ / "before.png", path_ / "link.png");
  RunDirectory directory(path_);
  claim(directory);
  for (const char* name : {"before.png", "link.png", "manifest.json"})
    EXPECT_THAT(text_of<spec::ConfigError>([&] { directory.reject_to_replace(path_ / name); }),
                HasSubstr(name));
  directory.reject_to_replace(path_ / "mine.png");
}

// A file of an earlier run that this run does not write would be removed.
TEST_F(Life, RunDoesNotRemoveItsInputs) {
  leave(old_);
  RunDirectory directory(path_);
  directory.claim("deburr run", {"after.png", kHead}, IfTaken::kReject);
  EXPECT_THAT(
      text_of<spec::ConfigError>([&] { directory.reject_to_replace(path_ / "golden.png"); }),
      HasSubstr("golden.png"));
}

TEST_F(Life, ReportsObstacles) {
  put(root_ / "runs", "a file");
  RunDirectory below_a_file(path_);
  EXPECT_THAT(text_of<spec::FileError>([&] { claim(below_a_file); }), HasSubstr("runs"));
  EXPECT_EQ(tb::read_file(root_ / "runs", 10), "a file");
  fs::create_directories(root_ / "elsewhere");
  put(root_ / "elsewhere/before.png", "mine");
  fs::create_directories(root_ / "linked");
  fs::create_symlink(root_ / "elsewhere", root_ / "linked/.deburr_run");
  RunDirectory linked(root_ / "linked");
  EXPECT_THROW(claim(linked), spec::FileError);
  EXPECT_TRUE(fs::exists(root_ / "elsewhere/before.png"));
}

}  // namespace
}  // namespace deburr::tool::run_directory_test
