// SPDX-License-Identifier: MIT
// How an engine wants its parameters drawn for random configurations (random_configuration.h), and
// the draws that engines have in common.
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

// Beside what holds for run.*, scene.* and every memory. By names of parameters.
struct RandomDraws {
  // What a range alone would make slow, rejected or the same as ever.
  std::map<std::string_view, Draw> draws{};
  // What stays as it is: files, what costs time and shows nothing of the hardware.
  std::vector<std::string_view> fixed{};
  // What decides most, and is drawn as often as a preset.
  std::vector<std::string_view> frequent{};
  // What every random run is given.
  std::vector<std::pair<std::string, std::string>> given{};
  // Each says false of what would take minutes, or show nothing.
  std::vector<bool (*)(const tb::ParameterSet&)> wanted{};
};

// What a parameter of integers is set to.
std::int64_t number_of(const tb::ParameterSet& set, std::string_view parameter);

// ---- draws --------------------------------------------------------------------------------------

std::string one_of(tb::Random& random, std::initializer_list<std::string_view> values);
// low..high, of which small numbers are as likely as large ones.
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
// Of a picture: mostly odd, and now and then a row or a column alone.
std::string side_of_picture(tb::Random& random);
std::string name_of_scene(tb::Random& random);

}  // namespace deburr::tool
