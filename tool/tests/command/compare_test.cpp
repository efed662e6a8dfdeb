// SPDX-License-Identifier: MIT
// `deburr compare` and `deburr report` of runs; of sweeps: points_test.cpp.
#include <nlohmann/json.hpp>
#include <string>

#include "tool/tests/command/made_engine.h"
#include "tool/tests/command/transcript.h"

namespace deburr::tb::compare_test {
namespace {

using Json = nlohmann::ordered_json;

// The seed says by how much it is worse: nothing, each value by an amount of its own, or better.
void run(const RunParameters& p, RunContext& /*context*/, Result& r) {
  const bool worse = p.seed == 2, better = p.seed == 3;
  r.comparisons = 10;
  r.cycles = worse ? 10400 : better ? 9000 : 10000;
  r.throughput = worse ? 0.9 : 1;
  r.throughput_unit = "pixel/clk";
  r.bytes_read = worse ? 6600 : 6400;
  r.latency.p50 = 5;
  r.latency.max = worse ? 9 : 8;
  MemoryFigures memory;
  memory.name = "cache";
  memory.kind = "sram";
  memory.logical_bits = memory.physical_bits = worse ? 1100 : 1000;
  if (better) memory.idealised = "nine ports";
  r.memories = {memory};
  r.work = {{"hits", std::uint64_t{worse ? 7u : 5u}, "line", "Hits."},
            {"other", std::uint64_t{worse ? 8u : 4u}, "line", "Others."}};
  r.figures = {{"Hits", "work.hits"}};
  r.quality.emplace().reference = "truth";
  r.quality->psnr_db = worse ? 29.0 : 30.0;
  r.quality->flip = worse ? 0.0875 : 0.0625;
  r.quality->ssim = worse ? 0.90 : 0.95;
  if (p.seed == 4) r.mismatches = 1;
  if (p.seed == 5) r.interrupted = true;
  if (p.seed == 6) r.work[1].value = std::uint64_t{5};
}

class CompareCommand : public Transcript {
 protected:
  CompareCommand() {
    made_run() = run;
    steps_["a result is damaged"] = [] { write("out/b/result.json", "{\"schema\": 3}"); };
    steps_["a manifest is damaged"] = [] {
      Json manifest = Json::parse(read("out/c/manifest.json"));
      manifest["parameters"] = 3;
      write("out/c/manifest.json", manifest.dump());
    };
    steps_["a report is gone"] = [] { std::filesystem::remove("out/a/report.html"); };
    steps_["it is there"] = [] {
      EXPECT_NE(read("out/a/report.html").find("made"), std::string::npos);
    };
  }
};

TEST_F(CompareCommand, SaysWhatDiffersAndWhatIsWorse) { expect("compare.txt"); }

TEST_F(CompareCommand, AsJsonIsOneObject) {
  deburr({"run", "made", "--out", "a"});
  deburr({"run", "made", "--out", "b", "--seed", "2"});
  const Said worse = deburr({"compare", "a", "b", "--json", "--html", "all.html"});
  EXPECT_EQ(worse.code, 1);
  const Json json = Json::parse(worse.out);
  EXPECT_EQ(json["exit_code"], 1);
  EXPECT_EQ(json["repro"], "deburr compare a b --json --html all.html");
  EXPECT_EQ(json["comparison"]["worse"], true);
  EXPECT_EQ(json["comparison"]["runs"].size(), 2u);
  EXPECT_NE(read("all.html").find("cycles"), std::string::npos);
}

}  // namespace
}  // namespace deburr::tb::compare_test
