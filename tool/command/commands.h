// SPDX-License-Identifier: MIT
// The commands of `deburr`. Each adds its options to the command line and stores its action when it
// is called.
#pragma once

#include "tool/command/command_line.h"
#include "tool/command/command_papers.h"
#include "tool/command/command_train.h"

namespace deburr::tool {

void add_run(CLI::App& app, CommandLine& line);
void add_params(CLI::App& app, CommandLine& line);
void add_compare(CLI::App& app, CommandLine& line);
void add_report(CLI::App& app, CommandLine& line);
void add_sweep(CLI::App& app, CommandLine& line);
void add_regress(CLI::App& app, CommandLine& line);
void add_completion(CLI::App& app, CommandLine& line);
void add_help(CLI::App& app, CommandLine& line);

}  // namespace deburr::tool
