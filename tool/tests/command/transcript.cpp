// SPDX-License-Identifier: MIT
#include "tool/tests/command/transcript.h"

#include <fmt/format.h>

#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string_view>
#include <utility>

#include "tb/base/file.h"
#include "tb/harness/test_paths.h"
#include "tool/command/commands.h"
#include "tool/pages/build_info.h"
#include "tool/tests/command/made_engine.h"

namespace deburr::tb {
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

// At blanks, but for those between ' and '.
std::vector<std::string> words_of(const std::string& line) {
  std::vector<std::string> words;
  bool quoted = false, open = false;
  for (const char c : line) {
    if (c == '\'') {
      quoted = !quoted;
      if (!open) words.emplace_back();
      open = true;
    } else if (c == ' ' && !quoted) {
      open = false;
    } else {
      if (!open) words.emplace_back();
      open = true;
      words.back() += c;
    }
  }
  return words;
}

// Without what gtest says of a worker.
std::string with_mark(const std::string& text, const std::string& mark) {
  std::istringstream lines(text);
  std::string marked;
  for (std::string line; std::getline(lines, line);)
    if (!line.starts_with("Running main()") && !line.starts_with("[==") && !line.starts_with("[--"))
      marked += mark + line + "\n";
  return marked;
}

std::string lines_with(const std::string& part, const std::string& text) {
  std::istringstream lines(text);
  std::string found;
  for (std::string line; std::getline(lines, line);)
    if (line.find(part) != std::string::npos) found += line + "\n";
  return found;
}

void replace_all(std::string& text, const std::string& what, const std::string& by) {
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at))
    text.replace(at, what.size(), by);
}

// The points of a sweep are run by this program, in the place of `deburr`.
class Worker : public testing::Environment {
  void SetUp() override {
    std::ifstream command("/proc/self/cmdline");
    std::vector<std::string> words;
    for (std::string word; std::getline(command, word, '\0');) words.push_back(word);
    if (words.size() < 2 || words[1] != "sweep-worker") return;
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    std::_Exit(
        run_command_line(static_cast<int>(words.size()), arguments.data(), add_all_commands));
  }
};
[[maybe_unused]] const testing::Environment* const worker =
    testing::AddGlobalTestEnvironment(new Worker);

}  // namespace

Transcript::Transcript()
    : before_(fs::current_path()),
      folder_(fs::path(testing::TempDir()) /
              (std::string("deburr_transcript_") +
               testing::UnitTest::GetInstance()->current_test_info()->name())) {
  fs::remove_all(folder_);
  fs::create_directories(folder_);
  fs::current_path(folder_);
  const BuildInfo& build = build_info();
  replaced_ = {{fmt::format("deburr {} ({}), {}, SystemC {}", build.version, build.commit,
                            build.compiler, build.systemc),
                "deburr VERSION (COMMIT), COMPILER, SystemC VERSION"},
               {fmt::format("\"deburr {}\"", build.version), "\"deburr VERSION\""}};
}

Transcript::~Transcript() {
  made_run() = nullptr;
  fs::current_path(before_);
  fs::remove_all(folder_);
}

Said Transcript::deburr(std::vector<std::string> words) {
  words.insert(words.begin(), "deburr");
  std::vector<char*> arguments;
  arguments.reserve(words.size() + 1);
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  const int code =
      run_command_line(static_cast<int>(words.size()), arguments.data(), add_all_commands);
  return {code, testing::internal::GetCapturedStdout(), testing::internal::GetCapturedStderr()};
}

void Transcript::expect(const std::string& file) {
  const fs::path expected_file = source_folder() / "tool/tests/command" / file;
  const std::string expected = read(expected_file);
  constexpr std::string_view kCommand = "$ deburr", kGrep = " | grep ", kStep = "% ", kText = "> ";
  std::string now, written;
  std::istringstream lines(expected);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("# ") && now.empty()) now += line + "\n";
    if (line.starts_with(kStep)) {
      const std::string what = line.substr(kStep.size());
      if (const auto step = steps_.find(what); step != steps_.end())
        step->second();
      else
        write(written = what, "");
      now += line + "\n" + std::exchange(said_, "");
    }
    if (line.starts_with(kText) && !written.empty()) {
      std::ofstream(written, std::ios::app) << line.substr(kText.size()) << "\n";
      now += line + "\n";
    }
    if (!line.starts_with(kCommand)) continue;
    const std::size_t pipe = line.find(kGrep);
    Said said = deburr(words_of(line.substr(kCommand.size(), pipe - kCommand.size())));
    for (std::string* const text : {&said.out, &said.errors})
      for (const auto& [what, by] : replaced_) replace_all(*text, what, by);
    if (pipe != std::string::npos)
      for (std::string* const text : {&said.out, &said.errors})
        *text = lines_with(line.substr(pipe + kGrep.size()), *text);
    now += line + "\n" + said.out + with_mark(said.errors, "! ");
    if (said.code != 0) now += fmt::format("= {}\n", said.code);
  }
  const fs::path left = fs::path(testing::TempDir()) / ("deburr_transcript_" + file);
  write(left, now);
  EXPECT_TRUE(now == expected) << "diff " << expected_file.string() << " " << left.string();
}

void Transcript::write(const fs::path& file, const std::string& text) {
  if (file.has_parent_path()) fs::create_directories(file.parent_path());
  std::ofstream(file) << text;
}

std::string Transcript::read(const fs::path& file) { return read_file(file, 1 << 24); }

}  // namespace deburr::tb
