// SPDX-License-Identifier: MIT
// What reads the command line, and the commands that only print: help, completion, params.
#include "tool/tests/command/made_engine.h"
#include "tool/tests/command/transcript.h"

namespace deburr::tb::line_test {
namespace {

class TheCommandLine : public Transcript {
 protected:
  TheCommandLine() {
    made_run() = [](const RunParameters& /*run*/, RunContext& /*context*/, Result& /*result*/) {};
  }
};

TEST_F(TheCommandLine, IsExplained) { expect("line.txt"); }

}  // namespace
}  // namespace deburr::tb::line_test
