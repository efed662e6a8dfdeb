// SPDX-License-Identifier: MIT
// Parameters of an engine by name and text, from their only declaration in
// spec/ENGINE/parameters.h. The preset is applied first, then the parameters set by name, as in the
// command.
#pragma once

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "golden/c/handle.h"
#include "spec/check_build.h"

namespace deburr::golden::c {

// A number in decimal, or in hexadecimal after 0x; nullopt if the text is not a number.
std::optional<std::int64_t> integer_of(std::string_view text);

// Throw ArgumentError with the text of the command.
[[noreturn]] void reject_value(std::string_view name, std::string_view text, std::string_view why);
[[noreturn]] void reject_name(std::string_view what, std::string_view name,
                              std::span<const std::string> known);
std::int64_t number_in_range(std::string_view name, std::string_view text, std::int64_t min,
                             std::int64_t max);
std::size_t code_of(std::string_view name, std::string_view text,
                    std::span<const std::string_view> names);
bool switch_of(std::string_view name, std::string_view text);

// Visitor (spec/parameters.h) that sets one parameter from a text.
class ParameterWriter {
 public:
  ParameterWriter(std::string_view wanted, std::string_view text) : wanted_(wanted), text_(text) {}
  void integer(std::string_view name, std::int32_t& value, std::int32_t min, std::int32_t max,
               std::string_view, std::string_view) const {
    if (name == wanted_) value = static_cast<std::int32_t>(number_in_range(name, text_, min, max));
  }
  template <class Enum, std::size_t N>
  void choice(std::string_view name, Enum& value, const std::array<std::string_view, N>& names,
              std::string_view) const {
    if (name == wanted_) value = static_cast<Enum>(code_of(name, text_, names));
  }
  void boolean(std::string_view name, bool& value, std::string_view) const {
    if (name == wanted_) value = switch_of(name, text_);
  }

 private:
  std::string_view wanted_, text_;
};

// Visitor that collects the names.
class ParameterNames {
 public:
  void integer(std::string_view name, std::int32_t, std::int32_t, std::int32_t, std::string_view,
               std::string_view) {
    names.emplace_back(name);
  }
  template <class Enum, std::size_t N>
  void choice(std::string_view name, Enum, const std::array<std::string_view, N>&,
              std::string_view) {
    names.emplace_back(name);
  }
  void boolean(std::string_view name, bool, std::string_view) { names.emplace_back(name); }

  std::vector<std::string> names;
};

template <class Parameters>
class ParameterTexts {
 public:
  // `preset` returns the defaults of the presets named in its argument.
  using Preset = Parameters (*)(const Parameters&);
  ParameterTexts(std::string_view engine, Preset preset) : engine_(engine), preset_(preset) {
    ParameterNames visitor;
    describe(values_, visitor);
    names_ = std::move(visitor.names);
  }

  // Accepts names with and without the engine's prefix. Changes everything or, if it throws,
  // nothing.
  void set(std::string_view name, std::string_view text) {
    const std::string known = known_name(name);
    Given given = given_;
    std::erase_if(given, [&](const auto& one) { return one.first == known; });
    given.emplace_back(known, text);
    Parameters named;
    apply(given, named);
    Parameters values = preset_(named);
    apply(given, values);
    given_ = std::move(given);
    values_ = values;
  }
  std::string get(std::string_view name) const {
    return spec::value_text(values_, known_name(name));
  }
  const Parameters& values() const { return values_; }
  std::span<const std::string> names() const { return names_; }

 private:
  using Given = std::vector<std::pair<std::string, std::string>>;
  static void apply(const Given& given, Parameters& parameters) {
    for (const auto& [name, text] : given) {
      const ParameterWriter writer(name, text);
      describe(parameters, writer);
    }
  }
  std::string known_name(std::string_view name) const {
    std::string_view rest = name;
    if (rest.starts_with(engine_) && rest.substr(engine_.size()).starts_with('.'))
      rest.remove_prefix(engine_.size() + 1);
    const auto known = std::find(names_.begin(), names_.end(), rest);
    if (known == names_.end()) reject_name("parameter", name, names_);
    return *known;
  }

  std::string_view engine_;
  Preset preset_;
  std::vector<std::string> names_;
  Given given_;
  Parameters values_;
};

}  // namespace deburr::golden::c
