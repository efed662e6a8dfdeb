// SPDX-License-Identifier: MIT
#include "tool/sweep/collection.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>

#include "spec/error.h"
#include "tb/base/atomic_file.h"
#include "tb/base/file.h"
#include "tb/base/json_text.h"
#include "tb/base/near_matches.h"
#include "tb/run/amount.h"
#include "tb/run/result.h"
#include "tool/pages/build_info.h"
#include "tool/pages/compare_sweeps.h"
#include "tool/pages/embedded.h"
#include "tool/pages/page.h"
#include "tool/pages/report.h"

namespace deburr::tool {
namespace {

namespace fs = std::filesystem;
namespace mustache = kainjow::mustache;
using Json = nlohmann::ordered_json;

constexpr const char* kUnitOfThroughput = "see throughput.unit";  // statistics()
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

std::string_view state_name(PointState state) {
  constexpr std::string_view kNames[] = {"missing", "running", "done", "failed"};
  return kNames[static_cast<std::size_t>(state)];
}

// Names within a dotted key may contain dots. Returns the value for the first way to split the key
// that exists.
const nlohmann::json* find(const nlohmann::json& node, std::string_view key) {
  if (!node.is_object()) return nullptr;
  if (const auto whole = node.find(key); whole != node.end()) return &*whole;
  for (std::size_t dot = key.find('.'); dot != std::string_view::npos; dot = key.find('.', dot + 1))
    if (const auto part = node.find(key.substr(0, dot)); part != node.end())
      if (const nlohmann::json* found = find(*part, key.substr(dot + 1))) return found;
  return nullptr;
}

const nlohmann::json* node_of(const nlohmann::json& result, const std::string& key) {
  if (!key.starts_with('/')) return find(result, key);
  try {
    const nlohmann::json::json_pointer pointer(key);
    return result.contains(pointer) ? &result.at(pointer) : nullptr;
  } catch (const nlohmann::json::exception&) {
    return nullptr;
  }
}

// A group that has a `value` stands for it (`cost.gates`).
const nlohmann::json* value_of(const nlohmann::json& result, const std::string& key) {
  const nlohmann::json* const node = node_of(result, key);
  return node && node->is_object() && node->contains("value") ? &node->at("value") : node;
}

// The first key of the metric that the result lacks; empty: none.
std::string missing_key(const nlohmann::json& result, const Metric& metric) {
  for (std::string& key : metric.keys())
    if (!value_of(result, key)) return std::move(key);
  return "";
}

struct Measured {
  double value = kNone;
  std::string reason;  // why it has no value
};

Measured measured(const nlohmann::json& result, const Metric& metric) {
  std::map<std::string, double> numbers;
  for (const std::string& key : metric.keys()) {
    const nlohmann::json* const value = value_of(result, key);
    if (!value) return {kNone, fmt::format("no key '{}' in the result", key)};
    if (value->is_null()) return {kNone, key + " is null"};
    if (!value->is_number() && !value->is_boolean()) return {kNone, key + " is not a number"};
    numbers[key] = value->is_boolean() ? (value->get<bool>() ? 1 : 0) : value->get<double>();
  }
  const bool infinite = std::any_of(numbers.begin(), numbers.end(),
                                    [](const auto& number) { return std::isinf(number.second); });
  double value = 0;
  if (metric.expression) {
    try {
      value = metric.expression->number([&](const std::string& key) { return numbers.at(key); });
    } catch (const DivisionByZero&) {
      return {kNone, "division by zero"};
    }
  } else {
    value = numbers.at(metric.key);
  }
  if (std::isfinite(value)) return {value, ""};
  if (!infinite) return {kNone, "too large for a number"};
  if (std::isnan(value)) return {kNone, "not defined for the infinite PSNR of identical pictures"};
  return value > 0 ? Measured{value, ""} : Measured{kNone, "minus infinity"};
}

Expression::Lookup lookup_in(const SweepDefinition& sweep, const std::vector<double>& values) {
  return [&](const std::string& name) {
    for (std::size_t i = 0; i < sweep.metrics.size(); ++i)
      if (sweep.metrics[i].name == name) return values[i];
    return kNone;
  };
}

nlohmann::json complete_result_in(const fs::path& directory) {
  const fs::path file = directory / "result.json";
  auto result = tb::try_parse_sorted_json(tb::read_file(file, tb::kMaxResultBytes));
  if (!result.is_object() || result.value("schema", 0) != tb::kResultSchema)
    throw spec::FileError(fmt::format(
        "'{}' is not a result of this version: remove its directory, and run the sweep again",
        file.string()));
  return tb::with_infinity(std::move(result));
}

void add_keys(const nlohmann::json& node, const std::string& path, std::vector<std::string>& keys) {
  if (path == "meaning" || path == "latency.histogram") return;
  if (!node.is_object()) {
    keys.push_back(path);
    return;
  }
  for (const auto& [key, value] : node.items())
    add_keys(value, path.empty() ? key : fmt::format("{}.{}", path, key), keys);
}

class Collector {
 public:
  Collector(const SweepDefinition& sweep, const SweepPlace& place) : sweep_(sweep), place_(place) {}

  Collection run() {
    for (const Metric& metric : sweep_.metrics)
      all_.metrics.push_back({metric.name, metric.key, "", ""});
    found_.assign(sweep_.metrics.size(), false);
    for_each_point(points_file(place_.directory), [&](const PlannedPoint& point) { add(point); });
    reject_unknown_metrics();
    find_front();
    find_effects();
    return std::move(all_);
  }

 private:
  void add(const PlannedPoint& planned) {
    const fs::path directory = point_directory(place_.points(), planned.name);
    CollectedPoint point{planned.name, planned.sample, state_of(directory), "", {}, {}, false, ""};
    point.values.assign(sweep_.metrics.size(), kNone);
    switch (point.state) {
      case PointState::kDone:
        read(directory, point);
        break;
      case PointState::kFailed: {
        const Failure failure = read_failure(directory);
        point.failure = fmt::format("{}: {}", failure.kind, failure.reason);
        break;
      }
      default:
        break;
    }
    ++(point.state == PointState::kDone     ? all_.done
       : point.state == PointState::kFailed ? all_.failed
                                            : all_.missing);
    all_.points.push_back(std::move(point));
  }

  void read(const fs::path& directory, CollectedPoint& point) {
    const nlohmann::json result = complete_result_in(directory);
    if (result.value("verdict", "") == "fail") {
      point.state = PointState::kFailed;
      point.failure = result.value("reason", "");
      return;
    }
    for (std::size_t i = 0; i < sweep_.metrics.size(); ++i) {
      Measured metric = measured(result, sweep_.metrics[i]);
      point.values[i] = metric.value;
      if (!metric.reason.empty()) {
        point.no_values.push_back({i, std::move(metric.reason)});
        ++all_.no_values[point.no_values.back()];
      }
      if (!found_[i] && missing_key(result, sweep_.metrics[i]).empty()) learn(result, i);
    }
    for (const Expression& limit : sweep_.limits)
      if (point.beyond.empty() && limit.violation(lookup_in(sweep_, point.values)) > 0)
        point.beyond = limit.text();
    if (!point.beyond.empty()) ++all_.beyond;
    if (first_result_.is_null()) first_result_ = result;
  }

  void learn(const nlohmann::json& result, std::size_t metric) {
    found_[metric] = true;
    if (sweep_.metrics[metric].expression) {
      all_.metrics[metric].meaning = sweep_.metrics[metric].key;
      return;
    }
    std::string key = sweep_.metrics[metric].key;
    if (key.starts_with('/')) {
      key.erase(0, 1);
      std::replace(key.begin(), key.end(), '/', '.');
    }
    const nlohmann::json meanings = result.value("meaning", nlohmann::json::object());
    if (!meanings.contains(key)) key += ".value";
    const nlohmann::json entry = meanings.value(key, nlohmann::json::object());
    all_.metrics[metric].unit = entry.value("unit", "");
    if (key.starts_with("throughput.") && all_.metrics[metric].unit == kUnitOfThroughput)
      all_.metrics[metric].unit = result["throughput"].value("unit", "");
    all_.metrics[metric].meaning = entry.value("meaning", "");
  }

  void reject_unknown_metrics() const {
    if (all_.done == 0) return;
    for (std::size_t i = 0; i < found_.size(); ++i)
      if (!found_[i] && !first_result_.is_null()) {
        std::vector<std::string> keys;
        add_keys(first_result_, "", keys);
        const std::string key = missing_key(first_result_, sweep_.metrics[i]);
        throw spec::ConfigError(fmt::format("{}: metric '{}': no result has the key '{}'{}",
                                            sweep_.file.string(), sweep_.metrics[i].name, key,
                                            tb::did_you_mean(tb::near_matches(key, keys))));
      }
  }

  // ---- front ------------------------------------------------------------------------------------

  void find_front() {
    if (sweep_.objectives.empty()) return;
    std::vector<std::pair<std::size_t, double>>
        goals;  // metric, and the sign that makes less better
    for (const Objective& objective : sweep_.objectives)
      for (std::size_t i = 0; i < sweep_.metrics.size(); ++i)
        if (sweep_.metrics[i].name == objective.metric)
          goals.emplace_back(i, objective.maximise ? -1.0 : 1.0);
    const auto cost = [&](const CollectedPoint& p, std::size_t g) {
      return goals[g].second * p.values[goals[g].first];
    };
    std::vector<CollectedPoint*> order;
    for (CollectedPoint& point : all_.points)
      if (point.state == PointState::kDone && point.beyond.empty() &&
          std::none_of(goals.begin(), goals.end(),
                       [&](const auto& goal) { return std::isnan(point.values[goal.first]); }))
        order.push_back(&point);
    const auto dominates = [&](const CollectedPoint& a, const CollectedPoint& b) {
      bool better = false;
      for (std::size_t g = 0; g < goals.size(); ++g) {
        if (cost(a, g) > cost(b, g)) return false;
        better = better || cost(a, g) < cost(b, g);
      }
      return better;
    };
    // In this order no point is dominated by a later point, so fronts only grow.
    std::stable_sort(order.begin(), order.end(), [&](const auto* a, const auto* b) {
      for (std::size_t g = 0; g < goals.size(); ++g)
        if (cost(*a, g) != cost(*b, g)) return cost(*a, g) < cost(*b, g);
      return false;
    });
    std::map<Sample, std::vector<const CollectedPoint*>> fronts;
    for (CollectedPoint* point : order) {
      Sample circumstances;
      for (const std::size_t axis : sweep_.front_axes) circumstances.push_back(point->sample[axis]);
      std::vector<const CollectedPoint*>& front = fronts[circumstances];
      if (std::any_of(front.begin(), front.end(),
                      [&](const CollectedPoint* other) { return dominates(*other, *point); }))
        continue;
      point->front = true;
      front.push_back(point);
      ++all_.front;
    }
  }

  // ---- effects ----------------------------------------------------------------------------------

  // In the file's order; for a sampled span, by value.
  std::vector<std::string> labels_of(std::size_t axis) const {
    std::vector<std::string> labels;
    for (const Choice& choice : sweep_.axes[axis].choices)
      if (std::find(labels.begin(), labels.end(), choice.label) == labels.end())
        labels.push_back(choice.label);
    if (sweep_.axes[axis].when) labels.emplace_back(kNotGiven);
    return labels;
  }

  void find_effects() {
    for (std::size_t axis = 0; axis < sweep_.axes.size(); ++axis) {
      const std::vector<std::string> labels = labels_of(axis);
      if (labels.size() < 2) continue;
      std::map<std::string, std::size_t> index;
      for (std::size_t i = 0; i < labels.size(); ++i) index[labels[i]] = i;
      for (std::size_t metric = 0; metric < sweep_.metrics.size(); ++metric) {
        std::vector<std::pair<double, std::uint64_t>> sums(labels.size());
        for (const CollectedPoint& point : all_.points)
          if (std::isfinite(point.values[metric])) {
            auto& [sum, count] = sums[index.at(point.sample[axis])];
            sum += point.values[metric];
            ++count;
          }
        MainEffect effect{axis, metric, {}};
        for (std::size_t i = 0; i < labels.size(); ++i)
          if (sums[i].second > 0)
            effect.means.emplace_back(labels[i],
                                      sums[i].first / static_cast<double>(sums[i].second));
        if (effect.means.size() > 1) all_.effects.push_back(std::move(effect));
      }
    }
  }

  const SweepDefinition& sweep_;
  const SweepPlace& place_;
  Collection all_;
  std::vector<bool> found_;
  nlohmann::json first_result_;  // keys that results have
};

// ---- writing ------------------------------------------------------------------------------------

std::string csv_cell(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + '"';
}

std::string csv_number(double value) {
  return std::isnan(value) ? "" : std::isinf(value) ? "inf" : fmt::format("{}", value);
}

Json json_number(double value) {
  if (!std::isfinite(value)) return nullptr;
  if (value == std::round(value) && std::fabs(value) < 1e15)
    return static_cast<std::int64_t>(value);
  return value;
}

std::string csv_of(const SweepDefinition& sweep, const SweepPlace& place, const Collection& all) {
  std::string text = "point,state";
  for (const Axis& axis : sweep.axes) text += fmt::format(",{}", csv_cell(axis.name));
  for (const MetricInfo& metric : all.metrics) text += fmt::format(",{}", csv_cell(metric.name));
  text += sweep.limits.empty() ? ",front,failure,directory\n" : ",front,beyond,failure,directory\n";
  for (const CollectedPoint& point : all.points) {
    text += fmt::format("{},{}", point.name, state_name(point.state));
    for (const std::string& label : point.sample) text += fmt::format(",{}", csv_cell(label));
    for (const double value : point.values) text += fmt::format(",{}", csv_number(value));
    text += fmt::format(",{}", point.front ? 1 : 0);
    if (!sweep.limits.empty()) text += fmt::format(",{}", csv_cell(point.beyond));
    text += fmt::format(",{},{}\n", csv_cell(point.failure),
                        csv_cell(point_directory(place.points(), point.name).string()));
  }
  return text;
}

Json json_of(const SweepDefinition& sweep, const Plan& plan, const SweepPlace& place,
             const Collection& all) {
  Json json;
  json["schema"] = kCollectionSchema;
  json["sweep"] = sweep.name;
  json["title"] = plan.title;
  json["engine"] = sweep.engine;
  json["version"] = build_info().version;
  json["commit"] = build_info().commit;
  json["model"] = build_info().model;
  json["counts"] = {{"points", plan.points},
                    {"done", all.done},
                    {"failed", all.failed},
                    {"missing", all.missing},
                    {"front", all.front}};
  json["inputs"] = inputs_of(plan, "definition");
  json["left_out"] = plan.left_out;
  json["reports"] = plan.reports;  // whether each finished point has a report.html
  // Relative to the sweep's directory, where the page is.
  json["points_directory"] =
      fs::proximate(fs::absolute(place.points()), fs::absolute(place.directory)).string();
  json["base"] = Json::array();
  for (const Setting& setting : plan.base) json["base"].push_back({setting.name, setting.value});
  json["axes"] = Json::array();
  for (std::size_t i = 0; i < plan.axes.size(); ++i) {
    Json labels = Json::array();
    if (sweep.sampling != SweepSampling::kListed)
      for (const Choice& choice : sweep.axes[i].choices) labels.push_back(choice.label);
    if (plan.axes[i].conditional) labels.push_back(kNotGiven);
    json["axes"].push_back({{"name", plan.axes[i].name},
                            {"parameters", plan.axes[i].parameters},
                            {"labels", labels},
                            {"choices", plan.axes[i].choices},
                            {"conditional", plan.axes[i].conditional}});
  }
  json["metrics"] = Json::array();
  for (const MetricInfo& metric : all.metrics)
    json["metrics"].push_back({{"name", metric.name},
                               {"key", metric.key},
                               {"unit", metric.unit},
                               {"meaning", metric.meaning}});
  json["objectives"] = Json::array();
  for (const Objective& objective : sweep.objectives)
    json["objectives"].push_back({{"metric", objective.metric}, {"maximise", objective.maximise}});
  if (!sweep.limits.empty()) {
    json["counts"]["beyond"] = all.beyond;
    for (const Expression& limit : sweep.limits) json["limits"].push_back(limit.text());
  }
  json["for_each"] = Json::array();
  for (const std::size_t axis : sweep.front_axes) json["for_each"].push_back(sweep.axes[axis].name);
  json["effects"] = Json::array();
  for (const MainEffect& effect : all.effects) {
    Json means = Json::array();
    for (const auto& [label, mean] : effect.means) means.push_back({label, json_number(mean)});
    json["effects"].push_back({{"axis", sweep.axes[effect.axis].name},
                               {"metric", sweep.metrics[effect.metric].name},
                               {"means", means}});
  }
  json["no_value"] = Json::array();
  for (const auto& [none, points] : all.no_values)
    json["no_value"].push_back(
        {{"metric", all.metrics[none.metric].name}, {"reason", none.reason}, {"points", points}});
  json["points"] = Json::array();
  for (const CollectedPoint& point : all.points) {
    Json values = Json::array();
    for (const double value : point.values) values.push_back(json_number(value));
    Json entry = {{"name", point.name},
                  {"state", state_name(point.state)},
                  {"at", point.sample},
                  {"values", values}};
    for (std::size_t i = 0; i < point.values.size(); ++i)
      if (std::isinf(point.values[i])) entry["identical"].push_back(all.metrics[i].name);
    for (const NoValue& none : point.no_values)
      entry["no_value"][all.metrics[none.metric].name] = none.reason;
    if (point.front) entry["front"] = true;
    if (!point.beyond.empty()) entry["beyond"] = point.beyond;
    if (!point.failure.empty()) entry["failure"] = point.failure;
    json["points"].push_back(std::move(entry));
  }
  return json;
}

std::string cell_text(const Json& value) {
  return value.is_null() ? "" : value.is_string() ? value.get<std::string>() : tb::json_text(value);
}

// Rows of the table without script; the front comes first.
constexpr std::size_t kMostRows = 200;

void set_table(const Json& json, mustache::data& page) {
  HtmlTable table("");
  for (const Json& axis : json.at("axes")) table.column(axis.at("name").get<std::string>());
  for (const Json& metric : json.at("metrics")) {
    const auto unit = metric.at("unit").get<std::string>();
    table.column(metric.at("name").get<std::string>() + (unit.empty() ? "" : " (" + unit + ")"),
                 "n");
  }
  table.column("Point");
  std::vector<const Json*> points;
  for (const Json& point : json.at("points")) points.push_back(&point);
  std::stable_partition(points.begin(), points.end(),
                        [](const Json* point) { return point->contains("front"); });
  const bool cut = points.size() > kMostRows;
  if (cut) points.resize(kMostRows);
  const fs::path folder = json.at("points_directory").get<std::string>();
  for (const Json* point : points) {
    std::vector<HtmlCell> cells;
    for (const Json& value : point->at("at")) cells.emplace_back(cell_text(value));
    const Json identical = point->value("identical", Json::array());
    const Json none = point->value("no_value", Json::object());
    for (std::size_t i = 0; i < json.at("metrics").size(); ++i) {
      const auto metric = json.at("metrics")[i].at("name").get<std::string>();
      const bool same = std::find(identical.begin(), identical.end(), metric) != identical.end();
      cells.emplace_back(same                    ? "identical"
                         : none.contains(metric) ? "none"
                                                 : cell_text(point->at("values")[i]));
      cells.back().tip = none.value(metric, "");
    }
    const auto name = point->at("name").get<std::string>();
    const auto state = point->at("state").get<std::string>();
    cells.push_back(
        state == "done"
            ? HtmlCell::link((point_directory(folder, name) / "result.json").string(),
                             name.substr(0, 8))
            : state + (point->contains("failure") ? ": " + cell_text(point->at("failure")) : ""));
    table.row(cells, point->contains("front")    ? "front"
                     : point->contains("beyond") ? "beyond"
                     : state == "failed"         ? state
                                                 : "");
  }
  page.set("rows", table.html(R"(class="scroll tall")"));
  page.set("is_cut", cut);
  page.set("rows_shown", tb::grouped(points.size()));
}

std::string page_of(const Json& json) {
  mustache::data page;
  page.set("script", std::string(embedded::sweep_js()));
  page.set("title", json.at("title").get<std::string>());
  page.set("brand", "sweep \u00b7 " + json.at("engine").get<std::string>());
  page.set("data", json_for_script(json));
  const auto count = [&](const char* key) {
    return tb::grouped(json.at("counts").at(key).get<std::uint64_t>());
  };
  page.set("points", count("points"));
  page.set("tiles", html_of({{"Points", count("points")},
                             {"Done", count("done")},
                             {"Failed", count("failed")},
                             {"Missing", count("missing")},
                             {"On the front", count("front")}}));
  page.set("is_partial", json.at("counts").at("done") != json.at("counts").at("points"));
  page.set("has_objectives", !json.at("objectives").empty());
  const bool has_limits = json.contains("limits");
  page.set("has_limits", has_limits);
  if (has_limits) {
    const std::uint64_t beyond = json.at("counts").at("beyond");
    page.set("beyond", beyond == 0   ? "No point is beyond a limit."
                       : beyond == 1 ? "One point, the cross, is beyond a limit."
                                     : fmt::format("{} points, the crosses, are beyond a limit.",
                                                   tb::grouped(beyond)));
    page.set("limits",
             fmt::format("{}", fmt::join(json.at("limits").get<std::vector<std::string>>(), ", ")));
  }
  std::vector<std::string> base;
  for (const Json& setting : json.at("base"))
    base.push_back(
        fmt::format("{} = {}", setting[0].get<std::string>(), setting[1].get<std::string>()));
  page.set("has_base", !base.empty());
  page.set("base", fmt::format("{}", fmt::join(base, ", ")));
  mustache::data notes{mustache::data::type::list};
  for (const Json& note : json.at("left_out")) {
    mustache::data entry;
    entry.set("note", note.get<std::string>());
    notes << entry;
  }
  page.set("left_out", notes);
  mustache::data none{mustache::data::type::list};
  for (const Json& entry : json.at("no_value")) {
    mustache::data line;
    line.set("text", fmt::format("{} in {} of {} points: {}", entry.at("metric").get<std::string>(),
                                 tb::grouped(entry.at("points").get<std::uint64_t>()),
                                 count("done"), entry.at("reason").get<std::string>()));
    none << line;
  }
  page.set("has_no_value", none.is_non_empty_list());
  page.set("no_value", none);
  set_table(json, page);
  return filled_page(embedded::sweep_template(), "sweep.mustache", page);
}

}  // namespace

Collection collect(const SweepDefinition& sweep, const SweepPlace& place) {
  return Collector(sweep, place).run();
}

std::vector<double> values_of(const SweepDefinition& sweep, const fs::path& directory) {
  const nlohmann::json result = complete_result_in(directory);
  std::vector<double> values;
  if (result.value("verdict", "") == "fail") return values;
  for (const Metric& metric : sweep.metrics) values.push_back(measured(result, metric).value);
  return values;
}

double beyond_limits(const SweepDefinition& sweep, const std::vector<double>& values) {
  double all = 0;
  for (const Expression& limit : sweep.limits) all += limit.violation(lookup_in(sweep, values));
  return all;
}

void write_collection(const SweepDefinition& sweep, const Plan& plan, const SweepPlace& place,
                      const Collection& collection) {
  const Json json = json_of(sweep, plan, place, collection);
  const std::string csv = csv_of(sweep, place, collection),
                    collected = tb::json_text(json, -1, tb::NotUtf8::kReplace) + "\n",
                    page = page_of(json);
  tb::write_files_atomically({{place.directory / "collected.csv", csv},
                              {place.directory / "collected.json", collected},
                              {place.directory / "index.html", page}});
}

}  // namespace deburr::tool
