// SPDX-License-Identifier: MIT
// `deburr papers`: every table and figure of the papers beside ours. They need half of the golden
// models' other uses, so that they are a program of its own, deburr_papers, which stands beside
// `deburr` and is started with the same command line.
#pragma once

#include <string>
#include <vector>

#include "tool/command/command_line.h"

namespace deburr::tool {

struct PapersOptions {
  std::string out = "out/papers";
  std::vector<std::string> only;  // ids; empty: all
  int size = 512;                 // side of the pictures and of the scenes that are measured
  bool quick = false, wait = false, quiet = false;
};

using PapersAction = Outcome (*)(const PapersOptions& options, const CommandLine& line);
void add_papers(CLI::App& app, CommandLine& line, PapersAction action);

// The action of `deburr`: becomes deburr_papers. FileError where that is not there.
Outcome start_papers(const PapersOptions& options, const CommandLine& line);

}  // namespace deburr::tool
