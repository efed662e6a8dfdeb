// SPDX-License-Identifier: MIT
// Declaration of a unit's parameters: name, storage, range, unit and one line of meaning.
//
// A parameter struct P is a plain struct whose member initialisers are the defaults, with a
// function
//
//   template <class Visitor> void describe(P& p, Visitor& v) {
//     v.integer("cache.ways", p.cache_ways, 1, 8, "way", "Associativity of the texture cache.");
//     v.choice("footprint", p.footprint, kFootprintNames, "Rule for the length of ...");
//     v.boolean("mesh.two_sided", p.two_sided, "...");
//   }
//
// Every consumer (command line, YAML, documentation, manifest) is a visitor with these members:
//   void integer(std::string_view name, std::int32_t& value, std::int32_t min, std::int32_t max,
//                std::string_view unit, std::string_view meaning);
//   template <class Enum, std::size_t N>
//   void choice(std::string_view name, Enum& value, const std::array<std::string_view, N>& names,
//               std::string_view meaning);          // enumerators are 0..N-1 in the order of names
//   void boolean(std::string_view name, bool& value, std::string_view meaning);
//
// A range is data only; the consumer that reads a value checks it.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
