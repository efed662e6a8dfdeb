// SPDX-License-Identifier: MIT
// `deburr completion bash | zsh | fish`: a script that completes commands, actions, options, units,
// parameters and their values, and faults. It is generated from the command line's description and
// the engines' declarations.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tb/run/parameter_set.h"
#include "tool/command/commands.h"
#include "tool/run/engine.h"
#include "tool/run/reference_pages.h"
#include "tool/run/shorthands.h"

namespace deburr::tool {
namespace {

// Completion words, keyed by "PLACE" (a command: its subcommands and options), "PLACE:WORD" (the
// values of an option or a parameter) and "PLACE@N" (the N-th positional argument). There is no
// entry where only the shell knows the words, as for files.
using Words = std::map<std::string, std::string>;

// "a | b | c" and "list of a, b, c" -> "a b c"; empty for any other range.
std::string choices(const std::string& range) {
  constexpr std::string_view kListOf = "list of ";
  if (range.starts_with(kListOf)) {
    std::string words = range.substr(kListOf.size());
    std::erase(words, ',');
    return words;
  }
  if (range.find(" | ") == std::string::npos || range.starts_with("name | file")) return "";
  std::string words;
  for (const char c : range)
    if (c != '|' && !(c == ' ' && (words.empty() || words.back() == ' '))) words += c;
  return words;
}

std::string values_of(const tb::Parameter& parameter) {
  std::string words = choices(parameter.range);
  for (const std::string& alias : parameter.aliases) words += " " + alias;
  return words;
}

// The format in which CLI11 prints IsMember: "TEXT:{plan,run}".
std::string values_of(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  const std::size_t begin = type.find('{'), end = type.find('}');
  if (begin == std::string::npos || end == std::string::npos) return "";
  std::string words = type.substr(begin + 1, end - begin - 1);
  for (char& c : words)
    if (c == ',') c = ' ';
  return words;
}

void add_words(Words& words, const CLI::App& command, const std::string& place) {
  std::string& here = words[place];
  const std::vector<const CLI::App*> commands = commands_of(command);
  for (const CLI::App* sub : commands) here += sub->get_name() + " ";
  int position = 0;
  for (const CLI::Option* option : command.get_options()) {
    if (option->get_group().empty()) continue;  // removed: kept only for its message
    const std::string values = values_of(*option);
    for (const std::string& name : option->get_lnames()) {
      here += "--" + name + " ";
      if (option->get_items_expected_min() > 0 || !values.empty())
        words[fmt::format("{}:--{}", place, name)] = values;
    }
    for (const std::string& name : option->get_snames())
      if (option->get_items_expected_min() > 0) words[fmt::format("{}:-{}", place, name)] = values;
    if (option->get_positional()) words[fmt::format("{}@{}", place, position++)] = values;
  }
  for (const CLI::App* sub : commands) add_words(words, *sub, place + " " + sub->get_name());
}

void add_parameters(Words& words, Engine& engine) {
  const std::string place = fmt::format("deburr run {}", engine.name());
  std::string& units = words["deburr params@0"];
  tb::ParameterSet set;
  RunParameters run = engine.run_parameters();
  set.add("run", tb::ParameterKind::kRun, run);
  engine.add_parameters(set);
  for (const tb::Parameter& p : set.all()) {
    words[place + ":--set"] += p.name + "= ";
    if (const std::string values = values_of(p); !values.empty())
      words[place + ":" + p.name] = values;
    const std::string unit = p.name.substr(0, p.name.find('.')) + " ";
    if ((" " + units).find(" " + unit) == std::string::npos) units += unit;
  }
  const std::string faults = fmt::format("{}", fmt::join(fault_names(engine), " "));
  words[place + ":run.fault"] = faults;
  for (const Shorthand& shorthand : shorthands_of(engine)) {
    if (!shorthand.second_parameter.empty()) continue;
    const tb::Parameter& parameter = *set.find(shorthand.parameter);
    const std::string values = parameter.name == "run.fault" ? faults : values_of(parameter);
    if (!values.empty() && parameter.range != "true | false")
      words[place + ":" + shorthand.option] = values;
  }
}

Words words_of(const CLI::App& app) {
  Words words;
  add_words(words, app, "deburr");
  for (const auto& engine : engines()) {
    add_parameters(words, *engine);
    words["deburr help@1"] += fmt::format("{} ", engine->name());
  }
  for (const CLI::App* command : commands_of(app))
    words["deburr help@0"] += command->get_name() + " ";
  words["deburr regress@0"] = words["deburr regress@1"];  // just an action
  return words;
}

// Places as a list of patterns or words.
std::string places_of(const Words& words, std::string_view between) {
  std::string places;
  for (const auto& [key, values] : words)
    if (key.find_first_of(":@") == std::string::npos)
      places += fmt::format("{}'{}'", places.empty() ? "" : between, key);
  return places;
}

// The script with @TABLE@ and @PLACES@ replaced.
std::string filled(std::string_view script, const std::string& table, const std::string& places) {
  std::string text(script);
  for (const auto& [mark, content] : {std::pair("@TABLE@\n", table), {"@PLACES@", places}})
    text.replace(text.find(mark), std::string_view(mark).size(), content);
  return text;
}

constexpr std::string_view kBash = R"sh(# Completion of deburr, made by `deburr completion bash`.
_deburr_words() {
  local found=
  case "$1" in
@TABLE@
    *) return 1 ;;
  esac
  printf %s "$found"
}
_deburr() {
  local place=deburr i word before words count=0
  COMPREPLY=()
  for ((i = 1; i < COMP_CWORD; ++i)); do
    word=${COMP_WORDS[i]} before=${COMP_WORDS[i - 1]}
    case "$place $word" in
      @PLACES@) place="$place $word" ;;
      *) [[ $word == -* || $word == = || $before == = ]] || _deburr_words "$place:$before" >/dev/null || ((++count)) ;;
    esac
  done
  word=${COMP_WORDS[COMP_CWORD]}
  before=${COMP_WORDS[COMP_CWORD - 1]}
  # bash makes three words of NAME=VALUE.
  if [[ $word == = ]]; then
    word=
  elif [[ $before == = ]]; then
    before=${COMP_WORDS[COMP_CWORD - 2]}
  fi
  if [[ $word == -* ]]; then
    words=$(_deburr_words "$place")
  elif words=$(_deburr_words "$place:$before"); then
    [[ $before != --set ]] || compopt -o nospace 2>/dev/null
  elif [[ ${COMP_WORDS[COMP_CWORD - 1]} == = ]]; then
    return
  elif ! words=$(_deburr_words "$place@$count"); then
    words=$(_deburr_words "$place")
  fi
  COMPREPLY=($(compgen -W "$words" -- "$word"))
}
complete -o default -F _deburr deburr
)sh";

constexpr std::string_view kZsh = R"sh(#compdef deburr
# Completion of deburr, made by `deburr completion zsh`.
_deburr_words() {
  local found=
  case "$1" in
@TABLE@
    *) return 1 ;;
  esac
  printf %s "$found"
}
_deburr() {
  local place=deburr i word before list
  integer count=0
  for ((i = 2; i < CURRENT; ++i)); do
    word=${words[i]} before=${words[i - 1]}
    case "$place $word" in
      (@PLACES@) place="$place $word" ;;
      (*) [[ $word == -* ]] || _deburr_words "$place:$before" >/dev/null || ((++count)) ;;
    esac
  done
  word=${words[CURRENT]}
  before=${words[CURRENT - 1]}
  if [[ $word == *=* && ($before == --set || $word == --*) ]]; then
    list=$(_deburr_words "$place:${word%%=*}") || return 1
    compset -P '*='
    compadd -- ${=list} || _files
  elif [[ $word == -* ]]; then
    compadd -- ${=$(_deburr_words "$place")}
  elif list=$(_deburr_words "$place:$before"); then
    if [[ $before == --set ]]; then
      compadd -S '' -- ${=list}
    else
      compadd -- ${=list} || _files
    fi
  elif list=$(_deburr_words "$place@$count"); then
    compadd -- ${=list} || _files
  else
    compadd -- ${=$(_deburr_words "$place")}
  fi
}
if [[ ${funcstack[1]} == _deburr ]]; then
  _deburr "$@"
elif (($+functions[compdef])); then
  compdef _deburr deburr
fi
)sh";

constexpr std::string_view kFish = R"sh(# Completion of deburr, made by `deburr completion fish`.
function __deburr_words
  switch $argv[1]
@TABLE@
    case '*'
      return 1
  end
  return 0
end
function __deburr_complete
  set -l tokens (commandline -opc)
  set -l word (commandline -ct)
  set -l place deburr
  set -l before deburr
  set -l count 0
  for token in $tokens[2..-1]
    if contains -- "$place $token" @PLACES@
      set place "$place $token"
    else if not string match -q -- '-*' $token; and not __deburr_words "$place:$before" >/dev/null
      set count (math $count + 1)
    end
    set before $token
  end
  if test "$before" = --set; and string match -q -- '*=*' $word
    set -l name (string split -m 1 = -- $word)[1]
    for value in (__deburr_words "$place:$name")
      echo "$name=$value"
    end
  else if string match -q -- '-*' $word
    __deburr_words $place
  else if __deburr_words "$place:$before"
  else if __deburr_words "$place@$count"
  else
    __deburr_words $place
  end
end
complete -c deburr -f -a '(__deburr_complete)'
complete -c deburr -n 'test -z "$(__deburr_complete | string collect)"' -F
)sh";

// For bash and zsh, or for fish.
std::string table_of(const Words& words, bool fish) {
  std::string table;
  for (const auto& [key, values] : words)
    table += fish ? fmt::format("    case '{}'\n      string split -n ' ' -- '{}'\n", key, values)
                  : fmt::format("    '{}') found='{}' ;;\n", key, values);
  return table;
}

std::string script_for(const std::string& shell, const CLI::App& app) {
  const Words words = words_of(app);
  const bool fish = shell == "fish";
  return filled(fish             ? kFish
                : shell == "zsh" ? kZsh
                                 : kBash,
                table_of(words, fish), places_of(words, fish ? " " : " | "));
}

}  // namespace

void add_completion(CLI::App& app, CommandLine& line) {
  CLI::App* command = app.add_subcommand("completion", "Print a script that completes commands");
  show_examples(*command,
                {"deburr completion bash > ~/.local/share/bash-completion/completions/deburr",
                 "deburr completion zsh > ~/.zfunc/_deburr",
                 "deburr completion fish > ~/.config/fish/completions/deburr.fish"});
  const auto shell = std::make_shared<std::string>("bash");
  command->add_option("SHELL", *shell, "Shell to complete commands in")
      ->check(CLI::IsMember({"bash", "zsh", "fish"}))
      ->capture_default_str();
  command->callback([&app, shell, &line] {
    line.action = [&app, shell] {
      fmt::print("{}", script_for(*shell, app));
      return Outcome{};
    };
  });
}

}  // namespace deburr::tool
