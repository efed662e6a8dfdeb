// SPDX-License-Identifier: MIT
#include "tool/run/engine.h"

#include <fmt/format.h>

#include <algorithm>

#include "spec/error.h"
#include "tb/base/near_matches.h"
#include "tool/run/composition.h"

namespace deburr::tool {

std::unique_ptr<CompositionRole> Engine::role() const { return nullptr; }

std::unique_ptr<Engine> engine_named(const std::string& name) {
  std::vector<std::string> known;
  for (std::unique_ptr<Engine>& engine : engines()) {
    if (engine->name() == name) return std::move(engine);
    known.emplace_back(engine->name());
  }
  throw spec::ConfigError(fmt::format("no engine '{}'{} (known: {})", name,
                                      tb::did_you_mean(tb::near_matches(name, known)),
                                      fmt::join(known, ", ")));
}

std::vector<std::string> maps_of(const Engine& engine) {
  std::vector<std::string> names;
  for (const std::string_view map : engine.maps()) names.emplace_back(map);
  for (const std::string_view part : engine.parts())
    for (const std::string& map : maps_of(*engine_named(std::string(part))))
      names.push_back(fmt::format("{}_{}", part, map));
  return names;
}

bool keeps_pixel_history(const Engine& engine) {
  const std::vector<std::string_view> parts = engine.parts();
  return !engine.pixel_history().empty() ||
         std::any_of(parts.begin(), parts.end(), [](std::string_view part) {
           return keeps_pixel_history(*engine_named(std::string(part)));
         });
}

}  // namespace deburr::tool
