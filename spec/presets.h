// SPDX-License-Identifier: MIT
// How presets are applied. An engine lists what its presets set, once, as a function that names
// each parameter with its member and its value:
//
//   template <class Set>
//   constexpr void for_each_of(Preset preset, Set&& set) {
//     const PresetRow& row = row_of(kPresets, &PresetRow::preset, preset);
//     set("axes", &Rules::axes, row.axes);
//   }
//
// preset_parameters() of the engine gives the defaults with these values; the command goes by the
// names.
#pragma once

#include <string>

#include "spec/error.h"

namespace deburr::spec {

// The row of a table whose key is this value. ConfigError where there is none.
template <class Rows, class Row, class Key>
constexpr const Row& row_of(const Rows& rows, Key Row::*key, Key value) {
  for (const Row& row : rows)
    if (row.*key == value) return row;
  throw ConfigError("no preset or quality has the number " +
                    std::to_string(static_cast<int>(value)));
}

}  // namespace deburr::spec
