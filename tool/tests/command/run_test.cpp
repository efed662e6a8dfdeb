// SPDX-License-Identifier: MIT
// `deburr run`: its options, output and exit codes.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <limits>
#include <new>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "spec/error.h"
#include "tb/base/interrupt.h"
#include "tool/tests/command/in_process.h"
#include "tool/tests/command/made_engine.h"

namespace deburr::tool::run_test {
namespace {

using testing::HasSubstr;
using Json = nlohmann::ordered_json;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

tb::MemoryFigures memory(const std::string& name, const std::string& not_implementable) {
  tb::MemoryFigures m;
  m.name = name;
  m.kind = "sram";
  m.not_implementable = not_implementable;
  return m;
}

// Every field has a different value.
void fill(tb::Result& r) {
  r.comparisons = 12345;
  r.traffic_comparisons = 2345;
  r.cycles = 40000;
  r.throughput = 1.25;
  r.throughput_bound = 2;
  r.throughput_unit = "pixel/clk";
  r.throughput_bound_meaning = "two lanes";
  r.bottleneck = tb::Bottleneck{"walker", "full", "Its queue is full.", 9000};
  r.terminal = {{"hits", "98.1 % of lookups"}, {"a long name of it", "7"}};
  r.bytes_read = 640000;
  r.bytes_written = 160000;
  r.memories = {memory("rom", ""), memory("cache", "nine ports"), memory("queue", "no clock")};
  r.quality = tb::Quality{"reference", 31.5,   28.25, 27.125,  30.25, 29.5,
                          25,          0.0625, 0.125, 0.96875, 0.9375};
  r.change = tb::Change{12.25, 3.5, 0.75, 0.125, 33.75};
}

// The seed selects the outcome.
void run(const RunParameters& p, RunContext& context, tb::Result& r) {
  if (context.checking_only()) return;
  switch (p.seed) {
    case 2:  // without optional fields
      r.cycles = 1000;
      r.throughput = 0.5;
      r.throughput_unit = "pixel/clk";
      r.quality.emplace().reference = "reference";
      r.quality->psnr_db = kInfinity;
      r.quality->flip = 0.5;
      r.quality->ssim = 0.25;
      r.change.emplace().small_percent = 1;
      r.change->right_small_percent = 2;
      r.change->psnr_db = kInfinity;
      break;
    case 3:
      fill(r);
      r.mismatches = 3;
      r.traffic_mismatches = 4;
      break;
    case 4:
      r.cycles = 77;
      throw spec::DeadlockError("nothing moves\nlinks: 1");
    case 5:
      throw spec::SimulationError("a limit");
    case 6:
      throw spec::ConfigError("no such thing");
    case 7:
      throw spec::FileError("no such file");
    case 8:
      fill(r);
      r.interrupted = true;
      break;
    case 9:
      throw tb::Interrupted();
    case 10:
      throw std::bad_alloc();
    case 11:
      r.quality.emplace().reference = "reference";
      r.quality->psnr_edge_db = 30;
      r.quality->psnr_before_db = 20;
      r.quality->psnr_edge_before_db = kInfinity;
      r.cycles = 1000;
      r.mismatches = 1;
      r.interrupted = true;
      break;
    case 12:
      throw std::runtime_error("something else");
    case 13: {
      r.cycles = 1000;
      r.throughput_unit = "pixel/clk";
      rtl::Datasheet sheet = {.unit = "Adder"};
      sheet.stages = {{.clock = "1", .work = "sums", .registers = 8}};
      if (p.stall_seed == 2) sheet.stages[0].longest = {rtl::op::multiply(24, 24)};
      r.sheets = {{"adder", sheet}};
      break;
    }
    default:
      fill(r);
  }
}

class RunCommand : public InProcessTable {
 protected:
  RunCommand() { made_run() = run; }
};
class RunOutput : public RunCommand {};
class RejectedRun : public RunCommand {};

// ---- output -------------------------------------------------------------------------------------

TEST_P(RunOutput, PrintsExpectedLines) {
  EXPECT_EQ(printed(GetParam().given), GetParam().expected);
}

const Case kOutputs[] = {
    {"Everything", "run made", R"(rate        1.250 pixel/clk, 62.5 % of 2: two lanes
limited by  walker, full in 22.5 % of the cycles: Its queue is full.
hits        98.1 % of lookups
a long name of it 7
memory      3.2 GB/s read, 0.8 written at 200 MHz
quality     31.50 dB (+1.25), edges 28.25 dB (-1.25), silhouettes 27.12 dB (+2.12), FLIP 0.0625 (-0.0625), SSIM 0.9688 (+0.0312) against reference
changed     12.25 % of the pixels by more than 2 codes, 3.50 % by more than 16 (of correct input pixels 0.75 % and 0.12 %); 33.75 dB to the input
RESULT: PASS made: 12,345 outputs and 2,345 memory accesses compared, 0 mismatches, 40,000 cycles, 1.250 pixel/clk, NOT IMPLEMENTABLE cache, queue, out/made/report.html
! deburr: warning: this hardware cannot be built: memory cache: nine ports
! deburr: warning: this hardware cannot be built: memory queue: no clock
)"},
    {"WithoutOptionalValues", "run other --seed 2", R"(rate        0.500 pixel/clk
quality     identical, FLIP 0.5000, SSIM 0.2500 against reference
changed     1.00 % of the pixels by more than 2 codes, 0.00 % by more than 16; identical to the input
RESULT: PASS other: 1,000 cycles, 0.500 pixel/clk, out/other/report.html
)"},
    {"Unchecked", "run made --seed 2 --quiet --check none",
     "RESULT: UNCHECKED made: 1,000 cycles, 0.500 pixel/clk, out/made/report.html\n"},
    {"Mismatch", "run made --quiet --seed 3", R"(REPRO: deburr run made --quiet --seed 3
RESULT: FAIL mismatch: 3 of 12345 outputs and 4 of 2345 memory accesses differ from the golden model (made: 12,345 outputs and 2,345 memory accesses compared, 7 mismatches, 40,000 cycles, 1.250 pixel/clk, NOT IMPLEMENTABLE cache, queue, out/made/report.html)
= 1
)"},
    {"MismatchAndInterrupted", "run made --seed 11",
     "rate        0.000 \n"
     R"(quality     -, edges 30.00 dB against reference
REPRO: deburr run made --seed 11
RESULT: FAIL mismatch: 1 of 0 outputs and 0 of 0 memory accesses differ from the golden model (made: 1,000 cycles, 0.000 , out/made/report.html)
= 1
)"},
    {"Deadlock", "run made --seed 4",
     "rate        0.000 \n"
     R"(REPRO: deburr run made --seed 4
RESULT: FAIL deadlock: nothing moves, links: 1 (made: 77 cycles, 0.000 , out/made/report.html)
! deburr: nothing moves
! links: 1
= 4
)"},
    {"ErrorInSimulation", "run made --seed 5", R"(REPRO: deburr run made --seed 5
RESULT: FAIL simulation: a limit (made: 0 cycles, 0.000 , out/made/report.html)
! deburr: a limit
= 3
)"},
    {"Interrupted", "run made --quiet --seed 8", R"(REPRO: deburr run made --quiet --seed 8
RESULT: INTERRUPTED made: 12,345 outputs and 2,345 memory accesses compared, 0 mismatches, 40,000 cycles, 1.250 pixel/clk, NOT IMPLEMENTABLE cache, queue, out/made/report.html
! deburr: interrupted; the partial results are kept. Run the same command again for complete results.
= 130
)"},
    {"InterruptedBeforeItBegan", "run made --seed 9", R"(REPRO: deburr run made --seed 9
RESULT: INTERRUPTED made: before the simulation began, no results were written
! deburr: interrupted before the simulation began; no results were written
= 130
)"},
};
INSTANTIATE_TEST_SUITE_P(All, RunOutput, testing::ValuesIn(kOutputs), name_of_case);

// The numbers belong to tool/cost/osu018.json.
TEST_F(RunCommand, PrintsCost) {
  const std::string number = "[0-9.,]+",
                    ranged = number + " \\(" + number + " to " + number + "\\)";
  EXPECT_THAT(printed("run made --seed 13"),
              testing::ContainsRegex("\ncost        " + ranged + " gates\n"));
  EXPECT_THAT(printed("run made --seed 13 --set run.stall_seed=2"),
              testing::ContainsRegex("\ncost        " + ranged + " gates, " + ranged +
                                     " ns in adder stage 1, " + ranged + " MHz\n"));
}

TEST_F(RunCommand, JsonIsOneObject) {
  const char* const mismatch =
      "3 of 12345 outputs and 4 of 2345 memory accesses differ from the golden model";
  struct Row {
    const char *seed, *check;
    int code;
    const char *verdict, *reason;
  };
  for (const Row& row : {Row{"1", "golden", 0, "pass", ""}, Row{"1", "none", 0, "unchecked", ""},
                         Row{"3", "none", 1, "fail", mismatch},
                         Row{"4", "golden", 4, "fail", "nothing moves\nlinks: 1"},
                         Row{"5", "golden", 3, "fail", "a limit"},
                         Row{"8", "golden", 130, "unchecked",
                             "interrupted: the results cover only the completed part"}}) {
    const std::string line =
        fmt::format("run made --seed {} --check {} --json", row.seed, row.check);
    const Json json = InProcess::json(line);
    EXPECT_EQ(json["exit_code"], row.code) << line;
    EXPECT_EQ(json["directory"], "out/made") << line;
    EXPECT_EQ(json["result"]["verdict"], row.verdict) << line;
    EXPECT_EQ(json["result"].value("reason", ""), row.reason) << line;
    EXPECT_EQ(json["result"]["clock_mhz"], 200.0) << line;
    EXPECT_EQ(json["command"], "deburr " + line);
    EXPECT_EQ(json.value("repro", ""), row.code == 0 ? "" : "deburr " + line);
  }
  for (const auto& [seed, code] : {std::pair("6", 2), {"7", 5}, {"9", 130}, {"12", 3}}) {
    const Json json = InProcess::json(fmt::format("run made --seed {} --json", seed));
    EXPECT_EQ(json["exit_code"], code) << seed;
    EXPECT_EQ(json.size(), 4u) << "no result";
  }
}

TEST_F(RunCommand, ManifestRecordsCommandAndConfiguration) {
  write("set.yaml", "frame:\n  width: 9\n");
  EXPECT_EQ(result("run made --quiet --config set.yaml --seed 2"),
            "PASS made: 1,000 cycles, 0.500 pixel/clk, out/made/report.html");
  const Json manifest = Json::parse(read("out/made/manifest.json"));
  EXPECT_EQ(manifest["command"], "deburr run made --quiet --config set.yaml --seed 2");
  EXPECT_EQ(manifest["configuration"]["frame.width"], 9);
  EXPECT_EQ(manifest["configuration"]["run.seed"], 2);
  EXPECT_EQ(manifest["inputs"][0]["file"], "set.yaml");
}

TEST_F(RunCommand, ShowConfigMergesFileAndOptions) {
  write("set.yaml", "frame:\n  width: 9\nmade.lanes: 2\n");
  const std::string shown = printed(
      "run made --show-config --config set.yaml --size 12x7 --set made.filter=bilinear --round "
      "--no-images");
  for (const char* const line :
       {"run.seed: 1  # ", "run.images: false  # ", "frame.width: 12  # ", "frame.height: 7  # ",
        "made.filter: \"linear\"  # How it looks.", "made.round: true  # ", "made.lanes: 2  # ",
        "made.depth: 8  # Of its queue."})
    EXPECT_THAT("\n" + shown, HasSubstr(std::string("\n") + line));
  EXPECT_FALSE(std::filesystem::exists("out"));
}

// ---- rejected -----------------------------------------------------------------------------------

TEST_P(RejectedRun, MessageNamesReason) { expect_failure(GetParam().given, GetParam().expected); }

const Case kRejected[] = {
    {"ByTheEngine", "run made --seed 6", "configuration: no such thing"},
    {"MissingFile", "run made --seed 7", "file: no such file"},
    {"OutOfMemory", "run made --seed 10",
     "simulation: out of memory: use a smaller picture or fewer textures"},
    {"OtherException", "run made --seed 12", "simulation: something else"},
    {"SizeOfOneNumber", "run made --size 12",
     "configuration: --size: expected WIDTHxHEIGHT, got '12'"},
    {"SetContradictsSet", "run made --set made.lanes=4 --set made.lanes=5",
     "configuration: --set: 'made.lanes' = '5' contradicts --set ('4')"},
    {"PixelOfEngineWithoutHistory", "run other --pixel 1,2",
     "configuration: run.pixel: the engine other does not record the history of a pixel: leave out "
     "--pixel; engines that do: made"},
    {"TraceFromWithoutTrace", "run made --trace-from 5",
     "configuration: --trace-from: 'run.trace_from' = '5' has no effect: it needs "
     "run.trace (--trace)"},
    {"TraceToWithoutTrace", "run made --trace-to 5",
     "configuration: --trace-to: 'run.trace_to' = '5' has no effect: it needs "
     "run.trace (--trace)"},
    {"EmptyTimeline", "run made --timeline --timeline-from 7 --timeline-to 7",
     "configuration: run.timeline_from = 7 and run.timeline_to = 7 leave no cycle: --timeline-to "
     "is the cycle after the last one, give one above 7"},
    {"TimelineTooLong", "run made --timeline --timeline-from 7 --timeline-to 100008",
     "configuration: run.timeline_from = 7 and run.timeline_to = 100008: 100001 cycles are more "
     "than trace viewers open, at most 100000: choose a shorter range"},
    {"TimelineFromWithoutTimeline", "run made --timeline-from 5",
     "configuration: --timeline-from: 'run.timeline_from' = '5' has no effect: it needs "
     "run.timeline (--timeline)"},
    {"TimelineToWithoutTimeline", "run made --timeline-to 5",
     "configuration: --timeline-to: 'run.timeline_to' = '5' has no effect: it needs "
     "run.timeline (--timeline)"},
};
INSTANTIATE_TEST_SUITE_P(All, RejectedRun, testing::ValuesIn(kRejected), name_of_case);

TEST_F(RunCommand, AcceptsOneCycleTraceLongestTimelineAndRepeatedValue) {
  for (const char* const options :
       {"--trace '*' --trace-from 5 --trace-to 6",
        "--timeline --timeline-from 7 --timeline-to 100007", "--set made.lanes=4 --lanes 4"})
    EXPECT_EQ(printed(fmt::format("run made --quiet --seed 2 {}", options)),
              "RESULT: PASS made: 1,000 cycles, 0.500 pixel/clk, out/made/report.html\n");
}

}  // namespace
}  // namespace deburr::tool::run_test
