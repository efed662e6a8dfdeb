// SPDX-License-Identifier: MIT
// What surrounds the geometric engine: resets, several frames, weather, and its use as a part.
#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <variant>
#include <vector>

#include "spec/error.h"
#include "tb/base/forked.h"
#include "tb/engines/geometric/geometric_environment.h"
#include "tb/engines/geometric/geometric_frames.h"

namespace deburr::tb::environment_test {
namespace {

using spec::geometric::Region;

geometric::Frame small_frame(EdgeOrder order = EdgeOrder::kTable) {
  GeometricSceneParameters p;
  p.source = "wheelcover";
  p.width = 90;
  p.height = 61;
  p.edge_order = order;
  return load_geometric_frame(p, 1, false).frame;
}

// Little room on the chip, so that weights come and go.
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

// Hashes are compared with hashes of the same model elsewhere, so that what none looks at is seen
// here alone.
TEST(GeometricEnvironment, TheHashIsOfEveryChannelOfEveryPixel) {
  const std::vector<geometric::Frame> frames = {small_frame()};
  Simulation simulation({});
  GeometricEnvironment environment(simulation, frames, small_setup());
  simulation.elaborate(environment);
  simulation.run();
  OutputHash hash;
  for (const Rgba8& pixel : environment.expected_frame().pixels) {
    std::uint64_t word = 0;
    for (std::size_t c = 4; c-- > 0;) word = word * 256 + pixel[c];
    hash.add(word);
  }
  EXPECT_EQ(environment.pixel_hash(), hash.value());
}

// Golden's bins of look-ups against the counters of the hardware.
TEST(GeometricEnvironment, GoldenFetchesAsTheHardwareLooksUp) {
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
  const auto ordered = [&](const char* cache) {
    return fetches(cache, "miss") + fetches(cache, "replaced");
  };
  EXPECT_EQ(ordered("vertex"), engine.vertex_fetch.misses.value());
  EXPECT_EQ(ordered("vertex") + fetches("vertex", "hit"), engine.vertex_fetch.lookups.value());
  EXPECT_LT(engine.vertex_fetch.lookups.value(), 2 * engine.work().kept_edges)
      << "edges with both vertices in a line";
  EXPECT_GT(engine.vertex_fetch.lookups.value(), engine.work().kept_edges) << "and in two";
  EXPECT_EQ(ordered("depth"), engine.depth_test.misses.value());
  EXPECT_EQ(fetches("block", "miss") + fetches("block", "read-back"),
            engine.weight_combiner.misses.value());
  EXPECT_EQ(fetches("block", "read-back"), engine.weight_combiner.blocks_read.value());
}

TEST(GeometricEnvironment, AResetInAnyPhaseBeginsTheFrameAgain) {
  for (const bool frame_copy : {false, true}) {
    GeometricSetup setup = small_setup();
    setup.geometric.frame_copy = frame_copy;
    const Outcome whole = run({}, setup);
    for (const rtl::Cycle at : {3u, 60u, 150u, 250u, 400u, 600u, 800u, 1000u}) {
      ASSERT_LT(at, whole.cycles);
      SimulationOptions options;
      options.reset_after = at;
      options.poison = true;
      const Outcome again = run(options, setup);
      EXPECT_EQ(again.hash, whole.hash) << at;
      EXPECT_EQ(again.cycles, whole.cycles) << at;
      EXPECT_EQ(again.mismatches, 0u) << at;
      EXPECT_GE(again.comparisons, whole.comparisons) << at;
    }
  }
}

TEST(GeometricEnvironment, FramesInARowBeginAsTheyWereRendered) {
  const Outcome one = run({}, small_setup()), three = run({}, small_setup(), 3);
  EXPECT_EQ(three.frames, 3u);
  EXPECT_EQ(three.cycles, 3 * one.cycles);
  EXPECT_EQ(three.traffic, 3 * one.traffic);
  constexpr std::uint64_t kAtTheEnd = 42 + 27;  // registers and figures
  EXPECT_EQ(three.comparisons - kAtTheEnd, 3 * (one.comparisons - kAtTheEnd));
}

// MEMORY_ERRORS counts on from frame to frame.
TEST(GeometricEnvironment, ErrorsOfFramesInARowAreExpected) {
  const Outcome two = forked<Outcome>([] {
    const std::vector<geometric::Frame> frames(2, small_frame());
    GeometricSetup setup = small_setup();
    setup.memory.error_address = regions_of(frames, setup.geometric).base(Region::kVertices);
    Simulation simulation({});
    GeometricEnvironment environment(simulation, frames, setup);
    simulation.elaborate(environment);
    bool failed = false;
    try {
      simulation.run();
      environment.check();
    } catch (const spec::SimulationError&) {
      failed = true;  // by the memory's errors, which are predicted
    }
    Outcome outcome = outcome_of(simulation, environment);
    if (!failed) outcome.frames = 0;
    return outcome;
  });
  EXPECT_EQ(two.frames, 2u) << "or no error came";
  EXPECT_EQ(two.mismatches, 0u);
}

// Of a frame with a copy: each line is a request, and takes a clock of the port at least.
TEST(GeometricEnvironment, FiguresOfACopyHaveEachLineOnce) {
  struct Figures {
    double bound, read, written, bytes_read;
  };
  const Figures figures = forked<Figures>([] {
    const std::vector<geometric::Frame> frames = {small_frame()};
    GeometricSetup setup = small_setup();
    setup.geometric.frame_copy = true;
    Simulation simulation({});
    GeometricEnvironment environment(simulation, frames, setup);
    simulation.elaborate(environment);
    simulation.run();
    environment.check();
    Result result;
    simulation.collect(result);
    Figures f{0, 0, 0, static_cast<double>(result.bytes_read)};
    for (const auto& work : result.work) {
      const auto* whole = std::get_if<std::uint64_t>(&work.value);
      const auto* real = std::get_if<double>(&work.value);
      const double value = whole ? static_cast<double>(*whole) : real ? *real : 0;
      if (work.name == "frame_cycles_bound") f.bound = value;
      if (work.name.starts_with("lines_read_")) f.read += value;
      if (work.name.starts_with("lines_written_")) f.written += value;
    }
    return f;
  });
  EXPECT_GT(figures.written, 0);
  EXPECT_EQ(64 * figures.read, figures.bytes_read);
  EXPECT_GE(figures.bound, figures.read + figures.written);
}

TEST(GeometricEnvironment, WeatherChangesClocksAndNothingElse) {
  const Outcome calm = run({}, small_setup());
  SimulationOptions slow;
  slow.fast_path = false;
  EXPECT_EQ(run(slow, small_setup()).cycles, calm.cycles);
  for (const std::uint64_t seed : {1u, 2u}) {
    SimulationOptions stormy;
    stormy.seed = seed;
    stormy.stall_permille = 150;
    stormy.poison = stormy.shuffle = true;
    GeometricSetup setup = small_setup();
    setup.memory.latency_max = 200;
    setup.memory.outstanding = 20;
    setup.memory.banks = 4;
    setup.memory.bank_busy = 5;
    const Outcome outcome = run(stormy, setup);
    EXPECT_EQ(outcome.hash, calm.hash);
    EXPECT_EQ(outcome.traffic, calm.traffic);
    EXPECT_EQ(outcome.mismatches, 0u);
    EXPECT_GT(outcome.cycles, calm.cycles);
  }
}

TEST(GeometricEnvironment, TheOrderOfEdgesChangesNoPixel) {
  const Outcome table = run({}, small_setup()),
                shuffled = run({}, small_setup(), 1, EdgeOrder::kShuffled);
  EXPECT_EQ(shuffled.hash, table.hash);
  EXPECT_NE(shuffled.traffic, table.traffic);
}

TEST(GeometricEnvironment, RegionsFollowEachOtherAtPages) {
  const std::vector<geometric::Frame> frames = {small_frame()};
  GeometricSetup setup;
  for (const bool frame_copy : {false, true}) {
    setup.geometric.frame_copy = frame_copy;
    const platform::GeometricRegions map = regions_of(frames, setup.geometric);
    // 480 faces, 720 edges, 240 vertices and 2 poles; 12 x 8 tiles of 256 bytes; 23 x 16 blocks.
    const std::uint32_t expected[] = {0, 4096, 16384, 20480, 45056, 69632, 94208};
    for (std::size_t i = 0; i < std::size(expected); ++i)
      EXPECT_EQ(map.base(static_cast<Region>(i)), expected[i]) << i;
    EXPECT_EQ(map.bytes(), frame_copy ? 118784u : 94208u);
    EXPECT_EQ(map.region_of(4095), 0u);
    EXPECT_EQ(map.region_of(4096), 1u);
    EXPECT_EQ(map.region_of(94207), 5u);
    EXPECT_EQ(map.region_of(118784), platform::GeometricRegions::kCount);
  }
}

TEST(GeometricEnvironment, WhatTheEngineDoesNotTakeIsRejected) {
  const std::vector<geometric::Frame> frames = {small_frame()};
  GeometricSetup setup;
  setup.geometric.line_pixels = 64;
  Simulation simulation({});
  EXPECT_THROW(GeometricEnvironment(simulation, frames, setup), spec::ConfigError);
}

// A part that gets its colours from elsewhere: here a row of pixels every few cycles.
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

TEST(GeometricEnvironment, IsAPartOfAComposition) {
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
