// SPDX-License-Identifier: MIT
// The command's half of an engine's declaration: how the engine is run, which files its runs write,
// and how its random and long runs are made. The testbench's half is tb/env/engine_testbench.h. An
// engine is declared once; all other code reads the declaration and names no engine. To add one:
// implement the halves in tb/engines/NAME and tool/engines/NAME, and add NAME to
// tb/engines/engines.txt (docs/howto/add_an_engine.md).
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tb/env/engine_testbench.h"
#include "tb/run/given_work.h"
#include "tb/traces/trace_file.h"
#include "tool/pages/run_context.h"
#include "tool/run/random_draws.h"

namespace deburr::tool {

// Parameters of every engine's runs, "run.*".
enum class CheckMode : std::uint8_t { kNone, kGolden };
inline constexpr std::array<std::string_view, 2> kCheckModeNames = {"none", "golden"};

struct RunParameters {
  CheckMode check = CheckMode::kGolden;
  std::int64_t seed = 1, stall_seed = 1;
  double clock_mhz = 166.67;
  std::int64_t max_cycles = 0;
  std::int32_t watchdog_cycles = 20000;
  double stalls = 0;
  std::int64_t reset_after = 0;
  bool shuffle = false;
  bool fast_path = true;
  bool check_links = true;
  bool poison = false;
  std::string trace;
  std::int64_t trace_from = 0, trace_to = 2000;
  std::int64_t interval_cycles = 0;
  bool maps = false;
  std::string pixel;
  bool coverage = false;
  bool timeline = false;
  std::int64_t timeline_from = 0, timeline_to = 2000;
  tb::traces::TraceChoice line_trace = tb::traces::TraceChoice::kNone;
  std::string fault;
  bool reference = false;
  bool images = true;
};

template <class Visitor>
void describe(RunParameters& p, Visitor& v) {
  v.choice("check", p.check, kCheckModeNames,
           "golden: compare every output and every memory access with the golden model.");
  v.integer("seed", p.seed, 0, 0xFFFFFFFF, "", "Seed of the inputs, such as procedural textures.");
  v.integer("stall_seed", p.stall_seed, 0, 0xFFFFFFFF, "",
            "Seed of everything that must not change a pixel: random stalls, latencies, evaluation "
            "order and noise.");
  v.real("clock_mhz", p.clock_mhz, 1, 10000, "MHz",
         "Clock frequency for which times and rates are given.");
  v.is_work("clock_mhz", tb::GivenWork::kSetting);
  v.integer("max_cycles", p.max_cycles, 0, std::int64_t{1} << 40, "clk",
            "Cycle limit: the run ends with an error there; 0: no limit.");
  v.integer("watchdog_cycles", p.watchdog_cycles, 100, 1 << 30, "clk",
            "Cycles without any progress that count as a deadlock.");
  v.real("stalls", p.stalls, 0, 0.9, "probability",
         "Random stalls: probability that one side of a link stalls in a cycle, for every link.");
  v.integer("reset_after", p.reset_after, 0, std::int64_t{1} << 40, "clk",
            "Cycle of the first frame in which the hardware is reset once; the frame then starts "
            "again. Must not change results. 0: never.");
  v.boolean("shuffle", p.shuffle, "Evaluate the units in a random order; must not change results.");
  v.boolean(
      "fast_path", p.fast_path,
      "Evaluate several cycles per SystemC activation where this is unobservable; must not change "
      "results.");
  v.boolean("check_links", p.check_links,
            "Protocol checkers on every link; off by default if a fault is injected.");
  v.boolean("poison", p.poison,
            "Unwritten fields of every link hold noise, which must fit their width; must not "
            "change results.");
  v.text("trace", p.trace, "glob", "Units and links recorded in trace.vcd; empty: none.");
  v.integer("trace_from", p.trace_from, 0, std::int64_t{1} << 40, "clk", "First recorded cycle.");
  v.integer("trace_to", p.trace_to, 0, std::int64_t{1} << 40, "clk",
            "Cycle after the last recorded one.");
  v.integer(
      "interval_cycles", p.interval_cycles, 0, std::int64_t{1} << 40, "clk",
      "Sampling interval in cycles: records the activity of each unit, link and port per interval "
      "in intervals.json, with link occupancies in result.json and curves in the report; 0: none.");
  v.boolean("maps", p.maps,
            "Write maps of the picture, in false colours and as values: what the hardware did for "
            "each pixel.");
  v.text("pixel", p.pixel, "X,Y",
         "Records every step for this pixel, golden and hardware side by side, as pixel of "
         "result.json and a table of the report; column from the left, row from the top. Empty: "
         "none.");
  v.boolean("coverage", p.coverage,
            "Functional coverage: write the hits of each bin of docs/reference/coverage.md as "
            "coverage.bins of result.json. Needs the golden model, which counts them.");
  v.boolean("timeline", p.timeline,
            "Write timeline.json for trace viewers (Perfetto, chrome://tracing): the activity of "
            "each unit in each cycle, and memory transactions.");
  v.integer("timeline_from", p.timeline_from, 0, std::int64_t{1} << 40, "clk",
            "First cycle of the timeline.");
  v.integer("timeline_to", p.timeline_to, 0, std::int64_t{1} << 40, "clk",
            "Cycle after the last of the timeline, at most 100000 after the first.");
  v.choice("line_trace", p.line_trace, tb::traces::kTraceChoiceNames,
           "Writes lines.trace: every line requested from memory (docs/reference/traces.md).");
  v.text("fault", p.fault, "name",
         "Injects a fault that the checks must catch (docs/reference/tests.md).");
  v.boolean("reference", p.reference,
            "Compare the picture with the supersampled reference image of the scene.");
  v.boolean("images", p.images, "Write pictures, and show them in the report.");
}

// A command line option that sets one parameter, or two if its value has the form AxB. An option
// without a value sets a switch to `given`.
struct Shorthand {
  std::string option, parameter, help;
  std::string second_parameter{}, given = "true";
};

// Settings that make a random run long: many frames, or a large frame.
struct LongRun {
  std::vector<std::pair<std::string, std::string>> settings;
  // Suffixes of parameters that keep their defaults: build parameters that suit only small
  // pictures.
  std::vector<std::string_view> without{};
};

class CompositionRole;

class Engine : public virtual tb::EngineTestbench {
 public:
  virtual std::string_view summary() const = 0;
  // Its role in a composition, with its own parameters (tool/run/composition.h); null: none.
  virtual std::unique_ptr<CompositionRole> role() const;
  // Names of the engines of which it is composed. It inherits their maps (prefixed "NAME_"),
  // coverage bins and random draws.
  virtual std::vector<std::string_view> parts() const { return {}; }
  RunParameters run_parameters() const {
    RunParameters run;
    run.clock_mhz = clock_mhz();
    return run;
  }
  virtual std::vector<Shorthand> shorthands() const = 0;
  // Options of at least one instructive run, for --help. Input files are called mesh.obj or
  // frame.png.
  virtual std::vector<std::string_view> examples() const = 0;
  // Called after all settings: derives dependent values (presets) and rejects settings without
  // effect.
  virtual void resolve(tb::ParameterSet&) {}
  // Checks the input as run() does (a scene that draws nothing, a frame too wide for the build),
  // without simulating. After resolve().
  virtual void check(const RunParameters& run, RunContext& context) = 0;
  // Simulates and fills the context's images. Errors are thrown (spec/error.h); `result` then holds
  // what was measured so far.
  virtual void run(const RunParameters& run, RunContext& context, tb::Result& result) = 0;
  // Prepares the inputs that run() takes from context.shared(), for all runs that share them. It
  // creates no SystemC objects, so that the process can fork any number of run() calls afterwards.
  virtual void prepare(const RunParameters&, RunContext&) {}

  // ---- names of files that its runs may write: NAME.png; map_NAME.png and map_NAME.pfm
  virtual std::vector<std::string_view> pictures() const = 0;
  virtual std::vector<std::string_view> maps() const { return {}; }

  // A short description of the pixel history that the engine keeps (run.pixel); empty if it keeps
  // none.
  virtual std::string_view pixel_history() const { return {}; }

  // ---- random runs
  virtual RandomDraws random_draws() const { return {}; }
  virtual LongRun long_run() const = 0;
};

// The engines of tb/engines/engines.txt, in order. They are selected by the list with which the
// program is linked (cmake/Engines.cmake).
std::vector<std::unique_ptr<Engine>> engines();

// ConfigError with near matches for an unknown name.
std::unique_ptr<Engine> engine_named(const std::string& name);
// The maps of the engine and its parts, under their names in RunContext.
std::vector<std::string> maps_of(const Engine& engine);
// Whether the engine or one of its parts keeps the history of a pixel.
bool keeps_pixel_history(const Engine& engine);

}  // namespace deburr::tool
