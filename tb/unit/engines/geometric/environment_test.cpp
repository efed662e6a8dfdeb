// SPDX-License-Identifier: MIT
// The environment of the geometric engine: several frames, and its use as a part of a composition.
// figures_test.cpp and tb/system/geometric_stress_test.cpp test resets, stalls and memory errors.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "spec/error.h"
#include "tb/base/forked.h"
#include "tb/engines/geometric/geometric_environment.h"
#include "tb/engines/geometric/geometric_frames.h"

namespace deburr::tb::environment_test {
namespace {

geometric::Frame small_frame(EdgeOrder order = EdgeOrder::kTable) {
  GeometricSceneParameters p;
  p.source = "wheelcover";
  p.width = 90;
  p.height = 61;
  p.edge_order = order;
  return load_geometric_frame(p, 1, false).frame;
}

// Small caches, so that weight blocks are written and read back.
GeometricSetup small_setup() {
  GeometricSetup setup;
  setup.geometric.depth_lines = setup.geometric.vertex_lines = setup.geometric.weight_blocks =
      spec::geometric::CacheLines::k16;
  setup.memory.latency = 30;
  return setup;
}

struct Outcome {
  std::uint64_t hash = 0, cycles = 0, comparisons = 0, mismatches = 0, traffic = 0, frames = 0;
};

Outcome outcome_of(const Simulation& simulation, const GeometricEnvironment& environment) {
  Result result;
  simulation.collect(result);
  return {environment.pixel_hash(),   result.cycles,
          result.comparisons,         result.mismatches + result.traffic_mismatches,
          result.traffic_comparisons, environment.meter().frames_done()};
}

Outcome run(const SimulationOptions& options, const GeometricSetup& setup, std::size_t count = 1,
            EdgeOrder order = EdgeOrder::kTable) {
  return forked<Outcome>([&] {
    const std::vector<geometric::Frame> frames(count, small_frame(order));
    Simulation simulation(options);
    GeometricEnvironment environment(simulation, frames, setup);
    simulation.elaborate(environment);
    simulation.run();
    environment.check();
    return outcome_of(simulation, environment);
  });
}

// The golden model's lookup bins against the counters of the hardware.
TEST(GeometricEnvironment, GoldenFetchesMatchHardwareLookups) {
  const std::vector<geometric::Frame> frames = {small_frame()};
  Simulation simulation({});
  GeometricEnvironment environment(simulation, frames, small_setup());
  simulation.elaborate(environment);
  simulation.run();
  environment.check();
  const auto& engine = environment.engine();
  const Coverage coverage = environment.coverage();
  const auto fetches = [&](const char* cache, const char* outcome) {
    return coverage.bins().at(std::string("geometric/fetch/") + cache + '/' + outcome);
  };
  const auto requested = [&](const char* cache) {
    return fetches(cache, "miss") + fetches(cache, "replaced");
  };
  EXPECT_EQ(requested("vertex"), engine.vertex_fetch.misses.value());
  EXPECT_EQ(requested("vertex") + fetches("vertex", "hit"), engine.vertex_fetch.lookups.value());
  EXPECT_LT(engine.vertex_fetch.lookups.value(), 2 * engine.work().kept_edges)
      << "edges with both vertices in a line";
  EXPECT_GT(engine.vertex_fetch.lookups.value(), engine.work().kept_edges) << "and in two";
  EXPECT_EQ(requested("depth"), engine.depth_test.misses.value());
  EXPECT_EQ(fetches("block", "miss") + fetches("block", "read-back"),
            engine.weight_combiner.misses.value());
  EXPECT_EQ(fetches("block", "read-back"), engine.weight_combiner.blocks_read.value());
}

TEST(GeometricEnvironment, ConsecutiveFramesBehaveAlike) {
  const Outcome one = run({}, small_setup()), three = run({}, small_setup(), 3);
  EXPECT_EQ(three.frames, 3u);
  EXPECT_EQ(three.cycles, 3 * one.cycles);
  EXPECT_EQ(three.traffic, 3 * one.traffic);
  constexpr std::uint64_t kAtTheEnd = 42 + 27;  // registers and figures
  EXPECT_EQ(three.comparisons - kAtTheEnd, 3 * (one.comparisons - kAtTheEnd));
}

TEST(GeometricEnvironment, EdgeOrderChangesNoPixel) {
  const Outcome table = run({}, small_setup()),
                shuffled = run({}, small_setup(), 1, EdgeOrder::kShuffled);
  EXPECT_EQ(shuffled.hash, table.hash);
  EXPECT_NE(shuffled.traffic, table.traffic);
}

TEST(GeometricEnvironment, RejectsFramesWiderThanTheBuild) {
  const std::vector<geometric::Frame> frames = {small_frame()};
  GeometricSetup setup;
  setup.geometric.line_pixels = 64;
  Simulation simulation({});
  EXPECT_THROW(GeometricEnvironment(simulation, frames, setup), spec::ConfigError);
}

// A part that gets its colours from elsewhere: here one row of pixels every ten cycles.
class Painted final : public Environment {
 public:
  Painted(Simulation& simulation, std::span<const geometric::Frame> frames,
          const GeometricSetup& setup)
      : Environment(simulation, ""),
        part(simulation, frames, setup, "geometric"),
        frames_(frames) {}

  void configure() override { part.configure(); }
  bool begin(std::size_t piece) override {
    row_ = 0;
    next_ = simulation().clock().cycle();
    return part.begin(piece);
  }
  void watch() override {
    const Image& image = frames_.front().image;
    if (row_ < image.height && simulation().clock().cycle() >= next_) {
      for (int x = 0; x < image.width; ++x) part.put(x, row_, image.at(x, row_));
      next_ += 10;
      if (++row_ == image.height) part.draw();
    }
    part.watch();
  }
  bool done() const override { return part.done(); }
  void end() override { part.end(); }
  void restart() override {
    simulation().clock().set_reset_n(false);
    drain_memory();
    simulation().clock().set_reset_n(true);
    configure();
    row_ = 0;
    next_ = simulation().clock().cycle();
    part.restart();
  }
  void finish() override { part.finish(); }
  void reject_memory_errors() override { part.reject_memory_errors(); }
  void reject_unused_errors() const override { part.reject_unused_errors(); }
  Amount amount() const override { return part.amount(); }
  bool memory_at_rest() const override { return part.memory_at_rest(); }
  Boards outputs() const override { return part.outputs(); }
  Boards traffic() const override { return part.traffic(); }
  Boards counters() const override { return part.counters(); }
  void collect(Result& result) const override { part.collect(result); }
  void show_parts(Observer& observer) const override { part.show_parts(observer); }
  std::vector<PictureMap> maps() const override { return part.maps(); }
  Coverage coverage() const override { return part.coverage(); }
  void collect_headline(Result& result) const override { part.collect_headline(result); }

  GeometricEnvironment part;

 private:
  std::span<const geometric::Frame> frames_;
  int row_ = 0;
  rtl::Cycle next_ = 0;
};

TEST(GeometricEnvironment, WorksAsPartOfAComposition) {
  const Outcome alone = run({}, small_setup());
  for (const rtl::Cycle reset_after : {0u, 300u, 1500u}) {
    const Outcome part = forked<Outcome>([&] {
      const std::vector<geometric::Frame> frames = {small_frame()};
      SimulationOptions options;
      options.reset_after = reset_after;
      Simulation simulation(options);
      Painted painted(simulation, frames, small_setup());
      simulation.elaborate(painted);
      simulation.run();
      painted.check();
      const Image after = painted.part.frame();
      for (const auto& [x, y] : {std::pair(0, 0), {45, 30}, {89, 60}})
        EXPECT_EQ(painted.part.driver().pixel(x, y), after.at(x, y));
      return outcome_of(simulation, painted.part);
    });
    EXPECT_EQ(part.hash, alone.hash);
    EXPECT_EQ(part.mismatches, 0u);
    EXPECT_GE(part.comparisons, alone.comparisons);
    EXPECT_GT(part.cycles, alone.cycles + 500) << "it waits for its colours";
  }
}

}  // namespace
}  // namespace deburr::tb::environment_test
