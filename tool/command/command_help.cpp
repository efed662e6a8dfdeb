// SPDX-License-Identifier: MIT
// `deburr help [COMMAND]` prints `deburr COMMAND --help`; `deburr help --man` prints all of it as a
// manual page.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "tool/command/commands.h"
#include "tool/pages/build_info.h"
#include "tool/run/engine.h"

namespace deburr::tool {
namespace {

std::string help_page(const CLI::App& app, const std::vector<std::string>& words) {
  const CLI::App* command = &app;
  std::string path = app.get_name();
  for (const std::string& word : words) {
    command = &command_named(*command, path, word);
    path += " " + word;
  }
  // App::help() would describe the command that was called, which is `help` itself.
  return command->get_formatter()->make_help(command, path, CLI::AppFormatMode::Normal);
}

// Text that roff prints verbatim, between .nf and .fi.
std::string verbatim(const std::string& text) {
  std::string roff = text.starts_with('.') || text.starts_with('\'') ? "\\&" : "";
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '\\')
      roff += "\\e";
    else if (c == '-')
      roff += "\\-";
    else
      roff += c;
    if (c == '\n' && i + 1 < text.size() && (text[i + 1] == '.' || text[i + 1] == '\''))
      roff += "\\&";
  }
  return ".nf\n" + roff + (roff.ends_with('\n') ? "" : "\n") + ".fi\n";
}

void add_commands(std::string& page, const CLI::App& app, std::vector<std::string> words) {
  std::vector<const CLI::App*> below = {&app};
  for (const std::string& word : words) below.push_back(&command_named(*below.back(), "", word));
  for (const CLI::App* command : commands_of(*below.back())) {
    words.push_back(command->get_name());
    page +=
        fmt::format(".SS deburr {}\n{}", fmt::join(words, " "), verbatim(help_page(app, words)));
    add_commands(page, app, words);
    words.pop_back();
  }
}

// The page has no date, so that builds of one commit are identical.
std::string man_page(const CLI::App& app) {
  std::string page = fmt::format(
      ".\\\" SPDX-License-Identifier: MIT, made by `deburr help --man`\n"
      ".TH DEBURR 1 \"\" \"deburr {}\" \"User Commands\"\n.SH NAME\ndeburr \\- {}\n"
      ".SH SYNOPSIS\n.B deburr\n.I COMMAND\n[\n.I OPTIONS\n]\n.SH DESCRIPTION\n{}.SH COMMANDS\n",
      build_info().version, app.get_description(), verbatim(help_page(app, {})));
  add_commands(page, app, {});
  return page;
}

}  // namespace

void add_help(CLI::App& app, CommandLine& line) {
  CLI::App* command = app.add_subcommand("help", "Show what a command does and its options");
  show_examples(*command, {"deburr help sweep",
                           fmt::format("deburr help run {}", engines().front()->name())});
  const auto words = std::make_shared<std::vector<std::string>>();
  command->add_option("COMMAND", *words, "The command (default: all)");
  const auto man = std::make_shared<bool>(false);
  command->add_flag("--man", *man, "Print everything as a manual page, for man -l -")
      ->excludes(command->get_option("COMMAND"));
  command->callback([&app, words, man, &line] {
    line.action = [&app, words, man] {
      if (*man)
        fmt::print("{}", man_page(app));
      else
        print_help(help_page(app, *words));
      return Outcome{};
    };
  });
}

}  // namespace deburr::tool
