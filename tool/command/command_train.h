// SPDX-License-Identifier: MIT
// `deburr train`: learned weights for a title, from pairs of its frames. It is a separate program,
// deburr_train, installed next to `deburr` and started with the same command line.
#pragma once

#include <cstdint>
#include <string>

#include "tool/command/command_line.h"

namespace deburr::tool {

struct TrainOptions {
  std::string in, reference, out;
  std::uint64_t seed = 1;
  int batches = 600;
  bool quiet = false;
};

using TrainAction = Outcome (*)(const TrainOptions& options, const CommandLine& line);
void add_train(CLI::App& app, CommandLine& line, TrainAction action);

// The action of `deburr`: replaces the process with deburr_train. FileError if it is not installed.
Outcome start_train(const TrainOptions& options, const CommandLine& line);

}  // namespace deburr::tool
