// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "spec/error.h"
#include "tb/command/command_papers.h"

namespace deburr::tb {

Outcome start_papers(const PapersOptions& /*read again by the other program*/,
                     const CommandLine& line) {
  const std::filesystem::path program =
      std::filesystem::read_symlink("/proc/self/exe").replace_filename("deburr_papers");
  ::execv(program.c_str(), line.words);
  const int reason = errno;
  throw spec::FileError(
      fmt::format("papers are reproduced by a program of its own, {}, which cannot be started "
                  "({}); put that of "
                  "the same build there (in the repository: scripts/demo --complete)",
                  program.string(), std::strerror(reason)));
}

}  // namespace deburr::tb
