// SPDX-License-Identifier: MIT
// Shared by the programs of the command: parses the command line, calls one of the commands, and
// converts every outcome to an exit code and a last line "RESULT: ...".
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace deburr::tool {

struct Outcome {
  int code = 0;
  std::string text;                    // after "RESULT: "; empty for a command that only prints
  std::filesystem::path directory{};   // of the results
  std::string result = "result.json";  // file in it that --json shows
  std::string details{};               // a JSON object; --json shows its members too
  // Arguments of `deburr` that reproduce a failure if the same command would not; empty: the
  // command does.
  std::string repro{};
};

struct CommandLine {
  std::string text;   // as typed, plus what is needed to reproduce it later
  char** words;       // argv of main()
  bool json = false;  // standard output is one JSON object
  std::function<Outcome()> action;
};

// The documented commands, in their order.
std::vector<const CLI::App*> commands_of(const CLI::App& app);
// The command of this name. Throws ConfigError with near matches; `path` is the command line up to
// it.
const CLI::App& command_named(const CLI::App& app, const std::string& path,
                              const std::string& name);
// Prints the end of --help, example command lines, wrapped to the terminal's width.
void print_help(const std::string& text);
void show_examples(CLI::App& command, const std::vector<std::string>& lines);

// `add` registers the program's commands. The called command stores its action. Returns the exit
// code.
int run_command_line(int argc, char** argv, void (*add)(CLI::App& app, CommandLine& line));

}  // namespace deburr::tool
