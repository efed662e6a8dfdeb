// SPDX-License-Identifier: MIT
// `deburr help [COMMAND]`: what `deburr COMMAND --help` prints.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <string>
#include <vector>

#include "tb/app/engine.h"
#include "tb/command/commands.h"

namespace deburr::tb {
namespace {

std::string help_page(const CLI::App& app, const std::vector<std::string>& words) {
  const CLI::App* command = &app;
  std::string path = app.get_name();
  for (const std::string& word : words) {
    command = &command_named(*command, path, word);
    path += " " + word;
  }
  // By itself App::help() would tell of the command that was given, which is this one.
  return command->get_formatter()->make_help(command, path, CLI::AppFormatMode::Normal);
}

}  // namespace

void add_help(CLI::App& app, CommandLine& line) {
  CLI::App* command = app.add_subcommand("help", "What a command does, and its options");
  show_examples(*command, {"deburr help sweep",
                           fmt::format("deburr help run {}", engines().front()->name())});
  const auto words = std::make_shared<std::vector<std::string>>();
  command->add_option("COMMAND", *words, "The command (all of them)");
  command->callback([&app, words, &line] {
    line.action = [&app, words] {
      fmt::print("{}", help_page(app, *words));
      return Outcome{};
    };
  });
}

}  // namespace deburr::tb
