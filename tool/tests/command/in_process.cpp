// SPDX-License-Identifier: MIT
#include "tool/tests/command/in_process.h"

#include <fmt/format.h>
#include <wordexp.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "tb/base/file.h"
#include "tool/command/commands.h"
#include "tool/pages/build_info.h"
#include "tool/tests/command/made_engine.h"

namespace deburr::tool {
namespace {

namespace fs = std::filesystem;

void add_all_commands(CLI::App& app, CommandLine& line) {
  add_run(app, line);
  add_papers(app, line, start_papers);
  add_train(app, line, start_train);
  add_params(app, line);
  add_compare(app, line);
  add_report(app, line);
  add_sweep(app, line);
  add_regress(app, line);
  add_completion(app, line);
  add_help(app, line);
}

int run_words(std::size_t count, char** words) {
  return run_command_line(static_cast<int>(count), words, add_all_commands);
}

// A sweep starts this program as its worker, as it would start `deburr`.
class Worker : public testing::Environment {
  void SetUp() override {
    std::vector<std::string> arguments = testing::internal::GetArgvs();
    if (arguments.size() < 2 || arguments[1] != "sweep-worker") return;
    std::vector<char*> words;
    for (std::string& word : arguments) words.push_back(word.data());
    words.push_back(nullptr);
    std::_Exit(run_words(arguments.size(), words.data()));
  }
};
[[maybe_unused]] const testing::Environment* const worker =
    testing::AddGlobalTestEnvironment(new Worker);

std::string name_of_this_test() {
  const testing::TestInfo& test = *testing::UnitTest::GetInstance()->current_test_info();
  std::string name = fmt::format("deburr_command_{}_{}", test.test_suite_name(), test.name());
  std::replace(name.begin(), name.end(), '/', '_');
  return name;
}

}  // namespace

InProcess::InProcess()
    : before_(fs::current_path()), folder_(fs::path(testing::TempDir()) / name_of_this_test()) {
  fs::remove_all(folder_);
  fs::create_directories(folder_);
  fs::current_path(folder_);
  const BuildInfo& build = build_info();
  replaced_ = {{fmt::format("deburr {} ({}), {}, SystemC {}", build.version, build.commit,
                            build.compiler, build.systemc),
                "deburr VERSION (COMMIT), COMPILER, SystemC VERSION"},
               {fmt::format("\"deburr {}\"", build.version), "\"deburr VERSION\""}};
}

InProcess::~InProcess() {
  made_run() = nullptr;
  fs::current_path(before_);
  fs::remove_all(folder_);
}

std::string InProcess::printed(const std::string& line) {
  wordexp_t words{};
  EXPECT_EQ(::wordexp(("deburr " + line).c_str(), &words, WRDE_NOCMD), 0) << line;
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  const int code = run_words(words.we_wordc, words.we_wordv);
  ::wordfree(&words);
  std::string text = testing::internal::GetCapturedStdout();
  std::istringstream errors(testing::internal::GetCapturedStderr());
  for (std::string error; std::getline(errors, error);) {
    // A worker also prints GoogleTest's own lines.
    if (error.starts_with("Running main()") || error.starts_with("[==") || error.starts_with("[--"))
      continue;
    text += "! " + error + "\n";
  }
  for (const auto& [what, by] : replaced_)
    for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at))
      text.replace(at, what.size(), by);
  return code == 0 ? text : text + fmt::format("= {}\n", code);
}

nlohmann::ordered_json InProcess::json(const std::string& line) {
  const std::string text = printed(line);
  return nlohmann::ordered_json::parse(text.substr(0, text.find("\n}\n") + 2));
}

std::string InProcess::result(const std::string& line) {
  const std::string text = "\n" + printed(line), mark = "\nRESULT: ";
  const std::size_t at = text.find(mark);
  if (at == std::string::npos) return "none: " + text;
  return text.substr(at + mark.size(), text.find('\n', at + 1) - at - mark.size());
}

void InProcess::expect_failure(const std::string& line, const std::string& failure) {
  static const std::map<std::string, int> kCodes = {
      {"usage", 2}, {"configuration", 2}, {"simulation", 3}, {"file", 5}};
  const std::size_t colon = failure.find(": ");
  EXPECT_EQ(printed(line),
            fmt::format("REPRO: deburr{}{}\nRESULT: FAIL {}\n! deburr: {}\n= {}\n",
                        line.empty() ? "" : " ", line, failure, failure.substr(colon + 2),
                        kCodes.at(failure.substr(0, colon))));
}

void InProcess::write(const fs::path& file, const std::string& text) {
  if (file.has_parent_path()) fs::create_directories(file.parent_path());
  std::ofstream(file) << text;
}

std::string InProcess::read(const fs::path& file) { return tb::read_file(file, 1 << 24); }

}  // namespace deburr::tool
