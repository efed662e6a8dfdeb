// SPDX-License-Identifier: MIT
// `deburr train`: learned shares for a title, from pairs of its frames. A training is a program of
// its own, deburr_train, which stands beside `deburr` and is started with the same command line.
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

// The action of `deburr`: becomes deburr_train. FileError where that is not there.
Outcome start_train(const TrainOptions& options, const CommandLine& line);

}  // namespace deburr::tool
