// SPDX-License-Identifier: MIT
// Inputs of a geometric engine in the bindings to other languages.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "golden/c/handle.h"
#include "golden/c/parameter_texts.h"
#include "golden/geometric/traffic.h"
#include "spec/geometric/parameters.h"

namespace deburr::golden::c {

inline ParameterTexts<spec::geometric::Parameters> geometric_texts() {
  return {"geometric", [](const spec::geometric::Parameters& p) {
            return spec::geometric::preset_parameters(p.preset);
          }};
}

// Sets the base address of a memory region by name. Throws ArgumentError for an unknown name and
// for an address that is not a multiple of a line.
inline void set_base(geometric::Bases& bases, std::string_view name, std::uint32_t address) {
  const std::pair<const char*, std::uint32_t*> regions[] = {
      {"edges", &bases.edges}, {"vertices", &bases.vertices}, {"facing", &bases.facing},
      {"depth", &bases.depth}, {"colour", &bases.colour},     {"weights", &bases.weights},
      {"copy", &bases.copy},   {"pairs", &bases.pairs},       {"coarse", &bases.coarse}};
  std::vector<std::string> known;
  std::uint32_t* base = nullptr;
  for (const auto& [region, of_region] : regions) {
    known.emplace_back(region);
    if (name == region) base = of_region;
  }
  if (!base) reject_name("region of memory", name, known);
  require(address % spec::geometric::kLineBytes == 0,
          "the base of " + std::string(name) + ", " + std::to_string(address) +
              ", is not a multiple of " + std::to_string(spec::geometric::kLineBytes));
  *base = address;
}

}  // namespace deburr::golden::c
