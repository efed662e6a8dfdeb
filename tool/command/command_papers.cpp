// SPDX-License-Identifier: MIT
#include "tool/command/command_papers.h"

#include <CLI/CLI.hpp>
#include <memory>

namespace deburr::tool {

void add_papers(CLI::App& app, CommandLine& line, PapersAction action) {
  CLI::App* command =
      app.add_subcommand("papers", "Reproduce the tables and figures of the papers");
  show_examples(*command, {"deburr papers --out out/papers", "deburr papers 004 --quick"});
  const auto options = std::make_shared<PapersOptions>();
  command->add_option("--out", options->out, "Directory for index.html, papers.json and pictures")
      ->capture_default_str();
  command->add_option("ID,--only", options->only, "Papers to reproduce, such as 004 (all)");
  command->add_option("--size", options->size, "Width and height of the pictures in pixels")
      ->capture_default_str()
      ->check(CLI::Range(64, 4096));
  command->add_flag("--quick", options->quick, "Skip figures that take more than a few seconds");
  command->add_flag("--wait", options->wait,
                    "Wait while another run uses the directory, instead of failing");
  command->add_flag("--quiet", options->quiet, "Print only errors and the line RESULT: ...");
  command->add_flag("--json", line.json,
                    "Print one JSON object: exit code, outcome, directory, result");
  command->callback([options, action, &line] {
    line.action = [options, action, &line] { return action(*options, line); };
  });
}

}  // namespace deburr::tool
