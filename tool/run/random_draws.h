// SPDX-License-Identifier: MIT
// How an engine's parameters are drawn for random configurations (random_configuration.h), and
// draws shared by the engines.
#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tb/base/random.h"

namespace deburr::tb {
class ParameterSet;
}  // namespace deburr::tb

namespace deburr::tool {

using Draw = std::string (*)(tb::Random&);

// Draws by parameter name, in addition to those of run.*, scene.* and every memory.
struct RandomDraws {
  // Draws for parameters whose range alone would give slow, rejected or identical runs.
  std::map<std::string_view, Draw> draws{};
  // Parameters that keep their values: files, and settings that cost time without exercising the
  // hardware.
  std::vector<std::string_view> fixed{};
  // The most influential parameters, drawn as often as a preset.
  std::vector<std::string_view> frequent{};
  // Settings of every random run.
  std::vector<std::pair<std::string, std::string>> given{};
  // Each function returns false for a configuration that would take minutes or exercise nothing.
  std::vector<bool (*)(const tb::ParameterSet&)> wanted{};
};

// The value of an integer parameter.
std::int64_t number_of(const tb::ParameterSet& set, std::string_view parameter);

// ---- draws --------------------------------------------------------------------------------------

std::string one_of(tb::Random& random, std::initializer_list<std::string_view> values);
// A number in low..high, log-uniform.
std::int64_t by_magnitude(tb::Random& random, std::int64_t low, std::int64_t high);

template <std::int64_t low, std::int64_t high>
std::string magnitude(tb::Random& random) {
  return std::to_string(by_magnitude(random, low, high));
}
template <int low, int high>
std::string evenly(tb::Random& random) {
  return std::to_string(random.between(low, high));
}
template <std::size_t low, std::size_t high>
std::string power_of_two(tb::Random& random) {
  return std::to_string(std::size_t{1} << random.between(low, high));
}
// The side of a picture: mostly odd, sometimes only 1..5.
std::string side_of_picture(tb::Random& random);
std::string name_of_scene(tb::Random& random);

}  // namespace deburr::tool
