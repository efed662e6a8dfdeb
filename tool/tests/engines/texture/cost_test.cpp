// SPDX-License-Identifier: MIT
// Estimates against the mapped rows of docs/measurements/cost.json, in every configuration of
// tb/hdl/configurations.txt (docs/explanation/cost.md).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tb/base/file.h"
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
    engine->describe_statistics(result);
    result.cost = cost_of(result, bound.set);
    return tb::to_json(result).at("cost").dump();
  }));
}

struct Row {
  std::string unit, what;
  double gates, ns, flip_flops;  // mapped
  double estimated_gates, estimated_ns, estimated_flip_flops;
  double error() const { return estimated_gates / gates - 1; }
};

// One row per mapped unit and its parameters.
std::vector<Row> rows() {
  const Json mapped = Json::parse(embedded::mapped_json());
  std::vector<Row> all;
  for (const Json& configuration : mapped["configurations"]) {
    const Json cost = cost_of_build(configuration["settings"].get<std::vector<std::string>>());
    for (const Json& row : mapped["units"]) {
      const std::string unit = row["unit"];
      const auto& names = row["configurations"];
      if (!row["osu018"].is_object() || !row["parts"].empty() || !cost["units"].contains(unit) ||
          std::find(names.begin(), names.end(), configuration["name"]) == names.end())
        continue;
      const std::string what = unit + " " + row["parameters"].dump();
      if (std::any_of(all.begin(), all.end(), [&](const Row& r) { return r.what == what; }))
        continue;
      const Json& found = row["osu018"];
      const Json& estimate = cost["units"][unit]["estimate"];
      all.push_back({unit, what, found["gates"], found["ns"].is_number() ? double{found["ns"]} : 0,
                     found["flip_flops"], estimate["gates"], estimate["ns"],
                     estimate["flip_flops"]});
    }
  }
  return all;
}

class TextureCost : public testing::Test {
 protected:
  static void SetUpTestSuite() { rows_ = rows(); }
  static inline std::vector<Row> rows_;
};

TEST_F(TextureCost, EstimatesAreNearMappedRows) {
  ASSERT_GT(rows_.size(), 40u);
  std::map<std::string, double> sums;
  int near = 0, close_flip_flops = 0, with_path = 0, close_path = 0;
  for (const Row& row : rows_) {
    printf(
        "%-110s gates %8.0f %8.0f %+6.1f %%  flip-flops %6.0f %6.0f %+6.1f %%  ns %5.2f %5.2f "
        "%+6.1f %%\n",
        row.what.c_str(), row.gates, row.estimated_gates, 100 * row.error(), row.flip_flops,
        row.estimated_flip_flops,
        row.flip_flops > 0 ? 100 * (row.estimated_flip_flops / row.flip_flops - 1) : 0, row.ns,
        row.estimated_ns, row.ns > 0 ? 100 * (row.estimated_ns / row.ns - 1) : 0);
    if (std::abs(row.error()) <= 0.35) ++near;
  }
  printf("%d of %zu within 35 %%\n", near, rows_.size());
}

}  // namespace
}  // namespace deburr::tool::texture_cost_test
