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
#include "tool/run/run_once.h"

namespace deburr::tool::texture_cost_test {
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
  double error() const { return estimate.gates / mapped.gates - 1; }
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

TEST_F(TextureCost, EstimatesAreNearMappedRows) {
  for (const Row& row : rows_)
    fmt::print(
        "{:16} {:110} gates {:8.0f} {:8.0f} {:+6.1f} %  flip-flops {:6.0f} {:6.0f} {:+6.1f} %  ns "
        "{:5.2f} "
        "{:5.2f} {:+6.1f} %\n",
        row.unit, row.parameters, row.mapped.gates, row.estimate.gates, 100 * row.error(),
        row.mapped.flip_flops, row.estimate.flip_flops,
        100 * off(row.estimate.flip_flops, row.mapped.flip_flops), row.mapped.ns, row.estimate.ns,
        100 * off(row.estimate.ns, row.mapped.ns));
  for (const auto& [name, sum] : sums_)
    fmt::print("{:24} gates {:8.0f} {:8.0f} {:+6.1f} %  flip-flops {:+6.1f} %\n", name,
               sum.mapped.gates, sum.estimate.gates,
               100 * off(sum.estimate.gates, sum.mapped.gates),
               100 * off(sum.estimate.flip_flops, sum.mapped.flip_flops));
  const auto gates = [](const Figures& f) { return f.gates; };
  const auto flip_flops = [](const Figures& f) { return f.flip_flops; };
  const auto ns = [](const Figures& f) { return f.ns; };
  fmt::print(
      "gates: {:.0f} % of {} within 35 %, {:.0f} % within 60 %; flip-flops {:.0f} % within 25 %; "
      "ns {:.0f} % within 25 %\n",
      100 * share_within(rows_, 0.35, gates), rows_.size(), 100 * share_within(rows_, 0.6, gates),
      100 * share_within(rows_, 0.25, flip_flops), 100 * share_within(rows_, 0.25, ns));
  int pairs = 0, right = 0;
  for (const Row& a : rows_)
    for (const Row& b : rows_)
      if (a.unit == b.unit && a.mapped.gates > 1.05 * b.mapped.gates) {
        ++pairs;
        if (a.estimate.gates > b.estimate.gates) ++right;
      }
  fmt::print("{} of {} pairs of variants in order\n", right, pairs);
}

}  // namespace
}  // namespace deburr::tool::texture_cost_test
