// SPDX-License-Identifier: MIT
// Reads parameters of the texture unit from text such as `axes=two`, for the program that prints a
// configuration and for the tests that build the same one in SystemC: the build lists each
// configuration once.
#pragma once

#include <charconv>
#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

#include "spec/texture/check_build.h"
#include "spec/texture/parameters.h"

namespace deburr::tb::hdl {

namespace detail {

// Sets the parameter of that name.
struct Setter {
  std::string_view name, value;
  bool found = false;
  template <class Enum, class Names>
  void choice(std::string_view parameter, Enum& field, const Names& names, std::string_view) {
    if (parameter != name) return;
    for (std::size_t i = 0; i < names.size(); ++i)
      if (names[i] == value) field = static_cast<Enum>(i), found = true;
  }
  void integer(std::string_view parameter, std::int32_t& field, std::int32_t, std::int32_t,
               std::string_view, std::string_view) {
    if (parameter != name) return;
    const auto end = value.data() + value.size();
    found = std::from_chars(value.data(), end, field).ptr == end && !value.empty();
  }
};

}  // namespace detail

// Default parameters with these space-separated changes. Throws std::invalid_argument for an
// unknown name or value, ConfigError for a configuration that cannot be built.
inline spec::texture::Parameters parameters_of(std::string_view settings) {
  spec::texture::Parameters parameters;
  while (!settings.empty()) {
    const std::string_view one = settings.substr(0, settings.find(' '));
    settings.remove_prefix(std::min(settings.size(), one.size() + 1));
    if (one.empty()) continue;
    const std::size_t equals = one.find('=');
    detail::Setter setter{one.substr(0, equals), equals == std::string_view::npos
                                                     ? std::string_view()
                                                     : one.substr(equals + 1)};
    spec::texture::describe(parameters, setter);
    if (!setter.found)
      throw std::invalid_argument(std::string(one) +
                                  ": no such parameter or value of the texture unit");
  }
  return spec::texture::check_build(parameters);
}

}  // namespace deburr::tb::hdl
