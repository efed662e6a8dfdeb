// SPDX-License-Identifier: MIT
// The contents of a sweep's YAML file (docs/reference/sweeps.md): engine, settings of every point,
// axes, sampling, constraints, and metrics.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tb/run/parameter_set.h"
#include "tool/sweep/expression.h"

namespace YAML {
class Node;
}

namespace deburr::tb {
class YamlFile;
}  // namespace deburr::tb

namespace deburr::tool {

// A parameter's value, and where it was set.
struct Setting {
  std::string name, value, where;
};

// One value of an axis: a parameter's value, or a named set of several parameters' values.
struct Choice {
  std::string label;
  std::vector<std::string> values;  // one per Axis::parameters
};

// A range between two numbers, only for sampling.
struct Span {
  double from = 0, to = 0;
  bool integer = false;
};

struct Axis {
  std::string name;
  std::vector<std::string> parameters;  // just `name` if it is a single parameter
  std::vector<Choice> choices;          // empty for a span
  std::optional<Span> span;
  std::optional<Constraint> when;  // the axis applies only if the point's other settings meet it
  std::string where;
};
inline constexpr const char* kNotGiven = "-";  // the label if it does not apply

// A key of result.json, dotted or as JSON pointer, or an expression of dotted keys.
struct Metric {
  std::string name, key;
  std::optional<Expression> expression;  // if it is not a single key
  std::string where;

  // The keys of result.json that the metric reads.
  std::vector<std::string> keys() const {
    return expression ? expression->names() : std::vector<std::string>{key};
  }
};

struct Objective {
  std::string metric;
  bool maximise = false;
};

enum class SweepSampling : std::uint8_t { kCartesian, kListed, kRandom, kLatin };

struct SweepDefinition {
  std::filesystem::path file;
  std::string name, title, engine;
  std::vector<Setting> base;
  std::vector<Axis> axes;
  SweepSampling sampling = SweepSampling::kCartesian;
  std::uint64_t samples = 0, sample_seed = 1;  // for kRandom and kLatin
  std::vector<Constraint> constraints;
  bool skip_rejected = false;  // omit points that the engine rejects, instead of failing
  std::vector<Metric> metrics;
  std::vector<Expression> limits;  // comparisons of metrics; a point beyond a limit is on no front
  std::vector<Objective> objectives;
  std::vector<std::size_t> front_axes;  // only points that agree in these are compared
  bool reports = true;
  std::uint64_t chunk = 0;  // points per worker; 0: chosen by the number of points
};

// ConfigError with file and line for every invalid entry: unknown keys, engines, parameters and
// metrics, values out of range, empty axes, invalid constraints.
SweepDefinition read_sweep(const std::filesystem::path& file);

// The keys of the stimulus part of a definition, and a reader for such a part in other files. A
// part without axes and points has a single point, the base. The caller checks the keys of the
// part.
const std::vector<std::string>& stimulus_keys();
SweepDefinition read_stimuli(const tb::YamlFile& file, const YAML::Node& part);

}  // namespace deburr::tool
