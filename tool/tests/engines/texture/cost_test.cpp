// SPDX-License-Identifier: MIT
// Estimates against the mapped rows of docs/measurements/cost.json, in every configuration of
// tb/hdl/configurations.txt (docs/explanation/cost.md).
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tb/harness/in_child.h"
#include "tb/run/result.h"
#include "tool/cost/embedded_cost.h"
#include "tool/cost/estimate.h"
#include "tool/run/run_once.h"

namespace deburr::tool::cost_test {
namespace {

using Json = nlohmann::ordered_json;

// `cost` of result.json for a configuration.
Json cost_of_build(const std::vector<std::string>& settings) {
  return Json::parse(tb::in_child([&] {
    const std::unique_ptr<Engine> engine = engine_named("texture");
    BoundEngine bound(*engine);
    for (const std::string& setting : settings)
      bound.set.set_assignment("texture." + setting, "configurations.txt");
    bound.resolve();
    tb::Result result;
    engine->describe_build(result);
    result.cost = cost_of(result, bound.set);
    return tb::to_json(result).at("cost").dump();
  }));
}

struct Figures {
  double gates = 0, ns = 0, flip_flops = 0;
};
struct Row {
  std::string unit, parameters;
  Figures mapped, estimate;
};
struct Sum {
  Figures mapped, estimate;
};

double off(double estimate, double mapped) { return estimate / mapped - 1; }

class TextureCost : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    const Json mapped = Json::parse(embedded::mapped_json());
    for (const Json& configuration : mapped["configurations"]) {
      const std::string name = configuration["name"];
      const Json cost = cost_of_build(configuration["settings"].get<std::vector<std::string>>());
      for (const Json& unit : mapped["units"]) {
        const std::string of = unit["unit"];
        const auto& names = unit["configurations"];
        if (!unit["osu018"].is_object() || !unit["parts"].empty() || !cost["units"].contains(of) ||
            std::find(names.begin(), names.end(), name) == names.end() ||
            // The RTL is one decoder without the requests, and the unit has several.
            of == "block_decoder" ||
            // Small memories that the RTL keeps apart and the unit has in flip-flops.
            (unit["osu018"]["memory_bits"] > 0 && cost["units"][of]["memory_bits"] == 0))
          continue;
        add({of, unit["parameters"].dump(), figures(unit["osu018"]),
             figures(cost["units"][of]["estimate"])},
            name);
      }
    }
  }
  static Figures figures(const Json& of) {
    return {of["gates"], of["ns"].is_number() ? of["ns"].get<double>() : 0, of["flip_flops"]};
  }
  static void add(const Row& row, const std::string& configuration) {
    Sum& sum = sums_[configuration];
    sum.mapped.gates += row.mapped.gates;
    sum.estimate.gates += row.estimate.gates;
    sum.mapped.flip_flops += row.mapped.flip_flops;
    sum.estimate.flip_flops += row.estimate.flip_flops;
    const auto same = [&](const Row& r) {
      return r.unit == row.unit && r.parameters == row.parameters;
    };
    if (std::none_of(rows_.begin(), rows_.end(), same)) rows_.push_back(row);
  }

  static inline std::vector<Row> rows_;
  static inline std::map<std::string, Sum> sums_;
};

// Of the rows with this figure, those within a share of it.
template <class Figure>
double share_within(const std::vector<Row>& rows, double share, Figure figure) {
  double there = 0, within = 0;
  for (const Row& row : rows) {
    if (!(figure(row.mapped) > 0)) continue;
    ++there;
    if (std::abs(off(figure(row.estimate), figure(row.mapped))) <= share) ++within;
  }
  return there > 0 ? within / there : 0;
}

// The claims of docs/explanation/cost.md, and the ranges that every estimate is given with.
TEST_F(TextureCost, EstimatesAreNearMappedRows) {
  ASSERT_GE(rows_.size(), 30u);
  for (const Row& row : rows_)
    fmt::print(
        "{} {}: gates {:.0f}, {:.0f} ({:+.1f} %); flip-flops {:.0f}, {:.0f}; ns {:.2f}, {:.2f}\n",
        row.unit, row.parameters, row.mapped.gates, row.estimate.gates,
        100 * off(row.estimate.gates, row.mapped.gates), row.mapped.flip_flops,
        row.estimate.flip_flops, row.mapped.ns, row.estimate.ns);
  const auto gates = [](const Figures& f) { return f.gates; };
  const auto flip_flops = [](const Figures& f) { return f.flip_flops; };
  const auto ns = [](const Figures& f) { return f.ns; };
  EXPECT_GE(share_within(rows_, kUnitRange, gates), 0.8);
  EXPECT_EQ(share_within(rows_, 0.6, gates), 1);
  EXPECT_EQ(share_within(rows_, 0.25, flip_flops), 1);
  EXPECT_GE(share_within(rows_, kPathRange, ns), 0.9);
  EXPECT_GE(share_within(rows_, 0.25, ns), 0.6);
}

TEST_F(TextureCost, SumsOfPresetsAreNearMappedOnes) {
  for (const char* name : {"VAddressPaper", "VAddressDeburr", "VCacheDefault", "VFilterDeburr"}) {
    ASSERT_TRUE(sums_.contains(name)) << name;
    const Sum& sum = sums_[name];
    EXPECT_LE(std::abs(off(sum.estimate.gates, sum.mapped.gates)), kSumRange) << name;
    EXPECT_LE(std::abs(off(sum.estimate.flip_flops, sum.mapped.flip_flops)), 0.1) << name;
  }
}

// Of two variants of a unit, the larger one by mapping is the larger one by estimate.
TEST_F(TextureCost, OrderOfVariantsIsThatOfMappedRows) {
  int pairs = 0, right = 0;
  for (const Row& a : rows_)
    for (const Row& b : rows_)
      if (a.unit == b.unit && a.mapped.gates > 1.05 * b.mapped.gates) {
        ++pairs;
        if (a.estimate.gates > b.estimate.gates) ++right;
      }
  EXPECT_GE(pairs, 30);
  EXPECT_GE(right, pairs * 28 / 30) << pairs;
}

}  // namespace
}  // namespace deburr::tool::cost_test
