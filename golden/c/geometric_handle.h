// SPDX-License-Identifier: MIT
// Inputs of a geometric engine in the bindings to other languages.
#pragma once

#include "golden/c/parameter_texts.h"
#include "spec/geometric/parameters.h"

namespace deburr::golden::c {

inline ParameterTexts<spec::geometric::Parameters> geometric_texts() {
  return {"geometric", [](const spec::geometric::Parameters& p) {
            return spec::geometric::preset_parameters(p.preset);
          }};
}

}  // namespace deburr::golden::c
