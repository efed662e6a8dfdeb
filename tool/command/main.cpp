// SPDX-License-Identifier: MIT
// The `deburr` command.
#include "tool/command/command_line.h"
#include "tool/command/commands.h"

int main(int argc, char** argv) {
  return deburr::tb::run_command_line(argc, argv, [](CLI::App& app, deburr::tb::CommandLine& line) {
    deburr::tb::add_run(app, line);
    deburr::tb::add_papers(app, line, deburr::tb::start_papers);
    deburr::tb::add_train(app, line, deburr::tb::start_train);
    deburr::tb::add_params(app, line);
    deburr::tb::add_compare(app, line);
    deburr::tb::add_report(app, line);
    deburr::tb::add_sweep(app, line);
    deburr::tb::add_regress(app, line);
    deburr::tb::add_completion(app, line);
    deburr::tb::add_help(app, line);
  });
}
