// SPDX-License-Identifier: MIT
#include "tool/tests/command/made_engine.h"

#include <array>
#include <fstream>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "spec/check_build.h"

namespace deburr::tool {
namespace {

enum class Filter : std::uint8_t { kNear, kLinear, kWide, kOther };
constexpr std::array<std::string_view, 4> kFilterNames = {"near", "linear", "wide",
                                                          "another-one-with-a-very-long-name"};

struct MadeRules {
  Filter filter = Filter::kLinear;
  bool round = false;
};
struct MadeBuild {
  std::int32_t lanes = 4, depth = 8;
};
struct MadeParameters : MadeRules, MadeBuild {
  using Configuration = MadeRules;
  using Build = MadeBuild;
};
template <class Visitor>
void describe(MadeRules& p, Visitor& v) {
  v.choice("filter", p.filter, kFilterNames, "How it looks.");
  v.boolean("round", p.round, "To the nearest.");
}
template <class Visitor>
void describe(MadeBuild& p, Visitor& v) {
  v.integer("lanes", p.lanes, 1, 16, "pixel", "So many at a time.");
  v.integer("depth", p.depth, 1, 64, "", "Of its queue.");
}
template <class Visitor>
void describe(const MadeParameters& p, Visitor& v) {
  MadeParameters copy = p;
  describe(static_cast<MadeRules&>(copy), v);
  describe(static_cast<MadeBuild&>(copy), v);
}
constexpr std::array<spec::BuildRule<MadeParameters>, 1> kBuildRules = {
    {{{"depth", "lanes"}, "must be at least lanes", [](const MadeParameters& p) {
        return p.depth >= p.lanes;
      }}}};
std::span<const spec::BuildRule<MadeParameters>> build_rules(const MadeParameters& /*values*/) {
  return kBuildRules;
}

constexpr std::array<tb::CoverageGroup, 2> kGroups = {
    {{"made/lanes", "How many."}, {"made/never", "What never is."}}};

struct MadeInput {
  std::string in;
  std::int32_t width = 6, height = 5;
  double gain = 0.5;
};
template <class Visitor>
void describe(MadeInput& p, Visitor& v) {
  v.text("in", p.in, "file", "What goes in.");
  v.integer("width", p.width, 1, 4096, "pixel", "Of the frame.");
  v.integer("height", p.height, 1, 4096, "pixel", "Of the frame.");
  v.real("gain", p.gain, 0, 2, "", "Of the frame.");
}

class MadeEngine : public Engine {
 public:
  explicit MadeEngine(std::string_view name) : name_(name) {}
  std::string_view name() const override { return name_; }
  std::string_view summary() const override { return "Made for tests"; }
  double clock_mhz() const override { return 200; }
  void add_parameters(tb::ParameterSet& set) override {
    set.add("frame", tb::ParameterKind::kInput, input_);
    set.add_engine(name_, values_);
    set.alias(std::string(name_) + ".filter", "bilinear", "linear");
  }
  std::vector<Shorthand> shorthands() const override {
    return {{"--in", "frame.in", "What goes in"},
            {"--size", "frame.width", "Of the frame", "frame.height"},
            {"--gain", "frame.gain", "Of the frame"},
            {"--filter", std::string(name_) + ".filter", "near, linear (default) or wide"},
            {"--lanes", std::string(name_) + ".lanes", "At a time"},
            {"--round", std::string(name_) + ".round", "To the nearest"}};
  }
  std::vector<std::string_view> examples() const override { return {"--size 64x32", "--lanes 8"}; }
  void check(const RunParameters& run, RunContext& context) override {
    tb::Result none;
    if (made_run()) made_run()(run, context, none);
  }
  void run(const RunParameters& run, RunContext& context, tb::Result& result) override {
    if (made_run())
      made_run()(run, context, result);
    else
      measure(run, context, result);
  }
  std::vector<std::filesystem::path> input_files(tb::MeshFiles& /*meshes*/) const override {
    if (input_.in.empty()) return {};
    return {input_.in};
  }
  void describe_statistics(tb::Result& result) override {
    result.faults = {name_ + "_late", name_ + "_lost"};
    if (name_ != "made") return;
    const auto lanes = static_cast<std::uint32_t>(values_.lanes);
    rtl::Datasheet sheet = {.unit = "Adder"};
    sheet.stages = {{.clock = "1",
                     .work = "sums",
                     .operators = {rtl::op::add(8 * lanes)},
                     .longest = {rtl::op::add(8 * lanes)},
                     .registers = 8 * lanes}};
    result.sheets = {{"adder", sheet}};
  }
  std::vector<std::string_view> pictures() const override { return {"after"}; }
  std::string_view pixel_history() const override { return name_ == "made" ? "Its steps" : ""; }
  LongRun long_run() const override { return {}; }

  RandomDraws random_draws() const override {
    RandomDraws draws;
    draws.fixed = {"frame.in"};
    return draws;
  }
  tb::CoverageSection coverage() const override {
    tb::CoverageSection section{"Made", {}, kGroups};
    for (const char* const bin : {"lanes/few", "lanes/many", "never/met"})
      section.bins.declare(name_ + "/" + bin);
    return section;
  }

 private:
  void measure(const RunParameters& run, const RunContext& context, tb::Result& result) const {
    if (!run.trace.empty())
      std::ofstream(context.trace_file()) << run.trace_from << ".." << run.trace_to << "\n";
    if (input_.gain == 1.5) throw spec::ConfigError("a gain of 1.5 is invalid");
    result.cycles = static_cast<std::uint64_t>(1200 / values_.lanes);
    if (input_.gain == 2) throw spec::DeadlockError("nothing moves, cycle 812");
    result.throughput = values_.lanes;
    result.throughput_unit = "pixel/clk";
    result.comparisons = 9;
    result.mismatches = values_.lanes == 3 ? 1 : 0;
    result.scoreboards = {{"colours", 9, result.mismatches}};
    if (result.mismatches > 0)
      result.first_mismatches = {{"colours", "cycle 812", "pixel (3, 4)", "red", "1", "2"}};
    if (!run.coverage) return;
    const std::uint64_t many = values_.lanes > 2 ? 1 : 0;
    result.coverage = {
        {name_ + "/lanes/few", 1 - many}, {name_ + "/lanes/many", many}, {name_ + "/never/met", 0}};
  }

  std::string name_;
  MadeParameters values_;
  MadeInput input_;
};

}  // namespace

MadeRun& made_run() {
  static MadeRun run;
  return run;
}

std::vector<std::unique_ptr<Engine>> engines() {
  std::vector<std::unique_ptr<Engine>> all;
  all.push_back(std::make_unique<MadeEngine>("made"));
  all.push_back(std::make_unique<MadeEngine>("other"));
  return all;
}

}  // namespace deburr::tool
