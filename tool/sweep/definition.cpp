// SPDX-License-Identifier: MIT
#include "tool/sweep/definition.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <string_view>

#include "spec/error.h"
#include "tb/base/near_matches.h"
#include "tb/base/yaml_file.h"
#include "tool/run/run_once.h"

namespace deburr::tool {
namespace {

using spec::ConfigError;

constexpr std::size_t kMaxValues = 1'000'000;  // per axis
constexpr int kMaxNesting = 16;

class Reader {
 public:
  explicit Reader(const tb::YamlFile& yaml) : yaml_(yaml) {
    sweep_.file = yaml.path();
    sweep_.name = yaml.path().stem().string();
  }

  SweepDefinition read() {
    const YAML::Node& root = yaml_.root();
    std::vector<std::string> known = stimulus_keys();
    known.insert(known.end(), {"title", "metrics", "limits", "objectives", "reports", "chunk"});
    yaml_.require_keys(root, known);
    read_engine(root);
    if (sweep_.name == "." || sweep_.name == "..")
      throw ConfigError(
          fmt::format("'{}': a sweep is named after its file, and '{}' is not a valid name of a "
                      "folder: rename the file",
                      sweep_.file.string(), sweep_.name));
    if (!root["axes"] && !root["points"])
      fail(root, "nothing is varied: give 'axes', or list 'points'");
    if (root["title"]) sweep_.title = scalar(root["title"], "title");
    read_stimuli(root);
    read_metrics(root["metrics"]);
    read_limits(root["limits"]);
    read_objectives(root["objectives"]);
    if (root["reports"]) sweep_.reports = yaml_.boolean(root["reports"], "reports");
    if (root["chunk"]) sweep_.chunk = yaml_.count(root["chunk"], "chunk", 100'000);
    return std::move(sweep_);
  }

  SweepDefinition read_part(const YAML::Node& part) {
    read_engine(part);
    read_stimuli(part);
    return std::move(sweep_);
  }

 private:
  static const char* kind(const YAML::Node& node) { return tb::YamlFile::kind(node); }
  std::string where(const YAML::Node& node) const { return yaml_.where(node); }
  [[noreturn]] void fail(const YAML::Node& node, const std::string& what) const {
    yaml_.fail(node, what);
  }
  std::string scalar(const YAML::Node& node, std::string_view what) const {
    return yaml_.scalar(node, what);
  }

  void read_engine(const YAML::Node& root) {
    if (!root["engine"])
      fail(root, fmt::format("'engine' is missing: add 'engine: {}'", engines().front()->name()));
    sweep_.engine = scalar(root["engine"], "engine");
    try {
      engine_ = engine_named(sweep_.engine);
    } catch (const ConfigError& error) {
      fail(root["engine"], error.what());
    }
    bound_ = std::make_unique<BoundEngine>(*engine_);
  }

  // Reads the stimuli, without metrics and objectives.
  void read_stimuli(const YAML::Node& root) {
    read_base(root["base"]);
    read_points(root);
    read_sampling(root["sample"]);
    read_constraints(root["constraints"]);
    if (const YAML::Node node = root["refused"]) {
      const std::string text = scalar(node, "refused");
      if (text != "error" && text != "skip")
        fail(node, fmt::format("'refused' = '{}' must be error or skip", text));
      sweep_.skip_rejected = text == "skip";
    }
  }

  // Throws if the parameter is unknown or rejects the value.
  void try_value(const std::string& name, const std::string& value, const YAML::Node& node) const {
    BoundEngine scratch(*engine_);
    scratch.set.set(name, value, where(node));
  }

  // ---- base -------------------------------------------------------------------------------------

  void read_base(const YAML::Node& base) {
    if (!base) return;
    if (!base.IsMap()) fail(base, fmt::format("'base' must be a map, got {}", kind(base)));
    walk_base(base, "", 0);
  }

  void walk_base(const YAML::Node& map, const std::string& prefix, int depth) {
    if (depth > kMaxNesting) fail(map, "maps are nested too deeply");
    for (const auto& entry : map) {
      const std::string name = prefix + entry.first.Scalar();
      if (entry.second.IsMap()) {
        walk_base(entry.second, name + ".", depth + 1);
        continue;
      }
      const std::string value = scalar(entry.second, name);
      try_value(name, value, entry.first);
      for (const Setting& other : sweep_.base)
        if (other.name == name)
          fail(entry.first, fmt::format("'{}' is given twice (first at {})", name, other.where));
      sweep_.base.push_back({name, value, where(entry.first)});
    }
  }

  // ---- axes and listed points -------------------------------------------------------------------

  void read_points(const YAML::Node& root) {
    const YAML::Node axes = root["axes"], points = root["points"];
    if (axes && points)
      fail(points, "'axes' and 'points' exclude each other: list every point, or give axes");
    if (points) {
      read_listed(points);
      return;
    }
    if (!axes) return;
    if (!axes.IsMap() || axes.size() == 0)
      fail(axes, fmt::format("'axes' must be a map of parameters to values, got {}", kind(axes)));
    for (const auto& entry : axes) add_axis(entry.first.Scalar(), entry.first, entry.second);
  }

  void add_axis(const std::string& name, const YAML::Node& key, const YAML::Node& values) {
    Axis axis;
    axis.name = name;
    axis.where = where(key);
    const bool named = values.IsMap() && values.size() > 0 && values.begin()->second.IsMap();
    if (named) {
      read_named(axis, values);
    } else {
      if (!bound_->set.find(name)) bound_->set.set(name, "", where(key));  // with near matches
      axis.parameters = {name};
      if (values.IsMap() && values["when"])
        axis.when.emplace(scalar(values["when"], "when"), where(values["when"]), bound_->set);
      const YAML::Node list = values.IsMap() && values["values"] ? values["values"] : values;
      if (values.IsMap() && values["values"])
        for (const auto& entry : values)
          if (const std::string known = entry.first.Scalar(); known != "values" && known != "when")
            fail(entry.first,
                 fmt::format("axis '{}': unknown '{}' (known: values, when)", name, known));
      if (list.IsMap())
        read_range(axis, list);
      else if (list.IsSequence())
        read_values(axis, list);
      else
        fail(key, fmt::format("axis '{}' must be a list of values or {{from: .., to: ..}}, got {}",
                              name, kind(list)));
    }
    if (axis.choices.empty() && !axis.span)
      fail(key, fmt::format("axis '{}' is empty: give it a value, or leave it out", name));
    claim_parameters(axis, key);
    sweep_.axes.push_back(std::move(axis));
  }

  // An axis's parameters may not be set elsewhere.
  void claim_parameters(const Axis& axis, const YAML::Node& key) {
    for (const std::string& parameter : axis.parameters) {
      for (const Axis& other : sweep_.axes)
        if (std::find(other.parameters.begin(), other.parameters.end(), parameter) !=
            other.parameters.end())
          fail(key, fmt::format("'{}' is varied twice (first at {})", parameter, other.where));
      for (const Setting& setting : sweep_.base)
        if (setting.name == parameter)
          fail(key, fmt::format("'{}' is varied, and fixed at {}", parameter, setting.where));
    }
  }

  void read_values(Axis& axis, const YAML::Node& list) const {
    std::set<std::string> before;
    for (const auto& node : list) {
      const std::string value = scalar(node, axis.name);
      try_value(axis.name, value, node);
      if (!before.insert(value).second)
        fail(node, fmt::format("axis '{}' has the value '{}' twice", axis.name, value));
      axis.choices.push_back({value, {value}});
    }
  }

  void read_named(Axis& axis, const YAML::Node& values) const {
    for (const auto& entry : values) {
      const std::string label = entry.first.Scalar();
      if (!entry.second.IsMap() || entry.second.size() == 0)
        fail(entry.first,
             fmt::format(
                 "axis '{}': '{}' must be a map of parameters to values, like the other entries",
                 axis.name, label));
      std::vector<std::pair<std::string, std::string>> settings;
      for (const auto& setting : entry.second) {
        const std::string name = setting.first.Scalar();
        const std::string value = scalar(setting.second, name);
        try_value(name, value, setting.first);
        settings.emplace_back(name, value);
      }
      std::sort(settings.begin(), settings.end());
      Choice choice{label, {}};
      std::vector<std::string> names;
      for (auto& [name, value] : settings) {
        names.push_back(name);
        choice.values.push_back(value);
      }
      if (axis.parameters.empty()) axis.parameters = names;
      if (axis.parameters != names)
        fail(entry.first,
             fmt::format("axis '{}': '{}' sets {}, the first entry sets {}", axis.name, label,
                         fmt::join(names, ", "), fmt::join(axis.parameters, ", ")));
      axis.choices.push_back(std::move(choice));
    }
  }

  void read_range(Axis& axis, const YAML::Node& range) const {
    for (const auto& entry : range)
      if (const std::string key = entry.first.Scalar();
          key != "from" && key != "to" && key != "step" && key != "times" && key != "when")
        fail(entry.first,
             fmt::format("axis '{}': unknown '{}' (known: from, to, step, times, when)", axis.name,
                         key));
    if (!range["from"] || !range["to"])
      fail(range, fmt::format("axis '{}': a range needs 'from' and 'to'", axis.name));
    if (range["step"] && range["times"])
      fail(range, fmt::format("axis '{}': 'step' and 'times' exclude each other", axis.name));
    const auto from = yaml_.number<double>(range["from"], "from");
    const auto to = yaml_.number<double>(range["to"], "to");
    const std::string& limits = bound_->set.find(axis.name)->range;
    if (limits.find("..") == std::string::npos)
      fail(range, fmt::format("axis '{}' takes {}: list the values", axis.name, limits));
    const bool integer = bound_->set.find(axis.name)->json().is_number_integer() &&
                         from == std::floor(from) && to == std::floor(to);
    if (from > to)
      fail(range, fmt::format("axis '{}' is empty: from {} to {}", axis.name, from, to));
    if (!range["step"] && !range["times"]) {
      axis.span = Span{from, to, integer};
      try_value(axis.name, shown(from), range);
      try_value(axis.name, shown(to), range);
      return;
    }
    const bool adds = static_cast<bool>(range["step"]);
    const auto by = adds ? yaml_.number<double>(range["step"], "step")
                         : yaml_.number<double>(range["times"], "times");
    if (adds ? by <= 0 : by <= 1 || from <= 0)
      fail(range, fmt::format("axis '{}' never gets from {} to {} with '{}' = {}", axis.name, from,
                              to, adds ? "step" : "times", by));
    const double slack = 1e-9 * std::max(std::fabs(from), std::fabs(to));
    for (std::size_t i = 0;; ++i) {
      const double value =
          adds ? from + static_cast<double>(i) * by : from * std::pow(by, static_cast<double>(i));
      if (value > to + slack) break;
      if (i >= kMaxValues)
        fail(range, fmt::format("axis '{}' has more than {} values", axis.name, kMaxValues));
      const std::string text = shown(
          integer || std::fabs(value - std::round(value)) < slack ? std::round(value) : value);
      if (i == 0 || axis.choices.back().label != text) axis.choices.push_back({text, {text}});
    }
    try_value(axis.name, axis.choices.front().label, range);
    try_value(axis.name, axis.choices.back().label, range);
    if (axis.choices.size() > 1) try_value(axis.name, axis.choices[1].label, range);
  }

  static std::string shown(double value) {
    return value == std::round(value) && std::fabs(value) < 1e15
               ? fmt::format("{}", static_cast<std::int64_t>(value))
               : fmt::format("{:.9g}", value);
  }

  // One axis per parameter, with the points' values in order.
  void read_listed(const YAML::Node& points) {
    sweep_.sampling = SweepSampling::kListed;
    if (!points.IsSequence() || points.size() == 0)
      fail(points, fmt::format("'points' must be a list of maps, got {}", kind(points)));
    for (const auto& point : points) {
      if (!point.IsMap()) fail(point, fmt::format("a point must be a map, got {}", kind(point)));
      const bool first = sweep_.axes.empty();
      for (const auto& entry : point) {
        const std::string name = entry.first.Scalar();
        const std::string value = scalar(entry.second, name);
        try_value(name, value, entry.first);
        if (first) {
          Axis axis;
          axis.name = name;
          axis.parameters = {name};
          axis.where = where(entry.first);
          claim_parameters(axis, entry.first);
          sweep_.axes.push_back(std::move(axis));
        }
        const auto axis = std::find_if(sweep_.axes.begin(), sweep_.axes.end(),
                                       [&](const Axis& a) { return a.name == name; });
        if (axis == sweep_.axes.end())
          fail(entry.first,
               fmt::format(
                   "the first point does not set '{}': every point must set the same parameters",
                   name));
        axis->choices.push_back({value, {value}});
      }
      for (const Axis& axis : sweep_.axes)
        if (axis.choices.size() != sweep_.axes.front().choices.size() ||
            point.size() != sweep_.axes.size())
          fail(point, fmt::format("every point must set the same parameters, each once; this one "
                                  "does not (expected {})",
                                  sweep_.axes.size()));
    }
  }

  // ---- the rest ---------------------------------------------------------------------------------

  void read_sampling(const YAML::Node& sample) {
    if (!sample) return require_values();
    if (sweep_.sampling == SweepSampling::kListed)
      fail(sample, "'sample' is only valid with 'axes'; 'points' are all run");
    if (sample.IsScalar()) {
      if (sample.Scalar() != "cartesian")
        fail(sample, fmt::format("'sample' = '{}' must be cartesian, {{random: N, seed: S}} or "
                                 "{{latin: N, seed: S}}",
                                 sample.Scalar()));
      return require_values();
    }
    if (!sample.IsMap())
      fail(sample, fmt::format("'sample' must be a name or a map, got {}", kind(sample)));
    for (const auto& entry : sample) {
      const std::string key = entry.first.Scalar();
      if (key == "seed") {
        sweep_.sample_seed = yaml_.number<std::uint64_t>(entry.second, "seed");
      } else if ((key == "random" || key == "latin") && sweep_.samples == 0) {
        sweep_.sampling = key == "random" ? SweepSampling::kRandom : SweepSampling::kLatin;
        sweep_.samples = yaml_.count(entry.second, key, 1'000'000);
      } else {
        fail(entry.first,
             fmt::format("'sample': unexpected '{}' (expected random or latin, and seed)", key));
      }
    }
    if (sweep_.samples == 0) fail(sample, "'sample' needs random or latin with a number");
  }

  void require_values() {
    if (sweep_.sampling != SweepSampling::kCartesian) return;
    for (Axis& axis : sweep_.axes) {
      if (!axis.span) continue;
      const double size = axis.span->to - axis.span->from + 1;
      if (!axis.span->integer)
        throw ConfigError(
            fmt::format("{}: axis '{}' has infinitely many values: give 'step' or 'times', or take "
                        "a sample of it ('sample: {{random: 100}}')",
                        axis.where, axis.name));
      if (size > static_cast<double>(kMaxValues))
        throw ConfigError(fmt::format("{}: axis '{}' has {:.0f} values: give 'step' or 'times'",
                                      axis.where, axis.name, size));
      for (double value = axis.span->from; value <= axis.span->to; ++value)
        axis.choices.push_back({shown(value), {shown(value)}});
      axis.span.reset();
    }
  }

  void read_constraints(const YAML::Node& constraints) {
    if (!constraints) return;
    if (!constraints.IsSequence())
      fail(constraints, fmt::format("'constraints' must be a list, got {}", kind(constraints)));
    for (const auto& node : constraints)
      sweep_.constraints.emplace_back(scalar(node, "constraints"), where(node), bound_->set);
  }

  void read_metrics(const YAML::Node& metrics) {
    if (!metrics) {
      for (const auto& [name, key] :
           {std::pair{"cycles", "cycles"}, std::pair{"rate", "throughput.value"},
            std::pair{"latency_p95", "latency.p95"}, std::pair{"bytes_read", "memory.bytes_read"},
            std::pair{"memory_bits", "memory_bits.total.physical"}})
        sweep_.metrics.push_back({name, key, std::nullopt, yaml_.path().string()});
      return;
    }
    if (!metrics.IsMap() || metrics.size() == 0)
      fail(metrics, fmt::format("'metrics' must be a map of names to keys of result.json or "
                                "expressions of them, got {}",
                                kind(metrics)));
    for (const auto& entry : metrics) {
      const std::string name = entry.first.Scalar();
      for (const Metric& other : sweep_.metrics)
        if (other.name == name) fail(entry.first, fmt::format("metric '{}' is given twice", name));
      for (const Axis& axis : sweep_.axes)
        if (axis.name == name)
          fail(entry.first, fmt::format("metric '{}' has the name of an axis", name));
      sweep_.metrics.push_back(metric(name, scalar(entry.second, name), entry.second));
    }
  }

  Metric metric(const std::string& name, const std::string& text, const YAML::Node& node) const {
    if (text.empty()) fail(node, fmt::format("metric '{}' must be a key of result.json", name));
    Metric metric{name, text, std::nullopt, where(node)};
    if (text.starts_with('/')) return metric;
    // The engine knows the valid keys (require_known_metrics()).
    Expression expression(text, metric.where,
                          {"metric", "a key of result.json",
                           [](const std::string& key) -> std::optional<std::string> {
                             if (std::isdigit(static_cast<unsigned char>(key.front())) != 0)
                               return std::nullopt;
                             return std::string();
                           },
                           [](const std::string&) { return std::vector<std::string>(); }});
    if (expression.names().empty())
      fail(node, fmt::format("metric '{}': '{}' uses no key of result.json", name, text));
    expression.number(Trial());  // determines its type
    if (expression.names() != std::vector{text}) metric.expression = std::move(expression);
    return metric;
  }

  // Distinct values for a trial evaluation of an expression: a divisor may be a difference.
  struct Trial {
    double next = 1.618;
    Expression::Value operator()(const std::string&) { return next += 0.377; }
  };

  void read_limits(const YAML::Node& limits) {
    if (!limits) return;
    if (!limits.IsSequence())
      fail(limits,
           fmt::format(
               "'limits' must be a list of comparisons of metrics, such as '{} <= 10', got {}",
               sweep_.metrics.front().name, kind(limits)));
    std::vector<std::string> metrics;
    for (const Metric& metric : sweep_.metrics) metrics.push_back(metric.name);
    for (const auto& node : limits) {
      Expression limit(scalar(node, "limits"), where(node),
                       {"limit", "a metric",
                        [&](const std::string& name) -> std::optional<std::string> {
                          const auto found = std::find(metrics.begin(), metrics.end(), name);
                          return found == metrics.end() ? std::nullopt
                                                        : std::optional(std::string());
                        },
                        [&](const std::string& name) { return tb::near_matches(name, metrics); }});
      if (!limit.is_comparison() || limit.names().empty())
        fail(node, fmt::format("limit '{}' is not a comparison of a metric by < <= > >=: list "
                               "several limits separately",
                               limit.text()));
      limit.reference(Trial());  // determines its type, and that it does not always divide by zero
      sweep_.limits.push_back(std::move(limit));
    }
  }

  void read_objectives(const YAML::Node& objectives) {
    if (!objectives) return;
    if (!objectives.IsMap())
      fail(objectives, fmt::format("'objectives' must be a map of minimise and maximise, got {}",
                                   kind(objectives)));
    std::vector<std::string> metrics, axes;
    for (const Metric& metric : sweep_.metrics) metrics.push_back(metric.name);
    for (const Axis& axis : sweep_.axes) axes.push_back(axis.name);
    for (const auto& entry : objectives) {
      const std::string key = entry.first.Scalar();
      if (key != "minimise" && key != "maximise" && key != "for_each")
        fail(entry.first,
             fmt::format("'objectives': unknown '{}' (known: minimise, maximise, for_each)", key));
      if (!entry.second.IsSequence()) fail(entry.first, fmt::format("'{}' must be a list", key));
      for (const auto& node : entry.second) {
        if (key == "for_each") {
          sweep_.front_axes.push_back(one_of(axes, node, "axis"));
          continue;
        }
        const std::string& name = metrics[one_of(metrics, node, "metric")];
        for (const Objective& other : sweep_.objectives)
          if (other.metric == name) fail(node, fmt::format("objective '{}' is given twice", name));
        sweep_.objectives.push_back({name, key == "maximise"});
      }
    }
  }

  std::size_t one_of(const std::vector<std::string>& names, const YAML::Node& node,
                     std::string_view what) const {
    const std::string name = scalar(node, what);
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end())
      fail(node,
           fmt::format("no {} '{}'{} (known: {})", what, name,
                       tb::did_you_mean(tb::near_matches(name, names)), fmt::join(names, ", ")));
    return static_cast<std::size_t>(found - names.begin());
  }

  const tb::YamlFile& yaml_;
  SweepDefinition sweep_;
  std::unique_ptr<Engine> engine_;
  std::unique_ptr<BoundEngine> bound_;
};

}  // namespace

const std::vector<std::string>& stimulus_keys() {
  static const std::vector<std::string> kKeys = {"engine", "base",        "axes",   "points",
                                                 "sample", "constraints", "refused"};
  return kKeys;
}

SweepDefinition read_sweep(const std::filesystem::path& file) {
  return Reader(tb::YamlFile(file)).read();
}

SweepDefinition read_stimuli(const tb::YamlFile& file, const YAML::Node& part) {
  return Reader(file).read_part(part);
}

}  // namespace deburr::tool
