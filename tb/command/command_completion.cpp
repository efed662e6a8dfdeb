// SPDX-License-Identifier: MIT
// `deburr completion bash`: a script that completes commands, options, parameters and their values,
// made from the command line's own description and the declarations of the parameters.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "tb/app/engine.h"
#include "tb/app/shorthands.h"
#include "tb/command/commands.h"
#include "tb/results/parameter_set.h"

namespace deburr::tb {
namespace {

// "a | b | c" -> "a b c"; nothing for any other range.
std::string choices(const std::string& range) {
  if (range.find(" | ") == std::string::npos || range == "name | file") return "";
  std::string words;
  for (const char c : range)
    if (c != '|' && !(c == ' ' && (words.empty() || words.back() == ' '))) words += c;
  return words;
}

// What may follow, by "PATH" (commands and options) and by "PATH:WORD" (its values).
using Words = std::map<std::string, std::string>;

void add_words(Words& words, const CLI::App& command, const std::string& path) {
  std::string& here = words[path];
  std::vector<const CLI::App*> subcommands = command.get_subcommands(nullptr);
  std::erase_if(subcommands, [](const CLI::App* sub) { return sub->get_group().empty(); });
  for (const CLI::App* sub : subcommands) here += sub->get_name() + " ";
  for (const CLI::Option* option : command.get_options())
    for (const std::string& name : option->get_lnames()) {
      here += "--" + name + " ";
      // What takes a value that nobody knows is left to the shell, which knows files.
      if (option->get_items_expected_min() > 0) words[fmt::format("{}:--{}", path, name)];
    }
  for (const CLI::App* sub : subcommands) add_words(words, *sub, path + " " + sub->get_name());
}

void add_parameters(Words& words) {
  for (const auto& engine : engines()) {
    const std::string path = fmt::format("deburr run {}", engine->name());
    ParameterSet set;
    RunParameters run = engine->run_parameters();
    set.add("run", ParameterKind::kRun, run);
    engine->add_parameters(set);
    for (const Parameter& p : set.all()) {
      words[path + ":--set"] += p.name + "= ";
      if (const std::string values = choices(p.range); !values.empty())
        words[path + ":" + p.name] = values;
    }
    for (const Shorthand& shorthand : shorthands_of(*engine))
      if (const std::string values = choices(set.find(shorthand.parameter)->range);
          !values.empty() && shorthand.second_parameter.empty())
        words[path + ":" + shorthand.option] = values;
  }
}

std::string bash_script(const CLI::App& app) {
  Words words;
  add_words(words, app, "deburr");
  add_parameters(words);
  words["deburr completion"] += "bash";
  std::string cases, commands;
  for (const auto& [key, values] : words) {
    cases += fmt::format("    '{}') words='{}' ;;\n", key, values);
    if (key.find(':') == std::string::npos) commands += fmt::format("'{}' | ", key);
  }
  commands.resize(commands.size() - 3);
  return fmt::format(R"(# Completion of deburr, made by `deburr completion bash`.
_deburr_words() {{
  local words=
  case "$1" in
{}    *) return 1 ;;
  esac
  printf %s "$words"
}}
_deburr() {{
  local path=deburr i word words before
  COMPREPLY=()
  for ((i = 1; i < COMP_CWORD; ++i)); do
    case "$path ${{COMP_WORDS[i]}}" in
      {}) path="$path ${{COMP_WORDS[i]}}" ;;
    esac
  done
  word=${{COMP_WORDS[COMP_CWORD]}}
  before=${{COMP_WORDS[COMP_CWORD - 1]}}
  # bash makes three words of NAME=VALUE.
  if [[ $word == = ]]; then
    word=
  elif [[ $before == = ]]; then
    before=${{COMP_WORDS[COMP_CWORD - 2]}}
  fi
  if words=$(_deburr_words "$path:$before"); then
    [[ $before != --set ]] || compopt -o nospace 2>/dev/null
  elif [[ ${{COMP_WORDS[COMP_CWORD - 1]}} == = ]]; then
    return
  else
    words=$(_deburr_words "$path")
  fi
  COMPREPLY=($(compgen -W "$words" -- "$word"))
}}
complete -o default -F _deburr deburr
)",
                     cases, commands);
}

}  // namespace

void add_completion(CLI::App& app, CommandLine& line) {
  CLI::App* command = app.add_subcommand("completion", "Print a script that completes commands");
  const auto shell = std::make_shared<std::string>("bash");
  command->add_option("SHELL", *shell, "bash")->check(CLI::IsMember({"bash"}));
  command->callback([&app, shell, &line] {
    line.action = [&app, shell] {
      fmt::print("{}", bash_script(app));
      return Outcome{};
    };
  });
}

}  // namespace deburr::tb
