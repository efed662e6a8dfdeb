// SPDX-License-Identifier: MIT
// Presets. An engine lists the values of its presets once, in a function that passes each parameter
// by name, member and value:
//
//   template <class Set>
//   constexpr void for_each_of(Preset preset, Set&& set) {
//     const PresetRow& row = row_of(kPresets, &PresetRow::preset, preset);
//     set("axes", &Configuration::axes, row.axes);
//   }
//
// The engine's preset_parameters() returns the defaults with these values; the command uses the
// names.
#pragma once

#include <string>

#include "spec/error.h"

namespace deburr::spec {

// The row of a table with this key. Throws ConfigError if there is none.
template <class Rows, class Row, class Key>
constexpr const Row& row_of(const Rows& rows, Key Row::*key, Key value) {
  for (const Row& row : rows)
    if (row.*key == value) return row;
  throw ConfigError("unknown preset or quality: number " + std::to_string(static_cast<int>(value)));
}

}  // namespace deburr::spec
