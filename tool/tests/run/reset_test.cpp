// SPDX-License-Identifier: MIT
// A reset in the middle of a run, for random builds and runs (tool/run/random_configuration.h).
// After the reset the run is cycle-identical to a run without it. Every figure of result.json is
// compared.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "tb/base/forked.h"
#include "tb/base/random.h"
#include "tb/run/result.h"
#include "tool/run/random_configuration.h"
#include "tool/run/run_once.h"

namespace deburr::tool::reset_test {
namespace {

using Settings = std::vector<std::pair<std::string, std::string>>;
using Json = nlohmann::json;
using Figures = std::map<std::string, std::string>;

void flatten(const Json& node, const std::string& path, Figures& figures) {
  if (node.is_object())
    for (const auto& [key, value] : node.items()) flatten(value, path + "." + key, figures);
  else
    figures[path] = node.dump();
}

// Excludes everything that continues through a reset, random or not: stalls, out-of-order
// responses, a memory that is still serving earlier requests. Also excludes recordings of the run,
// which contain the part before the reset. The evaluation order of units (run.shuffle) has no
// effect.
Settings drawn(const std::string& engine, std::uint64_t seed) {
  Settings settings = random_configuration(engine, seed);
  std::erase_if(settings, [](const auto& setting) {
    const std::string& name = setting.first;
    const std::size_t memory = name.rfind("memory.");
    return (memory != std::string::npos && !name.ends_with(".latency")) ||
           name.find("_trace") != std::string::npos || name.starts_with("run.timeline") ||
           name == "run.stalls" || name == "run.reset_after" || name == "run.interval_cycles" ||
           name == "run.maps" || name == "run.coverage" || name == "run.pixel";
  });
  return settings;
}

std::string text_of(const Settings& settings) {
  std::string text;
  for (const auto& [name, value] : settings) text += " " + name + "=" + value;
  return text;
}

std::uint64_t frames_of(const Settings& settings) {
  for (const auto& [name, value] : settings)
    if (name == "scene.count" || name == "frame.count") return std::stoull(value);
  return 1;
}

// All figures of a run except those of the host. Comparisons before the reset are counted too, and
// the reset takes cycles of its own, in which units are idle.
struct Run {
  Figures figures;
  std::uint64_t compared = 0;
};

Run run(const std::string& engine, const Settings& settings, std::uint64_t reset_after) {
  const std::filesystem::path directory =
      std::filesystem::temp_directory_path() / ("deburr_reset_" + std::to_string(::getpid()));
  const std::string text = tb::forked_text([&]() -> std::string {
    const std::unique_ptr<Engine> made = engine_named(engine);
    BoundEngine bound(*made);
    for (const auto& [name, value] : settings) bound.set.set(name, value, "drawn");
    bound.set.set("run.reset_after", std::to_string(reset_after), "drawn");
    bound.resolve();
    RunContext context(directory, bound.set, "", static_cast<std::uint64_t>(bound.run.seed));
    context.set_quiet(true);
    return to_json(run_once(bound, context, IfTaken::kWait).result).dump();
  });
  std::filesystem::remove_all(directory);
  Run made;
  flatten(Json::parse(text), "", made.figures);
  for (const auto& [name, value] : made.figures)
    if (name.starts_with(".scoreboards.") && name.ends_with(".comparisons"))
      made.compared += std::stoull(value);
  std::erase_if(made.figures, [](const auto& figure) {
    return figure.first.starts_with(".host.") || figure.first.starts_with(".meaning.") ||
           figure.first.ends_with("comparisons") ||
           (figure.first.starts_with(".units.") && figure.first.ends_with(".idle"));
  });
  return made;
}

class ResetOfDraws : public testing::TestWithParam<std::string> {};

TEST_P(ResetOfDraws, LeavesNoStateBehind) {
  const std::string engine = GetParam();
  int resets = 0;  // after at least one comparison, which is the only evidence of a reset
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    const Settings settings = drawn(engine, seed);
    const auto [whole, compared] = run(engine, settings, 0);
    ASSERT_EQ(whole.at(".verdict"), "\"pass\"") << text_of(settings);
    const std::uint64_t cycles = std::stoull(whole.at(".cycles"));
    tb::Random random(seed, "reset");
    for (int i = 0; i < 3; ++i) {
      const std::uint64_t at =
          1 + random.below(static_cast<std::uint32_t>(cycles / frames_of(settings)));
      const auto [again, compared_again] = run(engine, settings, at);
      EXPECT_GE(compared_again, compared) << text_of(settings);
      resets += compared_again > compared ? 1 : 0;
      std::string different;
      for (const auto& [name, value] : whole) {
        const auto figure = again.find(name);
        const std::string got = figure == again.end() ? "none" : figure->second;
        if (got != value) different += name + ": " + value + ", " + got + "\n";
      }
      EXPECT_EQ(different, "") << "reset " << at << " cycles into " << cycles << ", of seed "
                               << seed << text_of(settings);
    }
  }
  EXPECT_GE(resets, 12) << "of 36";
}

INSTANTIATE_TEST_SUITE_P(Engines, ResetOfDraws, testing::ValuesIn([] {
                           std::vector<std::string> names;
                           for (const auto& engine : engines()) names.emplace_back(engine->name());
                           return names;
                         }()),
                         [](const auto& p) { return p.param; });

}  // namespace
}  // namespace deburr::tool::reset_test
