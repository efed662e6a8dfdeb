// SPDX-License-Identifier: MIT
// `deburr papers`: every table and figure of the papers beside ours.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "spec/error.h"
#include "tb/app/commands.h"
#include "tb/papers/papers.h"
#include "tb/results/interrupt.h"
#include "tb/results/run_directory.h"
#include "tb/scene/truth.h"

namespace deburr::tb {
namespace {

struct PapersCommand {
  std::string out = "out/papers";
  bool wait = false, quiet = false;
  std::vector<std::string> only;
  PaperOptions options;
};

bool printed(const std::string& text) {
  return std::fputs(text.c_str(), stdout) >= 0 && std::fflush(stdout) == 0;
}

Outcome run_papers(const PapersCommand& command, const CommandLine& line) {
  std::vector<std::string> known;
  for (const PaperEntry& entry : papers()) known.emplace_back(entry.id);
  for (const std::string& id : command.only)
    if (std::find(known.begin(), known.end(), id) == known.end())
      throw spec::ConfigError(
          fmt::format("no paper '{}' here: known are {}", id, fmt::join(known, ", ")));
  if (command.out.empty())
    throw spec::ConfigError("--out: expected a name, got '': give one, or leave out --out");
  catch_interrupts();
  let_broken_pipes_fail();
  PaperOptions options = command.options;
  options.interrupted = interrupted;
  options.quiet = command.quiet || line.json;
  RunDirectory directory(command.out);
  std::vector<Paper> done;
  std::string ended;  // why it is not complete
  int code = 0;
  try {
    directory.claim(line.text, {"papers.json", "index.html"},
                    command.wait ? IfTaken::kWait : IfTaken::kRefuse);
    for (const PaperEntry& entry : papers()) {
      if (!command.only.empty() &&
          std::find(command.only.begin(), command.only.end(), entry.id) == command.only.end())
        continue;
      done.push_back(entry.build(options));
      if (!options.quiet && !printed(to_text(done.back()) + "\n")) {
        code = static_cast<int>(spec::ExitCode::kFile);
        ended = "FAIL file: standard output cannot be written";
        break;
      }
    }
  } catch (const Interrupted&) {
    code = kInterruptedExit;
    ended = "INTERRUPTED papers";
  }
  if (done.empty()) return {code, ended + ": nothing was finished, no results were written"};
  nlohmann::ordered_json manifest = write_papers(directory.draft(), done);
  manifest["command"] = line.text;
  directory.publish(std::move(manifest), "index.html");
  const std::string left = fmt::format("{} reproduced, {}/index.html", done.size(), command.out);
  return {code, code == 0 ? "PASS papers: " + left : ended + ": " + left, command.out,
          "papers.json"};
}

}  // namespace

void add_papers(CLI::App& app, CommandLine& line) {
  CLI::App* command =
      app.add_subcommand("papers", "Reproduce the tables and figures of the papers");
  const auto options = std::make_shared<PapersCommand>();
  command->add_option("--out", options->out, "Directory for index.html, papers.json and pictures")
      ->capture_default_str();
  command->add_option("ID,--only", options->only, "Papers to reproduce, such as 004 (all)");
  command->add_option("--size", options->options.size, "Side of the pictures, pixel")
      ->capture_default_str()
      ->check(CLI::Range(64, 4096));
  command->add_flag("--quick", options->options.quick,
                    "Leave out what takes more than a few seconds");
  command->add_flag("--wait", options->wait,
                    "Wait for another run that has the directory, instead of refusing");
  command->add_flag("--quiet", options->quiet, "Print nothing but errors and the line RESULT: ...");
  command->add_flag("--json", line.json,
                    "Print one JSON object: exit code, outcome, directory, result");
  command->callback(
      [options, &line] { line.action = [options, &line] { return run_papers(*options, line); }; });
}

}  // namespace deburr::tb
