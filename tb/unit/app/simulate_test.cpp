// SPDX-License-Identifier: MIT
// What a run that fails says of itself, whatever can no longer be left of it.
#include "tb/app/simulate.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <stdexcept>
#include <string>
#include <systemc>
#include <vector>

#include "spec/error.h"
#include "tb/app/run_once.h"
#include "tb/base/forked.h"
#include "tb/engines/geometric/geometric_environment.h"
#include "tb/engines/geometric/geometric_frames.h"

namespace deburr::tb::simulate_test {
namespace {

using testing::HasSubstr;
using testing::Not;

// Nothing is bound to it, so no simulation with it is elaborated.
struct Unbound : sc_core::sc_module {
  explicit Unbound(const sc_core::sc_module_name& name) : sc_module(name) {}
  sc_core::sc_in<bool> nothing{"nothing"};
};

std::string error_of(const std::string& engine) {
  return forked_text([&]() -> std::string {
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
    Result result;
    try {
      bound.engine.run(bound.run, context, result);
    } catch (const std::exception& error) {
      return error.what();
    }
    return "no error";
  });
}

// Not that of pictures of a frame that was never begun.
TEST(FailedRun, OfEveryEngineSaysWhatElaborationSays) {
  for (const std::unique_ptr<Engine>& engine : engines())
    EXPECT_THAT(error_of(std::string(engine->name())), HasSubstr("unbound.nothing"))
        << engine->name();
}

TEST(FailedRun, SaysWhyEvenIfItsPicturesFailToo) {
  for (const bool fails : {false, true}) {
    const std::string error = forked_text([&]() -> std::string {
      GeometricSceneParameters p;
      p.source = "cube";
      p.width = p.height = 32;
      const std::vector<geometric::Frame> frames = {load_geometric_frame(p, 1, false).frame};
      RunParameters run;
      ParameterSet set;
      set.add("run", ParameterKind::kRun, run);
      RunContext context("", set, "", 1);
      context.set_quiet(true);
      SimulationOptions options;
      options.max_cycles = fails ? 10 : 0;
      Simulation simulation(options);
      GeometricEnvironment environment(simulation, frames, {});
      Result result;
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

}  // namespace
}  // namespace deburr::tb::simulate_test
