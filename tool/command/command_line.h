// SPDX-License-Identifier: MIT
// What the programs of the command have in common: they read the command line, hand over to one of
// their commands, and turn every outcome into an exit code and a last line "RESULT: ...".
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
  std::string text;                    // after "RESULT: "; empty: a command that only prints
  std::filesystem::path directory{};   // of the results
  std::string result = "result.json";  // in it: what --json shows
  std::string details{};               // a JSON object whose members --json shows, too
  // Arguments of `deburr` that show a failure again where the same command would not; empty: that.
  std::string repro{};
};

struct CommandLine {
  std::string text;   // as typed, and what does the same on another day
  char** words;       // as main() was given them
  bool json = false;  // the standard output is one JSON object
  std::function<Outcome()> action;
};

// Those that people are told of, in their order.
std::vector<const CLI::App*> commands_of(const CLI::App& app);
// The command of this name. ConfigError with near matches; `path` is the command line up to it.
const CLI::App& command_named(const CLI::App& app, const std::string& path,
                              const std::string& name);
// What --help ends with: command lines that do something useful.
// On standard output, as wide as its terminal.
void print_help(const std::string& text);
void show_examples(CLI::App& command, const std::vector<std::string>& lines);

// `add` adds the commands that the program has. Each leaves an action behind when it is the one
// that was called. Returns the exit code.
int run_command_line(int argc, char** argv, void (*add)(CLI::App& app, CommandLine& line));

}  // namespace deburr::tool
