// SPDX-License-Identifier: MIT
// `deburr papers` prints every table and figure of the papers next to ours. It needs many more
// parts of the golden models than the other commands, so it is a separate program, deburr_papers,
// installed next to `deburr` and started with the same command line.
#pragma once

#include <string>
#include <vector>

#include "tool/command/command_line.h"

namespace deburr::tool {

struct PapersOptions {
  std::string out = "out/papers";
  std::vector<std::string> only;  // ids; empty: all
  int size = 512;                 // side in pixels of the pictures and of the measured scenes
  bool quick = false, wait = false, quiet = false;
};

using PapersAction = Outcome (*)(const PapersOptions& options, const CommandLine& line);
void add_papers(CLI::App& app, CommandLine& line, PapersAction action);

// The action of `deburr`: replaces the process with deburr_papers. FileError if it is not
// installed.
Outcome start_papers(const PapersOptions& options, const CommandLine& line);

}  // namespace deburr::tool
