// SPDX-License-Identifier: MIT
// The commands of `deburr`. Each adds its options to the command line and leaves an action behind
// when it is the one that was called.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

namespace CLI {
class App;
}

namespace deburr::tb {

struct Outcome {
  int code = 0;
  std::string text;                    // after "RESULT: "; empty: a command that only prints
  std::filesystem::path directory{};   // of the results
  std::string result = "result.json";  // in it: what --json shows
  std::string comparison{};            // JSON that --json shows
};

struct CommandLine {
  std::string text;   // as typed, and what does the same on another day
  bool json = false;  // the standard output is one JSON object
  std::function<Outcome()> action;
};

void add_run(CLI::App& app, CommandLine& line);
void add_papers(CLI::App& app, CommandLine& line);
void add_params(CLI::App& app, CommandLine& line);
void add_compare(CLI::App& app, CommandLine& line);
void add_report(CLI::App& app, CommandLine& line);
void add_sweep(CLI::App& app, CommandLine& line);
void add_regress(CLI::App& app, CommandLine& line);
void add_completion(CLI::App& app, CommandLine& line);

}  // namespace deburr::tb
