// SPDX-License-Identifier: MIT
// Commands that are separate programs, installed next to `deburr` and started with the same command
// line.
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <string_view>

#include "spec/error.h"
#include "tool/command/command_papers.h"
#include "tool/command/command_train.h"

namespace deburr::tool {
namespace {

[[noreturn]] void become(std::string_view name, const CommandLine& line) {
  const std::filesystem::path program =
      std::filesystem::read_symlink("/proc/self/exe").replace_filename(name);
  ::execv(program.c_str(), line.words);
  const int reason = errno;
  throw spec::FileError(
      fmt::format("this command needs the program {}, which cannot be started ({}): put it there, "
                  "from the same build (in the repository: scripts/demo --complete)",
                  program.string(), std::strerror(reason)));
}

}  // namespace

// The other program parses the options again.
Outcome start_papers(const PapersOptions&, const CommandLine& line) {
  become("deburr_papers", line);
}

Outcome start_train(const TrainOptions&, const CommandLine& line) { become("deburr_train", line); }

}  // namespace deburr::tool
