// SPDX-License-Identifier: MIT
// `deburr compare` and `report` for runs; sweep_test.cpp compares sweeps.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "tool/tests/command/in_process.h"
#include "tool/tests/command/made_engine.h"

namespace deburr::tool::compare_test {
namespace {

using testing::HasSubstr;
using testing::Not;
using Json = nlohmann::ordered_json;

// Seed 2 is worse than seed 1, each value by another amount; seed 3 is better, but cannot be built;
// seed 4 has one other counter.
void run(const RunParameters& p, RunContext& /*context*/, tb::Result& r) {
  const bool worse = p.seed == 2, better = p.seed == 3;
  r.comparisons = 10;
  r.cycles = worse ? 10400 : better ? 9000 : 10000;
  r.throughput = worse ? 0.9 : 1;
  r.throughput_unit = "pixel/clk";
  r.bytes_read = worse ? 6600 : 6400;
  r.latency.p50 = 5;
  r.latency.max = worse ? 9 : 8;
  tb::MemoryFigures memory;
  memory.name = "cache";
  memory.kind = "sram";
  memory.logical_bits = memory.physical_bits = worse ? 1100 : 1000;
  if (better) memory.not_implementable = "nine ports";
  r.memories = {memory};
  r.work = {{"hits", std::uint64_t{worse ? 7u : 5u}, "line", "Hits."},
            {"other", std::uint64_t{worse ? 8u : 4u}, "line", "Others."}};
  r.figures = {{"Hits", "work.hits"}};
  r.quality.emplace().reference = "reference";
  r.quality->psnr_db = worse ? 29.0 : 30.0;
  r.quality->flip = worse ? 0.0875 : 0.0625;
  r.quality->ssim = worse ? 0.90 : 0.95;
  if (p.seed == 4) r.work[1].value = std::uint64_t{5};
}

// Runs of seed N are in out/N; the command calls them A, B and so on.
class CompareCommand : public InProcess {
 protected:
  CompareCommand() { made_run() = run; }
  void run_seeds(std::initializer_list<int> seeds) {
    for (const int seed : seeds)
      printed(fmt::format("run made --quiet --out out/{0} --seed {0}{1}", seed,
                          seed == 2 ? " --lanes 8 --filter wide" : ""));
  }
};

TEST_F(CompareCommand, ListsParametersAndFiguresThatDiffer) {
  run_seeds({1, 2});
  EXPECT_EQ(printed("compare out/1 out/2"), R"(parameters that differ       A     B
run.seed                     1     2
made.filter             linear  wide
made.lanes                   4     8

                                 A       B
cycles                       10000   10400   +4.00 %  WORSE
throughput.value                 1     0.9  -10.00 %  WORSE
memory.bytes_read             6400    6600   +3.12 %  WORSE
memory_bits.total.physical    1000    1100  +10.00 %  worse
quality.psnr_db                 30      29  -1.00 dB  WORSE
quality.flip                0.0625  0.0875  +40.00 %  WORSE
quality.ssim                  0.95     0.9   -5.26 %  WORSE
work.hits                        5       7  +40.00 %
8 more values differ: --all shows counters and the rest
REPRO: deburr compare out/1 out/2
RESULT: FAIL worse: cycles, throughput.value, memory.bytes_read, quality.psnr_db, quality.flip, quality.ssim
= 1
)");
}

TEST_F(CompareCommand, EachOptionSetsItsTolerance) {
  run_seeds({1, 2});
  struct Row {
    const char *below, *above, *value;
  };
  for (const Row& row :
       {Row{"--cycles-percent 3.9", "--cycles-percent 4.1", "cycles"},
        {"--cycles-percent 3.1", "--cycles-percent 3.2", "memory.bytes_read"},
        {"--throughput-percent 9.9", "--throughput-percent 10.1", "throughput.value"},
        {"--psnr-db 0.99", "--psnr-db 1.01", "quality.psnr_db"},
        {"--flip 0.024", "--flip 0.026", "quality.flip"},
        {"--ssim 0.049", "--ssim 0.051", "quality.ssim"},
        {"--memory-percent 9.9", "--memory-percent 10.1", "memory_bits.total.logical"}}) {
    EXPECT_THAT(result(fmt::format("compare out/1 out/2 {}", row.below)), HasSubstr(row.value));
    EXPECT_THAT(result(fmt::format("compare out/1 out/2 {}", row.above)),
                Not(HasSubstr(row.value)));
  }
  EXPECT_EQ(result("compare out/1 out/2 --cycles-percent 5 --throughput-percent 11 --psnr-db 2 "
                   "--flip 0.1 --ssim 0.1"),
            "PASS compare: nothing is worse beyond its tolerance");
}

TEST_F(CompareCommand, EqualRunsPass) {
  run_seeds({1, 4});
  EXPECT_EQ(printed("compare out/1 out/1"),
            "no value differs\nRESULT: PASS compare: nothing is worse beyond its tolerance\n");
  EXPECT_THAT(printed("compare out/1 out/4"),
              HasSubstr("\n1 more value differs: --all shows counters and the rest\n"));
}

TEST_F(CompareCommand, ComparesSeveralRunsWithTheFirst) {
  run_seeds({1, 2, 3});
  const std::string text = printed("compare out/1 out/2 out/3 --html out/all.html");
  EXPECT_THAT(text, HasSubstr(R"(
                                 A       B                            C
cycles                       10000   10400   +4.00 %  WORSE        9000  -10.00 %  better
throughput.value                 1     0.9  -10.00 %  WORSE           1
)"));
  EXPECT_THAT(text, HasSubstr(R"(
not_implementable.cache          -       -                   nine ports             WORSE
8 more values differ: --all shows counters and the rest
out/all.html
REPRO: deburr compare out/1 out/2 out/3 --html out/all.html
RESULT: FAIL worse: cycles, )"));
  EXPECT_THAT(text, testing::EndsWith(R"(, not_implementable.cache, NOT IMPLEMENTABLE
! deburr: warning: C is not implementable: memory cache (nine ports)
= 1
)"));
  EXPECT_THAT(read("out/all.html"), HasSubstr("cycles"));
}

TEST_F(CompareCommand, AcceptsUpToSixteenRuns) {
  run_seeds({1});
  std::string sixteen = "compare";
  for (int i = 0; i < 16; ++i) sixteen += " out/1";
  EXPECT_EQ(result(sixteen), "PASS compare: nothing is worse beyond its tolerance");
  expect_failure(
      sixteen + " out/1",
      "configuration: 17 results to compare, at most 16 are possible: use a sweep for more");
}

TEST_F(CompareCommand, ReportRebuildsPages) {
  run_seeds({1, 3});
  std::filesystem::remove("out/1/report.html");
  EXPECT_EQ(printed("report out/1 out/3"),
            "out/1/report.html\nout/3/report.html\nRESULT: PASS report: 2 written\n");
  EXPECT_THAT(read("out/1/report.html"), HasSubstr("made"));
  Json manifest = Json::parse(read("out/3/manifest.json"));
  manifest["parameters"] = 3;
  write("out/3/manifest.json", manifest.dump());
  EXPECT_THAT(result("report out/1 out/3"),
              testing::StartsWith("FAIL file: 'out/1', 'out/3': damaged result or manifest"));
}

}  // namespace
}  // namespace deburr::tool::compare_test
