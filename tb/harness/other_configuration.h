// SPDX-License-Identifier: MIT
// Builds a configuration that differs from the wanted one in every parameter. An engine built with
// this configuration gives wrong results if software does not write a register, or if a unit takes
// a value from its constructor.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace deburr::tb {

// Visitor of describe() (spec/parameters.h): gives every parameter not named in `kept` another
// value of its range.
class OtherConfiguration {
 public:
  explicit OtherConfiguration(std::span<const std::string_view> kept = {}) : kept_(kept) {}

  void integer(std::string_view name, std::int32_t& value, std::int32_t min, std::int32_t /*max*/,
               std::string_view /*unit*/, std::string_view /*meaning*/) {
    if (changes(name)) value = value == min ? min + 1 : min;
  }
  template <class Enum, std::size_t N>
  void choice(std::string_view name, Enum& value, const std::array<std::string_view, N>& /*names*/,
              std::string_view /*meaning*/) {
    if (changes(name)) value = static_cast<Enum>((static_cast<std::size_t>(value) + 1) % N);
  }
  void boolean(std::string_view name, bool& value, std::string_view /*meaning*/) {
    if (changes(name)) value = !value;
  }

 private:
  bool changes(std::string_view name) const {
    return std::find(kept_.begin(), kept_.end(), name) == kept_.end();
  }
  std::span<const std::string_view> kept_;
};

}  // namespace deburr::tb
