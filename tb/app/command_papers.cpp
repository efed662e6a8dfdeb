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
#include "tb/results/parameter_set.h"
#include "tb/scene/image_io.h"

namespace deburr::tb {
namespace {

struct PapersCommand {
  std::string out = "out/papers";
  std::vector<std::string> only;
  PaperOptions options;
};

Outcome run_papers(const PapersCommand& command) {
  std::vector<std::string> known;
  for (const PaperEntry& entry : papers()) known.emplace_back(entry.id);
  for (const std::string& id : command.only)
    if (std::find(known.begin(), known.end(), id) == known.end())
      throw spec::ConfigError(
          fmt::format("no paper '{}' here: known are {}", id, fmt::join(known, ", ")));
  prove_writable(command.out);
  std::vector<Paper> done;
  for (const PaperEntry& entry : papers()) {
    if (!command.only.empty() &&
        std::find(command.only.begin(), command.only.end(), entry.id) == command.only.end())
      continue;
    done.push_back(entry.build(command.options));
    fmt::print("{}\n", to_text(done.back()));
    std::fflush(stdout);
  }
  write_papers(command.out, done);
  return {0, fmt::format("PASS papers: {} reproduced, {}/index.html", done.size(), command.out)};
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
  command->callback([options, &line] { line.action = [options] { return run_papers(*options); }; });
}

}  // namespace deburr::tb
