// SPDX-License-Identifier: MIT
// How a simulation runs the pieces of an environment, and how it adds up the checks.
#include "tb/env/simulation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "spec/error.h"
#include "tb/env/environment.h"
#include "tb/harness/verdict.h"

namespace deburr::tb::simulation_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

// Busy for the number of cycles of each piece.
class Scripted final : public Environment {
 public:
  Scripted(Simulation& simulation, std::vector<rtl::Cycle> pieces)
      : Environment(simulation, ""), pieces_(std::move(pieces)) {}

  void configure() override { note("configure"); }
  bool begin(std::size_t piece) override {
    if (piece == pieces_.size()) return false;
    note("begin");
    piece_ = piece;
    from_ = simulation().clock().cycle();
    return true;
  }
  void watch() override { ++watched; }
  bool done() const override { return here() >= pieces_[piece_]; }
  void end() override {
    note("end");
    delivered_ += pieces_[piece_];
  }
  void restart() override {
    note("restart");
    from_ = simulation().clock().cycle();
  }
  void finish() override { note("finish"); }
  void reject_memory_errors() override { note("reject"); }
  void reject_unused_errors() const override {}
  Amount amount() const override { return {delivered_ + here(), here(), 1000, "clock"}; }
  bool memory_at_rest() const override { return true; }
  Boards outputs() const override { return {&pixels, &more}; }
  Boards traffic() const override { return {&lines}; }
  Boards counters() const override { return {&registers}; }
  void collect(Result& result) const override { result.bytes_read += 64; }
  void show_parts(Observer&) const override {}
  std::vector<PictureMap> maps() const override { return {}; }
  Coverage coverage() const override {
    Coverage coverage;
    coverage.declare("bin");
    coverage.hit("bin");
    return coverage;
  }
  void collect_headline(Result& result) const override {
    result.throughput = static_cast<double>(result.bytes_read);  // filled in after collect()
  }

  std::vector<std::string> notes;
  std::uint64_t watched = 0;
  Scoreboard<int> pixels{"pixels", 0}, more{"pixels", 0}, lines{"lines", 0}, registers{"regs", 0};

 private:
  void note(const std::string& what) {
    notes.push_back(what + "@" + std::to_string(simulation().clock().cycle()));
  }
  rtl::Cycle here() const { return simulation().clock().cycle() - from_; }
  std::vector<rtl::Cycle> pieces_;
  std::size_t piece_ = 0;
  rtl::Cycle from_ = 0;
  std::uint64_t delivered_ = 0;
};

struct Bench {
  explicit Bench(std::vector<rtl::Cycle> pieces, const SimulationOptions& options = {})
      : simulation(options), scripted(simulation, std::move(pieces)) {}
  void run(const Simulation::GoOn& go_on = {}) {
    simulation.elaborate(scripted);
    simulation.run(go_on);
  }
  Result result() const {
    Result result;
    simulation.collect(result);
    return result;
  }
  Simulation simulation;
  Scripted scripted;
};

TEST(Simulation, RunsPieceAfterPiece) {
  Bench b({10, 7, 20});
  b.run();
  EXPECT_THAT(b.scripted.notes,
              ElementsAre("configure@4", "begin@4", "end@14", "begin@14", "end@21", "begin@21",
                          "end@41", "finish@41", "reject@41"));
  EXPECT_TRUE(b.simulation.complete());
  EXPECT_EQ(b.simulation.cycles(), 37u) << "without those of the reset";
  EXPECT_EQ(b.simulation.begun(), 21u);
  EXPECT_GE(b.scripted.watched, 37u);
  EXPECT_EQ(b.result().cycles, 37u);
}

// Once, in the first piece, which restarts: cycles before the reset do not count.
TEST(Simulation, ResetAbortsFirstPieceOnce) {
  SimulationOptions options;
  options.reset_after = 6;
  Bench b({10, 8}, options);
  b.run();
  EXPECT_THAT(b.scripted.notes,
              ElementsAre("configure@4", "begin@4", "configure@14", "restart@14", "end@24",
                          "begin@24", "end@32", "finish@32", "reject@32"));
  EXPECT_EQ(b.simulation.cycles(), 18u);
  EXPECT_EQ(b.simulation.begun(), 24u);
}

TEST(Simulation, ResetAfterThePieceNeverHappens) {
  SimulationOptions options;
  options.reset_after = 11;
  Bench b({10, 30}, options);
  b.run();
  EXPECT_EQ(b.simulation.cycles(), 40u);
  EXPECT_THAT(b.scripted.notes, testing::Not(testing::Contains(HasSubstr("restart"))));
}

// The limit covers all pieces.
TEST(Simulation, StopsAtItsLimit) {
  SimulationOptions options;
  options.max_cycles = 25;
  Bench b({10, 7, 20}, options);
  std::string error;
  try {
    b.run();
  } catch (const OutOfCycles& over) {
    error = over.what();
  }
  EXPECT_THAT(error, HasSubstr("not done after 25 cycles"));
  EXPECT_THAT(error, HasSubstr("25 of 1,000 clocks are done"));
  EXPECT_FALSE(b.simulation.complete());
  EXPECT_EQ(b.simulation.cycles(), 25u);
  EXPECT_EQ(b.scripted.notes.back(), "begin@21");
}

TEST(Simulation, MayUseWholeLimit) {
  SimulationOptions options;
  options.max_cycles = 37;
  Bench b({10, 7, 20}, options);
  EXPECT_NO_THROW(b.run());
  EXPECT_TRUE(b.simulation.complete());
}

// Called every few thousand cycles with the results so far; it may stop the run there.
TEST(Simulation, AsksWhetherToContinue) {
  Bench b({5000, 5000, 5000});
  std::vector<std::pair<std::uint64_t, std::uint64_t>> asked;
  b.run([&](std::uint64_t delivered, std::uint64_t taken) {
    asked.emplace_back(delivered, taken);
    return asked.size() < 3;
  });
  EXPECT_THAT(asked,
              ElementsAre(std::pair(0u, 0u), std::pair(4096u, 4096u), std::pair(8192u, 3192u)));
  EXPECT_FALSE(b.simulation.complete());
  EXPECT_EQ(b.simulation.cycles(), 8192u);
  EXPECT_THAT(b.scripted.notes.back(), HasSubstr("begin"));
}

TEST(Simulation, StoppedRunIsNotReset) {
  SimulationOptions options;
  options.reset_after = 4096;
  Bench b({5000}, options);
  int asked = 0;
  b.run([&](std::uint64_t, std::uint64_t) { return ++asked < 2; });
  EXPECT_EQ(asked, 2);
  EXPECT_EQ(b.simulation.cycles(), 4096u);
  EXPECT_THAT(b.scripted.notes, ElementsAre("configure@4", "begin@4"));
}

// Boards of one name are one entry; items that never arrived are differences once all could have
// arrived.
TEST(Simulation, AddsUpComparisons) {
  SimulationOptions options;
  options.coverage = true;
  Bench b({10}, options);
  for (const int i : {1, 2, 3}) b.scripted.pixels.expect(i);
  for (const int i : {1, 5}) b.scripted.pixels.got(i, "here");  // one wrong, one missing
  b.scripted.more.expect(7);
  b.scripted.more.got(7);
  for (const int i : {4, 5, 6}) b.scripted.lines.expect(i);
  b.scripted.lines.got(4);  // two missing
  b.scripted.registers.expect(1);
  b.scripted.registers.got(2, "there");
  b.run();
  Result r;
  for (int times = 0; times < 2; ++times) {  // however often it is called
    r.bytes_read = 0;
    b.simulation.collect(r);
    EXPECT_EQ(r.comparisons, 2u + 1 + 1);
    EXPECT_EQ(r.mismatches, 1u + 1 + 1);
    EXPECT_EQ(r.traffic_comparisons, 1u);
    EXPECT_EQ(r.traffic_mismatches, 2u);
    ASSERT_EQ(r.scoreboards.size(), 3u);
    EXPECT_EQ(r.scoreboards[0].name, "pixels");
    EXPECT_EQ(r.scoreboards[0].comparisons, 3u);
    EXPECT_EQ(r.scoreboards[0].mismatches, 2u);
    EXPECT_EQ(r.scoreboards[1].name, "lines");
    EXPECT_EQ(r.scoreboards[1].comparisons, 1u);
    EXPECT_EQ(r.scoreboards[1].mismatches, 2u);
    EXPECT_EQ(r.scoreboards[2].name, "regs");
    EXPECT_EQ(r.scoreboards[2].mismatches, 1u);
    ASSERT_EQ(r.first_mismatches.size(), 2u);
    EXPECT_EQ(r.first_mismatches[0].check, "pixels");
    EXPECT_EQ(r.first_mismatches[0].where, "here");
    EXPECT_EQ(r.first_mismatches[0].expected, "2");
    EXPECT_EQ(r.first_mismatches[0].got, "5");
    EXPECT_EQ(r.first_mismatches[1].check, "regs");
    EXPECT_EQ(r.bytes_read, 64u);
    EXPECT_EQ(r.throughput, 64);
    ASSERT_TRUE(r.coverage.has_value());
    EXPECT_EQ(r.coverage->at("bin"), 1u);
  }
}

TEST(Simulation, AbortedRunReportsNoMissingOutput) {
  SimulationOptions options;
  options.max_cycles = 5;
  Bench b({10}, options);
  for (const int i : {1, 2, 3}) b.scripted.pixels.expect(i);
  b.scripted.pixels.got(1);
  b.scripted.lines.expect(4);
  EXPECT_THROW(b.run(), OutOfCycles);
  EXPECT_EQ(b.result().mismatches, 0u);
  EXPECT_EQ(b.result().traffic_mismatches, 0u);
  EXPECT_FALSE(b.result().coverage.has_value());
}

// Every board can fail a run.
TEST(Environment, ChecksEveryBoard) {
  Bench b({3});
  b.simulation.elaborate(b.scripted);
  EXPECT_NO_THROW(b.scripted.check());
  for (Scoreboard<int>* board :
       {&b.scripted.pixels, &b.scripted.more, &b.scripted.lines, &b.scripted.registers}) {
    board->expect(1);
    EXPECT_THROW(b.scripted.check(), Mismatch) << board->name();
    board->got(1);
    EXPECT_NO_THROW(b.scripted.check()) << board->name();
  }
}

TEST(Environment, ChecksNothingWithoutGoldenModel) {
  SimulationOptions options;
  options.golden = false;
  Bench b({3}, options);
  b.simulation.elaborate(b.scripted);
  b.scripted.pixels.expect(1);
  EXPECT_NO_THROW(b.scripted.check());
}

}  // namespace
}  // namespace deburr::tb::simulation_test
