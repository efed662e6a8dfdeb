// SPDX-License-Identifier: MIT
// A visitor of parameters that refuses values outside of their declared ranges.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "spec/error.h"

namespace deburr::spec {

// ConfigError that begins with the engine's name.
struct RangeCheck {
  std::string engine;

  void integer(std::string_view name, std::int32_t value, std::int32_t min, std::int32_t max,
               std::string_view unit, std::string_view) const {
    if (value >= min && value <= max) return;
    throw ConfigError(engine + " " + std::string(name) + " = " + std::to_string(value) +
                      " is outside " + std::to_string(min) + ".." + std::to_string(max) + " " +
                      std::string(unit));
  }
  template <class Enum, std::size_t N>
  void choice(std::string_view name, Enum value, const std::array<std::string_view, N>&,
              std::string_view) const {
    if (static_cast<std::size_t>(value) >= N)
      throw ConfigError(engine + " " + std::string(name) + " is none of its " + std::to_string(N) +
                        " choices");
  }
  void boolean(std::string_view, bool, std::string_view) const {}
};

}  // namespace deburr::spec
