// SPDX-License-Identifier: MIT
#include "tool/regress/testplan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <iterator>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <sstream>
#include <string_view>
#include <system_error>
#include <utility>

#include "rtl_model/fabric/glob.h"
#include "spec/error.h"
#include "tb/base/file.h"
#include "tb/base/near_matches.h"
#include "tb/base/renamed.h"
#include "tb/base/yaml_file.h"
#include "tb/run/parameter_set.h"
#include "tool/run/engine.h"
#include "tool/run/reference_pages.h"
#include "tool/sweep/sampling.h"

namespace deburr::tool {

using tb::YamlFile;

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxPageBytes = 16u << 20;
constexpr std::uint64_t kMostSeeds = 100'000;
constexpr std::uint64_t kMostComparisons = std::uint64_t{1} << 60;

// Anchors of a page's headings, except in code blocks.
std::vector<std::string> anchors_in(const std::string& markdown) {
  std::vector<std::string> anchors;
  bool in_code = false;
  std::istringstream lines(markdown);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("```")) in_code = !in_code;
    const std::size_t marks = line.find_first_not_of('#');
    if (in_code || marks == 0 || marks == std::string::npos || line[marks] != ' ') continue;
    anchors.push_back(anchor_of(line.substr(marks)));
  }
  return anchors;
}

class Pages {
 public:
  explicit Pages(const fs::path& testplan) : folder_(fs::absolute(testplan).parent_path()) {}

  // The anchors of a page, or nullptr if the page does not exist.
  const std::vector<std::string>* find(const fs::path& page) {
    const auto [entry, is_new] = pages_.try_emplace(page.string());
    if (is_new) entry->second = read(page);
    return entry->second ? &*entry->second : nullptr;
  }
  const std::vector<fs::path>& found() const { return found_; }
  // Whether there is documentation above the testplan.
  bool any() const {
    for (fs::path folder = folder_;; folder = folder.parent_path()) {
      std::error_code error;
      if (fs::is_directory(folder / "docs", error)) return true;
      if (folder == folder.parent_path()) return false;
    }
  }

 private:
  std::optional<std::vector<std::string>> read(const fs::path& page) {
    for (fs::path folder = folder_;; folder = folder.parent_path()) {
      std::error_code error;
      if (fs::is_regular_file(folder / page, error)) {
        found_.push_back(folder / page);
        return anchors_in(tb::read_file(found_.back(), kMaxPageBytes));
      }
      if (folder == folder.parent_path()) return std::nullopt;
    }
  }

  fs::path folder_;
  std::map<std::string, std::optional<std::vector<std::string>>> pages_;
  std::vector<fs::path> found_;
};

// A coverage glob. It is checked after all files have named the engines of its feature, or of the
// plan.
struct PendingGlob {
  std::string feature;  // empty: the whole plan
  YAML::Node node;
  const YamlFile* yaml;
};

// One file of a testplan: the main file or an included one. Included features come first; features
// of the same id are merged.
class TestplanFile {
 public:
  TestplanFile(const YamlFile& yaml, std::vector<Feature>& common, std::vector<Feature>& included,
               std::vector<PendingGlob>& globs)
      : yaml_(yaml), pages_(yaml.path()), common_(common), included_(included), globs_(globs) {}

  // Reads the keys of the whole plan; returns the included files.
  std::vector<fs::path> read_whole(Testplan& plan) {
    const YAML::Node& root = yaml_.root();
    yaml_.require_keys(root, {"title", "include", "features", "coverage", "unmet"});
    plan.file = yaml_.path();
    plan.name = plan.title = plan.file.stem().string();
    if (root["title"]) plan.title = yaml_.scalar(root["title"], "title");
    note_globs(root, "");
    std::vector<fs::path> files;
    if (root["include"])
      for (const YAML::Node& node : list_of(root, "include"))
        for (fs::path& file : files_of(node)) files.push_back(std::move(file));
    includes_ = !files.empty();
    if (includes_ && !root["features"]) return files;
    for (const YAML::Node& node : list_of(root, "features")) {
      Feature feature = read_feature(node);
      if (feature_named(feature.id))
        yaml_.fail(node["id"], fmt::format("duplicate feature '{}'", feature.id));
      common_.push_back(std::move(feature));
    }
    return files;
  }

  void read_part() {
    yaml_.require_keys(yaml_.root(), {"features", "coverage", "unmet"});
    note_globs(yaml_.root(), "");
    std::set<std::string> own;
    for (const YAML::Node& node : list_of(yaml_.root(), "features")) {
      const std::string id = name_of(node, "id");
      if (!own.insert(id).second) yaml_.fail(node["id"], fmt::format("duplicate feature '{}'", id));
      if (Feature* const feature = feature_named(id))
        add_to(*feature, node);
      else
        included_.push_back(read_feature(node));
    }
  }

  const std::vector<fs::path>& pages() const { return pages_.found(); }
  bool needs_traces() const { return pages_.any(); }

  void read(const PendingGlob& glob, Testplan& plan) const {
    const std::string where = yaml_.where(glob.node);
    if (!glob.feature.empty()) {
      Feature& feature = *feature_named(glob.feature);
      feature.coverage.push_back(
          {read_glob(glob.node, "coverage", bins_of({&feature}), "the feature's"), where});
      return;
    }
    std::vector<const Feature*> all;
    for (const std::vector<Feature>* const features : {&common_, &included_})
      for (const Feature& feature : *features) all.push_back(&feature);
    const std::vector<std::string> bins = bins_of(all);
    if (!glob.node.IsMap()) {
      plan.coverage.push_back({read_glob(glob.node, "coverage", bins, "the plan's"), where});
      return;
    }
    yaml_.require_keys(glob.node, {"bins", "reason"});
    const std::string reason = text_of(glob.node, "reason");
    if (reason.empty()) yaml_.fail(glob.node["reason"], "'reason' must be a text");
    if (!glob.node["bins"]) yaml_.fail(glob.node, "'bins' is missing");
    plan.unmet.push_back({read_glob(glob.node["bins"], "bins", bins, "the plan's"), reason, where});
  }

 private:
  // A list with at least one entry.
  YAML::Node list_of(const YAML::Node& map, const char* key) const {
    const YAML::Node list = map[key];
    if (!list) yaml_.fail(map, fmt::format("'{}' is missing", key));
    if (!list.IsSequence() || list.size() == 0)
      yaml_.fail(list, fmt::format("'{}' must be a list, got {}", key, YamlFile::kind(list)));
    return list;
  }

  // A file relative to this one; * stands for each engine's name, in order.
  std::vector<fs::path> files_of(const YAML::Node& node) const {
    const std::string text = yaml_.scalar(node, "include");
    const std::size_t star = text.find('*');
    std::vector<std::string> names;
    if (star == std::string::npos)
      names.push_back(text);
    else
      for (const std::unique_ptr<Engine>& engine : engines())
        names.push_back(std::string(text).replace(star, 1, engine->name()));
    std::vector<fs::path> files;
    for (const std::string& name : names) {
      files.push_back((yaml_.path().parent_path() / name).lexically_normal());
      if (std::error_code error; !fs::is_regular_file(files.back(), error))
        yaml_.fail(node, fmt::format("file '{}' not found", files.back().string()));
    }
    return files;
  }

  Feature* feature_named(const std::string& id) const {
    for (std::vector<Feature>* const features : {&common_, &included_})
      for (Feature& feature : *features)
        if (feature.id == id) return &feature;
    return nullptr;
  }

  std::string text_of(const YAML::Node& map, const char* key) const {
    if (!map[key]) yaml_.fail(map, fmt::format("'{}' is missing", key));
    return yaml_.scalar(map[key], key);
  }

  // The name becomes part of point names.
  std::string name_of(const YAML::Node& map, const char* key) const {
    std::string name = text_of(map, key);
    if (name.empty() ||
        name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789-") != std::string::npos)
      yaml_.fail(
          map[key],
          fmt::format("'{}' = '{}' must consist of lower-case letters, digits and -", key, name));
    return name;
  }

  Feature read_feature(const YAML::Node& node) {
    yaml_.require_keys(node, {"id", "title", "traces", "stimuli", "checks", "coverage"});
    Feature feature;
    feature.id = name_of(node, "id");
    feature.title = text_of(node, "title");
    // Included files may supply missing keys.
    if (node["traces"] || (!includes_ && needs_traces())) read_traces_of(node, feature);
    if (!includes_ || node["stimuli"]) read_stimuli_of(node, feature);
    if (!includes_ && !node["checks"] && !node["coverage"])
      yaml_.fail(
          node,
          "'checks' and 'coverage' are both missing: give one of them, so that the runs can fail");
    read_checks(node, feature);
    note_globs(node, feature.id);
    return feature;
  }

  void add_to(Feature& feature, const YAML::Node& node) {
    yaml_.require_keys(node, {"id", "traces", "stimuli", "checks", "coverage"});
    if (node["traces"]) read_traces_of(node, feature);
    read_stimuli_of(node, feature);
    read_checks(node, feature);
    note_globs(node, feature.id);
  }

  void read_traces_of(const YAML::Node& node, Feature& feature) {
    for (const YAML::Node& trace : list_of(node, "traces"))
      feature.traces.push_back(read_trace(trace));
  }

  void read_stimuli_of(const YAML::Node& node, Feature& feature) const {
    for (const YAML::Node& entry : list_of(node, "stimuli")) {
      Stimulus stimulus = read_stimulus(entry);
      for (const Stimulus& other : feature.stimuli)
        if (other.name == stimulus.name)
          yaml_.fail(entry["name"], fmt::format("duplicate stimulus '{}'", stimulus.name));
      feature.stimuli.push_back(std::move(stimulus));
    }
  }

  void note_globs(const YAML::Node& node, const std::string& feature) {
    for (const char* const key : {"coverage", "unmet"}) {
      if (!node[key]) continue;
      for (const YAML::Node& glob : list_of(node, key)) {
        if (glob.IsMap() != (key == std::string_view("unmet")))
          yaml_.fail(glob, fmt::format("'{}' must be {}, got {}", key,
                                       glob.IsMap() ? "a list of globs"
                                                    : "a list of maps of bins and reason",
                                       YamlFile::kind(glob)));
        globs_.push_back({feature, glob, &yaml_});
      }
    }
  }

  // Whether the path stays inside docs/.
  static bool is_in_docs(const fs::path& page) {
    return page.begin() != page.end() && *page.begin() == "docs" && page.extension() == ".md" &&
           std::find(page.begin(), page.end(), "..") == page.end();
  }

  // "docs/reference/texture/index.md#presets"
  std::string read_trace(const YAML::Node& node) {
    if (node.IsMap())  // the form with quoted sentences, until 0.4.0
      yaml_.fail(node,
                 "'traces' no longer takes 'page' and 'says': name the heading above the sentence, "
                 "as docs/PAGE.md#HEADING");
    std::string trace = yaml_.scalar(node, "traces");
    const std::size_t mark = std::min(trace.find('#'), trace.size());
    const fs::path page = trace.substr(0, mark);
    if (!is_in_docs(page))
      yaml_.fail(node, fmt::format("'traces' = '{}' must be a heading of a page of the "
                                   "documentation, docs/PAGE.md#HEADING",
                                   trace));
    const std::vector<std::string>* const anchors = pages_.find(page);
    if (!anchors)
      yaml_.fail(node,
                 fmt::format("page '{}' not found in any folder above this file", page.string()));
    const std::string anchor = trace.substr(std::min(mark + 1, trace.size()));
    if (anchor.empty())
      yaml_.fail(node, fmt::format("'traces' = '{}' names no heading: append #HEADING, with - for "
                                   "blanks and without punctuation",
                                   trace));
    if (std::find(anchors->begin(), anchors->end(), anchor) == anchors->end()) {
      const std::vector<std::string> near = tb::near_matches(anchor, *anchors);
      yaml_.fail(node, fmt::format("'{}' lacks the heading '#{}'{}", page.string(), anchor,
                                   near.empty() ? ": check that the feature is still tested, and "
                                                  "name the heading that describes it now"
                                                : tb::did_you_mean(near)));
    }
    return trace;
  }

  Stimulus read_stimulus(const YAML::Node& node) const {
    std::vector<std::string> keys = stimulus_keys();
    keys.insert(keys.end(), {"name", "seeds", "random"});
    yaml_.require_keys(node, keys);
    Stimulus stimulus;
    stimulus.name = name_of(node, "name");
    stimulus.configurations = read_stimuli(yaml_, node);
    if (node["seeds"]) stimulus.seeds = yaml_.count(node["seeds"], "seeds", kMostSeeds);
    if (node["random"]) stimulus.random = yaml_.boolean(node["random"], "random");
    return stimulus;
  }

  // Only runs know scoreboards, so an unknown scoreboard is reported as a failed check.
  void read_checks(const YAML::Node& node, Feature& feature) const {
    const YAML::Node checks = node["checks"];
    if (!checks) return;
    if (!checks.IsMap() || checks.size() == 0)
      yaml_.fail(checks, fmt::format("'checks' must be a map of scoreboards to numbers, got {}",
                                     YamlFile::kind(checks)));
    for (const auto& entry : checks) {
      const std::string name = entry.first.Scalar();
      for (const RequiredCheck& other : feature.checks)
        if (other.scoreboard == name)
          yaml_.fail(entry.first, fmt::format("'{}' is given twice", name));
      feature.checks.push_back(
          {name, yaml_.count(entry.second, name, kMostComparisons), yaml_.where(entry.first)});
    }
  }

  static std::vector<std::string> bins_of(const std::vector<const Feature*>& features) {
    std::set<std::string> engines, bins;
    for (const Feature* const feature : features)
      for (const Stimulus& stimulus : feature->stimuli)
        engines.insert(stimulus.configurations.engine);
    for (const std::string& engine : engines) bins.merge(coverage_bins(engine));
    return {bins.begin(), bins.end()};
  }

  // A glob of possible bins; only the runs show which ones exist.
  std::string read_glob(const YAML::Node& node, std::string_view key,
                        const std::vector<std::string>& bins, std::string_view whose) const {
    std::string glob = yaml_.scalar(node, key);
    if (glob.empty() || glob.find_first_of("[]{}!\\") != std::string::npos)
      yaml_.fail(node, fmt::format("'{}' is not a glob: * matches any text and ? any character; [, "
                                   "{{, ! and \\ are not supported",
                                   glob));
    const auto matches = [&](const std::string& pattern) {
      return std::any_of(bins.begin(), bins.end(),
                         [&](const std::string& bin) { return rtl::glob_match(pattern, bin); });
    };
    if (!matches(glob)) {
      const std::string now = tb::with_current_words(glob);
      yaml_.fail(
          node,
          fmt::format(
              "no bin of {} engines matches '{}'{} (docs/reference/coverage.md)", whose, glob,
              tb::did_you_mean(matches(now) ? std::vector{now} : tb::near_matches(glob, bins))));
    }
    return glob;
  }

  const YamlFile& yaml_;
  Pages pages_;
  std::vector<Feature>&common_, &included_;
  std::vector<PendingGlob>& globs_;
  bool includes_ = false;
};

std::uint64_t share_of(std::uint64_t number, std::uint64_t divisor) {
  return (number + divisor - 1) / divisor;
}

// The number of comparisons of random configurations varies by more than its mean. Returns the
// fraction of the mean that `runs` random configurations surely reach.
double sure_part(std::uint64_t runs) {
  constexpr double kSpread = 8;
  constexpr double kLeast = 0.5;  // comparisons of the fixed-size frames among them
  if (runs == 0) return 1;
  return std::max(kLeast, 1 - kSpread / std::sqrt(static_cast<double>(runs)));
}

}  // namespace

Testplan read_testplan(const fs::path& file) {
  Testplan plan;
  std::vector<Feature> common;
  std::vector<PendingGlob> globs;
  std::deque<YamlFile> files;
  const auto open = [&](const fs::path& name) {
    files.emplace_back(name);
    return TestplanFile(files.back(), common, plan.features, globs);
  };
  const auto note_pages = [&](const TestplanFile& read) {
    for (const fs::path& page : read.pages())
      if (std::find(plan.pages.begin(), plan.pages.end(), page) == plan.pages.end())
        plan.pages.push_back(page);
  };
  TestplanFile whole = open(file);
  plan.included = whole.read_whole(plan);
  const bool needs_traces = whole.needs_traces();
  note_pages(whole);
  for (const fs::path& included : plan.included) {
    TestplanFile part = open(included);
    part.read_part();
    note_pages(part);
  }
  for (const PendingGlob& glob : globs)
    TestplanFile(*glob.yaml, common, plan.features, globs).read(glob, plan);
  if (plan.coverage.empty() && !plan.unmet.empty())
    throw spec::ConfigError(
        fmt::format("{}: 'unmet' lists bins of the plan's own 'coverage' (next to 'features'), "
                    "which is missing",
                    plan.unmet.front().where));
  plan.features.insert(plan.features.end(), std::make_move_iterator(common.begin()),
                       std::make_move_iterator(common.end()));
  const auto require = [&](bool has, const Feature& feature, const char* what) {
    if (!has)
      throw spec::ConfigError(
          fmt::format("{}: the feature '{}' lacks {}, and no included file adds any", file.string(),
                      feature.id, what));
  };
  for (const Feature& feature : plan.features) {
    require(!feature.traces.empty() || !needs_traces, feature, "traces");
    require(!feature.stimuli.empty(), feature, "stimuli");
    require(!feature.checks.empty() || !feature.coverage.empty(), feature, "checks");
  }
  return plan;
}

Testplan part_of(Testplan testplan, std::uint64_t divisor) {
  if (divisor == 1) return testplan;
  testplan.divisor = divisor;
  testplan.name += fmt::format("-of-{}", divisor);
  testplan.title += fmt::format(", one seed of {}", divisor);
  for (Feature& feature : testplan.features) {
    std::uint64_t random = 0;
    for (Stimulus& stimulus : feature.stimuli) {
      stimulus.seeds = share_of(stimulus.seeds, divisor);
      if (stimulus.random) random += sample_bound(stimulus.configurations) * stimulus.seeds;
    }
    const double sure = sure_part(random);
    for (RequiredCheck& check : feature.checks) {
      const double share = sure * static_cast<double>(share_of(check.minimum, divisor));
      check.minimum = std::max(std::uint64_t{1}, static_cast<std::uint64_t>(share));
    }
    for (RequiredBins& bins : feature.coverage) bins.every = false;
  }
  for (RequiredBins& bins : testplan.coverage) bins.every = false;
  return testplan;
}

}  // namespace deburr::tool
