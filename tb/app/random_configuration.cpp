// SPDX-License-Identifier: MIT
#include "tb/app/random_configuration.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <initializer_list>
#include <map>
#include <memory>
#include <set>

#include "spec/error.h"
#include "tb/app/run_once.h"
#include "tb/scene/scenes.h"
#include "tb/scene/textures.h"
#include "tb/stimuli/random.h"

namespace deburr::tb {
namespace {

using Settings = std::vector<std::pair<std::string, std::string>>;

constexpr std::array<std::string_view, 22> kFixed = {
    // A run that is not compared, that ends by design, or that leaves pictures and waves.
    "run.check", "run.max_cycles", "run.fault", "run.truth", "run.images", "run.trace",
    "run.trace_from", "run.trace_to", "run.timeline_from",
    // Files, and cameras that mostly see nothing.
    "scene.fragments", "scene.eye", "scene.target", "frame.depth", "frame.truth", "frame.mask",
    // Truths are supersampled, and nothing of the hardware.
    "frame.truth_samples", "scene.truth_samples", "sequence.frames", "sequence.motion",
    // No run that meets an error of memory passes.
    "memory.error_address", "memory.error_bytes",
    // Below the patience of a watchdog, memory that is slow and stalls would be a deadlock.
    "run.watchdog_cycles"};

using Draw = std::string (*)(Random&);

std::string one_of(Random& random, std::initializer_list<std::string_view> values) {
  return std::string(values.begin()[random.below(static_cast<std::uint32_t>(values.size()))]);
}

// low..high, of which small numbers are as likely as large ones.
std::int64_t by_magnitude(Random& random, std::int64_t low, std::int64_t high) {
  std::int64_t span = high - low + 1;
  int bits = 0;
  while (span >> bits > 1) ++bits;
  const std::int64_t below = std::min(span, std::int64_t{1} << random.between(0, bits));
  return low + static_cast<std::int64_t>(random.next() % static_cast<std::uint64_t>(below));
}

template <std::int64_t low, std::int64_t high>
std::string magnitude(Random& random) {
  return std::to_string(by_magnitude(random, low, high));
}

template <int low, int high>
std::string evenly(Random& random) {
  return std::to_string(random.between(low, high));
}

std::string word(Random& random) { return std::to_string(random.word()); }

// Mostly odd, and now and then a row or a column alone.
std::string side(Random& random) {
  if (random.chance(100)) return evenly<1, 5>(random);
  const int drawn = random.between(3, 96);
  return std::to_string(random.chance(700) ? drawn | 1 : drawn);
}

template <std::size_t low, std::size_t high>
std::string power_of_two(Random& random) {
  return std::to_string(std::size_t{1} << random.between(low, high));
}

std::string permille(Random& random) {
  return fmt::format("0.{:03}",
                     random.chance(250) ? random.between(200, 600) : random.between(1, 200));
}

std::string scene(Random& random) {
  const auto names = scene_names();
  return std::string(names[random.below(static_cast<std::uint32_t>(names.size()))].name);
}

std::string texture(Random& random) {
  const auto names = texture_names();
  return std::string(names[random.below(static_cast<std::uint32_t>(names.size()))]);
}

// How a parameter is drawn that a range alone would make slow, refused or the same as ever.
const std::map<std::string_view, Draw>& draws() {
  static const std::map<std::string_view, Draw> all = {
      {"run.seed", word},
      {"run.stall_seed", word},
      {"run.clock_mhz",
       [](Random& r) {
         return one_of(r, {"1", "27", "148.5", "250", "999.9"});
       }},
      {"run.stalls", permille},
      {"run.reset_after", magnitude<1, 16000>},
      {"run.window_cycles", evenly<40, 4000>},
      {"run.timeline_to", evenly<1, 3000>},
      {"scene.source", scene},
      {"frame.source", scene},
      {"scene.texture", texture},
      {"scene.texture_size", magnitude<1, 300>},
      {"scene.width", side},
      {"scene.height", side},
      {"frame.width", side},
      {"frame.height", side},
      {"scene.fov",
       [](Random& r) {
         const int hundredths = r.between(20, 250);
         return fmt::format("{}.{:02}", hundredths / 100, hundredths % 100);
       }},
      {"scene.roll", evenly<-180, 180>},
      {"frame.count", evenly<2, 3>},
      {"scene.count", evenly<2, 3>},
      {"sampler.lod_bias", evenly<-1600, 1600>},
      {"sampler.min_lod", evenly<0, 1600>},
      {"sampler.max_lod", evenly<0, 4000>},
      {"texture.cache.bytes", power_of_two<8, 16>},
      {"texture.cache.line_bytes", power_of_two<5, 7>},
      {"texture.cache.ways", power_of_two<0, 3>},
      {"texture.cache.fifo_depth", magnitude<2, 300>},
      {"texture.axis_clocks", power_of_two<0, 2>},
      {"morphological.window_rows",
       [](Random& r) { return std::to_string(2 * by_magnitude(r, 5, 129)); }},
      {"morphological.reach_columns", magnitude<4, 2048>},
      {"morphological.line_pixels", evenly<96, 1100>},
      {"morphological.memory.outstanding", magnitude<4, 256>},
      {"geometric.line_pixels", evenly<96, 1100>},
      {"geometric.touched_words", magnitude<25, 4000>},
      {"geometric.face_limit", [](Random& r) { return std::to_string(r.between(32, 100) * 1024); }},
      {"geometric.memory.outstanding", magnitude<8, 1024>},
      {"memory.latency", magnitude<1, 300>},
      {"memory.latency_max", magnitude<2, 600>},
      {"memory.bytes_per_clock",
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

// Of every memory the same: "frame_memory.latency" -> "memory.latency".
std::string_view common_name(std::string_view name) {
  const std::size_t dot = name.find('.');
  constexpr std::string_view kMemory = "memory";
  return name.substr(0, dot).ends_with(kMemory) ? name.substr(dot - kMemory.size()) : name;
}

// How many runs of a thousand change it.
std::uint32_t how_often(std::string_view name) {
  constexpr std::string_view kRun = "run.";
  if (name.ends_with(".width") || name.ends_with(".height") || name == "scene.texture_size" ||
      name == "run.seed" || name == "run.stall_seed")
    return 1000;
  if (name.ends_with(".source") || name.ends_with(".preset") || name == "frame.smoothing" ||
      name == "run.stalls")
    return 700;
  if (name == "run.maps" || name == "run.window_cycles" || name == "run.timeline" ||
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

// By its range: "2..4096", "true | false", "lru | fifo | random"; empty for text.
std::string drawn(const Parameter& parameter, Random& random) {
  const auto found = draws().find(common_name(parameter.name));
  if (found != draws().end()) return found->second(random);
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
  DEBURR_CHECK(choices.size() > 1, parameter.name + " has a range that nothing is drawn from");
  return std::string(choices[random.below(static_cast<std::uint32_t>(choices.size()))]);
}

// What only the model of the hardware would refuse when it is built, and what would take minutes.
bool is_buildable_and_quick(const ParameterSet& set) {
  const auto value = [&](const std::string& name) { return number(set.find(name)->text()); };
  if (set.find("texture.axes")) {
    const std::int64_t line = value("texture.cache.line_bytes"),
                       bytes = value("texture.cache.bytes");
    constexpr std::int64_t kMostLines = 512;
    if (bytes < line * value("texture.cache.ways") || bytes > line * kMostLines) return false;
    const std::string axes = set.find("texture.axes")->text();
    if (value("texture.axis_clocks") > (axes == "two" ? 1 : axes == "four" ? 2 : 4)) return false;
  }
  const Parameter* const storage = set.find("morphological.storage");
  if (set.find("frame.count") && storage->text() != "memory" &&
      set.find("run.line_trace")->text() != "none")
    return false;  // the morphological engine alone asks memory for nothing
  constexpr std::int64_t kMostClocks = 60, kMostBusy = 10;  // of a transaction
  for (const char* const memory : {"memory", "geometric_memory", "frame_memory"}) {
    const auto of = [&](const char* name) { return value(fmt::format("{}.{}", memory, name)); };
    if (!set.find(fmt::format("{}.latency", memory))) continue;
    if (std::max(of("latency"), of("latency_max")) > kMostClocks * of("outstanding")) return false;
    if (of("bank_busy") > kMostBusy * of("banks")) return false;
  }
  return true;
}

// The engine with these settings; null where it, or what is said above, refuses one.
class Candidate {
 public:
  Candidate(const std::string& engine, const Settings& settings)
      : engine_(engine_named(engine)), bound_(*engine_) {
    for (const auto& [name, value] : settings) bound_.set.set(name, value, "--set");
  }

  bool is_resolved() {
    try {
      bound_.resolve();
    } catch (const spec::ConfigError&) {
      return false;
    }
    return is_buildable_and_quick(bound_.set);
  }

  // After is_resolved().
  bool is_accepted() {
    try {
      RunContext context("", bound_.set, "", static_cast<std::uint64_t>(bound_.run.seed));
      context.set_quiet(true);
      context.set_judging_only();
      engine_->judge(bound_.run, context);
    } catch (const spec::ConfigError&) {
      return false;
    }
    return true;
  }

 private:
  std::unique_ptr<Engine> engine_;
  BoundEngine bound_;
};

// Those that go with what is given and with each other: one that goes with none of those before it
// may go with those behind it.
Settings accepted(const std::string& engine, const Settings& given, Settings wanted) {
  Settings settings = given;
  constexpr int kPasses = 2;
  for (int pass = 0; pass < kPasses; ++pass) {
    Settings refused;
    for (auto& setting : wanted) {
      settings.push_back(std::move(setting));
      if (Candidate(engine, settings).is_resolved()) continue;
      refused.push_back(std::move(settings.back()));
      settings.pop_back();
    }
    wanted = std::move(refused);
  }
  return settings;
}

}  // namespace

std::span<const std::string_view> fixed_parameters() { return kFixed; }

bool is_fixed(std::string_view parameter) {
  return std::find(kFixed.begin(), kFixed.end(), common_name(parameter)) != kFixed.end();
}

Settings random_configuration(const std::string& engine, std::uint64_t seed,
                              const Settings& given) {
  Random random(seed, engine);
  const std::unique_ptr<Engine> asked = engine_named(engine);
  const BoundEngine bound(*asked);
  std::set<std::string_view> stays;
  for (const auto& [name, value] : given) stays.insert(name);
  constexpr int kTries = 100;
  for (int i = 0; i < kTries; ++i) {
    Settings wanted = {{"run.images", "false"}, {"run.watchdog_cycles", "200000"}};
    if (bound.set.find("frame.truth_samples")) wanted.emplace_back("frame.truth_samples", "0");
    for (const Parameter& parameter : bound.set.all())
      if (!is_fixed(parameter.name) && random.chance(how_often(parameter.name)))
        wanted.emplace_back(parameter.name, drawn(parameter, random));
    std::erase_if(wanted, [&](const auto& setting) { return stays.contains(setting.first); });
    Settings settings = accepted(engine, given, std::move(wanted));
    Candidate candidate(engine, settings);
    if (candidate.is_resolved() && candidate.is_accepted()) {
      settings.erase(settings.begin(),
                     settings.begin() + static_cast<std::ptrdiff_t>(given.size()));
      return settings;
    }
  }
  // Of nothing but draws one is always found, so that it is for what is given that none is.
  throw spec::ConfigError(
      fmt::format("of {} random configurations of '{}' for seed {} none goes with what is given",
                  kTries, engine, seed));
}

}  // namespace deburr::tb
