// SPDX-License-Identifier: MIT
// Build rules of the posteriser.
#pragma once

#include <array>
#include <span>

#include "spec/check_build.h"
#include "spec/posteriser/parameters.h"

namespace deburr::spec::posteriser {

inline constexpr std::array<BuildRule<Parameters>, 1> kBuildRules = {{
    {{"link_depth"},
     "must be 1 or an even number of tones",
     [](const Parameters& p) { return p.link_depth == 1 || p.link_depth % 2 == 0; }},
}};

inline std::span<const BuildRule<Parameters>> build_rules(const Parameters&) { return kBuildRules; }

inline const Parameters& check_build(const Parameters& parameters) {
  return spec::check_build("posteriser", parameters);
}

}  // namespace deburr::spec::posteriser
