// SPDX-License-Identifier: MIT
// Messages of a failed run, even if its results can no longer be written.
#include "tool/run/simulate.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <memory>
#include <stdexcept>
#include <string>
#include <systemc>
#include <vector>

#include "spec/error.h"
#include "tb/base/forked.h"
#include "tb/engines/geometric/geometric_environment.h"
#include "tb/engines/geometric/geometric_frames.h"
#include "tool/run/input_rules.h"
#include "tool/run/run_once.h"

namespace deburr::tool::simulate_test {

using tb::ParameterSet;

namespace {

using testing::HasSubstr;
using testing::Not;

// It has an unbound port, so no simulation with it can be elaborated.
struct Unbound : sc_core::sc_module {
  explicit Unbound(const sc_core::sc_module_name& name) : sc_module(name) {}
  sc_core::sc_in<bool> nothing{"nothing"};
};

std::string error_of(const std::string& engine) {
  return tb::forked_text([&]() -> std::string {
    const std::unique_ptr<Engine> made = engine_named(engine);
    BoundEngine bound(*made);
    for (const char* size : {"width", "height"})
      for (const char* of : {"scene", "frame"})
        if (const std::string name = std::string(of) + '.' + size; bound.set.find(name))
          bound.set.set(name, "32", "test");
    bound.resolve();
    RunContext context("", bound.set, "", 1);
    context.set_quiet(true);
    const Unbound unbound("unbound");
    tb::Result result;
    try {
      bound.engine.run(bound.run, context, result);
    } catch (const std::exception& error) {
      return error.what();
    }
    return "no error";
  });
}

// Not the error about pictures of a frame that was never started.
TEST(FailedRun, EveryEngineReportsElaborationError) {
  for (const std::unique_ptr<Engine>& engine : engines())
    EXPECT_THAT(error_of(std::string(engine->name())), HasSubstr("unbound.nothing"))
        << engine->name();
}

TEST(FailedRun, ReportsReasonEvenIfPicturesFail) {
  for (const bool fails : {false, true}) {
    const std::string error = tb::forked_text([&]() -> std::string {
      tb::GeometricSceneParameters p;
      p.source = "cube";
      p.width = p.height = 32;
      const std::vector<tb::geometric::Frame> frames = {
          tb::load_geometric_frame(p, 1, false).frame};
      RunParameters run;
      ParameterSet set;
      set.add("run", tb::ParameterKind::kRun, run);
      RunContext context("", set, "", 1);
      context.set_quiet(true);
      tb::SimulationOptions options;
      options.max_cycles = fails ? 10 : 0;
      tb::Simulation simulation(options);
      tb::GeometricEnvironment environment(simulation, frames, {});
      tb::Result result;
      try {
        simulate(simulation, environment, context, result,
                 [] { throw std::runtime_error("no pictures"); });
      } catch (const std::exception& e) {
        return e.what();
      }
      return "no error";
    });
    EXPECT_THAT(error, HasSubstr(fails ? "--max-cycles" : "no pictures"));
    if (fails) {
      EXPECT_THAT(error, Not(HasSubstr("no pictures")));
    }
  }
}

// ---- parameters of a simulation ---------------------------------------------------------------

tb::SimulationOptions options_of(const RunParameters& run, const ParameterSet& set = {}) {
  return simulation_options(run, RunContext("out", set, "", 1));
}

TEST(SimulationOptions, FollowRunParameters) {
  RunParameters run;
  tb::SimulationOptions o = options_of(run);
  EXPECT_TRUE(o.golden && o.fast_path && o.check_links);
  EXPECT_FALSE(o.shuffle || o.poison || o.maps || o.coverage || o.timeline || o.pixel);
  EXPECT_TRUE(o.faults.empty() && o.trace_scope.empty());
  run.clock_mhz = 123.5;
  run.seed = 8;
  run.stall_seed = 9;
  run.stalls = 0.2506;
  run.max_cycles = 11;
  run.watchdog_cycles = 112;
  run.reset_after = 13;
  run.shuffle = run.poison = run.maps = run.coverage = run.timeline = true;
  run.fast_path = run.check_links = false;
  run.trace = "a*";
  run.trace_from = 14;
  run.trace_to = 15;
  run.interval_cycles = 16;
  run.pixel = "17,18";
  run.timeline_from = 19;
  run.timeline_to = 20;
  o = options_of(run);
  EXPECT_EQ(o.clock_mhz, 123.5);
  EXPECT_EQ(o.seed, 9u) << "that of what must change nothing";
  EXPECT_EQ(o.stall_permille, 251u);
  EXPECT_EQ(o.max_cycles, 11u);
  EXPECT_EQ(o.patience, 112u);
  EXPECT_EQ(o.reset_after, 13u);
  EXPECT_TRUE(o.shuffle && o.poison && o.maps && o.coverage);
  EXPECT_FALSE(o.fast_path || o.check_links);
  EXPECT_EQ(o.trace_scope, "a*");
  EXPECT_THAT(o.trace_file, testing::EndsWith("trace.vcd"));
  EXPECT_EQ(o.trace_from, 14u);
  EXPECT_EQ(o.trace_to, 15u);
  EXPECT_EQ(o.interval_cycles, 16u);
  EXPECT_EQ(o.pixel, (tb::PixelAddress{17, 18}));
  EXPECT_EQ(o.timeline->from, 19u);
  EXPECT_EQ(o.timeline->to, 20u);
  run.check = CheckMode::kNone;
  EXPECT_THROW(options_of(run), spec::ConfigError) << "coverage is the golden model's";
  run.coverage = false;
  EXPECT_FALSE(options_of(run).golden);
}

// Link checkers ignore an injected fault unless they were requested.
TEST(SimulationOptions, InjectedFaultDisablesLinkCheckers) {
  RunParameters run;
  ParameterSet set;
  set.add("run", tb::ParameterKind::kRun, run);
  run.fault = "flip-bit";
  EXPECT_FALSE(options_of(run, set).check_links);
  EXPECT_THAT(options_of(run, set).faults, testing::ElementsAre("flip-bit"));
  set.set("run.check_links", "true", "test");
  EXPECT_TRUE(options_of(run, set).check_links);
}

TEST(SimulationOptions, ProgramConfigurationUnlessItIsResetValues) {
  tb::ProgramParameters program;
  ParameterSet set;
  set.add("run", tb::ParameterKind::kRun, program);
  EXPECT_TRUE(options_of({}, set).program);
  set.set("run.program", "reset", "test");
  EXPECT_FALSE(options_of({}, set).program);
}

TEST(FromRepository, StripsTheBuildPath) {
  EXPECT_EQ(from_repository("/a/layers/tb/tb/env/x.cpp:7: y"), "tb/env/x.cpp:7: y");
  EXPECT_EQ(from_repository("/a/layers/tool/tool/run/x.cpp:7: y"), "tool/run/x.cpp:7: y");
  EXPECT_EQ(from_repository("/a/layers/studies/studies/papers/x.h"), "studies/papers/x.h");
  EXPECT_EQ(from_repository("/a/layers/rtl_model/rtl_model/x.h:7"), "rtl_model/x.h:7");
  EXPECT_EQ(from_repository("/a/layers/golden/golden/x.h"), "golden/x.h");
  EXPECT_EQ(from_repository("/a/layers/spec/spec/x.h"), "spec/x.h");
  EXPECT_EQ(from_repository("elsewhere/x.h"), "elsewhere/x.h");
}

// ---- checks of the input ----------------------------------------------------------------------

std::string rejection(const std::function<void()>& action) {
  try {
    action();
  } catch (const spec::ConfigError& error) {
    return error.what();
  }
  return "";
}

TEST(InputRules, RejectsSceneThatDrawsNothing) {
  tb::Scene scene;
  scene.name = "s";
  scene.mesh.vertices = {{{1, -2, 3}, {}, {}}, {{-1.5, 4, 0}, {}, {}}};
  scene.mesh.triangles.resize(3);
  tb::DepthImage depth(3, 2);
  EXPECT_EQ(rejection([&] { reject_nothing_drawn(scene, depth); }),
            "the scene 's' draws nothing: none of its 3 triangles, from (-1.5, -2, 0) to (1, 4, "
            "3), covers the centre of any of 3 x 2 pixels: check the camera (scene.eye, "
            "scene.target, scene.fov) and the size of the mesh");
  EXPECT_EQ(rejection([&] { reject_nothing_drawn(depth, "m.obj"); }),
            "the scene 'm.obj' draws nothing: none of its triangles covers the centre of any of 3 "
            "x 2 pixels: check the size of the mesh");
  depth.at(2, 1) = 0.001f;
  EXPECT_EQ(rejection([&] { reject_nothing_drawn(scene, depth); }), "");
  EXPECT_EQ(rejection([&] { reject_nothing_drawn(depth, "m.obj"); }), "");
}

TEST(InputRules, RejectsMemorySlowerThanWatchdog) {
  RunParameters run;
  run.watchdog_cycles = 1000;
  ParameterSet set;
  set.add("run", tb::ParameterKind::kRun, run);
  tb::MemoryParameters memory;
  const auto said = [&](std::int32_t latency, std::int32_t most, std::int32_t busy) {
    memory.latency = latency;
    memory.latency_max = most;
    memory.bank_busy = busy;
    return rejection([&] { reject_slow_memory(set, "memory", memory); });
  };
  EXPECT_EQ(said(999, 0, 0), "");
  EXPECT_EQ(said(900, 999, 0), "");
  EXPECT_EQ(said(900, 0, 99), "");
  const std::string rest =
      " is not below run.watchdog_cycles = 1000, after which a run without progress counts as a "
      "deadlock: raise it (--set run.watchdog_cycles=";
  EXPECT_EQ(said(1000, 0, 0), "memory.latency = 1000" + rest + "2000), or make the memory faster");
  EXPECT_EQ(said(10, 1001, 0),
            "memory.latency_max = 1001" + rest + "2002), or make the memory faster");
  EXPECT_EQ(said(900, 20, 100), "memory.latency = 900 and memory.bank_busy = 100" + rest +
                                    "2000), or make the memory faster");
  memory.latency_file = testing::TempDir() + "latencies.txt";
  std::ofstream(memory.latency_file) << "5\n1500\n8\n";
  EXPECT_EQ(said(1, 0, 0),
            "memory.latency_file = 1500" + rest + "3000), or make the memory faster");
}

TEST(InputRules, RejectsUnusedMemoryParameters) {
  tb::MemoryParameters memory;
  const auto said = [&](const std::vector<std::pair<std::string, std::string>>& given) {
    memory = {};
    ParameterSet set;
    add_memory(set, "memory", memory);
    for (const auto& [name, value] : given) set.set("memory." + name, value, "--set");
    return rejection([&] { reject_unused_memory(set, "memory", memory); });
  };
  EXPECT_EQ(said({{"latency_max", "101"},
                  {"banks", "2"},
                  {"interleave_bytes", "128"},
                  {"error_address", "0"},
                  {"error_bytes", "1"}}),
            "");
  EXPECT_THAT(said({{"latency_max", "100"}}),
              HasSubstr("has no effect: it is not above memory.latency = 100"));
  EXPECT_THAT(said({{"latency_max", "101"}, {"latency_file", "any"}}),
              HasSubstr("has no effect: memory.latency_file gives the latencies"));
  EXPECT_THAT(said({{"interleave_bytes", "128"}}), HasSubstr("has no effect: memory.banks = 1"));
  EXPECT_THAT(said({{"error_bytes", "1"}}),
              HasSubstr("has no effect: memory.error_address is not set"));
}

TEST(InputRules, LabelNamesChangesFromPreset) {
  tb::MemoryParameters memory;
  ParameterSet set;
  add_memory(set, "memory", memory);
  EXPECT_EQ(with_changes("fast", set, "memory."), "fast");
  for (const char* name : {"memory.latency", "memory.banks", "memory.outstanding"}) {
    set.set(name, "7", "--set");
    set.imply(name, name == std::string("memory.banks") ? "7" : "9", "preset");
  }
  EXPECT_EQ(with_changes("fast", set, "memory."), "fast, changed: latency, outstanding");
  EXPECT_EQ(with_changes("fast", set, "other."), "fast");
}

}  // namespace
}  // namespace deburr::tool::simulate_test
