// SPDX-License-Identifier: MIT
// A whole frame takes its results from the environments that it is composed of, whichever they are.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "spec/error.h"
#include "tb/base/forked.h"
#include "tb/unit/engines/run_figures.h"
#include "tool/engines/frame/frame_composition.h"

namespace deburr::tool::composition_test {

using tb::number_at;
using tb::work;

namespace {

using Settings = std::vector<std::pair<std::string, std::string>>;

// The first composition of each kind.
enum class Kind { kRows, kMesh, kBoth };
constexpr Kind kAll[] = {Kind::kRows, Kind::kMesh, Kind::kBoth};

const Smoothing& first_of(const FrameRoles& roles, Kind kind) {
  for (const Smoothing& s : roles.smoothings())
    if ((s.mesh != nullptr) == (kind != Kind::kRows) &&
        (s.rows != nullptr) == (kind != Kind::kMesh))
      return s;
  throw spec::ConfigError("no such composition");
}

// Names of parameters: "rows:storage" is a parameter of the row smoother, "mesh_memory:latency" of
// the mesh smoother's memory.
std::string name_in(const Smoothing& s, const std::string& name) {
  const std::size_t colon = name.find(':');
  if (colon == std::string::npos) return name;
  const std::string of = name.substr(0, colon);
  const PictureSmoother& smoother =
      of.starts_with("rows") ? static_cast<const PictureSmoother&>(*s.rows) : *s.mesh;
  const std::vector<std::string> prefixes = smoother.prefixes();
  return (of.ends_with("_memory") ? prefixes.back() : prefixes.front()) + name.substr(colon + 1);
}

struct Given {
  Kind kind = Kind::kRows;
  Settings settings{};
};

// The roles as in a run: its parameters, set and resolved.
struct Resolved {
  explicit Resolved(const Given& given) {
    set.add("run", tb::ParameterKind::kRun, run);
    roles.add_parameters(set);
    const Smoothing& smoothing = first_of(roles, given.kind);
    set.set("frame.smoothing", smoothing.name, "test");
    for (const auto& [name, value] :
         Settings{{"scene.texture_size", "64"}, {"scene.width", "48"}, {"scene.height", "32"}})
      set.set(name, value, "test");
    for (const auto& [name, value] : given.settings)
      set.set(name_in(smoothing, name), value, "test");
    roles.resolve(set);
  }
  std::shared_ptr<const tb::DrawnScene> scene() const {
    RunContext context("", set, "", 1);
    return roles.drawer().load(1, context);
  }
  RunParameters run;
  FrameRoles roles;
  tb::ParameterSet set;
};

struct Outcome {
  std::uint64_t cycles, comparisons, mismatches, traffic, pixels, colours, blended, left;
  std::uint64_t drawing, bound;
  bool memory_errors;
};

// A hardware counter of any engine and unit.
std::uint64_t counter(const tb::Result& result, std::string_view end) {
  for (const tb::WorkItem& item : result.work)
    if (item.name.ends_with(end)) return std::get<std::uint64_t>(item.value);
  return 0;
}

Outcome run(const tb::SimulationOptions& options, const Given& given) {
  return tb::forked<Outcome>([&] {
    const Resolved resolved(given);
    const std::shared_ptr<const tb::DrawnScene> scene = resolved.scene();
    tb::Simulation simulation(options);
    FrameComposition frame(simulation, *scene, resolved.roles);
    simulation.elaborate(frame);
    bool memory_errors = false;
    try {
      simulation.run();
    } catch (const spec::SimulationError&) {
      memory_errors = true;
    }
    frame.check();
    tb::Result result;
    simulation.collect(result);
    return Outcome{result.cycles,
                   result.comparisons,
                   result.mismatches,
                   result.traffic_comparisons,
                   frame.delivered(),
                   frame.drawing().environment().amount().delivered,
                   counter(result, "_resolver_blended_pixels"),
                   counter(result, "_bypassed_pixels"),
                   counter(result, "drawing_cycles"),
                   counter(result, "engine_cycles_bound"),
                   memory_errors};
  });
}

TEST(FrameComposition, ComparesBothEnginesAndTheirRegisters) {
  const Outcome o = run({}, {});
  constexpr std::uint64_t kRegisters = 7 + 15, kFigures = 11 + 4;
  EXPECT_EQ(o.pixels, 48u * 32u);
  EXPECT_GT(o.colours, 0u);
  EXPECT_EQ(o.comparisons, o.colours + 2 * o.pixels + kRegisters + kFigures);
  EXPECT_GT(o.traffic, 0u);
}

// Checks lines, candidates and blocks in addition to its pixels, which are those in memory.
TEST(FrameComposition, EdgeSmootherStartsAfterTheFrameIsDrawn) {
  const Outcome o = run({}, {Kind::kMesh});
  EXPECT_EQ(o.mismatches, 0u);
  EXPECT_EQ(o.pixels, 48u * 32u);
  EXPECT_GT(o.blended, 20u);
  EXPECT_GT(o.comparisons, o.colours + o.pixels + 2 * o.blended / 16);
  EXPECT_GT(o.cycles, o.colours + o.drawing);
  EXPECT_GT(o.drawing, 500u);
  EXPECT_GE(o.cycles, o.bound);
}

TEST(FrameComposition, RowSmootherStartsAfterEdgeSmoother) {
  const Outcome first = run({}, {Kind::kMesh});
  const Outcome both = run({}, {Kind::kBoth});
  EXPECT_EQ(both.mismatches, 0u);
  EXPECT_EQ(both.pixels, 48u * 32u);
  EXPECT_EQ(both.blended, first.blended);
  EXPECT_GT(run({}, {Kind::kBoth, {{"rows:bypass", "half"}}}).left, 10u);
  EXPECT_EQ(both.drawing, first.drawing);
  // The engines run one after the other.
  constexpr std::uint64_t kRows = 32, kWidth = 48, kReach = 32;
  EXPECT_GT(both.cycles, first.cycles + (kRows + kReach + 5) * kWidth);
  EXPECT_LT(both.cycles, first.cycles + (kRows + kReach + 5) * kWidth + 400);
}

tb::Json figures_of(const Given& given) {
  return tb::Json::parse(tb::forked_text([&] {
    const Resolved resolved(given);
    const std::shared_ptr<const tb::DrawnScene> scene = resolved.scene();
    tb::Simulation simulation({});
    FrameComposition frame(simulation, *scene, resolved.roles);
    simulation.elaborate(frame);
    simulation.run();
    frame.check();
    tb::Json json = json_of(simulation);
    json["fragments"] = scene->stream().counts.fragments;
    json["bound_of_colours"] = frame.drawing().cycles_bound();
    const MeshStage* const mesh = std::as_const(frame).mesh();
    const RowStage* const rows = std::as_const(frame).rows();
    json["bound_of_edges"] = mesh ? mesh->cycles_bound(48, 32) : 0;
    json["bound_of_rows"] = rows ? rows->cycles_bound(48, 32) : 0;
    json["doing"] = resolved.roles.drawer().words().doing;
    return json.dump();
  }));
}

// Four bytes per fragment written and per pixel read. Edges are smoothed after drawing, rows alone
// during drawing.
TEST(FrameComposition, FiguresCoverTheWholeFrame) {
  constexpr double kPixels = 48 * 32;
  for (const Kind kind : kAll) {
    const tb::Json r = figures_of({kind});
    const bool mesh = kind != Kind::kRows, rows = kind != Kind::kMesh;
    const double cycles = number_at(r, "/cycles"), colours = number_at(r, "/bound_of_colours"),
                 edges = number_at(r, "/bound_of_edges"), smooth = number_at(r, "/bound_of_rows");
    EXPECT_EQ(work(r, "frame_buffer_bytes"), 4 * kPixels);
    EXPECT_EQ(work(r, "frame_buffer_bytes_written"), 4 * number_at(r, "/fragments"));
    EXPECT_EQ(work(r, "frame_buffer_bytes_read"), rows ? 4 * kPixels : 0);
    EXPECT_DOUBLE_EQ(number_at(r, "/throughput/value"), kPixels / cycles);
    const double bound = mesh ? colours + edges + smooth : std::max(colours, smooth);
    EXPECT_EQ(work(r, mesh ? "engine_cycles_bound" : "slower_engine_cycles"), bound);
    EXPECT_DOUBLE_EQ(number_at(r, "/throughput/bound"), kPixels / bound);
    EXPECT_LE(bound, cycles);
    const double drawn = work(r, r["doing"].get<std::string>() + "_cycles");
    EXPECT_GE(drawn, colours);
    double all = drawn;
    if (mesh) {
      EXPECT_GE(work(r, "drawing_cycles"), edges);
      all += work(r, "drawing_cycles");
    }
    if (rows) {
      EXPECT_EQ(work(r, "smoothing_cycles_by_formula"), smooth);
      EXPECT_GE(work(r, "smoothing_cycles"), smooth);
      all += work(r, "smoothing_cycles");
    }
    if (mesh)
      EXPECT_NEAR(all, cycles, 20) << "one after the other";
    else
      EXPECT_EQ(work(r, "overlapped_cycles"), all - cycles);
  }
}

// Hidden fragments are written as well.
TEST(FrameComposition, ByteCountsIncludeHiddenFragments) {
  for (const Kind kind : kAll) {
    const tb::Json seen = figures_of({kind}),
                   all = figures_of({kind, {{"scene.visibility", "overdraw"}}});
    EXPECT_GT(number_at(all, "/fragments"), number_at(seen, "/fragments"));
    EXPECT_EQ(work(all, "frame_buffer_bytes_written"), 4 * number_at(all, "/fragments"));
    EXPECT_EQ(work(all, "frame_buffer_bytes_read"), work(seen, "frame_buffer_bytes_read"));
    EXPECT_EQ(number_at(all, "/checks/mismatches"), 0);
  }
}

TEST(FrameComposition, NoiseInUnwrittenFieldsChangesNothing) {
  tb::SimulationOptions poisoned;
  poisoned.poison = true;
  poisoned.stall_permille = 100;
  for (const Kind kind : kAll) EXPECT_EQ(run(poisoned, {kind}).mismatches, 0u);
}

TEST(FrameComposition, ResetInMidFrameRestartsTheFrame) {
  for (const Given& given : {Given{}, Given{Kind::kRows, {{"rows:storage", "memory"}}},
                             Given{Kind::kMesh}, Given{Kind::kBoth}}) {
    const Outcome whole = run({}, given);
    std::set<rtl::Cycle> moments = {100, 1500, 3000};
    // While edges are drawn, and while rows are output.
    if (given.kind != Kind::kRows)
      moments.insert({whole.cycles - 60, whole.cycles - whole.drawing / 2});
    for (const rtl::Cycle at : moments) {
      tb::SimulationOptions broken_off;
      broken_off.reset_after = at;
      const Outcome again = run(broken_off, given);
      EXPECT_EQ(again.pixels, whole.pixels) << at;
      EXPECT_EQ(again.cycles, whole.cycles) << at;
      EXPECT_EQ(again.mismatches, 0u) << at;
    }
  }
}

TEST(FrameComposition, ErrorsOfEveryMemoryArePredictedAndReported) {
  const std::string all = std::to_string(1 << 20);
  const Settings texels = {{"memory.error_address", "0"}, {"memory.error_bytes", all}};
  EXPECT_TRUE(run({}, {Kind::kRows, texels}).memory_errors);
  const Settings pixels = {{"rows:storage", "memory"}, {"rows_memory:error_address", "0"}};
  EXPECT_TRUE(run({}, {Kind::kRows, pixels}).memory_errors);
  // Errors in everything that is read and written along edges; the next engine gets the pixels that
  // remain correct.
  for (const Kind kind : {Kind::kMesh, Kind::kBoth}) {
    const Settings edges = {{"mesh_memory:error_address", "0"}, {"mesh_memory:error_bytes", all}};
    const Outcome o = run({}, {kind, edges});
    EXPECT_TRUE(o.memory_errors);
    EXPECT_EQ(o.mismatches, 0u);
  }
}

void each_figure_has_a_name_of_its_own(tb::Simulation& simulation, FrameComposition& frame) {
  simulation.elaborate(frame);
  tb::Result result;
  simulation.collect(result);
  std::set<std::string> names;
  for (const tb::WorkItem& item : result.work)
    EXPECT_TRUE(names.insert(item.name).second) << item.name;
  for (const tb::UnitCycles& unit : result.units)
    EXPECT_TRUE(names.insert("unit " + unit.name).second) << unit.name;
  for (const tb::MemoryFigures& memory : result.memories)
    EXPECT_TRUE(names.insert("memory " + memory.name).second) << memory.name;
  for (const tb::Figure& figure : result.figures) {
    if (!figure.key.starts_with("work.")) continue;
    EXPECT_TRUE(names.contains(figure.key.substr(5))) << figure.key;
  }
}

// A figure of one part must not hide that of another.
class EveryFigure : public testing::TestWithParam<Kind> {};

TEST_P(EveryFigure, NamesAreUnique) {
  const Resolved resolved({GetParam()});
  const std::shared_ptr<const tb::DrawnScene> scene = resolved.scene();
  tb::Simulation simulation({});
  FrameComposition frame(simulation, *scene, resolved.roles);
  each_figure_has_a_name_of_its_own(simulation, frame);
}

INSTANTIATE_TEST_SUITE_P(FrameComposition, EveryFigure, testing::ValuesIn(kAll));

TEST(FrameComposition, AllEnginesAreDescribedWithoutRunning) {
  const Resolved resolved({});
  const std::shared_ptr<const tb::DrawnScene> scene = resolved.scene();
  tb::Simulation simulation({});
  const auto frame = FrameComposition::of_all(simulation, *scene, resolved.roles);
  each_figure_has_a_name_of_its_own(simulation, *frame);
}

}  // namespace
}  // namespace deburr::tool::composition_test
