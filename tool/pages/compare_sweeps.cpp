// SPDX-License-Identifier: MIT
#include "tool/pages/compare_sweeps.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>

#include "spec/error.h"
#include "tb/base/file.h"
#include "tb/base/json_text.h"
#include "tool/pages/compare_runs.h"
#include "tool/pages/input_files.h"

namespace deburr::tool {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using spec::FileError;

constexpr std::size_t kMaxSweepBytes = std::size_t{1} << 30;
constexpr const char* kCollected = "collected.json";

using Settings = std::vector<std::pair<std::string, std::string>>;
using MetricValues = std::vector<std::optional<double>>;  // one per common metric
using At = std::vector<std::string>;                      // one per matching parameter

struct ComparedPoint {
  std::string state;
  std::string failure;
  MetricValues values;
  bool front = false;
};

struct Sweep {
  fs::path path;
  Json json;
  Settings base;
  std::map<At, ComparedPoint> points;
};

struct MetricInfo {
  std::string name, key, unit, meaning;
  std::optional<bool> maximise;
  std::vector<std::size_t> columns;  // in each sweep
};

Sweep read_sweep(const fs::path& path) {
  std::error_code error;
  const fs::path file = fs::is_directory(path, error) ? path / kCollected : path;
  if (!fs::exists(file, error))
    throw FileError(
        fmt::format("'{}' is a sweep that was not collected: run 'deburr sweep FILE "
                    "collect' first",
                    path.string()));
  Sweep sweep{path, tb::try_parse_json(tb::read_file(file, kMaxSweepBytes)), {}, {}};
  const Json& json = sweep.json;
  const auto damaged = [&](const std::string& what) {
    throw FileError(fmt::format("'{}' is damaged ({}): run 'deburr sweep FILE collect' again",
                                file.string(), what));
  };
  if (!json.is_object()) damaged("not a JSON object");
  if (json.value("schema", 0) != kCollectionSchema)
    damaged(fmt::format("expected schema {}", kCollectionSchema));
  for (const char* key :
       {"sweep", "engine", "counts", "base", "axes", "metrics", "objectives", "points"})
    if (!json.contains(key)) damaged(fmt::format("'{}' is missing", key));
  for (const Json& setting : json["base"]) {
    if (!setting.is_array() || setting.size() != 2) damaged("a setting of 'base'");
    sweep.base.emplace_back(value_text(setting[0]), value_text(setting[1]));
  }
  for (const Json& axis : json["axes"])
    if (!axis.is_object() || !axis.contains("parameters") || !axis["parameters"].is_array() ||
        axis["parameters"].empty())
      damaged("an axis");
  for (const Json& point : json["points"])
    if (!point.is_object() || point.value("at", Json::array()).size() != json["axes"].size() ||
        point.value("values", Json::array()).size() != json["metrics"].size())
      damaged(fmt::format("point '{}'", point.is_object() ? point.value("name", "?") : "?"));
  return sweep;
}

// All settings of a point, by parameter: the base's and its own.
std::map<std::string, std::string> settings_of(const Sweep& sweep, const Json& at) {
  std::map<std::string, std::string> settings(sweep.base.begin(), sweep.base.end());
  const Json& axes = sweep.json["axes"];
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const Json& parameters = axes[i]["parameters"];
    const std::string label = value_text(at[i]);
    const Json choices = axes[i].value("choices", Json::object());
    if (const auto found = choices.find(label); found != choices.end())
      for (std::size_t p = 0; p < parameters.size() && p < found->size(); ++p)
        settings[parameters[p].get<std::string>()] = value_text((*found)[p]);
    else
      settings[parameters[0].get<std::string>()] = label;
  }
  return settings;
}

class SweepComparison {
 public:
  SweepComparison(std::vector<Sweep> sweeps, const Tolerances& tolerances,
                  const UnsaidValue& unsaid)
      : sweeps_(std::move(sweeps)), tolerances_(tolerances), unsaid_(unsaid) {
    reject_different_engines();
    find_axes();
    find_metrics();
    for (Sweep& sweep : sweeps_) place_points(sweep);
  }

  Json run() {
    Json json = {{"kind", "sweeps"}, {"engine", sweeps_[0].json["engine"]}};
    json["worse"] = false;
    describe(json);
    match(json);
    summarise(json);
    json["worse"] = worse_;
    return json;
  }

 private:
  void reject_different_engines() const {
    for (std::size_t i = 1; i < sweeps_.size(); ++i)
      if (sweeps_[i].json["engine"] != sweeps_[0].json["engine"])
        throw spec::ConfigError(fmt::format(
            "A is a sweep of '{}', {} of '{}': results of different engines cannot be compared",
            value_text(sweeps_[0].json["engine"]), letter(i),
            value_text(sweeps_[i].json["engine"])));
  }

  void find_axes() {
    for (const Sweep& sweep : sweeps_)
      for (const Json& axis : sweep.json["axes"])
        for (const Json& parameter : axis["parameters"])
          if (std::find(axes_.begin(), axes_.end(), parameter.get<std::string>()) == axes_.end())
            axes_.push_back(parameter.get<std::string>());
  }

  std::string said(const Sweep& sweep, const std::map<std::string, std::string>& settings,
                   const std::string& parameter) {
    const auto found = settings.find(parameter);
    if (found != settings.end()) return found->second;
    std::string& known = unsaid_values_[{&sweep, parameter}];
    if (known.empty())
      known = unsaid_(sweep.json["engine"].get<std::string>(), sweep.base, parameter);
    return known;
  }

  // Metrics present in every sweep.
  void find_metrics() {
    const auto column = [](const Sweep& sweep,
                           const std::string& key) -> std::optional<std::size_t> {
      const Json& metrics = sweep.json["metrics"];
      for (std::size_t i = 0; i < metrics.size(); ++i)
        if (metrics[i].value("key", "") == key) return i;
      return std::nullopt;
    };
    for (const Json& metric : sweeps_[0].json["metrics"]) {
      MetricInfo info{metric.value("name", ""),
                      metric.value("key", ""),
                      metric.value("unit", ""),
                      metric.value("meaning", ""),
                      std::nullopt,
                      {}};
      for (const Sweep& sweep : sweeps_)
        if (const auto found = column(sweep, info.key)) info.columns.push_back(*found);
      if (info.columns.size() != sweeps_.size()) continue;
      for (const Json& objective : sweeps_[0].json["objectives"])
        if (objective.value("metric", "") == info.name)
          info.maximise = objective.value("maximise", false);
      metrics_.push_back(info);
    }
    if (metrics_.empty())
      throw spec::ConfigError(
          "the sweeps have no metric key in common: add the same metric to all of them, and "
          "collect them again");
  }

  // A key of result.json in the notation of compare().
  static std::string dotted(std::string key) {
    if (!key.starts_with('/')) return key;
    key.erase(0, 1);
    std::replace(key.begin(), key.end(), '/', '.');
    return key;
  }

  void place_points(Sweep& sweep) {
    const std::size_t index = static_cast<std::size_t>(&sweep - sweeps_.data());
    for (const Json& json : sweep.json["points"]) {
      const std::map<std::string, std::string> settings = settings_of(sweep, json["at"]);
      At at;
      for (const std::string& axis : axes_) at.push_back(said(sweep, settings, axis));
      ComparedPoint point{
          json.value("state", ""), json.value("failure", ""), {}, json.value("front", false)};
      for (const MetricInfo& metric : metrics_)
        point.values.push_back(value_in(sweep.json, json, metric.columns[index]));
      sweep.points.emplace(std::move(at), std::move(point));
    }
  }

  static std::optional<double> value_in(const Json& sweep, const Json& point, std::size_t column) {
    const Json identical = point.value("identical", Json::array());
    if (std::find(identical.begin(), identical.end(), sweep["metrics"][column].value("name", "")) !=
        identical.end())
      return INFINITY;
    return as_number(point["values"][column]);
  }

  // ---- inputs of the comparison

  void describe(Json& json) const {
    json["warnings"] = Json::array();
    json["sweeps"] = Json::array();
    for (std::size_t i = 0; i < sweeps_.size(); ++i) {
      const Json& sweep = sweeps_[i].json;
      const Json& counted = sweep["counts"];
      json["sweeps"].push_back({{"name", letter(i)},
                                {"path", sweeps_[i].path.string()},
                                {"sweep", sweep["sweep"]},
                                {"title", sweep.value("title", "")},
                                {"commit", sweep.value("commit", "")},
                                {"counts", counted}});
      const std::uint64_t failed = counted.value("failed", 0u),
                          missing = counted.value("missing", 0u);
      if (failed + missing > 0)
        json["warnings"].push_back(fmt::format(
            "{} is not complete: {} points failed, {} are missing", letter(i), failed, missing));
      const std::string inputs = different_inputs_of(i);
      if (!inputs.empty()) json["warnings"].push_back(inputs);
    }
    json["parameters"] = parameters();
    json["axes"] = axes_;
    json["metrics"] = Json::array();
    json["objectives"] = Json::array();
    for (const MetricInfo& metric : metrics_) {
      const Trend more = check(dotted(metric.key), 1, 2, tolerances_, metric.maximise);
      Json direction;
      if (more != Trend::kNone && more != Trend::kEqual) direction = more == Trend::kBetter;
      json["metrics"].push_back({{"name", metric.name},
                                 {"key", metric.key},
                                 {"unit", metric.unit},
                                 {"meaning", metric.meaning},
                                 {"maximise", direction},
                                 {"counts", counts(dotted(metric.key), tolerances_)}});
      if (metric.maximise) json["objectives"].push_back(metric.name);
    }
  }

  // Relative to the first sweep.
  std::string different_inputs_of(std::size_t sweep) const {
    const auto inputs = [](const Sweep& of) { return of.json.value("inputs", Json::array()); };
    const std::string different = different_inputs(inputs(sweeps_[0]), inputs(sweeps_[sweep]));
    if (different.empty()) return "";
    return fmt::format("the inputs differ: {}{}", different,
                       sweep > 1 ? fmt::format(" (B is {} here)", letter(sweep)) : "");
  }

  Json parameters() const {
    std::vector<std::string> names;
    for (const Sweep& sweep : sweeps_)
      for (const auto& [name, value] : sweep.base)
        if (std::find(names.begin(), names.end(), name) == names.end() &&
            std::find(axes_.begin(), axes_.end(), name) == axes_.end())
          names.push_back(name);
    Json differing = Json::array();
    for (const std::string& name : names) {
      Json values = Json::array();
      for (const Sweep& sweep : sweeps_) {
        const auto found = std::find_if(sweep.base.begin(), sweep.base.end(),
                                        [&](const auto& setting) { return setting.first == name; });
        values.push_back(found != sweep.base.end()
                             ? found->second
                             : unsaid_(sweep.json["engine"].get<std::string>(), sweep.base, name));
      }
      if (std::any_of(values.begin(), values.end(),
                      [&](const Json& value) { return value != values[0]; }))
        differing.push_back({{"name", name}, {"values", values}});
    }
    return differing;
  }

  // ---- points

  static Json numbers(const MetricValues& values) {
    Json json = Json::array();
    for (const std::optional<double>& value : values)
      if (!value || std::isinf(*value))
        json.push_back(nullptr);
      else if (*value == std::round(*value) && std::fabs(*value) < 1e15)
        json.push_back(static_cast<std::int64_t>(*value));
      else
        json.push_back(*value);
    return json;
  }

  // The metrics whose values are infinite.
  Json identical(const MetricValues& values) const {
    Json names = Json::array();
    for (std::size_t m = 0; m < values.size(); ++m)
      if (values[m] && std::isinf(*values[m])) names.push_back(metrics_[m].name);
    return names;
  }

  void match(Json& json) {
    std::map<At, std::vector<const ComparedPoint*>> all;
    for (std::size_t i = 0; i < sweeps_.size(); ++i)
      for (const auto& [at, point] : sweeps_[i].points) {
        auto& row = all[at];
        row.resize(sweeps_.size());
        row[i] = &point;
      }
    sums_.assign(sweeps_.size(), std::vector<Sum>(metrics_.size()));
    json["points"] = Json::array();
    json["only"] = Json::array();
    std::vector<JointPoint> joint;
    for (const auto& [at, row] : all) {
      for (std::size_t i = 0; i < row.size(); ++i)
        if (row[i] && row[i]->state == "done") joint.push_back({i, &row[i]->values});
      const bool everywhere =
          std::all_of(row.begin(), row.end(), [](const ComparedPoint* p) { return p; });
      const bool done =
          everywhere && std::all_of(row.begin(), row.end(),
                                    [](const ComparedPoint* p) { return p->state == "done"; });
      Json entry = {{"at", at}};
      entry["values"] = Json::array();
      entry["identical"] = Json::array();
      entry["front"] = Json::array();
      for (const ComparedPoint* point : row) {
        const bool has = point && point->state == "done";
        entry["values"].push_back(has ? numbers(point->values) : Json());
        entry["identical"].push_back(has ? identical(point->values) : Json::array());
        entry["front"].push_back(point && point->front);
      }
      if (done) {
        check_point(row, entry);
        json["points"].push_back(std::move(entry));
        continue;
      }
      entry["states"] = Json::array();
      bool lost = false;
      for (const ComparedPoint* point : row) {
        entry["states"].push_back(!point                   ? "none"
                                  : point->state == "done" ? "done"
                                  : point->failure.empty() ? point->state
                                                           : "failed: " + point->failure);
        lost = lost || (row[0] && row[0]->state == "done" && point && point->state == "failed");
      }
      entry["worse"] = lost;
      worse_ = worse_ || lost;
      json["only"].push_back(std::move(entry));
    }
    count_joint_front(joint, json);
  }

  void check_point(const std::vector<const ComparedPoint*>& row, Json& entry) {
    bool worse = false;
    entry["judgements"] = Json::array();
    for (std::size_t i = 1; i < row.size(); ++i) {
      Json checked = Json::array();
      for (std::size_t m = 0; m < metrics_.size(); ++m) {
        const std::string key = dotted(metrics_[m].key);
        const auto a = row[0]->values[m], b = row[i]->values[m];
        const Trend verdict = check(key, a, b, tolerances_, metrics_[m].maximise);
        checked.push_back(kTrendNames[static_cast<std::size_t>(verdict)]);
        worse = worse || (verdict == Trend::kWorse && counts(key, tolerances_));
        sums_[i][m].add(verdict, a, b, in_decibels(key));
      }
      entry["judgements"].push_back(checked);
    }
    entry["worse"] = worse;
    worse_ = worse_ || worse;
  }

  // ---- summary over all points

  struct JointPoint {
    std::size_t sweep;
    const MetricValues* values;
  };

  // For each sweep, the points that no point of any sweep dominates.
  void count_joint_front(const std::vector<JointPoint>& points, Json& json) const {
    std::vector<std::pair<std::size_t, double>> goals;
    for (std::size_t m = 0; m < metrics_.size(); ++m)
      if (const std::optional<bool> maximise = metrics_[m].maximise)
        goals.emplace_back(m, *maximise ? -1.0 : 1.0);
    if (goals.empty()) return;
    struct Cost {
      std::vector<double> goals;
      std::size_t sweep;
    };
    std::vector<Cost> costs;
    for (const JointPoint& point : points) {
      Cost cost{{}, point.sweep};
      for (const auto& [metric, sign] : goals)
        if (const auto value = (*point.values)[metric]) cost.goals.push_back(sign * *value);
      if (cost.goals.size() == goals.size()) costs.push_back(std::move(cost));
    }
    const auto dominates = [](const Cost& a, const Cost& b) {
      bool better = false;
      for (std::size_t g = 0; g < a.goals.size(); ++g) {
        if (a.goals[g] > b.goals[g]) return false;
        better = better || a.goals[g] < b.goals[g];
      }
      return better;
    };
    // In this order no point is dominated by a later one.
    std::stable_sort(costs.begin(), costs.end(),
                     [](const Cost& a, const Cost& b) { return a.goals < b.goals; });
    std::vector<const Cost*> front;
    for (const Cost& cost : costs)
      if (std::none_of(front.begin(), front.end(),
                       [&](const Cost* other) { return dominates(*other, cost); }))
        front.push_back(&cost);
    for (std::size_t i = 0; i < sweeps_.size(); ++i)
      json["sweeps"][i]["joint_front"] = std::count_if(
          front.begin(), front.end(), [i](const Cost* cost) { return cost->sweep == i; });
  }

  struct Sum {
    std::uint64_t better = 0, equal = 0, worse = 0, changes = 0;
    double sum = 0, least = INFINITY, most = -INFINITY;

    void add(Trend verdict, std::optional<double> a, std::optional<double> b, bool decibels) {
      better += verdict == Trend::kBetter;
      worse += verdict == Trend::kWorse;
      equal += verdict == Trend::kEqual;
      if (!a || !b || !std::isfinite(*a) || !std::isfinite(*b) || (!decibels && *a == 0)) return;
      const double change = decibels ? *b - *a : 100 * (*b - *a) / std::fabs(*a);
      ++changes;
      sum += change;
      least = std::min(least, change);
      most = std::max(most, change);
    }
  };

  void summarise(Json& json) const {
    json["summary"] = Json::array();
    for (std::size_t i = 1; i < sweeps_.size(); ++i) {
      Json rows = Json::array();
      for (std::size_t m = 0; m < metrics_.size(); ++m) {
        const Sum& sum = sums_[i][m];
        Json row = {{"better", sum.better}, {"equal", sum.equal}, {"worse", sum.worse}};
        if (sum.changes > 0) {
          row["unit"] = in_decibels(dotted(metrics_[m].key)) ? "dB" : "%";
          row["mean"] = sum.sum / static_cast<double>(sum.changes);
          row["least"] = sum.least;
          row["most"] = sum.most;
        }
        rows.push_back(row);
      }
      json["summary"].push_back(rows);
    }
  }

  std::vector<Sweep> sweeps_;
  const Tolerances& tolerances_;
  const UnsaidValue& unsaid_;
  std::vector<std::string> axes_;
  std::vector<MetricInfo> metrics_;
  std::map<std::pair<const Sweep*, std::string>, std::string> unsaid_values_;
  std::vector<std::vector<Sum>> sums_;
  bool worse_ = false;
};

}  // namespace

bool is_sweep(const fs::path& path) {
  std::error_code error;
  if (path.filename() == kCollected) return true;
  return fs::is_directory(path, error) && !fs::exists(path / "result.json", error) &&
         (fs::exists(path / kCollected, error) || fs::exists(path / "plan.json", error));
}

Json compare_sweeps(const std::vector<fs::path>& paths, const Tolerances& tolerances,
                    const UnsaidValue& unsaid) {
  std::vector<Sweep> sweeps;
  sweeps.reserve(paths.size());
  for (const fs::path& path : paths) sweeps.push_back(read_sweep(path));
  return SweepComparison(std::move(sweeps), tolerances, unsaid).run();
}

}  // namespace deburr::tool
