// SPDX-License-Identifier: MIT
// The `deburr` command.
#include "tool/command/command_line.h"
#include "tool/command/commands.h"

int main(int argc, char** argv) {
  return deburr::tool::run_command_line(
      argc, argv, [](CLI::App& app, deburr::tool::CommandLine& line) {
        deburr::tool::add_run(app, line);
        deburr::tool::add_papers(app, line, deburr::tool::start_papers);
        deburr::tool::add_train(app, line, deburr::tool::start_train);
        deburr::tool::add_params(app, line);
        deburr::tool::add_compare(app, line);
        deburr::tool::add_report(app, line);
        deburr::tool::add_sweep(app, line);
        deburr::tool::add_regress(app, line);
        deburr::tool::add_completion(app, line);
        deburr::tool::add_help(app, line);
      });
}
