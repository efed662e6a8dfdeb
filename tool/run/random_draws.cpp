// SPDX-License-Identifier: MIT
#include "tool/run/random_draws.h"

#include <algorithm>
#include <charconv>

#include "tb/run/parameter_set.h"
#include "tb/scene/scenes.h"

namespace deburr::tool {

std::int64_t number_of(const tb::ParameterSet& set, std::string_view parameter) {
  const std::string text = set.find(parameter)->text();
  std::int64_t value = 0;
  std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

std::string one_of(tb::Random& random, std::initializer_list<std::string_view> values) {
  return std::string(values.begin()[random.below(static_cast<std::uint32_t>(values.size()))]);
}

std::int64_t by_magnitude(tb::Random& random, std::int64_t low, std::int64_t high) {
  std::int64_t span = high - low + 1;
  int bits = 0;
  while (span >> bits > 1) ++bits;
  const std::int64_t below = std::min(span, std::int64_t{1} << random.between(0, bits));
  return low + static_cast<std::int64_t>(random.next() % static_cast<std::uint64_t>(below));
}

std::string side_of_picture(tb::Random& random) {
  if (random.chance(100)) return evenly<1, 5>(random);
  const int drawn = random.between(3, 96);
  return std::to_string(random.chance(700) ? drawn | 1 : drawn);
}

std::string name_of_scene(tb::Random& random) {
  const auto names = tb::scene_names();
  return std::string(names[random.below(static_cast<std::uint32_t>(names.size()))].name);
}

}  // namespace deburr::tool
