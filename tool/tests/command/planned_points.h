// SPDX-License-Identifier: MIT
// Points of sweeps and regressions, with results written by the test.
#pragma once

#include <fmt/format.h>

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "tb/run/result.h"
#include "tool/sweep/plan.h"
#include "tool/sweep/point.h"
#include "tool/tests/command/in_process.h"

namespace deburr::tool {

class PlannedPoints : public InProcess {
 protected:
  // From now on printed() shows points by their samples: "points/<2 near>" of a sweep,
  // "points/<runs/base/0>" of a regression.
  void name_points(const std::filesystem::path& directory) {
    for_each_point(points_file(directory), [&](const PlannedPoint& point) {
      std::string name;
      for (const std::string& label : point.sample)
        name += (name.empty() ? "" : point.engine.empty() ? " " : "/") + label;
      points_[name] = point.name;
      replaced_[point_directory("points", point.name).string()] = "points/<" + name + ">";
    });
  }
  // One line per point, with input, sample and settings, then one per reason for excluding points.
  static std::string list_points(const std::filesystem::path& directory) {
    std::string lines;
    const Plan plan = read_plan(directory);
    for_each_point(points_file(directory), [&](const PlannedPoint& point) {
      lines += fmt::format("{} [{}]", point.input, fmt::join(point.sample, "] ["));
      for (const Setting& setting : plan.settings_of(point))
        lines += fmt::format(" {}={}", setting.name, setting.value);
      lines += "\n";
    });
    for (const std::string& line : plan.left_out) lines += "left out " + line + "\n";
    return lines;
  }
  std::filesystem::path folder_of(const std::string& name) const {
    return point_directory("out/points", points_.at(name));
  }
  void pass(const std::string& name, const nlohmann::ordered_json& result) const {
    nlohmann::ordered_json whole = {{"schema", tb::kResultSchema}, {"verdict", "pass"}};
    whole.update(result);
    write(folder_of(name) / "result.json", whole.dump(1));
    write(folder_of(name) / "manifest.json", "{}");
    remove_failure(folder_of(name));
  }
  void fail(const std::string& name, const std::string& kind, const std::string& reason) const {
    std::filesystem::remove(folder_of(name) / "result.json");
    write_failure(folder_of(name), {kind, reason, false});
  }

 private:
  std::map<std::string, std::string> points_;  // name here -> name of the point
};

}  // namespace deburr::tool
