// SPDX-License-Identifier: MIT
// The program that `deburr papers` starts.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "spec/error.h"
#include "studies/papers/papers.h"
#include "tb/base/interrupt.h"
#include "tb/scene/reference.h"
#include "tool/command/command_papers.h"
#include "tool/pages/run_directory.h"

namespace deburr::studies {
namespace {

bool printed(const std::string& text) {
  return std::fputs(text.c_str(), stdout) >= 0 && std::fflush(stdout) == 0;
}

tool::Outcome reproduce(const tool::PapersOptions& command, const tool::CommandLine& line) {
  std::vector<std::string> known;
  for (const PaperEntry& entry : papers()) known.emplace_back(entry.id);
  for (const std::string& id : command.only)
    if (std::find(known.begin(), known.end(), id) == known.end())
      throw spec::ConfigError(
          fmt::format("unknown paper '{}' (known: {})", id, fmt::join(known, ", ")));
  if (command.out.empty())
    throw spec::ConfigError("--out: expected a name, got '': give one, or leave out --out");
  tb::catch_interrupts();
  tb::let_broken_pipes_fail();
  const PaperOptions options{.quick = command.quick,
                             .size = command.size,
                             .quiet = command.quiet || line.json,
                             .interrupted = tb::interrupted};
  tool::RunDirectory directory(command.out);
  std::vector<Paper> done;
  std::string ended;  // why it is incomplete
  int code = 0;
  try {
    directory.claim(line.text, {"papers.json", "index.html"},
                    command.wait ? tool::IfTaken::kWait : tool::IfTaken::kReject);
    for (const PaperEntry& entry : papers()) {
      if (!command.only.empty() &&
          std::find(command.only.begin(), command.only.end(), entry.id) == command.only.end())
        continue;
      done.push_back(entry.build(options));
      if (!options.quiet && !printed(to_text(done.back()) + "\n")) {
        code = static_cast<int>(spec::ExitCode::kFile);
        ended = "FAIL file: standard output cannot be written";
        break;
      }
    }
  } catch (const tb::Interrupted&) {
    code = tb::kInterruptedExit;
    ended = "INTERRUPTED papers";
  }
  if (done.empty()) return {code, ended + ": no paper was finished, no results were written"};
  nlohmann::ordered_json manifest = write_papers(directory.draft(), done);
  manifest["command"] = line.text;
  directory.publish(std::move(manifest), "index.html");
  const std::string left = fmt::format("{} reproduced, {}/index.html", done.size(), command.out);
  return {code, code == 0 ? "PASS papers: " + left : ended + ": " + left, command.out,
          "papers.json"};
}

}  // namespace
}  // namespace deburr::studies

int main(int argc, char** argv) {
  using deburr::tool::CommandLine;
  return deburr::tool::run_command_line(argc, argv, [](CLI::App& app, CommandLine& line) {
    deburr::tool::add_papers(app, line, deburr::studies::reproduce);
  });
}
