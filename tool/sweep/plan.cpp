// SPDX-License-Identifier: MIT
#include "tool/sweep/plan.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <system_error>
#include <unordered_set>
#include <utility>

#include "spec/error.h"
#include "tb/base/atomic_file.h"
#include "tb/base/file.h"
#include "tb/base/headline.h"
#include "tb/base/json_text.h"
#include "tb/run/amount.h"
#include "tb/run/progress.h"
#include "tool/pages/build_info.h"

namespace deburr::tool {

using tb::grouped;

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using spec::ConfigError;
using spec::FileError;

constexpr std::size_t kMaxPlanBytes = 64u << 20;
constexpr int kPlanSchema = 4;

fs::path plan_file(const fs::path& directory) { return directory / "plan.json"; }

void make_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error)
    throw FileError(fmt::format("cannot make the folder '{}': {}; choose another with --out",
                                folder.string(), error.message()));
}

// A file written line by line that is renamed to its final name when complete.
class LineFile {
 public:
  explicit LineFile(fs::path file) : file_(std::move(file)), draft_(file_.string() + ".tmp") {
    stream_ = std::fopen(draft_.c_str(), "w");
    if (!stream_) fail("create");
  }
  ~LineFile() {
    if (!stream_) return;
    std::fclose(stream_);
    ::unlink(draft_.c_str());
  }
  LineFile(const LineFile&) = delete;
  LineFile& operator=(const LineFile&) = delete;

  void add(const std::string& line) {
    if (std::fwrite(line.data(), 1, line.size(), stream_) != line.size() ||
        std::fputc('\n', stream_) == EOF)
      fail("write");
  }
  void finish() {
    if (std::fflush(stream_) != 0 || ::fsync(::fileno(stream_)) != 0) fail("write");
    FILE* stream = std::exchange(stream_, nullptr);
    if (std::fclose(stream) != 0 || std::rename(draft_.c_str(), file_.c_str()) != 0) fail("write");
  }

 private:
  [[noreturn]] void fail(const char* action) {
    const int reason = errno;
    if (stream_) std::fclose(std::exchange(stream_, nullptr));
    ::unlink(draft_.c_str());
    throw FileError(
        fmt::format("cannot {} '{}': {}; make room there, or choose another directory with --out",
                    action, file_.string(), std::strerror(reason)));
  }
  fs::path file_, draft_;
  FILE* stream_ = nullptr;
};

std::string in_words(const Plan& plan, const Sample& sample) {
  std::string text;
  for (std::size_t i = 0; i < sample.size(); ++i)
    text += fmt::format("{}{} = {}", i > 0 ? ", " : "", plan.axes[i].name, sample[i]);
  return text;
}

Json to_json(const Plan& plan) {
  Json json = {{"schema", kPlanSchema}, {"engine", plan.engine}, {"title", plan.title},
               {"file", plan.file},     {"digest", plan.digest}, {"model", plan.model},
               {"points", plan.points}, {"inputs", plan.inputs}, {"left_out", plan.left_out},
               {"parts", plan.parts},   {"files", plan.files},   {"reports", plan.reports},
               {"chunk", plan.chunk}};
  json["base"] = Json::array();
  for (const Setting& s : plan.base) json["base"].push_back({s.name, s.value, s.where});
  json["axes"] = Json::array();
  for (const PlanAxis& axis : plan.axes)
    json["axes"].push_back({{"name", axis.name},
                            {"parameters", axis.parameters},
                            {"choices", axis.choices},
                            {"conditional", axis.conditional}});
  return json;
}

// Expands and checks every sample.
class Planner {
 public:
  Planner(const SweepDefinition& sweep, Plan& plan, LineFile& lines)
      : sweep_(sweep), plan_(plan), lines_(lines), check_(sweep, plan) {}

  void run() {
    tb::Progress progress("planning", sample_bound(sweep_), "point");
    for_each_sample(sweep_, [&](const Sample& sample) {
      progress.update(++seen_);
      return take(sample);
    });
    if (plan_.points == 0)
      throw ConfigError(fmt::format("{}: all {} points are excluded: {}", plan_.file,
                                    grouped(seen_), check_.reasons()));
    check_.tell(plan_);
    if (twice_ > 0)
      plan_.left_out.push_back(fmt::format("{} that duplicate another point", grouped(twice_)));
    if (sweep_.sampling == SweepSampling::kRandom && plan_.points < sweep_.samples)
      plan_.left_out.push_back(fmt::format("{} of {} random points that were not found in {} draws",
                                           grouped(sweep_.samples - plan_.points),
                                           grouped(sweep_.samples), grouped(seen_)));
  }

 private:
  bool take(const Sample& sample) {
    const std::optional<PlannedPoint> point = check_.check(sample);
    if (!point) return false;
    if (!names_.insert(point->name).second) {
      // else only inapplicable axes differ
      if (point->sample == sample) ++twice_;
      return false;
    }
    lines_.add(line_of(*point));
    ++plan_.points;
    return true;
  }

  const SweepDefinition& sweep_;
  Plan& plan_;
  LineFile& lines_;
  PointChecker check_;
  std::uint64_t seen_ = 0, twice_ = 0;
  std::unordered_set<std::string> names_;
};

}  // namespace

SweepPlace place_of(const fs::path& out, const std::string& name) {
  return {out, out / "sweeps" / name};
}

fs::path points_file(const fs::path& directory) { return directory / "points.jsonl"; }

std::vector<Setting> Plan::settings_of(const Sample& sample) const {
  std::vector<Setting> settings = base;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const PlanAxis& axis = axes[i];
    if (axis.conditional && sample.at(i) == kNotGiven) continue;
    const std::string where = fmt::format("{}: axis '{}'", file, axis.name);
    if (axis.choices.empty()) {
      settings.push_back({axis.name, sample.at(i), where});
      continue;
    }
    const std::vector<std::string>& values = axis.choices.at(sample.at(i));
    for (std::size_t k = 0; k < values.size(); ++k)
      settings.push_back({axis.parameters.at(k), values[k], where});
  }
  return settings;
}

PlannedPoint PointNamer::name(const BoundEngine& bound, Sample sample) {
  PlannedPoint planned{point_name(bound, files_), 0, 0, std::move(sample)};
  planned.input = inputs_.emplace(tb::sha256(input_name(bound)), inputs_.size()).first->second;
  planned.golden = goldens_.emplace(tb::sha256(golden_name(bound)), goldens_.size()).first->second;
  return planned;
}

void PointNamer::tell(Plan& plan) const {
  plan.inputs = inputs_.size();
  plan.files = files_.all();
}

PointChecker::PointChecker(const SweepDefinition& sweep, const Plan& plan)
    : sweep_(sweep), plan_(plan), excluded_(sweep.constraints.size(), 0) {}

// Removes axes without effect on this point.
Sample PointChecker::without_idle_axes(const Sample& sample) const {
  Sample bare = sample, given = sample;
  for (std::size_t i = 0; i < sample.size(); ++i)
    if (sweep_.axes[i].when) bare[i] = kNotGiven;
  if (bare == sample) return sample;
  PointEngine point(plan_.engine, plan_.settings_of(bare));
  try {
    point.bound.resolve();
  } catch (const ConfigError&) {  // later settings may fix it
  }
  for (std::size_t i = 0; i < sample.size(); ++i)
    if (sweep_.axes[i].when && !sweep_.axes[i].when->holds(point.bound.set)) given[i] = kNotGiven;
  return given;
}

std::optional<PlannedPoint> PointChecker::check(const Sample& all) {
  const Sample sample = without_idle_axes(all);
  PointEngine point(plan_.engine, plan_.settings_of(sample));
  std::optional<std::string> rejection;
  try {
    point.bound.resolve();
    faults_.require(plan_.engine, point.bound.run.fault);
  } catch (const ConfigError& error) {
    rejection = error.what();
  }
  // Excluded points need not be valid, so constraints come first.
  for (std::size_t i = 0; i < sweep_.constraints.size(); ++i)
    if (!sweep_.constraints[i].holds(point.bound.set)) {
      ++excluded_[i];
      return std::nullopt;
    }
  if (rejection) {
    if (!sweep_.skip_rejected)
      throw ConfigError(fmt::format(
          "{}: the engine rejects the point {}: {}; leave such points out with a constraint, or "
          "all that are rejected with 'refused: skip'",
          plan_.file, in_words(plan_, sample), tb::headline(*rejection)));
    if (rejected_++ == 0)
      first_rejection_ = in_words(plan_, sample) + ": " + tb::headline(*rejection);
    return std::nullopt;
  }
  return namer_.name(point.bound, sample);
}

void PointChecker::tell(Plan& plan) const {
  namer_.tell(plan);
  plan.left_out.clear();
  for (std::size_t i = 0; i < excluded_.size(); ++i)
    if (excluded_[i] > 0)
      plan.left_out.push_back(fmt::format("{} by the constraint '{}'", grouped(excluded_[i]),
                                          sweep_.constraints[i].text()));
  if (rejected_ > 0)
    plan.left_out.push_back(fmt::format("{} that the engine rejects, the first: {}",
                                        grouped(rejected_), first_rejection_));
}

std::string PointChecker::reasons() const {
  std::string why;
  for (std::size_t i = 0; i < excluded_.size(); ++i)
    if (excluded_[i] > 0)
      why += fmt::format("{}'{}' excludes {}", why.empty() ? "" : ", of the rest ",
                         sweep_.constraints[i].text(), grouped(excluded_[i]));
  if (rejected_ > 0)
    why += fmt::format("{}the engine rejects {}, the first {}", why.empty() ? "" : "; ",
                       grouped(rejected_), first_rejection_);
  return why;
}

Plan plan_without_points(const SweepDefinition& sweep) {
  Plan plan;
  plan.engine = sweep.engine;
  plan.title = sweep.title.empty() ? sweep.name : sweep.title;
  plan.file = sweep.file.string();
  plan.base = sweep.base;
  plan.reports = sweep.reports;
  plan.chunk = sweep.chunk;
  for (const Axis& axis : sweep.axes) {
    PlanAxis planned{axis.name, axis.parameters, {}, axis.when.has_value()};
    if (axis.parameters != std::vector<std::string>{axis.name})
      for (const Choice& choice : axis.choices) planned.choices[choice.label] = choice.values;
    plan.axes.push_back(std::move(planned));
  }
  return plan;
}

std::vector<std::string> changes_since(const Plan& plan, const fs::path& file) {
  std::vector<std::string> changes;
  if (!is_of_this_model(plan)) changes.emplace_back("the model");
  if (content_of(file) != plan.digest) changes.push_back(fmt::format("'{}'", file.string()));
  for (const auto* const all : {&plan.parts, &plan.files})
    for (const auto& [input, content] : *all)
      if (content_of(input) != content) changes.push_back(fmt::format("'{}'", input));
  return changes;
}

Json inputs_of(const Plan& plan, std::string_view role) {
  Json inputs = Json::array();
  inputs.push_back(input_entry(plan.file, plan.digest, role));
  for (const auto& [file, content] : plan.parts) inputs.push_back(input_entry(file, content, role));
  for (const auto& [file, content] : plan.files) inputs.push_back(input_entry(file, content));
  return inputs;
}

bool is_of_this_model(const Plan& plan) { return plan.model == build_info().model; }

void write_points(const std::vector<PlannedPoint>& points, const SweepPlace& place) {
  make_folder(place.directory);
  std::string lines;
  for (const PlannedPoint& point : points) lines += line_of(point) + "\n";
  tb::write_file_atomically(points_file(place.directory), lines);
}

void write_plan(Plan& plan, const SweepPlace& place) {
  plan.digest = tb::sha256_of_file(plan.file);
  plan.model = build_info().model;
  tb::write_file_atomically(plan_file(place.directory), tb::json_text(to_json(plan), 1) + "\n");
}

Plan make_plan(const SweepDefinition& sweep, const SweepPlace& place) {
  if (const auto before = find_plan(place.directory);
      before && changes_since(*before, sweep.file).empty())
    return *before;
  if (sample_bound(sweep) > kMostPoints)
    throw ConfigError(fmt::format(
        "{}: the axes make {} points{}, at most {} can be planned: give fewer values, or take a "
        "sample of them ('sample: {{random: 1000}}' or '{{latin: 1000}}')",
        sweep.file.string(), sizes_of(sweep),
        sample_bound(sweep) == std::numeric_limits<std::uint64_t>::max()
            ? ""
            : " = " + grouped(sample_bound(sweep)),
        grouped(kMostPoints)));
  make_folder(place.directory);
  Plan plan = plan_without_points(sweep);
  std::error_code ignored;
  fs::remove(plan_file(place.directory), ignored);  // it would name another plan's points
  LineFile lines(points_file(place.directory));
  Planner(sweep, plan, lines).run();
  lines.finish();
  write_plan(plan, place);
  return plan;
}

std::optional<Plan> find_plan(const fs::path& directory) {
  std::error_code error;
  if (!fs::exists(plan_file(directory), error)) return std::nullopt;
  try {
    return read_plan(directory);
  } catch (const FileError&) {
    return std::nullopt;
  }
}

Plan read_plan(const fs::path& directory) {
  const fs::path file = plan_file(directory);
  std::error_code error;
  if (!fs::exists(file, error))
    throw FileError(fmt::format("no plan in '{}': run or plan it first", directory.string()));
  try {
    const Json json = tb::parse_json(tb::read_file(file, kMaxPlanBytes));
    if (json.at("schema") != kPlanSchema) throw FileError("made by another version");
    Plan plan;
    plan.engine = json.at("engine");
    plan.title = json.at("title");
    plan.file = json.at("file");
    plan.digest = json.at("digest");
    plan.model = json.at("model");
    plan.points = json.at("points");
    plan.inputs = json.at("inputs");
    plan.left_out = json.at("left_out").get<std::vector<std::string>>();
    plan.parts = json.at("parts").get<std::map<std::string, std::string>>();
    plan.files = json.at("files").get<std::map<std::string, std::string>>();
    plan.reports = json.at("reports");
    plan.chunk = json.at("chunk");
    for (const Json& s : json.at("base")) plan.base.push_back({s.at(0), s.at(1), s.at(2)});
    for (const Json& axis : json.at("axes"))
      plan.axes.push_back(
          {axis.at("name"), axis.at("parameters").get<std::vector<std::string>>(),
           axis.at("choices").get<std::map<std::string, std::vector<std::string>>>(),
           axis.at("conditional")});
    return plan;
  } catch (const std::exception& problem) {
    throw FileError(fmt::format("'{}' is not a plan of this version ({}): plan it again",
                                file.string(), problem.what()));
  }
}

std::string line_of(const PlannedPoint& point) {
  Json line = {point.name, point.input, point.golden};
  for (const std::string& text : point.sample) line.push_back(text);
  if (!point.engine.empty()) {
    Json settings = Json::array();
    for (const Setting& s : point.settings) settings.push_back({s.name, s.value, s.where});
    line.push_back({{"engine", point.engine}, {"settings", std::move(settings)}});
  }
  return tb::json_text(line, -1, tb::NotUtf8::kReplace);
}

void for_each_point(const fs::path& file, const std::function<void(const PlannedPoint&)>& take,
                    PointLines lines) {
  std::ifstream in(file);
  if (!in)
    throw FileError(fmt::format("cannot open '{}': {}", file.string(), std::strerror(errno)));
  std::string line;
  in.seekg(static_cast<std::streamoff>(lines.offset));
  for (std::uint64_t taken = 0; taken < lines.count && std::getline(in, line); ++taken) {
    const Json json = tb::try_parse_json(line);
    if (!json.is_array() || json.size() < 3)
      throw FileError(fmt::format("'{}' is damaged: plan it again", file.string()));
    PlannedPoint point{json[0], json[1], json[2], {}};
    for (std::size_t i = 3; i < json.size(); ++i) {
      if (json[i].is_string()) {
        point.sample.push_back(json[i]);
        continue;
      }
      point.engine = json[i].at("engine");
      for (const Json& s : json[i].at("settings"))
        point.settings.push_back({s.at(0), s.at(1), s.at(2)});
    }
    take(point);
  }
  if (in.bad()) throw FileError(fmt::format("cannot read '{}'", file.string()));
}

}  // namespace deburr::tool
