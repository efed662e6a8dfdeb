// SPDX-License-Identifier: MIT
#include "tool/run/random_configuration.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <initializer_list>
#include <map>
#include <memory>
#include <set>

#include "spec/error.h"
#include "tb/base/random.h"
#include "tb/scene/textures.h"
#include "tool/run/run_once.h"

namespace deburr::tool {

using tb::Random;

namespace {

using Settings = std::vector<std::pair<std::string, std::string>>;

// For every engine.
constexpr std::array<std::string_view, 17> kFixed = {
    // Runs that are not compared, that end early by design, or that write pictures and waveforms.
    "run.check", "run.max_cycles", "run.fault", "run.reference", "run.images", "run.pixel",
    "run.trace", "run.trace_from", "run.trace_to", "run.timeline_from",
    // Most random cameras see nothing.
    "scene.eye", "scene.target",
    // References are supersampled, which does not exercise the hardware.
    "scene.reference_samples",
    // Runs with memory errors never pass.
    "memory.error_address", "memory.error_bytes",
    // A file of the user.
    "memory.latency_file",
    // With a short watchdog, slow memory and stalls would count as a deadlock.
    "run.watchdog_cycles"};

std::string word(Random& random) { return std::to_string(random.word()); }

std::string permille(Random& random) {
  return fmt::format("0.{:03}",
                     random.chance(250) ? random.between(200, 600) : random.between(1, 200));
}

std::string texture(Random& random) {
  const auto names = tb::texture_names();
  return std::string(names[random.below(static_cast<std::uint32_t>(names.size()))]);
}

// For every engine: draws of run, scene and memory parameters.
const std::map<std::string_view, Draw>& common_draws() {
  static const std::map<std::string_view, Draw> all = {
      {"run.seed", word},
      {"run.stall_seed", word},
      {"run.clock_mhz",
       [](Random& r) {
         return one_of(r, {"1", "27", "148.5", "250", "999.9"});
       }},
      {"run.stalls", permille},
      {"run.reset_after", magnitude<1, 16000>},
      {"run.interval_cycles", evenly<40, 4000>},
      {"run.timeline_to", evenly<1, 3000>},
      {"scene.source", name_of_scene},
      {"scene.texture", texture},
      {"scene.texture_size", magnitude<1, 300>},
      {"scene.width", side_of_picture},
      {"scene.height", side_of_picture},
      {"scene.fov",
       [](Random& r) {
         const int hundredths = r.between(20, 250);
         return fmt::format("{}.{:02}", hundredths / 100, hundredths % 100);
       }},
      {"scene.roll", evenly<-180, 180>},
      {"scene.count", evenly<2, 3>},
      {"memory.latency", magnitude<1, 300>},
      {"memory.latency_max", magnitude<2, 600>},
      {"memory.bytes_per_cycle",
       [](Random& r) {
         return one_of(r, {"0", "4", "8", "16", "31", "32", "100", "128"});
       }},
      {"memory.banks", magnitude<2, 64>},
      {"memory.interleave_bytes", power_of_two<6, 12>},
      {"memory.bank_busy", magnitude<1, 60>},
      {"memory.outstanding", magnitude<1, 300>},
  };
  return all;
}

// The same for all memories: "frame_memory.latency" -> "memory.latency".
std::string_view common_name(std::string_view name) {
  const std::size_t dot = name.find('.');
  constexpr std::string_view kMemory = "memory";
  return name.substr(0, dot).ends_with(kMemory) ? name.substr(dot - kMemory.size()) : name;
}

// Draws of the engine and of its parts.
RandomDraws draws_of(const Engine& engine) {
  RandomDraws all = engine.random_draws();
  for (const std::string_view part : engine.parts()) {
    RandomDraws more = draws_of(*engine_named(std::string(part)));
    all.draws.merge(more.draws);
    const auto append = [&](auto list) {
      (all.*list).insert((all.*list).end(), (more.*list).begin(), (more.*list).end());
    };
    append(&RandomDraws::fixed);
    append(&RandomDraws::frequent);
    append(&RandomDraws::given);
    append(&RandomDraws::wanted);
  }
  return all;
}

template <class Names>
bool has(const Names& names, std::string_view name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

// In how many of a thousand runs the parameter is changed.
std::uint32_t how_often(const RandomDraws& engine, std::string_view name) {
  constexpr std::string_view kRun = "run.";
  if (name.ends_with(".width") || name.ends_with(".height") || name == "scene.texture_size" ||
      name == "run.seed" || name == "run.stall_seed")
    return 1000;
  if (name.ends_with(".source") || name.ends_with(".preset") || name == "run.stalls" ||
      has(engine.frequent, name))
    return 700;
  if (name == "run.maps" || name == "run.interval_cycles" || name == "run.timeline" ||
      name.ends_with("_trace"))
    return 60;
  if (name.starts_with(kRun)) return 400;
  return 300;
}

std::int64_t number(std::string_view text) {
  std::int64_t value = 0;
  std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

// A value by range: "2..4096", "true | false", "lru | fifo | random"; empty for text.
std::string drawn(const RandomDraws& engine, const tb::Parameter& parameter, Random& random) {
  const std::string_view name = common_name(parameter.name);
  for (const auto* const all : {&engine.draws, &common_draws()})
    if (const auto found = all->find(name); found != all->end()) return found->second(random);
  const std::string_view range = parameter.range;
  if (const std::size_t dots = range.find(".."); dots != std::string_view::npos)
    return std::to_string(
        by_magnitude(random, number(range.substr(0, dots)), number(range.substr(dots + 2))));
  std::vector<std::string_view> choices;
  constexpr std::string_view kBetween = " | ";
  for (std::size_t from = 0; from < range.size();) {
    const std::size_t to = std::min(range.find(kBetween, from), range.size());
    choices.push_back(range.substr(from, to - from));
    from = to + kBetween.size();
  }
  DEBURR_CHECK(choices.size() > 1, parameter.name + " has a range that cannot be sampled");
  return std::string(choices[random.below(static_cast<std::uint32_t>(choices.size()))]);
}

// False for memory settings that would take minutes.
bool is_quick(const tb::ParameterSet& set) {
  constexpr std::int64_t kMostCycles = 60, kMostBusy = 10;  // per transaction
  constexpr std::string_view kLatency = "memory.latency", kOfMemory = ".latency";
  for (const tb::Parameter& parameter : set.all()) {
    if (!parameter.name.ends_with(kLatency)) continue;
    const std::string memory = parameter.name.substr(0, parameter.name.size() - kOfMemory.size());
    const auto of = [&](const char* name) {
      return number_of(set, fmt::format("{}.{}", memory, name));
    };
    if (std::max(of("latency"), of("latency_max")) > kMostCycles * of("outstanding")) return false;
    if (of("bank_busy") > kMostBusy * of("banks")) return false;
  }
  return true;
}

// The engine with these settings, and whether it and the limits above accept them.
class DrawnConfiguration {
 public:
  DrawnConfiguration(const std::string& engine, const RandomDraws& draws, const Settings& settings)
      : draws_(draws), engine_(engine_named(engine)), bound_(*engine_) {
    for (const auto& [name, value] : settings) bound_.set.set(name, value, "--set");
  }

  bool is_resolved() {
    try {
      bound_.resolve();
    } catch (const spec::ConfigError&) {
      return false;
    }
    return is_quick(bound_.set) &&
           std::all_of(draws_.wanted.begin(), draws_.wanted.end(),
                       [&](const auto& is_wanted) { return is_wanted(bound_.set); });
  }

  // After is_resolved().
  bool is_accepted() {
    try {
      RunContext context("", bound_.set, "", static_cast<std::uint64_t>(bound_.run.seed));
      context.set_quiet(true);
      context.set_checking_only();
      engine_->check(bound_.run, context);
    } catch (const spec::ConfigError&) {
      return false;
    }
    return true;
  }

 private:
  const RandomDraws& draws_;
  std::unique_ptr<Engine> engine_;
  BoundEngine bound_;
};

// The drawn settings that are valid with the given settings and with each other. A setting that is
// rejected at first may become valid after later settings.
Settings accepted(const std::string& engine, const RandomDraws& draws, const Settings& given,
                  Settings wanted) {
  Settings settings = given;
  constexpr int kPasses = 2;
  for (int pass = 0; pass < kPasses; ++pass) {
    Settings rejected;
    for (auto& setting : wanted) {
      settings.push_back(std::move(setting));
      if (DrawnConfiguration(engine, draws, settings).is_resolved()) continue;
      rejected.push_back(std::move(settings.back()));
      settings.pop_back();
    }
    wanted = std::move(rejected);
  }
  return settings;
}

}  // namespace

bool is_fixed(const Engine& engine, std::string_view parameter) {
  const std::string_view name = common_name(parameter);
  return has(kFixed, name) || has(draws_of(engine).fixed, name);
}

Settings random_configuration(const std::string& engine, std::uint64_t seed,
                              const Settings& given) {
  Random random(seed, engine);
  const std::unique_ptr<Engine> asked = engine_named(engine);
  const BoundEngine bound(*asked);
  const RandomDraws draws = draws_of(*asked);
  std::set<std::string_view> stays;
  for (const auto& [name, value] : given) stays.insert(name);
  constexpr int kTries = 100;
  for (int i = 0; i < kTries; ++i) {
    Settings wanted = {{"run.images", "false"}, {"run.watchdog_cycles", "200000"}};
    for (const auto& setting : draws.given)
      if (bound.set.find(setting.first)) wanted.push_back(setting);
    for (const tb::Parameter& parameter : bound.set.all())
      if (const std::string_view name = common_name(parameter.name);
          !has(kFixed, name) && !has(draws.fixed, name) &&
          random.chance(how_often(draws, parameter.name)))
        wanted.emplace_back(parameter.name, drawn(draws, parameter, random));
    std::erase_if(wanted, [&](const auto& setting) { return stays.contains(setting.first); });
    Settings settings = accepted(engine, draws, given, std::move(wanted));
    DrawnConfiguration candidate(engine, draws, settings);
    if (candidate.is_resolved() && candidate.is_accepted()) {
      settings.erase(settings.begin(),
                     settings.begin() + static_cast<std::ptrdiff_t>(given.size()));
      return settings;
    }
  }
  // Random draws alone always find a valid configuration, so the given settings are the cause.
  throw spec::ConfigError(fmt::format(
      "none of {} random configurations of '{}' for seed {} is valid with the given values", kTries,
      engine, seed));
}

}  // namespace deburr::tool
