// SPDX-License-Identifier: MIT
#include "tool/command/command_line.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "spec/error.h"
#include "tb/base/file.h"
#include "tb/base/headline.h"
#include "tb/base/interrupt.h"
#include "tb/base/json_text.h"
#include "tb/base/near_matches.h"
#include "tb/base/shell.h"
#include "tb/base/terminal.h"
#include "tb/run/parameter_set.h"
#include "tb/run/result.h"
#include "tool/pages/build_info.h"

namespace deburr::tool {
namespace {

using Json = nlohmann::ordered_json;
using spec::ExitCode;

// CLI11 lists excluded options by address, in an order that differs from run to run.
class OrderedFormatter : public CLI::Formatter {
 public:
  std::string make_option_opts(const CLI::Option* option) const override {
    std::string text = CLI::Formatter::make_option_opts(option);
    constexpr std::string_view kExcludes = " Excludes:";
    const std::size_t at = text.rfind(kExcludes);
    if (at == std::string::npos) return text;
    std::vector<std::string> names;
    for (const CLI::Option* excluded : option->get_excludes())
      names.push_back(excluded->get_name());
    std::sort(names.begin(), names.end());
    text.erase(at + kExcludes.size());
    for (const std::string& name : names) text += " " + name;
    return text;
  }
};

std::string quoted_command(int argc, char** argv) {
  std::string command;
  for (int i = 0; i < argc; ++i) command += (i > 0 ? " " : "") + tb::shell_quoted(argv[i]);
  return command;
}

int finish(const Outcome& outcome, const CommandLine& line) {
  std::fflush(stdout);
  const std::string repro =
      outcome.repro.empty() ? line.text : tb::shell_quoted(line.words[0]) + " " + outcome.repro;
  if (line.json) {
    Json object = {{"exit_code", outcome.code}, {"outcome", outcome.text}, {"command", line.text}};
    if (outcome.code != 0) object["repro"] = repro;
    if (!outcome.directory.empty()) {
      object["directory"] = outcome.directory.string();
      object["result"] =
          tb::parse_json(tb::read_file(outcome.directory / outcome.result, tb::kMaxResultBytes));
    }
    if (!outcome.details.empty()) object.update(tb::parse_json(outcome.details));
    fmt::print("{}\n", tb::json_text(object, 2, tb::NotUtf8::kReplace));
    return outcome.code;
  }
  if (outcome.code != 0) fmt::print("REPRO: {}\n", repro);
  fmt::print("RESULT: {}\n", outcome.text);
  return outcome.code;
}

// If a standard stream is closed, the next file that is opened would get its number and receive
// what is printed. So /dev/null takes the place of the stream: output to it fails, errors are
// discarded.
void fill_closed_streams() {
  for (const auto& [stream, mode] :
       {std::pair(STDIN_FILENO, O_RDONLY), {STDOUT_FILENO, O_RDONLY}, {STDERR_FILENO, O_WRONLY}})
    // open() takes the lowest free number
    if (::fcntl(stream, F_GETFD) == -1) ::open("/dev/null", mode);
}

bool is_utf8(const std::string& text) {
  try {
    return !tb::json_text(nlohmann::ordered_json(text)).empty();
  } catch (const nlohmann::ordered_json::exception&) {
    return false;
  }
}

// Results and pages contain the command line and must be UTF-8.
void require_utf8(int argc, char** argv) {
  for (int i = 1; i < argc; ++i)
    if (!is_utf8(argv[i]))
      throw spec::ConfigError(fmt::format(
          "argument {} is not valid UTF-8, which results and pages need: rename the file", i));
}

// Flushes standard output, since a full disk is a failure too.
int flushed(int code) {
  errno = 0;
  const bool lost = std::fflush(stdout) != 0 || std::ferror(stdout) != 0;
  const int reason = errno != 0 ? errno : EIO;
  if (!lost) return code;
  fmt::print(stderr, "deburr: cannot write to standard output: {}\n", std::strerror(reason));
  return code != 0 ? code : static_cast<int>(ExitCode::kFile);
}

// The message becomes the last line; with details (a dump) it goes to the error stream.
Outcome failure(int code, const char* kind, const std::string& text) {
  fmt::print(stderr, "deburr: {}\n", text);
  return {code, fmt::format("FAIL {}: {}", kind, tb::headline(text))};
}

std::string quoted_names(const std::vector<const CLI::App*>& commands) {
  std::string names;
  for (const CLI::App* command : commands)
    names += (names.empty() ? "" : ", ") + command->get_name();
  return names;
}

// Explains the first error of the command line, in the order in which it was written. CLI11 would
// report the last argument that it could not place, without near matches and without the help page
// that applies.
std::string explain(const CLI::App& app, int argc, char** argv, const std::string& complaint) {
  const CLI::App* command = &app;
  std::string path = "deburr";
  const auto see = [&](const std::string& text) {
    return fmt::format("{} (see {} --help)", text, path);
  };
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    const auto commands = commands_of(*command);
    if (word.starts_with("--") && word.size() > 2) {
      const std::string name = word.substr(0, word.find('='));
      const CLI::Option* option = command->get_option_no_throw(name);
      if (!option) {
        std::vector<std::string> known;
        for (const CLI::Option* other : command->get_options())
          for (const std::string& long_name : other->get_lnames())
            known.push_back("--" + long_name);
        return see(fmt::format("unknown option '{}'{}", name,
                               tb::did_you_mean(tb::near_matches(name, known))));
      }
      if (name == word && option->get_items_expected_min() > 0) ++i;  // its value
    } else if (!word.starts_with("-") && !commands.empty()) {
      try {
        command = &command_named(*command, path, word);
      } catch (const spec::ConfigError& unknown) {
        return see(unknown.what());
      }
      path += " " + word;
    }
  }
  if (const auto commands = commands_of(*command); !commands.empty())
    return see(fmt::format("{}: missing command (known: {})", path, quoted_names(commands)));
  return see(complaint);
}

// CLI11 accepts any word after an option as its value: `--out --quiet` would create a directory of
// that name. Returns the option whose value is missing, and the word that follows; empty: none.
std::string missing_value(const CLI::App& app, int argc, char** argv) {
  const CLI::App* command = &app;
  const auto option_of = [&](const std::string& word) {
    return word.starts_with("--") && word.size() > 2
               ? command->get_option_no_throw(word.substr(0, word.find('=')))
               : nullptr;
  };
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "--") break;
    if (const CLI::Option* option = option_of(word)) {
      if (word.find('=') != std::string::npos || option->get_items_expected_min() == 0) continue;
      if (++i < argc && option_of(argv[i]))
        return fmt::format(
            "{} needs a value, but '{}' is an option: to use it as the value, write {}={}", word,
            argv[i], word, argv[i]);
    } else {
      for (const CLI::App* inner : commands_of(*command))
        if (inner->get_name() == word) {
          command = inner;
          break;
        }
    }
  }
  return "";
}

bool asks_for_json(int argc, char** argv) {
  return std::any_of(argv, argv + argc,
                     [](const char* word) { return std::string_view(word) == "--json"; });
}

int run(int argc, char** argv, void (*add)(CLI::App&, CommandLine&)) {
  CLI::App app{"Cycle-accurate models of anti-aliasing hardware, checked against golden models.",
               "deburr"};
  app.formatter(std::make_shared<OrderedFormatter>());  // inherited by all commands
  app.set_version_flag("--version", [] {
    const auto& build = build_info();
    return fmt::format("deburr {} ({}), {}, SystemC {}", build.version, build.commit,
                       build.compiler, build.systemc);
  });
  app.require_subcommand(1);
  app.footer(
      "Examples:\n"
      "  deburr help run\n"
      "  deburr params memory\n"
      "  deburr compare out/a out/b --html out/a_b.html\n\n"
      "Exit codes: 0 pass, 1 mismatch or worse, 2 usage or configuration, 3 simulation error or\n"
      "--max-cycles reached, 4 deadlock, 5 file, 130 interrupted. The last line is RESULT: ..., "
      "on\n"
      "failure after REPRO: ...");
  CommandLine line{quoted_command(argc, argv), argv, false, nullptr};
  const auto ended = [&](const Outcome& outcome) { return finish(outcome, line); };
  add(app, line);
  try {
    require_utf8(argc, argv);
    if (const std::string missing = missing_value(app, argc, argv); !missing.empty()) {
      line.json = asks_for_json(argc, argv);
      return ended(failure(static_cast<int>(ExitCode::kUsage), "usage", missing));
    }
    app.parse(argc, argv);
    const Outcome outcome = line.action();
    return outcome.text.empty() ? outcome.code : ended(outcome);
  } catch (const CLI::Success& done) {  // --help, --version
    std::ostringstream said;
    const int code = app.exit(done, said);
    print_help(said.str());
    return code;
  } catch (const CLI::ParseError& error) {
    line.json = asks_for_json(argc, argv);
    return ended(failure(static_cast<int>(ExitCode::kUsage), "usage",
                         explain(app, argc, argv, error.what())));
  } catch (const spec::Error& error) {
    line.json = line.json || asks_for_json(argc, argv);
    constexpr const char* kKinds[] = {"",           "mismatch", "configuration",
                                      "simulation", "deadlock", "file"};
    return ended(failure(static_cast<int>(error.code()), kKinds[static_cast<int>(error.code())],
                         error.what()));
  } catch (const std::bad_alloc&) {
    return ended(failure(static_cast<int>(ExitCode::kSimulation), "simulation",
                         "out of memory: use a smaller picture or fewer textures"));
  } catch (const std::system_error& error) {  // from fmt, when standard output is full
    return ended(failure(static_cast<int>(ExitCode::kFile), "file", error.what()));
  } catch (const std::exception& error) {
    return ended(failure(static_cast<int>(ExitCode::kSimulation), "simulation", error.what()));
  }
}

}  // namespace

// Commands without a group are started by the program itself.
std::vector<const CLI::App*> commands_of(const CLI::App& app) {
  std::vector<const CLI::App*> commands = app.get_subcommands(nullptr);
  std::erase_if(commands, [](const CLI::App* command) { return command->get_group().empty(); });
  return commands;
}

const CLI::App& command_named(const CLI::App& app, const std::string& path,
                              const std::string& name) {
  const std::vector<const CLI::App*> commands = commands_of(app);
  std::vector<std::string> known;
  known.reserve(commands.size());
  for (const CLI::App* command : commands) {
    if (command->get_name() == name) return *command;
    known.push_back(command->get_name());
  }
  throw spec::ConfigError(known.empty()
                              ? fmt::format("no '{} {}': '{}' has no commands", path, name, path)
                              : fmt::format("no '{} {}'{}, known are {}", path, name,
                                            tb::did_you_mean(tb::near_matches(name, known)),
                                            quoted_names(commands)));
}

void print_help(const std::string& text) {
  constexpr std::size_t kDescriptions = 30;  // column where CLI11 starts them
  const std::size_t columns = tb::output_columns();
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    // A command is not wrapped, so that it can be copied.
    if (!line.starts_with("  deburr ")) line = tb::wrapped(line, columns, kDescriptions);
    std::fputs((line + "\n").c_str(), stdout);  // write errors are checked at the end
  }
}

void show_examples(CLI::App& command, const std::vector<std::string>& lines) {
  command.footer(fmt::format("Examples:\n  {}", fmt::join(lines, "\n  ")));
}

int run_command_line(int argc, char** argv, void (*add)(CLI::App& app, CommandLine& line)) {
  fill_closed_streams();
  tb::let_full_files_fail();
  return flushed(run(argc, argv, add));
}

}  // namespace deburr::tool
