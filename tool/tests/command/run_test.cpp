// SPDX-License-Identifier: MIT
// `deburr run`: what is given, what is said of a result, and how it ends.
#include <fmt/format.h>

#include <limits>
#include <new>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <utility>

#include "spec/error.h"
#include "tb/base/interrupt.h"
#include "tool/tests/command/made_engine.h"
#include "tool/tests/command/transcript.h"

namespace deburr::tb::run_test {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

MemoryFigures memory(const std::string& name, const std::string& idealised) {
  MemoryFigures m;
  m.name = name;
  m.kind = "sram";
  m.idealised = idealised;
  return m;
}

// A value of its own for each field, so that none can stand for another.
void fill(Result& r) {
  r.comparisons = 12345;
  r.traffic_comparisons = 2345;
  r.cycles = 40000;
  r.throughput = 1.25;
  r.throughput_bound = 2;
  r.throughput_unit = "pixel/clk";
  r.throughput_bound_meaning = "two lanes";
  r.bottleneck = Bottleneck{"walker", "full", "Its queue is full.", 9000};
  r.terminal = {{"hits", "98.1 % of look-ups"}, {"a long name of it", "7"}};
  r.bytes_read = 640000;
  r.bytes_written = 160000;
  r.memories = {memory("rom", ""), memory("cache", "nine ports"), memory("queue", "no clock")};
  r.quality =
      Quality{"truth", 31.5, 28.25, 27.125, 30.25, 29.5, 25, 0.0625, 0.125, 0.96875, 0.9375};
  r.change = Change{12.25, 3.5, 0.75, 0.125, 33.75};
}

// The seed says which.
void run(const RunParameters& p, RunContext& context, Result& r) {
  if (context.checking_only()) return;
  switch (p.seed) {
    case 2:  // what may be absent is
      r.cycles = 1000;
      r.throughput = 0.5;
      r.throughput_unit = "pixel/clk";
      r.quality.emplace().reference = "truth";
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
      throw Interrupted();
    case 10:
      throw std::bad_alloc();
    case 11:
      r.quality.emplace().reference = "truth";
      r.quality->psnr_edge_db = 30;
      r.quality->psnr_before_db = 20;
      r.quality->psnr_edge_before_db = kInfinity;
      r.cycles = 1000;
      r.mismatches = 1;
      r.interrupted = true;
      break;
    case 12:
      throw std::runtime_error("something else");
    case 13:
      r.cycles = 1000;
      r.traffic_comparisons = 1;
      r.bytes_written = 1;
      r.throughput_bound = 3;
      r.throughput = 1;
      break;
    default:
      fill(r);
  }
}

class RunCommand : public Transcript {
 protected:
  RunCommand() {
    made_run() = run;
    write("set.yaml", "frame:\n  width: 9\nmade.lanes: 2\n");
    write("in.png", "");
  }
};

TEST_F(RunCommand, SaysWhatWasMeasuredAndHowItEnded) { expect("run.txt"); }

TEST_F(RunCommand, AsJsonIsOneObject) {
  struct Row {
    const char *seed, *check;
    int code;
    const char *verdict, *reason;
    bool repro;
  };
  for (const Row& row :
       {Row{"1", "golden", 0, "pass", "", false}, Row{"1", "none", 0, "unchecked", "", false},
        Row{"3", "none", 1, "fail",
            "3 of 12345 outputs and 4 of 2345 memory accesses differ from the golden model", true},
        Row{"4", "golden", 4, "fail", "nothing moves\nlinks: 1", true},
        Row{"5", "golden", 3, "fail", "a limit", true},
        Row{"8", "golden", 130, "unchecked",
            "interrupted: the results cover what was done until then", true},
        Row{"11", "golden", 1, "fail",
            "1 of 0 outputs and 0 of 0 memory accesses differ from the golden model", true}}) {
    const Said said = deburr({"run", "made", "--seed", row.seed, "--check", row.check, "--json"});
    EXPECT_EQ(said.code, row.code) << row.seed;
    const Json json = Json::parse(said.out);
    EXPECT_EQ(json["exit_code"], row.code) << row.seed;
    EXPECT_EQ(json["directory"], "out/made") << row.seed;
    EXPECT_EQ(json["result"]["verdict"], row.verdict) << row.seed;
    EXPECT_EQ(json["result"].value("reason", ""), row.reason) << row.seed;
    EXPECT_EQ(json["result"]["clock_mhz"], 200.0) << row.seed;
    const std::string command =
        fmt::format("deburr run made --seed {} --check {} --json", row.seed, row.check);
    EXPECT_EQ(json["command"], command);
    EXPECT_EQ(json.value("repro", ""), row.repro ? command : "");
  }
  for (const auto& [seed, code] : {std::pair("6", 2), {"7", 5}, {"9", 130}, {"12", 3}}) {
    const Said said = deburr({"run", "made", "--seed", seed, "--json"});
    EXPECT_EQ(said.code, code);
    const Json json = Json::parse(said.out);
    EXPECT_EQ(json["exit_code"], code);
    EXPECT_EQ(json.size(), 4u) << said.out;
  }
}

// The manifest repeats the run.
TEST_F(RunCommand, LeavesWhatItWas) {
  EXPECT_EQ(deburr({"run", "made", "--config", "set.yaml", "--seed", "2"}).code, 0);
  const Json manifest = Json::parse(read("out/made/manifest.json"));
  EXPECT_EQ(manifest["command"], "deburr run made --config set.yaml --seed 2");
  EXPECT_EQ(manifest["configuration"]["frame.width"], 9);
  EXPECT_EQ(manifest["configuration"]["run.seed"], 2);
  EXPECT_EQ(manifest["inputs"][0]["file"], "set.yaml");
}

}  // namespace
}  // namespace deburr::tb::run_test
