// SPDX-License-Identifier: MIT
// What a sweep's YAML file says (docs/reference/sweeps.md): which engine, what every point has,
// what is varied, how it is sampled, what is left out, and what is looked at afterwards.
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

// What is given to a parameter, and where that was said.
struct Setting {
  std::string name, value, where;
};

// One value of an axis: of a parameter, or a name for values of several.
struct Choice {
  std::string label;
  std::vector<std::string> values;  // one each of Axis::parameters
};

// Between two numbers, for samples only.
struct Span {
  double from = 0, to = 0;
  bool integer = false;
};

struct Axis {
  std::string name;
  std::vector<std::string> parameters;  // `name` itself where it is one parameter
  std::vector<Choice> choices;          // empty where there is a span
  std::optional<Span> span;
  std::optional<Constraint> when;  // it is given only where this holds of the point without it
  std::string where;
};
inline constexpr const char* kNotGiven = "-";  // the label where it does not

// What is looked at: a key of result.json, dotted or as JSON pointer, or an expression of dotted
// keys.
struct Metric {
  std::string name, key;
  std::optional<Expression> expression;  // where it is no single key
  std::string where;

  // The keys that it reads.
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
  std::uint64_t samples = 0, sample_seed = 1;  // of kRandom and kLatin
  std::vector<Constraint> constraints;
  bool skip_rejected = false;  // points that the engine rejects are left out, not an error
  std::vector<Metric> metrics;
  std::vector<Expression> limits;  // comparisons of metrics: a point beyond one is on no front
  std::vector<Objective> objectives;
  std::vector<std::size_t> front_axes;  // only points that agree in these are compared
  bool reports = true;
  std::uint64_t chunk = 0;  // points a worker; 0: chosen by the number of points
};

// ConfigError with file and line for everything that cannot be meant: unknown keys, engines,
// parameters and metrics, values out of range, empty axes, constraints that are none.
SweepDefinition read_sweep(const std::filesystem::path& file);

// The part of it that says what is run: its keys, and how another file with such parts reads one.
// Without axes and points it is one point, its base. The caller checks the keys of the part.
const std::vector<std::string>& stimulus_keys();
SweepDefinition read_stimuli(const tb::YamlFile& file, const YAML::Node& part);

}  // namespace deburr::tool
